//! What a checkpoint holds of couplings by forces: what acts, what it has worked, and where friction holds.
//! The pairs follow from positions.

use crate::coupling::Anchor;
use crate::output::checkpoint::{Checkpoint, Read};
use crate::scalar::Real;
use crate::simulation::contact::{Acting, Couple};
use crate::tensor::Matrix;

impl<T: Real, const D: usize> Couple<T, D> {
    pub(super) fn put(&self, name: &str, file: &mut Checkpoint) {
        let Self {
            coupling: _,
            sides: _,
            indices: _,
            reach: _,
            exclusion: _,
            reference: _,
            stiffness,
            acting,
            work,
            // It follows from positions.
            list: _,
        } = self;
        let Acting {
            force,
            step,
            forces,
            moments,
            anchors,
            stored,
            heat,
            penetration: [now, most],
            pairs,
            images,
            time,
        } = acting;
        file.put(format!("{name}/force"), 1, force);
        file.put(format!("{name}/moments"), 1, moments.as_slice());
        let numbers = [
            *step, *stiffness, work[0], work[1], *stored, *heat, *now, *most, *time,
        ];
        file.put(format!("{name}/numbers"), 1, numbers);
        file.put_one(format!("{name}/pairs"), *pairs as u64);
        for (side, own) in images.iter().enumerate() {
            file.put(format!("{name}/images{side}"), D, own.as_flattened());
        }
        for (side, own) in forces.iter().enumerate() {
            let (ids, forces): (Vec<u32>, Vec<[T; D]>) = own.iter().copied().unzip();
            file.put(format!("{name}/particles{side}"), 1, ids);
            file.put_reals(format!("{name}/forces{side}"), D, forces.as_flattened());
        }
        let (ids, anchors): (Vec<[u64; 2]>, Vec<Anchor<T, D>>) = anchors.iter().copied().unzip();
        let rows: Vec<[[T; D]; 2]> = anchors.iter().map(|own| [own.place, own.force]).collect();
        file.put(format!("{name}/anchored"), 2, ids.as_flattened());
        file.put_reals(
            format!("{name}/anchors"),
            2 * D,
            rows.as_flattened().as_flattened(),
        );
    }

    pub(super) fn take_state(&mut self, name: &str, file: &Checkpoint) -> Read<()> {
        let of = |what: &str| format!("{name}/{what}");
        let vectors = |what: &str, count: usize| -> Read<Vec<[T; D]>> {
            let numbers = file.get_all_reals::<T>(&of(what), count * D)?;
            Ok(numbers.as_chunks::<D>().0.to_vec())
        };
        let [
            step,
            stiffness,
            first,
            second,
            stored,
            heat,
            now,
            most,
            evaluated,
        ] = file.get_array(&of("numbers"))?;
        (self.stiffness, self.work) = (stiffness, [first, second]);
        let mut forces = [Vec::new(), Vec::new()];
        for (side, own) in forces.iter_mut().enumerate() {
            let ids = file.get::<u32>(&of(&format!("particles{side}")))?;
            let values = vectors(&format!("forces{side}"), ids.len())?;
            own.extend(ids.into_iter().zip(values));
        }
        let moments = file.get_all::<f64>(&of("moments"), D * D)?;
        let mut images = [Vec::new(), Vec::new()];
        for (side, own) in images.iter_mut().enumerate() {
            let forces = file.get::<f64>(&of(&format!("images{side}")))?;
            *own = forces.as_chunks::<D>().0.to_vec();
        }
        let ids = file.get::<u64>(&of("anchored"))?;
        let ids: Vec<[u64; 2]> = ids.as_chunks::<2>().0.to_vec();
        let rows = vectors("anchors", 2 * ids.len())?;
        let anchors = rows.as_chunks::<2>().0.iter();
        let anchors = anchors.map(|&[place, force]| Anchor { place, force });
        self.acting = Acting {
            force: file.get_array(&of("force"))?,
            step,
            forces,
            moments: Matrix::from_column_slice(&moments),
            anchors: ids.into_iter().zip(anchors).collect(),
            stored,
            heat,
            penetration: [now, most],
            pairs: file.get_one::<u64>(&of("pairs"))? as usize,
            images,
            time: evaluated,
        };
        Ok(())
    }
}
