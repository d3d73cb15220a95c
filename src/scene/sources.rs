//! Sources and drains of a scene, and what can be wrong with them.
//! A source feeds a body of a scheme of liquids.

use super::plan::Plan;
use super::{Part, Scene};
use crate::boundary::{Drain, Source};
use crate::error::Problem;
use crate::scalar::Real;
use crate::simulation::{DrainState, SourceState};

impl<T: Real, const D: usize> Scene<T, D> {
    /// Adds a source, at whose points particles appear.
    #[must_use]
    pub fn source(mut self, source: Source<D>) -> Self {
        self.sources.push(source);
        self
    }

    /// Adds a drain, which takes particles out of a shape.
    #[must_use]
    pub fn drain(mut self, drain: Drain<D>) -> Self {
        self.drains.push(drain);
        self
    }

    /// Particles that may enter a body.
    pub(super) fn reserve_of(&self, body: &str) -> usize {
        let inlets = self.inlets.iter().filter(|own| own.body == body);
        let sources = self.sources.iter().filter(|own| own.body == body);
        let reserves = inlets.map(|own| own.reserve);
        reserves.chain(sources.map(|own| own.reserve)).sum()
    }

    /// Whether particles may enter a body.
    pub(super) fn is_fed(&self, body: &str) -> bool {
        self.inlets.iter().any(|own| own.body == body)
            || self.sources.iter().any(|own| own.body == body)
    }

    pub(super) fn check_sources(&self, problems: &mut Vec<Problem>) {
        for own in &self.sources {
            for (what, value, must_be) in own.problems() {
                problems.push(Problem::Parameter {
                    what: format!("{what} of the source of body `{}`", own.body),
                    value,
                    must_be,
                });
            }
            let mut parts = self.parts.iter();
            let fed = parts.find(|part| part.bodies.iter().any(|body| body.name == own.body));
            let Some(part) = fed else {
                problems.push(self.unknown_body(&own.body));
                continue;
            };
            if !part.scheme.density.is_integrated() || !part.scheme.meets_walls() {
                problems.push(Problem::Incompatible {
                    what: format!(
                        "the source of body `{}` adds particles, which the scheme {} does not take",
                        own.body, part.scheme.name
                    ),
                    remedy: "take a scheme of liquids (schemes::weakly_compressible)",
                });
            }
        }
        for own in &self.drains {
            for (what, value, must_be) in own.problems() {
                problems.push(Problem::Parameter {
                    what: format!("{what} of a drain"),
                    value,
                    must_be,
                });
            }
            let Some(name) = &own.body else {
                let flows = |part: &&Part<T, D>| !part.scheme.density.keeps_neighbors();
                if self.parts.iter().filter(flows).count() > 1 {
                    problems.push(Problem::Incompatible {
                        what: "a drain takes particles from bodies of several schemes, and each would lose the \
                        whole rate".into(),
                        remedy: "limit it to a body by Drain::on",
                    });
                }
                continue;
            };
            let mut parts = self.parts.iter();
            let from = parts.find(|part| part.bodies.iter().any(|body| body.name == *name));
            match from {
                None => problems.push(self.unknown_body(name)),
                Some(part) if part.scheme.density.keeps_neighbors() => {
                    problems.push(Problem::Incompatible {
                        what: format!(
                            "a drain takes particles from body `{name}`, which keeps its neighbours under the \
                             scheme {}",
                            part.scheme.name
                        ),
                        remedy: "take a scheme of liquids, or limit the drain to another body by Drain::on",
                    });
                }
                Some(_) => {}
            }
        }
    }
}

impl<T: Real, const D: usize> Plan<'_, T, D> {
    /// The sources of its bodies, with places that are counted from an origin \[m\].
    pub(super) fn sources(&self, origin: &[f64; D]) -> Vec<SourceState<D>> {
        let of = |own: &Source<D>| {
            let body = self.bodies.iter().position(|body| body.name == own.body)?;
            Some(SourceState::new(own, body, origin))
        };
        self.scene.sources.iter().filter_map(of).collect()
    }

    /// The drains of its bodies. What keeps its neighbours stays whole.
    pub(super) fn drains(&self) -> Vec<DrainState<D>> {
        if self.scheme.density.keeps_neighbors() {
            return Vec::new();
        }
        let takes = |own: &&Drain<D>| {
            let is = |name: &String| self.bodies.iter().any(|body| body.name == *name);
            own.body.as_ref().is_none_or(is)
        };
        let drains = self.scene.drains.iter().filter(takes);
        drains.map(DrainState::new).collect()
    }
}
