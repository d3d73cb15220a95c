//! Schemes that bodies obey from an event on: effects with pair terms that begin at a time, or when something happens.
//! Two schemes that follow each other differ in effects alone.

use super::Scene;
use crate::error::Problem;
use crate::scalar::Real;
use crate::scheme::Scheme;
use crate::term::Stage;
use std::sync::Arc;

/// A scheme that the group of a body obeys from an event on.
pub(super) struct ExchangeOf<T: Real, const D: usize> {
    pub body: String,
    pub event: String,
    pub scheme: Arc<Scheme<T, D>>,
}

impl<T: Real, const D: usize> Scene<T, D> {
    /// Gives the group of a body another scheme from an [event](Self::event) on: an effect that begins at a time or when
    /// something happens, and, by a second exchange, ends so. Loops over pairs have no clock; each scheme has its own,
    /// so that a step pays for no effect, in time or memory, that is not in force. It takes one evaluation when it happens.
    ///
    /// The schemes may differ in their effects and in their viscosity, and in nothing else: kernel, h/dx, density and energy form,
    /// smoothing and walls are the same, and none that follows may leave out a field that the one before integrates.
    /// Fields that only the new one has begin as at a start; others are forgotten. An effect without pair terms needs no
    /// exchange: [`During`](crate::effect::During).
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// // A liquid that is shifted from a twentieth of a second on.
    /// let plain = schemes::weakly_compressible();
    /// let shifted = schemes::weakly_compressible().with(Shifting::STANDARD);
    /// let water = catalogue::weakly_compressible_water(1.0);
    /// let mut simulation = Scene::<f64, 2>::new(plain)
    ///     .body(Body::block("water", water, [0.0; 2], [0.1; 2], 0.01))
    ///     .event("a twentieth", |now| now.time() >= 0.05)
    ///     .exchange_scheme("water", "a twentieth", shifted)
    ///     .build()?;
    /// let terms = |run: &Simulation<f64, 2>| run.scheme().terms().len();
    /// let before = terms(&simulation);
    /// simulation.run_until(0.049)?;
    /// assert_eq!(terms(&simulation), before);
    /// simulation.run_until(0.06)?;
    /// assert!(terms(&simulation) > before);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn exchange_scheme(
        mut self,
        body: &str,
        event: &str,
        scheme: impl Into<Scheme<T, D>>,
    ) -> Self {
        self.exchanges.push(ExchangeOf {
            body: body.into(),
            event: event.into(),
            scheme: Arc::new(scheme.into()),
        });
        self
    }

    /// The exchanges of a group, in order.
    pub(super) fn exchanges_of(&self, group: usize) -> impl Iterator<Item = &ExchangeOf<T, D>> {
        let own = move |own: &&ExchangeOf<T, D>| {
            self.place_of(&own.body).is_some_and(|(k, _)| k == group)
        };
        self.exchanges.iter().filter(own)
    }

    /// Schemes that follow each other differ in effects alone.
    pub(super) fn check_exchanges(&self, problems: &mut Vec<Problem>) {
        for own in &self.exchanges {
            if self.place_of(&own.body).is_none() {
                problems.push(self.unknown_body(&own.body));
            }
        }
        for group in 0..self.parts.len() {
            let mut before = &self.parts[group].scheme;
            for own in self.exchanges_of(group) {
                self.plan_of(group, &own.scheme).check_scheme(problems);
                for what in differences(before, &own.scheme) {
                    problems.push(Problem::Incompatible {
                        what: format!(
                            "the scheme that body `{}` takes at the event `{}` and the one before differ in {what}",
                            own.body, own.event
                        ),
                        remedy: "exchange schemes that differ in effects and viscosity alone",
                    });
                }
                before = &own.scheme;
            }
        }
    }
}

/// In what two schemes differ that follow each other, beside effects.
fn differences<T: Real, const D: usize>(a: &Scheme<T, D>, b: &Scheme<T, D>) -> Vec<String> {
    let kernel = |own: &Scheme<T, D>| (own.kernel.name, own.kernel.support, own.h_over_dx);
    let density = |own: &Scheme<T, D>| (own.density, own.pressure_form, own.consistent_at_rest);
    let reference = |own: &Scheme<T, D>| {
        let laws = &own.program.laws[Stage::Reference.number()];
        let sums = own.sweep(Stage::Reference).is_some();
        (own.reference.is_some(), sums, laws.len())
    };
    let lengths = |own: &Scheme<T, D>| {
        let carried = own.fields();
        carried.contains(crate::particles::Field::SMOOTHING_LENGTH)
    };
    let walls = |own: &Scheme<T, D>| (own.meets_walls(), own.program.wall_normals, own.between);
    let lattice = |own: &Scheme<T, D>| own.lattice_consistency_factor.to_bits();
    let same = [
        ("kernel or h/dx", kernel(a) == kernel(b)),
        ("density or pressure form", density(a) == density(b)),
        ("energy form", a.energy == b.energy),
        (
            "smoothing",
            a.smoothing == b.smoothing && lengths(a) == lengths(b),
        ),
        ("reference configuration", reference(a) == reference(b)),
        ("consistency", lattice(a) == lattice(b)),
        ("walls or contacts", walls(a) == walls(b)),
    ];
    let mut all: Vec<String> = same
        .into_iter()
        .filter(|(_, same)| !same)
        .map(|(what, _)| what.into())
        .collect();
    let left = a.program.integrated().minus(b.program.integrated());
    all.extend(left.iter().map(|field| {
        format!(
            "the {} that the one before integrates",
            a.program.name_of(field)
        )
    }));
    all
}
