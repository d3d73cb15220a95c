//! The true area of a body's surface, where smoothing rounds its edges.
//! It is given between steps, and stays with the particles.

use crate::effect::{SurfaceHeat, TOTAL_AREA};
use crate::error::{Error, Problem, Result};
use crate::geometry::POSITIVE;
use crate::scalar::Real;
use crate::simulation::Simulation;

impl SurfaceHeat {
    /// Makes the surface of a body have this area \[mᴰ⁻¹\] as it is now: multiplies the [`AREA_FACTOR`](Self::AREA_FACTOR) of its
    /// particles by area/Σ A, and returns that ratio. Smoothing rounds edges: Σ A of a cube of twelve particles a side is 16 % low.
    ///
    /// The factor stays with the particles and is saved with them. What covers a part of the surface at that time, as a wall, counts as no
    /// surface.
    ///
    /// ```
    /// use meshfree::effect::{HeatConduction, SurfaceHeat};
    /// use meshfree::prelude::*;
    /// let conduction = HeatConduction { conductivity: 1.0, specific_heat: 1.0, temperature: 400.0 };
    /// let scheme = schemes::weakly_compressible().with(conduction).with(SurfaceHeat::convection(50.0, 300.0));
    /// let water = catalogue::weakly_compressible_water(1.0);
    /// let mut square = Scene::<f64, 2>::new(scheme)
    ///     .body(Body::block("square", water, [0.0; 2], [0.1; 2], 0.01))
    ///     .build()?;
    /// let factor = SurfaceHeat::set_area(&mut square, "square", 0.4)?;
    /// assert!((1.0..1.15).contains(&factor), "{factor}");
    /// let area = square.ledger().whole.total("area of the surface").unwrap_or(0.0);
    /// assert!((area - 0.4).abs() < 1e-9, "{area}");
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Argument`] if there is no such body, it has no area, or `area` is not positive and finite; those of
    /// [`Simulation::evaluate`].
    pub fn set_area<T: Real, const D: usize>(
        simulation: &mut Simulation<T, D>,
        body: &str,
        area: f64,
    ) -> Result<f64> {
        if !(area.is_finite() && area > 0.0) {
            return Err(Error::Argument(Problem::Parameter {
                what: format!("area of the surface of body `{body}`"),
                value: area,
                must_be: POSITIVE,
            }));
        }
        // An unknown name is told with those that there are.
        simulation.body(body).map(drop)?;
        // Areas are those of an evaluation: with the factors and places as they are.
        simulation.evaluate()?;
        let ledger = simulation.ledger();
        let own = ledger.bodies.iter().find(|(name, _)| name == body);
        let found = own.and_then(|(_, budget)| budget.total(TOTAL_AREA));
        let Some(found) = found.filter(|found| *found > 0.0) else {
            return Err(Error::Argument(Problem::Incompatible {
                what: format!("body `{body}` has no area of a free surface"),
                remedy: "take a scheme with SurfaceHeat, and leave a part of the surface free",
            }));
        };
        let ratio = area / found;
        let field = Self::AREA_FACTOR;
        simulation.set_field(body, field, |_, [factor]: [f64; 1]| [ratio * factor])?;
        simulation.evaluate()?;
        Ok(ratio)
    }
}
