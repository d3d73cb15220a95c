//! What is said of crushed structures: stress over strain, sections, where the work has gone, and what must hold.
//! Energies are those of one cell's depth, twice what half of it has.

use super::crush::{CHOICES, Crushed};
use super::crushing::{Crushing, SECTIONS};
use meshfree::output::svg::{Axis, Cloud, Figure, Panel, Series, viridis};
use meshfree::output::table::{Table, significant};

type Runs = [(Crushed, Crushing)];

/// Stress and absorbed energy over strain.
pub fn figure(runs: &Runs) -> Figure {
    let panel = |name: &str, unit: &str, of: &dyn Fn(&super::crushing::Sample) -> f64| {
        let mut panel = Panel::new(
            Axis::linear("strain", "%"),
            Axis::linear(name, unit).from(0.0),
        );
        for (case, record) in runs {
            let points = record.samples.iter().map(|s| (1e2 * s.strain, of(s)));
            let fill = case
                .viscosity
                .map_or("empty".to_string(), |mu| format!("{mu:.0e} Pa s"));
            let label = format!("c {:.1} mm, {fill}", 1e3 * case.wall);
            let line = Series::line(&label, points).width(0.4 + 1200.0 * case.wall);
            panel = panel.series(match case.viscosity {
                None => line
                    .color(meshfree::output::svg::Color(120, 120, 120))
                    .dashed(),
                Some(mu) => line.color(viridis(0.85 * ((mu.log10() + 3.0) / 3.0).clamp(0.0, 1.0))),
            });
        }
        panel
    };
    Figure::new()
        .panel(panel("engineering stress", "MPa", &|s| 1e-6 * s.stress[0]))
        .panel(panel("work of the plate", "mJ", &|s| 2e3 * s.work))
        .columns(2)
        .shared_legend()
}

/// The structure, and the water, in planes of symmetry at the start, half-way and at the end.
pub fn sections(case: &Crushed, record: &Crushing) -> Figure {
    let mut figure = Figure::new().columns(SECTIONS.len());
    let most = |k: usize| {
        let values = record
            .sections
            .iter()
            .flat_map(|own| &own[k])
            .map(|own| own.2);
        let mut values: Vec<f64> = values.filter(|value| value.is_finite()).collect();
        values.sort_by(f64::total_cmp);
        // The colours end where all but a hundredth are.
        values
            .get(values.len().saturating_sub(1) * 99 / 100)
            .copied()
            .unwrap_or(1.0)
    };
    let names = [("plastic strain", ""), ("pressure", "MPa")];
    for (k, (name, unit)) in names.into_iter().enumerate() {
        if record.sections.iter().all(|own| own[k].is_empty()) {
            continue;
        }
        let most = most(k).max(1e-6);
        for (share, own) in SECTIONS.iter().zip(&record.sections) {
            let value = Axis::linear(name, unit).range(0.0, most);
            let cloud = Cloud::new(value, own[k].iter().copied()).diameter(1e3 * record.spacing);
            let [length, _, height] = case.size().map(|x| 1e3 * x);
            let panel = Panel::new(
                Axis::linear("x", "mm").range(0.0, 1.6 * length),
                Axis::linear("z", "mm").range(0.0, height),
            );
            let place = ["middle of the wall", "middle of the cell"][k];
            let title = format!("{place}, strain {:.0} %", 1e2 * share * case.strain);
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
        "initial stiffness [MPa]",
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
        "ledger",
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
        table.row([
            significant(1e3 * case.wall, 2),
            significant(record.relative_density, 3),
            case.viscosity
                .map_or("empty".into(), |mu| significant(mu, 1)),
            significant(1e-6 * record.stiffness(), 3),
            significant(1e-6 * record.plateau(), 3),
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

/// What the ledger leaves open of the work of the plate: without water all that it did not become; with it, what water
/// has gained from nothing, which no dissipation explains.
fn balance(record: &Crushing) -> f64 {
    let Some(last) = record.samples.last() else {
        return f64::NAN;
    };
    let open = if record.particles[1] == 0 {
        last.water[0].abs()
    } else {
        (-last.water[2]).max(0.0)
    };
    open / last.work
}

/// Work of the filled structure over that of the empty one, if that was run.
fn ratio(runs: &Runs, case: &Crushed, record: &Crushing) -> Option<f64> {
    case.viscosity?;
    let empty = runs
        .iter()
        .find(|(own, _)| own.wall == case.wall && own.viscosity.is_none())?;
    Some(record.energy() / empty.1.energy())
}

/// What must hold, and whether it does.
pub fn trends(runs: &Runs) -> String {
    let rises = |same: &dyn Fn(&Crushed, &Crushed) -> bool,
                 by: &dyn Fn(&Crushed) -> f64,
                 of: &dyn Fn(&Crushed, &Crushing) -> Option<f64>| {
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
        format!("{rising} of {pairs} pairs")
    };
    let wet = || runs.iter().filter(|(case, _)| case.viscosity.is_some());
    let volume = wet()
        .filter_map(|(_, record)| record.samples.last())
        .fold(0.0_f64, |worst, last| {
            worst.max((last.expelled / last.crushed - 1.0).abs())
        });
    let ledger = runs
        .iter()
        .fold(0.0_f64, |worst, (_, record)| worst.max(balance(record)));
    let density = |case: &Crushed| case.wall;
    let viscosity = |case: &Crushed| case.viscosity.unwrap_or(0.0);
    format!(
        "Stress at 10 to 20 % rises with the density of the structure in {}.\n\
         Work over that of the empty structure rises with density in {}, with viscosity in {}.\n\
         Expelled volume within {:.1} % of the crushed void (must be 2 %).\n\
         The ledger leaves {:.1e} of the work open (must be 0.01).\n",
        rises(
            &|a, b| a.viscosity == b.viscosity,
            &density,
            &|_, own| Some(own.plateau())
        ),
        rises(
            &|a, b| a.viscosity == b.viscosity,
            &density,
            &|case, own| ratio(runs, case, own)
        ),
        rises(&|a, b| a.wall == b.wall, &viscosity, &|case, own| ratio(
            runs, case, own
        )),
        1e2 * volume,
        ledger,
    )
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
