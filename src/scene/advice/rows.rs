//! Advice on motions that are made of rows: whether the rows resolve them.
//! A force on what moves goes with its acceleration, which is the first to be off.

use super::Advice;
use super::bands::ROWS;
use crate::scalar::Real;
use crate::scene::Scene;

impl<T: Real, const D: usize> Scene<T, D> {
    pub(super) fn advise_on_rows(&self, advice: &mut Advice) {
        let walls = self.walls.iter().map(|own| (&own.name, &own.motion));
        let clamps = self.clamps.iter().map(|own| (&own.body, &own.motion));
        for (name, motion) in walls.chain(clamps) {
            let off = motion.as_ref().and_then(|motion| motion.resolution());
            if let Some(off) = off {
                advice.add(ROWS.line(name, off, None));
            }
        }
    }
}
