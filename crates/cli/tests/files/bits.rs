//! A scene file and the same scene in Rust: the same columns, digit by digit.
//! Numbers are written so that they read back as they were, so equal files are equal bits.

use super::{altered, folder, perform, scenes, source, text};
use meshfree::effect::{ExpansionMemory, ExtrapolatedPressure};
use meshfree::material::{Liquid, SoundSpeed};
use meshfree::output::csv::Csv;
use meshfree::prelude::*;
use meshfree::scene::ParticleState;
use meshfree::term::viscosity::MonaghanGingold;
use meshfree_cli::command::Task;
use std::path::Path;

/// The last state of a scene file.
fn of_file(text: &str, name: &str) -> String {
    let folder = folder(name);
    perform(&source(text), &Task::Run(Some(folder.clone()))).expect("a run");
    std::fs::read_to_string(folder.join("particles.csv")).expect("columns")
}

/// The last state of a scene.
fn of_rust<const D: usize>(scene: Scene<f64, D>, until: f64, name: &str) -> String {
    let mut simulation = scene.build().expect("a scene");
    simulation.run_until(until).expect("a run");
    let path = folder(name).join("rust.csv");
    ParticleState::of(&simulation)
        .write_csv(&path)
        .expect("columns");
    std::fs::read_to_string(path).expect("columns")
}

/// The scheme of the two liquids below: one, so that it is compiled once.
fn liquid(alpha: f64, remembers: bool) -> Scheme<f64, 2> {
    schemes::weakly_compressible()
        .with_viscosity(MonaghanGingold { alpha, beta: 0.0 })
        .walls(ExtrapolatedPressure::default())
        .with(remembers.then_some(ExpansionMemory))
        .compose()
}

#[test]
fn a_dam_break_has_the_bits_of_rust() {
    let coarse = altered(
        &text("dam_break.toml"),
        &[
            ("spacing = 0.015", "spacing = 0.03"),
            ("spacing = 0.015", "spacing = 0.03"),
            ("until = 0.8", "until = 0.2"),
        ],
    );
    let gravity = [0.0, -9.81];
    let water = Liquid::new(997.0, 1480.0, 8.9e-4)
        .material("water", SoundSpeed::Chosen(34.31))
        .with_pressure_cut_off(0.0);
    let column = Body::block("water", water, [0.0; 2], [0.6, 0.3], 0.03);
    let sides = [[true, true], [true, false]];
    let scene = Scene::new(liquid(0.02, false))
        .body(column.hydrostatic(gravity, [0.0, 0.3]))
        .wall(Wall::around("tank", [0.0; 2], [1.61, 1.0], 0.03, 3, sides))
        .acceleration(move |_| gravity);
    let (file, rust) = (
        of_file(&coarse, "dam_break"),
        of_rust(scene, 0.2, "dam_break_rust"),
    );
    assert_eq!(file, rust);
    // Another viscosity has other bits.
    let other = altered(&coarse, &[("alpha = 0.02", "alpha = 0.03")]);
    assert_ne!(of_file(&other, "dam_break_other"), rust);
}

#[test]
fn a_moved_tank_has_the_bits_of_rust() {
    let coarse = altered(
        &text("sloshing_tank.toml"),
        &[
            ("spacing = 0.015", "spacing = 0.03"),
            ("spacing = 0.015", "spacing = 0.03"),
            ("until = 0.08", "until = 0.02"),
        ],
    );
    let gravity = [0.0, -9.81];
    let water = Liquid::new(1000.0, 1480.0, 1e-3)
        .material("water", SoundSpeed::artificial(17.15))
        .with_pressure_cut_off(0.0);
    let rows = Csv::read(scenes().join("half_sine.csv")).expect("a record");
    let column = |name: &str| rows.column(name).expect("numbers");
    let accelerations = column("x_g").into_iter().map(|x| [x * 9.80665, 0.0]);
    let record: Vec<_> = column("time_s").into_iter().zip(accelerations).collect();
    let motion = Translation::from_acceleration(&record).expect("a motion");
    let body = Body::block("water", water, [0.0; 2], [0.5, 0.18], 0.03).jitter(0.15, 1);
    let tank = Wall::around("tank", [0.0; 2], [0.5, 0.3], 0.03, 3, [[true; 2]; 2]);
    let scene = Scene::new(liquid(0.002, true))
        .body(body.hydrostatic(gravity, [0.0, 0.18]))
        .wall(tank.container_frame().motion(motion))
        .acceleration(move |_| gravity);
    let file = of_file(&coarse, "sloshing_tank");
    assert_eq!(file, of_rust(scene, 0.02, "sloshing_tank_rust"));
}

#[test]
fn composite_rods_have_the_bits_of_rust() {
    let rods = altered(
        &text("composite_rods.toml"),
        &[("until = 26e-6", "until = 8e-6")],
    );
    let rod = |name, of, low: f64, high: f64| {
        let material = catalogue::by_name(of).expect("a material");
        Body::block(name, material, [low], [high], 1e-4)
    };
    let scene = Scene::<f64, 1>::new(schemes::impact())
        .body(rod("striker", "copper", 0.0, 0.010).velocity([20.0]))
        .body(rod("pad", "pmma", 0.010, 0.015).velocity([20.0]))
        .body(rod("target", "copper", 0.015, 0.055))
        .between("striker", "pad", Interaction::Bonded);
    assert_eq!(of_file(&rods, "rods"), of_rust(scene, 8e-6, "rods_rust"));
}

#[test]
fn a_resumed_run_has_the_bits_of_one_run() {
    let rods = text("composite_rods.toml");
    let output = "checkpoint = { at = [4e-6] }\nhistory = { every = 1e-6 }";
    let until = |until: &str| {
        altered(
            &rods,
            &[
                ("until = 26e-6", until),
                ("history = { every = 1e-6 }", output),
            ],
        )
    };
    let whole = of_file(&until("until = 8e-6"), "resumed_whole");
    let half = of_file(&until("until = 5e-6"), "resumed");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("files/resumed");
    perform(
        &source(&until("until = 8e-6")),
        &Task::Resume(Some(folder.clone())),
    )
    .expect("a run");
    let read = |name: &str| std::fs::read_to_string(folder.join(name)).expect("columns");
    assert_eq!(read("particles.csv"), whole);
    assert_ne!(half, whole);
    // From 5 to 8 µs, beside the table of the run before.
    let rows = |name| Csv::read(folder.join(name)).expect("a table").rows.len();
    assert_eq!([rows("history.csv"), rows("history_2.csv")], [6, 4]);
}
