//! What a rank said to the others: counts and bytes, and bytes by how they depend on the number of ranks.
//! Counted where messages are made, so what is counted is what travels.

use std::time::Duration;

/// Messages of a rank since its simulation was built, and the time that they took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Traffic {
    /// Times at which all ranks gathered.
    pub gathered: u64,
    /// Times at which ranks exchanged particles with those near them.
    pub exchanged: u64,
    /// Times at which particles went to other ranks: list builds that sort them, and cuts anew.
    pub travelled: u64,
    /// Bytes that the rank gave.
    pub sent: u64,
    /// Bytes that it got.
    pub received: u64,
    /// Time of sending, receiving and waiting for others.
    pub waited: Duration,
}

/// What letters between ranks hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Letters {
    /// So many bytes for each rank.
    Each(usize),
    /// So many bytes for each ghost of a rank.
    Ghosts(usize),
    /// Particles that go to another rank.
    Moved,
}

/// What a rank gave, by how it depends on the number of ranks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Given {
    /// Bytes of headers, votes and joined numbers: as many from each rank.
    pub each: u64,
    /// Bytes of parts of one whole: sums, lists, particles.
    pub parts: u64,
    /// Bytes of letters to each rank.
    pub to_each: u64,
    /// Bytes that travelled for one ghost, whether there is one or not.
    pub of_ghost: u64,
}
