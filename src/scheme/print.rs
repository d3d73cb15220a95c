//! How a scheme prints itself: its terms with equations and sources, its step, and the fields of a particle.
//! What is not printed here is not in the program that runs.

use super::Scheme;
use crate::effect::reads_and_writes;
use crate::particles::{Field, Fields};
use crate::scalar::Real;
use crate::term::Stage;
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

    /// Whether the pressure makes forces.
    fn presses(&self) -> bool {
        let rates = self.sweep(Stage::Rates);
        rates.is_some_and(|sweep| sweep.fields().contains(Field::PRESSURE_COEFFICIENT))
    }

    /// The step program: what happens at every stage of a step, with the fields read and written.
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
        for stage in Stage::ALL {
            if let Some(sweep) = self.sweep(stage) {
                let mut uses = sweep.uses();
                uses.retain(|own| !own.name.is_empty());
                // Not the order of the list of effects.
                uses.sort_by(|a, b| a.name.cmp(&b.name));
                for own in uses {
                    let sums = own.writes.iter().map(|sum| self.name_of_sum(sum));
                    let sums = sums.collect::<Vec<_>>().join(", ");
                    let reads = own.reads.minus(own.reads.minus(sweep.fields()));
                    lines.push(format!("  {}, pairs: {}", stage.name(), own.name));
                    lines.push(format!("      reads  {}", self.names(reads)));
                    lines.push(format!("      sums   {sums}"));
                }
            }
            for law in &self.program.laws[stage.number()] {
                lines.push(format!("  {}: {}", stage.name(), law.name()));
                let [reads, writes] = reads_and_writes(&**law, self.fields());
                lines.push(format!("      reads  {}", self.names(reads)));
                lines.push(format!("      writes {}", self.names(writes)));
            }
            if stage == Stage::Density {
                let read = Fields::of(&[Field::DENSITY, Field::ENERGY]);
                let absent = read.minus(self.fields());
                let state = [Field::PRESSURE, Field::SOUND_SPEED];
                lines.push("  state: equations of state".into());
                lines.push(format!("      reads  {}", self.names(read.minus(absent))));
                lines.push(format!("      writes {}", self.names(Fields::of(&state))));
            }
            // Once the pressures of walls are known.
            if stage == Stage::Walls && self.presses() {
                let of = |fields: &[Field]| self.names(Fields::of(fields));
                let read = of(&[Field::DENSITY, Field::PRESSURE]);
                let written = of(&[Field::PRESSURE_COEFFICIENT]);
                lines.push(format!("  state: pressure force by {}", self.pressure_form));
                lines.push(format!("      reads  {read}"));
                lines.push(format!("      writes {written}"));
            }
        }
        let beside = lines.len();
        for own in &self.program.evolved {
            let (name, unit) = (self.program.name_of(own.field), own.field.unit());
            lines.push(format!(
                "  evolves {name} [{unit}]: {:?}, {:?}{}",
                own.when,
                own.update,
                if own.residual.is_some() {
                    ", rounding kept"
                } else {
                    ""
                }
            ));
        }
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
