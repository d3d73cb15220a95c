//! The linear system of joints: bodies that move, rows of constraints between them, and its direct solution.
//! Small and dense: multipliers follow exactly, so there is no tolerance that a run depends on.

use super::joint_rows::{Frame, Row};
use super::rigid::Rigid;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn, Vector3};

type V = Vector3<f64>;

/// Newton steps after which a drift is given up; a step that is not too long takes four.
const NEWTON: usize = 30;
/// The residual, over the size of its parts, at which Newton's method ends where it gains no more.
const HELD: f64 = 1e-10;
/// The square of the share of a constraint that others must leave free.
const INDEPENDENT: f64 = 1e-11;

/// A body of joints: how it stands and moves.
pub(super) struct Mover<'a, const D: usize> {
    pub rigid: &'a Rigid<D>,
    pub frame: Frame,
    pub momenta: [V; 2],
    /// Whether a clamp moves it.
    pub driven: bool,
    /// In how many moves its group drifts.
    pub moves: u32,
}

impl<const D: usize> Mover<'_, D> {
    /// What an impulse and its moment change of velocity and spin where it is turned as in a frame.
    pub fn answer(&self, frame: &Frame, [force, moment]: [V; 2]) -> [V; 2] {
        if self.driven {
            return [V::zeros(); 2];
        }
        [
            force / self.rigid.mass,
            self.rigid.answer_at(&frame.turn, &moment),
        ]
    }

    /// Its velocity and spin.
    pub fn motion(&self) -> [V; 2] {
        self.motion_with(self.momenta)
    }

    /// The same with other momenta.
    pub fn motion_with(&self, [momentum, spin]: [V; 2]) -> [V; 2] {
        let turning = self.rigid.answer_at(&self.frame.turn, &spin);
        [momentum / self.rigid.mass, turning]
    }

    /// Its momenta after an impulse and its moment.
    pub fn pushed(&self, [impulse, moment]: [V; 2]) -> [V; 2] {
        if self.driven {
            return self.momenta;
        }
        [self.momenta[0] + impulse, self.momenta[1] + moment]
    }

    /// Where it is after a drift over `dt` \[s\] that begins with an impulse.
    pub fn moved(&self, impulse: [V; 2], dt: f64) -> Frame {
        let [momentum, spin] = self.pushed(impulse);
        let (mut frame, part) = (self.frame, dt / f64::from(self.moves));
        for _ in 0..self.moves {
            frame.centre += part * momentum / self.rigid.mass;
            frame.turn = self.rigid.rotated(frame.turn, &spin, part);
        }
        frame
    }
}

/// A row of the system: of which joint, between which movers, and how fast its value is to change.
pub(super) struct Line {
    pub row: Row,
    pub joint: usize,
    pub ends: [Option<usize>; 2],
    pub drive: f64,
    pub is_motor: bool,
}

impl Line {
    /// What a unit of it does to one end.
    pub fn on(&self, side: usize) -> [V; 2] {
        let sign = [1.0, -1.0][side];
        [sign * self.row.linear, sign * self.row.angular[side]]
    }

    /// Its rate with the motions of the movers.
    pub fn rate(&self, motions: &[[V; 2]]) -> f64 {
        let of = |side: usize| {
            let [n, a] = self.on(side);
            self.ends[side].map_or(0.0, |k| n.dot(&motions[k][0]) + a.dot(&motions[k][1]))
        };
        of(0) + of(1)
    }
}

/// J M⁻¹ Jᵀ, with the rows `left` and the columns `right`, at frames of the movers.
pub(super) fn matrix<const D: usize>(
    [left, right]: [&[Line]; 2],
    movers: &[Mover<'_, D>],
    frames: &[Frame],
) -> DMatrix<f64> {
    let answers: Vec<[[V; 2]; 2]> = right
        .iter()
        .map(|line| {
            core::array::from_fn(|side| {
                let none = [V::zeros(); 2];
                line.ends[side].map_or(none, |k| movers[k].answer(&frames[k], line.on(side)))
            })
        })
        .collect();
    DMatrix::from_fn(left.len(), right.len(), |k, l| {
        let mut sum = 0.0;
        for side in 0..2 {
            for other in 0..2 {
                if left[k].ends[side].is_some() && left[k].ends[side] == right[l].ends[other] {
                    let ([n, a], [v, w]) = (left[k].on(side), answers[l][other]);
                    sum += n.dot(&v) + a.dot(&w);
                }
            }
        }
        sum
    })
}

/// What each mover gets by some lines with these multipliers: impulse and moment.
pub(super) fn with(lines: &[Line], multipliers: &[f64], movers: usize) -> Vec<[V; 2]> {
    let mut all = vec![[V::zeros(); 2]; movers];
    for (line, multiplier) in lines.iter().zip(multipliers) {
        for side in 0..2 {
            if let Some(k) = line.ends[side] {
                let [n, a] = line.on(side);
                all[k][0] += *multiplier * n;
                all[k][1] += *multiplier * a;
            }
        }
    }
    all
}

/// A factor of a symmetric matrix that is scaled to a unit diagonal, and the scales.
pub(super) type Factor = (Cholesky<f64, Dyn>, DVector<f64>);

/// The factor of a symmetric matrix, or the first row that depends on those before it.
pub(super) fn factored(mut a: DMatrix<f64>) -> Result<Factor, usize> {
    let scales = DVector::from_fn(a.nrows(), |k, _| a[(k, k)].sqrt().recip());
    if let Some(k) = scales.iter().position(|scale| !scale.is_finite()) {
        return Err(k);
    }
    for k in 0..a.nrows() {
        for l in 0..a.ncols() {
            a[(k, l)] *= scales[k] * scales[l];
        }
    }
    let leading = |size: usize| {
        let factor = Cholesky::new(a.view((0, 0), (size, size)).into_owned())?;
        let pivots = factor.l_dirty().diagonal();
        pivots
            .iter()
            .all(|p| p * p >= INDEPENDENT)
            .then_some(factor)
    };
    match leading(a.nrows()) {
        Some(factor) => Ok((factor, scales)),
        None => Err((1..a.nrows())
            .find(|size| leading(*size).is_none())
            .unwrap_or(a.nrows())
            - 1),
    }
}

/// The solution of the system of a factor.
pub(super) fn solve((factor, scales): &Factor, right: Vec<f64>) -> Vec<f64> {
    let scaled = DVector::from_vec(right).component_mul(scales);
    factor
        .solve(&scaled)
        .component_mul(scales)
        .as_slice()
        .to_vec()
}

/// Why a drift cannot be held: of which line, and why.
type Failed = (usize, &'static str);

/// The impulses along lines at the start of a drift over `dt` \[s\] with which all of them are zero at its end, and the frames there.
/// `at` gives the lines anew where bodies are in other frames. Newton's method, to rounding.
pub(super) fn drift_impulses<const D: usize>(
    movers: &[Mover<'_, D>],
    lines: &[Line],
    at: impl Fn(&[Frame]) -> Vec<Line>,
    dt: f64,
) -> Result<(Vec<f64>, Vec<Frame>), Failed> {
    let mut impulses = vec![0.0; lines.len()];
    let mut before = f64::INFINITY;
    let frames = |impulses: &[f64]| -> Vec<Frame> {
        let given = with(lines, impulses, movers.len());
        let all = movers.iter().zip(given);
        all.map(|(own, given)| own.moved(given, dt)).collect()
    };
    let mut worst = 0;
    for _ in 0..NEWTON {
        let then = frames(&impulses);
        let there = at(&then);
        let residual = |line: &Line| line.row.value.abs() / line.row.scale;
        let size = there.iter().map(residual).fold(0.0, f64::max);
        if size == 0.0 || (size <= HELD && size >= 0.5 * before) {
            return Ok((impulses, then));
        }
        worst = (0..there.len())
            .find(|&k| residual(&there[k]) == size)
            .unwrap_or(0);
        before = size;
        let values = DVector::from_fn(there.len(), |k, _| there[k].row.value / dt);
        let Some(change) = matrix([&there, lines], movers, &then).lu().solve(&values) else {
            return Err((
                worst,
                "its constraints depend on those of others at the end of a step",
            ));
        };
        for (own, change) in impulses.iter_mut().zip(&change) {
            *own -= change;
        }
    }
    Err((
        worst,
        "Newton's method finds no impulse with which it holds at the end of a step",
    ))
}
