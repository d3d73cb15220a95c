//! How a scene is integrated: integrator, steps, neighbour lists, instructions, memory.
//! None of it is physics; each has a default.

use super::Scene;
use crate::integrator::Integrator;
#[cfg(doc)]
use crate::integrator::KickDriftKick;
use crate::ranks::{Ranks, Team};
use crate::scalar::Real;
use crate::simulation::StepControl;
use crate::sweep::{InstructionSet, Root};
use std::sync::Arc;

/// Skins in units of the kernel's support: of lists that last, and of lists that do not.
pub(super) const SKINS: [f64; 2] = [0.1, 0.2];
/// The same where smoothing lengths follow the density.
pub(super) const FOLLOWING_SKINS: [f64; 2] = [0.1, 0.02];

impl<T: Real, const D: usize> Scene<T, D> {
    /// Chooses the integrator; [`KickDriftKick`] if not given.
    #[must_use]
    pub fn integrator(mut self, integrator: impl Integrator + 'static) -> Self {
        self.integrator = Arc::new(integrator);
        self
    }

    /// Chooses an integrator that is already boxed.
    #[must_use]
    pub fn boxed_integrator(mut self, integrator: Box<dyn Integrator>) -> Self {
        self.integrator = integrator.into();
        self
    }

    /// Changes how the time step is chosen.
    #[must_use]
    pub fn steps(mut self, change: impl FnOnce(StepControl) -> StepControl) -> Self {
        self.control = change(self.control);
        self
    }

    /// Asks for steps that end at these times \[s\]: where a load or a motion has a kink, which a step across it would take as
    /// smooth. The step before is shortened, or the two before. A load that jumps counts, for half a step on either side, with
    /// its value at the time of the jump itself.
    ///
    /// Such times belong to the scene. [Readings](crate::simulation#readings) need none, and shorten no step.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// // A force per mass that falls to zero within 0.1 µs and stays there.
    /// let mut rod = Scene::<f64, 1>::new(schemes::impact())
    ///     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4))
    ///     .acceleration(|t| [2e9 * (1.0 - t / 1e-7).max(0.0)])
    ///     .step_ends_at([1e-7])
    ///     .build()?;
    /// rod.run_until(2e-7)?;
    /// let whole = rod.ledger().whole;
    /// assert!((whole.momentum[0] / whole.mass - 100.0).abs() < 1e-6);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn step_ends_at(mut self, times: impl IntoIterator<Item = f64>) -> Self {
        self.step_ends.extend(times);
        self
    }

    /// The skin of the neighbour lists in units of the kernel's support. A thicker
    /// skin makes lists longer and their builds rarer; results differ in rounding only.
    ///
    /// If not given it is 0.1; where lists serve for fewer than eight evaluations, four steps of a liquid, as
    /// under drops that fly, it is 0.2 until they serve for more than 24. It stays at 0.1 in scenes with
    /// boundaries that make images.
    #[must_use]
    pub fn skin(mut self, skin: f64) -> Self {
        self.skin = Some(skin);
        self
    }

    /// The instruction set of the pair loop; the best that the machine has if not given.
    ///
    /// [`InstructionSet::Baseline`] has no fused multiply-add, so its sums, products and roots round alike on every machine, and
    /// elementary functions are [made of them](crate::scalar::Lane::exp). Rust leaves the last digits of `exp_m1` and `ln_1p` to
    /// the platform: [`Tait`](crate::material::eos::Tait) and [`Murnaghan`](crate::material::eos::Murnaghan) with an exponent that
    /// is no whole number call these, as does the regularised
    /// [`HerschelBulkley`](crate::material::rheology::HerschelBulkley). So may laws, loads and motions of your own.
    #[must_use]
    pub fn instructions(mut self, set: InstructionSet) -> Self {
        self.instructions = set;
        self
    }

    /// How the pair loop takes roots in `f64`; the faster way for the processor if not given, so that two makes of
    /// processor may differ in their last bits. [`Root::Products`] gives the same bits on all that have the
    /// instruction set; on [`InstructionSet::Baseline`] both ways are
    /// the divider's.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// use meshfree::scalar::Root;
    /// let scene = || Scene::<f64, 2>::new(schemes::weakly_compressible())
    ///     .body(Body::block("water", catalogue::weakly_compressible_water(1.0), [0.0; 2], [0.1; 2], 0.01));
    /// let sums = |root| scene().root(root).build().map(|run| run.all().map(|p| p.density()).sum::<f64>());
    /// assert!((sums(Root::Divider)? / sums(Root::Products)? - 1.0).abs() < 1e-12);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn root(mut self, root: Root) -> Self {
        self.root = root;
        self
    }

    /// The memory \[bytes\] that bodies, lists and sums may take. A scene that is predicted to take more is refused
    /// before any of it is allocated; what the machine has to give (`MemAvailable` and the limit of the control group
    /// on Linux) if not given, and without a limit elsewhere.
    #[must_use]
    pub fn memory_limit(mut self, bytes: u64) -> Self {
        self.memory = Some(bytes);
        self
    }

    /// Runs the scene on [ranks](crate::ranks), which all build the same one and call the same methods of it: the sums over pairs
    /// are divided among them, to the bits of one process.
    #[must_use]
    pub fn on_ranks(mut self, ranks: Arc<dyn Ranks>) -> Self {
        self.ranks = Some(ranks);
        self
    }

    /// The ranks that it is built on, all of which get an error of one.
    pub(super) fn team(&mut self) -> Option<Arc<Team>> {
        let team = Arc::new(Team::new(self.ranks.clone()?));
        self.ranks_here = team.beside();
        Some(team)
    }
}
