//! Liquids and the bodies of other groups that they meet: walls that follow these, and the forces on them.
//! The text is that of the host's walls, for one particle.

use super::Offloaded;
use super::program::{Action, FollowStep, Given, Made};
use super::record::{Recorder, evaluated};
use crate::particles::{Field, Output};
use crate::scalar::{Real, Record};
use crate::simulation::Group;
use crate::simulation::walls::{Structure, WallState};
use crate::sweep::Pass;
use crate::term::Stage;

/// Walls that are bodies of other groups, with their numbers.
fn structures<T: Real, const D: usize>(
    group: &Group<T, D>,
) -> impl Iterator<Item = (usize, &WallState<T, D>, &Structure<T, D>)> {
    let walls = group.walls.iter().enumerate();
    walls.filter_map(|(number, wall)| Some((number, wall, wall.structure.as_ref()?)))
}

/// What of such walls does not run on a device.
pub(super) fn refused<T: Real, const D: usize>(group: &Group<T, D>) -> Vec<String> {
    let mut all = Vec::new();
    for (_, wall, structure) in structures(group) {
        let what = format!("a liquid that meets `{}`", wall.name);
        if !group.boundaries.is_empty() {
            all.push(format!("{what} among images of boundaries"));
        }
        if wall.is_mirrored() {
            all.push(format!("{what} and sticks to it"));
        }
        if structure.coupling.wall_mass_record().is_none() {
            let name = structure.coupling.name();
            all.push(format!(
                "{what} by the coupling `{name}`, which has no record of its wall_mass,"
            ));
        }
    }
    all
}

impl<T: Real, const D: usize> Recorder<'_, T, D> {
    /// Blocks whose forces are booked, and walls that are bodies of other groups.
    pub(super) fn structures(&mut self, groups: &[Group<T, D>]) {
        let bodies = self.group.particles.bodies.iter();
        let mut feels: Vec<_> = bodies.map(|body| body.slots.clone()).enumerate().collect();
        let count = feels.len();
        let mut runs = Vec::new();
        for (number, wall, structure) in structures(self.group) {
            let (other, run) = (&groups[structure.group], wall.slots.start..wall.end);
            let rates = other.scheme.sums(Stage::Rates);
            let places = [Field::POSITION, Field::POSITION_RESIDUAL, Field::VELOCITY];
            let places = places.into_iter().filter(|field| self.has(*field));
            let places = places.flat_map(|field| (0..D).map(move |d| (field, d)));
            let places: Vec<_> = places.collect();
            let mut from = vec![
                Given::Field(Field::MASS, 0),
                Given::Field(Field::DENSITY, 0),
            ];
            let summed = rates.contains(Output::FORCE);
            from.extend((0..D).map(|d| {
                if summed {
                    Given::Rate(Output::FORCE, d)
                } else {
                    Given::Constant(0.0)
                }
            }));
            from.extend((0..D).map(evaluated::<D>));
            from.extend(places.iter().map(|&(field, d)| Given::Field(field, d)));
            let mut made = vec![Made::Field(Field::MASS, 0)];
            made.extend((0..D).map(Made::Wall));
            made.extend(places.iter().map(|&(field, d)| Made::Field(field, d)));
            // Refused by name before, if there is none.
            let Some(mass) = structure.coupling.wall_mass_record() else {
                continue;
            };
            let record = Record::of(1 + from.len(), |x| {
                let mut results = mass.follow(&x[..3]);
                let acceleration = |d: usize| x[3 + d] / x[1] + x[3 + D + d];
                results.extend((0..D).map(acceleration));
                results.extend_from_slice(&x[3 + 2 * D..]);
                results
            });
            feels.push((count + number, wall.slots.clone()));
            runs.push(run.clone());
            self.program.follows.extend(record.map(|record| FollowStep {
                slots: run,
                group: structure.group,
                body: other.particles.bodies[structure.body].run(),
                record,
                own: vec![Given::Field(Field::DENSITY, 0)],
                from,
                made,
            }));
        }
        self.program.feels = feels;
        if let Some(Action::Sweep(mut sweep)) = self.pass(Stage::Rates, Pass::Rates, &runs) {
            (sweep.of_rates, sweep.of_walls) = (false, true);
            self.program.reacts.push(Action::Sweep(sweep));
        }
    }
}

impl<T: Real, const D: usize> Offloaded<T, D> {
    /// Of a wall of a group that [follows](FollowStep) a body, by its number among those: the slot of the body for each of its slots, and
    /// its own slot for each of the body.
    #[must_use]
    pub fn followed(&self, group: usize, number: usize) -> [Vec<u32>; 2] {
        let groups = &self.simulation.state.groups;
        let Some((_, wall, structure)) = structures(&groups[group]).nth(number) else {
            return [Vec::new(), Vec::new()];
        };
        let (own, others) = (&groups[group].particles, &groups[structure.group].particles);
        let body = &others.bodies[structure.body];
        let run = body.run();
        let (mut from, mut back) = (Vec::new(), vec![0; run.len()]);
        for slot in wall.slots.start..wall.end {
            // No particle leaves where there are neither outlets nor drains.
            let at = wall.rest_of(&own.ids, slot);
            let other = wall.slot_in(others, at).unwrap_or(run.start);
            from.push(other as u32);
            if wall.slots.contains(&slot) {
                for repeat in body.with_repeats(other) {
                    back[repeat - run.start] = slot as u32;
                }
            }
        }
        [from, back]
    }

    /// Takes back what has accelerated walls that follow bodies \[m/s²\], as [`walls`](Self::walls) has it.
    pub(super) fn take_walls(&mut self, group: usize, numbers: &[f64]) {
        let group = &mut self.simulation.state.groups[group];
        let mobile = group.particles.mobile;
        let count = group.particles.columns.slots() - mobile;
        for wall in &mut group.walls {
            for slot in wall.slots.clone() {
                let at = wall.rest_of(&group.particles.ids, slot);
                if let Some(structure) = &mut wall.structure {
                    structure.accelerations[at] =
                        core::array::from_fn(|d| numbers[d * count + slot - mobile]);
                }
            }
        }
    }
}
