//! Runs: schedules show what they say and change no bit, criteria end a run where theory says and say why, and what makes no
//! sense is refused by name.

use approx::{assert_abs_diff_eq, assert_relative_eq};
use meshfree::prelude::*;
use meshfree::run::{End, Run, Schedule, Stop};
use std::time::Duration;

const LENGTH: f64 = 0.01;
const END: f64 = 6e-6;

/// A copper rod that flies against a wall: steps of some 4e-8 s.
fn scene() -> Scene<f64, 1> {
    Scene::<f64, 1>::new(schemes::impact())
        .body(Body::block("rod", catalogue::copper(), [0.0], [LENGTH], 2e-4).velocity([20.0]))
        .boundary(MirrorPlane::wall([LENGTH], [1.0]))
        .event("late", |now: &Simulation<f64, 1>| now.time() > 2e-6)
}

fn rod() -> Simulation<f64, 1> {
    scene().build().unwrap()
}

/// The times at which a schedule shows a run.
fn times(schedule: Schedule) -> Vec<f64> {
    let mut times = Vec::new();
    let mut rod = rod();
    let show = |now: &Simulation<f64, 1>| {
        times.push(now.time());
        Ok(())
    };
    Run::new(&mut rod, END)
        .observe(schedule, show)
        .go()
        .unwrap();
    times
}

#[test]
fn schedules_show_what_they_say() {
    let all = times(Schedule::every(1.3e-6));
    assert_eq!(all, [0.0, 1.3e-6, 2.0 * 1.3e-6, 3.0 * 1.3e-6, 4.0 * 1.3e-6]);
    let given = [5e-6, 1e-9, 1e-9, 7.0, -1.0];
    assert_eq!(times(Schedule::at(given)), [1e-9, 5e-6]);
    assert_eq!(times(Schedule::evenly(3)), [0.0, 3e-6, END]);
    assert_eq!(times(Schedule::end()), [END]);
    // What falls on one instant is shown once.
    let both = Schedule::every(3e-6).and(Schedule::evenly(3));
    assert_eq!(times(both.and(Schedule::end())), [0.0, 3e-6, END]);
    let mut steps = Vec::new();
    rod().run_with(END, |now| steps.push(now.time())).unwrap();
    // The last of these is a reading.
    assert_eq!(times(Schedule::steps(1)), steps[..steps.len() - 1]);
    let third: Vec<f64> = steps[..steps.len() - 1]
        .chunks_exact(3)
        .map(|own| own[2])
        .collect();
    assert_eq!(times(Schedule::steps(3)), third);
    let first = *steps.iter().find(|time| **time > 2e-6).unwrap();
    assert_eq!(times(Schedule::on("late")), [first]);
}

#[test]
fn a_run_in_parts_shows_no_time_twice() {
    let (mut rod, mut all) = (rod(), Vec::new());
    for end in [2e-6, 2e-6, 3.5e-6, END] {
        let show = |now: &Simulation<f64, 1>| {
            all.push(now.time());
            Ok(())
        };
        let schedule = Schedule::every(1e-6).and(Schedule::on("late"));
        Run::new(&mut rod, end)
            .observe(schedule, show)
            .go()
            .unwrap();
    }
    let late = rod.event("late").unwrap().unwrap();
    let at = |k: f64| k * 1e-6;
    let expected = [0.0, at(1.0), at(2.0), late, at(3.0), at(4.0), at(5.0), END];
    assert_eq!(all, expected);
}

#[test]
fn schedules_and_criteria_change_no_bit_and_cuts_do() {
    let mut plain = rod();
    plain.run_until(END).unwrap();
    for interval in [1e-6, 1.7e-7, 1e-8] {
        let mut read = rod();
        let mut shown = 0;
        Run::new(&mut read, END)
            .observe(Schedule::every(interval), |now| {
                shown += usize::from(now.ledger().time == now.time());
                Ok(())
            })
            .observe(Schedule::evenly(12).and(Schedule::steps(5)), |_| Ok(()))
            .stop(Stop::steady(1e-30, 1e-6))
            .stop(Stop::wall_clock(Duration::from_secs(3600)))
            .go()
            .unwrap();
        assert_eq!(shown, (END / interval * (1.0 + 1e-12)) as usize + 1);
        assert_eq!(read.bits_hash(), plain.bits_hash(), "every {interval} s");
        assert_eq!(read.work().pairs, plain.work().pairs);
    }
    // The control: steps that are cut at these times.
    let mut cut = rod();
    for k in 1..=6 {
        let time = 1e-6 * f64::from(k);
        while time - cut.time() > 1e-18 {
            cut.step_at_most(time - cut.time()).unwrap();
        }
    }
    assert_abs_diff_eq!(cut.time(), END, epsilon = 1e-17);
    assert_ne!(cut.bits_hash(), plain.bits_hash());
}

#[test]
fn criteria_end_a_run_where_theory_says_and_whoever_reads_it() {
    // The wave from the wall has brought all to rest when it reaches the free end.
    let arrival = LENGTH / 3940.0;
    let ended = |interval: Option<f64>| {
        let mut rod = rod();
        let schedule = interval.map_or(Schedule::end(), Schedule::every);
        let mut last = 0.0;
        let run = Run::new(&mut rod, 1e-5).observe(schedule, |now| {
            last = now.time();
            Ok(())
        });
        let summary = run.stop(Stop::at_rest(0.05, 1e-7)).go().unwrap();
        assert!(interval.is_some() || last == rod.time(), "the end is shown");
        (rod.time(), rod.bits_hash(), summary)
    };
    let (time, bits, summary) = ended(None);
    assert_relative_eq!(time, arrival, max_relative = 0.12);
    let text = summary.to_string();
    assert!(
        text.contains("ended early by at rest: the kinetic energy was"),
        "{text}"
    );
    for interval in [1e-6, 3e-9] {
        let other = ended(Some(interval));
        assert_eq!((other.0, other.1), (time, bits), "every {interval} s");
        assert_eq!(other.2.end, summary.end);
    }
    // The kinetic energy falls and rises again until the rod flies off, at twice that time, as fast as it came. A window in
    // which little can change finds that steady too soon.
    let steady = |over: f64| {
        let mut rod = rod();
        let first = rod.kinetic_energy();
        let stop = Stop::steady(0.1, over);
        let summary = Run::new(&mut rod, 1e-4).stop(stop).go().unwrap();
        assert!(summary.end.is_early());
        (rod.time(), rod.kinetic_energy() / first)
    };
    let (time, left) = steady(1e-6);
    assert!(left > 0.8, "{left}");
    assert_relative_eq!(time, 2.0 * arrival + 1e-6, max_relative = 0.15);
    assert!(steady(1e-7).0 < 0.2 * arrival);
    let probe = |now: &Simulation<f64, 1>| now.all().last().map_or(0.0, |own| own.pressure());
    let mut plateau = rod();
    let stop = Stop::steady_probe("pressure", probe, 1e6, 3e-7);
    let summary = Run::new(&mut plateau, 1e-5).stop(stop).go().unwrap();
    assert_relative_eq!(probe(&plateau), 709e6, max_relative = 0.02);
    assert!(matches!(&summary.end, End::Criterion { name, .. } if name == "pressure"));
}

#[test]
fn a_drift_of_energy_ends_a_run() {
    // Heat that a load brings: 1 MW/kg against 200 J/kg of motion, so 1 % is there after 2 µs.
    let scene = |heat: f64| scene().load(Load::heating(move |_| heat)).build().unwrap();
    let mut heated = scene(1e6);
    let summary = Run::new(&mut heated, END)
        .stop(Stop::energy_drift(0.01))
        .go()
        .unwrap();
    assert_relative_eq!(heated.time(), 2e-6, max_relative = 0.03);
    assert!(
        summary.end.to_string().contains("drift of energy"),
        "{}",
        summary.end
    );
    let mut not = scene(0.0);
    let summary = Run::new(&mut not, END)
        .stop(Stop::energy_drift(1e-9))
        .go()
        .unwrap();
    assert_eq!(summary.end, End::Time { end: END });
}

#[test]
fn the_wall_clock_ends_a_run_at_a_step_of_it() {
    let mut ended = rod();
    let stop = || Stop::wall_clock(Duration::from_millis(30));
    let summary = Run::new(&mut ended, 1.0).stop(stop()).go().unwrap();
    assert!(summary.end.is_early() && summary.seconds >= 0.03);
    let mut plain = rod();
    while plain.time() < ended.time() {
        plain.step().unwrap();
    }
    assert_eq!(plain.bits_hash(), ended.bits_hash());
}

/// A run with something more.
type Changed = fn(Run<'_, f64, 1>) -> Run<'_, f64, 1>;

#[test]
fn failures_and_nonsense_are_named() {
    let refused = |run: Changed| {
        let mut rod = rod();
        let error = run(Run::new(&mut rod, END)).go().unwrap_err();
        assert_eq!(rod.steps(), 0, "{error}");
        error.to_string()
    };
    fn on(run: Run<'_, f64, 1>, schedule: Schedule) -> Run<'_, f64, 1> {
        run.observe(schedule, |_| Ok(()))
    }
    let cases: [(Changed, &str); 9] = [
        (
            |run| on(run, Schedule::every(0.0)),
            "interval of a schedule is 0: it must be positive",
        ),
        (
            |run| on(run, Schedule::every(f64::NAN)),
            "interval of a schedule is NaN",
        ),
        (|run| on(run, Schedule::every(1e-30)), "above rounding"),
        (
            |run| on(run, Schedule::at([f64::INFINITY])),
            "time of a schedule is inf",
        ),
        (
            |run| on(run, Schedule::evenly(1)),
            "number of times of a schedule is 1: take two",
        ),
        (
            |run| on(run, Schedule::steps(0)),
            "number of steps of a schedule is 0",
        ),
        (
            |run| on(run, Schedule::on("later")),
            "no event called `later`: the scene has late",
        ),
        (
            |run| run.stop(Stop::steady(-0.1, 1.0)),
            "share of the kinetic energy of the criterion `steady` is -0.1: it must be positive",
        ),
        (
            |run| run.stop(Stop::at_rest(0.1, f64::NAN)),
            "window of the criterion `at rest` is NaN",
        ),
    ];
    for (run, says) in cases {
        let text = refused(run);
        assert!(text.contains(says), "{text}");
    }
    assert!(matches!(
        Run::new(&mut rod(), f64::NAN).go(),
        Err(Error::Argument(_))
    ));
    let water = catalogue::weakly_compressible_water(1.0);
    let mut water = Scene::<f64, 2>::new(schemes::weakly_compressible())
        .body(Body::block("water", water, [0.0; 2], [0.1; 2], 0.02))
        .build()
        .unwrap();
    let error = Run::new(&mut water, 1.0)
        .stop(Stop::energy_drift(0.1))
        .go()
        .unwrap_err();
    assert!(
        error.to_string().contains("bodies without internal energy"),
        "{error}"
    );
    // An observer fails on the way: what was shown before stays, and the simulation can go on.
    let (mut failing, mut shown) = (rod(), 0);
    let error = Run::new(&mut failing, END)
        .observe(Schedule::every(1e-6), |now| {
            if now.time() > 1.5e-6 {
                Err("the disk is full")?;
            }
            shown += 1;
            Ok(())
        })
        .go()
        .unwrap_err();
    let text = error.to_string();
    assert!(
        text.contains("every 0.000001 s failed at t = 0.000002 s: the disk is full"),
        "{text}"
    );
    assert_eq!(shown, 2);
    failing.run_until(END).unwrap();
    let mut plain = rod();
    plain.run_until(END).unwrap();
    assert_eq!(plain.bits_hash(), failing.bits_hash());
    let stop = Stop::when("probe", |_| Err("no probe".into()));
    let error = Run::new(&mut failing, 2.0 * END)
        .stop(stop)
        .go()
        .unwrap_err();
    assert!(
        error.to_string().contains("the criterion `probe` failed"),
        "{error}"
    );
}

/// Takes a JSON value (RFC 8259) off the front of a text.
fn take_value(text: &mut &str) {
    let first = text.chars().next().expect("a value");
    let close = match first {
        '{' => '}',
        '[' => ']',
        '"' => {
            *text = &text[1..];
            while !text.starts_with('"') {
                *text = &text[if text.starts_with('\\') {
                    2
                } else {
                    text.chars().next().unwrap().len_utf8()
                }..];
            }
            *text = &text[1..];
            return;
        }
        _ => {
            let end = text.find([',', '}', ']', '\n']).expect("an end");
            let (own, rest) = text.split_at(end);
            assert!(
                ["null", "true", "false"].contains(&own) || own.parse::<f64>().is_ok(),
                "{own}"
            );
            *text = rest;
            return;
        }
    };
    *text = text[1..].trim_start();
    while !text.starts_with(close) {
        if close == '}' {
            take_value(text);
            *text = text.strip_prefix(':').expect("a colon").trim_start();
        }
        take_value(text);
        *text = text.trim_start();
        match text.strip_prefix(',') {
            Some(rest) => *text = rest.trim_start(),
            None => assert!(text.starts_with(close), "{text}"),
        }
    }
    *text = &text[1..];
}

/// A number behind a name in a line of a receipt.
fn number(text: &str, line: &str, name: &str) -> f64 {
    let line = text
        .lines()
        .find(|own| own.trim_start().starts_with(&format!("\"{line}\":")))
        .unwrap();
    let value = line.split(&format!("\"{name}\": ")).nth(1).unwrap();
    value.split([',', '}']).next().unwrap().parse().unwrap()
}

#[test]
fn a_receipt_says_what_was_run_and_what_it_took() {
    let folder = std::env::temp_dir().join(format!("meshfree-receipts-{}", std::process::id()));
    let path = folder.join("receipt.json");
    let (mut plain, mut run) = (rod(), rod());
    plain.run_until(END).unwrap();
    let summary = Run::new(&mut run, END)
        .label("a \"rod\"")
        .receipt(&path)
        .go()
        .unwrap();
    assert_eq!(
        run.bits_hash(),
        plain.bits_hash(),
        "the rehearsal changes no bit"
    );
    let text = std::fs::read_to_string(&path).unwrap();
    let mut rest = text.as_str();
    take_value(&mut rest);
    assert_eq!(rest.trim(), "");
    assert!(
        text.contains(&format!("\"bits_hash\": \"{:016x}\"", plain.bits_hash())),
        "{text}"
    );
    assert!(
        text.contains(r#""label": "a \"rod\"""#) && text.contains(r#""material": "copper""#),
        "{text}"
    );
    assert!(
        text.contains("\"why\": \"t = 0.000006 s was reached\", \"early\": false"),
        "{text}"
    );
    assert_eq!(number(&text, "actual", "steps"), summary.steps as f64);
    assert_eq!(number(&text, "actual", "pairs"), summary.pairs as f64);
    assert_relative_eq!(
        number(&text, "predicted", "steps"),
        summary.steps as f64,
        max_relative = 0.1
    );
    assert_relative_eq!(number(&text, "ledger", "kinetic_j"), run.kinetic_energy());
    // A run that goes on counts its own steps, and one that fails leaves a receipt too.
    let failing = Run::new(&mut run, 2.0 * END).receipt(&path);
    failing
        .observe(Schedule::end(), |_| Err("no room".into()))
        .go()
        .unwrap_err();
    let text = std::fs::read_to_string(&path).unwrap();
    take_value(&mut text.as_str());
    assert!(
        text.contains("failed at t = 0.000012 s: no room\", \"early\": true, \"failed\": true"),
        "{text}"
    );
    assert_eq!(
        number(&text, "actual", "steps"),
        (run.steps() - summary.steps) as f64
    );
    std::fs::remove_dir_all(&folder).unwrap();
}

/// The numbers of an array of doubles in a VTU file.
fn doubles(file: &[u8], name: &str) -> Vec<f64> {
    let start = file.windows(6).position(|own| own == b"raw\">\n").unwrap() + 7;
    let head = String::from_utf8_lossy(&file[..start]).into_owned();
    let tag = head
        .split(&format!("type=\"Float64\" Name=\"{name}\""))
        .nth(1)
        .unwrap();
    let offset = tag
        .split("offset=\"")
        .nth(1)
        .unwrap()
        .split('"')
        .next()
        .unwrap();
    let at = start + offset.parse::<usize>().unwrap();
    let bytes = |from: usize| -> [u8; 8] { file[from..from + 8].try_into().unwrap() };
    let count = u64::from_le_bytes(bytes(at)) as usize / 8;
    (1..=count)
        .map(|k| f64::from_le_bytes(bytes(at + 8 * k)))
        .collect()
}

#[test]
fn a_series_for_paraview_has_walls_and_sizes_and_goes_on() {
    let folder = std::env::temp_dir().join(format!("meshfree-series-{}", std::process::id()));
    let list = folder.join("tank.pvd");
    let water = catalogue::weakly_compressible_water(2.0);
    let tank = Wall::around(
        "tank",
        [0.0; 2],
        [0.2, 0.3],
        0.02,
        3,
        [[true, true], [true, false]],
    );
    let mut tank = Scene::<f64, 2>::new(schemes::weakly_compressible())
        .body(Body::block("water", water, [0.0; 2], [0.2, 0.2], 0.02))
        .wall(tank)
        .acceleration(|_| [0.0, -9.81])
        .build()
        .unwrap();
    let schedule = || Schedule::every(2e-3);
    Run::new(&mut tank, 4e-3)
        .paraview(schedule(), &list)
        .go()
        .unwrap();
    Run::new(&mut tank, 8e-3)
        .paraview(schedule(), &list)
        .go()
        .unwrap();
    let text = std::fs::read_to_string(&list).unwrap();
    let times = text
        .split("timestep=\"")
        .skip(1)
        .map(|own| own.split('"').next().unwrap());
    let times: Vec<f64> = times.map(|own| own.parse().unwrap()).collect();
    assert_eq!(times, [0.0, 2e-3, 4e-3, 6e-3, 8e-3]);
    let file = std::fs::read(folder.join("tank_00004.vtu")).unwrap();
    let walls = tank.wall("tank").unwrap().count();
    let [spacing, h, mass] =
        ["spacing", "smoothing_length", "mass"].map(|name| doubles(&file, name));
    for all in [&spacing, &h, &mass] {
        assert_eq!(all.len(), tank.particles() + walls);
    }
    for k in 0..spacing.len() {
        assert_relative_eq!(spacing[k], 0.02, max_relative = 1e-12);
        assert_relative_eq!(h[k], tank.smoothing_length(), max_relative = 1e-12);
        assert_relative_eq!(mass[k], 1000.0 * 0.02 * 0.02, max_relative = 0.01);
    }
    let pressure = doubles(&file, "pressure");
    assert_eq!(pressure[0], tank.all().next().unwrap().pressure());
    assert!(
        pressure[tank.particles()..].iter().any(|own| *own > 100.0),
        "walls bear the water"
    );
    std::fs::remove_dir_all(&folder).unwrap();
}
