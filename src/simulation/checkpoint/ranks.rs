//! Checkpoints of ranks: each writes its rows, and when all are there the first one the manifest, by which they count.
//! What one rank cannot write is one error on all; the checkpoint before stands, and the simulation can go on.

use crate::error::Result;
use crate::output::checkpoint::{Before, Checkpoint};
use crate::ranks::Team;
use crate::scalar::Real;
use crate::simulation::Simulation;
use std::path::Path;

impl<T: Real, const D: usize> Simulation<T, D> {
    pub(super) fn save_in_parts(&self, team: &Team, path: &Path) -> Result<()> {
        // Rows of ranks that are elsewhere would make a state that no run has had.
        self.agree_on(Ok(()))?;
        let (rank, count) = (team.rank(), team.count());
        let before = if rank == 0 {
            Before::at(path)
        } else {
            Ok(Before::default())
        };
        let before = self.of_any_rank(before)?;
        let [turn] = team.largest([f64::from(before.turn)]);
        let turn = turn as u32;
        let mut file = self.put(Checkpoint::of_rank(rank, count));
        let sum = self.of_any_rank(file.write_rows(path, turn))?;
        let mut parts = Vec::with_capacity(count);
        team.numbers([sum], |[own]| parts.push(own));
        // Of a rank that has gone there is none, which is told below.
        let listed = if rank == 0 && parts.len() == count {
            let listed = file.write_manifest(path, turn, &parts);
            listed.map(|()| before.remove())
        } else {
            Ok(())
        };
        self.of_any_rank(listed)?;
        self.agree_on(Ok(()))
    }
}
