//! Plots of a report: any column against any, both logarithmic, with the front and the slopes of methods.
//! Runs that failed are crosses at the upper edge.

use super::report::{Row, Status, View};
use crate::output::svg::{Axis, Color, Figure, Legend, Marker, PALETTE, Panel, Series};

/// What a plot shows along an axis, and what [`View::work_at`] counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Column {
    /// The error in the quantity of the view.
    Error,
    /// The spacing \[m\].
    Spacing,
    /// Time \[s\].
    Seconds,
    /// Pairs evaluated.
    Pairs,
    /// Steps.
    Steps,
    /// Builds of neighbour lists.
    ListBuilds,
    /// Bytes held.
    Bytes,
    /// Particles.
    Particles,
}

impl Column {
    fn axis(self, quantity: &str) -> Axis {
        match self {
            Self::Error => Axis::log(&format!("error: {quantity}"), ""),
            Self::Spacing => Axis::log("spacing", "m"),
            Self::Seconds => Axis::log("time", "s"),
            Self::Pairs => Axis::log("pairs", ""),
            Self::Steps => Axis::log("steps", ""),
            Self::ListBuilds => Axis::log("list builds", ""),
            Self::Bytes => Axis::log("memory", "B"),
            Self::Particles => Axis::log("particles", ""),
        }
    }
}

const MARKERS: [Marker; 5] = [
    Marker::Circle,
    Marker::Square,
    Marker::Triangle,
    Marker::Diamond,
    Marker::Ring,
];

/// Of the front, behind the methods.
const GREY: Color = Color(0xc8, 0xc8, 0xc8);

impl View<'_> {
    pub(super) fn read(&self, row: &Row, column: Column) -> Option<f64> {
        let work = &row.work;
        let value = match column {
            Column::Error => self.error(row)?,
            Column::Spacing => row.spacing,
            Column::Seconds => row.seconds,
            Column::Pairs => work.pairs as f64,
            Column::Steps => work.steps as f64,
            Column::ListBuilds => work.list_builds as f64,
            Column::Bytes => work.bytes as f64,
            Column::Particles => work.particles as f64,
        };
        (value.is_finite() && value > 0.0).then_some(value)
    }

    /// One column against another: a curve for each method; where error is plotted against spacing its law, dashed, with
    /// the order in the legend; and where it is plotted against time the front.
    #[must_use]
    pub fn panel(&self, x: Column, y: Column) -> Panel {
        self.draw(x, y, true)
    }

    fn draw(&self, x: Column, y: Column, labelled: bool) -> Panel {
        let name = self.quantity().name();
        let mut panel = Panel::new(x.axis(name), y.axis(name))
            .title(name)
            .legend(if labelled {
                Legend::Auto
            } else {
                Legend::Hidden
            });
        if (x, y) == (Column::Seconds, Column::Error) {
            let front = self.front().into_iter();
            let points = front.filter_map(|row| Some((self.read(row, x)?, self.read(row, y)?)));
            panel = panel.series(Series::line("front", points).color(GREY).width(6.0));
        }
        let mut largest = 0.0_f64;
        for (k, method) in self.report.methods().enumerate() {
            let rows = self.report.rows.iter().filter(|row| row.method == method);
            let points: Vec<_> = rows
                .filter_map(|row| Some((self.read(row, x)?, self.read(row, y)?)))
                .collect();
            largest = points.iter().fold(largest, |most, point| most.max(point.1));
            let color = PALETTE[k % PALETTE.len()];
            let mut label = method.to_string();
            let lawful = (x, y) == (Column::Spacing, Column::Error);
            if let Some(fit) = lawful.then(|| self.fit(method).ok()).flatten() {
                label += &format!(" (order {:.2})", fit.order().value);
                let (least, most) = fit.range();
                let steps = 24;
                let places = (0..=steps)
                    .map(|k| least * (most / least).powf(f64::from(k) / f64::from(steps)));
                let law: Vec<_> = places
                    .filter_map(|dx| Some((dx, fit.at(dx).ok()?.value)))
                    .collect();
                panel = panel.series(Series::line("", law).color(color).dashed().width(1.0));
            }
            let mut series = if lawful {
                Series::markers(if labelled { &label } else { "" }, points)
            } else {
                Series::line(if labelled { &label } else { "" }, points)
            };
            series = series
                .marker(MARKERS[(k / PALETTE.len()) % MARKERS.len()])
                .color(color);
            panel = panel.series(series);
        }
        let failed = self
            .report
            .rows
            .iter()
            .filter(|row| matches!(row.status, Status::Failed(_)));
        let crosses: Vec<_> = failed
            .filter_map(|row| Some((self.read(row, x)?, 1.5 * largest)))
            .collect();
        if !crosses.is_empty() && largest > 0.0 {
            panel = panel.series(Series::markers("failed", crosses).marker(Marker::Cross));
        }
        panel
    }

    /// Error against spacing, and error against time: what a study is usually looked at by.
    #[must_use]
    pub fn figure(&self) -> Figure {
        Figure::new()
            .title(&self.report.name)
            .panel(self.draw(Column::Spacing, Column::Error, true))
            .panel(self.draw(Column::Seconds, Column::Error, false))
            .columns(2)
            .panel_size(480.0, 360.0)
            .shared_legend()
    }
}
