//! Whether a step has left a state that can be stepped on: finite numbers, and walls that did not jump.
//! Looked at after every step, the last of a run included.

use super::Simulation;
use super::group::Group;
use super::limits::are_finite;
use super::population::Particles;
use crate::boundary::{Motion, Pose};
use crate::collective::{over, over_pieces};
use crate::effect::StepProgram;
use crate::error::{Error, Problem, Result};
use crate::parallel::{GRAIN, runs};
use crate::particles::{Columns, Field};
use crate::scalar::Real;
use crate::scheme::Smoothing;
use std::ops::Range;

/// Share of a full neighbourhood below which a particle has no neighbours to be measured by.
const ALONE: f64 = 1e-6;

/// Share of the density of the start below which a sum lacks neighbours, and share of the bulk modulus above which a material is in
/// tension.
const LACKING: f64 = 0.9;
const TENSION: f64 = 1e-3;

/// The name under which gas of negative energy is counted.
pub(super) const NEGATIVE_ENERGY: &str = "negative internal energy";

/// Share of the spacing by which a wall may move beside what its velocity gives.
const JUMP: f64 = 0.5;

impl<T: Real, const D: usize> Simulation<T, D> {
    /// Refuses a state in which a number is not finite.
    pub(super) fn check_state(&mut self) -> Result<()> {
        for group in &mut self.state.groups {
            group.count(NEGATIVE_ENERGY, negative_energies(&group.particles));
        }
        if self.is_parted() {
            let mut groups = self.state.groups.iter();
            let is_unsound =
                groups.any(|group| unsound(&group.particles, &group.scheme.program).is_some());
            if self.team.as_ref().is_some_and(|team| team.any(is_unsound)) {
                self.bring_together();
            }
        }
        for group in self.state.groups.iter().filter(|group| group.all.is_none()) {
            if let Some(slot) = unsound(&group.particles, &group.scheme.program) {
                // A particle whose law gives no pressure spoils its neighbours as well, and is the one to name.
                let density = group.particles.columns.raw(Field::DENSITY);
                let source = group.particles.bodies.iter().find_map(|body| {
                    body.slots.clone().find(|&slot| {
                        let density = density[slot].to_f64();
                        let lawful = || body.material.state(density, 0.0).0.is_finite();
                        density.is_finite() && density > 0.0 && !lawful()
                    })
                });
                return Err(self.broken(group, source.unwrap_or(slot)));
            }
        }
        let impulse = self
            .state
            .impulses
            .values()
            .find(|impulse| !impulse.is_finite());
        let work = self
            .state
            .work
            .iter()
            .flat_map(|work| [work.load, work.wall]);
        let mut sums = impulse.into_iter().chain(work);
        if let Some(value) = sums.find(|value| !value.is_finite()) {
            return Err(Error::NotFinite {
                quantity: "impulse or work",
                value,
                body: "all".into(),
                particle: 0,
                position: Vec::new(),
                time: self.state.time,
                step: self.state.steps,
            });
        }
        Ok(())
    }

    /// Particles without neighbours, where density is measured from the reference configuration: one for each body.
    pub(crate) fn isolated(&self) -> Vec<Problem> {
        let measured = self.state.groups.iter().filter(|group| {
            group.scheme.density.has_reference() && group.scheme.consistent_at_rest
        });
        measured
            .flat_map(|group| {
                let reach = group.scheme.kernel.support * group.neighborhood.smoothing_length;
                isolated(&group.particles, reach)
            })
            .collect()
    }

    /// Surfaces at which a summed density puts a solid or liquid under tension: one for each body.
    pub(crate) fn surfaces_in_tension(&self) -> Vec<Problem> {
        let is_summed =
            |group: &Group<T, D>| matches!(group.scheme.smoothing, Smoothing::Consistent(_));
        // Other ranks need not be asked where no scheme sums its density.
        if !self.state.own().groups.iter().any(is_summed) {
            return Vec::new();
        }
        let summed = self.state.groups.iter().filter(|group| is_summed(group));
        summed
            .flat_map(|group| surfaces_in_tension(&group.particles))
            .collect()
    }

    /// Refuses a step of `dt` \[s\] at whose end a boundary, a wall, an inlet or a clamp is nowhere, or in which a wall moves differently from its
    /// own velocity, as one that jumps does.
    pub(super) fn check_motions(&self, dt: f64) -> Result<()> {
        let (time, end) = (self.state.time, self.state.time + dt);
        self.check_boundaries(end)?;
        self.check_clamps(end)?;
        for group in &self.state.groups {
            for inflow in group.walls.iter().filter_map(|wall| wall.inflow.as_ref()) {
                let body = &group.particles.bodies[inflow.body].name;
                inflow.check(end, body)?;
                if let Some(motion) = inflow.motion() {
                    check_span(motion, end, || format!("inlet of body `{body}`"))?;
                }
            }
        }
        let outlets = self.state.groups.iter().flat_map(|group| &group.outlets);
        for motion in outlets.filter_map(|outlet| outlet.carried()) {
            check_span(motion, end, || "an outlet".into())?;
        }
        let spacing = self.spacing();
        for wall in self.state.groups.iter().flat_map(|group| &group.walls) {
            let Some(motion) = &wall.motion else {
                continue;
            };
            check_span(&**motion, end, || format!("wall `{}`", wall.name))?;
            let (before, after) = (motion.pose(time), motion.pose(end));
            let beside = |x: &[f64; D]| {
                let [from, to] = [&before, &after].map(|pose| (pose.of(0, x), pose.of(1, x)));
                let off = (0..D).map(|d| to.0[d] - from.0[d] - 0.5 * dt * (from.1[d] + to.1[d]));
                off.map(|off| off * off).sum::<f64>().sqrt()
            };
            // What is not a number is the farthest of all.
            let farther = |most: f64, x: &[f64; D]| {
                let off = beside(x);
                if off <= most { most } else { off }
            };
            let off = wall.rest.iter().fold(0.0, farther);
            if off.is_nan() || off > JUMP * spacing {
                return Err(Error::WallJump {
                    wall: wall.name.clone(),
                    distance: off,
                    time,
                    end,
                });
            }
            if let Some(value) = not_finite(&after) {
                return Err(no_motion(format!("wall `{}`", wall.name), value, end));
            }
        }
        Ok(())
    }

    /// Refuses boundaries that move to where no place is.
    fn check_boundaries(&self, time: f64) -> Result<()> {
        let Some(group) = self.state.groups.first() else {
            return Ok(());
        };
        for boundary in group.boundaries.iter().filter(|own| own.moves()) {
            for image in 0..boundary.images() {
                if let Some(value) = boundary.transform(image, time).not_finite() {
                    return Err(Error::Function {
                        what: format!("transform of image {image} of the {}", boundary.name()),
                        value,
                        time,
                        must_be: "rotation, shift and velocity must be finite numbers",
                    });
                }
            }
        }
        Ok(())
    }

    /// Refuses clamps that move to where no place is.
    fn check_clamps(&self, time: f64) -> Result<()> {
        for group in &self.state.groups {
            for clamp in group.held.clamps.iter().filter(|own| !own.is_free) {
                let body = &group.particles.bodies[clamp.body].name;
                let whose = || format!("a clamp of body `{body}`");
                if let Some(motion) = &clamp.motion {
                    check_span(&**motion, time, whose)?;
                }
                let pose = clamp.motion.as_ref().map(|motion| motion.pose(time));
                if let Some(value) = pose.as_ref().and_then(not_finite) {
                    return Err(no_motion(whose(), value, time));
                }
            }
        }
        Ok(())
    }
}

/// A number of a pose that is not finite.
pub(crate) fn not_finite<const D: usize>(pose: &Pose<D>) -> Option<f64> {
    let linear = pose.linear.iter().flat_map(|a| a.iter());
    let shift = pose.shift.iter().flat_map(|b| b.iter());
    linear.chain(shift).copied().find(|x| !x.is_finite())
}

/// Refuses a time \[s\] at which a motion is no more, or not yet.
fn check_span<const D: usize>(
    motion: &dyn Motion<D>,
    time: f64,
    whose: impl Fn() -> String,
) -> Result<()> {
    let [first, last] = motion.span();
    if (first..=last).contains(&time) {
        return Ok(());
    }
    Err(Error::Function {
        what: format!("motion of {} ({})", whose(), motion.name()),
        value: f64::NAN,
        time,
        must_be: "the run goes beyond its rows: record it for longer, end the run before, or let it rest there by \
                  Recorded::at_rest_beyond",
    })
}

fn no_motion(of: String, value: f64, time: f64) -> Error {
    Error::Function {
        what: format!("motion of {of}"),
        value,
        time,
        must_be: "place, velocity and acceleration must be finite: check its table for gaps",
    }
}

/// Kinetic and internal energy \[J\], by mass \[kg\], velocity \[m/s\] and specific internal energy \[J/kg\].
pub(super) fn energy_of<T: Real, const D: usize>(mass: T, v: &[T; D], internal: Option<&T>) -> f64 {
    let internal = internal.map_or(0.0, |energy| energy.to_f64());
    mass.to_f64() * (0.5 * v.iter().map(|v| v.to_f64().powi(2)).sum::<f64>() + internal)
}

/// The first particle of each body that has no neighbours, by its moment at rest; `reach` \[m\] is how far it looks.
fn isolated<T: Real, const D: usize>(
    particles: &Particles<T, D>,
    reach: f64,
) -> impl Iterator<Item = Problem> {
    let moments = particles.columns.raw(Field::CONSISTENCY_FACTOR);
    let alone = |slot: &usize| {
        let moment = moments.get(*slot).map_or(1.0, |moment| moment.to_f64());
        moment <= ALONE
    };
    particles.bodies.iter().filter_map(move |body| {
        let slot = body.slots.clone().find(alone)?;
        Some(Problem::Isolated {
            body: body.name.clone(),
            particle: particles.ids[slot] as usize - body.ids.start,
            position: particles.position(slot).to_vec(),
            reach,
        })
    })
}

/// The first particle of each body whose summed density is far below that which it starts with, and whose law answers with
/// tension.
fn surfaces_in_tension<T: Real, const D: usize>(
    particles: &Particles<T, D>,
) -> impl Iterator<Item = Problem> {
    let [density, mass, energy] =
        [Field::DENSITY, Field::MASS, Field::ENERGY].map(|field| particles.columns.raw(field));
    let solids = particles
        .bodies
        .iter()
        .filter(|body| !body.material.is_gas());
    solids.filter_map(move |body| {
        let stiffness = body.material.bulk_modulus();
        let in_tension = |slot: usize| {
            let start = mass[slot].to_f64() / body.spacing.powi(D as i32);
            let summed = density[slot].to_f64();
            let energy = energy.get(slot).map_or(0.0, |energy| energy.to_f64());
            let (pressure, _) = body.material.state(summed, energy);
            (summed < LACKING * start && pressure < -TENSION * stiffness)
                .then_some((slot, [start, summed, pressure]))
        };
        let (slot, [start, summed, pressure]) = body.slots.clone().find_map(in_tension)?;
        Some(Problem::Incompatible {
            what: format!(
                "body `{}` has a free surface and a material that supports tension: the summed density of particle {} at {:?} m is {summed} \
                 kg/m³ where it starts with {start}, and the pressure there {pressure} Pa",
                body.name,
                particles.ids[slot] as usize - body.ids.start,
                particles.position(slot),
            ),
            remedy: "at a surface the sum lacks half of its neighbours, which puts a solid or liquid in tension: \
            take a scheme whose density is relative to rest (schemes::impact) or by continuity \
            (schemes::weakly_compressible), or close the surface by a period or a plane of symmetry",
        })
    })
}

/// How many particles of gas have a negative internal energy: its law takes it as none
/// ([`IdealGas::minimum_energy`](crate::material::eos::IdealGas::minimum_energy)), and the ledger as it is.
fn negative_energies<T: Real, const D: usize>(particles: &Particles<T, D>) -> u64 {
    let energy = particles.columns.raw(Field::ENERGY);
    let mut negative = 0;
    for body in &particles.bodies {
        if !energy.is_empty() && body.material.is_gas() {
            negative += over(body.slots.clone(), |slot| {
                u64::from(energy[slot] < T::zero())
            });
        }
    }
    negative
}

/// The first slot whose state is not finite, or whose density is not positive.
fn unsound<T: Real, const D: usize>(
    particles: &Particles<T, D>,
    program: &StepProgram<T, D>,
) -> Option<usize> {
    let sound = |run: Range<usize>| {
        is_sound(&particles.columns, run.clone()) && are_finite(program, &particles.columns, run)
    };
    particles.bodies.iter().find_map(|body| {
        let unsound = |_, run: Range<usize>| {
            // Nearly always all are sound, and nobody asks which is not.
            if sound(run.clone()) {
                return None;
            }
            let mut slots = run.into_iter();
            let first = slots.find(|&slot| !sound(slot..slot + 1));
            first.map(|slot| (slot, ()))
        };
        let chunks = runs(body.slots.clone(), GRAIN);
        over_pieces(chunks, unsound).map(|(slot, ())| slot)
    })
}

/// Whether place, density and energy are finite in all of a run, and densities positive.
fn is_sound<T: Real, const D: usize>(columns: &Columns<T, D>, run: Range<usize>) -> bool {
    let [x, v] =
        [Field::POSITION, Field::VELOCITY].map(|field| &columns.vectors(field)[run.clone()]);
    let [density, mass] =
        [Field::DENSITY, Field::MASS].map(|field| &columns.raw(field)[run.clone()]);
    let internal = columns.raw(Field::ENERGY).get(run).unwrap_or_default();
    let mut sound = true;
    for (n, density) in density.iter().enumerate() {
        let energy = energy_of(mass[n], &v[n], internal.get(n));
        let place: f64 = x[n].iter().map(|x| x.to_f64()).sum();
        let density = density.to_f64();
        sound &= (place + density + energy).is_finite() && density > 0.0;
    }
    sound
}
