//! How many particles are across a body: from its faces inwards until it ends.
//! What images continue has no end, and is not counted.

use super::look::Looker;
use crate::neighbors::Cells;
use crate::particles::Field;
use crate::scalar::Real;

/// Particles across from which on it does not matter how many.
pub(super) const THICK: f64 = 32.0;
/// Faces that are looked at.
const MOST: usize = 2048;
/// A place within this distance of a particle, in spacings, is inside.
const WITHIN: f64 = 1.0;

/// Particles across a body from the faces of some of its particles: the slot of each with the number.
pub(super) fn thicknesses<T: Real, const D: usize>(
    looker: &Looker<'_, T, D>,
    body: usize,
) -> Vec<(usize, f64)> {
    let group = looker.group;
    let own = group.particles.bodies[body].slots.clone();
    let columns = &group.particles.columns;
    let positions = columns.vectors(Field::POSITION);
    let mut points: Vec<[f64; D]> = positions[own.clone()]
        .iter()
        .map(|x| x.map(Real::to_f64))
        .collect();
    let real = points.len();
    for image in &group.neighborhood.images {
        let source = image.source as usize;
        if own.contains(&source) {
            let by = &group.neighborhood.chains.transforms[image.transform as usize];
            points.push(by.point(&positions[source]).map(Real::to_f64));
        }
    }
    let spacing = group.particles.bodies[body].spacing;
    let all: Vec<u32> = (0..points.len() as u32).collect();
    let cells = Cells::build(&points, &all, WITHIN * spacing);
    // One of so many, so that few faces of a large body are looked for among its particles.
    let stride = (real / (8 * MOST)).max(1);
    let faces = own.clone().step_by(stride).filter_map(|slot| {
        let normal = looker.face(slot, true)?;
        Some((slot, normal))
    });
    let mut found = Vec::new();
    for (slot, normal) in faces.take(MOST) {
        let x = points[slot - own.start];
        let (mut depth, mut last_is_image, mut reach) = (0.0_f64, false, 0.0_f64);
        while normal != [0.0; D] && reach <= THICK {
            reach += 0.5;
            let place: [f64; D] = core::array::from_fn(|d| x[d] - reach * spacing * normal[d]);
            let within = WITHIN * spacing;
            let mut inside = false;
            cells.for_each_run(
                place.map(|x| x - within),
                place.map(|x| x + within),
                |run| {
                    for &k in run {
                        let point = points[k as usize];
                        let apart: f64 = (0..D).map(|d| (point[d] - place[d]).powi(2)).sum();
                        if apart <= within * within {
                            inside = true;
                            let along: f64 = (0..D).map(|d| (x[d] - point[d]) * normal[d]).sum();
                            if along / spacing > depth {
                                depth = along / spacing;
                                last_is_image = k as usize >= real;
                            }
                        }
                    }
                },
            );
            if !inside {
                break;
            }
        }
        if !last_is_image || depth >= THICK - 1.0 {
            found.push((slot, (depth + 1.0).min(THICK)));
        }
    }
    found
}
