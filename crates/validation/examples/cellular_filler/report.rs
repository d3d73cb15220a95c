//! Forces, works and volumes of all cases in one figure and one table.
//! What must hold: volumes to 2 %, forces that rise with viscosity and with the density of the structure.

use super::filler::{Case, Record};
use meshfree::output::svg::{Axis, Figure, Panel, Series, viridis};
use meshfree::output::table::{Table, significant};

/// Force, work and expelled volume against strain.
pub fn figure(runs: &[(Case, Record)]) -> Figure {
    let label = |case: &Case| format!("c {:.1} mm, {:.0e} Pa s", 1e3 * case.wall, case.viscosity);
    let panel = |name: &str, unit: &str, of: &dyn Fn(&super::filler::Sample) -> f64| {
        let mut panel = Panel::new(Axis::linear("strain", "%"), Axis::linear(name, unit));
        for (case, record) in runs {
            let points = record.samples.iter().map(|s| (1e2 * s.strain, of(s)));
            // Colours tell viscosities apart, strokes the thickness of walls.
            let fluid = (case.viscosity.log10() + 3.0) / 3.0;
            let color = viridis(0.85 * fluid.clamp(0.0, 1.0));
            let line = Series::line(&label(case), points).color(color);
            let line = line.width(0.4 + 1200.0 * case.wall);
            let thin = case.wall < 0.75e-3;
            panel = panel.series(if thin { line.dashed() } else { line });
        }
        panel
    };
    Figure::new()
        .panel(panel("force of the filler", "N", &|s| s.force))
        .panel(panel("work on the filler", "mJ", &|s| 1e3 * s.work))
        .panel(panel("expelled volume over loss of void", "", &|s| s.expelled).mark_y(1.0))
        .columns(3)
        .shared_legend()
}

/// Mean force over the second half of the run, at the full rate of strain.
fn force(record: &Record) -> f64 {
    let later = &record.samples[record.samples.len() / 2..];
    later.iter().map(|s| s.force).sum::<f64>() / later.len().max(1) as f64
}

/// One row for each case.
pub fn table(runs: &[(Case, Record)]) -> Table {
    let mut table = Table::new([
        "c [mm]",
        "relative density",
        "viscosity [Pa s]",
        "mean force [N]",
        "work [mJ]",
        "kinetic [mJ]",
        "dissipated [mJ]",
        "expelled over loss of void",
        "particles",
        "time [s]",
    ]);
    for (case, record) in runs {
        let Some(last) = record.samples.last() else {
            continue;
        };
        table.row([
            significant(1e3 * case.wall, 2),
            significant(record.relative_density, 3),
            significant(case.viscosity, 1),
            significant(force(record), 3),
            significant(1e3 * last.work, 3),
            significant(1e3 * last.kinetic, 3),
            significant(1e3 * last.dissipated, 3),
            format!("{:.3}", last.expelled),
            record.particles.to_string(),
            significant(record.seconds, 3),
        ]);
    }
    table
}

/// What must hold, and whether it does.
pub fn trends(runs: &[(Case, Record)]) -> String {
    let worst = runs
        .iter()
        .filter_map(|(_, record)| record.samples.last())
        .map(|last| (last.expelled - 1.0).abs())
        .fold(0.0, f64::max);
    let rises = |same: &dyn Fn(&Case, &Case) -> bool, by: &dyn Fn(&Case) -> f64| {
        let (mut pairs, mut rising) = (0, 0);
        for (a, first) in runs {
            for (b, second) in runs {
                if same(a, b) && by(a) < by(b) {
                    pairs += 1;
                    rising += usize::from(force(first) < force(second));
                }
            }
        }
        format!("{rising} of {pairs} pairs")
    };
    format!(
        "Expelled volume within {:.1} % of the loss of void (must be 2 %).\n\
         Force rises with viscosity in {}, with the density of the structure in {}.",
        1e2 * worst,
        rises(&|a, b| a.wall == b.wall, &|case| case.viscosity),
        rises(&|a, b| a.viscosity == b.viscosity, &|case| case.wall),
    )
}
