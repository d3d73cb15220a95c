//! Loads: accelerations and heat sources that depend on place, velocity, density, other fields, body and time.
//! What pushes or heats a particle whatever its neighbours are: wells, drag, rotating frames, lasers, decay.

use crate::particles::{Columns, Field, Fields};
use crate::scalar::Real;
use core::fmt;
use core::fmt::Debug;
use std::sync::Arc;

/// What a load may depend on: a particle at the time of an evaluation.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct LoadPoint<'a, const D: usize> {
    /// The number of the particle in its body, in the order in which the scene placed them, as
    /// [`Column::numbers`](super::Column::numbers) has it: what another code keeps of a particle goes by it.
    pub particle: usize,
    /// Position x \[m\] in the scene, in `f64`.
    pub position: [f64; D],
    /// Where the particle was in the scene as built \[m\], which stays with the material; nothing for bodies that an
    /// [inlet](crate::boundary::Inlet) feeds.
    pub as_built: Option<[f64; D]>,
    /// Velocity v \[m/s\], predicted to the time of the evaluation by leapfrogs.
    pub velocity: [f64; D],
    /// Density ρ \[kg/m³\].
    pub density: f64,
    /// Time t \[s\].
    pub time: f64,
    /// The name of the body.
    pub body: &'a str,
    pub(super) happened: &'a [(String, Option<f64>)],
    pub(super) fields: &'a dyn Seen,
    pub(super) slot: usize,
}

/// Fields of particles that a load reads, whatever the scalar.
pub(super) trait Seen: Debug {
    /// Component `k` of a field of the particle in a slot.
    fn number(&self, field: Field, slot: usize, k: usize) -> Option<f64>;
}

/// The columns that a load names.
#[derive(Debug)]
pub(super) struct Named<'a, T, const D: usize>(pub &'a Columns<T, D>, pub Fields);

impl<T: Real, const D: usize> Seen for Named<'_, T, D> {
    fn number(&self, field: Field, slot: usize, k: usize) -> Option<f64> {
        let column = self.1.contains(field).then(|| self.0.raw(field))?;
        column
            .get(slot * field.components(D) + k)
            .map(|x| x.to_f64())
    }
}

impl<const D: usize> LoadPoint<'_, D> {
    /// The fields that loads see of a particle, which must be at hand where they act; in `f32` also
    /// [`Field::POSITION_RESIDUAL`].
    pub const READS: Fields = Fields::of(&[Field::POSITION, Field::VELOCITY, Field::DENSITY]);
    /// How long ago \[s\] an [event](crate::scene::Scene::event) happened; nothing if it has not, or there is none of that name.
    #[must_use]
    pub fn since(&self, event: &str) -> Option<f64> {
        let own = self.happened.iter().find(|(name, _)| name == event)?;
        own.1.map(|at| self.time - at)
    }
    /// A scalar field that the load [reads](Load::reading), as it is at this evaluation; nothing if it does not.
    #[must_use]
    pub fn scalar(&self, field: Field) -> Option<f64> {
        self.component(field, 0)
    }
    /// Component `k` of a vector, tensor or matrix, in the order of [`Simulation::column`](super::Simulation::column).
    #[must_use]
    pub fn component(&self, field: Field, k: usize) -> Option<f64> {
        (k < field.components(D)).then(|| self.fields.number(field, self.slot, k))?
    }
}

/// A law of a load.
type Law<R, const D: usize> = Arc<dyn Fn(&LoadPoint<'_, D>) -> R + Send + Sync>;

/// An acceleration or a heat source that acts on the particles of bodies: dv/dt = … + a(x, v, ρ, t), or
/// de/dt = … + q(x, v, ρ, t).
///
/// It is evaluated with the rates, so the integrator has the order with it that it has without, and the
/// [force criterion](super::StepControl::force) of the step sees it. What an acceleration works is no heat in
/// either [energy form](crate::scheme::EnergyForm), and
/// [`EnergyLedger::load_work`](super::EnergyLedger) where the ledger is kept. Drag that is to heat needs a
/// heat source beside it.
///
/// Walls do not know of it: a liquid that leans on walls of particles takes its weight, and that of an accelerated frame,
/// from [`Scene::acceleration`](crate::scene::Scene::acceleration), which walls and density diffusion know.
///
/// A load costs a call of its function for each particle of its bodies in each evaluation; all accelerations together a
/// vector a particle, and all heat sources a number. A scene without them pays nothing.
///
/// ```
/// use meshfree::prelude::*;
/// // A copper rod is drawn to the origin, slowed down, and heated at its left end.
/// let (omega, drag) = (1e3, 50.0);
/// let mut simulation = Scene::<f64, 1>::new(schemes::impact())
///     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4))
///     .load(Load::acceleration(move |at| [-omega * omega * at.position[0] - drag * at.velocity[0]]))
///     .load(Load::heating(|at| if at.position[0] < 1e-3 { 1e6 } else { 0.0 }).on("rod"))
///     .build()?;
/// simulation.run_until(1e-6)?;
/// let heated = simulation.body("rod")?.next().map_or(0.0, |particle| particle.energy());
/// assert!((heated - 1.0).abs() < 0.01, "1 MW/kg for 1 µs, {heated} J/kg");
/// assert!(simulation.ledger().whole.momentum[0] < 0.0);
/// # Ok::<(), Error>(())
/// ```
///
/// A place that moves with the material is that [as built](LoadPoint::as_built): what is heated stays what was lit.
///
/// ```
/// use meshfree::prelude::*;
/// // A rod that flies, with a source in its first millimetre.
/// let source = |at: &meshfree::simulation::LoadPoint<'_, 1>| match at.as_built {
///     Some([x]) if x < 1e-3 => 1e6,
///     _ => 0.0,
/// };
/// let mut simulation = Scene::<f64, 1>::new(schemes::impact())
///     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4).velocity([200.0]))
///     .load(Load::heating(source))
///     .build()?;
/// simulation.run_until(1e-5)?;
/// let heat: Vec<f64> = simulation.all().map(|particle| particle.energy()).collect();
/// assert!((heat[4] - 10.0).abs() < 0.1 && heat[5].abs() < 0.1, "1 MW/kg for 10 µs, 2 mm on: {heat:?}");
/// # Ok::<(), Error>(())
/// ```
///
/// Other fields it names beforehand.
///
/// ```
/// use meshfree::effect::HeatConduction;
/// use meshfree::prelude::*;
/// // Current heats a wire by more, the hotter it is: 1 MW/kg at 300 K, and 0.4 % more for each kelvin.
/// let conduction = HeatConduction { conductivity: 400.0, specific_heat: 385.0, temperature: 300.0 };
/// let current = Load::heating(|at| {
///     let kelvin = at.scalar(HeatConduction::TEMPERATURE).unwrap_or(300.0);
///     1e6 * (1.0 + 0.004 * (kelvin - 300.0))
/// });
/// let mut wire = Scene::<f64, 1>::new(schemes::impact_by_continuity().with(conduction))
///     .body(Body::block("wire", catalogue::copper(), [0.0], [0.01], 2e-4))
///     .load(current.reading(&[HeatConduction::TEMPERATURE]))
///     .build()?;
/// wire.run_until(1e-6)?;
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone)]
pub struct Load<const D: usize> {
    kind: Kind<D>,
    /// What it reads beside what every load sees.
    reads: Fields,
    /// The body on which it acts; on all without one.
    body: Option<String>,
}

/// What a load gives.
#[derive(Clone)]
enum Kind<const D: usize> {
    Acceleration(Law<[f64; D], D>),
    Heating(Law<f64, D>),
}

impl<const D: usize> Load<D> {
    /// An acceleration a \[m/s²\] of each particle.
    #[must_use]
    pub fn acceleration(
        law: impl Fn(&LoadPoint<'_, D>) -> [f64; D] + Send + Sync + 'static,
    ) -> Self {
        Self {
            kind: Kind::Acceleration(Arc::new(law)),
            reads: Fields::NONE,
            body: None,
        }
    }

    /// A heat source q \[W/kg\] of each particle: of its internal energy, and of its temperature under
    /// [`HeatConduction`](crate::effect::HeatConduction). Bodies whose scheme carries neither cannot be heated.
    #[must_use]
    pub fn heating(law: impl Fn(&LoadPoint<'_, D>) -> f64 + Send + Sync + 'static) -> Self {
        Self {
            kind: Kind::Heating(Arc::new(law)),
            reads: Fields::NONE,
            body: None,
        }
    }

    /// Lets it act on one body alone, by its name; on all bodies if not given.
    #[must_use]
    pub fn on(self, body: &str) -> Self {
        Self {
            body: Some(body.into()),
            ..self
        }
    }

    /// Names fields that it reads, for [`LoadPoint::scalar`] and [`LoadPoint::component`]. The schemes of its bodies must have them.
    #[must_use]
    pub fn reading(self, fields: &[Field]) -> Self {
        let reads = self.reads.union(Fields::of(fields));
        Self { reads, ..self }
    }

    /// What it reads beside what every load sees.
    pub(crate) fn reads(&self) -> Fields {
        self.reads
    }

    /// The name of the body that it was limited to.
    pub(crate) fn body(&self) -> Option<&str> {
        self.body.as_deref()
    }

    /// Whether it acts on the body with a name.
    pub(crate) fn acts_on(&self, body: &str) -> bool {
        self.body().is_none_or(|own| own == body)
    }

    /// Whether it is a heat source.
    pub(crate) fn heats(&self) -> bool {
        matches!(self.kind, Kind::Heating(_))
    }

    /// The field in which its values are kept.
    pub(crate) fn field(&self) -> Field {
        match self.kind {
            Kind::Acceleration(_) => Field::LOAD_ACCELERATION,
            Kind::Heating(_) => Field::LOAD_HEATING,
        }
    }

    /// Adds what it gives a particle to that field; the first value after which the sum is not finite, if there is one.
    pub(crate) fn add<T: Real>(&self, at: &LoadPoint<'_, D>, sum: &mut [T]) -> Option<f64> {
        match &self.kind {
            // Steps are chosen by the size of accelerations.
            Kind::Acceleration(law) => add(sum, &law(at), |a| a * a),
            Kind::Heating(law) => add(sum, &[law(at)], |q| q),
        }
    }
}

/// Adds values to sums; the first after which what `must_be_finite` makes of the sum is not finite.
fn add<T: Real>(sum: &mut [T], values: &[f64], must_be_finite: impl Fn(T) -> T) -> Option<f64> {
    let mut wrong = None;
    for (sum, &value) in sum.iter_mut().zip(values) {
        *sum += T::from_f64(value);
        if !must_be_finite(*sum).to_f64().is_finite() {
            wrong = wrong.or(Some(value));
        }
    }
    wrong
}

/// What it is, in messages and in the fingerprint of a scene.
impl<const D: usize> fmt::Display for Load<D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self.kind {
            Kind::Acceleration(_) => "acceleration",
            Kind::Heating(_) => "heating",
        })?;
        match &self.body {
            Some(body) => write!(f, " on body `{body}`"),
            None => f.write_str(" on all bodies"),
        }
    }
}

impl<const D: usize> fmt::Debug for Load<D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Load({self})")
    }
}
