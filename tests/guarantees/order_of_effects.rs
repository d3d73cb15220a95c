//! The order of a list of effects has no meaning: what effects do runs in the order of declarations and names.
//! Lists are permuted at run time and in the source, and neither program nor bits nor refusals change.

use meshfree::effect::{
    ArtificialConduction, BySum, ConsistentShifting, Damage, DensityFloor, Evolved,
    FiniteStrainPlasticity, HourglassFree, Hypoelastic, PairingControl, Plasticity, Setting,
    StepProgram, UniaxialStress, YieldingHourglass,
};
use meshfree::material::failure::{PlasticStrainLimit, SpallStrength};
use meshfree::name;
use meshfree::particles::{Output, Outputs};
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::term::{
    Fourtakas, In, LaminarViscosity, Layout, Pair, Sums, Term, TermDoc, stage, viscosity,
};
use std::sync::atomic::{AtomicUsize, Ordering};

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

/// A scheme whose effects said what they do in 200 other orders prints the same program and runs to the same bits.
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
        scheme.permute(seed);
        assert_eq!(scheme.step_program(), program, "{seed}");
        if seed < 20 {
            assert_eq!(run(scheme), first, "{seed}");
        }
    }
}

#[test]
fn permuted_entries_are_the_same_entries() {
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
            .with(VolumeConsistency { strength: 0.05 })
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

/// Schemes of one builder with the same effects in several orders.
macro_rules! orders {
    ($builder:expr; $([$($effect:expr),*])*) => {
        [$($builder$(.with($effect))*.compose()),*]
    };
}

/// What a scheme prints, and the bits of a scene after some steps.
fn run<const D: usize>(
    scheme: Scheme<f64, D>,
    build: &impl Fn(Scheme<f64, D>) -> Simulation<f64, D>,
) -> (String, Vec<u64>) {
    let (text, fields) = (
        format!("{scheme}\n{}", scheme.step_program()),
        scheme.fields(),
    );
    let mut own = build(scheme);
    for _ in 0..5 {
        own.step().expect("a step");
    }
    (text, bits(&own, fields))
}

fn all_the_same<const D: usize>(
    schemes: impl IntoIterator<Item = Scheme<f64, D>>,
    build: impl Fn(Scheme<f64, D>) -> Simulation<f64, D>,
) {
    let mut all = schemes.into_iter().map(|scheme| run(scheme, &build));
    let first = all.next().expect("a scheme");
    assert!(first.1.len() > 100);
    for (order, own) in all.enumerate() {
        assert_eq!(own.0, first.0, "{order}");
        assert_eq!(own.1, first.1, "{order}");
    }
}

/// The sum to which effects of a test add, and its integral over time.
const SUM: Output = Output::scalar(name!("a sum of a test", "1/s"));
const SUMMED: Field = Field::scalar(name!("an integral of a test", "1"));

/// Adds a multiple of Σ W to a sum, under the name of a number.
#[derive(Clone, Copy, Debug)]
struct Adds<const NAME: usize>(f64);

impl<const D: usize, const NAME: usize> Term<D> for Adds<NAME> {
    const NAME: &'static str = ["tests::a", "tests::b", "tests::c"][NAME];
    const READS: Fields = Fields::NONE;
    const WRITES: Outputs = Outputs::of(&[SUM]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        sums.add(SUM, pair.w * L::of(self.0));
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: format!("{} Σ W", self.0),
            equation: "",
            source: "",
        }
    }
}

impl<const D: usize, const NAME: usize> Effect<D> for Adds<NAME> {
    type Terms = (In<stage::Rates, Self>,);
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(*self),)
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        if NAME == 0 {
            let sum = BySum {
                sum: SUM,
                over: None,
            };
            program.declare(SUMMED, 0.0);
            program.evolve(Evolved::kicked(SUMMED).by(sum));
        }
    }
}

fn tube(scheme: Scheme<f64, 1>) -> Simulation<f64, 1> {
    let gas = Material::new("gas", IdealGas::new(1.4, 1.0));
    let start = |[x]: [f64; 1], start| Start {
        velocity: [0.1 * (9.0 * x).sin()],
        energy: 2.5 + x,
        ..start
    };
    let gas = Body::block("gas", gas, [0.0], [1.0], 0.02).start(start);
    Scene::new(scheme).body(gas).build().expect("a tube")
}

#[test]
fn lists_in_other_orders_are_the_same_scheme() {
    let (flow, hourglass) = (ArtificialConduction::default(), HourglassFree::default());
    let solids = orders! {
        schemes::impact_by_continuity();
        [Hypoelastic, Plasticity, Damage, hourglass, flow]
        [flow, hourglass, Damage, Plasticity, Hypoelastic]
        [Plasticity, flow, Hypoelastic, hourglass, Damage]
        [hourglass, Damage, flow, Hypoelastic, Plasticity]
    };
    all_the_same::<1>(solids, bar);
    let diffusion = DensityDiffusion(Fourtakas::default());
    let (viscous, damping) = (Laminar(LaminarViscosity), AcousticDamping { strength: 0.1 });
    let (shift, volumes) = (Shifting::STANDARD, VolumeConsistency { strength: 0.05 });
    let liquids = orders! {
        SchemeBuilder::liquid(WendlandC2, viscosity::Inviscid);
        [diffusion, viscous, damping, shift, volumes]
        [volumes, shift, damping, viscous, diffusion]
        [shift, diffusion, volumes, viscous, damping]
        [damping, volumes, diffusion, shift, viscous]
    };
    all_the_same::<1>(liquids, |scheme| {
        let water = catalogue::weakly_compressible_water(1.0).with_dynamic_viscosity(0.1);
        let stretch = |[x]: [f64; 1], start| Start {
            velocity: [0.1 * (9.0 * x).sin()],
            ..start
        };
        let water = Body::block("water", water, [0.0], [1.0], 0.02).start(stretch);
        Scene::new(scheme).body(water).build().expect("water")
    });
    let (a, b, c) = (Adds::<0>(0.1), Adds::<1>(0.7), Adds::<2>(0.3));
    let gases = orders! {
        schemes::gas();
        [a, b, c, flow]
        [flow, c, b, a]
        [b, flow, a, c]
        [c, a, flow, b]
    };
    all_the_same::<1>(gases, tube);
    // The bits show the order of the terms: that of other names.
    let [own, other] = [
        orders! { schemes::gas(); [a, b, c] },
        orders! { schemes::gas(); [Adds::<0>(0.3), Adds::<1>(0.7), Adds::<2>(0.1)] },
    ];
    let [own, other] = [own, other].map(|[scheme]| run(scheme, &tube).1);
    assert_ne!(own, other);
}

/// An effect that looks at its place in a list, which no effect should.
#[derive(Clone, Copy, Debug)]
struct Placed<const NUMBER: usize>;

static PLACES: AtomicUsize = AtomicUsize::new(0);

impl<const D: usize, const NUMBER: usize> Effect<D> for Placed<NUMBER> {
    type Terms = ();
    fn terms(&self, _setting: &Setting) {}
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        let field = [
            const { Field::scalar(name!("first", "1")) },
            const { Field::scalar(name!("second", "1")) },
        ][NUMBER];
        let place = PLACES.fetch_add(1, Ordering::Relaxed);
        program.declare(field, (place % 2) as f64);
    }
}

#[test]
fn an_effect_that_looks_at_its_place_is_caught() {
    let (first, second) = (Placed::<0>, Placed::<1>);
    let planted = orders! { schemes::gas(); [first, second] [second, first] };
    let [own, other] = planted.map(|scheme| run(scheme, &tube));
    assert_ne!(own.0, other.0);
    assert_ne!(own.1, other.1);
}

/// Everything that is wrong with a scheme of the water of a test.
fn refused(scheme: Scheme<f64, 1>) -> Vec<String> {
    let water = catalogue::weakly_compressible_water(1.0);
    let water = Body::block("water", water, [0.0], [1.0], 0.02);
    let found = Scene::new(scheme).body(water).problems();
    found.iter().map(ToString::to_string).collect()
}

#[test]
fn lists_in_other_orders_are_refused_in_the_same_words() {
    let (damping, volumes) = (
        AcousticDamping { strength: -1.0 },
        VolumeConsistency { strength: -1.0 },
    );
    let flow = ArtificialConduction::default();
    let all = orders! {
        schemes::weakly_compressible();
        [damping, Plasticity, volumes, flow, Damage]
        [Damage, flow, volumes, Plasticity, damping]
        [flow, Damage, Plasticity, damping, volumes]
        [Plasticity, volumes, damping, Damage, flow]
    };
    let [first, others @ ..] = all.map(refused);
    assert!(first.len() > 4, "{first:?}");
    for own in others {
        assert_eq!(own, first);
    }
}

#[test]
fn two_terms_of_one_name_are_refused_by_both_names() {
    let (a, b) = (Adds::<1>(0.1), Adds::<1>(0.7));
    let all: [Scheme<f64, 1>; 2] =
        orders! { schemes::gas(); [Adds::<0>(0.3), a, b] [b, Adds::<0>(0.3), a] };
    let [first, second] = all.map(|scheme| {
        let gas = Material::new("gas", IdealGas::new(1.4, 1.0));
        let gas = Body::block("gas", gas, [0.0], [1.0], 0.02).energy(2.5);
        let found = Scene::new(scheme).body(gas).problems();
        found.iter().map(ToString::to_string).collect::<Vec<_>>()
    });
    assert_eq!(first, second);
    let text = "the terms `0.1 Σ W` and `0.7 Σ W` of the stage rates have one name, tests::b";
    assert!(first.len() == 1 && first[0].contains(text), "{first:?}");
}
