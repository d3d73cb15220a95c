//! What an error took, between the runs that were measured: no law, and so a number that a gate can hold to a few per cent.
//! In pairs or steps no machine changes it.

use super::plot::Column;
use super::refusal::Refusal;
use super::report::View;

impl View<'_> {
    /// What a method took for this error, in pairs, steps, seconds or any other column: between the two measured runs around
    /// it, straight in logarithms. Where errors do not fall all the way it is the last passage of that error
    /// on the way to the finest run, since an error that grows again was small by luck.
    ///
    /// Counts depend on the scene, the method and the arithmetic alone, so a test can hold them to a few per cent, where a
    /// time cannot be held to any.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// use meshfree::study::work_precision::{Column, Outcome, Quantity, WorkPrecision};
    /// let report = WorkPrecision::new("rods", |case| {
    ///     let rod = |name, x| Body::block(name, catalogue::copper(), [x], [x + 0.01], case.spacing());
    ///     let mut rods = Scene::<f64, 1>::new(schemes::impact())
    ///         .body(rod("striker", 0.0).velocity([20.0]))
    ///         .body(rod("target", 0.01))
    ///         .build()?;
    ///     rods.run_until(2e-6)?;
    ///     let left = rods.all().map(|p| p.mass() * p.velocity()[0].powi(2)).sum::<f64>();
    ///     Ok(Outcome::of(&rods).value("kinetic energy", left))
    /// })
    /// .quantity(Quantity::richardson("kinetic energy"))
    /// .spacings([4e-4, 2e-4, 1e-4])
    /// .run()?;
    /// let view = report.first();
    /// let [coarse, _, fine] = report.rows() else { unreachable!() };
    /// let error = view.error(fine).zip(view.error(coarse)).map(|(a, b)| (a * b).sqrt());
    /// let pairs = view.work_at("as it is", Column::Pairs, error.unwrap())?;
    /// assert!(pairs > coarse.work.pairs as f64 && pairs < fine.work.pairs as f64);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`Refusal::NotAround`] if no two runs of the method lie around the error, or one of them lacks the column.
    pub fn work_at(&self, method: &str, column: Column, error: f64) -> Result<f64, Refusal> {
        let pilots = self.pilots(method);
        let ends = |own: fn(f64, f64) -> f64, start| {
            let errors = pilots.iter().map(|(_, error)| *error);
            errors.fold(start, own)
        };
        let refusal = || Refusal::NotAround {
            wanted: error,
            least: ends(f64::min, f64::INFINITY),
            largest: ends(f64::max, 0.0),
        };
        let around = pilots
            .windows(2)
            .rev()
            .find(|two| two[0].1 > error && two[1].1 <= error);
        let [(coarse, above), (fine, below)] = around.ok_or_else(refusal)? else {
            return Err(refusal());
        };
        // An error that has grown beyond it since is not reached.
        if pilots.last().is_some_and(|(_, last)| *last > error) || *below <= 0.0 {
            return Err(refusal());
        }
        let read = |row| self.read(row, column).ok_or_else(refusal);
        let (few, many) = (read(coarse)?, read(fine)?);
        let share = (above / error).ln() / (above / below).ln();
        Ok(few * (many / few).powf(share))
    }
}
