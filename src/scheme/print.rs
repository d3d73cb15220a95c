//! How a scheme prints itself: its terms with equations and sources, its step, and the fields of a particle.
//! What is not printed here is not in the program that runs.

use super::Scheme;
use super::entry::{Kind, Part};
use crate::particles::{Fields, Outputs};
use crate::scalar::Real;
use core::fmt;

impl<T: Real, const D: usize> fmt::Display for Scheme<T, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{}: {} kernel, h/dx {}, density by {}, energy {:?}, smoothing {:?}",
            self.name, self.kernel.name, self.h_over_dx, self.density, self.energy, self.smoothing
        )?;
        for term in self.terms().iter().filter(|term| !term.name.is_empty()) {
            writeln!(f, "  {}: {}  [{}]", term.name, term.equation, term.source)?;
        }
        write!(f, "  carries {}", self.names(self.fields()))
    }
}

impl<T: Real, const D: usize> Scheme<T, D> {
    fn names(&self, fields: Fields) -> String {
        let names: Vec<_> = fields
            .iter()
            .map(|field| self.program.name_of(field))
            .collect();
        names.join(", ")
    }

    fn names_of_sums(&self, sums: Outputs) -> String {
        let names: Vec<_> = sums.iter().map(|sum| self.name_of_sum(sum)).collect();
        names.join(", ")
    }

    /// The step program: the entries of a step in the order in which they run, with the fields that each reads and writes.
    /// Sums are made by pairs and read by the others.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// let scheme: Scheme<f64, 2> = schemes::weakly_compressible().compose();
    /// let program = scheme.step_program();
    /// assert!(program.contains("rates"));
    /// ```
    #[must_use]
    pub fn step_program(&self) -> String {
        let mut lines = vec![format!("{}, step by step", self.name)];
        let phases = self.entries.phases().into_iter();
        for (phase, entries) in phases.filter(|own| !own.1.is_empty()) {
            lines.push(phase.into());
            for part in entries.iter().flat_map(|entry| self.parts(*entry)) {
                let verb = match part.kind {
                    Kind::Term => ", pairs: ",
                    Kind::Update => ": evolves ",
                    _ => ": ",
                };
                let Part {
                    stage, name, note, ..
                } = &part;
                lines.push(format!("  {stage}{verb}{name}{note}"));
                let [sums, _] = part.sums;
                let written = [
                    ("reads ", self.names(part.reads)),
                    ("sums  ", self.names_of_sums(sums.union(part.makes))),
                    ("writes", self.names(part.writes)),
                ];
                for (what, names) in written.iter().filter(|own| !own.1.is_empty()) {
                    lines.push(format!("      {what} {names}"));
                }
            }
        }
        let beside = lines.len();
        for own in &self.program.declared {
            let (name, unit) = (self.program.name_of(own.field), own.field.unit());
            lines.push(format!("  starts {name} [{unit}] at {}", own.start));
        }
        for own in &self.program.ledger {
            let name = self.program.name_of(own.field);
            let mass = if own.times_mass { "m " } else { "" };
            lines.push(format!(
                "  ledger: {} [{}] = {} Σ {mass}{name}",
                own.name, own.unit, own.factor
            ));
        }
        // What flows between particles goes back and forth and grows in steps that are too long.
        let flows = self.program.evolved.iter().filter(|own| {
            let mut sums = own.rates.iter().flat_map(|rate| rate.sums().iter());
            sums.any(|sum| sum.index().is_none())
        });
        for own in flows.filter(|_| self.program.limits.is_empty()) {
            let name = self.program.name_of(own.field);
            lines.push(format!(
                "  limits the step: nothing for {name}, which sums over pairs change (StepProgram::limit)"
            ));
        }
        for limit in &self.program.limits {
            lines.push(format!("  limits the step: {}", limit.name()));
        }
        // Not the order of the list of effects.
        lines[beside..].sort();
        lines.join("\n")
    }
}
