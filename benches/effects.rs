//! The price of every effect, alone and together: time a pair and a step, bytes a particle, and the step, each against the scheme
//! without it; and pair effects against loops by hand (`throughput/by_hand.rs`).
//!
//! `cargo bench --bench effects [-- --quick | --by-hand]`. The two of a row take turns on one thread; a time is the least over steps, which
//! what else a machine does changes least, and still by tens of per cent where it is busy.

#[path = "throughput/by_hand.rs"]
mod by_hand;
#[path = "throughput/by_hand/continuity.rs"]
mod continuity_by_hand;
#[path = "throughput/by_hand/corrected.rs"]
mod corrected_by_hand;
#[path = "throughput/lattice.rs"]
mod lattice;
#[path = "throughput/by_hand/solids.rs"]
mod solids_by_hand;
#[path = "throughput/by_hand/viscosities.rs"]
mod viscosities_by_hand;
#[path = "throughput/by_hand/walls.rs"]
mod walls_by_hand;

use by_hand::forces::{
    BY_VELOCITY, CENTRAL, CONDUCTED, CONDUCTION, ENERGY, Forces, LAMINAR, PHASES, SHARE, SHARPNESS,
    TENSION, VISCOSITY, viscosity,
};
use by_hand::{norm, over_shape_at_spacing, row};
use continuity_by_hand::{
    BY_RIEMANN, COMPRESSION, CONSISTENCY, CROWDING, Continuity, DELTA, DIFFUSION, FIRST_MOMENT,
    OF_BENT, OF_DENSITY, PAIRING, REPULSION, SHIFTED, SHIFTING, SLOPE, SUMMED, WITHIN,
};
use meshfree::effect::{
    ArtificialConduction, ArtificialPressure, ArtificialStress, ConductionSignal, HourglassControl,
    HourglassFree, Hypoelastic, NeoHookean, PairingControl, Plasticity, TwoPhase, WithinPhase,
    parts::{Crowding, NearPairs, ShiftedContinuity, TensionRepulsion},
};
use meshfree::kernel::WendlandC2;
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::term::viscosity::{Inviscid, MonaghanGingold};
use meshfree::term::{
    Antuono, CentralViscosity, Fourtakas, InternalEnergy, KernelSum, LaminarViscosity, Molteni,
    PressureForce, RiemannDiffusion,
    parts::{Compression, ConcentrationGradient, KernelMoment, SlopeInH, Unity},
};
use std::time::Instant;

/// How much is measured.
#[derive(Clone, Copy)]
struct Size {
    side: usize,
    steps: usize,
}

/// A free block of `side`³ particles a millimetre apart that rings.
fn block(scheme: Scheme<f64, 3>, material: Material<f64>, side: usize) -> Simulation<f64, 3> {
    let size = 1e-3 * side as f64;
    let (_, c) = material.state(material.reference_density(), 0.0);
    let rings = move |x: [f64; 3], own: Start<3>| Start {
        velocity: [0, 1, 2].map(|d| 1e-4 * c * (6.0 * x[d] / size).sin()),
        ..own
    };
    let body = Body::block("block", material, [0.0; 3], [size; 3], 1e-3).start(rings);
    Scene::new(scheme).body(body).build().expect("a scene")
}

fn step(simulation: &mut Simulation<f64, 3>) -> f64 {
    let start = Instant::now();
    simulation.step().expect("a step");
    start.elapsed().as_secs_f64()
}

/// A scheme, its name and what its bodies are made of.
struct Case {
    name: &'static str,
    scheme: Scheme<f64, 3>,
}

/// A row for each scheme with an effect, against the base.
fn rows(
    base: impl Fn() -> Scheme<f64, 3>,
    material: fn() -> Material<f64>,
    with: Vec<Case>,
    size: Size,
) {
    let name = base().name().to_owned();
    let mut first = true;
    for Case {
        name: effect,
        scheme,
    } in with
    {
        let mut without = block(base(), material(), size.side);
        let mut with = block(scheme, material(), size.side);
        for _ in 0..2 {
            step(&mut without);
            step(&mut with);
        }
        let before = [&without, &with].map(|own| own.work());
        let mut times = [Vec::new(), Vec::new()];
        for _ in 0..size.steps {
            times[0].push(step(&mut without));
            times[1].push(step(&mut with));
        }
        let after = [&without, &with].map(|own| own.work());
        let count = without.particles() as f64;
        let pairs = [0, 1].map(|k| (after[k].pairs - before[k].pairs) as f64 / size.steps as f64);
        let [base_time, time] = times.map(|own| own.into_iter().fold(f64::INFINITY, f64::min));
        let ratio = time / base_time;
        let steps = [&without, &with].map(|own| own.last_vote().map_or(0.0, |vote| vote.step));
        if first {
            println!(
                "| **{name}** | {:.0} | 1 | {:.2} | | {:.0} | 1 |",
                base_time / count * 1e9,
                base_time / pairs[0] * 1e9,
                after[0].bytes as f64 / count,
            );
            first = false;
        }
        println!(
            "| {effect} | {:.0} | {ratio:.2} | {:.2} | {:.2} | {:+.0} | {:.2} |",
            time / count * 1e9,
            time / pairs[1] * 1e9,
            pairs[1] / pairs[0],
            (after[1].bytes as f64 - after[0].bytes as f64) / count,
            steps[1] / steps[0],
        );
    }
}

fn liquids(size: Size) {
    let base = || {
        let viscosity = MonaghanGingold {
            alpha: 0.02,
            beta: 0.0,
        };
        SchemeBuilder::liquid(WendlandC2, viscosity)
            .named("liquid")
            .h_over_dx(1.3)
    };
    let case = |name, scheme: Scheme<f64, 3>| Case { name, scheme };
    let diffusion = || DensityDiffusion(Fourtakas::default());
    let cases = vec![
        case(
            "without artificial viscosity",
            base().with_viscosity(Inviscid).compose(),
        ),
        case(
            "density diffusion (Fourtakas)",
            base().with(diffusion()).compose(),
        ),
        case(
            "laminar viscosity",
            base().with(Laminar(LaminarViscosity)).compose(),
        ),
        case(
            "the same, by shear rate",
            base()
                .with(Laminar(LaminarViscosity))
                .with(GeneralisedNewtonian)
                .compose(),
        ),
        case("shifting", base().with(Shifting::STANDARD).compose()),
        case(
            "volume consistency",
            base().with(VolumeConsistency { strength: 0.05 }).compose(),
        ),
        case(
            "acoustic damping, λ = 0.3",
            base().with(AcousticDamping { strength: 0.3 }).compose(),
        ),
        case(
            "artificial pressure",
            base().with(ArtificialPressure::default()).compose(),
        ),
        case(
            "pairing control",
            base().with(PairingControl::default()).compose(),
        ),
        case(
            "all of these together",
            base()
                .with(diffusion())
                .with(Laminar(LaminarViscosity))
                .with(Shifting::STANDARD)
                .with(VolumeConsistency { strength: 0.05 })
                .with(AcousticDamping { strength: 0.3 })
                .with(ArtificialPressure::default())
                .with(PairingControl::default())
                .compose(),
        ),
    ];
    let water = || catalogue::weakly_compressible_water(10.0);
    rows(|| base().compose(), water, cases, size);
}

fn solids(size: Size) {
    let base = || schemes::impact_by_continuity().named("updated Lagrangian");
    let case = |name, scheme: Scheme<f64, 3>| Case { name, scheme };
    let cases = vec![
        case("elastic (Hypoelastic)", base().with(Hypoelastic).compose()),
        case(
            "elastic and plastic",
            base().with(Hypoelastic).with(Plasticity).compose(),
        ),
        case(
            "elastic, artificial stress",
            base()
                .with(Hypoelastic)
                .with(ArtificialStress::default())
                .compose(),
        ),
        case(
            "elastic, hourglass-free",
            base()
                .with(Hypoelastic)
                .with(HourglassFree::default())
                .compose(),
        ),
        case(
            "all of these together",
            base()
                .with(Hypoelastic)
                .with(Plasticity)
                .with(ArtificialStress::default())
                .with(HourglassFree::default())
                .compose(),
        ),
    ];
    rows(|| base().compose(), catalogue::steel_4340, cases, size);
    let total = || {
        SchemeBuilder::total_lagrangian(WendlandC2, Inviscid)
            .named("total Lagrangian, neo-Hookean")
            .h_over_dx(0.8)
            .with(NeoHookean)
    };
    let cases = vec![case(
        "hourglass control",
        total().with(HourglassControl::default()).compose(),
    )];
    rows(|| total().compose(), catalogue::steel_4340, cases, size);
}

/// Pair terms of effects, alone and together, over loops that are written out for just these.
fn against_by_hand(side: usize, turns: usize) {
    if by_hand::skipped() {
        return;
    }
    println!("effects composed over written out by hand, {side}³ particles, f64, one thread");
    // One over hᴰ W of the spacing.
    let at_spacing = over_shape_at_spacing() / norm();
    let tension = || TensionRepulsion {
        of: ArtificialPressure {
            share: SHARE,
            exponent: 4,
        },
        over_kernel_at_spacing: at_spacing,
    };
    let force = PressureForce;
    row("pressure", (force,), Forces::<0>, side, turns);
    by_hand::forces::with_viscosity(side, turns);
    let terms = (force, LaminarViscosity);
    row("laminar viscosity", terms, Forces::<LAMINAR>, side, turns);
    let terms = (force, tension());
    row("artificial pressure", terms, Forces::<TENSION>, side, turns);
    let terms = (force, CentralViscosity);
    row("central viscosity", terms, Forces::<CENTRAL>, side, turns);
    let phases = TwoPhase {
        sharpness: SHARPNESS,
    };
    row("two phases", (force, phases), Forces::<PHASES>, side, turns);
    let terms = (force, viscosity(), LaminarViscosity, tension());
    let by_hand = Forces::<{ VISCOSITY | LAMINAR | TENSION }>;
    row("all four", terms, by_hand, side, turns);
    let conducted = |signal| ArtificialConduction {
        strength: CONDUCTION,
        signal,
    };
    let conduction = || conducted(ConductionSignal::Pressure);
    let terms = (force, InternalEnergy);
    row("gas: energy", terms, Forces::<ENERGY>, side, turns);
    let terms = (force, InternalEnergy, conduction());
    let by_hand = Forces::<{ ENERGY | CONDUCTED }>;
    row("gas: conduction", terms, by_hand, side, turns);
    let terms = (force, InternalEnergy, conducted(ConductionSignal::Velocity));
    let by_hand = Forces::<{ ENERGY | BY_VELOCITY }>;
    row("gas: conduction by velocity", terms, by_hand, side, turns);
    let terms = (force, InternalEnergy, viscosity(), conduction());
    let by_hand = Forces::<{ ENERGY | CONDUCTED | VISCOSITY }>;
    row("gas: conduction, viscosity", terms, by_hand, side, turns);
    viscosities_by_hand::table(side, turns);

    let diffusion = || Fourtakas { delta: DELTA };
    let shifting = || ConcentrationGradient {
        repulsion: REPULSION,
        at_spacing: 1.0 / at_spacing,
    };
    let pairing = || NearPairs {
        over_kernel_at_spacing: at_spacing,
    };
    let by_hand = Continuity::<COMPRESSION>;
    row("compression", (Compression,), by_hand, side, turns);
    let terms = (Compression, diffusion());
    let by_hand = Continuity::<{ COMPRESSION | DIFFUSION }>;
    row("density diffusion", terms, by_hand, side, turns);
    let within = (Compression, WithinPhase(diffusion()));
    let by_hand = Continuity::<{ COMPRESSION | WITHIN }>;
    row("diffusion within a phase", within, by_hand, side, turns);
    let terms = (Compression, Molteni { delta: DELTA });
    let by_hand = Continuity::<{ COMPRESSION | OF_DENSITY }>;
    row("diffusion, Molteni", terms, by_hand, side, turns);
    let terms = (Compression, Antuono { delta: DELTA });
    let by_hand = Continuity::<{ COMPRESSION | OF_BENT }>;
    row("diffusion, Antuono", terms, by_hand, side, turns);
    let terms = (Compression, RiemannDiffusion);
    let by_hand = Continuity::<{ COMPRESSION | BY_RIEMANN }>;
    row("diffusion, Riemann", terms, by_hand, side, turns);
    let terms = (Compression, shifting());
    let by_hand = Continuity::<{ COMPRESSION | SHIFTING }>;
    row("shifting", terms, by_hand, side, turns);
    let terms = (Compression, pairing());
    let by_hand = Continuity::<{ COMPRESSION | PAIRING }>;
    row("pairing control", terms, by_hand, side, turns);
    let terms = (Compression, Unity);
    let by_hand = Continuity::<{ COMPRESSION | CONSISTENCY }>;
    row("volume consistency", terms, by_hand, side, turns);
    let terms = (Compression, diffusion(), shifting(), Unity, pairing());
    let by_hand = Continuity::<{ COMPRESSION | DIFFUSION | SHIFTING | CONSISTENCY | PAIRING }>;
    row("all five", terms, by_hand, side, turns);
    let crowding = Crowding {
        over_kernel_at_spacing: at_spacing,
    };
    let by_hand = Continuity::<CROWDING>;
    row("crowding", (crowding,), by_hand, side, turns);
    let terms = (Compression, ShiftedContinuity);
    let by_hand = Continuity::<{ COMPRESSION | SHIFTED }>;
    row("consistent shifting", terms, by_hand, side, turns);
    let by_hand = Continuity::<SUMMED>;
    row("kernel sum", (KernelSum,), by_hand, side, turns);
    let terms = (KernelSum, Unity);
    let by_hand = Continuity::<{ SUMMED | CONSISTENCY }>;
    row("kernel sum, unity", terms, by_hand, side, turns);
    let terms = (KernelSum, Unity, KernelMoment);
    let by_hand = Continuity::<{ SUMMED | CONSISTENCY | FIRST_MOMENT }>;
    row("kernel sum, unity, moment", terms, by_hand, side, turns);
    let by_hand = Continuity::<{ SUMMED | SLOPE }>;
    row(
        "kernel sum, slope in h",
        (KernelSum, SlopeInH),
        by_hand,
        side,
        turns,
    );

    walls_by_hand::table(side, turns);
    corrected_by_hand::table(side, turns);
    solids_by_hand::table(at_spacing, side, turns);
}

fn main() {
    // `cargo test` runs benches without `--bench`: then small and once.
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let given = |name: &str| arguments.iter().any(|a| a == name);
    let size = match (given("--bench"), given("--quick")) {
        (false, _) => Size { side: 6, steps: 4 },
        (true, true) => Size {
            side: 16,
            steps: 12,
        },
        (true, false) => Size {
            side: 24,
            steps: 40,
        },
    };
    let turns = if given("--bench") { 60 } else { 5 };
    against_by_hand(2 * (size.side / 2), turns);
    if given("--by-hand") {
        return;
    }
    println!(
        "| a free block of {0}³, one thread | ns a step and particle | time, ratio | ns a pair | pairs | bytes a particle | step |",
        size.side
    );
    println!("|---|---:|---:|---:|---:|---:|---:|");
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .expect("a pool");
    pool.install(|| {
        liquids(size);
        solids(size);
    });
}
