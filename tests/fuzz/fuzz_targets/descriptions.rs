//! The fuzz target: the first byte says of what, the others make a scene, a material or a record of motion, or are the bytes of
//! a table, a mesh or a checkpoint. Whatever they are, it is built or read, or refused; nothing panics or hangs.
//!
//! Led by coverage: `cargo +nightly fuzz run --fuzz-dir tests/fuzz --features libfuzzer descriptions`. Without a fuzzer the
//! target takes cases from the files it is given, or one from the standard input.

#![cfg_attr(feature = "libfuzzer", no_main)]
// Tests of the files whose generators are shared are not compiled here.
#![allow(dead_code, unused_imports)]

#[path = "bytes.rs"]
mod bytes;
#[path = "../../robustness/files.rs"]
mod files;
#[path = "../../robustness/guard.rs"]
mod guard;
#[path = "../../robustness/materials.rs"]
mod materials;
#[path = "../../robustness/numbers.rs"]
mod numbers;
#[path = "../../robustness/scenes.rs"]
mod scenes;

/// What the generators take from `tests/common`.
mod common {
    pub use crate::bytes::Random;
}

use meshfree::geometry::{Mesh, Shape};
use meshfree::output::csv::Csv;
use meshfree::study::records::Record;
use std::path::PathBuf;
use std::sync::OnceLock;

/// One case, and what became of it.
fn case(input: &[u8]) -> &'static str {
    let Some((kind, rest)) = input.split_first() else {
        return "nothing";
    };
    bytes::feed(rest);
    match kind % 6 {
        0 => scenes::case(0),
        1 => materials::case(0),
        2 => files::record(0),
        3 => table(rest),
        4 => mesh(rest),
        _ => checkpoint(rest),
    }
}

/// Text as it is, and the text of the tests altered.
fn table(text: &[u8]) -> &'static str {
    let own = String::from_utf8_lossy(text);
    if let Ok(records) = Record::parse(&own) {
        let _ = records.interpolate("p [Pa]", "t [s]", 0.5);
    }
    let _ = Csv::parse(&own);
    files::table(0)
}

/// A place for files of this process.
fn place(name: &str) -> PathBuf {
    std::env::temp_dir().join(format!("meshfree-fuzz-{}-{name}", std::process::id()))
}

/// A mesh file of these bytes.
fn mesh(bytes: &[u8]) -> &'static str {
    let path = place("mesh.stl");
    std::fs::write(&path, bytes).expect("a file");
    let read = Mesh::read(&path, 1.0);
    let _ = std::fs::remove_file(&path);
    match read {
        Ok(mesh) => {
            assert!(mesh.volume().is_finite());
            assert!(!mesh.signed_distance(&[0.1, 0.2, 0.3]).is_nan());
            "read"
        }
        Err(error) => {
            assert!(!error.to_string().is_empty());
            "refused"
        }
    }
}

/// A good checkpoint in which three bytes each say where a byte is what; with an odd number of bytes over, these bytes alone.
fn checkpoint(bytes: &[u8]) -> &'static str {
    static WHOLE: OnceLock<Vec<u8>> = OnceLock::new();
    let path = place("state.safetensors");
    let whole = WHOLE.get_or_init(|| {
        let mut simulation = files::checkpoints::scene().build().expect("a scene");
        simulation.step().expect("a step");
        simulation.save(&path).expect("a file");
        std::fs::read(&path).expect("a file")
    });
    let mut own = whole.clone();
    if bytes.len() % 3 == 1 {
        own = bytes.to_vec();
    } else {
        for at in bytes.chunks_exact(3) {
            let place = usize::from(at[0]) << 8 | usize::from(at[1]);
            let count = own.len();
            own[place % count] = at[2];
        }
    }
    std::fs::write(&path, &own).expect("a file");
    let resumed = files::checkpoints::scene().resume(&path);
    let _ = std::fs::remove_file(&path);
    assert_eq!(
        resumed.is_ok(),
        own == *whole,
        "an altered checkpoint was taken, or a good one refused"
    );
    if resumed.is_ok() {
        "resumed"
    } else {
        "refused"
    }
}

#[cfg(feature = "libfuzzer")]
libfuzzer_sys::fuzz_target!(|input: &[u8]| {
    case(input);
});

#[cfg(not(feature = "libfuzzer"))]
fn main() -> std::io::Result<()> {
    use std::io::Read;
    let mut inputs = Vec::new();
    for name in std::env::args().skip(1) {
        inputs.push((name.clone(), std::fs::read(name)?));
    }
    if inputs.is_empty() {
        let mut own = Vec::new();
        std::io::stdin().read_to_end(&mut own)?;
        inputs.push(("-".into(), own));
    }
    for (name, input) in inputs {
        println!("{name}: {}", case(&input));
    }
    Ok(())
}
