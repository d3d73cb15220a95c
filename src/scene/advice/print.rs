//! Advice as a table: what is needed most comes first.
//! Numbers have three digits: they are estimates.

use super::{Advice, Line};
use core::fmt;

impl fmt::Display for Line {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let here = match self.present {
            Some(true) => "yes",
            Some(false) => "no",
            None => "",
        };
        let value = if self.value != 0.0 && !(1e-2..1e4).contains(&self.value.abs()) {
            format!("{:.2e}", self.value)
        } else {
            format!("{:.3}", self.value)
        };
        write!(
            f,
            "| {} | {} | {} | {here} | {} = {value} | {} | {} |",
            self.need.name(),
            self.effect,
            self.of,
            self.number,
            self.band,
            self.reason
        )
    }
}

impl fmt::Display for Advice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "| need | effect | of | there | number | band | because |"
        )?;
        writeln!(f, "|---|---|---|---|---|---|---|")?;
        let mut lines: Vec<_> = self.lines.iter().collect();
        lines.sort_by_key(|line| (!line.is_missing(), line.need));
        for line in lines {
            writeln!(f, "{line}")?;
        }
        for what in &self.unknown {
            writeln!(f, "not told: {what}")?;
        }
        Ok(())
    }
}
