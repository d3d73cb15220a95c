//! Images in the lists of couplings by forces: particles behind a plane of symmetry, or one period on.
//! A pair with an image acts on the particle that is there; its mirror image in the list acts on the other.

use crate::boundary::Boundary;
use crate::scalar::Real;
use crate::sweep::Transform;
use std::sync::Arc;

/// Images of the particles of both sides of a coupling, which stand in its list behind the particles.
#[derive(Clone, Debug)]
pub(crate) struct PairImages<T, const D: usize> {
    /// How many particles each side has.
    pub counts: [usize; 2],
    /// The number of the particle, and which chain makes its image.
    pub of: [Vec<[u32; 2]>; 2],
    /// Which images of which boundaries follow on each other.
    chains: Vec<Chain>,
    /// What they do at the time of the last evaluation.
    pub transforms: Vec<Transform<T, D>>,
}

#[derive(Clone, Debug)]
struct Chain {
    /// A number that does not depend on which images there are.
    code: u32,
    links: Vec<[usize; 2]>,
}

/// An image within reach.
struct Found<const D: usize> {
    id: u32,
    code: u32,
    links: Vec<[usize; 2]>,
    at: [f64; D],
}

impl<T, const D: usize> Default for PairImages<T, D> {
    fn default() -> Self {
        Self {
            counts: [0; 2],
            of: [Vec::new(), Vec::new()],
            chains: Vec::new(),
            transforms: Vec::new(),
        }
    }
}

impl<T: Real, const D: usize> PairImages<T, D> {
    /// Forgets all images.
    pub fn clear(&mut self) {
        self.of.iter_mut().for_each(Vec::clear);
        self.chains.clear();
        self.transforms.clear();
    }

    /// Adds the images within `reach` \[m\] to the particles of a side, by their numbers.
    pub fn add(
        &mut self,
        side: usize,
        places: &mut Vec<[f64; D]>,
        boundaries: &[Arc<dyn Boundary<D>>],
        reach: f64,
        time: f64,
    ) {
        self.counts[side] = places.len();
        if boundaries.is_empty() {
            return;
        }
        let mut images: Vec<Found<D>> = Vec::new();
        let mut radix = 1;
        for (b, boundary) in boundaries.iter().enumerate() {
            let earlier = images.len();
            for k in 0..boundary.images() {
                let own = boundary.transform(k, time).to_scalar::<T>();
                let digit = radix * (k as u32 + 1);
                let image = |x: &[f64; D]| {
                    let near = boundary.reaches(k, x, reach, time);
                    near.then(|| own.point(&x.map(T::from_f64)).map(Real::to_f64))
                };
                for (id, x) in places.iter().enumerate().filter(|(_, x)| !x[0].is_nan()) {
                    if let Some(at) = image(x) {
                        images.push(Found {
                            id: id as u32,
                            code: digit,
                            links: vec![[b, k]],
                            at,
                        });
                    }
                }
                for n in 0..earlier {
                    if let Some(at) = image(&images[n].at) {
                        let Found {
                            id, code, links, ..
                        } = &images[n];
                        images.push(Found {
                            id: *id,
                            code: code + digit,
                            links: links.iter().copied().chain([[b, k]]).collect(),
                            at,
                        });
                    }
                }
            }
            radix *= boundary.images() as u32 + 1;
        }
        images.sort_by_key(|own| (own.code, own.id));
        for Found {
            id,
            code,
            links,
            at,
        } in images
        {
            let known = self.chains.iter().position(|own| own.code == code);
            let chain = known.unwrap_or_else(|| {
                self.chains.push(Chain { code, links });
                self.chains.len() - 1
            });
            self.of[side].push([id, chain as u32]);
            places.push(at);
        }
    }

    /// What images are at `time` \[s\].
    pub fn place(&mut self, boundaries: &[Arc<dyn Boundary<D>>], time: f64) {
        self.transforms.clear();
        for chain in &self.chains {
            let links = chain.links.iter();
            let whole = links.fold(Transform::identity(), |whole, &[b, k]| {
                whole.then(&boundaries[b].transform(k, time).to_scalar())
            });
            self.transforms.push(whole);
        }
    }

    /// The particle that stands at a number of the list, and the chain if it is an image.
    pub fn source(&self, side: usize, id: u32) -> (u32, Option<usize>) {
        match (id as usize).checked_sub(self.counts[side]) {
            None => (id, None),
            Some(image) => {
                let [source, chain] = self.of[side][image];
                (source, Some(chain as usize))
            }
        }
    }

    /// A number of what stands at a number of the list that lists made later have too, in the same order.
    pub fn key(&self, side: usize, id: u32) -> u32 {
        match self.source(side, id) {
            (id, None) => id,
            (id, Some(chain)) => id + self.chains[chain].code * self.counts[side] as u32,
        }
    }

    /// The boundary to which the last image of a chain belongs.
    pub fn boundary(&self, chain: usize) -> usize {
        self.chains[chain].links.last().map_or(0, |link| link[0])
    }

    /// How far the farthest image has been moved by boundaries alone since it was listed \[m\], where they move.
    pub fn carried(&self, boundaries: &[Arc<dyn Boundary<D>>], times: [f64; 2]) -> f64 {
        if !boundaries.iter().any(|own| own.moves()) {
            return 0.0;
        }
        let shift = |chain: &Chain, time: f64| {
            let links = chain.links.iter();
            let whole = links.fold(Transform::identity(), |whole, &[b, k]| {
                whole.then(&boundaries[b].transform(k, time).to_scalar())
            });
            whole.point(&[T::zero(); D]).map(Real::to_f64)
        };
        let moved = self.chains.iter().map(|chain| {
            let [then, now] = times.map(|time| shift(chain, time));
            (0..D).map(|d| (now[d] - then[d]).powi(2)).sum::<f64>()
        });
        moved.fold(0.0, f64::max).sqrt()
    }
}
