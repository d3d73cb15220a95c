//! All kernels of scenes of every kind in CUDA C, compiled for a card by NVRTC, which needs none.
//! Registers are printed, and nothing may be spilled. Where NVRTC cannot be loaded the tests skip by their names.

mod scenes;

use self::scenes::{bars, bent, blast, kept_blast, layers, plate, tank};
use meshfree::effect::{Damage, FiniteStrainPlasticity, Shifting, TwoPhase};
use meshfree::prelude::*;
use meshfree::term::LaminarViscosity;
use meshfree_gpu::{Language, nvrtc, sources};

/// Hopper.
const CARD: &str = "sm_90";

/// What a kernel takes of a multiprocessor.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Used {
    registers: u32,
    /// Bytes that are stored and loaded since registers do not suffice.
    spilled: u32,
}

/// What the assembler says, if it says all of it.
fn used(log: &str) -> Option<Used> {
    let numbers = |what: &str| -> Vec<u32> {
        let before = log.match_indices(what).map(|(at, _)| &log[..at]);
        let digits = before.filter_map(|own| own.rsplit(|c: char| !c.is_ascii_digit()).next());
        digits.filter_map(|own| own.parse().ok()).collect()
    };
    let spilled = [" bytes spill stores", " bytes spill loads"]
        .map(numbers)
        .concat();
    Some(Used {
        registers: numbers(" registers").into_iter().max()?,
        spilled: (!spilled.is_empty()).then(|| spilled.iter().sum())?,
    })
}

fn compiled(name: &str, text: &str, fused: bool) -> Used {
    let fused = format!("--fmad={fused}");
    let made = nvrtc::compile(text, CARD, &["--ptxas-options=-v", &fused]);
    let made = made.unwrap_or_else(|error| panic!("{name}: {error}\n{text}"));
    assert!(made.code.starts_with(b"\x7fELF"), "{name}: no code");
    used(&made.log).unwrap_or_else(|| panic!("{name}: {}", made.log))
}

/// Whether there is a compiler; a test says that it was skipped.
fn is_there(test: &str) -> bool {
    let found = nvrtc::is_there();
    if !found {
        println!("skipped: {test}: NVRTC cannot be loaded");
    }
    found
}

fn texts<T: Real, const D: usize>(scene: Scene<T, D>) -> Vec<(String, String)> {
    let scene = scene.build().unwrap_or_else(|error| panic!("{error}"));
    sources(scene, Language::Cuda).unwrap_or_else(|error| panic!("{error}"))
}

/// Compiles every kernel of a scene with products that are fused, and with none that is not fused in the text.
fn compiles<T: Real, const D: usize>(test: &str, scene: Scene<T, D>) {
    let mut all = texts(scene);
    let sweeps = all.iter().filter(|own| own.0.starts_with("sweep")).count();
    assert!(
        all.len() > 20 && sweeps > 0,
        "{test}: {} kernels",
        all.len()
    );
    // Some kernels are the same in several places of the program.
    all.sort_by(|a, b| a.1.cmp(&b.1));
    all.dedup_by(|a, b| a.1 == b.1);
    let mut most = 0;
    let mut spilled = Vec::new();
    for (name, text) in &all {
        let both = [false, true].map(|fused| compiled(name, text, fused));
        let registers = both.map(|own| own.registers);
        println!("{test}: {registers:?} registers: {name}");
        most = most.max(registers[0]).max(registers[1]);
        if both.iter().any(|own| own.spilled > 0) {
            spilled.push((name, both));
        }
    }
    println!("{test}: {} kernels, at most {most} registers", all.len());
    assert!(spilled.is_empty(), "{test}: {spilled:?}");
}

/// Scenes of a kind, each with its scalar, its dimensions and its scheme.
macro_rules! compile {
    ($name:ident: $scene:ident, $(($scalar:ty, $dimensions:literal): $scheme:expr),* $(,)?) => {
        #[test]
        fn $name() {
            let name = stringify!($name).replace('_', " ");
            if is_there(&name) { $(
                let own = format!("{name}, {}, {}D", stringify!($scalar), $dimensions);
                compiles(&own, $scene::<$scalar, $dimensions>($scheme));
            )* }
        }
    };
}

// Shifts, flow and failure are computed in f64, and do not run for particles in f32.
compile!(
    viscous_liquids_in_walls: tank,
    (f64, 2): schemes::weakly_compressible().with(Laminar(LaminarViscosity)).with(Shifting::STANDARD),
    (f64, 3): schemes::weakly_compressible().with(Laminar(LaminarViscosity)).with(Shifting::STANDARD),
    (f32, 2): schemes::weakly_compressible().with(Laminar(LaminarViscosity)),
    (f32, 3): schemes::weakly_compressible().with(Laminar(LaminarViscosity)),
);
compile!(
    two_liquids: layers,
    (f64, 3): schemes::weakly_compressible().with(TwoPhase::default()).with(ExpansionMemory),
    (f32, 3): schemes::riemann_liquid().with(ExpansionMemory),
);
compile!(gases: blast, (f64, 3): schemes::gas(), (f32, 3): schemes::gas());
compile!(
    states_that_are_kept: kept_blast,
    (f64, 3): schemes::gas().energy(EnergyForm::Symmetric),
    (f32, 3): schemes::gas().energy(EnergyForm::Symmetric),
);
compile!(impacts: bars, (f64, 3): schemes::impact(), (f32, 3): schemes::impact());
compile!(
    solids_by_present_neighbours: bars,
    (f64, 2): schemes::updated_lagrangian().with(Plasticity).with(Damage),
    (f64, 3): schemes::updated_lagrangian().with(Plasticity).with(Damage),
    (f32, 3): schemes::updated_lagrangian(),
);
compile!(
    solids_by_neighbours_as_built: bent,
    (f64, 2): schemes::total_lagrangian_impact().with(FiniteStrainPlasticity),
    (f64, 3): schemes::total_lagrangian_impact().with(FiniteStrainPlasticity),
    (f32, 3): schemes::total_lagrangian_impact().with(StVenantKirchhoff),
);
compile!(
    plates_in_liquids: plate,
    (f64, 3): schemes::total_lagrangian().with(NeoHookean),
    (f32, 2): schemes::total_lagrangian().with(NeoHookean),
    (f32, 3): schemes::total_lagrangian().with(NeoHookean),
);

#[test]
fn what_is_spilled_or_wrong_is_seen() {
    if !is_there("what is spilled or wrong") {
        return;
    }
    let all = texts(blast::<f64, 3>(schemes::gas()));
    let sweep = all.iter().filter(|own| own.0.starts_with("sweep"));
    let (name, text) = sweep.max_by_key(|own| own.1.len()).expect("a sweep");
    // So many groups on a multiprocessor that threads have 32 registers.
    let crowded = text.replace("__launch_bounds__(64, 1)", "__launch_bounds__(64, 32)");
    let found = compiled(name, &crowded, true);
    assert!(found.registers <= 32 && found.spilled > 0, "{found:?}");
    let wrong = text.replacen("const double", "const number", 1);
    let error = nvrtc::compile(&wrong, CARD, &[]).expect_err("a type that there is not");
    assert!(error.contains("number"), "{error}");
}
