//! What wall particles sum over the liquid before them, written out by hand, and the rows of its table.
//! All of it is linear in the kernel, whose factor in front comes last; what belongs to a neighbour alone is made once for all lanes.

use super::by_hand::{Apart, MOST, Record, Written, norm, places, row};
use super::lattice::H;
use meshfree::effect::parts::VelocityBeforeWall;
use meshfree::name;
use meshfree::particles::{Field, Output};
use meshfree::scalar::Lane;
use meshfree::term::parts::{LiquidNearWall, VelocityAtWall, ViscosityAtWall};

/// What a loop sums beside the pressure of the liquid: its velocity for walls as Riemann problems, or velocity, arm and viscosity
/// for walls without slip.
const BEFORE: u8 = 1;
const NO_SLIP: u8 = 2;

/// Where the sums are, behind unity.
const PRESSURE: usize = 1;
const MOMENT: usize = 2;
const VELOCITY: usize = 5;
const ARM: usize = 8;
const VISCOSITY: usize = 11;

#[derive(Clone, Copy)]
struct Wall<const WHAT: u8>;

impl<const WHAT: u8> Written for Wall<WHAT> {
    fn outputs() -> Vec<(Output, usize)> {
        let count = |of: u8, components: usize| if WHAT & of != 0 { components } else { 0 };
        vec![
            (Output::UNITY, 1),
            (Output::LIQUID_PRESSURE, 1),
            (Output::LIQUID_MOMENT, 3),
            (
                Output::vector(name!("liquid_velocity_before_wall", "m/s")),
                count(BEFORE, 3),
            ),
            (Output::LIQUID_VELOCITY, count(NO_SLIP, 3)),
            (Output::LIQUID_ARM, count(NO_SLIP, 3)),
            (Output::LIQUID_VISCOSITY, count(NO_SLIP, 1)),
        ]
    }
    #[inline(always)]
    fn pair<Row: Lane<Scalar = f64>, R: Record>(
        &self,
        apart: &Apart<Row>,
        _own: &[Row; MOST],
        other: &[f64],
        sums: &mut [Row; MOST],
    ) {
        let [m, rho, p, v, mu] = const {
            places::<R, 5>([
                Field::MASS,
                Field::DENSITY,
                Field::PRESSURE,
                Field::VELOCITY,
                Field::DYNAMIC_VISCOSITY,
            ])
        };
        let Apart { r, shape, .. } = *apart;
        let volume = Row::splat(other[m] / other[rho]) * shape;
        sums[0] = sums[0] + volume;
        sums[PRESSURE] = volume.mul_add(Row::splat(other[p]), sums[PRESSURE]);
        let mass = Row::splat(other[m]) * shape;
        for d in 0..3 {
            sums[MOMENT + d] = mass.mul_add(r[d], sums[MOMENT + d]);
        }
        if WHAT != 0 {
            for d in 0..3 {
                sums[VELOCITY + d] = volume.mul_add(Row::splat(other[v + d]), sums[VELOCITY + d]);
            }
        }
        if WHAT & NO_SLIP != 0 {
            for d in 0..3 {
                sums[ARM + d] = volume.mul_add(r[d], sums[ARM + d]);
            }
            sums[VISCOSITY] = volume.mul_add(Row::splat(other[mu]), sums[VISCOSITY]);
        }
    }
    #[inline(always)]
    fn finish<Row: Lane<Scalar = f64>>(&self, sums: &[Row; MOST]) -> [Row; MOST] {
        let mut finished = *sums;
        for sum in &mut finished[..=VISCOSITY] {
            *sum = *sum * Row::splat(norm() / H.powi(3));
        }
        finished
    }
}

/// The wall laws.
pub fn table(side: usize, turns: usize) {
    row("wall: pressure", (LiquidNearWall,), Wall::<0>, side, turns);
    row(
        "wall: pressure, velocity before it",
        (LiquidNearWall, VelocityBeforeWall),
        Wall::<BEFORE>,
        side,
        turns,
    );
    row(
        "wall: pressure, no slip",
        (LiquidNearWall, VelocityAtWall, ViscosityAtWall),
        Wall::<NO_SLIP>,
        side,
        turns,
    );
}
