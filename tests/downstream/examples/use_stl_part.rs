//! A wedge from an STL file in millimetres strikes a wall, from *Shapes from STL files*.

use meshfree::geometry::Mesh;
use meshfree::prelude::*;
use std::fmt::Write;

/// A wedge of 4 mm by 4 mm by 4 mm, whose upper side slopes, as text.
fn wedge() -> String {
    let corners = [
        [0, 0, 0],
        [4, 0, 0],
        [4, 4, 0],
        [0, 4, 0],
        [0, 0, 4],
        [0, 4, 4],
    ];
    let faces = [
        [0, 2, 1],
        [0, 3, 2],
        [0, 4, 5],
        [0, 5, 3],
        [1, 2, 5],
        [1, 5, 4],
        [0, 1, 4],
        [3, 5, 2],
    ];
    let mut text = String::from("solid wedge\n");
    for face in faces {
        text += "facet normal 0 0 0\nouter loop\n";
        for [x, y, z] in face.map(|corner: usize| corners[corner]) {
            writeln!(text, "vertex {x} {y} {z}").unwrap();
        }
        text += "endloop\nendfacet\n";
    }
    text + "endsolid wedge\n"
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let file = std::env::temp_dir().join("meshfree-use-wedge.stl");
    std::fs::write(&file, wedge())?;
    let part = Mesh::read(&file, 1e-3)?;
    std::fs::remove_file(&file)?;
    println!("{} m³ in {} triangles", part.volume(), part.triangles());
    assert!((part.volume() / 32e-9 - 1.0).abs() < 1e-6);

    let body = Body::fill("wedge", catalogue::aluminium(), &part, 5e-4);
    let mut impact = Scene::<f64, 3>::new(schemes::impact())
        .body(body.velocity([0.0, 0.0, -50.0]))
        .boundary(MirrorPlane::wall([0.0; 3], [0.0, 0.0, -1.0]))
        .build()?;
    impact.run_until(5e-7)?;
    let pressure = impact.column("wedge", Field::PRESSURE)?;
    let highest = pressure.iter().map(|(_, own)| own[0]).fold(0.0, f64::max);
    println!("{:.0} MPa", 1e-6 * highest);
    // Less than ρ c v = 2700 · 5350 · 50 but for what the lattice's edges ring.
    assert!(highest > 2e8 && highest < 1.5e9);
    Ok(())
}
