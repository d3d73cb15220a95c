//! Total-Lagrangian solids against theory: patch test, waves, bending, flow under shear, and what is conserved.
//! Two dimensions are plane strain.

use approx::assert_relative_eq;
use meshfree::coupling::{CoupledParticle, Coupling};
use meshfree::effect::{
    FiniteStrainPlasticity, HourglassControl, NeoHookean, Plasticity, StVenantKirchhoff,
    TotalLagrangian,
};
use meshfree::material::eos::Linear;
use meshfree::material::strength::LinearHardening;
use meshfree::particles::Field;
use meshfree::prelude::*;
use meshfree::scheme::Start;
use meshfree::simulation::ParticleView;
use meshfree::study::free_beam::FreeBeam;
use meshfree::term::TermDoc;
use std::f64::consts::TAU;

const RHO: f64 = 1000.0;
const YOUNGS: f64 = 2e6;
const POISSON: f64 = 0.3975;

fn elastic<T: Real>() -> Material<T> {
    let law = Linear::from_elastic_constants(RHO, YOUNGS, POISSON);
    let shear = YOUNGS / (2.0 * (1.0 + POISSON));
    Material::new("elastic", law).with_shear_modulus(shear)
}

fn scheme() -> Scheme<f64, 2> {
    schemes::total_lagrangian().with(NeoHookean).compose()
}

/// Pseudo-random numbers in (−1, 1), the same in every run.
fn jitter() -> impl FnMut() -> f64 {
    let mut state = 0.3_f64;
    move || {
        state = (state * 9301.0 + 0.49297).fract();
        2.0 * state - 1.0
    }
}

/// v = A x.
fn linear<const D: usize>(a: [[f64; D]; D]) -> impl Fn([f64; D], Start<D>) -> Start<D> {
    move |x, own| Start {
        velocity: core::array::from_fn(|r| (0..D).map(|c| a[r][c] * x[c]).sum()),
        ..own
    }
}

/// The largest error of F in a disordered block that is deformed linearly within one step.
fn patch<T: Real, const D: usize>(
    scheme: Scheme<T, D>,
    a: [[f64; D]; D],
) -> (f64, Simulation<T, D>) {
    let dx = 0.02;
    let mut random = jitter();
    let size = core::array::from_fn(|d| dx * (8 - d) as f64);
    let block = Body::block("block", elastic(), [0.0; D], size, dx)
        .displace(|x| x.map(|x| x + 0.2 * dx * random()))
        .start(linear(a));
    let mut block = Scene::new(scheme).body(block).build().unwrap();
    block.step().unwrap();
    block.evaluate().unwrap();
    let t = block.time();
    let worst = block.all().fold(0.0_f64, |worst, p| {
        let f = p.matrix(TotalLagrangian::DEFORMATION).unwrap();
        let error = |r: usize, c: usize| {
            let one = f64::from(u8::from(r == c));
            (f[r][c] - one - t * a[r][c]).abs()
        };
        (0..D * D).fold(worst, |worst, k| worst.max(error(k / D, k % D)))
    });
    (worst, block)
}

#[test]
fn a_linear_deformation_is_exact_and_no_hourglass() {
    let (worst, block) = patch(scheme(), [[30.0, -80.0], [50.0, 20.0]]);
    assert!(block.time() > 1e-5 && worst < 1e-13, "{worst:e}");
    // Half of a step is without force, so what the control has worked is of second order in the step.
    let own = block.ledger().whole;
    let share = own.total("hourglass energy").unwrap() / own.total("elastic energy").unwrap();
    assert!(share.abs() < 1e-12, "{share:e}");
    let solid = schemes::total_lagrangian().with(StVenantKirchhoff);
    let turned = [[10.0, -80.0, 5.0], [50.0, 20.0, 0.0], [-20.0, 40.0, 30.0]];
    let (worst, _) = patch(solid.compose::<f64, 3>(), turned);
    assert!(worst < 1e-13, "{worst:e}");
    let single = schemes::total_lagrangian().with(NeoHookean);
    let (worst, _) = patch(single.compose::<f32, 2>(), [[30.0, -80.0], [50.0, 20.0]]);
    assert!(worst < 1e-6, "{worst:e}");
}

/// Longitudinal and shear waves at 50 spacings a wavelength, and where the energy of one is.
#[test]
fn waves_run_at_their_speeds() {
    let material = elastic();
    let (bulk, shear) = (material.bulk_modulus(), material.shear_modulus.unwrap());
    let speeds = [
        ((bulk + 4.0 / 3.0 * shear) / RHO).sqrt(),
        (shear / RHO).sqrt(),
    ];
    for (axis, speed) in speeds.into_iter().enumerate() {
        let start = move |[x, _]: [f64; 2], own: Start<2>| {
            let mut velocity = [0.0; 2];
            velocity[axis] = 1e-3 * (TAU * x).sin();
            Start { velocity, ..own }
        };
        let strip = Body::block("strip", material.clone(), [0.0; 2], [1.0, 0.1], 0.02);
        let mut strip = Scene::new(scheme())
            .body(strip.start(start))
            .boundary(Periodic::along(0, 0.0, 1.0))
            .boundary(Periodic::along(1, 0.0, 0.1))
            .build()
            .unwrap();
        let first = strip.ledger().whole.total_energy();
        let amplitude = |strip: &Simulation<f64, 2>| -> f64 {
            let part =
                |p: ParticleView<'_, f64, 2>| p.velocity()[axis] * (TAU * p.position()[0]).sin();
            strip.all().map(part).sum()
        };
        let quarter = 0.25 / speed;
        let zero = first_zero(&mut strip, 0.9 * quarter, amplitude);
        assert_relative_eq!(quarter, zero, epsilon = 0.0, max_relative = 0.005);
        // There the energy is elastic, but for what came and went with the hourglass control.
        let whole = strip.ledger().whole;
        assert_relative_eq!(
            whole.total_energy(),
            first,
            epsilon = 0.0,
            max_relative = 1e-13
        );
        let stored = whole.total("elastic energy").unwrap() / first;
        let control = whole.total("hourglass energy").unwrap() / first;
        // A kick-drift-kick keeps v² + ω² x² (1 − (ω dt)²/4), so the crest is higher by 8e-4 at ω dt = 0.055.
        assert!((stored + control - 1.0).abs() < 1e-3, "{stored} {control}");
        assert!(control.abs() < 1e-4, "{control}");
    }
}

/// The time at which a sum over particles passes through zero, from some time on.
fn first_zero<const D: usize>(
    simulation: &mut Simulation<f64, D>,
    from: f64,
    sum: impl Fn(&Simulation<f64, D>) -> f64,
) -> f64 {
    simulation.run_until(from).unwrap();
    let mut before = (from, sum(simulation));
    loop {
        simulation.step().unwrap();
        let now = (simulation.time(), sum(simulation));
        if now.1 * before.1 <= 0.0 {
            return before.0 + (now.0 - before.0) * before.1 / (before.1 - now.1);
        }
        before = now;
    }
}

/// The first bending of a free plate, ten thicknesses long, with ten particles through it, against Timoshenko's beam;
/// momentum, angular momentum and energy meanwhile.
#[test]
fn a_free_plate_bends_at_its_period() {
    let [length, height] = [0.2, 0.02];
    let beam = FreeBeam::new(length, height, RHO, YOUNGS, POISSON).unwrap();
    let shape = move |x: f64| beam.shape(x);
    let start = move |[x, _]: [f64; 2], own: Start<2>| Start {
        velocity: [0.0, 0.01 * shape(x)],
        ..own
    };
    let plate = Body::block(
        "plate",
        elastic(),
        [0.0; 2],
        [length, height],
        height / 10.0,
    );
    let mut plate = Scene::new(scheme())
        .body(plate.start(start))
        .build()
        .unwrap();
    let amplitude = |plate: &Simulation<f64, 2>| -> f64 {
        let part = |p: ParticleView<'_, f64, 2>| {
            let [x, _] = p.vector(Field::REFERENCE_POSITION).unwrap();
            p.velocity()[1] * shape(x)
        };
        plate.all().map(part).sum()
    };
    let spin = |plate: &Simulation<f64, 2>| -> f64 {
        let part = |p: ParticleView<'_, f64, 2>| {
            let ([x, y], [u, v]) = (p.position(), p.velocity());
            p.mass() * (x * v - y * u)
        };
        plate.all().map(part).sum()
    };
    let before = (plate.ledger().whole, spin(&plate));
    let theory = beam.period();
    let quarter = first_zero(&mut plate, 0.2 * theory, amplitude);
    let three = first_zero(&mut plate, 0.7 * theory, amplitude);
    let period = 2.0 * (three - quarter) / theory;
    assert!((1.0..1.02).contains(&period), "{period}");
    let whole = plate.ledger().whole;
    let scale = whole.mass * 0.02;
    for d in 0..2 {
        let change = (whole.momentum[d] - before.0.momentum[d]) / scale;
        assert!(change.abs() < 1e-13, "{change:e}");
    }
    let change = (spin(&plate) - before.1) / (scale * length);
    assert!(change.abs() < 1e-13, "{change:e}");
    let gain = whole.total_energy() / before.0.total_energy() - 1.0;
    assert!(gain.abs() < 1e-13, "{gain:e}");
    let control = whole.total("hourglass energy").unwrap() / before.0.total_energy();
    assert!(control.abs() < 0.02, "{control}");
}

/// Total energy of a bar that yields and dissipates at a plane of symmetry, by every integrator that kicks, to rounding.
#[test]
fn energy_is_kept_where_a_bar_flows() {
    fn drift<I: Integrator + 'static>(integrator: I) -> f64 {
        let scheme = schemes::total_lagrangian_impact().with(FiniteStrainPlasticity);
        let bar = Body::block(
            "bar",
            catalogue::ofhc_copper(),
            [0.0; 2],
            [0.01, 0.004],
            5e-4,
        );
        let mut bar = Scene::<f64, 2>::new(scheme)
            .body(bar.velocity([-200.0, 0.0]))
            .boundary(MirrorPlane::symmetry([0.0; 2], [-1.0, 0.0]))
            .integrator(integrator)
            .build()
            .unwrap();
        let before = bar.ledger().whole;
        bar.run_until(5e-6).unwrap();
        let after = bar.ledger().whole;
        // Most of it is heat by then.
        assert!(after.kinetic < 0.7 * before.kinetic, "{}", after.kinetic);
        after.total_energy() / before.total_energy() - 1.0
    }
    for drift in [
        drift(KickDriftKick),
        drift(DriftKickDrift),
        drift(PositionVerlet),
    ] {
        assert!(drift.abs() < 1e-13, "{drift:e}");
    }
}

/// In the middle of a block that shears by inertia, before its edges are heard of: √3 τ = Y, and γ less its elastic part
/// is √3 times the plastic strain.
#[test]
fn simple_shear_flows_by_theory() {
    let [hardening, first] = [2e4, 7e2];
    let material = elastic().with_strength(LinearHardening::new(first, hardening));
    let shear = material.shear_modulus.unwrap();
    let rate = 2000.0;
    let block = Body::block("block", material, [-0.1; 2], [0.1; 2], 0.005);
    let plastic = schemes::total_lagrangian().with(FiniteStrainPlasticity);
    let mut block = Scene::<f64, 2>::new(plastic)
        .body(block.start(linear([[0.0, rate], [0.0; 2]])))
        .build()
        .unwrap();
    block.run_until(2e-4).unwrap();
    block.evaluate().unwrap();
    let strain = rate * block.time();
    let middle = |p: &ParticleView<'_, f64, 2>| p.position().iter().all(|x| x.abs() < 0.02);
    let mut seen = 0;
    for p in block.all().filter(middle) {
        let flowed = p.scalar(Plasticity::STRAIN).unwrap();
        let yields = first + hardening * flowed;
        // γ = τ/G + √3 ε, τ = Y/√3.
        let theory = (strain - first / 3_f64.sqrt() / shear)
            / (3_f64.sqrt() + hardening / 3_f64.sqrt() / shear);
        assert_relative_eq!(flowed, theory, epsilon = 0.0, max_relative = 2e-3);
        let piola = p.matrix(TotalLagrangian::PIOLA).unwrap();
        // P₁₂ is τ where nothing is stretched along x, and J is one.
        let tau = piola[0][1] * 3_f64.sqrt() / yields;
        assert!((tau - 1.0).abs() < 2e-3, "{tau}");
        // Of all that has been worked, Y²/6G is stored in distortion.
        let stored = p.named("distortion").unwrap()[0] * RHO * 6.0 * shear / yields.powi(2);
        assert!((stored - 1.0).abs() < 2e-3, "{stored}");
        seen += 1;
    }
    assert!(seen > 40 && block.limited("plastic flow") > 0);
}

/// Pushes every particle of the first body away from every one of the second, along x.
#[derive(Clone, Copy, Debug)]
struct Push;

impl<T: Real, const D: usize> Coupling<T, D> for Push {
    fn name(&self) -> &'static str {
        "push"
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "push".into(),
            equation: "F = 1e-3 x",
            source: "this test",
        }
    }
    fn reach(&self, spacings: [f64; 2]) -> f64 {
        100.0 * spacings[0]
    }
    fn force(&self, _on: &CoupledParticle<T, D>, _from: &CoupledParticle<T, D>) -> [T; D] {
        core::array::from_fn(|d| T::from_f64(if d == 0 { 1e-3 } else { 0.0 }))
    }
}

/// Fifteen particles do not fill the rows of lanes, whose last slot repeats one of them: it must feel what that one does.
#[test]
fn a_coupling_pushes_what_rows_repeat() {
    let block = |name: &str, low: f64| {
        Body::<f64, 2>::block(name, elastic(), [low, 0.0], [low + 0.05, 0.03], 0.01)
    };
    let scene = || {
        Scene::new(scheme())
            .body(block("source", 0.0))
            .group(scheme(), [block("block", 0.2)])
            .couple("block", "source", Push)
    };
    // 225 pairs push 1.5 kg, all of it alike.
    let speed = 225.0 * 1e-3 * 0.01 / 15e-4 / RHO;
    for scene in [scene(), scene().sub_cycle("block", 4)] {
        let mut pushed = scene.build().unwrap();
        pushed.run_until(0.01).unwrap();
        for p in pushed.body("block").unwrap() {
            let [u, v] = p.velocity();
            assert!(
                (u / speed - 1.0).abs() < 1e-9 && v.abs() < 1e-9 * speed,
                "{u} {v} {speed}"
            );
        }
    }
}

#[test]
fn what_does_not_go_with_kept_neighbours_is_refused() {
    let block = || Body::<f64, 2>::block("block", elastic(), [0.0; 2], [0.1; 2], 0.01);
    let refusal = |scene: Scene<f64, 2>| scene.build().unwrap_err().to_string();
    let without = refusal(Scene::new(schemes::total_lagrangian()).body(block()));
    assert!(without.contains("gives a stress"), "{without}");
    let wall = Scene::new(scheme()).body(block());
    let opens = refusal(wall.boundary(MirrorPlane::wall([0.0; 2], [-1.0, 0.0])));
    assert!(opens.contains("MirrorPlane::symmetry"), "{opens}");
    let limited = meshfree::term::viscosity::LimitedMonaghanGingold::STANDARD;
    let viscous = schemes::total_lagrangian().with_viscosity(limited);
    let gradient = refusal(Scene::new(viscous.with(NeoHookean)).body(block()));
    assert!(gradient.contains("Inviscid"), "{gradient}");
    let form = schemes::impact().density(DensityForm::Deformation);
    let form = refusal(Scene::new(form).body(block()));
    assert!(form.contains("SchemeBuilder::total_lagrangian"), "{form}");
    let hard = Material::new("rubber", Linear::new(RHO, 50.0)).with_shear_modulus(1e3);
    let body = Body::block("block", hard, [0.0; 2], [0.1; 2], 0.01);
    let locked = refusal(Scene::new(scheme()).body(body));
    assert!(locked.contains("Poisson ratio of body `block`"), "{locked}");
    let control = HourglassControl { strength: -1.0 };
    let negative = schemes::total_lagrangian().with(NeoHookean).with(control);
    let negative = refusal(Scene::new(negative).body(block()));
    assert!(negative.contains("hourglass"), "{negative}");
}
