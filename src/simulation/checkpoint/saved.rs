//! Particles of a checkpoint without its scene: where those of bodies are, and their columns by the names of fields.
//! What is needed of a file is which slots hold them; walls and repeated particles are left out.

use super::check_format;
use crate::error::CheckpointProblem;
use crate::origin::global;
use crate::output::checkpoint::{Checkpoint, Read, damaged};
use crate::particles::Field;

/// Particles of the bodies of a group, body by body in the order of identities.
pub(crate) struct SavedGroup<const D: usize> {
    /// Where they are in the scene \[m\].
    pub points: Vec<[f64; D]>,
    /// The body of each, among those of the group.
    pub bodies: Vec<usize>,
    /// How many bodies the group has.
    pub count: usize,
    /// The name of each field, how many numbers a particle has of it, and these.
    pub columns: Vec<(String, usize, Vec<f64>)>,
}

/// All groups of a file, of `f32` or `f64`.
pub(crate) fn saved_groups<const D: usize>(file: &Checkpoint) -> Read<Vec<SavedGroup<D>>> {
    check_format(file)?;
    let found = file.text("dimension")?;
    if found != D.to_string() {
        return Err(CheckpointProblem::Kind {
            what: "dimension",
            found: found.into(),
            own: D.to_string(),
        });
    }
    let origin = file.get_array("origin")?;
    let names = (0..).map(|k| format!("group{k}"));
    let names = names.take_while(|name| file.has(&format!("{name}/body_ends")));
    names
        .map(|name| saved_group(&name, &origin, file))
        .collect()
}

fn saved_group<const D: usize>(
    name: &str,
    origin: &[f64; D],
    file: &Checkpoint,
) -> Read<SavedGroup<D>> {
    let ends = file.get::<u64>(&format!("{name}/body_ends"))?;
    let particles = particles(file, name, &ends)?;
    let of = |begin: &str, column: &str| -> Read<(usize, Vec<f64>)> {
        let (width, numbers) = file.get_rows(&format!("{begin}{column}"))?;
        let mut own = Vec::with_capacity(particles.len() * width);
        for (_, slot) in &particles {
            let row = numbers.get(slot * width..(slot + 1) * width);
            own.extend(row.ok_or_else(|| damaged(format!("column `{column}` is too short")))?);
        }
        Ok((width, own))
    };
    let begin = format!("{name}/particles/");
    let place = |field: Field| -> Read<Vec<[f64; D]>> {
        let (_, numbers) = of(&begin, field.name())?;
        Ok(numbers.as_chunks::<D>().0.to_vec())
    };
    let mut points = place(Field::POSITION)?;
    let residual = Field::POSITION_RESIDUAL;
    if file.has(&format!("{begin}{}", residual.name())) {
        for (x, lost) in points.iter_mut().zip(place(residual)?) {
            *x = core::array::from_fn(|d| x[d] + lost[d]);
        }
    }
    let places = [Field::POSITION, residual].map(Field::name);
    let columns = file.names(&begin).filter(|column| !places.contains(column));
    let columns = columns.map(|column| {
        let (width, numbers) = of(&begin, column)?;
        Ok((column.to_owned(), width, numbers))
    });
    Ok(SavedGroup {
        points: points.iter().map(|x| global(x, origin)).collect(),
        bodies: particles.iter().map(|own| own.0).collect(),
        count: ends.len(),
        columns: columns.collect::<Read<_>>()?,
    })
}

/// Body and slot of each particle of a group that is in a body.
fn particles(file: &Checkpoint, name: &str, ends: &[u64]) -> Read<Vec<(usize, usize)>> {
    let ids = file.get::<u32>(&format!("{name}/ids"))?;
    let slot_of = file.get::<u32>(&format!("{name}/slot_of"))?;
    let mut all = Vec::new();
    let mut body = 0;
    for (slot, id) in ids.into_iter().enumerate() {
        // Behind the bodies are walls.
        while ends.get(body).is_some_and(|end| *end <= slot as u64) {
            body += 1;
        }
        // Another slot repeats its particle.
        if body < ends.len() && slot_of.get(id as usize) == Some(&(slot as u32)) {
            all.push((body, id, slot));
        }
    }
    all.sort_unstable();
    let all = all.into_iter().map(|(body, _, slot)| (body, slot));
    Ok(all.collect())
}
