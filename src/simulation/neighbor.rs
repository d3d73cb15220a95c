//! Neighbours of particles, images behind planes and across periods among them, as the neighbour lists hold them.
//! What looks at pairs outside of the pair loop walks over them here.

use super::group::Group;
use super::neighborhood::Neighborhood;
use super::query::ParticleView;
use crate::neighbors::CHUNK;
use crate::particles::Field;
use crate::scalar::{Real, width};
use crate::scheme::{DensityForm, Smoothing};
use crate::sweep::Transform;

/// An entry of a neighbour list: a particle, or an image of one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Entry<'a, T, const D: usize> {
    /// Its number in the lists.
    pub number: usize,
    /// The slot of the particle.
    pub slot: usize,
    /// What makes the image.
    pub image: Option<&'a Transform<T, D>>,
}

impl<T: Real, const D: usize> Entry<'_, T, D> {
    /// Its place, by a column of places.
    #[inline(always)]
    pub fn place(&self, places: &[[T; D]]) -> [T; D] {
        let own = places[self.slot];
        self.image.map_or(own, |by| by.point(&own))
    }

    /// From a place to it \[m\], by the column that the place is of.
    pub fn from(&self, x: &[T; D], places: &[[T; D]]) -> [f64; D] {
        let place = self.place(places);
        core::array::from_fn(|d| place[d].to_f64() - x[d].to_f64())
    }

    /// Its velocity \[m/s\], by the column of velocities.
    #[inline(always)]
    pub fn velocity(&self, velocities: &[[T; D]]) -> [T; D] {
        let own = velocities[self.slot];
        self.image.map_or(own, |by| by.velocity_of(&own))
    }
}

impl<T: Real, const D: usize> Neighborhood<T, D> {
    /// The neighbours of a row of particles, members of the row among them, block by block.
    pub fn of_row(
        &self,
        row: usize,
    ) -> impl Iterator<Item = (usize, impl Iterator<Item = Entry<'_, T, D>>)> {
        let slots = self.listed.len() - self.images.len();
        let entry = move |&j: &u32| match (j as usize).checked_sub(slots) {
            None => Entry {
                number: j as usize,
                slot: j as usize,
                image: None,
            },
            Some(image) => Entry {
                number: j as usize,
                slot: self.images[image].source as usize,
                image: Some(&self.chains.transforms[self.images[image].transform as usize]),
            },
        };
        let own = self.lists.chunks().get(row / CHUNK);
        let list = match own {
            Some(own) if !own.is_here() => self.all_lists().chunks().get(row / CHUNK),
            own => own,
        };
        let list = list.filter(|list| row % CHUNK < list.rows());
        list.into_iter().flat_map(move |list| {
            let segments = list.segments_of(row % CHUNK).iter();
            segments.map(move |own| (own.block as usize, list.listed(own).0.iter().map(entry)))
        })
    }

    /// The neighbours of a particle, within the reach of its row and the skin.
    pub fn of(&self, slot: usize) -> impl Iterator<Item = Entry<'_, T, D>> {
        let row = self.of_row(slot / width::<T>());
        row.flat_map(|(_, entries)| entries)
            .filter(move |own| own.slot != slot || own.image.is_some())
    }
}

/// A neighbour of a particle, as [`ParticleView::for_each_neighbor`] shows it.
#[derive(Clone, Copy, Debug)]
pub struct Neighbor<'a, T: Real, const D: usize> {
    group: &'a Group<T, D>,
    entry: Entry<'a, T, D>,
    offset: [f64; D],
    distance: f64,
    /// Of the pair \[m\].
    h: f64,
}

impl<'a, T: Real, const D: usize> Neighbor<'a, T, D> {
    /// The particle, or the one that it is an image of.
    #[must_use]
    pub fn particle(&self) -> ParticleView<'a, T, D> {
        ParticleView {
            group: self.group,
            slot: self.entry.slot,
        }
    }
    /// Whether it is an image.
    #[must_use]
    pub fn is_image(&self) -> bool {
        self.entry.image.is_some()
    }
    /// From the particle to it \[m\].
    #[must_use]
    pub fn offset(&self) -> [f64; D] {
        self.offset
    }
    /// The length of the [offset](Self::offset) \[m\].
    #[must_use]
    pub fn distance(&self) -> f64 {
        self.distance
    }
    /// Its velocity \[m/s\]; of an image that of the image.
    #[must_use]
    pub fn velocity(&self) -> [f64; D] {
        let columns = &self.group.particles.columns;
        let own = self.entry.velocity(columns.vectors(Field::VELOCITY));
        own.map(Real::to_f64)
    }
    /// The kernel W \[1/mᴰ\].
    #[must_use]
    pub fn kernel(&self) -> f64 {
        self.shape()[0]
    }
    /// The gradient ∇W \[1/mᴰ⁺¹\] at the particle, which points to the neighbour.
    #[must_use]
    pub fn kernel_gradient(&self) -> [f64; D] {
        let factor = self.shape()[1];
        self.offset.map(|r| r * factor)
    }
    /// W and |∇W|/r.
    fn shape(&self) -> [f64; 2] {
        let [shape, slope] = self.group.scheme.profile.at(self.distance / self.h);
        let scale = self.h.powi(D as i32);
        [shape / scale, -slope / (scale * self.h * self.h)]
    }
}

impl<'a, T: Real, const D: usize> ParticleView<'a, T, D> {
    /// Visits the neighbours of a particle within the support of the kernel, without the particle itself: particles of bodies and
    /// walls of its [group](crate::scene::Scene::group), and their images behind planes and across periods.
    ///
    /// The smoothing length of a pair is that of the scheme: the mean of the two, or that of the particle. Schemes that sum over the
    /// reference configuration (total Lagrangian) have neighbours, offsets, distances and kernels there. Particles on the two sides
    /// of a contact are neighbours before the contact is active.
    ///
    /// Neighbours are those of the last evaluation; a scene that is built has been evaluated.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// let water = catalogue::weakly_compressible_water(2.0);
    /// let body = Body::block("water", water, [0.0; 2], [0.2, 0.1], 0.01);
    /// let simulation = Scene::<f64, 2>::new(schemes::weakly_compressible())
    ///     .body(body)
    ///     .boundary(MirrorPlane::symmetry([0.0, 0.0], [0.0, -1.0]))
    ///     .build()?;
    /// // Σ V ∇W is zero inside of a liquid, and points into it at a free surface.
    /// for particle in simulation.body("water")? {
    ///     let (mut sum, mut images) = ([0.0; 2], 0);
    ///     particle.for_each_neighbor(|neighbor| {
    ///         let other = neighbor.particle();
    ///         let volume = other.mass() / other.density();
    ///         let gradient = neighbor.kernel_gradient();
    ///         sum = [0, 1].map(|d| sum[d] + volume * gradient[d]);
    ///         images += usize::from(neighbor.is_image());
    ///     });
    ///     let [x, y] = particle.position();
    ///     if 0.05 < x && x < 0.15 {
    ///         assert_eq!(sum[1] * 0.01 < -0.3, y > 0.09, "{sum:?} at {x}, {y}");
    ///         assert_eq!(images > 0, y < 0.02);
    ///     }
    /// }
    /// # Ok::<(), Error>(())
    /// ```
    pub fn for_each_neighbor(&self, mut visit: impl FnMut(Neighbor<'a, T, D>)) {
        let (group, columns) = (self.group, &self.group.particles.columns);
        let places = columns.vectors(if group.scheme.density == DensityForm::Deformation {
            Field::REFERENCE_POSITION
        } else {
            Field::POSITION
        });
        let own_lengths = matches!(group.scheme.smoothing, Smoothing::Consistent(_));
        let (support, length) = (group.scheme.kernel.support, self.smoothing_length());
        let x = places[self.slot];
        for entry in group.neighborhood.of(self.slot) {
            let offset = entry.from(&x, places);
            let distance = offset.iter().map(|r| r * r).sum::<f64>().sqrt();
            let other = ParticleView {
                group,
                slot: entry.slot,
            };
            let h = if own_lengths {
                length
            } else {
                0.5 * (length + other.smoothing_length())
            };
            if distance / h < support {
                visit(Neighbor {
                    group,
                    entry,
                    offset,
                    distance,
                    h,
                });
            }
        }
    }
}
