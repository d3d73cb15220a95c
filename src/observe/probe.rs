//! Pressure on a wall: averaged over a disc as a sensor does, and as force over area.
//! A probe moves with the wall that it is fixed to.

use super::place::{DIRECTION, Place, refused};
use super::{normalisation, weight};
use crate::error::Result;
use crate::geometry::POSITIVE;
use crate::scalar::Real;
use crate::simulation::{Simulation, Which};
use crate::tensor::{Vector, length};

/// Share of the kernel above which a place counts as full of liquid and wall: what full places have, less
/// the scatter of particles.
const FULL: f64 = 0.95;

/// Rings of points on which a disc is sampled.
const RINGS: usize = 2;

/// A pressure sensor on a wall: a disc in 3D, a length in 2D, a point in 1D.
///
/// The pressure at a point of the surface is p = Σ V p W / Σ V W over liquid and wall: the sides lie half
/// a spacing before and behind it, so the mean is that of the surface to second order. What liquid and
/// wall leave empty counts with no pressure, as the dry part of a sensor does. Behind a plane of symmetry, or one that is a wall, and
/// one period on it sees the images of liquid and walls.
#[derive(Clone, Debug, PartialEq)]
pub struct PressureProbe<const D: usize> {
    centre: Place<D>,
    normal: [f64; D],
    diameter: f64,
}

impl<const D: usize> PressureProbe<D> {
    /// A sensor of `diameter` \[m\] around `centre` \[m\] on a surface with `normal`, in the scene as built.
    ///
    /// # Errors
    /// If the centre is not finite or [outside of the scene](super#places), the normal zero or not
    /// finite, or the diameter not positive.
    pub fn disc<T: Real>(
        simulation: &Simulation<T, D>,
        name: &str,
        centre: [f64; D],
        normal: [f64; D],
        diameter: f64,
    ) -> Result<Self> {
        let size = length(&Vector::from(normal));
        if !(size.is_finite() && size > 0.0) {
            return Err(refused(name, "length of the normal", size, DIRECTION));
        }
        if !(diameter.is_finite() && diameter > 0.0) {
            return Err(refused(name, "diameter", diameter, POSITIVE));
        }
        Ok(Self {
            centre: Place::new(simulation, name, centre, None)?,
            normal: normal.map(|n| n / size),
            diameter,
        })
    }

    /// Fixes it to a wall whose motion it follows.
    ///
    /// # Errors
    /// If the scene does not have that wall; the error lists those that it has.
    pub fn on_wall(self, wall: impl Which) -> Result<Self> {
        let centre = self.centre.on_wall(&wall)?;
        Ok(Self { centre, ..self })
    }

    /// Its name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.centre.name
    }

    /// Where it is in the scene as built \[m\].
    #[must_use]
    pub fn centre(&self) -> [f64; D] {
        self.centre.point
    }

    /// Points of the disc, of equal area, in the scene as built.
    fn points(&self) -> Vec<[f64; D]> {
        let normal = Vector::<f64, D>::from(self.normal);
        // Two directions along the surface, by taking the normal out of the axes least along it.
        let mut axes: Vec<Vector<f64, D>> = Vec::new();
        let mut order: Vec<usize> = (0..D).collect();
        order.sort_by(|&a, &b| normal[a].abs().total_cmp(&normal[b].abs()));
        for &d in order.iter().take(D - 1) {
            let mut axis = Vector::<f64, D>::from_fn(|a, _| f64::from(u8::from(a == d)));
            for other in core::iter::once(&normal).chain(&axes) {
                axis -= other * axis.dot(other);
            }
            axes.push(axis / length(&axis));
        }
        let radius = 0.5 * self.diameter;
        let centre = Vector::from(self.centre.point);
        let mut points = vec![self.centre.point];
        match axes.as_slice() {
            [] => {}
            [along] => {
                // Five points on a length, each the middle of a fifth.
                for s in [-0.8, -0.4, 0.4, 0.8] {
                    points.push((centre + along * (s * radius)).into());
                }
            }
            [first, second, ..] => {
                // A centre and rings of 6 k points: 1 + 6 + 12 patches of equal area.
                let total = (1 + 3 * RINGS * (RINGS + 1)) as f64;
                for ring in 1..=RINGS {
                    let inner = (1 + 3 * ring * (ring - 1)) as f64;
                    let outer = (1 + 3 * ring * (ring + 1)) as f64;
                    let r = radius * (0.5 * (inner + outer) / total).sqrt();
                    for k in 0..6 * ring {
                        let angle = core::f64::consts::TAU * k as f64 / (6 * ring) as f64;
                        let (sine, cosine) = angle.sin_cos();
                        points.push((centre + first * (r * cosine) + second * (r * sine)).into());
                    }
                }
            }
        }
        points
    }

    /// The pressure \[Pa\] averaged over the disc, at the last evaluation; zero where it is dry.
    #[must_use]
    pub fn pressure<T: Real>(&self, simulation: &Simulation<T, D>) -> f64 {
        Self::pressures(core::slice::from_ref(self), simulation)[0]
    }

    /// [`pressure`](Self::pressure) \[Pa\] of each of many probes, in one search for the particles around them.
    #[must_use]
    pub fn pressures<T: Real>(probes: &[Self], simulation: &Simulation<T, D>) -> Vec<f64> {
        let h = simulation.sampling_length();
        let norm = normalisation::<D>() / h.powi(D as i32);
        let poses = probes.iter().map(|probe| probe.centre.pose(simulation));
        let (places, mut points): (Vec<_>, Vec<_>) = probes
            .iter()
            .zip(poses)
            .map(|(probe, pose)| {
                let place = (
                    pose.of(0, &probe.centre.point),
                    2.0 * h + 0.5 * probe.diameter,
                );
                // Σ V W and Σ V p W, over liquid and over walls.
                let empty = [[0.0; 2]; 2];
                let points = probe.points();
                let points: Vec<_> = points.iter().map(|x| (pose.of(0, x), empty)).collect();
                (place, points)
            })
            .unzip();
        simulation.near(&places, |probe, particle, x| {
            let volume = particle.mass() / particle.density() * norm;
            let side = usize::from(!particle.is_mobile());
            for (point, sum) in &mut points[probe] {
                let r2: f64 = (0..D).map(|d| (x[d] - point[d]).powi(2)).sum();
                let q = r2.sqrt() / h;
                if q < 2.0 {
                    let weight = volume * weight::<D>(q);
                    sum[side][0] += weight;
                    sum[side][1] += weight * particle.pressure();
                }
            }
        });
        let mean = |(_, [[liquid, pressed], [wall, pressing]]): &([f64; D], [[f64; 2]; 2])| {
            if *liquid <= 0.0 {
                return 0.0;
            }
            // Above the liquid walls show the pressure of what they feel from below: they count as
            // much as liquid does.
            let share = (liquid / wall.max(f64::MIN_POSITIVE)).min(1.0);
            let wet = (liquid / (FULL * (1.0 - wall)).max(*liquid)).min(1.0);
            wet * (pressed + share * pressing) / (liquid + share * wall)
        };
        let read = |points: &Vec<_>| points.iter().map(mean).sum::<f64>() / points.len() as f64;
        points.iter().map(read).collect()
    }

    /// The force \[N\] of the liquid on the wall particles behind the disc, along the normal and into the
    /// wall, over the area of their columns: the pressure that the wall really feels. Of a plane it is the force of its images, each
    /// spread over a spacing, over the area of the disc, which is a spacing wide at least.
    ///
    /// Its sum over time is the impulse that the wall got. Within a support of an edge it reads low, by 12 % one
    /// spacing above a floor: the wall around the corner takes its share. On a plate thinner than two supports it
    /// sees the other side. It costs a sweep over the walls, which
    /// [`contact_pressures`](Self::contact_pressures) makes once for many probes.
    #[must_use]
    pub fn contact_pressure<T: Real>(&self, simulation: &Simulation<T, D>) -> f64 {
        Self::contact_pressures(core::slice::from_ref(self), simulation)[0]
    }

    /// [`contact_pressure`](Self::contact_pressure) \[Pa\] of each of many probes.
    #[must_use]
    pub fn contact_pressures<T: Real>(probes: &[Self], simulation: &Simulation<T, D>) -> Vec<f64> {
        let forces = simulation.wall_particle_forces();
        let planes = simulation.plane_forces();
        let felt = |probe: &Self| {
            probe.felt(simulation, &forces) + probe.felt_by_planes(simulation, &planes)
        };
        probes.iter().map(felt).collect()
    }

    /// The pressure \[Pa\] that places and forces of all wall particles make on the disc.
    fn felt<T: Real>(&self, simulation: &Simulation<T, D>, forces: &[([f64; D], [f64; D])]) -> f64 {
        let pose = self.centre.pose(simulation);
        let centre = Vector::<f64, D>::from(pose.of(0, &self.centre.point));
        let normal = pose.linear[0] * Vector::from(self.normal);
        let (mut force, mut columns) = (0.0, 0_usize);
        let spacing = simulation.spacing();
        // What lies deeper feels the liquid on another side of the wall.
        let deepest = -simulation.reach();
        for (x, on) in forces {
            let r = Vector::from(*x) - centre;
            let along = r.dot(&normal);
            let aside = length(&(r - normal * along));
            // As wide as the disc, and at least one column of particles.
            if aside <= (0.5 * self.diameter).max(0.71 * spacing)
                && (deepest..=0.0).contains(&along)
            {
                force -= Vector::from(*on).dot(&normal);
                columns += usize::from(along > -spacing);
            }
        }
        if columns == 0 {
            return 0.0;
        }
        force / (columns as f64 * spacing.powi(D as i32 - 1))
    }

    /// The pressure \[Pa\] that forces on planes, where images are, make on the disc.
    fn felt_by_planes<T: Real>(
        &self,
        simulation: &Simulation<T, D>,
        forces: &[([f64; D], [f64; D])],
    ) -> f64 {
        let pose = self.centre.pose(simulation);
        let centre = Vector::<f64, D>::from(pose.of(0, &self.centre.point));
        let normal = pose.linear[0] * Vector::from(self.normal);
        let spacing = simulation.spacing();
        let radius = 0.5 * self.diameter.max(spacing);
        let deepest = -simulation.reach();
        let mut sum = 0.0;
        for (x, on) in forces {
            let r = Vector::from(*x) - centre;
            let along = r.dot(&normal);
            let aside = length(&(r - normal * along));
            if (deepest..=0.0).contains(&along) {
                // The part of a spacing around it that is on the disc.
                let share = ((radius + 0.5 * spacing - aside) / spacing).clamp(0.0, 1.0);
                sum -= share * Vector::from(*on).dot(&normal);
            }
        }
        // The integral of that share over the plane.
        sum / match D {
            1 => 1.0,
            2 => 2.0 * radius,
            _ => core::f64::consts::PI * (radius * radius + spacing * spacing / 12.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_lie_on_the_disc_and_balance() {
        let probe = PressureProbe {
            centre: Place {
                name: "p".into(),
                point: [1.0, 2.0, 3.0],
                wall: None,
                walls: Vec::new(),
            },
            normal: [0.0, 0.6, 0.8],
            diameter: 0.2,
        };
        let points = probe.points();
        assert_eq!(points.len(), 19);
        let mut mean = [0.0; 3];
        for x in &points {
            let along: f64 = (0..3)
                .map(|d| (x[d] - probe.centre()[d]) * probe.normal[d])
                .sum();
            let r2: f64 = (0..3).map(|d| (x[d] - probe.centre()[d]).powi(2)).sum();
            assert!(along.abs() < 1e-15 && r2.sqrt() < 0.1);
            for d in 0..3 {
                mean[d] += x[d] / 19.0;
            }
        }
        // The mean square radius of a disc is half its radius squared.
        let spread: f64 = points
            .iter()
            .map(|x| {
                (0..3)
                    .map(|d| (x[d] - probe.centre()[d]).powi(2))
                    .sum::<f64>()
                    / 19.0
            })
            .sum();
        assert!((spread / 0.005 - 1.0).abs() < 0.06, "{spread}");
        assert!((0..3).all(|d| (mean[d] - probe.centre()[d]).abs() < 1e-14));
    }
}
