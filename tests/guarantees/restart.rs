//! Restart: a simulation that stops at any moment and goes on from its file ends with the same bits, in every kind of
//! scheme; and a file that is not its own is refused with what differs.

use super::bits::said;
use super::stopped::{held, stop_and_go_on};
use crate::common::folder::Folder;
use crate::common::{self, Random};
use meshfree::boundary::{Crush, Inlet, Outlet, Rotation, Wall};
use meshfree::coupling::ContactDensity;
use meshfree::effect::{FiniteStrainPlasticity, Hypoelastic, NeoHookean};
use meshfree::error::CheckpointProblem;
use meshfree::integrator::Predictor;
use meshfree::material::Material;
use meshfree::material::eos::IdealGas;
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::sweep::InstructionSet;
use meshfree::term::CentralViscosity;
use meshfree::term::viscosity::CullenDehnen;
use std::f64::consts::PI;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

const DX: f64 = 0.01;

fn rods<T: Real>() -> Scene<T, 1> {
    Scene::new(schemes::impact())
        .body(Body::block("striker", catalogue::copper(), [0.0], [0.01], 2e-4).velocity([20.0]))
        .body(Body::block(
            "target",
            catalogue::pmma(),
            [0.01],
            [0.03],
            2e-4,
        ))
        .boundary(MirrorPlane::wall([0.03], [1.0]))
}

#[test]
fn rods_that_touch_and_part() {
    stop_and_go_on("rods-f64", rods::<f64>, false, 4e-6);
    stop_and_go_on("rods-f32", rods::<f32>, true, 4e-6);
}

#[test]
fn rods_by_continuity_before_a_wall_that_comes() {
    let scene = || {
        Scene::<f32, 1>::new(schemes::impact_by_continuity())
            .body(Body::block("rod", catalogue::copper(), [0.0], [0.0199], 2e-4).velocity([30.0]))
            .boundary(MirrorPlane::wall([0.02], [1.0]).moving(-20.0))
            .integrator(DriftKickDrift)
    };
    stop_and_go_on("continuity", scene, false, 3e-6);
}

#[test]
fn a_solid_that_flows_through_a_period_by_runge_kutta() {
    let scene = || {
        let rod = Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4);
        Scene::<f64, 1>::new(schemes::impact().energy(EnergyForm::Symmetric))
            .body(rod.start(|x, start| Start {
                velocity: [400.0 + 5.0 * (200.0 * PI * x[0]).sin()],
                ..start
            }))
            .boundary(Periodic::along(0, 0.0, 0.01))
            .integrator(RungeKutta4)
    };
    stop_and_go_on("runge-kutta", scene, false, 4e-6);
}

#[test]
fn an_elastic_plate_that_spins_as_its_edge_is_struck() {
    let scene = || {
        let steel = catalogue::steel().with_shear_modulus(77e9);
        let struck = |[x, y]: [f64; 2], start| Start {
            velocity: [
                2000.0 * (0.005 - y),
                2000.0 * (x - 0.01) + if x < 0.002 { 5.0 } else { 0.0 },
            ],
            ..start
        };
        Scene::<f64, 2>::new(schemes::impact_by_continuity().with(Hypoelastic))
            .body(Body::block("plate", steel, [0.0; 2], [0.02, 0.01], 1e-3).start(struck))
    };
    stop_and_go_on("plate", scene, false, 5e-6);
}

#[test]
fn the_printed_leapfrog_with_old_rates() {
    let scene = || {
        let copper = catalogue::copper::<f64>;
        Scene::<f64, 1>::new(schemes::lam2002())
            .body(Body::block("striker", copper(), [0.0], [0.01], 2e-4).velocity([20.0]))
            .body(Body::block("target", copper(), [0.01], [0.03], 2e-4))
            .between("striker", "target", Interaction::Bonded)
            .integrator(LamLeapfrog {
                predictor: Predictor::Lagged,
            })
    };
    stop_and_go_on("lam", scene, false, 2e-6);
}

#[test]
fn a_gas_whose_lengths_and_viscosities_follow_the_flow() {
    let scene = || {
        let gas = IdealGas::new(1.4, 1.0);
        let tube = Body::block("tube", Material::new("gas", gas), [-0.5], [0.5], 0.01);
        let tube = tube.start(|x, start| Start {
            velocity: [-0.5 * (2.0 * PI * x[0]).sin()],
            energy: gas.energy(if x[0] < 0.0 { 1.0 } else { 0.5 }, 1.0),
            ..start
        });
        let scheme = SchemeBuilder::new(CubicSpline, CullenDehnen::default())
            .density(DensityForm::Summation)
            .with(ConsistentSmoothing {
                smallest: 0.05,
                largest: 20.0,
            });
        Scene::<f64, 1>::new(scheme)
            .body(tube)
            .boundary(MirrorPlane::symmetry([-0.5], [-1.0]))
            .boundary(MirrorPlane::symmetry([0.5], [1.0]))
            .integrator(PositionVerlet)
    };
    stop_and_go_on("gas", scene, false, 0.2);
}

/// A square of water off its lattice, with random velocities.
fn splash<T: Real>() -> Body<T, 2> {
    let mut random = Random(3);
    let points = common::jittered([0.0; 2], [10; 2], 0.1, &mut random);
    let points = points.into_iter().map(|x| x.map(|x| x * DX)).collect();
    let water = catalogue::weakly_compressible_water(2.0).with_dynamic_viscosity(0.5);
    let random = std::cell::RefCell::new(random);
    Body::points_of("water", water, points, DX).start(|_, start| Start {
        velocity: random.borrow_mut().vector(1.0),
        ..start
    })
}

fn closed_tank() -> Wall<2> {
    Wall::around("tank", [0.0; 2], [0.1; 2], DX, 4, [[true; 2]; 2])
}

fn down<const D: usize>(_time: f64) -> [f64; D] {
    core::array::from_fn(|d| if d + 1 == D { -9.81 } else { 0.0 })
}

/// s = size sin(rate t), with its two derivatives.
fn swing(size: f64, rate: f64) -> impl Fn(f64) -> [f64; 3] + Send + Sync + 'static {
    move |t| {
        let (s, c) = (rate * t).sin_cos();
        [size * s, size * rate * c, -size * rate * rate * s]
    }
}

/// Water in a tank.
fn tank<T: Real>() -> Scene<T, 2> {
    let open = [[true; 2], [true, false]];
    Scene::new(schemes::weakly_compressible())
        .body(splash())
        .wall(Wall::around("tank", [0.0; 2], [0.12, 0.15], DX, 4, open))
        .acceleration(down)
}

#[test]
fn a_liquid_in_a_tank() {
    stop_and_go_on("tank", tank::<f64>, true, 0.05);
}

#[test]
fn liquids_in_tanks_that_roll_and_that_are_crushed() {
    let scene = |wall: Wall<2>| {
        let scheme = schemes::weakly_compressible().with(Laminar(CentralViscosity));
        Scene::<f64, 2>::new(scheme)
            .body(splash())
            .wall(wall)
            .acceleration(down)
    };
    let rolled = || {
        let motion = Rotation::about([0.05; 2], swing(0.02, 60.0));
        scene(closed_tank().motion(motion).no_slip().container_frame())
    };
    stop_and_go_on("rolled", rolled, true, 0.04);
    let crushed = || scene(closed_tank().motion(Crush::along(1, 0.0, |t| [0.5 * t, 0.5, 0.0])));
    stop_and_go_on("crushed", crushed, true, 0.03);
}

/// A channel through which water flows: two walls, an inlet, and an outlet; more enters than the reserve holds.
fn channel() -> Scene<f64, 2> {
    let opening = (0..10).map(|k| [0.0, DX * (f64::from(k) + 0.5)]).collect();
    let water = catalogue::weakly_compressible_water(2.0);
    Scene::new(schemes::weakly_compressible())
        .body(Body::block("water", water, [0.0; 2], [0.2, 0.1], DX).velocity([1.0, 0.0]))
        .inlet(Inlet::new("water", opening, [1.0, 0.0], DX, 60))
        .outlet(Outlet::plane([0.22, 0.0], [1.0, 0.0]))
}

#[test]
fn what_enters_and_leaves() {
    let closed = [[false; 2], [true; 2]];
    let floors = || {
        let (low, high) = ([-0.06, 0.0], [0.3, 0.1]);
        channel().wall(Wall::around("floors", low, high, DX, 4, closed))
    };
    stop_and_go_on("channel", floors, true, 0.12);
    let periodic = || channel().boundary(Periodic::along(1, 0.0, 0.1));
    stop_and_go_on("period", periodic, false, 0.12);
}

#[test]
fn a_liquid_on_a_structure() {
    let scene = || {
        let soft = meshfree::material::Liquid::new(2000.0, 40.0, 0.0);
        let soft = soft.material("soft", meshfree::material::SoundSpeed::Physical);
        let block = Body::block("block", soft, [-0.05, -0.105], [0.15, -0.005], DX);
        Scene::<f64, 2>::new(schemes::weakly_compressible().with(Laminar(CentralViscosity)))
            .body(splash())
            .group(schemes::impact(), [block.no_slip()])
            .acceleration(down)
    };
    stop_and_go_on("structure", scene, false, 0.02);
    stop_and_go_on("sub-cycled", || scene().sub_cycle("block", 16), true, 0.02);
}

/// Water on an elastic plate that is clamped, and a block that yields and touches it by a coupling, in one scene.
#[test]
fn liquid_wall_elastic_and_plastic_bodies_go_on() {
    let scene = || {
        let water = catalogue::water_at(meshfree::material::SoundSpeed::artificial(2.0));
        let soft = |name: &str| {
            Material::new(name, meshfree::material::eos::Linear::new(1100.0, 40.0))
                .with_shear_modulus(5e5)
                .with_yield_stress(2e3)
        };
        let plate = Body::block("plate", soft("plate"), [-0.03, -0.05], [0.13, 0.0], DX);
        let block = Body::block("block", soft("block"), [0.02, -0.105], [0.08, -0.055], DX);
        Scene::<f64, 2>::new(schemes::weakly_compressible())
            .body(Body::block("water", water, [0.0; 2], [0.1, 0.08], DX))
            .group(schemes::total_lagrangian().with(NeoHookean), [plate])
            .group(
                schemes::total_lagrangian().with(FiniteStrainPlasticity),
                [block.velocity([0.0, 2.0])],
            )
            .wall(Wall::around(
                "tank",
                [0.0; 2],
                [0.1; 2],
                DX,
                4,
                [[true; 2], [false; 2]],
            ))
            .fix("plate", |[x, _]| !(0.0..0.1).contains(x))
            .couple("plate", "block", ContactDensity::new())
            .between("water", "block", Interaction::None)
            .between("plate", "tank", Interaction::None)
            .between("block", "tank", Interaction::None)
            .sub_cycle("plate", 8)
            .acceleration(|_| [0.0, -9.81])
    };
    stop_and_go_on("mixed", scene, true, 0.01);
}

#[test]
fn a_block_in_a_box_that_is_shaken() {
    let scene = || {
        let stuff = Material::new("stuff", meshfree::material::eos::Linear::new(2000.0, 20.0));
        let shaken = Translation::new(
            |t| [0.02 * (30.0 * t).sin() - 0.6 * t, 0.0],
            |t| [0.6 * (30.0 * t).cos() - 0.6, 0.0],
            |t| [-18.0 * (30.0 * t).sin(), 0.0],
        );
        let tank = Wall::around("tank", [0.0; 2], [0.2, 0.1], DX, 3, [[true; 2]; 2]);
        Scene::<f64, 2>::new(schemes::impact_by_continuity())
            .body(Body::block("block", stuff, [0.05, 0.0], [0.11, 0.06], DX))
            .rigid("block")
            .wall(tank.motion(shaken))
            .couple("block", "tank", ContactDensity::new().friction(0.3))
            .acceleration(|_| [0.0, -9.81])
    };
    stop_and_go_on("shaken", scene, true, 0.05);
}

#[test]
fn a_closed_flow_that_is_shifted() {
    let scene = || {
        let water = catalogue::weakly_compressible_water(1.0);
        let body = Body::block("water", water, [0.0; 2], [0.2; 2], DX).jitter(0.2, 7);
        let k = 10.0 * PI;
        Scene::<f32, 2>::new(schemes::weakly_compressible().with(Shifting::CLOSED))
            .body(body.start(|x, start| Start {
                velocity: [
                    (k * x[0]).sin() * (k * x[1]).cos(),
                    -(k * x[0]).cos() * (k * x[1]).sin(),
                ],
                ..start
            }))
            .boundary(Periodic::along(0, 0.0, 0.2))
            .boundary(Periodic::along(1, 0.0, 0.2))
    };
    stop_and_go_on("shifted", scene, false, 0.1);
}

#[test]
fn lengths_that_follow_the_divergence() {
    let scene = || {
        Scene::<f32, 2>::new(schemes::ls_dyna_default())
            .body(splash())
            .wall(closed_tank())
            .acceleration(down)
    };
    stop_and_go_on("divergence", scene, true, 0.03);
}

/// A drop in a corner of mirrors, in space, with fields of an effect's own.
#[test]
fn a_drop_in_a_corner() {
    let scene = || {
        let water = catalogue::weakly_compressible_water(2.0);
        let drop = Body::block("drop", water, [0.0; 3], [0.06; 3], DX).velocity([-1.0, 0.2, -0.5]);
        Scene::<f32, 3>::new(schemes::weakly_compressible().with(AcousticDamping { strength: 0.3 }))
            .body(drop)
            .boundary(MirrorPlane::wall([0.0; 3], [-1.0, 0.0, 0.0]))
            .boundary(MirrorPlane::wall([0.0; 3], [0.0, 0.0, -1.0]))
            .acceleration(down)
    };
    stop_and_go_on("corner", scene, false, 0.04);
}

#[test]
fn a_run_goes_on_with_the_instructions_that_it_began_with() {
    let folder = Folder::new("instructions");
    let path = folder.file("one");
    let baseline = || tank::<f64>().instructions(InstructionSet::Baseline);
    let mut whole = baseline().build().unwrap();
    for _ in 0..10 {
        whole.step().unwrap();
    }
    whole.save(&path).unwrap();
    let mut resumed = tank::<f64>().resume(&path).unwrap();
    for _ in 0..20 {
        whole.step().unwrap();
        resumed.step().unwrap();
    }
    assert!(said(&whole) == said(&resumed));
    assert_eq!(held(&path)["instructions"], b"Baseline");
}

#[test]
fn an_evaluation_between_steps_is_not_in_the_file() {
    let folder = Folder::new("between");
    let path = folder.file("one");
    let mut whole = tank::<f64>().build().unwrap();
    for moment in [7, 20, 33] {
        while whole.steps() < moment {
            whole.step().unwrap();
        }
        let builds = whole.list_builds();
        whole.save(&path).unwrap();
        whole.evaluate().unwrap();
        let evaluated = folder.file("evaluated");
        whole.save(&evaluated).unwrap();
        if whole.list_builds() == builds {
            let [before, after] = [&path, &evaluated].map(|path| held(path));
            for (name, bytes) in &before {
                assert!(*bytes == after[name], "`{name}` differs");
            }
        }
        let mut resumed = tank::<f64>().resume(&evaluated).unwrap();
        for _ in 0..6 {
            whole.step().unwrap();
            resumed.step().unwrap();
        }
        assert!(said(&whole) == said(&resumed), "evaluated after {moment}");
    }
}

#[test]
fn what_has_failed_is_not_saved() {
    let folder = Folder::new("failed");
    let path = folder.file("one");
    let opening = (0..10).map(|k| [0.0, DX * (f64::from(k) + 0.5)]).collect();
    let water = catalogue::weakly_compressible_water(2.0);
    let mut simulation = Scene::<f64, 2>::new(schemes::weakly_compressible())
        .body(Body::block("water", water, [0.0; 2], [0.1; 2], DX).velocity([1.0, 0.0]))
        .boundary(Periodic::along(1, 0.0, 0.1))
        .inlet(Inlet::new("water", opening, [1.0, 0.0], DX, 15))
        .build()
        .unwrap();
    assert!(simulation.run_until(0.1).is_err());
    let error = simulation.save(&path).unwrap_err();
    assert!(matches!(error, Error::Failed { .. }), "{error}");
    assert!(!path.exists());
}

/// The first `steps` of a scene in a file.
fn saved<T: Real, const D: usize>(scene: Scene<T, D>, path: &Path, steps: usize) {
    let mut simulation = scene.build().unwrap();
    for _ in 0..steps {
        simulation.step().unwrap();
    }
    simulation.save(path).unwrap();
}

fn problem<T: Real, const D: usize>(scene: Scene<T, D>, path: &Path) -> CheckpointProblem {
    match scene.resume(path) {
        Err(Error::Checkpoint {
            path: named,
            problem,
        }) => {
            assert_eq!(named, path);
            problem
        }
        Err(other) => panic!("{other}"),
        Ok(_) => panic!("resumed"),
    }
}

#[test]
fn a_file_cut_short_or_altered_is_refused() {
    let folder = Folder::new("altered");
    let path = folder.file("one");
    saved(rods::<f64>(), &path, 5);
    let whole = fs::read(&path).unwrap();
    let mut random = Random(11);
    let refused = |bytes: &[u8]| {
        fs::write(&path, bytes).unwrap();
        let problem = problem(rods::<f64>(), &path);
        let damaged = matches!(problem, CheckpointProblem::Damaged { .. });
        assert!(damaged && problem.to_string().contains("older checkpoint"));
    };
    let end = whole.len();
    for length in [0, 1, 7, 8, 9, 100, end / 2, end - 9, end - 8, end - 1] {
        refused(&whole[..length]);
    }
    refused(&[&whole[..], b"more"].concat());
    let header = 8 + u64::from_le_bytes(whole[..8].try_into().unwrap()) as usize;
    for k in 0..60 {
        // A third of them in the header, the last in the checksum.
        let at = match k {
            59 => end - 1,
            _ if k % 3 == 0 => random.below(header),
            _ => random.below(end),
        };
        let mut altered = whole.clone();
        altered[at] ^= 1 << random.below(8);
        refused(&altered);
    }
    refused(b"x,y\n1.0,2.0\n");
    fs::write(&path, &whole).unwrap();
    assert!(rods::<f64>().resume(&path).is_ok());
}

#[test]
fn a_file_that_is_not_there_is_named() {
    let folder = Folder::new("missing");
    let path = folder.file("none");
    let error = rods::<f64>().resume(&path).unwrap_err();
    assert!(
        matches!(error, Error::File { action: "read", .. }),
        "{error}"
    );
    assert!(error.to_string().contains("none"));
    let nowhere = folder.file("file");
    fs::write(&nowhere, b"").unwrap();
    let error = rods::<f64>().build().unwrap().save(nowhere.join("in it"));
    assert!(matches!(error, Err(Error::File { .. })));
}

#[test]
fn another_type_is_named() {
    let folder = Folder::new("types");
    let path = folder.file("one");
    saved(rods::<f64>(), &path, 2);
    assert_eq!(
        problem(rods::<f32>(), &path),
        CheckpointProblem::Kind {
            what: "scalar",
            found: "f64".into(),
            own: "f32".into()
        }
    );
    assert_eq!(
        problem(tank::<f64>(), &path),
        CheckpointProblem::Kind {
            what: "dimension",
            found: "1".into(),
            own: "2".into()
        }
    );
}

/// A copy of a file with one text exchanged by one as long, and a checksum that fits.
fn forged(path: &Path, text: &str, by: &str) -> Vec<u8> {
    assert_eq!(text.len(), by.len());
    let mut bytes = fs::read(path).unwrap();
    let found = bytes
        .windows(text.len())
        .position(|window| window == text.as_bytes());
    let at = found.unwrap();
    bytes[at..at + text.len()].copy_from_slice(by.as_bytes());
    let end = bytes.len() - 8;
    let hash = bytes[..end]
        .iter()
        .fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
            (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3)
        });
    bytes[end..].copy_from_slice(&hash.to_le_bytes());
    bytes
}

#[test]
fn another_version_width_and_machine_are_named() {
    let folder = Folder::new("forged");
    let (path, copy) = (folder.file("one"), folder.file("copy"));
    saved(
        rods::<f64>().instructions(InstructionSet::Baseline),
        &path,
        2,
    );
    let with = |text: &str, by: &str| {
        fs::write(&copy, forged(&path, text, by)).unwrap();
        problem(rods::<f64>(), &copy)
    };
    assert_eq!(
        with(r#""version":"6""#, r#""version":"9""#),
        CheckpointProblem::Version {
            found: "9".into(),
            known: "6"
        }
    );
    assert_eq!(
        with(r#""lane width":"8""#, r#""lane width":"4""#),
        CheckpointProblem::Kind {
            what: "lane width",
            found: "4".into(),
            own: "8".into()
        }
    );
    let unknown = with(
        r#""instructions":"Baseline""#,
        r#""instructions":"Fathomed""#,
    );
    assert!(matches!(unknown, CheckpointProblem::Damaged { .. }));
    let other = with(r#""format":"meshfree "#, r#""format":"another  "#);
    assert!(matches!(other, CheckpointProblem::Damaged { .. }));
    // A machine that has them goes on.
    if !InstructionSet::Avx512.available() {
        let lacking = with(
            r#""instructions":"Baseline""#,
            r#""instructions":"Avx512"  "#,
        );
        let found = "Avx512".into();
        assert_eq!(lacking, CheckpointProblem::Instructions { found });
    }
}

#[test]
fn another_scene_is_refused_with_what_differs() {
    let folder = Folder::new("scenes");
    let path = folder.file("one");
    let scene = |alpha: f64, shift: f64| {
        let mut splash = splash::<f64>();
        splash = splash.velocity([shift, 0.0]);
        let viscosity = meshfree::term::viscosity::MonaghanGingold { alpha, beta: 0.0 };
        Scene::<f64, 2>::new(schemes::weakly_compressible().with_viscosity(viscosity)).body(splash)
    };
    saved(
        scene(0.02, 0.0).wall(closed_tank()).acceleration(down),
        &path,
        2,
    );
    let differs = |scene: Scene<f64, 2>| match problem(scene, &path) {
        CheckpointProblem::Scene { parts, .. } => parts.join(", "),
        other => panic!("{other}"),
    };
    let base = || scene(0.02, 0.0).wall(closed_tank()).acceleration(down);
    assert!(base().resume(&path).is_ok());
    let cases = [
        (scene(0.02, 0.0).acceleration(down), "walls"),
        (scene(0.02, 0.0).wall(closed_tank()), "the loads"),
        (
            scene(0.02, 1e-15).wall(closed_tank()).acceleration(down),
            "bodies",
        ),
        (
            scene(0.021, 0.0).wall(closed_tank()).acceleration(down),
            "schemes",
        ),
        (
            scene(0.02, 0.0)
                .wall(closed_tank().no_slip())
                .acceleration(down),
            "walls",
        ),
        (base().integrator(DriftKickDrift), "the integrator"),
        (base().skin(0.15), "the skin of neighbour lists"),
        (
            base()
                .outlet(Outlet::faster_than(100.0))
                .integrator(DriftKickDrift),
            "outlets, the integrator",
        ),
        (base().boundary(Periodic::along(0, -1.0, 1.0)), "boundaries"),
        (
            base().steps(|steps| StepControl {
                force: 0.2,
                ..steps
            }),
            "the choice of steps",
        ),
    ];
    for (scene, expected) in cases {
        assert_eq!(differs(scene), expected);
    }
}

/// The header is what Python's `safetensors` reads first: its length in eight bytes, then JSON.
#[test]
fn names_stand_in_the_header() {
    let folder = Folder::new("header");
    let path = folder.file("one");
    saved(tank::<f64>(), &path, 2);
    let bytes = fs::read(&path).unwrap();
    let length = u64::from_le_bytes(bytes[..8].try_into().unwrap()) as usize;
    let header = std::str::from_utf8(&bytes[8..8 + length])
        .unwrap()
        .trim_end();
    assert!(header.starts_with('{') && header.ends_with('}'));
    assert!(header.contains(r#""format":"meshfree checkpoint""#));
    // Of water ten by ten, in whole rows of eight, and of a tank of four layers.
    let slots = 104 + 20 * 19 - 12 * 15;
    for (name, kind, shape) in [
        ("time", "F64", String::new()),
        ("steps", "U64", String::new()),
        ("group0/particles/position", "F64", format!("{slots},2")),
        ("group0/particles/density", "F64", slots.to_string()),
        ("group0/ids", "U32", slots.to_string()),
        ("checksum", "U8", "8".into()),
    ] {
        let entry = format!(r#""{name}":{{"dtype":"{kind}","shape":[{shape}],"data_offsets":["#);
        assert!(header.contains(&entry), "{entry} in {header}");
    }
    // The column of a name is where the header says, and in the unit of the crate.
    let density = header
        .split(r#""group0/particles/density""#)
        .nth(1)
        .unwrap();
    let offsets = density.split("data_offsets\":[").nth(1).unwrap();
    let first: usize = offsets.split(',').next().unwrap().parse().unwrap();
    let at = 8 + length + first;
    let number = f64::from_le_bytes(bytes[at..at + 8].try_into().unwrap());
    assert!((number / 1000.0 - 1.0).abs() < 0.1, "{number}");
}

/// The run that is killed: it saves after every step.
fn run_and_save(path: &Path) {
    let mut simulation = tank::<f64>().build().unwrap();
    simulation
        .run_with(KILLED_END, |now| now.save(path).unwrap())
        .unwrap();
}

const KILLED_END: f64 = 0.05;
const VICTIM: &str = "MESHFREE_RESTART_VICTIM";

#[test]
fn a_process_killed_at_any_moment_leaves_a_file_to_go_on_from() {
    if let Some(path) = std::env::var_os(VICTIM) {
        run_and_save(Path::new(&path));
        return;
    }
    let mut whole = tank::<f64>().build().unwrap();
    whole.run_until(KILLED_END).unwrap();
    let last = said(&whole);
    let folder = Folder::new("killed");
    let mut random = Random(23);
    let mut between = 0;
    for k in 0..12 {
        let path = folder.file(&k.to_string());
        let mut victim = Command::new(std::env::current_exe().unwrap())
            .args([
                "--exact",
                "guarantees::restart::a_process_killed_at_any_moment_leaves_a_file_to_go_on_from",
            ])
            .env(VICTIM, &path)
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let begin = Instant::now();
        while !path.exists() {
            assert!(
                begin.elapsed() < Duration::from_secs(60),
                "nothing is saved"
            );
            std::thread::sleep(Duration::from_micros(200));
        }
        std::thread::sleep(Duration::from_micros(random.bits() % 100_000));
        victim.kill().unwrap();
        victim.wait().unwrap();
        let mut resumed = tank::<f64>().resume(&path).unwrap();
        between += u32::from(resumed.time() < KILLED_END);
        resumed.run_until(KILLED_END).unwrap();
        assert!(said(&resumed) == last, "killed at step {}", resumed.steps());
    }
    assert!(between > 3, "{between} of 12 were killed on their way");
}
