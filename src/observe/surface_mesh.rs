//! The surface of a body as triangles, for rendering and for measuring areas.
//! Marching tetrahedra over the filling of its particles, so that it is closed and its triangles meet edge to edge.

use super::SampleGrid;
use crate::boundary::Boundary;
use crate::error::{Error, Problem, Result};
use crate::origin::local;
use crate::output::write_whole;
use crate::particles::Field;
use crate::scalar::Real;
use crate::simulation::{Simulation, Which};
use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

/// Triangles that enclose a body, as [`Simulation::surface`] finds them.
///
/// Seen from outside, corners of a triangle go round anticlockwise. The surface has no rim: each edge is that of two
/// triangles.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct SurfaceMesh {
    vertices: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
}

impl SurfaceMesh {
    /// The corners \[m\].
    #[must_use]
    pub fn vertices(&self) -> &[[f64; 3]] {
        &self.vertices
    }

    /// The corners of each triangle, by their index.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The area \[m²\].
    #[must_use]
    pub fn area(&self) -> f64 {
        let twice = |[a, b, c]: [[f64; 3]; 3]| {
            let n = cross(&minus(&b, &a), &minus(&c, &a));
            dot(&n, &n).sqrt()
        };
        0.5 * self.corners().map(twice).sum::<f64>()
    }

    /// The volume inside \[m³\], by the theorem of Gauss.
    #[must_use]
    pub fn volume(&self) -> f64 {
        // From a corner of its own, so that the place of the body is none of its digits.
        let Some(from) = self.vertices.first() else {
            return 0.0;
        };
        let six_times = |corners: [[f64; 3]; 3]| {
            let [a, b, c] = corners.map(|corner| minus(&corner, from));
            dot(&a, &cross(&b, &c))
        };
        self.corners().map(six_times).sum::<f64>() / 6.0
    }

    fn corners(&self) -> impl Iterator<Item = [[f64; 3]; 3]> + '_ {
        let of = |corners: &[u32; 3]| corners.map(|k| self.vertices[k as usize]);
        self.triangles.iter().map(of)
    }

    /// Writes it as a PLY file (binary, little-endian, coordinates in `f64`), which ParaView, Blender and MeshLab read.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write_ply(&self, path: impl AsRef<Path>) -> Result<()> {
        let mut bytes = format!(
            "ply\nformat binary_little_endian 1.0\ncomment lengths in metres\nelement vertex {}\nproperty double x\nproperty double y\n\
             property double z\nelement face {}\nproperty list uchar uint vertex_indices\nend_header\n",
            self.vertices.len(),
            self.triangles.len()
        )
        .into_bytes();
        for x in self.vertices.as_flattened() {
            bytes.extend_from_slice(&x.to_le_bytes());
        }
        for triangle in &self.triangles {
            bytes.push(3);
            for corner in triangle {
                bytes.extend_from_slice(&corner.to_le_bytes());
            }
        }
        write_whole(path.as_ref(), &bytes)
    }
}

impl<T: Real> Simulation<T, 3> {
    /// The surface of a body: where the [filling](super::Sample::filling) Σ V W of its particles is `level`.
    ///
    /// At ½ it is the face of a body that is flat there, half a spacing outside of its last particles. Sheets and
    /// drops of few particles do not reach ½ and are left out; a single particle has about 0.12 in its place, so 0.1
    /// shows them, and lies 0.7 smoothing lengths farther out on a flat face. `grid` \[m\] is the distance of points at which the
    /// filling is read: the spacing of the particles resolves it, half of it shows smoother drops at eight times the price.
    ///
    /// Cells of the grid are cut into six tetrahedra each, along which the filling is taken as linear (Doi & Koide
    /// 1991), so there are no ambiguous cases, and the surface is closed. At planes of symmetry and at the ends of periods it is
    /// closed by a face, which is off by less than `grid`.
    ///
    /// ```
    /// use meshfree::geometry::Ball;
    /// use meshfree::prelude::*;
    /// let water = catalogue::weakly_compressible_water(2.0);
    /// let drop = Ball::new([0.0; 3], 0.01);
    /// let simulation = Scene::<f64, 3>::new(schemes::weakly_compressible())
    ///     .body(Body::fill("drop", water, &drop, 1e-3))
    ///     .build()?;
    /// let surface = simulation.surface("drop", 1e-3, 0.5)?;
    /// let volume = 4.0 / 3.0 * std::f64::consts::PI * 0.01_f64.powi(3);
    /// assert!((surface.volume() / volume - 1.0).abs() < 0.03);
    /// # let path = std::env::temp_dir().join(format!("meshfree-drop-{}.ply", std::process::id()));
    /// # /*
    /// let path = "drop.ply";
    /// # */
    /// surface.write_ply(&path)?;
    /// # let _ = std::fs::remove_file(path);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// If there is no such body, `grid` is not positive and finite or would have more than 2³² points, or `level` is not between
    /// 0 and 1.
    pub fn surface(&self, body: impl Which, grid: f64, level: f64) -> Result<SurfaceMesh> {
        let refused = |what: &str, value, must_be| {
            let what = format!("{what} of a surface");
            Err(Error::Argument(Problem::Parameter {
                what,
                value,
                must_be,
            }))
        };
        if !(grid.is_finite() && grid > 0.0) {
            let must_be = "it must be positive and finite, in metres: the spacing of the particles";
            return refused("grid", grid, must_be);
        }
        if !(level > 0.0 && level < 1.0) {
            let must_be = "it must be between 0 and 1: ½ is the face of a body";
            return refused("level", level, must_be);
        }
        let particles = self.body(body)?;
        let mut box_of_all = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for particle in particles.clone() {
            let reach = 2.0 * particle.sampling_length();
            for (d, x) in particle.position().into_iter().enumerate() {
                box_of_all[0][d] = box_of_all[0][d].min(x - reach);
                box_of_all[1][d] = box_of_all[1][d].max(x + reach);
            }
        }
        let [low, high] = box_of_all;
        if low[0] > high[0] {
            return Ok(SurfaceMesh::default());
        }
        let steps: [f64; 3] = core::array::from_fn(|d| ((high[d] - low[d]) / grid).ceil());
        let counts = steps.map(|steps| steps as usize + 1);
        let high = core::array::from_fn(|d| low[d] + steps[d] * grid);
        let points = SampleGrid::between(low, high, counts)?;
        // Beyond the end of a period the body is not its images.
        let hidden = |point: &[f64; 3], least: f64| {
            let x = local(point, &self.origin());
            let left = |own: &Arc<dyn Boundary<3>>| own.wrap(&x, self.time()).is_some();
            if self.boundaries().iter().any(left) {
                u64::MAX
            } else {
                self.boundaries_before(point, least)
            }
        };
        let at = points.points();
        let filling = self.sample_particles(Field::POSITION, particles, &at, hidden)?;
        Ok(marched(&points, filling.filling(), level))
    }
}

/// The tetrahedra of a cell, which share its long diagonal: corners by the bits of their place, x first. Those whose order is an
/// even permutation of the axes are right-handed.
const TETRAHEDRA: [([usize; 4], bool); 6] = [
    ([0, 1, 3, 7], true),
    ([0, 1, 5, 7], false),
    ([0, 2, 3, 7], false),
    ([0, 2, 6, 7], true),
    ([0, 4, 5, 7], true),
    ([0, 4, 6, 7], false),
];

/// Triangles between the points whose value is above `level` and those where it is not.
fn marched(grid: &SampleGrid<3>, values: &[f64], level: f64) -> SurfaceMesh {
    let [nx, ny, nz] = grid.counts();
    let points = grid.points();
    let offset = |corner: usize| (corner & 1) + nx * ((corner >> 1 & 1) + ny * (corner >> 2));
    let mut mesh = SurfaceMesh::default();
    // Vertices by the lower end of their edge and its direction: cells that share an edge share its vertex.
    let mut known: HashMap<(usize, usize), u32> = HashMap::new();
    for first in 0..nx * ny * nz {
        let [i, j, k] = [first % nx, first / nx % ny, first / (nx * ny)];
        if i + 1 == nx || j + 1 == ny || k + 1 == nz {
            continue;
        }
        let inside: [bool; 8] =
            core::array::from_fn(|corner| values[first + offset(corner)] > level);
        if inside.iter().all(|&own| own == inside[0]) {
            continue;
        }
        let mut vertex = |a: usize, b: usize| {
            let (low, high) = (a & b, a | b);
            *known
                .entry((first + offset(low), high ^ low))
                .or_insert_with(|| {
                    let [from, to] = [low, high].map(|corner| first + offset(corner));
                    let along = (level - values[from]) / (values[to] - values[from]);
                    let x = core::array::from_fn(|d| {
                        points[from][d] + along * (points[to][d] - points[from][d])
                    });
                    mesh.vertices.push(x);
                    mesh.vertices.len() as u32 - 1
                })
        };
        for (corners, right_handed) in TETRAHEDRA {
            let ([a, b, c, d], count) = inside_first(corners, right_handed, inside);
            match count {
                1 => mesh
                    .triangles
                    .push([vertex(a, b), vertex(a, c), vertex(a, d)]),
                2 => {
                    let face = [vertex(a, c), vertex(a, d), vertex(b, d), vertex(b, c)];
                    mesh.triangles.push([face[0], face[1], face[2]]);
                    mesh.triangles.push([face[0], face[2], face[3]]);
                }
                3 => mesh
                    .triangles
                    .push([vertex(d, a), vertex(d, b), vertex(d, c)]),
                _ => {}
            }
        }
    }
    mesh
}

/// The corners of a tetrahedron in a right-handed order in which those inside come first, and how many these are.
fn inside_first(corners: [usize; 4], right_handed: bool, inside: [bool; 8]) -> ([usize; 4], usize) {
    let mut order = corners;
    let mut right = right_handed;
    let mut count = 0;
    for k in 0..4 {
        if inside[order[k]] {
            // Each swap changes the hand.
            for at in (count..k).rev() {
                order.swap(at, at + 1);
                right = !right;
            }
            count += 1;
        }
    }
    if !right {
        // Two that are alike on the surface's one side or other: three inside are the first, else the last two.
        let at = if count == 3 { 0 } else { 2 };
        order.swap(at, at + 1);
    }
    (order, count)
}

fn minus(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    core::array::from_fn(|d| a[d] - b[d])
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    (0..3).map(|d| a[d] * b[d]).sum()
}

fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    core::array::from_fn(|d| {
        let [e, f] = [(d + 1) % 3, (d + 2) % 3];
        a[e] * b[f] - a[f] * b[e]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::{assert_abs_diff_eq, assert_relative_eq};
    use core::f64::consts::PI;

    /// The surface of a function of place on a grid of 41 points a side.
    fn of(function: impl Fn(&[f64; 3]) -> f64) -> SurfaceMesh {
        let grid = SampleGrid::between([-1.0; 3], [1.0, 1.1, 1.2], [41; 3]).unwrap();
        let values: Vec<f64> = grid.points().iter().map(function).collect();
        marched(&grid, &values, 0.0)
    }

    /// Edges that are not those of two triangles, once in each direction.
    fn open_edges(mesh: &SurfaceMesh) -> usize {
        let mut edges = HashMap::new();
        for [a, b, c] in mesh.triangles() {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                *edges.entry((from, to)).or_insert(0) += 1;
            }
        }
        let unpaired = |((from, to), count): (&(&u32, &u32), &i32)| {
            *count != 1 || edges.get(&(*to, *from)) != Some(&1)
        };
        edges.iter().filter(|edge| unpaired(*edge)).count()
    }

    #[test]
    fn a_sphere_a_ring_and_a_plane_are_found_closed_and_outwards() {
        let ball = of(|x| 0.7 - dot(x, x).sqrt());
        assert_eq!(open_edges(&ball), 0);
        assert_relative_eq!(ball.volume(), 4.0 / 3.0 * PI * 0.343, max_relative = 3e-3);
        assert_relative_eq!(ball.area(), 4.0 * PI * 0.49, max_relative = 3e-3);
        // A hole changes what is joined to what: Euler's number is 0 for a ring, 2 for a sphere.
        let ring = of(|x| 0.25 - (x[0].hypot(x[1]) - 0.6).hypot(x[2]));
        assert_eq!(open_edges(&ring), 0);
        let euler =
            |mesh: &SurfaceMesh| mesh.vertices().len() as i64 - (mesh.triangles().len() / 2) as i64;
        assert_eq!((euler(&ball), euler(&ring)), (2, 0));
        assert_relative_eq!(
            ring.volume(),
            2.0 * PI * PI * 0.6 * 0.0625,
            max_relative = 1e-2
        );
        // Many small islands and bridges: every case of a tetrahedron occurs.
        let rough = of(|x| {
            let inside = x.iter().all(|x| x.abs() < 0.9);
            let waves = (17.0 * x[0]).sin() + (19.0 * x[1]).sin() + (23.0 * x[2]).sin();
            if inside { waves } else { -1.0 }
        });
        assert_eq!(open_edges(&rough), 0);
    }

    #[test]
    fn a_block_of_particles_has_its_faces_and_its_place_is_nothing() {
        use crate::prelude::*;
        let mesh = |at: f64| {
            let water = catalogue::weakly_compressible_water(2.0);
            let low = [at, 0.0, 0.0];
            let body = Body::block("water", water, low, [at + 0.1, 0.08, 0.06], 0.01);
            let other = catalogue::weakly_compressible_water(2.0);
            let beside = Body::block(
                "beside",
                other,
                [at + 0.1, 0.0, 0.0],
                [at + 0.2, 0.08, 0.06],
                0.01,
            );
            let scene = Scene::<f64, 3>::new(schemes::weakly_compressible());
            let simulation = scene.body(body).body(beside).build().unwrap();
            simulation.surface("water", 0.005, 0.5).unwrap()
        };
        let here = mesh(0.0);
        assert_eq!(open_edges(&here), 0);
        let extent = |d: usize| {
            let along = || here.vertices().iter().map(|x| x[d]);
            [
                along().fold(f64::INFINITY, f64::min),
                along().fold(f64::NEG_INFINITY, f64::max),
            ]
        };
        for (d, size) in [0.1, 0.08, 0.06].into_iter().enumerate() {
            let [low, high] = extent(d);
            assert_abs_diff_eq!(low, 0.0, epsilon = 1e-3);
            assert_abs_diff_eq!(high, size, epsilon = 1e-3);
        }
        let there = mesh(64.0);
        assert_eq!(here.triangles(), there.triangles());
        assert_relative_eq!(here.volume(), there.volume(), max_relative = 1e-9);
    }

    /// Images complete the filling before planes and ends of periods, and are no part of the body: its volume is that of a piece of a
    /// long bar, whose edges are rounded alike.
    #[test]
    fn planes_and_periods_close_a_surface() {
        use crate::prelude::*;
        let grid = 0.0025;
        let scene = |length: f64| {
            let water = catalogue::weakly_compressible_water(2.0);
            let body = Body::block("water", water, [0.0; 3], [length, 0.06, 0.06], 0.01);
            Scene::<f64, 3>::new(schemes::weakly_compressible()).body(body)
        };
        let mesh = |scene: Scene<f64, 3>| {
            let simulation = scene.build().unwrap();
            simulation.surface("water", grid, 0.5).unwrap()
        };
        let [long, longer, free] = [0.2, 0.3, 0.1].map(|length| mesh(scene(length)).volume());
        let piece = longer - long;
        let planes = [(0.0, -1.0), (0.1, 1.0)]
            .into_iter()
            .fold(scene(0.1), |scene, (x, out)| {
                scene.boundary(MirrorPlane::symmetry([x, 0.0, 0.0], [out, 0.0, 0.0]))
            });
        let period = scene(0.1).boundary(Periodic::along(0, 0.0, 0.1));
        for mesh in [planes, period].map(mesh) {
            assert_eq!(open_edges(&mesh), 0);
            for x in mesh.vertices() {
                assert!((-grid..=0.1 + grid).contains(&x[0]), "{x:?}");
            }
            assert_relative_eq!(mesh.volume(), piece, max_relative = 2.0 * grid / 0.1);
            assert!(mesh.volume() > 1.02 * free, "ends of their own are rounded");
        }
    }

    #[test]
    fn the_file_has_what_its_head_says() {
        let ball = of(|x| 0.7 - dot(x, x).sqrt());
        let path = std::env::temp_dir().join(format!("meshfree-ball-{}.ply", std::process::id()));
        ball.write_ply(&path).unwrap();
        let bytes = std::fs::read(&path).unwrap();
        std::fs::remove_file(&path).unwrap();
        let end = b"end_header\n";
        let head = bytes
            .windows(end.len())
            .position(|part| part == end)
            .unwrap()
            + end.len();
        assert_eq!(
            bytes.len() - head,
            24 * ball.vertices().len() + 13 * ball.triangles().len()
        );
        let first = f64::from_le_bytes(bytes[head..head + 8].try_into().unwrap());
        assert_eq!(first, ball.vertices()[0][0]);
    }

    #[test]
    fn what_cannot_be_is_named() {
        use crate::prelude::*;
        let water = catalogue::weakly_compressible_water(2.0);
        let body = Body::block("water", water, [0.0; 3], [0.05; 3], 0.01);
        let scene = Scene::<f64, 3>::new(schemes::weakly_compressible());
        let simulation = scene.body(body).build().unwrap();
        let message = |body, grid, level| {
            let refused = simulation.surface(body, grid, level);
            refused.unwrap_err().to_string()
        };
        assert!(message("wine", 0.01, 0.5).contains("water"));
        assert!(message("water", 0.0, 0.5).contains("grid of a surface"));
        assert!(message("water", f64::NAN, 0.5).contains("grid of a surface"));
        assert!(message("water", 1e-9, 0.5).contains("below 2³²"));
        assert!(message("water", 0.01, 1.0).contains("level of a surface"));
    }
}
