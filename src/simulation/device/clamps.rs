//! Clamped particles as records: forces that are replaced after all are summed, and what clamps give.
//! What they give is added up on the device, particle by particle, until the host asks for it.

use super::Offloaded;
use super::program::{Given, Made};
use super::record::{DT, HALF, Recorder, evaluated};
use crate::boundary::Pose;
use crate::particles::{Field, Output};
use crate::scalar::{Lane, Real, Traced};
use crate::simulation::{Clamp, Group};
use crate::term::Stage;
use core::ops::Range;

/// Columns of what is clamped: the number of the clamp, counted from one, and where the particle was built; then the force that it is
/// given, and the impulse and the work of that.
const fn width<const D: usize>() -> usize {
    1 + 3 * D + 1
}
/// The first of those that change.
const fn first_given<const D: usize>() -> usize {
    1 + D
}

/// The numbers that the particles of each clamp that moves share: its acceleration by place, d²A/dt² and d²b/dt².
pub(super) fn shared<T: Real, const D: usize>(group: &Group<T, D>, time: f64) -> Vec<f64> {
    let clamps = group.held.clamps.iter();
    let motions = clamps.filter_map(|own| own.motion.as_ref());
    let of = |pose: Pose<D>| {
        let rows = (0..D).flat_map(|a| (0..D).map(move |b| (a, b)));
        let mut all: Vec<f64> = rows.map(|at| pose.linear[2][at]).collect();
        all.extend(pose.shift[2].iter());
        all
    };
    motions.flat_map(|motion| of(motion.pose(time))).collect()
}

/// Whether two clamps hold one particle.
pub(super) fn overlap<const D: usize>(clamps: &[Clamp<D>]) -> bool {
    let held = clamps.iter().flat_map(|own| {
        let particles = own.particles.iter();
        particles.map(|(id, _)| (own.body, *id))
    });
    let mut held: Vec<_> = held.collect();
    let all = held.len();
    held.sort_unstable();
    held.dedup();
    held.len() < all
}

impl<T: Real, const D: usize> Recorder<'_, T, D> {
    /// Forces on clamped particles are replaced, and what clamps give is booked in kicks.
    pub(super) fn clamps(&mut self) {
        let clamps = &self.group.held.clamps;
        if clamps.is_empty() {
            return;
        }
        let first = self.program.columns;
        self.program.columns += width::<D>();
        self.program.held = Some(first);
        let sums = self.group.scheme.sums(Stage::Rates);
        if !sums.contains(Output::FORCE) {
            let what = "a clamp under a scheme without forces does not run on a device";
            self.refuse(what.into(), "run the scene on the host");
            return;
        }
        let given = first + first_given::<D>();
        for (body, run) in self.bodies().into_iter().enumerate() {
            let mut reads = vec![Given::Field(Field::MASS, 0)];
            reads.extend((0..D).map(|d| Given::Rate(Output::FORCE, d)));
            reads.extend((0..D).map(evaluated::<D>));
            reads.extend((first..given).map(Given::Column));
            // Behind all other shared numbers.
            let (mut own, mut shared) = (Vec::new(), self.place_of_timed());
            for (number, clamp) in clamps.iter().enumerate() {
                let moves = clamp.motion.is_some();
                let numbers = if moves { D * D + D } else { 0 };
                if clamp.body == body {
                    own.push((number + 1, moves.then_some(reads.len())));
                    reads.extend((shared..shared + numbers).map(Given::Shared));
                }
                shared += numbers;
            }
            if own.is_empty() {
                continue;
            }
            let made = (0..D).map(|d| Made::Rate(Output::FORCE, d));
            let made = made.chain((0..D).map(|d| Made::Column(given + d)));
            let io = (reads, made.collect());
            let held = self.on_each("clamps", vec![run.clone()], io, |x| {
                let (mass, forces, gravity) = (x[0], &x[1..1 + D], &x[1 + D..1 + 2 * D]);
                let (number, rest) = (x[1 + 2 * D], &x[2 + 2 * D..2 + 3 * D]);
                let mut after = forces.to_vec();
                for &(clamp, shared) in &own {
                    let apart = (number - Traced::of(clamp as f64)).abs();
                    let is_held = apart.lt(Traced::of(0.5));
                    for d in 0..D {
                        let mut a = Traced::of(0.0);
                        if let Some(at) = shared {
                            a = x[at + D * D + d];
                            (0..D).for_each(|b| a += x[at + d * D + b] * rest[b]);
                        }
                        after[d] = Lane::select(is_held, mass * (a - gravity[d]), after[d]);
                    }
                }
                let given: Vec<_> = (0..D).map(|d| after[d] - forces[d]).collect();
                [after, given].concat()
            });
            self.program.hold.extend(held);
            let mut reads = vec![DT, HALF, Given::Field(Field::MASS, 0)];
            for d in 0..D {
                reads.extend([Given::Column(given + d), Given::Column(given + D + d)]);
                reads.push(Given::Field(Field::VELOCITY, d));
                reads.extend([Given::Rate(Output::FORCE, d), evaluated::<D>(d)]);
            }
            reads.push(Given::Column(given + 2 * D));
            let made = (given + D..given + 2 * D + 1).map(Made::Column).collect();
            let booked = self.on_each("what clamps give", vec![run], (reads, made), |x| {
                let (dt, half, mass) = (x[0], x[1], x[2]);
                let (mut results, mut power) = (Vec::new(), Traced::of(0.0));
                for own in x[3..3 + 5 * D].chunks_exact(5) {
                    results.push(own[1] + dt * own[0]);
                    power += own[0] * (own[2] + half * (own[3] / mass + own[4]));
                }
                results.push(x[3 + 5 * D] + dt * power);
                results
            });
            let at = self.of_work;
            self.program.kick.splice(at..at, booked);
        }
    }
}

impl<T: Real, const D: usize> Offloaded<T, D> {
    /// What is known of clamped particles, column by column from [`Program::held`](super::Program::held) on.
    pub(super) fn held(&self, group: usize) -> Vec<f64> {
        let group = &self.simulation.state.groups[group];
        let slots = group.particles.columns.slots();
        let mut all = vec![0.0; width::<D>() * slots];
        for (number, own) in group.held.clamps.iter().enumerate() {
            let [forces, _] = &own.forces;
            for (k, (id, rest)) in own.particles.iter().enumerate() {
                let force = forces.get(k).copied().unwrap_or([0.0; D]);
                for slot in group.particles.slots_of(own.body, *id) {
                    all[slot] = number as f64 + 1.0;
                    for d in 0..D {
                        all[(1 + d) * slots + slot] = rest[d];
                        all[(first_given::<D>() + d) * slots + slot] = force[d];
                    }
                }
            }
        }
        all
    }

    /// The columns of [`held`](Self::held) that change, of which all but as many as there are dimensions are sums.
    pub(super) fn held_changes(&self) -> Range<usize> {
        first_given::<D>()..width::<D>()
    }

    /// Takes back what clamps have given since it was sent, in the columns of [`held_changes`](Self::held_changes), whose sums the device
    /// begins anew.
    pub(super) fn take_held(&mut self, group: usize, numbers: &[f64]) {
        let group = &mut self.simulation.state.groups[group];
        let slots = group.particles.columns.slots();
        let at = |column: usize, slot: usize| numbers[column * slots + slot];
        for own in &mut group.held.clamps {
            let [forces, _] = &mut own.forces;
            forces.clear();
            for (id, _) in &own.particles {
                let slot = group.particles.slots_of(own.body, *id).start;
                forces.push(core::array::from_fn(|d| at(d, slot)));
                (0..D).for_each(|d| own.impulse[d] += at(D + d, slot));
                own.work += at(2 * D, slot);
            }
        }
    }
}
