//! An open boundary: a pump that speeds up, and a vessel of gas that liquid is pressed into.
//! One gives the velocity of what enters, the other the pressure of what leaves.

use meshfree::boundary::{OpenBoundary, OpenPlace};

/// What a pump delivers: u = u₀ + a t, the same over its opening.
#[derive(Clone, Copy, Debug)]
pub struct Pump {
    /// Speed at the start \[m/s\].
    pub speed: f64,
    /// How fast it grows \[m/s²\].
    pub acceleration: f64,
}

impl<const D: usize> OpenBoundary<D> for Pump {
    fn name(&self) -> String {
        format!("pump from {} m/s by {} m/s²", self.speed, self.acceleration)
    }
    fn velocity(&self, at: &OpenPlace<D>) -> Option<[f64; D]> {
        let speed = self.speed + self.acceleration * at.time;
        Some(at.inwards.map(|n| speed * n))
    }
}

/// A vessel whose gas is compressed as the pump goes on: p = p₀ + ṗ t.
#[derive(Clone, Copy, Debug)]
pub struct Vessel {
    /// Pressure at the start \[Pa\].
    pub pressure: f64,
    /// How fast it grows \[Pa/s\].
    pub rate: f64,
}

impl<const D: usize> OpenBoundary<D> for Vessel {
    fn name(&self) -> String {
        format!("vessel from {} Pa by {} Pa/s", self.pressure, self.rate)
    }
    fn pressure(&self, at: &OpenPlace<D>) -> Option<f64> {
        Some(self.pressure + self.rate * at.time)
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let fine = self.pressure >= 0.0;
        let bad = (!fine).then_some((
            "pressure of the vessel",
            self.pressure,
            "it must not be negative, in Pa",
        ));
        bad.into_iter().collect()
    }
}
