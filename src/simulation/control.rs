//! The time step: every criterion votes, and the simulation remembers which one set the step.
//! Reductions have a fixed order, so the step is the same on any number of threads.

use super::Simulation;
use super::approach::{Near, approach};
use super::by_parts::told_by_all;
use super::group::Group;
use super::limits::{broken_effect, vote_of_effects};
use super::population::Particles;
use super::soundness::energy_of;
use super::stages::Moment;
use super::view::rounding;
use super::vote::{Criterion, NO_VOTE, ROUNDED, Vote};
use super::workspace::Workspace;
use crate::collective::{Join, Least, over_pieces};
use crate::error::{Error, LAW_PRESSURE, LAW_SOUND_SPEED, Result};
use crate::parallel::{GRAIN, runs};
use crate::particles::{Field, Output};
use crate::scalar::{Lane, Real};
use crate::tensor::{Vector, length};
use std::ops::Range;

/// How the time step is chosen.
///
#[doc = include_str!("../../docs/equations/time_step.html")]
///
/// and no pair may close by more than a share of its distance: with the closing speed u = −vᵢⱼ·rᵢⱼ/|rᵢⱼ|,
/// Δt ≤ C_r |rᵢⱼ|/u. Sound and viscosity say nothing of a cold gas, or of liquid that is faster than its sound, and a
/// step that moved particles through each other would be none. Distances below half a spacing count as that, and
/// what is not in reach yet as a support away.
///
/// A step may be longer than the one before by a factor [`growth`](Self::growth), and shorter by any.
///
/// κ is what the integrator allows relative to a leapfrog
/// ([`stability`](crate::integrator::Integrator::stability)), and sᵢⱼ the signal that the viscosity in
/// use adds to the sound speed of a pair.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct StepControl {
    /// Factor C on h/(c + signal), where the signal is what the artificial viscosity in use adds;
    /// taken from the scheme by default (0.55). It must be below one, and below what the
    /// [kernel](crate::kernel::Kernel::stable_step) allows.
    pub courant: f64,
    /// Factor C_a on √(h/|a|); 0.25 by default (Monaghan 1992), below one.
    pub force: f64,
    /// Factor C_v on h² ρ/μ where a physical viscosity acts; 0.125 by default (Morris, Fox & Zhu 1997),
    /// below 0.5.
    pub viscous: f64,
    /// Factor C_r: the share of its distance by which a pair may close in a step; 0.5 by default, less than one.
    /// Courant, Friedrichs & Lewy (1928) for particles: what is between two may not leave. Where viscosity acts, the
    /// signal of the first criterion asks for less already, so it limits cold gas and flow without viscosity alone.
    pub approach: f64,
    /// The factor by which a step may be longer than the one before; 1.2 by default, above one, and
    /// infinite for no limit. What a criterion asks for may jump up from one step to the next, and steps that jump
    /// periodically excite what is not damped. With 1.2, as in LULESH (Karlin et al. 2013), a step regains half of its length in
    /// four, and a start whose steps grow a hundredfold takes 25. Cuts by
    /// [`Simulation::step_at_most`] and [`Scene::step_ends_at`](crate::scene::Scene::step_ends_at) do not count.
    #[cfg_attr(feature = "serde", serde(with = "crate::serial::unbounded"))]
    pub growth: f64,
    /// A fixed step \[s\], held in every step against the limit by the factor of the scheme, or by
    /// [`courant`](Self::courant) if that is larger.
    pub fixed: Option<f64>,
    /// Smallest step \[s\] before the run stops with [`Error::StepCollapsed`]; by default 10⁻⁶ of the
    /// first.
    pub smallest: Option<f64>,
}

impl Default for StepControl {
    fn default() -> Self {
        Self {
            courant: crate::scheme::DEFAULT_STEP_FACTOR,
            force: 0.25,
            viscous: 0.125,
            approach: 0.5,
            growth: 1.2,
            fixed: None,
            smallest: None,
        }
    }
}

impl StepControl {
    /// The steps \[s\] by sound, forces and viscosity of a particle: of its smoothing length \[m\], sound speed with the signal of
    /// viscosity \[m/s\], acceleration \[m/s²\], density \[kg/m³\] and, where there is any, dynamic viscosity \[Pa s\].
    #[inline(always)]
    pub(super) fn limits<L: Lane>(
        &self,
        h: L,
        speed: L,
        acceleration: L,
        (density, viscosity): (L, Option<L>),
    ) -> [L; 3] {
        let by_viscosity = viscosity.map_or(L::of(f64::INFINITY), |mu| {
            L::of(self.viscous) * h * h * density / mu
        });
        let by_force = L::of(self.force) * (h / acceleration).sqrt();
        [L::of(self.courant) * h / speed, by_force, by_viscosity]
    }
}

impl<T: Real, const D: usize> Simulation<T, D> {
    /// The largest step that may be taken from the present state, and what sets it.
    ///
    /// # Errors
    /// [`Error::NotFinite`] if a particle's state is no longer finite, or its density not positive, and
    /// [`Error::SoundSpeedTooLow`] where a liquid meets faster than its sound.
    pub fn vote(&self) -> Result<Vote> {
        Ok(self.grown(self.vote_with(self.control.courant)?))
    }

    /// A vote, or the step before times the most by which it may grow.
    pub(super) fn grown(&self, vote: Vote) -> Vote {
        let most = self
            .state
            .step_before
            .map(|step| self.control.growth * step);
        match most.filter(|most| *most < vote.step) {
            Some(step) => Vote {
                step,
                criterion: Criterion::Growth,
                ..vote
            },
            None => vote,
        }
    }

    /// The step, or a shorter one that ends where the scene asks for an end: of two equal ones if that is farther than one.
    pub(super) fn ending_with_scene(&self, vote: Vote) -> Vote {
        let later = |end: &&f64| **end - self.state.time > rounding(**end);
        let Some(end) = self.step_ends.iter().find(later) else {
            return vote;
        };
        let left = end - self.state.time;
        // What is left after the first of two is one step to rounding, and is not halved again.
        let step = if left > vote.step * (1.0 + 1e-6) {
            0.5 * left
        } else {
            left
        };
        if step >= vote.step {
            return vote;
        }
        Vote {
            step,
            criterion: Criterion::SceneTime,
            ..vote
        }
    }

    /// What a fixed step is compared with: the factor of the scheme, or a larger requested one. A smaller
    /// one makes no step unstable.
    pub(crate) fn largest_fixed_step(&self) -> Result<Vote> {
        let own = self.state.groups[0].scheme.step_factor;
        self.vote_with(self.control.courant.max(own))
    }

    fn vote_with(&self, courant: f64) -> Result<Vote> {
        let mut all: Option<Vote> = None;
        for group in 0..self.state.groups.len() {
            let vote = self.vote_of(group, courant)?;
            let step = vote.step * self.state.groups[group].step_ratio();
            if all.is_none_or(|all| step < all.step) {
                all = Some(Vote { step, ..vote });
            }
        }
        let mut all = all.unwrap_or(NO_VOTE);
        for (k, group) in self.state.groups.iter().enumerate() {
            let count = group.step_ratio();
            let limit = Vote {
                step: all.step / count,
                ..all
            };
            let vote = self.approach_of(k, limit)?;
            if vote.step < limit.step {
                all = Vote {
                    step: vote.step * count,
                    ..vote
                };
            }
        }
        let mut all = self.of_couples(all);
        if let Some((step, [group, rigid])) =
            self.state.step_of_joints().filter(|own| own.0 < all.step)
        {
            let group = &self.state.groups[group];
            let body = &group.particles.bodies[group.held.rigid[rigid].body];
            all = Vote {
                step,
                criterion: Criterion::Effect(super::joint_forces::LIMIT),
                particle: group.particles.first_id + body.ids.start,
            };
        }
        Ok(all)
    }

    /// A vote, or a shorter step that couplings by forces ask for.
    pub(super) fn of_couples(&self, mut all: Vote) -> Vote {
        for couple in &self.state.couples {
            if couple.acting.step < all.step {
                let (group, body) = couple.sides[0].body().unwrap_or_default();
                let group = &self.state.groups[group];
                all = Vote {
                    step: couple.acting.step,
                    criterion: Criterion::Effect(couple.coupling.name()),
                    particle: group.particles.first_id + group.particles.bodies[body].ids.start,
                };
            }
        }
        all
    }

    /// The vote of a group, but for pairs that approach each other.
    pub(super) fn vote_of(&self, group: usize, courant: f64) -> Result<Vote> {
        // What a user asks of the first scheme may be more than another allows.
        let own = if group == 0 && self.state.groups[0].exchanges.is_empty() {
            f64::INFINITY
        } else {
            self.state.groups[group].scheme.step_factor
        };
        let group = &self.state.groups[group];
        let control = StepControl {
            courant: courant.min(own) * self.integrator.stability(),
            ..self.control
        };
        let h = group.neighborhood.smoothing_length;
        let vote = vote(&group.particles, &group.work, h, &control);
        let now = Moment {
            time: self.state.time,
            ..group.of_rates(0.0)
        };
        let views = group.views(now);
        let vote = vote_of_effects(&group.scheme.program, views, vote);
        if group.all.is_some() {
            let vote = group.shortest(vote);
            return if vote.step < 0.0 {
                Err(told_by_all())
            } else {
                Ok(vote)
            };
        }
        if vote.step < 0.0 {
            return Err(self.broken(group, vote.particle));
        }
        let id = group.particles.ids.get(vote.particle);
        let particle = id.map_or(usize::MAX, |&id| group.particles.first_id + id as usize);
        Ok(Vote { particle, ..vote })
    }

    /// `limit`, or a shorter step that pairs of a group ask for which approach each other.
    pub(super) fn approach_of(&self, group: usize, limit: Vote) -> Result<Vote> {
        let group = &self.state.groups[group];
        let approach = approach(
            &group.particles,
            &group.neighborhood,
            &group.scheme,
            group.instructions,
            (self.control.approach, limit.step),
            group.apart().map(|(team, part)| Near {
                team,
                ghosts: &*part.halo,
                images: &part.of_own,
            }),
        );
        if let (Some((team, _)), Some(own)) = (group.apart(), approach) {
            if team.any(own.meeting.is_some()) {
                return Err(told_by_all());
            }
            let vote = group.shortest(own.vote);
            return Ok(if vote.step >= limit.step { limit } else { vote });
        }
        let Some(mut approach) = approach else {
            return Ok(limit);
        };
        if let Some(share) = &group.share {
            approach = approach.of_all(&share.team);
        }
        if let Some(meeting) = approach.meeting {
            let body = &group.particles.bodies[group.particles.body_of(meeting.slot)];
            return Err(Error::SoundSpeedTooLow {
                body: body.name.clone(),
                particle: group.particles.ids[meeting.slot] as usize - body.ids.start,
                speed: meeting.speed,
                sound_speed: meeting.speed / meeting.mach,
                position: group.particles.position(meeting.slot).to_vec(),
                time: self.state.time,
            });
        }
        if approach.vote.step >= limit.step {
            return Ok(limit);
        }
        let id = group.particles.ids[approach.vote.particle] as usize;
        Ok(Vote {
            particle: group.particles.first_id + id,
            ..approach.vote
        })
    }

    /// The error that describes a particle whose state is no longer finite.
    pub(super) fn broken(&self, group: &Group<T, D>, slot: usize) -> Error {
        let columns = &group.particles.columns;
        let worst = |values: &[T]| {
            let first = values.first().map_or(0.0, |value| value.to_f64());
            let bad = values.iter().map(|value| value.to_f64());
            bad.filter(|value| !value.is_finite())
                .fold(first, |_, bad| bad)
        };
        let number = |field: Field| {
            let width = field.components(D);
            let own = slot * width..(slot + 1) * width;
            worst(columns.raw(field).get(own).unwrap_or_default())
        };
        let (v, internal) = (
            &columns.vectors(Field::VELOCITY)[slot],
            columns.raw(Field::ENERGY).get(slot),
        );
        let energy = energy_of(columns.raw(Field::MASS)[slot], v, internal);
        let signal = group.work.rates.get(Output::SIGNAL, 0, slot).to_f64();
        // What a law makes of numbers is its own; what it makes of none is not. A kick may have spoilt the energy since.
        let given = [Field::DENSITY, Field::ENERGY].map(number);
        let energy_then = if given[1].is_finite() { given[1] } else { 0.0 };
        let material = &group.particles.bodies[group.particles.body_of(slot)].material;
        let (pressure, sound_speed) = material.state(given[0], energy_then);
        let is_law = !(pressure.is_finite() && sound_speed.is_finite());
        let by_law = if is_law && given[0].is_finite() && given[0] > 0.0 {
            [LAW_PRESSURE, LAW_SOUND_SPEED]
        } else {
            ["pressure", "sound speed"]
        };
        let candidates = [
            ("density", number(Field::DENSITY)),
            (by_law[0], number(Field::PRESSURE)),
            (by_law[1], number(Field::SOUND_SPEED)),
            ("position", number(Field::POSITION)),
            ("velocity", number(Field::VELOCITY)),
            ("internal energy", number(Field::ENERGY)),
            ("dynamic viscosity", number(Field::DYNAMIC_VISCOSITY)),
            (
                "force",
                worst(&group.work.rates.vector(Output::FORCE, slot)),
            ),
            ("signal of the artificial viscosity", signal),
            ("energy", energy),
        ];
        let wrong = |&(name, value): &(&str, f64)| {
            !value.is_finite() || (name == "density" && value <= 0.0)
        };
        let (quantity, value) = candidates
            .into_iter()
            .find(wrong)
            .or_else(|| {
                let mut views = group.views(group.of_rates(0.0));
                let (_, view) = views.nth(group.particles.body_of(slot))?;
                broken_effect(&group.scheme.program, &view, slot)
            })
            .unwrap_or(candidates[0]);
        let body = &group.particles.bodies[group.particles.body_of(slot)];
        Error::NotFinite {
            quantity,
            value,
            body: body.name.clone(),
            particle: (group.particles.ids[slot] as usize).saturating_sub(body.ids.start),
            position: group.particles.position(slot).to_vec(),
            time: self.state.time,
            step: self.state.steps,
        }
    }
}

/// The largest stable step, and the slot that sets it; negative where a state is not finite. `uniform` \[m\] is the
/// smoothing length of all where particles have none of their own.
fn vote<T: Real, const D: usize>(
    particles: &Particles<T, D>,
    work: &Workspace<T, D>,
    uniform: f64,
    control: &StepControl,
) -> Vote {
    let columns = &particles.columns;
    let (c, rho) = (columns.raw(Field::SOUND_SPEED), columns.raw(Field::DENSITY));
    let viscosity = columns.raw(Field::DYNAMIC_VISCOSITY);
    let (mass, h) = (
        columns.raw(Field::MASS),
        columns.raw(Field::SMOOTHING_LENGTH),
    );
    let velocity = columns.vectors(Field::VELOCITY);
    let gravity = Vector::<T, D>::from(work.evaluated_gravity);
    // Of each criterion, in the order in which one wins a tie; negative where the state is not sound.
    let limits = |slot: usize| {
        let h = h.get(slot).map_or(uniform, |h| h.to_f64());
        let signal = work.rates.get(Output::SIGNAL, 0, slot).to_f64();
        let force: Vector<T, D> = work.rates.vector(Output::FORCE, slot).into();
        let a = length(&(force / mass[slot] + gravity)).to_f64();
        let speed = velocity[slot].iter().fold(0.0, |s, v| s + v.to_f64().abs());
        let density = rho[slot].to_f64();
        // Without sound, as in dust, other criteria limit the step.
        let speeds = c[slot].to_f64() + signal + a + speed;
        let mu = viscosity.get(slot).map(|mu| mu.to_f64());
        let limits = control.limits(
            h,
            c[slot].to_f64() + signal,
            a.max(f64::MIN_POSITIVE),
            (density, mu),
        );
        if !(speeds.is_finite() && !limits[0].is_nan() && density > 0.0) {
            return [-1.0; 3];
        }
        limits
    };
    let shortest =
        |slot: usize| Least(limits(slot).into_iter().fold(f64::INFINITY, f64::min), slot);
    // Whether all criteria of a sound state are above a step, by products: roots and quotients are most of the work, and few
    // slots need them. Room is left for what the scalar rounds.
    let is_above = |slot: usize, step: f64| {
        let step = (1.0 + ROUNDED) * step;
        let h = h.get(slot).map_or(uniform, |h| h.to_f64());
        let m = mass[slot].to_f64();
        let (mut force2, mut speed) = (0.0, 0.0);
        for d in 0..D {
            let force = work.rates.get(Output::FORCE, d, slot).to_f64();
            let weight = m * gravity[d].to_f64();
            let most = (force + weight).abs() + ROUNDED * (force.abs() + weight.abs());
            force2 += most * most;
            speed += velocity[slot][d].to_f64().abs();
        }
        let signal = c[slot].to_f64() + work.rates.get(Output::SIGNAL, 0, slot).to_f64();
        let (density, step2) = (rho[slot].to_f64(), step * step);
        let by_force = (control.force * control.force * h * m).powi(2);
        let by_viscosity = control.viscous * h * h * density;
        density > 0.0
            && speed.is_finite()
            && signal >= 0.0
            && control.courant * h > step * signal
            && by_force > (step2 * step2 * force2).max(f64::MIN_POSITIVE)
            && viscosity
                .get(slot)
                .is_none_or(|mu| by_viscosity > step * mu.to_f64())
    };
    let in_run = |_, run: Range<usize>| {
        let mut shortest_yet = Least::NONE;
        for slot in run {
            if !is_above(slot, shortest_yet.0) {
                shortest_yet = shortest_yet.and(shortest(slot));
            }
        }
        shortest_yet
    };
    let Least(step, particle) = over_pieces(runs(0..particles.mobile, GRAIN), in_run);
    if particle == NO_VOTE.particle {
        return NO_VOTE;
    }
    let own = limits(particle);
    let kinds = [Criterion::Acoustic, Criterion::Force, Criterion::Viscous];
    let set = kinds.into_iter().zip(own).find(|(_, limit)| *limit == step);
    Vote {
        step,
        criterion: set.map_or(Criterion::Fixed, |(criterion, _)| criterion),
        particle,
    }
}
