//! Rods that meet at 20 m/s: plateaus, fronts, arrivals and contact times against a Godunov solution
//! with the same equation of state, at a spacing of 0.05 mm.

use meshfree::boundary::MirrorPlane;
use meshfree::integrator::{KickDriftKick, LamLeapfrog};
use meshfree::kernel::CubicSpline;
use meshfree::material::catalogue;
use meshfree::material::eos::{Hugoniot, MieGruneisen};
use meshfree::scene::{Body, Scene};
use meshfree::scheme::{DensityForm, EnergyForm, Scheme, SchemeBuilder};
use meshfree::schemes;
use meshfree::simulation::Simulation;
use meshfree::study::godunov_rods::{GodunovRods, GodunovSolution, RodSegment};
use meshfree::study::norms::{arrival, overshoot, plateau_mean, rise_10_90};
use meshfree::study::{Contact, End, Joint};
use meshfree::sweep::Interaction;
use meshfree::term::viscosity::MonaghanGingold;
use std::sync::Arc;

const DX: f64 = 5e-5;
const SPEED: f64 = 20.0;
const STRIKER: f64 = 0.01;
const TARGET: f64 = 0.04;

/// What the striker meets, and the pressure \[MPa\] of the first plateau.
const TARGETS: [(&str, f64); 5] = [
    ("wall", 709.01),
    ("copper", 353.17),
    ("steel", 313.49),
    ("aluminium", 205.46),
    ("pmma", 57.44),
];

fn law(name: &str) -> (Arc<MieGruneisen>, f64) {
    let (rho, c, s, gamma) = match name {
        "copper" => (8930.0, 3940.0, 1.49, 2.02),
        "steel" => (7850.0, 3570.0, 1.92, 1.8),
        "aluminium" => (2700.0, 5350.0, 1.34, 2.0),
        _ => (1190.0, 2600.0, 1.52, 1.0),
    };
    let law = MieGruneisen::new(rho, c, s, gamma).with_form(Hugoniot::LamCubic);
    (Arc::new(law), rho)
}

fn scene(scheme: impl Into<Scheme<f64, 1>>, target: &str, contact: Interaction) -> Scene<f64, 1> {
    let striker =
        Body::block("striker", catalogue::copper(), [0.0], [STRIKER], DX).velocity([SPEED]);
    let scene = Scene::new(scheme).body(striker);
    if target == "wall" {
        return scene.boundary(MirrorPlane::wall([STRIKER], [1.0]));
    }
    let material = catalogue::by_name(target).unwrap();
    scene
        .body(Body::block(
            "target",
            material,
            [STRIKER],
            [STRIKER + TARGET],
            DX,
        ))
        .between("striker", "target", contact)
}

/// Histories of a run.
#[derive(Default)]
struct History {
    time: Vec<f64>,
    /// Pressure 5 mm from the free end of the striker \[Pa\].
    middle: Vec<f64>,
    /// Pressure 15 mm from it, in the target \[Pa\].
    target: Vec<f64>,
    /// What the striker feels from the other side \[N/m²\].
    contact: Vec<f64>,
    /// Worst change of momentum over that of the impact.
    momentum: f64,
    /// Worst change of energy over that of the impact.
    energy: f64,
}

fn between(simulation: &Simulation<f64, 1>, body: usize, k: usize) -> f64 {
    let mut around = simulation.body(body).unwrap().skip(k - 1).take(2);
    0.5 * around
        .by_ref()
        .map(|particle| particle.pressure())
        .sum::<f64>()
}

fn record(simulation: &mut Simulation<f64, 1>, until: f64) -> History {
    let start = simulation.ledger().whole;
    let (p0, e0) = (start.momentum[0], start.kinetic);
    let mut history = History::default();
    simulation
        .run_with(until, |now| {
            history.time.push(now.time());
            history.middle.push(between(now, 0, 100));
            if now.bodies().count() > 1 {
                history.target.push(between(now, 1, 100));
            }
            history.contact.push(-now.force_between(0, 1).unwrap()[0]);
            let ledger = now.ledger();
            let momentum = ledger.whole.momentum[0] - ledger.boundary_impulse[0] - p0;
            history.momentum = history.momentum.max((momentum / p0).abs());
            let energy = (ledger.whole.total_energy() - start.total_energy()) / e0;
            history.energy = history.energy.max(energy.abs());
        })
        .unwrap();
    history
}

fn reference(target: &str, contact: Contact, until: f64) -> GodunovSolution {
    let (copper, rho) = law("copper");
    let striker = RodSegment::at_rest(copper, STRIKER, rho).moving(SPEED);
    let rods = if target == "wall" {
        GodunovRods::new(1600).segment(striker).right_end(End::Wall)
    } else {
        let (law, rho) = law(target);
        GodunovRods::new(4000)
            .segment(striker)
            .contact(contact)
            .segment(RodSegment::at_rest(law, TARGET, rho))
            .gauge(STRIKER + 0.005)
    };
    rods.gauge(0.005).solve(until).unwrap()
}

fn gauge(solution: &GodunovSolution, x0: f64) -> (&[f64], Vec<f64>) {
    let gauge = solution
        .gauges()
        .iter()
        .find(|g| (g.x0 - x0).abs() < 1e-12)
        .unwrap();
    (
        &gauge.time,
        gauge.stress.iter().map(|stress| -stress).collect(),
    )
}

/// The middle 70 % of an interval.
fn central(from: f64, to: f64) -> (f64, f64) {
    (from + 0.15 * (to - from), to - 0.15 * (to - from))
}

/// First plateau at 5 mm: mean \[MPa\], overshoot, rise \[µs\] and arrival \[µs\].
fn first_plateau(history: &History, pressure: f64) -> (f64, f64, f64, f64) {
    let (t, p) = (&history.time, &history.middle);
    // In by compression, out by the rarefaction from the free end.
    let (from, to) = central(1.26e-6, 3.79e-6);
    let mean = plateau_mean(t, p, from, to).unwrap();
    let end = t.partition_point(|t| *t < 3.6e-6);
    (
        mean / 1e6,
        overshoot(&p[..end], 0.0, pressure * 1e6).unwrap(),
        rise_10_90(t, p, 0.0, mean).unwrap() * 1e6,
        arrival(t, p, 0.0, mean).unwrap() * 1e6,
    )
}

fn bars_hold(scheme: impl Fn() -> Scheme<f64, 1>, target: &str, pressure: f64) {
    let mut simulation = scene(scheme(), target, Interaction::Unilateral)
        .build()
        .unwrap();
    assert!(
        simulation.all().all(|p| p.pressure() == 0.0),
        "stress before the impact"
    );
    let history = record(&mut simulation, 5.1e-6);
    let exact = reference(target, Contact::Unilateral, 5.1e-6);
    let (time, stress) = gauge(&exact, 0.005);
    let expected = arrival(time, &stress, 0.0, pressure * 1e6).unwrap() * 1e6;
    let (mean, over, rise, arrived) = first_plateau(&history, pressure);
    let velocity = 0.5
        * simulation
            .body(0)
            .unwrap()
            .skip(99)
            .take(2)
            .map(|p| p.velocity()[0])
            .sum::<f64>();
    let record = &exact.gauges().iter().find(|g| g.x0 == 0.005).unwrap();
    let rebound = *record.velocity.last().unwrap();
    println!(
        "{target}: plateau {mean:.2} MPa ({:+.3} %), overshoot {:.2} %, rise {rise:.4} us, arrival {arrived:.4} us \
         ({:+.4}), momentum {:.1e}, energy {:.1e}, velocity after {velocity:.4} m/s ({:+.4})",
        100.0 * (mean / pressure - 1.0),
        100.0 * over,
        arrived - expected,
        history.momentum,
        history.energy,
        velocity - rebound,
    );
    assert!(
        (mean / pressure - 1.0).abs() < 0.005,
        "{target}: plateau {mean} MPa"
    );
    assert!(over <= 0.03, "{target}: overshoot {over}");
    assert!(rise <= 0.14, "{target}: rise {rise} us");
    assert!(
        (arrived - expected).abs() < 0.01,
        "{target}: arrival {arrived} us, expected {expected}"
    );
    assert!(
        (velocity - rebound).abs() < 0.003 * SPEED,
        "{target}: velocity {velocity}, expected {rebound}"
    );
    assert!(
        history.momentum < 1e-12,
        "{target}: momentum {}",
        history.momentum
    );
    assert!(
        history.energy < 1e-11,
        "{target}: energy {}",
        history.energy
    );
}

#[test]
fn number_density_meets_the_bars_for_every_target() {
    for (target, pressure) in TARGETS {
        bars_hold(|| schemes::impact().compose(), target, pressure);
    }
}

#[test]
fn continuity_meets_the_bars_for_every_target() {
    for (target, pressure) in TARGETS {
        bars_hold(
            || schemes::impact_by_continuity().compose(),
            target,
            pressure,
        );
    }
}

/// Last time \[µs\] at which a contact presses with more than 1 % of the plateau.
fn last_press(time: &[f64], pressure: &[f64], plateau: f64) -> f64 {
    let k = pressure.iter().rposition(|p| *p > 0.01 * plateau).unwrap();
    time[k] * 1e6
}

fn contact_opens_in_time(scheme: impl Into<Scheme<f64, 1>>) {
    let until = 16e-6;
    let mut simulation = scene(scheme, "aluminium", Interaction::Unilateral)
        .build()
        .unwrap();
    let history = record(&mut simulation, until);
    let exact = reference("aluminium", Contact::Unilateral, until);
    let joint = exact.joint(Joint::Between(0)).unwrap();
    let expected = last_press(&joint.time, &joint.pressure, 205.46e6);
    let found = last_press(&history.time, &history.contact, 205.46e6);
    // Second and third plateaus in the target, each after a round trip in the striker.
    let (time, stress) = gauge(&exact, 0.015);
    let mut steps = Vec::new();
    for k in 1..=2 {
        let round = 2.0 * STRIKER / 3960.0;
        let start = 0.005 / 5370.0 + f64::from(k) * round;
        let (from, to) = central(start + 0.2e-6, (start + round).min(14.0e-6));
        let (a, b) = (
            plateau_mean(&history.time, &history.target, from, to).unwrap() / 1e6,
            plateau_mean(time, &stress, from, to).unwrap() / 1e6,
        );
        steps.push((a, b));
    }
    println!(
        "aluminium opens at {found:.3} us, expected {expected:.3}; plateaus at 15 mm {steps:.2?}"
    );
    assert!((expected - 14.9).abs() < 0.15, "reference {expected}");
    assert!(
        (found / expected - 1.0).abs() < 0.01,
        "opens at {found} us, expected {expected}"
    );
    for (found, expected) in steps {
        assert!(
            (found - expected).abs() < 0.01 * 205.46,
            "{found} instead of {expected} MPa"
        );
    }
}

#[test]
fn the_contact_with_aluminium_opens_in_time_with_number_density() {
    contact_opens_in_time(schemes::impact());
}

#[test]
fn the_contact_with_aluminium_opens_in_time_with_continuity() {
    contact_opens_in_time(schemes::impact_by_continuity());
}

#[test]
fn a_mirror_wall_is_the_other_half_of_a_symmetric_impact() {
    for scheme in [schemes::impact, schemes::impact_by_continuity] {
        let mut wall = scene(scheme(), "wall", Interaction::Unilateral)
            .build()
            .unwrap();
        let other = Body::block("other", catalogue::copper(), [STRIKER], [2.0 * STRIKER], DX);
        let mut pair = Scene::<f64, 1>::new(scheme())
            .body(
                Body::block("striker", catalogue::copper(), [0.0], [STRIKER], DX).velocity([SPEED]),
            )
            .body(other.velocity([-SPEED]))
            .build()
            .unwrap();
        let mut worst = 0.0_f64;
        for until in [2.5e-6, 4e-6, 6e-6] {
            wall.run_until(until).unwrap();
            pair.run_until(until).unwrap();
            for (a, b) in wall.body(0).unwrap().zip(pair.body(0).unwrap()) {
                worst = worst.max((a.pressure() - b.pressure()).abs() / 709e6);
            }
            println!(
                "  at {until}: {worst:.1e}, {} and {} steps",
                wall.steps(),
                pair.steps()
            );
        }
        println!("wall against pair: {worst:.1e} of the plateau");
        assert!(worst < 1e-9, "{worst:.1e}");
    }
}

#[test]
fn an_interface_that_no_wave_has_reached_feels_nothing() {
    for scheme in [schemes::impact, schemes::impact_by_continuity] {
        let mut simulation = Scene::<f64, 1>::new(scheme())
            .body(
                Body::block("striker", catalogue::copper(), [0.0], [STRIKER], DX).velocity([SPEED]),
            )
            .body(Body::block("pad", catalogue::pmma(), [0.01], [0.02], DX).velocity([SPEED]))
            .body(Body::block(
                "target",
                catalogue::copper(),
                [0.02],
                [0.04],
                DX,
            ))
            .between("striker", "pad", Interaction::Bonded)
            .build()
            .unwrap();
        assert!(simulation.all().all(|p| p.pressure() == 0.0));
        // The wave needs 3.8 us through the pad.
        simulation.run_until(3e-6).unwrap();
        let hit = simulation.body(1).unwrap().last().unwrap().pressure();
        assert!(hit > 50e6, "the target was not hit: {hit}");
        let near = simulation
            .body(0)
            .unwrap()
            .skip(190)
            .chain(simulation.body(1).unwrap().take(10));
        let most = near.fold(0.0_f64, |m, p| m.max(p.pressure().abs()));
        println!(
            "stress at the joint ahead of the wave: {:.1e} of the plateau",
            most / 104.6e6
        );
        assert!(most < 1e-9 * 104.6e6, "{most} Pa");
    }
}

#[test]
fn lams_scheme_runs_every_target_with_its_own_errors() {
    for (target, pressure) in TARGETS {
        let mut simulation = scene(schemes::lam2002(), target, Interaction::Bonded)
            .integrator(LamLeapfrog::default())
            .build()
            .unwrap();
        let history = record(&mut simulation, 5.1e-6);
        let (mean, over, rise, arrived) = first_plateau(&history, pressure);
        println!(
            "lam2002, {target}: plateau {mean:.2} MPa ({:+.3} %), overshoot {:.2} %, rise {rise:.4} us, \
             arrival {arrived:.4} us, momentum {:.1e}, energy {:.1e}",
            100.0 * (mean / pressure - 1.0),
            100.0 * over,
            history.momentum,
            history.energy
        );
        assert!(
            (mean / pressure - 1.0).abs() < 0.005,
            "{target}: {mean} MPa"
        );
        assert!(rise > 0.14, "{target}: as steep as the default, {rise} us");
        assert!(
            arrived < 1.255,
            "{target}: waves are no longer 2 % too fast, {arrived} us"
        );
        assert!(
            history.momentum < 1e-12,
            "{target}: momentum {}",
            history.momentum
        );
        assert!(history.energy < 1e-2, "{target}: energy {}", history.energy);
    }
}

#[test]
fn equation_25_on_every_particle_hides_the_compression() {
    let scheme = schemes::lam2002().density(DensityForm::Normalised);
    let mut simulation = scene(scheme, "copper", Interaction::Bonded)
        .integrator(LamLeapfrog::default())
        .build()
        .unwrap();
    let history = record(&mut simulation, 3.6e-6);
    let mean = plateau_mean(&history.time, &history.middle, 1.7e-6, 3.4e-6).unwrap() / 1e6;
    println!("equation 25 everywhere: {mean:.4} MPa instead of 353");
    assert!(mean.abs() < 3.5, "{mean} MPa");
}

/// Change of energy over that of the impact, and the plateau over the exact one, at a bonded joint of
/// copper and PMMA.
fn joint(pressure_form: Option<DensityForm>) -> Option<(f64, f64)> {
    let mut scheme = SchemeBuilder::new(CubicSpline, MonaghanGingold::default())
        .density(DensityForm::Continuity)
        .energy(EnergyForm::Symmetric)
        .without_consistency_factor();
    if let Some(form) = pressure_form {
        scheme = scheme.mismatched_pressure_form(form);
    }
    let mut simulation = scene(scheme, "pmma", Interaction::Bonded)
        .integrator(KickDriftKick)
        .build()
        .unwrap();
    let start = simulation.ledger().whole;
    let mut plateau = (0.0, 0);
    let run = simulation.run_with(3.6e-6, |now| {
        if now.time() > 1.7e-6 {
            plateau = (plateau.0 + between(now, 0, 100), plateau.1 + 1);
        }
    });
    run.ok()?;
    let end = simulation.ledger().whole;
    Some((
        (end.total_energy() - start.total_energy()) / start.kinetic,
        plateau.0 / f64::from(plateau.1) / 57.44e6,
    ))
}

#[test]
fn a_mixed_pair_of_density_and_pressure_breaks_a_joint_and_the_matched_pair_does_not() {
    let (energy, plateau) = joint(None).unwrap();
    println!("matched: energy {energy:+.1e}, plateau {plateau:.4}");
    assert!(
        energy.abs() < 1e-3 && (plateau - 1.0).abs() < 0.01,
        "{energy:.1e}, {plateau}"
    );
    match joint(Some(DensityForm::Summation)) {
        None => println!("mixed: exploded"),
        Some((energy, plateau)) => {
            println!("mixed: energy {energy:+.1e}, plateau {plateau:.4}");
            assert!(
                energy.abs() > 0.02 || (plateau - 1.0).abs() > 0.1,
                "{energy:.1e}, {plateau}"
            );
        }
    }
}
