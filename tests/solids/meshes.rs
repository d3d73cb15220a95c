//! Shapes from triangle meshes against boxes and balls, through STL files, whole and broken.
//! A sphere of facets has the distance of a sphere within the height of a facet's arc.

use approx::assert_relative_eq;
use meshfree::error::Error;
use meshfree::geometry::{Cuboid, Mesh, Shape, fill};
use std::collections::HashMap;
use std::path::PathBuf;

type Surface = (Vec<[f64; 3]>, Vec<[usize; 3]>);

const LOW: [f64; 3] = [-0.5, 0.25, 1.0];
const HIGH: [f64; 3] = [0.5, 1.0, 2.5];

/// A box of twelve triangles.
fn cuboid() -> Surface {
    let corners = (0..8).map(|n| core::array::from_fn(|d| [LOW, HIGH][n >> d & 1][d]));
    let quads = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let halves = quads
        .iter()
        .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
    (corners.collect(), halves.collect())
}

/// An octahedron whose triangles are parted in four so many times, with all corners on the unit sphere.
fn sphere(times: usize) -> Surface {
    let mut corners = vec![
        [1.0, 0.0, 0.0],
        [-1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, -1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.0, 0.0, -1.0],
    ];
    let mut triangles = vec![
        [0, 2, 4],
        [2, 1, 4],
        [1, 3, 4],
        [3, 0, 4],
        [2, 0, 5],
        [1, 2, 5],
        [3, 1, 5],
        [0, 3, 5],
    ];
    for _ in 0..times {
        let mut known = HashMap::new();
        let mut middle = |a: usize, b: usize| {
            *known.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                let sum: [f64; 3] = core::array::from_fn(|d| corners[a][d] + corners[b][d]);
                let size = sum.iter().map(|x| x * x).sum::<f64>().sqrt();
                corners.push(sum.map(|x| x / size));
                corners.len() - 1
            })
        };
        triangles = triangles
            .iter()
            .flat_map(|&[a, b, c]| {
                let [d, e, f] = [middle(a, b), middle(b, c), middle(c, a)];
                [[a, d, f], [d, b, e], [f, e, c], [d, e, f]]
            })
            .collect();
    }
    (corners, triangles)
}

/// Places that fill the cube from −2 to 2 evenly.
fn places() -> impl Iterator<Item = [f64; 3]> {
    (1..500).map(|k| [2.0_f64, 3.0, 5.0].map(|x| 4.0 * (f64::from(k) * x.sqrt()).fract() - 2.0))
}

fn binary((corners, triangles): &Surface, header: &[u8]) -> Vec<u8> {
    let mut bytes = header.to_vec();
    bytes.resize(80, b' ');
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for triangle in triangles {
        let normal = [0.0_f32; 3];
        let at = triangle.map(|n| corners[n].map(|x| x as f32));
        for x in [normal].iter().chain(&at).flatten() {
            bytes.extend(x.to_le_bytes());
        }
        bytes.extend([0, 0]);
    }
    bytes
}

fn text((corners, triangles): &Surface) -> String {
    let mut text = String::from("solid shape\n");
    for triangle in triangles {
        text += "facet normal 0 0 0\nouter loop\n";
        for n in triangle {
            let [x, y, z] = corners[*n];
            // Zero of either sign is one place.
            let x = if x == 0.0 && n % 2 == 0 { -0.0 } else { x };
            text += &format!("vertex {x:e} {y:e} {z:e}\n");
        }
        text += "endloop\nendfacet\n";
    }
    text + "endsolid shape\n"
}

fn written(name: &str, bytes: &[u8]) -> PathBuf {
    let path = std::env::temp_dir().join(format!("meshfree_{}_{name}.stl", std::process::id()));
    std::fs::write(&path, bytes).unwrap();
    path
}

fn read(name: &str, bytes: &[u8], unit: f64) -> Result<Mesh, Error> {
    let path = written(name, bytes);
    let mesh = Mesh::read(&path, unit);
    std::fs::remove_file(path).unwrap();
    mesh
}

#[test]
fn a_box_of_triangles_is_a_box() {
    let (corners, triangles) = cuboid();
    let exact = Cuboid::new(LOW, HIGH);
    let mesh = Mesh::new(&corners, &triangles).unwrap();
    let turned: Vec<_> = triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
    let turned = Mesh::new(&corners, &turned).unwrap();
    for mesh in [&mesh, &turned] {
        assert!((mesh.volume() - 1.125).abs() < 1e-14);
        for x in places() {
            let [own, exact] = [mesh.signed_distance(&x), exact.signed_distance(&x)];
            assert!((own - exact).abs() < 1e-14, "{x:?}: {own} {exact}");
        }
    }
    let dx = 0.125;
    assert_eq!(
        fill(&mesh, dx, LOW).unwrap(),
        fill(&exact, dx, LOW).unwrap()
    );
}

#[test]
fn a_sphere_of_triangles_is_one_within_its_facets() {
    let surface = sphere(4);
    let mesh = Mesh::new(&surface.0, &surface.1).unwrap();
    assert_eq!(mesh.triangles(), 8 * 4_usize.pow(4));
    let ball = 4.0 / 3.0 * std::f64::consts::PI;
    // The largest facets lie as deep as the foot of their plane.
    let depth = surface.1.iter().map(|triangle| {
        let sum: [f64; 3] =
            core::array::from_fn(|d| triangle.iter().map(|&n| surface.0[n][d] / 3.0).sum());
        1.0 - sum.iter().map(|x| x * x).sum::<f64>().sqrt()
    });
    let depth = depth.fold(0.0, f64::max);
    let (mut worst, mut winding) = (0.0_f64, 0.0_f64);
    for x in places() {
        let exact = x.iter().map(|x| x * x).sum::<f64>().sqrt() - 1.0;
        let own = mesh.signed_distance(&x);
        worst = worst.max((own - exact).abs());
        if exact.abs() > depth {
            let inside = f64::from(u8::from(exact < 0.0));
            winding = winding.max((mesh.winding_number(&x) - inside).abs());
        }
    }
    let dx = 0.05;
    let filled = fill(&mesh, dx, [-1.0; 3]).unwrap().len() as f64 * dx.powi(3);
    println!(
        "facets {depth:.1e} deep: distance within {worst:.1e}, winding number within {winding:.1e}, volume of the mesh {:+.2e} \
         of the ball's, of the particles {:+.2e} of the mesh's",
        mesh.volume() / ball - 1.0,
        filled / mesh.volume() - 1.0
    );
    assert!(worst < 1.01 * depth && depth < 5e-3, "{worst:e} {depth:e}");
    assert!(winding < 0.03, "{winding}");
    assert_relative_eq!(
        mesh.volume(),
        ball,
        epsilon = 0.0,
        max_relative = 3.0 * depth
    );
    assert_relative_eq!(filled, mesh.volume(), epsilon = 0.0, max_relative = 5e-3);
}

#[test]
fn files_in_both_forms_and_units_are_read() {
    let surface = cuboid();
    for (name, bytes) in [
        ("binary", binary(&surface, b"made by a test")),
        ("solid", binary(&surface, b"solid in name only")),
        ("text", text(&surface).into_bytes()),
    ] {
        let mesh = read(name, &bytes, 1e-3).unwrap();
        assert_eq!(mesh.triangles(), 12, "{name}");
        assert_relative_eq!(mesh.volume(), 1.125e-9, epsilon = 0.0, max_relative = 1e-12);
        assert!((mesh.signed_distance(&[0.0, 5e-4, 1.25e-3]) + 2.5e-4).abs() < 1e-15);
    }
}

#[test]
fn what_is_no_closed_surface_is_refused() {
    let surface = cuboid();
    let whole = binary(&surface, b"");
    let cut = read("cut", &whole[..whole.len() - 30], 1.0).unwrap_err();
    assert!(matches!(cut, Error::File { .. }), "{cut}");
    let words = text(&surface);
    let cut = read("words", &words.as_bytes()[..words.len() / 2], 1.0);
    println!("{}", cut.as_ref().unwrap_err());
    assert!(cut.is_err());
    let short = read("short", b"stl", 1.0).unwrap_err();
    assert!(matches!(short, Error::File { .. }), "{short}");
    let none = Mesh::read("/does/not/exist.stl", 1.0).unwrap_err();
    assert!(none.to_string().contains("exist.stl"), "{none}");

    let refusal = |surface: &Surface| Mesh::new(&surface.0, &surface.1).unwrap_err().to_string();
    let mut open = surface.clone();
    open.1.pop();
    let message = refusal(&open);
    assert!(
        message.contains("3 edges") && message.contains("open"),
        "{message}"
    );
    let mut fin = surface.clone();
    fin.0.push([0.0, 0.0, 9.0]);
    fin.0.push([0.0, 1.0, 9.0]);
    fin.1.extend([[0, 1, 8], [1, 0, 9], [8, 1, 9], [0, 8, 9]]);
    assert!(refusal(&fin).contains("not manifold"), "{}", refusal(&fin));
    let mut turned = surface.clone();
    turned.1[0].swap(0, 1);
    assert!(refusal(&turned).contains("inconsistent orientations"));
    let mut far = surface.clone();
    far.0[0][2] = f64::NAN;
    assert!(refusal(&far).contains("corner of the mesh"));
    let mut beyond = surface.clone();
    beyond.1[0][0] = 8;
    assert!(refusal(&beyond).contains("number of a corner"));
    assert!(refusal(&(surface.0.clone(), vec![[0, 1, 1]])).contains("no triangles"));
    let unit = Mesh::read("/does/not/exist.stl", 0.0).unwrap_err();
    assert!(unit.to_string().contains("unit of length"), "{unit}");
}
