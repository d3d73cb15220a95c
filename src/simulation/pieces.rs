//! Particle files of ranks: each writes those of its own particles, and the first one the list of them.
//! The columns are those of the file of all particles, and what one rank cannot write is an error of all.

use super::Simulation;
use super::group::Group;
use super::part::runs_of;
use crate::error::{Error, Result};
use crate::output::pvtu::{Pvtu, check_ending, piece_name};
use crate::ranks::even;
use crate::scalar::Real;
use std::path::Path;

impl<T: Real, const D: usize> Simulation<T, D> {
    /// Writes all particles of bodies and walls now, in pieces: each rank a file of its own particles next to the list at `path`, as
    /// `now_0.vtu` and `now_1.vtu` for `now.pvtu`, and the first rank the list, when all pieces are there. Without ranks there is
    /// one piece.
    ///
    /// Pieces together have each particle of [`vtu_with_walls`](Self::vtu_with_walls) once, with its columns, to the bit. A rank
    /// writes a share of the bytes, where [`Vtu::write`](crate::output::vtu::Vtu::write) on the first rank writes all; all ranks must
    /// see the same folder. On ranks all call it, in an observer of a [`Run`](crate::run::Run) for instance;
    /// [`Run::paraview_in_pieces`](crate::run::Run::paraview_in_pieces) is a series of such files. It reads and changes nothing.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// use meshfree::ranks;
    /// # let folder = std::env::temp_dir().join(format!("meshfree-pieces-{}", std::process::id()));
    /// # let path = folder.join("now.pvtu");
    /// # /*
    /// let path = "out/now.pvtu";
    /// # */
    /// let all = ranks::in_threads(2, 1, |ranks| {
    ///     let rod = Scene::<f64, 1>::new(schemes::impact())
    ///         .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 5e-6).velocity([20.0]))
    ///         .on_ranks(ranks)
    ///         .build()?;
    ///     rod.write_pieces(&path)
    /// })?;
    /// assert!(all.into_iter().all(|own| own.is_ok()));
    /// # assert!(folder.join("now_1.vtu").exists() && path.exists());
    /// # let _ = std::fs::remove_dir_all(folder);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::File`] if a file cannot be written or `path` has another ending than `.pvtu`; on several ranks that of the first rank
    /// that has one, as the same [`Error::Rank`] on all of them. There is no new list then, and the simulation can go on.
    pub fn write_pieces(&self, path: impl AsRef<Path>) -> Result<()> {
        let path = path.as_ref();
        let piece = self.piece();
        let (rank, count) = self.rank().unwrap_or((0, 1));
        let file = path.with_file_name(piece_name(path, rank));
        let written = check_ending(path).and_then(|()| piece.write(file));
        self.of_any_rank(written)?;
        let listed = if rank == 0 {
            let names = (0..count).map(|rank| piece_name(path, rank));
            let list = names.fold(Pvtu::of(&piece), |list, name| list.piece(&name));
            list.write(path)
        } else {
            Ok(())
        };
        self.of_any_rank(listed)
    }

    /// The outcome of files that ranks write: of all if it is well on all, and otherwise one error on all. A simulation goes on after
    /// it, for no particle is elsewhere.
    pub(crate) fn of_any_rank<V>(&self, outcome: Result<V>) -> Result<V> {
        let Some(team) = self.team.as_ref().filter(|team| team.count() > 1) else {
            return outcome;
        };
        let own = outcome.as_ref().err().map(ToString::to_string);
        match team.first_said(own.as_deref()) {
            Some((rank, cause)) => Err(Error::Rank { rank, cause }),
            None => outcome,
        }
    }
}

impl<T: Real, const D: usize> Group<T, D> {
    /// Whether this rank writes the particle of a slot: one of its own, or one of an equal share until lists have been cut.
    pub(super) fn is_written_here(&self, slot: usize) -> bool {
        let Some(share) = &self.share else {
            return true;
        };
        let (rank, count) = (share.team.rank(), share.team.count());
        let slots = self.particles.columns.slots();
        if !share.is_divided(&self.neighborhood.lists) {
            return even(slots, rank, count).contains(&slot);
        }
        let own = runs_of::<T>(share.division(), rank, slots);
        own.iter().any(|run| run.contains(&slot))
    }
}
