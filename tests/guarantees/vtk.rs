//! VTK's own reader finds in particle files what was written into them.
//! Needs Python with VTK: `MESHFREE_PYTHON` names the interpreter, unless it is `python3`.

use meshfree::output::vtu::{Pvd, Vtu};
use meshfree::prelude::*;
use std::path::Path;
use std::process::Command;

/// What VTK's reader finds in a series, a line for each array of a frame. `None` without that reader.
fn read(list: &Path, test: &str) -> Option<String> {
    let python = std::env::var("MESHFREE_PYTHON").unwrap_or_else(|_| "python3".into());
    let has_vtk = Command::new(&python)
        .args(["-c", "import vtkmodules.vtkIOXML"])
        .output()
        .is_ok_and(|output| output.status.success());
    if !has_vtk {
        println!("skipped {test}: {python} cannot import vtkmodules");
        return None;
    }
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/guarantees/read_vtu.py");
    let read = Command::new(&python)
        .arg(script)
        .arg(list)
        .output()
        .unwrap();
    let [text, errors] = [read.stdout, read.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
    assert!(read.status.success(), "{text}{errors}");
    Some(text)
}

#[test]
fn vtk_reads_what_was_written() {
    let folder = std::env::temp_dir().join(format!("meshfree-vtk-{}", std::process::id()));
    let list = folder.join("jet.pvd");
    let mut series = Pvd::create(&list).unwrap();
    let frame = Vtu::new([[0.1, 0.25], [1.0, -3.5]])
        .scalar("p < 0", [1e-300, -2.5e9])
        .scalar("body", [7_u32, 8])
        .vector("velocity", [[0.5_f32, 1.5], [-0.25, 4.0]])
        .array("stress", [[1_i64, 2], [3, -4]])
        .time(1e-7);
    series
        .frame(0.0, &Vtu::new(Vec::<[f64; 3]>::new()))
        .unwrap();
    series.frame(1e-7, &frame).unwrap();
    let text = read(&list, "vtk_reads_what_was_written");
    std::fs::remove_dir_all(&folder).unwrap();
    let Some(text) = text else {
        return;
    };
    let expected = "\
t 0.0: 0 points, 0 cells of types {}
t 1e-07: 2 points, 2 cells of types {1}
Points double: 0.1 0.25 0.0 | 1.0 -3.5 0.0
p < 0 double: 1e-300 | -2500000000.0
body unsigned int: 7.0 | 8.0
velocity float: 0.5 1.5 0.0 | -0.25 4.0 0.0
stress long long: 1.0 2.0 | 3.0 -4.0
TimeValue double: 1e-07
";
    // Integers of 64 bits are `long` where that is as wide.
    assert_eq!(text.replace("stress long:", "stress long long:"), expected);
}

/// What ParaView's *Point Gaussian* takes its size from is there for walls too, and a column tells them from the liquid.
#[test]
fn vtk_finds_walls_and_the_size_of_particles() {
    let folder = std::env::temp_dir().join(format!("meshfree-vtk-tank-{}", std::process::id()));
    let list = folder.join("tank.pvd");
    let water = catalogue::weakly_compressible_water(2.0);
    let open_above = [[true, true], [true, false]];
    let mut tank = Scene::<f64, 2>::new(schemes::weakly_compressible())
        .body(Body::block("water", water, [0.0; 2], [0.2, 0.1], 0.02))
        .wall(Wall::around(
            "tank",
            [0.0; 2],
            [0.2, 0.2],
            0.02,
            3,
            open_above,
        ))
        .acceleration(|_| [0.0, -9.81])
        .build()
        .unwrap();
    Run::new(&mut tank, 2e-3)
        .paraview(Schedule::every(1e-3), &list)
        .go()
        .unwrap();
    let text = read(&list, "vtk_finds_walls_and_the_size_of_particles");
    std::fs::remove_dir_all(&folder).unwrap();
    let Some(text) = text else {
        return;
    };
    let (particles, walls) = (tank.particles(), tank.wall("tank").unwrap().count());
    let frames: Vec<_> = text.split("\nt ").collect();
    assert_eq!(frames.len(), 3, "at 0, 1 and 2 ms");
    for frame in frames {
        let points = format!(": {} points, ", particles + walls);
        assert!(frame.contains(&points), "{frame}");
        // A scalar: a number for each point, between bars.
        let scalar = |name: &str| {
            let line = frame.lines().find(|line| line.starts_with(name)).unwrap();
            let (_, values) = line.split_once(": ").unwrap();
            let values = values.split(" | ").map(|own| own.parse().unwrap());
            values.collect::<Vec<f64>>()
        };
        let is_wall = scalar("wall ");
        assert!(is_wall[..particles].iter().all(|own| *own == 0.0));
        assert!(is_wall[particles..].iter().all(|own| *own == 1.0));
        let spacing = scalar("spacing ");
        assert_eq!(spacing.len(), particles + walls);
        for own in spacing {
            approx::assert_relative_eq!(own, 0.02, max_relative = 1e-12);
        }
    }
}
