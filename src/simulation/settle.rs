//! Laws that are repeated until they have settled, with their sweep: on the particles alone that have not.
//! Smoothing lengths that follow the density differ from their prediction at fronts, and hardly elsewhere.

use super::population::BodyState;
use crate::clock::Instant;
use crate::effect::{Around, Chunk, Law, MOST_LAWS, Slices, Tally};
use crate::parallel::GRAIN;
use crate::scalar::Real;
use std::ops::Range;
use std::time::Duration;

/// Slots that settle together: whole clusters of either scalar, and few enough to tell a front from what is around it.
pub(super) const PIECE: usize = 64;

/// Slots of a body that settle together.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    is_open: bool,
    /// Particles at which each law applied a limit when it last acted.
    limited: [u8; MOST_LAWS],
}

const OPEN: Piece = Piece {
    is_open: true,
    limited: [0; MOST_LAWS],
};

/// What has settled and what has not. It keeps its memory from one evaluation to the next.
#[derive(Clone, Debug, Default)]
pub(crate) struct Settling {
    /// Body by body.
    pieces: Vec<Piece>,
    /// The slots of those that have not settled, as few runs as there can be.
    pub(super) open: Vec<Range<usize>>,
}

impl Settling {
    /// Nothing has settled.
    pub(super) fn open_all<T: Real>(&mut self, bodies: &[BodyState<T>]) {
        let count = bodies.iter().map(|body| pieces_of(body)).sum();
        self.pieces.clear();
        self.pieces.resize(count, OPEN);
        self.find_open(bodies);
    }

    /// Finds the slots that have not settled; whether there are any.
    pub(super) fn find_open<T: Real>(&mut self, bodies: &[BodyState<T>]) -> bool {
        self.open.clear();
        let mut pieces = self.pieces.iter();
        for body in bodies {
            let run = body.run();
            for (k, piece) in pieces.by_ref().take(pieces_of(body)).enumerate() {
                let first = run.start + k * PIECE;
                let slots = first..run.end.min(first + PIECE);
                if !piece.is_open {
                    continue;
                }
                match self.open.last_mut() {
                    Some(before) if before.end == slots.start => before.end = slots.end,
                    _ => self.open.push(slots),
                }
            }
        }
        !self.open.is_empty()
    }

    /// The pieces of each body.
    pub(super) fn by_body<'a, T: Real>(
        &'a mut self,
        bodies: &'a [BodyState<T>],
    ) -> impl Iterator<Item = &'a mut [Piece]> {
        let mut rest = self.pieces.as_mut_slice();
        bodies.iter().map(move |body| {
            let (own, behind) = core::mem::take(&mut rest).split_at_mut(pieces_of(body));
            rest = behind;
            own
        })
    }

    /// Particles at which each law applied a limit when it last acted.
    pub(super) fn limited(&self) -> [u64; MOST_LAWS] {
        let mut limited = [0; MOST_LAWS];
        for piece in &self.pieces {
            for (sum, own) in limited.iter_mut().zip(piece.limited) {
                *sum += u64::from(own);
            }
        }
        limited
    }
}

fn pieces_of<T: Real>(body: &BodyState<T>) -> usize {
    body.run().len().div_ceil(PIECE)
}

/// At how many particles a law applied a limit, and how long it took.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Outcome {
    pub limited: u64,
    pub time: Duration,
}

/// Adds the outcomes of other chunks.
pub(super) fn join(outcomes: &mut [Outcome; MOST_LAWS], others: &[Outcome; MOST_LAWS]) {
    for (own, other) in outcomes.iter_mut().zip(others) {
        own.limited += other.limited;
        own.time += other.time;
    }
}

/// Laws over those pieces of a run of slots that have not settled: they have when no law changes anything by more than
/// `tolerance`. Slots before `live` are particles, and the others repeat the last.
pub(super) fn run_pieces<T: Real, const D: usize>(
    laws: &[Box<dyn Law<T, D>>],
    columns: Slices<'_, T>,
    slots: Range<usize>,
    live: usize,
    around: Around<'_, T, D>,
    (pieces, tolerance): (&mut [Piece], f64),
) -> [Outcome; MOST_LAWS] {
    if slots.len() > GRAIN {
        let half = (slots.len() / GRAIN).div_ceil(2) * GRAIN;
        let (low, high) = columns.split(half);
        let (pieces, others) = pieces.split_at_mut(half / PIECE);
        let middle = slots.start + half;
        let run = |columns, slots, pieces| {
            run_pieces(laws, columns, slots, live, around, (pieces, tolerance))
        };
        let (mut outcomes, others) = crate::parallel::join(
            || run(low, slots.start..middle, pieces),
            || run(high, middle..slots.end, others),
        );
        join(&mut outcomes, &others);
        return outcomes;
    }
    let mut outcomes = [Outcome::default(); MOST_LAWS];
    let (mut rest, mut at) = (columns, slots.start);
    for (k, piece) in pieces.iter_mut().enumerate() {
        if !piece.is_open {
            continue;
        }
        let first = slots.start + k * PIECE;
        let end = slots.end.min(first + PIECE);
        let (own, behind) = rest.split(first - at).1.split(end - first);
        (rest, at) = (behind, end);
        let mut chunk = Chunk::new(own, first..end, live, around);
        piece.is_open = false;
        for (n, (law, outcome)) in laws.iter().zip(&mut outcomes).enumerate() {
            let start = Instant::now();
            let Tally { limited, change } = chunk.run(&**law);
            outcome.time += start.elapsed();
            piece.is_open |= change >= tolerance;
            piece.limited[n] = limited.min(PIECE as u64) as u8;
        }
    }
    outcomes
}
