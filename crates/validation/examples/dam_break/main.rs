//! Dam breaks against experiments: Lobovský, Koshizuka & Oka, Martin & Moyce, and SPHERIC 2.
//! `cargo validate dam_break -- --help` lists the options.

mod bars;
#[path = "../common/mod.rs"]
mod common;
mod consistency;
mod figures;
mod flat;
mod lattice_rows;
mod obstacle;
#[path = "../common/violent.rs"]
mod violent;

use common::{Example, Failure, Options};
use meshfree::scalar::Real;
use std::process::ExitCode;
use violent::{Choices, own};

const EXAMPLE: Example = Example {
    name: "dam_break",
    about: "Dam breaks against experiments.

--case NAME is lobovsky, koshizuka or martin-moyce, in a plane, or spheric2, in space.
The scheme viscous has the water's own viscosity, and walls without slip; docs/dam_breaks.md says what
each choice gains.",
    schemes: &violent::SCHEMES,
    own: &violent::options_and(own(
        "--gate",
        "M/S",
        "pulls the gate up at this speed, in a plane (default: it vanishes at once)",
    )),
};

pub(crate) fn main() -> ExitCode {
    common::main(&EXAMPLE, perform::<f64>, Some(perform::<f32>))
}

fn perform<T: Real>(options: &Options) -> Result<(), Failure> {
    let choices = Choices::of(options)?;
    match options.text("--case").unwrap_or("lobovsky") {
        "spheric2" => obstacle::perform::<T>(options, &choices),
        name => match flat::Flat::of(name, options, &choices) {
            Some(case) => flat::perform::<T>(&case, options, &choices),
            None => Err(format!(
                "--case: `{name}` is not accepted; it takes one of lobovsky, koshizuka, \
                 martin-moyce, spheric2"
            )
            .into()),
        },
    }
}
