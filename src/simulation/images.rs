//! Images of particles behind boundaries: which are needed, and where they are.
//! Later boundaries also mirror the images of earlier ones.

use super::neighborhood::Neighborhood;
use super::population::Particles;
use super::walls::WallState;
use crate::boundary::Boundary;
use crate::neighbors::Block;
use crate::particles::{Columns, Field};
use crate::scalar::Real;
use crate::sweep::Image;
use std::ops::Range;
use std::sync::Arc;

/// How an image's transform comes about: the boundary's own, after that of the image it mirrors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Chain {
    parent: Option<u32>,
    boundary: u32,
    image: u32,
}

impl<T: Real, const D: usize> Neighborhood<T, D> {
    /// Finds which images are needed. Later boundaries also mirror the images of earlier ones, which
    /// fills edges and corners. The images of each body and of each wall are blocks of their own.
    pub(super) fn place_images(
        &mut self,
        particles: &Particles<T, D>,
        walls: &[WallState<T, D>],
        boundaries: &[Arc<dyn Boundary<D>>],
        time: f64,
    ) {
        self.images.clear();
        self.chains.clear();
        if boundaries.is_empty() {
            return;
        }
        let columns = &particles.columns;
        for body in &particles.bodies {
            self.place_images_of(columns, &body.slots, None, boundaries, time);
        }
        for wall in walls {
            self.place_images_of(columns, &wall.slots, Some(wall), boundaries, time);
        }
        self.place_transforms(boundaries, time);
    }

    /// One block of images a boundary, of the particles in `sources`: those of a body, or of a wall.
    fn place_images_of(
        &mut self,
        columns: &Columns<T, D>,
        sources: &Range<usize>,
        wall: Option<&WallState<T, D>>,
        boundaries: &[Arc<dyn Boundary<D>>],
        time: f64,
    ) {
        let (slots, reach) = (columns.slots(), self.listed_reach);
        let before = self.images.len();
        let mut candidates: Vec<(u32, Option<u32>, [T; D])> = Vec::new();
        for (b, boundary) in boundaries.iter().enumerate() {
            let start = self.images.len();
            for k in 0..boundary.images() {
                let own = boundary.transform(k, time).to_scalar();
                candidates.clear();
                let near = |x: &[T; D]| boundary.reaches(k, &x.map(Real::to_f64), reach, time);
                let positions = columns.vectors(Field::POSITION);
                for slot in sources.clone() {
                    if near(&positions[slot]) {
                        candidates.push((slot as u32, None, positions[slot]));
                    }
                }
                for (image, x) in self.images[before..start]
                    .iter()
                    .zip(&self.listed[slots + before..])
                {
                    if near(x) {
                        candidates.push((image.source, Some(image.transform), *x));
                    }
                }
                for &(source, parent, x) in &candidates {
                    let chain = Chain {
                        parent,
                        boundary: b as u32,
                        image: k as u32,
                    };
                    let known = self.chains.iter().position(|c| *c == chain);
                    let transform = known.unwrap_or(self.chains.len()) as u32;
                    if known.is_none() {
                        self.chains.push(chain);
                    }
                    self.images.push(Image { source, transform });
                    self.listed.push(own.point(&x));
                }
            }
            self.blocks.push(Block {
                slots: slots + start..slots + self.images.len(),
                wall: wall.is_some(),
            });
            self.mirrored
                .push(wall.is_some_and(|wall| wall.is_mirrored()));
        }
    }

    /// Brings the transforms of images up to date.
    pub(super) fn place_transforms(&mut self, boundaries: &[Arc<dyn Boundary<D>>], time: f64) {
        self.placed_time = time;
        self.transforms.clear();
        for chain in &self.chains {
            let own = boundaries[chain.boundary as usize].transform(chain.image as usize, time);
            let own = own.to_scalar();
            let whole = match chain.parent {
                Some(parent) => self.transforms[parent as usize].then(&own),
                None => own,
            };
            self.transforms.push(whole);
        }
    }
}
