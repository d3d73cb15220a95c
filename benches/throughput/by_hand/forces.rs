//! Forces of liquids and gas, with and without energy, written out by hand.
//! What belongs to one particle of a pair alone is divided once a row, or once for all lanes, and a pair divides as rarely as it can.

use super::super::lattice::H;
use super::{Apart, MOST, Record, Written, over_shape_at_spacing, parting, places, row, skipped};
use meshfree::effect::TwoPhase;
use meshfree::name;
use meshfree::particles::{Field, Output};
use meshfree::scalar::Lane;
use meshfree::term::viscosity::MonaghanGingold;
use meshfree::term::{PressureForce, Viscosity};

const ALPHA: f64 = 0.02;
pub const SHARE: f64 = 0.3;
pub const CONDUCTION: f64 = 0.5;
pub const SHARPNESS: f64 = 0.02;

/// What a loop sums beside the pressure force.
pub const VISCOSITY: u16 = 1;
pub const LAMINAR: u16 = 1 << 1;
pub const TENSION: u16 = 1 << 2;
pub const ENERGY: u16 = 1 << 3;
/// Needs the energy.
pub const CONDUCTED: u16 = 1 << 4;
/// The same by the velocity at which pairs part.
pub const BY_VELOCITY: u16 = 1 << 5;
/// The repulsion of two phases.
pub const PHASES: u16 = 1 << 6;
/// Laminar viscosity along the line of centres.
pub const CENTRAL: u16 = 1 << 7;

/// Where the sums of [`Forces`] are, behind the force.
const SIGNAL: usize = 3;
const POWER: usize = 4;
const FLOW: usize = 5;

/// The pressure force and `WHAT`.
#[derive(Clone, Copy)]
pub struct Forces<const WHAT: u16>;

impl<const WHAT: u16> Written for Forces<WHAT> {
    fn outputs() -> Vec<(Output, usize)> {
        let count = |of: u16| usize::from(WHAT & of != 0);
        vec![
            (Output::FORCE, 3),
            (Output::SIGNAL, count(VISCOSITY)),
            (Output::POWER, count(ENERGY)),
            (
                Output::scalar(name!("artificial_conduction", "W")),
                count(CONDUCTED | BY_VELOCITY),
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
        let [m, rho, c] =
            const { places::<R, 3>([Field::MASS, Field::DENSITY, Field::SOUND_SPEED]) };
        let [weight, coefficient, mu, p, e, phase] = const {
            places::<R, 6>([
                Field::WEIGHT,
                Field::PRESSURE_COEFFICIENT,
                Field::DYNAMIC_VISCOSITY,
                Field::PRESSURE,
                Field::ENERGY,
                TwoPhase::PHASE,
            ])
        };
        let Apart { r, d2, shape, f } = *apart;
        let (mut jump, mut vr) = ([Row::zero(); 3], Row::zero());
        if WHAT & (VISCOSITY | LAMINAR | CENTRAL | ENERGY) != 0 {
            (jump, vr) = parting::<Row, R>(&r, own, other);
        }
        let weights = own[weight] * Row::splat(other[weight]);
        let stress = own[coefficient] + Row::splat(other[coefficient]);
        let mut along = weights * stress;
        let densities = own[rho] + Row::splat(other[rho]);
        let masses = own[m] * Row::splat(other[m]);
        let mut over_densities = Row::zero();
        if WHAT & VISCOSITY != 0 {
            let sounds = own[c] + Row::splat(other[c]);
            let over_h = d2.mul_add(Row::splat(1.0 / H), Row::splat(0.01 * H));
            let mut approach = vr.min(Row::zero());
            if WHAT & CONDUCTED != 0 {
                let one_over = (over_h * densities).recip();
                over_densities = one_over * over_h;
                approach = approach * one_over;
            } else {
                approach = approach / (over_h * densities);
            }
            let speed = sounds * Row::splat(ALPHA);
            along = masses.mul_add(-(approach * speed), along);
            let inside = f.lt(Row::zero());
            let signal = speed * Row::splat(0.3);
            sums[SIGNAL] = sums[SIGNAL].max(Row::select(inside, signal, Row::zero()));
        } else if WHAT & (CONDUCTED | BY_VELOCITY) != 0 {
            over_densities = densities.recip();
        }
        if WHAT & TENSION != 0 {
            // The kernel over its value at the spacing, to the fourth power.
            let ratio = shape * Row::splat(over_shape_at_spacing());
            let square = ratio * ratio;
            let tension = (-own[p]).positive_part() + Row::splat((-other[p]).max(0.0));
            let pull = tension * Row::splat(SHARE) * (square * square);
            along = weights.mul_add(pull, along);
        }
        if WHAT & PHASES != 0 {
            let other_phase = Row::splat(other[phase]);
            let unlike = own[phase].lt(other_phase) | other_phase.lt(own[phase]);
            let push = own[p].abs() + Row::splat(other[p].abs());
            let push = Row::select(unlike, push * Row::splat(SHARPNESS), Row::zero());
            along = weights.mul_add(push, along);
        }
        if WHAT & CENTRAL != 0 {
            // By one division, as below.
            let mean = masses * own[mu] * Row::splat(-20.0 * other[mu]);
            let below = own[rho] * Row::splat(other[rho]) * (own[mu] + Row::splat(other[mu]));
            let distance2 = d2 + Row::splat(1e-6 * H * H);
            along = along + mean * vr / (below * distance2);
        }
        let radial = -(along * f);
        for d in 0..3 {
            sums[d] = radial.mul_add(r[d], sums[d]);
        }
        let mut power = radial * vr;
        if WHAT & LAMINAR != 0 {
            // 4 Vᵢ Vⱼ μᵢ μⱼ/(μᵢ + μⱼ) F by one division.
            let mean = masses * own[mu] * Row::splat(4.0 * other[mu]);
            let below = own[rho] * Row::splat(other[rho]) * (own[mu] + Row::splat(other[mu]));
            let shear = mean * f / below;
            for d in 0..3 {
                sums[d] = shear.mul_add(jump[d], sums[d]);
                power = (shear * jump[d]).mul_add(jump[d], power);
            }
        }
        if WHAT & ENERGY != 0 {
            sums[POWER] = sums[POWER] + power;
        }
        if WHAT & BY_VELOCITY != 0 {
            let rate = masses * vr.abs() * (f * over_densities);
            sums[FLOW] = rate.mul_add(own[e] - Row::splat(other[e]), sums[FLOW]);
        }
        if WHAT & CONDUCTED != 0 {
            let difference = (own[p] - Row::splat(other[p])).abs();
            let speed = ((difference + difference) * d2 * over_densities).root();
            let rate = masses * speed * (f * over_densities);
            sums[FLOW] = rate.mul_add(own[e] - Row::splat(other[e]), sums[FLOW]);
        }
    }
    #[inline(always)]
    fn finish<Row: Lane<Scalar = f64>>(&self, sums: &[Row; MOST]) -> [Row; MOST] {
        let mut finished = *sums;
        let mut k = 3;
        if WHAT & VISCOSITY != 0 {
            k += 1;
        }
        let flow = sums[FLOW] * Row::splat(2.0 * CONDUCTION);
        if WHAT & ENERGY != 0 {
            finished[k] = sums[POWER].mul_add(Row::splat(-0.5), flow);
            k += 1;
        }
        if WHAT & (CONDUCTED | BY_VELOCITY) != 0 {
            finished[k] = flow;
        }
        finished
    }
}

pub fn viscosity() -> Viscosity<MonaghanGingold> {
    Viscosity(MonaghanGingold {
        alpha: ALPHA,
        beta: 0.0,
    })
}

/// Pressure and artificial viscosity alone: what the gate holds.
pub fn with_viscosity(side: usize, turns: usize) -> f64 {
    if skipped() {
        return 1.0;
    }
    let terms = (PressureForce, viscosity());
    row(
        "composed over written out by hand",
        terms,
        Forces::<VISCOSITY>,
        side,
        turns,
    )
}
