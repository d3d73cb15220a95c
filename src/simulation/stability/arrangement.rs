//! How particles are arranged: nearest neighbours, clumping, anisotropy, those without neighbours, and noise.
//! Read from the neighbour lists at hand, chunk by chunk.

use super::super::group::Group;
use crate::collective::{Collective, Join, Least, over_pieces};
use crate::geometry::edge;
use crate::neighbors::CHUNK;
use crate::parallel::runs;
use crate::particles::{Columns, Field};
use crate::scalar::{Lane, Real};
use crate::sweep::Transform;

/// Bins of the distances of nearest neighbours, which reach to two spacings.
const BINS: usize = 128;
/// Farthest neighbours that count, in local spacings: between the second and the third of a square lattice.
const NEAR: f64 = 1.6;
/// Offset of the centre of the near neighbours, in units of their distance, from which on a particle is at a surface.
const SURFACE: f64 = 0.25;

/// The arrangement of particles at one time. Distances are in units of the local spacing (m/ρ)^(1/D), so that gas that a
/// shock compresses counts as well arranged, and images behind planes of symmetry do not count as neighbours to be near
/// to. A nearest neighbour farther than two spacings counts as two.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Arrangement {
    /// Smallest distance of two particles.
    pub nearest: f64,
    /// The distance of nearest neighbours below which one in a thousand particles is.
    pub quantile: f64,
    /// Mean distance of nearest neighbours.
    pub mean: f64,
    /// Share of particles whose nearest neighbour is within half a spacing.
    pub close: f64,
    /// Mean over particles inside of |A − tr A/D|/|A| √(D/(D−1)), A = Σ w r rᵀ/r²: 0 of a lattice, 1 of a line; 0 in 1D.
    pub anisotropy: f64,
    /// Share of particles with fewer than 2 D neighbours within 1.6 spacings.
    pub sparse: f64,
    /// Particles without any neighbour within two spacings.
    pub alone: u64,
    /// Root mean square of v − v̄ over that of v, with the mean v̄ of near neighbours.
    pub noise: f64,
    /// The slot of the one with the smallest distance, and its group.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(super) at: (usize, usize),
}

/// The smallest distance and its slot; nearest neighbours by their distance; particles, those alone, with few neighbours and
/// inside; and sums of distances, anisotropies, noise and speed.
type Sums = (Least, [u64; BINS + 1], [u64; 4], [f64; 4]);

/// Those of the particles of one chunk of lists.
fn sums_of<T: Real, const D: usize>(group: &Group<T, D>, chunk: usize, rows: usize) -> Sums {
    let (particles, neighborhood) = (&group.particles, &group.neighborhood);
    let (mut least, mut bins) = (Least::NONE, [0; BINS + 1]);
    let [mut count, mut alone, mut sparse, mut inside] = [0; 4];
    let [mut distance, mut anisotropy, mut noise, mut speed] = [0.0; 4];
    let width = <T::Wide<false> as Lane>::WIDTH;
    let columns = &particles.columns;
    let positions = columns.vectors(Field::POSITION);
    let velocities = columns.vectors(Field::VELOCITY);
    for row in chunk * CHUNK..chunk * CHUNK + rows {
        let first = row * width;
        if first >= particles.mobile {
            break;
        }
        let body = &particles.bodies[particles.body_of(first)];
        for slot in first..(first + width).min(body.slots.end) {
            let x = positions[slot];
            let v = velocities[slot].map(Real::to_f64);
            let own = local_spacing(columns, slot);
            let mut nearest = f64::INFINITY;
            let (mut near, mut weights) = (0, 0.0);
            let (mut offset, mut mean) = ([0.0; D], [0.0; D]);
            let mut moment = [[0.0; D]; D];
            for entry in neighborhood.of(slot) {
                let r = entry.from(&x, positions);
                let r2: f64 = r.iter().map(|r| r * r).sum();
                let mobile = entry.slot < particles.mobile;
                let spacing = if mobile {
                    0.5 * (own + local_spacing(columns, entry.slot))
                } else {
                    own
                };
                // Far ones first, which are most.
                if r2 > (2.0 * spacing).powi(2) {
                    continue;
                }
                let q = r2.sqrt() / spacing;
                if mobile && entry.image.is_none_or(shifts) {
                    nearest = nearest.min(q);
                }
                if q < NEAR {
                    near += 1;
                    let weight = 1.0 - q / NEAR;
                    weights += weight;
                    let moved = entry.velocity(velocities);
                    let unit = r.map(|r| r / r2.sqrt().max(f64::MIN_POSITIVE));
                    for a in 0..D {
                        mean[a] += weight * moved[a].to_f64();
                        offset[a] += weight * unit[a];
                        for b in 0..D {
                            moment[a][b] += weight * unit[a] * unit[b];
                        }
                    }
                }
            }
            count += 1;
            alone += u64::from(nearest.is_infinite());
            sparse += u64::from(near < 2 * D);
            least = least.and(Least(nearest, slot));
            let nearest = nearest.min(2.0);
            distance += nearest;
            bins[(0.5 * nearest * BINS as f64) as usize] += 1;
            speed += v.iter().map(|v| v * v).sum::<f64>();
            if weights == 0.0 {
                continue;
            }
            let aside = offset.iter().map(|o| o * o).sum::<f64>().sqrt() / weights;
            if aside < SURFACE && near >= 2 * D {
                inside += 1;
                anisotropy += departure(&moment);
                let differs = |d: usize| (v[d] - mean[d] / weights).powi(2);
                noise += (0..D).map(differs).sum::<f64>();
            }
        }
    }
    let sums = [distance, anisotropy, noise, speed];
    (least, bins, [count, alone, sparse, inside], sums)
}

/// The arrangement of all groups; nothing of no particles.
pub(super) fn arrangement<T: Real, const D: usize>(groups: &[Group<T, D>]) -> Option<Arrangement> {
    let mut all = Collective::<Sums>::new();
    let (mut nearest, mut at) = (f64::INFINITY, (usize::MAX, 0));
    for (index, group) in groups.iter().enumerate() {
        let chunks = group.neighborhood.all_lists().chunks();
        let of_chunk = |chunk, _| sums_of(group, chunk, chunks[chunk].rows());
        let own = over_pieces(runs(0..chunks.len(), 1), of_chunk);
        let Least(least, slot) = own.0;
        if least < nearest {
            (nearest, at) = (least, (slot, index));
        }
        all.add(own);
    }
    let (_, bins, [count, alone, sparse, inside], sums) = all.value();
    let [distance, anisotropy, noise, speed] = sums;
    let mut below = 0;
    let bin = bins.iter().position(|own| {
        below += own;
        below > count / 1000
    });
    let of_bin = |bin: usize| 2.0 * bin as f64 / BINS as f64;
    let share = |some: u64| some as f64 / count.max(1) as f64;
    (count > 0).then(|| Arrangement {
        nearest: nearest.min(2.0),
        quantile: bin.map_or(2.0, of_bin).max(nearest.min(2.0)),
        mean: distance / count as f64,
        close: share(bins[..BINS / 4].iter().sum()),
        anisotropy: anisotropy / inside.max(1) as f64,
        sparse: share(sparse),
        alone,
        noise: (noise / speed.max(f64::MIN_POSITIVE)).sqrt(),
        at,
    })
}

/// Whether a transform shifts alone, as that of a period does.
fn shifts<T: Real, const D: usize>(by: &Transform<T, D>) -> bool {
    by.rotation == Transform::<T, D>::identity().rotation
}

/// The local spacing \[m\] of a slot.
fn local_spacing<T: Real, const D: usize>(columns: &Columns<T, D>, slot: usize) -> f64 {
    let [mass, density] = [Field::MASS, Field::DENSITY].map(|f| columns.raw(f)[slot].to_f64());
    edge::<D>(mass / density)
}

/// |A − tr A/D|/tr A √(D/(D − 1)): zero of a multiple of the unit tensor, one of a single direction.
fn departure<const D: usize>(moment: &[[f64; D]; D]) -> f64 {
    if D == 1 {
        return 0.0;
    }
    let trace: f64 = (0..D).map(|d| moment[d][d]).sum();
    let mut square = 0.0;
    for a in 0..D {
        for b in 0..D {
            let even = if a == b { trace / D as f64 } else { 0.0 };
            square += (moment[a][b] - even).powi(2);
        }
    }
    (square * D as f64 / (D as f64 - 1.0)).sqrt() / trace.max(f64::MIN_POSITIVE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn departure_is_zero_of_a_lattice_and_one_of_a_line() {
        assert!(departure(&[[3.0, 0.0], [0.0, 3.0]]).abs() < 1e-15);
        assert!((departure(&[[2.0, 0.0], [0.0, 0.0]]) - 1.0).abs() < 1e-15);
        let slanted = [[1.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0; 3]];
        assert!((departure(&slanted) - 1.0).abs() < 1e-15);
        assert_eq!(departure(&[[1.0]]), 0.0);
    }
}
