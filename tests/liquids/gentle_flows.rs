//! Gentle and closed flows of liquids against exact solutions, at resolutions that take seconds.
//! The programs of the same names take the full ones; docs/liquids.md has their values.

use crate::tank::{after_rest, swings};
use meshfree::boundary::Wall;
use meshfree::kernel::{WendlandC2, WendlandC6};
use meshfree::material::rheology::PowerLaw;
use meshfree::material::{Liquid, Material, SoundSpeed};
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::scheme::Shifting;
use meshfree::study::channel::{Couette, Poiseuille, PowerLawPoiseuille};
use meshfree::study::taylor_green::TaylorGreen;
use meshfree::study::work_precision::relative_l2;
use meshfree::term::viscosity::{Inviscid, MonaghanGingold};
use meshfree::term::{
    Antuono, CentralViscosity, Fourtakas, LaminarViscosity, Molteni, PressureForce,
};

type Viscous<R> = SchemeBuilder<
    WendlandC2,
    Inviscid,
    ExtrapolatedPressure,
    (
        (
            (((), PressureForce), Cavitation),
            DensityDiffusion<Fourtakas>,
        ),
        Laminar<R>,
    ),
>;

/// A liquid with a physical viscosity and nothing else that takes energy from shear.
fn viscous<R>(viscosity: R) -> Viscous<R> {
    schemes::weakly_compressible()
        .with_viscosity(Inviscid)
        .with(Laminar(viscosity))
}

/// At h/dx 2; what is diffused must not be the hydrostatic pressure itself, as Molteni's form does.
#[test]
fn a_column_at_rest_stays_so_unless_its_own_pressure_is_diffused() {
    let scheme = || schemes::weakly_compressible().h_over_dx(2.0);
    let fourtakas = after_rest(scheme());
    let antuono = after_rest(scheme().density_diffusion(Antuono::default()));
    let riemann_walls = after_rest(scheme().walls(RiemannWalls::default()));
    let molteni = after_rest(scheme().density_diffusion(Molteni::default()));
    let text = format!("RMS, rise, v/c: {fourtakas:?} {antuono:?} {riemann_walls:?} {molteni:?}");
    println!("{text}");
    for [rms, rise, speed] in [fourtakas, antuono, riemann_walls] {
        assert!(rms < 0.01 && rise.abs() < 0.5 && speed < 1e-4, "{text}");
    }
    assert!(molteni[0] > 0.01 || molteni[1].abs() > 0.5, "{text}");
}

/// Two periods of a standing wave within 0.5 %. With renormalised gradients it is 0.54 % off on 20 particles over
/// the depth.
#[test]
fn a_standing_wave_keeps_its_period() {
    let scheme = || schemes::weakly_compressible().renormalised();
    let plain = swings(schemes::weakly_compressible());
    let riemann_walls = swings(schemes::weakly_compressible().walls(RiemannWalls::default()));
    let renormalised = swings(scheme());
    let text = format!(
        "period over the exact one, crest over crest: {plain:?} {riemann_walls:?} {renormalised:?}"
    );
    println!("{text}");
    assert!((plain[0] - 1.0).abs() < 0.005, "{text}");
    assert!((riemann_walls[0] - 1.0).abs() < 0.005, "{text}");
    assert!((renormalised[0] - 1.0).abs() < 0.01, "{text}");
}

/// 40 particles a wavelength: corrected gradients keep the height of a wave within 1 % a period, from which the artificial viscosity
/// of the control alone takes more.
#[test]
fn a_standing_wave_keeps_its_height_with_corrected_gradients() {
    let viscosity = |alpha| MonaghanGingold { alpha, beta: 0.0 };
    let scheme = || schemes::weakly_compressible();
    let [period, crest] = swings(scheme().with_viscosity(viscosity(0.005)).renormalised());
    let [_, control] = swings(scheme());
    let text = format!("period {period}, second crest {crest}, control {control}");
    println!("{text}");
    assert!((crest - 1.0).abs() < 0.01, "{text}");
    assert!((period - 1.0).abs() < 0.01, "{text}");
    assert!(control < 0.96, "{text}");
}

const WIDTH: f64 = 1e-3;
const VISCOSITY: f64 = 1e-6;
const SPEED: f64 = 1.25e-5;
const FORCE: f64 = 1e-4;

/// The largest error of the velocity over [`SPEED`] at the times, with `count` particles across.
fn channel(
    count: f64,
    material: Material<f64>,
    slide: f64,
    force: f64,
    times: &[f64],
    exact: impl Fn(f64, f64) -> f64,
) -> f64 {
    let mut flow = between_plates(count, material, slide, force);
    let mut worst = 0.0_f64;
    for &time in times {
        flow.run_until(time).expect("a run");
        worst = worst.max(largest_error(&flow, |y| exact(y, time)));
    }
    worst
}

fn largest_error(flow: &Simulation<f64, 2>, exact: impl Fn(f64) -> f64) -> f64 {
    let errors = flow.all().map(|particle| {
        let (y, u) = (particle.position()[1], particle.velocity()[0]);
        (u - exact(y)).abs() / SPEED
    });
    errors.fold(0.0, f64::max)
}

/// A liquid between plates, of which the upper slides or which a force drives.
fn between_plates(
    count: f64,
    material: Material<f64>,
    slide: f64,
    force: f64,
) -> Simulation<f64, 2> {
    let spacing = WIDTH / count;
    let length = 10.0 * spacing;
    let plate = |name, low: f64| {
        let high = low + 4.0 * spacing;
        let water = meshfree::material::catalogue::water();
        let points = Body::<f64, 2>::block(name, water, [0.0, low], [length, high], spacing);
        Wall::of(name, points.points().to_vec(), spacing).no_slip()
    };
    let scheme = viscous(LaminarViscosity)
        .with(GeneralisedNewtonian)
        .walls(ExtrapolatedPressure {
            floor: f64::NEG_INFINITY,
        });
    Scene::<f64, 2>::new(scheme)
        .body(Body::block(
            "liquid",
            material,
            [0.0; 2],
            [length, WIDTH],
            spacing,
        ))
        .wall(plate("lower", -4.0 * spacing))
        .wall(plate("upper", WIDTH).sliding([slide, 0.0]))
        .boundary(Periodic::along(0, 0.0, length))
        .acceleration(move |_| [force, 0.0])
        .build()
        .expect("a channel")
}

fn water() -> Material<f64> {
    let water = Liquid::new(1000.0, 1480.0, 1000.0 * VISCOSITY);
    water.material("water", SoundSpeed::Chosen(100.0 * SPEED))
}

#[test]
fn couette_flow_starts_and_settles() {
    let exact = Couette::new(WIDTH, SPEED, VISCOSITY).expect("plates");
    let at = |y, t| exact.velocity(y, t).expect("inside");
    let error = channel(32.0, water(), SPEED, 0.0, &[0.05, 0.2, 1.0], at);
    let text = format!("largest error {:.2} % of the plate's speed", 100.0 * error);
    println!("{text}");
    assert!(error < 0.01, "{text}");
}

#[test]
fn poiseuille_flow_starts_and_settles() {
    let exact = Poiseuille::new(WIDTH, FORCE, VISCOSITY).expect("plates");
    let at = |y, t| exact.velocity(y, t).expect("inside");
    let error = channel(32.0, water(), 0.0, FORCE, &[0.05, 0.2, 1.0], at);
    let text = format!("largest error {:.2} % of the greatest speed", 100.0 * error);
    println!("{text}");
    assert!(error < 0.01, "{text}");
}

/// A liquid whose stress goes with the root of the shear rate; as Newtonian it would be 30 % off.
#[test]
#[ignore = "takes 11 s"]
fn a_liquid_that_thins_flows_as_its_law_says() {
    let index = 0.5;
    let shape = index / (index + 1.0) * (0.5 * WIDTH).powf(1.0 + 1.0 / index);
    let consistency = 1000.0 * FORCE * (shape / SPEED).powf(index);
    let greatest = 10.0 * 1000.0 * VISCOSITY;
    let law = PowerLaw::new(consistency, index, 1e-2 * greatest, greatest);
    let exact = PowerLawPoiseuille::new(WIDTH, 1000.0 * FORCE, consistency, index);
    let exact = exact.expect("plates");
    let at = |y, _| exact.velocity(y).expect("inside");
    let liquid = water().with_rheology(law);
    let mut flow = between_plates(32.0, liquid, 0.0, FORCE);
    flow.run_until(1.0).expect("a run");
    let error = largest_error(&flow, |y| at(y, 1.0));
    let text = format!("largest error {:.2} % of the greatest speed", 100.0 * error);
    println!("{text}");
    assert!(error < 0.02, "{text}");
    // The Newtonian parabola differs from it where the law matters.
    let parabola = Poiseuille::new(WIDTH, FORCE, VISCOSITY).expect("plates");
    let y = 0.25 * WIDTH;
    let apart = (parabola.steady(y).expect("inside") - at(y, 0.0)).abs() / SPEED;
    assert!(apart > 0.1, "{apart}");
}

/// Taylor–Green vortices at Re 100 on so many particles squared, as they start.
fn vortices(scheme: impl Into<Scheme<f64, 2>>, count: u32) -> (TaylorGreen, Simulation<f64, 2>) {
    let exact = TaylorGreen::new(100.0).expect("vortices");
    let liquid = Liquid::new(1.0, 1480.0, exact.kinematic_viscosity()).linear();
    let material = liquid.material("liquid", SoundSpeed::Chosen(10.0));
    let dx = 1.0 / f64::from(count);
    let body = Body::block("liquid", material, [0.0; 2], [1.0; 2], dx);
    let body = body.start(|x, start| Start {
        velocity: exact.velocity(x, 0.0),
        density: 1.0 + exact.pressure(x, 0.0) / 100.0,
        ..start
    });
    let vortices = Scene::new(scheme)
        .body(body)
        .boundary(Periodic::along(0, 0.0, 1.0))
        .boundary(Periodic::along(1, 0.0, 1.0))
        .build()
        .expect("vortices");
    (exact, vortices)
}

/// Until the speed has halved.
#[test]
fn vortices_decay_by_viscosity_alone() {
    let scheme = viscous(LaminarViscosity).with(Shifting::CLOSED);
    let (exact, mut vortices) = vortices(scheme, 50);
    for (time, bar) in [(0.5, 0.005), (0.88, 0.01)] {
        vortices.run_until(time).expect("a run");
        let energy = vortices.ledger().whole.kinetic / exact.kinetic_energy(time);
        let text = format!(
            "speed {:+.2} % off at {time} s",
            100.0 * (energy.sqrt() - 1.0)
        );
        println!("{text}");
        assert!((energy.sqrt() - 1.0).abs() < bar, "{text}");
    }
}

/// With more neighbours the rate at which they decay is within 0.2 % and the pressure within 3 % at 100², and both converge.
#[test]
fn vortices_converge_with_many_neighbours() {
    let errors = |count: u32| {
        let scheme = SchemeBuilder::liquid(WendlandC6, Inviscid)
            .with(DensityDiffusion(Fourtakas::default()))
            .with(Laminar(LaminarViscosity))
            .with(Shifting::CLOSED)
            .h_over_dx(2.5);
        let (exact, mut vortices) = vortices(scheme, count);
        let energy = |now: &Simulation<f64, 2>| now.ledger().whole.kinetic;
        let start = energy(&vortices);
        vortices.run_until(1.0).expect("a run");
        let exact_start = exact.kinetic_energy(0.0) / exact.kinetic_energy(1.0);
        let rate = (start / energy(&vortices)).ln() / exact_start.ln();
        let mean = vortices.all().map(|p| p.pressure()).sum::<f64>() / f64::from(count * count);
        let pressures = vortices.all();
        let pressure = relative_l2(pressures.map(|p| {
            let own = exact.pressure(p.position(), 1.0);
            (p.pressure() - mean, own, 1.0)
        }));
        println!(
            "{count}²: rate {rate}, pressure {:.2} % off",
            100.0 * pressure
        );
        [(rate - 1.0).abs(), pressure]
    };
    let [coarse, fine] = [errors(64), errors(100)];
    assert!(fine[0] < 0.002 && fine[1] < 0.03, "{fine:?}");
    assert!(
        fine[0] < coarse[0] && fine[1] < coarse[1],
        "{coarse:?} {fine:?}"
    );
}

/// Share of its angular momentum that a drop loses whose inside turns faster than its rim.
fn spin_lost(scheme: impl Into<Scheme<f64, 2>>) -> f64 {
    let material = Liquid::new(1000.0, 1480.0, 1.0).linear();
    let material = material.material("liquid", SoundSpeed::Chosen(10.0));
    let drop = Body::fill("drop", material, &Ball::new([0.0; 2], 0.1), 0.01);
    let drop = drop.start(|[x, y], start| {
        let rate = 5.0 * (1.0 - 50.0 * (x * x + y * y));
        Start {
            velocity: [-rate * y, rate * x],
            ..start
        }
    });
    let mut drop = Scene::<f64, 2>::new(scheme)
        .body(drop)
        .build()
        .expect("a drop");
    let spin = |now: &Simulation<f64, 2>| {
        let each = now.all().map(|p| {
            let ([x, y], [u, v]) = (p.position(), p.velocity());
            p.mass() * (x * v - y * u)
        });
        each.sum::<f64>()
    };
    let before = spin(&drop);
    drop.run_until(0.05).expect("a run");
    1.0 - spin(&drop) / before
}

#[test]
fn only_the_viscosity_along_centres_keeps_angular_momentum() {
    let central = spin_lost(viscous(CentralViscosity));
    let laminar = spin_lost(viscous(LaminarViscosity));
    let text = format!("lost {central:.1e} along centres, {laminar:.1e} otherwise");
    println!("{text}");
    assert!(central.abs() < 1e-12, "{text}");
    assert!(laminar.abs() > 1e-3, "{text}");
}
