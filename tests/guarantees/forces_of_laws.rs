//! A force that a law gives particles acts as forces of pairs do: in motion, work, momentum and ledgers.
//! Springs and weight by laws of this file, with the published surface alone, against their closed forms and against loads.

use meshfree::effect::{Chunk, Effect, Law, NeoHookean, Setting, StepProgram, Tally};
use meshfree::integrator::{
    DriftKickDrift, Integrator, KickDriftKick, LamLeapfrog, Midpoint, PositionVerlet, RungeKutta4,
    StrongStabilityPreserving3,
};
use meshfree::name;
use meshfree::particles::{Field, Fields};
use meshfree::prelude::*;
use meshfree::scheme::EnergyForm;
use meshfree::term::Stage;

/// Specific energy that a spring stores \[J/kg\].
const STORED: Field = Field::scalar(name!("energy of the spring", "J/kg"));

/// A spring to the point x = 0 on every particle, F = −m ω² x, or from all to one point, F = −m ω² (x − X + a), by which a body
/// moves as one; or a weight F = −m g where ω is zero. The stage may be a wrong one.
#[derive(Clone, Copy, Debug)]
struct Pull {
    omega: f64,
    weight: f64,
    /// The distance a \[m\] from the point at which all particles start.
    amplitude: Option<f64>,
    at: Stage,
}

fn spring(omega: f64) -> Pull {
    Pull {
        omega,
        weight: 0.0,
        amplitude: None,
        at: Stage::Rates,
    }
}

impl<const D: usize> Effect<D> for Pull {
    type Terms = ();
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, _setting: &Setting) -> Self::Terms {}
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.declare(STORED, 0.0);
        program.store(STORED);
        program.law(self.at, *self);
    }
}

impl<T: Real, const D: usize> Law<T, D> for Pull {
    fn name(&self) -> &'static str {
        "pull"
    }
    fn reads(&self) -> Fields {
        Fields::of(&[Field::POSITION, Field::MASS, Field::REFERENCE_POSITION])
    }
    fn optional(&self) -> Fields {
        match self.amplitude {
            Some(_) => Fields::NONE,
            None => Fields::of(&[Field::REFERENCE_POSITION]),
        }
    }
    fn writes(&self) -> Fields {
        Fields::of(&[Field::FORCE, STORED])
    }
    fn adds(&self) -> Fields {
        Fields::of(&[Field::FORCE])
    }
    fn apply(&self, chunk: &mut Chunk<'_, T, D>) -> Tally {
        let origin = chunk.around.origin.map(T::from_f64);
        let [square, weight] = [self.omega * self.omega, self.weight].map(T::from_f64);
        let half = T::from_f64(0.5);
        let amplitude = self.amplitude.map(T::from_f64);
        let ([x, mass, built], [force, stored]) = chunk.columns(
            [Field::POSITION, Field::MASS, Field::REFERENCE_POSITION],
            [Field::FORCE, STORED],
        );
        for (n, stored) in stored.iter_mut().enumerate() {
            let mut energy = T::zero();
            for d in 0..D {
                let k = n * D + d;
                let x = match amplitude {
                    Some(amplitude) => x[k] - built[k] + amplitude,
                    None => x[k] + origin[d],
                };
                let down = if d + 1 == D { weight } else { T::zero() };
                force[k] -= mass[n] * (square * x + down);
                energy += half * square * x * x + down * x;
            }
            *stored = energy;
        }
        Tally::default()
    }
}

/// A material whose pressure depends on density alone.
fn soft() -> Material<f64> {
    let law = meshfree::material::eos::Linear::from_bulk_modulus(1000.0, 3.25e6);
    Material::new("soft", law).with_shear_modulus(7.15e5)
}

/// A bar that swings as one about the point from which it starts by 1 mm.
fn bob(integrator: impl Integrator + 'static, omega: f64) -> Simulation<f64, 1> {
    let spring = Pull {
        amplitude: Some(1e-3),
        ..spring(omega)
    };
    let scheme = schemes::total_lagrangian()
        .energy(EnergyForm::Symmetric)
        .with(NeoHookean)
        .with(spring);
    Scene::new(scheme)
        .body(Body::block("bob", soft(), [0.0], [0.01], 1e-3))
        .integrator(integrator)
        .build()
        .unwrap()
}

/// The largest difference from cos ωt over a period of `steps` steps, in units of the amplitude.
fn off_cosine(integrator: impl Integrator + 'static, steps: u32) -> f64 {
    let omega = 1e3;
    let dt = core::f64::consts::TAU / omega / f64::from(steps);
    let mut now = bob(integrator, omega);
    let mut worst = 0.0_f64;
    for k in 1..=steps {
        while now.time() < f64::from(k) * dt * (1.0 - 1e-12) {
            now.step_at_most(f64::from(k) * dt - now.time()).unwrap();
        }
        let moved = now.all().next().unwrap().position()[0] - 5e-4;
        worst = worst.max((moved / 1e-3 + 1.0 - (omega * now.time()).cos()).abs());
    }
    worst
}

/// A body on a spring swings as cos ωt with every integrator, in its order.
#[test]
fn a_spring_swings_with_every_integrator() {
    fn check(name: &str, order: f64, finest: f64, of: impl Fn(u32) -> f64) {
        // Steps below the acoustic limit, which are all of one length.
        let [coarse, fine] = [2000, 4000].map(of);
        println!("{name}: {coarse:e} and {fine:e}");
        assert!(fine < finest, "{name}: {fine:e}");
        if fine > 1e-12 {
            let found = (coarse / fine).log2();
            assert!((found - order).abs() < 0.2, "{name}: order {found}");
        }
    }
    check("kick-drift-kick", 2.0, 1e-6, |n| {
        off_cosine(KickDriftKick, n)
    });
    check("drift-kick-drift", 2.0, 1e-6, |n| {
        off_cosine(DriftKickDrift, n)
    });
    check("position Verlet", 2.0, 1e-6, |n| {
        off_cosine(PositionVerlet, n)
    });
    check("midpoint", 2.0, 1e-5, |n| off_cosine(Midpoint, n));
    check("Runge-Kutta 4", 4.0, 1e-12, |n| off_cosine(RungeKutta4, n));
    check("SSP 3", 3.0, 1e-8, |n| {
        off_cosine(StrongStabilityPreserving3, n)
    });
    check("Lam's leapfrog", 2.0, 1e-5, |n| {
        off_cosine(LamLeapfrog::default(), n)
    });
}

/// What a law works is booked in every integrator: kinetic energy and momentum change by as much, to rounding where velocities
/// are kicked, and in the order of Runge-Kutta methods.
#[test]
fn work_and_momentum_of_a_law_are_booked() {
    fn check(name: &str, integrator: impl Integrator + 'static, bound: f64) {
        let omega = 1e3;
        let mut now = bob(integrator, omega);
        now.run_until(1.3 / omega).unwrap();
        let whole = now.ledger().whole;
        let work = whole.total("work of laws").unwrap();
        let gain = whole.kinetic / work - 1.0;
        let momentum = now.ledger().law_impulse[0] / whole.momentum[0] - 1.0;
        println!("{name}: work {gain:e}, momentum {momentum:e}");
        assert!(work > 0.0 && gain.abs() < bound, "{name}: {gain:e}");
        assert!(momentum.abs() < bound, "{name}: {momentum:e}");
    }
    check("kick-drift-kick", KickDriftKick, 1e-13);
    check("drift-kick-drift", DriftKickDrift, 1e-13);
    check("position Verlet", PositionVerlet, 1e-13);
    check("Runge-Kutta 4", RungeKutta4, 1e-8);
    check("SSP 3", StrongStabilityPreserving3, 1e-6);
    check("midpoint", Midpoint, 1e-3);
}

/// Two rods that collide while springs pull them: internal energy takes the work of pairs alone, and momentum and energy are
/// closed with that of the law.
#[test]
fn work_of_a_law_closes_energy() {
    let rod =
        |name, low: f64, v: f64| Body::block(name, soft(), [low], [low + 0.01], 2e-4).velocity([v]);
    let scheme = schemes::impact().with_viscosity(meshfree::term::viscosity::Inviscid);
    let mut now = Scene::<f64, 1>::new(scheme.with(spring(50.0)))
        .body(rod("left", -0.01, 0.5))
        .body(rod("right", 0.0, -0.5))
        .build()
        .unwrap();
    let before = now.ledger().whole;
    now.keep_energy();
    now.keep_stability(meshfree::simulation::Thresholds::default());
    now.run_until(4e-4).unwrap();
    let after = now.ledger().whole;
    let work = after.total("work of laws").unwrap();
    assert_eq!(now.energy().unwrap().law_work, work);
    let residual = after.total_energy() - before.total_energy() - work;
    println!("{residual:e} J of {work:e} J, {} J", before.kinetic);
    assert!(work.abs() > 1e-3 * before.kinetic);
    assert!(residual.abs() < 1e-12 * before.kinetic, "{residual:e} J");
    let report = now.stability();
    assert!(report.momentum.unwrap() < 1e-10, "{report}");
    assert!(report.energy_closure.unwrap() < 1e-10, "{report}");
}

/// What a spring takes from a rod that flies away it stores, as the effect declares: no energy comes from nowhere.
#[test]
fn stored_energy_counts_the_work_of_a_law() {
    let rod = Body::block("rod", soft(), [0.0], [0.01], 2e-4).velocity([0.5]);
    let mut now = Scene::<f64, 1>::new(schemes::impact().with(spring(50.0)))
        .body(rod)
        .build()
        .unwrap();
    now.run_until(5e-3).unwrap();
    let stored = now.stored_energy();
    let balance = stored.parts[0].balance.unwrap();
    let work = now.ledger().whole.total("work of laws").unwrap();
    println!("{work} J\n{stored}");
    assert!(work < -0.1 * balance.supplied);
    assert!(balance.gain.abs() < 1e-2 * balance.supplied, "{stored}");
}

/// A weight by a law is the run of [`Scene::acceleration`] to rounding, with every kind of integrator, and its work that of
/// the load.
#[test]
fn a_weight_by_a_law_is_an_acceleration() {
    fn check(integrator: impl Integrator + Clone + 'static, books: bool) {
        let g = 1e6;
        let run = |by_law: bool| {
            let weight = Pull {
                weight: if by_law { g } else { 0.0 },
                ..spring(0.0)
            };
            let rod = |name, low: f64, v: f64| {
                Body::block(name, catalogue::copper(), [low], [low + 0.004], 2e-4).velocity([v])
            };
            let form = if books {
                EnergyForm::Compatible
            } else {
                EnergyForm::Symmetric
            };
            let scene = Scene::<f64, 1>::new(schemes::impact().energy(form).with(weight))
                .body(rod("lower", 0.0, 0.0))
                .body(rod("upper", 0.004, -20.0))
                .integrator(integrator.clone());
            let scene = if by_law {
                scene
            } else {
                scene.acceleration(move |_| [-g])
            };
            let mut now = scene.build().unwrap();
            now.keep_energy();
            now.run_until(2e-6).unwrap();
            now
        };
        let [by_law, by_load] = [true, false].map(run);
        assert_eq!(by_law.steps(), by_load.steps());
        for (own, other) in by_law.all().zip(by_load.all()) {
            assert!((own.position()[0] - other.position()[0]).abs() < 1e-15);
            assert!((own.velocity()[0] - other.velocity()[0]).abs() < 1e-9);
            assert!((own.energy() - other.energy()).abs() < 1e-9);
            assert!((own.acceleration()[0] - other.acceleration()[0]).abs() < 1e-8 * g);
        }
        let [law, load] = [&by_law, &by_load].map(|now| now.energy().unwrap());
        assert_eq!(law.load_work, 0.0);
        if books {
            assert!(load.load_work.abs() > 0.1 * load.kinetic);
            assert!((law.law_work / load.load_work - 1.0).abs() < 1e-12);
            assert!((law.dissipated - load.dissipated).abs() < 1e-9 * law.kinetic);
        }
    }
    check(KickDriftKick, true);
    check(DriftKickDrift, true);
    check(RungeKutta4, false);
    check(StrongStabilityPreserving3, false);
}

/// A rod that takes several steps in one of the others feels its laws in its own, and their work stays booked.
#[test]
fn laws_act_in_steps_of_their_own() {
    let run = |count| {
        let water = catalogue::weakly_compressible_water(20.0);
        let rod = Body::block("rod", catalogue::copper(), [-4e-3], [0.0], 1e-4);
        let scene = Scene::<f64, 1>::new(schemes::weakly_compressible())
            .body(Body::block("water", water, [1e-3], [2e-2], 1e-4))
            .group(schemes::impact().with(spring(2e4)), [rod.velocity([0.1])]);
        let scene = if count > 1 {
            scene.sub_cycle("rod", count)
        } else {
            scene
        };
        let mut now = scene.build().unwrap();
        let before = now.ledger();
        now.run_until(4e-5).unwrap();
        (before, now)
    };
    let [(_, together), (before, apart)] = [1, 20].map(run);
    assert!(together.steps() > 10 * apart.steps());
    let (rod, then) = (apart.ledger().bodies[1].1.clone(), &before.bodies[1].1);
    let of = |name| rod.total(name).unwrap();
    let (law, couplings) = (of("work of laws"), of("work of couplings"));
    let residual = rod.total_energy() - then.total_energy() - law - couplings;
    println!("{residual:e} J of {law:e} J");
    assert!(law.abs() > 1e-2 * then.kinetic);
    assert!(residual.abs() < 1e-12 * rod.kinetic, "{residual:e} J");
    let other = together.ledger().bodies[1].1.total("work of laws").unwrap();
    assert!((law / other - 1.0).abs() < 1e-3, "{law} and {other} J");
}

/// A law that gives a force where no forces are summed is refused by its name.
#[test]
fn forces_at_other_stages_are_refused() {
    for at in Stage::ALL {
        let pull = Pull { at, ..spring(1.0) };
        let rod = Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4);
        let problems = Scene::<f64, 1>::new(schemes::impact().with(pull))
            .body(rod)
            .problems();
        let said: Vec<_> = problems.iter().map(ToString::to_string).collect();
        let refused = said.iter().any(|said| {
            said.contains("`pull`") && said.contains(at.name()) && said.contains("Stage::Rates")
        });
        assert_eq!(refused, at != Stage::Rates, "{at:?}: {said:?}");
    }
}

/// The same bits on any number of threads.
#[test]
fn forces_of_laws_do_not_depend_on_threads() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap().install(|| {
            let block = Body::block("block", catalogue::copper(), [0.0; 2], [0.01; 2], 1e-4);
            let mut now = Scene::<f32, 2>::new(schemes::impact().with(spring(1e5)))
                .body(block)
                .build()
                .unwrap();
            for _ in 0..5 {
                now.step().unwrap();
            }
            let work = now.ledger().whole.total("work of laws").unwrap();
            let x: Vec<_> = now.all().flat_map(|p| p.position()).collect();
            (work.to_bits(), x)
        })
    };
    assert_eq!(run(1), run(4));
}

/// A run that is resumed has the bits, and the booked work, of one that was not stopped.
#[cfg(feature = "checkpoint")]
#[test]
fn forces_of_laws_resume() {
    let scene = || {
        let rod = Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4);
        Scene::<f64, 1>::new(schemes::impact().with(spring(1e5))).body(rod)
    };
    let path = std::env::temp_dir().join(format!("forces_of_laws_{}", std::process::id()));
    let mut whole = scene().build().unwrap();
    whole.run_until(2e-6).unwrap();
    whole.keep_energy();
    whole.run_until(4e-6).unwrap();
    whole.save(&path).unwrap();
    let mut resumed = scene().resume(&path).unwrap();
    std::fs::remove_file(&path).unwrap();
    for now in [&mut whole, &mut resumed] {
        now.run_until(8e-6).unwrap();
    }
    assert_eq!(whole.ledger(), resumed.ledger());
    assert_eq!(whole.energy(), resumed.energy());
    let [one, other] = [&whole, &resumed].map(|now| now.all().map(|p| p.position()[0].to_bits()));
    assert!(one.eq(other));
    assert!(
        whole.energy().unwrap().law_work != whole.ledger().whole.total("work of laws").unwrap()
    );
}
