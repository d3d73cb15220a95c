//! Images of particles behind boundaries, in neighbour lists and in lists of couplings: which are needed, and where they are.
//! Later boundaries also show the images of earlier ones, which fills edges and corners.

use crate::boundary::Boundary;
use crate::scalar::Real;
use crate::sweep::{Image, Transform};
use std::sync::Arc;

/// How an image's transform comes about: the boundary's own, after that of the image it shows.
#[derive(Clone, Copy, Debug)]
struct Chain {
    /// A number that does not depend on which images there are, of the pairs of a coupling; of many boundaries, which a scene with
    /// couplings may not have, it is not one of a kind.
    code: u64,
    parent: Option<u32>,
    boundary: usize,
    image: usize,
}

/// How many numbers chains of some boundaries have, from that of a particle itself, 0; modulo 2⁶⁴.
fn numbers_of_chains<const D: usize>(boundaries: &[Arc<dyn Boundary<D>>]) -> u64 {
    let each = boundaries.iter().map(|own| own.images() as u64 + 1);
    each.fold(1, u64::wrapping_mul)
}

/// The transforms of images, each of one boundary after another.
#[derive(Clone, Debug)]
pub(crate) struct Chains<T, const D: usize> {
    all: Vec<Chain>,
    /// What they are at the time for which they were last placed.
    pub transforms: Vec<Transform<T, D>>,
}

impl<T, const D: usize> Default for Chains<T, D> {
    fn default() -> Self {
        Self {
            all: Vec::new(),
            transforms: Vec::new(),
        }
    }
}

impl<T: Real, const D: usize> Chains<T, D> {
    pub fn clear(&mut self) {
        self.all.clear();
        self.transforms.clear();
    }

    /// Adds the images within `reach` \[m\] that a boundary shows of particles, by their numbers and places \[m\], and of those `images` of
    /// them that earlier boundaries show.
    pub fn show(
        &mut self,
        sources: impl Iterator<Item = (u32, [f64; D])> + Clone,
        images: &mut Vec<(Image, [f64; D])>,
        (boundaries, b): (&[Arc<dyn Boundary<D>>], usize),
        (reach, time): (f64, f64),
    ) {
        let (boundary, earlier) = (&boundaries[b], images.len());
        let radix = numbers_of_chains(&boundaries[..b]);
        for image in 0..boundary.images() {
            let own = boundary.transform(image, time).to_scalar::<T>();
            let mut add = |images: &mut Vec<_>, source, parent: Option<u32>, x: [f64; D]| {
                if !boundary.reaches(image, &x, reach, time) {
                    return;
                }
                let known = self.all.iter().position(|chain| {
                    (chain.parent, chain.boundary, chain.image) == (parent, b, image)
                });
                let transform = known.unwrap_or(self.all.len()) as u32;
                if known.is_none() {
                    let before = parent.map_or(0, |parent| self.all[parent as usize].code);
                    let own = radix.wrapping_mul(image as u64 + 1);
                    self.all.push(Chain {
                        code: before.wrapping_add(own),
                        parent,
                        boundary: b,
                        image,
                    });
                }
                let at = own.point(&x.map(T::from_f64)).map(Real::to_f64);
                images.push((Image { source, transform }, at));
            };
            for (source, x) in sources.clone() {
                add(images, source, None, x);
            }
            for n in 0..earlier {
                let (of, x) = images[n];
                add(images, of.source, Some(of.transform), x);
            }
        }
    }

    /// Brings the transforms to `time` \[s\].
    pub fn place(&mut self, boundaries: &[Arc<dyn Boundary<D>>], time: f64) {
        self.transforms.clear();
        for chain in &self.all {
            self.transforms.push(self.at(chain, boundaries, time));
        }
    }

    fn at(&self, chain: &Chain, boundaries: &[Arc<dyn Boundary<D>>], time: f64) -> Transform<T, D> {
        let own = boundaries[chain.boundary]
            .transform(chain.image, time)
            .to_scalar();
        match chain.parent {
            Some(parent) => self
                .at(&self.all[parent as usize], boundaries, time)
                .then(&own),
            None => own,
        }
    }

    /// How far the farthest image has been moved by boundaries alone between two times \[s\], where they move \[m\].
    pub fn carried(&self, boundaries: &[Arc<dyn Boundary<D>>], times: [f64; 2]) -> f64 {
        if !boundaries.iter().any(|own| own.moves()) {
            return 0.0;
        }
        let moved = self.all.iter().map(|chain| {
            let [then, now] = times.map(|time| self.at(chain, boundaries, time).shift);
            (0..D)
                .map(|d| (now[d].to_f64() - then[d].to_f64()).powi(2))
                .sum::<f64>()
        });
        moved.fold(0.0, f64::max).sqrt()
    }
}

/// Images of the particles of both sides of a coupling, which stand in its list behind the particles. A pair with an image acts on
/// the particle that is there; its mirror image in the list acts on the other.
#[derive(Clone, Debug)]
pub(crate) struct PairImages<T, const D: usize> {
    /// How many particles each side has.
    pub counts: [usize; 2],
    images: [Vec<Image>; 2],
    pub chains: Chains<T, D>,
}

impl<T, const D: usize> Default for PairImages<T, D> {
    fn default() -> Self {
        Self {
            counts: [0; 2],
            images: [Vec::new(), Vec::new()],
            chains: Chains::default(),
        }
    }
}

impl<T: Real, const D: usize> PairImages<T, D> {
    /// Forgets all images.
    pub fn clear(&mut self) {
        self.images.iter_mut().for_each(Vec::clear);
        self.chains.clear();
    }

    /// Adds the images within `reach` \[m\] to the particles of a side, by their numbers. Particles that are not there have no place.
    pub fn add(
        &mut self,
        side: usize,
        places: &mut Vec<[f64; D]>,
        boundaries: &[Arc<dyn Boundary<D>>],
        at: (f64, f64),
    ) {
        self.counts[side] = places.len();
        let mut images = Vec::new();
        let there = places.iter().enumerate().filter(|(_, x)| !x[0].is_nan());
        let there = there.map(|(id, x)| (id as u32, *x));
        for b in 0..boundaries.len() {
            let sources = there.clone();
            self.chains.show(sources, &mut images, (boundaries, b), at);
        }
        images.sort_by_key(|(own, _)| (self.chains.all[own.transform as usize].code, own.source));
        self.images[side].extend(images.iter().map(|own| own.0));
        places.extend(images.iter().map(|own| own.1));
    }

    /// The particle that stands at a number of the list, and the chain if it is an image.
    pub fn source(&self, side: usize, id: u32) -> (u32, Option<usize>) {
        match (id as usize).checked_sub(self.counts[side]) {
            None => (id, None),
            Some(image) => {
                let own = self.images[side][image];
                (own.source, Some(own.transform as usize))
            }
        }
    }

    /// A number of what stands at a number of the list that lists made later have too, in the same order.
    pub fn key(&self, side: usize, id: u32) -> u64 {
        let (id, chain) = self.source(side, id);
        let code = chain.map_or(0, |chain| self.chains.all[chain].code);
        u64::from(id) + code * self.counts[side] as u64
    }

    /// The boundary to which the last image of a chain belongs.
    pub fn boundary(&self, chain: usize) -> usize {
        self.chains.all[chain].boundary
    }
}
