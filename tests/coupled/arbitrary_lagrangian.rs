//! Liquids whose particles do not follow the flow: what they exchange is kept, converges, and stays in its tank.
//! Taylor's vortices are the exact solution; a tank at 30 g is the violent case.

use approx::assert_relative_eq;
use meshfree::effect::{ArbitraryLagrangian, ConsistentShifting, Eulerian, Laminar};
use meshfree::material::{Liquid, Material, SoundSpeed};
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::study::taylor_green::TaylorGreen;
use meshfree::term::viscosity::{Inviscid, MonaghanGingold};
use meshfree::term::{InternalEnergy, LaminarViscosity};

/// Vortices in a periodic square of 1 m and 1 m/s at the Reynolds number 100, on a lattice that is displaced by a share of its spacing.
fn vortices(scheme: Scheme<f64, 2>, across: f64, sound: f64, displaced: f64) -> Simulation<f64, 2> {
    let flow = TaylorGreen::new(100.0).unwrap();
    let liquid: Material<f64> = Liquid::new(1.0, 1480.0, flow.kinematic_viscosity())
        .linear()
        .material("liquid", SoundSpeed::Chosen(sound));
    let body = Body::block("liquid", liquid, [0.0; 2], [1.0; 2], 1.0 / across)
        .jitter(displaced, 1)
        .start(move |x, start| Start {
            velocity: flow.velocity(x, 0.0),
            density: 1.0 + flow.pressure(x, 0.0) / (sound * sound),
            ..start
        });
    let scene = Scene::new(scheme)
        .body(body)
        .boundary(Periodic::along(0, 0.0, 1.0))
        .boundary(Periodic::along(1, 0.0, 1.0));
    scene.build().unwrap()
}

/// Mass \[kg/m\], momentum \[kg/s\], energy of motion and heat \[J/m\], volume \[m²\].
fn totals(now: &Simulation<f64, 2>) -> [f64; 5] {
    let mut all = [0.0; 5];
    for p in now.all() {
        let ([u, v], m) = (p.velocity(), p.mass());
        let own = [
            m,
            m * u,
            m * v,
            m * (0.5 * (u * u + v * v) + p.energy()),
            m / p.density(),
        ];
        for (all, own) in all.iter_mut().zip(own) {
            *all += own;
        }
    }
    all
}

/// By how much the greatest speed that belongs to the energy of motion differs from the exact one, over that.
fn error_of_speed(now: &Simulation<f64, 2>) -> f64 {
    let flow = TaylorGreen::new(100.0).unwrap();
    let energy: f64 = now
        .all()
        .map(|p| {
            let [u, v] = p.velocity();
            0.5 * p.mass() * (u * u + v * v)
        })
        .sum();
    (energy / flow.kinetic_energy(now.time())).sqrt() - 1.0
}

fn laminar() -> SchemeBuilder<WendlandC2, Inviscid, ExtrapolatedPressure, impl Effects<2>> {
    schemes::weakly_compressible()
        .with_viscosity(Inviscid)
        .with(Laminar(LaminarViscosity))
}

/// Mass, momentum and energy are kept to rounding, with particles in disorder where they move; masses do change.
#[test]
fn what_is_exchanged_is_kept() {
    let warm = || {
        laminar()
            .with(InternalEnergy)
            .energy(EnergyForm::Compatible)
    };
    let shifting = ConsistentShifting {
        strength: 0.5,
        in_tension: true,
    };
    let moving = warm().with(ArbitraryLagrangian::<true> { shifting });
    let still = warm().with(Eulerian::<true>);
    for (scheme, displaced) in [(moving.compose(), 0.2), (still.compose(), 0.0)] {
        let mut own = vortices(scheme, 16.0, 10.0, displaced);
        let before = totals(&own);
        for _ in 0..100 {
            own.step().unwrap();
        }
        let after = totals(&own);
        assert_relative_eq!(after[0], before[0], max_relative = 1e-13);
        for d in [1, 2] {
            assert!((after[d] - before[d]).abs() < 1e-14, "{after:?}");
        }
        assert_relative_eq!(after[3], before[3], max_relative = 1e-12);
        let own: Vec<_> = own.all().map(|p| p.mass() * 256.0).collect();
        let most = own
            .iter()
            .fold(0.0, |most: f64, own| most.max((own - 1.0).abs()));
        assert!(most > 1e-3, "{most}");
    }
}

/// On a lattice at Mach 0.02 the Eulerian form is of second order, and its volumes stay.
#[test]
fn at_rest_a_lattice_converges_at_second_order() {
    let error = |across| {
        let mut own = vortices(
            laminar().with(Eulerian::<false>).compose(),
            across,
            50.0,
            0.0,
        );
        own.run_until(0.1).unwrap();
        assert_relative_eq!(totals(&own)[4], 1.0, max_relative = 1e-12);
        error_of_speed(&own)
    };
    let order = (error(20.0) / error(40.0)).log2();
    assert!(order > 1.8, "{order}");
}

/// Water at 30 g: those that exchange mass stay in the tank and keep its volume; those that only move leave it.
#[test]
fn water_that_exchanges_mass_stays_in_its_tank() {
    let (size, dx, depth) = ([0.5, 0.3, 0.3], 0.025, 0.175);
    let standard = || {
        schemes::weakly_compressible()
            .h_over_dx(1.5)
            .with_viscosity(MonaghanGingold {
                alpha: 0.002,
                beta: 0.0,
            })
            .walls(ExtrapolatedPressure { floor: 0.0 })
            .with(ExpansionMemory)
    };
    let after = |scheme: Scheme<f64, 3>| {
        let water: Material<f64> = Liquid::water()
            .material("water", SoundSpeed::Chosen(171.0))
            .with_pressure_cut_off(0.0);
        let body = Body::block("water", water, [0.0; 3], [size[0], size[1], depth], dx)
            .jitter(0.15, 1)
            .hydrostatic([0.0, 0.0, -9.81], [0.0, 0.0, depth]);
        let pulse = |t: f64| 30.0 * 9.81 * (std::f64::consts::PI * t / 0.08).sin();
        let mut tank = Scene::new(scheme)
            .body(body)
            .wall(Wall::around("tank", [0.0; 3], size, dx, 3, [[true; 2]; 3]))
            .acceleration(move |t: f64| [pulse(t), 0.0, -9.81])
            .build()
            .unwrap();
        tank.run_until(0.08).unwrap();
        let places = tank.all().map(|p| p.position());
        let outside = |x: &[f64; 3]| (0..3).any(|d| x[d] < -dx || x[d] > size[d] + dx);
        let volume: f64 = tank.all().map(|p| p.mass() / p.density()).sum();
        let built = size[0] * size[1] * depth;
        (places.filter(outside).count(), volume / built - 1.0)
    };
    let (outside, swelling) = after(
        standard()
            .with(ArbitraryLagrangian::<false>::default())
            .compose(),
    );
    assert!(
        outside == 0 && swelling.abs() < 0.005,
        "{outside} outside, {swelling:+e}"
    );
    let (outside, _) = after(standard().with(ConsistentShifting::default()).compose());
    assert!(outside > 10, "{outside} outside: the control stays in too");
}

/// A scheme that carries no heat exchanges none, and mass passes between bodies of one material alone.
#[test]
fn what_cannot_be_exchanged_is_refused() {
    let scheme: Scheme<f64, 2> = laminar().with(Eulerian::<true>).compose();
    let block = |name: &str, from: f64, density: f64| {
        let liquid: Material<f64> =
            Liquid::new(density, 1480.0, 1e-6).material("liquid", SoundSpeed::Chosen(10.0));
        Body::block(name, liquid, [from, 0.0], [from + 1.0, 1.0], 0.1)
    };
    let told = |scene: Scene<f64, 2>| scene.build().unwrap_err().to_string();
    let warm = told(Scene::new(scheme).body(block("a", 0.0, 1e3)));
    assert!(warm.contains("Eulerian::<true>"), "{warm}");
    let scheme: Scheme<f64, 2> = laminar()
        .with(ArbitraryLagrangian::<false>::default())
        .compose();
    let two = Scene::new(scheme)
        .body(block("a", 0.0, 1e3))
        .body(block("b", 1.0, 8e2));
    let two = told(two);
    assert!(two.contains("mass pass between bodies"), "{two}");
}
