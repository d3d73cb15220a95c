//! Hard cases: where others fail, the cure, a criterion in numbers, and a control without the cure that must fail it.
//! `cargo test --test checks hard_cases -- --nocapture` prints the rows of `docs/hard-cases.md`.

mod at_rest;
mod brick_on_floor;
mod corner_impact;
mod elliptic_drop;
mod gas;
mod gas_in_a_plane;
mod gas_in_space;
mod harness;
mod imploding_gas;
mod jittered;
mod kelvin_helmholtz;
mod quadratic_viscosity;
mod readings;
mod ringing_walls;
mod rods;
mod shell_in_water;
mod square_patch;
mod stretch_and_twist;
mod swegle;
mod tank_at_30g;
mod thin_jet;
mod two_phases;
mod unlike;
mod variations;
mod vortices;
mod water_hammer;
