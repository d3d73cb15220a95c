//! The stiffness of the springs of a coupling: the one given, or that of what lies between the bodies.
//! Shared by contacts and ties that act pair by pair.

use crate::scalar::Lane;

/// A stiffness k \[N/m\] of a pair (N/m per metre in 2D, per m² in 1D), if it was given.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Spring(pub Option<f64>);

impl Spring {
    /// The stiffness given, or `share` of M s^(D−2) \[N/m\] by the stiffness M \[Pa\] of the bodies and their spacing s \[m\].
    pub fn of<L: Lane, const D: usize>(self, share: f64, stiffness: L, spacing: L) -> L {
        let own = || L::of(share) * super::link::<L, D>(stiffness, spacing);
        self.0.map_or_else(own, L::of)
    }

    /// What is wrong with it.
    pub fn problems(self) -> Vec<(&'static str, f64, &'static str)> {
        let wrong = self.0.filter(|k| !(k.is_finite() && *k > 0.0));
        let must_be = "it must be finite and positive, in N/m";
        let wrong = wrong.map(|k| ("stiffness", k, must_be));
        wrong.into_iter().collect()
    }
}
