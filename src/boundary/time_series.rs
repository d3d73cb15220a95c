//! A number as a function of time: a constant, a function, or rows of time and value.
//! Rows are joined by a cubic spline.

use super::recorded::resolution;
use super::spline::{Ends, Spline};
use crate::error::{Error, Problem, Result};
use crate::output::hash::Hash;
use core::fmt;
use std::sync::Arc;

/// A number that changes with time, as a flow rate or a pressure does.
///
/// Rows are joined by a cubic spline whose first and second derivatives are continuous (de Boor 1978, A Practical Guide to
/// Splines, chapter IV), as those of [`Recorded`](super::Recorded) motions are: straight pieces would make the liquid's
/// acceleration, and so its pressure, jump at every row. Before the first row and after the last there is no value; a run
/// that goes there ends with an error.
///
/// ```
/// use meshfree::boundary::TimeSeries;
/// let rows: Vec<(f64, f64)> = (0..=20).map(|k| 0.1 * f64::from(k)).map(|t| (t, t.sin())).collect();
/// let flow = TimeSeries::rows(&rows)?;
/// assert!((flow.value(0.55) - 0.55_f64.sin()).abs() < 1e-5);
/// assert_eq!(TimeSeries::from(3.0).value(7.0), 3.0);
/// assert!(TimeSeries::rows(&rows[..3]).is_err());
/// # Ok::<(), meshfree::error::Error>(())
/// ```
#[derive(Clone)]
pub struct TimeSeries {
    kind: Kind,
    name: String,
}

#[derive(Clone)]
enum Kind {
    Constant(f64),
    Function(Arc<dyn Fn(f64) -> f64 + Send + Sync>),
    Rows(Arc<Spline<1>>, [f64; 2], Option<f64>),
}

/// How far beyond its rows a time still counts as within, for rounding, over the length of the record.
const ROUNDING: f64 = 1e-9;

impl TimeSeries {
    /// The spline through rows of time \[s\] and value.
    ///
    /// # Errors
    /// [`Error::Argument`] with the number of the row, the first being 1: if there are fewer than four rows, a number is not
    /// finite, or a time is not later than the one before.
    pub fn rows(rows: &[(f64, f64)]) -> Result<Self> {
        let refuse = |of: String, value: f64, must_be: &'static str| {
            Err(Error::Argument(Problem::Parameter {
                what: format!("{of} of the time series"),
                value,
                must_be,
            }))
        };
        if rows.len() < 4 {
            let must_be = "it must be at least four, through which a cubic goes";
            return refuse("number of rows".into(), rows.len() as f64, must_be);
        }
        for (k, (time, value)) in rows.iter().enumerate() {
            if !value.is_finite() {
                let must_be = "it must be finite: correct the row, or leave it out";
                return refuse(format!("value in row {}", k + 1), *value, must_be);
            }
            if !time.is_finite() || (k > 0 && *time <= rows[k - 1].0) {
                let must_be =
                    "it must be finite, in seconds, and later than that of the row before";
                return refuse(format!("time in row {}", k + 1), *time, must_be);
            }
        }
        let columns: Vec<(f64, [f64; 1])> = rows.iter().map(|&(t, x)| (t, [x])).collect();
        let spline = Spline::new(&columns, Ends::Free);
        if !spline.is_finite() {
            let must_be = "its spline must be finite: check that times are in seconds and not too close to each \
            other";
            return refuse("number of rows".into(), rows.len() as f64, must_be);
        }
        let mut hash = Hash::new();
        hash.numbers(rows.iter().flat_map(|(time, value)| [time, value]));
        let span = [rows[0].0, rows[rows.len() - 1].0];
        Ok(Self {
            name: format!(
                "{} rows, {} s to {} s, hash {:016x}",
                rows.len(),
                span[0],
                span[1],
                hash.value()
            ),
            kind: Kind::Rows(Arc::new(spline), span, resolution(&columns)),
        })
    }

    /// A function of time \[s\]; it should be smooth.
    #[must_use]
    pub fn function(of: impl Fn(f64) -> f64 + Send + Sync + 'static) -> Self {
        Self {
            kind: Kind::Function(Arc::new(of)),
            name: "a function of time".into(),
        }
    }

    /// The value at a time \[s\]; no number beyond the rows.
    #[must_use]
    pub fn value(&self, time: f64) -> f64 {
        match &self.kind {
            Kind::Constant(value) => *value,
            Kind::Function(of) => of(time),
            Kind::Rows(spline, ..) => {
                let [first, last] = self.span();
                if time < first || time > last {
                    return f64::NAN;
                }
                spline.at(0, time)[0]
            }
        }
    }

    /// The times \[s\] between which there is a value.
    #[must_use]
    pub fn span(&self) -> [f64; 2] {
        match &self.kind {
            Kind::Rows(_, [first, last], _) => {
                let slack = ROUNDING * (last - first);
                [first - slack, last + slack]
            }
            _ => [f64::NEG_INFINITY, f64::INFINITY],
        }
    }

    /// An estimate of how far the spline is from what its rows were taken from: how far the spline through every other row passes the
    /// rows in between at most, over half the range of the rows. It is that of [`Recorded`](super::Recorded#resolution) motions, which
    /// lists its size for a sine. None of a constant, a function, fewer than eight rows, and rows that all have one value.
    ///
    /// [`Scene::advise`](crate::scene::Scene::advise) warns from 0.01 on. Rows that meet a period always at the same place, as one row a
    /// period does, look like a constant: no estimate from rows alone sees that.
    ///
    /// ```
    /// use meshfree::boundary::TimeSeries;
    /// let sine = |per_period: u32| {
    ///     let times = (0..=6 * per_period).map(|k| f64::from(k) / f64::from(per_period));
    ///     let rows: Vec<(f64, f64)> = times.map(|t| (t, (std::f64::consts::TAU * t).sin())).collect();
    ///     TimeSeries::rows(&rows)
    /// };
    /// assert!(sine(40)?.resolution().is_some_and(|off| off < 0.01));
    /// assert!(sine(5)?.resolution().is_some_and(|off| off > 0.1));
    /// assert_eq!(TimeSeries::from(3.0).resolution(), None);
    /// # Ok::<(), meshfree::error::Error>(())
    /// ```
    #[must_use]
    pub fn resolution(&self) -> Option<f64> {
        match self.kind {
            Kind::Rows(_, _, resolution) => resolution,
            _ => None,
        }
    }

    /// The constant that is no number, if it is one.
    pub(super) fn bad_constant(&self) -> Option<f64> {
        match self.kind {
            Kind::Constant(value) if !value.is_finite() => Some(value),
            _ => None,
        }
    }
}

impl From<f64> for TimeSeries {
    /// The same value at all times.
    fn from(value: f64) -> Self {
        Self {
            kind: Kind::Constant(value),
            name: value.to_string(),
        }
    }
}

impl fmt::Display for TimeSeries {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.name)
    }
}

impl fmt::Debug for TimeSeries {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.name)
    }
}

#[cfg(test)]
mod tests {
    use super::TimeSeries;
    use approx::assert_abs_diff_eq;

    #[test]
    fn rows_are_met_and_wrong_ones_are_named() {
        let rows: Vec<(f64, f64)> = (0..6).map(|k| (f64::from(k), f64::from(k * k))).collect();
        let series = TimeSeries::rows(&rows).unwrap();
        for (t, x) in &rows {
            assert_abs_diff_eq!(series.value(*t), *x, epsilon = 1e-12);
        }
        // A parabola is a cubic.
        assert_abs_diff_eq!(series.value(2.5), 6.25, epsilon = 1e-12);
        assert!(series.value(5.1).is_nan() && series.value(-0.1).is_nan());
        let refused = |row: usize, with: (f64, f64), named: &str| {
            let mut rows = rows.clone();
            rows[row] = with;
            let error = TimeSeries::rows(&rows).unwrap_err().to_string();
            assert!(error.contains(named), "{error}");
        };
        refused(2, (2.0, f64::NAN), "value in row 3");
        refused(3, (2.0, 9.0), "time in row 4");
        let few = TimeSeries::rows(&rows[..3]).unwrap_err().to_string();
        assert!(
            few.contains("number of rows of the time series is 3"),
            "{few}"
        );
        assert_ne!(
            series.to_string(),
            TimeSeries::rows(&rows[..5]).unwrap().to_string()
        );
    }
}
