//! Solids and gases against exact solutions: rods that strike, waves, shock tubes, and what is conserved.
//! Cases of several bodies and schemes among them: contact, loads, events, conversion.

mod absorbing_layer;
mod advice;
mod at_walls;
mod bad_solids;
mod beams_in_space;
mod clamped_wall;
mod conservation;
mod contact;
mod convergence;
mod conversion;
mod detonation;
mod driven;
mod elastic_plastic_waves;
mod events;
mod exchange;
mod failed_material;
#[cfg(feature = "meshes")]
mod filled_meshes;
mod gas;
mod halved_contact;
mod held;
mod hourglass;
mod integrators;
mod joints;
mod kernels_on_lattices;
mod loads;
mod manufactured;
#[cfg(feature = "meshes")]
mod meshes;
mod misprints;
mod rods;
mod shear_in_gas;
mod sheets;
mod smoothing;
mod states;
mod total_lagrangian;
