//! The columns from which a group starts: what bodies say of their particles, and what walls of theirs.
//! All of them, or those of some runs of slots, as of one rank.

use super::plan::Plan;
use crate::boundary::Wall;
use crate::origin::local;
use crate::particles::{Columns, Field};
use crate::scalar::Real;
use crate::simulation::Group;
use std::ops::Range;

/// The slots of some runs that are among others, each behind its place in these runs.
fn among(runs: &[Range<usize>], others: Range<usize>) -> impl Iterator<Item = (usize, usize)> {
    let mut before = 0;
    runs.iter().flat_map(move |run| {
        let first = before;
        before += run.len();
        let both = run.start.max(others.start)..run.end.min(others.end);
        both.map({
            let run = run.clone();
            move |slot| (first + slot - run.start, slot)
        })
    })
}

impl<T: Real, const D: usize> Plan<'_, T, D> {
    /// Columns of some runs of slots of its group, whose places count from an origin.
    pub(super) fn fill(&self, group: &Group<T, D>, runs: &[Range<usize>]) -> Columns<T, D> {
        let particles = &group.particles;
        let slots = runs.iter().map(Range::len).sum();
        let mut columns = Columns::new(particles.columns.fields(), slots);
        for (body, state) in self.bodies.iter().zip(&particles.bodies) {
            for (here, slot) in among(runs, state.run()) {
                let k = (slot - state.slots.start).min(body.points.len() - 1);
                let own = (&body.material, body.spacing);
                let x = local(&body.points[k], &particles.origin);
                self.scheme
                    .place(&mut columns, here, own, x, body.start_of(k));
                if let Some(mass) = body.masses.get(k) {
                    columns.raw_mut(Field::MASS)[here] = T::from_f64(*mass);
                }
                for start in &body.fields {
                    let width = start.components;
                    let values = start.values[k * width..(k + 1) * width].iter();
                    let places = columns.raw_mut(start.field)[here * width..].iter_mut();
                    for (place, value) in places.zip(values) {
                        *place = T::from_f64(*value);
                    }
                }
            }
        }
        for ((wall, _), state) in self.walls.iter().zip(&group.walls) {
            for (here, _) in among(runs, state.slots.start..state.end) {
                self.place_wall(&mut columns, wall, here);
            }
        }
        columns
    }

    /// Mass \[kg\] of a wall particle: its volume, filled with the first liquid at rest.
    pub(super) fn wall_mass(&self, wall: &Wall<D>) -> f64 {
        let body = self.bodies.first();
        let density = body.map_or(0.0, |body| body.material.reference_density());
        density * wall.spacing.powi(D as i32)
    }

    /// Gives a wall particle what does not change. It has the density of the first liquid at rest: its
    /// volume is what the liquid's pressure acts on.
    fn place_wall(&self, columns: &mut Columns<T, D>, wall: &Wall<D>, slot: usize) {
        let Some(body) = self.bodies.first() else {
            return;
        };
        let density = body.material.reference_density();
        let (_, sound_speed) = body.material.state(density, 0.0);
        let mut set = |field: Field, value: f64| {
            if let Some(place) = columns.raw_mut(field).get_mut(slot) {
                *place = T::from_f64(value);
            }
        };
        set(Field::DENSITY, density);
        set(Field::SOUND_SPEED, sound_speed);
        set(Field::MASS, self.wall_mass(wall));
        set(
            Field::SMOOTHING_LENGTH,
            self.scheme.h_over_dx * wall.spacing,
        );
        // The liquid corrects the gradients; a wall takes them as they are.
        if let Some(rows) = columns
            .raw_mut(Field::CORRECTION)
            .get_mut(slot * D * D..(slot + 1) * D * D)
        {
            for d in 0..D {
                rows[d * (D + 1)] = T::one();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::among;
    use crate::particles::Field;
    use crate::prelude::{Body, Load, Scene, Wall, catalogue, schemes};
    use crate::ranks::{Team, in_threads};
    use crate::scene::Start;
    use std::sync::Arc;

    #[test]
    fn slots_of_runs_have_their_places_in_these() {
        let runs = [2..5, 9..12];
        let all = |others| among(&runs, others).collect::<Vec<_>>();
        assert_eq!(all(0..4), [(0, 2), (1, 3)]);
        assert_eq!(all(4..11), [(2, 4), (3, 9), (4, 10)]);
        assert!(all(5..9).is_empty() && all(12..20).is_empty());
    }

    /// Two bodies of water in a tank, of as many chunks as three ranks need.
    fn tank() -> Scene<f64, 2> {
        let water = catalogue::weakly_compressible_water(4.0);
        let body = |name, x: f64| {
            let block = Body::block(name, water.clone(), [x, 0.0], [x + 0.3, 0.3], 0.01);
            block.start(|[x, y], start| Start {
                velocity: [y, x],
                ..start
            })
        };
        let closed = [[true; 2]; 2];
        Scene::new(schemes::weakly_compressible())
            .body(body("water", 0.0))
            .body(body("more", 0.3))
            .wall(Wall::around("tank", [0.0; 2], [0.8, 0.6], 0.01, 4, closed))
    }

    /// Mass and velocity of each particle that is laid out, behind its slot in the group.
    fn laid_out(scene: &Scene<f64, 2>, team: Option<&Arc<Team>>) -> Vec<(usize, [f64; 3])> {
        let plan = scene.plans().next().expect("a plan");
        let part = scene.is_of_neighbors_alone();
        let group = plan.lay_out(scene.origin(), team, part);
        let columns = &group.particles.columns;
        let of = |slot: usize| {
            let in_group = group.all.as_ref().map(|own| own.part.slot_in_group(slot));
            let [u, v] = columns.vectors(Field::VELOCITY)[slot];
            let mass = columns.raw(Field::MASS)[slot];
            (in_group.unwrap_or(slot), [mass, u, v])
        };
        (0..columns.slots()).map(of).collect()
    }

    #[test]
    fn ranks_lay_their_own_particles_out_alone() {
        let all = in_threads(3, 1, |ranks| {
            let team = Arc::new(Team::new(ranks));
            // A load may look at all particles.
            let loaded = tank().load(Load::acceleration(|_| [0.0; 2]));
            [tank(), loaded].map(|scene| laid_out(&scene, Some(&team)))
        });
        let whole = laid_out(&tank(), None);
        let mut joined = Vec::new();
        for [own, every] in all.expect("threads") {
            assert!(2 * own.len() < whole.len(), "{}", own.len());
            assert_eq!(every, whole);
            joined.extend(own);
        }
        joined.sort_by_key(|own| own.0);
        assert_eq!(joined, whole);
    }
}
