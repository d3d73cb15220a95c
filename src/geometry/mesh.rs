//! Shapes from triangle meshes, read from STL files.
//! Inside is where the winding number is one; the distance is that to the nearest triangle.

use super::moved::problems_of;
use super::overlap::correction;
use super::rows::Line;
use super::{Shape, is_inside};
use crate::error::{Error, Problem, Result};
use crate::tensor::{Matrix, Vector};
use std::collections::HashMap;
use std::fmt;
use std::io::Cursor;
use std::path::Path;

/// Most triangles in a leaf of the tree.
const LEAF: usize = 4;
/// How many radii away a node must be for its dipole to stand for its triangles.
const FAR: f64 = 2.5;

type Point = [f64; 3];

/// What a closed surface of triangles holds.
///
/// The distance is exact, to the nearest point of the nearest triangle. The sign follows from the winding number
///
/// w(x) = Σ Ω(x)/4π
///
/// over the solid angles Ω of the triangles seen from x (Van Oosterom & Strackee 1983), which is one inside and zero
/// outside; far triangles count together as a dipole (Barill, Dickson, Schmidt, Levin & Jacobson 2018, ACM Trans. Graph.
/// 37, 43). Both go through a tree of boxes, so a distance costs a time that grows with the logarithm of the number of
/// triangles.
///
/// The surface must be closed: every edge has two triangles, which face alike. All together may face inwards; they are
/// turned then. Points that agree to the last bit are one, as of an STL file they must be.
///
/// ```
/// use meshfree::geometry::{Mesh, Shape, fill};
/// // A tetrahedron in the corner of the axes.
/// let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let mesh = Mesh::new(&corners, &[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
/// assert!((mesh.volume() - 1.0 / 6.0).abs() < 1e-15);
/// assert!((mesh.signed_distance(&[0.1, 0.3, 0.3]) + 0.1).abs() < 1e-15);
/// let points = fill(&mesh, 0.02, [0.0; 3])?;
/// assert!((points.len() as f64 * 0.02_f64.powi(3) - mesh.volume()).abs() < 0.01);
/// # Ok::<(), meshfree::error::Error>(())
/// ```
#[derive(Clone)]
pub struct Mesh {
    /// Corners of the triangles \[m\], in the order of the tree.
    triangles: Vec<[Point; 3]>,
    nodes: Vec<Node>,
    volume: f64,
}

/// A box around triangles.
#[derive(Clone, Debug)]
struct Node {
    low: Point,
    high: Point,
    /// Centre of the triangles by area, and the largest distance of a corner from it.
    centre: Point,
    radius: f64,
    /// Sum of the areas along the normals.
    dipole: Point,
    /// Its triangles.
    first: usize,
    count: usize,
    /// The second of two nodes in it; the first stands next to it. Zero for a leaf.
    second: usize,
}

fn minus(a: Point, b: Point) -> Point {
    core::array::from_fn(|d| a[d] - b[d])
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Point, b: Point) -> Point {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn size(a: Point) -> f64 {
    dot(a, a).sqrt()
}

/// The surface cannot be the boundary of a body.
fn unusable(what: String, remedy: &'static str) -> Error {
    Error::Argument(Problem::Incompatible { what, remedy })
}

impl Mesh {
    /// A mesh of `corners` \[m\] and triangles by their numbers, counter-clockwise seen from outside.
    ///
    /// # Errors
    /// [`Error::Argument`] if there is no triangle, a number is not that of a corner, a corner is not finite, an edge has
    /// another number of triangles than two, two neighbours face differently, or nothing is inside.
    pub fn new(corners: &[Point], triangles: &[[usize; 3]]) -> Result<Self> {
        const REPAIR: &str = "close and orient the surface in the program that made it (a check for manifold or watertight \
                              meshes, and a repair), and export it again";
        if let Some(bad) = corners.iter().flatten().find(|x| !x.is_finite()) {
            return Err(Error::Argument(Problem::Parameter {
                what: "corner of the mesh".into(),
                value: *bad,
                must_be: "it must be finite, in metres",
            }));
        }
        if let Some(&bad) = triangles.iter().flatten().find(|n| **n >= corners.len()) {
            return Err(Error::Argument(Problem::Parameter {
                what: "number of a corner of a triangle".into(),
                value: bad as f64,
                must_be: "it must be less than the number of corners",
            }));
        }
        // Triangles that are a line of two corners hold nothing and open nothing.
        let all = triangles.iter().copied();
        let all: Vec<[usize; 3]> = all.filter(|[a, b, c]| a != b && b != c && c != a).collect();
        if all.is_empty() {
            return Err(unusable("the mesh has no triangles".into(), REPAIR));
        }
        let mut edges: HashMap<[usize; 2], [u32; 2]> = HashMap::new();
        for [a, b, c] in &all {
            for [from, to] in [[*a, *b], [*b, *c], [*c, *a]] {
                let own = edges.entry([from.min(to), from.max(to)]).or_default();
                own[usize::from(from > to)] += 1;
            }
        }
        let count = |wrong: fn(u32, u32) -> bool| {
            let found = edges.iter().filter(|(_, [up, down])| wrong(*up, *down));
            // The least, so that the message is the same every time.
            let first = found.clone().map(|(edge, _)| *edge).min();
            first.map(|edge| (found.count(), corners[edge[0]], corners[edge[1]]))
        };
        if let Some((count, a, b)) = count(|up, down| up + down == 1) {
            return Err(unusable(
                format!(
                    "the mesh is open: {count} edges have one triangle, as that from {a:?} to {b:?} m"
                ),
                REPAIR,
            ));
        }
        if let Some((count, a, b)) = count(|up, down| up + down > 2) {
            return Err(unusable(
                format!(
                    "the mesh is not manifold: {count} edges have more than two triangles, as that from {a:?} to {b:?} m"
                ),
                REPAIR,
            ));
        }
        if let Some((count, a, b)) = count(|up, down| up != down) {
            return Err(unusable(
                format!(
                    "the triangles of the mesh have inconsistent orientations at {count} edges, as that from \
                     {a:?} to {b:?} m"
                ),
                REPAIR,
            ));
        }
        let mut triangles: Vec<[Point; 3]> = all.iter().map(|t| t.map(|n| corners[n])).collect();
        let origin = triangles[0][0];
        let six = |[a, b, c]: &[Point; 3]| {
            let [a, b, c] = [*a, *b, *c].map(|x| minus(x, origin));
            dot(a, cross(b, c))
        };
        let volume = triangles.iter().map(six).sum::<f64>() / 6.0;
        if volume < 0.0 {
            for own in &mut triangles {
                own.swap(1, 2);
            }
        }
        if !(volume.abs() > 0.0 && volume.is_finite()) {
            return Err(unusable(
                format!("the mesh holds a volume of {volume} m³"),
                REPAIR,
            ));
        }
        let mut nodes = Vec::new();
        let count = triangles.len();
        build(&mut triangles, 0, count, &mut nodes);
        let twice = correction(&triangles, nodes[0].low, nodes[0].high);
        Ok(Self {
            triangles,
            nodes,
            volume: volume.abs() + twice,
        })
    }

    /// Reads an STL file, binary or text, whose unit of length is `unit` \[m\]: 1e-3 for millimetres. The file does not say it.
    ///
    /// # Errors
    /// [`Error::File`] if it cannot be read, or is cut short or no STL, and as [`new`](Self::new).
    pub fn read(path: impl AsRef<Path>, unit: f64) -> Result<Self> {
        let path = path.as_ref();
        let failed = |cause| Error::File {
            action: "read",
            path: path.into(),
            cause,
        };
        if !(unit.is_finite() && unit > 0.0) {
            return Err(Error::Argument(Problem::Parameter {
                what: "unit of length of the mesh".into(),
                value: unit,
                must_be: super::POSITIVE,
            }));
        }
        let mut bytes = std::fs::read(path).map_err(failed)?;
        // Some programs begin binary files with the word that begins text files.
        if let Some(count) = bytes.get(80..84) {
            let count = u32::from_le_bytes([count[0], count[1], count[2], count[3]]);
            if bytes.len() as u64 == 84 + 50 * u64::from(count) {
                bytes[..80].fill(0);
            }
        }
        let mut cursor = Cursor::new(bytes);
        let reader = stl_io::create_stl_reader(&mut cursor).map_err(failed)?;
        let (mut corners, mut triangles) = (Vec::new(), Vec::new());
        let mut known: HashMap<[u32; 3], usize> = HashMap::new();
        for triangle in reader {
            let triangle = triangle.map_err(failed)?;
            triangles.push(triangle.vertices.map(|vertex| {
                // Zero has two signs.
                let at: [f32; 3] = vertex.0.map(|x| x + 0.0);
                *known.entry(at.map(f32::to_bits)).or_insert_with(|| {
                    corners.push(at.map(|x| unit * f64::from(x)));
                    corners.len() - 1
                })
            }));
        }
        Self::new(&corners, &triangles)
    }

    /// The volume that it holds \[m³\]: that of the points whose winding number is above zero, each counted once, as
    /// [`fill`](super::fill) has it.
    ///
    /// It is exact where no shells of the surface overlap. What shells hold together is taken off by 512 × 512 lines through the
    /// mesh, and known to about a thousandth of the section of the mesh times its length there; what a shell that is inside out
    /// seems to take away is added likewise. A shell inside out within another is a cavity.
    ///
    /// ```
    /// use meshfree::geometry::Mesh;
    /// // Two tetrahedra of 1/6 m³ in one file, of which the second is half as large and wholly in the first.
    /// let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    /// let corners = |low: f64, edge: f64| {
    ///     let high = low + edge;
    ///     [[low; 3], [high, low, low], [low, high, low], [low, low, high]]
    /// };
    /// let points = [corners(0.0, 1.0), corners(0.1, 0.5)].concat();
    /// let both: Vec<[usize; 3]> = (0..8).map(|k| faces[k % 4].map(|n| n + 4 * (k / 4))).collect();
    /// let volume = Mesh::new(&points, &both)?.volume();
    /// assert!((6.0 * volume - 1.0).abs() < 1e-3, "{volume}");
    /// # Ok::<(), meshfree::error::Error>(())
    /// ```
    #[must_use]
    pub fn volume(&self) -> f64 {
        self.volume
    }

    /// The mesh with its triangles turned about the origin by an orthonormal `rotation`, then moved by `shift` \[m\]. A reflection
    /// mirrors it.
    ///
    /// The surface is that of [`Shape::moved`], which turns every point that is asked for instead. Rows of a lattice are not rows any
    /// more in the turned frame, so [`fill`](super::fill) goes through a moved shape point by point, and through this one row by row.
    ///
    /// ```
    /// use meshfree::geometry::{Mesh, Shape};
    /// use meshfree::tensor::Matrix;
    /// let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    /// let mesh = Mesh::new(&corners, &[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
    /// // A quarter turn about z, and 2 m up.
    /// let quarter = Matrix::<f64, 3>::new(0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
    /// let placed = mesh.clone().placed(quarter, [0.0, 0.0, 2.0])?;
    /// assert_eq!(placed.bounds(), ([-1.0, 0.0, 2.0], [0.0, 1.0, 3.0]));
    /// assert!(mesh.placed(2.0 * quarter, [0.0; 3]).is_err());
    /// # Ok::<(), meshfree::error::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Argument`] if an entry of RᵀR − 1 is above 10⁻⁹, or the shift is not finite.
    pub fn placed(mut self, rotation: Matrix<f64, 3>, shift: Point) -> Result<Self> {
        if let Some((what, value, must_be)) = problems_of(&rotation, &shift).into_iter().next() {
            let what = what.into();
            return Err(Error::Argument(Problem::Parameter {
                what,
                value,
                must_be,
            }));
        }
        let mirrors = rotation.determinant() < 0.0;
        for own in &mut self.triangles {
            *own = own.map(|x| (rotation * Vector::from(x) + Vector::from(shift)).into());
            if mirrors {
                own.swap(1, 2);
            }
        }
        self.nodes.clear();
        let count = self.triangles.len();
        build(&mut self.triangles, 0, count, &mut self.nodes);
        Ok(self)
    }

    /// How many triangles it has.
    #[must_use]
    pub fn triangles(&self) -> usize {
        self.triangles.len()
    }

    /// The winding number at a point: one inside and zero outside, within two hundredths for the
    /// dipoles of far triangles.
    #[must_use]
    pub fn winding_number(&self, x: &[f64; 3]) -> f64 {
        let (mut sum, mut stack) = (0.0, vec![0]);
        while let Some(at) = stack.pop() {
            let node = &self.nodes[at];
            let to = minus(node.centre, *x);
            let distance = size(to);
            if distance > FAR * node.radius {
                sum += dot(node.dipole, to) / distance.powi(3);
            } else if node.second == 0 {
                let own = &self.triangles[node.first..node.first + node.count];
                sum += own.iter().map(|own| solid_angle(own, x)).sum::<f64>();
            } else {
                stack.extend([at + 1, node.second]);
            }
        }
        sum / (4.0 * core::f64::consts::PI)
    }

    /// Distance to the nearest triangle \[m\].
    fn nearest(&self, x: &[f64; 3]) -> f64 {
        let (mut least, mut stack) = (f64::INFINITY, vec![0]);
        while let Some(at) = stack.pop() {
            let node = &self.nodes[at];
            if node.beyond(x) >= least {
                continue;
            }
            if node.second == 0 {
                let own = &self.triangles[node.first..node.first + node.count];
                least = own.iter().map(|own| square(own, x)).fold(least, f64::min);
            } else {
                // The nearer one is looked at first.
                let mut next = [at + 1, node.second];
                if self.nodes[next[0]].beyond(x) < self.nodes[next[1]].beyond(x) {
                    next.reverse();
                }
                stack.extend(next);
            }
        }
        least.sqrt()
    }
}

impl Node {
    /// The square of the distance of a point from the box.
    fn beyond(&self, x: &Point) -> f64 {
        let out = |d: usize| (self.low[d] - x[d]).max(x[d] - self.high[d]).max(0.0);
        (0..3).map(|d| out(d).powi(2)).sum()
    }
}

/// The tree over triangles from `first`, which are put into its order.
fn build(all: &mut [[Point; 3]], first: usize, count: usize, nodes: &mut Vec<Node>) {
    let own = &mut all[first..first + count];
    let corners = || own.iter().flatten();
    let extreme = |pick: fn(f64, f64) -> f64, start: f64| -> Point {
        core::array::from_fn(|d| corners().fold(start, |most, x| pick(most, x[d])))
    };
    let low = extreme(f64::min, f64::INFINITY);
    let high = extreme(f64::max, f64::NEG_INFINITY);
    let (mut dipole, mut centre, mut area) = ([0.0; 3], [0.0; 3], 0.0);
    for [a, b, c] in &*own {
        let normal = cross(minus(*b, *a), minus(*c, *a)).map(|n| 0.5 * n);
        let weight = size(normal);
        area += weight;
        for d in 0..3 {
            dipole[d] += normal[d];
            centre[d] += weight * (a[d] + b[d] + c[d]) / 3.0;
        }
    }
    let centre = if area > 0.0 {
        centre.map(|x| x / area)
    } else {
        own[0][0]
    };
    let radius = corners().fold(0.0_f64, |most, x| most.max(size(minus(*x, centre))));
    let at = nodes.len();
    nodes.push(Node {
        low,
        high,
        centre,
        radius,
        dipole,
        first,
        count,
        second: 0,
    });
    if count > LEAF {
        let widest = (0..3).max_by(|&a, &b| (high[a] - low[a]).total_cmp(&(high[b] - low[b])));
        let d = widest.unwrap_or(0);
        let middle = |own: &[Point; 3]| own[0][d] + own[1][d] + own[2][d];
        let half = count / 2;
        own.select_nth_unstable_by(half, |a, b| middle(a).total_cmp(&middle(b)));
        build(all, first, half, nodes);
        nodes[at].second = nodes.len();
        build(all, first + half, count - half, nodes);
    }
}

/// The solid angle of a triangle, positive where its back is seen: Ω = 2 atan2(a·(b × c), abc + …).
fn solid_angle(own: &[Point; 3], x: &Point) -> f64 {
    let [a, b, c] = own.map(|corner| minus(corner, *x));
    let [la, lb, lc] = [a, b, c].map(size);
    let below = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
    2.0 * dot(a, cross(b, c)).atan2(below)
}

/// The square of the distance to a triangle: to its plane where the foot is in it, else to its nearest edge.
fn square(&[a, b, c]: &[Point; 3], x: &Point) -> f64 {
    let normal = cross(minus(b, a), minus(c, a));
    let edges = [[a, b], [b, c], [c, a]];
    let within =
        |[from, to]: &[Point; 2]| dot(cross(normal, minus(*to, *from)), minus(*x, *from)) >= 0.0;
    let area = dot(normal, normal);
    if area > 0.0 && edges.iter().all(within) {
        return dot(normal, minus(*x, a)).powi(2) / area;
    }
    let to_edge = |[from, to]: [Point; 2]| {
        let (along, out) = (minus(to, from), minus(*x, from));
        let share = (dot(out, along) / dot(along, along)).clamp(0.0, 1.0);
        let left: Point = core::array::from_fn(|d| out[d] - share * along[d]);
        dot(left, left)
    };
    edges.map(to_edge).into_iter().fold(f64::INFINITY, f64::min)
}

impl Shape<3> for Mesh {
    fn signed_distance(&self, x: &[f64; 3]) -> f64 {
        let distance = self.nearest(x);
        // What is out of the box is outside.
        if self.nodes[0].beyond(x) == 0.0 && self.winding_number(x) > 0.5 {
            -distance
        } else {
            distance
        }
    }
    fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        (self.nodes[0].low, self.nodes[0].high)
    }
    /// By the triangles that the line through the row meets, which are found through the tree.
    fn inside_row(&self, row: &[[f64; 3]], inside: &mut [bool]) {
        let (Some(first), whole) = (row.first(), &self.nodes[0]) else {
            return;
        };
        let places = whole.low.iter().chain(&whole.high);
        let largest = places.fold(0.0_f64, |most, x| most.max(x.abs()));
        let (mut line, mut stack) = (Line::new(first, largest), vec![0]);
        while let Some(at) = stack.pop() {
            let node = &self.nodes[at];
            if !line.meets(&node.low, &node.high) {
                continue;
            }
            if node.second == 0 {
                let own = &self.triangles[node.first..node.first + node.count];
                for own in own {
                    line.add(own);
                }
            } else {
                stack.extend([at + 1, node.second]);
            }
        }
        line.mark(row, inside, |x| is_inside(self.signed_distance(x)));
    }
}

impl fmt::Debug for Mesh {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            triangles, volume, ..
        } = self;
        write!(f, "Mesh({} triangles, {volume} m³)", triangles.len())
    }
}
