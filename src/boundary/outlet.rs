//! Outlets: where particles leave the simulation, and what they must do to be taken out.
//! What leaves is counted, with its mass and momentum. Before a plane may lie a buffer of given pressure or velocity.

use super::{Motion, OpenBoundary, motion_from};
use crate::geometry::{POSITIVE, SWAPPED};
use crate::origin::local;
use crate::tensor::Vector;
use core::fmt;
use std::sync::Arc;

/// A reason to take particles out.
///
/// They leave when neighbour lists are next made, so put a plane a support behind the place where the
/// flow is looked at.
///
/// An end without a [buffer](Self::buffer) is a free surface: the pressure there is zero, whatever the flow.
///
/// ```
/// use meshfree::boundary::Outlet;
/// let end = Outlet::plane([1.0, 0.0], [1.0, 0.0]);
/// assert!(end.takes(&[1.1, 5.0], &[0.0, 0.0]) && !end.takes(&[0.9, 5.0], &[0.0, 0.0]));
/// assert!(Outlet::faster_than(10.0).takes(&[0.0], &[-11.0]));
/// ```
#[derive(Clone)]
pub struct Outlet<const D: usize>(Reason<D>, Option<Buffer<D>>, Option<Arc<dyn Motion<D>>>);

/// Liquid before a plane whose state is given.
#[derive(Clone, Debug)]
pub(crate) struct Buffer<const D: usize> {
    /// Its thickness \[m\].
    pub depth: f64,
    pub state: Arc<dyn OpenBoundary<D>>,
}

impl<const D: usize> fmt::Debug for Outlet<D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut all = f.debug_tuple("Outlet");
        all.field(&self.0);
        // Checkpoints of outlets without one are as they were.
        if let Some(buffer) = &self.1 {
            all.field(buffer);
        }
        if let Some(motion) = &self.2 {
            all.field(motion);
        }
        all.finish()
    }
}

/// The same place and buffer; boundaries and motions are the same if one is a clone of the other.
impl<const D: usize> PartialEq for Outlet<D> {
    fn eq(&self, other: &Self) -> bool {
        let same = match (&self.1, &other.1) {
            (None, None) => true,
            (Some(a), Some(b)) => a.depth == b.depth && Arc::ptr_eq(&a.state, &b.state),
            _ => false,
        };
        let carried = match (&self.2, &other.2) {
            (None, None) => true,
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            _ => false,
        };
        self.0 == other.0 && same && carried
    }
}

#[derive(Clone, Debug, PartialEq)]
enum Reason<const D: usize> {
    Beyond { point: [f64; D], normal: [f64; D] },
    Outside { low: [f64; D], high: [f64; D] },
    Faster { speed: f64 },
}

impl<const D: usize> Outlet<D> {
    /// Beyond the plane through `point` \[m\]; `normal` points to where particles leave.
    #[must_use]
    pub fn plane(point: [f64; D], normal: [f64; D]) -> Self {
        Self(Reason::Beyond { point, normal }, None, None)
    }

    /// Outside of the box from `low` to `high` \[m\]: the box in which a simulation is active.
    #[must_use]
    pub fn outside_box(low: [f64; D], high: [f64; D]) -> Self {
        Self(Reason::Outside { low, high }, None, None)
    }

    /// Faster than `speed` \[m/s\]: particles that a run can do without, as LS-DYNA's MAXV.
    #[must_use]
    pub fn faster_than(speed: f64) -> Self {
        Self(Reason::Faster { speed }, None, None)
    }

    /// Lets the liquid within `depth` \[m\] before a plane have the velocity or the pressure that a [boundary](OpenBoundary)
    /// gives; what it does not give is extrapolated from inside.
    ///
    /// A particle of the buffer takes what the liquid has at its place mirrored at the inner face of the buffer (Tafuni et al.
    /// 2018, whose ghost nodes lie there): a polynomial of second degree fitted to the particles of its body inside, weighted
    /// by a kernel. Theirs is of first degree, which loses the curvature of a parabolic profile: the flow meets a buffer that
    /// is too slow, and the pressure inside is too high. The particle keeps that velocity until the next evaluation; no force
    /// acts on it.
    ///
    /// So `depth` must be at least what the kernel reaches, and as much liquid must be inside. Walls of a channel go on beyond
    /// the plane by as much. A given pressure is that of the whole buffer. Where the pressure falls along the flow, as in
    /// liquid that is accelerated, the inner face has it to the fall over four spacings.
    ///
    /// Buffers of two outlets may not share liquid: a run in which they do ends with an error.
    ///
    /// Energy and momentum that the buffer gives are in no column of the ledger. Liquid leaves; where it flows back for long
    /// the buffer empties, and with it the end becomes a free surface.
    ///
    /// ```
    /// use meshfree::boundary::{GivenPressure, Outlet};
    /// let end = Outlet::plane([2.0, 0.0], [1.0, 0.0]).buffer(0.2, GivenPressure::of(500.0));
    /// assert!(end.takes(&[2.1, 0.0], &[0.0; 2]) && !end.takes(&[1.9, 0.0], &[0.0; 2]));
    /// ```
    #[must_use]
    pub fn buffer(mut self, depth: f64, state: impl OpenBoundary<D> + 'static) -> Self {
        self.1 = Some(Buffer {
            depth,
            state: Arc::new(state),
        });
        self
    }

    /// Lets a rigid motion carry a plane, with its [buffer](Self::buffer), as that of the wall that it is in. Point and normal are those as
    /// built; a [boundary](OpenBoundary) gives values in the frame of the scene, where the plane is.
    ///
    /// ```
    /// use meshfree::boundary::{Outlet, Translation};
    /// let end = Outlet::plane([1.0, 0.0], [1.0, 0.0]).motion(Translation::steady([0.5, 0.0]));
    /// ```
    #[must_use]
    pub fn motion(mut self, motion: impl Motion<D> + 'static) -> Self {
        self.2 = Some(Arc::new(motion));
        self
    }

    /// What carries it, if it moves.
    pub(crate) fn carried(&self) -> Option<&dyn Motion<D>> {
        self.2.as_deref()
    }

    /// The boundary whose state its buffer has, if it has one.
    pub(crate) fn state(&self) -> Option<&dyn OpenBoundary<D>> {
        self.1.as_ref().map(|buffer| &*buffer.state)
    }

    /// The same at rest where it is at `time` \[s\].
    pub(crate) fn at(&self, time: f64) -> Self {
        let reason = match (&self.0, &self.2) {
            (Reason::Beyond { point, normal }, Some(motion)) => {
                let pose = motion.pose(time);
                Reason::Beyond {
                    point: pose.of(0, point),
                    normal: (pose.linear[0] * Vector::from(*normal)).into(),
                }
            }
            (reason, _) => reason.clone(),
        };
        Self(reason, self.1.clone(), None)
    }

    /// The point \[m\] and the unit normal, outwards, of its plane, with the buffer before it; none if there is none.
    pub(crate) fn open(&self) -> Option<([f64; D], [f64; D], &Buffer<D>)> {
        let (Reason::Beyond { point, normal }, Some(buffer)) = (&self.0, &self.1) else {
            return None;
        };
        let size = normal.iter().map(|n| n * n).sum::<f64>().sqrt();
        Some((*point, normal.map(|n| n / size), buffer))
    }

    /// Whether a particle at `x` \[m\] with velocity `v` \[m/s\] leaves, with a plane where it is built.
    #[must_use]
    pub fn takes(&self, x: &[f64; D], v: &[f64; D]) -> bool {
        match &self.0 {
            Reason::Beyond { point, normal } => {
                let height: f64 = (0..D).map(|d| (x[d] - point[d]) * normal[d]).sum();
                height > 0.0
            }
            Reason::Outside { low, high } => (0..D).any(|d| x[d] < low[d] || x[d] > high[d]),
            Reason::Faster { speed } => v.iter().map(|v| v * v).sum::<f64>() > speed * speed,
        }
    }

    /// The same for places that are counted from an origin \[m\].
    pub(crate) fn seen_from(&self, origin: &[f64; D]) -> Self {
        let reason = match &self.0 {
            Reason::Beyond { point, normal } => Reason::Beyond {
                point: local(point, origin),
                normal: *normal,
            },
            Reason::Outside { low, high } => Reason::Outside {
                low: local(low, origin),
                high: local(high, origin),
            },
            Reason::Faster { speed } => Reason::Faster { speed: *speed },
        };
        let motion = self.2.as_ref().map(|motion| motion_from(motion, origin));
        Self(reason, self.1.clone(), motion)
    }

    /// What is wrong with it, as `(what, value, what it must be)`.
    pub(crate) fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let finite = |values: &[f64]| values.iter().copied().find(|x| !x.is_finite());
        let mut problems = Vec::new();
        if let Some(Buffer { depth, state }) = &self.1 {
            if !(depth.is_finite() && *depth > 0.0) {
                problems.push(("depth of the buffer", *depth, POSITIVE));
            }
            if !matches!(self.0, Reason::Beyond { .. }) {
                let must_be = "a buffer lies before a plane: take Outlet::plane";
                problems.push(("depth of the buffer", *depth, must_be));
            }
            problems.extend(state.problems());
        }
        if self.2.is_some() && !matches!(self.0, Reason::Beyond { .. }) {
            let must_be = "a motion carries a plane: take Outlet::plane";
            problems.push(("motion", f64::NAN, must_be));
        }
        let own = match &self.0 {
            Reason::Beyond { point, normal } => {
                let bad = finite(point).or(finite(normal));
                let bad = bad.or((normal.iter().all(|&n| n == 0.0)).then_some(0.0));
                bad.map(|bad| {
                    (
                        "plane",
                        bad,
                        "point and normal must be finite, the normal not zero",
                    )
                })
            }
            Reason::Outside { low, high } => (0..D)
                .map(|d| high[d] - low[d])
                .find(|size| size.is_nan() || *size <= 0.0)
                .map(|size| {
                    (
                        "size",
                        size,
                        if size < 0.0 {
                            SWAPPED
                        } else {
                            "the box must have a positive size along every axis"
                        },
                    )
                }),
            Reason::Faster { speed } => (speed.is_nan() || *speed <= 0.0).then_some((
                "speed",
                *speed,
                "must be positive, in m/s",
            )),
        };
        problems.extend(own);
        problems
    }
}
