//! The indicators of a state as a short table, with what limits it most.
//! What could not be measured has no line.

use super::report::{Indicators, Spread};
use crate::output::table::significant;
use core::fmt;

impl fmt::Display for Indicators {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            time,
            particles,
            inside,
            ..
        } = self;
        let time = significant(*time, 4);
        writeln!(
            f,
            "indicators at {time} s, {particles} particles sampled, {inside} of them away from free surfaces"
        )?;
        let line = |f: &mut fmt::Formatter<'_>, what: &str, own: &Spread| {
            let [median, worst] = [own.median, own.worst.value].map(|value| significant(value, 2));
            let place: Vec<_> = own
                .worst
                .position
                .iter()
                .map(|x| significant(*x, 3))
                .collect();
            let (body, place) = (&own.worst.body, place.join(", "));
            writeln!(
                f,
                "  {what:<28} {median:>8}  worst {worst:>8} in `{body}` at ({place}) m"
            )
        };
        for (what, own) in [
            ("unity defect", &self.unity),
            ("gradient defect", &self.gradient),
            ("after the correction", &self.left),
            ("disorder", &self.disorder),
            ("density by sum, and carried", &self.density),
            ("spacing over front", &self.fronts),
            ("spacing over shear layer", &self.layers),
        ] {
            if let Some(own) = own {
                line(f, what, own)?;
            }
        }
        for own in &self.thickness {
            line(f, "particles across", own)?;
        }
        match self.limit() {
            Some(limit) => write!(f, "largest error by {limit}"),
            None => write!(f, "no source of error was found"),
        }
    }
}
