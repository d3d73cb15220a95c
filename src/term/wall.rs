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
    const READS: Fields = Fields::of(&[Field::Mass, Field::Density, Field::Pressure]);
    const WRITES: Outputs =
        Outputs::of(&[Output::Unity, Output::LiquidPressure, Output::LiquidMoment]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let mass = pair.j(Field::Mass) * pair.w * pair.mobile;
        let volume = mass / pair.j(Field::Density);
        sums.add(Output::Unity, volume);
        sums.add(Output::LiquidPressure, volume * pair.j(Field::Pressure));
        for d in 0..D {
            sums.add_at(Output::LiquidMoment, d, mass * pair.r[d]);
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

/// The sum from which a wall particle takes the velocity of the liquid before it, Σ V v W.
#[derive(Clone, Copy, Debug)]
pub struct VelocityAtWall;

impl<const D: usize> Term<D> for VelocityAtWall {
    const READS: Fields = Fields::of(&[Field::Mass, Field::Density, Field::Velocity]);
    const WRITES: Outputs = Outputs::of(&[Output::LiquidVelocity]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let volume = pair.j(Field::Mass) / pair.j(Field::Density) * pair.w * pair.mobile;
        for d in 0..D {
            let v = pair.j_at(Field::Velocity, d);
            sums.add_at(Output::LiquidVelocity, d, volume * v);
        }
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "velocity of the liquid at walls, mirrored where it sticks".into(),
            equation: "Σ v_f W / Σ W, v_w = 2 v_wall − Σ v_f W / Σ W",
            source: "Adami, Hu & Adams 2012, eqs. 22, 23",
        }
    }
}

/// The sum from which a wall particle without slip takes its viscosity, Σ V μ W.
#[derive(Clone, Copy, Debug)]
pub struct ViscosityAtWall;

impl<const D: usize> Term<D> for ViscosityAtWall {
    const READS: Fields = Fields::of(&[Field::Mass, Field::Density, Field::DynamicViscosity]);
    const WRITES: Outputs = Outputs::of(&[Output::LiquidViscosity]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let volume = pair.j(Field::Mass) / pair.j(Field::Density) * pair.w * pair.mobile;
        let viscosity = pair.j(Field::DynamicViscosity);
        sums.add(Output::LiquidViscosity, volume * viscosity);
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "viscosity of walls without slip".into(),
            equation: "μ_w = Σ μ_f W / Σ W",
            source: "the interpolation of Adami, Hu & Adams 2012, eq. 22, for viscosities that vary",
        }
    }
}
