//! Effects of two crates whose fields and sums have the same names stand in one scheme, and in its files.
//! Each temperature decays as if the other were not there.

use super::heat::material;
use crate::heat::{CONDUCTIVITY, HeatConduction, TEMPERATURE};
use electrons::Electrons;
use meshfree::prelude::*;
use meshfree::simulation::Simulation;
use meshfree::term::viscosity::Inviscid;
use std::f64::consts::TAU;

const BOTH: [Field; 2] = [TEMPERATURE, electrons::TEMPERATURE];

/// A periodic line of 1 m with two temperatures, 50 K sin(2πx) both; those of electrons spread half as fast, at 0.5 m²/s.
fn scene() -> Scene<f64, 1> {
    let start = |[x]: [f64; 1]| [50.0 * (TAU * x).sin()];
    let lattice = HeatConduction {
        conductivity: 2e6,
        specific_heat: 1000.0,
        start: 0.0,
    };
    let scheme = SchemeBuilder::new(WendlandC2, Inviscid)
        .density(DensityForm::NumberDensity)
        .energy(EnergyForm::None)
        .with(lattice)
        .with(Electrons { diffusivity: 0.5 });
    let body = Body::block("line", material(), [0.0], [1.0], 1.0 / 48.0);
    let body = body
        .field(TEMPERATURE, start)
        .field(electrons::TEMPERATURE, start);
    let scene = Scene::new(scheme).body(body);
    scene.boundary(Periodic::along(0, 0.0, 1.0))
}

fn bits(of: &Simulation<f64, 1>) -> Vec<u64> {
    let values = of
        .all()
        .flat_map(|p| BOTH.map(|own| p.scalar(own).unwrap()));
    values.map(f64::to_bits).collect()
}

#[test]
fn fields_of_one_name_decay_apart_and_are_told_by_their_full_names() {
    let mut line = scene().build().unwrap();
    line.run_until(0.01).unwrap();
    for (field, diffusivity) in BOTH.into_iter().zip([1.0, 0.5]) {
        let decayed = 50.0 * (-diffusivity * TAU * TAU * 0.01).exp();
        let most = line
            .all()
            .map(|p| p.scalar(field).unwrap())
            .fold(0.0, f64::max);
        assert!((most / decayed - 1.0).abs() < 0.02, "{most} for {decayed}");
    }
    for (name, field) in ["downstream::temperature", "electrons::temperature"]
        .into_iter()
        .zip(BOTH)
    {
        assert_eq!(line.field(name).unwrap(), field);
        let first = line.all().next().unwrap();
        assert_eq!(first.named(name).unwrap(), [first.scalar(field).unwrap()]);
    }
    // The short name could be either, and the error says which there are.
    let error = line.field("temperature").unwrap_err().to_string();
    assert!(error.contains("downstream::temperature") && error.contains("electrons::temperature"));
    assert_eq!(line.field("conductivity").unwrap(), CONDUCTIVITY);
    let printed = line.scheme().step_program();
    for part in [
        "evolves downstream::temperature [K]",
        "evolves electrons::temperature [K]",
        "downstream::heat_flow_over_specific_heat",
        "electrons::heat_flow_over_specific_heat",
    ] {
        assert!(printed.contains(part), "{part} in {printed}");
    }
}

#[test]
fn both_are_in_files_and_a_resumed_run_has_their_bits() {
    let at =
        |end: &str| std::env::temp_dir().join(format!("two-crates-{}.{end}", std::process::id()));
    let (checkpoint, picture) = (at("ckpt"), at("vtu"));
    let mut whole = scene().build().unwrap();
    whole.run_until(0.005).unwrap();
    whole.save(&checkpoint).unwrap();
    let mut resumed = scene().resume(&checkpoint).unwrap();
    std::fs::remove_file(&checkpoint).unwrap();
    assert!(bits(&resumed) == bits(&whole));
    for own in [&mut whole, &mut resumed] {
        own.run_until(0.01).unwrap();
    }
    assert!(bits(&resumed) == bits(&whole));
    resumed.vtu().write(&picture).unwrap();
    let file = std::fs::read(&picture).unwrap();
    std::fs::remove_file(&picture).unwrap();
    let text = String::from_utf8_lossy(&file);
    let mark = b"encoding=\"raw\">\n_";
    let data = file.windows(mark.len()).position(|w| w == mark).unwrap() + mark.len();
    let first = resumed.all().next().unwrap();
    for (package, field) in ["downstream", "electrons"].into_iter().zip(BOTH) {
        let array = format!(
            "Name=\"{package}::temperature\" NumberOfComponents=\"1\" format=\"appended\" offset=\""
        );
        let (_, offset) = text.split_once(&array).unwrap();
        let offset: usize = offset.split('"').next().unwrap().parse().unwrap();
        let start = data + offset + 8;
        let written = f64::from_le_bytes(file[start..start + 8].try_into().unwrap());
        assert_eq!(written, first.scalar(field).unwrap());
    }
}
