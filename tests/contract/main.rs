//! The contract of pair terms, each of which is compiled here in every dimension and lane.
//! A program of its own, which takes as long to compile as most others together: `.ci/run` names it.

#[path = "../common/mod.rs"]
mod common;

mod contract;
