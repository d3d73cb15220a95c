//! From a scene to a simulation: checked, laid out and evaluated once, or gone on with from a checkpoint.

use super::plan::Plan;
use super::{Body, Part, Scene};
use crate::boundary::Wall;
use crate::collective::over;
use crate::error::{BuildError, Error, Problem, Result};
use crate::once::once;
use crate::origin::middle;
#[cfg(feature = "checkpoint")]
use crate::output::checkpoint::Checkpoint;
use crate::ranks::{Stamp, Team};
use crate::scalar::Real;
#[cfg(feature = "checkpoint")]
use crate::simulation::{Change, Changes, Difference, RARE, differences};
use crate::simulation::{Group, Simulation};
#[cfg(feature = "checkpoint")]
use std::path::Path;
use std::sync::Arc;

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
            let mut scene = own.scene();
            let team = scene.team();
            let built = scene.built(team.clone());
            own.simulation = Some(agreed(team, built)?);
            Ok(())
        })
    }

    #[cfg(feature = "checkpoint")]
    fn resume(&mut self, path: &Path, changes: &[Change]) -> Result<()> {
        once!(self => &mut Building, |own, path: &Path, changes: &[Change]| -> Result<()> {
            let mut scene = own.scene();
            let team = scene.team();
            let resumed = scene.resumed(path, Changes::new(changes), team.clone());
            own.simulation = Some(agreed(team, resumed)?);
            Ok(())
        })
    }
}

/// What comes of a scene, if it does on all ranks.
fn agreed<V>(team: Option<Arc<Team>>, outcome: Result<V>) -> Result<V> {
    match team {
        None => outcome,
        Some(team) => team.agree(None, outcome),
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

    fn built(self, team: Option<Arc<Team>>) -> Result<Simulation<T, D>> {
        let fixed = self.control.fixed;
        let mut simulation = self.lay_out(None, team, true)?;
        simulation.hold_velocities();
        simulation.take_references();
        let problems = simulation.problems_of_all(Simulation::isolated);
        if !problems.is_empty() {
            return Err(Error::Build(BuildError { problems }));
        }
        let evaluated = simulation.evaluate_by_parts();
        let problems = simulation.surfaces_in_tension();
        if !problems.is_empty() {
            return Err(Error::Build(BuildError { problems }));
        }
        let vote = evaluated?;
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
        self.resume_with(path, &[])
    }

    /// Goes on from a checkpoint of a scene that differs from this one in parts that `changes` names: with another integrator,
    /// viscosity, load, motion or wall. What is not named must be the same.
    ///
    /// Rates are evaluated anew at the state of the file, so the run is the one in which the change happens at the end of
    /// its last step. Where steps, outlets and events alone are named, or motions while no clamp holds anything, the
    /// rates in the file are kept. Ledgers count on.
    ///
    /// ```
    /// use meshfree::integrator::DriftKickDrift;
    /// use meshfree::prelude::*;
    /// use meshfree::simulation::Change;
    /// # let file = std::env::temp_dir().join(format!("meshfree-changed-{}", std::process::id()));
    /// let rod = |velocity| Scene::<f64, 1>::new(schemes::impact())
    ///     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4).velocity([velocity]))
    ///     .boundary(MirrorPlane::wall([0.01], [1.0]));
    /// let mut simulation = rod(20.0).build()?;
    /// simulation.run_until(1e-6)?;
    /// simulation.save(&file)?;
    /// // The integrator may be another if it is named, and a body may not.
    /// let other = || rod(20.0).integrator(DriftKickDrift);
    /// assert_eq!(other().differences(&file)?[0].file.as_deref(), Some("KickDriftKick"));
    /// assert!(other().resume(&file).is_err());
    /// other().resume_with(&file, &[Change::Integrator])?.run_until(2e-6)?;
    /// let error = rod(10.0).resume_with(&file, &[Change::Integrator]).err();
    /// # let _ = std::fs::remove_file(file);
    /// assert!(error.is_some_and(|error| error.to_string().contains("is 20.0 in the file and 10.0 in the scene")));
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`resume`](Self::resume), with all differences that `changes` does not cover.
    #[cfg(feature = "checkpoint")]
    pub fn resume_with(
        self,
        path: impl AsRef<Path>,
        changes: &[Change],
    ) -> Result<Simulation<T, D>> {
        Building::of(self).simulation(|own| own.resume(path.as_ref(), changes))
    }

    #[cfg(feature = "checkpoint")]
    fn resumed(
        self,
        path: &Path,
        changes: Changes<'_>,
        team: Option<Arc<Team>>,
    ) -> Result<Simulation<T, D>> {
        let file = Checkpoint::read(path)?;
        // Walls that are elsewhere would move the place from which columns count.
        let origin = file.get_array("origin").ok();
        let origin = origin.filter(|_| changes.has(Change::Walls));
        let simulation = self.lay_out(origin, team, changes.is_empty())?;
        simulation.resumed(path, &file, changes)
    }

    /// All that is other in this scene than in the one that wrote a checkpoint, with both values.
    ///
    /// # Errors
    /// [`Error::File`] and [`Error::Checkpoint`] if the file cannot be read.
    #[cfg(feature = "checkpoint")]
    pub fn differences(&self, path: impl AsRef<Path>) -> Result<Vec<Difference>> {
        let file = Checkpoint::read_alone(path.as_ref())?;
        let described = (&self.hashes(), &self.values());
        Ok(differences(described, &RARE, &file))
    }

    /// The simulation before anything is summed, of which ranks lay their own particles out alone where they `part` and the scene may.
    fn lay_out(
        self,
        origin: Option<[f64; D]>,
        team: Option<Arc<Team>>,
        part: bool,
    ) -> Result<Simulation<T, D>> {
        let problems = self.problems();
        let mut sound = Ok(());
        if !problems.is_empty() {
            sound = Err(Error::Build(BuildError { problems }));
        }
        match &team {
            None => sound?,
            // Ranks that have parts of different scenes would not notice it later.
            Some(team) => team.agree(Some(self.stamp()), sound)?,
        }
        let domain = self.domain();
        let origin = origin.unwrap_or_else(|| self.origin());
        let part = part && self.is_of_neighbors_alone();
        let lay_out = |plan: Plan<'_, T, D>| plan.lay_out(origin, team.as_ref(), part);
        let groups: Vec<_> = self.plans().map(lay_out).collect();
        let built = self.places_as_built(&groups);
        let couples = self.couples(&origin);
        let joints = self.joints_of(&groups, &origin);
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
        .with_events(self.events)
        .with_joints(joints)?
        .on(team);
        simulation.built = built;
        #[cfg(feature = "checkpoint")]
        let simulation = simulation.of_scene(hashes, values);
        Ok(simulation)
    }

    /// Whether nothing in it looks at more than a particle and its neighbours, as far as the scene says and not its group.
    pub(super) fn is_of_neighbors_alone(&self) -> bool {
        self.parts.len() == 1
            && self.couplings.is_empty()
            && self.clamps.is_empty()
            && self.rigid.is_empty()
            && self.joints.is_empty()
            && self.loads.is_empty()
            && self.events.is_empty()
    }

    /// Whether each of so many ranks begins with its own particles.
    pub(super) fn begins_apart(&self, ranks: usize) -> bool {
        let begins = |mut plan: Plan<'_, T, D>| {
            let group = plan.without_numbers(self.origin());
            group.first_division(ranks).is_some()
        };
        self.is_of_neighbors_alone() && self.plans().all(begins)
    }

    /// By which ranks notice that they build different scenes: how many particles bodies have, how these start, and where walls are.
    fn stamp(&self) -> Stamp {
        let of_body = |body: &Body<T, D>| {
            over(0..body.points.len(), |k| {
                let start = body.start_of(k);
                let numbers = body.points[k].into_iter().chain(start.velocity);
                Stamp::digits(numbers.chain([start.density, start.energy]))
            })
        };
        let of_wall =
            |wall: &Wall<D>| over(0..wall.points.len(), |k| Stamp::digits(wall.points[k]));
        Stamp {
            steps: 0,
            time: 0.0,
            particles: self.bodies().map(|body| body.points.len()).sum(),
            motion: self.bodies().map(of_body).sum::<u64>()
                + self.walls.iter().map(of_wall).sum::<u64>(),
        }
    }

    /// Where particles of each group are as built \[m\], by identity, if loads may ask. What enters takes the identities of
    /// those that have left, so a body that is fed has none.
    fn places_as_built(&self, groups: &[Group<T, D>]) -> Vec<Vec<Option<[f64; D]>>> {
        if self.loads.is_empty() {
            return Vec::new();
        }
        let of_group = |(part, group): (&Part<T, D>, &Group<T, D>)| {
            let mut places = vec![None; group.particles.ids.len()];
            for (body, state) in part.bodies.iter().zip(&group.particles.bodies) {
                if self.is_fed(&body.name) {
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
    /// and the openings of inlets and points of sources.
    pub(super) fn origin(&self) -> [f64; D] {
        let bodies = self.bodies().flat_map(|body| &body.points);
        let walls = self.walls.iter().flat_map(|wall| &wall.points);
        let openings = self.inlets.iter().flat_map(|inlet| &inlet.opening);
        let points = self.sources.iter().flat_map(|source| &source.points);
        middle(bodies.chain(walls).chain(openings).chain(points))
    }

    /// The box around bodies and walls \[m\], where walls alone bound the scene.
    fn domain(&self) -> Option<[[f64; D]; 2]> {
        let fed = !self.inlets.is_empty() || !self.sources.is_empty();
        if self.walls.is_empty() || fed || !self.boundaries.is_empty() {
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
