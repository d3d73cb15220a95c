//! Numbers that are finite and still no start, step or contact: each limit has its reason beside it.
//! What lies beyond one would end later as an error that names the run and not the input.

use super::parameter;
use crate::error::Problem;
use crate::geometry::Flaw;
use crate::integrator::{Integrator, oscillator};
use crate::neighbors::Cells;
use crate::origin::local;
use crate::scalar::Real;
use crate::scene::plan::Plan;
use crate::scene::{Body, Scene};
use crate::scheme::Smoothing;
use crate::sweep::Interaction;
use crate::tensor::{Matrix, Vector, length};

/// Speed of light \[m/s\]: mechanics here is Newton's, and what is faster has the wrong unit.
const LIGHT: f64 = 299_792_458.0;

/// Mach number above which a solid or liquid cannot start: its kinetic energy is 5000 c², and the strongest known impacts, of
/// meteoroids at 72 km/s, are below 20 c.
const FASTEST: f64 = 100.0;

/// Factor by which the density of a solid or liquid may start off that of its law: a strong shock compresses a
/// monatomic gas by four ((γ + 1)/(γ − 1), γ = 5/3), and nothing denser by more.
const DENSITIES: f64 = 4.0;

/// Places farther from zero, in spacings, are known to a thousandth of a spacing and worse in `f64`, in which they are given.
const FARTHEST: f64 = 1e-3 / f64::EPSILON;

/// Share of a spacing by which rounding may move a place that is counted from the origin of the scene. Forces see it as
/// disorder of the lattice, and still water starts to move at some times as much (`tests/guarantees/place.rs`).
const ROUNDED: f64 = 0.005;

/// Images that a boundary can give a particle.
pub(super) const MOST_IMAGES: usize = 64;

/// Spacings between a particle at the one end of a period and the image of one at the other, below which they are one place.
const SEAM: f64 = 0.3;

/// States that an integrator can keep.
const MOST_STATES: usize = 64;

/// Whether one of the others is nearer to one of the points than `reach`.
fn any_within<const D: usize>(
    points: &[[f64; D]],
    mut others: impl Iterator<Item = [f64; D]>,
    reach: f64,
) -> bool {
    let all: Vec<u32> = (0..points.len() as u32).collect();
    let cells = Cells::build(points, &all, reach);
    others.any(|x| {
        let mut found = false;
        cells.for_each_run(x.map(|x| x - reach), x.map(|x| x + reach), |run| {
            let apart = |j: &u32| length(&(Vector::from(points[*j as usize]) - Vector::from(x)));
            found |= run.iter().any(|j| apart(j) < reach);
        });
        found
    })
}

/// What is wrong with the numbers that particles start with.
pub(super) fn check_starts<T: Real, const D: usize>(body: &Body<T, D>) -> Option<Flaw> {
    let positions = body.points.iter().flatten();
    let farthest = positions.fold(0.0_f64, |most, x| most.max(x.abs()));
    if farthest > FARTHEST * body.spacing {
        let must_be =
            "it must be within 4.5e12 spacings of zero: farther away rounding moves particles";
        return Some(("position", farthest, must_be));
    }
    if !T::from_f64(farthest * farthest).to_f64().is_finite() {
        let must_be = "its square must be finite in the scalar type: check that it is in metres";
        return Some(("position", farthest, must_be));
    }
    // The kernel's gradient over a distance has this unit.
    let steepest = T::from_f64(body.spacing.powi(-(D as i32) - 2)).to_f64();
    let volume = T::from_f64(body.spacing.powi(D as i32)).to_f64();
    if !(steepest.is_normal() && volume.is_normal()) {
        let must_be = "its volume and the gradients over it must be finite in the scalar type: check that it is in metres";
        return Some(("spacing", body.spacing, must_be));
    }
    let material = &body.material;
    let rest = material.reference_density();
    let sound_at_rest = material.state(rest, 0.0).1;
    let least_energy = -sound_at_rest.powi(2);
    let is_gas = material.is_gas();
    body.starts.iter().find_map(|start| {
        let mass = T::from_f64(start.density * body.spacing.powi(D as i32)).to_f64();
        if let Some(&fast) = start.velocity.iter().find(|v| v.abs() >= LIGHT) {
            return Some(("velocity", fast, "it must be below that of light, in m/s"));
        }
        let speed = start.velocity.iter().map(|v| v * v).sum::<f64>().sqrt();
        if !is_gas && speed > FASTEST * sound_at_rest {
            let must_be = "it must be at most a hundred times the sound speed of the material at rest, beyond \
            which no law of a solid or liquid holds: check that it is in m/s";
            return Some(("velocity", speed, must_be));
        }
        if start.energy > LIGHT * LIGHT {
            let must_be = "it must be below 9e16 J/kg, the square of the speed of light";
            return Some(("energy", start.energy, must_be));
        }
        if start.energy < least_energy {
            let must_be = "it must be above −c², with c the sound speed of the material at rest, and of a gas \
                           not negative: internal energy is counted from rest";
            return Some(("energy", start.energy, must_be));
        }
        if !is_gas && !(rest / DENSITIES..=rest * DENSITIES).contains(&start.density) {
            let must_be = "it must be between a quarter of the material's and four times that, in kg/m³: take \
            another material, or leave the density out";
            return Some(("density", start.density, must_be));
        }
        if !mass.is_normal() {
            return Some(("mass of a particle", mass, "density or spacing is out of range"));
        }
        let (pressure, sound_speed) = material.state(start.density, start.energy);
        let fine = |value: f64| T::from_f64(value * value).to_f64().is_finite();
        if !fine(pressure) {
            let must_be = "its square must be finite at the density and energy of the start";
            return Some(("pressure", pressure, must_be));
        }
        if !(fine(sound_speed) && sound_speed > 0.0) {
            let must_be = "it must be finite and positive at the density and energy of the start: look at the law \
                           of the material";
            return Some(("sound speed", sound_speed, must_be));
        }
        None
    })
}

impl<T: Real, const D: usize> Scene<T, D> {
    /// Bodies and walls so far apart that the scalar does not hold places in one scene.
    pub(super) fn check_extent(&self, problems: &mut Vec<Problem>) {
        // Half of the distance of two numbers.
        let rounding = 0.5 * T::EPSILON;
        let origin = self.origin();
        let bodies = self.bodies();
        let bodies = bodies.map(|own| ("body", &own.name, &own.points, own.spacing));
        let walls = self.walls.iter();
        let walls = walls.map(|own| ("wall", &own.name, &own.points, own.spacing));
        for (kind, name, points, spacing) in bodies.chain(walls) {
            let places = points.iter().map(|x| local(x, &origin));
            let farthest = places.flatten().fold(0.0_f64, |most, x| most.max(x.abs()));
            if farthest * rounding > ROUNDED * spacing {
                problems.push(parameter(
                    &format!("distance of {kind} `{name}` from the middle of the scene"),
                    farthest / spacing,
                    "it must be below 8.4e4 spacings in f32, which rounds places there by a two-hundredth of one: take \
                     f64, or leave out what is far away",
                ));
            }
        }
    }

    /// What the start leaves nothing of.
    pub(super) fn check_outlets(&self, problems: &mut Vec<Problem>) {
        for body in self.bodies().filter(|body| !body.points.is_empty()) {
            let mut particles = body.points.iter().enumerate();
            let taken = particles.all(|(k, x)| {
                let v = &body.start_of(k).velocity;
                let takes = |outlet: &crate::boundary::Outlet<D>| outlet.takes(x, v);
                self.outlets.iter().any(takes)
            });
            if taken {
                problems.push(Problem::Incompatible {
                    what: format!(
                        "the outlets take every particle of body `{}` at the start",
                        body.name
                    ),
                    remedy: "reverse the normal, which points to where particles leave, or move the outlet",
                });
            }
        }
    }

    /// Names that are none, and contacts that cannot be.
    pub(super) fn check_contacts(&self, problems: &mut Vec<Problem>) {
        let bodies = self.bodies().map(|body| ("body", &body.name));
        let walls = self.walls.iter().map(|wall| ("wall", &wall.name));
        if let Some((kind, _)) = bodies.chain(walls).find(|(_, name)| name.trim().is_empty()) {
            problems.push(Problem::Incompatible {
                what: format!("a {kind} has an empty name"),
                remedy: "give it one: errors, contacts and tables use it",
            });
        }
        for (first, second, _) in &self.contacts {
            if first == second {
                problems.push(Problem::Incompatible {
                    what: format!("an interaction of body `{first}` with itself is given"),
                    remedy: "name two bodies: a body is always bonded to itself",
                });
            }
        }
    }

    /// Periods that hold a body, and boundaries with a number of images that can be made.
    pub(super) fn check_periods(&self, problems: &mut Vec<Problem>) {
        let mut periods: Vec<Vector<f64, D>> = Vec::new();
        for boundary in &self.boundaries {
            let images = boundary.images();
            if images > MOST_IMAGES {
                problems.push(parameter(
                    &format!("number of images of the {}", boundary.name()),
                    images as f64,
                    "it must be at most 64: each is looked for whenever lists are made",
                ));
                continue;
            }
            let (before, said) = (periods.len(), problems.len());
            for image in 0..images {
                // A shift that changes no direction, back from which particles re-enter.
                let by = boundary.transform(image, 0.0);
                let period = length(&by.shift);
                let straight = by.rotation == Matrix::<f64, D>::identity();
                let along = by.shift / period;
                let parallel = |other: &Vector<f64, D>| other.dot(&along).abs() > 0.999_999;
                // The way back is the same period.
                let known = periods[before..].iter().any(&parallel);
                if !straight || !period.is_finite() || period <= 0.0 || known {
                    continue;
                }
                if periods[..before].iter().any(parallel) {
                    problems.push(Problem::Incompatible {
                        what: format!("the {} is given twice", boundary.name()),
                        remedy: "give one period for each direction: a second one fills the space of the first again",
                    });
                }
                periods.push(along);
                // One direction says it: what is too long for one is so for those between it and others.
                if problems.len() == said {
                    self.check_bodies_in_period(&boundary.name(), along, period, problems);
                }
            }
        }
    }

    /// Bodies that are longer than a period in a direction overlap their own images.
    fn check_bodies_in_period(
        &self,
        name: &str,
        along: Vector<f64, D>,
        period: f64,
        problems: &mut Vec<Problem>,
    ) {
        for body in self.bodies() {
            let height = |x: &[f64; D]| along.dot(&Vector::from(*x));
            let heights = body.points.iter().map(height);
            let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
                (low.min(x), high.max(x))
            });
            // Points without a lattice may fill a period to its ends and a little beyond, where none is at the image of another.
            let seam = SEAM * body.spacing;
            let meets = || {
                let last = |x: &&[f64; D]| height(x) > low + period - seam;
                let images = body.points.iter().filter(last).map(|x| {
                    let image = Vector::from(*x) - along * period;
                    image.into()
                });
                let first = |x: &&[f64; D]| height(x) < high - period + seam;
                let ends = body.points.iter().filter(first).copied();
                any_within(&ends.collect::<Vec<_>>(), images, seam)
            };
            if high - low > period + seam || high - low > period - seam && meets() {
                problems.push(Problem::Incompatible {
                        what: format!(
                            "body `{}` reaches over {} m along the {}, which is {period} m long, and would overlap itself",
                            body.name,
                            high - low + body.spacing,
                            name
                        ),
                        remedy: "make the period as long as the body, or the body shorter",
                    });
            }
        }
    }

    /// Factors of the step that integrator and kernel allow, and what the integrator says of itself.
    pub(super) fn check_factors(&self, problems: &mut Vec<Problem>) {
        let kernels = self.parts.iter().map(|part| part.scheme.kernel.stable_step);
        let bearable = kernels.fold(1.0, f64::min);
        let control = &self.control;
        if control.courant.is_finite() && control.courant >= bearable {
            problems.push(Problem::Incompatible {
                what: format!(
                    "the step factor (courant) is {}, and integrator and kernel are stable below {bearable}",
                    control.courant
                ),
                remedy: "take the 0.55 of the schemes, or less for noisy flow",
            });
        }
        for (what, value, limit, must_be) in [
            (
                "force factor of the step",
                control.force,
                1.0,
                "it must be positive and below 1: with 1 a particle moves half a smoothing length from rest",
            ),
            (
                "viscous factor of the step",
                control.viscous,
                0.5,
                "it must be positive and below 0.5, where explicit diffusion is no longer stable",
            ),
            (
                "approach factor of the step",
                control.approach,
                1.0,
                "it must be positive and below 1, or particles pass through each other",
            ),
        ] {
            if value.is_nan() || value <= 0.0 || value >= limit {
                problems.push(parameter(what, value, must_be));
            }
        }
        if control.growth.is_nan() || control.growth <= 1.0 {
            let must_be =
                "it must be above 1, or the step never grows again; infinite for no limit";
            problems.push(parameter(
                "growth factor of the step",
                control.growth,
                must_be,
            ));
        }
        for &end in &self.step_ends {
            if !end.is_finite() || end <= 0.0 {
                let must_be = "it must be finite and after the start, in seconds";
                problems.push(parameter("time at which a step ends", end, must_be));
            }
        }
        if let Some(smallest) = control.smallest
            && !(smallest.is_finite() && smallest >= 0.0)
        {
            let must_be = "it must be finite and not negative, in seconds";
            problems.push(parameter("smallest time step", smallest, must_be));
        }
        for (what, value, must_be) in integrator_flaws(self.integrator.as_ref()) {
            let what = format!("{what} of the integrator {}", self.integrator.name());
            problems.push(parameter(&what, value, must_be));
        }
    }
}

/// What is wrong with an integrator, by itself and by what a simulation can do.
fn integrator_flaws(integrator: &dyn Integrator) -> Vec<Flaw> {
    let mut flaws = integrator.problems();
    let stability = integrator.stability();
    if !(stability.is_finite() && stability > 0.0) {
        let must_be = "it must be finite and positive, 1 for a leapfrog";
        flaws.push(("stability", stability, must_be));
    }
    if integrator.slots() > MOST_STATES {
        let must_be = "it must be at most 64: each is a copy of all particles";
        flaws.push(("number of kept states", integrator.slots() as f64, must_be));
    }
    if flaws.is_empty() {
        flaws.extend(oscillator::problem_of(integrator));
    }
    flaws
}

impl<T: Real, const D: usize> Plan<'_, T, D> {
    /// A smoothing length that is solved with the density sees one side of a contact, and half of the density there.
    pub(super) fn check_openings_of_sums(&self, problems: &mut Vec<Problem>) {
        if !matches!(self.scheme.smoothing, Smoothing::Consistent(_)) {
            return;
        }
        for (k, second) in self.bodies.iter().enumerate() {
            for first in &self.bodies[..k] {
                let said = self.scene.said_between(&first.name, &second.name);
                if said.unwrap_or(self.scheme.between) == Interaction::Unilateral {
                    problems.push(Problem::Incompatible {
                        what: format!(
                            "bodies `{}` and `{}` are in a contact that opens, and a smoothing length that follows the density \
                             sees one side of it",
                            first.name, second.name
                        ),
                        remedy: "bond them with Scene::between, or take a fixed smoothing length",
                    });
                }
            }
        }
    }
}
