//! Shapes against sampled surfaces, areas and volumes, and lattices against exact counts.
//! Wrong input is refused by name.

use super::*;
use crate::error::{Error, Problem};
use crate::material::catalogue;
use crate::scene::Body;
use core::f64::consts::PI;
use proptest::prelude::*;

/// The numbers from −1 to 1 in `n` equal steps.
fn steps(n: usize) -> impl Iterator<Item = f64> + Clone {
    (0..=n).map(move |k| 2.0 * k as f64 / n as f64 - 1.0)
}

fn distance<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    length(&(Vector::from(*a) - Vector::from(*b)))
}

fn turn(angle: f64) -> Matrix<f64, 2> {
    let (s, c) = angle.sin_cos();
    Matrix::<f64, 2>::new(c, -s, s, c)
}

/// Holds distances of a shape against the nearest of points that lie on its surface, `pitch` apart.
fn nearest_is_as_near<const D: usize>(shape: &impl Shape<D>, surface: &[[f64; D]], pitch: f64) {
    for x in surface {
        assert!(shape.signed_distance(x).abs() < 1e-12, "{x:?}");
    }
    for k in 0..200 {
        // Places that fill the cube of side 6 evenly: multiples of irrational numbers.
        let x = core::array::from_fn(|d| {
            6.0 * ((k + 1) as f64 * [2.0_f64, 3.0, 5.0][d].sqrt()).fract() - 3.0
        });
        let sampled = surface
            .iter()
            .map(|s| distance(s, &x))
            .fold(f64::INFINITY, f64::min);
        let given = shape.signed_distance(&x).abs();
        assert!(given <= sampled + 1e-12, "{x:?}: {given} {sampled}");
        assert!(sampled - given <= pitch, "{x:?}: {given} {sampled}");
    }
}

#[test]
fn distance_to_a_box_is_that_to_the_nearest_point_of_its_faces() {
    let (low, high) = ([-1.0, -0.5, -2.0], [1.0, 1.5, 1.0]);
    let middle: [f64; 3] = core::array::from_fn(|d| 0.5 * (low[d] + high[d]));
    let half: [f64; 3] = core::array::from_fn(|d| 0.5 * (high[d] - low[d]));
    let mut surface = Vec::new();
    for d in 0..3 {
        for side in [-1.0, 1.0] {
            for u in steps(60) {
                for v in steps(60) {
                    let mut x = middle;
                    x[d] += side * half[d];
                    x[(d + 1) % 3] += u * half[(d + 1) % 3];
                    x[(d + 2) % 3] += v * half[(d + 2) % 3];
                    surface.push(x);
                }
            }
        }
    }
    nearest_is_as_near(&Cuboid::new(low, high), &surface, 0.05);
}

#[test]
fn distance_to_a_cylinder_is_that_to_the_nearest_point_of_its_surface() {
    // Along the space diagonal, with two directions at right angles to it.
    let axis = Vector::from([1.0, 1.0, 1.0]) / 3.0_f64.sqrt();
    let across = Vector::from([1.0, -1.0, 0.0]) / 2.0_f64.sqrt();
    let other = axis.cross(&across);
    let (r, half) = (0.8, 1.2);
    let mut surface = Vec::new();
    for angle in steps(120).map(|u| PI * u) {
        let rim = across * angle.cos() + other * angle.sin();
        for u in steps(60) {
            surface.push((rim * r + axis * (half * u)).into());
            surface.push((rim * (r * u.abs()) + axis * half.copysign(u)).into());
            surface.push((rim * (r * u.abs()) - axis * half.copysign(u)).into());
        }
    }
    let bar = Cylinder::between((axis * -half).into(), (axis * half).into(), r);
    nearest_is_as_near(&bar, &surface, 0.05);
    // The box ends where the rims of the end discs do.
    let reach = half / 3.0_f64.sqrt() + r * (2.0_f64 / 3.0).sqrt();
    let (low, high) = bar.bounds();
    for d in 0..3 {
        assert!((high[d] - reach).abs() < 1e-14 && (low[d] + reach).abs() < 1e-14);
        let most = surface.iter().map(|x: &[f64; 3]| x[d]).fold(0.0, f64::max);
        assert!(most <= high[d] + 1e-12 && most > high[d] - 1e-3);
    }
}

#[test]
fn distances_do_not_depend_on_the_direction() {
    let (ball, pipe) = (
        Ball::new([0.0; 3], 1.0),
        Cylinder::infinite([0.0; 3], [0.0, 0.0, 2.0], 1.0),
    );
    for angle in steps(20).map(|u| PI * u) {
        let (s, c) = angle.sin_cos();
        assert!((ball.signed_distance(&[3.0 * c, 0.0, 3.0 * s]) - 2.0).abs() < 1e-14);
        assert!((pipe.signed_distance(&[0.4 * c, 0.4 * s, 7.0 * c]) + 0.6).abs() < 1e-14);
        // A square is the same after a quarter turn, and no other than its image in a mirror.
        let square = Cuboid::new([-1.0; 2], [1.0; 2]);
        let x = [2.0 * c, 1.3 * s];
        let d = square.signed_distance(&x);
        assert_eq!(d, square.signed_distance(&[-x[1], x[0]]));
        assert_eq!(d, square.signed_distance(&[-x[0], x[1]]));
        // A half-plane through the origin, turned, has the turned normal.
        let turned = HalfSpace::new([0.0; 2], [1.0, 0.0]).moved(turn(angle), [0.5, 0.0]);
        let straight = HalfSpace::new([0.5, 0.0], [c, s]);
        assert!((turned.signed_distance(&x) - straight.signed_distance(&x)).abs() < 1e-14);
    }
}

#[test]
fn bounds_end_where_the_shape_ends() {
    let inf = f64::INFINITY;
    let floor = HalfSpace::new([0.0, 0.0, 2.0], [0.0, 0.0, 5.0]);
    assert_eq!(floor.bounds(), ([-inf; 3], [inf, inf, 2.0]));
    let roof = HalfSpace::new([0.0, 0.0, -1.0], [0.0, 0.0, -1.0]);
    assert_eq!(roof.bounds(), ([-inf, -inf, -1.0], [inf; 3]));
    let oblique = HalfSpace::new([0.0; 3], [1.0, 1.0, 0.0]);
    assert_eq!(oblique.bounds(), ([-inf; 3], [inf; 3]));
    let pipe = Cylinder::infinite([1.0, 2.0, 3.0], [0.0, 1.0, 0.0], 0.5);
    assert_eq!(pipe.bounds(), ([0.5, -inf, 2.5], [1.5, inf, 3.5]));
    // Endless shapes may have a bounded part in common, to be filled.
    let slab = floor.intersection(roof);
    let column = slab.intersection(Cuboid::new([0.0, 0.0, -inf], [1.0, 1.0, inf]));
    assert_eq!(column.bounds(), ([0.0, 0.0, -1.0], [1.0, 1.0, 2.0]));
    assert_eq!(fill(&column, 0.25, [0.0; 3]).unwrap().len(), 4 * 4 * 12);
    // A slab that is moved keeps its ends and has none where it had none; a square turned is wider.
    let slab = Cuboid::new([-inf, 0.0], [inf, 1.0]).moved(turn(0.0), [3.0, 1.0]);
    assert_eq!(slab.bounds(), ([-inf, 1.0], [inf, 2.0]));
    let square = Cuboid::new([-1.0; 2], [1.0; 2]).moved(turn(PI / 4.0), [0.0; 2]);
    assert!((square.bounds().1[0] - 2.0_f64.sqrt()).abs() < 1e-15);
}

/// Two shapes that overlap, and their booleans as truth tables.
#[test]
fn booleans_are_those_of_logic() {
    let (a, b) = (
        Ball::new([0.0; 2], 1.0),
        Cuboid::new([0.2, -0.4], [2.0, 0.5]),
    );
    for x in steps(31) {
        for y in steps(31) {
            let x = [2.0 * x, 2.0 * y];
            let (in_a, in_b) = (
                x[0].hypot(x[1]) < 1.0,
                x[0] > 0.2 && x[0] < 2.0 && x[1] > -0.4 && x[1] < 0.5,
            );
            let inside = |s: &dyn Shape<2>| s.signed_distance(&x) < 0.0;
            assert_eq!(inside(&a.union(b)), in_a || in_b);
            assert_eq!(inside(&a.intersection(b)), in_a && in_b);
            assert_eq!(inside(&a.minus(b)), in_a && !in_b);
            assert_eq!(inside(&b.minus(a)), in_b && !in_a);
            assert_eq!(inside(&a.complement()), !in_a);
        }
    }
    // Shapes chosen at run time.
    let mut row: Box<dyn Shape<2>> = Box::new(Ball::new([0.0; 2], 0.5));
    for k in 1..4 {
        row = Box::new(row.union(Ball::new([2.0 * f64::from(k), 0.0], 0.5)));
    }
    assert_eq!(row.bounds(), ([-0.5; 2], [6.5, 0.5]));
    assert_eq!(row.signed_distance(&[3.0, 0.0]), 0.5);
}

/// The volume that is counted: cells whose centre is inside.
fn volume<const D: usize>(shape: &impl Shape<D>, spacing: f64) -> f64 {
    let points = fill(shape, spacing, [0.0; D]).unwrap();
    points.len() as f64 * spacing.powi(D as i32)
}

/// Cells that are counted wrongly are cut by the surface, so the error is below surface times
/// spacing times √D/2, the half diagonal of a cell.
fn converges<const D: usize>(shape: &impl Shape<D>, exact: f64, surface: f64, size: f64) {
    for n in [10.0, 20.0, 40.0, 80.0] {
        let spacing = size / n;
        let error = (volume(shape, spacing) - exact).abs();
        assert!(
            error < surface * spacing * (D as f64).sqrt() / 2.0,
            "{shape:?} at size/{n}: {error} of {exact}"
        );
    }
    let error = volume(shape, size / 80.0) / exact - 1.0;
    assert!(error.abs() < 0.01, "{shape:?}: {error}");
}

#[test]
fn volumes_by_counting_converge_at_first_order() {
    let r = 0.013;
    converges(&Ball::new([0.1], r), 2.0 * r, 2.0, 2.0 * r);
    converges(&Ball::new([0.1, 0.2], r), PI * r * r, 2.0 * PI * r, 2.0 * r);
    let sphere = (4.0 / 3.0 * PI * r.powi(3), 4.0 * PI * r * r);
    converges(&Ball::new([0.1, 0.2, 0.3], r), sphere.0, sphere.1, 2.0 * r);
    let bar = Cylinder::between([0.01, 0.02, 0.03], [0.02, 0.03, 0.05], r);
    let long = 6.0_f64.sqrt() * 0.01;
    converges(&bar, PI * r * r * long, 2.0 * PI * r * (long + r), 2.0 * r);
    // A lens of two discs whose centres are one radius apart, and what it leaves of one.
    let (a, b) = (Ball::new([0.0; 2], r), Ball::new([r, 0.0], r));
    let lens = r * r * (2.0 * PI / 3.0 - 3.0_f64.sqrt() / 2.0);
    let edge = 2.0 * PI * r;
    converges(&a.intersection(b), lens, 2.0 / 3.0 * edge, r);
    converges(&a.minus(b), PI * r * r - lens, edge, 2.0 * r);
    converges(
        &a.union(b),
        2.0 * PI * r * r - lens,
        4.0 / 3.0 * edge,
        3.0 * r,
    );
    let square = Cuboid::new([0.0; 2], [r; 2]).moved(turn(0.4), [0.1, 0.2]);
    converges(&square, r * r, 4.0 * r, 1.4 * r);
}

#[test]
fn a_box_gives_the_points_of_a_block() {
    let (low, high) = ([0.01, -0.02, 0.5], [0.03, 0.02, 0.53]);
    let block: Body<f64, 3> = Body::block("a", catalogue::water(), low, high, 1e-3);
    let filled: Body<f64, 3> = Body::fill("a", catalogue::water(), &Cuboid::new(low, high), 1e-3);
    assert_eq!(block.points().len(), 20 * 40 * 30);
    assert_eq!(block.points().len(), filled.points().len());
    for (a, b) in block.points().iter().zip(filled.points()) {
        assert!(distance(a, b) < 1e-15, "{a:?} {b:?}");
    }
}

#[test]
fn walls_of_a_box_have_the_exact_count() {
    fn count<const D: usize>(cells: [usize; D], layer: usize) {
        let spacing = 0.02;
        let low = [0.3; D];
        let high = core::array::from_fn(|d| low[d] + cells[d] as f64 * spacing);
        let inside = Cuboid::new(low, high);
        let wall = layers(&inside, spacing, layer as f64 * spacing, low).unwrap();
        let all: usize = cells.iter().map(|n| n + 2 * layer).product();
        assert_eq!(wall.len(), all - cells.iter().product::<usize>());
        for x in &wall {
            assert!(inside.signed_distance(x) > 0.49 * spacing);
        }
        // The corner's outermost point.
        let corner = low.map(|x| x - (layer as f64 - 0.5) * spacing);
        assert!(wall.iter().any(|x| distance(x, &corner) < 1e-12));
    }
    for layer in 1..=4 {
        count([7], layer);
        count([7, 4], layer);
        count([5, 4, 3], layer);
    }
    // Between two whole numbers the lower counts, because the last layer is half a spacing nearer.
    let unit = Cuboid::new([0.0], [1.0]);
    for (thickness, points) in [
        (0.1, 2),
        (0.24, 4),
        (0.25, 6),
        (0.26, 6),
        (0.34, 6),
        (0.36, 8),
    ] {
        assert_eq!(layers(&unit, 0.1, thickness, [0.0]).unwrap().len(), points);
    }
}

/// Whatever is within reach of any place in the shape is in the wall or in the shape.
#[test]
fn nothing_in_reach_is_missing_from_a_wall() {
    let (spacing, reach) = (0.1, 0.24);
    let shape = Ball::new([0.03, 0.01], 0.7).union(Cuboid::new([0.0; 2], [1.04, 0.33]));
    let wall = layers(&shape, spacing, reach, [0.0; 2]).unwrap();
    let has = |k: [i32; 2]| {
        let at = k.map(|k| (f64::from(k) + 0.5) * spacing);
        shape.signed_distance(&at) < 0.0 || wall.iter().any(|x| distance(x, &at) < 1e-9)
    };
    let mut seen = 0;
    for x in fill(&shape, 0.013, [0.0; 2]).unwrap() {
        let near = x.map(|x| (x / spacing).floor() as i32);
        for i in -4..=4 {
            for j in -4..=4 {
                let k = [near[0] + i, near[1] + j];
                if distance(&x, &k.map(|k| (f64::from(k) + 0.5) * spacing)) < reach {
                    assert!(has(k), "{k:?} from {x:?}");
                    seen += 1;
                }
            }
        }
    }
    assert!(seen > 100_000);
    // And none is farther off than the corner of a box of that thickness, to half a spacing.
    for x in &wall {
        let d = shape.signed_distance(x);
        assert!((0.0..=(reach + 0.5 * spacing) * 2.0_f64.sqrt()).contains(&d));
    }
}

/// Holes of 3 mm, and what Vesenjak & Ren (2007) print of the three structures.
#[test]
fn open_cells_have_the_printed_densities() {
    for (wall, density, printed) in [
        (1.5e-3, 0.3718, 0.37),
        (1.0e-3, 0.2713, 0.27),
        (0.5e-3, 0.1595, 0.16),
    ] {
        let cells = OpenCell::new(3e-3, wall).at([0.01, -0.02, 0.0]);
        assert!((cells.relative_density() / density - 1.0).abs() < 5e-4);
        assert!((cells.relative_density() - printed).abs() < 0.005);
        let whole = cells.side().powi(3);
        for n in [20.0, 40.0, 80.0] {
            let spacing = cells.side() / n;
            let count = |part: OpenCellPart| {
                let points = fill(&part, spacing, part.bounds().0).unwrap();
                points.len() as f64 * spacing.powi(3)
            };
            let (solid, void) = (count(cells.solid()), count(cells.void()));
            assert!(((solid + void) / whole - 1.0).abs() < 1e-12);
            // Cut cells: the curved surface is below that of the three holes.
            let surface = 3.0 * PI * 3e-3 * cells.side();
            let error = (void - cells.void_volume()).abs();
            assert!(error < surface * spacing * 3.0_f64.sqrt() / 2.0);
            if n == 80.0 {
                let relative = solid / whole / density - 1.0;
                assert!(relative.abs() < 0.01, "c = {wall}: {relative}");
            }
        }
    }
}

#[test]
fn open_cells_repeat() {
    let one = OpenCell::new(3e-3, 1e-3);
    let block = one.tiled([3, 2, 1]);
    let count = |part: OpenCellPart| fill(&part, 2e-4, [0.0; 3]).unwrap().len();
    assert_eq!(count(block.solid()), 6 * count(one.solid()));
    assert_eq!(count(block.void()), 6 * count(one.void()));
    assert_eq!(block.solid().bounds(), ([0.0; 3], [12e-3, 8e-3, 4e-3]));
    // The solid is a block less three holes a cell: the same by booleans of primitives.
    let hole = |axis| Cylinder::infinite([2e-3; 3], axis, 1.5e-3);
    let pierced = Cuboid::new([0.0; 3], [4e-3; 3])
        .minus(hole([1.0, 0.0, 0.0]))
        .minus(hole([0.0, 1.0, 0.0]))
        .minus(hole([0.0, 0.0, 1.0]));
    for x in fill(&Cuboid::new([0.0; 3], [4e-3; 3]), 3e-4, [0.0; 3]).unwrap() {
        let (a, b) = (one.solid().signed_distance(&x), pierced.signed_distance(&x));
        assert!((a - b).abs() < 1e-17, "{x:?}: {a} {b}");
    }
}

/// The error's field, value and advice.
fn refused<T>(result: crate::error::Result<T>) -> (String, f64, &'static str) {
    match result {
        Err(Error::Argument(Problem::Parameter {
            what,
            value,
            must_be,
        })) => (what, value, must_be),
        Err(other) => panic!("{other}"),
        Ok(_) => panic!("accepted"),
    }
}

#[test]
fn wrong_input_is_refused_by_name() {
    let names = |shape: &dyn Shape<3>, name: &str| {
        let (what, _, must_be) = refused(fill(shape, 0.1, [0.0; 3]));
        assert!(what.contains(name), "{what} {must_be}");
        assert!(refused(layers(shape, 0.1, 0.3, [0.0; 3])).0.contains(name));
    };
    let (nan, x) = (f64::NAN, [1.0, 0.0, 0.0]);
    let ball = Ball::new([0.0; 3], 1.0);
    for bad in [0.0, -1.0, nan, f64::INFINITY] {
        names(&Ball::new([0.0; 3], bad), "radius of the ball");
        names(
            &Cylinder::between([0.0; 3], x, bad),
            "radius of the cylinder",
        );
        names(&OpenCell::new(bad, 1.0).solid(), "hole diameter");
        names(&OpenCell::new(1.0, bad).void(), "wall thickness");
        assert_eq!(refused(fill(&ball, bad, [0.0; 3])).0, "spacing");
        assert_eq!(refused(layers(&ball, bad, 0.3, [0.0; 3])).0, "spacing");
        assert!(
            refused(layers(&ball, 0.1, bad, [0.0; 3]))
                .0
                .contains("thickness")
        );
    }
    names(&Ball::new([0.0, nan, 0.0], 1.0), "centre");
    names(&Cuboid::new([0.0; 3], [1.0, -1.0, 1.0]), "size of the box");
    names(&Cuboid::new([0.0; 3], [1.0, nan, 1.0]), "size of the box");
    names(&HalfSpace::new([0.0; 3], [0.0; 3]), "normal");
    names(&Cylinder::between(x, x, 1.0), "axis");
    names(
        &OpenCell::new(1.0, 1.0).tiled([1, 0, 1]).void(),
        "number of open cells",
    );
    names(
        &OpenCell::new(1.0, 1.0).at([nan; 3]).void(),
        "origin of the open cells",
    );
    names(
        &ball.moved(Matrix::<f64, 3>::identity() * 2.0, x),
        "rotation",
    );
    names(
        &ball.moved(Matrix::<f64, 3>::identity() * nan, x),
        "rotation",
    );
    names(&ball.moved(Matrix::<f64, 3>::identity(), [nan; 3]), "shift");
    // Parts of booleans are asked too.
    names(&ball.minus(Ball::new([0.0; 3], -2.0)), "radius of the ball");
    names(&ball.union(Ball::new([0.0; 3], -2.0)), "radius of the ball");
    // No end.
    for endless in [
        Box::new(HalfSpace::new([0.0; 3], x)) as Box<dyn Shape<3>>,
        Box::new(Cylinder::infinite([0.0; 3], x, 1.0)),
        Box::new(ball.complement()),
    ] {
        names(&endless, "extent of the shape");
    }
    assert!(refused(fill(&ball, 0.1, [nan; 3])).0.contains("origin"));
    let (what, value, must_be) = refused(fill(&ball, 1e-6, [0.0; 3]));
    assert_eq!(what, "number of lattice points");
    assert!(value > 7.9e18 && must_be.contains("check that the spacing is in metres"));
    // Shapes that are apart have nothing in common, which is no error.
    let apart = ball.intersection(Ball::new([9.0; 3], 1.0));
    assert!(fill(&apart, 0.1, [0.0; 3]).unwrap().is_empty());
}

proptest! {
    /// A shape and its complement share out the lattice, also where points lie on the surface.
    #[test]
    fn a_shape_and_its_complement_share_the_lattice(
        radius in 1..12_i32, centre in -3..3_i32, low in -6..0_i32, high in 1..6_i32,
    ) {
        // Whole and half multiples of the spacing, so that surfaces go through points.
        let at = |k: i32| 0.05 * f64::from(k);
        let shape = Ball::new([at(centre); 2], at(radius)).minus(Cuboid::new([at(low); 2], [at(high); 2]));
        let all = Cuboid::new([-1.0; 2], [1.0; 2]);
        let inside = fill(&all.intersection(shape), 0.1, [0.0; 2]).unwrap();
        let outside = fill(&all.minus(shape), 0.1, [0.0; 2]).unwrap();
        prop_assert_eq!(inside.len() + outside.len(), 400);
        prop_assert!(inside.iter().all(|x| !outside.contains(x)));
    }

    /// A distance never changes by more than the way between two places.
    #[test]
    fn no_distance_is_too_long(a in prop::array::uniform3(-3.0..3.0_f64), b in prop::array::uniform3(-3.0..3.0_f64)) {
        let pipe = Cylinder::infinite([0.5; 3], [1.0, 2.0, -1.0], 0.7);
        let shapes: [Box<dyn Shape<3>>; 4] = [
            Box::new(Cuboid::new([-1.0; 3], [1.0, 0.5, 2.0]).minus(pipe)),
            Box::new(Ball::new([0.2; 3], 1.1).union(pipe)),
            Box::new(OpenCell::new(0.6, 0.2).tiled([2, 3, 1]).solid()),
            Box::new(OpenCell::new(0.6, 0.2).tiled([2, 3, 1]).void()),
        ];
        for shape in &shapes {
            let change = shape.signed_distance(&a) - shape.signed_distance(&b);
            prop_assert!(change.abs() <= distance(&a, &b) + 1e-12, "{:?}", shape);
        }
    }
}
