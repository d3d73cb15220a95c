//! Images behind boundaries as a device has them: records of their sources, turned and shifted.
//! Which there are is found here with the lists; where planes and periods are is a handful of numbers a boundary.

use super::Offloaded;
use crate::particles::{Field, Fields, Shape};
use crate::scalar::{Lane, Real, Record, Traced, Unrecordable};
use crate::sweep::two_sum;
use crate::tensor::{Square, Symmetric};

/// A matrix from its numbers row by row.
pub(super) fn square<const D: usize>(numbers: &[Traced]) -> Square<Traced, D> {
    Square(core::array::from_fn(|a| {
        core::array::from_fn(|b| numbers[a * D + b])
    }))
}

/// The record of an image, from that of its source and the numbers of its transform as [`Offloaded::transforms`] has them.
pub(super) fn image_record<const D: usize>(reads: Fields) -> Result<Record, Unrecordable> {
    let stride = reads.width(D);
    Record::of(stride + D * D + 2 * D, |given| {
        let (own, by) = given.split_at(stride);
        let rotation = square::<D>(by);
        let (shift, velocity) = by[D * D..].split_at(D);
        let (mut image, mut lost) = (Vec::new(), [Traced::of(0.0); D]);
        for field in reads.iter() {
            let own = &own[reads.offset(field, D)..][..field.components(D)];
            match field.shape() {
                Shape::Scalar => image.push(own[0]),
                Shape::Matrix => {
                    let turned = rotation.times(&square(own)).times(&rotation.transposed());
                    image.extend(turned.0.as_flattened());
                }
                Shape::Tensor => {
                    let tensor = Symmetric::new(core::array::from_fn(|k| own[k]));
                    image.extend(rotation.turned(&tensor).components());
                }
                shape => {
                    let turned = rotation.dot(&core::array::from_fn(|d| own[d]));
                    for d in 0..D {
                        image.push(match shape {
                            Shape::Point => {
                                let (sum, error) = two_sum(turned[d], shift[d]);
                                lost[d] = error;
                                sum
                            }
                            Shape::Velocity => turned[d] + velocity[d],
                            _ if field == Field::POSITION_RESIDUAL => turned[d] + lost[d],
                            _ => turned[d],
                        });
                    }
                }
            }
        }
        image
    })
}

impl<T: Real, const D: usize> Offloaded<T, D> {
    /// The images of particles of a group that lists have behind all slots: the slot of each, and the number of its transform.
    #[must_use]
    pub fn images(&self, group: usize) -> Vec<u32> {
        let images = &self.simulation.state.groups[group].neighborhood.images;
        let of = images.iter().flat_map(|own| [own.source, own.transform]);
        of.collect()
    }

    /// Transforms of images, one after another: rotation or reflection row by row, shift \[m\], velocity \[m/s\].
    #[must_use]
    pub fn transforms(&self, group: usize) -> Vec<f64> {
        let chains = &self.simulation.state.groups[group].neighborhood.chains;
        let mut all = Vec::new();
        for own in &chains.transforms {
            all.extend(own.rotation.transpose().iter().map(|x| x.to_f64()));
            all.extend(own.shift.iter().chain(&own.velocity).map(|x| x.to_f64()));
        }
        all
    }

    /// Brings boundaries that move to where they are at a time \[s\]; whether there are any.
    pub(super) fn place_boundaries(&mut self, group: usize, time: f64) -> bool {
        let group = &mut self.simulation.state.groups[group];
        let moves = group.boundaries.iter().any(|own| own.moves());
        if moves {
            group.neighborhood.place_transforms(&group.boundaries, time);
        }
        moves
    }

    /// The largest speed \[m/s\] that a boundary gives images, and a range of velocities \[m/s\] with those of all images: no image is
    /// outside of what its boundary makes of the range of all particles.
    pub(super) fn range_with_images(
        &self,
        group: usize,
        [low, high]: &[Vec<f64>; 2],
    ) -> (f64, Vec<f64>) {
        let chains = &self.simulation.state.groups[group].neighborhood.chains;
        let (mut most, [mut least, mut largest]) = (0.0_f64, [low.clone(), high.clone()]);
        for own in &chains.transforms {
            most = most.max(own.velocity.map(Real::to_f64).norm());
            for a in 0..D {
                let [mut from, mut to] = [own.velocity[a].to_f64(); 2];
                for b in 0..D {
                    let ends = [low[b], high[b]].map(|v| own.rotation[(a, b)].to_f64() * v);
                    from += ends[0].min(ends[1]);
                    to += ends[0].max(ends[1]);
                }
                (least[a], largest[a]) = (least[a].min(from), largest[a].max(to));
            }
        }
        (most, [least, largest].concat())
    }
}
