//! What is checked beside the newcomer's tests, because it takes minutes to compile or to run. One program, in which loops
//! and driver that its parts share are compiled once: `cargo test --all-features --test checks` and the name of a part.

mod common;
mod contract;
mod coupled;
mod guarantees;
mod hard_cases;
mod ranks;
mod recording;
mod robustness;
mod solids;
mod updated_lagrangian;
