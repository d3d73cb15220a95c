//! The buffers of outlets: liquid before a plane takes what the boundary gives, and the rest from the liquid inside.
//! After Tafuni, Domínguez, Vacondio & Crespo 2018 (Comput. Methods Appl. Mech. Engrg. 342, 604).

use super::group::Group;
use crate::boundary::{BEYOND, OpenPlace, Outlet};
use crate::error::{Error, Result};
use crate::neighbors::Cells;
use crate::origin::global;
use crate::particles::Field;
use crate::scalar::Real;

/// The least part of a diagonal that may be left of it for an unknown to be fitted; with less the polynomial does without.
const PIVOT: f64 = 1e-3;

/// Unknowns of a polynomial of second degree in three dimensions.
const MOST: usize = 10;

/// A fit of least squares to values around a place by a polynomial of second degree, which a parabola is.
struct Fit<const D: usize> {
    /// Σ w q qᵀ below and on the diagonal, and Σ w q f, of the monomials q of (x − place)/reach; f is the velocity, and then
    /// the density. D is at most 3.
    matrix: [[f64; MOST]; MOST],
    right: [[f64; 4]; MOST],
}

impl<const D: usize> Fit<D> {
    const UNKNOWNS: usize = (D + 1) * (D + 2) / 2;

    fn new() -> Self {
        Self {
            matrix: [[0.0; MOST]; MOST],
            right: [[0.0; 4]; MOST],
        }
    }

    /// Monomials, the constant first.
    fn monomials(r: &[f64; D]) -> [f64; MOST] {
        let mut q = [0.0; MOST];
        q[0] = 1.0;
        q[1..=D].copy_from_slice(r);
        let mut next = D + 1;
        for a in 0..D {
            for b in 0..=a {
                q[next] = r[a] * r[b];
                next += 1;
            }
        }
        q
    }

    fn add(&mut self, weight: f64, r: &[f64; D], values: [f64; 4]) {
        let q = Self::monomials(r);
        for row in 0..Self::UNKNOWNS {
            let weight = weight * q[row];
            for column in 0..=row {
                self.matrix[row][column] += weight * q[column];
            }
            for (sum, value) in self.right[row].iter_mut().zip(values) {
                *sum += weight * value;
            }
        }
    }

    /// The values at the place; none without any around it.
    fn value(mut self) -> Option<[f64; 4]> {
        if self.matrix[0][0] <= 0.0 {
            return None;
        }
        // L D Lᵀ from the constant on, so that where there are few values the highest degrees are left out.
        let mut kept = [false; MOST];
        for k in 0..Self::UNKNOWNS {
            let diagonal = self.matrix[k][k];
            for j in 0..k {
                let mut own = self.matrix[k][j];
                for i in (0..j).filter(|&i| kept[i]) {
                    own -= self.matrix[k][i] * self.matrix[j][i] * self.matrix[i][i];
                }
                self.matrix[k][j] = if kept[j] {
                    own / self.matrix[j][j]
                } else {
                    0.0
                };
            }
            let mut right = self.right[k];
            for j in (0..k).filter(|&j| kept[j]) {
                let share = self.matrix[k][j];
                self.matrix[k][k] -= share * share * self.matrix[j][j];
                for (own, before) in right.iter_mut().zip(self.right[j]) {
                    *own -= share * before;
                }
            }
            self.right[k] = right;
            kept[k] = self.matrix[k][k] > PIVOT * diagonal;
        }
        let mut solved = [[0.0; 4]; MOST];
        for k in (0..Self::UNKNOWNS).rev().filter(|&k| kept[k]) {
            solved[k] = self.right[k].map(|sum| sum / self.matrix[k][k]);
            for j in (k + 1..Self::UNKNOWNS).filter(|&j| kept[j]) {
                let after = solved[j];
                for (own, after) in solved[k].iter_mut().zip(after) {
                    *own -= self.matrix[j][k] * after;
                }
            }
        }
        Some(solved[0])
    }
}

/// A plane with a buffer before it.
struct Zone<'a, const D: usize> {
    outlet: &'a Outlet<D>,
    point: [f64; D],
    normal: [f64; D],
    depth: f64,
}

impl<'a, const D: usize> Zone<'a, D> {
    fn of(outlet: &'a Outlet<D>) -> Option<Self> {
        let (point, normal, buffer) = outlet.open()?;
        Some(Self {
            outlet,
            point,
            normal,
            depth: buffer.depth,
        })
    }

    /// How far beyond the inner face of the buffer a place is \[m\].
    fn beyond<T: Real>(&self, x: &[T; D]) -> f64 {
        let height = |d: usize| (x[d].to_f64() - self.point[d]) * self.normal[d];
        (0..D).map(height).sum::<f64>() + self.depth
    }
}

impl<T: Real, const D: usize> Group<T, D> {
    /// Gives the liquid in the buffers of outlets its velocity and density at `time` \[s\].
    ///
    /// # Errors
    /// Where a boundary has no state, or its pressure no density.
    pub(super) fn fill_buffers(&mut self, time: f64) -> Result<()> {
        let outlets: Vec<_> = self.outlets.iter().map(|own| own.at(time)).collect();
        outlets.iter().filter_map(Zone::of).try_for_each(|zone| {
            (0..self.particles.bodies.len())
                .try_for_each(|body| self.fill((&zone, &outlets), body, time))
        })
    }

    fn fill(
        &mut self,
        (zone, outlets): (&Zone<'_, D>, &[Outlet<D>]),
        body: usize,
        time: f64,
    ) -> Result<()> {
        let Some((_, _, buffer)) = zone.outlet.open() else {
            return Ok(());
        };
        let state = &*buffer.state;
        let own = &self.particles.bodies[body];
        let refused = |what: &str, value: f64, must_be: &'static str| Error::Function {
            what: format!(
                "{what} in the outlet of body `{}` ({})",
                own.name,
                state.name()
            ),
            value,
            time,
            must_be,
        };
        let [first, last] = state.span();
        if !(first..=last).contains(&time) {
            return Err(refused("state", f64::NAN, BEYOND));
        }
        let reach = self.neighborhood.smoothing_length * self.scheme.kernel.support;
        let columns = &self.particles.columns;
        let x = columns.vectors(Field::POSITION);
        let is_within = |slot: &usize| zone.beyond(&x[*slot]) >= 0.0;
        let within: Vec<usize> = own.slots.clone().filter(is_within).collect();
        let farthest = within.iter().map(|&slot| zone.beyond(&x[slot]));
        let farthest = farthest.fold(0.0, f64::max) + reach;
        let inside: Vec<u32> = own
            .slots
            .clone()
            .filter(|&slot| (-farthest..0.0).contains(&zone.beyond(&x[slot])))
            .filter(|&slot| {
                let mut all = outlets.iter().filter_map(Zone::of);
                all.all(|other| other.beyond(&x[slot]) < 0.0)
            })
            .map(|slot| slot as u32)
            .collect();
        let cells = Cells::build(x, &inside, 0.5 * reach);
        let mut found = Vec::with_capacity(within.len());
        for &slot in &within {
            let holds = |other: &Zone<'_, D>| other.beyond(&x[slot]) >= 0.0;
            if outlets.iter().filter_map(Zone::of).filter(holds).count() > 1 {
                let must_be = "a particle is in the buffers of two outlets, which may not overlap: move one, or make it less deep";
                return Err(refused("state", f64::NAN, must_be));
            }
            let at = x[slot].map(Real::to_f64);
            let place = OpenPlace {
                position: global(&at, &self.particles.origin),
                time,
                inwards: zone.normal.map(|n| -n),
            };
            let (velocity, pressure) = (state.velocity(&place), state.pressure(&place));
            let density = match pressure {
                None => None,
                Some(pressure) if !pressure.is_finite() => {
                    return Err(refused("pressure", pressure, "it must be finite, in Pa"));
                }
                Some(pressure) => {
                    let must_be = "the material must have a density at it: give a pressure within the range of its equation of state";
                    let density = own.material.eos().density_at(pressure, 0.0);
                    Some(density.ok_or_else(|| refused("pressure", pressure, must_be))?)
                }
            };
            if let Some(bad) = velocity.iter().flatten().find(|v| !v.is_finite()) {
                return Err(refused("velocity", *bad, "it must be finite, in m/s"));
            }
            let fitted = if velocity.is_some() && density.is_some() {
                None
            } else {
                self.fit(zone, &cells, &at, reach)
            };
            let fitted_velocity = fitted.map(|own| core::array::from_fn(|d| own[d]));
            found.push((
                velocity.or(fitted_velocity),
                density.or(fitted.map(|own| own[3])),
            ));
        }
        for (slot, (velocity, density)) in within.into_iter().zip(found) {
            for slot in self.particles.bodies[body].with_repeats(slot) {
                if let Some(velocity) = velocity {
                    self.particles.columns.vectors_mut(Field::VELOCITY)[slot] =
                        velocity.map(T::from_f64);
                }
                if let Some(density) = density {
                    self.particles.columns.raw_mut(Field::DENSITY)[slot] = T::from_f64(density);
                }
            }
        }
        Ok(())
    }

    /// The velocity and the density of the liquid inside, at the mirror image of a place \[m\] in the buffer.
    fn fit(
        &self,
        zone: &Zone<'_, D>,
        cells: &Cells<D>,
        at: &[f64; D],
        reach: f64,
    ) -> Option<[f64; 4]> {
        let columns = &self.particles.columns;
        let (x, v) = (
            columns.vectors(Field::POSITION),
            columns.vectors(Field::VELOCITY),
        );
        let (mass, density) = (columns.raw(Field::MASS), columns.raw(Field::DENSITY));
        let back = 2.0 * zone.beyond(at);
        let mirrored: [f64; D] = core::array::from_fn(|d| at[d] - back * zone.normal[d]);
        let mut fit = Fit::<D>::new();
        cells.for_each_run(
            mirrored.map(|x| x - reach),
            mirrored.map(|x| x + reach),
            |run| {
                for &slot in run {
                    let slot = slot as usize;
                    let r: [f64; D] =
                        core::array::from_fn(|d| (x[slot][d].to_f64() - mirrored[d]) / reach);
                    let s = r.iter().map(|r| r * r).sum::<f64>().sqrt();
                    if s >= 1.0 {
                        continue;
                    }
                    // Wendland's kernel C2 over the reach.
                    let weight = (1.0 - s).powi(4) * (1.0 + 4.0 * s);
                    let volume = mass[slot].to_f64() / density[slot].to_f64();
                    let mut values = [0.0; 4];
                    for d in 0..D {
                        values[d] = v[slot][d].to_f64();
                    }
                    values[3] = density[slot].to_f64();
                    fit.add(weight * volume, &r, values);
                }
            },
        );
        fit.value()
    }

    /// Takes forces off the liquid in the buffers of outlets, which keeps its velocity until the next evaluation.
    pub(super) fn free_buffers(&mut self) {
        let (gravity, time) = (self.work.evaluated_gravity, self.work.evaluated_time);
        let outlets: Vec<_> = self.outlets.iter().map(|own| own.at(time)).collect();
        let (mut forces, particles, _) = self.forces(false);
        let columns = &particles.columns;
        let (x, mass) = (columns.vectors(Field::POSITION), columns.raw(Field::MASS));
        for zone in outlets.iter().filter_map(Zone::of) {
            for body in &particles.bodies {
                for slot in body.run().filter(|&slot| zone.beyond(&x[slot]) >= 0.0) {
                    forces.set(slot, core::array::from_fn(|d| -mass[slot] * gravity[d]));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Fit;
    use approx::assert_abs_diff_eq;

    /// Exact for what is parabolic, from one side too, and for what is linear where there are few; the control is the mean.
    #[test]
    fn a_parabola_is_extrapolated() {
        let field = |[x, y]: [f64; 2]| [1.0 + 2.0 * x - y + y * y - x * y, 3.0 * x, 0.0, 5.0 + x];
        let (mut fit, mut row, mut mean) = (Fit::<2>::new(), Fit::<2>::new(), (0.0, 0.0));
        for k in 0..30_i32 {
            let x = [0.1 + 0.1 * f64::from(k % 6), 0.2 * f64::from(k / 6) - 0.35];
            let weight = 1.0 / f64::from(k + 1);
            fit.add(weight, &x, field(x));
            mean = (mean.0 + weight, mean.1 + weight * field(x)[0]);
            // On one line nothing is known of the way across.
            row.add(weight, &[x[0], 0.0], field([x[0], 0.0]));
        }
        for found in [fit.value(), row.value()] {
            for (own, exact) in found.unwrap().into_iter().zip(field([0.0; 2])) {
                assert_abs_diff_eq!(own, exact, epsilon = 1e-11);
            }
        }
        // Two values make a line, and one is itself.
        let mut few = Fit::<1>::new();
        few.add(0.3, &[0.2], [1.0; 4]);
        assert_abs_diff_eq!(few.value().unwrap()[0], 1.0, epsilon = 1e-14);
        let mut few = Fit::<1>::new();
        few.add(0.3, &[0.2], [1.0; 4]);
        few.add(0.1, &[0.6], [3.0; 4]);
        assert_abs_diff_eq!(few.value().unwrap()[0], 0.0, epsilon = 1e-12);
        assert!((mean.1 / mean.0 - 1.0_f64).abs() > 0.1);
        assert!(Fit::<2>::new().value().is_none());
    }
}
