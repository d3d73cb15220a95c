//! What forces between particles conserve, on random particle sets, materials, kernels and density
//! forms, in one, two and three dimensions.

use crate::common::{self, AnyKernel, Random};
use meshfree::integrator::KickDriftKick;
use meshfree::kernel::{Kernel, KernelKind};
use meshfree::scene::{Body, Scene};
use meshfree::scheme::{DensityForm, EnergyForm, Scheme, SchemeBuilder};
use meshfree::simulation::{ParticleView, Simulation};
use meshfree::sweep::Interaction;
use meshfree::term::MidpointReconstruction;
use meshfree::term::viscosity::LimitedMonaghanGingold;
use proptest::prelude::*;

/// A random scene: two jittered lattices that lie against each other and approach.
#[derive(Clone, Debug)]
struct Case {
    seed: u64,
    kernel: KernelKind,
    form: DensityForm,
    materials: [usize; 2],
    interaction: Interaction,
    curvature: bool,
    energy: EnergyForm,
}

fn case() -> impl Strategy<Value = Case> {
    let interactions = [Interaction::Bonded, Interaction::Unilateral];
    (
        any::<u64>(),
        proptest::sample::select(KernelKind::ALL),
        proptest::sample::select(&DensityForm::ALL[..]),
        [0..5_usize, 0..5_usize],
        proptest::sample::select(interactions.to_vec()),
        any::<bool>(),
    )
        .prop_map(
            |(seed, kernel, form, materials, interaction, curvature)| Case {
                seed,
                kernel,
                form,
                materials,
                interaction,
                curvature,
                energy: EnergyForm::Compatible,
            },
        )
}

/// Spacing \[m\].
const DX: f64 = 1e-3;
/// Particles along a side of a body in 1D, 2D and 3D.
const SIDES: [usize; 3] = [24, 6, 4];

/// How a scene is moved before it starts: turned, and carried along.
struct Frame<const D: usize> {
    rotation: [[f64; D]; D],
    velocity: [f64; D],
}

impl<const D: usize> Frame<D> {
    fn rest() -> Self {
        Self {
            rotation: core::array::from_fn(|a| {
                core::array::from_fn(|b| f64::from(u8::from(a == b)))
            }),
            velocity: [0.0; D],
        }
    }
}

fn scheme<const D: usize>(case: &Case) -> Scheme<f64, D>
where
    KernelKind: Kernel<D>,
{
    let builder = SchemeBuilder::new(AnyKernel(case.kernel), LimitedMonaghanGingold::default())
        .density(case.form)
        .energy(case.energy);
    if case.curvature {
        builder.with(MidpointReconstruction::STANDARD).compose()
    } else {
        builder.compose()
    }
}

fn scene<const D: usize>(case: &Case, frame: &Frame<D>, scheme: Scheme<f64, D>) -> Scene<f64, D> {
    let mut random = Random(case.seed);
    let side = SIDES[D - 1];
    let mut body = |name: &str, k: usize, approach: f64| {
        let mut corner = [0.0; D];
        corner[0] = (k * side) as f64;
        let points = common::jittered(corner, [side; D], 0.15, &mut random);
        let points: Vec<_> = points
            .iter()
            .map(|x| common::turn(&frame.rotation, x.map(|x| x * DX)))
            .collect();
        let material = common::material(case.materials[k]);
        let mut body = Body::points_of(name, material, points.clone(), DX);
        let velocities: Vec<[f64; D]> = points
            .iter()
            .map(|_| {
                let mut v = random.vector::<D>(2.0);
                v[0] += approach;
                let v = common::turn(&frame.rotation, v);
                core::array::from_fn(|d| v[d] + frame.velocity[d])
            })
            .collect();
        let next = std::cell::Cell::new(0);
        body = body.start(|_, start| {
            let velocity = velocities[next.replace(next.get() + 1)];
            meshfree::scene::Start { velocity, ..start }
        });
        body
    };
    let (first, second) = (body("first", 0, 20.0), body("second", 1, -20.0));
    Scene::new(scheme)
        .body(first)
        .body(second)
        .between("first", "second", case.interaction)
        .integrator(KickDriftKick)
        // Thin, so that particles change places in memory during the run.
        .skin(0.002)
}

fn run<const D: usize>(case: &Case, frame: &Frame<D>, steps: usize) -> Simulation<f64, D>
where
    KernelKind: Kernel<D>,
{
    let mut simulation = scene(case, frame, scheme(case)).build().unwrap();
    for _ in 0..steps {
        simulation.step().unwrap();
    }
    simulation
}

fn conserves<const D: usize>(case: &Case)
where
    KernelKind: Kernel<D>,
{
    let before = run::<D>(case, &Frame::rest(), 0);
    let after = run::<D>(case, &Frame::rest(), 30);
    let moved = after
        .all()
        .zip(before.all())
        .any(|(a, b)| a.velocity() != b.velocity());
    assert!(moved && after.list_builds() > 1, "nothing happened");
    assert_eq!(after.ledger().whole.mass, before.ledger().whole.mass);
    let ((p, scale), (p0, _)) = (common::momentum(&after), common::momentum(&before));
    for d in 0..D {
        common::assert_close(p[d], p0[d], 1e-13 * scale, "momentum");
    }
    let (turning, scale) = common::angular_momentum(&after);
    for (now, then) in turning.iter().zip(common::angular_momentum(&before).0) {
        common::assert_close(*now, then, 1e-13 * scale, "angular momentum");
    }
    let (e, e0) = (after.ledger().whole, before.ledger().whole);
    let scale = e.kinetic.abs().max(e0.kinetic);
    common::assert_close(e.total_energy(), e0.total_energy(), 1e-12 * scale, "energy");
    let (there, back) = (
        after.force_between(0, 1).unwrap(),
        after.force_between(1, 0).unwrap(),
    );
    // Forces of pairs cancel, those of pressure and of viscosity; together they are of the order of all that accelerates.
    let force = |p: ParticleView<'_, f64, D>| {
        let square: f64 = p.acceleration().iter().map(|a| a * a).sum();
        p.mass() * square.sqrt()
    };
    let strength: f64 = after.all().map(force).sum();
    for d in 0..D {
        common::assert_close(there[d], -back[d], 1e-15 * strength, "action and reaction");
    }
}

/// Pressures and velocities of one run seen from the frame of another.
fn same_seen_from_both<const D: usize>(case: &Case, frame: &Frame<D>, tolerance: f64)
where
    KernelKind: Kernel<D>,
{
    let still = run::<D>(case, &Frame::rest(), 12);
    let moved = run::<D>(case, frame, 12);
    let time = still.time();
    common::assert_close(moved.time(), time, 1e-9 * time, "time");
    let top = still.all().fold(0.0_f64, |m, p| m.max(p.pressure().abs()));
    // Rounding of a density is that of a pressure over the stiffness: it shows where the form of
    // density hides the compression, and pressures are nothing beside it.
    let stiffness = case.materials.map(|k| {
        let material = common::material(k);
        material.impedance().powi(2) / material.reference_density()
    });
    let rounding = tolerance * top + 1e-14 * stiffness[0].max(stiffness[1]);
    for (a, b) in still.all().zip(moved.all()) {
        common::assert_close(b.pressure(), a.pressure(), rounding, "pressure");
        let (x, v) = (
            common::turn(&frame.rotation, a.position()),
            common::turn(&frame.rotation, a.velocity()),
        );
        for d in 0..D {
            let carried = x[d] + frame.velocity[d] * time;
            common::assert_close(
                b.velocity()[d] - frame.velocity[d],
                v[d],
                tolerance * 20.0,
                "velocity",
            );
            common::assert_close(b.position()[d], carried, tolerance * DX, "position");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn rows_conserve_mass_momentum_and_energy(case in case()) {
        conserves::<1>(&case);
    }
    #[test]
    fn rows_do_not_feel_a_common_velocity(case in case(), u in -200.0..200.0_f64) {
        let frame = Frame { velocity: [u], ..Frame::rest() };
        same_seen_from_both(&case, &frame, 1e-8);
    }
    #[test]
    fn rows_do_not_know_left_from_right(case in case()) {
        same_seen_from_both(&case, &Frame { rotation: [[-1.0]], velocity: [0.0] }, 1e-8);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn sheets_conserve_mass_both_momenta_and_energy(case in case()) {
        conserves::<2>(&case);
    }
    #[test]
    fn sheets_do_not_feel_a_common_velocity(case in case(), u in [-200.0..200.0_f64, -200.0..200.0]) {
        let frame = Frame { velocity: u, ..Frame::rest() };
        same_seen_from_both(&case, &frame, 1e-8);
    }
    #[test]
    fn sheets_have_no_preferred_direction(case in case(), seed in any::<u64>()) {
        let rotation = common::rotation(&mut Random(seed));
        same_seen_from_both::<2>(&case, &Frame { rotation, velocity: [0.0; 2] }, 1e-8);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 10, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn solids_conserve_mass_both_momenta_and_energy(case in case()) {
        conserves::<3>(&case);
    }
    #[test]
    fn solids_have_no_preferred_frame(case in case(), seed in any::<u64>(), u in [-200.0..200.0_f64, -200.0..200.0, -200.0..200.0]) {
        let rotation = common::rotation(&mut Random(seed));
        same_seen_from_both::<3>(&case, &Frame { rotation, velocity: u }, 1e-8);
    }
}

/// Energy error of the symmetric form at the end of a fixed time, with n equal steps.
fn symmetric_drift(form: DensityForm, steps: usize) -> f64 {
    let case = Case {
        seed: 7,
        kernel: KernelKind::CubicSpline,
        form,
        materials: [0, 2],
        interaction: Interaction::Bonded,
        curvature: false,
        energy: EnergyForm::Symmetric,
    };
    let end = 4e-7;
    // The same viscosity without its limiter, whose corners would hide the order.
    let scheme = SchemeBuilder::new(AnyKernel(case.kernel), meshfree::term::viscosity::Inviscid)
        .density(form)
        .energy(EnergyForm::Symmetric)
        .compose();
    let mut simulation = scene::<1>(&case, &Frame::rest(), scheme)
        .steps(|control| meshfree::simulation::StepControl {
            fixed: Some(end / steps as f64),
            ..control
        })
        .build()
        .unwrap();
    let before = simulation.ledger().whole;
    for _ in 0..steps {
        simulation.step().unwrap();
    }
    let after = simulation.ledger().whole;
    ((after.total_energy() - before.total_energy()) / before.kinetic).abs()
}

#[test]
fn the_symmetric_form_loses_energy_with_the_second_order_of_the_step() {
    for form in [
        DensityForm::Summation,
        DensityForm::NumberDensity,
        DensityForm::Continuity,
    ] {
        let steps = [40, 80, 160, 320];
        let errors = steps.map(|n| symmetric_drift(form, n));
        let widths = steps.map(|n| 1.0 / n as f64);
        let order = meshfree::study::norms::observed_order(&widths, &errors)
            .unwrap()
            .order;
        println!("{form}: {errors:?}, order {order:.3}");
        assert!(
            (1.8..2.4).contains(&order),
            "{form}: {errors:?}, order {order}"
        );
    }
}
