//! Events of a scene, and what waits for them: loads that begin, and bodies that are held until something happens.
//! Events are part of the state, so a run that resumes goes on to the same bits.

use super::Scene;
use crate::boundary::Motion;
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
        self.fix(body, region)
            .with_last_clamp(|own| own.until = Some(event.into()))
    }

    /// Clamps particles that move as `motion` has it, as [`clamp`](Self::clamp) does, until an [event](Self::event) has
    /// happened: from the end of that step they are free, with the velocity that they have. All particles of a
    /// [rigid](Self::rigid) body drive it as a whole.
    ///
    /// For a release at a time let a step [end there](Self::step_ends_at).
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// use meshfree::material::eos::Linear;
    /// // A box is lowered at 1 m/s for 0.1 s, and let go.
    /// let wood = Material::new("wood", Linear::new(600.0, 10.0));
    /// let mut simulation = Scene::<f64, 2>::new(schemes::impact_by_continuity())
    ///     .body(Body::block("box", wood, [-0.1; 2], [0.1; 2], 0.02))
    ///     .rigid("box")
    ///     .clamp_until("box", |_| true, Translation::steady([0.0, -1.0]), "let go")
    ///     .event("let go", |now| now.time() >= 0.1)
    ///     .step_ends_at([0.1])
    ///     .acceleration(|_| [0.0, -9.81])
    ///     .build()?;
    /// simulation.run_until(0.3)?;
    /// let fallen = simulation.body("box")?.next().map_or(0.0, |p| p.position()[1] + 0.09);
    /// assert!((fallen / -(0.1 + 0.2 + 0.5 * 9.81 * 0.04) - 1.0).abs() < 1e-9);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn clamp_until(
        self,
        body: &str,
        region: impl Fn(&[f64; D]) -> bool + Send + Sync + 'static,
        motion: impl Motion<D> + 'static,
        event: &str,
    ) -> Self {
        self.clamp(body, region, motion)
            .with_last_clamp(|own| own.until = Some(event.into()))
    }

    /// Catches the particles of a body for which `region` is true of where they are as built \[m\] when an
    /// [event](Self::event) has happened: at the end of that step they stop where they are, and stay. Before it they are free.
    /// The momentum and the kinetic energy that they lose are in the impulse and the work of the clamp
    /// ([`Simulation::clamps`](crate::simulation::Simulation::clamps)). Catch all of a [rigid](Self::rigid) body.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// // A rod flies, and is caught.
    /// let mut simulation = Scene::<f64, 1>::new(schemes::impact_by_continuity())
    ///     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4).velocity([20.0]))
    ///     .event("caught", |now| now.time() >= 1e-6)
    ///     .fix_from("rod", |_| true, "caught")
    ///     .build()?;
    /// let momentum = simulation.ledger().whole.momentum[0];
    /// simulation.run_until(2e-6)?;
    /// assert_eq!(simulation.ledger().whole.momentum[0], 0.0);
    /// assert!((simulation.clamps()[0].impulse[0] / -momentum - 1.0).abs() < 1e-12);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn fix_from(
        self,
        body: &str,
        region: impl Fn(&[f64; D]) -> bool + Send + Sync + 'static,
        event: &str,
    ) -> Self {
        self.fix(body, region)
            .with_last_clamp(|own| own.since = Some(event.into()))
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
        let waits = self.clamps.iter();
        let waits = waits.flat_map(|own| own.since.iter().chain(&own.until));
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
