//! What a wall particle sums over the liquid before it.
//! Adami, Hu & Adams 2012, equations 22 and 27.

use super::{Layout, Pair, Sums, Term, TermDoc};
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::Lane;

/// The sums from which a wall particle takes its pressure: Σ V W, Σ V p W and Σ V ρ r W over liquid.
///
/// p_w = [Σ p_f W + (g − a_w)·Σ ρ_f r_wf W] / Σ W (Adami, Hu & Adams 2012, eq. 27), with volumes so
/// that liquids of several densities may meet a wall.
#[derive(Clone, Copy, Debug)]
pub struct LiquidNearWall;

impl<const D: usize> Term<D> for LiquidNearWall {
    const NAME: &'static str = "meshfree::liquid_near_wall";
    const READS: Fields = Fields::of(&[Field::MASS, Field::DENSITY, Field::PRESSURE]);
    const WRITES: Outputs = Outputs::of(&[
        Output::UNITY,
        Output::LIQUID_PRESSURE,
        Output::LIQUID_MOMENT,
    ]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let liquid = pair.w * pair.mobile;
        // A quotient of the neighbour alone is made once for a row.
        let volume = pair.j(Field::MASS) / pair.j(Field::DENSITY) * liquid;
        sums.add(Output::UNITY, volume);
        sums.add_product(Output::LIQUID_PRESSURE, volume, pair.j(Field::PRESSURE));
        let mass = pair.j(Field::MASS) * liquid;
        for d in 0..D {
            sums.add_product_at(Output::LIQUID_MOMENT, d, mass, pair.r[d]);
        }
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "pressure of walls".into(),
            equation: "p_w = [Σ p_f W + (g − a_w)·Σ ρ_f r_wf W] / Σ W",
            source: "Adami, Hu & Adams 2012, eq. 27",
        }
    }
}

/// The sums from which a wall particle takes the velocity of the liquid before it relative to the wall, Σ V v W and Σ V r W.
///
/// Where the velocity of the wall is the linear field v_w + L·(x − x_w), as that of anything rigid is, the liquid moves
/// relative to it by v_f − v_w + L·r at a place x_w − r.
#[derive(Clone, Copy, Debug)]
pub struct VelocityAtWall;

impl<const D: usize> Term<D> for VelocityAtWall {
    const NAME: &'static str = "meshfree::velocity_at_wall";
    const READS: Fields = Fields::of(&[Field::MASS, Field::DENSITY, Field::VELOCITY]);
    const WRITES: Outputs = Outputs::of(&[Output::LIQUID_VELOCITY, Output::LIQUID_ARM]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let volume = pair.j(Field::MASS) / pair.j(Field::DENSITY) * (pair.w * pair.mobile);
        for d in 0..D {
            let v = pair.j_at(Field::VELOCITY, d);
            sums.add_product_at(Output::LIQUID_VELOCITY, d, volume, v);
            sums.add_product_at(Output::LIQUID_ARM, d, volume, pair.r[d]);
        }
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "velocity of the liquid at walls, mirrored where it sticks".into(),
            equation: "v_w = v_wall(x_w) − Σ (v_f − v_wall(x_f)) W / Σ W",
            source: "Adami, Hu & Adams 2012, eqs. 22, 23, in the frame of the wall",
        }
    }
}

/// The sum from which a wall particle without slip takes its viscosity, Σ V μ W.
#[derive(Clone, Copy, Debug)]
pub struct ViscosityAtWall;

impl<const D: usize> Term<D> for ViscosityAtWall {
    const NAME: &'static str = "meshfree::viscosity_at_wall";
    const READS: Fields = Fields::of(&[Field::MASS, Field::DENSITY, Field::DYNAMIC_VISCOSITY]);
    const WRITES: Outputs = Outputs::of(&[Output::LIQUID_VISCOSITY]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let volume = pair.j(Field::MASS) / pair.j(Field::DENSITY) * (pair.w * pair.mobile);
        let viscosity = pair.j(Field::DYNAMIC_VISCOSITY);
        sums.add_product(Output::LIQUID_VISCOSITY, volume, viscosity);
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "viscosity of walls without slip".into(),
            equation: "μ_w = Σ μ_f W / Σ W",
            source: "the interpolation of Adami, Hu & Adams 2012, eq. 22, for viscosities that vary",
        }
    }
}
