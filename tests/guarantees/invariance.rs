//! What results do not depend on: threads to the bit, instruction sets and precision to rounding.

use crate::common;
use meshfree::boundary::Periodic;
use meshfree::kernel::{Kernel, KernelKind};
use meshfree::material::catalogue;
use meshfree::scalar::Real;
use meshfree::scene::{Body, Scene, Start};
use meshfree::schemes;
use meshfree::simulation::Simulation;
use meshfree::sweep::InstructionSet;

/// Everything that a particle is, to the bit.
fn bits<T: Real, const D: usize>(simulation: &Simulation<T, D>) -> Vec<u64> {
    let mut all = vec![simulation.time().to_bits()];
    for particle in simulation.all() {
        all.extend(particle.position().map(f64::to_bits));
        all.extend(particle.velocity().map(f64::to_bits));
        all.extend([particle.density(), particle.pressure(), particle.energy()].map(f64::to_bits));
    }
    all
}

fn on<R: Send>(threads: usize, work: impl FnOnce() -> R + Send) -> R {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .unwrap();
    pool.install(work)
}

fn rods<T: Real>(spacing: f64, until: f64) -> Simulation<T, 1> {
    let mut simulation = Scene::<T, 1>::new(schemes::impact())
        .body(Body::block("striker", catalogue::copper(), [0.0], [0.01], spacing).velocity([20.0]))
        .body(Body::block(
            "target",
            catalogue::aluminium(),
            [0.01],
            [0.05],
            spacing,
        ))
        .build()
        .unwrap();
    simulation.run_until(until).unwrap();
    simulation
}

/// A periodic block with a swirl in it; enough particles for several chunks and list builds.
fn swirl<T: Real, const D: usize>(set: Option<InstructionSet>, steps: usize) -> Simulation<T, D>
where
    KernelKind: Kernel<D>,
    meshfree::kernel::CubicSpline: Kernel<D>,
{
    let count = [1000.0, 40.0, 14.0][D - 1];
    let k = 2.0 * std::f64::consts::PI / count;
    let block =
        Body::block("block", catalogue::copper(), [0.0; D], [count; D], 1.0).start(|x, start| {
            Start {
                velocity: core::array::from_fn(|d| 150.0 * (k * x[(d + 1) % D]).sin()),
                ..start
            }
        });
    let mut scene = Scene::<T, D>::new(schemes::impact()).body(block);
    for axis in 0..D {
        scene = scene.boundary(Periodic::along(axis, 0.0, count));
    }
    if let Some(set) = set {
        scene = scene.instructions(set);
    }
    let mut simulation = scene.build().unwrap();
    for _ in 0..steps {
        simulation.step().unwrap();
    }
    simulation
}

#[test]
fn one_two_and_three_threads_give_the_same_bits() {
    let rods_on = |threads| on(threads, || bits(&rods::<f64>(1e-4, 2e-6)));
    let one = rods_on(1);
    assert_eq!(one, rods_on(2));
    assert_eq!(one, rods_on(3));
    let sheet_on = |threads| {
        on(threads, || {
            let simulation = swirl::<f64, 2>(None, 60);
            assert!(simulation.list_builds() > 2, "{}", simulation.list_builds());
            bits(&simulation)
        })
    };
    let one = sheet_on(1);
    assert_eq!(one, sheet_on(2));
    assert_eq!(one, sheet_on(3));
    let block_on = |threads| on(threads, || bits(&swirl::<f64, 3>(None, 15)));
    assert_eq!(block_on(1), block_on(2));
}

/// Largest difference of pressures over the largest pressure, and of velocities over the largest.
fn apart<T: Real, U: Real, const D: usize>(a: &Simulation<T, D>, b: &Simulation<U, D>) -> f64 {
    let (mut top, mut off) = ([f64::MIN_POSITIVE; 2], [0.0_f64; 2]);
    for (a, b) in a.all().zip(b.all()) {
        let pairs = [(0, a.pressure(), b.pressure())]
            .into_iter()
            .chain((0..D).map(|d| (1, a.velocity()[d], b.velocity()[d])));
        for (k, a, b) in pairs {
            top[k] = top[k].max(a.abs());
            off[k] = off[k].max((a - b).abs());
        }
    }
    (off[0] / top[0]).max(off[1] / top[1])
}

fn paths_agree<const D: usize>(steps: usize)
where
    KernelKind: Kernel<D>,
    meshfree::kernel::CubicSpline: Kernel<D>,
{
    let baseline = swirl::<f64, D>(Some(InstructionSet::Baseline), steps);
    let again = swirl::<f64, D>(Some(InstructionSet::Baseline), steps);
    assert_eq!(bits(&baseline), bits(&again), "the baseline repeats itself");
    for set in [InstructionSet::Avx2, InstructionSet::Avx512] {
        if !set.available() {
            println!("{set:?} is not here");
            continue;
        }
        let wide = swirl::<f64, D>(Some(set), steps);
        let apart = apart(&baseline, &wide);
        println!("{D}D, {set:?} against the baseline: {apart:.1e}");
        assert!(apart < 1e-9, "{D}D, {set:?}: {apart:.1e}");
        assert_ne!(bits(&wide), bits(&baseline), "{set:?} was not used");
        assert_eq!(bits(&wide), bits(&swirl::<f64, D>(Some(set), steps)));
    }
}

#[test]
fn instruction_sets_agree_to_rounding_and_repeat_themselves() {
    paths_agree::<2>(25);
    paths_agree::<3>(10);
}

#[test]
fn single_precision_keeps_the_plateau() {
    let (spacing, until) = (5e-5, 3.2e-6);
    let (double, single) = (rods::<f64>(spacing, until), rods::<f32>(spacing, until));
    let plateau = 205.46e6;
    let (mut worst, mut count) = (0.0_f64, 0);
    for (a, b) in double.all().zip(single.all()) {
        // On the plateau, and not in a front that moves by a step.
        if (a.pressure() / plateau - 1.0).abs() < 0.005 {
            worst = worst.max((a.pressure() - b.pressure()).abs() / plateau);
            count += 1;
        }
    }
    println!("f32 against f64 on {count} particles of the plateau: {worst:.2e}");
    assert!(count > 100, "{count} particles are no plateau");
    assert!(worst < 2e-3, "{worst:.2e}");
}

#[test]
fn kernels_on_a_lattice_are_a_partition_of_unity() {
    // Cubic splines on their own knots are one exactly; others by how much a lattice is off.
    fn check<const D: usize>(kernel: KernelKind, ratio: f64, bound: f64)
    where
        KernelKind: Kernel<D>,
    {
        let mut random = common::Random(3);
        for _ in 0..20 {
            let x: [f64; D] = random.vector(0.5);
            let mut sum = 0.0;
            let side = 15_i32;
            for k in 0..side.pow(D as u32) {
                let mut rest = k;
                let r2: f64 = (0..D)
                    .map(|d| {
                        let index = rest % side - side / 2;
                        rest /= side;
                        (x[d] - f64::from(index)).powi(2)
                    })
                    .sum();
                sum += Kernel::<D>::shape(&kernel, r2.sqrt() / ratio);
            }
            sum *= Kernel::<D>::normalisation(&kernel) / ratio.powi(D as i32);
            assert!(
                (sum - 1.0).abs() < bound,
                "{kernel} in {D}D at {ratio}: {sum}"
            );
        }
    }
    check::<1>(KernelKind::CubicSpline, 1.0, 1e-14);
    check::<1>(KernelKind::CubicSpline, 2.0, 1e-14);
    check::<1>(KernelKind::QuarticSpline, 1.0, 1e-14);
    check::<1>(KernelKind::QuinticSpline, 2.0, 1e-14);
    for &kernel in KernelKind::ALL {
        check::<1>(kernel, Kernel::<1>::h_over_dx(&kernel), 0.02);
        check::<2>(kernel, Kernel::<2>::h_over_dx(&kernel), 0.02);
        check::<3>(kernel, Kernel::<3>::h_over_dx(&kernel), 0.02);
    }
}

/// Rods with compatible energy and limited viscosity, whose rates belong to predicted velocities.
#[test]
fn an_evaluation_between_steps_changes_nothing_of_what_comes() {
    let after = |asks: bool| {
        let mut rods = rods::<f64>(2e-4, 2e-7);
        for _ in 0..20 {
            if asks {
                rods.evaluate().unwrap();
            }
            rods.step().unwrap();
        }
        bits(&rods)
    };
    assert_eq!(after(true), after(false));
}
