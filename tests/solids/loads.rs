//! Loads that depend on the particle, against exact solutions: wells, drag, heat, and the energy that they give.
//! A particle alone follows an ordinary differential equation, and an integrator has its order on it.

use approx::assert_relative_eq;
use meshfree::boundary::Periodic;
use meshfree::effect::HeatConduction;
use meshfree::error::{Error, Problem};
use meshfree::integrator::{DriftKickDrift, Integrator, KickDriftKick, RungeKutta4};
use meshfree::material::eos::{IdealGas, Linear};
use meshfree::material::{Material, catalogue};
use meshfree::scene::{Body, Scene};
use meshfree::scheme::EnergyForm;
use meshfree::schemes;
use meshfree::simulation::{Criterion, Load, Simulation, StepControl};

/// A particle alone, at a place \[m\] and with a velocity \[m/s\], and steps of `dt` \[s\].
fn alone(x: f64, v: f64, dt: f64) -> Scene<f64, 1> {
    let soft = Material::new("soft", Linear::new(1000.0, 0.01));
    let body = Body::points_of("a", soft, vec![[x]], 0.01).velocity([v]);
    let scheme = schemes::impact_by_continuity().without_consistency_factor();
    let scheme = scheme.energy(EnergyForm::None);
    Scene::new(scheme).body(body).steps(|steps| StepControl {
        fixed: Some(dt),
        ..steps
    })
}

/// Place and velocity of the only particle.
fn state(now: &Simulation<f64, 1>) -> [f64; 2] {
    let particle = now.all().next().unwrap();
    [particle.position()[0], particle.velocity()[0]]
}

/// −ω² x.
fn well<const D: usize>(omega: f64) -> Load<D> {
    Load::acceleration(move |at| at.position.map(|x| -omega * omega * x))
}

/// −k v.
fn drag<const D: usize>(k: f64) -> Load<D> {
    Load::acceleration(move |at| at.velocity.map(|v| -k * v))
}

/// Two rods that meet at 40 m/s.
fn rods() -> Scene<f64, 1> {
    let rod =
        |name: &str, from: f64| Body::block(name, catalogue::copper(), [from], [from + 0.01], 2e-4);
    Scene::new(schemes::impact())
        .body(rod("a", 0.0).velocity([20.0]))
        .body(rod("b", 0.01).velocity([-20.0]))
}

/// All that particles are and carry, and the work of loads if it is kept.
fn bits(now: &Simulation<f64, 1>) -> Vec<u64> {
    let particles = now.all().flat_map(|p| {
        let places = [p.position()[0], p.velocity()[0]];
        places.into_iter().chain([p.density(), p.energy()])
    });
    let work = now.energy().map(|energy| energy.load_work);
    particles.chain(work).map(f64::to_bits).collect()
}

#[test]
fn a_well_swings_with_the_period_and_the_energy_of_the_integrator() {
    let (omega, dt, x) = (1.0, 0.02, 0.1);
    let mut simulation = alone(x, 0.0, dt).load(well(omega)).build().unwrap();
    // A leapfrog turns the phase by 2 asin(ω dt/2) a step, and keeps v² + ω² (1 − (ω dt/2)²) x² (Hairer, Lubich &
    // Wanner 2003).
    let phase = 2.0 * (0.5 * omega * dt).asin();
    let share = omega * omega * (1.0 - (0.5 * omega * dt).powi(2));
    for n in 1..=2000 {
        simulation.step().unwrap();
        let [now, v] = state(&simulation);
        let [a] = simulation.all().next().unwrap().acceleration();
        assert!((a + omega * omega * now).abs() < 1e-15, "{a}");
        assert!((now / x - (f64::from(n) * phase).cos()).abs() < 1e-11);
        let energy = v * v + share * now * now;
        assert_relative_eq!(energy, share * x * x, epsilon = 0.0, max_relative = 1e-12);
    }
    // Its period is short by (ω dt)²/24.
    let short = 1.0 - omega * dt / phase;
    assert_relative_eq!(
        short,
        (omega * dt).powi(2) / 24.0,
        epsilon = 0.0,
        max_relative = 1e-3
    );
}

#[test]
fn drag_decays_at_the_order_of_the_integrator() {
    fn order<I: Integrator + Clone + 'static>(integrator: I) -> f64 {
        let (k, start) = (2.0, 0.1);
        let error = |steps: u32| {
            let scene = alone(0.0, start, 1.0 / f64::from(steps)).load(drag(k));
            let mut simulation = scene.integrator(integrator.clone()).build().unwrap();
            (0..steps).for_each(|_| assert!(simulation.step().is_ok()));
            let [x, v] = state(&simulation);
            let left = start * (-k).exp();
            (v - left).abs() + (x - (start - left) / k).abs()
        };
        (error(20) / error(40)).log2()
    }
    // Half a step leaves a quarter of the error at order 2.
    let orders = [
        order(KickDriftKick),
        order(DriftKickDrift),
        order(RungeKutta4),
    ];
    for (found, expected) in orders.into_iter().zip([2.0, 2.0, 4.0]) {
        assert!((found - expected).abs() < 0.1, "{orders:?}");
    }
}

#[test]
fn a_uniform_acceleration_is_the_same_by_either_call() {
    let a = |t: f64| [1e7 * (1e6 * t).cos()];
    let mut by_scene = rods().acceleration(a).build().unwrap();
    let mut by_load = rods()
        .load(Load::acceleration(move |at| a(at.time)))
        .build()
        .unwrap();
    by_scene.run_until(1e-6).unwrap();
    by_load.run_until(1e-6).unwrap();
    assert_eq!(by_scene.steps(), by_load.steps());
    for (one, other) in by_scene.all().zip(by_load.all()) {
        assert!((one.position()[0] - other.position()[0]).abs() < 1e-15);
        assert!((one.velocity()[0] - other.velocity()[0]).abs() < 1e-11);
        assert!((one.energy() - other.energy()).abs() < 1e-9);
    }
}

#[test]
fn a_load_on_one_body_leaves_the_other_alone() {
    let apart = |load: Option<Load<1>>| {
        let rod = |name: &str, from: f64| {
            Body::block(name, catalogue::copper(), [from], [from + 0.01], 2e-4)
        };
        let scene = Scene::new(schemes::impact())
            .body(rod("a", 0.0))
            .body(rod("b", 0.05));
        let scene = load.into_iter().fold(scene, Scene::load);
        let steps = scene.steps(|steps| StepControl {
            fixed: Some(1e-8),
            ..steps
        });
        let mut simulation = steps.build().unwrap();
        (0..50).for_each(|_| assert!(simulation.step().is_ok()));
        simulation
    };
    let pull = Load::acceleration(|at| {
        assert_eq!(at.body, "a");
        assert!(at.density > 0.0 && at.position[0] < 0.02);
        [1e8]
    });
    let (pulled, free) = (apart(Some(pull.on("a"))), apart(None));
    let velocities = |now: &Simulation<f64, 1>, body: &str| -> Vec<f64> {
        now.body(body).unwrap().map(|p| p.velocity()[0]).collect()
    };
    assert_eq!(velocities(&pulled, "b"), velocities(&free, "b"));
    // Forces between particles are those of rounding.
    let expected = 1e8 * pulled.time();
    let off = |v: &f64| (v / expected - 1.0).abs();
    let most = velocities(&pulled, "a").iter().map(off).fold(0.0, f64::max);
    assert!(most < 1e-10, "{most}");
}

#[test]
fn heat_is_mass_times_rate_times_time() {
    // Gas that fills a period does no work when it is heated as one.
    let (rate, end) = (0.3, 0.5);
    let heated = |form: EnergyForm, integrator: Box<dyn Integrator>| {
        let gas = Material::new("gas", IdealGas::new(1.4, 1.0));
        let body = Body::block("gas", gas, [0.0], [1.0], 1.0 / 64.0).energy(2.5);
        let mut simulation = Scene::<f64, 1>::new(schemes::gas().energy(form))
            .body(body)
            .boundary(Periodic::along(0, 0.0, 1.0))
            .load(Load::heating(move |_| rate))
            .boxed_integrator(integrator)
            .build()
            .unwrap();
        let before = simulation.ledger().whole;
        simulation.run_until(end).unwrap();
        let after = simulation.ledger().whole;
        let expected = before.mass * rate * end;
        assert!(
            simulation.steps() > 20 && after.kinetic < 1e-20,
            "{}",
            after.kinetic
        );
        (after.internal - before.internal) / expected - 1.0
    };
    for error in [
        heated(EnergyForm::Compatible, Box::new(KickDriftKick)),
        heated(EnergyForm::Compatible, Box::new(DriftKickDrift)),
        heated(EnergyForm::Symmetric, Box::new(KickDriftKick)),
        heated(EnergyForm::Symmetric, Box::new(RungeKutta4)),
    ] {
        assert!(error.abs() < 1e-12, "{error}");
    }
}

#[test]
fn the_work_of_loads_is_in_the_ledger_and_not_in_heat() {
    let scene = rods().load(well(1e5)).load(drag(1e5).on("a"));
    let mut simulation = scene.acceleration(|_| [1e6]).build().unwrap();
    simulation.keep_energy();
    let before = simulation.ledger().whole;
    simulation.run_until(2e-6).unwrap();
    let after = simulation.ledger().whole;
    let work = simulation.energy().unwrap().load_work;
    let gain = after.total_energy() - before.total_energy();
    assert!(work.abs() > 0.01 * before.kinetic, "{work}");
    assert!(
        (gain - work).abs() < 1e-12 * before.kinetic,
        "{gain} {work}"
    );
}

#[test]
fn the_step_sees_what_a_load_accelerates() {
    let strong = Load::acceleration(|_| [1e4]);
    let vote = alone(0.0, 0.0, 1e-4)
        .load(strong)
        .build()
        .unwrap()
        .vote()
        .unwrap();
    assert_eq!(vote.criterion, Criterion::Force);
    let without = alone(0.0, 0.0, 1e-4).build().unwrap().vote().unwrap();
    assert_ne!(without.criterion, Criterion::Force);
}

#[test]
fn bits_do_not_depend_on_threads_evaluations_or_stops() {
    let scene = || {
        let body = Body::block("a", catalogue::copper(), [0.0], [2.0], 2e-4);
        Scene::<f64, 1>::new(schemes::impact())
            .body(body.velocity([3.0]))
            .load(well(1e5))
            .load(drag(1e4))
            .load(Load::heating(|at| 1e9 * at.position[0]))
    };
    let run = |threads: usize, evaluate: bool| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap().install(|| {
            let mut simulation = scene().build().unwrap();
            simulation.keep_energy();
            for _ in 0..6 {
                simulation.step().unwrap();
                if evaluate {
                    simulation.evaluate().unwrap();
                }
            }
            bits(&simulation)
        })
    };
    let one = run(1, false);
    assert!(one == run(3, false) && one == run(2, true));
    #[cfg(feature = "checkpoint")]
    {
        let name = format!("meshfree-loads-{}.safetensors", std::process::id());
        let file = std::env::temp_dir().join(name);
        let mut first = scene().build().unwrap();
        first.keep_energy();
        (0..3).for_each(|_| assert!(first.step().is_ok()));
        first.save(&file).unwrap();
        let mut second = scene().resume(&file).unwrap();
        (0..3).for_each(|_| assert!(second.step().is_ok()));
        assert!(one == bits(&second));
        let other = scene().load(Load::heating(|_| 0.0).on("a")).resume(&file);
        std::fs::remove_file(file).unwrap();
        let message = other.unwrap_err().to_string();
        assert!(message.contains("which differs in the loads"), "{message}");
    }
}

#[test]
fn a_load_that_is_not_finite_stops_the_run() {
    for bad in [f64::NAN, f64::INFINITY] {
        let until = move |at: &meshfree::simulation::LoadPoint<'_, 1>| {
            [if at.time < 0.1 { 1.0 } else { bad }]
        };
        let mut simulation = alone(0.0, 0.0, 0.02)
            .load(Load::acceleration(until).on("a"))
            .build()
            .unwrap();
        let error = simulation.run_until(1.0).unwrap_err();
        let Error::Load {
            load,
            body,
            particle: 0,
            time,
            ..
        } = &error
        else {
            panic!("{error}");
        };
        assert_eq!(
            (load.as_str(), body.as_str()),
            ("acceleration on body `a`", "a")
        );
        assert!((0.1..0.13).contains(time));
        assert!(error.to_string().contains("must give finite numbers"));
        assert!(matches!(simulation.step(), Err(Error::Failed { .. })));
    }
    let heat = rods().load(Load::heating(|_| f64::INFINITY)).build();
    let message = heat.unwrap_err().to_string();
    assert!(
        message.starts_with("the load (heating on all bodies) gave inf to particle 0 of body `a`")
    );
}

#[test]
fn loads_on_what_is_not_there_or_cannot_be_heated_are_refused() {
    let unknown = rods().load(drag(1.0).on("c")).problems();
    let expected = Problem::UnknownName {
        kind: "body",
        name: "c".into(),
        known: "`a`, `b`".into(),
    };
    assert_eq!(unknown, [expected]);
    let cold = alone(0.0, 0.0, 0.01)
        .load(Load::heating(|_| 1.0))
        .problems();
    let [problem] = cold.as_slice() else {
        panic!("{cold:?}");
    };
    assert!(
        problem
            .to_string()
            .contains("heats body `a`, and the scheme"),
        "{problem}"
    );
    assert!(
        problem.to_string().contains("carries no energy"),
        "{problem}"
    );
}

/// A rod in a bath of 400 K that takes up k (400 K − T) per second, in every other particle, by what another code keeps by number.
#[test]
fn loads_see_the_fields_that_they_name_and_the_number_of_the_particle() {
    const TEMPERATURE: meshfree::particles::Field = HeatConduction::TEMPERATURE;
    let (specific_heat, k) = (385.0, 2e6);
    let insulated = HeatConduction {
        conductivity: 0.0,
        specific_heat,
        temperature: 300.0,
    };
    let rod = Body::block("a", catalogue::copper(), [0.0], [0.01], 2e-4);
    let scheme = schemes::impact_by_continuity().with(insulated);
    let kept: Vec<f64> = (0..50).map(|n| f64::from(n % 2)).collect();
    let bath = Load::heating(move |at| {
        let own = at.scalar(TEMPERATURE).expect("a field that is named");
        assert!(at.scalar(HeatConduction::CONDUCTIVITY).is_none());
        kept[at.particle] * k * specific_heat * (400.0 - own)
    });
    let mut run = Scene::<f64, 1>::new(scheme)
        .body(rod.clone())
        .load(bath.reading(&[TEMPERATURE]))
        .build()
        .unwrap();
    run.run_until(1e-6).unwrap();
    let exact = 400.0 - 100.0 * (-k * run.time()).exp();
    for (number, own) in run.column("a", TEMPERATURE).unwrap().iter() {
        let right = if number % 2 == 1 { exact } else { 300.0 };
        assert_relative_eq!(own[0], right, max_relative = 1e-3);
    }
    let problems = Scene::<f64, 1>::new(schemes::impact())
        .body(rod)
        .load(Load::acceleration(|_| [0.0]).reading(&[TEMPERATURE]))
        .problems();
    let text = problems[0].to_string();
    assert!(
        text.contains("reads temperature of body `a`") && text.contains("Load::on"),
        "{text}"
    );
}
