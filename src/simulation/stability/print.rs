//! The report on a run as a short table.
//! What could not be measured has no line.

use super::report::{Extreme, StabilityReport};
use crate::output::table::significant;
use core::fmt;

impl fmt::Display for Extreme {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            time,
            body,
            particle,
            position,
            ..
        } = self;
        let place: Vec<_> = position.iter().map(|x| significant(*x, 3)).collect();
        let (time, place) = (significant(*time, 4), place.join(", "));
        write!(
            f,
            "t = {time} s, particle {particle} of `{body}` at ({place}) m"
        )
    }
}

impl fmt::Display for StabilityReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let number = |value: Option<f64>| value.map_or("not known".into(), |v| significant(v, 3));
        let Self {
            time,
            steps,
            particles,
            ..
        } = self;
        let time = significant(*time, 4);
        writeln!(
            f,
            "stability at {time} s, {steps} steps watched, {particles} particles"
        )?;
        for (what, range) in [
            ("density over rest", &self.density),
            ("h over the first", &self.smoothing),
        ] {
            if let Some([low, high]) = range {
                let [low, high] = [low, high].map(|own| significant(own.value, 4));
                writeln!(f, "  {what:<26} {low} to {high}")?;
            }
        }
        for (name, count) in &self.limits {
            writeln!(f, "  limit: {name:<19} {count} times")?;
        }
        writeln!(
            f,
            "  {:<26} {}",
            "limited particle steps",
            significant(self.limited, 3)
        )?;
        writeln!(
            f,
            "  {:<26} {}",
            "residual of momentum",
            number(self.momentum)
        )?;
        writeln!(f, "  {:<26} {}", "gain of energy", number(self.energy_gain))?;
        if let Some(closure) = self.energy_closure {
            writeln!(
                f,
                "  {:<26} {}",
                "change of energy",
                significant(closure, 3)
            )?;
        }
        match &self.stored_energy {
            Some(own) => writeln!(
                f,
                "  {:<26} {} of the energy supplied",
                "gain of stored energy",
                significant(own.value, 3)
            )?,
            None => writeln!(f, "  {:<26} not checkable", "gain of stored energy")?,
        }
        if let Some(nearest) = &self.nearest {
            let value = significant(nearest.value, 3);
            writeln!(f, "  {:<26} {value} spacings, {nearest}", "nearest pair")?;
        }
        let (quantile, close) = (number(self.quantile), significant(100.0 * self.close, 3));
        writeln!(
            f,
            "  {:<26} {quantile} spacings; within half of one: {close} %",
            "closest 0.1 %"
        )?;
        if let Some(now) = self.arrangement {
            let [mean, uneven, sparse] = [1.0 - now.mean, now.anisotropy, 100.0 * now.sparse];
            let [mean, uneven, sparse] = [mean, uneven, sparse].map(|own| significant(own, 3));
            writeln!(
                f,
                "  {:<26} {mean}; anisotropy {uneven}; sparse {sparse} %",
                "clumping now"
            )?;
        }
        let void = self.void.as_ref().map(|own| own.0);
        writeln!(f, "  {:<26} {} spacings", "largest void now", number(void))?;
        if let Some(step) = &self.step {
            let [least, median] = [step.least.value, step.median].map(|own| significant(own, 3));
            let criterion = step.criterion;
            writeln!(
                f,
                "  {:<26} {least} s of median {median} s, by {criterion}",
                "shortest step"
            )?;
        }
        writeln!(f, "  {:<26} {}", "growth of noise", number(self.growth))?;
        let Self {
            leaked,
            ejected,
            left,
            ..
        } = self;
        writeln!(
            f,
            "  {:<26} {leaked} leaked, {ejected} alone, {left} left",
            "particles"
        )?;
        writeln!(
            f,
            "  {:<26} {} %",
            "cost of watching",
            significant(100.0 * self.price, 2)
        )?;
        if let Some(cause) = &self.verdict.failed {
            writeln!(f, "verdict: ended by an error: {cause}")?;
        }
        if self.verdict.is_stable() {
            return writeln!(f, "verdict: stable");
        }
        if !self.verdict.watched {
            writeln!(
                f,
                "verdict: unknown, because no step was watched: call `keep_stability` before the run"
            )?;
        }
        for own in &self.verdict.breaches {
            let [value, limit] = [own.value, own.limit].map(|own| significant(own, 3));
            write!(f, "verdict: {} is {value}, limit {limit}", own.measure)?;
            match &own.at {
                Some(at) => writeln!(f, ", first {at}")?,
                None => writeln!(f)?,
            }
            if let ("compression", Some(c)) = (own.measure, self.sound_speed) {
                writeln!(
                    f,
                    "  the pressure of the flow is too high for the sound speed, and forces are too low: take {} m/s or more",
                    significant(c, 3)
                )?;
            }
        }
        Ok(())
    }
}
