//! Off means off: where an effect is absent, results, bytes, fields, stages and counted work are those of a scheme written
//! without it, for every effect of the crate; an effect of zero strength changes no bit of the state.

use meshfree::effect::{Effect, HourglassControl, NeoHookean, NoWalls, Setting};
use meshfree::kernel::WendlandC2;
use meshfree::prelude::*;
use meshfree::simulation::Work;
use meshfree::term::Fourtakas;
use meshfree::term::viscosity::Inviscid;
use std::fmt::Debug;
use std::marker::PhantomData;
use std::process::Command;

/// An effect that is not there: an entry of a list, by type, with nothing of what `A` is.
#[derive(Clone, Debug)]
struct Absent<A>(PhantomData<A>);

impl<const D: usize, A: Clone + Debug + Send + Sync + 'static> Effect<D> for Absent<A> {
    type Terms = ();
    fn terms(&self, _setting: &Setting) {}
}

fn absent<A>(_effect: &A) -> Absent<A> {
    Absent(PhantomData)
}

/// A run of a few steps: what the scheme is, what it counted, and every number of the state.
#[derive(Clone, Debug, PartialEq)]
struct Run {
    program: String,
    carries: Fields,
    counts: [u64; 4],
    bytes: usize,
    bits: Vec<u64>,
}

fn bits(simulation: &Simulation<f64, 1>) -> Vec<u64> {
    let particles = simulation.all().flat_map(|particle| {
        let known = [
            Field::DENSITY,
            Field::PRESSURE,
            Field::ENERGY,
            Field::SOUND_SPEED,
        ];
        let others = known.map(|field| particle.scalar(field).unwrap_or(0.0));
        let moves = [particle.position()[0], particle.velocity()[0]];
        moves.into_iter().chain(others).map(f64::to_bits)
    });
    particles.chain([simulation.time().to_bits()]).collect()
}

/// A bar that rings at both ends, or a column of liquid.
fn bar(scheme: Scheme<f64, 1>, material: Material<f64>, count: usize) -> Simulation<f64, 1> {
    let (_, c) = material.state(material.reference_density(), 0.0);
    let body = Body::block("bar", material, [0.0], [1e-3 * count as f64], 1e-3);
    let body = body.start(move |x, own| meshfree::scene::Start {
        velocity: [1e-3 * c * (40.0 * x[0]).sin()],
        ..own
    });
    Scene::new(scheme).body(body).build().expect("a scene")
}

fn run(scheme: Scheme<f64, 1>, material: Material<f64>) -> Run {
    let (program, carries) = (scheme.step_program(), scheme.fields());
    let mut simulation = bar(scheme, material, 60);
    for _ in 0..12 {
        simulation.step().expect("a step");
    }
    let Work {
        steps,
        evaluations,
        list_builds,
        pairs,
        bytes,
        ..
    } = simulation.work();
    Run {
        program,
        carries,
        counts: [steps, evaluations, list_builds, pairs],
        bytes,
        bits: bits(&simulation),
    }
}

fn liquid() -> Material<f64> {
    catalogue::weakly_compressible_water(10.0)
}

/// Total Lagrangian without hourglass control, so that there is a scheme to add it to.
fn total() -> SchemeBuilder<WendlandC2, Inviscid, NoWalls, impl Effects<1>> {
    SchemeBuilder::total_lagrangian(WendlandC2, Inviscid)
        .h_over_dx(0.8)
        .with(NeoHookean)
}

#[test]
fn an_absent_effect_changes_no_bit_no_byte_and_no_count() {
    let steel = catalogue::steel_4340::<f64>;
    let bases = [
        run(schemes::weakly_compressible().compose(), liquid()),
        run(schemes::impact_by_continuity().compose(), steel()),
        run(total().compose(), steel()),
    ];
    assert!(bases.iter().all(|base| base.counts[3] > 0));
    let mut tried = 0;
    let mut same = |name: &str, of: usize, run: Run| {
        assert_eq!(run, bases[of], "{name}");
        tried += 1;
    };
    macro_rules! each {
        (liquid [$($a:expr),*] solid [$($b:expr),*] total_lagrangian [$($c:expr),*] sheet [$($d:expr),*] rod [$($e:expr),*]) => {
            $(same(stringify!($a), 0, run(schemes::weakly_compressible().with(absent(&$a)).compose(), liquid()));)*
            $(same(stringify!($b), 1, run(schemes::impact_by_continuity().with(absent(&$b)).compose(), steel()));)*
            $(same(stringify!($c), 2, run(total().with(absent(&$c)).compose(), steel()));)*
            $(same(stringify!($d), 2, run(total().with(absent(&$d)).compose(), steel()));)*
            $(same(stringify!($e), 1, run(schemes::impact_by_continuity().with(absent(&$e)).compose(), steel()));)*
        };
    }
    meshfree::for_each_effect!(each);
    assert!(tried > 25, "{tried}");
}

/// What has a strength does nothing at zero: the state has the same bits, whatever the scheme carries and sums beside.
#[test]
fn an_effect_of_zero_strength_changes_no_bit() {
    let base = run(schemes::weakly_compressible().compose(), liquid());
    let damped = schemes::weakly_compressible().with(AcousticDamping { strength: 0.0 });
    assert_eq!(run(damped.compose(), liquid()).bits, base.bits);
    let held = schemes::weakly_compressible().with(VolumeConsistency { strength: 0.0 });
    assert_eq!(run(held.compose(), liquid()).bits, base.bits);
    // And with a strength it changes some, or the comparison says nothing.
    let damped = schemes::weakly_compressible().with(AcousticDamping { strength: 0.1 });
    assert_ne!(run(damped.compose(), liquid()).bits, base.bits);

    let diffusive = |delta| {
        let none = schemes::weakly_compressible().density_diffusion(meshfree::term::Nothing);
        match delta {
            None => none.compose(),
            Some(delta) => none.density_diffusion(Fourtakas { delta }).compose(),
        }
    };
    let without = run(diffusive(None), liquid());
    assert_eq!(run(diffusive(Some(0.0)), liquid()).bits, without.bits);
    assert_ne!(without.bits, base.bits);

    let steel = catalogue::steel_4340::<f64>;
    let without = run(total().compose(), steel());
    let controlled = |strength| {
        run(
            total().with(HourglassControl { strength }).compose(),
            steel(),
        )
    };
    assert_eq!(controlled(0.0).bits, without.bits);
    assert_ne!(controlled(0.5).bits, without.bits);
}

/// How the parts of the count of instructions tell each other what to do.
const ASKED: &str = "MESHFREE_STEPS_TO_COUNT";

/// Steps that [`instructions_are_those_of_a_scheme_without`] counts; alone it does nothing.
#[test]
fn steps_to_count() {
    let Ok(asked) = std::env::var(ASKED) else {
        return;
    };
    let (which, steps) = asked.split_once(' ').expect("a scheme and a number");
    let steps: u64 = steps.parse().expect("a number");
    let diffusion = DensityDiffusion(Fourtakas::default());
    let steel = catalogue::steel_4340::<f64>;
    let none = || schemes::weakly_compressible().density_diffusion(meshfree::term::Nothing);
    let (scheme, material) = match which {
        "liquid" => (none().compose(), liquid()),
        "liquid-absent" => (none().with(absent(&diffusion)).compose(), liquid()),
        "liquid-there" => (schemes::weakly_compressible().compose(), liquid()),
        "total" => (total().compose(), steel()),
        "total-absent" => (
            total().with(absent(&HourglassControl::default())).compose(),
            steel(),
        ),
        _ => (total().with(HourglassControl::default()).compose(), steel()),
    };
    let mut simulation = bar(scheme, material, 2000);
    for _ in 0..steps {
        simulation.step().expect("a step");
    }
    println!("pairs {}", simulation.work().pairs);
}

/// Instructions a pair, counted by callgrind, between a run of some steps and one of twice as many.
fn instructions(which: &str) -> Option<f64> {
    let count = |steps: u64| {
        let output = Command::new("valgrind")
            .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
            .arg(std::env::current_exe().ok()?)
            .args([
                "absent_effects::steps_to_count",
                "--nocapture",
                "--test-threads=1",
            ])
            .env(ASKED, format!("{which} {steps}"))
            .env("RAYON_NUM_THREADS", "1")
            .output()
            .ok()?;
        let after = |text: &[u8], word: &str| -> Option<f64> {
            let text = String::from_utf8_lossy(text).into_owned();
            let rest = text.split_once(word)?.1.trim_start().to_owned();
            rest.split_whitespace().next()?.parse().ok()
        };
        let pairs = after(&output.stdout, "pairs ")?;
        Some((after(&output.stderr, "Collected :")?, pairs))
    };
    let [(few, pairs_few), (many, pairs_many)] = [count(15)?, count(30)?];
    Some((many - few) / (pairs_many - pairs_few))
}

/// Takes about half a minute; skipped by name without valgrind.
#[test]
#[ignore = "counts instructions under valgrind, half a minute"]
fn instructions_are_those_of_a_scheme_without() {
    if Command::new("valgrind").arg("--version").output().is_err() {
        println!("skipped: the machine has no valgrind");
        return;
    }
    for base in ["liquid", "total"] {
        let each = ["", "-absent", "-there"].map(|what| instructions(&format!("{base}{what}")));
        let [Some(without), Some(absent), Some(there)] = each else {
            panic!("valgrind gave no count for {base}: {each:?}");
        };
        println!("{base}: {without:.2} instructions a pair, absent {absent:.2}, there {there:.2}");
        assert!((absent / without - 1.0).abs() < 0.01, "{base}");
        assert!(there > 1.02 * without, "{base}: the count sees no effect");
    }
}
