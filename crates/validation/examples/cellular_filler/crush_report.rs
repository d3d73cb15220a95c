//! What is said of crushed structures: stress over strain, sections, where the work has gone, and what must hold.
//! Energies are those of one cell's depth, twice what half of it has.

use super::crush::{CHOICES, Crushed};
use super::crushing::{Crushing, SECANTS, SECTIONS, Sample};
use meshfree::output::svg::{Axis, Cloud, Color, Figure, Panel, Series, viridis};
use meshfree::output::table::{Table, significant};

type Runs = [(Crushed, Crushing)];

/// Stress and work over strain, and what the water adds to the stress where a structure was crushed filled and empty.
pub fn figure(runs: &Runs) -> Figure {
    let axes =
        |name: &str, unit: &str| Panel::new(Axis::linear("strain", "%"), Axis::linear(name, unit));
    let line = |case: &Crushed, points: Vec<(f64, f64)>| {
        let fill = case
            .viscosity
            .map_or("empty".to_string(), |mu| format!("{mu:.0e} Pa s"));
        let label = format!("c {:.1} mm, {fill}", 1e3 * case.wall);
        let line = Series::line(&label, points).width(0.4 + 1200.0 * case.wall);
        match case.viscosity {
            None => line.color(Color(120, 120, 120)).dashed(),
            Some(mu) => line.color(viridis(0.85 * ((mu.log10() + 3.0) / 3.0).clamp(0.0, 1.0))),
        }
    };
    let panel = |name: &str, unit: &str, of: &dyn Fn(&Sample) -> f64| {
        runs.iter().fold(axes(name, unit), |panel, (case, record)| {
            let points = record.samples.iter().map(|s| (1e2 * s.strain, of(s)));
            panel.series(line(case, points.collect()))
        })
    };
    let mut figure = Figure::new()
        .panel(panel("engineering stress", "MPa", &|s| 1e-6 * s.stress[0]))
        .panel(panel("work of the plate", "mJ", &|s| 2e3 * s.work));
    let pairs: Vec<_> = (runs.iter())
        .filter_map(|(case, record)| Some((case, record, empty(runs, case)?)))
        .collect();
    if !pairs.is_empty() {
        let mut panel = axes("stress filled less empty", "MPa").mark_y(0.0);
        for (case, record, empty) in pairs {
            let both = record.samples.iter().zip(&empty.samples);
            let points = both.map(|(s, e)| (1e2 * s.strain, 1e-6 * (s.stress[0] - e.stress[0])));
            panel = panel.series(line(case, points.collect()));
        }
        figure = figure.panel(panel);
    }
    figure.columns(3).shared_legend()
}

/// The run of the empty structure with the walls of a filled one, if there is one.
fn empty<'a>(runs: &'a Runs, case: &Crushed) -> Option<&'a Crushing> {
    case.viscosity?;
    let empty = (runs.iter()).find(|(own, _)| own.wall == case.wall && own.viscosity.is_none());
    empty.map(|(_, record)| record)
}

/// Structure, water and plates in the middle of the cell, and structure and plates in the middle of a wall, at several strains.
pub fn sections(case: &Crushed, record: &Crushing) -> Figure {
    let mut figure = Figure::new().columns(SECTIONS.len());
    let most = |k: usize| {
        let all = record.sections.iter().flat_map(|own| &own[k]);
        let mut values: Vec<f64> = all.map(|own| own.2).filter(|v| v.is_finite()).collect();
        values.sort_by(f64::total_cmp);
        // The colours end where all but a hundredth are.
        let last = values.get(values.len().saturating_sub(1) * 99 / 100);
        last.copied().unwrap_or(0.0).max(1e-6)
    };
    let names = [("pressure of water", "MPa"), ("plastic strain", "")];
    let places = ["middle of the cell", "middle of a wall"];
    for (k, (name, unit)) in names.into_iter().enumerate() {
        let most = most(k);
        for (share, own) in SECTIONS.iter().zip(&record.sections) {
            let value = Axis::linear(name, unit).range(0.0, most);
            let cloud = Cloud::new(value, own[k].iter().copied()).diameter(1e3 * record.spacing);
            let [length, _, height] = case.size().map(|x| 1e3 * x);
            let plates = 1e3 * record.spacing * super::filler::LAYERS as f64;
            let panel = Panel::new(
                Axis::linear("x", "mm").range(0.0, 1.5 * length),
                Axis::linear("z", "mm").range(-plates, height + plates),
            );
            let title = format!("{}, strain {:.0} %", places[k], 1e2 * share * case.strain);
            figure = figure.panel(panel.cloud(cloud).equal_aspect().title(&title));
        }
    }
    figure
}

/// One row for each case.
pub fn table(runs: &Runs) -> Table {
    let mut table = Table::new([
        "c [mm]",
        "relative density",
        "water [Pa s]",
        "secant modulus at 1 % [MPa]",
        "at 2 % [MPa]",
        "stress at 10 to 20 % [MPa]",
        "work [mJ]",
        "over empty",
        "plastic",
        "elastic",
        "in polymer by viscosity",
        "kinetic",
        "water: work [mJ]",
        "water: dissipated [mJ]",
        "expelled over crushed",
        "energy from nothing",
        "particles",
        "steps",
        "time [s]",
    ]);
    for (case, record) in runs {
        let Some(last) = record.samples.last() else {
            continue;
        };
        let share = |energy: f64| format!("{:.1} %", 1e2 * energy / last.work);
        let ratio = ratio(runs, case, record).map_or(String::new(), |ratio| format!("{ratio:.3}"));
        let wet = case.viscosity.is_some();
        let of_water = |text: String| if wet { text } else { String::new() };
        // A short run does not reach every strain.
        let stress = |pa: f64| {
            let reached = Some(pa).filter(|pa| pa.is_finite());
            reached.map_or(String::new(), |pa| significant(1e-6 * pa, 3))
        };
        table.row([
            significant(1e3 * case.wall, 2),
            significant(record.relative_density, 3),
            case.viscosity
                .map_or("empty".into(), |mu| significant(mu, 1)),
            stress(record.secant(SECANTS[0])),
            stress(record.secant(SECANTS[1])),
            stress(record.plateau()),
            significant(1e3 * record.energy(), 4),
            ratio,
            share(last.plastic),
            share(last.elastic),
            share(last.viscous + last.hourglass),
            share(last.kinetic[0] + last.kinetic[1]),
            of_water(significant(2e3 * last.water[0], 3)),
            of_water(significant(2e3 * last.water[2], 3)),
            of_water(format!("{:.3}", last.expelled / last.crushed)),
            format!("{:.1e}", balance(record)),
            format!("{}", record.particles.iter().sum::<usize>()),
            record.steps.to_string(),
            significant(record.seconds, 3),
        ]);
    }
    table
}

/// What the ledger leaves open: without water, of the work of the plate all that it did not become; with it, of the work on
/// the water what no dissipation explains.
fn balance(record: &Crushing) -> f64 {
    match record.samples.last() {
        None => f64::NAN,
        Some(last) if record.particles[1] == 0 => last.water[0].abs() / last.work,
        Some(_) => record.gained(),
    }
}

/// Work of the filled structure over that of the empty one, if that was run.
fn ratio(runs: &Runs, case: &Crushed, record: &Crushing) -> Option<f64> {
    Some(record.energy() / empty(runs, case)?.energy())
}

/// What must hold, and whether it does. Of runs without a partner nothing is compared.
pub fn trends(runs: &Runs) -> String {
    type Of<'a> = &'a dyn Fn(&Crushed, &Crushing) -> Option<f64>;
    let mut text = String::new();
    let mut rises = |what: &str,
                     with: &str,
                     same: &dyn Fn(&Crushed, &Crushed) -> bool,
                     by: &dyn Fn(&Crushed) -> f64,
                     of: Of<'_>| {
        let (mut pairs, mut rising) = (0, 0);
        for (a, first) in runs {
            for (b, second) in runs {
                if let (Some(one), Some(two)) = (of(a, first), of(b, second))
                    && same(a, b)
                    && by(a) < by(b)
                {
                    pairs += 1;
                    rising += usize::from(one < two);
                }
            }
        }
        if pairs > 0 {
            text += &format!("{what} rises with {with} in {rising} of {pairs} pairs.\n");
        }
    };
    let fill = |a: &Crushed, b: &Crushed| a.viscosity == b.viscosity;
    let walls = |a: &Crushed, b: &Crushed| a.wall == b.wall;
    let filling =
        |a: &Crushed, b: &Crushed| walls(a, b) && a.viscosity.is_none() && b.viscosity.is_some();
    let thick = |a: &Crushed, b: &Crushed| walls(a, b) && a.viscosity.is_some();
    let density = |case: &Crushed| case.wall;
    let viscosity = |case: &Crushed| case.viscosity.unwrap_or(0.0);
    for (k, strain) in SECANTS.into_iter().enumerate() {
        let name = format!("Secant modulus at {:.0} %", 1e2 * strain);
        let secant =
            |_: &Crushed, own: &Crushing| Some(own.secant(SECANTS[k])).filter(|e| e.is_finite());
        rises(
            &name,
            "the density of the structure",
            &fill,
            &density,
            &secant,
        );
        rises(&name, "water", &filling, &viscosity, &secant);
        rises(&name, "viscosity", &thick, &viscosity, &secant);
    }
    let plateau = |_: &Crushed, own: &Crushing| Some(own.plateau()).filter(|own| own.is_finite());
    rises(
        "Stress at 10 to 20 %",
        "the density of the structure",
        &fill,
        &density,
        &plateau,
    );
    let ratio = |case: &Crushed, own: &Crushing| ratio(runs, case, own);
    let name = "Work over that of the empty structure";
    rises(name, "density", &fill, &density, &ratio);
    rises(name, "viscosity", &walls, &viscosity, &ratio);
    let wet = runs.iter().filter(|(case, _)| case.viscosity.is_some());
    let volumes = wet.filter_map(|(_, record)| record.samples.last());
    let volume = volumes.map(|last| (last.expelled / last.crushed - 1.0).abs());
    if let Some(volume) = volume.reduce(f64::max) {
        text += &format!(
            "Expelled volume within {:.1} % of the crushed void (must be 2 %).\n",
            1e2 * volume
        );
    }
    for (filled, what) in [(false, "of the plate"), (true, "on the water")] {
        let some = runs
            .iter()
            .filter(|(case, _)| case.viscosity.is_some() == filled);
        if let Some(open) = some.map(|(_, record)| balance(record)).reduce(f64::max) {
            text +=
                &format!("The ledger leaves {open:.1e} of the work {what} open (must be 0.01).\n");
        }
    }
    text
}

/// One run in words.
pub fn text(case: &Crushed, record: &Crushing) -> String {
    let runs = [(case.clone(), record.clone())];
    let mut text = format!(
        "{CHOICES}\n\n{} at a spacing of {:.4} mm, {} particles of the structure and {} of water\n\n{}\n",
        case.name(),
        1e3 * record.spacing,
        record.particles[0],
        record.particles[1],
        table(&runs).markdown(),
    );
    for (bodies, depth, pairs) in &record.contacts {
        text += &format!(
            "contact of {bodies}: {pairs} pairs act at the end, deepest {depth:.3} spacings\n"
        );
    }
    if case.viscosity.is_some() {
        let [inside, beyond] = record.leaked;
        text += &format!(
            "water at the end: {inside} particles in the structure, {beyond} beyond the plates\n"
        );
    }
    for (name, count) in &record.limits {
        text += &format!("{name}: {count}\n");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A run to 5 % whose stress is a line over strain \[Pa\], and in which water dissipates and then gains \[J\].
    fn run(viscosity: Option<f64>, modulus: f64) -> (Crushed, Crushing) {
        let case = Crushed {
            wall: 1.5e-3,
            viscosity,
            cells: 1,
            spacing: 2.5e-4,
            strain: 0.05,
        };
        let sample = |k: u32| {
            let strain = 3e-3 * f64::from(k);
            Sample {
                strain,
                stress: [modulus * strain; 3],
                work: strain,
                water: [1e-2 * strain, 0.0, if k < 8 { 1e-4 } else { 4e-5 }],
                ..Sample::default()
            }
        };
        let record = Crushing {
            samples: (1..=16).map(sample).collect(),
            particles: [10, usize::from(viscosity.is_some())],
            ..Crushing::default()
        };
        (case, record)
    }

    #[test]
    fn a_single_run_is_compared_with_nothing() {
        let alone = trends(&[run(Some(1e-3), 4e8)]);
        assert!(!alone.contains("pairs"), "{alone}");
        let both = trends(&[run(None, 3e8), run(Some(1e-3), 4e8)]);
        let rises = "Secant modulus at 1 % rises with water in 1 of 1 pairs.";
        assert!(both.contains(rises), "{both}");
        let falls = trends(&[run(None, 4e8), run(Some(1e-3), 3e8)]);
        assert!(falls.contains("in 0 of 1 pairs"), "{falls}");
    }

    #[test]
    fn what_water_gains_is_held_against_its_own_work() {
        let (_, record) = run(Some(1e-3), 4e8);
        approx::assert_relative_eq!(record.secant(0.01), 4e8, max_relative = 1e-12);
        approx::assert_relative_eq!(record.gained(), 6e-5 / 4.8e-4, max_relative = 1e-12);
    }
}
