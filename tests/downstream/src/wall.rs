//! A wall law: walls that show a liquid its mean pressure, each neighbour's brought to the wall's height.
//! After S. Adami, X. Y. Hu, N. A. Adams, Journal of Computational Physics 231 (2012) 7057–7075.

use meshfree::effect::{Effect, Point, PointLaw, Reach, Setting, StepProgram};
use meshfree::name;
use meshfree::particles::{Field, Fields, Output, Outputs};
use meshfree::scalar::{Lane, Real};
use meshfree::term::{In, Layout, Pair, Stage, Sums, Term, TermDoc, stage};

/// Σ V (p + ρ g·r) W \[Pa\] and Σ V W over the liquid before a wall.
const LEVELLED: [Output; 2] = [
    Output::scalar(name!("level_pressure", "Pa")),
    Output::scalar(name!("share_of_liquid", "1")),
];

/// Walls that do not move, with p_w = Σ V (p + ρ g·r_wf) W / Σ V W and no floor: they hold what they touch.
#[derive(Clone, Copy, Debug, Default)]
pub struct LevelWall;

impl<const D: usize> Effect<D> for LevelWall {
    type Terms = (In<stage::Walls, LevelWall>,);
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(*self),)
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.law(Stage::Walls, *self);
    }
}

impl<const D: usize> Term<D> for LevelWall {
    const NAME: &'static str = "downstream::level_wall";
    const READS: Fields = Fields::of(&[Field::MASS, Field::DENSITY, Field::PRESSURE]);
    const WRITES: Outputs = Outputs::of(&LEVELLED);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let volume = pair.j(Field::MASS) / pair.j(Field::DENSITY) * pair.w * pair.mobile;
        let mut depth = L::zero();
        for d in 0..D {
            depth = pair.body_force[d].mul_add(pair.r[d], depth);
        }
        let pressure = pair
            .j(Field::DENSITY)
            .mul_add(depth, pair.j(Field::PRESSURE));
        sums.add(LEVELLED[0], volume * pressure);
        sums.add(LEVELLED[1], volume);
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "level pressure of walls".into(),
            equation: "p_w = Σ V (p + ρ g·r_wf) W / Σ V W",
            source: "after Adami, Hu & Adams 2012, eq. 27",
        }
    }
}

impl<const D: usize> PointLaw<D> for LevelWall {
    const NAME: &'static str = "level pressure of walls";
    const READS: Fields = Fields::NONE;
    const WRITES: Fields = Fields::of(&[Field::PRESSURE]);
    const SUMS: Outputs = Outputs::of(&LEVELLED);
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let [sum, unity] = LEVELLED.map(|output| at.sum(output));
        let wet = unity.gt(L::zero());
        at.set(Field::PRESSURE, L::select(wet, sum / unity, L::zero()));
    }
}
