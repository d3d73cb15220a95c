//! What moves towards each other limits the step: no pair may close by more than a share of its distance.
//! Pairs are looked at only where the spread of velocities says that they could.

use super::neighborhood::Neighborhood;
use super::population::Particles;
use super::vote::{Criterion, NO_VOTE, ROUNDED, Vote};
use crate::collective::{Collective, Corners, Join, Least, largest, over, over_pieces};
use crate::neighbors::CHUNK;
use crate::parallel::runs;
use crate::particles::{Field, Fields};
use crate::ranks::Team;
use crate::scalar::{Lane, Mask, OnRows, Real};
use crate::scheme::Scheme;
use crate::sweep::{Ghosts, Image, InstructionSet, Interaction, Records};
use crate::tensor::length;
use std::ops::Range;

/// Distance in spacings that a pair has at least, as far as its step is concerned: spray and gas behind a shock have
/// pairs that are nearer, which kernels do not resolve and which would stop the run.
pub(super) const NEAREST: f64 = 0.5;

/// Closing speed over sound speed from which a weakly compressible liquid is none. Joukowsky's hammer ρ c u then
/// asks for a compression u/c of one, where such a liquid is meant for a hundredth (Monaghan 1994).
pub(super) const FASTEST: f64 = 1.0;

/// Particles of a liquid that close faster than its sound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Meeting {
    /// Closing speed over the mean sound speed of the pair.
    pub mach: f64,
    /// Closing speed \[m/s\].
    pub speed: f64,
    pub slot: usize,
}

/// What the approach of pairs asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Approach {
    pub vote: Vote,
    pub meeting: Option<Meeting>,
}

impl Approach {
    /// What the pairs of all ranks ask for, where each has looked at those of its own chunks and knows all particles.
    pub fn of_all(self, team: &Team) -> Self {
        let mut all = NOTHING;
        let Vote { step, particle, .. } = self.vote;
        let [mach, speed, slot] = self.meeting.map_or([0; 3], |own| {
            [own.mach.to_bits(), own.speed.to_bits(), own.slot as u64]
        });
        let own = [step.to_bits(), particle as u64, mach, speed, slot];
        team.numbers(own, |[step, particle, mach, speed, slot]| {
            let vote = Vote {
                step: f64::from_bits(step),
                criterion: Criterion::Approach,
                particle: particle as usize,
            };
            let [mach, speed] = [mach, speed].map(f64::from_bits);
            let slot = slot as usize;
            let meeting = (mach > 0.0).then_some(Meeting { mach, speed, slot });
            all = all.and(Self { vote, meeting });
        });
        all
    }
}

const NOTHING: Approach = Approach {
    vote: NO_VOTE,
    meeting: None,
};

/// The shorter step and the faster meeting; the lower slot wins a tie.
impl Join for Approach {
    const NONE: Self = NOTHING;
    fn and(self, other: Self) -> Self {
        let faster = |a: Meeting, b: Meeting| {
            if b.mach > a.mach || (b.mach == a.mach && b.slot < a.slot) {
                b
            } else {
                a
            }
        };
        Self {
            vote: self.vote.and(other.vote),
            meeting: match (self.meeting, other.meeting) {
                (Some(a), Some(b)) => Some(faster(a, b)),
                (a, b) => a.or(b),
            },
        }
    }
}

/// The other ranks, and the particles of these that lists name.
#[derive(Clone, Copy)]
pub(super) struct Near<'a, T> {
    pub team: &'a Team,
    pub ghosts: &'a dyn Ghosts<T>,
    /// Images of particles of this rank.
    pub images: &'a [Image],
}

/// The largest step in which no pair closes by more than `share` of its distance, if it is shorter than
/// `limit` \[s\], and the fastest meeting of a liquid with what is faster than its sound; none where no pair can come near in that
/// time. On ranks all look, or none does.
///
/// Pairs that are not listed yet are at least a support apart, and close at most by the spread of velocities.
pub(super) fn approach<T: Real, const D: usize>(
    particles: &Particles<T, D>,
    neighborhood: &Neighborhood<T, D>,
    scheme: &Scheme<T, D>,
    instructions: InstructionSet,
    (share, limit): (f64, f64),
    near: Option<Near<'_, T>>,
) -> Option<Approach> {
    let lengths = particles.columns.raw(Field::SMOOTHING_LENGTH);
    let least_h = if lengths.is_empty() {
        neighborhood.smoothing_length
    } else {
        over(0..lengths.len(), |slot| Least(lengths[slot].to_f64(), slot)).0
    };
    let (mut least_h, mut fastest) = (least_h, fastest(particles, neighborhood));
    if let Some(Near { team, .. }) = near {
        let own = [least_h, fastest].map(f64::to_bits);
        team.numbers(own, |[h, speed]| {
            least_h = least_h.min(f64::from_bits(h));
            fastest = fastest.max(f64::from_bits(speed));
        });
    }
    let bearable = share * NEAREST * least_h / scheme.h_over_dx;
    let harmless = |speed: f64| speed == 0.0 || speed * limit <= bearable;
    let shifted = neighborhood
        .chains
        .transforms
        .iter()
        .fold(0.0_f64, |most, by| most.max(length(&by.velocity).to_f64()));
    if harmless(2.0 * fastest + shifted) {
        return None;
    }
    let range = velocities(particles, neighborhood, near);
    let spread: f64 = range.extent().iter().map(|v| v.powi(2)).sum();
    if harmless(spread.sqrt()) {
        return None;
    }
    let reads = Fields::of(&[Field::POSITION, Field::VELOCITY, Field::SOUND_SPEED]);
    let mut records = Records::default();
    if let Some(Near { ghosts, .. }) = near {
        let images = (
            &neighborhood.images[..],
            &neighborhood.chains.transforms[..],
        );
        records.pack(reads, &particles.columns, Some(ghosts), images, &mut |_| {});
    }
    let places = [Field::POSITION, Field::VELOCITY, Field::SOUND_SPEED];
    let offsets = places.map(|field| reads.offset(field, D));
    let chunks = neighborhood.lists.chunks();
    let in_chunk = |chunk: usize, _| {
        instructions.run(InChunk {
            particles,
            neighborhood,
            scheme,
            rows: chunk * CHUNK..chunk * CHUNK + chunks[chunk].rows(),
            share,
            limit,
            least_h,
            range: range.0,
            records: (records.data(), reads.width(D), offsets),
        })
    };
    Some(over_pieces(runs(0..chunks.len(), 1), in_chunk))
}

/// Slots of bodies and walls, which stand before images.
fn direct<T: Real, const D: usize>(
    particles: &Particles<T, D>,
    neighborhood: &Neighborhood<T, D>,
) -> impl Iterator<Item = Range<usize>> {
    let slots = particles.columns.slots();
    let blocks = neighborhood.blocks.iter().map(|block| block.slots.clone());
    blocks.take_while(move |own| own.end <= slots)
}

/// The largest speed \[m/s\] of bodies and walls.
fn fastest<T: Real, const D: usize>(
    particles: &Particles<T, D>,
    neighborhood: &Neighborhood<T, D>,
) -> f64 {
    let velocities = particles.columns.vectors(Field::VELOCITY);
    let square = |v: &[T; D]| v.iter().map(|v| v.to_f64().powi(2)).sum::<f64>();
    let fastest = |slots: Range<usize>| largest(slots, |slot| square(&velocities[slot]));
    direct(particles, neighborhood)
        .map(fastest)
        .fold(0.0, f64::max)
        .sqrt()
}

/// The least and the largest component of velocities \[m/s\] along each axis, of bodies, walls and images.
fn velocities<T: Real, const D: usize>(
    particles: &Particles<T, D>,
    neighborhood: &Neighborhood<T, D>,
    near: Option<Near<'_, T>>,
) -> Corners<D> {
    let velocities = particles.columns.vectors(Field::VELOCITY);
    let mut all = Collective::new();
    for slots in direct(particles, neighborhood) {
        all.add_range(slots, |slot| {
            Corners::at(velocities[slot].map(Real::to_f64))
        });
    }
    // Of images of all particles each rank has those of its own.
    let images = near.map_or(&neighborhood.images[..], |near| near.images);
    all.add_range(0..images.len(), |k| {
        let by = &neighborhood.chains.transforms[images[k].transform as usize];
        let v = by.velocity_of(&velocities[images[k].source as usize]);
        Corners::at(v.map(Real::to_f64))
    });
    let mut corners = [all.value()];
    if let Some(Near { team, .. }) = near {
        team.join_corners(&mut corners, &mut []);
    }
    let [corners] = corners;
    corners
}

/// What the approach of pairs asks for in one chunk, among the particles that move by forces.
struct InChunk<'a, T: Real, const D: usize> {
    particles: &'a Particles<T, D>,
    neighborhood: &'a Neighborhood<T, D>,
    scheme: &'a Scheme<T, D>,
    rows: Range<usize>,
    share: f64,
    /// The step \[s\] from which on nothing matters.
    limit: f64,
    least_h: f64,
    /// The least and the largest component of velocities.
    range: [[f64; D]; 2],
    /// Records of all that lists name on ranks, numbers of each, and where its place, velocity and sound speed stand.
    records: (&'a [T], usize, [usize; 3]),
}

impl<T: Real, const D: usize> OnRows<T> for InChunk<'_, T, D> {
    type Output = Approach;
    /// Without products that round once, so that steps are the same on every machine.
    #[inline(always)]
    fn run<L: Lane<Scalar = T, Broadcast = T>>(self) -> Approach {
        let Self {
            particles,
            neighborhood,
            scheme,
            rows,
            share,
            limit,
            least_h,
            range,
            records: (records, stride, [place, motion, speed]),
        } = self;
        let width = L::WIDTH;
        let (positions, velocities) = (
            particles.columns.vectors(Field::POSITION),
            particles.columns.vectors(Field::VELOCITY),
        );
        let (sound, lengths) = (
            particles.columns.raw(Field::SOUND_SPEED),
            particles.columns.raw(Field::SMOOTHING_LENGTH),
        );
        let uniform = T::from_f64(neighborhood.smoothing_length);
        let h_of = |slot: usize| lengths.get(slot).copied().unwrap_or(uniform);
        let of_spacing = T::from_f64(NEAREST / scheme.h_over_dx);
        let support = scheme.kernel.support;
        let viscosity = particles.columns.raw(Field::DYNAMIC_VISCOSITY);
        let (zero, sticks) = (L::of(0.0), !viscosity.is_empty());
        // Most pairs do not close so fast that they matter, which products tell without a root and quotients.
        let slowest = L::of(share / limit * (1.0 - ROUNDED));
        let sounds = scheme.meets_walls();
        let quarter = L::of(0.25 * FASTEST * FASTEST * (1.0 - ROUNDED));
        let mut all = NOTHING;
        for row in rows {
            let first = row * width;
            let block = neighborhood
                .blocks
                .partition_point(|b| b.slots.end <= first);
            let live = neighborhood
                .blocks
                .get(block)
                .filter(|b| b.slots.contains(&first));
            let Some(own) = live.filter(|_| first < particles.mobile) else {
                continue;
            };
            let lanes = |of: &dyn Fn(usize) -> T| L::from_fn(|lane| of(first + lane));
            let x: [L; D] = core::array::from_fn(|d| lanes(&|slot| positions[slot][d]));
            let v: [L; D] = core::array::from_fn(|d| lanes(&|slot| velocities[slot][d]));
            let nearest = lanes(&|slot| h_of(slot) * of_spacing);
            let speeds = lanes(&|slot| sound[slot]);
            let (mut rate, mut mach) = (zero, zero);
            for (other, entries) in neighborhood.of_row(row) {
                if neighborhood.interactions[block * neighborhood.blocks.len() + other]
                    == Interaction::None
                {
                    continue;
                }
                let seen = L::of(if sticks && neighborhood.mirrored[other] {
                    0.5
                } else {
                    1.0
                });
                for entry in entries {
                    let (xj, vj, cj) = if records.is_empty() {
                        let (x, v) = (entry.place(positions), entry.velocity(velocities));
                        (x, v, sound[entry.slot])
                    } else {
                        let own = &records[stride * entry.number..][..stride];
                        let vector = |at: usize| core::array::from_fn(|d| own[at + d]);
                        (vector(place), vector(motion), own[speed])
                    };
                    let (mut r2, mut across) = (zero, zero);
                    for d in 0..D {
                        let r = x[d] - L::splat(xj[d]);
                        r2 += r * r;
                        across += r * (v[d] - L::splat(vj[d]));
                    }
                    let towards = (-across).positive_part() * seen;
                    let mut matters = towards.gt(slowest * r2).any();
                    if sounds {
                        let both = speeds + L::splat(cj);
                        matters |= (towards * towards).gt(quarter * (both * both) * r2).any();
                    }
                    if !matters {
                        continue;
                    }
                    let distance = r2.sqrt().max(nearest * L::of(1e-6));
                    let closing = towards / distance;
                    rate = rate.max(closing / distance.max(nearest));
                    // Twice the mean of the sound speeds.
                    mach = mach.max(closing / (speeds + L::splat(cj)));
                }
            }
            for slot in first..own.slots.end.min(first + width) {
                let lane = slot - first;
                let farthest: f64 = (0..D)
                    .map(|d| {
                        let v = velocities[slot][d].to_f64();
                        (v - range[0][d]).max(range[1][d] - v).powi(2)
                    })
                    .sum();
                let apart = 0.5 * support * (h_of(slot).to_f64() + least_h);
                let unseen = farthest.sqrt() / apart;
                let rate = rate.extract(lane).to_f64().max(unseen);
                let mach = 2.0 * mach.extract(lane).to_f64();
                let meets = scheme.meets_walls() && mach > FASTEST;
                all = all.and(Approach {
                    vote: Vote {
                        step: share / rate,
                        criterion: Criterion::Approach,
                        particle: slot,
                    },
                    meeting: meets.then_some(Meeting {
                        mach,
                        speed: mach * sound[slot].to_f64(),
                        slot,
                    }),
                });
            }
        }
        all
    }
}
