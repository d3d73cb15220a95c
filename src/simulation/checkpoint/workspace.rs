//! What a checkpoint holds of a group's lists and workspace: where lists were built, rates, sums, and saved states.
//! Lists follow from the places that they were built from, and are built again.

use super::whole::{Kept, Whole};
use crate::output::checkpoint::{Checkpoint, Read, damaged};
use crate::particles::{Columns, Field, Output, Outputs};
use crate::scalar::Real;
use crate::scheme::Scheme;
use crate::simulation::Phases;
use crate::simulation::cost::Spent;
use crate::simulation::evolve::state;
use crate::simulation::neighborhood::Neighborhood;
use crate::simulation::settle::Settling;
use crate::simulation::workspace::{Saved, Workspace};
use crate::sweep::{Reaction, Records, Results};
use crate::term::Stage;

/// Of the lists all but themselves: the places and smoothing lengths that they were built from, and the time \[s\] at which the
/// transforms of images were.
pub(super) fn take_neighborhood<T: Real, const D: usize>(
    own: &mut Neighborhood<T, D>,
    (columns, kept): (&Columns<T, D>, &Kept),
    name: &str,
    file: &Checkpoint,
) -> Read<(Saved<T>, f64)> {
    own.listed_time = file.get_one(&format!("{name}/listed_time"))?;
    own.listed_reach = file.get_one(&format!("{name}/listed_reach"))?;
    let placed_time = file.get_one(&format!("{name}/placed_time"))?;
    own.skin = file.get_one(&format!("{name}/skin"))?;
    own.served = file.get_one(&format!("{name}/served"))?;
    own.rebuilds = file.get_one(&format!("{name}/rebuilds"))?;
    let entries = file.get_one::<u64>(&format!("{name}/sorted_entries"))?;
    own.sorted_entries = entries as usize;
    let x = file.get_all_reals(&format!("{name}/listed_position"), kept.slots * D)?;
    let count = kept.count_of(columns, Field::SMOOTHING_LENGTH);
    let h = file.get_all_reals(&format!("{name}/listed_smoothing_length"), count)?;
    let listed = [(Field::POSITION, x), (Field::SMOOTHING_LENGTH, h)];
    let listed = listed.map(|(field, all)| (field, kept.column(all))).into();
    Ok((listed, placed_time))
}

pub(super) fn take_workspace<T: Real, const D: usize>(
    (columns, kept_here): (&Columns<T, D>, &Kept),
    (scheme, mobile): (&Scheme<T, D>, usize),
    name: &str,
    file: &Checkpoint,
) -> Read<Workspace<T, D>> {
    let rows = |what: &str| -> Read<Results<T, D>> {
        let all = take_rows(scheme, &format!("{name}/{what}"), file)?;
        Ok(kept_here.sums(all, mobile))
    };
    let saved = |what: &str, fields: Vec<Field>| -> Read<Saved<T>> {
        let mut saved = Saved::new();
        for field in fields {
            let column = format!("{name}/{what}/{}", scheme.program.name_of(field));
            // What has no column is kept as none.
            let count = kept_here.count_of(columns, field);
            let numbers = match count {
                0 => Vec::new(),
                _ => file.get_all_reals(&column, count)?,
            };
            saved.push((field, kept_here.column(numbers)));
        }
        Ok(saved)
    };
    let mut kept = Vec::new();
    while let what = format!("kept{}", kept.len())
        && let Ok(full) = file.get_one::<u32>(&format!("{name}/{what}/full"))
    {
        let fields = if full == 0 {
            Vec::new()
        } else {
            state(&scheme.program).collect()
        };
        kept.push(saved(&what, fields)?);
    }
    let evaluated: [f64; D] = file.get_array(&format!("{name}/evaluated_gravity"))?;
    Ok(Workspace {
        records: take_records(&format!("{name}/records"), file)?,
        work_records: take_records(&format!("{name}/work_records"), file)?,
        records_of_rates: file.get_one::<u32>(&format!("{name}/records_of_rates"))? != 0,
        rates: rows("rates")?,
        evaluated_time: file.get_one(&format!("{name}/evaluated_time"))?,
        evaluated_gravity: evaluated.map(T::from_f64),
        worked: rows("worked")?,
        first_kick: take_first_kick(name, file)?,
        lengths_time: file.get_one(&format!("{name}/lengths_time"))?,
        sums: Results::default(),
        coupling: rows("coupling")?,
        settling: Settling::default(),
        predicted: Saved::new(),
        is_predicted: false,
        kept,
        phases: Phases::default(),
        spent: Spent::default(),
    })
}

pub(super) fn put_neighborhood<T: Real, const D: usize>(
    (neighborhood, whole): (&Neighborhood<T, D>, &Whole<'_, T, D>),
    slots: usize,
    name: &str,
    file: &mut Checkpoint,
) {
    let Neighborhood {
        blocks: _,
        mirrored: _,
        interactions: _,
        images: _,
        chains: _,
        lists: _,
        listed,
        listed_h,
        listed_time,
        listed_reach,
        placed_time,
        skin,
        skins: _,
        served: _,
        rebuilds,
        sorted_entries,
        support: _,
        smoothing_length: _,
        whole: _,
    } = neighborhood;
    // Images stand behind the slots.
    let listed = whole.column(&listed[..slots], 1);
    let lengths = whole.column(&listed_h[..slots.min(listed_h.len())], 1);
    file.put_reals(format!("{name}/listed_position"), D, listed.as_flattened());
    file.put_reals(format!("{name}/listed_smoothing_length"), 1, &lengths);
    file.put_one(format!("{name}/listed_time"), *listed_time);
    file.put_one(format!("{name}/listed_reach"), *listed_reach);
    file.put_one(format!("{name}/placed_time"), *placed_time);
    file.put_one(format!("{name}/skin"), *skin);
    file.put_one(format!("{name}/rebuilds"), *rebuilds);
    file.put_one(format!("{name}/sorted_entries"), *sorted_entries as u64);
}

pub(super) fn put_workspace<T: Real, const D: usize>(
    (work, whole): (&Workspace<T, D>, &Whole<'_, T, D>),
    (scheme, has_walls): (&Scheme<T, D>, bool),
    name: &str,
    file: &mut Checkpoint,
) {
    let Workspace {
        records,
        work_records,
        records_of_rates,
        rates,
        evaluated_time,
        evaluated_gravity: _,
        worked,
        first_kick,
        lengths_time,
        // Each sweep sums anew.
        sums: _,
        coupling,
        // A prediction is taken back in the step that makes it.
        predicted: _,
        is_predicted: _,
        kept,
        phases: _,
        spent: _,
        // Found anew in each evaluation.
        settling: _,
    } = work;
    // Only sums over walls read records without packing them.
    let records = if *records_of_rates && has_walls {
        records
    } else {
        &Records::default()
    };
    put_records(whole, records, &format!("{name}/records"), file);
    put_records(whole, work_records, &format!("{name}/work_records"), file);
    let of_rates = u32::from(*records_of_rates);
    file.put_one(format!("{name}/records_of_rates"), of_rates);
    file.put_one(format!("{name}/lengths_time"), *lengths_time);
    file.put_one(format!("{name}/evaluated_time"), *evaluated_time);
    let first_kick = first_kick.unwrap_or([f64::NAN; 2]);
    file.put(format!("{name}/first_kick"), 1, first_kick);
    for (what, rows) in [("rates", rates), ("worked", worked)] {
        put_rows(&whole.sums(rows), &format!("{name}/{what}"), file);
    }
    put_rows(coupling, &format!("{name}/coupling"), file);
    let mut put_saved = |what: &str, saved: &Saved<T>| {
        for (field, column) in saved.iter().filter(|(_, column)| !column.is_empty()) {
            let name = format!("{name}/{what}/{}", scheme.program.name_of(*field));
            let width = field.components(D);
            file.put_reals(name, width, &whole.column(column, width));
        }
    };
    for (k, saved) in kept.iter().enumerate() {
        put_saved(&format!("kept{k}"), saved);
    }
    for (k, saved) in kept.iter().enumerate() {
        let full = u32::from(!saved.is_empty());
        file.put_one(format!("{name}/kept{k}/full"), full);
    }
}

/// The first kick that took the forces at hand; no number where there was none.
fn take_first_kick(name: &str, file: &Checkpoint) -> Read<Option<[f64; 2]>> {
    let stored: [f64; 2] = file.get_array(&format!("{name}/first_kick"))?;
    Ok(stored.iter().all(|own| !own.is_nan()).then_some(stored))
}

fn put_records<T: Real, const D: usize>(
    whole: &Whole<'_, T, D>,
    records: &Records<T>,
    name: &str,
    file: &mut Checkpoint,
) {
    let width = records.stride().max(1);
    file.put_reals(name.into(), width, &whole.column(records.data(), width));
    file.put_one(format!("{name}/stride"), records.stride() as u64);
}

fn take_records<T: Real>(name: &str, file: &Checkpoint) -> Read<Records<T>> {
    let stride = file.get_one::<u64>(&format!("{name}/stride"))? as usize;
    Ok(Records::of_stored(file.get_reals(name)?, stride))
}

fn put_rows<T: Real, const D: usize>(rows: &Results<T, D>, name: &str, file: &mut Checkpoint) {
    let names: Vec<_> = rows.outputs().iter().map(Output::full_name).collect();
    let (data, first) = rows.stored();
    file.put_text(name, names.join("\n"));
    file.put_reals(name.into(), 1, data);
    file.put_one(format!("{name}/first"), first as u64);
    let blocks: Vec<u32> = rows
        .reactions()
        .flat_map(|Reaction { on, from, force: _ }| [*on, *from])
        .collect();
    let forces: Vec<f64> = rows
        .reactions()
        .flat_map(|reaction| reaction.force)
        .collect();
    file.put(format!("{name}/reactions/blocks"), 2, blocks);
    file.put(format!("{name}/reactions/force"), D, forces);
}

fn take_rows<T: Real, const D: usize>(
    scheme: &Scheme<T, D>,
    name: &str,
    file: &Checkpoint,
) -> Read<Results<T, D>> {
    let sweeps = Stage::ALL
        .into_iter()
        .filter_map(|stage| scheme.sweep(stage));
    let sweeps = sweeps.chain(scheme.reference.as_deref());
    let known = sweeps.fold(Outputs::ALL, |all, sweep| all.union(sweep.outputs()));
    let mut outputs = Outputs::NONE;
    for sum in file.text(name)?.lines() {
        let own = known.iter().find(|own| own.full_name() == sum);
        let own = own.ok_or_else(|| damaged(format!("there is no sum `{sum}`")))?;
        outputs = outputs.union(Outputs::of(&[own]));
    }
    let first = file.get_one::<u64>(&format!("{name}/first"))? as usize;
    let blocks = file.get::<u32>(&format!("{name}/reactions/blocks"))?;
    let (blocks, _) = blocks.as_chunks::<2>();
    let column = format!("{name}/reactions/force");
    let forces = file.get_all::<f64>(&column, blocks.len() * D)?;
    let (forces, _) = forces.as_chunks::<D>();
    let reactions = blocks
        .iter()
        .zip(forces)
        .map(|([on, from], force)| Reaction {
            on: *on,
            from: *from,
            force: *force,
        });
    let data = file.get_reals(name)?;
    Ok(Results::of_stored(
        outputs,
        (data, first),
        reactions.collect(),
    ))
}
