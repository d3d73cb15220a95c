//! What a dam break must meet, and whether it does.
//! Measured numbers are quoted from the papers; bounds are those of the crate's issue list.

use super::common::Failure;
use super::figures::{MARTIN_MOYCE_FRONT, VOLUME_OF_FLUID_H2, VOLUME_OF_FLUID_P1};
use super::flat::Flat;
use super::violent::{Bar, Choices, History, print_bars};

/// Slope of a line through points, by least squares.
fn slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let (mx, my) = points
        .iter()
        .fold((0.0, 0.0), |(a, b), (x, y)| (a + x / n, b + y / n));
    let (xy, xx) = points.iter().fold((0.0, 0.0), |(a, b), (x, y)| {
        (a + (x - mx) * (y - my), b + (x - mx) * (x - mx))
    });
    xy / xx
}

/// The plane cases.
pub fn flat(case: &Flat, history: &History, choices: &Choices) -> Result<(), Failure> {
    let units = case.units()?;
    let mut bars = vec![Bar::between(
        "particles over half a spacing deep in walls",
        history.lost as f64,
        0.0,
        0.0,
    )];
    let mut front = |what: &str, measured: &[(f64, f64)]| {
        let place = |t: f64| history.at("front_m", t * units.front_time_unit()) / units.width();
        // Until the front meets the far wall, or the run ends.
        let free = 0.97 * case.tank[0] / units.width();
        let late: Vec<_> = measured
            .iter()
            .copied()
            .filter(|(t, _)| *t > 1.15 && place(*t) < free)
            .collect();
        let computed: Vec<_> = late.iter().map(|(t, _)| (*t, place(*t))).collect();
        let wanted = slope(&late);
        bars.push(Bar::near(what, slope(&computed), wanted, 0.05 * wanted));
        for (place, measured) in computed.iter().zip(&late).step_by(4) {
            println!(
                "T = {:.2}: front {:.3}, measured {:.3}",
                place.0, place.1, measured.1
            );
        }
    };
    match case.name {
        "martin-moyce" => front("slope of the front dZ/dT", &MARTIN_MOYCE_FRONT),
        "koshizuka" => {
            for (file, columns, unit) in [
                ("koshizuka_oka_1996_pysph.csv", ["T", "Z"], 1.0),
                // A column one metre wide at g = 9.81.
                (
                    "koshizuka_oka_1996_dualsphysics.csv",
                    ["time_s", "x_m"],
                    19.62_f64.sqrt(),
                ),
                ("koshizuka_oka_1996_mps.csv", ["T", "Z"], 1.0),
            ] {
                if let Some(record) = choices.records.read(&format!("dambreak2d_front/{file}")) {
                    let times = record.column(columns[0])?.into_iter().map(|t| t * unit);
                    let points: Vec<_> = times.zip(record.column(columns[1])?).collect();
                    front(&format!("slope of the front dZ/dT, {file}"), &points);
                }
            }
        }
        _ => lobovsky(case, history, choices, &mut bars)?,
    }
    let title = format!(
        "{}, spacing {:.2} mm, {}",
        case.name,
        1e3 * case.spacing,
        choices.scheme
    );
    print_bars(&title, &bars);
    Ok(())
}

/// Lobovský et al. 2014: sensor 2 over 100 runs, the others in a single record.
fn lobovsky(
    case: &Flat,
    history: &History,
    choices: &Choices,
    bars: &mut Vec<Bar>,
) -> Result<(), Failure> {
    let units = case.units()?;
    let (time, unit) = (
        units.pressure_time_unit(),
        units.pressure_unit(case.density),
    );
    let smooth = history.smoothed(1e-3);
    let arrival = smooth.first_above("p1_pa", 0.2 * unit, 0.0) / time;
    bars.push(Bar::near("arrival at sensor 1, T", arrival, 2.43, 0.05));
    let (_, peak1) = smooth.peak("p1_pa", 0.0, 3.0 * time);
    let (when, peak) = smooth.peak("p2_pa", 0.0, 3.0 * time);
    bars.push(Bar::between(
        "first peak of sensor 2",
        peak / unit,
        1.77,
        2.03,
    ));
    bars.push(Bar::near("its time, T", when / time, 2.60, 0.1));
    let longer = history.smoothed(8e-3);
    let (_, mean) = longer.peak("p2_pa", 0.0, 3.0 * time);
    bars.push(Bar::between(
        "the same as a mean over 8 ms",
        mean / unit,
        1.77,
        2.03,
    ));
    let (_, peak3) = smooth.peak("p3_pa", 0.0, 3.2 * time);
    bars.push(Bar::near("first peak of sensor 3", peak3 / unit, 1.52, 0.2));
    println!("sensor 1 peak {:.2} (single record 2.84)", peak1 / unit);
    let until = history.time.last().map_or(0.0, |end| end / time);
    if until > 4.6 {
        let level = |name: &str| history.mean(name, 3.6 * time, 4.6 * time) / unit;
        let what = "mean of sensor 2, T = 3.6 to 4.6";
        bars.push(Bar::near(what, level("p2_pa"), 0.59, 0.05 * 0.59));
        for (name, what, file) in [
            (
                "p2_pa",
                "the same, against De Courcy et al. 2024",
                "decourcy_2024_P2.csv",
            ),
            (
                "p5_pa",
                "mean at 0.2 h, against Buchner 2002",
                "buchner_2002.csv",
            ),
        ] {
            if let Some(record) = choices.records.read(&format!("dambreak2d_pressure/{file}")) {
                let rows = record.column("T")?.into_iter().zip(record.column("P")?);
                let late: Vec<f64> = rows
                    .filter(|(t, _)| (3.6..4.6).contains(t))
                    .map(|(_, p)| p)
                    .collect();
                let other = late.iter().sum::<f64>() / late.len() as f64;
                bars.push(Bar::near(what, level(name), other, 0.05 * other));
            }
        }
        let level4 = history.mean("p4_pa", 3.4 * time, 4.4 * time) / unit;
        bars.push(Bar::near(
            "mean of sensor 4, T = 3.4 to 4.4",
            level4,
            0.56,
            0.05,
        ));
    }
    if until > 7.0 {
        let (second, height) = smooth.peak("p2_pa", 5.0 * time, 7.0 * time);
        bars.push(Bar::near("second event, T", second / time, 6.0, 0.3));
        println!("second event {:.2} (0.85)", height / unit);
    }
    Ok(())
}

/// SPHERIC 2: numbers of the record of Kleefsman et al. 2005, of which H1 and H3 are exchanged, and their computation.
pub fn obstacle(history: &History, spacing: f64, choices: &Choices) -> Result<(), Failure> {
    // Time, H2 and H4 in metres.
    const HEIGHTS: [(f64, f64, f64); 9] = [
        (0.5, 0.099, 0.426),
        (1.0, 0.179, 0.279),
        (1.5, 0.236, 0.182),
        (2.0, 0.287, 0.130),
        (2.5, 0.281, 0.104),
        (3.0, 0.203, 0.202),
        (4.0, 0.136, 0.332),
        (5.0, 0.252, 0.233),
        (6.0, 0.214, 0.186),
    ];
    // Means of P1 over a tenth of a second around these times, in pascals.
    const DECAY: [(f64, f64); 4] = [(1.0, 3036.0), (2.0, 3055.0), (3.0, 1836.0), (4.0, 1246.0)];
    let computed = |what: &str| format!("{what}, against their computation");
    let until = history.time.last().copied().unwrap_or(0.0);
    let mut bars = vec![Bar::between(
        "particles over half a spacing deep in walls",
        history.lost as f64,
        0.0,
        0.0,
    )];
    for (t, h2, h4) in HEIGHTS.into_iter().filter(|(t, ..)| *t < until) {
        let mean = |name: &str| history.mean(name, t - 0.02, t + 0.02);
        let what = format!("H2 at {t} s");
        bars.push(Bar::near(&format!("{what} [m]"), mean("h2_m"), h2, 0.03));
        if let Some((_, other)) = VOLUME_OF_FLUID_H2.into_iter().find(|own| own.0 == t) {
            bars.push(Bar::near(&computed(&what), mean("h2_m"), other, 0.03));
        }
        if t <= 2.5 {
            let what = format!("H4 at {t} s [m]");
            bars.push(Bar::near(&what, mean("h4_m"), h4, 0.0165));
        }
    }
    if let Some(record) = choices
        .records
        .read("spheric02_dambreak3d/water_heights.csv")
    {
        let measured = record
            .column("time_s")?
            .into_iter()
            .zip(record.column("H2")?);
        for end in [2.5, 6.0].into_iter().filter(|end| *end <= until + 0.01) {
            let squares: Vec<f64> = measured
                .clone()
                .filter(|(t, _)| *t < end - 0.01)
                .map(|(t, h)| (history.at("h2_m", t) - h).powi(2))
                .filter(|square| square.is_finite())
                .collect();
            let deviation = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
            let what = format!("H2, root mean square deviation until {end} s [m]");
            bars.push(Bar::between(&what, deviation, 0.0, 0.03));
        }
    }
    let smooth = history.smoothed(5e-3);
    let arrival = history.first_above("p1_pa", 500.0, 0.0);
    bars.push(Bar::near("arrival at P1 [s]", arrival, 0.393, 0.02));
    // As the mean around a point, and as force over area, of which the floor takes a share.
    const FIRST: [(&str, &str); 2] = [("P1", "p1_pa"), ("P1 by force", "p1_contact_pa")];
    for (name, column) in FIRST {
        let (_, peak) = smooth.peak(column, 0.0, 0.7);
        let what = format!("peak of {name}, mean over 5 ms [Pa]");
        bars.push(Bar::near(&what, peak, 10_620.0, 0.2 * 10_620.0));
    }
    let (_, peak) = smooth.peak("p1_pa", 0.0, 0.7);
    let other = VOLUME_OF_FLUID_P1[0].1;
    let what = computed("peak of P1, mean over 5 ms");
    bars.push(Bar::near(&what, peak, other, 0.2 * other));
    // A particle takes seven milliseconds to arrive at 18 mm: what is left when single ones are averaged out.
    for (window, measured) in [
        (0.01, 10_099.0),
        (0.02, 9860.0),
        (0.04, 9367.0),
        (0.08, 8543.0),
    ] {
        let wide = history.smoothed(window);
        let [mean, force] = FIRST.map(|(_, column)| wide.peak(column, 0.0, 0.75).1);
        println!(
            "peak of P1, mean over {:.0} ms: {mean:.0} Pa, by force {force:.0} Pa, measured {measured} Pa",
            1e3 * window
        );
    }
    for (k, wanted) in [(2, 8130.0), (3, 6560.0), (4, 7200.0)] {
        let (_, peak) = smooth.peak(&format!("p{k}_pa"), 0.0, 0.7);
        println!("peak of P{k}: {peak:.0} Pa, measured {wanted} Pa");
    }
    for (t, p) in DECAY.into_iter().filter(|(t, _)| *t < until) {
        let mean = |column: &str| history.mean(column, t - 0.05, t + 0.05);
        for (name, column) in FIRST {
            let what = format!("{name} at {t} s [Pa]");
            bars.push(Bar::near(&what, mean(column), p, 0.15 * p));
        }
        if let Some((_, other)) = VOLUME_OF_FLUID_P1.into_iter().find(|own| own.0 == t) {
            let what = computed(&format!("P1 at {t} s"));
            bars.push(Bar::near(&what, mean("p1_pa"), other, 0.15 * other));
        }
    }
    let title = format!(
        "SPHERIC 2, spacing {:.1} mm, {}",
        1e3 * spacing,
        choices.scheme
    );
    print_bars(&title, &bars);
    Ok(())
}
