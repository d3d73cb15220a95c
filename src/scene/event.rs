//! Events of a scene, and what waits for them: loads that begin, and bodies that are held until something happens.
//! Events are part of the state, so a run that resumes goes on to the same bits.

use super::Scene;
use crate::error::Problem;
use crate::scalar::Real;
use crate::simulation::{Event, Simulation};
use std::sync::Arc;

impl<T: Real, const D: usize> Scene<T, D> {
    /// Names a condition that is looked at after every step until it holds: an event. [`Simulation::event`] tells when it
    /// happened, a load asks for it by [`LoadPoint::since`](crate::simulation::LoadPoint::since), and
    /// [`fix_until`](Self::fix_until) holds a body until then.
    ///
    /// A load that waits for an event begins with the first evaluation after the step in which it happened: half a step late.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// // A rod is heated from when its end has moved by a hundredth of a millimetre.
    /// let moved = |now: &Simulation<f64, 1>| now.all().next().is_some_and(|p| p.position()[0] > 1.1e-4);
    /// let mut simulation = Scene::<f64, 1>::new(schemes::impact())
    ///     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4).velocity([20.0]))
    ///     .event("moved", moved)
    ///     .load(Load::heating(|at| if at.since("moved").is_some() { 1e9 } else { 0.0 }))
    ///     .build()?;
    /// simulation.run_until(1e-6)?;
    /// let when = simulation.event("moved")?;
    /// assert!(when.is_some_and(|time| (time - 0.5e-6).abs() < 0.1e-6));
    /// let heat = simulation.ledger().whole.internal / simulation.ledger().whole.mass;
    /// assert!((heat / (1e9 * 0.5e-6) - 1.0).abs() < 0.2);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn event(
        mut self,
        name: &str,
        condition: impl Fn(&Simulation<T, D>) -> bool + Send + Sync + 'static,
    ) -> Self {
        self.events.push(Event {
            name: name.into(),
            condition: Arc::new(condition),
        });
        self
    }

    /// Clamps the particles of a body for which `region` is true of where they are as built \[m\], as [`fix`](Self::fix)
    /// does, until an [event](Self::event) has happened. What holds them until then is in
    /// [`Simulation::clamps`](crate::simulation::Simulation::clamps).
    #[must_use]
    pub fn fix_until(
        self,
        body: &str,
        region: impl Fn(&[f64; D]) -> bool + Send + Sync + 'static,
        event: &str,
    ) -> Self {
        let mut scene = self.fix(body, region);
        if let Some(own) = scene.clamps.last_mut() {
            own.until = Some(event.into());
        }
        scene
    }

    /// Keeps a solid body where it is, at rest, until it first feels another body, a wall or a boundary: from the end of the
    /// step in which it does it moves freely. The momentum that it is given in that step the clamp takes, and books
    /// ([`Simulation::clamps`](crate::simulation::Simulation::clamps)).
    ///
    /// It is an [event](Self::event) named `first contact of` the body, and a clamp of all its particles until then: gravity
    /// and what shakes the frame do not move it, and no rounding does. Its pairs are summed all the same.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// let mut simulation = Scene::<f64, 1>::new(schemes::impact())
    ///     .body(Body::block("striker", catalogue::copper(), [0.0], [0.005], 2e-4).velocity([100.0]))
    ///     .body(Body::block("target", catalogue::copper(), [0.0051], [0.0101], 2e-4))
    ///     .acceleration(|_| [1e5])
    ///     .at_rest_until_contact("target")
    ///     .build()?;
    /// simulation.run_until(3e-6)?;
    /// let met = simulation.event("first contact of target")?;
    /// assert!(met.is_some_and(|time| (time - 1e-6).abs() < 0.2e-6));
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn at_rest_until_contact(self, body: &str) -> Self {
        let event = format!("first contact of {body}");
        let name = body.to_owned();
        self.event(&event, move |now| now.touches(&name))
            .fix_until(body, |_| true, &event)
    }

    /// Events have names of their own, and what waits for one waits for one that there is.
    pub(super) fn check_events(&self, problems: &mut Vec<Problem>) {
        for (k, own) in self.events.iter().enumerate() {
            if self.events[..k].iter().any(|other| other.name == own.name) {
                problems.push(Problem::Incompatible {
                    what: format!("two events are called `{}`", own.name),
                    remedy: "give every event a name of its own",
                });
            }
        }
        let waits = self.clamps.iter().filter_map(|own| own.until.as_ref());
        let waits = waits.chain(self.exchanges.iter().map(|own| &own.event));
        for name in waits.filter(|name| !self.events.iter().any(|own| own.name == **name)) {
            let known = self.events.iter().map(|own| format!("`{}`", own.name));
            problems.push(Problem::UnknownName {
                kind: "event",
                name: name.clone(),
                known: known.collect::<Vec<_>>().join(", "),
            });
        }
    }
}
