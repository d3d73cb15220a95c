//! The pressure force of gases with gradients from inverted matrices, and the work that each side takes of it.
//! García-Senz, Cabezón & Escartín 2012; Rosswog 2020 (MAGMA2); by volumes as Bonet & Lok 1999.

use super::renormalised::corrected;
use super::{Layout, Pair, Sums, Term, TermDoc};
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::Lane;

/// The pressure force of a gas with gradients that are exact for linear fields on any arrangement of particles.
///
/// mᵢ dvᵢ/dt = −Σⱼ Vᵢ Vⱼ (pᵢ Gᵢ + pⱼ Gⱼ), Gᵢ = Cᵢ (xⱼ − xᵢ) W(hᵢ), Cᵢ⁻¹ = Σⱼ Vⱼ (xⱼ − xᵢ) ⊗ (xⱼ − xᵢ) W(hᵢ)
///
/// with pressures p \[Pa\], volumes V = m/ρ \[m³\] and the particles' own smoothing lengths h \[m\]: no grad-h terms are
/// needed, for the matrix normalises whatever kernel there is. The internal energy of a particle follows the work of its own
/// pressure,
///
/// mᵢ deᵢ/dt = pᵢ Vᵢ Σⱼ Vⱼ (vᵢ − vⱼ)·Gᵢ = −pᵢ Vᵢ ∇·v,
///
/// with the divergence exact for linear velocities, so that what is not heated keeps its entropy.
///
/// Opposite for the two sides, so momentum is conserved to rounding, and with it total energy in the
/// [compatible](crate::scheme::EnergyForm::Compatible) form: what one side takes beyond half of the work the other lacks. The force does not
/// lie along the line of centres; its torques cancel particle by particle, for Cᵢ is the inverse of the moment of the same
/// weights, so angular momentum is conserved as well (Bonet & Lok 1999) but where a matrix cannot be inverted: there, on lines
/// and sheets of particles, the gradient is left uncorrected, and particle steps of it are counted. Of MAGMA2's forms this is neither (by p/ρ² or
/// the mean of both gradients); Gresho's vortex does not tell the three apart, Sedov's blast has the smallest error with this one.
///
/// Sum densities and smoothing lengths that follow them belong to it: [`schemes::gas`](crate::schemes::gas).
#[derive(Clone, Copy, Debug)]
pub struct MatrixPressureForce;

impl<const D: usize> Term<D> for MatrixPressureForce {
    const NAME: &'static str = "meshfree::matrix_pressure_force";
    const READS: Fields = Fields::of(&[
        Field::VELOCITY,
        Field::MASS,
        Field::DENSITY,
        Field::PRESSURE,
        Field::CORRECTION,
    ]);
    const WRITES: Outputs = Outputs::of(&[Output::FORCE, Output::POWER]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let own = corrected(&pair.r, pair.weight_i(), |k| {
            pair.i_at(Field::CORRECTION, k)
        });
        let other = corrected(&pair.r, pair.weight_j(), |k| {
            pair.j_at(Field::CORRECTION, k)
        });
        let volumes = pair.volumes();
        let x_i = volumes * pair.i(Field::PRESSURE);
        let x_j = volumes * pair.j(Field::PRESSURE);
        let mut beyond = L::zero();
        for d in 0..D {
            // Products by themselves: what is fused would differ between the two sides.
            let (of_i, of_j) = (x_i * own[d], x_j * other[d]);
            sums.force.add(d, -(of_i + of_j));
            beyond += (of_i - of_j) * pair.v[d];
        }
        sums.add(Output::POWER, beyond * L::of(0.5));
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "pressure force by matrix gradients".into(),
            equation: "mᵢ dvᵢ/dt = −Σⱼ Vᵢ Vⱼ (pᵢ Gᵢ + pⱼ Gⱼ), mᵢ deᵢ/dt = pᵢ Vᵢ Σⱼ Vⱼ vᵢⱼ·Gᵢ, G = C (xⱼ − xᵢ) W(h)",
            source: "García-Senz, Cabezón & Escartín 2012; Rosswog 2020; by volumes as Bonet & Lok 1999",
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::boundary::Periodic;
    use crate::material::eos::IdealGas;
    use crate::prelude::*;
    use crate::scene::Start;
    use crate::term::viscosity::{Inviscid, LimitedMonaghanGingold};
    use approx::assert_relative_eq;

    /// Gas on a lattice displaced by a fifth of a spacing, between free ends, whose energy and velocity are given.
    fn disordered(
        scheme: impl Into<Scheme<f64, 2>>,
        count: u32,
        start: impl Fn([f64; 2]) -> ([f64; 2], f64) + Send + Sync + 'static,
    ) -> Simulation<f64, 2> {
        let gas = Material::new("gas", IdealGas::new(5.0 / 3.0, 1.0));
        let body = Body::block("gas", gas, [-0.5; 2], [0.5; 2], 1.0 / f64::from(count))
            .jitter(0.2, 5)
            .start(move |x, own| {
                let (velocity, energy) = start(x);
                Start {
                    velocity,
                    energy,
                    ..own
                }
            });
        Scene::new(scheme).body(body).build().expect("gas")
    }

    /// With matrix gradients, so that the velocity gradient is wanted.
    fn exact() -> Scheme<f64, 2> {
        schemes::gas()
            .with_viscosity(LimitedMonaghanGingold::STANDARD)
            .compose()
    }

    #[test]
    fn gradients_are_exact_for_linear_fields_whatever_the_arrangement() {
        let slopes = [[0.3, -0.7], [1.1, 0.4]];
        let linear = move |x: [f64; 2]| [0, 1].map(|a| slopes[a][0] * x[0] + slopes[a][1] * x[1]);
        let gas = disordered(exact(), 12, move |x| (linear(x), 1.0));
        let mut worst = 0.0_f64;
        for particle in gas.all() {
            let found = particle.matrix(Field::VELOCITY_GRADIENT);
            let found = found.expect("a gradient");
            for a in 0..2 {
                for b in 0..2 {
                    worst = worst.max((found[a][b] - slopes[a][b]).abs());
                }
            }
        }
        // Corners included.
        assert!(worst < 1e-12, "{worst}");
    }

    #[test]
    fn momentum_energy_and_angular_momentum_stay() {
        let kick = |x: [f64; 2]| {
            let swirl = [-x[1] + 0.3 * x[0] * x[1], x[0] + 0.2 * x[1] * x[1]];
            (swirl, 1.0 + (5.0 * x[0]).sin() * 0.5)
        };
        let run = |scheme: Scheme<f64, 2>| {
            let mut gas = disordered(scheme, 16, kick);
            let sums = |gas: &Simulation<f64, 2>| {
                gas.all().fold([0.0; 3], |[x, y, turn], p| {
                    let (m, at, v) = (p.mass(), p.position(), p.velocity());
                    let spin = at[0] * v[1] - at[1] * v[0];
                    [x + m * v[0], y + m * v[1], turn + m * spin]
                })
            };
            let (before, energy) = (sums(&gas), gas.ledger().whole.total_energy());
            gas.run_until(0.1).expect("a run");
            let after = sums(&gas);
            let change = gas.ledger().whole.total_energy() / energy - 1.0;
            let turn = after[2] / before[2] - 1.0;
            ([after[0] - before[0], after[1] - before[1]], turn, change)
        };
        let ([x, y], turn, change) = run(schemes::gas().with_viscosity(Inviscid).compose());
        assert!(x.abs() < 1e-14 && y.abs() < 1e-14, "{x} {y}");
        assert!(change.abs() < 1e-13, "{change}");
        assert!(turn.abs() < 1e-10, "{turn}");
        // The control takes each side half of the work without the compatible form.
        let symmetric = schemes::gas()
            .with_viscosity(Inviscid)
            .energy(EnergyForm::Symmetric);
        let (_, _, drift) = run(symmetric.compose());
        assert!(drift.abs() > 1e-9, "{drift}");
    }

    /// Mean error of the acceleration over its largest, for p = 1 + 0.1 sin(2πx) at an even density, with so many along a period.
    fn error_of_force(scheme: Scheme<f64, 2>, count: u32) -> f64 {
        use core::f64::consts::TAU;
        let gas = Material::new("gas", IdealGas::new(5.0 / 3.0, 1.0));
        let spacing = 1.0 / f64::from(count);
        // Rows that a smooth flow has moved along each other: density stays, and no particle has its neighbours on a lattice.
        let bent = |k: u32| {
            let [x, y] = [k % count, k / count].map(|n| (f64::from(n) + 0.5) * spacing);
            [(x + 0.1 * (TAU * y).sin()).rem_euclid(1.0), y]
        };
        let points = (0..count * count).map(bent).collect();
        let body = Body::points_of("gas", gas, points, spacing).start(|x: [f64; 2], _| Start {
            velocity: [0.0; 2],
            density: 1.0,
            energy: 1.5 * (1.0 + 0.1 * (TAU * x[0]).sin()),
        });
        let mut gas = Scene::new(scheme)
            .body(body)
            .boundary(Periodic::along(0, 0.0, 1.0))
            .boundary(Periodic::along(1, 0.0, 1.0))
            .build()
            .expect("gas");
        let before: Vec<_> = gas.all().map(|p| (p.position(), p.density())).collect();
        let dt = gas.step_at_most(1e-6).expect("a step");
        let pairs = gas.all().zip(before);
        let off = pairs.map(|(p, (x, density))| {
            let exact = -0.1 * TAU * (TAU * x[0]).cos();
            let found = p.velocity().map(|v| v / dt * density);
            (found[0] - exact).abs() + found[1].abs()
        });
        off.sum::<f64>() / f64::from(count * count) / (0.1 * TAU)
    }

    #[test]
    fn the_force_has_an_order_on_bent_lattices() {
        let errors = [16, 32].map(|n| error_of_force(schemes::gas().compose(), n));
        let order = (errors[0] / errors[1]).log2();
        assert!(order > 1.0, "{errors:?} {order}");
        assert_relative_eq!(errors[1], 0.0, epsilon = 0.05);
    }
}
