//! A body of a scene: where its particles are, what it is made of, and how it starts.
//! Boxes and shapes are filled with a lattice; points may be the user's own.

use super::random::random;
use crate::boundary::Slip;
use crate::geometry::{
    FEWER, Flaw, MOST_PARTICLES, POSITIVE, SWAPPED, Shape, edge, filled, packed,
};
use crate::material::Material;
use crate::particles::Field;
use crate::scalar::Real;
pub use crate::scheme::Start;

/// A body: particles of one material.
///
/// ```
/// use meshfree::material::catalogue;
/// use meshfree::scene::Body;
/// // 10 mm of copper at 20 m/s, a particle every 0.1 mm.
/// let rod: Body<f64, 1> = Body::block("rod", catalogue::copper(), [0.0], [0.010], 1e-4).velocity([20.0]);
/// assert_eq!(rod.points().len(), 100);
/// ```
#[derive(Clone, Debug)]
pub struct Body<T: Real, const D: usize> {
    pub(crate) name: String,
    pub(crate) material: Material<T>,
    pub(crate) points: Vec<[f64; D]>,
    pub(crate) spacing: f64,
    /// How its particles start: one for all of them, or one for each.
    pub(crate) starts: Vec<Start<D>>,
    pub(crate) slip: Slip,
    pub(crate) shape: Result<(), Flaw>,
    /// Fields that start with values of their own.
    pub(crate) fields: Vec<StartField>,
    /// The acceleration \[m/s²\] in which it starts hydrostatic.
    pub(crate) hydrostatic: Option<[f64; D]>,
    /// Masses \[kg\] of their own; without them density times the spacing to the power D.
    pub(crate) masses: Vec<f64>,
}

/// A field with the numbers that the particles of a body start with, one particle after the other.
#[derive(Clone, Debug)]
pub(crate) struct StartField {
    pub field: Field,
    pub components: usize,
    pub values: Vec<f64>,
}

impl<T: Real, const D: usize> Body<T, D> {
    /// A box from `low` to `high` \[m\], filled with a cubic lattice of about `spacing` \[m\].
    ///
    /// Along each axis the spacing is stretched or squeezed until a whole number of particles fits;
    /// half a spacing lies between the outermost particles and the faces of the box.
    #[must_use]
    pub fn block(
        name: &str,
        material: Material<T>,
        low: [f64; D],
        high: [f64; D],
        spacing: f64,
    ) -> Self {
        let size: [f64; D] = core::array::from_fn(|d| high[d] - low[d]);
        let valid = spacing.is_finite() && spacing > 0.0 && size.iter().all(|s| s.is_finite());
        let counts: [usize; D] = core::array::from_fn(|d| {
            if valid {
                (size[d] / spacing).round().clamp(0.0, 2.0 * MOST_PARTICLES) as usize
            } else {
                0
            }
        });
        let total = counts.iter().fold(1.0, |n, &c| n * c as f64);
        let mut points = Vec::new();
        let fits = total <= MOST_PARTICLES && points.try_reserve_exact(total as usize).is_ok();
        if fits {
            for k in 0..total as usize {
                let mut rest = k;
                points.push(core::array::from_fn(|d| {
                    let index = rest % counts[d];
                    rest /= counts[d];
                    low[d] + size[d] * (index as f64 + 0.5) / counts[d] as f64
                }));
            }
        }
        let volume: f64 = (0..D).map(|d| size[d] / counts[d].max(1) as f64).product();
        let mut body = Self::points_of(name, material, points, edge::<D>(volume.abs()));
        if !spacing.is_finite() || spacing <= 0.0 {
            body.shape = Err(("spacing", spacing, POSITIVE));
            body.spacing = spacing;
        } else if let Some(bad) = size.iter().find(|s| !s.is_finite()) {
            body.shape = Err(("size", *bad, "corners must be finite, in metres"));
        } else if let Some(bad) = size.iter().find(|s| **s < 0.0) {
            body.shape = Err(("size", *bad, SWAPPED));
        } else if !fits {
            body.shape = Err(("number of particles", total, FEWER));
        }
        body
    }

    /// A shape, filled with the cubic lattice of `spacing` \[m\] whose first cell begins at the low
    /// corner of the shape's [bounds](Shape::bounds); see [`fill`](crate::geometry::fill).
    ///
    /// A box that is a whole number of spacings wide gives the particles of [`Body::block`]; for any
    /// other size the spacing stays as it is. Two bodies that must share a lattice, as a hole and its
    /// filling, are best filled from one origin and given by [`Body::points_of`].
    ///
    /// ```
    /// use meshfree::geometry::Ball;
    /// use meshfree::material::catalogue;
    /// use meshfree::scene::Body;
    /// // A copper ball of 5 mm radius, a particle every 0.25 mm.
    /// let ball: Body<f64, 3> = Body::fill("ball", catalogue::copper(), &Ball::new([0.0; 3], 5e-3), 2.5e-4);
    /// assert!((ball.points().len() as f64 * 2.5e-4_f64.powi(3) / 523.6e-9 - 1.0).abs() < 0.01);
    /// ```
    #[must_use]
    pub fn fill(
        name: &str,
        material: Material<T>,
        shape: &(impl Shape<D> + ?Sized),
        spacing: f64,
    ) -> Self {
        let points = filled(shape, spacing, shape.bounds().0);
        Self::or_flaw(name, material, points, spacing)
    }

    /// A shape, filled with particles that follow its surface, each with the volume `spacing`ᴰ \[mᴰ\]; see
    /// [`pack`](crate::geometry::pack).
    ///
    /// ```
    /// use meshfree::geometry::Ball;
    /// use meshfree::material::catalogue;
    /// use meshfree::scene::Body;
    /// let disc = Ball::new([0.0; 2], 8e-3);
    /// let disc: Body<f64, 2> = Body::packed("disc", catalogue::copper(), &disc, 1e-3);
    /// assert_eq!(disc.points().len(), 201);
    /// ```
    #[must_use]
    pub fn packed(
        name: &str,
        material: Material<T>,
        shape: &(impl Shape<D> + ?Sized),
        spacing: f64,
    ) -> Self {
        let points = packed(shape, spacing, shape.bounds().0);
        Self::or_flaw(name, material, points, spacing)
    }

    /// Particles at points, or what is wrong with them.
    fn or_flaw(
        name: &str,
        material: Material<T>,
        points: core::result::Result<Vec<[f64; D]>, Flaw>,
        spacing: f64,
    ) -> Self {
        let (points, shape) = match points {
            Ok(points) => (points, Ok(())),
            Err(flaw) => (Vec::new(), Err(flaw)),
        };
        Self {
            shape,
            ..Self::points_of(name, material, points, spacing)
        }
    }

    /// Particles at `points` \[m\], each with the volume `spacing`ᴰ.
    #[must_use]
    pub fn points_of(
        name: &str,
        material: Material<T>,
        points: Vec<[f64; D]>,
        spacing: f64,
    ) -> Self {
        let start = Start {
            velocity: [0.0; D],
            density: material.reference_density(),
            energy: 0.0,
        };
        Self {
            name: name.into(),
            material,
            points,
            spacing,
            starts: vec![start],
            slip: Slip::Free,
            shape: Ok(()),
            fields: Vec::new(),
            hydrostatic: None,
            masses: Vec::new(),
        }
    }

    /// Lets a liquid of another [group](crate::scene::Scene::group) stick to this body; it slips if not
    /// given.
    #[must_use]
    pub fn no_slip(self) -> Self {
        Self {
            slip: Slip::None,
            ..self
        }
    }

    /// Starts all particles at a velocity \[m/s\].
    #[must_use]
    pub fn velocity(self, velocity: [f64; D]) -> Self {
        self.all(|start| Start { velocity, ..start })
    }

    /// Starts all particles at a density \[kg/m³\]; that of the material if not given.
    #[must_use]
    pub fn density(self, density: f64) -> Self {
        self.all(|start| Start { density, ..start })
    }

    /// Starts all particles at the pressure that a liquid at rest has under `acceleration` g \[m/s²\] with a
    /// free surface through `surface` x_s \[m\]: dp = ρ(p) dψ from p = 0 at ψ = g·(x − x_s) = 0 (Batchelor 1967, §1.4). Its density is that
    /// of the material there. It is ρ₀ ψ but for the liquid's own compression, ψ/(2c²) of it, without which a liquid with c = 10 √(gH)
    /// would start half a per cent out of balance.
    ///
    /// Above the surface, and where the law does not reach the pressure, particles keep their density. A body with no
    /// particle below its surface is refused, as where the acceleration points up, and so is one in a scene whose
    /// [acceleration](crate::scene::Scene::acceleration) points against that given here.
    #[must_use]
    pub fn hydrostatic(mut self, acceleration: [f64; D], surface: [f64; D]) -> Self {
        for (what, given) in [
            ("acceleration of the hydrostatic start", acceleration),
            ("surface of the hydrostatic start", surface),
        ] {
            if let Some(bad) = given.into_iter().find(|x| !x.is_finite()) {
                let must_be = "it must be finite, in m/s² and in metres";
                self.shape = self.shape.and(Err((what, bad, must_be)));
                return self;
            }
        }
        let material = self.material.clone();
        let head =
            |x: &[f64; D]| -> f64 { (0..D).map(|d| acceleration[d] * (x[d] - surface[d])).sum() };
        let most = self
            .points
            .iter()
            .map(head)
            .fold(f64::NEG_INFINITY, f64::max);
        if most < 0.0 && most.is_finite() {
            let must_be = "no particle is below the surface: acceleration and surface must be such that g·(x − x_s) is \
                           positive in the liquid; gravity points down, as [0, −9.81] m/s² where y points up";
            let flaw = (
                "largest head g·(x − x_s) of the hydrostatic start",
                most,
                must_be,
            );
            self.shape = self.shape.and(Err(flaw));
            return self;
        }
        self.hydrostatic = Some(acceleration);
        self.start(
            |x, start| match density_below(&material, head(&x), start.energy) {
                Some(density) => Start { density, ..start },
                None => start,
            },
        )
    }

    /// Starts all particles at a specific internal energy \[J/kg\]; zero if not given.
    #[must_use]
    pub fn energy(self, energy: f64) -> Self {
        self.all(|start| Start { energy, ..start })
    }

    /// Starts each particle as a function of its position \[m\] and its start so far.
    #[must_use]
    pub fn start(mut self, start: impl Fn([f64; D], Start<D>) -> Start<D>) -> Self {
        let points = self.points.iter().enumerate();
        let starts = points.map(|(k, x)| start(*x, *self.start_of(k)));
        self.set_starts(starts.collect());
        self
    }

    /// Starts all particles otherwise, by how they start so far.
    fn all(mut self, start: impl Fn(Start<D>) -> Start<D>) -> Self {
        for own in &mut self.starts {
            *own = start(*own);
        }
        self
    }

    /// How a particle starts.
    pub(crate) fn start_of(&self, particle: usize) -> &Start<D> {
        let k = particle.min(self.starts.len() - 1);
        &self.starts[k]
    }

    /// Starts each particle as listed: one is kept where all are the same.
    pub(crate) fn set_starts(&mut self, mut starts: Vec<Start<D>>) {
        // Zeros of either sign are equal and have different bits.
        let bits = |own: &Start<D>| {
            let [density, energy] = [own.density, own.energy].map(f64::to_bits);
            (own.velocity.map(f64::to_bits), density, energy)
        };
        if starts
            .windows(2)
            .all(|pair| bits(&pair[0]) == bits(&pair[1]))
        {
            starts.truncate(1);
            starts.shrink_to_fit();
        }
        if !starts.is_empty() {
            self.starts = starts;
        }
    }

    /// Starts a field that an effect declares or integrates with a function of position \[m\]; `N` is the number of
    /// its components: 1, D, 6 for a symmetric tensor (xx, yy, zz, yz, xz, xy). Without it, it starts with what the
    /// effect declares.
    ///
    /// ```
    /// use meshfree::effect::{Effect, Setting, StepProgram};
    /// use meshfree::name;
    /// use meshfree::prelude::*;
    ///
    /// const DYE: Field = Field::scalar(name!("dye", "1"));
    ///
    /// /// A dye that moves with the particles.
    /// #[derive(Clone, Debug)]
    /// struct Dye;
    /// impl<const D: usize> Effect<D> for Dye {
    ///     type Terms = ();
    ///     fn terms(&self, _: &Setting) {}
    ///     fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
    ///         program.declare(DYE, 0.0);
    ///     }
    /// }
    /// let simulation = Scene::<f64, 1>::new(schemes::impact().with(Dye))
    ///     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 1e-3).field(DYE, |[x]| [100.0 * x]))
    ///     .build()?;
    /// assert!((simulation.all().last().and_then(|p| p.scalar(DYE)).unwrap_or(0.0) - 0.95).abs() < 1e-12);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn field<const N: usize>(
        mut self,
        field: Field,
        start: impl Fn([f64; D]) -> [f64; N],
    ) -> Self {
        let values = self.points.iter().flat_map(|x| start(*x)).collect();
        self.fields.push(StartField {
            field,
            components: N,
            values,
        });
        self
    }

    /// Starts a field with numbers that are listed particle by particle.
    pub(crate) fn listed<const N: usize>(mut self, field: Field, values: &[[f64; N]]) -> Self {
        self.fields.push(StartField {
            field,
            components: N,
            values: values.as_flattened().to_vec(),
        });
        self
    }

    /// Moves every particle along each axis by up to `share` of the spacing, at random: the same for the same `seed`.
    ///
    /// A lattice strikes a wall row by row, all of a row at once, and a pressure sensor reads spikes; particles that
    /// have lost their order strike one after the other, as water does. In a coarse dam break in space the peak at the
    /// foot of a wall falls from 20 to 7 kPa and its mean stays (`tests/liquids/off_lattice.rs`); in a plane, where a
    /// row is one particle, nothing is gained ([dam breaks and sloshing](crate#pages)). Runs of other seeds say what of a violent flow is
    /// chance.
    ///
    /// A fifth is enough. It may be from 0 to 0.3, beyond which neighbours are too close. Give it before what starts
    /// particles by their places, as [`hydrostatic`](Self::hydrostatic).
    ///
    /// ```
    /// use meshfree::material::catalogue;
    /// use meshfree::scene::Body;
    /// let drop = || Body::<f64, 2>::block("drop", catalogue::water(), [0.0; 2], [0.1; 2], 0.01);
    /// let [first, again, other] = [1, 1, 2].map(|seed| drop().jitter(0.2, seed));
    /// assert!(first.points() == again.points() && first.points() != other.points());
    /// ```
    #[must_use]
    pub fn jitter(mut self, share: f64, seed: u64) -> Self {
        if !(0.0..=0.3).contains(&share) {
            let must_be = "it must be from 0 to 0.3, as a share of the spacing";
            self.shape = self.shape.and(Err(("jitter", share, must_be)));
            return self;
        }
        let farthest = share * self.spacing;
        for (k, x) in self.points.as_flattened_mut().iter_mut().enumerate() {
            *x += farthest * random(seed, k as u64);
        }
        self
    }

    /// Moves every particle to where a function of its place says \[m\].
    ///
    /// Give it before what starts particles by their places, as [`hydrostatic`](Self::hydrostatic).
    ///
    /// ```
    /// use meshfree::material::catalogue;
    /// use meshfree::scene::Body;
    /// // A bar that is bent before the scene begins.
    /// let bar = Body::<f64, 2>::block("bar", catalogue::steel(), [0.0; 2], [0.1, 0.01], 1e-3);
    /// let bent = bar.displace(|[x, y]| [x, y + x * x]);
    /// assert!((bent.points()[99][1] - (0.0005 + 0.0995 * 0.0995)).abs() < 1e-12);
    /// ```
    #[must_use]
    pub fn displace(mut self, place: impl FnMut([f64; D]) -> [f64; D]) -> Self {
        let places = self.points.iter().copied().map(place).collect();
        self.points = places;
        self
    }

    /// Where its particles are \[m\].
    #[must_use]
    pub fn points(&self) -> &[[f64; D]] {
        &self.points
    }
}

/// The density at which a liquid rests under the head ψ \[m²/s²\] of what is above it: dp = ρ(p) dψ by four steps of the classical
/// Runge–Kutta method, which leaves 2e-13 of it at ψ = c²/100.
fn density_below<T: Real>(material: &Material<T>, head: f64, energy: f64) -> Option<f64> {
    const STEPS: u32 = 4;
    let step = head / f64::from(STEPS);
    let density = |pressure: f64| material.eos().density_at(pressure, energy);
    let mut pressure = 0.0;
    for _ in 0..STEPS {
        let first = density(pressure)?;
        let second = density(pressure + 0.5 * step * first)?;
        let third = density(pressure + 0.5 * step * second)?;
        let last = density(pressure + step * third)?;
        pressure += step / 6.0 * (first + 2.0 * (second + third) + last);
    }
    density(pressure).filter(|_| pressure > 0.0)
}

#[cfg(test)]
mod tests {
    use super::{Body, Start, density_below};
    use crate::material::eos::Linear;
    use crate::material::{SoundSpeed, catalogue};

    /// By Tait's law with γ = 7 it is ρ₀ (1 + 6ψ/c²)^(1/6), by p = c²(ρ − ρ₀) ρ₀ exp(ψ/c²): the enthalpy is ψ.
    #[test]
    fn liquid_at_rest_carries_what_is_above_it() {
        let water = catalogue::water_at::<f64>(SoundSpeed::Chosen(10.0));
        let linear = water.clone().with_eos(Linear::new(1000.0, 10.0));
        for head in [1e-3, 0.1, 1.0] {
            let of = |law| density_below(law, head, 0.0).unwrap();
            let share: f64 = head / 100.0;
            let exact = 1000.0 * (1.0 + 6.0 * share).powf(1.0 / 6.0);
            approx::assert_relative_eq!(of(&water), exact, max_relative = 1e-12);
            approx::assert_relative_eq!(of(&linear), 1000.0 * share.exp(), max_relative = 1e-12);
            // Not that of a column whose weight nothing compresses.
            assert!(of(&linear) / 1000.0 - 1.0 - share > 0.4 * share * share);
        }
        assert_eq!(density_below(&water, -1.0, 0.0), None);
    }

    #[test]
    fn one_start_is_kept_where_all_are_the_same() {
        let bar = || Body::<f64, 1>::block("bar", catalogue::copper(), [0.0], [1.0], 0.25);
        let same = bar().velocity([2.0]).start(|_, start| Start {
            energy: 3.0,
            ..start
        });
        assert_eq!(same.starts.len(), 1);
        let expected = (same.starts[0].velocity, same.starts[0].energy);
        assert_eq!(expected, ([2.0], 3.0));
        assert_eq!(same.start_of(3), same.start_of(0));
        // What is said of all particles later changes each of them, and no sign of a zero is lost.
        let sign = |x: f64| if x < 0.5 { 0.0 } else { -0.0 };
        let each = bar().start(|[x], start| Start {
            velocity: [sign(x)],
            ..start
        });
        let each = each.energy(3.0);
        assert_eq!(each.starts.len(), 4);
        let bits = [0, 3].map(|k| each.start_of(k).velocity[0].to_bits());
        assert_eq!(bits, [0.0_f64, -0.0].map(f64::to_bits));
        assert!((0..4).all(|k| each.start_of(k).energy == 3.0));
        // A body without particles starts as its material at rest.
        let none = Body::<f64, 1>::points_of("none", catalogue::copper(), Vec::new(), 0.1);
        let none = none.start(|_, _| unreachable!("there are no particles"));
        assert_eq!(none.start_of(0).velocity, [0.0]);
    }
}
