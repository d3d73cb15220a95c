//! Conduction against the exact decay of a sine, and its place in ledger, files, step and printed program.

use crate::heat::{CONDUCTIVITY, HeatConduction, TEMPERATURE};
use meshfree::effect::NoWalls;
use meshfree::material::eos::Linear;
use meshfree::prelude::*;
use meshfree::simulation::{Criterion, Simulation};
use meshfree::term::viscosity::Inviscid;
use std::f64::consts::TAU;

/// Density \[kg/m³\], conductivity \[W/(m K)\] and specific heat \[J/(kg K)\]: a diffusivity of 1 m²/s.
const HEAT: HeatConduction = HeatConduction {
    conductivity: 2e6,
    specific_heat: 1000.0,
    start: 300.0,
};

pub fn material() -> Material<f64> {
    Material::new("still", Linear::new(2000.0, 1.0))
}

fn scheme() -> SchemeBuilder<WendlandC2, Inviscid, NoWalls, impl Effects<1> + Effects<2>> {
    SchemeBuilder::new(WendlandC2, Inviscid)
        .density(DensityForm::NumberDensity)
        .energy(EnergyForm::None)
        .with(HEAT)
}

/// A square of 1 m, periodic, whose temperature is 300 K + 50 K sin(2πx).
fn scene(count: usize) -> Scene<f64, 2> {
    let spacing = 1.0 / count as f64;
    let body = Body::block("square", material(), [0.0; 2], [1.0; 2], spacing)
        .field(TEMPERATURE, |[x, _]| [300.0 + 50.0 * (TAU * x).sin()]);
    Scene::new(scheme())
        .body(body)
        .boundary(Periodic::along(0, 0.0, 1.0))
        .boundary(Periodic::along(1, 0.0, 1.0))
}

fn square(count: usize) -> Simulation<f64, 2> {
    scene(count).build().unwrap()
}

#[test]
fn a_sine_decays_at_second_order_and_heat_stays() {
    let end: f64 = 0.02;
    let errors = [12, 24, 48].map(|count| {
        let mut simulation = square(count);
        let heat = simulation.ledger().whole.total("heat").unwrap();
        assert!((heat / (2000.0 * 1000.0 * 300.0) - 1.0).abs() < 1e-12);
        simulation.step().unwrap();
        let vote = simulation.last_vote().unwrap();
        assert_eq!(
            vote.criterion,
            Criterion::Effect("conduction: 0.08 h² ρ c/k")
        );
        simulation.run_until(end).unwrap();
        let after = simulation.ledger().whole.total("heat").unwrap();
        assert!((after / heat - 1.0).abs() < 1e-13, "{after} of {heat}");
        let decayed = 50.0 * (-TAU * TAU * end).exp();
        let errors = simulation.all().map(|particle| {
            let exact = 300.0 + decayed * (TAU * particle.position()[0]).sin();
            (particle.scalar(TEMPERATURE).unwrap() - exact).powi(2)
        });
        (errors.sum::<f64>() / simulation.particles() as f64).sqrt()
    });
    let orders = [0, 1].map(|k| (errors[k] / errors[k + 1]).log2());
    println!("errors {errors:?} K, orders {orders:?}");
    assert!(
        orders.iter().all(|order| (1.9..2.2).contains(order)),
        "{orders:?} of {errors:?}"
    );
    assert!(errors[2] < 0.05);
}

#[test]
fn two_bodies_of_unlike_conductivity_end_with_the_flow_of_resistances_in_series() {
    // A rod of two halves between ends held at 400 and 300 K: q = ΔT/(L₁/k₁ + L₂/k₂), and the joint's temperature.
    let half = |name, low: f64, k: f64, t: f64| {
        Body::<f64, 1>::block(name, material(), [low], [low + 0.5], 0.0125)
            .field(CONDUCTIVITY, move |_| [k])
            .field(TEMPERATURE, move |_| [t])
    };
    let [k_1, k_2] = [2e6, 5e5];
    let mut rod = Scene::<f64, 1>::new(scheme())
        .body(half("first", 0.0, k_1, 400.0))
        .body(half("second", 0.5, k_2, 300.0))
        .between("first", "second", Interaction::Bonded)
        .build()
        .unwrap();
    let hold = |low: f64, at: f64| {
        move |[x]: [f64; 1], [t]: [f64; 1]| [if (low..low + 0.1).contains(&x) { at } else { t }]
    };
    while rod.time() < 3.0 {
        rod.step().unwrap();
        rod.set_field("first", TEMPERATURE, hold(0.0, 400.0))
            .unwrap();
        rod.set_field("second", TEMPERATURE, hold(0.9, 300.0))
            .unwrap();
    }
    // The held ends are the first and last tenth, less half a spacing.
    let held = 0.1 - 0.5 * 0.0125;
    let flow = 100.0 / ((0.5 - held) / k_1 + (0.5 - held) / k_2);
    let joint = 400.0 - flow * (0.5 - held) / k_1;
    let near: Vec<f64> = rod.all().map(|p| p.scalar(TEMPERATURE).unwrap()).collect();
    let found = 0.5 * (near[39] + near[40]) + 0.5 * flow * 0.00625 * (1.0 / k_2 - 1.0 / k_1);
    println!("joint {found} K, exact {joint} K");
    assert!((found - joint).abs() < 0.5, "{found} for {joint}");
}

#[test]
fn temperature_is_in_files_and_in_the_printed_step() {
    let mut simulation = square(12);
    let printed = simulation.scheme().step_program();
    assert!(printed.contains("evolves temperature [K]"), "{printed}");
    assert!(
        printed.contains("ledger: heat [J] = 1000 Σ m temperature"),
        "{printed}"
    );
    assert!(printed.contains("limits the step: conduction"), "{printed}");
    assert_eq!(simulation.field("temperature").unwrap(), TEMPERATURE);
    let first = simulation.all().next().unwrap();
    assert_eq!(
        first.named("temperature").unwrap(),
        [first.scalar(TEMPERATURE).unwrap()]
    );
    let path = std::env::temp_dir().join(format!("downstream-{}.vtu", std::process::id()));
    simulation.vtu().write(&path).unwrap();
    let file = std::fs::read(&path).unwrap();
    std::fs::remove_file(&path).unwrap();
    let text = String::from_utf8_lossy(&file);
    let array = "Name=\"temperature\" NumberOfComponents=\"1\" format=\"appended\" offset=\"";
    let at: usize = text
        .split(array)
        .nth(1)
        .unwrap()
        .split('"')
        .next()
        .unwrap()
        .parse()
        .unwrap();
    let mark = b"encoding=\"raw\">\n_";
    let start = file.windows(mark.len()).position(|w| w == mark).unwrap() + mark.len() + at + 8;
    let written = f64::from_le_bytes(file[start..start + 8].try_into().unwrap());
    assert_eq!(
        written,
        simulation
            .all()
            .next()
            .unwrap()
            .scalar(TEMPERATURE)
            .unwrap()
    );
    // What is not there is an error that names what is.
    let error = simulation
        .set_field("square", Field::PRESSURE, |_, p: [f64; 1]| p)
        .unwrap_err();
    assert!(error.to_string().contains("pressure"), "{error}");
    let error = simulation
        .set_field("circle", TEMPERATURE, |_, t: [f64; 1]| t)
        .unwrap_err();
    assert!(error.to_string().contains("square"), "{error}");
    let error = simulation
        .set_field("square", TEMPERATURE, |_, _| [f64::NAN])
        .unwrap_err();
    assert!(error.to_string().contains("temperature"), "{error}");
    let cold = Body::block("square", material(), [0.0; 2], [1.0; 2], 0.1);
    let wrong = Scene::<f64, 2>::new(scheme()).body(cold.field(Field::PRESSURE, |_| [1.0]));
    assert!(wrong.problems()[0].to_string().contains("pressure"));
}

#[test]
fn a_run_that_is_resumed_has_the_temperatures_of_one_that_was_not() {
    let path = std::env::temp_dir().join(format!("downstream-{}.ckpt", std::process::id()));
    let mut whole = square(12);
    whole.run_until(0.01).unwrap();
    whole.save(&path).unwrap();
    whole.run_until(0.02).unwrap();
    let mut resumed = scene(12).resume(&path).unwrap();
    std::fs::remove_file(&path).unwrap();
    assert_eq!(resumed.time(), 0.01);
    resumed.run_until(0.02).unwrap();
    let temperatures = |of: &Simulation<f64, 2>| -> Vec<u64> {
        of.all()
            .map(|p| p.scalar(TEMPERATURE).unwrap().to_bits())
            .collect()
    };
    assert!(temperatures(&whole) == temperatures(&resumed));
}
