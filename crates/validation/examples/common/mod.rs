//! What the programs share: options, threads and precision, pictures.
//! A program describes itself, names what runs in each precision, and is left with its scene.
//!
//! ```text
//! mod common;
//! use common::{Example, Failure, Options};
//!
//! const EXAMPLE: Example = Example { name: "dam_break", about: "...", schemes: &["default"], own: &[] };
//!
//! fn main() -> std::process::ExitCode {
//!     common::main(&EXAMPLE, perform::<f64>, Some(perform::<f32>))
//! }
//! fn perform<T: Real>(options: &Options) -> Result<(), Failure> { ... }
//! ```

// Each program uses a part of this.
#![allow(dead_code, unused_imports)]

mod draw;
mod options;
mod records;

pub use draw::{Shade, evenly, picture, save_picture};
pub use options::{Example, Options, Own};
pub use records::Records;

use std::process::ExitCode;

pub use meshfree::run::Failure;

/// What a program does with its options, in one precision.
pub type Perform = fn(&Options) -> Result<(), Failure>;

/// Stable steps of an elastic structure in one of the liquid around it, of the same spacing, from their speeds of sound and
/// smoothing lengths, 0.8 dx and 1.3 dx. The structure has a Young's modulus \[Pa\], a Poisson ratio and a density \[kg/m³\].
pub fn stable_steps([youngs, poisson, density]: [f64; 3], sound_speed: f64) -> u32 {
    let modulus = youngs * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
    ((modulus / density).sqrt() / sound_speed * 1.3 / 0.8).max(1.0) as u32
}

/// Reads the command line, sets the threads, and runs the program in the precision asked for. Only programs in which single
/// precision is of interest are given both: each takes as long to compile as the other.
///
/// Exit status 2 is a command line or a scene that cannot be followed, 1 a run that failed.
pub fn main(example: &Example, in_f64: Perform, in_f32: Option<Perform>) -> ExitCode {
    let options = example.parse();
    if let Some(threads) = options.threads
        && let Err(failure) = rayon::ThreadPoolBuilder::new()
            .num_threads(threads.into())
            .build_global()
    {
        eprintln!("--threads: {failure}");
        return ExitCode::from(1);
    }
    let run = if options.single { in_f32 } else { Some(in_f64) };
    let Some(run) = run else {
        eprintln!("--precision: this program runs in f64 alone");
        return ExitCode::from(2);
    };
    match run(&options) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("{failure}");
            let bad_scene = failure
                .downcast_ref::<meshfree::error::Error>()
                .is_some_and(|error| matches!(error, meshfree::error::Error::Build(_)));
            ExitCode::from(if bad_scene { 2 } else { 1 })
        }
    }
}
