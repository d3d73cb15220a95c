//! All that a simulation says of itself, to the bit.
//! With places, for runs of the same scene, and without, for scenes that have been moved.

use meshfree::prelude::*;

/// Places of particles, forces on walls, and all other numbers.
pub fn said<T: Real, const D: usize>(simulation: &Simulation<T, D>) -> Vec<u64> {
    let walls = 0..simulation.walls().count();
    let of_walls = walls.flat_map(|wall| simulation.wall(wall).unwrap());
    let particles = simulation.all().chain(of_walls).map(|own| own.position());
    let forces = simulation.wall_particle_forces();
    let places = particles.chain(forces.iter().map(|own| own.0));
    let mut all: Vec<u64> = places.flatten().map(f64::to_bits).collect();
    all.extend(said_but_places(simulation));
    all
}

pub(super) fn said_but_places<T: Real, const D: usize>(simulation: &Simulation<T, D>) -> Vec<u64> {
    let mut all = vec![
        simulation.steps(),
        simulation.evaluations(),
        simulation.list_builds(),
        simulation.guard_counts().total(),
        simulation.removed().particles,
        simulation.time().to_bits(),
    ];
    all.extend(simulation.limits().iter().map(|limit| limit.1));
    let walls = simulation.walls().count();
    let of_walls = (0..walls).flat_map(|wall| simulation.wall(wall).unwrap());
    for particle in simulation.all().chain(of_walls) {
        all.push(particle.id() as u64);
        let mut add = |numbers: &[f64]| all.extend(numbers.iter().map(|x| x.to_bits()));
        add(&particle.velocity());
        add(&particle.acceleration());
        for field in Fields::ALL.iter() {
            add(particle.scalar(field).as_slice());
            if let Some(tensor) = particle.tensor(field) {
                add(tensor.components());
            }
        }
    }
    let mut add = |numbers: &[f64]| all.extend(numbers.iter().map(|x| x.to_bits()));
    let ledger = simulation.ledger();
    for impulse in [
        &ledger.boundary_impulse,
        &ledger.law_impulse,
        &ledger.joint_impulse,
    ] {
        add(impulse);
    }
    for (_, budget) in &ledger.bodies {
        add(&budget.momentum);
        add(&[budget.mass, budget.kinetic, budget.internal]);
    }
    for wall in 0..walls {
        add(&simulation.wall_impulse(wall).unwrap());
        add(&simulation.wall_force(wall).unwrap());
    }
    for (_, force) in simulation.wall_particle_forces() {
        add(&force);
    }
    for clamp in simulation.clamps() {
        add(&clamp.impulse);
    }
    for contact in simulation.contacts() {
        add(&contact.force);
    }
    for joint in simulation.joints() {
        add(&joint.force);
        add(&joint.moment);
        add(&joint.impulse);
        add(&[joint.value, joint.rate, joint.stored, joint.work]);
        add(&[joint.motor_work, joint.heat]);
    }
    for passed in [simulation.removed(), simulation.entered()] {
        add(&passed.momentum);
        add(&[passed.mass, passed.kinetic]);
    }
    if let Some(energy) = simulation.energy() {
        add(&[energy.load_work, energy.wall_work, energy.dissipated]);
    }
    if let Some(vote) = simulation.last_vote() {
        add(&[vote.step]);
        all.push(vote.particle as u64);
    }
    all
}
