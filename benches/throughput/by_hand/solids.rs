//! Sums of solids, written out by hand, and their table: updated Lagrangian forces and gradients, and total-Lagrangian forces.
//! What belongs to one particle of a pair alone is divided once a row, or once for all lanes, and a pair divides as rarely as it can.

use super::by_hand::{
    Apart, MOST, Record, Written, norm, over_shape_at_spacing, parting, places, row,
};
use super::lattice::H;
use meshfree::effect::{
    ArtificialStress, HourglassControl, HourglassFree, Hypoelastic, TotalLagrangian,
    parts::{DisplacementGradient, Repulsion, StressForce, VelocityMismatch},
};
use meshfree::name;
use meshfree::particles::{Field, Output};
use meshfree::scalar::Lane;
use meshfree::term::{PressureForce, VelocityGradient, parts::Compression};

/// What a loop sums beside the pressure force.
const STRESS: u8 = 1;
const REPULSION: u8 = 2;
const HOURGLASS: u8 = 4;

/// Stiffness of the hourglass-free form of a particle \[Pa\], negative.
const STIFFNESS: Field = Field::scalar(name!("hourglass_stiffness", "Pa"));
/// Keeps quotients of these finite, as the effect has it.
const LEAST: f64 = 1e-30;

/// The forces of an updated Lagrangian solid.
#[derive(Clone, Copy)]
struct Updated<const WHAT: u8>;

impl<const WHAT: u8> Written for Updated<WHAT> {
    fn outputs() -> Vec<(Output, usize)> {
        vec![(Output::FORCE, 3)]
    }
    #[inline(always)]
    fn prepare<Row: Lane<Scalar = f64>, R: Record>(&self, own: &mut [Row; MOST]) {
        let [m, rho, s, stress, tension] = const {
            places::<R, 5>([
                Field::MASS,
                Field::DENSITY,
                Field::CONSISTENCY_FACTOR,
                Hypoelastic::STRESS,
                ArtificialStress::TENSION,
            ])
        };
        // The volume in place of the mass, and stresses over the first moment.
        own[m] = own[m] / own[rho];
        let over = own[s].recip();
        for k in 0..6 {
            if WHAT & STRESS != 0 {
                own[stress + k] = own[stress + k] * over;
            }
            if WHAT & REPULSION != 0 {
                own[tension + k] = own[tension + k] * over;
            }
        }
    }
    #[inline(always)]
    fn pair<Row: Lane<Scalar = f64>, R: Record>(
        &self,
        apart: &Apart<Row>,
        own: &[Row; MOST],
        other: &[f64],
        sums: &mut [Row; MOST],
    ) {
        let [m, rho, s, weight, coefficient] = const {
            places::<R, 5>([
                Field::MASS,
                Field::DENSITY,
                Field::CONSISTENCY_FACTOR,
                Field::WEIGHT,
                Field::PRESSURE_COEFFICIENT,
            ])
        };
        let [stress, tension, q, stiffness] = const {
            places::<R, 4>([
                Hypoelastic::STRESS,
                ArtificialStress::TENSION,
                HourglassFree::MISMATCH,
                STIFFNESS,
            ])
        };
        let Apart { r, d2, shape, f } = *apart;
        let pressures = own[coefficient] + Row::splat(other[coefficient]);
        let mut radial = -(own[weight] * Row::splat(other[weight]) * pressures);
        let volumes = own[m] * Row::splat(other[m] / other[rho]);
        if WHAT & HOURGLASS != 0 {
            let mut along = Row::zero();
            for d in 0..3 {
                along = (own[q + d] - Row::splat(other[q + d])).mul_add(r[d], along);
            }
            let [a, b] = [own[stiffness], Row::splat(other[stiffness])];
            let distance2 = d2 + Row::splat(1e-12 * H * H);
            let above = a * Row::splat(-20.0 * other[stiffness]) * volumes * along;
            let moments = own[s] + Row::splat(other[s]);
            radial += above / ((a + b - Row::splat(LEAST)) * moments * distance2);
        }
        radial = radial * f;
        if WHAT & (STRESS | REPULSION) != 0 {
            let over = Row::splat(1.0 / other[s]);
            let mut sum = [Row::zero(); 6];
            if WHAT & STRESS != 0 {
                for k in 0..6 {
                    sum[k] = over.mul_add(Row::splat(other[stress + k]), own[stress + k]);
                }
            }
            if WHAT & REPULSION != 0 {
                let ratio = shape * Row::splat(over_shape_at_spacing());
                let square = ratio * ratio;
                let near = -(square * square);
                for k in 0..6 {
                    let pulls = over.mul_add(Row::splat(other[tension + k]), own[tension + k]);
                    sum[k] = near.mul_add(pulls, sum[k]);
                }
            }
            let factor = volumes * f;
            let [xx, yy, zz, yz, xz, xy] = sum;
            for (d, [x, y, z]) in [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
                .into_iter()
                .enumerate()
            {
                let traction = z.mul_add(r[2], y.mul_add(r[1], x * r[0]));
                sums[d] = factor.mul_add(traction, sums[d]);
            }
        }
        for d in 0..3 {
            sums[d] = radial.mul_add(r[d], sums[d]);
        }
    }
}

/// Where the sums of [`Gradients`] are, behind the compression: of the velocity gradient, the six of the moment
/// matrix, and with `MISMATCH` those of the hourglass-free form.
const GRADIENT: usize = 1;
const MATRIX: usize = 10;
const DIFFERENCE: usize = 16;
const CENTRE: usize = 19;

/// Compression and velocity gradient of an updated Lagrangian solid.
#[derive(Clone, Copy)]
struct Gradients<const MISMATCH: bool>;

impl<const MISMATCH: bool> Written for Gradients<MISMATCH> {
    fn outputs() -> Vec<(Output, usize)> {
        let count = if MISMATCH { 3 } else { 0 };
        vec![
            (Output::COMPRESSION, 1),
            (Output::VELOCITY_GRADIENT, 9),
            (Output::MOMENT_MATRIX, 9),
            (Output::vector(name!("velocity_mismatch", "m/s")), count),
            (Output::vector(name!("neighbours_centre", "m")), count),
        ]
    }
    #[inline(always)]
    fn pair<Row: Lane<Scalar = f64>, R: Record>(
        &self,
        apart: &Apart<Row>,
        own: &[Row; MOST],
        other: &[f64],
        sums: &mut [Row; MOST],
    ) {
        let [m, rho, weight, stiffness] =
            const { places::<R, 4>([Field::MASS, Field::DENSITY, Field::WEIGHT, STIFFNESS]) };
        let Apart { r, d2, f, .. } = *apart;
        let (jump, vr) = parting::<Row, R>(&r, own, other);
        sums[0] = (Row::splat(other[weight]) * f).mul_add(vr, sums[0]);
        let factor = Row::splat(-other[m] / other[rho]) * f;
        let mut k = MATRIX;
        for b in 0..3 {
            let gradient = factor * r[b];
            for a in 0..3 {
                let sum = &mut sums[GRADIENT + 3 * a + b];
                *sum = jump[a].mul_add(gradient, *sum);
            }
            for a in 0..=b {
                sums[k] = r[a].mul_add(gradient, sums[k]);
                k += 1;
            }
        }
        if MISMATCH {
            let its = Row::splat(other[stiffness]);
            let share = its / (own[stiffness] + its - Row::splat(LEAST));
            let weight = factor * d2 * share;
            for d in 0..3 {
                sums[DIFFERENCE + d] = weight.mul_add(jump[d], sums[DIFFERENCE + d]);
                sums[CENTRE + d] = weight.mul_add(r[d], sums[CENTRE + d]);
            }
        }
    }
    #[inline(always)]
    fn finish<Row: Lane<Scalar = f64>>(&self, sums: &[Row; MOST]) -> [Row; MOST] {
        let mut finished = *sums;
        let mut k = MATRIX;
        for b in 0..3 {
            for a in 0..=b {
                finished[MATRIX + 3 * a + b] = sums[k];
                finished[MATRIX + 3 * b + a] = sums[k];
                k += 1;
            }
        }
        for k in 0..6 {
            finished[19 + k] = sums[DIFFERENCE + k] * Row::splat(2.0 / 3.0);
        }
        finished
    }
}

/// P L, as the effect of total-Lagrangian solids has it.
const CORRECTED: Field = Field::matrix(name!("corrected_piola_stress", "Pa"));
/// Young's modulus, as the hourglass control has it.
const MODULUS: Field = STIFFNESS;
const STRENGTH: f64 = 0.1;
/// Where the power of the hourglass control is, behind the force.
const POWER: usize = 3;

/// The force of the Piola stress of a total-Lagrangian solid, and the hourglass control.
#[derive(Clone, Copy)]
struct Total<const CONTROLLED: bool>;

impl<const CONTROLLED: bool> Written for Total<CONTROLLED> {
    fn outputs() -> Vec<(Output, usize)> {
        vec![
            (Output::FORCE, 3),
            (
                Output::scalar(name!("hourglass_power", "W")),
                usize::from(CONTROLLED),
            ),
        ]
    }
    #[inline(always)]
    fn pair<Row: Lane<Scalar = f64>, R: Record>(
        &self,
        apart: &Apart<Row>,
        own: &[Row; MOST],
        other: &[f64],
        sums: &mut [Row; MOST],
    ) {
        let [x, v, weight, stress, deformation, modulus] = const {
            places::<R, 6>([
                Field::POSITION,
                Field::VELOCITY,
                Field::WEIGHT,
                CORRECTED,
                TotalLagrangian::DEFORMATION,
                MODULUS,
            ])
        };
        let Apart {
            r: built,
            d2,
            shape,
            f,
        } = *apart;
        let weights = own[weight] * Row::splat(other[weight]);
        let factor = weights * f;
        for a in 0..3 {
            let mut traction = Row::zero();
            for b in 0..3 {
                let at = stress + 3 * a + b;
                let sum = own[at] + Row::splat(other[at]);
                traction = sum.mul_add(built[b], traction);
            }
            sums[a] = factor.mul_add(traction, sums[a]);
        }
        if CONTROLLED {
            let (mut error, mut r2, mut vr) = (Row::zero(), Row::zero(), Row::zero());
            let mut r = [Row::zero(); 3];
            for a in 0..3 {
                r[a] = own[x + a] - Row::splat(other[x + a]);
                r2 = r[a].mul_add(r[a], r2);
                vr = (own[v + a] - Row::splat(other[v + a])).mul_add(r[a], vr);
                let mut image = -(r[a] + r[a]);
                for b in 0..3 {
                    let at = deformation + 3 * a + b;
                    let sum = own[at] + Row::splat(other[at]);
                    image = sum.mul_add(built[b], image);
                }
                error = image.mul_add(r[a], error);
            }
            let scale = 0.25 * STRENGTH * norm() / H.powi(3);
            let moduli = (own[modulus] + Row::splat(other[modulus])) * Row::splat(scale);
            let distances = (d2 * r2).max(Row::splat(f64::from(f32::MIN_POSITIVE)));
            let radial = moduli * weights * shape * error / distances;
            for d in 0..3 {
                sums[d] = radial.mul_add(r[d], sums[d]);
            }
            sums[POWER] = radial.mul_add(vr, sums[POWER]);
        }
    }
    #[inline(always)]
    fn finish<Row: Lane<Scalar = f64>>(&self, sums: &[Row; MOST]) -> [Row; MOST] {
        let mut finished = *sums;
        finished[POWER] = sums[POWER] * Row::splat(-0.5);
        finished
    }
}

/// The sum of the deformation of a total-Lagrangian solid.
#[derive(Clone, Copy)]
struct Deformation;

impl Written for Deformation {
    fn outputs() -> Vec<(Output, usize)> {
        vec![(Output::matrix(name!("displacement_gradient", "1")), 9)]
    }
    #[inline(always)]
    fn pair<Row: Lane<Scalar = f64>, R: Record>(
        &self,
        apart: &Apart<Row>,
        own: &[Row; MOST],
        other: &[f64],
        sums: &mut [Row; MOST],
    ) {
        let [x, weight] = const { places::<R, 2>([Field::POSITION, Field::WEIGHT]) };
        let Apart { r: built, f, .. } = *apart;
        let factor = Row::splat(-other[weight]) * f;
        for a in 0..3 {
            let displaced = factor * (own[x + a] - Row::splat(other[x + a]) - built[a]);
            for b in 0..3 {
                sums[3 * a + b] = displaced.mul_add(built[b], sums[3 * a + b]);
            }
        }
    }
}

/// Sums of solids, alone and together.
pub fn table(over_kernel_at_spacing: f64, side: usize, turns: usize) {
    let repulsion = || Repulsion {
        exponent: 4,
        over_kernel_at_spacing,
    };
    let free = || HourglassFree { stiffness: 1.0 };
    let stress = (PressureForce, Hypoelastic);
    row("deviatoric stress", stress, Updated::<STRESS>, side, turns);
    let terms = (PressureForce, repulsion());
    row(
        "artificial stress",
        terms,
        Updated::<REPULSION>,
        side,
        turns,
    );
    let terms = (PressureForce, free());
    row("hourglass-free", terms, Updated::<HOURGLASS>, side, turns);
    let terms = (PressureForce, Hypoelastic, repulsion(), free());
    row(
        "all three",
        terms,
        Updated::<{ STRESS | REPULSION | HOURGLASS }>,
        side,
        turns,
    );
    let terms = (Compression, VelocityGradient);
    row("velocity gradient", terms, Gradients::<false>, side, turns);
    let terms = (Compression, VelocityGradient, VelocityMismatch);
    row(
        "velocity gradient, mismatch",
        terms,
        Gradients::<true>,
        side,
        turns,
    );
    let deformation = (DisplacementGradient,);
    row(
        "total-Lagrangian deformation",
        deformation,
        Deformation,
        side,
        turns,
    );
    row(
        "total-Lagrangian force",
        (StressForce,),
        Total::<false>,
        side,
        turns,
    );
    let control = HourglassControl { strength: STRENGTH };
    row(
        "hourglass control",
        (StressForce, control),
        Total::<true>,
        side,
        turns,
    );
}
