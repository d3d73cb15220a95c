//! Outflow at a given pressure: the liquid in the buffer has it, and the velocity of the liquid inside.
//! After Tafuni, Domínguez, Vacondio & Crespo 2018 (Comput. Methods Appl. Mech. Engrg. 342, 604).

use super::{OpenBoundary, OpenPlace, TimeSeries};

type Excess<const D: usize> = Box<dyn Fn([f64; D]) -> f64 + Send + Sync>;

/// The pressure \[Pa\] at which liquid leaves, for the buffer of an [`Outlet`](super::Outlet).
///
/// A level that may change with time, the same over the section, and what a place adds to it, as the weight of liquid above:
/// p(x, t) = p₀(t) + p₁(x).
///
/// Pressure is that of the equation of state. Where the scheme has no tension ([`Cavitation`](crate::effect::Cavitation)), the level
/// must stay above what fluctuates in the flow, of the order of ρ u²: in a liquid a constant pressure moves nothing.
///
/// ```
/// use meshfree::boundary::{GivenPressure, OpenBoundary, OpenPlace};
/// let below_a_surface = GivenPressure::of(0.0).plus(|[_, y]: [f64; 2]| 9810.0 * (2.0 - y));
/// let at = OpenPlace { position: [1.0, 0.5], time: 0.0, inwards: [-1.0, 0.0] };
/// assert_eq!(below_a_surface.pressure(&at), Some(14715.0));
/// ```
pub struct GivenPressure<const D: usize> {
    level: TimeSeries,
    excess: Option<Excess<D>>,
}

impl<const D: usize> GivenPressure<D> {
    /// A pressure \[Pa\], or one that changes with time.
    #[must_use]
    pub fn of(level: impl Into<TimeSeries>) -> Self {
        Self {
            level: level.into(),
            excess: None,
        }
    }

    /// The same, and more \[Pa\] by the place \[m\].
    #[must_use]
    pub fn plus(mut self, excess: impl Fn([f64; D]) -> f64 + Send + Sync + 'static) -> Self {
        self.excess = Some(Box::new(excess));
        self
    }
}

impl<const D: usize> OpenBoundary<D> for GivenPressure<D> {
    fn name(&self) -> String {
        let and = self.excess.as_ref().map_or("", |_| " and more by place");
        format!("pressure of {} Pa{and}", self.level)
    }
    fn pressure(&self, at: &OpenPlace<D>) -> Option<f64> {
        let excess = self.excess.as_ref().map_or(0.0, |own| own(at.position));
        Some(self.level.value(at.time) + excess)
    }
    fn span(&self) -> [f64; 2] {
        self.level.span()
    }
    fn resolution(&self) -> Option<f64> {
        self.level.resolution()
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let bad = self.level.bad_constant().into_iter();
        bad.map(|bad| ("pressure", bad, "it must be finite, in Pa"))
            .collect()
    }
}
