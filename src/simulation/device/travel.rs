//! How far particles have gone at most since lists were built, by speeds and accelerations that the last vote has found.
//! While that is within the skin, a device need not be asked how far they have.

use super::Offloaded;
use super::program::{Action, Made, Program};
use super::state::Moved;
use super::vote::Found;
use crate::particles::Field;
use crate::scalar::Real;
use crate::simulation::Group;

/// The names of the steps by which particles move.
pub(super) const KICK: &str = "kick";
pub(super) const DRIFT: &str = "drift";

/// A share that is added for rounding.
const ROUNDING: f64 = 1e-3;
/// Where lists are looked at in a drift.
const MIDDLE: f64 = 0.5;

/// Where particles of a group may be, and how they may move; infinite, or no numbers, where that is not known.
#[derive(Clone, Debug)]
pub(super) struct Travel {
    /// Since lists were built: at the beginning of the drift under way, or after a share of that.
    gone: Moved,
    share: f64,
    /// The drift \[s\].
    dt: f64,
    /// Speeds at most, the least and the largest component of velocities \[m/s\], and accelerations in the next kick \[m/s²\].
    speed: f64,
    range: [Vec<f64>; 2],
    acceleration: f64,
}

impl Travel {
    pub fn unknown(dimensions: usize) -> Self {
        let range = [f64::NEG_INFINITY, f64::INFINITY].map(|end| vec![end; dimensions]);
        Self {
            gone: Moved {
                farthest2: f64::INFINITY,
                range: range.clone(),
                grown: 0.0,
            },
            share: 0.0,
            dt: 0.0,
            speed: f64::INFINITY,
            range,
            acceleration: f64::INFINITY,
        }
    }

    /// What a vote has found, with walls that rest.
    pub fn vote(&mut self, found: &Found, are_there_walls: bool) {
        (self.speed, self.acceleration) = (found.speed2.sqrt(), found.acceleration);
        self.range.clone_from(&found.range);
        if are_there_walls {
            // What sticks to a wall has overwritten its velocity.
            let [low, high] = &mut self.range;
            for (low, high) in low.iter_mut().zip(high) {
                (*low, *high) = (low.min(0.0), high.max(0.0));
            }
        }
    }

    /// A drift has ended, and the next vote tells accelerations.
    pub fn evaluate(&mut self) {
        self.drift(0.0);
        self.acceleration = f64::INFINITY;
    }

    /// Velocities change over `dt` \[s\] by no more than the largest acceleration makes of it.
    pub fn kick(&mut self, dt: f64) {
        let more = self.acceleration * dt.abs();
        self.speed += more;
        let [low, high] = &mut self.range;
        for (low, high) in low.iter_mut().zip(high) {
            (*low, *high) = (*low - more, *high + more);
        }
    }

    /// A drift over `dt` \[s\] begins, where the last one ends.
    pub fn drift(&mut self, dt: f64) {
        self.gone = self.after(1.0);
        (self.share, self.dt) = (0.0, dt);
    }

    /// Where particles are in the middle of a drift, or after it.
    pub fn is_at(&mut self, found: Moved) {
        (self.gone, self.share) = (found, MIDDLE);
    }

    /// Where particles are after a share of the drift, which may go back in time.
    fn after(&self, share: f64) -> Moved {
        let dt = (share - self.share) * self.dt;
        if dt == 0.0 {
            return self.gone.clone();
        }
        let farthest = self.gone.farthest2.sqrt() + self.speed * dt.abs();
        let [mut low, mut high] = self.gone.range.clone();
        let [slowest, fastest] = &self.range;
        for (d, (a, b)) in slowest.iter().zip(fastest).enumerate() {
            low[d] += (a * dt).min(b * dt);
            high[d] += (a * dt).max(b * dt);
        }
        Moved {
            farthest2: farthest.powi(2),
            range: [low, high],
            grown: 0.0,
        }
    }
}

/// Whether speeds and accelerations say how far particles of a group go: between votes and looks at lists nothing but one kick and one
/// drift moves each body, no wall moves, and no smoothing length grows.
pub(super) fn is_bounded<T: Real, const D: usize>(group: &Group<T, D>, program: &Program) -> bool {
    let particles = &group.particles;
    let (mobile, bodies) = (particles.mobile, particles.bodies.len());
    let moved = [Field::POSITION, Field::POSITION_RESIDUAL, Field::VELOCITY];
    let is_moved = |made: &Made| matches!(made, Made::Field(field, _) if moved.contains(field));
    // How many steps of a list move bodies, but for those of others than the driver.
    let moves = |list: &[Action]| {
        let steps = list.iter().map(|action| match action {
            Action::Points(step) if step.slots.start >= mobile => Some(0),
            Action::Points(step) if !step.made.iter().any(is_moved) => Some(0),
            Action::Points(step) => [KICK, DRIFT].contains(&step.name.as_str()).then_some(1),
            Action::Repeat(_) => None,
            Action::Lists | Action::Sweep(_) | Action::Keep(_) => Some(0),
        });
        steps.sum::<Option<usize>>()
    };
    let often = |list, most| moves(list).is_some_and(|count| count <= most);
    let mut walls = group.walls.iter();
    walls.all(|own| own.motion.is_none() && own.structure.is_none())
        && !particles.columns.fields().contains(Field::SMOOTHING_LENGTH)
        && often(&program.kick, bodies)
        && often(&program.drift_begins, bodies)
        && often(&program.drift_middle, 0)
        && often(&program.drift_ends, bodies)
        && often(&program.evaluation, 0)
}

impl<T: Real, const D: usize> Offloaded<T, D> {
    /// Whether lists serve at a time \[s\] wherever particles have gone by what the last vote has found; then they serve once more.
    /// Else a device has to be asked ([`is_outdated`](Self::is_outdated)).
    pub fn surely_serve(&mut self, group: usize, time: f64) -> bool {
        let own = &self.recorded[group];
        let gone = own.travel.after(MIDDLE);
        let serve = own.is_bounded
            && gone.farthest2 < f64::INFINITY
            && !self.has_used_skin(group, &gone, ROUNDING, time);
        let near = &mut self.simulation.state.groups[group].neighborhood;
        near.served += u32::from(serve);
        serve
    }

    /// Nothing is known of where particles are and how they move.
    pub(super) fn forget_travel(&mut self) {
        for own in &mut self.recorded {
            own.travel = Travel::unknown(D);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Steps of a leapfrog, of which some go back in time.
    #[test]
    fn no_particle_goes_beyond() {
        let number = |k: usize| (12.9898 * k as f64).sin() * 3.0;
        let mut all: Vec<[f64; 2]> = (0..40).map(|k| [0.0, number(k)]).collect();
        let mut travel = Travel::unknown(1);
        travel.is_at(Moved::none(1));
        for step in 0..30 {
            let dt = [0.1, 0.07, -0.05][step % 3];
            let forces: Vec<f64> = (0..40).map(|k| number(k + 41 * step)).collect();
            let speeds = all.iter().map(|own| own[1]);
            let [low, high] = [f64::min, f64::max].map(|pick| speeds.clone().reduce(pick));
            let found = Found {
                step: 1.0,
                slot: 0,
                criterion: 0,
                speed2: speeds.map(f64::abs).fold(0.0, f64::max).powi(2),
                range: [low, high].map(|own| own.into_iter().collect()),
                length: 1.0,
                acceleration: forces.iter().copied().map(f64::abs).fold(0.0, f64::max),
            };
            travel.vote(&found, false);
            travel.kick(0.5 * dt);
            for (own, force) in all.iter_mut().zip(&forces) {
                own[1] += 0.5 * dt * force;
            }
            travel.drift(dt);
            for share in [MIDDLE, 1.0] {
                for own in &mut all {
                    own[0] += 0.5 * dt * own[1];
                }
                let Moved {
                    farthest2, range, ..
                } = travel.after(share);
                for [x, _] in &all {
                    assert!(x.powi(2) <= farthest2 * (1.0 + 1e-12));
                    assert!(range[0][0] <= x + 1e-12 && *x <= range[1][0] + 1e-12);
                }
                if share == MIDDLE && step == 20 {
                    let farthest = all.iter().map(|own| own[0].abs()).fold(0.0, f64::max);
                    assert!(farthest.powi(2) < farthest2);
                    let ends = [f64::min, f64::max];
                    let ends = ends.map(|pick| all.iter().map(|own| own[0]).reduce(pick));
                    travel.is_at(Moved {
                        farthest2: farthest.powi(2),
                        range: ends.map(|own| own.into_iter().collect()),
                        grown: 0.0,
                    });
                }
            }
            travel.evaluate();
        }
        travel.kick(0.1);
        travel.drift(0.1);
        assert!(travel.after(1.0).farthest2 == f64::INFINITY);
    }
}
