//! Inflow by a profile: velocity as a function of place and time.
//! Pressure comes from the liquid inside.

use super::{OpenBoundary, OpenPlace, TimeSeries};

type Field<const D: usize> = Box<dyn Fn([f64; D], f64) -> [f64; D] + Send + Sync>;

/// Velocity \[m/s\] as a function of place \[m\] and time \[s\], for an [`Inlet`](super::Inlet) or for the buffer of an
/// [`Outlet`](super::Outlet) from which liquid is drawn.
///
/// ```
/// use meshfree::boundary::{OpenBoundary, OpenPlace, VelocityProfile};
/// // Poiseuille flow of mean 1 m/s between plates at 0 and 1 m.
/// let parabola = VelocityProfile::new(|[_, y]: [f64; 2], _| [6.0 * y * (1.0 - y), 0.0]);
/// let at = OpenPlace { position: [0.0, 0.5], time: 0.0, inwards: [1.0, 0.0] };
/// assert_eq!(parabola.velocity(&at), Some([1.5, 0.0]));
/// ```
pub struct VelocityProfile<const D: usize> {
    of: Field<D>,
    strength: TimeSeries,
}

impl<const D: usize> VelocityProfile<D> {
    /// Velocity as a function of place and time.
    #[must_use]
    pub fn new(of: impl Fn([f64; D], f64) -> [f64; D] + Send + Sync + 'static) -> Self {
        Self {
            of: Box::new(of),
            strength: 1.0.into(),
        }
    }

    /// The same, times a number that changes with time.
    #[must_use]
    pub fn times(mut self, strength: impl Into<TimeSeries>) -> Self {
        self.strength = strength.into();
        self
    }
}

impl<const D: usize> OpenBoundary<D> for VelocityProfile<D> {
    fn name(&self) -> String {
        format!("velocity as a function of place, times {}", self.strength)
    }
    fn velocity(&self, at: &OpenPlace<D>) -> Option<[f64; D]> {
        let strength = self.strength.value(at.time);
        Some((self.of)(at.position, at.time).map(|u| strength * u))
    }
    fn span(&self) -> [f64; 2] {
        self.strength.span()
    }
    fn resolution(&self) -> Option<f64> {
        self.strength.resolution()
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let bad = self.strength.bad_constant().into_iter();
        bad.map(|bad| ("strength of the profile", bad, "it must be finite"))
            .collect()
    }
}
