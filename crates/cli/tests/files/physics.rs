//! Schemes and shapes that no other test here runs: a gas against Sod's exact solution, a bar that keeps its energy, an STL file.
//! What they give is known without the program.

use super::{altered, folder, perform, text};
use meshfree::output::csv::Csv;
use meshfree::study::sod::Sod;
use meshfree_cli::command::Task;
use meshfree_cli::fault::Source;
use std::path::Path;

/// Runs a scene into a folder, and reads a table that it writes.
fn table(text: &str, name: &str, file: &str) -> Csv {
    let folder = folder(name);
    perform(&super::source(text), &Task::Run(Some(folder.clone()))).expect("a run");
    Csv::read(folder.join(file)).expect("a table")
}

fn column(table: &Csv, name: &str) -> Vec<f64> {
    table.column(name).expect("numbers")
}

#[test]
fn a_shock_tube_has_the_densities_of_sod() {
    let tube = table(&text("shock_tube.toml"), "shock_tube", "particles.csv");
    let (places, densities) = (column(&tube, "x"), column(&tube, "density"));
    // The undisturbed gas, both sides of the contact at 0.186, and before the shock at 0.350.
    for (low, high) in [(-0.45, -0.30), (0.05, 0.15), (0.22, 0.31), (0.40, 0.48)] {
        let inside = places
            .iter()
            .zip(&densities)
            .filter(|(x, _)| (low..high).contains(*x));
        let (count, sum) = inside.fold((0.0, 0.0), |own, (_, rho)| (own.0 + 1.0, own.1 + rho));
        let exact = Sod::new()
            .and_then(|own| own.profile(&[0.5 * (low + high)], 0.2))
            .expect("a profile");
        let ratio = sum / count / exact[0].density;
        println!("{low} to {high}: {ratio} of the exact density");
        assert!((ratio - 1.0).abs() < 0.01, "{low} to {high}: {ratio}");
    }
}

/// Cases 1 and 2 of Lam, Shen & Gong: half of the speed is left behind the front in like rods, none at a rigid wall, and the shock
/// relation p = ρ₀ (C₀ + S u) u has the pressure of what was stopped, u.
#[test]
fn rods_have_the_pressures_of_the_shock_relation() {
    for (scene, stopped) in [("rods", 10.0), ("rod_on_wall", 20.0)] {
        let probes = table(&text(&format!("{scene}.toml")), scene, "probes.csv");
        let [time, pressure] = [0, 1].map(|k| column(&probes, &probes.header[k].clone()));
        // In the striker's middle between the front, at 1.3 µs, and its echo from the free end, at 3.8 µs.
        let inside = time.iter().zip(&pressure);
        let inside = inside.filter(|(t, _)| (2.0e-6..3.2e-6).contains(*t));
        let (count, sum) = inside.fold((0.0, 0.0), |own, (_, p)| (own.0 + 1.0, own.1 + p));
        let exact = 8930.0 * (3940.0 + 1.49 * stopped) * stopped;
        let ratio = sum / count / exact;
        println!("{scene}: {ratio} of {exact} Pa");
        assert!((ratio - 1.0).abs() < 0.01, "{scene}: {ratio}");
    }
}

#[test]
fn a_bar_turns_its_speed_into_work_and_loses_none() {
    let bar = altered(
        &text("taylor_bar.toml"),
        &[("until = 2e-5", "until = 5e-6")],
    );
    let history = table(&bar, "taylor_bar", "history.csv");
    let [kinetic, internal, momentum] =
        ["kinetic", "internal", "momentum_z"].map(|name| column(&history, name));
    let mass = column(&history, "mass")[0];
    assert!((kinetic[0] / (0.5 * mass * 227.0 * 227.0) - 1.0).abs() < 1e-12);
    let last = kinetic.len() - 1;
    assert!(kinetic[last] < 0.9 * kinetic[0] && momentum[last] > momentum[0]);
    let drift = (kinetic[last] + internal[last]) / (kinetic[0] + internal[0]) - 1.0;
    println!(
        "kinetic energy {} of the first, drift {drift}",
        kinetic[last] / kinetic[0]
    );
    assert!(drift.abs() < 1e-10, "{drift}");
}

/// A cube of 100 mm as an STL file in text.
fn cube() -> String {
    let corner = |k: usize| [k & 1, k >> 1 & 1, k >> 2].map(|bit| 100 * bit);
    // Outwards by the rule of the right hand.
    let sides = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let facet = |corners: [usize; 3]| {
        let vertices = corners.map(|k| {
            let [x, y, z] = corner(k);
            format!("vertex {x} {y} {z}\n")
        });
        format!(
            "facet normal 0 0 0\nouter loop\n{}endloop\nendfacet\n",
            vertices.concat()
        )
    };
    let facets = sides.map(|[a, b, c, d]| facet([a, b, c]) + &facet([a, c, d]));
    format!("solid cube\n{}endsolid cube\n", facets.concat())
}

#[test]
fn a_tank_from_an_stl_file_is_filled_and_turns() {
    let folder = folder("mesh");
    std::fs::create_dir_all(&folder).expect("a folder");
    std::fs::write(folder.join("cube.stl"), cube()).expect("a file");
    let scene = r#"
dimension = 3
gravity = [0, 0, -9.81]
scheme = { weakly_compressible = {} }
material.water.liquid = { density = 1000, greatest_speed = 1.5 }

[[body]]
name = "water"
material = "water"
spacing = 0.01
hydrostatic = [0, 0, 0.05]
[[body.fill.minus]]
mesh = { file = "cube.stl", unit = 0.001 }
[[body.fill.minus]]
half_space = { point = [0, 0, 0.05], normal = [0, 0, -1] }

[[wall]]
name = "tank"
spacing = 0.01
layers_of = { mesh = { file = "cube.stl", unit = 0.001 } }
[[wall.motion]]
rotation = { centre = [0.05, 0.05, 0], axis = [0, 1, 0], table = { rows = [[0, 0], [0.1, 1], [0.2, 2], [0.3, 3]], scale = 0.0174533 } }

[run]
until = 0.3
"#;
    let source = Source::new(Path::new(&folder.join("tank.toml")), scene.to_owned());
    let told = perform(&source, &Task::Check).expect("a scene");
    assert!(told.contains("500 particles, about "), "{told}");
}

#[test]
fn a_brick_rests_on_a_floor_by_a_contact_that_is_named() {
    let scene = r#"
dimension = 2
scheme = { updated_lagrangian = { alpha = 1.0 } }
acceleration = [{ rows = [[0, 0, 0], [0.05, 0, -9.81], [10, 0, -9.81]] }]
material.stone = { linear = { density = 2000, sound_speed = 20 }, shear_modulus = 1e5, strength = { yield_stress = 1e9 } }

[[body]]
name = "brick"
material = "stone"
spacing = 0.02
block = { low = [0, 0], high = [0.2, 0.1] }
rigid = true

[[wall]]
name = "floor"
spacing = 0.02
around = { low = [-0.1, 0], high = [0.3, 0.2], closed = [[false, false], [true, false]] }
layers = 3

[[between]]
first = "brick"
second = "floor"
interaction = "contact"
friction = 0.3

[run]
until = 0.2
"#;
    let force = column(&table(scene, "brick", "history.csv"), "force_on_floor_y");
    let weight = 2000.0 * 0.2 * 0.1 * 9.81;
    let ratio = force.last().expect("a force") / -weight;
    println!("{ratio} of the weight");
    assert!((ratio - 1.0).abs() < 0.1, "{ratio}");
    // Without it the brick is refused, in the words of the file.
    let unnamed = &scene[..scene.find("[[between]]").expect("a contact")];
    let refused = perform(
        &super::source(&format!("{unnamed}[run]\nuntil = 0.2")),
        &Task::Check,
    );
    let message = refused.expect_err("no contact is named").to_string();
    assert!(
        message.contains("body[0]: body `brick` meets wall `floor`")
            && message.contains("[[between]]"),
        "{message}"
    );
}
