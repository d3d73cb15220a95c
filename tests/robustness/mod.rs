//! Random input: scenes, materials, checkpoints, tables and meshes are built or read, or refused with an error; nothing panics,
//! hangs or makes numbers that are none.

mod files;
mod guard;
mod materials;
mod numbers;
mod scenes;
