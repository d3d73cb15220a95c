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

/// Wavenumber of the wave on the contacts, two waves a metre.
const K: f64 = 4.0 * PI;
/// Density of the band; that around it is one. Both slide at half a metre a second.
const HEAVY: f64 = 2.0;

/// Growth rate of the wave on a vortex sheet between gases of 2.5 Pa, γ = 5/3 \[1/s\]: ρ₁ D₁²/κ₁ + ρ₂ D₂²/κ₂ = 0 with D = σ − iω + ikU and
/// κ² = k² + D²/c² (Landau 1944). It is 0.940 of k Δu √(ρ₁ρ₂)/(ρ₁ + ρ₂), that without compression.
fn growth() -> f64 {
    0.940 * incompressible()
}

fn incompressible() -> f64 {
    K * HEAVY.sqrt() / (1.0 + HEAVY)
}

/// A band of gas of twice the density that slides through another at a speed of one, both of one pressure, and the growing mode of
/// linear theory without compression on their contacts: its growth over a span, as an exponent over the exact one, and the largest error of a pressure
/// at the start of it. The lattice is even: displaced by a hundredth of a spacing, growth varies by a quarter. Started by a velocity alone half of a wave is the mode that decays, and sound takes a part.
fn shear(cure: Cure, count: usize, [from, to]: [f64; 2]) -> [f64; 2] {
    const PRESSURE: f64 = 2.5;
    const CONTACTS: [f64; 2] = [0.25, 0.75];
    let law = IdealGas::new(5.0 / 3.0, 1.0);
    let common = 0.5 * (HEAVY - 1.0) / (HEAVY + 1.0);
    // D over the displacement's e^(ikx), real and imaginary part: σ and k (U − ω/k).
    let rate = |band: bool| {
        let speed = if band { 0.5 } else { -0.5 };
        [incompressible(), K * (speed - common)]
    };
    let times = |[a, b]: [f64; 2], [c, d]: [f64; 2]| [a * c - b * d, a * d + b * c];
    // Velocities of 0.01 at the contacts.
    let size = |[a, b]: [f64; 2]| a.hypot(b);
    let height = 0.02 / (size(rate(false)) + size(rate(true)));
    let spacing = 1.0 / count as f64;
    let displaced = |[x, y]: [f64; 2]| {
        CONTACTS.iter().fold([x, y], |at, contact| {
            let by = height * (-K * (y - contact).abs()).exp();
            let side = (y - contact).signum();
            [
                at[0] + side * by * (K * x).sin(),
                at[1] + by * (K * x).cos(),
            ]
        })
    };
    let at = move |k: usize| (k as f64 + 0.5) * spacing;
    let lattice = (0..count).flat_map(|i| (0..count).map(move |j| displaced([at(i), at(j)])));
    let material = Material::new("gas", law);
    let body = Body::points_of("gas", material, lattice.collect(), spacing).start(
        move |[x, y]: [f64; 2], _| {
            let from = CONTACTS.map(|contact| y - contact - height * (K * x).cos());
            let band = from[0] > 0.0 && from[1] < 0.0;
            let density = if band { HEAVY } else { 1.0 };
            let [mut along, mut across, mut pressure] =
                [if band { 0.5 } else { -0.5 }, 0.0, PRESSURE];
            for from in from {
                let size = height * (-K * from.abs()).exp();
                let v = times(rate(band), [(K * x).cos(), (K * x).sin()]);
                across += size * v[0];
                along += from.signum() * size * v[1];
                pressure += from.signum() * density * size / K * times(rate(band), v)[0];
            }
            Start {
                velocity: [along, across],
                density,
                energy: law.energy(pressure, density),
            }
        },
    );
    let mut own = Scene::new(gas(cure, EnergyForm::Compatible))
        .body(body)
        .boundary(Periodic::along(0, 0.0, 1.0))
        .boundary(Periodic::along(1, 0.0, 1.0))
        .varied()
        .build()
        .expect("gas");
    // The size of the mode: sin and cos of its wavenumber, e^(−k |y|) from each contact.
    let size = |own: &Simulation<f64, 2>| {
        let mut sums = [0.0; 3];
        for p in own.all() {
            let [x, y] = p.position();
            let from = CONTACTS.map(|contact| (y - contact).abs());
            let weight = p.mass() / p.density() * (-K * from[0].min(from[1])).exp();
            let v = weight * p.velocity()[1];
            let [s, c] = [(K * x).sin(), (K * x).cos()];
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
    let grown = (size(&own) / first).ln() / (growth() * (to - from));
    println!(
        "{cure:?}: from {first} to {}, {grown} of the exact exponent, pressure {jump}",
        size(&own)
    );
    [grown, jump]
}

#[test]
fn a_shear_between_gases_rolls_up() {
    let span = [0.1, 0.4];
    let cures = [[0.02, 0.5], [0.02, 0.0], [1.0, 0.5]];
    let [mixed, parted, viscous] = cures.map(|cure| shear(cure, 64, span));
    let row = |criterion, value, control| Row {
        case: "Kelvin–Helmholtz 2:1, 64²",
        criterion,
        value,
        control,
    };
    row(
        "growth of the wave over that of linear theory, 0.1 to 0.4 s, even start; α = 0.02, control: 1",
        mixed[0],
        viscous[0],
    )
    .at_least(0.9);
    row(
        "largest error of pressure at the contacts, 0.1 s",
        mixed[1],
        parted[1],
    )
    .at_most(0.1);
}
