//! Sums of places and volumes of liquids, written out by hand: compression, and what is summed with it.
//! What belongs to one particle of a pair alone is divided once a row, or once for all lanes.

use super::by_hand::{Apart, MOST, Record, Written, norm, over_shape_at_spacing, parting, places};
use super::lattice::H;
use meshfree::effect::{ConsistentShifting, TwoPhase};
use meshfree::name;
use meshfree::particles::{Field, Output};
use meshfree::scalar::Lane;

pub const DELTA: f64 = 0.1;
pub const REPULSION: f64 = 0.2;

/// What a loop sums of places and volumes.
pub const COMPRESSION: u16 = 1 << 5;
pub const DIFFUSION: u16 = 1;
pub const SHIFTING: u16 = 1 << 1;
pub const PAIRING: u16 = 1 << 2;
pub const CONSISTENCY: u16 = 1 << 3;
/// What consistent shifting does to density.
pub const SHIFTED: u16 = 1 << 4;
/// What the velocity of consistent shifting is made of, without compression.
pub const CROWDING: u16 = 1 << 6;

/// Diffusion within one of two phases, of density, of what is left of it by linear fields, and by a Riemann solver.
pub const WITHIN: u16 = 1 << 7;
pub const OF_DENSITY: u16 = 1 << 8;
pub const OF_BENT: u16 = 1 << 9;
pub const BY_RIEMANN: u16 = 1 << 10;
/// All that diffuse.
const DIFFUSIONS: u16 = DIFFUSION | WITHIN | OF_DENSITY | OF_BENT | BY_RIEMANN;
/// Densities by sums: the kernel, its first moment, and its slope in h.
pub const SUMMED: u16 = 1 << 11;
pub const FIRST_MOMENT: u16 = 1 << 12;
pub const SLOPE: u16 = 1 << 13;

/// Where the sums of [`Continuity`] are, behind the compression.
const DIFFUSED: usize = 1;
const CONCENTRATION: usize = 2;
const MOMENT: usize = 5;
const NEAR: usize = 6;
const UNITY: usize = 9;
const RATE: usize = 10;
const OUTWARDS: usize = 11;
const KERNEL: usize = 14;
const CONTACT: usize = 15;
const SLOPES: usize = 16;

/// The sums of `WHAT`.
#[derive(Clone, Copy)]
pub struct Continuity<const WHAT: u16>;

impl<const WHAT: u16> Continuity<WHAT> {
    /// What is summed, its first sum, and how many there are.
    fn sums() -> [(Output, usize, usize); 13] {
        let count = |of: u16, components: usize| if WHAT & of != 0 { components } else { 0 };
        [
            (Output::COMPRESSION, 0, count(COMPRESSION, 1)),
            (Output::DENSITY_DIFFUSION, DIFFUSED, count(DIFFUSIONS, 1)),
            (
                Output::CONCENTRATION_GRADIENT,
                CONCENTRATION,
                count(SHIFTING, 3),
            ),
            (Output::MOMENT, MOMENT, count(SHIFTING | FIRST_MOMENT, 1)),
            (
                Output::vector(name!("near_pairs", "1/m")),
                NEAR,
                count(PAIRING, 3),
            ),
            (Output::UNITY, UNITY, count(CONSISTENCY, 1)),
            (
                Output::scalar(name!("density_rate_of_shifting", "kg/(m³ s)")),
                RATE,
                count(SHIFTED, 1),
            ),
            (
                Output::vector(name!("crowding", "1/m")),
                CONCENTRATION,
                count(CROWDING, 3),
            ),
            (
                Output::vector(name!("outwards", "1/m")),
                OUTWARDS,
                count(CROWDING, 3),
            ),
            (
                Output::scalar(name!("gradient_moment", "1")),
                MOMENT,
                count(CROWDING, 1),
            ),
            (Output::KERNEL_SUM, KERNEL, count(SUMMED, 1)),
            // Across contacts, of which there are none.
            (Output::CONTACT_SUM, CONTACT, count(SUMMED, 1)),
            (Output::SLOPE_IN_H, SLOPES, count(SLOPE, 1)),
        ]
    }
}

impl<const WHAT: u16> Written for Continuity<WHAT> {
    fn outputs() -> Vec<(Output, usize)> {
        let sums = Self::sums().into_iter();
        sums.map(|(output, _, count)| (output, count)).collect()
    }
    #[inline(always)]
    fn prepare<Row: Lane<Scalar = f64>, R: Record>(&self, own: &mut [Row; MOST]) {
        let [c, rho, shift, bend] = const {
            places::<R, 4>([
                Field::SOUND_SPEED,
                Field::DENSITY,
                ConsistentShifting::VELOCITY,
                Field::DENSITY_GRADIENT,
            ])
        };
        if WHAT & (DIFFUSION | WITHIN) != 0 {
            own[c] = Row::splat(2.0 * DELTA * H) / own[c];
        }
        if WHAT & OF_BENT != 0 {
            for d in 0..3 {
                own[bend + d] = own[bend + d] * Row::splat(-0.5);
            }
        }
        if WHAT & SHIFTED != 0 {
            for d in 0..3 {
                own[shift + d] = own[shift + d] * (own[rho] + own[rho]);
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
        let [m, rho, c] =
            const { places::<R, 3>([Field::MASS, Field::DENSITY, Field::SOUND_SPEED]) };
        let [weight, p, shift, phase, bend] = const {
            places::<R, 5>([
                Field::WEIGHT,
                Field::PRESSURE,
                ConsistentShifting::VELOCITY,
                TwoPhase::PHASE,
                Field::DENSITY_GRADIENT,
            ])
        };
        let Apart { r, d2, shape, f } = *apart;
        let gradient = Row::splat(other[weight]) * f;
        if WHAT & COMPRESSION != 0 {
            let (_, vr) = parting::<Row, R>(&r, own, other);
            sums[0] = gradient.mul_add(vr, sums[0]);
        }
        if WHAT & (DIFFUSION | WITHIN) != 0 {
            // Without a body force nothing is hydrostatic.
            let mut difference = own[p] - Row::splat(other[p]);
            if WHAT & WITHIN != 0 {
                let its = Row::splat(other[phase]);
                let alike = own[phase].le(its) & its.le(own[phase]);
                difference = Row::select(alike, difference, Row::zero());
            }
            sums[DIFFUSED] = (gradient * own[c]).mul_add(difference, sums[DIFFUSED]);
        }
        if WHAT & (OF_DENSITY | OF_BENT) != 0 {
            let mut jump = own[rho] - Row::splat(other[rho]);
            if WHAT & OF_BENT != 0 {
                for d in 0..3 {
                    // The row has its half, negative.
                    let mean = own[bend + d] - Row::splat(0.5 * other[bend + d]);
                    jump = mean.mul_add(r[d], jump);
                }
            }
            let sounds = own[c] + Row::splat(other[c]);
            sums[DIFFUSED] = (gradient * sounds).mul_add(jump, sums[DIFFUSED]);
        }
        if WHAT & BY_RIEMANN != 0 {
            let jump = (own[p] - Row::splat(other[p])) * d2.sqrt();
            let sounds = own[c] + Row::splat(other[c]);
            sums[DIFFUSED] = gradient.mul_add(jump / sounds, sums[DIFFUSED]);
        }
        if WHAT & SUMMED != 0 {
            sums[KERNEL] = Row::splat(other[weight]).mul_add(shape, sums[KERNEL]);
        }
        if WHAT & (FIRST_MOMENT | SLOPE) != 0 {
            sums[MOMENT] = gradient.mul_add(d2, sums[MOMENT]);
        }
        if WHAT & (SHIFTING | CROWDING) != 0 {
            let square = shape * shape;
            let fourth = over_shape_at_spacing().powi(4);
            let weighted =
                gradient * (square * square).mul_add(Row::splat(REPULSION * fourth), Row::one());
            for d in 0..3 {
                sums[CONCENTRATION + d] = weighted.mul_add(r[d], sums[CONCENTRATION + d]);
            }
            sums[MOMENT] = gradient.mul_add(d2, sums[MOMENT]);
        }
        if WHAT & CROWDING != 0 {
            for d in 0..3 {
                sums[OUTWARDS + d] = gradient.mul_add(r[d], sums[OUTWARDS + d]);
            }
        }
        if WHAT & PAIRING != 0 {
            let excess = shape.mul_add(Row::splat(over_shape_at_spacing()), -Row::one());
            let near = gradient * excess.positive_part();
            for d in 0..3 {
                sums[NEAR + d] = near.mul_add(r[d], sums[NEAR + d]);
            }
        }
        if WHAT & CONSISTENCY != 0 {
            let volume = Row::splat(other[m] / other[rho]);
            sums[UNITY] = volume.mul_add(shape, sums[UNITY]);
        }
        if WHAT & SHIFTED != 0 {
            // ρᵢ (δuᵢ − δuⱼ) + ρᵢ δuᵢ + ρⱼ δuⱼ, of which the row has 2 ρᵢ δuᵢ.
            let (mut mine, mut its) = (Row::zero(), Row::zero());
            for d in 0..3 {
                mine = own[shift + d].mul_add(r[d], mine);
                its = Row::splat(other[shift + d]).mul_add(r[d], its);
            }
            let moved = (Row::splat(other[rho]) - own[rho]).mul_add(its, mine);
            sums[RATE] = gradient.mul_add(moved, sums[RATE]);
        }
    }
    #[inline(always)]
    fn finish<Row: Lane<Scalar = f64>>(&self, sums: &[Row; MOST]) -> [Row; MOST] {
        let mut sums = *sums;
        let kernel = Row::splat(norm() / H.powi(3));
        sums[KERNEL] = sums[KERNEL] * kernel;
        // ∂W/∂h = −(3 W + r² F)/h
        let slopes = sums[KERNEL].mul_add(Row::splat(3.0), sums[MOMENT]);
        sums[SLOPES] = slopes * Row::splat(-1.0 / H);
        if WHAT & (OF_DENSITY | OF_BENT) != 0 {
            sums[DIFFUSED] = sums[DIFFUSED] * Row::splat(DELTA * H);
        }
        if WHAT & BY_RIEMANN != 0 {
            sums[DIFFUSED] = sums[DIFFUSED] + sums[DIFFUSED];
        }
        if WHAT & CROWDING == 0 {
            sums[MOMENT] = sums[MOMENT] * Row::splat(-1.0 / 3.0);
        }
        sums[UNITY] = sums[UNITY] * kernel;
        let (mut finished, mut at) = ([Row::zero(); MOST], 0);
        for (_, first, count) in Self::sums() {
            for k in 0..count {
                finished[at] = sums[first + k];
                at += 1;
            }
        }
        finished
    }
}
