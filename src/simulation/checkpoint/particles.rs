//! What a checkpoint holds of particles: their columns, which slot each is in, and what has left.
//! Columns are put under the names of their fields.

use super::change::{Change, Changes};
use crate::output::checkpoint::{Checkpoint, Read, damaged};
use crate::scalar::Real;
use crate::scheme::Scheme;
use crate::simulation::population::{BodyState, Moves, Particles, Passed};
use std::ops::Range;

pub(super) fn put_particles<T: Real, const D: usize>(
    particles: &Particles<T, D>,
    scheme: &Scheme<T, D>,
    name: &str,
    file: &mut Checkpoint,
) {
    let Particles {
        columns,
        bodies,
        mobile: _,
        ids,
        slot_of,
        removed,
        entered,
        first_id: _,
        // Of the simulation.
        origin: _,
        // Saved states have been told between steps.
        moved: _,
    } = particles;
    for field in columns.fields().iter() {
        let column = format!("{name}/particles/{}", scheme.program.name_of(field));
        file.put_reals(column, field.components(D), columns.raw(field));
    }
    let end = |body: &BodyState<T>| {
        let BodyState {
            name: _,
            material: _,
            slots,
            end: _,
            ids: _,
            spacing: _,
        } = body;
        slots.end as u64
    };
    let ends: Vec<u64> = bodies.iter().map(end).collect();
    file.put(format!("{name}/body_ends"), 1, ends);
    file.put(format!("{name}/ids"), 1, ids);
    file.put(format!("{name}/slot_of"), 1, slot_of);
    put_passed(removed, &format!("{name}/removed"), file);
    // Files of runs into which nothing has entered are as they were.
    if entered.particles > 0 {
        put_passed(entered, &format!("{name}/entered"), file);
    }
}

fn put_passed<const D: usize>(passed: &Passed<D>, name: &str, file: &mut Checkpoint) {
    let Passed {
        particles,
        mass,
        momentum,
        kinetic,
    } = passed;
    file.put_one(format!("{name}/particles"), *particles);
    file.put_one(format!("{name}/mass"), *mass);
    file.put(format!("{name}/momentum"), 1, momentum);
    file.put_one(format!("{name}/kinetic"), *kinetic);
}

fn take_passed<const D: usize>(name: &str, file: &Checkpoint) -> Read<Passed<D>> {
    Ok(Passed {
        particles: file.get_one(&format!("{name}/particles"))?,
        mass: file.get_one(&format!("{name}/mass"))?,
        momentum: file.get_array(&format!("{name}/momentum"))?,
        kinetic: file.get_one(&format!("{name}/kinetic"))?,
    })
}

pub(super) fn take_particles<T: Real, const D: usize>(
    particles: &mut Particles<T, D>,
    scheme: &Scheme<T, D>,
    (name, file): (&str, &Checkpoint),
    changes: Changes<'_>,
) -> Read<()> {
    let slots = particles.columns.slots();
    for field in particles.columns.fields().iter() {
        let column = format!("{name}/particles/{}", scheme.program.name_of(field));
        // What a load that is new gives to.
        if changes.has(Change::Loads) && !file.has(&column) {
            continue;
        }
        let numbers = file.get_all_reals(&column, slots * field.components(D))?;
        *particles.columns.column_mut(field) = numbers;
    }
    let ends = file.get_all::<u64>(&format!("{name}/body_ends"), particles.bodies.len())?;
    particles.ids = file.get_all(&format!("{name}/ids"), slots)?;
    particles.slot_of = file.get_all(&format!("{name}/slot_of"), slots)?;
    for (k, end) in ends.into_iter().enumerate() {
        let run = particles.bodies[k].run();
        check_run(particles, run.clone())?;
        let end = end as usize;
        if !(run.start..=run.end).contains(&end) {
            return Err(damaged("a body ends outside of its run"));
        }
        particles.bodies[k].slots.end = end;
    }
    particles.moved = Moves::default();
    particles.removed = take_passed(&format!("{name}/removed"), file)?;
    particles.entered = if file.has(&format!("{name}/entered/particles")) {
        take_passed(&format!("{name}/entered"), file)?
    } else {
        Passed::default()
    };
    Ok(())
}

/// Particles stay in the run of their body or wall.
pub(super) fn check_run<T: Real, const D: usize>(
    particles: &Particles<T, D>,
    run: Range<usize>,
) -> Read<()> {
    let inside = |slot: &u32| run.contains(&(*slot as usize));
    let ids = particles.ids[run.clone()].iter().all(inside);
    let slots = particles.slot_of[run.clone()].iter();
    if ids && slots.filter(|slot| **slot != u32::MAX).all(inside) {
        return Ok(());
    }
    Err(damaged("a particle is outside of the run of its body"))
}
