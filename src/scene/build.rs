//! From a scene to a simulation: checked, laid out and evaluated once, or gone on with from a checkpoint.

use super::{Part, Scene};
use crate::error::{BuildError, Error, Problem, Result};
use crate::once::once;
use crate::origin::middle;
#[cfg(feature = "checkpoint")]
use crate::output::checkpoint::Checkpoint;
use crate::scalar::Real;
use crate::simulation::{Group, Simulation};
#[cfg(feature = "checkpoint")]
use std::path::Path;

/// A scene, and then the simulation that was made of it: one value, so that no type of its own has to come back.
struct Building<T: Real, const D: usize> {
    scene: Option<Scene<T, D>>,
    simulation: Option<Simulation<T, D>>,
}

impl<T: Real, const D: usize> Building<T, D> {
    fn of(scene: Scene<T, D>) -> Self {
        Self {
            scene: Some(scene),
            simulation: None,
        }
    }

    fn simulation(
        mut self,
        make: impl FnOnce(&mut Self) -> Result<()>,
    ) -> Result<Simulation<T, D>> {
        make(&mut self)?;
        Ok(self.simulation.expect("it was made"))
    }

    fn scene(&mut self) -> Scene<T, D> {
        self.scene.take().expect("it is made once")
    }

    fn build(&mut self) -> Result<()> {
        once!(self => &mut Building, |own| -> Result<()> {
            own.simulation = Some(own.scene().built()?);
            Ok(())
        })
    }

    #[cfg(feature = "checkpoint")]
    fn resume(&mut self, path: &Path) -> Result<()> {
        once!(self => &mut Building, |own, path: &Path| -> Result<()> {
            let file = Checkpoint::read(path)?;
            own.simulation = Some(own.scene().lay_out()?.resumed(path, &file)?);
            Ok(())
        })
    }
}

impl<T: Real, const D: usize> Scene<T, D> {
    /// Checks the scene and makes a simulation of it.
    ///
    /// # Errors
    /// [`Error::Build`] with every problem that was found.
    pub fn build(self) -> Result<Simulation<T, D>> {
        Building::of(self).simulation(Building::build)
    }

    fn built(self) -> Result<Simulation<T, D>> {
        let fixed = self.control.fixed;
        let mut simulation = self.lay_out()?;
        simulation.hold_velocities();
        simulation.take_references();
        let problems = simulation.isolated();
        if !problems.is_empty() {
            return Err(Error::Build(BuildError { problems }));
        }
        let evaluated = simulation.evaluate();
        let problems = simulation.surfaces_in_tension();
        if !problems.is_empty() {
            return Err(Error::Build(BuildError { problems }));
        }
        evaluated?;
        let vote = simulation.largest_fixed_step()?;
        match fixed {
            Some(step) if step > vote.step => Err(Error::Build(BuildError {
                problems: vec![Problem::StepAboveLimit {
                    step,
                    limit: vote.step,
                    criterion: vote.criterion.name(),
                }],
            })),
            _ => Ok(simulation),
        }
    }

    /// Goes on from a [checkpoint](crate::simulation#checkpoint-and-restart) of the same scene, to the same bits as if
    /// the run had not stopped. The scene supplies what is no state: schemes, materials, motions, loads, the integrator
    /// and how steps are chosen; the file supplies the rest. The pair loops run on the instruction set that they ran on
    /// before, whatever [`instructions`](Self::instructions) says.
    ///
    /// # Errors
    /// [`Error::File`] if the file cannot be read, [`Error::Checkpoint`] with what differs if it is cut short or
    /// altered, or of another scene, scalar, dimension, lane width, or of instructions that this machine lacks, and
    /// [`Error::Build`] as [`build`](Self::build).
    #[cfg(feature = "checkpoint")]
    pub fn resume(self, path: impl AsRef<Path>) -> Result<Simulation<T, D>> {
        Building::of(self).simulation(|own| own.resume(path.as_ref()))
    }

    /// The simulation before anything is summed.
    fn lay_out(self) -> Result<Simulation<T, D>> {
        let problems = self.problems();
        if !problems.is_empty() {
            return Err(Error::Build(BuildError { problems }));
        }
        let domain = self.domain();
        let origin = self.origin();
        let groups: Vec<_> = self.plans().map(|plan| plan.lay_out(origin)).collect();
        let built = self.places_as_built(&groups);
        let couples = self.couples(&origin);
        #[cfg(feature = "checkpoint")]
        let (hashes, values) = (self.hashes(), self.values());
        let mut simulation = Simulation::new(
            groups,
            couples,
            domain,
            self.integrator,
            self.control,
            self.accelerations,
            self.loads,
        )
        .with_step_ends(self.step_ends)
        .with_events(self.events);
        simulation.built = built;
        #[cfg(feature = "checkpoint")]
        let simulation = simulation.of_scene(hashes, values);
        Ok(simulation)
    }

    /// Where particles of each group are as built \[m\], by identity, if loads may ask. An inlet gives away the identities of
    /// those that have left, so its body has none.
    fn places_as_built(&self, groups: &[Group<T, D>]) -> Vec<Vec<Option<[f64; D]>>> {
        if self.loads.is_empty() {
            return Vec::new();
        }
        let of_group = |(part, group): (&Part<T, D>, &Group<T, D>)| {
            let mut places = vec![None; group.particles.ids.len()];
            for (body, state) in part.bodies.iter().zip(&group.particles.bodies) {
                if self.inlets.iter().any(|inlet| inlet.body == body.name) {
                    continue;
                }
                for (place, x) in places[state.ids.clone()].iter_mut().zip(&body.points) {
                    *place = Some(*x);
                }
            }
            places
        };
        self.parts.iter().zip(groups).map(of_group).collect()
    }

    /// The place \[m\] from which columns of particles count: the middle of the box around all particles of bodies and walls
    /// and the openings of inlets.
    pub(super) fn origin(&self) -> [f64; D] {
        let bodies = self.bodies().flat_map(|body| &body.points);
        let walls = self.walls.iter().flat_map(|wall| &wall.points);
        let openings = self.inlets.iter().flat_map(|inlet| &inlet.opening);
        middle(bodies.chain(walls).chain(openings))
    }

    /// The box around bodies and walls \[m\], where walls alone bound the scene.
    fn domain(&self) -> Option<[[f64; D]; 2]> {
        if self.walls.is_empty() || !self.inlets.is_empty() || !self.boundaries.is_empty() {
            return None;
        }
        let bodies = self.bodies().flat_map(|body| &body.points);
        let all = bodies.chain(self.walls.iter().flat_map(|wall| &wall.points));
        let start = [[f64::INFINITY; D], [f64::NEG_INFINITY; D]];
        Some(all.fold(start, |[low, high], x| {
            let corner =
                |of: fn(f64, f64) -> f64, far: [f64; D]| core::array::from_fn(|d| of(far[d], x[d]));
            [corner(f64::min, low), corner(f64::max, high)]
        }))
    }
}
