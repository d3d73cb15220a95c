//! Forces, compression and gradients that are exact for linear fields, written out by hand, and the rows of their table.
//! Of the corrected stress the row's side is one matrix, multiplied once a row; matrices of moments are symmetric, so six sums.

use super::by_hand::{Apart, MOST, Record, Written, parting, places, row};
use meshfree::effect::{Hypoelastic, RenormalisedHypoelastic};
use meshfree::particles::{Field, Output};
use meshfree::scalar::Lane;
use meshfree::term::{
    MidpointReconstruction, PressureForce, RenormalisedPressureForce,
    parts::{DensityGradient, MomentMatrix, PressureGradient, RenormalisedCompression},
};

/// Where xx, xy, xz, yx, … of a symmetric tensor stand in its six numbers.
const SIX: [usize; 9] = [0, 5, 4, 5, 1, 3, 4, 3, 2];

/// What of corrected forces a loop sums.
const PRESSURE: u8 = 1;
const STRESS: u8 = 2;

#[derive(Clone, Copy)]
struct Force<const WHAT: u8>;

impl<const WHAT: u8> Written for Force<WHAT> {
    fn outputs() -> Vec<(Output, usize)> {
        vec![(Output::FORCE, 3)]
    }
    #[inline(always)]
    fn prepare<Row: Lane<Scalar = f64>, R: Record>(&self, own: &mut [Row; MOST]) {
        let [m, rho, weight, coefficient] = const {
            places::<R, 4>([
                Field::MASS,
                Field::DENSITY,
                Field::WEIGHT,
                Field::PRESSURE_COEFFICIENT,
            ])
        };
        let [correction, stress] =
            const { places::<R, 2>([Field::CORRECTION, Hypoelastic::STRESS]) };
        if WHAT & STRESS != 0 {
            own[m] = own[m] / own[rho];
        }
        if WHAT & PRESSURE != 0 {
            own[coefficient] = own[coefficient] * own[weight];
        }
        if WHAT == PRESSURE {
            for k in 0..9 {
                own[correction + k] = own[correction + k] * own[coefficient];
            }
        }
        if WHAT == STRESS {
            let mut product = [Row::zero(); 9];
            for a in 0..3 {
                for b in 0..3 {
                    for c in 0..3 {
                        product[3 * a + b] = own[stress + SIX[3 * a + c]]
                            .mul_add(own[correction + 3 * c + b], product[3 * a + b]);
                    }
                }
            }
            own[correction..correction + 9].copy_from_slice(&product);
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
        let [m, rho, weight, coefficient] = const {
            places::<R, 4>([
                Field::MASS,
                Field::DENSITY,
                Field::WEIGHT,
                Field::PRESSURE_COEFFICIENT,
            ])
        };
        let [correction, stress] =
            const { places::<R, 2>([Field::CORRECTION, Hypoelastic::STRESS]) };
        let Apart { r, f, .. } = *apart;
        let (mut mine, mut its) = ([Row::zero(); 3], [Row::zero(); 3]);
        for a in 0..3 {
            for b in 0..3 {
                let at = correction + 3 * a + b;
                mine[a] = own[at].mul_add(r[b], mine[a]);
                its[a] = Row::splat(other[at]).mul_add(r[b], its[a]);
            }
        }
        let mut force = [Row::zero(); 3];
        if WHAT & STRESS != 0 {
            for a in 0..3 {
                if WHAT == STRESS {
                    force[a] = mine[a];
                }
                for b in 0..3 {
                    let at = stress + SIX[3 * a + b];
                    if WHAT != STRESS {
                        force[a] = own[at].mul_add(mine[b], force[a]);
                    }
                    force[a] = Row::splat(other[at]).mul_add(its[b], force[a]);
                }
            }
            let volumes = own[m] * Row::splat(other[m] / other[rho]) * f;
            for a in 0..3 {
                force[a] = force[a] * volumes;
            }
        }
        if WHAT & PRESSURE != 0 {
            // Bᵢ Xᵢ Bⱼ and Bᵢ Xⱼ Bⱼ, of which the row has Bᵢ Xᵢ, and alone has it in its matrix.
            let factor = Row::splat(-other[weight]) * f;
            let pushed = factor * own[weight] * Row::splat(other[coefficient]);
            let push = if WHAT == PRESSURE {
                factor
            } else {
                factor * own[coefficient]
            };
            for a in 0..3 {
                force[a] = push.mul_add(mine[a], pushed.mul_add(its[a], force[a]));
            }
        }
        for a in 0..3 {
            sums[a] = sums[a] + force[a];
        }
    }
}

const STRENGTH: f64 = 1.0 / 3.0;

/// The pressure force, and what its reconstruction at the middle of pairs adds.
#[derive(Clone, Copy)]
struct Midpoint;

impl Written for Midpoint {
    fn outputs() -> Vec<(Output, usize)> {
        vec![(Output::FORCE, 3)]
    }
    #[inline(always)]
    fn prepare<Row: Lane<Scalar = f64>, R: Record>(&self, own: &mut [Row; MOST]) {
        let [m, rho] = const { places::<R, 2>([Field::MASS, Field::DENSITY]) };
        own[m] = own[m] / own[rho] * Row::splat(4.0 * STRENGTH);
    }
    #[inline(always)]
    fn pair<Row: Lane<Scalar = f64>, R: Record>(
        &self,
        apart: &Apart<Row>,
        own: &[Row; MOST],
        other: &[f64],
        sums: &mut [Row; MOST],
    ) {
        let [m, rho, weight, coefficient, gradient, s] = const {
            places::<R, 6>([
                Field::MASS,
                Field::DENSITY,
                Field::WEIGHT,
                Field::PRESSURE_COEFFICIENT,
                Field::PRESSURE_GRADIENT,
                Field::CONSISTENCY_FACTOR,
            ])
        };
        let Apart { r, f, .. } = *apart;
        let pressures = own[coefficient] + Row::splat(other[coefficient]);
        let along = own[weight] * Row::splat(other[weight]) * pressures;
        let mut bend = Row::zero();
        for d in 0..3 {
            bend = (own[gradient + d] - Row::splat(other[gradient + d])).mul_add(r[d], bend);
        }
        let moments = own[s] + Row::splat(other[s]);
        let bent = own[m] * Row::splat(other[m] / other[rho]) * bend / moments;
        let radial = (bent - along) * f;
        for d in 0..3 {
            sums[d] = radial.mul_add(r[d], sums[d]);
        }
    }
}

/// The corrected rate of compression.
#[derive(Clone, Copy)]
struct Compression;

impl Written for Compression {
    fn outputs() -> Vec<(Output, usize)> {
        vec![(Output::COMPRESSION, 1)]
    }
    #[inline(always)]
    fn pair<Row: Lane<Scalar = f64>, R: Record>(
        &self,
        apart: &Apart<Row>,
        own: &[Row; MOST],
        other: &[f64],
        sums: &mut [Row; MOST],
    ) {
        let [weight, correction] = const { places::<R, 2>([Field::WEIGHT, Field::CORRECTION]) };
        let Apart { r, f, .. } = *apart;
        let (jump, _) = parting::<Row, R>(&r, own, other);
        let mut along = Row::zero();
        for a in 0..3 {
            let mut turned = Row::zero();
            for b in 0..3 {
                turned = own[correction + 3 * a + b].mul_add(r[b], turned);
            }
            along = turned.mul_add(jump[a], along);
        }
        sums[0] = (Row::splat(other[weight]) * f).mul_add(along, sums[0]);
    }
}

/// The gradient of pressure or density, with the moment matrix that corrects it.
#[derive(Clone, Copy)]
struct Gradient<const OF_DENSITY: bool>;

impl<const OF_DENSITY: bool> Written for Gradient<OF_DENSITY> {
    fn outputs() -> Vec<(Output, usize)> {
        let gradient = if OF_DENSITY {
            Output::DENSITY_GRADIENT
        } else {
            Output::PRESSURE_GRADIENT
        };
        vec![(gradient, 3), (Output::MOMENT_MATRIX, 9)]
    }
    #[inline(always)]
    fn pair<Row: Lane<Scalar = f64>, R: Record>(
        &self,
        apart: &Apart<Row>,
        own: &[Row; MOST],
        other: &[f64],
        sums: &mut [Row; MOST],
    ) {
        let [m, rho, p] = const { places::<R, 3>([Field::MASS, Field::DENSITY, Field::PRESSURE]) };
        let value = if OF_DENSITY { rho } else { p };
        let Apart { r, f, .. } = *apart;
        let factor = Row::splat(-other[m] / other[rho]) * f;
        let difference = own[value] - Row::splat(other[value]);
        let mut k = 3;
        for b in 0..3 {
            let gradient = factor * r[b];
            sums[b] = difference.mul_add(gradient, sums[b]);
            for a in 0..=b {
                sums[k] = r[a].mul_add(gradient, sums[k]);
                k += 1;
            }
        }
    }
    #[inline(always)]
    fn finish<Row: Lane<Scalar = f64>>(&self, sums: &[Row; MOST]) -> [Row; MOST] {
        let mut finished = *sums;
        let mut k = 3;
        for b in 0..3 {
            for a in 0..=b {
                finished[3 + 3 * a + b] = sums[k];
                finished[3 + 3 * b + a] = sums[k];
                k += 1;
            }
        }
        finished
    }
}

/// What corrected and reconstructed gradients cost.
pub fn table(side: usize, turns: usize) {
    let (pressure, stress) = (RenormalisedPressureForce, RenormalisedHypoelastic);
    row(
        "corrected pressure",
        (pressure,),
        Force::<PRESSURE>,
        side,
        turns,
    );
    row("corrected stress", (stress,), Force::<STRESS>, side, turns);
    let both = Force::<{ PRESSURE | STRESS }>;
    row(
        "corrected pressure, stress",
        (pressure, stress),
        both,
        side,
        turns,
    );
    let terms = (RenormalisedCompression,);
    row("corrected compression", terms, Compression, side, turns);
    let midpoint = MidpointReconstruction { strength: STRENGTH };
    let terms = (PressureForce, midpoint);
    row("midpoint reconstruction", terms, Midpoint, side, turns);
    let terms = (MomentMatrix, PressureGradient);
    row("pressure gradient", terms, Gradient::<false>, side, turns);
    let terms = (DensityGradient,);
    row("density gradient", terms, Gradient::<true>, side, turns);
}
