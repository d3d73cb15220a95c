//! What observers see behind boundaries: images of particles, and the forces of planes on what is before them.
//! Found when asked for, from where the particles are; the lists of a run are not touched.

use super::Simulation;
use crate::boundary::Boundary;
use crate::origin::{global, local};
use crate::particles::{Field, Output};
use crate::scalar::Real;
use crate::sweep::{Interaction, Pass, Records, Results, SweepInput, Transform};
use crate::term::Stage;
use std::sync::Arc;

/// A place \[m\] and a force \[N\] there.
type ForceAt<const D: usize> = ([f64; D], [f64; D]);

/// An image of a particle.
#[derive(Clone, Debug)]
pub(crate) struct ObservedImage<T, const D: usize> {
    /// Where it is \[m\].
    pub at: [f64; D],
    pub transform: Transform<T, D>,
    /// A bit for each boundary that makes it.
    pub boundaries: u64,
}

impl<T: Real, const D: usize> Simulation<T, D> {
    pub(crate) fn boundaries(&self) -> &[Arc<dyn Boundary<D>>] {
        &self.state.groups[0].boundaries
    }

    /// The images of a particle at `x` \[m\] in the scene that lie within `reach` \[m\] of the domain. Later boundaries also show those of
    /// earlier ones.
    pub(crate) fn images_of(
        &self,
        x: &[f64; D],
        reach: f64,
        images: &mut Vec<ObservedImage<T, D>>,
    ) {
        images.clear();
        let origin = self.origin();
        let x = local(x, &origin);
        for (b, boundary) in self.boundaries().iter().enumerate() {
            let earlier = images.len();
            for k in 0..boundary.images() {
                for n in 0..=earlier {
                    let before = n.checked_sub(1).map(|n| &images[n]);
                    let at = before.map_or(x, |image| image.at);
                    if !boundary.reaches(k, &at, reach, self.state.time) {
                        continue;
                    }
                    let own = boundary.transform(k, self.state.time).to_scalar();
                    let (transform, others) = match before {
                        Some(image) => (image.transform.then(&own), image.boundaries),
                        None => (own.clone(), 0),
                    };
                    images.push(ObservedImage {
                        at: image_of(&own, &at),
                        transform,
                        boundaries: others | 1 << b,
                    });
                }
            }
        }
        for image in images {
            image.at = global(&image.at, &origin);
        }
    }

    /// The boundaries that a point is behind, a bit for each, and not within `least` \[m\] of: nothing that they show is there.
    pub(crate) fn boundaries_before(&self, x: &[f64; D], least: f64) -> u64 {
        let mut all = 0;
        let x = &local(x, &self.origin());
        for (b, boundary) in self.boundaries().iter().enumerate() {
            if boundary.crossed(x, self.state.time) {
                let image = image_of(&boundary.transform(0, self.state.time), x);
                let far: f64 = (0..D).map(|d| (image[d] - x[d]).powi(2)).sum();
                all |= u64::from(far > least * least) << b;
            }
        }
        all
    }

    /// The forces \[N\] of the bodies on planes of symmetry and planes that are walls at the last evaluation, each where the image
    /// of its particle is \[m\]. A sweep for each plane, when asked for.
    pub(crate) fn plane_forces(&self) -> Vec<ForceAt<D>> {
        let mut forces = Vec::new();
        let mut rows = Results::default();
        for group in self.observed() {
            let Some(rates) = group.scheme.sweep(Stage::Rates) else {
                continue;
            };
            let direct = group.particles.bodies.len() + group.walls.len();
            let blocks = group.neighborhood.blocks.len();
            let is_plane =
                |own: &Transform<T, D>| own.rotation != Transform::<T, D>::identity().rotation;
            let planes = group.boundaries.iter().enumerate();
            let planes = planes.map(|(b, own)| {
                let at = group.neighborhood.placed_time;
                (b, own.transform(0, at).to_scalar::<T>())
            });
            for (b, transform) in planes.filter(|(_, own)| is_plane(own)) {
                // Nothing but images behind the plane acts.
                let mut interactions = group.neighborhood.interactions.clone();
                for (at, interaction) in interactions.iter_mut().enumerate() {
                    let from = at % blocks;
                    if from < direct || (from - direct) % group.boundaries.len() != b {
                        *interaction = Interaction::None;
                    }
                }
                let input = SweepInput {
                    interactions: &interactions,
                    lists: group.neighborhood.all_lists(),
                    ..group.input()
                };
                let mut packed = Records::default();
                let records = if group.work.records_of_rates {
                    &group.work.records
                } else {
                    rates.pack(Pass::Rates, &input, &mut packed);
                    &packed
                };
                rates.run(Pass::Rates, &input, records, &mut rows);
                let positions = group.particles.columns.vectors(Field::POSITION);
                for slot in group
                    .particles
                    .bodies
                    .iter()
                    .flat_map(|body| body.slots.clone())
                {
                    let force = rows.vector(Output::FORCE, slot).map(|f| -f.to_f64());
                    if force.iter().any(|f| *f != 0.0) {
                        let x = positions[slot].map(Real::to_f64);
                        let place = image_of(&transform, &x);
                        forces.push((global(&place, &group.particles.origin), force));
                    }
                }
            }
        }
        forces
    }
}

/// The image of a point, without the rounding of the scalar.
fn image_of<T: Real, const D: usize>(transform: &Transform<T, D>, x: &[f64; D]) -> [f64; D] {
    core::array::from_fn(|d| {
        let turned: f64 = (0..D)
            .map(|k| transform.rotation[(d, k)].to_f64() * x[k])
            .sum();
        turned + transform.shift[d].to_f64()
    })
}
