//! What a run is, as numbers: every quantity of a simulation that its user can ask for, to the bit.
//! All use of accessors is here, so a change of their names is made in one place.

use meshfree::particles::Field;
use meshfree::scalar::Real;
use meshfree::simulation::{ParticleView, Simulation};

/// Scalars that a particle may carry beside those with accessors of their own.
const CARRIED: [Field; 6] = [
    Field::SOUND_SPEED,
    Field::VISCOSITY_COEFFICIENT,
    Field::DYNAMIC_VISCOSITY,
    Field::EXPANSION,
    Field::CONTACT_ACTIVITY,
    Field::GRAD_H,
];

/// The hash of Fowler, Noll & Vo (FNV-1a) in 64 bits, and whether all numbers in it were finite.
#[derive(Clone, Copy, Debug)]
pub struct Hash {
    pub value: u64,
    pub finite: bool,
}

impl Hash {
    pub fn new() -> Self {
        Self {
            value: 0xcbf2_9ce4_8422_2325,
            finite: true,
        }
    }
    pub fn count(&mut self, number: u64) {
        for byte in number.to_le_bytes() {
            self.value = (self.value ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }
    pub fn number(&mut self, number: f64) {
        self.finite &= number.is_finite();
        // Adding zero makes one of the two zeros: the sign of an empty sum says nothing.
        self.count((number + 0.0).to_bits());
    }
    pub fn numbers(&mut self, numbers: impl IntoIterator<Item = f64>) {
        numbers.into_iter().for_each(|number| self.number(number));
    }
    /// Adds things whose order says nothing: the sum of their own hashes.
    fn unordered(&mut self, hashes: impl IntoIterator<Item = Hash>) {
        let mut sum = 0_u64;
        for hash in hashes {
            sum = sum.wrapping_add(hash.value);
            self.finite &= hash.finite;
        }
        self.count(sum);
    }
}

/// Adds what a particle is and carries.
fn particle<T: Real, const D: usize>(hash: &mut Hash, particle: &ParticleView<'_, T, D>) {
    hash.numbers(particle.position());
    hash.numbers(particle.velocity());
    hash.numbers([
        particle.density(),
        particle.pressure(),
        particle.energy(),
        particle.mass(),
        particle.smoothing_length(),
    ]);
    for field in CARRIED {
        match particle.scalar(field) {
            Some(value) => hash.number(value),
            None => hash.count(0),
        }
    }
}

/// All particles of bodies in the order of their identity, and those of walls in any.
pub fn particles<T: Real, const D: usize>(now: &Simulation<T, D>) -> Hash {
    let mut hash = Hash::new();
    for own in now.all() {
        hash.count(own.id() as u64);
        particle(&mut hash, &own);
    }
    for (index, name) in now.walls().enumerate() {
        name.bytes().for_each(|byte| hash.count(u64::from(byte)));
        hash.unordered(now.wall(index).unwrap().map(|own| {
            let mut hash = Hash::new();
            particle(&mut hash, &own);
            hash
        }));
    }
    hash
}

/// The ledgers, what has left, and forces between bodies and walls.
pub fn balances<T: Real, const D: usize>(now: &Simulation<T, D>) -> Hash {
    let mut hash = Hash::new();
    let ledger = now.ledger();
    let whole = (String::new(), ledger.whole);
    for (name, budget) in ledger.bodies.into_iter().chain([whole]) {
        name.bytes().for_each(|byte| hash.count(u64::from(byte)));
        hash.numbers([budget.mass, budget.kinetic, budget.internal]);
        hash.numbers(budget.momentum);
    }
    hash.number(ledger.time);
    hash.numbers(ledger.boundary_impulse);
    if let Some(energy) = now.energy() {
        hash.numbers([
            energy.kinetic,
            energy.compression,
            energy.load_work,
            energy.wall_work,
            energy.left,
            energy.dissipated,
        ]);
    }
    let removed = now.removed();
    hash.count(removed.particles);
    hash.numbers([removed.mass, removed.kinetic]);
    hash.numbers(removed.momentum);
    let (bodies, walls) = (now.bodies().count(), now.walls().count());
    for wall in 0..walls {
        hash.numbers(now.wall_impulse(wall).unwrap());
        hash.numbers(now.wall_force(wall).unwrap());
    }
    for on in 0..bodies {
        for from in (0..bodies + walls).filter(|&from| from != on) {
            hash.numbers(now.force_between(on, from).unwrap());
        }
    }
    hash.unordered(now.wall_particle_forces().into_iter().map(|(x, force)| {
        let mut hash = Hash::new();
        hash.numbers(x);
        hash.numbers(force);
        hash
    }));
    hash
}

/// How much was done, and what guards have done.
pub fn counts<T: Real, const D: usize>(now: &Simulation<T, D>) -> Hash {
    let mut hash = Hash::new();
    let guards = now.guard_counts();
    for count in [
        now.particles() as u64,
        now.steps(),
        now.evaluations(),
        now.list_builds(),
        guards.compression,
        guards.expansion,
        guards.cut_off,
        now.limited_smoothing_lengths(),
        now.limited("cavitation"),
    ] {
        hash.count(count);
    }
    hash
}

/// One line of a history: time, who set the step, a few particles and the whole momentum.
pub fn moment<T: Real, const D: usize>(hash: &mut Hash, now: &Simulation<T, D>) {
    hash.number(now.time());
    if let Some(vote) = now.last_vote() {
        hash.number(vote.step);
        hash.count(vote.particle as u64);
    }
    let every = now.particles() / 5 + 1;
    for own in now.all().step_by(every) {
        hash.numbers(own.position());
        hash.numbers([own.velocity()[0], own.density(), own.pressure()]);
    }
    hash.numbers(now.ledger().whole.momentum);
}
