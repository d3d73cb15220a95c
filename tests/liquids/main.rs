//! Liquids: flows with exact solutions, violent ones, walls, and what is conserved.
//! One program, so that loops over pairs that several files use are compiled once.

#[path = "../common/mod.rs"]
mod common;
mod tank;

mod across_boundaries;
mod advice;
mod cylinders;
mod dam_break;
mod drops;
mod drum;
#[cfg(feature = "pictures")]
mod film;
mod gauges;
mod gentle_flows;
mod indicators;
mod jet_on_step;
mod lees_edwards;
mod liquid_conservation;
mod manufactured;
mod moving_openings;
mod off_lattice;
mod open_boundaries;
mod recorded_motion;
mod riemann_walls;
mod sampling;
mod sinking_disc;
mod sloshing;
mod slow;
mod sound_and_volume;
mod sources;
mod sponge;
mod still_water;
