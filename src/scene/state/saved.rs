//! A state from a checkpoint alone, without the scene that wrote it: places, and columns by the names of their fields.
//! What is needed of a file is which slots hold particles of bodies; walls and repeated particles are left out.

use super::{ParticleState, Quantity};
use crate::error::{CheckpointProblem, Error, Result};
use crate::output::checkpoint::{Checkpoint, Read, damaged};
use crate::particles::Field;
use std::path::Path;

impl<const D: usize> ParticleState<D> {
    /// Reads a checkpoint of any scene, of `f32` or `f64`, which need not be at hand: all its columns by the names of their fields, and
    /// `body`. It is the state that the next step starts from.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// use meshfree::scene::ParticleState;
    /// let water = || catalogue::weakly_compressible_water(2.0);
    /// let scene = |body| Scene::<f64, 2>::new(schemes::weakly_compressible()).body(body).build();
    /// let mut coarse = scene(Body::block("water", water(), [0.0; 2], [0.4, 0.2], 0.02).velocity([1.0, 0.0]))?;
    /// coarse.run_until(0.01)?;
    /// let path = std::env::temp_dir().join("coarse_of_another_scene.safetensors");
    /// coarse.save(&path)?;
    ///
    /// let state = ParticleState::read_checkpoint(&path)?;
    /// let fine = Body::block("water", water(), [0.01, 0.0], [0.41, 0.2], 0.01).started_from(&state)?;
    /// assert_eq!(scene(fine)?.particles(), 800);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// When the file cannot be read, is no checkpoint or was altered, or is of another dimension.
    pub fn read_checkpoint(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        let state = Self::of_checkpoint(&Checkpoint::read(path)?);
        state.map_err(|problem| Error::Checkpoint {
            path: path.to_path_buf(),
            problem,
        })
    }

    fn of_checkpoint(file: &Checkpoint) -> Read<Self> {
        let found = file.text("dimension")?;
        if found != D.to_string() {
            return Err(CheckpointProblem::Kind {
                what: "dimension",
                found: found.into(),
                own: D.to_string(),
            });
        }
        let origin: [f64; D] = file.get_array("origin")?;
        let (mut state, mut bodies) = (Self::default(), 0);
        for group in (0..).map(|k| format!("group{k}")) {
            if !file.has(&format!("{group}/body_ends")) {
                break;
            }
            let ends = file.get::<u64>(&format!("{group}/body_ends"))?;
            let slots = particles(file, &group, &ends)?;
            let before = state.points.len();
            let columns = format!("{group}/particles/");
            let mut known = vec![Quantity {
                name: "body".into(),
                components: 1,
                values: slots.iter().map(|own| (bodies + own.0) as f64).collect(),
            }];
            for name in file.names(&columns) {
                let (width, numbers) = file.rows(&format!("{columns}{name}"))?;
                let components = components::<D>(name, width);
                let mut values = Vec::with_capacity(slots.len() * components.len());
                for (_, slot) in &slots {
                    let row = numbers.get(slot * width..(slot + 1) * width);
                    let row =
                        row.ok_or_else(|| damaged(format!("column `{name}` is too short")))?;
                    values.extend(components.iter().map(|k| k.map_or(0.0, |k| row[k])));
                }
                known.push(Quantity {
                    name: name.to_owned(),
                    components: components.len(),
                    values,
                });
            }
            let mut take = |field: Field| {
                let own = known.iter().position(|own| own.name == field.name());
                own.map(|k| known.remove(k))
            };
            let position = take(Field::POSITION).ok_or_else(|| damaged("it has no positions"))?;
            let lost = take(Field::POSITION_RESIDUAL);
            state.points.extend((0..slots.len()).map(|n| {
                core::array::from_fn(|d| {
                    let of = |own: &Quantity| own.values[n * own.components + d];
                    of(&position) + lost.as_ref().map_or(0.0, of) + origin[d]
                })
            }));
            state.join(before, known);
            bodies += ends.len();
        }
        state.join(state.points.len(), Vec::new());
        Ok(state)
    }

    /// Adds numbers of particles behind so many; who has none of a name has NaN, as in files of all.
    fn join(&mut self, before: usize, more: Vec<Quantity>) {
        for own in more {
            let place = self.quantities.iter().position(|old| old.name == own.name);
            let place = place.unwrap_or_else(|| {
                self.quantities.push(Quantity {
                    values: Vec::new(),
                    ..own.clone()
                });
                self.quantities.len() - 1
            });
            let all = &mut self.quantities[place];
            all.values.resize(before * all.components, f64::NAN);
            all.values.extend(own.values);
        }
        for own in &mut self.quantities {
            own.values
                .resize(self.points.len() * own.components, f64::NAN);
        }
    }
}

/// Body and slot of each particle of a group that is in a body, body by body in the order of identities.
fn particles(file: &Checkpoint, group: &str, ends: &[u64]) -> Read<Vec<(usize, usize)>> {
    let ids = file.get::<u32>(&format!("{group}/ids"))?;
    let slot_of = file.get::<u32>(&format!("{group}/slot_of"))?;
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
    Ok(all
        .into_iter()
        .map(|(body, _, slot)| (body, slot))
        .collect())
}

/// Which numbers of a row are the components that a file for VTK has: of a vector three, of a tensor xx, yy, zz, xy, yz, xz, of a
/// matrix nine.
fn components<const D: usize>(name: &str, width: usize) -> Vec<Option<usize>> {
    let is_vector = |field: Field| field.name() == name;
    if width == 6 {
        [0, 1, 2, 5, 3, 4].map(Some).to_vec()
    } else if width == D && (D > 1 || is_vector(Field::VELOCITY)) {
        (0..3).map(|k| (k < D).then_some(k)).collect()
    } else if width == D * D && D > 1 {
        let place = |k: usize| (k / 3 < D && k % 3 < D).then_some(k / 3 * D + k % 3);
        (0..9).map(place).collect()
    } else {
        (0..width).map(Some).collect()
    }
}
