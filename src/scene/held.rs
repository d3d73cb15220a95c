//! What a scene holds: particles of bodies that are clamped, and bodies that are rigid.
//! Regions choose particles by where they are as built.

use super::Scene;
use crate::boundary::{Motion, motion_from};
use crate::origin::local;
use crate::particles::Field;
use crate::scalar::Real;
use crate::simulation::{Clamp, Group, Rigid};
use std::sync::Arc;

/// Chooses particles by where they are as built \[m\].
type Region<const D: usize> = Box<dyn Fn(&[f64; D]) -> bool + Send + Sync>;

/// Particles of a body that are clamped.
pub(super) struct ClampOf<const D: usize> {
    pub body: String,
    pub region: Region<D>,
    pub motion: Option<Arc<dyn Motion<D>>>,
    /// The event that begins it, and the one that ends it.
    pub since: Option<String>,
    pub until: Option<String>,
}

impl<const D: usize> ClampOf<D> {
    /// Whether no event begins or ends it.
    pub fn is_for_good(&self) -> bool {
        self.since.is_none() && self.until.is_none()
    }

    /// The numbers and places of those of some points that are clamped.
    pub fn particles(&self, points: &[[f64; D]]) -> Vec<(u32, [f64; D])> {
        let own = points.iter().enumerate().filter(|(_, x)| (self.region)(x));
        own.map(|(k, x)| (k as u32, *x)).collect()
    }
}

impl<T: Real, const D: usize> Scene<T, D> {
    /// Clamps the particles of a body for which `region` is true of where they are as built \[m\]: they stay there,
    /// whatever acts on them, and go on acting on others. What it takes is in
    /// [`Simulation::clamps`](crate::simulation::Simulation::clamps).
    ///
    /// Clamp as many layers as the kernel reaches (two to three), so that what is free sees a whole neighbourhood.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// // A rod that is pulled by its one end, and held by the other.
    /// let mut simulation = Scene::<f64, 1>::new(schemes::impact_by_continuity())
    ///     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4))
    ///     .fix("rod", |x| x[0] < 6e-4)
    ///     .clamp("rod", |x| x[0] > 9.4e-3, Translation::steady([0.5]))
    ///     .build()?;
    /// simulation.run_until(2e-6)?;
    /// let [held, pulled] = [0, 1].map(|k| simulation.clamps()[k].clone());
    /// assert!(pulled.impulse[0] > 0.0 && pulled.work > 0.0 && held.work == 0.0);
    /// let ledger = simulation.ledger();
    /// let given = held.impulse[0] + pulled.impulse[0];
    /// let gained = ledger.whole.momentum[0] - 3.0 * 8930.0 * 2e-4 * 0.5;
    /// assert!((gained / given - 1.0).abs() < 1e-9);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn fix(
        mut self,
        body: &str,
        region: impl Fn(&[f64; D]) -> bool + Send + Sync + 'static,
    ) -> Self {
        self.clamps.push(ClampOf {
            body: body.into(),
            region: Box::new(region),
            motion: None,
            since: None,
            until: None,
        });
        self
    }

    /// The same with particles that move as `motion` has it, whose acceleration they are given: they start with its
    /// velocity, and follow its path as exactly as the integrator does. A clamp of all particles of a
    /// [rigid](Self::rigid) body drives it as a whole.
    #[must_use]
    pub fn clamp(
        self,
        body: &str,
        region: impl Fn(&[f64; D]) -> bool + Send + Sync + 'static,
        motion: impl Motion<D> + 'static,
    ) -> Self {
        self.fix(body, region)
            .with_last_clamp(|own| own.motion = Some(Arc::new(motion)))
    }

    /// With the clamp that was added last changed.
    pub(super) fn with_last_clamp(mut self, change: impl FnOnce(&mut ClampOf<D>)) -> Self {
        if let Some(own) = self.clamps.last_mut() {
            change(own);
        }
        self
    }

    /// Lets a solid body move as a rigid one: by the sum of the forces on its particles and by their moment about its
    /// centre of mass, in one dimension without turning. Its particles keep their places in it to rounding. The motion
    /// that it starts with is the one that has the momentum and angular momentum of the velocities that it is given.
    ///
    /// A step kicks momenta and turns the body freely in between, by rotations about its principal axes
    /// (Dullweber, Leimkuhler & McLachlan 1997, J. Chem. Phys. 107, 5840): momentum and angular momentum stay to rounding,
    /// and energy is bounded. It needs an integrator that kicks and drifts.
    ///
    /// Its material gives it mass, and stiffness where it touches others by [couplings](crate::coupling): the sound
    /// speed may be chosen low, ten times the greatest speed, which makes steps longer and contacts softer. To liquids it is
    /// a wall. It goes through [periods](crate::boundary::Periodic), meets [walls of particles](Scene::wall) by contact, and
    /// leaves by an [outlet](Scene::outlet) when all of it has passed. Other boundaries, as planes, are refused: their
    /// images rotate, or move differently from it.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// // A box that falls and turns.
    /// let wood = Material::new("wood", meshfree::material::eos::Linear::new(600.0, 10.0));
    /// let turns = |[x, y]: [f64; 2], start| meshfree::scheme::Start { velocity: [-y, x], ..start };
    /// let mut simulation = Scene::<f64, 2>::new(schemes::impact_by_continuity())
    ///     .body(Body::block("box", wood, [-0.1; 2], [0.1; 2], 0.02).start(turns))
    ///     .rigid("box")
    ///     .acceleration(|_| [0.0, -9.81])
    ///     .build()?;
    /// simulation.run_until(0.5)?;
    /// let corner = simulation.body("box")?.next().map_or([0.0; 2], |p| p.position());
    /// let [x, y] = [-0.09, -0.09];
    /// let (sin, cos) = 0.5_f64.sin_cos();
    /// assert!((corner[0] - (cos * x - sin * y)).abs() < 1e-9);
    /// assert!((corner[1] - (sin * x + cos * y - 0.5 * 9.81 * 0.25)).abs() < 1e-9);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn rigid(mut self, body: &str) -> Self {
        self.rigid.push(body.into());
        self
    }

    /// Gives a group what it holds.
    pub(super) fn hold(&self, number: usize, group: &mut Group<T, D>) {
        let origin = &group.particles.origin.clone();
        for (k, body) in self.parts[number].bodies.iter().enumerate() {
            let clamps = self.clamps.iter().filter(|own| own.body == body.name);
            group.held.clamps.extend(clamps.map(|own| {
                let event = |name: &Option<String>| {
                    let name = name.as_ref()?;
                    self.events.iter().position(|own| own.name == *name)
                };
                let particles = own.particles(&body.points).into_iter();
                Clamp {
                    since: event(&own.since),
                    until: event(&own.until),
                    is_free: own.since.is_some(),
                    ..Clamp::new(
                        k,
                        particles.map(|(k, x)| (k, local(&x, origin))).collect(),
                        own.motion.as_ref().map(|own| motion_from(own, origin)),
                    )
                }
            }));
            if self.rigid.contains(&body.name) {
                let slots = group.particles.bodies[k].slots.clone();
                let mass = &group.particles.columns.raw(Field::MASS)[slots];
                let mass: Vec<f64> = mass.iter().map(|mass| mass.to_f64()).collect();
                let points: Vec<_> = body.points.iter().map(|x| local(x, origin)).collect();
                group.held.rigid.push(Rigid::new(k, &points, &mass));
            }
        }
    }
}
