//! The order of a list of effects has no meaning: laws run in the order that their declarations give.
//! Laws are permuted at run time, lists are permuted in the source, and neither program nor bits change.

use meshfree::effect::{
    ConsistentShifting, Damage, DensityFloor, FiniteStrainPlasticity, Hypoelastic, PairingControl,
    Plasticity, UniaxialStress, YieldingHourglass,
};
use meshfree::material::failure::{PlasticStrainLimit, SpallStrength};
use meshfree::prelude::*;
use meshfree::scene::Start;

fn copper() -> Material<f64> {
    catalogue::copper()
        .with_shear_modulus(46e9)
        .with_yield_stress(1e8)
        .with_failure(PlasticStrainLimit::new(0.004))
}

/// Halves of a bar that fly apart at ±60 m/s.
fn bar(scheme: impl Into<Scheme<f64, 1>>) -> Simulation<f64, 1> {
    let apart = |[x]: [f64; 1], start| Start {
        velocity: [if x < 0.0 { -60.0 } else { 60.0 }],
        ..start
    };
    let bar = Body::block("bar", copper(), [-0.01], [0.01], 1e-4).start(apart);
    Scene::new(scheme).body(bar).build().expect("a bar")
}

/// Every number that particles carry, in the order of their slots.
fn bits<const D: usize>(scene: &Simulation<f64, D>, fields: Fields) -> Vec<u64> {
    let mut numbers = Vec::new();
    for field in fields.iter() {
        for particle in scene.all() {
            numbers.extend(particle.scalar(field));
            numbers.extend(particle.vector(field).into_iter().flatten());
            numbers.extend(
                particle
                    .tensor(field)
                    .iter()
                    .flat_map(|own| *own.components()),
            );
            numbers.extend(particle.matrix(field).iter().flatten().flatten());
        }
    }
    numbers.into_iter().map(f64::to_bits).collect()
}

#[test]
fn the_bar_of_a_list_is_the_bar_of_another_list() {
    let lists: [Scheme<f64, 1>; 3] = [
        schemes::impact_by_continuity()
            .with(Hypoelastic)
            .with(Plasticity)
            .with(Damage)
            .compose(),
        schemes::impact_by_continuity()
            .with(Hypoelastic)
            .with(Damage)
            .with(Plasticity)
            .compose(),
        schemes::impact_by_continuity()
            .with(Damage)
            .with(Plasticity)
            .with(Hypoelastic)
            .compose(),
    ];
    let fields = lists[0].fields();
    let program = lists[0].step_program();
    let flow = program.find("plastic flow").expect("a law");
    assert!(flow < program.find("failure").expect("a law"), "{program}");
    let mut first = None;
    for scheme in lists {
        assert_eq!(program, scheme.step_program());
        let mut bar = bar(scheme);
        bar.run_until(1e-6).expect("a run");
        let work = bar.ledger().whole.total("plastic work").expect("a column");
        let own = (work.to_bits(), bits(&bar, fields));
        assert!(work > 0.0 && own.1.len() > 1000);
        assert_eq!(first.get_or_insert_with(|| own.clone()), &own);
    }
}

/// A scheme whose laws stood in 200 other orders prints the same program and runs to the same bits.
fn stays<const D: usize>(
    compose: impl Fn() -> Scheme<f64, D>,
    build: impl Fn(Scheme<f64, D>) -> Simulation<f64, D>,
) {
    let program = compose().step_program();
    let run = |scheme: Scheme<f64, D>| {
        let fields = scheme.fields();
        let mut own = build(scheme);
        for _ in 0..3 {
            own.step().expect("a step");
        }
        bits(&own, fields)
    };
    let first = run(compose());
    assert!(first.len() > 100);
    for seed in 0..200 {
        let mut scheme = compose();
        scheme.permute_laws(seed);
        assert_eq!(scheme.step_program(), program, "{seed}");
        if seed < 20 {
            assert_eq!(run(scheme), first, "{seed}");
        }
    }
}

#[test]
fn permuted_laws_are_the_same_laws() {
    let solid = || {
        schemes::impact_by_continuity()
            .with(Hypoelastic)
            .with(UniaxialStress)
            .with(Plasticity)
            .with(Damage)
            .with(DensityFloor::default())
            .compose()
    };
    stays::<1>(solid, bar);
    let liquid = || {
        schemes::weakly_compressible()
            .with(AcousticDamping { strength: 0.1 })
            .with(Shifting::STANDARD)
            .with(PairingControl::default())
            .with(ExpansionMemory)
            .compose()
    };
    stays::<1>(liquid, |scheme| {
        let water = catalogue::weakly_compressible_water(1.0).with_pressure_cut_off(0.0);
        let stretch = |[x]: [f64; 1], start| Start {
            velocity: [0.1 * x],
            ..start
        };
        let water = Body::block("water", water, [0.0], [1.0], 0.02).start(stretch);
        Scene::new(scheme).body(water).build().expect("water")
    });
    let shifted = || {
        schemes::weakly_compressible()
            .with(ConsistentShifting::default())
            .with(Shifting::STANDARD)
            .with(PairingControl::default())
            .compose()
    };
    stays::<2>(shifted, |scheme| {
        let water = catalogue::weakly_compressible_water(1.0);
        let shear = |[x, y]: [f64; 2], start| Start {
            velocity: [y.sin(), x.cos()],
            ..start
        };
        let water = Body::block("water", water, [0.0; 2], [1.0; 2], 0.05).start(shear);
        Scene::new(scheme).body(water).build().expect("water")
    });
    let structure = || {
        schemes::total_lagrangian()
            .with(FiniteStrainPlasticity)
            .with(YieldingHourglass)
            .compose()
    };
    stays::<2>(structure, |scheme| {
        let shear = |[x, _]: [f64; 2], start| Start {
            velocity: [0.0, 3e4 * x],
            ..start
        };
        let copper = catalogue::copper()
            .with_shear_modulus(46e9)
            .with_yield_stress(1e8)
            .with_failure(SpallStrength::new(1e9));
        let plate = Body::block("plate", copper, [0.0; 2], [0.01; 2], 1e-3).start(shear);
        Scene::new(scheme).body(plate).build().expect("a plate")
    });
}
