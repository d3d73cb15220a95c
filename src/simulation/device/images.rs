//! Images behind boundaries as a device has them: records of their sources, turned and shifted.
//! Which there are is found here, from places alone; where planes and periods are is a handful of numbers a boundary.

use super::{Bounds, Offloaded};
use crate::particles::{Field, Fields, Shape};
use crate::scalar::{Lane, Real, Record, Traced, Unrecordable};
use crate::sweep::{Transform, two_sum};
use crate::tensor::{Square, Symmetric};
use std::sync::Arc;

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

/// Particles that have left a period and re-enter.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReEntries {
    /// The slot of each, and the number of its transform.
    pub entries: Vec<u32>,
    /// Transforms as [`Offloaded::transforms`] has them.
    pub transforms: Vec<f64>,
}

/// A transform as numbers.
fn numbers<T: Real, const D: usize>(own: &Transform<T, D>) -> Vec<f64> {
    let rotation = own.rotation.transpose();
    let moved = own.shift.iter().chain(&own.velocity);
    rotation.iter().chain(moved).map(|x| x.to_f64()).collect()
}

impl<T: Real, const D: usize> Offloaded<T, D> {
    /// Whether particles of a group have images.
    #[must_use]
    pub fn shows_images(&self, group: usize) -> bool {
        !self.simulation.state.groups[group].boundaries.is_empty()
    }

    /// The fields in which a particle changes that re-enters, and the record of them.
    ///
    /// # Errors
    ///
    /// [`Unrecordable`] if the text cannot be recorded.
    pub fn re_entry(&self, group: usize) -> Result<(Fields, Record), Unrecordable> {
        let there = self.recorded[group].layout.fields;
        let moved = [Field::POSITION, Field::POSITION_RESIDUAL].into_iter();
        let moved: Vec<_> = moved.filter(|field| there.contains(*field)).collect();
        let fields = Fields::of(&moved);
        Ok((fields, image_record::<D>(fields)?))
    }

    /// Lets what has left a period at a time \[s\] re-enter among places \[m\], axis after axis; which particles these are. None where what
    /// re-enters is turned, or an integrator keeps other places of it: then the host [rebuilds](Self::rebuild).
    #[must_use]
    pub fn re_entered(&self, number: usize, places: &mut [f64], time: f64) -> Option<ReEntries> {
        let (group, slots) = (
            &self.simulation.state.groups[number],
            self.recorded[number].layout.slots,
        );
        let mut all = ReEntries::default();
        for slot in 0..group.particles.mobile {
            let start: [f64; D] = core::array::from_fn(|d| places[d * slots + slot]);
            let (mut x, mut by) = (start.map(T::from_f64), None);
            for boundary in &group.boundaries {
                let at = x.map(Real::to_f64);
                if boundary.crossed(&at, time) {
                    return None;
                }
                let Some(through) = boundary.wrap(&at, time) else {
                    continue;
                };
                let through = through.to_scalar::<T>();
                if through.turns() || !self.recorded[number].program.states.is_empty() {
                    return None;
                }
                x = through.point(&x);
                by = Some(match by {
                    Some(by) => Transform::then(&by, &through),
                    None => through,
                });
            }
            let Some(by) = by else { continue };
            for (d, x) in by.point(&start.map(T::from_f64)).into_iter().enumerate() {
                places[d * slots + slot] = x.to_f64();
            }
            let by = numbers(&by);
            let known = all.transforms.chunks(by.len()).position(|own| own == by);
            let number = known.unwrap_or(all.transforms.len() / by.len());
            if known.is_none() {
                all.transforms.extend(by);
            }
            all.entries.extend([slot as u32, number as u32]);
        }
        Some(all)
    }

    /// Finds the images of a group for places \[m\], axis after axis, and smoothing lengths \[m\] where they vary, of which the largest bounds
    /// have. Slot k is now what slot `order[k]` was there, if there is an order.
    pub fn show_images(
        &mut self,
        number: usize,
        (columns, order): (&[f64], &[u32]),
        bounds: &Bounds<D>,
    ) {
        let (layout, group) = (
            &self.recorded[number].layout,
            &mut self.simulation.state.groups[number],
        );
        let (slots, near) = (layout.slots, &mut group.neighborhood);
        let before = |slot: usize| order.get(slot).map_or(slot, |own| *own as usize);
        let of = |d: usize, slot: usize| T::from_f64(columns[d * slots + before(slot)]);
        let place = |slot: usize| core::array::from_fn(|d| of(d, slot));
        near.listed = Arc::new((0..slots).map(place).collect());
        let lengths = 0..columns.len() - D * slots;
        near.listed_h = lengths.map(|slot| of(D, slot)).collect();
        let largest = bounds.lengths.map_or(0.0, |own| own[1]);
        let reach = near.support * largest.max(near.smoothing_length) + near.skin;
        let at = (near.listed_time, reach);
        near.place_blocks(&group.particles, &group.walls, &group.boundaries, at);
    }

    /// What bounds all particles of a group, and their images.
    #[must_use]
    pub fn bounds_with_images(&self, group: usize, mut bounds: Bounds<D>) -> Bounds<D> {
        let near = &self.simulation.state.groups[group].neighborhood;
        for x in &near.listed[self.recorded[group].layout.slots..] {
            for d in 0..D {
                let [low, high] = &mut bounds.range;
                low[d] = low[d].min(x[d].to_f64());
                high[d] = high[d].max(x[d].to_f64());
            }
        }
        bounds
    }

    /// The places \[m\] of the images of a group, with their smoothing lengths \[m\] where these vary, and the block of each.
    #[must_use]
    pub fn listed_images(&self, group: usize) -> (Vec<f64>, Vec<u32>) {
        let (near, slots) = (
            &self.simulation.state.groups[group].neighborhood,
            self.recorded[group].layout.slots,
        );
        let mut places = Vec::new();
        for (n, x) in near.listed.iter().enumerate().skip(slots) {
            places.extend(x.iter().map(|x| x.to_f64()));
            places.extend(near.listed_h.get(n).map(|h| h.to_f64()));
        }
        let blocks = near.blocks.iter().enumerate();
        let blocks = blocks.filter(|(_, own)| own.slots.start >= slots);
        let blocks = blocks.flat_map(|(k, own)| own.slots.clone().map(move |_| k as u32));
        (places, blocks.collect())
    }

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
        chains.transforms.iter().flat_map(numbers).collect()
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
