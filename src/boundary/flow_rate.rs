//! Inflow by a flow rate: a volume in a time, spread over the section of an opening.
//! Pressure comes from the liquid inside.

use super::{OpenBoundary, OpenPlace, TimeSeries};
use crate::geometry::POSITIVE;

type Shape<const D: usize> = Box<dyn Fn([f64; D]) -> f64 + Send + Sync>;

/// A flow rate Q through an opening of N points, u = Q s(x)/(Δxᴰ⁻¹ Σ s) along the way into the liquid.
///
/// Q is in m³/s in three dimensions, in m²/s (m³/s for every metre of depth) in a plane, and in m/s in one. The shape s is 1 by default: the
/// velocity is the same over the section. The sum is over the points of the opening, so that exactly Q enters whatever
/// their number.
///
/// ```
/// use meshfree::boundary::{FlowRate, OpenBoundary, OpenPlace};
/// let opening: Vec<[f64; 2]> = (0..10).map(|k| [0.0, 0.1 * (f64::from(k) + 0.5)]).collect();
/// let flow = FlowRate::over(&opening, 0.1, 0.3).shaped(|[_, y]| y * (1.0 - y));
/// let entering: f64 = opening.iter().map(|&position| {
///     let at = OpenPlace { position, time: 0.0, inwards: [1.0, 0.0] };
///     0.1 * flow.velocity(&at).unwrap_or_default()[0]
/// }).sum();
/// assert!((entering - 0.3).abs() < 1e-12);
/// ```
pub struct FlowRate<const D: usize> {
    rate: TimeSeries,
    opening: Vec<[f64; D]>,
    spacing: f64,
    shape: Shape<D>,
    /// Δxᴰ⁻¹ Σ s.
    section: f64,
    is_shaped: bool,
}

impl<const D: usize> FlowRate<D> {
    /// A flow `rate` through an opening of those points \[m\], `spacing` \[m\] apart: those of the [`Inlet`](super::Inlet).
    #[must_use]
    pub fn over(opening: &[[f64; D]], spacing: f64, rate: impl Into<TimeSeries>) -> Self {
        let own = Self {
            rate: rate.into(),
            opening: opening.to_vec(),
            spacing,
            shape: Box::new(|_| 1.0),
            section: 0.0,
            is_shaped: false,
        };
        own.measured()
    }

    /// The same with velocities in proportion to a shape s(x), which must not be negative and not zero everywhere.
    #[must_use]
    pub fn shaped(mut self, shape: impl Fn([f64; D]) -> f64 + Send + Sync + 'static) -> Self {
        self.shape = Box::new(shape);
        self.is_shaped = true;
        self.measured()
    }

    fn measured(mut self) -> Self {
        let sum: f64 = self.opening.iter().map(|x| (self.shape)(*x)).sum();
        self.section = self.spacing.powi(D as i32 - 1) * sum;
        self
    }
}

impl<const D: usize> OpenBoundary<D> for FlowRate<D> {
    fn name(&self) -> String {
        let shaped = if self.is_shaped { ", shaped" } else { "" };
        let rate = &self.rate;
        format!("flow rate of {rate} over {}{shaped}", self.section)
    }
    fn velocity(&self, at: &OpenPlace<D>) -> Option<[f64; D]> {
        let speed = self.rate.value(at.time) * (self.shape)(at.position) / self.section;
        Some(at.inwards.map(|n| speed * n))
    }
    fn span(&self) -> [f64; 2] {
        self.rate.span()
    }
    fn resolution(&self) -> Option<f64> {
        self.rate.resolution()
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let mut problems = Vec::new();
        if let Some(bad) = self.rate.bad_constant() {
            let must_be = "it must be finite, in m³/s, or in m²/s in a plane";
            problems.push(("flow rate", bad, must_be));
        }
        if !(self.section.is_finite() && self.section > 0.0) {
            problems.push(("section of the flow rate", self.section, POSITIVE));
        }
        let shape = |x: &[f64; D]| (self.shape)(*x);
        if let Some(bad) = self.opening.iter().map(shape).find(|s| *s < 0.0) {
            let must_be = "it must not be negative: liquid enters everywhere, or nowhere";
            problems.push(("shape of the flow rate", bad, must_be));
        }
        problems
    }
}
