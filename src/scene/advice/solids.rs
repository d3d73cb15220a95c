//! Advice on solids: what impacts and clamps do to them, and how many particles lie across thin parts.
//! A body that runs into a plane of symmetry meets its own image there, as one that closes at twice its speed.

use super::bands::{
    ASYMMETRY, BENDING, CROSSINGS, FOURIER, JOHNSON, NONLINEAR, OPENS, RATE, RESOLUTION, SHOCK,
    STATIC, THERMAL, YIELD,
};
use super::measures::{
    Measures, extents, farthest, fastest, length, middle, norm, thickness, velocity,
};
use super::{Advice, Known, Need};
use crate::material::Material;
use crate::material::strength::PlasticState;
use crate::scalar::Real;
use crate::scene::{Body, Part, Scene};
use crate::scheme::EnergyForm;
use crate::sweep::Interaction;
use crate::tensor::Vector;

/// What an impact does to one of the two.
struct Blow {
    /// Closing speed ΔU \[m/s\].
    closing: f64,
    /// Stress behind the shock \[Pa\], acoustic.
    stress: f64,
    /// Extent \[m\] along the impact, of this body and of the shorter of the two.
    length: f64,
    shorter: f64,
    /// Who strikes.
    by: String,
    /// Whether the two may part.
    opens: bool,
    /// When they meet \[s\], and how soon after that another impact counts as the same.
    when: [f64; 2],
}

impl Blow {
    /// When two bodies meet that close at a speed, half a spacing either way.
    fn time<T: Real, const D: usize>(
        axis: usize,
        closing: f64,
        apart: f64,
        bodies: [&Body<T, D>; 2],
    ) -> [f64; 2] {
        let half = bodies.iter().map(|body| 0.5 * extents(body)[axis]);
        let gap = (apart.abs() - half.sum::<f64>()).max(0.0);
        [gap / closing, bodies[0].spacing / closing]
    }

    /// The first impact, and the hardest of those that come with it.
    fn first(blows: &[Self]) -> Option<&Self> {
        let earliest = blows
            .iter()
            .min_by(|a, b| a.when[0].total_cmp(&b.when[0]))?;
        let until = earliest.when[0] + earliest.when[1];
        let with_it = blows.iter().filter(|blow| blow.when[0] <= until);
        with_it.max_by(|a, b| a.stress.total_cmp(&b.stress))
    }
}

impl<T: Real, const D: usize> Scene<T, D> {
    pub(super) fn advise_on_solids(&self, measures: &Measures, known: &Known, advice: &mut Advice) {
        let solids = || {
            let parts = self.parts.iter().filter(|part| !part.scheme.meets_walls());
            parts.flat_map(|part| part.bodies.iter().map(move |body| (part, body)))
        };
        for (part, body) in solids() {
            let others = solids().filter(|(_, other)| other.name != body.name);
            let blows = others.filter_map(|(_, other)| self.blow(body, other));
            let blows: Vec<_> = blows.chain(self.blows_of_images(body)).collect();
            let mut rate = known.strain_rate;
            if let Some(blow) = Blow::first(&blows) {
                let u = blow.stress / body.material.impedance();
                rate = rate.or(Some(u / blow.length));
                self.advise_on_blow(part, body, blow, (measures, known), advice);
                self.advise_on_gravity(&body.name, blow.closing, blow.length, measures, advice);
            } else {
                let lengths = length(body);
                let speed = (measures.acceleration * lengths).sqrt();
                if speed > 0.0 {
                    self.advise_on_gravity(&body.name, speed, lengths, measures, advice);
                }
            }
            rate = self.advise_on_clamps(part, body, measures, advice).or(rate);
            advise_on_strength(part, body, rate, advice);
            if let Some(kappa) = known.diffusivity {
                let number = kappa * measures.end / thickness(body).powi(2);
                advice.add(FOURIER.line(&body.name, number, None));
            }
        }
    }

    /// What a body takes from another that closes with it.
    fn blow(&self, body: &Body<T, D>, other: &Body<T, D>) -> Option<Blow> {
        let said = self.said_between(&body.name, &other.name);
        let coupled = self.coupling(&body.name, &other.name).is_some();
        if said == Some(Interaction::None) && !coupled {
            return None;
        }
        let own = self.place_of(&body.name)?.0;
        let usual = self.parts[own].scheme.between;
        let bonded = !coupled && said.unwrap_or(usual) == Interaction::Bonded;
        let parts = (middle(other), velocity(other));
        let shorter = |axis: usize| extents(body)[axis].min(extents(other)[axis]);
        let (closing, axis) = closes((middle(body), velocity(body)), parts)?;
        let [a, b] = [body, other].map(|body| body.material.impedance());
        Some(Blow {
            closing,
            stress: a * b / (a + b) * closing,
            length: extents(body)[axis],
            shorter: shorter(axis),
            by: other.name.clone(),
            opens: !bonded,
            when: Blow::time(
                axis,
                closing,
                middle(other)[axis] - middle(body)[axis],
                [body, other],
            ),
        })
    }

    /// What a body takes from its own images: behind a wall that it strikes. Images behind a period move with it.
    fn blows_of_images(&self, body: &Body<T, D>) -> Vec<Blow> {
        let (x, v) = (middle(body), velocity(body));
        let mut blows = Vec::new();
        for boundary in &self.boundaries {
            for image in 0..boundary.images() {
                let through = boundary.transform(image, 0.0);
                let turn = |v: &[f64; D], shift: &Vector<f64, D>| -> [f64; D] {
                    (through.rotation * Vector::from(*v) + *shift).into()
                };
                let there = (turn(&x, &through.shift), turn(&v, &through.velocity));
                if let Some((closing, axis)) = closes((x, v), there) {
                    blows.push(Blow {
                        closing: 0.5 * closing,
                        stress: 0.5 * body.material.impedance() * closing,
                        length: extents(body)[axis],
                        shorter: extents(body)[axis],
                        by: boundary.name(),
                        opens: boundary.interaction() == Interaction::Unilateral,
                        when: Blow::time(axis, closing, there.0[axis] - x[axis], [body, body]),
                    });
                }
            }
        }
        blows
    }

    fn advise_on_blow(
        &self,
        part: &Part<T, D>,
        body: &Body<T, D>,
        blow: &Blow,
        (measures, known): (&Measures, &Known),
        advice: &mut Advice,
    ) {
        let material = &body.material;
        let (density, z) = (material.reference_density(), material.impedance());
        let (c, u) = (z / density, blow.stress / z);
        let of = format!("{} struck by {}", body.name, blow.by);
        let energy = part.scheme.energy != EnergyForm::None;
        advice.add(CROSSINGS.line(&of, measures.end * c / blow.length, Some(true)));
        advice.add(SHOCK.line(&of, u / c, Some(energy)));
        let slope = slope(material);
        let curved = (slope - 0.5).abs() > 1e-3;
        let s = if curved {
            slope
        } else {
            known.shock_slope.unwrap_or(slope)
        };
        advice.add(NONLINEAR.line(&of, s * u / c, Some(curved)));
        let own = gruneisen(material);
        let gamma = if own == 0.0 {
            known.gruneisen
        } else {
            Some(own)
        };
        match gamma {
            Some(gamma) => {
                let heat = gamma * density * 0.5 * u * u / blow.stress;
                let there = energy && own != 0.0;
                advice.add(THERMAL.line(&of, heat, Some(there)));
            }
            None => advice.lacks(format!(
                "heat of the shock in `{}`, whose law has no energy: give Known::gruneisen",
                body.name
            )),
        }
        let Some(yields) = yield_stress(material) else {
            return advice.lacks(format!(
                "whether `{}` yields: its material has no yield stress",
                body.name
            ));
        };
        let plastic = Some(is_plastic(part));
        advice.add(YIELD.line(&of, blow.stress / yields, plastic));
        if self.touches_wall(body) {
            let doubled = YIELD.line(&of, 2.0 * blow.stress / yields, plastic);
            advice.add(
                doubled.because("a wall at its end doubles the stress as the wave comes back"),
            );
        }
        let johnson = density * blow.closing.powi(2) / yields;
        advice.add(JOHNSON.line(&of, johnson, plastic));
        let opens = measures.end * c / (2.0 * blow.shorter);
        advice.add(OPENS.line(&of, opens, Some(blow.opens)));
    }

    /// What clamps that move do to a body; gives the rate of strain \[1/s\].
    fn advise_on_clamps(
        &self,
        part: &Part<T, D>,
        body: &Body<T, D>,
        measures: &Measures,
        advice: &mut Advice,
    ) -> Option<f64> {
        let mut rate = None;
        for clamp in self.clamps.iter().filter(|own| own.body == body.name) {
            let Some(motion) = &clamp.motion else {
                continue;
            };
            let points: Vec<_> = clamp.particles(&body.points);
            let points: Vec<[f64; D]> = points.into_iter().map(|(_, x)| x).collect();
            let long = length(body);
            let speed = fastest(&**motion, &points, measures.end, 1);
            if speed == 0.0 || long == 0.0 {
                continue;
            }
            rate = Some(rate.unwrap_or(0.0_f64).max(speed / long));
            let Some(yields) = yield_stress(&body.material) else {
                continue;
            };
            let modulus = body.material.youngs_modulus();
            let modulus = modulus.unwrap_or_else(|| body.material.bulk_modulus());
            let strain = farthest(&**motion, &points, measures.end) / long;
            let line = STATIC.line(
                &body.name,
                modulus * strain / yields,
                Some(is_plastic(part)),
            );
            advice.add(line.because("the strain is the way of the clamp over the largest extent"));
        }
        rate
    }

    /// Whether particles of a body lie at a plane that reflects.
    fn touches_wall(&self, body: &Body<T, D>) -> bool {
        self.boundaries.iter().any(|boundary| {
            (0..boundary.images()).any(|image| {
                let through = boundary.transform(image, 0.0);
                let turned = through.rotation.trace() < D as f64 - 0.5;
                let near = |x: &[f64; D]| boundary.reaches(image, x, body.spacing, 0.0);
                turned && body.points.iter().any(near)
            })
        })
    }

    /// Particles across what is thin: bodies, and the gap that is known.
    pub(super) fn advise_on_spacing(&self, known: &Known, advice: &mut Advice) {
        for part in &self.parts {
            let liquid = part.scheme.meets_walls();
            for body in &part.bodies {
                let line = RESOLUTION.line(&body.name, thickness(body) / body.spacing, None);
                let rigid = self.rigid.contains(&body.name);
                advice.add(if rigid && line.need == Need::Impossible {
                    line.rather(Need::Skip, "but a rigid body does not bend")
                } else {
                    line
                });
                let slender = length(body) >= 3.0 * thickness(body);
                if D == 3 && !liquid && !rigid && slender {
                    let line = BENDING.line(&body.name, thickness(body) / body.spacing, None);
                    advice.add(line);
                }
                if let (true, Some(gap)) = (liquid, known.gap) {
                    let of = format!("{} in the narrowest gap", body.name);
                    advice.add(RESOLUTION.line(&of, gap / body.spacing, None));
                }
            }
        }
    }
}

/// The speed at which two bodies close, and the axis along which they are apart; nothing if they do not.
fn closes<const D: usize>(
    (x, v): ([f64; D], [f64; D]),
    (y, w): ([f64; D], [f64; D]),
) -> Option<(f64, usize)> {
    let apart: [f64; D] = core::array::from_fn(|d| y[d] - x[d]);
    let moves: [f64; D] = core::array::from_fn(|d| w[d] - v[d]);
    let rate: f64 = (0..D).map(|d| apart[d] * moves[d]).sum();
    let axis = (0..D).max_by(|&a, &b| moves[a].abs().total_cmp(&moves[b].abs()))?;
    (rate < 0.0).then(|| (norm(&moves), axis))
}

fn is_plastic<T: Real, const D: usize>(part: &Part<T, D>) -> bool {
    let mut declared = part.scheme.program.declared.iter();
    declared.any(|own| own.field.name() == "plastic_strain")
}

fn yield_stress<T: Real>(material: &Material<T>) -> Option<f64> {
    let law = material.strength()?;
    let yields = law.yield_stress(&PlasticState::default());
    (yields > 0.0).then_some(yields)
}

/// S of the shock line u_s = c + S u that a law gives weak shocks: p/(K η) = 1 + (2 S − 1) η to second order in η.
fn slope<T: Real>(material: &Material<T>) -> f64 {
    let (rest, eta) = (material.reference_density(), 1e-4);
    let (least, c) = material.state(rest, 0.0);
    let shock = material
        .state(rest * (1.0 + eta), 0.5 * (c * eta).powi(2))
        .0
        - least;
    0.5 * ((shock / (rest * c * c * eta) - 1.0) / eta + 1.0)
}

/// Γ = ∂p/∂(ρ e) of a law at rest.
fn gruneisen<T: Real>(material: &Material<T>) -> f64 {
    let rest = material.reference_density();
    let (none, c) = material.state(rest, 0.0);
    let energy = 1e-6 * c * c;
    (material.state(rest, energy).0 - none) / (rest * energy)
}

/// What rate and pressure do to the yield stress, as its law says.
fn advise_on_strength<T: Real, const D: usize>(
    part: &Part<T, D>,
    body: &Body<T, D>,
    rate: Option<f64>,
    advice: &mut Advice,
) {
    let (Some(law), Some(yields)) = (body.material.strength(), yield_stress(&body.material)) else {
        return;
    };
    let at = |state: PlasticState| law.yield_stress(&state) / yields;
    let rest = PlasticState::default();
    let plastic = Some(is_plastic(part));
    if let Some(rate) = rate {
        let gain = at(PlasticState { rate, ..rest }) - 1.0;
        let line = RATE.line(&body.name, gain, plastic);
        let line = line.because(&format!("at {rate:.1e} 1/s, by the law {}", law.name()));
        advice.add(if gain == 0.0 {
            line.rather(Need::Optional, "which knows no rate")
        } else {
            line
        });
    }
    // The pressure of simple compression and tension.
    let push = PlasticState {
        pressure: yields / 3.0,
        ..rest
    };
    let pull = PlasticState {
        pressure: -yields / 3.0,
        ..rest
    };
    advice.add(ASYMMETRY.line(&body.name, at(push) / at(pull) - 1.0, plastic));
}
