//! Particles as dots, coloured by a value.
//! All dots of one colour share a path, as one element each would make large files.

use super::bar::{LEVELS, level_color};
use super::draw::Prepared;
use super::path::px;
use std::fmt::Write as _;

impl Prepared<'_> {
    pub(super) fn cloud(&self, body: &mut String, w: f64, h: f64) {
        let (Some(cloud), Some(bar)) = (&self.panel.cloud, &self.bar) else {
            return;
        };
        let per_unit = if self.x.log {
            0.0
        } else {
            w / (self.x.high - self.x.low)
        };
        let diameter = cloud.diameter.map_or(3.0, |d| (d * per_unit).max(0.6));
        // One path for each colour; values that are not finite come last, in grey.
        let mut paths = vec![String::new(); LEVELS + 1];
        let reach = diameter;
        for &(x, y, value) in &cloud.points {
            let at = self.place((x, y), w, h);
            let inside =
                (-reach..=w + reach).contains(&at.0) && (-reach..=h + reach).contains(&at.1);
            if inside {
                let tenth = |v: f64| (v * 10.0).round() / 10.0 + 0.0;
                let _ = write!(
                    paths[bar.level(value)],
                    "M{} {}h0",
                    tenth(at.0),
                    tenth(at.1)
                );
            }
        }
        for (level, data) in paths
            .iter()
            .enumerate()
            .filter(|(_, data)| !data.is_empty())
        {
            let color = level_color(level);
            let _ = writeln!(
                body,
                "<path d=\"{data}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"{}\" \
                 stroke-linecap=\"round\"/>",
                px(diameter)
            );
        }
    }
}
