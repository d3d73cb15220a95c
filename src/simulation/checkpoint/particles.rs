//! What a checkpoint holds of particles: their columns, which slot each is in, and what has left.
//! Columns are put under the names of their fields.

use super::change::{Change, Changes};
use super::whole::{Kept, Whole};
use crate::output::checkpoint::{Checkpoint, Read, damaged};
use crate::particles::Field;
use crate::scalar::Real;
use crate::scheme::Scheme;
use crate::simulation::group::Group;
use crate::simulation::population::{BodyState, Moves, Particles, Passed};
use crate::term::Stage;
use std::ops::Range;

pub(super) fn put_particles<T: Real, const D: usize>(
    (particles, whole): (&Particles<T, D>, &Whole<'_, T, D>),
    scheme: &Scheme<T, D>,
    name: &str,
    file: &mut Checkpoint,
) {
    let Particles {
        columns,
        // Of all particles.
        bodies: _,
        mobile: _,
        ids: _,
        slot_of: _,
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
        let width = field.components(D);
        file.put_reals(column, width, &whole.column(columns.raw(field), width));
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
    let ends: Vec<u64> = whole.bodies().iter().map(end).collect();
    file.put(format!("{name}/body_ends"), 1, ends);
    let ids = whole.ids();
    file.put(format!("{name}/ids"), 1, &ids);
    file.put(format!("{name}/slot_of"), 1, whole.slot_of(&ids));
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
    group: &mut Group<T, D>,
    kept: &Kept,
    (name, file): (&str, &Checkpoint),
    changes: Changes<'_>,
) -> Read<()> {
    let (particles, scheme) = (&mut group.particles, &*group.scheme);
    let viscosities = if changes.has(Change::Viscosity) {
        built_viscosities(particles, scheme)
    } else {
        Vec::new()
    };
    for field in particles.columns.fields().iter() {
        let column = format!("{name}/particles/{}", scheme.program.name_of(field));
        // What a load that is new gives to.
        if changes.has(Change::Loads) && !file.has(&column) {
            continue;
        }
        let numbers = file.get_all_reals(&column, kept.slots * field.components(D))?;
        *particles.columns.column_mut(field) = kept.column(numbers);
    }
    take_order(group, kept, (name, file))?;
    let particles = &mut group.particles;
    if !viscosities.is_empty() {
        let column = particles.columns.raw_mut(Field::DYNAMIC_VISCOSITY);
        for body in particles.bodies.iter().filter(|own| !own.slots.is_empty()) {
            for slot in body.run() {
                // The last particle is repeated to the end of the run.
                let id = particles.ids[slot.min(body.slots.end - 1)] as usize;
                column[slot] = viscosities[id].unwrap_or(column[slot]);
            }
        }
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

/// Which particle is in which slot, and where bodies end.
fn take_order<T: Real, const D: usize>(
    group: &mut Group<T, D>,
    kept: &Kept,
    (name, file): (&str, &Checkpoint),
) -> Read<()> {
    let (bodies, walls) = match &group.all {
        None => (&group.particles.bodies, &group.walls),
        Some(all) => (&all.particles.bodies, &all.walls),
    };
    let ends = file.get_all::<u64>(&format!("{name}/body_ends"), bodies.len())?;
    let ids: Vec<u32> = file.get_all(&format!("{name}/ids"), kept.slots)?;
    let slot_of: Vec<u32> = file.get_all(&format!("{name}/slot_of"), kept.slots)?;
    for (body, end) in bodies.iter().zip(&ends) {
        check_run((&ids, &slot_of), body.run())?;
        let end = *end as usize;
        // Where ranks begin with their own alone nothing leaves.
        let has_all = group.all.is_none() || end == body.slots.end;
        if !has_all || !(body.slots.start..=body.end).contains(&end) {
            return Err(damaged("a body ends outside of its run"));
        }
    }
    for wall in walls {
        check_run((&ids, &slot_of), wall.slots.start..wall.end)?;
    }
    group.particles.ids = kept.column(ids);
    if let Some(all) = &group.all {
        let own = &mut group.particles.ids;
        all.part.number_walls(own, &all.walls, true);
        return Ok(());
    }
    group.particles.slot_of = slot_of;
    for (body, end) in group.particles.bodies.iter_mut().zip(ends) {
        body.slots.end = end as usize;
    }
    Ok(())
}

/// The viscosity \[Pa s\] that the scene gives each particle of its bodies, by number. Where no law of the scheme makes another of
/// it, the column of the file has that of the earlier material.
fn built_viscosities<T: Real, const D: usize>(
    particles: &Particles<T, D>,
    scheme: &Scheme<T, D>,
) -> Vec<Option<T>> {
    const VISCOSITY: Field = Field::DYNAMIC_VISCOSITY;
    if !particles.columns.fields().contains(VISCOSITY) {
        return Vec::new();
    }
    let program = &scheme.program;
    // Walls take that of the liquid before them.
    let mut stages = Stage::ALL.into_iter().filter(|own| *own != Stage::Walls);
    let varies = program.evolved.iter().any(|own| own.field == VISCOSITY)
        || stages.any(|stage| {
            let mut laws = program.laws[stage.number()].iter();
            laws.any(|law| law.writes().contains(VISCOSITY))
        });
    let built = particles.columns.raw(VISCOSITY);
    let mut all = vec![None; particles.slot_of.len()];
    for body in &particles.bodies {
        let law = body.material.rheology();
        if varies && law.is_some() {
            continue;
        }
        let of_material = T::from_f64(law.map_or(0.0, |law| law.viscosity(0.0)));
        for id in body.run() {
            // Those that are yet to enter have no slot.
            let own = built.get(particles.slot_of[id] as usize);
            all[id] = Some(own.copied().unwrap_or(of_material));
        }
    }
    all
}

/// Particles stay in the run of their body or wall.
fn check_run((ids, slot_of): (&[u32], &[u32]), run: Range<usize>) -> Read<()> {
    let inside = |slot: &u32| run.contains(&(*slot as usize));
    let ids = ids[run.clone()].iter().all(inside);
    let slots = slot_of[run.clone()].iter();
    if ids && slots.filter(|slot| **slot != u32::MAX).all(inside) {
        return Ok(());
    }
    Err(damaged("a particle is outside of the run of its body"))
}
