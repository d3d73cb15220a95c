//! Absorbing layers: zones in which velocity and stress fade together, so that sound leaves instead of coming back.
//! The matched layer of Berenger 1994 (J. Comput. Phys. 114, 185) at normal incidence, in Lagrangian form.

use super::plane::Layer;
use super::{
    Effect, Evolved, Hypoelastic, Point, PointLaw, PointLimit, PointRate, Reach, Rung, Setting,
    StepProgram, TotalLagrangian,
};
use crate::error::Problem;
use crate::name;
use crate::particles::{Field, Fields};
use crate::scalar::{Lane, Real};
use crate::term::{Stage, TermDoc};

/// A layer at the end of a body through which waves of pressure and stress leave: where a domain is cut out of a larger one.
///
#[doc = include_str!("../../docs/equations/absorbing_layer.html")]
///
/// with the force F \[N\] on a particle of mass m \[kg\] and velocity v \[m/s\], the stress σ\* \[Pa\] of material and strain, the stress
/// σ that acts, the stress σ₀ that the particle had when it was first evaluated, the sound speed c \[m/s\], and the distance d \[m\]
/// beyond the plane. L \[m\] is the thickness of the layer. The medium is at rest; a stream would be stopped.
///
/// Velocity and stress fade at one rate, so the layer has the impedance ρc of the medium before it, and a wave at normal
/// incidence is not reflected by it, however long it is. It keeps a thousandth of its amplitude on its way through and back. Of a
/// pulse of ten spacings comes back, as measured (`tests/solids/absorbing_layer.rs`):
///
/// | thickness | liquid | gas | solid |
/// |---|---|---|---|
/// | 10 spacings | 0.6 % | 4 % | 0.1 to 0.7 % |
/// | 20 spacings | | 1 % | 0.2 to 0.3 % |
///
/// Of waves at an angle to the normal more comes back: of 20 spacings in a liquid, through a layer of one wavelength, 6 % at 30°, 9 % at
/// 45° and 10 % at 60°. [`Sponge`](super::Sponge) damps velocities alone, for waves of a free surface.
///
/// | the layer lies in | stress that fades | made by |
/// |---|---|---|
/// | liquid, gas, a solid by its equation of state | pressure | [`beyond`](Self::beyond) |
/// | a solid with [`Hypoelastic`] stress | pressure, and S to zero | [`with_deviatoric_stress`](Self::with_deviatoric_stress) |
/// | a [total-Lagrangian](TotalLagrangian) solid | the first Piola–Kirchhoff stress | [`with_piola_stress`](Self::with_piola_stress) |
///
/// Hydrostatic pressure and other stresses at the start stay. A steady load later moves the layer, which acts as a damper with a time of
/// L/(10 c). The step is at most 0.25 L/(10.4 c), less than that of sound in layers below twenty spacings.
/// Impulse and work of F are [`Ledger::law_impulse`](crate::simulation::Ledger::law_impulse) and `work of laws`. What the stress of the layer takes
/// becomes internal energy where the scheme has one; of stored energy nothing is said.
///
/// ```
/// use meshfree::effect::AbsorbingLayer;
/// use meshfree::prelude::*;
/// // A pulse in a tube of water leaves to the right.
/// let water = catalogue::water_at(meshfree::material::SoundSpeed::Chosen(100.0));
/// let pulse = |[x]: [f64; 1], start: meshfree::scheme::Start<1>| {
///     let shape = (-((x - 0.5) / 0.1_f64).powi(2)).exp();
///     meshfree::scheme::Start { velocity: [0.1 * shape], density: start.density * (1.0 + 1e-3 * shape), ..start }
/// };
/// let layer = AbsorbingLayer::beyond([1.0], [1.0], 0.2);
/// let mut tube = Scene::<f64, 1>::new(schemes::weakly_compressible().with(layer))
///     .body(Body::block("water", water, [0.0], [1.2], 0.01).start(pulse))
///     .build()?;
/// tube.run_until(0.013)?;
/// let left = tube.all().map(|p| p.velocity()[0].abs()).fold(0.0, f64::max);
/// assert!(left < 0.002, "{left}");
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct AbsorbingLayer {
    layers: Vec<Layer>,
    fades: Fades,
}

/// Which stress fades with velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fades {
    Pressure,
    DeviatoricStress,
    PiolaStress,
}

/// R L/c: rates of R min(d/L, 1)² leave exp(−2 R L/(3 c)) of a wave that goes through the layer and back; a thousandth.
const STRENGTH: f64 = 10.362;

/// σ* − σ of a pressure, the pressure of the start, and whether that is known.
const FADED: Field = Field::scalar(name!("faded_pressure", "Pa"));
const AT_START: Field = Field::scalar(name!("pressure_at_start", "Pa"));
const KNOWN: Field = Field::scalar(name!("start_is_known", "1"));
/// The same of the stress of a total-Lagrangian solid.
const FADED_PIOLA: Field = Field::matrix(name!("faded_piola_stress", "Pa"));
const PIOLA_AT_START: Field = Field::matrix(name!("piola_stress_at_start", "Pa"));
const PIOLA: Field = TotalLagrangian::PIOLA;
const STRESS: Field = Hypoelastic::STRESS;

impl AbsorbingLayer {
    /// A layer beyond the plane through `place` \[m\], on the side to which `normal`, of any length, points. The body ends about
    /// `thickness` \[m\] behind the plane, at a free surface or a wall.
    #[must_use]
    pub fn beyond<const D: usize>(place: [f64; D], normal: [f64; D], thickness: f64) -> Self {
        Self {
            layers: vec![Layer::new(place, normal, thickness)],
            fades: Fades::Pressure,
        }
    }

    /// For a solid whose deviatoric stress is that of [`Hypoelastic`].
    #[must_use]
    pub fn with_deviatoric_stress(self) -> Self {
        Self {
            fades: Fades::DeviatoricStress,
            ..self
        }
    }

    /// For a [total-Lagrangian](TotalLagrangian) solid.
    #[must_use]
    pub fn with_piola_stress(self) -> Self {
        Self {
            fades: Fades::PiolaStress,
            ..self
        }
    }

    /// Adds another layer, as at the other end. Where layers overlap their rates add; the stress is that of the first.
    #[must_use]
    pub fn and(mut self, other: Self) -> Self {
        self.layers.extend(other.layers);
        self
    }

    /// r \[1/s\] of a particle.
    #[inline(always)]
    fn rate<L: Lane, P: Reach, const D: usize>(&self, at: &Point<'_, L, D, P>) -> L {
        let x = at.vector(Field::POSITION);
        let mut over_sound = L::zero();
        for own in &self.layers {
            let ramp = own.ramp(&x, &at.around.origin);
            over_sound += ramp * L::of(STRENGTH / own.thickness);
        }
        over_sound * at.get(Field::SOUND_SPEED)
    }
}

impl<const D: usize> Effect<D> for AbsorbingLayer {
    type Terms = ();
    fn terms(&self, _setting: &Setting) {}
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.declare(KNOWN, 0.0);
        program.law(Stage::Rates, self.clone());
        program.limit(self.clone());
        if self.fades == Fades::PiolaStress {
            program.declare(PIOLA_AT_START, 0.0);
            program.evolve(Evolved::kicked(FADED_PIOLA).by(FadingPiola(self.clone())));
            program.law(Stage::State, ShownPiola);
        } else {
            program.declare(AT_START, 0.0);
            program.evolve(Evolved::kicked(FADED).by(FadingPressure(self.clone())));
            program.law(Stage::State, ShownPressure);
        }
        if self.fades == Fades::DeviatoricStress {
            program.contribute(STRESS, FadingStress(self.clone()));
        }
        for own in &self.layers {
            program.document(TermDoc {
                name: format!("absorbing layer of {} m", own.thickness),
                equation: "m dv/dt = … − m r v, σ = σ* − q, dq/dt = r (σ − σ₀), r = 10.4 c/L min(max(d/L, 0), 1)²",
                source: "Berenger 1994, at normal incidence",
            });
        }
        let fades = self.fades;
        program.require(move |scene| {
            let (what, remedy) = match (scene.written.contains(PIOLA), fades) {
                (true, Fades::Pressure | Fades::DeviatoricStress) => (
                    "an absorbing layer of pressure lies in a total-Lagrangian solid, whose force has another stress",
                    "take AbsorbingLayer::with_piola_stress",
                ),
                (false, _) if scene.integrated.contains(STRESS) && fades == Fades::Pressure => (
                    "an absorbing layer of pressure lies in a solid that has deviatoric stress too",
                    "take AbsorbingLayer::with_deviatoric_stress",
                ),
                _ => return None,
            };
            Some(Problem::Incompatible { what: what.into(), remedy })
        });
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let of = |own: &Layer| own.problems(D, "thickness of an absorbing layer");
        self.layers.iter().flat_map(of).collect()
    }
}

/// −m r v.
impl<const D: usize> PointLaw<D> for AbsorbingLayer {
    const NAME: &'static str = "absorbing layer";
    const READS: Fields = Fields::of(&[
        Field::POSITION,
        Field::VELOCITY,
        Field::MASS,
        Field::SOUND_SPEED,
    ]);
    const WRITES: Fields = Fields::of(&[Field::FORCE]);
    const ADDS: Fields = Fields::of(&[Field::FORCE]);
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let v = at.vector(Field::VELOCITY);
        let damping = at.get(Field::MASS) * self.rate(at);
        for d in 0..D {
            at.add_at(Field::FORCE, d, -(damping * v[d]));
        }
    }
}

/// p = p* − q, and the pressure of the first evaluation.
#[derive(Clone, Copy, Debug)]
struct ShownPressure;

impl<const D: usize> PointLaw<D> for ShownPressure {
    const NAME: &'static str = "pressure of an absorbing layer";
    const READS: Fields = Fields::of(&[Field::PRESSURE, FADED, AT_START, KNOWN]);
    const WRITES: Fields = Fields::of(&[Field::PRESSURE, AT_START, KNOWN]);
    const RUNG: Option<Rung> = Some(Rung::Constraint);
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let shown = at.get(Field::PRESSURE) - at.get(FADED);
        let unknown = at.get(KNOWN).le(L::zero());
        at.set(AT_START, L::select(unknown, shown, at.get(AT_START)));
        at.set(KNOWN, L::one());
        at.set(Field::PRESSURE, shown);
    }
}

/// The same of the first Piola–Kirchhoff stress.
#[derive(Clone, Copy, Debug)]
struct ShownPiola;

impl<const D: usize> PointLaw<D> for ShownPiola {
    const NAME: &'static str = "stress of an absorbing layer";
    const READS: Fields = Fields::of(&[PIOLA, FADED_PIOLA, PIOLA_AT_START, KNOWN]);
    const WRITES: Fields = Fields::of(&[PIOLA, PIOLA_AT_START, KNOWN]);
    const RUNG: Option<Rung> = Some(Rung::Constraint);
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let unknown = at.get(KNOWN).le(L::zero());
        for k in 0..D * D {
            let shown = at.get_at(PIOLA, k) - at.get_at(FADED_PIOLA, k);
            let start = L::select(unknown, shown, at.get_at(PIOLA_AT_START, k));
            at.set_at(PIOLA_AT_START, k, start);
            at.set_at(PIOLA, k, shown);
        }
        at.set(KNOWN, L::one());
    }
}

/// r (p − p₀).
#[derive(Clone, Debug)]
struct FadingPressure(AbsorbingLayer);

impl<const D: usize> PointRate<D> for FadingPressure {
    const READS: Fields = Fields::of(&[
        Field::POSITION,
        Field::SOUND_SPEED,
        Field::PRESSURE,
        AT_START,
    ]);
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &Point<'_, L, D, P>, _: L, rate: &mut [L]) {
        rate[0] += self.0.rate(at) * (at.get(Field::PRESSURE) - at.get(AT_START));
    }
}

/// r (P − P₀).
#[derive(Clone, Debug)]
struct FadingPiola(AbsorbingLayer);

impl<const D: usize> PointRate<D> for FadingPiola {
    const READS: Fields = Fields::of(&[Field::POSITION, Field::SOUND_SPEED, PIOLA, PIOLA_AT_START]);
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &Point<'_, L, D, P>, _: L, rate: &mut [L]) {
        let fading = self.0.rate(at);
        for (k, rate) in rate.iter_mut().enumerate() {
            *rate += fading * (at.get_at(PIOLA, k) - at.get_at(PIOLA_AT_START, k));
        }
    }
}

/// −r S.
#[derive(Clone, Debug)]
struct FadingStress(AbsorbingLayer);

impl<const D: usize> PointRate<D> for FadingStress {
    const READS: Fields = Fields::of(&[Field::POSITION, Field::SOUND_SPEED]);
    const GROWTH: bool = true;
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &Point<'_, L, D, P>, _: L, rate: &mut [L]) {
        rate[0] -= self.0.rate(at);
    }
}

impl<const D: usize> PointLimit<D> for AbsorbingLayer {
    const NAME: &'static str = "absorbing layer: 0.25/r";
    const READS: Fields = Fields::of(&[Field::POSITION, Field::SOUND_SPEED]);
    #[inline(always)]
    fn step<L: Lane, P: Reach>(&self, at: &Point<'_, L, D, P>) -> L {
        // Infinite where nothing is damped.
        L::of(0.25) / self.rate(at)
    }
}
