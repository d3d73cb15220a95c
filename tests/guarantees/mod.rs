//! What holds whatever is simulated: bad input is refused by name, lists miss no pair,
//! results do not depend on threads, instruction sets or precision, and a run resumes to the same bits.

mod absent_effects;
mod allocations;
mod approach;
mod bad_input;
pub mod bits;
mod causes;
#[cfg(feature = "checkpoint")]
mod changes;
mod counted_work;
mod entries;
mod error_bars;
mod filled;
mod filling;
#[cfg(feature = "checkpoint")]
pub mod flap;
mod forces_of_laws;
mod invariance;
mod neighbours;
mod order_of_effects;
mod place;
#[cfg(feature = "checkpoint")]
mod readings;
#[cfg(feature = "checkpoint")]
mod restart;
#[cfg(feature = "checkpoint")]
mod restart_of_parts;
mod runs;
mod step_limits;
mod step_program;
#[cfg(feature = "checkpoint")]
mod stopped;
mod stored_energy;
mod vtk;
#[cfg(feature = "serde")]
mod written;
