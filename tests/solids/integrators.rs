//! Integrators: order, reversibility, damping and stability limits, on one oscillator where theory is
//! exact, and on waves in a row of particles.

use meshfree::boundary::Periodic;
use meshfree::error::Result;
use meshfree::integrator::{
    DriftKickDrift, Integrator, KickDriftKick, LamLeapfrog, Midpoint, PositionVerlet, Predictor,
    RungeKutta4, StrongStabilityPreserving3, System,
};
use meshfree::kernel::CubicSpline;
use meshfree::material::Material;
use meshfree::material::eos::Linear;
use meshfree::scene::{Body, Scene, Start};
use meshfree::scheme::{DensityForm, EnergyForm, SchemeBuilder};
use meshfree::simulation::{Simulation, StepControl};
use meshfree::study::norms::observed_order;
use meshfree::term::viscosity::Inviscid;
use std::f64::consts::PI;

/// x″ = −x: the smallest system that an integrator can advance.
#[derive(Clone, Debug, Default)]
struct Oscillator {
    x: f64,
    v: f64,
    a: f64,
    has_rates: bool,
    velocity_at_rates: f64,
    predicted: f64,
    kept: Vec<(f64, f64)>,
}

impl Oscillator {
    fn at(x: f64, v: f64) -> Self {
        Self {
            x,
            v,
            kept: vec![(0.0, 0.0); 4],
            ..Self::default()
        }
    }
    fn rates(&self) -> (f64, f64) {
        (self.velocity_at_rates, self.a)
    }
}

impl System for Oscillator {
    fn evaluate(&mut self, _offset: f64) -> Result<()> {
        (self.a, self.velocity_at_rates, self.has_rates) = (-self.x, self.v, true);
        Ok(())
    }
    fn kick(&mut self, dt: f64) {
        self.v += dt * self.a;
    }
    fn drift(&mut self, dt: f64, _offset: f64) -> Result<()> {
        self.x += dt * self.v;
        Ok(())
    }
    fn shift(&mut self, dv: f64, da: f64) {
        self.x += dv * self.v + da * self.a;
    }
    fn predict(&mut self, dt: f64) {
        self.predicted = self.v;
        self.v += dt * self.a;
    }
    fn restore(&mut self) {
        self.v = self.predicted;
    }
    fn save(&mut self, slot: usize) {
        self.kept[slot] = (self.x, self.v);
    }
    fn load(&mut self, slot: usize) {
        (self.x, self.v) = self.kept[slot];
    }
    fn combine(&mut self, slot: usize, a: f64, b: f64, dt: f64) {
        let ((x, v), (dx, dv)) = (self.kept[slot], self.rates());
        (self.x, self.v) = (a * x + b * self.x + dt * dx, a * v + b * self.v + dt * dv);
    }
    fn accumulate(&mut self, slot: usize, dt: f64) {
        let (dx, dv) = self.rates();
        self.kept[slot].0 += dt * dx;
        self.kept[slot].1 += dt * dv;
    }
    fn has_rates(&self) -> bool {
        self.has_rates
    }
}

fn all() -> Vec<(Box<dyn Integrator>, f64)> {
    vec![
        (Box::new(KickDriftKick), 2.0),
        (Box::new(DriftKickDrift), 2.0),
        (Box::new(PositionVerlet), 2.0),
        (Box::new(Midpoint), 2.0),
        (Box::new(StrongStabilityPreserving3), 3.0),
        (Box::new(RungeKutta4), 4.0),
        (
            Box::new(LamLeapfrog {
                predictor: Predictor::Fresh,
            }),
            2.0,
        ),
        (
            Box::new(LamLeapfrog {
                predictor: Predictor::Lagged,
            }),
            2.0,
        ),
    ]
}

/// The matrix of one step of z = ω dt, column by column.
fn step_matrix(integrator: &mut dyn Integrator, z: f64) -> [[f64; 2]; 2] {
    [(1.0, 0.0), (0.0, 1.0)].map(|(x, v)| {
        let mut system = Oscillator::at(x, v);
        integrator.step(&mut system, z).unwrap();
        [system.x, system.v]
    })
}

fn determinant(m: [[f64; 2]; 2]) -> f64 {
    m[0][0] * m[1][1] - m[0][1] * m[1][0]
}

/// Largest |eigenvalue| of a step.
fn spectral_radius(m: [[f64; 2]; 2]) -> f64 {
    let (half, det) = (0.5 * (m[0][0] + m[1][1]), determinant(m));
    let root = half * half - det;
    if root < 0.0 {
        det.sqrt()
    } else {
        half.abs() + root.sqrt()
    }
}

/// Growth of the amplitude per step after many; the lagged reading has three states, not two.
fn growth(integrator: &mut dyn Integrator, z: f64, steps: i32) -> f64 {
    let mut system = Oscillator::at(1.0, 0.3);
    let norm = |s: &Oscillator| s.x.hypot(s.v);
    let warm = 200;
    // Averages over the turning of the ellipse.
    let (mut first, mut last) = (0.0_f64, 0.0_f64);
    for k in 0..warm + steps {
        integrator.step(&mut system, z).unwrap();
        if k < warm {
            first = first.max(norm(&system));
        }
        if k >= steps {
            last = last.max(norm(&system));
        }
        if norm(&system) > 1e100 {
            return f64::INFINITY;
        }
    }
    (last / first).powf(1.0 / f64::from(steps))
}

#[test]
fn leapfrogs_keep_phase_space() {
    for integrator in [
        &mut KickDriftKick as &mut dyn Integrator,
        &mut DriftKickDrift,
        &mut PositionVerlet,
    ] {
        for z in [0.1, 0.5, 1.0, 1.9] {
            let det = determinant(step_matrix(integrator, z));
            assert!((det - 1.0).abs() < 1e-14, "{}: {det}", integrator.name());
        }
    }
}

#[test]
fn lams_printed_leapfrog_has_the_determinant_of_a_low_pass_filter() {
    let mut lam = LamLeapfrog {
        predictor: Predictor::Fresh,
    };
    let printed = [
        (0.1, -1.3e-5),
        (0.25, -4.9e-4),
        (0.5, -7.8e-3),
        (1.0, -0.134),
    ];
    for (z, change) in printed {
        let m = step_matrix(&mut lam, z);
        assert!((determinant(m) - (1.0 - z.powi(4) / 4.0)).abs() < 1e-14);
        assert!((m[0][0] + m[1][1] - (2.0 - z * z + z.powi(4) / 4.0)).abs() < 1e-14);
        let found = spectral_radius(m) - 1.0;
        assert!(
            (found / change - 1.0).abs() < 0.05,
            "z {z}: {found} instead of {change}"
        );
    }
}

#[test]
fn the_lagged_reading_damps_twice_as_much() {
    let printed = [
        (0.1, -2.5e-5),
        (0.25, -9.2e-4),
        (0.5, -1.3e-2),
        (1.0, -0.128),
    ];
    for (z, change) in printed {
        let mut lam = LamLeapfrog {
            predictor: Predictor::Lagged,
        };
        let found = growth(&mut lam, z, if z < 0.3 { 4000 } else { 800 }) - 1.0;
        println!("z {z}: {found:.3e}, printed {change:.3e}");
        assert!(
            (found / change - 1.0).abs() < 0.06,
            "z {z}: {found} instead of {change}"
        );
    }
}

#[test]
fn the_midpoint_rule_grows_by_z4_over_8_and_rk4_shrinks_by_z6_over_144() {
    for z in [0.1_f64, 0.25, 0.5] {
        let grown = spectral_radius(step_matrix(&mut Midpoint, z)).powi(2);
        assert!((grown - 1.0 - z.powi(4) / 4.0).abs() < 1e-14);
        let shrunk = spectral_radius(step_matrix(&mut RungeKutta4, z)).powi(2);
        let theory = 1.0 - z.powi(6) / 72.0 + z.powi(8) / 576.0;
        assert!((shrunk - theory).abs() < 1e-14, "{shrunk} {theory}");
        let shrunk = spectral_radius(step_matrix(&mut StrongStabilityPreserving3, z)).powi(2);
        let theory = 1.0 - z.powi(4) / 12.0 + z.powi(6) / 36.0;
        assert!((shrunk - theory).abs() < 1e-14, "{shrunk} {theory}");
    }
}

#[test]
fn each_is_stable_up_to_its_limit_and_not_beyond() {
    let limits: [(Box<dyn Integrator>, f64); 7] = [
        (Box::new(KickDriftKick), 2.0),
        (Box::new(DriftKickDrift), 2.0),
        (Box::new(PositionVerlet), 2.0),
        (Box::new(StrongStabilityPreserving3), 3.0_f64.sqrt()),
        (Box::new(RungeKutta4), 8.0_f64.sqrt()),
        (
            Box::new(LamLeapfrog {
                predictor: Predictor::Fresh,
            }),
            2.0_f64.sqrt(),
        ),
        (
            Box::new(LamLeapfrog {
                predictor: Predictor::Lagged,
            }),
            1.1547,
        ),
    ];
    for (mut integrator, limit) in limits {
        let inside = growth(&mut *integrator, 0.998 * limit, 2000);
        let outside = growth(&mut *integrator, 1.002 * limit, 2000);
        let name = integrator.name();
        println!("{name}: {inside:.6} inside and {outside:.6} outside of z = {limit:.4}");
        assert!(
            inside < 1.0 + 1e-3 && outside > 1.0 + 1e-3,
            "{name}: {inside}, {outside}"
        );
        // What the step control believes, in units of the leapfrog's 2.
        let believed = 2.0 * integrator.stability();
        assert!(
            believed <= 1.001 * limit && believed > 0.99 * limit,
            "{name}: {believed}"
        );
    }
}

#[test]
fn each_has_its_order_on_an_oscillator() {
    for (integrator, expected) in all() {
        let steps = [40, 80, 160];
        let errors = steps.map(|n| {
            let mut system = Oscillator::at(1.0, 0.0);
            for _ in 0..n {
                integrator.step(&mut system, 2.0 / f64::from(n)).unwrap();
            }
            (system.x - 2.0_f64.cos()).hypot(system.v + 2.0_f64.sin())
        });
        let order = observed_order(&steps.map(|n| 1.0 / f64::from(n)), &errors)
            .unwrap()
            .order;
        println!("{}: order {order:.3}", integrator.name());
        assert!(
            (order - expected).abs() < 0.1,
            "{}: {order}",
            integrator.name()
        );
    }
}

const LENGTH: usize = 32;

/// A smooth wave in a periodic row, inviscid.
fn wave(form: DensityForm, integrator: Box<dyn Integrator>, step: f64) -> Simulation<f64, 1> {
    let k = 2.0 * PI / LENGTH as f64;
    let solid = Material::new("linear", Linear::new(1000.0, 1000.0));
    let row = Body::block("row", solid, [0.0], [LENGTH as f64], 1.0).start(|x, start| Start {
        velocity: [5.0 * (k * x[0]).sin()],
        ..start
    });
    Scene::new(
        SchemeBuilder::new(CubicSpline, Inviscid)
            .density(form)
            .energy(EnergyForm::Symmetric),
    )
    .body(row)
    .boundary(Periodic::along(0, 0.0, LENGTH as f64))
    .boxed_integrator(integrator)
    .steps(|control| StepControl {
        fixed: Some(step),
        ..control
    })
    .build()
    .unwrap()
}

fn state(simulation: &mut Simulation<f64, 1>) -> Vec<f64> {
    // Some integrators evaluate last at half steps: density and pressure are those of that moment.
    simulation.evaluate().unwrap();
    simulation
        .all()
        .flat_map(|p| {
            [
                p.position()[0] / 1e-2,
                p.velocity()[0],
                (p.density() - 1000.0),
            ]
        })
        .collect()
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter()
        .zip(b)
        .map(|(a, b)| (a - b).powi(2))
        .sum::<f64>()
        .sqrt()
}

fn orders(form: DensityForm, expected: impl Fn(&dyn Integrator, f64) -> f64) {
    let end = 0.02;
    let run = |integrator: Box<dyn Integrator>, steps: u32| {
        let mut simulation = wave(form, integrator, end / f64::from(steps));
        for _ in 0..steps {
            simulation.step().unwrap();
        }
        state(&mut simulation)
    };
    let exact = run(Box::new(RungeKutta4), 1280);
    for (k, (integrator, order)) in all().into_iter().enumerate() {
        if form.is_integrated() && !integrator.integrates_density() {
            continue;
        }
        let steps = [80, 160, 320];
        let errors = steps.map(|n| distance(&run(all().swap_remove(k).0, n), &exact));
        let found = observed_order(&steps.map(|n| 1.0 / f64::from(n)), &errors)
            .unwrap()
            .order;
        let expected = expected(&*integrator, order);
        println!(
            "{form}, {}: {errors:?}, order {found:.3}",
            integrator.name()
        );
        assert!(
            (found - expected).abs() < 0.15,
            "{form}, {}: order {found}, errors {errors:?}",
            integrator.name()
        );
    }
}

#[test]
fn each_has_its_order_on_a_wave_with_density_from_positions() {
    orders(DensityForm::NumberDensity, |_, order| order);
}

#[test]
fn each_has_its_order_on_a_wave_with_density_by_continuity() {
    orders(DensityForm::Continuity, |_, order| order);
}

/// Runs there and back, and returns how far from home it ends, over how far it went.
fn missed(form: DensityForm, integrator: impl Integrator + 'static) -> f64 {
    let mut there = wave(form, Box::new(integrator), 2e-4);
    let start = state(&mut there);
    for _ in 0..100 {
        there.step().unwrap();
    }
    let far = distance(&state(&mut there), &start);
    there.set_velocities(|_, v| v.map(|v| -v));
    for _ in 0..100 {
        there.step().unwrap();
    }
    let home: Vec<f64> = state(&mut there)
        .chunks(3)
        .flat_map(|s| [s[0], -s[1], s[2]])
        .collect();
    distance(&home, &start) / far
}

#[test]
fn leapfrogs_run_backwards_to_where_they_came_from() {
    for form in [DensityForm::Summation, DensityForm::NumberDensity] {
        let (kdk, dkd) = (missed(form, KickDriftKick), missed(form, DriftKickDrift));
        println!("{form}: kick-drift-kick {kdk:.1e}, drift-kick-drift {dkd:.1e}");
        assert!(kdk < 1e-10 && dkd < 1e-10, "{form}: {kdk:.1e}, {dkd:.1e}");
    }
}

/// Volumes at the middle of a drift are predicted, which is second order but knows past from future.
#[test]
fn with_continuity_they_come_back_to_a_millionth() {
    let form = DensityForm::Continuity;
    let (kdk, dkd) = (missed(form, KickDriftKick), missed(form, DriftKickDrift));
    println!("kick-drift-kick {kdk:.1e}, drift-kick-drift {dkd:.1e}");
    assert!(kdk < 1e-6 && dkd < 1e-6, "{kdk:.1e}, {dkd:.1e}");
}

#[test]
fn the_others_do_not() {
    let form = DensityForm::NumberDensity;
    let lam = missed(
        form,
        LamLeapfrog {
            predictor: Predictor::Fresh,
        },
    );
    let midpoint = missed(form, Midpoint);
    println!("Lam {lam:.1e}, midpoint {midpoint:.1e}");
    assert!(lam > 1e-7 && midpoint > 1e-7, "{lam:.1e}, {midpoint:.1e}");
}
