//! Scenes on a device as on the host, in one program, so that the loops that its parts share are compiled once.
//! `cargo test -p meshfree-gpu --test scenes` and the name of a part.

mod bad_inputs;
#[path = "../common/mod.rs"]
mod common;
#[path = "../common/compare.rs"]
mod compare;
mod contact;
mod coupled;
#[cfg(feature = "cuda")]
mod cuda;
mod impact;
mod kinds;
mod liquids;
#[path = "../common/neighbours.rs"]
mod neighbours;
mod states;
mod sweeps;
