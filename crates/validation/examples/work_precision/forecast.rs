//! What the first steps of a run predict of the rest, against the rest.
//! Scenes of the other problems, in sizes of their own.

use super::{liquids, rods};
use meshfree::output::table::{Table, significant};
use meshfree::prelude::*;
use meshfree::study::cost_model::CostModel;
use meshfree::study::work_precision::Failure;
use std::time::Duration;

/// A row: what was predicted after so long, over what came.
fn hold<T: Real, const D: usize>(
    table: &mut Table,
    name: &str,
    mut simulation: Simulation<T, D>,
    end: f64,
    watch: Duration,
) -> Result<(), Failure> {
    let mut model = CostModel::new();
    model.watch(&mut simulation, end, watch)?;
    let forecast = model.forecast(end)?;
    let (before, at) = (simulation.work(), simulation.time());
    simulation.run_until(end)?;
    let after = simulation.work();
    let ratio = |predicted: f64, came: f64| format!("{:.3}", predicted / came);
    let seconds = after.time.saturating_sub(before.time).as_secs_f64();
    table.row([
        name.to_string(),
        after.particles.to_string(),
        significant(100.0 * at / end, 2),
        significant(seconds, 3),
        ratio(forecast.seconds, seconds),
        ratio(forecast.steps, (after.steps - before.steps) as f64),
        ratio(forecast.pairs, (after.pairs - before.pairs) as f64),
        ratio(forecast.bytes as f64, after.bytes as f64),
    ]);
    Ok(())
}

/// The table of all scenes.
pub fn table(quick: bool) -> Result<Table, Failure> {
    let mut table = Table::new([
        "scene",
        "particles",
        "watched [%]",
        "rest [s]",
        "time, predicted over measured",
        "steps",
        "pairs",
        "memory",
    ]);
    let watch = Duration::from_millis(if quick { 10 } else { 500 });
    for (target, dx) in [("copper", 1.25e-5), ("pmma", 2.5e-5)] {
        let dx = if quick { 4e-4 } else { dx };
        let scene = rods::scene::<f64>(schemes::impact().compose(), dx, target)?;
        hold(
            &mut table,
            &format!("rods, {target}"),
            scene.build()?,
            rods::END,
            watch,
        )?;
    }
    for (n, end) in [(48, 1.0), (160, 0.1)] {
        let n = if quick { 10 } else { n };
        let water = liquids::plain(1.0 / f64::from(n), 0.5)?;
        hold(&mut table, "water at rest", water, end, watch)?;
    }
    Ok(table)
}
