//! Bad input: each kind has its own error, which says what to do, and nothing panics.

use crate::common;
use meshfree::boundary::{Boundary, Inlet, MirrorPlane, Outlet, Periodic, Translation, Wall};
use meshfree::effect::{ConsistentSmoothing, Hypoelastic, PairingControl};
use meshfree::error::{Error, Problem};
use meshfree::integrator::{Integrator, LamLeapfrog, RungeKutta4, System};
use meshfree::kernel::{CubicSpline, Kernel};
use meshfree::material::catalogue;
use meshfree::material::eos::{EosState, EquationOfState, Guards, IdealGas};
use meshfree::material::{Liquid, Material, SoundSpeed, eos::Linear};
use meshfree::observe::{FlowPlane, PressureProbe, WaveGauge};
use meshfree::particles::Fields;
use meshfree::scalar::Lane;
use meshfree::scene::{Body, Scene, Start};
use meshfree::scheme::{DensityForm, EnergyForm, SchemeBuilder};
use meshfree::schemes;
use meshfree::simulation::{Simulation, StepControl};
use meshfree::sweep::{Interaction, Transform};
use meshfree::term::viscosity::MonaghanGingold;
use meshfree::term::{ArtificialViscosity, Layout, Pair, TermDoc, Viscous};
use proptest::prelude::*;

const DX: f64 = 1e-3;

fn rod() -> Body<f64, 1> {
    Body::block("rod", catalogue::copper(), [0.0], [0.02], DX)
}

fn good() -> Scene<f64, 1> {
    Scene::new(schemes::impact()).body(rod())
}

fn other(low: f64) -> Body<f64, 1> {
    Body::block("other", catalogue::copper(), [low], [low + 0.02], DX)
}

fn refused<const D: usize>(scene: Scene<f64, D>) -> Vec<Problem> {
    match scene.build() {
        Err(Error::Build(error)) => {
            let message = Error::Build(error.clone()).to_string();
            for problem in &error.problems {
                assert!(message.contains(&problem.to_string()), "{message}");
            }
            error.problems
        }
        Ok(_) => panic!("the scene was built"),
        Err(other) => panic!("another error: {other}"),
    }
}

/// The only problem of a scene.
fn problem<const D: usize>(scene: Scene<f64, D>) -> Problem {
    let problems = refused(scene);
    assert_eq!(problems.len(), 1, "{problems:?}");
    problems[0].clone()
}

/// That the problem is a parameter called `name`, and says `advice`.
fn is_parameter(problem: &Problem, name: &str, advice: &str) {
    let Problem::Parameter { what, .. } = problem else {
        panic!("{problem:?}");
    };
    assert!(what.contains(name), "{problem}");
    assert!(problem.to_string().contains(advice), "{problem}");
}

#[test]
fn what_is_good_is_built() {
    assert!(good().build().is_ok());
    assert!(
        good()
            .body(other(0.02))
            .between("rod", "other", Interaction::Bonded)
            .build()
            .is_ok()
    );
}

#[test]
fn a_spacing_that_is_not_positive() {
    for spacing in [-1e-3, 0.0, f64::NAN, f64::INFINITY] {
        let rod = Body::block("rod", catalogue::copper(), [0.0], [0.02], spacing);
        let found = problem(Scene::<f64, 1>::new(schemes::impact()).body(rod));
        is_parameter(
            &found,
            "spacing of body `rod`",
            "finite and positive, in metres",
        );
        let points = Body::points_of("rod", catalogue::copper(), vec![[0.0], [1.0]], spacing);
        let found = problem(Scene::<f64, 1>::new(schemes::impact()).body(points));
        is_parameter(
            &found,
            "spacing of body `rod`",
            "finite and positive, in metres",
        );
    }
}

#[test]
fn a_spacing_in_the_wrong_unit() {
    let rod = Body::block("rod", catalogue::copper(), [0.0], [1.0], 1e-12);
    let found = problem(Scene::<f64, 1>::new(schemes::impact()).body(rod));
    is_parameter(
        &found,
        "number of particles",
        "check that the spacing is in metres",
    );
}

#[test]
fn numbers_that_are_not() {
    for bad in [f64::NAN, f64::INFINITY] {
        let velocity = Scene::new(schemes::impact()).body(rod().velocity([bad]));
        is_parameter(
            &problem(velocity),
            "velocity of body `rod`",
            "finite, in m/s",
        );
        let energy = Scene::new(schemes::impact()).body(rod().energy(bad));
        is_parameter(&problem(energy), "energy of body `rod`", "finite, in J/kg");
        let points = vec![[0.0], [bad], [2.0 * DX]];
        let position = Body::points_of("rod", catalogue::copper(), points, DX);
        let found = problem(Scene::<f64, 1>::new(schemes::impact()).body(position));
        is_parameter(&found, "position of body `rod`", "finite, in metres");
        let corner = Body::block("rod", catalogue::copper(), [0.0], [bad], DX);
        let found = problem(Scene::<f64, 1>::new(schemes::impact()).body(corner));
        is_parameter(&found, "size of body `rod`", "corners must be finite");
    }
}

#[test]
fn a_density_of_zero_or_less() {
    for density in [0.0, -8930.0, f64::NAN] {
        let found = problem(Scene::new(schemes::impact()).body(rod().density(density)));
        is_parameter(
            &found,
            "density of body `rod`",
            "finite and positive, in kg/m³",
        );
    }
}

#[test]
fn a_material_with_constants_that_make_no_sense() {
    let solid = Material::new("solid", Linear::new(1000.0, f64::NAN));
    let rod = Body::block("rod", solid, [0.0], [0.02], DX);
    let found = problem(Scene::<f64, 1>::new(schemes::impact()).body(rod));
    is_parameter(&found, "of material `solid`", "");
}

fn overlaps(problem: &Problem) {
    let Problem::Overlap {
        first,
        second,
        distance,
        ..
    } = problem
    else {
        panic!("{problem:?}");
    };
    assert_eq!((first.as_str(), second.as_str()), ("rod", "other"));
    assert!(*distance < DX);
    assert!(
        problem
            .to_string()
            .contains("move one of them, or cut the shape"),
        "{problem}"
    );
}

#[test]
fn bodies_that_overlap_in_any_dimension_however_their_lattices_lie() {
    for shift in [0.0, 0.1, 0.25, 0.5, 0.75] {
        overlaps(&problem(good().body(other(0.01 + shift * DX))));
        let low = 0.004 + shift * DX;
        let sheet =
            |name, low: f64| Body::block(name, catalogue::copper(), [low; 2], [low + 0.01; 2], DX);
        let scene = Scene::<f64, 2>::new(schemes::impact());
        overlaps(&problem(
            scene.body(sheet("rod", 0.0)).body(sheet("other", low)),
        ));
        let cube =
            |name, low: f64| Body::block(name, catalogue::copper(), [low; 3], [low + 0.006; 3], DX);
        let scene = Scene::<f64, 3>::new(schemes::impact());
        overlaps(&problem(
            scene.body(cube("rod", 0.0)).body(cube("other", low)),
        ));
    }
}

#[test]
fn a_jitter_that_brings_particles_too_close() {
    for share in [-0.1, 0.5, f64::NAN, f64::INFINITY] {
        let found = problem(Scene::new(schemes::impact()).body(rod().jitter(share, 1)));
        is_parameter(&found, "jitter of body `rod`", "from 0 to 0.3");
    }
    let still = rod().jitter(0.0, 1);
    assert_eq!(still.points(), rod().points());
    assert_eq!(good().body(other(0.02).jitter(0.3, 1)).problems(), []);
}

#[test]
fn a_wall_that_liquid_overlaps_is_one_where_it_starts() {
    let water = Liquid::new(1000.0, 1480.0, 1e-3).material("water", SoundSpeed::Physical);
    let pool = Body::block("pool", water, [0.0; 2], [0.01; 2], DX);
    let scene = |shift: f64| {
        let floor = Wall::around(
            "floor",
            [0.0; 2],
            [0.01; 2],
            DX,
            4,
            [[false; 2], [true, false]],
        );
        let moved = Translation::new(move |_| [0.0, shift], |_| [0.0; 2], |_| [0.0; 2]);
        let scene = Scene::<f64, 2>::new(schemes::weakly_compressible().compose());
        scene.body(pool.clone()).wall(floor.motion(moved))
    };
    assert_eq!(scene(0.0).problems(), []);
    assert_eq!(scene(-0.02).problems(), []);
    let found = problem(scene(4.3 * DX));
    assert!(
        matches!(&found, Problem::Overlap { first, second, .. } if first == "floor" && second == "pool"),
        "{found}"
    );
}

#[test]
fn bodies_that_only_touch_do_not_overlap() {
    let sheet = |name, low: [f64; 2]| {
        Body::block(name, catalogue::copper(), low, low.map(|x| x + 0.01), DX)
    };
    for shift in [0.0, 0.3, 0.5] {
        let scene = Scene::<f64, 2>::new(schemes::impact())
            .body(sheet("rod", [0.0; 2]))
            .body(sheet("other", [0.01, shift * DX]));
        assert_eq!(scene.problems(), []);
    }
    // Nor do disordered ones.
    for seed in 0..40 {
        let mut random = common::Random(seed);
        let rotation = common::rotation::<3>(&mut random);
        let mut cube = |name, corner| {
            let points = common::jittered(corner, [5; 3], 0.15, &mut random);
            let points = points
                .iter()
                .map(|x| common::turn(&rotation, x.map(|x| x * DX)));
            Body::points_of(name, catalogue::copper(), points.collect(), DX)
        };
        let scene = Scene::<f64, 3>::new(schemes::impact())
            .body(cube("rod", [0.0; 3]))
            .body(cube("other", [5.0, 0.5, 0.5]));
        assert_eq!(scene.problems(), [], "seed {seed}");
    }
}

#[test]
fn a_material_that_nobody_knows() {
    let error: Error = catalogue::by_name::<f64>("unobtainium").unwrap_err().into();
    let Error::Argument(Problem::UnknownMaterial { name, known }) = &error else {
        panic!("{error:?}");
    };
    assert_eq!(name, "unobtainium");
    assert!(
        known.contains("copper") && error.to_string().contains("the catalogue has"),
        "{error}"
    );
}

#[test]
fn a_smoothing_length_at_which_particles_pair() {
    let sheet = || Body::block("sheet", catalogue::copper(), [0.0; 2], [0.01; 2], DX);
    for ratio in [1.5, 0.3, -1.2, f64::NAN] {
        let scene = Scene::<f64, 2>::new(schemes::impact().h_over_dx(ratio)).body(sheet());
        let found = problem(scene);
        let Problem::SmoothingRatio {
            recommended,
            highest,
            ..
        } = found
        else {
            panic!("{found:?}");
        };
        assert_eq!((recommended, highest), (1.2, 1.25));
        assert!(
            found.to_string().contains("particles pair; take 1.2"),
            "{found}"
        );
    }
    // A row does not pair at the same ratio.
    assert!(
        Scene::<f64, 1>::new(schemes::impact().h_over_dx(1.5))
            .body(rod())
            .build()
            .is_ok()
    );
}

#[test]
fn a_fixed_step_above_the_limit() {
    let fixed = |step| {
        good().steps(|control| StepControl {
            fixed: Some(step),
            ..control
        })
    };
    let found = problem(fixed(1e-6));
    let Problem::StepAboveLimit { step, limit, .. } = found else {
        panic!("{found:?}");
    };
    assert_eq!(step, 1e-6);
    assert!(
        found
            .to_string()
            .contains("take a smaller one, or leave the choice"),
        "{found}"
    );
    assert!(fixed(0.999 * limit).build().is_ok());
    for step in [0.0, -1e-9, f64::NAN] {
        is_parameter(
            &problem(fixed(step)),
            "fixed time step",
            "finite and positive",
        );
    }
}

#[test]
fn a_fixed_step_that_a_faster_impact_outgrows_stops_the_run() {
    let limit = good().build().unwrap().vote().unwrap().step;
    let mut simulation = Scene::new(schemes::impact())
        .body(rod().velocity([1000.0]))
        .body(other(0.021))
        .steps(|control| StepControl {
            fixed: Some(0.99 * limit),
            ..control
        })
        .build()
        .unwrap();
    let error = simulation.run_until(1e-5).unwrap_err();
    assert!(
        matches!(error, Error::Argument(Problem::StepAboveLimit { .. })),
        "{error}"
    );
}

#[test]
fn bodies_without_particles_and_scenes_without_bodies() {
    let empty = Body::block("nothing", catalogue::copper(), [0.0], [0.1 * DX], DX);
    let found = problem(Scene::<f64, 1>::new(schemes::impact()).body(empty));
    assert_eq!(
        found,
        Problem::EmptyBody {
            body: "nothing".into()
        }
    );
    assert!(
        found
            .to_string()
            .contains("give it a shape at least one spacing large"),
        "{found}"
    );
    let found = problem(Scene::<f64, 1>::new(schemes::impact()));
    assert_eq!(found, Problem::EmptyScene);
    assert!(
        found
            .to_string()
            .contains("add at least one with `Scene::body`"),
        "{found}"
    );
}

fn incompatible(problem: &Problem, reason: &str, advice: &str) {
    let Problem::Incompatible { what, remedy } = problem else {
        panic!("{problem:?}");
    };
    assert!(
        what.contains(reason) && remedy.contains(advice),
        "{problem}"
    );
}

#[test]
fn parts_that_do_not_fit() {
    let twins = Scene::<f64, 1>::new(schemes::impact())
        .body(rod())
        .body(Body::block("rod", catalogue::copper(), [0.02], [0.04], DX));
    incompatible(
        &problem(twins),
        "two bodies are called `rod`",
        "a name of its own",
    );
    let mixed = good().body(Body::block(
        "fine",
        catalogue::copper(),
        [0.02],
        [0.03],
        0.5 * DX,
    ));
    incompatible(&problem(mixed), "different spacings", "MixedSpacing");
    incompatible(
        &problem(good().integrator(RungeKutta4)),
        "compatible energy form cannot follow the integrator rk4",
        "EnergyForm::Symmetric",
    );
    let lam = Scene::<f64, 1>::new(schemes::impact_by_continuity())
        .body(rod())
        .integrator(LamLeapfrog::default());
    incompatible(
        &problem(lam),
        "does not integrate density",
        "follows from positions",
    );
    let by_continuity = || schemes::impact_by_continuity().energy(EnergyForm::Symmetric);
    let nudged = Scene::<f64, 1>::new(by_continuity().with(PairingControl::default()));
    incompatible(
        &problem(nudged.body(rod()).integrator(RungeKutta4)),
        "the law `pairing control` acts in drifts, which the integrator rk4 does not take",
        "kick-drift-kick",
    );
    let elastic = catalogue::copper().with_shear_modulus(46e9);
    let elastic = Body::block("rod", elastic, [0.0], [0.02], DX);
    let elastic = Scene::<f64, 1>::new(by_continuity().with(Hypoelastic)).body(elastic);
    let found = refused(elastic.integrator(RungeKutta4));
    let told = |what: &str| found.iter().any(|own| own.to_string().contains(what));
    assert!(
        told("sums the rate of deviatoric_stress in drifts"),
        "{found:?}"
    );
    let hot =
        Scene::<f64, 1>::new(schemes::impact().energy(EnergyForm::None)).body(rod().energy(1.0));
    incompatible(&problem(hot), "starts with internal energy", "energy form");
}

#[test]
fn names_that_the_scene_does_not_have() {
    let found = problem(good().between("rod", "Rod", Interaction::Bonded));
    let Problem::UnknownName { kind, name, known } = &found else {
        panic!("{found:?}");
    };
    assert_eq!(
        (*kind, name.as_str(), known.as_str()),
        ("body", "Rod", "`rod`")
    );
}

#[test]
fn boundaries_that_make_no_sense() {
    for (low, high) in [(0.0, 1e-3), (0.0, f64::NAN), (f64::NEG_INFINITY, 0.0)] {
        let found = problem(good().boundary(Periodic::along(0, low, high)));
        is_parameter(&found, "period", "at least twice the kernel's reach");
    }
    is_parameter(
        &problem(good().boundary(Periodic::along(1, 0.0, 1.0))),
        "axis",
        "below the dimension",
    );
    let flat = MirrorPlane::wall([0.02], [0.0]);
    is_parameter(&problem(good().boundary(flat)), "normal", "normal not zero");
}

/// A scene of liquid in a square, which a wall or an inlet is added to.
fn pool() -> Scene<f64, 2> {
    let water = catalogue::weakly_compressible_water(1.0);
    Scene::new(schemes::weakly_compressible()).body(Body::block(
        "water",
        water,
        [0.0; 2],
        [0.1, 0.1],
        0.01,
    ))
}

#[test]
fn walls_around_what_is_no_box() {
    let tank = |low: [f64; 2], high: [f64; 2], spacing: f64, layers: usize| {
        let tank = Wall::around("tank", low, high, spacing, layers, [[true; 2]; 2]);
        problem(pool().wall(tank))
    };
    assert!(
        pool()
            .wall(Wall::around(
                "tank",
                [0.0; 2],
                [0.1; 2],
                0.01,
                3,
                [[true; 2]; 2]
            ))
            .build()
            .is_ok()
    );
    for spacing in [0.0, -0.01, f64::NAN, f64::INFINITY] {
        let found = tank([0.0; 2], [0.1; 2], spacing, 3);
        is_parameter(
            &found,
            "spacing of wall `tank`",
            "finite and positive, in metres",
        );
    }
    let found = tank([0.0; 2], [0.1, -0.1], 0.01, 3);
    is_parameter(&found, "size of wall `tank`", "low and high are swapped");
    for corner in [0.0, f64::NAN, f64::INFINITY] {
        let found = tank([0.0; 2], [0.1, corner], 0.01, 3);
        is_parameter(
            &found,
            "size of wall `tank`",
            "corners must be finite and in order",
        );
    }
    for (spacing, layers) in [(1e-12, 3), (1e-300, 3), (0.01, usize::MAX)] {
        let found = tank([0.0; 2], [0.1; 2], spacing, layers);
        is_parameter(
            &found,
            "number of particles of wall `tank`",
            "check that the spacing is in metres",
        );
    }
    let found = tank([0.0; 2], [0.1; 2], 0.01, 0);
    is_parameter(
        &found,
        "number of layers of wall `tank`",
        "a number of layers, not a length",
    );
}

#[test]
fn inlets_that_make_no_sense() {
    let opening = |low: f64| {
        (0..10)
            .map(|k| [low, 0.01 * (f64::from(k) + 0.5)])
            .collect()
    };
    let inlet = |velocity: f64, spacing: f64, reserve: usize| {
        Inlet::new("water", opening(0.0), [velocity, 0.0], spacing, reserve)
    };
    let with = |inlet: Inlet<2>| problem(pool().inlet(inlet));
    assert!(pool().inlet(inlet(1.0, 0.01, 100)).build().is_ok());
    for spacing in [0.0, -0.01, f64::NAN, f64::INFINITY] {
        let found = with(inlet(1.0, spacing, 100));
        is_parameter(
            &found,
            "spacing of the inlet of body `water`",
            "finite and positive, in metres",
        );
    }
    incompatible(
        &with(inlet(1.0, 0.011, 100)),
        "the inlet of body `water` has a spacing of 0.011 m",
        "the spacing of the body",
    );
    for velocity in [0.0, f64::NAN, f64::INFINITY] {
        is_parameter(&with(inlet(velocity, 0.01, 100)), "velocity", "in m/s");
    }
    is_parameter(
        &with(inlet(1.0, 0.01, usize::MAX)),
        "reserve",
        "must be below 4e9",
    );
    for bad in [f64::NAN, f64::INFINITY] {
        let inlet = Inlet::new("water", opening(bad), [1.0, 0.0], 0.01, 100);
        is_parameter(&with(inlet), "opening", "points must be finite");
    }
    let closed = Inlet::new("water", Vec::new(), [1.0, 0.0], 0.01, 100);
    is_parameter(&with(closed), "opening", "at least one point");
    let solid = Inlet::new("rod", vec![[0.0]], [1.0], DX, 10);
    incompatible(&problem(good().inlet(solid)), "impact", "scheme of liquids");
    let unknown = Inlet::new("wine", opening(0.0), [1.0, 0.0], 0.01, 100);
    assert!(matches!(
        with(unknown),
        Problem::UnknownName { kind: "body", .. }
    ));
}

#[test]
fn bodies_and_walls_that_are_not_there() {
    let tank = Wall::around("tank", [0.0; 2], [0.2, 0.1], 0.01, 3, [[true; 2]; 2]);
    let tank = pool().wall(tank).build().unwrap();
    let open = pool().build().unwrap();
    let of = |error: Option<Error>| error.map(|error| error.to_string()).unwrap_or_default();
    let body = "there is no body called `ice`: the scene has water";
    assert_eq!(of(tank.body("ice").err()), body);
    // A wall is no body, whatever asks for one.
    let (name, wall) = (
        String::from("tank"),
        "there is no body called `tank`: the scene has water",
    );
    assert_eq!(of(tank.body(&name).err()), wall);
    let index = "there is no wall with the index 1: the scene has tank, counted from 0";
    assert_eq!(of(tank.wall(1).err()), index);
    assert_eq!(of(tank.wall_force(1).err()), index);
    assert_eq!(of(tank.wall_impulse(1).err()), index);
    assert_eq!(of(tank.wall_pose(1).err()), index);
    let none = "there is no wall called `tank`: the scene has none";
    assert_eq!(of(open.wall("tank").err()), none);
    let block = "there is no body, wall or boundary with the index 2: the scene has water, tank, counted from 0";
    assert_eq!(of(tank.force_between(0, 2).err()), block);
    let [by_name, by_index] = [
        tank.force_between("water", "tank"),
        tank.force_between(0, 1),
    ];
    assert_eq!(by_name.unwrap(), by_index.unwrap());
    assert_eq!(
        tank.wall("tank").unwrap().count(),
        tank.wall(0).unwrap().count()
    );
}

#[test]
fn observers_that_would_read_nothing() {
    let closed = [[true; 2]; 2];
    let tank = Wall::around("tank", [0.0; 2], [0.2, 0.1], 0.01, 3, closed);
    let tank = pool().wall(tank).build().unwrap();
    let open = pool().build().unwrap();
    let refused = |error: Error, name: &str, advice: &str| {
        let Error::Argument(problem) = &error else {
            panic!("{error:?}");
        };
        is_parameter(problem, name, advice);
    };

    let probe = |x: [f64; 2], normal: [f64; 2], diameter: f64| {
        PressureProbe::disc(&tank, "p", x, normal, diameter)
    };
    let (place, normal) = ([0.2, 0.05], [-1.0, 0.0]);
    assert!(probe(place, normal, 0.01).unwrap().on_wall(0).is_ok());
    for normal in [[0.0, 0.0], [f64::NAN, 1.0], [f64::INFINITY, 0.0]] {
        let error = probe(place, normal, 0.01).unwrap_err();
        refused(error, "normal of observer `p`", "finite and not zero");
    }
    for diameter in [0.0, -0.01, f64::NAN, f64::INFINITY] {
        let error = probe(place, normal, diameter).unwrap_err();
        refused(error, "diameter of observer `p`", "finite and positive");
    }
    for bad in [f64::NAN, f64::NEG_INFINITY] {
        let error = probe([0.2, bad], normal, 0.01).unwrap_err();
        refused(error, "position of observer `p`", "finite, in metres");
    }
    // The walls end at 0.23 m, and the kernel reaches 0.03 m beyond their last particles.
    assert!(probe([0.25, 0.05], normal, 0.01).is_ok());
    for far in [[0.26, 0.05], [-0.06, 0.05], [0.1, 0.16], [200.0, 50.0]] {
        let error = probe(far, normal, 0.01).unwrap_err();
        let advice = "near the bodies and walls of the scene as built";
        refused(error, "of observer `p`", advice);
    }
    assert!(probe(place, normal, 0.01).unwrap().on_wall("tank").is_ok());
    let error = probe(place, normal, 0.01).unwrap().on_wall(1).unwrap_err();
    let missing = "there is no wall with the index 1: the scene has tank, counted from 0";
    assert_eq!(error.to_string(), missing);

    let gauge = |foot: [f64; 2], axis: usize| WaveGauge::upwards(&tank, "h", foot, axis);
    // Heights may count from anywhere below.
    assert!(gauge([0.1, -7.0], 1).unwrap().on_wall(0).is_ok());
    let error = gauge([0.1, 0.0], 2).unwrap_err();
    refused(error, "axis of observer `h`", "below the dimension");
    let error = gauge([0.1, f64::NAN], 1).unwrap_err();
    refused(error, "position of observer `h`", "finite");
    let error = gauge([0.3, 0.0], 1).unwrap_err();
    refused(error, "coordinate 0 of observer `h`", "near the bodies");
    let error = gauge([0.1, 0.0], 1).unwrap().on_wall("lid").unwrap_err();
    let missing = "there is no wall called `lid`: the scene has tank";
    assert_eq!(error.to_string(), missing);

    // Without walls liquid can come anywhere.
    assert!(WaveGauge::upwards(&open, "far", [9.0, 0.0], 1).is_ok());
    assert!(PressureProbe::disc(&open, "far", [9.0, 0.0], normal, 0.01).is_ok());

    assert!(FlowPlane::new([9.0, 0.0], [1.0, 0.0]).is_ok());
    let error = FlowPlane::new([0.0; 2], [0.0; 2]).unwrap_err();
    refused(error, "normal of observer `flow plane`", "not zero");
    let error = FlowPlane::new([f64::NAN, 0.0], [1.0, 0.0]).unwrap_err();
    refused(error, "position of observer `flow plane`", "finite");
}

#[test]
fn every_problem_is_reported_and_not_only_the_first() {
    let scene = Scene::<f64, 1>::new(schemes::impact().h_over_dx(9.0))
        .body(rod().velocity([f64::NAN]).density(-1.0))
        .between("nobody", "rod", Interaction::None)
        .skin(-1.0);
    let problems = refused(scene);
    assert_eq!(problems.len(), 5, "{problems:?}");
}

#[test]
fn a_run_that_breaks_says_where_and_when() {
    let gas = Material::new("gas", IdealGas::new(1.4, 1.0));
    let row = Body::block("row", gas, [0.0], [1.0], 0.02).energy(2.5);
    let mut simulation = Scene::<f64, 1>::new(schemes::impact())
        .body(row)
        .acceleration(|t| [if t > 1e-3 { f64::NAN } else { 0.0 }])
        .build()
        .unwrap();
    let error = simulation.run_until(1.0).unwrap_err();
    let Error::Function { what, time, .. } = &error else {
        panic!("{error:?}");
    };
    assert!(
        *time > 0.0 && what.contains("Scene::acceleration"),
        "{error}"
    );
    for end in [f64::NAN, f64::INFINITY] {
        let error = good().build().unwrap().run_until(end).unwrap_err();
        assert!(
            matches!(error, Error::Argument(Problem::Parameter { .. })),
            "{error}"
        );
    }
}

/// A row of gas under a load that is no number from `start` \[s\] on.
fn breaking(start: f64) -> Simulation<f64, 1> {
    let gas = Material::new("gas", IdealGas::new(1.4, 1.0));
    let row = Body::block("row", gas, [0.0], [1.0], 0.02).energy(2.5);
    Scene::<f64, 1>::new(schemes::impact())
        .body(row)
        .acceleration(move |t| [if t >= start { f64::NAN } else { 0.0 }])
        .build()
        .unwrap()
}

#[test]
fn the_state_after_the_last_step_is_looked_at() {
    let end = 1e-4;
    let mut simulation = breaking(end);
    let error = simulation.step_at_most(end).unwrap_err();
    assert!(
        matches!(&error, Error::Function { time, .. } if *time == end),
        "{error:?}"
    );
}

#[test]
fn what_has_failed_takes_no_further_step() {
    let mut simulation = breaking(1e-3);
    let first = simulation.run_until(1.0).unwrap_err().to_string();
    let (time, steps) = (simulation.time(), simulation.steps());
    let again = [
        simulation.run_until(1.0).unwrap_err(),
        simulation.run_until(0.5 * time).unwrap_err(),
        simulation.step().unwrap_err(),
        simulation.evaluate().unwrap_err(),
    ];
    for error in again {
        let Error::Failed { cause } = &error else {
            panic!("{error:?}");
        };
        assert_eq!(*cause, first);
        assert!(
            error.to_string().contains("takes no further step"),
            "{error}"
        );
    }
    assert_eq!((simulation.time(), simulation.steps()), (time, steps));
}

#[test]
fn a_limit_of_the_step_that_is_no_time() {
    let mut simulation = good().build().unwrap();
    for limit in [0.0, -1.0, f64::NAN, f64::NEG_INFINITY] {
        let Error::Argument(problem) = simulation.step_at_most(limit).unwrap_err() else {
            panic!("another error");
        };
        is_parameter(&problem, "limit of the step", "positive, in seconds");
    }
    assert_eq!(simulation.time(), 0.0);
    assert!(simulation.step_at_most(f64::INFINITY).is_ok());
}

#[test]
fn numbers_that_are_finite_and_still_no_start() {
    let with = |body: Body<f64, 1>| problem(Scene::new(schemes::impact()).body(body));
    for (velocity, energy) in [(1e300, 0.0), (-3e8, 0.0), (0.0, 1e300), (0.0, -1e12)] {
        let found = with(rod().velocity([velocity]).energy(energy));
        let (name, advice) = if velocity == 0.0 {
            ("energy of body `rod`", "c²")
        } else {
            ("velocity of body `rod`", "below that of light")
        };
        let advice = if energy > 0.0 {
            "speed of light"
        } else {
            advice
        };
        is_parameter(&found, name, advice);
    }
    for factor in [1e-3, 0.1, 10.0, 1000.0] {
        let found = with(rod().density(8930.0 * factor));
        is_parameter(&found, "density of body `rod`", "four times");
    }
    // A gas has whatever density it starts with, and no energy below none.
    let gas = || {
        let gas = Material::new("gas", IdealGas::new(1.4, 1.0));
        Body::block("gas", gas, [0.0], [1.0], 0.02).energy(2.5)
    };
    assert_eq!(
        Scene::new(schemes::impact())
            .body(gas().density(1e-3))
            .problems(),
        []
    );
    is_parameter(
        &with(gas().energy(-1.0)),
        "energy of body `gas`",
        "not negative",
    );
    let far = Body::points_of("rod", catalogue::copper(), vec![[1e300], [2e300]], 1e-3);
    is_parameter(&with(far), "position of body `rod`", "spacings of zero");
    let huge = Body::block("rod", catalogue::copper(), [0.0], [1e300], 1e299);
    is_parameter(&with(huge), "position of body `rod`", "in metres");
    let tiny = Body::block("rod", catalogue::copper(), [0.0], [1e-199], 1e-200);
    is_parameter(&with(tiny), "spacing of body `rod`", "in metres");
    for bad in [f64::NAN, f64::INFINITY] {
        is_parameter(
            &with(rod().hydrostatic([bad], [0.02])),
            "hydrostatic start of body `rod`",
            "finite",
        );
        is_parameter(
            &with(rod().hydrostatic([9.81], [bad])),
            "hydrostatic start of body `rod`",
            "finite",
        );
    }
}

#[test]
fn gas_of_negative_energy_is_counted() {
    let steps = |energy: f64| {
        let gas = Material::new("gas", IdealGas::new(1.4, 1.0));
        let row = Body::block("gas", gas, [0.0], [1.0], 0.02).energy(energy);
        let mut simulation = Scene::<f64, 1>::new(schemes::impact())
            .body(row)
            .build()
            .unwrap();
        for _ in 0..3 {
            simulation.step_at_most(1e-3).unwrap();
        }
        simulation.limited("negative internal energy")
    };
    // Just below none, which the sound speed of the law at rest still allows.
    assert_eq!((steps(1.0), steps(-5e-13)), (0, 3 * 50));
}

/// Dust: no pressure, and no sound.
#[derive(Clone, Debug)]
struct Dust;

impl EquationOfState for Dust {
    fn name(&self) -> &'static str {
        "dust"
    }
    fn reference_density(&self) -> f64 {
        1000.0
    }
    fn uses_energy(&self) -> bool {
        false
    }
    fn state<L: Lane>(&self, _density: L, _energy: L) -> EosState<L> {
        EosState {
            pressure: L::zero(),
            sound_speed: L::zero(),
            guards: Guards::none(),
        }
    }
}

#[test]
fn a_law_without_sound() {
    let dust = Body::block("dust", Material::new("dust", Dust), [0.0], [0.02], DX);
    let found = problem(Scene::<f64, 1>::new(schemes::impact()).body(dust));
    is_parameter(&found, "sound speed of body `dust`", "law of the material");
}

#[test]
fn particles_without_neighbours() {
    let isolated = |points: Vec<[f64; 1]>, at: usize| {
        let body = Body::points_of("rod", catalogue::copper(), points, DX);
        let scene = Scene::<f64, 1>::new(schemes::impact()).body(body);
        assert_eq!(scene.problems(), []);
        let found = problem(scene);
        let Problem::Isolated { body, particle, .. } = &found else {
            panic!("{found:?}");
        };
        assert_eq!((body.as_str(), *particle), ("rod", at));
        assert!(
            found
                .to_string()
                .contains("check that the spacing is that of the points"),
            "{found}"
        );
    };
    isolated(vec![[0.0]], 0);
    // A fragment, and points that are farther apart than the spacing says.
    isolated(vec![[0.0], [DX], [2.0 * DX], [9.0 * DX]], 3);
    isolated(vec![[0.0], [5.0 * DX], [10.0 * DX]], 0);
}

#[test]
fn names_that_are_empty_and_bodies_against_themselves() {
    let nameless = Body::block(" ", catalogue::copper(), [0.03], [0.04], DX);
    incompatible(
        &problem(good().body(nameless)),
        "a body has an empty name",
        "give it one",
    );
    let wall = Wall::around("", [0.0; 2], [0.1; 2], 0.01, 3, [[true; 2]; 2]);
    incompatible(
        &problem(pool().wall(wall)),
        "a wall has an empty name",
        "give it one",
    );
    incompatible(
        &problem(good().between("rod", "rod", Interaction::None)),
        "body `rod` with itself",
        "name two bodies",
    );
}

#[test]
fn a_smoothing_length_that_sees_one_side_of_a_contact() {
    let scheme = || {
        SchemeBuilder::new(CubicSpline, MonaghanGingold::default())
            .density(DensityForm::Summation)
            .with(ConsistentSmoothing {
                smallest: 0.5,
                largest: 2.0,
            })
    };
    let two = || Scene::<f64, 1>::new(scheme()).body(rod()).body(other(0.02));
    incompatible(&problem(two()), "sees one side of it", "bond them");
    incompatible(
        &problem(two().between("rod", "other", Interaction::Unilateral)),
        "in a contact that opens",
        "fixed smoothing length",
    );
    for said in [Interaction::Bonded, Interaction::None] {
        assert_eq!(two().between("rod", "other", said).problems(), []);
    }
    // Bonded, density is the same at the joint as elsewhere, and so it is if the scheme says so.
    let bonded = scheme().between_bodies(Interaction::Bonded);
    let bonded = Scene::<f64, 1>::new(bonded)
        .body(rod())
        .body(other(0.02))
        .boundary(MirrorPlane::symmetry([0.0], [-1.0]))
        .boundary(MirrorPlane::symmetry([0.04], [1.0]));
    let bonded = bonded.build().unwrap();
    let at = |k: usize| bonded.body(0).unwrap().nth(k).unwrap().density();
    assert!((at(19) / at(10) - 1.0).abs() < 1e-9);
}

#[test]
fn periods_that_do_not_hold_the_body() {
    let period = |high: f64| Periodic::along(0, 0.0, high);
    assert_eq!(good().boundary(period(0.02)).problems(), []);
    incompatible(
        &problem(good().boundary(period(0.01))),
        "would overlap itself",
        "as long as the body",
    );
    incompatible(
        &problem(good().boundary(period(0.02)).boundary(period(0.03))),
        "given twice",
        "one period for each direction",
    );
    // Points that fill a period to its ends, as those of a relaxed glass, overlap where one is at the image of another.
    let gas = || Material::new("gas", meshfree::material::eos::IdealGas::new(1.4, 1.0));
    let points = |last: f64| {
        let points = (0..20).map(|k| [f64::from(k) * 0.05]).chain([[last]]);
        let body = Body::points_of("points", gas(), points.collect(), 0.05).energy(1.0);
        Scene::<f64, 1>::new(schemes::gas())
            .body(body)
            .boundary(Periodic::along(0, 0.0, 1.0))
    };
    assert_eq!(points(0.98).problems(), []);
    for last in [0.99, 1.0, 1.01, 1.02] {
        incompatible(
            &problem(points(last)),
            "would overlap itself",
            "as long as the body",
        );
    }
}

/// As many images as it is told to make.
#[derive(Clone, Debug)]
struct Kaleidoscope(usize);

impl Boundary<1> for Kaleidoscope {
    fn name(&self) -> String {
        "kaleidoscope".into()
    }
    fn images(&self) -> usize {
        self.0
    }
    fn transform(&self, image: usize, _time: f64) -> Transform<f64, 1> {
        let mut by = Transform::identity();
        by.shift[0] = 1.0 + image as f64;
        by
    }
    fn reaches(&self, _image: usize, _x: &[f64; 1], _reach: f64, _time: f64) -> bool {
        true
    }
}

#[test]
fn a_boundary_of_a_million_images() {
    assert_eq!(good().boundary(Kaleidoscope(2)).problems(), []);
    let found = problem(good().boundary(Kaleidoscope(1_000_000)));
    is_parameter(&found, "number of images of the kaleidoscope", "at most 64");
}

#[test]
fn factors_of_the_step_that_nothing_bears() {
    let steps = |change: fn(StepControl) -> StepControl| good().steps(change);
    for scene in [
        steps(|control| StepControl {
            courant: 1.0,
            ..control
        }),
        steps(|control| StepControl {
            courant: 50.0,
            ..control
        }),
    ] {
        incompatible(
            &problem(scene),
            "the step factor (courant)",
            "0.55 of the schemes",
        );
    }
    for (scene, name) in [
        (
            steps(|control| StepControl {
                force: 1.0,
                ..control
            }),
            "force factor",
        ),
        (
            steps(|control| StepControl {
                force: f64::NAN,
                ..control
            }),
            "force factor",
        ),
        (
            steps(|control| StepControl {
                viscous: 0.5,
                ..control
            }),
            "viscous factor",
        ),
        (
            steps(|control| StepControl {
                viscous: 0.0,
                ..control
            }),
            "viscous factor",
        ),
        (
            steps(|control| StepControl {
                approach: 1.0,
                ..control
            }),
            "approach factor",
        ),
        (
            steps(|control| StepControl {
                approach: -0.1,
                ..control
            }),
            "approach factor",
        ),
    ] {
        is_parameter(&problem(scene), name, "positive and below");
    }
    for smallest in [f64::NAN, -1e-9, f64::INFINITY] {
        let scene = good().steps(|control| StepControl {
            smallest: Some(smallest),
            ..control
        });
        is_parameter(&problem(scene), "smallest time step", "not negative");
    }
    // No factor makes a fixed step longer than what the scheme bears, or shorter.
    let fixed = |courant: f64, step: f64| {
        good()
            .steps(|control| StepControl {
                courant,
                fixed: Some(step),
                ..control
            })
            .build()
    };
    let limit = good().build().unwrap().vote().unwrap().step;
    assert!(fixed(0.01, 0.999 * limit).is_ok());
    assert!(fixed(0.99, 1.9 * limit).is_err());
}

#[test]
fn outlets_that_take_all() {
    let away = Outlet::plane([-1.0, 0.0], [1.0, 0.0]);
    incompatible(
        &problem(pool().outlet(away)),
        "the outlets take every particle of body `water`",
        "points to where particles leave",
    );
    // What leaves later leaves nothing behind, and no error.
    let mut simulation = pool()
        .outlet(Outlet::plane([0.0, -0.2], [0.0, -1.0]))
        .acceleration(|_| [0.0, -9.81])
        .build()
        .unwrap();
    simulation.run_until(0.5).unwrap();
    assert_eq!(
        (simulation.particles(), simulation.removed().particles),
        (0, 100)
    );
}

#[test]
fn probes_out_of_all_proportion() {
    let open = pool().build().unwrap();
    for far in [[1e9, 0.0], [0.0, -1e9]] {
        let error = PressureProbe::disc(&open, "far", far, [1.0, 0.0], 0.01).unwrap_err();
        assert!(
            error.to_string().contains("a thousand times the size"),
            "{error}"
        );
    }
}

#[test]
fn lattices_that_no_kernel_has() {
    for ratio in [1e5, -1.0, 1e39, f64::INFINITY, f64::NAN, 0.0] {
        let water = catalogue::weakly_compressible_water(1.0);
        let body = Body::block("water", water, [0.0; 2], [0.1; 2], 0.01);
        let scheme = schemes::weakly_compressible().h_over_dx(ratio);
        let found = problem(Scene::<f64, 2>::new(scheme).body(body));
        assert!(matches!(found, Problem::SmoothingRatio { .. }), "{found}");
    }
}

/// The quadratic kernel with numbers of one's choice.
#[derive(Clone, Copy, Debug)]
struct Odd {
    support: f64,
    normalisation: f64,
    stable_step: f64,
    slope: f64,
}

const EVEN: Odd = Odd {
    support: 2.0,
    normalisation: 0.375,
    stable_step: 1.0,
    slope: 1.0,
};

impl Kernel<1> for Odd {
    fn name(&self) -> &'static str {
        "odd"
    }
    fn support(&self) -> f64 {
        self.support
    }
    fn normalisation(&self) -> f64 {
        self.normalisation
    }
    fn h_over_dx(&self) -> f64 {
        1.2
    }
    fn h_over_dx_range(&self) -> (f64, f64) {
        (1.0, 2.0)
    }
    fn stable_step(&self) -> f64 {
        self.stable_step
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        if self.slope > 2.0 {
            return vec![("own number", self.slope, "it must be at most 2")];
        }
        Vec::new()
    }
    fn shape<L: Lane>(&self, q: L) -> L {
        // ∫ (1 − q²/4) over −2..2 is 8/3.
        (q * q).mul_add(L::of(-0.25), L::one()).positive_part()
    }
    fn slope_over_q<L: Lane>(&self, q: L) -> L {
        let inside = q.lt(L::of(2.0));
        L::select(inside, L::of(-0.5 * self.slope), L::zero())
    }
}

#[test]
fn kernels_that_are_none() {
    let with = |kernel: Odd| {
        let scheme = SchemeBuilder::new(kernel, MonaghanGingold::default());
        Scene::<f64, 1>::new(scheme.density(DensityForm::NumberDensity)).body(rod())
    };
    assert_eq!(with(EVEN).problems(), []);
    for (kernel, name) in [
        (
            Odd {
                support: 1e9,
                ..EVEN
            },
            "support of the odd kernel",
        ),
        (
            Odd {
                support: f64::NAN,
                ..EVEN
            },
            "support of the odd kernel",
        ),
        (
            Odd {
                support: 1.5,
                ..EVEN
            },
            "shape beyond the support of the odd kernel",
        ),
        (
            Odd {
                normalisation: 0.0,
                ..EVEN
            },
            "normalisation of the odd kernel",
        ),
        (
            Odd {
                normalisation: f64::NAN,
                ..EVEN
            },
            "normalisation of the odd kernel",
        ),
        (
            Odd {
                stable_step: 0.0,
                ..EVEN
            },
            "stable step of the odd kernel",
        ),
        (
            Odd { slope: 0.5, ..EVEN },
            "first moment of the slope of the odd kernel",
        ),
        (Odd { slope: 3.0, ..EVEN }, "own number of the odd kernel"),
    ] {
        let found = refused(with(kernel));
        is_parameter(&found[0], name, "it must be");
    }
    // Half of a normalisation is half of both integrals.
    let found = refused(with(Odd {
        normalisation: 0.18,
        ..EVEN
    }));
    is_parameter(
        &found[0],
        "integral of the odd kernel",
        "one within a hundredth",
    );
}

/// A viscosity with a signal of one's choice.
#[derive(Clone, Debug)]
struct Loud(f64);

impl ArtificialViscosity<1> for Loud {
    const READS: Fields = Fields::NONE;
    fn pair<L: Lane, P: Layout>(&self, _pair: &Pair<'_, L, 1, P>) -> Viscous<L> {
        Viscous {
            pi: L::zero(),
            signal: L::of(self.0),
        }
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "loud".into(),
            equation: "Π = 0",
            source: "of this test",
        }
    }
}

#[test]
fn a_viscosity_of_infinite_signal() {
    let with = |signal: f64| {
        let scheme = SchemeBuilder::new(CubicSpline, Loud(signal));
        Scene::<f64, 1>::new(scheme.density(DensityForm::NumberDensity))
            .body(rod())
            .build()
    };
    assert!(with(1.0).is_ok());
    let error = with(f64::INFINITY).map(|_| ()).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("signal of the artificial viscosity of particle"),
        "{error}"
    );
    assert!(
        error.to_string().contains("wrong from the start"),
        "{error}"
    );
    // Nor does a step that time does not feel run for ever.
    let error = with(1e300).unwrap().run_until(1e-6).unwrap_err();
    assert!(matches!(error, Error::StepCollapsed { .. }), "{error}");
}

/// An integrator that says of itself what is wrong with it.
#[derive(Clone, Debug)]
struct Unfit {
    order: f64,
    stability: f64,
    slots: usize,
}

impl Integrator for Unfit {
    fn name(&self) -> String {
        "unfit".into()
    }
    fn step(&self, system: &mut dyn System, dt: f64) -> Result<(), Error> {
        system.evaluate(0.0)?;
        system.kick(dt);
        system.drift(dt, 0.0)
    }
    fn stability(&self) -> f64 {
        self.stability
    }
    fn slots(&self) -> usize {
        self.slots
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        if self.order < 1.0 {
            return vec![("order", self.order, "it must be at least 1")];
        }
        Vec::new()
    }
}

#[test]
fn integrators_that_are_none() {
    let with = |order: f64, stability: f64, slots: usize| {
        good().integrator(Unfit {
            order,
            stability,
            slots,
        })
    };
    assert_eq!(with(1.0, 1.0, 0).problems(), []);
    is_parameter(
        &problem(with(0.5, 1.0, 0)),
        "order of the integrator unfit",
        "at least 1",
    );
    for stability in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let found = problem(with(1.0, stability, 0));
        is_parameter(
            &found,
            "stability of the integrator unfit",
            "finite and positive",
        );
    }
    let found = problem(with(1.0, 1.0, usize::MAX));
    is_parameter(&found, "kept states of the integrator unfit", "at most 64");
}

#[test]
fn more_particles_than_memory_holds() {
    let scene = || {
        let cube = Body::block("cube", catalogue::copper(), [0.0; 3], [0.02; 3], DX);
        Scene::<f64, 3>::new(schemes::impact()).body(cube)
    };
    let found = problem(scene().memory_limit(1_000_000));
    let Problem::Memory {
        particles,
        each,
        needed,
        available,
    } = found
    else {
        panic!("{found:?}");
    };
    assert_eq!((particles, available), (8000, 1_000_000));
    assert!(needed >= (each * particles) as u64, "{needed}");
    assert!(found.to_string().contains("Scene::memory_limit"), "{found}");
    // What is predicted is what is taken, or somewhat more.
    let mut simulation = scene().memory_limit(needed).build().unwrap();
    simulation.step().unwrap();
    let taken = simulation.bytes() as u64;
    println!("{needed} bytes predicted, {taken} taken");
    assert!(taken < needed && needed < 3 * taken, "{needed} {taken}");
    let water = pool().build().unwrap().bytes() as u64;
    let found = problem(pool().memory_limit(1));
    let Problem::Memory { needed, .. } = found else {
        panic!("{found:?}");
    };
    println!("{needed} bytes predicted, {water} taken");
    assert!(water < needed && needed < 4 * water, "{needed} {water}");
}

/// Numbers that a slip of the pen or a broken file can give.
fn garbage() -> impl Strategy<Value = f64> {
    prop_oneof![
        30 => -2.0..2.0_f64,
        1 => Just(0.0),
        1 => Just(f64::NAN),
        1 => Just(f64::INFINITY),
        1 => Just(f64::NEG_INFINITY),
        1 => Just(1e300),
        1 => Just(-1e300),
        1 => Just(1e-300),
        1 => Just(f64::MIN_POSITIVE * 0.5),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn garbage_never_panics(
        points in proptest::collection::vec([garbage(), garbage()], 0..12),
        numbers in [garbage(), garbage(), garbage(), garbage(), garbage(), garbage(), garbage(), garbage()],
        wall in [garbage(), garbage(), garbage(), garbage()],
        period in [garbage(), garbage()],
    ) {
        let [spacing, u, v, density, energy, skin, step, ratio] = numbers;
        let body = Body::points_of("garbage", catalogue::copper(), points, spacing)
            .start(|_, _| Start { velocity: [u, v], density, energy });
        let scene = || Scene::<f64, 2>::new(schemes::impact().h_over_dx(ratio)).skin(skin);
        // Small enough to fill, whatever the spacing.
        let block = Body::block("block", catalogue::pmma(), [4.0, u], [4.0 + 3.0 * spacing, u + spacing], spacing);
        let built = scene()
            .body(body.clone())
            .body(block)
            .boundary(MirrorPlane::wall([wall[0], wall[1]], [wall[2], wall[3]]))
            .boundary(Periodic::along(1, period[0], period[1]))
            .steps(|control| StepControl { fixed: Some(step), ..control })
            .build();
        if let Err(error) = built {
            prop_assert!(!error.to_string().is_empty());
        }
    }

    #[test]
    fn sizes_that_nobody_meant_end_in_an_error_or_a_run(
        exponents in [-160..160_i32, -160..160, -160..160, -160..160, -3..3],
        squeeze in 0.6..3.0_f64,
    ) {
        let [spacing, speed, density, energy, skin] = exponents.map(|e| 10_f64.powi(e));
        let points = (0..60)
            .map(|k| [k % 8, k / 8].map(|k| f64::from(k) * squeeze * spacing))
            .collect();
        let body = Body::<f64, 2>::points_of("odd", catalogue::copper(), points, spacing)
            .start(|x, _| Start { velocity: [speed, -speed * x[0] / spacing], density, energy });
        let mut simulation = match Scene::new(schemes::impact()).body(body).skin(skin).build() {
            Ok(simulation) => simulation,
            Err(error) => {
                prop_assert!(!error.to_string().is_empty());
                return Ok(());
            }
        };
        for _ in 0..5 {
            if let Err(error) = simulation.step() {
                prop_assert!(!error.to_string().is_empty());
                break;
            }
        }
    }
}
