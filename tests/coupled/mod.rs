//! Liquids with structures, bodies and heat, and the other forms of their equations.
//! What acts between them, what is conserved, and where bodies come to rest.

mod arbitrary_lagrangian;
mod five_equations;
mod floating;
mod groups;
mod heat;
mod lagrangian_liquid;
mod mechanisms;
mod mirror_planes;
mod penalty_structure;
mod solids_in_tank;
mod structures;
