//! What a checkpoint holds of clamps and rigid bodies: what holds them, what that has given, and how they stand.
//! Which particles are clamped or rigid follows from the scene.

use super::change::{Change, Changes};
use crate::output::checkpoint::{Checkpoint, Read};
use crate::simulation::held::{Clamp, Held};
use crate::simulation::rigid::Rigid;
use nalgebra::{Quaternion, UnitQuaternion};

pub(super) fn put_held<const D: usize>(held: &Held<D>, name: &str, file: &mut Checkpoint) {
    let Held { clamps, rigid } = held;
    for (k, own) in clamps.iter().enumerate() {
        let Clamp {
            body: _,
            particles: _,
            motion: _,
            // By the events, which are kept.
            since: _,
            until: _,
            is_free: _,
            forces,
            impulse,
            work,
        } = own;
        for (n, forces) in forces.iter().enumerate() {
            let column = format!("{name}/clamp{k}/forces{n}");
            file.put(column, D, forces.as_flattened());
        }
        file.put(format!("{name}/clamp{k}/impulse"), 1, impulse);
        file.put_one(format!("{name}/clamp{k}/work"), *work);
    }
    for (k, own) in rigid.iter().enumerate() {
        let Rigid {
            body: _,
            mass: _,
            places: _,
            inertia: _,
            centre,
            turn,
            built: _,
            back,
        } = own;
        file.put(format!("{name}/rigid{k}/centre"), 1, centre);
        file.put(format!("{name}/rigid{k}/turn"), 1, turn.coords.as_slice());
        file.put(format!("{name}/rigid{k}/back"), D, back.as_flattened());
    }
}

pub(super) fn take_held<const D: usize>(
    held: &mut Held<D>,
    (name, file): (&str, &Checkpoint),
    changes: Changes<'_>,
) -> Read<()> {
    // Of clamps that may be others nothing is known.
    let clamps = held.clamps.iter_mut();
    let clamps = clamps.filter(|_| !changes.has(Change::Motions));
    for (k, own) in clamps.enumerate() {
        for (n, forces) in own.forces.iter_mut().enumerate() {
            let numbers = file.get::<f64>(&format!("{name}/clamp{k}/forces{n}"))?;
            forces.clear();
            forces.extend_from_slice(numbers.as_chunks::<D>().0);
        }
        own.impulse = file.get_array(&format!("{name}/clamp{k}/impulse"))?;
        own.work = file.get_one(&format!("{name}/clamp{k}/work"))?;
    }
    for (k, own) in held.rigid.iter_mut().enumerate() {
        own.centre = file.get_array(&format!("{name}/rigid{k}/centre"))?;
        let turn: [f64; 4] = file.get_array(&format!("{name}/rigid{k}/turn"))?;
        own.turn = UnitQuaternion::new_unchecked(Quaternion::from_vector(turn.into()));
        let back = file.get::<f64>(&format!("{name}/rigid{k}/back"))?;
        own.back.clear();
        own.back.extend_from_slice(back.as_chunks::<D>().0);
    }
    Ok(())
}
