//! A study of runs that are made up, so that its answers are known.
//! Error floor + C dxᵖ and time A dx⁻ᵠ, by method.

use super::*;
use crate::simulation::Work;

/// Two methods, the second dearer and better, and a third that breaks on fine spacings.
fn made_up(case: &Case<'_>) -> core::result::Result<Outcome, Failure> {
    let dx = case.spacing();
    let (floor, factor, order, cost) = match case.text("kernel")? {
        "cubic" => (1e-3, 0.1, 1.0, 1e-4),
        "wide" => (0.0, 0.4, 2.0, 4e-4),
        _ if dx < 0.3 => return Err("the run has lost stability: by design".into()),
        _ => (0.0, 0.05, 1.0, 1e-5),
    };
    let seconds = cost * dx.powf(-2.0);
    let work = Work {
        particles: (1.0 / dx) as usize,
        steps: (10.0 / dx) as u64,
        time: Duration::from_secs_f64(seconds),
        ..Work::default()
    };
    let error = floor + factor * dx.powf(order);
    Ok(Outcome::from_work(work)
        .value("error", error)
        .value("period", 2.0 * (1.0 + error)))
}

fn report() -> Report {
    WorkPrecision::new("made \"up\"", made_up)
        .quantity(Quantity::measured("error"))
        .quantity(Quantity::exact("period", 2.0))
        .spacings([0.1, 0.8, 0.4, 0.2])
        .sweep("kernel", ["cubic", "wide", "breaks"])
        .run()
        .unwrap()
}

#[test]
fn answers_are_those_of_the_laws() {
    let report = report();
    // 0.01 = 0.4 dx²: 0.158, and 0.001 + 0.1 dx: 0.09, which is 1.1 times beyond the finest run.
    let one = report.for_error(0.01).unwrap();
    assert_eq!((one.method.as_str(), one.basis), ("cubic", Basis::Fitted));
    assert!(
        (one.spacing / 0.09 - 1.0).abs() < 0.02 && one.beyond > 1.0,
        "{one:?}"
    );
    assert!(
        (one.seconds.value / (1e-4 / 0.0081) - 1.0).abs() < 0.05,
        "{one}"
    );
    assert!(one.seconds.low < one.seconds.value && one.seconds.value < one.seconds.high);
    // Near the floor of the one, the other is cheaper.
    let fine = report.for_error(0.0014).unwrap();
    assert_eq!(fine.method, "wide");
    assert!((fine.spacing / 0.0592 - 1.0).abs() < 0.02, "{fine}");
    // Four times beyond 0.1 is 0.025, where the better method is at 0.00025.
    let why = report.for_error(1e-4).unwrap_err().to_string();
    assert!(
        why.contains("cubic: an error of 0.0100 % is not reachable by refinement")
            && why.contains("wide: it would take a spacing of"),
        "{why}"
    );
    // 1e-4 dx⁻², on 0.1 m.
    assert!(
        why.contains("(its finest run, on 0.100 m, took 0.0100 s)"),
        "{why}"
    );
    assert!(
        why.contains("breaks: a law") && why.contains("at least three spacings"),
        "{why}"
    );
    // The third has two runs: measured, not fitted.
    let coarse = report.for_error(0.03).unwrap();
    assert_eq!(
        (coarse.method.as_str(), coarse.basis),
        ("breaks", Basis::Measured)
    );
    let time = report.within(Duration::from_secs_f64(0.1)).unwrap();
    assert_eq!(time.method, "wide");
    assert!(
        (time.error.value / 0.0016 - 1.0).abs() < 0.02 && time.error.high > 0.0016,
        "{time}"
    );
    let view = report.first();
    assert!(matches!(view.price("wide"), Ok(fit) if (fit.order().value - 2.0).abs() < 0.02));
    let none = report
        .within(Duration::from_nanos(1))
        .unwrap_err()
        .to_string();
    assert!(none.contains("the cheapest run takes"), "{none}");
    // Both quantities are the same error here.
    let period = report.quantity("period").unwrap().for_error(0.01).unwrap();
    assert!((period.spacing / one.spacing - 1.0).abs() < 1e-6);
    assert!(
        report
            .quantity("mass")
            .unwrap_err()
            .to_string()
            .contains("error, period")
    );
}

#[test]
fn the_first_of_several_runs_warms_up() {
    let runs = std::sync::atomic::AtomicU32::new(0);
    let report = |repeats| {
        let study = WorkPrecision::new("cold at first", |_| {
            let before = runs.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
            let work = Work {
                time: Duration::from_secs(if before == 0 { 60 } else { 1 }),
                ..Work::default()
            };
            Ok(Outcome::from_work(work).value("error", 0.1))
        });
        let study = study.quantity(Quantity::measured("error"));
        study.spacings([0.1]).repeats(repeats).run().unwrap()
    };
    let twice = report(2);
    let row = &twice.rows()[0];
    assert_eq!((row.repeats, row.seconds, row.spread), (2, 1.0, [1.0; 2]));
    assert_eq!(runs.load(std::sync::atomic::Ordering::Relaxed), 3);
    // One run is that one, however cold.
    runs.store(0, std::sync::atomic::Ordering::Relaxed);
    assert_eq!(report(1).rows()[0].seconds, 60.0);
}

#[test]
fn work_between_runs_is_that_of_the_straight_line() {
    let report = report();
    let view = report.first();
    let steps = |method, error| view.work_at(method, Column::Steps, error);
    // 0.4 dx² between 0.2 and 0.1, where steps are 10/dx: a straight line in logarithms, so exact.
    let found = steps("wide", 0.4 * 0.15 * 0.15).unwrap();
    assert!((found * 0.15 / 10.0 - 1.0).abs() < 1e-12, "{found}");
    // Neither beyond the finest run nor before the coarsest, nor without a count.
    for error in [1e-4, 0.5] {
        let why = steps("wide", error).unwrap_err().to_string();
        assert!(why.contains("no two runs lie around"), "{why}");
    }
    assert!(view.work_at("wide", Column::Pairs, 0.01).is_err());
    assert!(steps("nothing", 0.01).is_err());
}

#[test]
fn laws_predict_the_finest_run() {
    let view = report();
    let predicted = view.first().predicted();
    assert_eq!(predicted.len(), 2, "the third has two runs");
    for one in predicted {
        let by_law = one.error.0.unwrap().value;
        assert!(
            (by_law / one.error.1 - 1.0).abs() < 0.02,
            "{by_law} {}",
            one.error.1
        );
        assert!((one.seconds.0.unwrap().value / one.seconds.1 - 1.0).abs() < 0.02);
    }
}

#[test]
fn nothing_is_dropped() {
    let report = report();
    assert_eq!(report.rows().len(), 12);
    let failed = report
        .rows()
        .iter()
        .filter(|row| matches!(row.status, Status::Failed(_)));
    assert_eq!(failed.count(), 2);
    let text = report.to_string();
    assert!(
        text.contains("failed: the run has lost stability"),
        "{text}"
    );
    let front: Vec<_> = report
        .first()
        .front()
        .into_iter()
        .map(|row| row.seconds)
        .collect();
    assert!(front.windows(2).all(|pair| pair[0] < pair[1]) && front.len() >= 3);
    let json = report.json();
    for (open, close) in [('{', '}'), ('[', ']')] {
        assert_eq!(json.matches(open).count(), json.matches(close).count());
    }
    assert!(json.contains(r#""study": "made \"up\"""#) && json.contains(r#""kernel": "wide""#));
    let svg = report.first().figure().to_string();
    assert!(
        svg.contains("failed") && svg.contains("wide (order 2.0"),
        "{svg}"
    );
    let path = std::env::temp_dir().join(format!("meshfree-study-{}.csv", std::process::id()));
    report.csv(&path).unwrap();
    let written = std::fs::read_to_string(&path).unwrap();
    assert!(!written.contains("NaN"), "{written}");
    let table = crate::output::csv::Csv::read(&path).unwrap();
    assert_eq!(table.column("steps").unwrap().len(), 12);
    std::fs::remove_file(path).unwrap();
}

#[test]
fn budgets_and_bad_studies_are_said() {
    let study = || WorkPrecision::new("late", made_up).sweep("kernel", ["cubic"]);
    let nothing = study().spacings([0.1]).run().unwrap_err().to_string();
    assert!(nothing.contains("no quantity"), "{nothing}");
    let study = || study().quantity(Quantity::measured("error"));
    assert!(study().run().is_err() && study().spacings([0.1, -1.0]).run().is_err());
    let mut seen = 0;
    let late = study()
        .spacings([0.1, 0.2])
        .budget(Duration::ZERO)
        .watch(|row| seen += usize::from(matches!(row.status, Status::NotRun(_))))
        .run()
        .unwrap();
    assert_eq!(seen, 2);
    assert!(late.to_string().contains("not run"));
    // A choice that is not there is a row that says so.
    let without = WorkPrecision::new("odd", made_up)
        .quantity(Quantity::measured("error"))
        .spacings([0.1])
        .sweep("viscosity", ["none"])
        .run()
        .unwrap();
    assert!(
        matches!(&without.rows()[0].status, Status::Failed(why) if why.contains("no choice called `kernel`"))
    );
}

#[test]
fn an_error_that_passes_through_zero_is_no_answer() {
    let report = WorkPrecision::new("luck", |case| {
        let dx = case.spacing();
        let work = Work {
            time: Duration::from_secs_f64(1e-4 / dx),
            ..Work::default()
        };
        Ok(Outcome::from_work(work).value("error", (dx - 0.21).abs()))
    })
    .quantity(Quantity::measured("error"))
    .spacings([0.8, 0.4, 0.2, 0.1])
    .run()
    .unwrap();
    // 0.59, 0.19, 0.01, 0.11
    assert!(report.first().fit("as it is").is_err());
    let found = report.for_error(0.15).unwrap();
    assert_eq!((found.basis, found.spacing), (Basis::Measured, 0.2));
    assert!((found.error.value - 0.11).abs() < 1e-12, "{found}");
    assert!(report.for_error(0.05).is_err());
    // Between 0.4 and 0.2, and not where the error of 0.01 has passed.
    let view = report.first();
    let time = view.work_at("as it is", Column::Seconds, 0.15).unwrap();
    assert!((1e-4 / 0.4..1e-4 / 0.2).contains(&time), "{time}");
    assert!(view.work_at("as it is", Column::Seconds, 0.05).is_err());
}

#[test]
fn times_follow_counted_pairs_and_not_what_small_runs_spend_beside_them() {
    // A nanosecond a pair of 10/dx³, and ten microseconds a step of 10/dx.
    let seconds = |dx: f64| 1e-8 * dx.powi(-3) + 1e-4 / dx;
    let report = WorkPrecision::new("made up", |case| {
        let dx = case.spacing();
        let work = Work {
            pairs: (10.0 * dx.powi(-3)).round() as u64,
            time: Duration::from_secs_f64(seconds(dx)),
            ..Work::default()
        };
        Ok(Outcome::from_work(work).value("error", dx))
    })
    .quantity(Quantity::measured("error"))
    .spacings([0.04, 0.02, 0.01, 0.005])
    .run()
    .unwrap();
    let price = report.first().price("as it is").unwrap();
    assert!((price.order().value - 3.0).abs() < 1e-3, "{price:?}");
    for dx in [0.002, 0.00126] {
        let (own, exact) = (price.at(1.0 / dx).unwrap(), seconds(dx));
        assert!((own.value / exact - 1.0).abs() < 0.3, "{own:?} {exact}");
        assert!(own.low < exact && exact < own.high, "{own:?} {exact}");
        let back = price.inverse(own.value).unwrap();
        assert!((back * dx - 1.0).abs() < 1e-9, "{back}");
    }
    assert!(
        price.at(1000.0).is_err() && price.inverse(1e9).is_err() && price.inverse(1e-9).is_err()
    );
}
