//! A hundred bad inputs: each gives an `Error` that says what is wrong, and none panics.
//! What a device lacks is told apart: an adapter, `f64`, and memory.

use crate::common::device;
use crate::compare::build;
use meshfree::boundary::Outlet;
use meshfree::coupling::{ContactDensity, Penalty};
use meshfree::effect::{FiniteStrainPlasticity, Plasticity, Shifting};
use meshfree::error::Error as HostError;
use meshfree::integrator::{Integrator, Midpoint, RungeKutta4, System};
use meshfree::kernel::WendlandC2;
use meshfree::material::strength::PerfectPlasticity;
use meshfree::neighbors::{Block, ClusterLists, Radii, SearchInput};
use meshfree::prelude::*;
use meshfree::scalar::{InstructionSet, Record};
use meshfree::simulation::{Load, Thresholds};
use meshfree::sweep::{FusedKernel, PairRecord, PairSweep, Pass};
use meshfree::term::PressureForce;
use meshfree_gpu::{Device, Error, PairKernel, PairLists, PointKernel, Precision, Shared};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::Command;

/// Numbers that hardly anything can be.
const BAD: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

/// What was tried, and what of it was not refused.
#[derive(Default)]
struct Tried {
    count: usize,
    wrong: Vec<String>,
}

impl Tried {
    /// Whether something is an error of a kind whose text says something.
    fn refused<V>(
        &mut self,
        what: impl Into<String>,
        is_kind: impl Fn(&Error) -> bool,
        run: impl FnOnce() -> Result<V, Error>,
    ) {
        self.count += 1;
        let what = what.into();
        println!("{what:.60?}");
        match catch_unwind(AssertUnwindSafe(run)) {
            Ok(Err(error)) if is_kind(&error) && error.to_string().len() > 20 => {}
            Ok(Err(error)) => self.wrong.push(format!("{what}: {error:?}, {error}")),
            Ok(Ok(_)) => self.wrong.push(format!("{what}: no error")),
            Err(_) => self.wrong.push(format!("{what}: a panic")),
        }
    }
    /// The same of a simulation that the device does not take.
    fn load<T: Real, const D: usize>(&mut self, device: &Device, what: &str, scene: Scene<T, D>) {
        match scene.build() {
            Ok(simulation) => self.loaded(device, what, simulation),
            Err(error) => self.wrong.push(format!("{what}: {error}")),
        }
    }
    fn loaded<T: Real, const D: usize>(
        &mut self,
        device: &Device,
        what: &str,
        simulation: Simulation<T, D>,
    ) {
        let is_named = |error: &Error| {
            let text = error.to_string();
            matches!(error, Error::Simulation(HostError::Build(_)))
                && text.contains(what)
                && text.contains("device")
        };
        self.refused(what, is_named, || device.load(simulation));
    }
}

fn size(error: &Error) -> bool {
    matches!(error, Error::Size { .. })
}

fn names(tried: &mut Tried, device: &Device) {
    let own = &device.adapter().name;
    let (long, more, lower) = ("x".repeat(10_000), format!("{own} "), own.to_uppercase());
    for name in [
        "",
        " ",
        "no such adapter",
        "\0",
        "Grafik",
        &long,
        &more,
        &lower,
    ] {
        let is_unknown = |error: &Error| matches!(error, Error::UnknownAdapter { .. });
        tried.refused(format!("named {name:.20}"), is_unknown, || {
            Device::named(name)
        });
    }
    for threads in [0, 1 << 20, u32::MAX] {
        let threaded = || device.clone().with_threads(threads);
        tried.refused(format!("{threads} threads"), size, threaded);
    }
}

fn points(tried: &mut Tried, device: &Device) {
    let record = Record::of(3, |x| vec![x[0] + x[1] * x[2]]).expect("lanes");
    let kernel = PointKernel::new(device, "points", &record, Precision::Double).expect("a kernel");
    let (one, two) = ([1.0], [1.0, 2.0]);
    let none: &[&[f64]] = &[];
    for given in [
        none,
        &[&one],
        &[&one, &one],
        &[&[], &[]],
        &[&one, &one, &two],
        &[&one, &two, &one],
        &[&two, &one, &two],
        &[&two, &two, &[]],
        &[&one, &one, &one, &two],
    ] {
        tried.refused(format!("columns {given:?}"), size, || {
            kernel.run(device, given)
        });
    }
    let other = Device::named(&device.adapter().name).expect("the same adapter");
    let elsewhere = |error: &Error| matches!(error, Error::OtherDevice);
    tried.refused("a kernel of another device", elsewhere, || {
        kernel.run(&other, &[&one, &one, &one])
    });
    let lesser = device.clone().as_lesser(true, 512);
    let many = vec![0.0; 100];
    let large = |error: &Error| matches!(error, Error::TooLarge { bytes: 2400, most, .. } if most % 512 == 0);
    let run = || kernel.run(&lesser, &[&many, &many, &many]);
    tried.refused("columns that do not fit", large, run);
}

type Sweep = FusedKernel<WendlandC2, (PressureForce,)>;

fn pair() -> PairRecord {
    let sweep: Sweep = FusedKernel::new(WendlandC2, (PressureForce,));
    PairSweep::<f64, 3>::record(&sweep, Pass::Rates, false).expect("lanes")
}

fn pairs(tried: &mut Tried, device: &Device) {
    let (pair, width, count) = (pair(), 8, 64);
    let stride = pair.reads.width(3);
    let new = |shape| PairKernel::new(device, "pairs", &pair, shape, Precision::Double);
    for shape in [(0, 8), (1, 8), (2, 8), (4, 8), (usize::MAX, 8), (3, 0)] {
        tried.refused(format!("a sweep of {shape:?}"), size, || new(shape));
    }
    let kernel = new((3, width)).expect("a kernel");
    let positions: Vec<_> = (0..count)
        .map(|k| [k % 4, k / 4 % 4, k / 16].map(|x| x as f64))
        .collect();
    let lists = |blocks: &[Block], width: usize| {
        let mut lists = ClusterLists::default();
        lists.rebuild(&SearchInput {
            positions: &positions,
            radii: Radii::Uniform(2.6),
            blocks,
            listed: &[],
            width,
            slots: count,
            skin: 0.0,
            instructions: InstructionSet::detect(),
        });
        lists
    };
    let wall = false;
    let slots = 0..count / 2;
    let rest = count / 2..count;
    let blocks = [Block { slots, wall }, Block { slots: rest, wall }];
    let both = lists(&blocks, width);
    let good = || PairLists::new(both.chunks(), &blocks, width);
    let records = vec![1.0; stride * count];
    let shared = |h, factor, force: &[f64]| Shared {
        smoothing_length: h,
        lattice_consistency_factor: factor,
        body_force: force.to_vec(),
    };
    let fine = shared(1.3, 1.0, &[0.0; 3]);
    let found = kernel.run(device, (&records, count), &good(), &fine);
    assert!(found.is_ok(), "{found:?}");
    let is_value = |error: &Error| matches!(error, Error::Value { .. });
    for bad in BAD.into_iter().chain([0.0, -1.0]) {
        for own in [shared(bad, 1.0, &[0.0; 3]), shared(1.3, bad, &[0.0; 3])] {
            let run = || kernel.run(device, (&records, count), &good(), &own);
            tried.refused(format!("{own:?}"), is_value, run);
        }
    }
    for bad in BAD {
        for d in 0..3 {
            let mut force = [0.0; 3];
            force[d] = bad;
            let own = shared(1.3, 1.0, &force);
            let run = || kernel.run(device, (&records, count), &good(), &own);
            tried.refused(format!("{own:?}"), is_value, run);
        }
    }
    for force in [&[][..], &[0.0], &[0.0; 2], &[0.0; 4]] {
        let own = shared(1.3, 1.0, force);
        let run = || kernel.run(device, (&records, count), &good(), &own);
        tried.refused(format!("{own:?}"), size, run);
    }
    for few in [0, 1, stride, records.len() / 2, records.len() - 1] {
        let run = || kernel.run(device, (&records[..few], count), &good(), &fine);
        tried.refused(format!("{few} records"), size, run);
    }
    for count in [0, 1, count - width, count + 1, 2 * count] {
        let run = || kernel.run(device, (&records, count), &good(), &fine);
        tried.refused(format!("{count} particles"), size, run);
    }
    for (what, own) in [
        ("no lists", PairLists::default()),
        ("lists of no chunk", PairLists::new(&[], &blocks, width)),
        (
            "clusters without particles",
            PairLists::new(both.chunks(), &blocks, 0),
        ),
        (
            "clusters of four",
            PairLists::new(both.chunks(), &blocks, 4),
        ),
        (
            "one block of two",
            PairLists::new(both.chunks(), &blocks[..1], width),
        ),
        ("no block", PairLists::new(both.chunks(), &[], width)),
    ] {
        let run = || kernel.run(device, (&records, count), &own, &fine);
        tried.refused(what, size, run);
    }
}

fn water() -> Scene<f64, 2> {
    let water = catalogue::weakly_compressible_water(2.0);
    Scene::new(schemes::weakly_compressible())
        .body(Body::block("water", water, [0.0; 2], [0.2; 2], 0.02))
}

fn rods() -> Scene<f64, 1> {
    rods_with(EnergyForm::Compatible)
}

fn rods_with(energy: EnergyForm) -> Scene<f64, 1> {
    let rod = |name: &str, low: f64| {
        Body::block(name, catalogue::copper::<f64>(), [low], [low + 0.01], 2e-4)
    };
    let scene = Scene::new(schemes::impact().energy(energy));
    scene.body(rod("left", 0.0)).body(rod("right", 0.0102))
}

/// An integrator that keeps a state without saying so.
#[derive(Clone, Copy, Debug)]
enum Secret {
    Save,
    Load,
    Combine,
    Accumulate,
}

impl Integrator for Secret {
    fn name(&self) -> String {
        "secret".into()
    }
    fn step(&self, system: &mut dyn System, _dt: f64) -> Result<(), HostError> {
        match self {
            Self::Save => system.save(0),
            Self::Load => system.load(0),
            Self::Combine => system.combine(0, 0.5, 0.5, 0.0),
            Self::Accumulate => system.accumulate(0, 0.0),
        }
        system.evaluate(0.0)
    }
}

fn scenes(tried: &mut Tried, device: &Device) {
    let late = |now: &Simulation<f64, 2>| now.time() > 1.0;
    tried.load(device, "the event `late`", water().event("late", late));
    for axis in 0..2 {
        let mut pull = [0.0; 2];
        pull[axis] = 1.0;
        let load = Load::acceleration(move |_| pull);
        tried.load(device, "the load (acceleration", water().load(load));
    }
    tried.load(
        device,
        "the load (heating",
        rods().load(Load::heating(|_| 1.0)),
    );
    let end = Outlet::plane([0.15, 0.0], [1.0, 0.0]);
    tried.load(device, "an outlet", water().outlet(end));
    let couple = || rods().couple("left", "right", Penalty::new().friction(0.1));
    tried.load(device, "the coupling `penalty`", couple());
    let slides = ContactDensity::new().friction(0.1);
    tried.load(
        device,
        "the coupling `contact density`",
        rods().couple("left", "right", slides),
    );
    let plane = MirrorPlane::symmetry([-1.0], [-1.0]);
    let imaged = rods().couple("left", "right", Penalty::new());
    tried.load(device, "among images", imaged.boundary(plane));
    let stiff = rods()
        .rigid("right")
        .couple("left", "right", Penalty::new());
    tried.load(device, "the rigid body `right`", stiff);
    let rod = || {
        let rod = Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4);
        Scene::<f64, 1>::new(schemes::lam2002()).body(rod)
    };
    tried.load(device, "density by Lam", rod());
    let kept = "which keeps states, with forces that are no pair's";
    let meet = || rods_with(EnergyForm::Symmetric).couple("left", "right", Penalty::new());
    tried.load(device, kept, meet().integrator(RungeKutta4));
    tried.load(device, kept, meet().integrator(Midpoint));
    let mut kept = build(water());
    kept.keep_energy();
    tried.loaded(device, "the energy ledger", kept);
    let mut watched = build(water());
    watched.keep_stability(Thresholds::default());
    tried.loaded(device, "a run that is watched", watched);
    let fixed = rods().fix("left", |x| x[0] < 5e-3);
    let fixed = fixed.fix("left", |x| x[0] < 2e-3);
    tried.load(device, "a particle that two clamps hold", fixed);
    let shifted = schemes::weakly_compressible().with(Shifting::STANDARD);
    let liquid = catalogue::weakly_compressible_water::<f32>(2.0);
    let body = Body::block("water", liquid, [0.0; 2], [0.2; 2], 0.02);
    tried.load(
        device,
        "the law `shifting`",
        Scene::<f32, 2>::new(shifted).body(body),
    );
    let copper = catalogue::copper::<f32>().with_shear_modulus(46e9);
    let copper = copper.with_strength(PerfectPlasticity::new(0.4e9));
    let bar = || Body::block("bar", copper.clone(), [0.0; 2], [0.01; 2], 1e-3);
    let flows = schemes::impact_by_continuity()
        .with(Hypoelastic)
        .with(Plasticity);
    tried.load(
        device,
        "computes in f64",
        Scene::<f32, 2>::new(flows).body(bar()),
    );
    let flows = schemes::total_lagrangian().with(FiniteStrainPlasticity);
    tried.load(
        device,
        "computes in f64",
        Scene::<f32, 2>::new(flows).body(bar()),
    );
    for own in [
        Secret::Save,
        Secret::Load,
        Secret::Combine,
        Secret::Accumulate,
    ] {
        let is_kept = |error: &Error| matches!(error, Error::KeptState { .. });
        tried.refused(format!("{own:?}"), is_kept, || {
            device.load(build(rods().integrator(own)))?.step()
        });
    }
}

fn runs(tried: &mut Tried, device: &Device) {
    let mut run = device.load(build(rods())).expect("a run");
    let is_argument = |error: &Error| matches!(error, Error::Simulation(HostError::Argument(_)));
    for end in BAD {
        tried.refused(format!("run_until {end}"), is_argument, || {
            run.run_until(end)
        });
        tried.refused(format!("run_with {end}"), is_argument, || {
            run.run_with(end, |_| ())
        });
        tried.refused(format!("step_until {end}"), is_argument, || {
            run.step_until(end)
        });
    }
    // From some time on, and for good.
    let of_host = |error: &Error| matches!(error, Error::Simulation(_));
    for bad in BAD.into_iter().chain([1e160, -1e160]) {
        let pulled = rods().acceleration(move |t| [if t > 1e-8 { bad } else { 0.0 }]);
        let mut run = device.load(build(pulled)).expect("a run");
        tried.refused(format!("pulled by {bad}"), of_host, || run.run_until(1e-6));
        let failed = |error: &Error| matches!(error, Error::Simulation(HostError::Failed { .. }));
        tried.refused(format!("after {bad}"), failed, || run.step());
    }
    for bad in BAD {
        let at = move |t: f64| if t > 1e-3 { bad } else { 0.0 };
        let motion = Translation::new(move |t| [at(t), 0.0], move |t| [at(t), 0.0], |_| [0.0; 2]);
        let closed = [[true; 2], [true, false]];
        let tank = Wall::around("tank", [0.0; 2], [0.2; 2], 0.02, 3, closed);
        let scene = water()
            .wall(tank.motion(motion))
            .acceleration(|_| [0.0, -9.81]);
        let run = || device.load(build(scene))?.run_until(0.02);
        tried.refused(format!("a wall that moves by {bad}"), of_host, run);
    }
}

fn lesser(tried: &mut Tried, device: &Device) {
    let single = device.clone().as_lesser(false, u64::MAX);
    let no_double = |error: &Error| matches!(error, Error::NoDouble { .. });
    tried.refused("f64 liquid", no_double, || single.load(build(water())));
    tried.refused("f64 rods", no_double, || single.load(build(rods())));
    let record = Record::of(1, |x| vec![x[0]]).expect("lanes");
    tried.refused("f64 points", no_double, || {
        PointKernel::new(&single, "points", &record, Precision::Double)
    });
    tried.refused("f64 pairs", no_double, || {
        PairKernel::new(&single, "pairs", &pair(), (3, 8), Precision::Double)
    });
    assert!(PointKernel::new(&single, "points", &record, Precision::Single).is_ok());
    let large = |error: &Error| matches!(error, Error::TooLarge { .. });
    for most in [0, 1, 100, 1000, 2000] {
        let small = device.clone().as_lesser(true, most);
        tried.refused(format!("{most} bytes"), large, || {
            small.load(build(water()))
        });
    }
}

#[test]
fn a_hundred_bad_inputs_are_errors_and_none_panics() {
    let Some(device) = device("bad inputs") else {
        return;
    };
    let mut tried = Tried::default();
    for all in [names, points, pairs, scenes, runs, lesser] {
        all(&mut tried, &device);
    }
    println!("{} bad inputs", tried.count);
    assert!(tried.wrong.is_empty(), "{}", tried.wrong.join("\n"));
    assert!(tried.count >= 100, "{}", tried.count);
}

/// Drivers are looked for once a process, so one is started that is told of none.
#[test]
fn a_missing_adapter_is_an_error_of_its_own() {
    const ALONE: &str = "MESHFREE_GPU_WITHOUT_DRIVER";
    if std::env::var_os(ALONE).is_some() {
        assert!(Device::list().is_empty());
        let [opened, named] = [Device::open(), Device::named("llvmpipe")];
        for found in [opened, named] {
            assert!(matches!(found, Err(Error::NoAdapter)), "{found:?}");
        }
        let text = Error::NoAdapter.to_string();
        assert!(text.contains("install"), "{text}");
        return;
    }
    let own = std::env::current_exe().expect("this program");
    let ended = Command::new(own)
        .args([
            "bad_inputs::a_missing_adapter_is_an_error_of_its_own",
            "--exact",
        ])
        .env(ALONE, "1")
        .env("VK_DRIVER_FILES", "/nowhere")
        .env("VK_ICD_FILENAMES", "/nowhere")
        .status();
    assert!(ended.expect("the same program").success());
}
