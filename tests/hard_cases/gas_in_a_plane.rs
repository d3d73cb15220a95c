//! Gases in two dimensions: Noh's implosion, Sedov's blast, and a contact at which two gases shear (Kelvin–Helmholtz).
//! Others lose energy, heat the middle, or part the gases by a jump of pressure that density and energy make between them.

use super::harness::{Row, Varied};
use super::imploding_gas::{BARE, CONDUCTING, Cure, FORMS, closed, gas, implosion, sedov};
use meshfree::material::eos::IdealGas;
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::scheme::EnergyForm;
use std::f64::consts::PI;

#[test]
fn noh_implodes_to_a_plateau_in_a_plane() {
    let case = "Noh's implosion 2D, 50 a radius";
    let runs = FORMS.map(|form| implosion::<2>(CONDUCTING, form, 50));
    let bare = implosion::<2>(BARE, EnergyForm::Compatible, 50);
    Row {
        case,
        criterion: "error of the mean of the plateau; control: no viscosity, fixed h",
        value: runs[0].plateau,
        control: bare.plateau,
    }
    .at_most(0.15);
    closed(case, runs.map(|run| run.energy));
}

#[test]
fn a_point_blast_runs_as_sedov_says() {
    sedov::<2>("Sedov's blast 2D, 50 a metre", 50, 4.0);
}

/// A band of gas of twice the density that slides through another at a speed of one, both of one pressure, and a wave on
/// their contacts: its growth over a span, as an exponent, and the largest error of a pressure at the start of it.
fn shear(cure: Cure, count: usize, [from, to]: [f64; 2]) -> [f64; 2] {
    const PRESSURE: f64 = 2.5;
    let law = IdealGas::new(5.0 / 3.0, 1.0);
    let body = Body::block(
        "gas",
        Material::new("gas", law),
        [0.0; 2],
        [1.0; 2],
        1.0 / count as f64,
    )
    .start(|[x, y]: [f64; 2], _| {
        let band = (y - 0.5).abs() < 0.25;
        let density = if band { 2.0 } else { 1.0 };
        let near = |contact: f64| (-4.0 * PI * (y - contact).abs()).exp();
        Start {
            velocity: [
                if band { 0.5 } else { -0.5 },
                0.025 * (4.0 * PI * x).sin() * (near(0.25) + near(0.75)),
            ],
            density,
            energy: law.energy(PRESSURE, density),
        }
    });
    let mut own = Scene::new(gas(cure, EnergyForm::Compatible))
        .body(body)
        .boundary(Periodic::along(0, 0.0, 1.0))
        .boundary(Periodic::along(1, 0.0, 1.0))
        .varied()
        .build()
        .expect("gas");
    // The size of the mode that linear theory grows: sin and cos of its wavenumber, e^(−k |y|) from each contact.
    let size = |own: &Simulation<f64, 2>| {
        let mut sums = [0.0; 3];
        for p in own.all() {
            let [x, y] = p.position();
            let from = (y - 0.25).abs().min((y - 0.75).abs());
            let weight = p.mass() / p.density() * (-4.0 * PI * from).exp();
            let v = weight * p.velocity()[1];
            let [s, c] = [(4.0 * PI * x).sin(), (4.0 * PI * x).cos()];
            sums = [sums[0] + v * s, sums[1] + v * c, sums[2] + weight];
        }
        2.0 * sums[0].hypot(sums[1]) / sums[2]
    };
    own.run_until(from).expect("gas");
    let first = size(&own);
    let jump = own
        .all()
        .map(|p| (p.pressure() / PRESSURE - 1.0).abs())
        .fold(0.0, f64::max);
    own.run_until(to).expect("gas");
    println!(
        "{cure:?}: {} from {first} to {}, pressure {jump}",
        (size(&own) / first).ln(),
        size(&own)
    );
    [(size(&own) / first).ln(), jump]
}

#[test]
fn a_shear_between_gases_rolls_up() {
    let span = [0.1, 0.4];
    let [mixed, parted] = [[0.1, 0.5], [0.1, 0.0]].map(|cure| shear(cure, 64, span));
    // Of a sharp contact without compression: k Δu √(ρ₁ρ₂)/(ρ₁ + ρ₂).
    let linear = 4.0 * PI * 2.0_f64.sqrt() / 3.0 * (span[1] - span[0]);
    println!(
        "growth over that of linear theory {} {}",
        mixed[0] / linear,
        parted[0] / linear
    );
    let row = |criterion, value, control| Row {
        case: "Kelvin–Helmholtz 2:1, 64²",
        criterion,
        value,
        control,
    };
    row(
        "largest error of pressure at the contacts, 0.1 s",
        mixed[1],
        parted[1],
    )
    .at_most(0.1);
}
