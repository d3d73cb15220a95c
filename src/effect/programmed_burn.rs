//! Programmed burn: an explosive that a detonation of given speed runs through, lit at places and times.
//! Wilkins 1964 (Methods in Computational Physics 3, 211); LS-DYNA Theory Manual, *MAT_HIGH_EXPLOSIVE_BURN.

use super::{Around, CONSTANTS, Effect, Point, PointLaw, Reach, Rung, Setting, StepProgram};
use crate::error::Problem;
use crate::name;
use crate::particles::{Field, Fields};
use crate::scalar::{Lane, Real};
use crate::term::{Stage, TermDoc};

/// An explosive that burns where a detonation front of given speed has passed.
///
#[doc = include_str!("../../docs/equations/programmed_burn.html")]
///
/// with the pressure p of the [products](crate::material::eos::Jwl), the burn fraction F \[1\], the speed D \[m/s\] of the
/// detonation, the distance \[m\] from what is lit at the time t₀ \[s\], the lighting time t_L \[s\] by the straight way of the first
/// of them to arrive, the smoothing length h \[m\] of the body as built and the [width](Self::width) w \[1\] of the front.
///
/// The energy of detonation is that of the body at the start ([`Body::energy`](crate::scene::Body::energy)), as in other codes: cold
/// explosive stores it without pressure, and the work of F p takes it out. So energy closes, and nothing moves before the front. The
/// speed must be that of a Chapman–Jouguet detonation of the material, or the front has another pressure. A front bends round no
/// corner: t_L follows straight lines through inert bodies as well.
///
/// The lighting time follows from the place at the first evaluation, and stays with the particle; both fields are saved. A body
/// can be given its own, as of a shaped front, by [`Body::field`](crate::scene::Body::field) of
/// [`LIGHTING_TIME`](Self::LIGHTING_TIME).
///
/// ```
/// use meshfree::effect::ProgrammedBurn;
/// use meshfree::material::eos::Jwl;
/// use meshfree::prelude::*;
/// // 20 mm of TNT, lit at its left end.
/// let burn = ProgrammedBurn::new("TNT", 6930.0).lit_at_plane([0.0], [1.0], 0.0);
/// let tnt = Material::new("TNT", Jwl::tnt());
/// let charge = Body::block("charge", tnt, [0.0], [0.02], 1e-4).energy(Jwl::tnt().detonation_energy);
/// let mut simulation = Scene::<f64, 1>::new(schemes::gas().with(burn)).body(charge).build()?;
/// simulation.run_until(1e-6)?;
/// let burnt = simulation.all().filter(|own| own.scalar(ProgrammedBurn::BURN_FRACTION) > Some(0.5));
/// assert!((60..75).contains(&burnt.count()), "6.93 mm of 0.1 mm");
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ProgrammedBurn {
    charges: Vec<Charge>,
}

/// A material that burns.
#[derive(Clone, Debug, PartialEq)]
struct Charge {
    material: String,
    speed: f64,
    width: f64,
    lights: Vec<Light>,
}

/// What is lit.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Light {
    /// Zero beyond its coordinates.
    place: [f64; 3],
    /// How many coordinates it has.
    dimensions: usize,
    /// The normal of a plane, of any length.
    normal: Option<[f64; 3]>,
    time: f64,
}

/// Lighting time \[s\]; [`UNKNOWN`] until the first evaluation.
const LIGHTING_TIME: Field = Field::scalar(name!("lighting_time", "s"));
/// Burn fraction F \[1\].
const BURN_FRACTION: Field = Field::scalar(name!("burn_fraction", "1"));
/// The lighting time of a particle that has not been seen \[s\].
const UNKNOWN: f64 = 1e30;

impl ProgrammedBurn {
    /// When the front arrives at a particle \[s\].
    pub const LIGHTING_TIME: Field = LIGHTING_TIME;
    /// What of a particle has burnt, from zero to one.
    pub const BURN_FRACTION: Field = BURN_FRACTION;

    /// A burn of a material, by its name, at the speed \[m/s\] of its detonation. Light it somewhere.
    #[must_use]
    pub fn new(material: &str, speed: f64) -> Self {
        let charge = Charge {
            material: material.into(),
            speed,
            width: 1.5,
            lights: Vec::new(),
        };
        Self {
            charges: vec![charge],
        }
    }

    /// Lights a point \[m\] at a time \[s\].
    #[must_use]
    pub fn lit_at_point<const D: usize>(self, place: [f64; D], time: f64) -> Self {
        self.lit(Light {
            place: padded(place),
            dimensions: D,
            normal: None,
            time,
        })
    }

    /// Lights the plane through a point \[m\] with a normal of any length at a time \[s\]; the front runs to both sides.
    #[must_use]
    pub fn lit_at_plane<const D: usize>(
        self,
        place: [f64; D],
        normal: [f64; D],
        time: f64,
    ) -> Self {
        self.lit(Light {
            place: padded(place),
            dimensions: D,
            normal: Some(padded(normal)),
            time,
        })
    }

    fn lit(mut self, light: Light) -> Self {
        if let Some(own) = self.charges.last_mut() {
            own.lights.push(light);
        }
        self
    }

    /// Sets the width w of the front in smoothing lengths \[1\]; 1.5 by default, as in LS-DYNA with elements for smoothing
    /// lengths.
    #[must_use]
    pub fn width(mut self, width: f64) -> Self {
        if let Some(own) = self.charges.last_mut() {
            own.width = width;
        }
        self
    }

    /// Adds the burn of another material, as of a main charge behind a booster. Each is lit by itself: light the main charge
    /// where and when the front of the booster arrives.
    #[must_use]
    pub fn and(mut self, other: Self) -> Self {
        self.charges.extend(other.charges);
        self
    }

    /// The charge of a material.
    fn of(&self, material: &str) -> Option<&Charge> {
        self.charges.iter().find(|own| own.material == material)
    }
}

impl<const D: usize> Effect<D> for ProgrammedBurn {
    type Terms = ();
    fn terms(&self, _setting: &Setting) {}
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.declare(LIGHTING_TIME, UNKNOWN);
        program.declare(BURN_FRACTION, 0.0);
        program.law(Stage::State, self.clone());
        for (k, charge) in self.charges.iter().enumerate() {
            let own = charge.material.clone();
            let twice = self.charges[..k].iter().any(|other| other.material == own);
            program.require(move |scene| {
                let there = || scene.bodies.iter().filter(|body| body.1.name == own);
                let (what, remedy) = if there().count() == 0 {
                    (
                        format!("ProgrammedBurn is of the material `{own}`, and no body has it"),
                        "name the material of the explosive as in Material::new",
                    )
                } else if twice {
                    (
                        format!("ProgrammedBurn has the material `{own}` twice"),
                        "light one charge at several places, or give one of two materials another name",
                    )
                } else {
                    let cold = there().find(|body| !body.1.eos().uses_energy())?;
                    (
                        format!("`{}` is to burn, and its equation of state does not use energy", cold.0),
                        "take the products of the explosive (eos::Jwl)",
                    )
                };
                Some(Problem::Incompatible { what, remedy })
            });
            program.document(TermDoc {
                name: format!("programmed burn of {}, D = {} m/s", charge.material, charge.speed),
                equation: "p ← F p, F = min(1, max(0, (t − t_L) D/(w h))), t_L = min(t₀ + |x − x₀|/D)",
                source: "Wilkins 1964",
            });
        }
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let is_size = |x: f64| x.is_finite() && x > 0.0;
        let of_charge = |own: &Charge| {
            [
                (
                    is_size(own.speed),
                    (
                        "speed of the detonation",
                        own.speed,
                        "it must be finite and positive, in m/s",
                    ),
                ),
                (
                    is_size(own.width),
                    (
                        "width of the detonation front",
                        own.width,
                        "it must be finite and positive, in smoothing lengths",
                    ),
                ),
                (
                    !own.lights.is_empty(),
                    (
                        "number of places that are lit",
                        0.0,
                        "it must be one or more: ProgrammedBurn::lit_at_point or lit_at_plane",
                    ),
                ),
            ]
        };
        let of_light = |own: &Light| {
            let numbers = own
                .place
                .iter()
                .chain([&own.time])
                .chain(own.normal.iter().flatten());
            let bad = numbers.copied().find(|x| !x.is_finite());
            [
                (
                    own.dimensions == D,
                    (
                        "number of coordinates of what is lit",
                        own.dimensions as f64,
                        "it must be that of the scene's dimensions",
                    ),
                ),
                (
                    bad.is_none(),
                    (
                        "place, normal or time of what is lit",
                        bad.unwrap_or(0.0),
                        "it must be finite, in metres and seconds",
                    ),
                ),
                (
                    own.normal != Some([0.0; 3]),
                    (
                        "normal of the plane that is lit",
                        0.0,
                        "it must have a length",
                    ),
                ),
            ]
        };
        let lights = self.charges.iter().flat_map(|own| &own.lights);
        let all = self
            .charges
            .iter()
            .flat_map(of_charge)
            .chain(lights.flat_map(of_light));
        all.filter(|(fine, _)| !fine)
            .map(|(_, problem)| problem)
            .collect()
    }
}

/// Coordinates, and zero beyond them.
fn padded<const D: usize>(x: [f64; D]) -> [f64; 3] {
    core::array::from_fn(|d| x.get(d).copied().unwrap_or(0.0))
}

impl Light {
    /// When a front of some speed that starts here arrives at `x`, which counts from an origin.
    #[inline(always)]
    fn arrival<L: Lane, const D: usize>(&self, x: &[L; D], origin: &[f64; D], speed: f64) -> L {
        let mut along = L::zero();
        let mut square = L::zero();
        let size = self
            .normal
            .map_or(1.0, |n| n.iter().map(|n| n * n).sum::<f64>().sqrt());
        for d in 0..D {
            let out = x[d] - L::of(self.place[d] - origin[d]);
            square = out.mul_add(out, square);
            along = out.mul_add(L::of(self.normal.map_or(0.0, |n| n[d] / size)), along);
        }
        let distance = if self.normal.is_some() {
            along.abs()
        } else {
            square.sqrt()
        };
        distance.mul_add(L::of(1.0 / speed), L::of(self.time))
    }
}

/// p ← F p.
impl<const D: usize> PointLaw<D> for ProgrammedBurn {
    const NAME: &'static str = "programmed burn";
    const READS: Fields = Fields::of(&[Field::POSITION, Field::PRESSURE, LIGHTING_TIME]);
    const WRITES: Fields = Fields::of(&[Field::PRESSURE, LIGHTING_TIME, BURN_FRACTION]);
    const RUNG: Option<Rung> = Some(Rung::Trial);
    fn prepare<T: Real>(
        &self,
        around: &Around<'_, T, D>,
        constants: &mut [f64; CONSTANTS],
    ) -> bool {
        let Some(charge) = self.of(&around.material.name) else {
            return false;
        };
        constants[0] = around.time;
        constants[1] = charge.speed / (charge.width * around.smoothing_length);
        true
    }
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let Some(charge) = self.of(&at.around.material.name) else {
            return;
        };
        let (x, origin) = (at.vector(Field::POSITION), at.around.origin);
        let mut first = L::of(UNKNOWN);
        for light in &charge.lights {
            first = first.min(light.arrival(&x, &origin, charge.speed));
        }
        let known = at.get(LIGHTING_TIME);
        let lighting = L::select(known.ge(L::of(UNKNOWN)), first, known);
        let fraction = (at.constant(0) - lighting) * at.constant(1);
        let fraction = fraction.positive_part().min(L::one());
        at.set(LIGHTING_TIME, lighting);
        at.set(BURN_FRACTION, fraction);
        at.set(Field::PRESSURE, at.get(Field::PRESSURE) * fraction);
    }
}
