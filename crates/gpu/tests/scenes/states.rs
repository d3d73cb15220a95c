//! Integrators that keep states, on the device as on the host: Runge–Kutta of gases and solids, and one of a user.
//! Kept states follow what list builds do, those of the device and those of the host where particles re-enter.

use crate::common::{device, in_any_groups};
use crate::compare::{in_both, in_double, on, on_device, on_host, resumed};
use meshfree::effect::{Effect, Evolved, Setting, StepProgram, Update};
use meshfree::error::Result;
use meshfree::integrator::{Integrator, Midpoint, RungeKutta4, StrongStabilityPreserving3, System};
use meshfree::material::eos::IdealGas;
use meshfree::name;
use meshfree::particles::Field;
use meshfree::prelude::*;
use meshfree::scheme::Start;
use meshfree::simulation::ParticleView;
use meshfree::term::{In, VelocityGradient, stage};
use std::f64::consts::TAU;

/// A rod through a period, whose lists the host builds where something re-enters.
fn rod<T: Real>(fused: bool) -> Scene<T, 1> {
    let body = Body::block("rod", catalogue::copper::<T>(), [0.0], [0.01], 5e-6);
    let body = body.start(|[x], start| Start {
        velocity: [900.0 + 50.0 * (200.0 * TAU * x).sin()],
        ..start
    });
    let scene = Scene::new(schemes::impact().energy(EnergyForm::Symmetric))
        .body(body)
        .boundary(Periodic::along(0, 0.0, 0.01))
        .integrator(RungeKutta4);
    on(scene, fused)
}

/// A gas that swirls, whose lengths follow its density: through periods, or as it expands into a vacuum and is sorted, once by the
/// host, since lengths differ too much for lists of the device.
fn gas<T: Real>(fused: bool, expands: bool) -> Scene<T, 2> {
    let gas = IdealGas::new(1.4, 1.0);
    let square = Body::block(
        "gas",
        Material::<T>::new("gas", gas),
        [0.0; 2],
        [1.0; 2],
        0.022,
    );
    let square = square.start(move |[x, y], start| Start {
        velocity: if expands {
            [0.5 - y + 0.2 * (TAU * x).sin(), x - 0.5]
        } else {
            [0.5 + 0.2 * (TAU * y).sin(), 0.2 * (TAU * x).sin()]
        },
        energy: gas.energy(1.0, 1.0),
        ..start
    });
    let mut scene = Scene::new(schemes::gas().energy(EnergyForm::Symmetric)).body(square);
    for axis in 0..if expands { 0 } else { 2 } {
        scene = scene.boundary(Periodic::along(axis, 0.0, 1.0));
    }
    on(scene.integrator(StrongStabilityPreserving3), fused)
}

/// A tensor that turns with what it is in.
const FIBRE: Field = Field::tensor(name!("fibre", "1"));

#[derive(Clone, Copy, Debug)]
struct Fibre;

impl<const D: usize> Effect<D> for Fibre {
    type Terms = (In<stage::Rates, VelocityGradient>,);
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(VelocityGradient),)
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.declare(FIBRE, 0.0);
        program.evolve(Evolved::kicked(FIBRE).updated(Update::Rotated));
    }
}

/// A plate of liquid copper that turns and rings.
fn plate<T: Real>(fused: bool, integrator: impl Integrator + 'static) -> Scene<T, 2> {
    let copper = catalogue::copper::<T>();
    let plate = Body::block("plate", copper, [0.0; 2], [0.08, 0.04], 1.25e-3);
    let plate = plate.field(FIBRE, |[x, _]| [1.0 + x, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let plate = plate.start(|[x, y], start| Start {
        velocity: [
            -4000.0 * (y - 0.02) + 20.0 * (80.0 * x).sin(),
            4000.0 * (x - 0.04),
        ],
        ..start
    });
    let scheme = schemes::impact_by_continuity().energy(EnergyForm::Symmetric);
    let scene = Scene::new(scheme.with(Fibre)).body(plate);
    on(scene.integrator(integrator), fused)
}

/// Heun's method. On its way it takes twice the state, and takes that back: shares that are not one together.
#[derive(Clone, Copy, Debug)]
struct Heun;

impl Integrator for Heun {
    fn name(&self) -> String {
        "Heun".into()
    }
    fn step(&self, system: &mut dyn System, dt: f64) -> Result<()> {
        system.save(0);
        system.evaluate(0.0)?;
        system.combine(0, 0.0, 1.0, dt);
        system.evaluate(dt)?;
        system.combine(0, 0.5, 0.5, 0.5 * dt);
        system.save(0);
        system.combine(0, 1.0, 1.0, 0.0);
        system.combine(0, -1.0, 1.0, 0.0);
        Ok(())
    }
    fn stability(&self) -> f64 {
        0.5
    }
    fn slots(&self) -> usize {
        1
    }
    fn kicks(&self) -> bool {
        false
    }
}

#[test]
fn runge_kutta_is_that_of_the_host() {
    let Some(device) = device("Runge-Kutta") else {
        return;
    };
    in_both(&device, "Rod", rod::<f64>, || rod::<f32>(false), 200);
    // Differences at the edge of a gas in a vacuum grow threefold a step, from the twelfth to the twentieth.
    for (expands, steps) in [(false, 40), (true, 12)] {
        let double = |fused| gas::<f64>(fused, expands);
        in_both(&device, "Gas", double, || gas::<f32>(false, expands), steps);
    }
    let orders = [
        on_device(&device, gas::<f64>(false, true), 12),
        on_host(gas(false, true), 12),
    ];
    let orders = orders.map(|own| own.offload().expect("it runs there").ids(0).to_vec());
    assert!(orders[0] == orders[1], "sorted at another time");
    let double = |fused| plate::<f64>(fused, Midpoint);
    let single = || plate::<f32>(false, Midpoint);
    in_both(&device, "Plate", double, single, 200);
    let fibres = |own: Simulation<f64, 2>| -> Vec<f64> {
        let of = |p: ParticleView<'_, f64, 2>| Some(p.tensor(FIBRE)?.components().to_vec());
        own.all().filter_map(of).flatten().collect()
    };
    let all = [
        on_device(&device, double(false), 200),
        on_host(double(false), 200),
        on_host(double(true), 200),
        on_host(double(false), 0),
    ];
    let [found, host, fused, start] = all.map(fibres);
    let apart = |a: &[f64], b: &[f64]| {
        let all = a.iter().zip(b).map(|(a, b)| (a - b).abs());
        all.fold(0.0, f64::max)
    };
    let (own, most) = (apart(&found, &host), apart(&fused, &host));
    println!("fibres: {own:e}, host {most:e}");
    assert!(own <= 20.0 * most && apart(&start, &host) > 0.01);
}

/// Two pairs of bars that turn, each pair a group under a scheme of its own.
fn bars(fused: bool) -> Scene<f64, 2> {
    let bar = |name: &str, low: [f64; 2], turns: f64| {
        let [high, middle] = [0.02, 0.01].map(|by| low.map(|x| x + by));
        let bar = Body::block(name, catalogue::copper(), low, high, 1e-3);
        bar.start(move |[x, y], start| Start {
            velocity: [
                turns * (middle[1] - y) + 20.0 * (80.0 * x).sin(),
                turns * (x - middle[0]),
            ],
            ..start
        })
    };
    let form = EnergyForm::Symmetric;
    let pair = [bar("c", [0.1, 0.0], 4000.0), bar("d", [0.1, 0.024], 2000.0)];
    let mut scene = Scene::new(schemes::impact().energy(form))
        .body(bar("a", [0.0; 2], 3000.0))
        .body(bar("b", [0.024, 0.0], -4000.0))
        .group(schemes::impact_by_continuity().energy(form), pair);
    for (own, other) in [("a", "c"), ("a", "d"), ("b", "c"), ("b", "d")] {
        scene = scene.between(own, other, Interaction::None);
    }
    on(scene.integrator(RungeKutta4), fused)
}

#[test]
fn groups_keep_states_of_their_own() {
    let Some(device) = device("kept states of groups") else {
        return;
    };
    in_double(&device, "Bars", bars, 60);
}

/// It keeps a state, and predicts.
#[test]
fn the_leapfrog_of_lam_is_that_of_the_host() {
    let Some(device) = device("the leapfrog of Lam") else {
        return;
    };
    let rod = |name, low: f64, velocity| {
        let body = Body::block(name, catalogue::copper(), [low], [low + 0.01], 1e-5);
        body.velocity([velocity])
    };
    let rods = |fused| {
        let scene = Scene::<f64, 1>::new(schemes::impact());
        let scene = scene.body(rod("left", 0.0, 200.0));
        let scene = scene.body(rod("right", 0.01, 0.0));
        on(scene.integrator(LamLeapfrog::default()), fused)
    };
    in_double(&device, "Lam", rods, 200);
}

#[test]
fn an_integrator_of_a_user_keeps_states() {
    let Some(device) = device("an integrator of a user") else {
        return;
    };
    let double = |fused| plate::<f64>(fused, Heun);
    in_both(&device, "Heun", double, || plate::<f32>(false, Heun), 200);
}

#[test]
fn kept_states_have_one_set_of_bits_and_resume() {
    let Some(device) = device("kept states") else {
        return;
    };
    in_any_groups(device.clone(), |device| {
        let run = on_device(device, gas::<f64>(false, true), 40);
        assert!(run.list_builds() > 4, "{}", run.list_builds());
        vec![run.bits_hash()]
    });
    resumed(&device, "Gas", |fused| gas(fused, true), [6, 6]);
    resumed(&device, "Rod", rod, [60, 60]);
}
