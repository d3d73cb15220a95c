//! The box in which a scene is awake: particles outside of it sleep, and wake when it reaches them.
//! For particles that leave for good there are outlets.

use super::Scene;
use crate::error::Problem;
use crate::scalar::Real;
use crate::simulation::Simulation;
use std::sync::Arc;

impl<T: Real, const D: usize> Scene<T, D> {
    /// Lets particles sleep that are outside of a box \[m\], from its low to its high corner. The box is asked for when the
    /// scene is built and after every step, so it may follow the time, an [event](Self::event) or what moves. An infinite
    /// bound is none.
    ///
    /// A sleeper is held as by a clamp: it stays where it is, at rest, with the density, energy and stress that it had, and
    /// goes on acting on its neighbours as something at rest. It is counted in all ledgers. Its velocity is taken when it
    /// falls asleep, and it wakes at rest, after the step in which the box reaches it or it is inside again. What holds
    /// it, that velocity, and the work of pairs that it does not receive are booked as given by the box:
    /// [`Simulation::asleep`]. So m v plus what all others were given stays to rounding, and so does energy where the
    /// scheme keeps it to rounding.
    ///
    /// It is for what must not change the answer and would disturb it: gas or ground far from a blast that has yet to reach them, water far
    /// from the ship, spray that has left the region of interest and may not set the step. Sums of pairs of sleepers are taken all the same,
    /// so it makes a step no cheaper; what may be dropped is dropped by an [outlet](Self::outlet). The edge of the
    /// box is a wall at rest, and reflects waves: keep it beyond what moves.
    ///
    /// Clamped particles are no sleepers while they are clamped. Rigid bodies, and integrators that do not kick
    /// and drift, are refused with it.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// // A rod is struck at its left end; what the pulse has not reached, at 1.3 times its speed, sleeps.
    /// let mut simulation = Scene::<f64, 1>::new(schemes::impact())
    ///     .body(Body::block("striker", catalogue::copper(), [-0.002], [0.0], 2e-4).velocity([20.0]))
    ///     .body(Body::block("rod", catalogue::copper(), [0.0], [0.03], 2e-4))
    ///     .awake_inside(|now| [[f64::NEG_INFINITY], [0.004 + 5200.0 * now.time()]])
    ///     .build()?;
    /// let before = simulation.ledger().whole;
    /// simulation.run_until(3e-6)?;
    /// let (after, asleep) = (simulation.ledger().whole, simulation.asleep());
    /// let asleep = asleep.unwrap_or_default();
    /// assert!(asleep.particles == 52 && asleep.woken == 78);
    /// let given = after.momentum[0] - before.momentum[0];
    /// assert!((given - asleep.impulse[0]).abs() < 1e-12 * before.momentum[0]);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn awake_inside(
        mut self,
        bounds: impl Fn(&Simulation<T, D>) -> [[f64; D]; 2] + Send + Sync + 'static,
    ) -> Self {
        self.awake = Some(Arc::new(bounds));
        self
    }

    /// What does not go with sleepers.
    pub(super) fn check_sleepers(&self, problems: &mut Vec<Problem>) {
        if self.awake.is_none() {
            return;
        }
        if let Some(body) = self.rigid.first() {
            problems.push(Problem::Incompatible {
                what: format!(
                    "body `{body}` is rigid in a scene in which particles sleep outside of a box"
                ),
                remedy: "leave Scene::awake_inside out: a rigid body moves as one",
            });
        }
        if !self.integrator.kicks() || !self.integrator.drifts() {
            problems.push(Problem::Incompatible {
                what: format!(
                    "the integrator {} does not step by kicks and drifts, by which particles that sleep are held",
                    self.integrator.name()
                ),
                remedy: "take KickDriftKick",
            });
        }
    }
}
