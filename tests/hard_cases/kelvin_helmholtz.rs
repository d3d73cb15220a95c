//! Two gases that slide along each other: growth of a wave on the layer between them, and pressure at a sharp contact.
//! Others damp the wave, or part the gases by a jump of pressure that density and energy make between them.

use super::harness::{Row, Varied, seed};
use meshfree::effect::ArtificialConduction;
use meshfree::kernel::WendlandC4;
use meshfree::material::eos::IdealGas;
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::sweep::Interaction;
use meshfree::term::viscosity::SignalVelocity;
use nalgebra::Complex;
use std::f64::consts::PI;

type Number = Complex<f64>;

const GAMMA: f64 = 5.0 / 3.0;
const PRESSURE: f64 = 2.5;
/// Density of the band in the middle half; that around it is one. Both slide at half a metre a second.
const HEAVY: f64 = 2.0;
/// Two waves a metre.
const K: f64 = 4.0 * PI;
/// Of the layer, as in McNally, Lyra & Passy (2012): a sheet without one has no answer, since the shorter a wave the faster it grows,
/// and what a perturbed start grows to then depends on the perturbation.
const THICKNESS: f64 = 0.025;

/// Speed and density at rest in themselves, and their slopes, across the lower layer, that at a quarter of a metre.
fn profile(y: f64) -> [f64; 4] {
    let s = ((y - 0.25) / THICKNESS).tanh();
    let slope = (1.0 - s * s) / THICKNESS;
    let half = 0.5 * (HEAVY - 1.0);
    [0.5 * s, 0.5 * slope, 1.0 + half + half * s, half * slope]
}

/// The mode of linear theory that grows: the same on both layers, so its pressure is zero in the middle of each gas.
struct Mode {
    /// Speed of the wave; the imaginary part times K is the rate of growth.
    speed: Number,
    /// Pressure and its slope from the middle of the light gas to that of the heavy one.
    pressure: Vec<[Number; 2]>,
}

impl Mode {
    const POINTS: usize = 2000;

    /// By shooting, with a secant for the speed.
    fn solved() -> Self {
        let end = |speed| Self::shot(speed)[Self::POINTS][0];
        let [mut last, mut speed] = [0.40, 0.41].map(|grows| Number::new(1.0 / 6.0, grows));
        let mut before = end(last);
        while (speed - last).norm() > 1e-9 {
            let at = end(speed);
            let next = speed - at * (speed - last) / (at - before);
            (last, before, speed) = (speed, at, next);
        }
        let pressure = Self::shot(speed);
        Self { speed, pressure }
    }

    /// p'' = (2 U'/(U − c) + ρ'/ρ) p' + K² (1 − (U − c)² ρ/(γ P)) p (Blumen 1970, with a density that varies), by the method of Runge and Kutta.
    fn shot(speed: Number) -> Vec<[Number; 2]> {
        let slope = |y: f64, [p, q]: [Number; 2]| {
            let [u, du, density, by] = profile(y);
            let from = u - speed;
            let compressed = 1.0 - from * from * (density / (GAMMA * PRESSURE));
            let shear = 2.0 * du / from + by / density;
            [q, shear * q + compressed * p * (K * K)]
        };
        let h = 0.5 / Self::POINTS as f64;
        let mut at = [Number::from(0.0), Number::from(1.0)];
        let mut all = vec![at];
        for k in 0..Self::POINTS {
            let y = k as f64 * h;
            let to = |by: f64, slope: [Number; 2]| [0, 1].map(|d| at[d] + slope[d] * by);
            let a = slope(y, at);
            let b = slope(y + 0.5 * h, to(0.5 * h, a));
            let c = slope(y + 0.5 * h, to(0.5 * h, b));
            let d = slope(y + h, to(h, c));
            at = [0, 1].map(|n| at[n] + (a[n] + 2.0 * b[n] + 2.0 * c[n] + d[n]) * (h / 6.0));
            all.push(at);
        }
        all
    }

    fn rate(&self) -> f64 {
        K * self.speed.im
    }

    /// Amplitudes at a height, for a slope of the pressure of one at the lower edge: pressure, velocity, displacement.
    fn at(&self, y: f64) -> (Number, [Number; 2], [Number; 2]) {
        // The layer above is the mirror image, in which the pressure has the other sign.
        let (below, sign) = if y < 0.5 { (y, 1.0) } else { (1.0 - y, -1.0) };
        let place = below / 0.5 * Self::POINTS as f64;
        let k = (place.max(0.0) as usize).min(Self::POINTS - 1);
        let part = place - k as f64;
        let [p, slope] =
            [0, 1].map(|n| self.pressure[k][n] * (1.0 - part) + self.pressure[k + 1][n] * part);
        let [u, du, density, _] = profile(below);
        let (p, du) = (p * sign, du * sign);
        let rate = Number::i() * K * (u - self.speed);
        let across = -slope / rate / density;
        let along = (-Number::i() * K * p / density - across * du) / rate;
        let up = across / rate;
        (p, [along, across], [(along + up * du) / rate, up])
    }
}

/// A square of two gases, periodic, of so many particles along it, with points, velocity, density and pressure as given.
fn gases(
    scheme: Scheme<f64, 2>,
    count: usize,
    place: impl Fn([f64; 2]) -> [f64; 2],
    start: impl Fn([f64; 2]) -> ([f64; 2], f64, f64),
) -> Simulation<f64, 2> {
    let law = IdealGas::new(GAMMA, 1.0);
    let spacing = 1.0 / count as f64;
    let at = move |k: usize| (k as f64 + 0.5) * spacing;
    let lattice = (0..count).flat_map(|i| (0..count).map(move |j| [at(i), at(j)]));
    let points = lattice.map(place).collect();
    let body = Body::points_of("gas", Material::new("gas", law), points, spacing)
        .jitter(0.01, seed(7))
        .start(|x: [f64; 2], _| {
            let (velocity, density, pressure) = start(x);
            Start {
                velocity,
                density,
                energy: law.energy(pressure, density),
            }
        });
    Scene::new(scheme)
        .body(body)
        .boundary(Periodic::along(0, 0.0, 1.0))
        .boundary(Periodic::along(1, 0.0, 1.0))
        .varied()
        .build()
        .expect("gases")
}

/// The ready gas with so much conduction.
fn conducting(conduction: f64) -> Scheme<f64, 2> {
    schemes::gas()
        .with(ArtificialConduction {
            strength: conduction,
            ..ArtificialConduction::default()
        })
        .compose()
}

/// The plain pressure force, and viscosity wherever gas closes in.
fn plain() -> Scheme<f64, 2> {
    SchemeBuilder::new(WendlandC4, SignalVelocity::STANDARD)
        .density(DensityForm::Summation)
        .between_bodies(Interaction::Bonded)
        .with(ConsistentSmoothing {
            smallest: 0.2,
            largest: 5.0,
        })
        .compose()
}

/// Growth of the mode from 0.1 to 0.6 s, as an exponent over that of linear theory, from a velocity of a hundredth.
fn growth(scheme: Scheme<f64, 2>, count: usize) -> f64 {
    let mode = Mode::solved();
    let fastest = (0..100).map(|k| mode.at(0.005 * f64::from(k)).1[1].norm());
    let size = 0.01 / fastest.fold(0.0, f64::max);
    let wave = |x: f64, amplitude: Number| size * (amplitude * (Number::i() * K * x).exp()).re;
    let place = |[x, y]: [f64; 2]| {
        let (_, _, displaced) = mode.at(y);
        [x + wave(x, displaced[0]), y + wave(x, displaced[1])]
    };
    let start = |[x, y]: [f64; 2]| {
        let (pressure, velocity, displaced) = mode.at(y);
        let folded = |y: f64| if y < 0.5 { y } else { 1.0 - y };
        // Particles bring their mass from where they were.
        let [_, _, density, _] = profile(folded(y - wave(x, displaced[1])));
        let [speed, ..] = profile(folded(y));
        let velocity = [speed + wave(x, velocity[0]), wave(x, velocity[1])];
        (velocity, density, PRESSURE + wave(x, pressure))
    };
    let mut own = gases(scheme, count, place, start);
    // The size of the wave: sin and cos of its wavenumber, e^(−K |y|) from the nearest layer.
    let size = |own: &Simulation<f64, 2>| {
        let mut sums = [0.0; 3];
        for p in own.all() {
            let [x, y] = p.position();
            let from = (y - 0.25).abs().min((y - 0.75).abs());
            let weight = p.mass() / p.density() * (-K * from).exp();
            let v = weight * p.velocity()[1];
            let [s, c] = [(K * x).sin(), (K * x).cos()];
            sums = [sums[0] + v * s, sums[1] + v * c, sums[2] + weight];
        }
        2.0 * sums[0].hypot(sums[1]) / sums[2]
    };
    let [begun, grown] = [0.1, 0.6].map(|time| {
        own.run_until(time).expect("gases");
        size(&own)
    });
    println!("rate {}: from {begun} to {grown}", mode.rate());
    (grown / begun).ln() / (0.5 * mode.rate())
}

/// Largest error of a pressure after 0.1 s, where a sharp contact parts the gases.
fn jump(scheme: Scheme<f64, 2>, count: usize) -> f64 {
    let start = |[_, y]: [f64; 2]| {
        let band = (0.25..0.75).contains(&y);
        let (speed, density) = if band { (0.5, HEAVY) } else { (-0.5, 1.0) };
        ([speed, 0.0], density, PRESSURE)
    };
    let mut own = gases(scheme, count, |x| x, start);
    own.run_until(0.1).expect("gases");
    let off = own.all().map(|p| (p.pressure() / PRESSURE - 1.0).abs());
    off.fold(0.0, f64::max)
}

#[test]
fn a_shear_between_gases_rolls_up() {
    Row {
        case: "Kelvin–Helmholtz 2:1, 128²",
        criterion: "growth of the wave over that of linear theory, 0.1 to 0.6 s; control: plain force and viscosity",
        value: growth(schemes::gas().compose(), 128),
        control: growth(plain(), 128),
    }
    .at_least(0.9);
}

#[test]
fn pressure_is_one_where_gases_meet() {
    let [value, control] = [0.5, 0.0].map(|conduction| jump(conducting(conduction), 64));
    Row {
        case: "sliding contact 2:1, 64²",
        criterion: "largest error of pressure, 0.1 s; artificial conduction, control without",
        value,
        control,
    }
    .at_most(0.1);
}
