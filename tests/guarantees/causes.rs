//! Input that is wrong without looking so: what stops a run, or keeps a scene from being built, names the cause.
//! Each has what is right beside it, so that no check refuses what is meant.

use meshfree::boundary::{Boundary, Inlet, MirrorPlane, Outlet, Periodic, Translation, Wall};
use meshfree::coupling::{CoupledParticle, Coupling};
use meshfree::effect::{BySum, Effect, Evolved, Setting, StepProgram};
use meshfree::error::{Error, Result};
use meshfree::geometry::{Cuboid, layers};
use meshfree::integrator::{Integrator, KickDriftKick, System};
use meshfree::kernel::{CubicSpline, Kernel};
use meshfree::material::eos::{EosState, EquationOfState, Guards, IdealGas, Jwl, StiffenedGas};
use meshfree::name;
use meshfree::particles::{Field, Fields, Output, Outputs};
use meshfree::prelude::*;
use meshfree::scalar::Lane;
use meshfree::simulation::LoadPoint;
use meshfree::sweep::Transform;
use meshfree::tensor::{Matrix, Vector};
use meshfree::term::{In, Layout, Pair, Sums, Term, TermDoc, stage};

const DX: f64 = 1e-3;

fn rod<T: Real>() -> Body<T, 1> {
    Body::block("rod", catalogue::copper(), [0.0], [0.02], DX)
}

fn good() -> Scene<f64, 1> {
    Scene::new(schemes::impact()).body(rod())
}

fn pool() -> Scene<f64, 2> {
    Scene::new(schemes::weakly_compressible()).body(block())
}

fn block() -> Body<f64, 2> {
    let water = catalogue::weakly_compressible_water(2.0);
    Body::block("water", water, [0.0; 2], [0.1; 2], 0.01)
}

/// What a scene is refused with, or a run of it stops with.
fn cause<T: Real, const D: usize>(scene: Scene<T, D>, end: f64) -> String {
    let run = scene.build().and_then(|mut run| run.run_until(end));
    match run {
        Ok(()) => "nothing".into(),
        Err(error) => error.to_string(),
    }
}

/// That a scene is refused or stopped, with all of some words and none of those that blame the run.
fn names<T: Real, const D: usize>(scene: Scene<T, D>, words: &[&str]) {
    let told = cause(scene, 1e-4);
    for word in words {
        assert!(told.contains(word), "{word}: {told}");
    }
    assert!(!told.contains("unstable: try"), "{told}");
}

fn runs<T: Real, const D: usize>(scene: Scene<T, D>, end: f64) {
    assert_eq!(cause(scene, end), "nothing");
}

#[test]
fn one_plane_given_twice() {
    let floor = || MirrorPlane::wall([0.0; 2], [0.0, -1.0]);
    let lid = MirrorPlane::wall([0.0, 0.1], [0.0, 1.0]);
    let side = MirrorPlane::symmetry([0.0; 2], [-1.0, 0.0]);
    let behind = MirrorPlane::wall([0.0, -0.005], [0.0, -1.0]);
    runs(pool().boundary(floor()).boundary(lid).boundary(side), 1e-3);
    for second in [
        floor(),
        behind,
        MirrorPlane::symmetry([0.3, 0.0], [0.0, -2.0]),
        floor().moving(0.1),
    ] {
        names(
            pool().boundary(floor()).boundary(second),
            &["same side", "its image would act twice"],
        );
    }
    // What no kernel reaches does nothing.
    let far = MirrorPlane::wall([0.0, -1.0], [0.0, -1.0]);
    runs(pool().boundary(floor()).boundary(far), 1e-3);
}

/// A boundary with one image, at `shift` \[m\] from `since` \[s\] on and 0.02 m on before.
#[derive(Clone, Debug)]
struct Own {
    shift: f64,
    since: f64,
    scale: f64,
}

impl Boundary<1> for Own {
    fn name(&self) -> String {
        "own boundary".into()
    }
    fn images(&self) -> usize {
        1
    }
    fn transform(&self, _: usize, time: f64) -> Transform<f64, 1> {
        let shift = if time >= self.since { self.shift } else { 0.02 };
        Transform {
            rotation: Matrix::<f64, 1>::identity() * self.scale,
            shift: Vector::<f64, 1>::new(shift),
            velocity: Vector::<f64, 1>::zeros(),
        }
    }
    fn reaches(&self, _: usize, x: &[f64; 1], reach: f64, _: f64) -> bool {
        x[0] < reach
    }
    fn moves(&self) -> bool {
        self.since > 0.0
    }
}

#[test]
fn a_boundary_of_ones_own_that_is_nowhere() {
    let own = |shift: f64, since: f64, scale: f64| {
        let scheme = schemes::impact_by_continuity();
        Scene::<f64, 1>::new(scheme).body(rod()).boundary(Own {
            shift,
            since,
            scale,
        })
    };
    runs(own(0.02, 0.0, 1.0), 1e-6);
    for bad in [f64::NAN, f64::INFINITY] {
        names(
            own(bad, 0.0, 1.0),
            &["transform of image 0 of the own boundary at t = 0"],
        );
        names(
            own(bad, 1e-6, 1.0),
            &["transform of image 0 of the own boundary gave", "finite"],
        );
    }
    names(own(0.02, 0.0, 0.5), &["rotation", "another size"]);
    names(
        own(0.0, 0.0, 1.0),
        &["shift of image 0", "must not be zero"],
    );
}

#[test]
fn an_acceleration_that_is_no_number() {
    let told = ["acceleration", "in m/s²"];
    let nan = |t: f64| if t > 2e-7 { f64::NAN } else { 9.81 };
    names(
        good().acceleration(move |t| [nan(t)]),
        &["acceleration of the scene", "gave NaN"],
    );
    names(good().acceleration(|_| [1e200]), &told);
    let small = || Scene::<f32, 1>::new(schemes::impact()).body(rod::<f32>());
    for much in [1e39, 1e30] {
        names(small().acceleration(move |_| [much]), &told);
        names(
            small().acceleration(move |t| [if t > 2e-7 { much } else { 0.0 }]),
            &told,
        );
        let load = Load::acceleration(move |_| [much]);
        names(
            small().load(load),
            &["the load (acceleration on all bodies)"],
        );
    }
    runs(small().acceleration(|_| [1e10]), 1e-7);
    // Heat of as many watts is a number of the scalar.
    runs(small().load(Load::heating(|_| 1e20)), 1e-20);
    names(
        small().load(Load::heating(|_| 1e39)),
        &["the load (heating on all bodies)"],
    );
}

/// Pushes by a force that is no number.
#[derive(Clone, Copy, Debug)]
struct Wild;

impl<T: Real, const D: usize> Coupling<T, D> for Wild {
    fn name(&self) -> &'static str {
        "wild"
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "wild".into(),
            equation: "F = 0/0",
            source: "this test",
        }
    }
    fn reach(&self, spacings: [f64; 2]) -> f64 {
        1.1 * spacings[0]
    }
    fn force(&self, _: &CoupledParticle<T, D>, _: &CoupledParticle<T, D>) -> [T; D] {
        [T::from_f64(f64::NAN); D]
    }
}

#[test]
fn functions_of_the_user_that_give_no_number() {
    let plate = Body::block("plate", catalogue::steel(), [-0.01], [0.0], DX);
    let scene = good().group(schemes::impact_by_continuity(), [plate]);
    names(
        scene.couple("rod", "plate", Wild),
        &["coupling wild of `rod` and `plate` gave NaN"],
    );
    let heat = Load::heating(|at| if at.time > 2e-7 { f64::NAN } else { 1.0 });
    names(
        good().load(heat),
        &["the load (heating on all bodies) gave NaN"],
    );
}

/// c² (ρ − ρ₀), and no number from a compression on.
#[derive(Clone, Debug)]
struct Hole;

impl EquationOfState for Hole {
    fn name(&self) -> &'static str {
        "law with a hole"
    }
    fn reference_density(&self) -> f64 {
        1000.0
    }
    fn uses_energy(&self) -> bool {
        false
    }
    #[inline(always)]
    fn state<L: Lane>(&self, density: L, _: L) -> EosState<L> {
        let over = density - L::of(1000.0);
        // The root of what is negative is none.
        let hole = (L::of(200.0) - over).sqrt();
        EosState {
            pressure: over * L::of(1e6) * hole / hole,
            sound_speed: L::of(1e3),
            guards: Guards::none(),
        }
    }
}

#[test]
fn a_law_that_gives_no_number_is_named() {
    let body = |name, low: f64, v: f64| {
        let material = Material::new("stuff", Hole);
        Body::block(name, material, [low], [low + 0.02], DX).velocity([v])
    };
    let strike = |v: f64| {
        let scene = Scene::<f64, 1>::new(schemes::impact());
        scene
            .body(body("rod", 0.0, v))
            .body(body("other", 0.02, -v))
    };
    runs(strike(0.1), 1e-5);
    names(
        strike(300.0),
        &[
            "pressure by the law of the material of particle",
            "gives no finite value",
        ],
    );
}

#[test]
fn walls_and_inlets_given_twice() {
    let tank = |name| Wall::around(name, [0.0; 2], [0.1; 2], 0.01, 3, [[true; 2]; 2]);
    let points = tank("tank").points().to_vec();
    let floor: Vec<_> = points.iter().copied().filter(|x| x[1] < 0.0).collect();
    let rest: Vec<_> = points.into_iter().filter(|x| x[1] > 0.0).collect();
    let floor = || Wall::of("floor", floor.clone(), 0.01);
    runs(
        pool().wall(floor()).wall(Wall::of("rest", rest, 0.01)),
        1e-3,
    );
    names(
        pool().wall(tank("tank")).wall(floor()),
        &["`tank` and `floor` overlap"],
    );
    let inlet = || {
        let opening = (0..10)
            .map(|k| [0.0, 0.01 * (f64::from(k) + 0.5)])
            .collect();
        Inlet::new("water", opening, [1.0, 0.0], 0.01, 200)
    };
    names(
        pool().inlet(inlet()).inlet(inlet()),
        &["an inlet of body `water`", "enter twice"],
    );
}

#[test]
fn motions_that_are_no_numbers() {
    let since = |bad: [bool; 3]| {
        let path = bad.map(|bad| move |t: f64| if bad && t > 2e-7 { [f64::NAN] } else { [0.0] });
        let [place, velocity, acceleration] = path;
        Translation::new(place, velocity, acceleration)
    };
    let clamped = |motion| good().clamp("rod", |x| x[0] < 0.004, motion);
    runs(clamped(since([false; 3])), 1e-6);
    for k in 0..3 {
        let motion = since(core::array::from_fn(|n| n == k));
        names(
            clamped(motion),
            &["motion of a clamp of body `rod` gave NaN", "finite"],
        );
    }
    let tank = || Wall::around("tank", [0.0; 2], [0.1; 2], 0.01, 3, [[true; 2]; 2]);
    let later = |_: f64| [0.0; 2];
    let nan = |t: f64| [if t > 2e-5 { f64::NAN } else { 0.0 }; 2];
    names(
        pool().wall(tank().motion(Translation::new(later, later, nan))),
        &["motion of wall `tank`"],
    );
    names(
        pool().wall(tank().motion(Translation::new(nan, later, later))),
        &["displacement of wall `tank`"],
    );
}

#[test]
fn a_velocity_in_another_unit() {
    let told = ["velocity of body", "check that it is in m/s"];
    names(good().body(rod().velocity([2e9])), &["velocity"]);
    let at = |v: f64| Scene::<f64, 1>::new(schemes::impact()).body(rod().velocity([v]));
    names(at(0.1e9), &told);
    names(at(1e6), &told);
    // The fastest meteoroids.
    runs(at(72e3), 1e-7);
    let water = |v: f64| {
        let scene = Scene::<f64, 2>::new(schemes::weakly_compressible());
        scene.body(block().velocity([0.0, v]))
    };
    names(water(0.1e9), &told);
    runs(water(20.0), 1e-3);
    // Cold gas has no sound to be measured by.
    let gas = Material::new("gas", IdealGas::new(5.0 / 3.0, 1.0));
    let cold = Body::block("gas", gas, [0.0], [1.0], 0.02)
        .velocity([1e4])
        .energy(1e-6);
    runs(Scene::<f64, 1>::new(schemes::gas()).body(cold), 1e-7);
}

/// A leapfrog, or none, that says another stability.
#[derive(Clone, Debug)]
struct Says {
    stability: f64,
    evaluates: bool,
}

impl Integrator for Says {
    fn name(&self) -> String {
        "bold".into()
    }
    fn step(&self, system: &mut dyn System, dt: f64) -> Result<()> {
        if self.evaluates {
            return KickDriftKick.step(system, dt);
        }
        system.kick(dt);
        system.drift(dt, 0.0)
    }
    fn stability(&self) -> f64 {
        self.stability
    }
}

#[test]
fn an_integrator_that_claims_more_than_it_bears() {
    let with = |stability: f64, evaluates| {
        good().integrator(Says {
            stability,
            evaluates,
        })
    };
    runs(with(1.0, true), 1e-6);
    for stability in [1.1, 2.0, 1e9] {
        names(
            with(stability, true),
            &["stability of the integrator bold", "oscillator grows"],
        );
    }
    names(
        with(1.0, false),
        &[
            "evaluations in a step of the integrator bold",
            "System::evaluate",
        ],
    );
}

/// The cubic spline with another stable step.
#[derive(Clone, Copy, Debug)]
struct Bold(f64);

impl Kernel<1> for Bold {
    fn name(&self) -> &'static str {
        "bold"
    }
    fn support(&self) -> f64 {
        2.0
    }
    fn normalisation(&self) -> f64 {
        Kernel::<1>::normalisation(&CubicSpline)
    }
    fn h_over_dx(&self) -> f64 {
        1.2
    }
    fn h_over_dx_range(&self) -> (f64, f64) {
        (1.0, 2.0)
    }
    fn stable_step(&self) -> f64 {
        self.0
    }
    #[inline(always)]
    fn shape<L: Lane>(&self, q: L) -> L {
        Kernel::<1>::shape(&CubicSpline, q)
    }
    #[inline(always)]
    fn slope_over_q<L: Lane>(&self, q: L) -> L {
        Kernel::<1>::slope_over_q(&CubicSpline, q)
    }
}

#[test]
fn a_kernel_that_claims_more_than_it_bears() {
    let with = |step: f64| {
        let scheme = schemes::impact().with_kernel(Bold(step));
        Scene::<f64, 1>::new(scheme).body(rod())
    };
    runs(with(1.29), 1e-7);
    for step in [2.1, 10.0, 1e9] {
        names(
            with(step),
            &["stable step of the bold kernel", "grow with that"],
        );
    }
}

#[test]
fn an_outlet_through_a_gas_takes_what_is_beyond() {
    let air = || Material::new("gas", IdealGas::new(1.4, 1.0));
    let cut = |end: f64| {
        let gas = Body::block("air", air(), [0.0], [1.0], 0.01).energy(2.5);
        let outlet = Outlet::plane([end], [1.0]);
        Scene::<f64, 1>::new(schemes::gas())
            .body(gas)
            .outlet(outlet)
            .build()
            .unwrap()
    };
    // As a body of what is left, to the bits but for the lists.
    let short = Body::block("air", air(), [0.0], [0.6], 0.01).energy(2.5);
    let mut short = Scene::<f64, 1>::new(schemes::gas())
        .body(short)
        .build()
        .unwrap();
    let mut long = cut(0.6);
    assert_eq!((long.particles(), long.removed().particles), (60, 40));
    let state = |run: &Simulation<f64, 1>| {
        let all = run
            .all()
            .map(|p| [p.density(), p.position()[0], p.smoothing_length()]);
        all.collect::<Vec<_>>()
    };
    assert_eq!(state(&long).len(), 60);
    for (a, b) in state(&long).iter().zip(state(&short)) {
        assert!((0..3).all(|k| (a[k] - b[k]).abs() < 1e-9), "{a:?} {b:?}");
    }
    // Both go on, the one through its outlet.
    long.run_until(0.05).unwrap();
    short.run_until(0.05).unwrap();
    assert!(long.particles() < 60 && short.particles() == 60);
}

#[test]
fn a_liquid_that_bears_tension_has_no_free_surface_in_a_summed_density() {
    let water = || Material::new("water", StiffenedGas::water());
    let told = [
        "free surface",
        "summed density",
        "schemes::weakly_compressible",
    ];
    let row = |low: f64| {
        let body = Body::block("water", water(), [low], [low + 0.05], DX);
        Scene::<f64, 1>::new(schemes::gas()).body(body)
    };
    names(row(0.0), &told);
    let wall = MirrorPlane::wall([0.0], [-1.0]);
    names(row(2.5 * DX).boundary(wall), &told);
    let sheet = Body::block("water", water(), [2.5 * DX, 0.0], [0.02, 0.02], DX);
    let wall = MirrorPlane::wall([0.0; 2], [-1.0, 0.0]);
    names(
        Scene::<f64, 2>::new(schemes::gas())
            .body(sheet)
            .boundary(wall),
        &told,
    );
    // Closed it has none, and neither has it in schemes for liquids and solids.
    runs(row(0.0).boundary(Periodic::along(0, 0.0, 0.05)), 1e-6);
    let body = Body::block("water", water(), [0.0], [0.05], DX);
    runs(Scene::<f64, 1>::new(schemes::impact()).body(body), 1e-6);
    // Products of a detonation press outwards however thin they are.
    let tnt = Material::new("TNT", Jwl::tnt());
    let lit = Body::block("charge", tnt, [0.0], [0.02], 2e-4).energy(Jwl::tnt().detonation_energy);
    runs(Scene::<f64, 1>::new(schemes::gas()).body(lit), 1e-6);
}

#[test]
fn corners_that_are_swapped() {
    let told = ["low and high are swapped", "low one comes first"];
    let turned = Body::block("rod", catalogue::copper(), [0.02], [0.0], DX);
    names(Scene::<f64, 1>::new(schemes::impact()).body(turned), &told);
    let cuboid = Cuboid::new([0.1, 0.0], [0.0, 0.1]);
    let water = catalogue::weakly_compressible_water(2.0);
    let filled = Body::fill("water", water, &cuboid, 0.01);
    names(
        Scene::<f64, 2>::new(schemes::weakly_compressible()).body(filled),
        &told,
    );
    let tank = Wall::around("tank", [0.0, 0.1], [0.1, 0.0], 0.01, 3, [[true; 2]; 2]);
    names(pool().wall(tank), &told);
    names(pool().boundary(Periodic::along(0, 0.1, 0.0)), &["swapped"]);
    names(
        pool().outlet(Outlet::outside_box([1.0; 2], [-1.0; 2])),
        &["swapped"],
    );
    let grid = meshfree::observe::SampleGrid::between([0.0, 1.0], [1.0, 0.0], [3, 3]);
    assert!(grid.unwrap_err().to_string().contains("swapped"));
    // What has no extent is no turn.
    let thin = Body::block("rod", catalogue::copper(), [0.0], [1e-4], DX);
    names(
        Scene::<f64, 1>::new(schemes::impact()).body(thin),
        &["has no particles"],
    );
}

#[test]
fn gravity_that_points_up() {
    let at = |g: f64, surface: f64| {
        let body = block().hydrostatic([0.0, g], [0.0, surface]);
        Scene::<f64, 2>::new(schemes::weakly_compressible()).body(body)
    };
    names(
        at(9.81, 0.1),
        &["hydrostatic start of body `water`", "gravity points down"],
    );
    names(
        at(-9.81, -0.1),
        &["hydrostatic start of body `water`", "below the surface"],
    );
    // A surface in the middle of it would hide that.
    names(
        at(9.81, 0.05).acceleration(|_| [0.0, -9.81]),
        &["starts hydrostatic under [0.0, 9.81]", "give both the same"],
    );
    for right in [
        at(-9.81, 0.1).acceleration(|_| [0.0, -9.81]),
        at(-9.81, 0.1),
        at(0.0, 0.1),
    ] {
        runs(right, 1e-4);
    }
}

#[test]
fn a_thickness_that_is_a_count() {
    let inside = Cuboid::new([0.0; 2], [1.0, 0.5]);
    assert_eq!(
        layers(&inside, 0.1, 0.3, [0.0; 2]).unwrap().len(),
        16 * 11 - 50
    );
    let error = layers(&inside, 0.01, 3.0, [0.0; 2])
        .unwrap_err()
        .to_string();
    assert!(error.contains("3 m thick is 300 layers"), "{error}");
    assert!(error.contains("times the spacing"), "{error}");
}

#[test]
fn heat_by_the_place_as_built_stays_in_the_material() {
    let source = |at: &LoadPoint<'_, 1>| match at.as_built {
        Some([x]) if x < 5.0 * DX => 1e6,
        _ => 0.0,
    };
    let by_place = |at: &LoadPoint<'_, 1>| if at.position[0] < 5.0 * DX { 1e6 } else { 0.0 };
    let heat = |load: Load<1>| {
        let scene = Scene::<f64, 1>::new(
            schemes::impact().with_viscosity(meshfree::term::viscosity::Inviscid),
        );
        let mut run = scene
            .body(rod().velocity([250.0]))
            .load(load)
            .build()
            .unwrap();
        run.run_until(1e-5).unwrap();
        run.all()
            .map(|particle| particle.energy())
            .collect::<Vec<f64>>()
    };
    let own = heat(Load::heating(source));
    for (k, heat) in own.iter().enumerate() {
        let right = if k < 5 { 10.0 } else { 0.0 };
        assert!((heat - right).abs() < 0.02, "{k}: {heat} J/kg of {right}");
    }
    // The control moves 2.5 spacings through the source.
    let moved = heat(Load::heating(by_place));
    assert!(moved[4] < 5.0, "{moved:?}");
}

const DYE: Field = Field::scalar(name!("dye", "1"));
const FLOW: Output = Output::scalar(name!("flow", "kg/s"));

/// A diffusion that limits no step, as nobody should write it.
#[derive(Clone, Copy, Debug)]
struct Unlimited(f64);

impl<const D: usize> Effect<D> for Unlimited {
    type Terms = (In<stage::Rates, Unlimited>,);
    fn terms(&self, _: &Setting) -> Self::Terms {
        (In::new(*self),)
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.declare(DYE, 0.0);
        program.evolve(Evolved::kicked(DYE).by(BySum::over_mass(FLOW)));
    }
}

impl<const D: usize> Term<D> for Unlimited {
    const NAME: &'static str = "tests::unlimited";
    const READS: Fields = Fields::of(&[DYE, Field::MASS, Field::DENSITY]);
    const WRITES: Outputs = Outputs::of(&[FLOW]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let masses = pair.i(Field::MASS) * pair.j(Field::MASS);
        let jump = pair.i(DYE) - pair.j(DYE);
        sums.add(
            FLOW,
            L::of(2.0 * self.0) * masses * jump * pair.f / pair.i(Field::DENSITY),
        );
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "diffusion".into(),
            equation: "m dc/dt = Σ m m 2κ (c − c) F/ρ",
            source: "Cleary & Monaghan 1999",
        }
    }
}

#[test]
fn an_effect_without_a_limit_says_so() {
    let scheme: Scheme<f64, 1> = schemes::impact().with(Unlimited(20.0)).compose();
    let text = scheme.step_program();
    assert!(text.contains("limits the step: nothing for dye"), "{text}");
    // The control of the page's example: without its limit the front grows from step to step.
    let body = rod().field(DYE, |[x]| [if x < 0.01 { 1.0 } else { 0.0 }]);
    let mut run = Scene::new(scheme).body(body).build().unwrap();
    run.run_until(5e-6).unwrap();
    let most = run.all().filter_map(|p| p.scalar(DYE)).fold(0.0, f64::max);
    assert!(most > 10.0, "{most}");
}

#[test]
#[cfg(feature = "checkpoint")]
fn a_checkpoint_of_another_viscosity_says_which() {
    let folder = std::env::temp_dir().join(format!("meshfree-causes-{}", std::process::id()));
    let path = folder.join("one");
    let scene = |viscosity: f64, alpha: f64, wall: f64| {
        let liquid = |viscosity: f64| {
            let mut liquid = catalogue::weakly_compressible_water::<f64>(2.0);
            liquid.dynamic_viscosity = Some(viscosity);
            liquid
        };
        let own = Body::block("water", liquid(viscosity), [0.0; 2], [0.1; 2], 0.01);
        let other = Body::block("oil", liquid(0.1), [0.2, 0.0], [0.3, 0.1], 0.01);
        let scheme = schemes::weakly_compressible()
            .with_viscosity(meshfree::term::viscosity::MonaghanGingold { alpha, beta: 0.0 });
        let plane = MirrorPlane::wall([0.0, wall], [0.0, -1.0]);
        Scene::<f64, 2>::new(scheme)
            .body(own)
            .body(other)
            .boundary(plane)
    };
    scene(1e-3, 0.02, 0.0).build().unwrap().save(&path).unwrap();
    let told = |scene: Scene<f64, 2>| match scene.resume(&path) {
        Err(error @ Error::Checkpoint { .. }) => error.to_string(),
        other => panic!("{other:?}"),
    };
    assert!(scene(1e-3, 0.02, 0.0).resume(&path).is_ok());
    let message = told(scene(2e-3, 0.02, 0.0));
    let right = "differs in bodies (body `water`.material.dynamic_viscosity is 0.001 in the file and 0.002 in the scene)";
    assert!(message.contains(right), "{message}");
    let message = told(scene(1e-3, 0.021, 0.0));
    assert!(
        message.contains("0.02") && message.contains("0.021"),
        "{message}"
    );
    let message = told(scene(1e-3, 0.02, -0.001));
    assert!(message.contains("-0.001 in the scene"), "{message}");
    let _ = std::fs::remove_dir_all(folder);
}
