//! Images of particles behind boundaries: which are needed, and where they are.
//! Later boundaries also mirror the images of earlier ones.

use super::group::Group;
use super::neighborhood::Neighborhood;
use crate::boundary::Boundary;
use crate::neighbors::Block;
use crate::particles::Field;
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

impl<T: Real, const D: usize> Group<T, D> {
    /// Finds which images are needed. Later boundaries also mirror the images of earlier ones, which
    /// fills edges and corners. The images of bodies and of each wall are blocks of their own.
    pub(super) fn place_images(&mut self, time: f64, reach: f64) {
        self.neighborhood.images.clear();
        self.neighborhood.chains.clear();
        if self.boundaries.is_empty() {
            return;
        }
        let bodies: Vec<Range<usize>> = self
            .particles
            .bodies
            .iter()
            .map(|body| body.slots.clone())
            .collect();
        self.place_images_of(&bodies, false, time, reach);
        for wall in 0..self.walls.len() {
            self.place_images_of(&[self.walls[wall].slots.clone()], true, time, reach);
        }
        self.neighborhood.place_transforms(&self.boundaries, time);
    }

    /// One block of images a boundary, of the particles in `sources`.
    fn place_images_of(&mut self, sources: &[Range<usize>], wall: bool, time: f64, reach: f64) {
        let slots = self.particles.columns.slots();
        let before = self.neighborhood.images.len();
        let mut candidates: Vec<(u32, Option<u32>, [T; D])> = Vec::new();
        for (b, boundary) in self.boundaries.iter().enumerate() {
            let start = self.neighborhood.images.len();
            for k in 0..boundary.images() {
                let own = boundary.transform(k, time);
                candidates.clear();
                let near = |x: &[T; D]| boundary.reaches(k, x, reach, time);
                let positions = self.particles.columns.vectors(Field::POSITION);
                for slot in sources.iter().flat_map(Clone::clone) {
                    if near(&positions[slot]) {
                        candidates.push((slot as u32, None, positions[slot]));
                    }
                }
                for (image, x) in self.neighborhood.images[before..start]
                    .iter()
                    .zip(&self.neighborhood.listed[slots + before..])
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
                    let known = self.neighborhood.chains.iter().position(|c| *c == chain);
                    let transform = known.unwrap_or(self.neighborhood.chains.len()) as u32;
                    if known.is_none() {
                        self.neighborhood.chains.push(chain);
                    }
                    self.neighborhood.images.push(Image { source, transform });
                    self.neighborhood.listed.push(own.point(&x));
                }
            }
            self.neighborhood.blocks.push(Block {
                slots: slots + start..slots + self.neighborhood.images.len(),
                wall,
            });
        }
    }
}

impl<T: Real, const D: usize> Neighborhood<T, D> {
    /// Brings the transforms of images up to date.
    pub(super) fn place_transforms(&mut self, boundaries: &[Arc<dyn Boundary<T, D>>], time: f64) {
        self.placed_time = time;
        self.transforms.clear();
        for chain in &self.chains {
            let own = boundaries[chain.boundary as usize].transform(chain.image as usize, time);
            let whole = match chain.parent {
                Some(parent) => self.transforms[parent as usize].then(&own),
                None => own,
            };
            self.transforms.push(whole);
        }
    }
}
