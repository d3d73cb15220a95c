//! The buffer of an inlet whose velocity changes with place and time: columns of wall particles, one behind each point of the opening.
//! A column goes with the inflow before it; by every spacing its first particle becomes liquid and the rest steps back.

use super::open::BEYOND;
use super::{Motion, OpenBoundary, OpenPlace, Pose, motion_from};
use crate::error::{Error, Result};
use crate::origin::local;
use crate::tensor::Vector;
use std::sync::Arc;

/// Places and weights of Gauss's rule of two points on the unit interval, exact for cubics.
const GAUSS: [(f64, f64); 2] = [
    (0.211_324_865_405_187_1, 0.5),
    (0.788_675_134_594_812_9, 0.5),
];

/// The part of a spacing over the sound speed in which accelerations are taken as differences.
const SHORT: f64 = 1e-3;

/// What moves a buffer.
#[derive(Clone, Debug)]
pub(crate) struct Inflow<const D: usize> {
    /// The body that it feeds, of a group.
    pub body: usize,
    /// How far each column has gone \[m\] since its last particle became liquid, at `time` \[s\].
    pub gone: Vec<f64>,
    pub time: f64,
    state: Arc<dyn OpenBoundary<D>>,
    inwards: [f64; D],
    spacing: f64,
    /// The time \[s\] in which accelerations are taken as differences.
    short: f64,
    /// The points of the opening in the scene, and where the first particle of a column is before it moves.
    opening: Vec<[f64; D]>,
    front: Vec<[f64; D]>,
    /// Displacement \[m\] and velocity \[m/s\] of the columns where they are now, and accelerations \[m/s²\] of all particles.
    shifts: Vec<f64>,
    velocities: Vec<[f64; D]>,
    accelerations: Vec<[f64; D]>,
    /// What carries the opening, in places that are counted from the origin, and where that is now.
    motion: Option<Arc<dyn Motion<D>>>,
    pose: Option<Pose<D>>,
}

/// A particle that becomes liquid.
pub(crate) struct Entering<const D: usize> {
    /// Where \[m\], with which velocity \[m/s\], and the number in the buffer of the particle that it was.
    pub x: [f64; D],
    pub velocity: [f64; D],
    pub number: usize,
}

impl<const D: usize> Inflow<D> {
    /// Of so many layers behind an opening, for a body in a liquid of that sound speed \[m/s\]; places are counted from an
    /// origin \[m\].
    pub fn new(
        (state, inwards): (Arc<dyn OpenBoundary<D>>, [f64; D]),
        opening: &[[f64; D]],
        (spacing, layers): (f64, usize),
        (body, sound_speed): (usize, f64),
        origin: &[f64; D],
    ) -> Self {
        let columns = opening.len();
        let front = |x: &[f64; D]| {
            let first = core::array::from_fn(|d| x[d] - 0.5 * spacing * inwards[d]);
            local(&first, origin)
        };
        Self {
            body,
            gone: vec![0.0; columns],
            time: 0.0,
            state,
            inwards,
            spacing,
            short: SHORT * spacing / sound_speed,
            front: opening.iter().map(front).collect(),
            opening: opening.to_vec(),
            shifts: vec![0.0; columns],
            velocities: vec![[0.0; D]; columns],
            accelerations: vec![[0.0; D]; columns * layers],
            motion: None,
            pose: None,
        }
    }

    /// The same behind an opening that moves.
    pub fn carried(self, motion: Option<&Arc<dyn Motion<D>>>, origin: &[f64; D]) -> Self {
        let motion = motion.map(|motion| motion_from(motion, origin));
        Self { motion, ..self }
    }

    /// Whether the opening moves.
    pub fn motion(&self) -> Option<&dyn Motion<D>> {
        self.motion.as_deref()
    }

    fn velocity(&self, column: usize, time: f64) -> [f64; D] {
        let at = OpenPlace {
            position: self.opening[column],
            time,
            inwards: self.inwards,
        };
        // What has none is refused before a step.
        self.state.velocity(&at).unwrap_or([f64::NAN; D])
    }

    fn inwards(&self, v: &[f64; D]) -> f64 {
        (0..D).map(|d| v[d] * self.inwards[d]).sum()
    }

    /// How far a column has gone by a time \[s\].
    fn gone_by(&self, column: usize, time: f64) -> f64 {
        let dt = time - self.time;
        if dt == 0.0 {
            return self.gone[column];
        }
        let of = |(at, weight): (f64, f64)| {
            weight * self.inwards(&self.velocity(column, self.time + at * dt))
        };
        self.gone[column] + dt * GAUSS.into_iter().map(of).sum::<f64>()
    }

    /// Moves the columns to where they are at `time` \[s\]; `chord` \[s\] are the ends of the drift under way, along which they
    /// go straight as particles do.
    pub fn move_to(&mut self, time: f64, chord: Option<[f64; 2]>) {
        let chord = chord.filter(|[begin, end]| begin != end);
        let before = (time - self.short).max(0.0);
        let columns = self.front.len();
        for k in 0..columns {
            let v = self.velocity(k, time);
            (self.shifts[k], self.velocities[k]) = match chord {
                Some(ends) => {
                    let [from, to] = ends.map(|end| self.gone_by(k, end));
                    let along = self.inwards(&v);
                    let mean = (to - from) / (ends[1] - ends[0]);
                    let on_chord = |d| v[d] + (mean - along) * self.inwards[d];
                    (0.5 * (from + to), core::array::from_fn(on_chord))
                }
                None => (self.gone_by(k, time), v),
            };
            let [early, late] = [before, before + self.short].map(|time| self.velocity(k, time));
            let a = core::array::from_fn(|d| (late[d] - early[d]) / self.short);
            for own in self.accelerations[k..].iter_mut().step_by(columns) {
                *own = a;
            }
        }
        let Some(motion) = &self.motion else {
            return;
        };
        let pose = motion.pose(time);
        // a = A a₀ + 2 A′ v₀ + A″ x₀ + b″ of a particle at x₀ in the frame of the opening.
        for (number, own) in self.accelerations.iter_mut().enumerate() {
            let (column, layer) = (number % columns, number / columns);
            let along = self.shifts[column] - layer as f64 * self.spacing;
            let x = core::array::from_fn(|d| self.front[column][d] + along * self.inwards[d]);
            let carried = Vector::from(pose.of(2, &x));
            let turned = pose.linear[1] * Vector::from(self.velocities[column]) * 2.0;
            *own = (pose.linear[0] * Vector::from(*own) + turned + carried).into();
        }
        self.pose = Some(match chord {
            Some(ends) => pose.on_chord(ends.map(|end| motion.pose(end)), ends),
            None => pose,
        });
    }

    /// Where the particle of the buffer is that was at `rest` \[m\] there, and its velocity \[m/s\].
    pub fn place(&self, number: usize, rest: &[f64; D]) -> [[f64; D]; 2] {
        let column = number % self.front.len();
        let x = core::array::from_fn(|d| rest[d] + self.shifts[column] * self.inwards[d]);
        let v = &self.velocities[column];
        self.pose
            .as_ref()
            .map_or([x, *v], |pose| pose.carries(&x, v))
    }

    /// Accelerations \[m/s²\] of its particles, by number.
    pub fn accelerations(&self) -> &[[f64; D]] {
        &self.accelerations
    }

    /// Refuses a time \[s\] at which the boundary has no velocity into the liquid, of the body of that name.
    pub fn check(&self, time: f64, body: &str) -> Result<()> {
        let refused = |value: f64, must_be| Error::Function {
            what: format!(
                "velocity of the inlet of body `{body}` ({})",
                self.state.name()
            ),
            value,
            time,
            must_be,
        };
        let [first, last] = self.state.span();
        if !(first..=last).contains(&time) {
            return Err(refused(f64::NAN, BEYOND));
        }
        for column in 0..self.front.len() {
            let v = self.velocity(column, time);
            let along = self.inwards(&v);
            if v.iter().any(|v| !v.is_finite()) {
                let must_be = "an inlet needs a velocity, of finite numbers in m/s: give it OpenBoundary::velocity";
                return Err(refused(along, must_be));
            }
            if along < 0.0 {
                let must_be = "its part into the liquid must not be negative: put an outlet where liquid flows out";
                return Err(refused(along, must_be));
            }
        }
        Ok(())
    }

    /// Brings it to `time` \[s\] and passes on what becomes liquid.
    ///
    /// # Errors
    /// Where the boundary has no velocity into the liquid, or what takes the particles does.
    pub fn advance(
        &mut self,
        (time, body): (f64, &str),
        mut enter: impl FnMut(Entering<D>) -> Result<()>,
    ) -> Result<()> {
        self.check(time, body)?;
        for column in 0..self.front.len() {
            self.shifts[column] = self.gone_by(column, time);
            self.velocities[column] = self.velocity(column, time);
        }
        self.gone.copy_from_slice(&self.shifts);
        self.time = time;
        let pose = self.motion.as_ref().map(|motion| motion.pose(time));
        for column in 0..self.front.len() {
            while self.gone[column] >= self.spacing {
                let (gone, front) = (self.gone[column], &self.front[column]);
                let x = core::array::from_fn(|d| front[d] + gone * self.inwards[d]);
                let v = &self.velocities[column];
                let [x, velocity] = pose.as_ref().map_or([x, *v], |pose| pose.carries(&x, v));
                enter(Entering {
                    x,
                    velocity,
                    number: column,
                })?;
                self.gone[column] -= self.spacing;
            }
        }
        Ok(())
    }
}
