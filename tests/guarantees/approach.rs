//! What moves towards each other: cold gas, liquid faster than its sound, and walls that jump.
//! A step ends before particles go through each other, or an error says why there is none.

use crate::common::AnyKernel;
use meshfree::boundary::{MirrorPlane, Translation, Wall};
use meshfree::effect::ConsistentSmoothing;
use meshfree::error::{Error, Problem};
use meshfree::kernel::KernelKind;
use meshfree::material::Material;
use meshfree::material::eos::{IdealGas, Linear};
use meshfree::scene::{Body, Scene};
use meshfree::scheme::{DensityForm, EnergyForm, Scheme, SchemeBuilder};
use meshfree::schemes;
use meshfree::simulation::{Criterion, ParticleView, Simulation, StepControl};
use meshfree::study::noh::Noh;
use meshfree::term::viscosity::{ArtificialViscosity, CullenDehnen, Inviscid, MonaghanGingold};

fn gas_scheme(viscosity: impl ArtificialViscosity<1>) -> Scheme<f64, 1> {
    SchemeBuilder::new(AnyKernel(KernelKind::CubicSpline), viscosity)
        .density(DensityForm::Summation)
        .with(ConsistentSmoothing {
            smallest: 0.02,
            largest: 50.0,
        })
        .energy(EnergyForm::Compatible)
        .h_over_dx(1.2)
        .compose()
}

/// Gas of no temperature that streams into a wall at unit speed.
fn noh(scheme: Scheme<f64, 1>, count: usize) -> Scene<f64, 1> {
    let gas = Material::new("gas", IdealGas::new(5.0 / 3.0, 1.0));
    let row = Body::block("gas", gas, [-1.0], [0.0], 1.0 / count as f64).velocity([1.0]);
    Scene::new(scheme)
        .body(row)
        .boundary(MirrorPlane::symmetry([0.0], [1.0]))
}

/// Mean density behind the shock, away from the wall and from the shock.
fn behind(simulation: &Simulation<f64, 1>) -> f64 {
    let shock = Noh::new(1).unwrap().shock_radius(simulation.time());
    let inside: Vec<f64> = simulation
        .all()
        .filter(|p| (-0.85 * shock..-0.3 * shock).contains(&p.position()[0]))
        .map(|p| p.density())
        .collect();
    inside.iter().sum::<f64>() / inside.len() as f64
}

#[test]
fn cold_gas_stops_at_four_times_its_density() {
    let schemes = [
        gas_scheme(MonaghanGingold::default()),
        gas_scheme(CullenDehnen::STANDARD),
    ];
    for scheme in schemes {
        let mut simulation = noh(scheme, 200).build().unwrap();
        // Half of the way to its own image, which comes at the same speed.
        let first = simulation.vote().unwrap();
        assert!(first.step <= 0.5 * 0.005 / 2.0 * (1.0 + 1e-9), "{first:?}");
        simulation.run_until(0.6).unwrap();
        let density = behind(&simulation);
        println!("{} steps, density {density:.3}", simulation.steps());
        assert!((density / 4.0 - 1.0).abs() < 0.02, "{density}");
    }
}

/// Nothing stops such gas before it is hot, so its particles come as near as they can.
#[test]
fn no_pair_closes_by_more_than_half_of_its_distance() {
    let mut simulation = noh(gas_scheme(Inviscid), 40).build().unwrap();
    let places = |simulation: &Simulation<f64, 1>| -> Vec<(f64, f64)> {
        let spacing = |p: ParticleView<'_, f64, 1>| (p.position()[0], p.smoothing_length() / 1.2);
        simulation.all().map(spacing).collect()
    };
    while simulation.time() < 0.1 {
        let before = places(&simulation);
        simulation.step_at_most(0.1).unwrap();
        let after = places(&simulation);
        for (a, b) in before.windows(2).zip(after.windows(2)) {
            let (from, to) = (a[1].0 - a[0].0, b[1].0 - b[0].0);
            let closed = if from < 0.0 { to - from } else { from - to };
            // Distances below half a spacing count as that. What forces add within the step is the slack.
            let apart = from.abs().max(0.5 * a[0].1.max(a[1].1));
            assert!(closed < 0.6 * apart, "{a:?} {b:?}");
        }
    }
    assert!(simulation.steps() > 20, "{}", simulation.steps());
}

#[test]
fn a_fixed_step_that_moves_pairs_through_each_other_is_refused() {
    let fixed = |step| {
        noh(gas_scheme(CullenDehnen::STANDARD), 100)
            .steps(|control| StepControl {
                fixed: Some(step),
                ..control
            })
            .build()
    };
    assert!(fixed(0.0024).is_ok());
    let Err(Error::Build(error)) = fixed(0.0026) else {
        panic!("it was built");
    };
    let Problem::StepAboveLimit { criterion, .. } = error.problems[0] else {
        panic!("{error}");
    };
    assert!(criterion.contains("closing speed"), "{criterion}");
}

/// Two rows of cold gas that have not met come to meet.
#[test]
fn what_is_not_in_reach_yet_does_not_jump_over_what_it_meets() {
    let gas = || Material::new("gas", IdealGas::new(5.0 / 3.0, 1.0));
    let row =
        |name: &str, x: f64, v: f64| Body::block(name, gas(), [x], [x + 0.1], 0.01).velocity([v]);
    let mut simulation = Scene::new(gas_scheme(MonaghanGingold::default()))
        .body(row("left", -0.2, 1.0))
        .body(row("right", 0.1, -1.0))
        .between("left", "right", meshfree::sweep::Interaction::Bonded)
        .build()
        .unwrap();
    simulation.run_until(0.15).unwrap();
    let edge = simulation.body(0).unwrap().last().unwrap().position()[0];
    assert!(edge < 0.01, "{edge}");
    assert!(simulation.body(1).unwrap().all(|p| p.position()[0] > edge));
}

const DX: f64 = 0.01;
const SOUND: f64 = 10.0;

fn liquid() -> Material<f64> {
    Material::new("liquid", Linear::new(1000.0, SOUND)).with_pressure_cut_off(0.0)
}

fn floor() -> Wall<2> {
    let sides = [[true; 2], [true, false]];
    Wall::around("floor", [0.0; 2], [0.1; 2], DX, 4, sides)
}

fn sound_speed_is_too_low(error: &Error) {
    let Error::SoundSpeedTooLow {
        speed, sound_speed, ..
    } = error
    else {
        panic!("{error:?}");
    };
    assert!(speed > sound_speed && (sound_speed - SOUND).abs() < 0.2 * SOUND);
    assert!(
        error.to_string().contains("sound speed is too low"),
        "{error}"
    );
}

#[test]
fn liquid_that_falls_faster_than_its_sound_is_refused() {
    let fall = |mach: f64| {
        let drop = Body::block("drop", liquid(), [0.0, 0.05], [0.1, 0.15], DX);
        let mut simulation = Scene::<f64, 2>::new(schemes::weakly_compressible())
            .body(drop.velocity([0.0, -mach * SOUND]))
            .wall(floor())
            .build()?;
        simulation.run_until(0.1 / (mach * SOUND))?;
        Ok(simulation)
    };
    let gentle = fall(0.3).unwrap();
    assert!(gentle.all().all(|p| p.position()[1] > 0.0));
    for mach in [3.0, 6.0, 12.0] {
        sound_speed_is_too_low(&fall(mach).unwrap_err());
    }
}

#[test]
fn drops_that_meet_gain_no_energy() {
    let meet = |mach: f64| {
        let v = 0.5 * mach * SOUND;
        let drop = |name: &str, x: f64, v: f64| {
            Body::block(name, liquid(), [x, 0.0], [x + 0.1, 0.1], DX).velocity([v, 0.0])
        };
        let mut simulation = Scene::<f64, 2>::new(schemes::weakly_compressible())
            .body(drop("left", -0.12, v))
            .body(drop("right", 0.02, -v))
            .build()?;
        simulation.keep_energy();
        simulation.run_until(0.3 / (mach * SOUND))?;
        Ok(simulation.energy().unwrap())
    };
    for mach in [0.3, 0.9] {
        let energy = meet(mach).unwrap();
        let whole = energy.kinetic + energy.compression;
        println!("mach {mach}: {energy:?}");
        assert!(energy.dissipated > 0.01 * whole, "{energy:?}");
    }
    for mach in [3.0, 10.0] {
        sound_speed_is_too_low(&meet(mach).unwrap_err());
    }
}

/// A wall that is at another place all at once, or nowhere, has passed the liquid.
#[test]
fn walls_that_jump_are_refused() {
    let with = |shift: fn(f64) -> [f64; 2], velocity: fn(f64) -> [f64; 2]| {
        let pool = Body::block("pool", liquid(), [0.0; 2], [0.1; 2], DX);
        let motion = Translation::new(shift, velocity, |_| [0.0; 2]);
        let mut simulation = Scene::<f64, 2>::new(schemes::weakly_compressible())
            .body(pool)
            .wall(floor().motion(motion))
            .build()
            .unwrap();
        simulation.run_until(0.004)
    };
    let steady = with(|t| [0.0, t], |_| [0.0, 1.0]);
    assert!(steady.is_ok(), "{steady:?}");
    let wrong = [
        with(|t| [0.0, if t > 0.002 { 0.05 } else { 0.0 }], |_| [0.0; 2]),
        with(
            |t| [0.0, if t > 0.002 { f64::NAN } else { 0.0 }],
            |_| [0.0; 2],
        ),
        with(
            |_| [0.0; 2],
            |t| [if t > 0.002 { f64::NAN } else { 0.0 }, 0.0],
        ),
    ];
    for outcome in wrong {
        let error = outcome.unwrap_err();
        let Error::WallJump { wall, end, .. } = &error else {
            panic!("{error:?}");
        };
        assert_eq!(wall, "floor");
        assert!(
            *end < 0.003 && error.to_string().contains("without jumps"),
            "{error}"
        );
    }
}

#[test]
fn what_closes_slower_than_sound_sets_no_step() {
    let pool = Body::block("pool", liquid(), [0.0, 0.05], [0.1, 0.15], DX);
    let mut simulation = Scene::<f64, 2>::new(schemes::weakly_compressible())
        .body(pool.velocity([0.0, -1.0]))
        .wall(floor())
        .build()
        .unwrap();
    simulation
        .run_with(0.1, |now| {
            let vote = now.last_vote().unwrap();
            assert!(vote.criterion != Criterion::Approach, "{vote:?}");
        })
        .unwrap();
    assert!(simulation.steps() > 100);
}
