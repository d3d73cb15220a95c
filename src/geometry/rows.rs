//! Which points of a lattice row a closed surface of triangles holds, by where the line through the row meets it.
//! Lines through edges and corners are decided exactly; points that touch the surface are left to its distance.

use crate::collective::ExactSum;

type Point = [f64; 3];

/// Share of the largest coordinate within which a point touches a triangle: well above the rounding of a distance.
const TOUCH: f64 = 1e-12;

/// What the line through a row meets.
pub(super) struct Line {
    /// The second and third coordinate \[m\].
    at: [f64; 2],
    /// How near a triangle counts as touched \[m\].
    touch: f64,
    /// Where it meets triangles \[m\], and by how much the winding number changes there on the way up.
    crossings: Vec<(f64, i32)>,
    /// Where it touches triangles, or nearly so: from and to \[m\].
    doubtful: Vec<[f64; 2]>,
}

impl Line {
    /// The line through `x`, along the first axis; `largest` is the largest coordinate \[m\] of what it may meet.
    pub fn new(x: &Point, largest: f64) -> Self {
        let scale = x.iter().fold(largest, |most, x| most.max(x.abs()));
        Self {
            at: [x[1], x[2]],
            touch: TOUCH * scale,
            crossings: Vec::new(),
            doubtful: Vec::new(),
        }
    }

    /// Whether the line may touch what is in a box.
    pub fn meets(&self, low: &Point, high: &Point) -> bool {
        (0..2).all(|d| {
            self.at[d] >= low[d + 1] - self.touch && self.at[d] <= high[d + 1] + self.touch
        })
    }

    /// Adds a triangle.
    pub fn add(&mut self, own: &[Point; 3]) {
        let extreme =
            |d: usize, pick: fn(f64, f64) -> f64| pick(pick(own[0][d], own[1][d]), own[2][d]);
        let low: Point = core::array::from_fn(|d| extreme(d, f64::min));
        let high: Point = core::array::from_fn(|d| extreme(d, f64::max));
        if !self.meets(&low, &high) {
            return;
        }
        let [a, b, c] = own;
        let edges = [[b, c], [c, a], [a, b]].map(|[p, q]| Edge::new(p, q, self.at));
        let near = edges
            .iter()
            .any(|edge| edge.area.abs() <= self.touch * edge.length);
        let up = edges.iter().all(|edge| edge.is_left);
        let hit = up || edges.iter().all(|edge| !edge.is_left);
        let sum: f64 = edges.iter().map(|edge| edge.area).sum();
        let share = |k: usize| edges[k].area / sum * own[k][0];
        let at = share(0) + share(1) + share(2);
        let at = if at.is_finite() {
            at.clamp(low[0], high[0])
        } else {
            low[0]
        };
        if hit {
            // Counter-clockwise seen from above is a top, above which one is outside.
            self.crossings.push((at, if up { -1 } else { 1 }));
        }
        if near {
            self.doubtful
                .push([low[0] - self.touch, high[0] + self.touch]);
        } else if hit {
            // A point is as near a steep triangle as it is to the line's crossing over the slope; weights are rounded too.
            let error = edges
                .iter()
                .fold(0.0_f64, |most, edge| most.max(edge.error));
            let rounding = 4.0 * error / sum.abs() * (high[0] - low[0]);
            let slack = self.touch * (1.0 + slope(own, sum)) + rounding;
            self.doubtful.push([at - slack, at + slack]);
        }
    }

    /// Whether points of the row, whose first coordinates rise, are where the winding number is above zero; `touching`
    /// decides what touches the surface.
    pub fn mark(mut self, row: &[Point], inside: &mut [bool], touching: impl Fn(&Point) -> bool) {
        self.crossings.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let mut crossings = self.crossings.iter().peekable();
        let mut winding = 0;
        for (x, inside) in row.iter().zip(inside.iter_mut()) {
            while let Some((_, change)) = crossings.next_if(|crossing| crossing.0 < x[0]) {
                winding += change;
            }
            *inside = winding > 0;
        }
        for [from, to] in self.doubtful {
            let first = row.partition_point(|x| x[0] < from);
            let points = row[first..].iter().zip(&mut inside[first..]);
            for (x, inside) in points.take_while(|(x, _)| x[0] <= to) {
                *inside = touching(x);
            }
        }
    }
}

/// The larger slope of a triangle with twice the projected area `sum` along one of the two axes, times √2 at most.
fn slope(&[a, b, c]: &[Point; 3], sum: f64) -> f64 {
    let [p, q] = [b, c].map(|x| [x[0] - a[0], x[1] - a[1], x[2] - a[2]]);
    let along = |d: usize| (p[0] * q[d] - p[d] * q[0]).abs();
    (along(1) + along(2)) / sum.abs()
}

/// An edge from p to q and a line, seen along the first axis.
struct Edge {
    /// Twice the area of the triangle of both corners and the line, positive if the line is to the left.
    area: f64,
    /// What that may be off by.
    error: f64,
    length: f64,
    /// Whether the line is to the left, exactly. A line through the edge counts as moved by ε along the second axis and by
    /// ε² along the third, with ε → 0, so that it is on one side of each edge, and of all edges the same line
    /// (simulation of simplicity: Edelsbrunner & Mücke 1990, ACM Trans. Graph. 9, 66).
    is_left: bool,
}

impl Edge {
    fn new(p: &Point, q: &Point, x: [f64; 2]) -> Self {
        let (along, out) = ([q[1] - p[1], q[2] - p[2]], [x[0] - p[1], x[1] - p[2]]);
        let terms = [along[0] * out[1], along[1] * out[0]];
        let area = terms[0] - terms[1];
        // The bound of Shewchuk (1997), Discrete Comput. Geom. 18, 305: (3 + 16 u) u with u = ε/2.
        let error = 2.0 * f64::EPSILON * (terms[0].abs() + terms[1].abs());
        let is_left = if area.abs() > error {
            area > 0.0
        } else {
            let exact = exact_area([p[1], p[2]], [q[1], q[2]], x);
            // The derivatives by the two axes along which the line counts as moved.
            let moved = [exact, -along[1], along[0]].into_iter().find(|s| *s != 0.0);
            moved.is_some_and(|s| s > 0.0)
        };
        let length = along[0].hypot(along[1]);
        Self {
            area,
            error,
            length,
            is_left,
        }
    }
}

/// (q − p) × (x − p), rounded once.
fn exact_area(p: [f64; 2], q: [f64; 2], x: [f64; 2]) -> f64 {
    let products = [
        (p[0], q[1]),
        (q[0], x[1]),
        (x[0], p[1]),
        (-p[1], q[0]),
        (-q[1], x[0]),
        (-x[1], p[0]),
    ];
    let mut sum = ExactSum::ZERO;
    for (a, b) in products {
        let product = a * b;
        sum.add(product);
        sum.add(a.mul_add(b, -product));
    }
    sum.value()
}
