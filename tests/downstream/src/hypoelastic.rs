//! A hypoelastic solid: a deviatoric stress of one's own that follows the strain rate, and the force it makes.
//! The Jaumann rate as in W. Benz, E. Asphaug, Computer Physics Communications 87 (1995) 253–265.

use meshfree::effect::{
    Effect, Evolved, Point, PointLimit, PointRate, Reach, Setting, StepProgram, Update, When,
};
use meshfree::name;
use meshfree::particles::{Field, Fields, Output, Outputs};
use meshfree::scalar::{Lane, Real};
use meshfree::term::{In, Layout, Pair, Sums, Term, TermDoc, VelocityGradient, stage};

/// Deviatoric stress S \[Pa\], positive in tension: xx, yy, zz, yz, xz, xy.
pub const STRESS: Field = Field::tensor(name!("deviatoric_stress", "Pa"));

/// A solid whose shear stress follows the strain rate, dS/dt = 2 G (D − tr D/3) + W S − S W, beside the pressure of its
/// equation of state.
#[derive(Clone, Copy, Debug)]
pub struct Hypoelastic {
    /// Shear modulus G \[Pa\].
    pub shear_modulus: f64,
}

impl<const D: usize> Effect<D> for Hypoelastic {
    type Terms = (
        In<stage::Rates, Hypoelastic>,
        In<stage::Continuity, VelocityGradient>,
    );
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(*self), In::new(VelocityGradient))
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.declare(STRESS, 0.0);
        // In the drift, as density: kicked, the step of elastic waves would be no leapfrog.
        let stress = Evolved::kicked(STRESS)
            .at(When::Drift)
            .updated(Update::Rotated);
        program.evolve(stress.by(*self));
        program.limit(*self);
    }
}

/// 2 G (D − tr D/3) with D the symmetric part of the corrected velocity gradient at the middle of the drift.
impl<const D: usize> PointRate<D> for Hypoelastic {
    const SUMS: Outputs = Outputs::of(&[Output::VELOCITY_GRADIENT, Output::MOMENT_MATRIX]);
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &Point<'_, L, D, P>, _present: L, rate: &mut [L]) {
        let strain = at.velocity_gradient().symmetric_part().deviator();
        let twice = L::of(2.0 * self.shear_modulus);
        for k in 0..6 {
            rate[k] += twice * strain.components()[k];
        }
    }
}

impl<const D: usize> Term<D> for Hypoelastic {
    const NAME: &'static str = "downstream::hypoelastic";
    const READS: Fields = Fields::of(&[
        STRESS,
        Field::MASS,
        Field::DENSITY,
        Field::CONSISTENCY_FACTOR,
    ]);
    const WRITES: Outputs = Outputs::of(&[Output::FORCE]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let volumes = pair.i(Field::MASS) * pair.j(Field::MASS)
            / (pair.i(Field::DENSITY) * pair.j(Field::DENSITY));
        let own = volumes * pair.f_i / pair.i(Field::CONSISTENCY_FACTOR);
        let other = volumes * pair.f_j / pair.j(Field::CONSISTENCY_FACTOR);
        let stress = pair.i_tensor(STRESS).scaled(own);
        sums.force += stress.plus(other, &pair.j_tensor(STRESS)).dot(&pair.r);
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "force of the deviatoric stress".into(),
            equation: "mᵢ dvᵢ/dt = Σⱼ Vᵢ Vⱼ (Sᵢ/sᵢ + Sⱼ/sⱼ)·∇Wᵢⱼ",
            source: "Bonet & Lok 1999, with the stress for −p",
        }
    }
}

impl<const D: usize> PointLimit<D> for Hypoelastic {
    const NAME: &'static str = "elastic waves: 0.5 h/sqrt(c² + 4G/3ρ)";
    const READS: Fields = Fields::of(&[Field::DENSITY, Field::SOUND_SPEED]);
    #[inline(always)]
    fn step<L: Lane, P: Reach>(&self, at: &Point<'_, L, D, P>) -> L {
        let shear = L::of(4.0 / 3.0 * self.shear_modulus) / at.get(Field::DENSITY);
        let speed = (at.get(Field::SOUND_SPEED).powi(2) + shear).sqrt();
        L::of(0.5 * at.around.smoothing_length) / speed
    }
}
