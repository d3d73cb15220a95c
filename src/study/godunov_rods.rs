//! Chains of rods with any equation of state: a second-order Godunov method in mass coordinates.
//! The reference for what is nonlinear in rod impact; its limit of small velocity is `acoustic_rods`.
//!
//! In each segment, with mass coordinate m \[kg/m²\], specific volume τ = 1/ρ, velocity u, pressure p
//! = p(ρ, e) (so σ = −p), specific total energy E = e + ½u² and impedance z = ρc,
//!
#![doc = include_str!("../../docs/equations/godunov.html")]
//!
//! (S. K. Godunov 1959; B. van Leer, *Journal of Computational Physics* 32 (1979) 101, the
//! MUSCL–Hancock form of E. F. Toro 2009, Section 14.4; shock impedance W after J. K. Dukowicz,
//! *Journal of Computational Physics* 61 (1985) 119.) A = ½ d(ρc)/dρ|ₛ / c is taken from each law at
//! its initial state: it is S of a linear Hugoniot, and makes weak shocks and rarefactions right to
//! second order; the conservation form makes the jumps of strong ones right. Mass, momentum and total
//! energy change by what walls do, to rounding. A unilateral contact opens when its face would be in
//! tension, moves as two free surfaces, and closes within the step in which its gap is used up.
//! Cells are as long in each segment as its waves travel in the same time, so fronts stay sharp
//! everywhere.
//!
//! ```
//! use meshfree::study::{Contact, Joint};
//! use meshfree::study::godunov_rods::{GodunovRods, PressureFn, RodSegment};
//! use std::sync::Arc;
//! let linear = |density0: f64, c: f64| {
//!     Arc::new(PressureFn(move |density: f64, _energy: f64| (c * c * (density - density0), c)))
//! };
//! let copper = linear(8930.0, 3940.0);
//! let run = GodunovRods::new(200)
//!     .segment(RodSegment::at_rest(copper.clone(), 0.010, 8930.0).moving(20.0))
//!     .contact(Contact::Unilateral)
//!     .segment(RodSegment::at_rest(copper, 0.040, 8930.0))
//!     .gauge(0.005)
//!     .solve(3e-6)?;
//! let gauge = &run.gauges()[0];
//! let plateau = gauge.stress[gauge.stress.len() - 1];
//! assert!((plateau / -352e6 - 1.0).abs() < 0.01);
//! assert!(run.ledger().momentum_defect().abs() < 1e-12);
//! # Ok::<(), meshfree::study::StudyError>(())
//! ```

use super::chain::chain_of_rods;
use super::{Contact, End, StudyError, finite, positive, within};
use crate::material::eos::EquationOfState;
use core::fmt::{self, Debug};
use std::sync::Arc;

mod cells;
mod faces;
mod record;
#[cfg(test)]
mod tests;

pub use record::{Cell, GaugeRecord, GodunovSolution, JointRecord, Ledger, Snapshot};

/// Pressure and sound speed of a row of cells: an equation of state whose type is forgotten, so that
/// each segment can have its own.
///
/// Every [`EquationOfState`] is one; [`PressureFn`] makes one of a closure.
pub trait PressureLaw: Debug + Send + Sync {
    /// Writes pressure p \[Pa\] and sound speed c \[m/s\] for density ρ \[kg/m³\] and specific
    /// internal energy e \[J/kg\], cell by cell. The four rows have the same length.
    fn evaluate(
        &self,
        density: &[f64],
        energy: &[f64],
        pressure: &mut [f64],
        sound_speed: &mut [f64],
    );
}

impl<E: EquationOfState> PressureLaw for E {
    fn evaluate(
        &self,
        density: &[f64],
        energy: &[f64],
        pressure: &mut [f64],
        sound_speed: &mut [f64],
    ) {
        let inputs = density.iter().zip(energy);
        for ((p, c), (&density, &energy)) in pressure.iter_mut().zip(sound_speed).zip(inputs) {
            let state = self.state(density, energy);
            *p = state.pressure;
            *c = state.sound_speed;
        }
    }
}

/// A pressure law from a function (ρ, e) ↦ (p, c).
#[derive(Clone, Copy)]
pub struct PressureFn<F>(pub F);

impl<F> Debug for PressureFn<F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("PressureFn")
    }
}

impl<F: Fn(f64, f64) -> (f64, f64) + Send + Sync> PressureLaw for PressureFn<F> {
    fn evaluate(
        &self,
        density: &[f64],
        energy: &[f64],
        pressure: &mut [f64],
        sound_speed: &mut [f64],
    ) {
        let inputs = density.iter().zip(energy);
        for ((p, c), (&density, &energy)) in pressure.iter_mut().zip(sound_speed).zip(inputs) {
            (*p, *c) = (self.0)(density, energy);
        }
    }
}

/// State of the material at a place and time zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InitialState {
    /// Density ρ \[kg/m³\].
    pub density: f64,
    /// Specific internal energy e \[J/kg\].
    pub energy: f64,
    /// Velocity u \[m/s\].
    pub velocity: f64,
}

/// A piece of rod with one pressure law.
#[derive(Clone)]
pub struct RodSegment {
    law: Arc<dyn PressureLaw>,
    length: f64,
    uniform: InitialState,
    profile: Option<Arc<dyn Fn(f64) -> InitialState + Send + Sync>>,
}

impl Debug for RodSegment {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("RodSegment")
            .field("law", &self.law)
            .field("length", &self.length)
            .field("uniform", &self.uniform)
            .finish_non_exhaustive()
    }
}

impl RodSegment {
    /// A segment of length `length` \[m\] at rest with density `density` \[kg/m³\] and no energy.
    #[must_use]
    pub fn at_rest(law: Arc<dyn PressureLaw>, length: f64, density: f64) -> Self {
        Self {
            law,
            length,
            uniform: InitialState {
                density,
                energy: 0.0,
                velocity: 0.0,
            },
            profile: None,
        }
    }
    /// Sets the velocity at time zero \[m/s\].
    #[must_use]
    pub fn moving(mut self, velocity: f64) -> Self {
        self.uniform.velocity = velocity;
        self
    }
    /// Sets the specific internal energy at time zero \[J/kg\].
    #[must_use]
    pub fn with_energy(mut self, energy: f64) -> Self {
        self.uniform.energy = energy;
        self
    }
    /// Sets the state at time zero as a function of position x \[m\]; it replaces the uniform state.
    #[must_use]
    pub fn initially(
        mut self,
        profile: impl Fn(f64) -> InitialState + Send + Sync + 'static,
    ) -> Self {
        self.profile = Some(Arc::new(profile));
        self
    }
    fn state_at(&self, x: f64) -> InitialState {
        match &self.profile {
            Some(profile) => profile(x),
            None => self.uniform,
        }
    }
}

/// How the gradients of two neighbouring faces become the gradient of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Limiter {
    /// No gradient: the first-order method of Godunov.
    FirstOrder,
    /// The smaller of the two (P. L. Roe 1986): most diffusive of the second-order ones.
    Minmod,
    /// The mean, but at most twice the smaller (B. van Leer 1977): sharp fronts, no overshoot.
    MonotonizedCentral,
}

/// A chain of rod segments, to be solved by the Godunov method.
///
/// Segments follow each other from left to right. They are bonded unless
/// [`contact`](GodunovRods::contact) is called between them; both ends are free and the left end is
/// at x = 0 unless said otherwise.
#[derive(Clone, Debug)]
pub struct GodunovRods {
    cells: usize,
    start: f64,
    segments: Vec<RodSegment>,
    contacts: Vec<Contact>,
    next: Contact,
    ends: [End; 2],
    courant: f64,
    limiter: Limiter,
    tension: Option<f64>,
    gauges: Vec<f64>,
    snapshots: Vec<f64>,
}

impl GodunovRods {
    /// An empty chain that will have about `cells` cells. They are shared out by transit time, and no
    /// segment gets fewer than four.
    #[must_use]
    pub fn new(cells: usize) -> Self {
        Self {
            cells,
            start: 0.0,
            segments: Vec::new(),
            contacts: Vec::new(),
            next: Contact::Bonded,
            ends: [End::Free; 2],
            courant: 0.9,
            limiter: Limiter::MonotonizedCentral,
            tension: None,
            gauges: Vec::new(),
            snapshots: Vec::new(),
        }
    }
    chain_of_rods!();

    /// The Courant number: the part of a cell that a wave may cross in a step. 0.9 unless set, the
    /// largest that leaves room for waves that speed up within a step; 1 is the limit of stability.
    #[must_use]
    pub fn courant(mut self, number: f64) -> Self {
        self.courant = number;
        self
    }
    /// The limiter; [`Limiter::MonotonizedCentral`] unless set, the sharpest of those offered.
    #[must_use]
    pub fn limiter(mut self, limiter: Limiter) -> Self {
        self.limiter = limiter;
        self
    }
    /// The tension \[Pa\] that a unilateral contact carries before it opens. Unless set, 10⁻⁴ of the
    /// largest ρc|u − u′| at a contact at time zero: rods of one material unload each other to
    /// stresses of either sign of 10⁻⁶ of that, and fronts in general come in over a few steps, so
    /// that the time of opening depends on this by less than its own resolution.
    #[must_use]
    pub fn tension_tolerance(mut self, tension: f64) -> Self {
        self.tension = Some(tension);
        self
    }
    /// Records stress and velocity after each step at the material point that starts at `x0` \[m\].
    #[must_use]
    pub fn gauge(mut self, x0: f64) -> Self {
        self.gauges.push(x0);
        self
    }
    /// Records all cells at time `t` \[s\]; a step ends exactly there.
    #[must_use]
    pub fn snapshot(mut self, t: f64) -> Self {
        self.snapshots.push(t);
        self
    }

    /// Marches from time zero to `until` \[s\].
    ///
    /// # Errors
    /// If a parameter is out of range, a gauge or snapshot is outside, or a cell leaves the range in
    /// which its law gives a finite pressure and a positive sound speed.
    pub fn solve(&self, until: f64) -> Result<GodunovSolution, StudyError> {
        positive("the end time [s]", until)?;
        self.check_chain()?;
        for segment in &self.segments {
            positive("length of a segment [m]", segment.length)?;
        }
        positive("the Courant number", self.courant)?;
        if self.courant > 1.0 {
            return Err(StudyError::Parameter {
                quantity: "the Courant number",
                value: self.courant,
                requirement: "at most 1",
            });
        }
        if let Some(tension) = self.tension.filter(|&t| !(t >= 0.0 && t.is_finite())) {
            return Err(StudyError::Parameter {
                quantity: "the tension tolerance [Pa]",
                value: tension,
                requirement: "0 or more",
            });
        }
        let length: f64 = self.segments.iter().map(|s| s.length).sum();
        for &x in &self.gauges {
            within("gauge position [m]", x, self.start, self.start + length)?;
        }
        for &t in &self.snapshots {
            within("snapshot time [s]", t, 0.0, until)?;
        }
        record::march(self, until)
    }
}
