//! The outline of a bar: layers of the lattice as they were, followed by the particles at their rim.
//! A layer's radius is the first one times the mean stretch of its outermost particles.

use meshfree::prelude::*;

/// Layers of a bar from its foot up, each by the numbers and first radii \[m\] of the particles at its rim.
pub struct Layers {
    rims: Vec<Vec<(usize, f64)>>,
    top: Vec<usize>,
    radius: f64,
    /// Height \[m\] of a layer.
    height: f64,
}

impl Layers {
    /// The layers of a bar that has not moved yet.
    pub fn of(simulation: &Simulation<f64, 3>, diameter: f64, spacing: f64) -> Self {
        let mut heights: Vec<f64> = simulation.all().map(|p| p.position()[2]).collect();
        heights.sort_by(f64::total_cmp);
        heights.dedup_by(|a, b| (*a - *b).abs() < 0.1 * spacing);
        let height = 2.0 * heights[0];
        let mut rims = vec![Vec::new(); heights.len()];
        let mut top = Vec::new();
        for p in simulation.all() {
            let [x, y, z] = p.position();
            let layer = ((z / height) as usize).min(heights.len() - 1);
            if x.hypot(y) > 0.5 * diameter - 1.2 * spacing {
                rims[layer].push((p.id(), x.hypot(y)));
            }
            if layer + 1 == heights.len() {
                top.push(p.id());
            }
        }
        Self {
            rims,
            top,
            radius: 0.5 * diameter,
            height,
        }
    }

    /// Height z and radius \[m\] of every layer.
    pub fn profile(&self, now: &Simulation<f64, 3>) -> Vec<[f64; 2]> {
        let places = places(now);
        let layer = |rim: &Vec<(usize, f64)>| {
            let share = 1.0 / rim.len().max(1) as f64;
            rim.iter().fold([0.0; 2], |[z, r], &(id, first)| {
                let place = places[id];
                let stretch = place[0].hypot(place[1]) / first;
                [z + share * place[2], r + share * stretch * self.radius]
            })
        };
        self.rims.iter().map(layer).collect()
    }

    /// Length \[m\]: the mean height of the last layer, and half of its own.
    pub fn length(&self, now: &Simulation<f64, 3>) -> f64 {
        let places = places(now);
        let sum: f64 = self.top.iter().map(|&id| places[id][2]).sum();
        sum / self.top.len().max(1) as f64 + 0.5 * self.height
    }
}

/// Positions by number.
fn places(now: &Simulation<f64, 3>) -> Vec<[f64; 3]> {
    let mut places = vec![[0.0; 3]; now.particles()];
    for p in now.all() {
        places[p.id()] = p.position();
    }
    places
}
