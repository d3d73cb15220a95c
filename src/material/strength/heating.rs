//! The temperature that plastic work gives a solid.
//! T = T₀ + χ w/c, with the share of Taylor and Quinney.

use super::ROOM_TEMPERATURE;
use crate::material::eos::guard::Problems;
use crate::scalar::Lane;

/// How plastic work w \[J/kg\] warms a solid (Taylor & Quinney 1934).
///
/// ```text
/// T = T₀ + χ w/c
/// ```
///
/// Conduction is left out, which is right within microseconds; so is the heat of shocks.
///
/// ```
/// use meshfree::material::strength::PlasticHeating;
/// let copper = PlasticHeating::new(383.0);
/// // A plastic strain of one at 300 MPa: 34 kJ/kg.
/// let temperature = copper.temperature(300e6_f64 / 8930.0);
/// assert!((temperature - 377.1).abs() < 0.1);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct PlasticHeating {
    /// Specific heat c \[J/(kg K)\].
    pub specific_heat: f64,
    /// Temperature T₀ \[K\] at the start; [`ROOM_TEMPERATURE`] unless set.
    pub initial_temperature: f64,
    /// Share χ of plastic work that becomes heat; 0.9 unless set, as measured on most metals. The rest is stored in
    /// the lattice.
    pub share: f64,
}

impl PlasticHeating {
    /// c \[J/(kg K)\].
    #[must_use]
    pub const fn new(specific_heat: f64) -> Self {
        Self {
            specific_heat,
            initial_temperature: ROOM_TEMPERATURE,
            share: 0.9,
        }
    }
    /// With T₀ \[K\].
    #[must_use]
    pub const fn with_initial_temperature(mut self, initial_temperature: f64) -> Self {
        self.initial_temperature = initial_temperature;
        self
    }
    /// With χ.
    #[must_use]
    pub const fn with_share(mut self, share: f64) -> Self {
        self.share = share;
        self
    }
    /// Temperature T \[K\] after plastic work w \[J/kg\].
    #[must_use]
    #[inline(always)]
    pub fn temperature<L: Lane>(&self, plastic_work: L) -> L {
        let [first, share, heat] =
            [self.initial_temperature, self.share, self.specific_heat].map(L::of);
        first + share * plastic_work / heat
    }
    /// What is wrong with the parameters, as `(field, value, what it must be)`; empty if nothing.
    #[must_use]
    pub fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        Problems::default()
            .positive("specific_heat", self.specific_heat)
            .positive("initial_temperature", self.initial_temperature)
            .must(
                (0.0..=1.0).contains(&self.share),
                "share",
                self.share,
                "between 0 and 1",
            )
            .list()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_becomes_heat_by_its_share() {
        let heating = PlasticHeating::new(400.0)
            .with_initial_temperature(300.0)
            .with_share(0.5);
        assert_eq!(heating.temperature(0.0), 300.0);
        assert_eq!(heating.temperature(8000.0), 310.0);
        let wrong = PlasticHeating::new(0.0).with_share(1.1).problems();
        let fields: Vec<_> = wrong.iter().map(|problem| problem.0).collect();
        assert_eq!(fields, ["specific_heat", "share"]);
    }
}
