//! The cells of a chain and one step of the Godunov method.
//! All rows are indexed by cell from the left; joints stand between segments and at the ends.

use super::faces::{Face, JointFace, Trace, meet, minmod, monotonized_central};
use super::{GodunovRods, Limiter, PressureLaw};
use crate::study::{StudyError, positive};
use std::ops::Range;
use std::sync::Arc;

/// The cells of one segment.
#[derive(Clone, Debug)]
pub(super) struct Block {
    pub cells: Range<usize>,
    law: Arc<dyn PressureLaw>,
    /// A = ½ d(ρc)/dρ|ₛ / c.
    stiffening: f64,
    /// Left end at time zero and cell length then \[m\].
    pub start: f64,
    pub spacing: f64,
    /// Where the left end is now \[m\].
    pub left_position: f64,
}

pub(super) struct Cells {
    pub blocks: Vec<Block>,
    pub joints: Vec<JointFace>,
    pub faces: Vec<Face>,
    pub mass: Vec<f64>,
    pub volume: Vec<f64>,
    pub velocity: Vec<f64>,
    pub total_energy: Vec<f64>,
    pub density: Vec<f64>,
    pub energy: Vec<f64>,
    pub pressure: Vec<f64>,
    pub sound_speed: Vec<f64>,
    pub impedance: Vec<f64>,
    tolerance: f64,
    limiter: Limiter,
    gradients: [Vec<f64>; 2],
    left_trace: [Vec<f64>; 2],
    right_trace: [Vec<f64>; 2],
    flux: [Vec<f64>; 2],
}

impl Cells {
    pub(super) fn new(rods: &GodunovRods) -> Result<Self, StudyError> {
        let mut transits = Vec::new();
        let mut x = rods.start;
        for segment in &rods.segments {
            let state = segment.state_at(x + 0.5 * segment.length);
            let (_, c) = one(&*segment.law, state.density, state.energy);
            positive("the sound speed at time zero [m/s]", c)?;
            transits.push(segment.length / c);
            x += segment.length;
        }
        let total: f64 = transits.iter().sum();
        let mut blocks = Vec::new();
        let (mut mass, mut volume) = (Vec::new(), Vec::new());
        let (mut velocity, mut total_energy) = (Vec::new(), Vec::new());
        let (mut first, mut x) = (0, rods.start);
        for (segment, transit) in rods.segments.iter().zip(transits) {
            let count = ((rods.cells as f64 * transit / total).round() as usize).max(4);
            let spacing = segment.length / count as f64;
            for k in 0..count {
                let state = segment.state_at(x + (k as f64 + 0.5) * spacing);
                let density = positive("density at time zero [kg/m³]", state.density)?;
                mass.push(density * spacing);
                volume.push(1.0 / density);
                velocity.push(state.velocity);
                total_energy.push(state.energy + 0.5 * state.velocity.powi(2));
            }
            let state = segment.state_at(x + 0.5 * segment.length);
            blocks.push(Block {
                cells: first..first + count,
                law: Arc::clone(&segment.law),
                stiffening: stiffening(&*segment.law, state.density, state.energy),
                start: x,
                spacing,
                left_position: x,
            });
            first += count;
            x += segment.length;
        }
        let mut joints = vec![JointFace::new(
            None,
            Some(0),
            JointFace::bond_of(rods.ends[0]),
        )];
        for (block, &contact) in blocks.iter().zip(&rods.contacts) {
            let end = block.cells.end;
            joints.push(JointFace::new(Some(end - 1), Some(end), Some(contact)));
        }
        let bond = JointFace::bond_of(rods.ends[1]);
        joints.push(JointFace::new(Some(first - 1), None, bond));
        let row = || vec![0.0; first];
        let pair = |n: usize| [vec![0.0; n], vec![0.0; n]];
        let mut cells = Self {
            faces: vec![Face::default(); joints.len()],
            blocks,
            joints,
            mass,
            volume,
            velocity,
            total_energy,
            density: row(),
            energy: row(),
            pressure: row(),
            sound_speed: row(),
            impedance: row(),
            tolerance: 0.0,
            limiter: rods.limiter,
            gradients: pair(first + 1),
            left_trace: pair(first),
            right_trace: pair(first),
            flux: pair(first + 1),
        };
        cells.close(0.0)?;
        cells.tolerance = rods.tension.unwrap_or_else(|| 1e-4 * cells.impact());
        Ok(cells)
    }

    /// The largest ρc|u − u′| at a joint.
    fn impact(&self) -> f64 {
        let largest = self.joints.iter().map(|joint| {
            let velocity = |cell: Option<usize>| cell.map_or(0.0, |j| self.velocity[j]);
            let impedance = |cell: Option<usize>| cell.map_or(0.0, |j| self.impedance[j]);
            let jump = (velocity(joint.left) - velocity(joint.right)).abs();
            jump * impedance(joint.left).max(impedance(joint.right))
        });
        largest.fold(0.0, f64::max)
    }

    /// Density, energy, pressure, sound speed and impedance from what is conserved.
    pub(super) fn close(&mut self, time: f64) -> Result<(), StudyError> {
        for j in 0..self.volume.len() {
            self.density[j] = 1.0 / self.volume[j];
            self.energy[j] = self.total_energy[j] - 0.5 * self.velocity[j] * self.velocity[j];
        }
        for block in &self.blocks {
            let range = block.cells.clone();
            block.law.evaluate(
                &self.density[range.clone()],
                &self.energy[range.clone()],
                &mut self.pressure[range.clone()],
                &mut self.sound_speed[range],
            );
        }
        let mut sound = true;
        for j in 0..self.volume.len() {
            let z = self.density[j] * self.sound_speed[j];
            self.impedance[j] = z;
            sound &= z > 0.0 && z < f64::INFINITY && self.density[j] > 0.0;
            sound &= self.pressure[j].abs() < f64::INFINITY;
        }
        if sound {
            return Ok(());
        }
        let wrong = |&j: &usize| {
            let z = self.impedance[j];
            let good = z > 0.0 && z.is_finite() && self.density[j] > 0.0;
            !(good && self.pressure[j].is_finite())
        };
        let cell = (0..self.volume.len()).find(wrong).unwrap_or(0);
        Err(StudyError::State {
            cell,
            time,
            density: self.density[cell],
            energy: self.energy[cell],
        })
    }

    /// The shortest time \[s\] in which a wave crosses a cell.
    pub(super) fn shortest_transit(&self) -> f64 {
        let crossings = self.impedance.iter().zip(&self.mass).map(|(z, m)| z / m);
        1.0 / crossings.fold(0.0, |a: f64, b| if a > b { a } else { b })
    }

    /// One step of length `dt` \[s\] that ends at `time` \[s\].
    pub(super) fn step(&mut self, dt: f64, time: f64) -> Result<(), StudyError> {
        let edges: Vec<[(f64, f64); 2]> = self.joints.iter().map(|j| j.gradients(self)).collect();
        for k in 0..self.blocks.len() {
            let (left, right) = (edges[k][1], edges[k + 1][0]);
            let range = self.blocks[k].cells.clone();
            match self.limiter {
                Limiter::FirstOrder => self.trace(range, left, right, dt, |_, _| 0.0),
                Limiter::Minmod => self.trace(range, left, right, dt, minmod),
                Limiter::MonotonizedCentral => {
                    self.trace(range, left, right, dt, monotonized_central);
                }
            }
        }
        for k in 0..self.joints.len() {
            let left = self.joints[k].left.map(|j| self.right_of(k - 1, j));
            let right = self.joints[k].right.map(|j| self.left_of(k, j));
            self.faces[k] = self.joints[k].act(left, right, dt, self.tolerance);
        }
        for k in 0..self.blocks.len() {
            self.advance(k, dt);
        }
        self.close(time)
    }

    fn right_of(&self, block: usize, j: usize) -> Trace {
        Trace {
            pressure: self.right_trace[0][j],
            velocity: self.right_trace[1][j],
            impedance: self.impedance[j],
            stiffening: self.density[j] * self.blocks[block].stiffening,
        }
    }

    fn left_of(&self, block: usize, j: usize) -> Trace {
        Trace {
            pressure: self.left_trace[0][j],
            velocity: self.left_trace[1][j],
            impedance: self.impedance[j],
            stiffening: self.density[j] * self.blocks[block].stiffening,
        }
    }

    /// Limited gradients, and from them the states at both faces of each cell half a step ahead.
    fn trace(
        &mut self,
        range: Range<usize>,
        left: (f64, f64),
        right: (f64, f64),
        dt: f64,
        limit: impl Fn(f64, f64) -> f64,
    ) {
        let n = range.len();
        let (mass, pressure) = (&self.mass[range.clone()], &self.pressure[range.clone()]);
        let velocity = &self.velocity[range.clone()];
        let impedance = &self.impedance[range.clone()];
        let [gp, gu] = &mut self.gradients;
        let (gp, gu) = (&mut gp[..n + 1], &mut gu[..n + 1]);
        (gp[0], gu[0]) = left;
        (gp[n], gu[n]) = right;
        for f in 1..n {
            let inverse = 2.0 / (mass[f - 1] + mass[f]);
            gp[f] = (pressure[f] - pressure[f - 1]) * inverse;
            gu[f] = (velocity[f] - velocity[f - 1]) * inverse;
        }
        let [lp, lu] = &mut self.left_trace;
        let (lp, lu) = (&mut lp[range.clone()], &mut lu[range.clone()]);
        let [rp, ru] = &mut self.right_trace;
        let (rp, ru) = (&mut rp[range.clone()], &mut ru[range]);
        for j in 0..n {
            let z = impedance[j];
            let plus = limit(gp[j] + z * gu[j], gp[j + 1] + z * gu[j + 1]);
            let minus = limit(gp[j] - z * gu[j], gp[j + 1] - z * gu[j + 1]);
            let sp = 0.5 * (plus + minus);
            let zsu = 0.5 * (plus - minus);
            let half = 0.5 * mass[j];
            let p = pressure[j] - 0.5 * dt * z * zsu;
            let u = velocity[j] - 0.5 * dt * sp;
            let du = half * zsu / z;
            lp[j] = p - half * sp;
            rp[j] = p + half * sp;
            lu[j] = u - du;
            ru[j] = u + du;
        }
    }

    /// Face states within a segment, and the update of its cells.
    fn advance(&mut self, k: usize, dt: f64) {
        let block = &mut self.blocks[k];
        let (range, a) = (block.cells.clone(), block.stiffening);
        let n = range.len();
        let (left, right) = (self.faces[k], self.faces[k + 1]);
        block.left_position += dt * left.right_velocity;
        let density = &self.density[range.clone()];
        let impedance = &self.impedance[range.clone()];
        let (lp, lu) = (
            &self.left_trace[0][range.clone()],
            &self.left_trace[1][range.clone()],
        );
        let (rp, ru) = (
            &self.right_trace[0][range.clone()],
            &self.right_trace[1][range.clone()],
        );
        let [fp, fu] = &mut self.flux;
        let (fp, fu) = (&mut fp[..n + 1], &mut fu[..n + 1]);
        for f in 1..n {
            let before = Trace {
                pressure: rp[f - 1],
                velocity: ru[f - 1],
                impedance: impedance[f - 1],
                stiffening: density[f - 1] * a,
            };
            let behind = Trace {
                pressure: lp[f],
                velocity: lu[f],
                impedance: impedance[f],
                stiffening: density[f] * a,
            };
            (fp[f], fu[f]) = meet(&before, &behind);
        }
        // At a joint the power is a mean of its own; elsewhere it is pressure times velocity.
        (fp[0], fu[0]) = (left.pressure, left.right_velocity);
        (fp[n], fu[n]) = (right.pressure, right.left_velocity);
        let mass = &self.mass[range.clone()];
        let volume = &mut self.volume[range.clone()];
        let velocity = &mut self.velocity[range.clone()];
        let energy = &mut self.total_energy[range];
        for j in 0..n {
            let rate = dt / mass[j];
            volume[j] += rate * (fu[j + 1] - fu[j]);
            velocity[j] -= rate * (fp[j + 1] - fp[j]);
            energy[j] -= rate * (fp[j + 1] * fu[j + 1] - fp[j] * fu[j]);
        }
        energy[0] += dt / mass[0] * (left.power - fp[0] * fu[0]);
        energy[n - 1] -= dt / mass[n - 1] * (right.power - fp[n] * fu[n]);
    }
}

/// Pressure and sound speed of one state.
fn one(law: &dyn PressureLaw, density: f64, energy: f64) -> (f64, f64) {
    let (mut p, mut c) = ([0.0], [0.0]);
    law.evaluate(&[density], &[energy], &mut p, &mut c);
    (p[0], c[0])
}

/// A = ½ d(ρc)/dρ|ₛ / c by a central difference along the isentrope; 0 where it is not finite.
fn stiffening(law: &dyn PressureLaw, density: f64, energy: f64) -> f64 {
    let (p, c) = one(law, density, energy);
    let shift = 1e-4 * density;
    let work = p / (density * density) * shift;
    let (_, above) = one(law, density + shift, energy + work);
    let (_, below) = one(law, density - shift, energy - work);
    let slope = ((density + shift) * above - (density - shift) * below) / (2.0 * shift);
    let a = 0.5 * slope / c;
    if a.is_finite() {
        a.clamp(0.0, 10.0)
    } else {
        0.0
    }
}
