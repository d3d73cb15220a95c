//! Parts of scenes that do not run on a device, each refused by its name with a remedy.
//! Nothing of it needs a device.

use super::{Fill, stirred, water};
use crate::compare::{build, refusal, refused};
use meshfree::boundary::{Inlet, Outlet};
use meshfree::coupling::Penalty;
use meshfree::effect::{
    Chunk, Effect, Law, Point, PointLaw, Reach, Rung, Setting, StepProgram, Tally,
};
use meshfree::integrator::RungeKutta4;
use meshfree::particles::{Field, Fields};
use meshfree::prelude::*;
use meshfree::scalar::{Lane, Real};
use meshfree::simulation::Load;
use meshfree::term::Stage;

fn plain() -> Scene<f64, 2> {
    water::<f64, 2>(Fill::Dam, true)
}

#[test]
fn tanks_are_taken() {
    assert!(build(plain()).offload().is_ok());
    assert!(build(stirred::<f64>(true)).offload().is_ok());
}

#[test]
fn parts_of_liquids_are_refused_by_name() {
    let late = |now: &Simulation<f64, 2>| now.time() > 1.0;
    let load = || Load::acceleration(|_| [0.0, 1.0]).on("water");
    refused(plain().event("late", late), &["the event `late`"]);
    refused(plain().load(load()), &["the load (", "water"]);
    let end = Outlet::plane([0.55, 0.0], [1.0, 0.0]);
    refused(plain().outlet(end), &["an outlet"]);
    let spacing = 0.0125;
    let opening = (0..4)
        .map(|k| [0.0, spacing * (f64::from(k) + 0.5)])
        .collect();
    let inlet = Inlet::new("water", opening, [0.5, 0.0], spacing, 40);
    let liquid = catalogue::weakly_compressible_water(2.0);
    let stream = || Body::block("water", liquid.clone(), [0.0; 2], [0.1, 0.05], spacing);
    let open = || Scene::<f64, 2>::new(schemes::weakly_compressible()).body(stream());
    refused(open().inlet(inlet), &["the inlet `"]);
    // All at once.
    let both = plain().event("late", late).load(load());
    refused(both, &["the event `late`", "the load ("]);
    let mut kept = build(plain());
    kept.keep_energy();
    assert!(refusal(kept).contains("energy ledger (Simulation::keep_energy)"));
    let mut watched = build(plain());
    watched.keep_stability(meshfree::simulation::Thresholds::default());
    assert!(refusal(watched).contains("Simulation::keep_stability"));
}

#[test]
fn laws_in_double_precision_are_refused_for_particles_in_single() {
    let parts = [
        "the law `shifting`",
        "computes in f64 where particles are stored in f32",
    ];
    refused(stirred::<f32>(true), &parts);
}

fn rod(name: &str, low: f64) -> Body<f64, 1> {
    Body::block(name, catalogue::copper(), [low], [low + 0.01], 2e-4)
}

#[test]
fn solids_are_refused_by_what_they_have() {
    let rods = || {
        let scene = Scene::<f64, 1>::new(schemes::impact());
        scene.body(rod("left", 0.0)).body(rod("right", 0.01))
    };
    let slides = rods().couple("left", "right", Penalty::new().friction(0.1));
    refused(slides, &["the coupling `penalty", "friction"]);
    let stiff = rods()
        .rigid("right")
        .couple("left", "right", Penalty::new());
    refused(stiff, &["the rigid body `right`"]);
    let scheme = schemes::impact().energy(EnergyForm::Symmetric);
    let kept = Scene::<f64, 1>::new(scheme).body(rod("left", 0.0));
    let kept = kept.body(rod("right", 0.01)).integrator(RungeKutta4);
    let kept = kept.couple("left", "right", Penalty::new());
    refused(
        kept,
        &["the integrator rk4, which keeps states, with forces"],
    );
    refused(
        Scene::new(schemes::lam2002()).body(rod("rod", 0.0)),
        &["density by Lam et al."],
    );
}

/// An effect with a law on pressures that a device has no record of.
#[derive(Clone, Debug)]
struct With<A>(A);

impl<A: Own> Effect<1> for With<A> {
    type Terms = ();
    fn terms(&self, _setting: &Setting) {}
    fn register<T: Real>(&self, program: &mut StepProgram<T, 1>) {
        self.0.register(program);
    }
}

/// How such a law is registered.
trait Own: Clone + core::fmt::Debug + Send + Sync + 'static {
    fn register<T: Real>(&self, program: &mut StepProgram<T, 1>);
}

const PRESSURE: Fields = Fields::of(&[Field::PRESSURE]);

/// It loops over columns.
#[derive(Clone, Debug)]
struct Looping;

impl<T: Real> Law<T, 1> for Looping {
    fn name(&self) -> &'static str {
        "looping"
    }
    fn reads(&self) -> Fields {
        PRESSURE
    }
    fn writes(&self) -> Fields {
        PRESSURE
    }
    fn rung(&self) -> Option<Rung> {
        Some(Rung::Bound)
    }
    fn apply(&self, chunk: &mut Chunk<'_, T, 1>) -> Tally {
        let (_, [pressure]) = chunk.columns([], [Field::PRESSURE]);
        for own in pressure {
            *own += T::one();
        }
        Tally::default()
    }
}

impl Own for Looping {
    fn register<T: Real>(&self, program: &mut StepProgram<T, 1>) {
        program.law(Stage::State, self.clone());
    }
}

/// Its text reads the time.
#[derive(Clone, Debug)]
struct Timed;

impl PointLaw<1> for Timed {
    const NAME: &'static str = "timed";
    const READS: Fields = PRESSURE;
    const WRITES: Fields = PRESSURE;
    const RUNG: Option<Rung> = Some(Rung::Bound);
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, 1, P>) {
        let now = at.get(Field::PRESSURE) + L::of(at.around.time);
        at.set(Field::PRESSURE, now);
    }
}

impl Own for Timed {
    fn register<T: Real>(&self, program: &mut StepProgram<T, 1>) {
        program.law(Stage::State, self.clone());
    }
}

/// Its text looks at an element of a lane.
#[derive(Clone, Debug)]
struct Branching;

impl PointLaw<1> for Branching {
    const NAME: &'static str = "branching";
    const READS: Fields = PRESSURE;
    const WRITES: Fields = PRESSURE;
    const RUNG: Option<Rung> = Some(Rung::Bound);
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, 1, P>) {
        let doubled = at.get(Field::PRESSURE).map(|own| own + own);
        at.set(Field::PRESSURE, doubled);
    }
}

impl Own for Branching {
    fn register<T: Real>(&self, program: &mut StepProgram<T, 1>) {
        program.law(Stage::State, self.clone());
    }
}

#[test]
fn laws_without_a_record_are_refused_with_the_reason() {
    fn scene(law: impl Own) -> Scene<f64, 1> {
        let water = catalogue::weakly_compressible_water(2.0);
        let scheme = schemes::weakly_compressible().with(With(law));
        Scene::new(scheme).body(Body::block("water", water, [0.0], [1.0], 0.02))
    }
    refused(
        scene(Looping),
        &[
            "the law `looping`",
            "it loops over columns itself",
            "PointLaw",
        ],
    );
    refused(
        scene(Timed),
        &["the law `timed`", "it depends on time", "PointLaw::prepare"],
    );
    refused(
        scene(Branching),
        &[
            "the law `branching`",
            "a function of elements",
            "Lane::select",
        ],
    );
}
