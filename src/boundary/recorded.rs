//! Motions from rows: of time and displacement, or of time and angle.
//! A cubic spline goes through them, so that acceleration is continuous whatever their interval.

use super::spline::{Ends, Spline};
use super::{Motion, Pose, Rotation, Translation};
use crate::error::{Error, Problem, Result};
use crate::output::hash::Hash;
use std::sync::Arc;

/// A motion from rows of time \[s\] and displacement \[m\], or of time and angle \[rad\].
///
/// A cubic spline goes through the rows: place, velocity and acceleration are continuous, the place converges with the
/// fourth power of the interval of rows and the acceleration with the second (de Boor 1978, A Practical Guide to
/// Splines, chapter IV). Straight pieces between rows would have a velocity that jumps at every row, and forces that
/// grow as intervals shrink.
///
/// | time | what it does |
/// |---|---|
/// | between the rows | follows the spline, whose outermost two intervals share one cubic: exact for cubics |
/// | before the first and after the last row | there is none: a run that goes there ends with an error |
/// | the same, [`at_rest_beyond`](Self::at_rest_beyond) | rests where the first or last row is; the spline begins and ends with zero velocity |
///
/// A displacement is counted from where things are built. Of a record of places take the first one away. Several records
/// [compose](super::Composed).
///
/// ```
/// use meshfree::boundary::{Motion, Recorded};
/// // A piston that swings with 1.2 s, from rows every 0.05 s.
/// let stroke = |t: f64| 0.1 * (1.0 - (2.0 * std::f64::consts::PI * t / 1.2).cos());
/// let rows: Vec<(f64, [f64; 2])> = (0..=48)
///     .map(|k| 0.05 * f64::from(k))
///     .map(|t| (t, [stroke(t), 0.0]))
///     .collect();
/// let piston = Recorded::translation(&rows)?.at_rest_beyond();
/// let [x, _] = piston.pose(0.62).of(0, &[0.0, 0.3]);
/// assert!((x - stroke(0.62)).abs() < 1e-5);
/// // Every other row alone would change it by this part of its amplitude.
/// assert!(piston.resolution().is_some_and(|off| off < 0.01));
/// # Ok::<(), meshfree::error::Error>(())
/// ```
///
/// # Resolution
/// [`Motion::resolution`] is how far the spline through every other row passes the rows in between at most, over half
/// the range of the rows. A sine with 40 rows in a period has 0.0001, with 20 rows 0.0025, with 16 rows 0.007 and with 12
/// rows 0.03. With 12 rows the greatest acceleration is 2.3 % high, with 8 rows 5.2 %.
/// [`Scene::advise`](crate::scene::Scene::advise) warns from 0.01 on, and calls an error of 0.1 or more
/// impossible. The estimate needs eight rows.
pub struct Recorded<const D: usize> {
    moved: Box<dyn Motion<D>>,
    /// The same, through rows that end at rest.
    at_rest: Box<dyn Motion<D>>,
    is_at_rest: bool,
    name: String,
    span: [f64; 2],
    resolution: Option<f64>,
}

/// What no number of a record reaches, so that splines through rows are numbers.
const MOST: f64 = 1e100;

/// How much faster than its neighbours an interval is that jumps.
const FASTER: f64 = 10.0;

/// The least part of the range of a record that counts as a jump.
const LEAST: f64 = 0.01;

/// Amplitude of rows that are the same but for rounding, over the largest number in them.
const SAME: f64 = 1e-12;

/// How far beyond its rows a time still counts as within, for rounding, over the length of the record.
const ROUNDING: f64 = 1e-9;

impl<const D: usize> Recorded<D> {
    /// A translation, by rows of time \[s\] and displacement \[m\].
    ///
    /// # Errors
    /// [`Error::Argument`] with the number of the row, the first being 1: if there are fewer than four rows, a number is
    /// not finite, a time is not later than the one before, or the motion jumps. It jumps where the speed
    /// between two rows is more than ten times that of the two intervals before and after (or of the interval on
    /// the one side at an end), or where a single row is passed to and fro so fast, if the way is more than a hundredth of
    /// the range of the record.
    pub fn translation(rows: &[(f64, [f64; D])]) -> Result<Self> {
        Self::new("translation", "displacement", rows, |spline| {
            let path = |order: usize| {
                let spline = spline.clone();
                move |time: f64| spline.at(order, time)
            };
            Box::new(Translation::new(path(0), path(1), path(2)))
        })
    }

    /// A rotation about `centre` \[m\] in the plane of the first two axes, by rows of time \[s\] and angle \[rad\], which is
    /// positive from the first axis towards the second and goes on beyond a full turn.
    ///
    /// # Errors
    /// As [`translation`](Self::translation).
    pub fn rotation(centre: [f64; D], rows: &[(f64, f64)]) -> Result<Self> {
        Self::new("rotation", "angle", &columns(rows), |spline| {
            let angle = move |time: f64| [0, 1, 2].map(|order| spline.at(order, time)[0]);
            Box::new(Rotation::about(centre, angle))
        })
    }

    fn new<const W: usize>(
        kind: &str,
        what: &str,
        rows: &[(f64, [f64; W])],
        of: impl Fn(Arc<Spline<W>>) -> Box<dyn Motion<D>>,
    ) -> Result<Self> {
        check(what, rows)?;
        let [free, at_rest] = [Ends::Free, Ends::AtRest].map(|ends| Spline::new(rows, ends));
        if !(free.is_finite() && at_rest.is_finite()) {
            let must_be = "its spline must be finite: check that times are in seconds and not too close to each \
            other";
            return refuse(what, "number of rows", rows.len() as f64, must_be);
        }
        let mut hash = Hash::new();
        for (time, own) in rows {
            hash.numbers(core::iter::once(time).chain(own));
        }
        let span = [rows[0].0, rows[rows.len() - 1].0];
        Ok(Self {
            moved: of(Arc::new(free)),
            at_rest: of(Arc::new(at_rest)),
            is_at_rest: false,
            name: format!(
                "{kind} from {} rows, {} s to {} s, hash {:016x}",
                rows.len(),
                span[0],
                span[1],
                hash.value()
            ),
            span,
            resolution: resolution(rows),
        })
    }

    /// Rests before the first row and after the last, where these are; velocity is zero at both, and continuous. For what
    /// starts and ends at rest: the spline through rows of another motion would bend to rest within an interval.
    #[must_use]
    pub fn at_rest_beyond(mut self) -> Self {
        self.is_at_rest = true;
        self.name += ", at rest beyond";
        self
    }
}

impl Recorded<3> {
    /// A rotation about the line through `point` \[m\] along `axis`, of any length, by rows of time \[s\] and angle
    /// \[rad\], positive by the rule of the right hand.
    ///
    /// # Errors
    /// As [`translation`](Self::translation) and [`Rotation::about_axis`].
    pub fn rotation_about(point: [f64; 3], axis: [f64; 3], rows: &[(f64, f64)]) -> Result<Self> {
        let at_rest = Rotation::about_axis(point, axis, |_| [0.0; 3])?;
        let kind = format!("rotation about {:?}", at_rest.axis());
        Self::new(&kind, "angle", &columns(rows), |spline| {
            let angle = move |time: f64| [0, 1, 2].map(|order| spline.at(order, time)[0]);
            Box::new(Rotation::about(point, angle).along(&at_rest))
        })
    }
}

impl<const D: usize> Motion<D> for Recorded<D> {
    fn name(&self) -> String {
        self.name.clone()
    }
    fn pose(&self, time: f64) -> Pose<D> {
        self.pose_from(&[0.0; D], time)
    }
    fn pose_from(&self, origin: &[f64; D], time: f64) -> Pose<D> {
        let [first, last] = self.span;
        if self.is_at_rest {
            let mut pose = self.at_rest.pose_from(origin, time.clamp(first, last));
            if time < first || time > last {
                for order in 1..3 {
                    pose.linear[order].fill(0.0);
                    pose.shift[order].fill(0.0);
                }
            }
            return pose;
        }
        let slack = ROUNDING * (last - first);
        if time < first - slack || time > last + slack {
            return Pose::nowhere();
        }
        self.moved.pose_from(origin, time)
    }
    fn span(&self) -> [f64; 2] {
        if self.is_at_rest {
            return [f64::NEG_INFINITY, f64::INFINITY];
        }
        let [first, last] = self.span;
        let slack = ROUNDING * (last - first);
        [first - slack, last + slack]
    }
    fn resolution(&self) -> Option<f64> {
        self.resolution
    }
}

fn columns(rows: &[(f64, f64)]) -> Vec<(f64, [f64; 1])> {
    rows.iter().map(|&(time, angle)| (time, [angle])).collect()
}

fn refuse<V>(what: &str, of: &str, value: f64, must_be: &'static str) -> Result<V> {
    Err(Error::Argument(Problem::Parameter {
        what: format!("{of} of the record of {what}"),
        value,
        must_be,
    }))
}

/// Refuses rows through which no motion goes.
fn check<const W: usize>(what: &str, rows: &[(f64, [f64; W])]) -> Result<()> {
    if rows.len() < 4 {
        let must_be = "it must be at least four, through which a cubic goes";
        return refuse(what, "number of rows", rows.len() as f64, must_be);
    }
    let wrong = |x: &f64| !x.is_finite() || x.abs() >= MOST;
    for (k, (time, own)) in rows.iter().enumerate() {
        if let Some(bad) = own.iter().copied().find(wrong) {
            let must_be =
                "it must be a finite number below 1e100: correct the row, or leave it out";
            return refuse(what, &format!("number in row {}", k + 1), bad, must_be);
        }
        if wrong(time) || (k > 0 && *time <= rows[k - 1].0) {
            let must_be = "it must be finite, in seconds, and later than that of the row before";
            return refuse(what, &format!("time in row {}", k + 1), *time, must_be);
        }
    }
    if let Some((k, ratio)) = jump(rows) {
        let must_be = "it must be below 10: between this row and the one before it the motion jumps; give rows in \
        between, correct the row, or let angles continue beyond a full turn";
        let of = format!("speed up to row {} over that of the rows around it", k + 1);
        return refuse(what, &of, ratio, must_be);
    }
    Ok(())
}

fn size<const W: usize>(numbers: [f64; W]) -> f64 {
    numbers.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Half of the range of rows.
fn amplitude<const W: usize>(rows: &[(f64, [f64; W])]) -> f64 {
    let range = |w: usize| {
        let all = rows.iter().map(|(_, own)| own[w]);
        let [low, high] = all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
            [low.min(x), high.max(x)]
        });
        high - low
    };
    0.5 * size::<W>(core::array::from_fn(range))
}

/// The first row that the motion jumps to, and how much faster than around it.
fn jump<const W: usize>(rows: &[(f64, [f64; W])]) -> Option<(usize, f64)> {
    let steps: Vec<[f64; W]> = rows
        .windows(2)
        .map(|pair| core::array::from_fn(|w| pair[1].1[w] - pair[0].1[w]))
        .collect();
    let speeds: Vec<f64> = steps
        .iter()
        .zip(rows.windows(2))
        .map(|(step, pair)| size(*step) / (pair[1].0 - pair[0].0))
        .collect();
    let least = LEAST * 2.0 * amplitude(rows);
    // The larger speed of up to two intervals on a side of some; none if there are none.
    let before = |k: usize| {
        speeds[k.saturating_sub(2)..k]
            .iter()
            .copied()
            .reduce(f64::max)
    };
    let after = |k: usize| {
        let end = (k + 3).min(speeds.len());
        speeds[(k + 1).min(end)..end]
            .iter()
            .copied()
            .reduce(f64::max)
    };
    let around = |first: usize, last: usize| {
        let sides = before(first).into_iter().chain(after(last));
        sides.fold(0.0, f64::max)
    };
    (0..speeds.len()).find_map(|k| {
        if size(steps[k]) <= least {
            return None;
        }
        // A step, or a row that is passed to and fro.
        let mut ratio = speeds[k] / around(k, k);
        if let (Some(next), Some(back)) = (speeds.get(k + 1), steps.get(k + 1))
            && (0..W).map(|w| steps[k][w] * back[w]).sum::<f64>() < 0.0
            && size(*back) > least
        {
            ratio = ratio.max(next.min(speeds[k]) / around(k, k + 1));
        }
        (ratio > FASTER).then_some((k + 1, ratio))
    })
}

/// How far the spline through every other row passes the others at most, over the amplitude; none of fewer than eight rows, and of rows
/// that are the same but for rounding.
pub(super) fn resolution<const W: usize>(rows: &[(f64, [f64; W])]) -> Option<f64> {
    let half: Vec<_> = rows.iter().copied().step_by(2).collect();
    let amplitude = amplitude(rows);
    let largest = rows
        .iter()
        .flat_map(|row| row.1)
        .fold(0.0, |most: f64, x| most.max(x.abs()));
    if rows.len() < 8 || amplitude <= SAME * largest {
        return None;
    }
    let spline = Spline::new(&half, Ends::Free);
    let last = half.last().map_or(0.0, |row| row.0);
    let off = rows
        .iter()
        .filter(|row| row.0 <= last)
        .map(|(time, own)| {
            let x = spline.at(0, *time);
            size::<W>(core::array::from_fn(|w| x[w] - own[w]))
        })
        .fold(0.0, f64::max);
    Some(off / amplitude)
}

#[cfg(test)]
mod tests {
    use super::super::motion::tests::derivatives_agree;
    use super::*;
    use approx::{assert_abs_diff_eq, assert_relative_eq};

    /// A sine with so many rows a period of 1 s.
    fn sine(per_period: u32, periods: u32) -> Vec<(f64, f64)> {
        let all = 0..=per_period * periods;
        all.map(|k| f64::from(k) / f64::from(per_period))
            .map(|t| (t, 0.3 * (core::f64::consts::TAU * t).sin()))
            .collect()
    }

    fn in_plane(rows: &[(f64, f64)]) -> Vec<(f64, [f64; 2])> {
        rows.iter().map(|&(t, x)| (t, [x, -0.5 * x])).collect()
    }

    #[test]
    fn recorded_motions_carry_their_own_derivatives() {
        let rows = sine(20, 2);
        let moved = Recorded::translation(&in_plane(&rows)).unwrap();
        derivatives_agree(&moved, [0.7, 0.1]);
        derivatives_agree(&moved.at_rest_beyond(), [0.7, 0.1]);
        let turned = Recorded::rotation([0.2, 0.1], &rows).unwrap();
        derivatives_agree(&turned, [0.7, 0.1]);
        let about = Recorded::rotation_about([0.2, 0.1, 0.0], [1.0, 1.0, 0.0], &rows).unwrap();
        derivatives_agree(&about, [0.7, 0.1, 0.9]);
        let plane = Recorded::rotation_about([0.2, 0.1, 0.0], [0.0, 0.0, 3.0], &rows).unwrap();
        let turned = turned.pose(0.33).of(0, &[0.7, 0.1]);
        let about = plane.pose(0.33).of(0, &[0.7, 0.1, 0.9]);
        assert_relative_eq!(turned.as_slice(), &about[..2], max_relative = 1e-14);
    }

    #[test]
    fn beyond_the_rows_there_is_nothing_or_rest() {
        let rows = in_plane(&sine(20, 2));
        let moved = Recorded::translation(&rows).unwrap();
        assert!(moved.pose(2.0).of(0, &[0.0; 2])[0].is_finite());
        assert!(moved.pose(2.001).of(0, &[0.0; 2])[0].is_nan());
        assert!(moved.pose(-0.001).of(0, &[0.0; 2])[0].is_nan());
        assert_abs_diff_eq!(moved.span()[1], 2.0, epsilon = 1e-8);
        let resting = moved.at_rest_beyond();
        for time in [-1.0, 0.0, 2.0, 3.0] {
            let pose = resting.pose(time);
            assert_abs_diff_eq!(pose.of(0, &[0.0; 2])[0], 0.0, epsilon = 1e-14);
            assert_abs_diff_eq!(pose.of(1, &[0.0; 2])[0], 0.0, epsilon = 1e-13);
        }
        assert_eq!(resting.pose(3.0).of(2, &[0.0; 2]), [0.0; 2]);
    }

    #[test]
    fn a_name_knows_every_number_of_the_rows() {
        let mut rows = sine(20, 2);
        let name = |rows: &[(f64, f64)]| Recorded::rotation([0.0; 2], rows).unwrap().name();
        let before = name(&rows);
        rows[7].1 += 1e-12;
        assert_ne!(before, name(&rows));
    }

    #[test]
    fn rows_that_do_not_resolve_a_motion_say_by_how_much() {
        let of = |per_period| {
            let moved = Recorded::rotation([0.0; 2], &sine(per_period, 6)).unwrap();
            moved.resolution().unwrap()
        };
        // The spline through every other row at the middle of a sine with n = 2π/θ of them a period:
        // cos(θ/2) (1 + c/8), c = 12 (1 − cos θ)/(4 + 2 cos θ); a row need not be at the middle of a crest.
        for n in [40_u32, 20, 16, 12] {
            let half = core::f64::consts::TAU / f64::from(n);
            let (m, k) = (half.cos(), (2.0 * half).cos());
            let off = 1.0 - m * (1.0 + 12.0 * (1.0 - k) / (4.0 + 2.0 * k) / 8.0);
            println!("{n} rows a period: {} by {off}", of(n));
            // Near the ends it is larger.
            assert!(of(n) > 0.9 * off && of(n) < 30.0 * off, "{n} {off}");
        }
        let short = Recorded::rotation([0.0; 2], &sine(6, 1)).unwrap();
        assert_eq!(short.resolution(), None);
    }

    #[test]
    fn wrong_rows_are_refused_with_their_number() {
        let message = |rows: &[(f64, f64)]| {
            let made = Recorded::<2>::rotation([0.0; 2], rows);
            made.err().map(|error| error.to_string())
        };
        let with = |row: usize, change: (f64, f64)| {
            let mut rows = sine(20, 1);
            rows[row] = change;
            rows
        };
        let step = |k: u32| (f64::from(k), if k < 4 { 0.0 } else { 1.0 });
        let wrapped = |k: u32| (f64::from(k), (0.3 * f64::from(k)) % core::f64::consts::TAU);
        let wrong = [
            (sine(20, 1)[..3].to_vec(), "number of rows"),
            (with(3, (0.15, f64::NAN)), "number in row 4"),
            (with(3, (0.10, 0.0)), "time in row 4"),
            (with(3, (f64::INFINITY, 0.0)), "time in row 4"),
            (with(0, (f64::NAN, 0.0)), "time in row 1"),
            (with(7, (0.35, 9.0)), "up to row 8"),
            ((0..9).map(step).collect(), "up to row 5"),
            ((0..60).map(wrapped).collect(), "up to row 22"),
        ];
        for (rows, part) in wrong {
            let text = message(&rows);
            assert!(
                text.as_ref().is_some_and(|text| text.contains(part)),
                "{part}: {text:?}"
            );
        }
        // What starts, stops and turns within four rows does not jump.
        for n in [5, 8, 20] {
            assert_eq!(message(&sine(n, 3)), None, "{n}");
        }
        let gaussian = |k: u32| {
            (
                f64::from(k),
                (-0.5 * ((f64::from(k) - 10.0) / 1.5).powi(2)).exp(),
            )
        };
        assert_eq!(message(&(0..20).map(gaussian).collect::<Vec<_>>()), None);
    }
}
