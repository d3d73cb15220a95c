//! Kinematics of joints: the constraints of one, its coordinate, and how both change with the motion of its two bodies.
//! Every derivative is exact, so Newton's method converges to rounding.

use crate::coupling::{Joint, Kind};
use nalgebra::{UnitQuaternion, Vector3};

type V = Vector3<f64>;

/// Where a body is: its centre \[m\], and the rotation from its own axes to space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    pub centre: V,
    pub turn: UnitQuaternion<f64>,
}

impl Frame {
    /// That of the ground.
    pub fn ground() -> Self {
        Self {
            centre: V::zeros(),
            turn: UnitQuaternion::identity(),
        }
    }
}

/// One function g of two bodies: its value, and dg/dt = n·(v₁ − v₂) + a₁·ω₁ − a₂·ω₂.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    pub value: f64,
    pub linear: V,
    pub angular: [V; 2],
    /// The size of what the value is a difference of.
    pub scale: f64,
}

/// What of a joint is fixed in its two bodies.
#[derive(Clone, Debug)]
pub(crate) struct Geometry {
    /// The place \[m\] and the axes a, b, c in the axes of each body.
    places: [V; 2],
    axes: [[V; 3]; 2],
    /// The distance of the places as built \[m\].
    pub length: f64,
}

/// The same in space.
struct Placed {
    /// From each centre to its place.
    r: [V; 2],
    /// From the second place to the first.
    u: V,
    axes: [[V; 3]; 2],
}

fn raised(x: &[f64]) -> V {
    V::from_fn(|d, _| x.get(d).copied().unwrap_or(0.0))
}

/// Axes a, b, c at right angles; in a plane b lies in it, and c too if a does not.
fn axes(along: V, dimension: usize) -> [V; 3] {
    let a = along.normalize();
    let out = V::z();
    let b = if dimension < 3 {
        let b = out.cross(&a);
        if b.norm_squared() > 0.0 { b } else { V::x() }
    } else {
        // The coordinate axis that is farthest from a.
        out_of(a).cross(&a).normalize()
    };
    [a, b, a.cross(&b)]
}

fn out_of(a: V) -> V {
    let mut least = 0;
    for d in 1..3 {
        if a[d].abs() < a[least].abs() {
            least = d;
        }
    }
    V::from_fn(|d, _| f64::from(u8::from(d == least)))
}

impl Geometry {
    /// Of a joint between bodies that are as built; places of the joint count from `origin` \[m\].
    pub fn new<const D: usize>(joint: &Joint<D>, frames: [&Frame; 2], origin: &[f64; D]) -> Self {
        let local = |x: &[f64; D]| raised(&crate::origin::local(x, origin));
        let (at, axis) = match &joint.kind {
            Kind::Ball { at } => ([*at; 2], V::z()),
            Kind::Hinge { at, axis } => ([*at; 2], V::from(*axis)),
            Kind::Slider { at, axis } => ([*at; 2], raised(axis)),
            Kind::Distance { at } | Kind::Spring { at } => (*at, V::z()),
        };
        let [first, second] = at.each_ref().map(local);
        let all = axes(axis, D);
        let own = |frame: &Frame, x: V| frame.turn.inverse() * (x - frame.centre);
        Self {
            places: [own(frames[0], first), own(frames[1], second)],
            axes: frames.map(|frame| all.map(|axis| frame.turn.inverse() * axis)),
            length: (first - second).norm(),
        }
    }

    /// All that it is by numbers.
    pub fn numbers(&self) -> Vec<f64> {
        let vectors = self.places.iter().chain(self.axes.as_flattened());
        vectors.flat_map(|own| own.iter().copied()).collect()
    }

    fn place(&self, frames: [&Frame; 2]) -> Placed {
        let r: [V; 2] = core::array::from_fn(|side| frames[side].turn * self.places[side]);
        Placed {
            u: (frames[0].centre + r[0]) - (frames[1].centre + r[1]),
            axes: core::array::from_fn(|side| self.axes[side].map(|own| frames[side].turn * own)),
            r,
        }
    }

    /// The place of the joint on the first body, from its centre \[m\].
    pub fn arm(&self, frame: &Frame) -> V {
        frame.turn * self.places[0]
    }

    /// The coordinate of a joint that has one; an angle is within half a turn of zero.
    pub(super) fn coordinate<const D: usize>(
        &self,
        kind: &Kind<D>,
        frames: [&Frame; 2],
    ) -> Option<Row> {
        let at = self.place(frames);
        match kind {
            Kind::Ball { .. } => None,
            Kind::Hinge { .. } => Some(at.angle()),
            Kind::Slider { .. } => Some(at.along(at.axes[1][0])),
            Kind::Distance { .. } | Kind::Spring { .. } => Some(at.distance()),
        }
    }

    /// What a joint holds at zero.
    pub(super) fn constraints<const D: usize>(
        &self,
        kind: &Kind<D>,
        frames: [&Frame; 2],
    ) -> Vec<Row> {
        let at = self.place(frames);
        let mut all = Vec::new();
        match kind {
            Kind::Ball { .. } => all.extend((0..D).map(|d| at.component(d))),
            Kind::Hinge { .. } => {
                all.extend((0..D).map(|d| at.component(d)));
                if D == 3 {
                    all.extend([(0, 1), (0, 2)].map(|pair| at.upright(pair)));
                }
            }
            Kind::Slider { .. } => {
                let across = &at.axes[1][1..D];
                all.extend(across.iter().map(|axis| at.along(*axis)));
                if D > 1 {
                    all.push(at.upright((0, 1)));
                }
                if D == 3 {
                    all.extend([(0, 2), (1, 2)].map(|pair| at.upright(pair)));
                }
            }
            Kind::Distance { .. } => {
                let own = at.distance();
                all.push(Row {
                    value: own.value - self.length,
                    ..own
                });
            }
            Kind::Spring { .. } => {}
        }
        all
    }
}

impl Placed {
    /// The size of the arms \[m\].
    fn size(&self) -> f64 {
        let [first, second] = self.r.map(|r| r.norm());
        first.max(second).max(self.u.norm()).max(f64::MIN_POSITIVE)
    }

    /// A component of u, along an axis of space.
    fn component(&self, d: usize) -> Row {
        let linear = V::from_fn(|k, _| f64::from(u8::from(k == d)));
        Row {
            value: self.u[d],
            linear,
            angular: self.r.map(|r| r.cross(&linear)),
            scale: self.size(),
        }
    }

    /// u·e with an axis e of the second body.
    fn along(&self, e: V) -> Row {
        Row {
            value: self.u.dot(&e),
            linear: e,
            angular: [self.r[0].cross(&e), (self.r[1] + self.u).cross(&e)],
            scale: self.size(),
        }
    }

    /// |u|; its direction is none where it is zero.
    fn distance(&self) -> Row {
        let value = self.u.norm();
        let n = self.u / value.max(f64::MIN_POSITIVE);
        Row {
            value,
            linear: n,
            angular: self.r.map(|r| r.cross(&n)),
            scale: self.size(),
        }
    }

    /// The product of an axis of the first body and one of the second, which were at right angles.
    fn upright(&self, (first, second): (usize, usize)) -> Row {
        let (e, f) = (self.axes[0][first], self.axes[1][second]);
        Row {
            value: e.dot(&f),
            linear: V::zeros(),
            angular: [e.cross(&f); 2],
            scale: 1.0,
        }
    }

    /// The angle about the axis.
    fn angle(&self) -> Row {
        let ([_, e, _], [a, b, c]) = (self.axes[0], self.axes[1]);
        Row {
            value: e.dot(&c).atan2(e.dot(&b)),
            linear: V::zeros(),
            angular: [a; 2],
            scale: 1.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// Two bodies that have moved a little since they were built.
    fn moved(by: f64) -> [Frame; 2] {
        let of = |x: [f64; 3], turn: [f64; 3]| Frame {
            centre: V::from(x),
            turn: UnitQuaternion::from_scaled_axis(V::from(turn)),
        };
        [
            of([0.3 + 0.2 * by, 0.1, -0.4 * by], [0.3 * by, 0.2, by]),
            of([-0.5, 0.6 * by, 0.2], [0.1, -0.7 * by, 0.4 * by]),
        ]
    }

    /// The rate of every row follows its value.
    #[test]
    fn rates_are_the_derivatives_of_values() {
        let (at, other) = ([0.1, 0.2, -0.1], [0.4, -0.2, 0.3]);
        let joints = [
            Joint::ball(at),
            Joint::hinge(at, [1.0, 2.0, -1.0]),
            Joint::slider(at, [0.5, 1.0, 3.0]),
            Joint::distance(at, other),
            Joint::spring(at, other, 1.0),
        ];
        let (start, step) = (moved(0.0), 1e-5);
        let [before, after] = [moved(-step), moved(step)];
        for joint in joints {
            let own = Geometry::new(&joint, [&start[0], &start[1]], &[0.0; 3]);
            let rows = |by: f64| {
                let frames = moved(by);
                let frames = [&frames[0], &frames[1]];
                let mut all = own.constraints(&joint.kind, frames);
                all.extend(own.coordinate(&joint.kind, frames));
                all
            };
            // Rates are exact where constraints hold, as they do as built.
            let (low, high) = (rows(-step), rows(step));
            let v = |side: usize| (after[side].centre - before[side].centre) / (2.0 * step);
            let w = |side: usize| {
                let turned = after[side].turn * before[side].turn.inverse();
                turned.scaled_axis() / (2.0 * step)
            };
            for (k, row) in rows(0.0).iter().enumerate() {
                let found = (high[k].value - low[k].value) / (2.0 * step);
                let rate = row.linear.dot(&(v(0) - v(1))) + row.angular[0].dot(&w(0))
                    - row.angular[1].dot(&w(1));
                assert_relative_eq!(rate, found, epsilon = 1e-8, max_relative = 1e-8);
            }
        }
    }
}
