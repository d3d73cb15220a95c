//! The march in time and what it leaves: gauges, joints, snapshots and the ledger.
//! Records hold one entry for each step; a joint's entry is its mean over the step.

use super::GodunovRods;
use super::cells::Cells;
use crate::study::{ContactInterval, Joint, StudyError};

/// History of a material point, one entry for each step, the first at time zero.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct GaugeRecord {
    /// Where the point starts \[m\].
    pub x0: f64,
    /// Times \[s\].
    pub time: Vec<f64>,
    /// Stress σ = −p \[Pa\], linear between cell centres.
    pub stress: Vec<f64>,
    /// Velocity \[m/s\], linear between cell centres.
    pub velocity: Vec<f64>,
}

/// History of a joint: means over each step, given at the middle of the step.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct JointRecord {
    /// Middle of the step \[s\].
    pub time: Vec<f64>,
    /// Contact pressure \[Pa\]; times the cross-section it is the contact force.
    pub pressure: Vec<f64>,
    /// Velocity of the material on the left \[m/s\]; 0 for a wall.
    pub left_velocity: Vec<f64>,
    /// Velocity of the material on the right \[m/s\]; 0 for a wall.
    pub right_velocity: Vec<f64>,
    /// Gap at the end of the step \[m\].
    pub gap: Vec<f64>,
    /// Whether the joint is closed at the end of the step. A free end never is.
    pub closed: Vec<bool>,
    /// ∫ p dt \[N·s/m²\] over the whole solution.
    pub impulse: f64,
    /// The closed times; opening and closing are known to a step.
    pub intervals: Vec<ContactInterval>,
}

/// A cell at the time of a snapshot.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Cell {
    /// Where its centre started \[m\].
    pub x0: f64,
    /// Where its centre is \[m\].
    pub x: f64,
    /// Its length now \[m\].
    pub length: f64,
    /// Segment to which it belongs.
    pub segment: usize,
    /// Density \[kg/m³\].
    pub density: f64,
    /// Velocity \[m/s\].
    pub velocity: f64,
    /// Pressure \[Pa\].
    pub pressure: f64,
    /// Specific internal energy \[J/kg\].
    pub energy: f64,
}

/// All cells at one time.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Snapshot {
    /// The time \[s\].
    pub time: f64,
    /// The cells from left to right.
    pub cells: Vec<Cell>,
}

/// Sums over the chain for each unit of cross-section, at the start and at the end.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Ledger {
    /// Mass \[kg/m²\], which never changes.
    pub mass: f64,
    /// Momentum at the start \[kg·m/s/m²\].
    pub initial_momentum: f64,
    /// Momentum at the end \[kg·m/s/m²\].
    pub final_momentum: f64,
    /// Impulse of the two ends on the chain \[N·s/m²\].
    pub impulse: f64,
    /// Internal and kinetic energy at the start \[J/m²\].
    pub initial_energy: f64,
    /// Internal and kinetic energy at the end \[J/m²\].
    pub final_energy: f64,
    /// Kinetic energy at the end \[J/m²\].
    pub final_kinetic: f64,
    /// Σ m|u| at the start \[kg·m/s/m²\], the measure of the momentum defect.
    pub momentum_scale: f64,
    /// Steps taken.
    pub steps: usize,
    /// Cells.
    pub cells: usize,
}

impl Ledger {
    /// Momentum gained beyond the impulse of the ends, relative to Σ m|u| and the impulse.
    #[must_use]
    pub fn momentum_defect(&self) -> f64 {
        let gained = self.final_momentum - self.initial_momentum - self.impulse;
        gained / (self.momentum_scale + self.impulse.abs()).max(f64::MIN_POSITIVE)
    }
    /// Energy gained, relative to that at the start. Walls at rest do no work.
    #[must_use]
    pub fn energy_defect(&self) -> f64 {
        let scale = self.initial_energy.abs().max(f64::MIN_POSITIVE);
        (self.final_energy - self.initial_energy) / scale
    }
}

/// What a Godunov solution recorded.
#[derive(Clone, Debug)]
pub struct GodunovSolution {
    segments: usize,
    gauges: Vec<GaugeRecord>,
    joints: Vec<JointRecord>,
    snapshots: Vec<Snapshot>,
    ledger: Ledger,
}

impl GodunovSolution {
    /// The gauges, in the order of the request.
    #[must_use]
    pub fn gauges(&self) -> &[GaugeRecord] {
        &self.gauges
    }
    /// The snapshots, in the order of time.
    #[must_use]
    pub fn snapshots(&self) -> &[Snapshot] {
        &self.snapshots
    }
    /// Conserved sums at the start and at the end.
    #[must_use]
    pub fn ledger(&self) -> &Ledger {
        &self.ledger
    }
    /// History of a joint.
    ///
    /// # Errors
    /// If there is no such joint.
    pub fn joint(&self, joint: Joint) -> Result<&JointRecord, StudyError> {
        Ok(&self.joints[joint.number(self.segments)?])
    }
}

pub(super) fn march(rods: &GodunovRods, until: f64) -> Result<GodunovSolution, StudyError> {
    let mut cells = Cells::new(rods)?;
    let mut stops: Vec<f64> = rods.snapshots.clone();
    stops.sort_by(f64::total_cmp);
    let mut stops = stops.into_iter().peekable();
    let mut solution = GodunovSolution {
        segments: cells.blocks.len(),
        gauges: rods.gauges.iter().map(|&x0| gauge(x0)).collect(),
        joints: cells
            .joints
            .iter()
            .map(|_| JointRecord::default())
            .collect(),
        snapshots: Vec::new(),
        ledger: Ledger::default(),
    };
    for (record, joint) in solution.joints.iter_mut().zip(&cells.joints) {
        if joint.closed {
            record.intervals.push(ContactInterval {
                from: 0.0,
                until: None,
            });
        }
    }
    let (momentum, energy, _) = sums(&cells);
    let mut ledger = Ledger {
        mass: cells.mass.iter().sum(),
        initial_momentum: momentum,
        initial_energy: energy,
        momentum_scale: cells
            .mass
            .iter()
            .zip(&cells.velocity)
            .map(|(m, u)| m * u.abs())
            .sum(),
        cells: cells.mass.len(),
        ..Ledger::default()
    };
    let mut time = 0.0;
    observe(&cells, &mut solution.gauges, time);
    loop {
        while let Some(stop) = stops.next_if(|&stop| stop <= time) {
            solution.snapshots.push(snapshot(&cells, stop));
        }
        if time >= until {
            break;
        }
        let next = stops.peek().map_or(until, |&stop| stop.min(until));
        let longest = rods.courant * cells.shortest_transit();
        let left = next - time;
        // Two even steps rather than a full one and a sliver.
        let (dt, arrives) = if left <= longest {
            (left, true)
        } else if left < 2.0 * longest {
            (0.5 * left, false)
        } else {
            (longest, false)
        };
        cells.step(dt, time + dt)?;
        note(&cells, &mut solution.joints, time, dt);
        time = if arrives { next } else { time + dt };
        observe(&cells, &mut solution.gauges, time);
        ledger.steps += 1;
    }
    let (momentum, energy, kinetic) = sums(&cells);
    ledger.final_momentum = momentum;
    ledger.final_energy = energy;
    ledger.final_kinetic = kinetic;
    let last = solution.joints.len() - 1;
    ledger.impulse = solution.joints[0].impulse - solution.joints[last].impulse;
    solution.ledger = ledger;
    Ok(solution)
}

/// Momentum, total energy and kinetic energy.
fn sums(cells: &Cells) -> (f64, f64, f64) {
    let mut result = (0.0, 0.0, 0.0);
    for j in 0..cells.mass.len() {
        let (m, u) = (cells.mass[j], cells.velocity[j]);
        result.0 += m * u;
        result.1 += m * cells.total_energy[j];
        result.2 += 0.5 * m * u * u;
    }
    result
}

fn gauge(x0: f64) -> GaugeRecord {
    GaugeRecord {
        x0,
        time: Vec::new(),
        stress: Vec::new(),
        velocity: Vec::new(),
    }
}

fn observe(cells: &Cells, gauges: &mut [GaugeRecord], time: f64) {
    for gauge in gauges {
        let last = cells.blocks.len() - 1;
        let k = cells.blocks[1..].partition_point(|block| block.start <= gauge.x0);
        let block = &cells.blocks[k.min(last)];
        let count = block.cells.len();
        let place = (gauge.x0 - block.start) / block.spacing - 0.5;
        let place = place.clamp(0.0, (count - 1) as f64);
        let k = (place as usize).min(count - 2);
        let (j, part) = (block.cells.start + k, place - k as f64);
        let between = |row: &[f64]| (1.0 - part) * row[j] + part * row[j + 1];
        gauge.time.push(time);
        gauge.stress.push(-between(&cells.pressure));
        gauge.velocity.push(between(&cells.velocity));
    }
}

fn note(cells: &Cells, records: &mut [JointRecord], time: f64, dt: f64) {
    for ((record, joint), face) in records.iter_mut().zip(&cells.joints).zip(&cells.faces) {
        let was_closed = record.intervals.last().is_some_and(|i| i.until.is_none());
        if was_closed && !joint.closed {
            if let Some(interval) = record.intervals.last_mut() {
                interval.until = Some(time);
            }
        } else if joint.closed && !was_closed {
            record.intervals.push(ContactInterval {
                from: time + dt,
                until: None,
            });
        }
        record.time.push(time + 0.5 * dt);
        record.pressure.push(face.pressure);
        let of = |cell: Option<usize>, velocity: f64| cell.map_or(0.0, |_| velocity);
        record
            .left_velocity
            .push(of(joint.left, face.left_velocity));
        record
            .right_velocity
            .push(of(joint.right, face.right_velocity));
        record.gap.push(joint.gap);
        record.closed.push(joint.closed);
        record.impulse += dt * face.pressure;
    }
}

fn snapshot(cells: &Cells, time: f64) -> Snapshot {
    let mut all = Vec::with_capacity(cells.mass.len());
    for (segment, block) in cells.blocks.iter().enumerate() {
        let mut x = block.left_position;
        for (k, j) in block.cells.clone().enumerate() {
            let length = cells.mass[j] * cells.volume[j];
            all.push(Cell {
                x0: block.start + (k as f64 + 0.5) * block.spacing,
                x: x + 0.5 * length,
                length,
                segment,
                density: cells.density[j],
                velocity: cells.velocity[j],
                pressure: cells.pressure[j],
                energy: cells.energy[j],
            });
            x += length;
        }
    }
    Snapshot { time, cells: all }
}
