//! The ledger sees energy from nowhere: stored energy as a function of the state, against the work that went into it.
//! Runs whose steps alternate are the control; solids, liquids, gas, contact and plastic impact are not to be blamed.

use meshfree::coupling::{ContactDensity, Penalty};
use meshfree::effect::{
    FiniteStrainPlasticity, Hypoelastic, NeoHookean, Plasticity, StVenantKirchhoff,
};
use meshfree::material::eos::{IdealGas, Linear};
use meshfree::material::{Liquid, Material, SoundSpeed};
use meshfree::prelude::*;
use meshfree::scheme::Start;
use meshfree::simulation::{StoredBalance, Thresholds};

fn soft<T: Real>() -> Material<T> {
    let law = Linear::from_bulk_modulus(1000.0, 3.25e6);
    Material::new("soft", law).with_shear_modulus(7.15e5)
}

/// A plate that is clamped at its left end and bent by a velocity, six particles thick.
fn plate<T: Real>(scheme: impl Into<Scheme<T, 2>>, speed: f64) -> Scene<T, 2> {
    let bent = move |[x, _]: [f64; 2], start| Start {
        velocity: [0.0, speed * (x.max(0.0) / 0.2).powi(2)],
        ..start
    };
    let body = Body::block("plate", soft(), [-0.02, 0.0], [0.2, 0.02], 0.02 / 6.0);
    Scene::new(scheme)
        .body(body.start(bent))
        .fix("plate", |[x, _]| *x < 0.0)
}

/// The time after which steps are cut \[s\]: 800 times in a period of the plate.
const CUT: f64 = 0.2552 / 800.0;

/// Takes steps that are cut to end at multiples of a time, the last two of them equal: a pattern with which waves resonate far
/// below the limit of stability.
fn alternate<T: Real, const D: usize>(now: &mut Simulation<T, D>, steps: u64) -> Result<(), Error> {
    for _ in 0..steps {
        let left = CUT * ((now.time() / CUT + 1e-9).floor() + 1.0) - now.time();
        let step = now.vote()?.step;
        let is_halved = left < 2.0 * step && left > 1.000_001 * step;
        now.step_at_most(if is_halved { 0.5 * left } else { left })?;
    }
    Ok(())
}

/// The account of the only part of which something can be said.
fn balance<T: Real, const D: usize>(now: &Simulation<T, D>) -> StoredBalance {
    let parts = now.stored_energy().parts;
    let known: Vec<_> = parts.iter().filter_map(|part| part.balance.ok()).collect();
    assert_eq!(known.len(), 1, "{parts:?}");
    known[0]
}

/// Steps a watched scene, and asks that its verdict has nothing against its stored energy; the largest share of all parts.
fn sound<T: Real, const D: usize>(name: &str, scene: Scene<T, D>, steps: usize) -> f64 {
    let mut now = scene.build().unwrap();
    now.keep_energy();
    now.keep_stability(Thresholds::default());
    for _ in 0..steps {
        now.step().unwrap();
    }
    let (report, stored) = (now.stability(), now.stored_energy());
    println!("{name}: {stored}");
    assert!(!report.verdict.breaks("stored energy"), "{name}: {report}");
    let largest = stored.largest().expect("something can be said");
    assert_eq!(report.stored_energy.map(|own| own.value), Some(largest));
    largest
}

#[test]
fn equal_steps_of_an_undamped_plate_gain_nothing() {
    let neo_hookean = || schemes::total_lagrangian().with(NeoHookean);
    let kirchhoff = schemes::total_lagrangian().with(StVenantKirchhoff);
    for (name, largest) in [
        (
            "neo-Hookean",
            sound("", plate::<f64>(neo_hookean(), 1.0), 1600),
        ),
        (
            "St Venant–Kirchhoff",
            sound("", plate::<f64>(kirchhoff, 1.0), 1600),
        ),
        ("f32", sound("", plate::<f32>(neo_hookean(), 1.0), 1600)),
    ] {
        println!("{name}: {largest:e}");
        assert!(largest < 2e-3, "{name}: {largest}");
    }
}

#[test]
fn alternating_steps_of_an_undamped_plate_are_stopped() {
    let mut now = plate::<f64>(schemes::total_lagrangian().with(NeoHookean), 1.0)
        .build()
        .unwrap();
    now.keep_stability(Thresholds::default());
    let before = now.ledger().whole.kinetic;
    let error = alternate(&mut now, 20_000).unwrap_err();
    println!("{error}");
    let Error::StoredEnergy {
        part,
        gain,
        supplied,
        limit,
        body,
        particle,
        position,
        time,
        step,
    } = error
    else {
        panic!("{error}");
    };
    assert_eq!(
        (part.as_str(), body.as_str(), limit),
        ("plate", "plate", 0.5)
    );
    assert!(gain > 0.5 * supplied && gain < 5.0 * supplied);
    // Nothing but the start has supplied energy, and the ledger closes all the same.
    assert!(
        (supplied / before - 1.0).abs() < 1e-6,
        "{supplied} {before}"
    );
    let whole = now.ledger().whole;
    assert!((whole.total_energy() / before - 1.0).abs() < 1e-6);
    // What is stored has not been taken from anything.
    let elastic = whole.total("elastic energy").unwrap();
    assert!(((elastic - whole.internal) / gain - 1.0).abs() < 1e-3);
    assert!(particle < now.particles() && position[0] > -0.02 && position[0] < 0.3);
    assert_eq!((time, step), (now.time(), now.steps()));
    assert!(matches!(now.step(), Err(Error::Failed { .. })));
    // The verdict has it from a hundredth on.
    let verdict = now.stability().verdict;
    assert!(verdict.breaks("stored energy") && verdict.failed.is_some());
}

#[test]
fn the_verdict_comes_before_the_error_and_both_can_be_moved() {
    let scene = || plate::<f64>(schemes::total_lagrangian().with(NeoHookean), 1.0);
    let mut now = scene().build().unwrap();
    now.keep_stability(Thresholds::default());
    for _ in 0..20_000 {
        alternate(&mut now, 1).unwrap();
        if now.stored_energy().largest() > Some(0.01) {
            break;
        }
    }
    let report = now.stability();
    let own = report.stored_energy.clone().expect("a plate is checkable");
    assert!(own.value > 0.01 && own.value < 0.5, "{own:?}");
    assert!(report.verdict.failed.is_none());
    let breach = report
        .verdict
        .breaches
        .iter()
        .find(|own| own.measure == "stored energy");
    let at = breach
        .and_then(|own| own.at.clone())
        .expect("it has a place");
    assert!(at.body == "plate" && at.time <= now.time());
    // With other limits it has nothing to say, and the run is not stopped.
    let mut free = scene().build().unwrap();
    free.keep_stability(Thresholds {
        stored_energy: f64::INFINITY,
        ..Thresholds::default()
    });
    free.limit_stored_energy(f64::INFINITY);
    alternate(&mut free, now.steps()).unwrap();
    assert!(!free.stability().verdict.breaks("stored energy"));
}

/// A load that works on a plate supplies it with what it then stores.
#[test]
fn what_a_load_works_is_supplied() {
    let scene = plate::<f64>(schemes::total_lagrangian().with(NeoHookean), 0.0)
        .acceleration(|_| [0.0, -1.0]);
    let mut now = scene.build().unwrap();
    for _ in 0..800 {
        now.step().unwrap();
    }
    let own = balance(&now);
    let whole = now.ledger().whole;
    let supplied = whole.kinetic + whole.internal;
    assert!(
        supplied > 0.0 && own.supplied >= 0.98 * supplied,
        "{own:?} {supplied}"
    );
    assert!(own.largest < 0.01, "{own:?}");
}

#[test]
fn solids_contact_and_plastic_impact_are_not_blamed() {
    let two = |scheme: Scheme<f64, 2>, material: Material<f64>, v: f64| {
        let [a, b] = [0.0, 0.1].map(|x| ([x, 0.0], [x + 0.1, 0.1]));
        Scene::<f64, 2>::new(scheme)
            .body(Body::block("a", material.clone(), a.0, a.1, 0.005).velocity([v, 0.0]))
            .body(Body::block("b", material, b.0, b.1, 0.005))
    };
    let yielding = || soft().with_yield_stress(2e4);
    let elastic = || schemes::total_lagrangian().with(NeoHookean);
    let hypoelastic = || schemes::impact_by_continuity().with(Hypoelastic);
    sound(
        "hypoelastic blocks",
        two(hypoelastic().into(), soft(), 2.0),
        400,
    );
    sound(
        "plastic blocks",
        two(hypoelastic().with(Plasticity).into(), yielding(), 4.0),
        400,
    );
    sound(
        "penalty",
        two(elastic().into(), soft(), 2.0).couple("a", "b", Penalty::new().friction(0.3)),
        400,
    );
    sound(
        "contact density",
        two(elastic().into(), soft(), 2.0).couple("a", "b", ContactDensity::new()),
        400,
    );
    let damped = schemes::total_lagrangian_impact().with(NeoHookean);
    sound("damped plate", plate::<f64>(damped, 1.0), 400);
    let struck = |[x, _]: [f64; 2], start| Start {
        velocity: [if x < 0.01 { 0.0 } else { -2.0 }, 0.0],
        ..start
    };
    let plastic = schemes::total_lagrangian_impact().with(FiniteStrainPlasticity);
    let bar = Body::block("bar", yielding(), [0.0; 2], [0.2, 0.05], 0.005).start(struck);
    let bar = Scene::<f64, 2>::new(plastic)
        .body(bar)
        .fix("bar", |[x, _]| *x < 0.01);
    sound("plastic bar", bar, 600);
}

#[test]
fn liquids_and_gas_are_not_blamed() {
    let sound_speed = SoundSpeed::Chosen(30.0);
    let water = || Liquid::new(1000.0, 1480.0, 1e-3).material::<f64>("water", sound_speed);
    let dam = |water| {
        let body = Body::block("water", water, [0.0; 2], [0.1, 0.2], 0.01);
        let open = [[true, true], [true, false]];
        Scene::<f64, 2>::new(schemes::weakly_compressible())
            .body(body.hydrostatic([0.0, -9.81], [0.0, 0.2]))
            .wall(Wall::around("tank", [0.0; 2], [0.4, 0.3], 0.01, 3, open))
            .acceleration(|_| [0.0, -9.81])
    };
    sound("dam break", dam(water()), 800);
    sound(
        "dam break without tension",
        dam(water().with_pressure_cut_off(0.0)),
        800,
    );
    let gas = Material::<f64>::new("gas", IdealGas::new(1.4, 1.0));
    let block = |name, x: f64, v: f64| {
        let body = Body::block(name, gas.clone(), [x], [x + 1.0], 0.02);
        body.energy(1.0).velocity([v])
    };
    let gases = Scene::<f64, 1>::new(schemes::gas())
        .body(block("left", 0.0, 0.5))
        .body(block("right", 1.0, 0.0));
    assert_eq!(sound("gas", gases, 200), 0.0);
}

#[test]
fn what_cannot_be_said_is_said_not_to_be() {
    let rod = Body::block("rod", catalogue::copper(), [0.0], [0.01], 1e-3).velocity([10.0]);
    let mut now = Scene::<f64, 1>::new(schemes::impact())
        .body(rod)
        .build()
        .unwrap();
    now.step().unwrap();
    let stored = now.stored_energy();
    assert_eq!((stored.body("rod"), stored.largest()), (None, None));
    assert!(stored.to_string().contains("not checkable"), "{stored}");
    assert!(
        now.stability()
            .to_string()
            .contains("gain of stored energy      not checkable")
    );
}

/// The accounts are part of a checkpoint: what goes on from it says the same, to the bit.
#[cfg(feature = "checkpoint")]
#[test]
fn accounts_go_on_from_a_checkpoint() {
    let folder = std::env::temp_dir().join(format!("meshfree-stored-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join("plate.safetensors");
    let scene = || plate::<f64>(schemes::total_lagrangian().with(NeoHookean), 1.0);
    // At a step and at a reading between two.
    for reading in [0.0, 0.4] {
        let mut whole = scene().build().unwrap();
        alternate(&mut whole, 100).unwrap();
        let at = whole.time() + reading * whole.vote().unwrap().step;
        whole.run_until(at).unwrap();
        whole.limit_stored_energy(0.25);
        whole.save(&file).unwrap();
        let mut resumed = scene().resume(&file).unwrap();
        assert_eq!(whole.stored_energy(), resumed.stored_energy());
        for now in [&mut whole, &mut resumed] {
            now.step().unwrap();
            alternate(now, 100).unwrap();
        }
        let stored = whole.stored_energy();
        assert!(stored.largest() > Some(0.0));
        assert_eq!(stored, resumed.stored_energy());
        // The limit is kept too.
        let [a, b] = [&mut whole, &mut resumed].map(|now| alternate(now, 20_000).unwrap_err());
        assert_eq!(a.to_string(), b.to_string());
        assert!(matches!(a, Error::StoredEnergy { limit: 0.25, .. }));
    }
    std::fs::remove_dir_all(folder).unwrap();
}
