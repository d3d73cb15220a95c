//! A square patch of liquid that spins: tension inside, corners that become arms, one-sided surfaces everywhere.
//! Others clump and tear (Le Touzé, Colagrossi, Colicchio & Greco 2013); the cure is three effects together.

use super::harness::{Cures, Row, Varied, largest_piece, same_bits, seed};
use meshfree::material::SoundSpeed;
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::simulation::{StabilityReport, Thresholds};
use std::f64::consts::PI;

const SOUND: f64 = 10.0;
const RHO: f64 = 1000.0;

/// The pressure \[Pa\] of the incompressible patch of unit side that starts to spin at 1/s, as a double sine series of
/// ∇²p = 2 ρ ω² with p = 0 on the sides, (0, 0) being a corner.
fn pressure([x, y]: [f64; 2]) -> f64 {
    let odd = || (1..60).step_by(2).map(f64::from);
    let term = |m: f64, n: f64| {
        let wave = (m * PI * x).sin() * (n * PI * y).sin();
        -32.0 * RHO * wave / (m * n * PI * PI * (m * m + n * n) * PI * PI)
    };
    odd().flat_map(|m| odd().map(move |n| term(m, n))).sum()
}

/// The patch with `count` particles along a side, each displaced by up to a hundredth of the spacing.
pub fn patch(cures: Cures, count: usize) -> Simulation<f64, 2> {
    let water = catalogue::water_at(SoundSpeed::Chosen(SOUND));
    let spin = |[x, y]: [f64; 2], start| Start {
        velocity: [y, -x],
        density: RHO + pressure([x + 0.5, y + 0.5]) / (SOUND * SOUND),
        ..start
    };
    let spacing = 1.0 / count as f64;
    let body = Body::block("patch", water, [-0.5; 2], [0.5; 2], spacing)
        .jitter(0.01, seed(1))
        .start(spin);
    let scene = Scene::new(cures.liquid()).body(body);
    scene.varied().build().expect("a patch")
}

/// Σ m (x v − y u).
fn spin(simulation: &Simulation<f64, 2>) -> f64 {
    let of = |([x, y], [u, v]): ([f64; 2], [f64; 2])| x * v - y * u;
    let all = simulation.all();
    all.map(|p| p.mass() * of((p.position(), p.velocity())))
        .sum()
}

/// What a run gave: the report, the share of the largest piece, and the change of angular momentum.
fn outcome(cures: Cures, count: usize) -> (StabilityReport, f64, f64) {
    let mut simulation = patch(cures, count);
    simulation.keep_stability(Thresholds {
        nearest: 0.5,
        every: 25,
        ..Thresholds::default()
    });
    let before = spin(&simulation);
    simulation.run_until(4.0).expect("a run");
    let report = simulation.stability();
    println!("{cures:?}\n{report}");
    let piece = largest_piece(&simulation, 2.0 / count as f64);
    (report, piece, spin(&simulation) / before - 1.0)
}

fn holds(count: usize, case: &'static str) {
    let (cured, whole, turned) = outcome(Cures::EVEN, count);
    let (plain, torn, _) = outcome(Cures::NONE, count);
    let shifting = Cures {
        shifting: Shifting::STANDARD,
        ..Cures::NONE
    };
    let (shifted, _, _) = outcome(shifting, count);
    let nearest = |report: &StabilityReport| report.nearest.as_ref().map_or(0.0, |n| n.value);
    let row = |criterion, value, control| Row {
        case,
        criterion,
        value,
        control,
    };
    row("nearest pair to t ω = 4", nearest(&cured), nearest(&plain)).at_least(0.5);
    row(
        "the same, control with shifting",
        nearest(&cured),
        nearest(&shifted),
    )
    .at_least(0.5);
    row("share of the largest piece", whole, torn).at_least(0.999);
    row("clumping", 1.0 - mean(&cured), 1.0 - mean(&plain)).at_most(0.2);
    let void = cured.void.as_ref().map_or(f64::NAN, |void| void.0);
    println!("void {void}, change of angular momentum {turned:.4}");
    assert!(void < 1.5 && turned.abs() < 0.01, "{void} {turned}");
    assert!(cured.verdict.is_stable(), "{cured}");
    assert!(
        plain.verdict.breaks("nearest") && plain.verdict.breaks("clumping"),
        "{plain}"
    );
    let breach = &plain.verdict.breaches[0];
    // The first pairs appear where the tension is largest, in the middle, before t ω = 1.
    let at = breach.at.as_ref().expect("a place");
    assert!(
        at.time < 1.0 && at.position.iter().all(|x| x.abs() < 0.2),
        "{at}"
    );
}

fn mean(report: &StabilityReport) -> f64 {
    report.arrangement.map_or(0.0, |now| now.mean)
}

#[test]
fn a_spinning_square_patch_keeps_its_particles_apart_and_its_arms_whole() {
    holds(50, "spinning square patch, 50²");
}

#[test]
#[ignore = "100 s on two cores in release"]
fn so_does_a_patch_of_twice_the_resolution() {
    holds(100, "spinning square patch, 100²");
}

#[test]
fn threads_do_not_change_a_bit_and_watching_neither() {
    same_bits(|| {
        let mut simulation = patch(Cures::EVEN, 20);
        simulation.keep_stability(Thresholds::default());
        simulation.run_until(0.5).expect("a run");
        simulation
    });
    let run = |watched: bool| {
        let mut simulation = patch(Cures::EVEN, 20);
        if watched {
            simulation.keep_stability(Thresholds {
                every: 1,
                ..Thresholds::default()
            });
        }
        simulation.run_until(0.2).expect("a run");
        let all = simulation.all().map(|p| p.position().map(f64::to_bits));
        all.collect::<Vec<_>>()
    };
    assert!(run(true) == run(false));
}
