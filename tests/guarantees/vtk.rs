//! VTK's own reader finds in particle files what was written into them.
//! Needs Python with VTK: `MESHFREE_PYTHON` names the interpreter, unless it is `python3`.

use meshfree::output::vtu::{Pvd, Vtu};
use std::path::Path;
use std::process::Command;

#[test]
fn vtk_reads_what_was_written() {
    let python = std::env::var("MESHFREE_PYTHON").unwrap_or_else(|_| "python3".into());
    let has_vtk = Command::new(&python)
        .args(["-c", "import vtkmodules.vtkIOXML"])
        .output()
        .is_ok_and(|output| output.status.success());
    if !has_vtk {
        println!("skipped vtk_reads_what_was_written: {python} cannot import vtkmodules");
        return;
    }
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
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/guarantees/read_vtu.py");
    let read = Command::new(&python)
        .arg(script)
        .arg(&list)
        .output()
        .unwrap();
    std::fs::remove_dir_all(&folder).unwrap();
    let [text, errors] = [read.stdout, read.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
    assert!(read.status.success(), "{text}{errors}");
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
