//! Dam breaks: the scales in which experiments are printed, and Ritter's flow on a dry bed.
//! The flow is exact for shallow water; the fronts of columns stay behind its own.
//!
//! A column of width a and height h \[m\] stands at the rear wall of a tank. Fronts are printed as
//! x/a over t√(gh)/a, which is t√(2g/a) where h = 2a; the height at the rear wall as η/h over t√(g/a)
//! (J. C. Martin, W. J. Moyce, *Philosophical Transactions of the Royal Society A* 244 (1952)
//! 312–324); pressures on the wall that the front meets as p/(ρgh) over t√(g/h) (L. Lobovský et al.,
//! *Journal of Fluids and Structures* 48 (2014) 407–434). [`Column`] gives the units.
//!
//! In shallow water a dam at x = 0 that vanishes at t = 0 leaves, with c = √(gh) and −c ≤ x/t ≤ 2c,
//!
//! ```text
//! depth = (2c − x/t)²/(9g)      velocity = (2/3)(c + x/t)
//! ```
//!
//! (A. Ritter, *Zeitschrift des Vereines Deutscher Ingenieure* 36 (1892) 947–954.) The front runs at
//! 2c from the first moment. Shallow water knows no vertical acceleration and here no friction; a
//! column has to turn its fall into motion along the bed first.
//!
//! ```
//! use meshfree::study::dam_break::Column;
//! let column = Column::new(0.05715, 0.1143)?;
//! let t = 1.19 * column.front_time_unit();
//! assert!((t - 0.0642).abs() < 1e-4);
//! // The measured front is then at x/a = 1.44, counted from the rear wall.
//! assert!(1.44 < 1.0 + column.ritter_front(t) / column.width());
//! # Ok::<(), meshfree::study::StudyError>(())
//! ```

use super::{StudyError, positive, within};

/// A column of liquid behind a dam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Column {
    width: f64,
    height: f64,
    gravity: f64,
}

/// Shallow water at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct ShallowWater {
    /// Depth \[m\].
    pub depth: f64,
    /// Velocity along the bed \[m/s\].
    pub velocity: f64,
}

impl Column {
    /// A column of `width` a and `height` h \[m\] under 9.81 m/s².
    ///
    /// # Errors
    /// If a value is not larger than zero.
    pub fn new(width: f64, height: f64) -> Result<Self, StudyError> {
        Ok(Self {
            width: positive("width of the column [m]", width)?,
            height: positive("height of the column [m]", height)?,
            gravity: 9.81,
        })
    }
    /// The column under another gravity g \[m/s²\].
    ///
    /// # Errors
    /// If it is not larger than zero.
    pub fn with_gravity(self, gravity: f64) -> Result<Self, StudyError> {
        Ok(Self {
            gravity: positive("gravity [m/s²]", gravity)?,
            ..self
        })
    }
    /// Width a \[m\], the unit of the place of the front.
    #[must_use]
    pub fn width(&self) -> f64 {
        self.width
    }
    /// Height h \[m\], the unit of the height at the rear wall.
    #[must_use]
    pub fn height(&self) -> f64 {
        self.height
    }
    /// Unit a/√(gh) \[s\] of the time of the front; √(a/(2g)) where h = 2a.
    #[must_use]
    pub fn front_time_unit(&self) -> f64 {
        self.width / self.wave_speed()
    }
    /// Unit √(a/g) \[s\] of the time of the height at the rear wall.
    #[must_use]
    pub fn height_time_unit(&self) -> f64 {
        (self.width / self.gravity).sqrt()
    }
    /// Unit √(h/g) \[s\] of the time of the pressure on the opposite wall.
    #[must_use]
    pub fn pressure_time_unit(&self) -> f64 {
        (self.height / self.gravity).sqrt()
    }
    /// Unit ρgh \[Pa\] of that pressure in a liquid of `density` \[kg/m³\].
    #[must_use]
    pub fn pressure_unit(&self, density: f64) -> f64 {
        density * self.gravity * self.height
    }
    /// Distance 2t√(gh) \[m\] of Ritter's front from the dam at time `t` \[s\].
    #[must_use]
    pub fn ritter_front(&self, t: f64) -> f64 {
        2.0 * self.wave_speed() * t
    }
    /// Ritter's flow at the distance `x` ≥ −a \[m\] from the dam at time `t` > 0 \[s\].
    ///
    /// # Errors
    /// If `x` is behind the column, or `t` is outside 0 to a/√(gh), when the fall of the surface
    /// reaches the rear wall.
    pub fn ritter(&self, x: f64, t: f64) -> Result<ShallowWater, StudyError> {
        within("distance x from the dam [m]", x, -self.width, f64::INFINITY)?;
        positive("time after the dam broke [s]", t)?;
        within(
            "time after the dam broke [s]",
            t,
            0.0,
            self.front_time_unit(),
        )?;
        let c = self.wave_speed();
        let ray = (x / t).max(-c);
        if ray > 2.0 * c {
            return Ok(ShallowWater {
                depth: 0.0,
                velocity: 0.0,
            });
        }
        Ok(ShallowWater {
            depth: (2.0 * c - ray).powi(2) / (9.0 * self.gravity),
            velocity: (c + ray) * 2.0 / 3.0,
        })
    }
    /// √(gh) \[m/s\].
    fn wave_speed(&self) -> f64 {
        (self.gravity * self.height).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::super::check::{reference, slope};
    use super::*;

    #[test]
    fn ritter_flow_satisfies_the_shallow_water_equations() {
        let g = 4.0;
        let column = Column::new(3.0, 1.0).unwrap().with_gravity(g).unwrap();
        let at = |x, t| column.ritter(x, t).unwrap();
        let step = 1e-5;
        for (x, t) in [(-0.5, 0.8), (0.3, 1.0), (1.9, 1.2)] {
            let depth = slope(|t| at(x, t).depth, t, step);
            let flux = slope(|x| at(x, t).depth * at(x, t).velocity, x, step);
            assert!((depth + flux).abs() < 1e-6, "{depth} {flux}");
            let rate = slope(|t| at(x, t).velocity, t, step);
            let rest = slope(
                |x| 0.5 * at(x, t).velocity.powi(2) + g * at(x, t).depth,
                x,
                step,
            );
            assert!((rate + rest).abs() < 1e-6, "{rate} {rest}");
        }
        // Nothing is lost; the flow starts at rest and ends in a front without depth.
        let (n, t) = (20_000, 1.25);
        let dx = (3.0 + column.ritter_front(t)) / f64::from(n);
        let volume: f64 = (0..n)
            .map(|k| at(-3.0 + (f64::from(k) + 0.5) * dx, t).depth * dx)
            .sum();
        assert!((volume - 3.0).abs() < 1e-6, "{volume}");
        let still = at(-2.9, t);
        assert!((still.depth - 1.0).abs() < 1e-12 && still.velocity.abs() < 1e-12);
        assert!(at(column.ritter_front(t) - 1e-6, t).depth < 1e-12);
        assert_eq!(at(6.0, t).depth, 0.0);
    }

    #[test]
    fn measured_fronts_stay_behind_that_of_ritter() {
        let name = "dambreak2d_front/martin_moyce_table2_front.csv";
        let Some(table) = reference("measured_fronts_stay_behind_that_of_ritter", name) else {
            return;
        };
        let column = Column::new(0.05715, 0.1143).unwrap();
        assert_eq!(table.rows.len(), 15);
        for row in &table.rows {
            let front = column.ritter_front(row[0] * column.front_time_unit());
            let measured = (row[1] - 1.0) * column.width();
            assert!(
                measured < front && measured > 0.1 * front,
                "{measured} {front}"
            );
        }
    }

    #[test]
    fn units_are_those_of_the_papers() {
        // T = t√(2g/a) with a = 57.15 mm, and t√(g/h), ρgh with h = 0.3 m.
        let column = Column::new(0.05715, 0.1143).unwrap();
        let unit = (0.05715f64 / (2.0 * 9.81)).sqrt();
        assert!((column.front_time_unit() / unit - 1.0).abs() < 1e-12);
        assert!((column.height_time_unit() / (unit * 2.0f64.sqrt()) - 1.0).abs() < 1e-12);
        let tank = Column::new(0.6, 0.3).unwrap();
        assert!((tank.pressure_time_unit() - 0.174_874).abs() < 1e-6);
        assert!((tank.pressure_unit(997.0) - 2934.171).abs() < 1e-3);
    }

    #[test]
    fn values_without_an_answer_are_refused() {
        let column = Column::new(1.0, 1.0).unwrap();
        for (x, t) in [(-1.1, 0.1), (0.0, 0.0), (0.0, 1.0), (f64::NAN, 0.1)] {
            assert!(column.ritter(x, t).is_err(), "{x} {t}");
        }
        assert!(Column::new(1.0, 0.0).is_err());
        assert!(column.with_gravity(-9.81).is_err());
    }
}
