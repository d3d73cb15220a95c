//! What a checkpoint holds of joints: where each is, what acts, and what it has given.
//! What joints are follows from the scene.

use crate::output::checkpoint::{Checkpoint, Read};
use crate::simulation::joints::{Jointing, Joints};
use nalgebra::Vector3;

/// Numbers of a joint, without its impulse and its multipliers.
const NUMBERS: usize = 14;

impl<const D: usize> Joints<D> {
    pub(super) fn put(&self, file: &mut Checkpoint) {
        for (k, own) in self.all.iter().enumerate() {
            let Jointing {
                joint: _,
                number: _,
                bodies: _,
                names: _,
                geometry: _,
                value,
                rest: _,
                target,
                acting,
                driving,
                damping,
                holding,
                // Of a step, and none between two.
                pending: _,
                held: [force, moment],
                impulse,
                work,
                motor_work,
                heat,
            } = own;
            let numbers = [
                *value,
                *target,
                *acting,
                *driving,
                *damping,
                *work,
                *motor_work,
                *heat,
            ];
            let held = force.iter().chain(moment.iter());
            let name = format!("joint{k}");
            let all: Vec<f64> = numbers.iter().chain(held).copied().collect();
            file.put(format!("{name}/numbers"), 1, all);
            file.put(format!("{name}/impulse"), 1, impulse);
            file.put(format!("{name}/holding"), 1, holding);
        }
    }

    pub(super) fn take_state(&mut self, file: &Checkpoint) -> Read<()> {
        for (k, own) in self.all.iter_mut().enumerate() {
            let name = format!("joint{k}");
            let numbers: [f64; NUMBERS] = file.get_array(&format!("{name}/numbers"))?;
            let [
                value,
                target,
                acting,
                driving,
                damping,
                work,
                motor_work,
                heat,
                held @ ..,
            ] = numbers;
            own.impulse = file.get_array(&format!("{name}/impulse"))?;
            own.holding = file.get(&format!("{name}/holding"))?;
            (own.value, own.target, own.acting) = (value, target, acting);
            (own.driving, own.damping) = (driving, damping);
            (own.work, own.motor_work, own.heat) = (work, motor_work, heat);
            own.held = [0, 3].map(|k| Vector3::from_fn(|d, _| held[k + d]));
        }
        Ok(())
    }
}
