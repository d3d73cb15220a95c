//! Bodies of triangles filled row by row hold the points that the distance of each point gives, on any number of threads.
//! Rows go through corners, along edges and in faces too, and shells lie in shells.

use meshfree::geometry::{Ball, Mesh, Shape, fill, layers};
use meshfree::tensor::Matrix;
use std::time::Instant;

type Surface = (Vec<[f64; 3]>, Vec<[usize; 3]>);

/// A shape whose points are asked one by one.
#[derive(Debug)]
struct PointByPoint(Mesh);

impl Shape<3> for PointByPoint {
    fn signed_distance(&self, x: &[f64; 3]) -> f64 {
        self.0.signed_distance(x)
    }
    fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        self.0.bounds()
    }
}

/// A cube from −1 to 1 whose faces have n × n squares of two triangles.
fn cube(n: usize) -> Surface {
    let (mut corners, mut triangles) = (Vec::new(), Vec::new());
    let mut number = |x: [usize; 3]| {
        let at = x.map(|k| 2.0 * k as f64 / n as f64 - 1.0);
        corners
            .iter()
            .position(|old| *old == at)
            .unwrap_or_else(|| {
                corners.push(at);
                corners.len() - 1
            })
    };
    for (axis, side, i, j) in (0..3 * 2 * n * n).map(|k| (k % 3, k / 3 % 2, k / 6 % n, k / 6 / n)) {
        let mut corner = |u: usize, v: usize| {
            let mut x = [0; 3];
            (x[axis], x[(axis + 1) % 3], x[(axis + 2) % 3]) = (side * n, i + u, j + v);
            number(x)
        };
        let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
        let halves = [[a, b, c], [a, c, d]];
        triangles.extend(halves.map(|[a, b, c]| if side == 1 { [a, b, c] } else { [a, c, b] }));
    }
    (corners, triangles)
}

/// A ring about the third axis with radii 1 and `small` of n × m squares.
fn torus(n: usize, m: usize, small: f64) -> Surface {
    let turn = |k: usize, n: usize| (std::f64::consts::TAU * k as f64 / n as f64).sin_cos();
    let corners = (0..n * m).map(|k| {
        let ((s, c), (up, out)) = (turn(k / m, n), turn(k % m, m));
        let r = 1.0 + small * out;
        [r * c, r * s, small * up]
    });
    let at = |i: usize, j: usize| i % n * m + j % m;
    let squares = (0..n * m).map(|k| (k / m, k % m));
    let halves = squares.flat_map(|(i, j)| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    });
    (corners.collect(), halves.collect())
}

/// A cube of n × n squares a face, drawn to the unit sphere: its corners lie on planes x = 0 and on diagonals.
fn sphere(n: usize) -> Surface {
    let (corners, triangles) = cube(n);
    let unit = |x: [f64; 3]| x.map(|own| own / x.iter().map(|x| x * x).sum::<f64>().sqrt());
    (corners.into_iter().map(unit).collect(), triangles)
}

/// Turned about two axes, scaled and moved.
fn placed((corners, triangles): &Surface, turn: [f64; 2], scale: f64, shift: [f64; 3]) -> Surface {
    let [(s, c), (t, d)] = turn.map(f64::sin_cos);
    let own = |&[x, y, z]: &[f64; 3]| {
        let [x, y] = [c * x - s * y, s * x + c * y];
        let [y, z] = [d * y - t * z, t * y + d * z];
        [0, 1, 2].map(|k| scale * [x, y, z][k] + shift[k])
    };
    (corners.iter().map(own).collect(), triangles.clone())
}

/// Both surfaces as one; the second inside out if it is to be a cavity.
fn both(first: &Surface, second: &Surface, cavity: bool) -> Surface {
    let own = |t: &[usize; 3]| {
        let [a, b, c] = t.map(|k| k + first.0.len());
        if cavity { [a, c, b] } else { [a, b, c] }
    };
    let triangles = first.1.iter().copied().chain(second.1.iter().map(own));
    (
        [first.0.clone(), second.0.clone()].concat(),
        triangles.collect(),
    )
}

/// Surfaces, spacings and origins; a third of them with rows through corners, along edges and in faces.
fn cases() -> Vec<(&'static str, Surface, f64, [f64; 3])> {
    let (still, zero) = ([0.0; 2], [0.0; 3]);
    let mut cases = vec![
        ("cube, rows along diagonals", cube(8), 0.25, zero),
        ("cube, points on the surface", cube(8), 0.25, [0.125; 3]),
        ("cube, rows in faces", cube(3), 0.25, [0.0, 0.125, 0.125]),
        (
            "sphere, rows through corners",
            sphere(6),
            0.125,
            [0.0625; 3],
        ),
        (
            "torus, rows through corners",
            torus(16, 8, 0.5),
            0.125,
            [0.0625; 3],
        ),
        (
            "large",
            placed(&sphere(9), still, 1e3, [7e3; 3]),
            71.0,
            zero,
        ),
        (
            "small",
            placed(&torus(20, 9, 0.3), [0.3, 1.1], 1e-5, zero),
            1.3e-6,
            zero,
        ),
        (
            "cavity",
            both(&sphere(6), &placed(&cube(2), still, 0.25, zero), true),
            0.125,
            [0.0625; 3],
        ),
        (
            "shell in shell",
            both(&cube(4), &placed(&sphere(5), still, 0.5, zero), false),
            0.125,
            [0.0625; 3],
        ),
        (
            "overlap",
            both(&cube(4), &placed(&cube(4), still, 1.0, [0.5; 3]), false),
            0.125,
            [0.0625; 3],
        ),
    ];
    for k in 0..6 {
        let [a, b, c] = [2.0_f64, 3.0, 5.0].map(|x| (f64::from(k + 1) * x.sqrt()).fract());
        let turned = |surface: Surface| placed(&surface, [6.0 * a, 6.0 * b], 1.0, [a, b, c]);
        cases.push(("turned cube", turned(cube(1 + k as usize)), 0.17, [c, a, b]));
        cases.push((
            "turned sphere",
            turned(sphere(5 + k as usize)),
            0.17,
            [c, a, b],
        ));
        cases.push((
            "turned torus",
            turned(torus(23, 11, 0.4 + 0.1 * a)),
            0.13,
            [c, a, b],
        ));
    }
    cases
}

#[test]
fn rows_hold_what_points_one_by_one_hold() {
    let mut particles = 0;
    for (name, (corners, triangles), spacing, origin) in cases() {
        let mesh = Mesh::new(&corners, &triangles).unwrap();
        let rows = fill(&mesh, spacing, origin).unwrap();
        assert_eq!(
            rows,
            fill(&PointByPoint(mesh.clone()), spacing, origin).unwrap(),
            "{name}"
        );
        // The first order of the volume in the spacing.
        let volume = rows.len() as f64 * spacing.powi(3);
        let share = volume / mesh.volume();
        assert!((0.6..1.4).contains(&share), "{name}: {share}");
        particles += rows.len();
    }
    println!("{particles} particles");
}

#[test]
fn booleans_of_meshes_hold_what_points_hold() {
    let (corners, triangles) = placed(&torus(24, 12, 0.4), [0.4, 0.9], 1.0, [0.0; 3]);
    let mesh = Mesh::new(&corners, &triangles).unwrap();
    let (ball, dx) = (Ball::new([0.3, 0.1, 0.0], 1.0), 0.11);
    let [by_row, by_point] = [true, false].map(|by_row| {
        let own = || -> Box<dyn Shape<3>> {
            if by_row {
                Box::new(mesh.clone())
            } else {
                Box::new(PointByPoint(mesh.clone()))
            }
        };
        [
            fill(&ball.minus(own()), dx, [0.0; 3]).unwrap(),
            fill(&ball.union(own()), dx, [0.0; 3]).unwrap(),
            fill(&own().intersection(ball), dx, [0.0; 3]).unwrap(),
        ]
    });
    assert_eq!(by_row, by_point);
    assert!(by_row.iter().all(|points| points.len() > 100));
}

#[test]
fn any_number_of_threads_fills_alike() {
    let (corners, triangles) = placed(&sphere(12), [0.7, 0.2], 1.0, [0.1, 0.2, 0.3]);
    let mesh = Mesh::new(&corners, &triangles).unwrap();
    let of = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let both = || {
            (
                fill(&mesh, 0.04, [0.0; 3]),
                layers(&mesh, 0.2, 0.4, [0.0; 3]),
            )
        };
        let (filled, wall) = pool.unwrap().install(both);
        (filled.unwrap(), wall.unwrap())
    };
    let one = of(1);
    for threads in [2, 3, 8] {
        assert_eq!(of(threads), one, "{threads} threads");
    }
}

/// R = R_y(b) R_z(a), to the rounding of sines.
fn turn(a: f64, b: f64) -> Matrix<f64, 3> {
    let ([s, c], [t, d]) = (a.sin_cos().into(), b.sin_cos().into());
    let about_z = Matrix::<f64, 3>::new(c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0);
    let about_y = Matrix::<f64, 3>::new(d, 0.0, t, 0.0, 1.0, 0.0, -t, 0.0, d);
    about_y * about_z
}

/// A mesh whose triangles are turned is the shape that turns points: the same particles, the same distances.
#[test]
fn placed_meshes_hold_what_moved_ones_hold() {
    let mirror = Matrix::<f64, 3>::from_diagonal(&[-1.0, 1.0, 1.0].into());
    for (k, (name, (corners, triangles), spacing, origin)) in cases().into_iter().enumerate() {
        let mesh = Mesh::new(&corners, &triangles).unwrap();
        let mut rotation = turn(0.3 + k as f64, 1.0 / (1.0 + k as f64));
        if k % 2 == 1 {
            rotation *= mirror;
        }
        let shift = [3.7, -2.3, 0.41].map(|x| x * spacing);
        let placed = mesh.clone().placed(rotation, shift).unwrap();
        assert_eq!(placed.volume(), mesh.volume(), "{name}");
        let moved = mesh.moved(rotation, shift);
        let by_rows = fill(&placed, spacing, origin).unwrap();
        assert_eq!(by_rows, fill(&moved, spacing, origin).unwrap(), "{name}");
        for x in by_rows.iter().step_by(7) {
            let [a, b] = [placed.signed_distance(x), moved.signed_distance(x)];
            assert!((a - b).abs() < 1e-9 * spacing, "{name}: {a}, {b}");
        }
    }
}

#[test]
fn placed_meshes_refuse_what_stretches() {
    let (corners, triangles) = cube(1);
    let mesh = Mesh::new(&corners, &triangles).unwrap();
    let refused = |rotation: Matrix<f64, 3>, shift: [f64; 3], what: &str| {
        let error = mesh.clone().placed(rotation, shift).map(drop);
        let error = error.expect_err(what).to_string();
        assert!(error.contains(what), "{error}");
    };
    let one = Matrix::<f64, 3>::identity();
    refused(one * 1.001, [0.0; 3], "orthonormal");
    refused(one * f64::NAN, [0.0; 3], "rotation");
    refused(one, [0.0, f64::INFINITY, 0.0], "shift of the shape");
}

/// 108 000 triangles and half a million particles, turned and filled row by row: the whole test takes 2.5 s of one core.
#[test]
fn a_placed_mesh_of_many_triangles_fills_by_rows() {
    let rotation = turn(0.6, 0.2);
    let (corners, triangles) = torus(600, 90, 0.4);
    let spacing =
        (0.5 * 0.4_f64 * 0.4 * std::f64::consts::TAU * std::f64::consts::PI / 2.5e5).cbrt();
    let mesh = Mesh::new(&corners, &triangles).unwrap();
    let began = Instant::now();
    let placed = mesh.clone().placed(rotation, [0.1, 0.2, 0.3]).unwrap();
    let turned = began.elapsed();
    let points = fill(&placed, spacing, [0.0; 3]).unwrap();
    println!(
        "{} triangles, {} particles: turned in {turned:?}, filled after {:?}",
        mesh.triangles(),
        points.len(),
        began.elapsed()
    );
    assert!(points.len() > 400_000);
    // A hundredth of the lattice point by point, in a box of the mesh.
    let moved = mesh.moved(rotation, [0.1, 0.2, 0.3]);
    let part = meshfree::geometry::Cuboid::new([0.8, -0.2, -0.6], [1.2, 0.2, 0.6]);
    let of = |shape: &dyn Shape<3>| {
        let all = fill(shape, spacing, [0.0; 3]).unwrap();
        all.into_iter()
            .filter(|x| part.signed_distance(x) < 0.0)
            .collect::<Vec<_>>()
    };
    let slow = fill(&moved.intersection(part), spacing, [0.0; 3]).unwrap();
    let by_rows = of(&placed);
    assert!(slow.len() > 1000);
    assert_eq!(slow, by_rows);
}
