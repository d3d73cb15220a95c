//! Advice on motions and open boundaries that are made of rows: whether the rows resolve them.
//! A force on what moves goes with its acceleration, which is the first to be off.

use super::Advice;
use super::bands::{FLOW_ROWS, ROWS};
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
        let inlets = self.inlets.iter().map(|own| {
            let name = format!("inlet of {}", own.body);
            (name, own.carried(), own.state.as_deref())
        });
        let outlets = (1..).zip(&self.outlets);
        let outlets = outlets.map(|(k, own)| (format!("outlet {k}"), own.carried(), own.state()));
        for (name, motion, state) in inlets.chain(outlets) {
            if let Some(off) = motion.and_then(|motion| motion.resolution()) {
                advice.add(ROWS.line(&name, off, None));
            }
            if let Some(off) = state.and_then(|state| state.resolution()) {
                advice.add(FLOW_ROWS.line(&name, off, None));
            }
        }
    }
}
