//! Materials: equations of state and the catalogue of named materials.
//! A material is evaluated once per particle and step, never inside the pair loop.

pub mod eos;
