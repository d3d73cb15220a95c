//! All examples in one program, which compiles in half the time of a program for each, since loops and driver that
//! they share are compiled once. It is the example by whose name it is called: `.ci/run` makes a link for each.

// Examples are programs; what one of them exports, another does not use.
#![allow(missing_docs, clippy::duplicate_mod)]

use std::path::Path;
use std::process::{ExitCode, Termination};

macro_rules! examples {
    ($($name:ident $path:literal)+) => {
        $(#[path = $path] mod $name;)+

        fn main() -> ExitCode {
            let called = std::env::args().next().unwrap_or_default();
            let called = Path::new(&called).file_stem().and_then(|name| name.to_str());
            $(if called == Some(stringify!($name)) {
                return $name::main().report();
            })+
            eprintln!("{called:?} is no example: call this by a link of the name of one");
            ExitCode::from(2)
        }
    };
}

examples! {
    cellular_filler "../../examples/cellular_filler/main.rs"
    channel "../../examples/channel.rs"
    dam_break "../../examples/dam_break/main.rs"
    elastic_gate "../../examples/elastic_gate.rs"
    elastic_plate "../../examples/elastic_plate.rs"
    falling_drop "../../examples/falling_drop.rs"
    hydrostatic "../../examples/hydrostatic.rs"
    hypervelocity "../../examples/hypervelocity/main.rs"
    lid_driven_cavity "../../examples/lid_driven_cavity.rs"
    rod_impact "../../examples/rod_impact/main.rs"
    rubber_rings "../../examples/rubber_rings/main.rs"
    sloshing_roll "../../examples/sloshing_roll/main.rs"
    sloshing_tank "../../examples/sloshing_tank/main.rs"
    square_patch "../../examples/square_patch.rs"
    standing_wave "../../examples/standing_wave.rs"
    taylor_bar "../../examples/taylor_bar/main.rs"
    taylor_green "../../examples/taylor_green.rs"
    turek_hron "../../examples/turek_hron.rs"
    viscosity_frontier "../../examples/viscosity_frontier.rs"
    water_on_plate "../../examples/water_on_plate.rs"
    work_precision "../../examples/work_precision/main.rs"
}
