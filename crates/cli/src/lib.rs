//! Scenes of meshfree from files, without Rust: what the program `meshfree` does.
//! The page "Scenes from files" of the book has the format; `meshfree schema` prints all of it.

pub mod build;
pub mod command;
pub mod fault;
pub mod format;
pub mod outputs;
