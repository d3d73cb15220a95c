//! Walls of dummy particles: any shape, at rest or in prescribed motion, with slip or without.
//! A wall particle takes its pressure from the liquid before it (Adami, Hu & Adams 2012).

use super::Motion;
use crate::geometry::{Cuboid, FEWER, Flaw, MOST_PARTICLES, POSITIVE, SWAPPED, Shape, edge};
use crate::tensor::{Vector, length};
use std::sync::Arc;

/// Whether liquid slides along a wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Slip {
    /// The wall exerts no viscous friction: right where the boundary layer is thinner than the spacing.
    /// Its particles still make it a little rough: in the impacts of the program `sloshing_tank`,
    /// with 1 to 16 kN on the ends, bottom, lid and sides take up to 280 N along the tank.
    #[default]
    Free,
    /// The liquid sticks: wall particles mirror its velocity in the frame of the wall,
    /// v_w = v_wall(x_w) − Σ (v_f − v_wall(x_f)) W/Σ W with the velocity that the wall's motion has at a place. Where it does not
    /// turn that is 2 v_wall − v_liquid (Adami, Hu & Adams 2012, eq. 23); where it does, the liquid sticks to the surface
    /// and not to the particles behind it. A body turns at each of its particles as its neighbours do, and is taken for rigid around it.
    None,
}

/// A wall of particles that do not move by forces.
///
/// It must be as thick as the support of the kernel, on the lattice spacing of the liquid, and start
/// half a spacing behind the surface that the liquid sees. Its pressure extrapolates that of the
/// liquid with the body force and the wall's own acceleration,
///
/// p_w = [Σ p_f W + (g − a_w)·Σ ρ_f r_wf W] / Σ W   (Adami, Hu & Adams 2012, eq. 27),
///
/// and is cut at the scheme's floor, so that a separating liquid is not held. What strikes it bounces, unless the
/// scheme takes walls as [Riemann problems](crate::effect::RiemannWalls).
///
/// Solids meet it by contact, which [`Scene::wall`](crate::scene::Scene::wall) has; two layers of any spacing do for them.
///
/// ```
/// use meshfree::boundary::{Translation, Wall};
/// let points: Vec<[f64; 2]> = (0..20).flat_map(|i| (1..4).map(move |k|
///     [0.1 * (f64::from(i) + 0.5), -0.1 * (f64::from(k) - 0.5)])).collect();
/// let floor = Wall::of("floor", points, 0.1).motion(Translation::steady([1.0, 0.0])).no_slip();
/// assert_eq!(floor.points().len(), 60);
/// ```
#[derive(Clone, Debug)]
pub struct Wall<const D: usize> {
    pub(crate) name: String,
    pub(crate) points: Vec<[f64; D]>,
    pub(crate) spacing: f64,
    pub(crate) motion: Option<Arc<dyn Motion<D>>>,
    pub(crate) slip: Slip,
    pub(crate) sliding: [f64; D],
    pub(crate) container_frame: bool,
    pub(crate) shape: Result<(), Flaw>,
    /// What liquid may fill, if the wall has it.
    pub(crate) fluid_side: Option<Arc<dyn Shape<D>>>,
}

impl<const D: usize> Wall<D> {
    /// A wall at rest with free slip, of particles at `points` \[m\] of volume `spacing`ᴰ.
    #[must_use]
    pub fn of(name: &str, points: Vec<[f64; D]>, spacing: f64) -> Self {
        Self {
            name: name.into(),
            points,
            spacing,
            motion: None,
            slip: Slip::Free,
            sliding: [0.0; D],
            container_frame: false,
            shape: Ok(()),
            fluid_side: None,
        }
    }

    /// Layers of particles around the box from `low` to `high` \[m\] in which liquid is kept, on every
    /// side that `closed` names (lower and upper end of each axis), `layers` thick. That is a count, where the thickness of
    /// [`geometry::layers`](crate::geometry::layers) is in metres.
    ///
    /// Edges and corners belong to it. The spacing is fitted to the box along each axis, as in
    /// [`Body::block`](crate::scene::Body::block).
    #[must_use]
    pub fn around(
        name: &str,
        low: [f64; D],
        high: [f64; D],
        spacing: f64,
        layers: usize,
        closed: [[bool; 2]; D],
    ) -> Self {
        let size: [f64; D] = core::array::from_fn(|d| high[d] - low[d]);
        let refused = |flaw: Flaw| Self {
            shape: Err(flaw),
            ..Self::of(name, Vec::new(), spacing)
        };
        if !(spacing.is_finite() && spacing > 0.0) {
            return refused(("spacing", spacing, POSITIVE));
        }
        if let Some(&bad) = size.iter().find(|s| !(s.is_finite() && **s > 0.0)) {
            let must_be = if bad < 0.0 && bad.is_finite() {
                SWAPPED
            } else {
                "corners must be finite and in order, in metres"
            };
            return refused(("size", bad, must_be));
        }
        if layers == 0 {
            let must_be = "it must be at least one, and as many as the kernel reaches: a number of layers, not a \
            length";
            return refused(("number of layers", 0.0, must_be));
        }
        let most = 2.0 * MOST_PARTICLES;
        let counts = size.map(|s| (s / spacing).round().clamp(1.0, most) as i64);
        let depth = layers.min(most as usize) as i64;
        let first = closed.map(|[lower, _]| if lower { -depth } else { 0 });
        let last: [i64; D] =
            core::array::from_fn(|d| counts[d] + if closed[d][1] { depth } else { 0 });
        let total: f64 = (0..D).map(|d| (last[d] - first[d]) as f64).product();
        let inside: f64 = counts.iter().map(|&n| n as f64).product();
        let mut points = Vec::new();
        let capacity = (total - inside) as usize;
        if total > MOST_PARTICLES || points.try_reserve_exact(capacity).is_err() {
            return refused(("number of particles", total, FEWER));
        }
        let mut at = first;
        'all: loop {
            if (0..D).any(|d| at[d] < 0 || at[d] >= counts[d]) {
                points.push(core::array::from_fn(|d| {
                    low[d] + size[d] * (at[d] as f64 + 0.5) / counts[d] as f64
                }));
            }
            for d in 0..D {
                at[d] += 1;
                if at[d] < last[d] {
                    continue 'all;
                }
                at[d] = first[d];
            }
            break;
        }
        // Of the volume of a cell as fitted, as the liquid's are: the force on the wall is in proportion.
        let volume: f64 = (0..D).map(|d| size[d] / counts[d] as f64).product();
        Self::of(name, points, edge::<D>(volume)).fluid_side(Cuboid::new(low, high))
    }

    /// Tells it the side that fluid may fill, from whose distance it takes the normals that
    /// [`RiemannWalls`](crate::effect::RiemannWalls) needs. A wall [around](Self::around) a box knows
    /// its fluid side.
    ///
    /// A normal is the slope of that shape's distance at a particle, in the scene as built, and turns with the wall; where
    /// there is no slope, as in the middle of a plate, a particle has none and does without.
    ///
    /// ```
    /// use meshfree::boundary::Wall;
    /// use meshfree::geometry::{Ball, Shape, fill};
    /// let post = Ball::new([0.0; 2], 0.1);
    /// let wall = Wall::of("post", fill(&post, 0.01, [0.0; 2])?, 0.01).fluid_side(post.complement());
    /// # Ok::<(), meshfree::error::Error>(())
    /// ```
    #[must_use]
    pub fn fluid_side(mut self, fluid_side: impl Shape<D> + 'static) -> Self {
        if let (Ok(()), Some(flaw)) = (self.shape, fluid_side.problems().first()) {
            self.shape = Err(*flaw);
        }
        self.fluid_side = Some(Arc::new(fluid_side));
        self
    }

    /// Unit vectors from the liquid into the wall at its particles, or zero; none if it knows no fluid side.
    pub(crate) fn normals(&self) -> Vec<[f64; D]> {
        let Some(fluid_side) = &self.fluid_side else {
            return Vec::new();
        };
        // A power of two, and the difference of the places themselves: far from zero these are rounded.
        let farthest = self.points.as_flattened().iter();
        let farthest = farthest.fold(0.0_f64, |most, x| most.max(x.abs()));
        let step = (1e-3 * self.spacing).max(16.0 * f64::EPSILON * farthest);
        let step = 2.0_f64.powi(step.log2().floor() as i32);
        let normal = |x: &[f64; D]| {
            let rise = Vector::<f64, D>::from_fn(|d, _| {
                let beside = |side: f64| {
                    let mut x = *x;
                    x[d] += side * step;
                    (x[d], fluid_side.signed_distance(&x))
                };
                let (after, before) = (beside(1.0), beside(-1.0));
                (after.1 - before.1) / (after.0 - before.0)
            });
            // A distance rises by one in one; less than half of that is no direction.
            let size = length(&rise);
            if size > 0.5 {
                (rise / size).into()
            } else {
                [0.0; D]
            }
        };
        self.points.iter().map(normal).collect()
    }

    /// Gives it a prescribed motion.
    #[must_use]
    pub fn motion(mut self, motion: impl Motion<D> + 'static) -> Self {
        self.motion = Some(Arc::new(motion));
        self
    }

    /// Makes the liquid stick to it, where the scheme has a viscosity that can tell.
    #[must_use]
    pub fn no_slip(mut self) -> Self {
        self.slip = Slip::None;
        self
    }

    /// Lets its surface run at `velocity` \[m/s\] in addition to its motion, while its particles keep their
    /// place: a lid or a belt without end, along which the velocity must lie. It drags what
    /// [sticks](Self::no_slip) to it.
    #[must_use]
    pub fn sliding(mut self, velocity: [f64; D]) -> Self {
        self.sliding = velocity;
        self
    }

    /// Makes the frame of the wall the container frame: it takes the liquid with it, as a tank does and a piston does not.
    ///
    /// A density diffusion that leaves the hydrostatic part out ([`Fourtakas`](crate::term::Fourtakas))
    /// takes that part in the frame of this wall.
    #[must_use]
    pub fn container_frame(mut self) -> Self {
        self.container_frame = true;
        self
    }

    /// Where its particles are in the scene as built \[m\].
    #[must_use]
    pub fn points(&self) -> &[[f64; D]] {
        &self.points
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_fill_edges_and_corners() {
        let tank = Wall::around("tank", [0.0; 3], [1.0; 3], 0.1, 3, [[true; 2]; 3]);
        assert_eq!(tank.points().len(), 16 * 16 * 16 - 1000);
        let open = Wall::around(
            "cup",
            [0.0; 2],
            [1.0; 2],
            0.1,
            2,
            [[true; 2], [true, false]],
        );
        assert_eq!(open.points().len(), 14 * 12 - 100);
        assert!(open.points().iter().all(|x| x[1] < 1.0));
        // Three cells of a third in a length of one, asked for 0.3.
        let fitted = Wall::around("fitted", [0.0; 2], [1.0; 2], 0.3, 1, [[true; 2]; 2]);
        assert!((fitted.spacing - 1.0 / 3.0).abs() < 1e-15);
    }
}
