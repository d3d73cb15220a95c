//! A state from a checkpoint alone, without the scene that wrote it: places, and columns by the names of their fields.
//! Vectors, tensors and matrices get the components that files for VTK have.

use super::{ParticleState, Quantity};
use crate::error::{Error, Result};
use crate::output::checkpoint::{Checkpoint, Read};
use crate::particles::Field;
use crate::simulation::saved_groups;
use std::path::Path;

impl<const D: usize> ParticleState<D> {
    /// Reads a checkpoint of any scene, of `f32` or `f64`, which need not be at hand: all its columns by the names of their fields, and
    /// `body`. It is the state that the next step starts from, which is up to a step away from the time that was shown.
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
    /// When the file cannot be read, is no checkpoint or was altered, or is of another dimension or version.
    pub fn read_checkpoint(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        let state = Self::of_checkpoint(&Checkpoint::read(path)?);
        state.map_err(|problem| Error::Checkpoint {
            path: path.to_path_buf(),
            problem,
        })
    }

    fn of_checkpoint(file: &Checkpoint) -> Read<Self> {
        let (mut state, mut bodies) = (Self::default(), 0);
        for group in saved_groups::<D>(file)? {
            let before = state.points.len();
            let mut known = vec![Quantity {
                name: "body".into(),
                components: 1,
                values: group
                    .bodies
                    .iter()
                    .map(|own| (bodies + own) as f64)
                    .collect(),
            }];
            known.extend(group.columns.into_iter().map(|(name, width, numbers)| {
                let components = components::<D>(&name, width);
                let rows = numbers.chunks_exact(width.max(1));
                let values =
                    rows.flat_map(|row| components.iter().map(|k| k.map_or(0.0, |k| row[k])));
                Quantity {
                    values: values.collect(),
                    components: components.len(),
                    name,
                }
            }));
            state.points.extend(group.points);
            state.join(before, known);
            bodies += group.count;
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
