//! Values by their names, taken from what types print of themselves for programmers, and where two lists of them differ.
//! With them a file can say which number of a scene is another, and not only that one is.

use core::fmt::{Debug, Write};

/// Names, as `bodies.water.dynamic_viscosity`, with values in words.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Values(Vec<(String, String)>);

/// Between a name and its value in a file.
const BETWEEN: char = '\u{1f}';

/// A longer value is shown by its beginning.
const LONGEST: usize = 120;

impl Values {
    /// One value.
    pub fn one(&mut self, name: impl Into<String>, value: impl Into<String>) {
        self.0.push((name.into(), value.into()));
    }

    /// All numbers and words in a value, by the names of fields and the places in lists.
    pub fn all(&mut self, name: &str, value: &impl Debug) {
        // Where we are: names of what is open, each with how many of its parts had no name, and whether it is a list.
        let mut open: Vec<(String, usize, bool)> = vec![(name.into(), 0, false)];
        for line in format!("{value:#?}").lines() {
            let line = line.trim().trim_end_matches(',');
            if line.starts_with(['}', ')', ']']) {
                open.pop();
                continue;
            }
            let named = line.split_once(": ").filter(|(name, _)| is_name(name));
            let begins = line.ends_with(['{', '(', '[']);
            let (own, value) = match named {
                Some((own, value)) => (format!(".{own}"), value),
                None if open.len() == 1 => (String::new(), line),
                None => {
                    let (count, is_list) = open.last_mut().map_or((0, false), |last| {
                        last.1 += 1;
                        (last.1 - 1, last.2)
                    });
                    // What an option or a wrapper of one value holds is that value.
                    let own = if count == 0 && !is_list {
                        String::new()
                    } else {
                        format!("[{count}]")
                    };
                    (own, line)
                }
            };
            let above = open.last().map_or("", |last| last.0.as_str());
            let path = format!("{above}{own}");
            if begins {
                self.kind(&path, value);
                open.push((path, 0, line.ends_with('[')));
            } else {
                self.one(path, without_addresses(value));
            }
        }
    }

    /// What type a group of values has, where it says so.
    fn kind(&mut self, path: &str, value: &str) {
        let kind = value.trim_end_matches(['{', '(', '[']).trim();
        if !kind.is_empty() && kind != "Some" {
            self.one(format!("{path} (kind)"), kind);
        }
    }

    /// As a text of a file.
    pub fn text(&self) -> String {
        let mut text = String::new();
        for (name, value) in &self.0 {
            let _ = writeln!(text, "{name}{BETWEEN}{value}");
        }
        text
    }

    /// From a text of a file.
    pub fn of_text(text: &str) -> Self {
        let pairs = text.lines().filter_map(|line| line.split_once(BETWEEN));
        Self(
            pairs
                .map(|(name, value)| (name.into(), value.into()))
                .collect(),
        )
    }

    /// The values that a condition picks by name and value.
    pub fn of(&self, picks: impl Fn(&str, &str) -> bool) -> Vec<&str> {
        let picked = self.0.iter().filter(|(name, value)| picks(name, value));
        picked.map(|(_, value)| value.as_str()).collect()
    }

    /// The names of what is another in a scene than in this, which is of a file, with both values; none where it is not.
    pub fn differing(&self, scene: &Self) -> Vec<(String, Option<String>, Option<String>)> {
        let find = |all: &Self, name: &str| {
            let found = all.0.iter().find(|own| own.0 == name);
            found.map(|own| own.1.clone())
        };
        let of_file = self.0.iter().filter_map(|(name, value)| {
            let own = find(scene, name);
            let differs = own.as_ref() != Some(value);
            differs.then(|| (name.clone(), Some(short(value)), own.map(|own| short(&own))))
        });
        let lacking = scene.0.iter();
        let lacking = lacking.filter(|(name, _)| find(self, name).is_none());
        let of_scene = lacking.map(|(name, value)| (name.clone(), None, Some(short(value))));
        of_file.chain(of_scene).collect()
    }
}

fn is_name(name: &str) -> bool {
    !name.is_empty() && name.chars().all(|c| c.is_alphanumeric() || c == '_')
}

fn short(value: &str) -> String {
    match value.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}…", &value[..end]),
        None => value.into(),
    }
}

/// A debug text without the addresses of functions, which differ from run to run.
pub(crate) fn without_addresses(text: &str) -> String {
    let mut parts = text.split("0x");
    let mut kept: String = parts.next().unwrap_or_default().into();
    for part in parts {
        kept.push_str("0x");
        kept.push_str(part.trim_start_matches(|c: char| c.is_ascii_hexdigit()));
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug)]
    #[allow(dead_code)]
    struct Liquid {
        name: &'static str,
        viscosity: Option<f64>,
        law: Law,
        rows: Vec<[f64; 2]>,
    }

    #[derive(Debug)]
    #[allow(dead_code)]
    struct Law(fn(f64) -> f64, f64);

    fn values(viscosity: Option<f64>, last: f64) -> Values {
        let mut all = Values::default();
        let rows = vec![[0.0, 1.0], [2.0, last]];
        let law = Law(f64::sin, 1.5);
        all.all(
            "water",
            &Liquid {
                name: "a: b",
                viscosity,
                law,
                rows,
            },
        );
        all
    }

    #[test]
    fn what_differs_is_told_by_its_name_with_both_values() {
        let own = values(Some(1e-3), 3.0);
        assert_eq!(Values::of_text(&own.text()), own);
        assert_eq!(own.differing(&own), Vec::new());
        let told = |scene| {
            let told = own.differing(&scene);
            assert_eq!(told.len(), 1);
            let (what, file, scene) = told[0].clone();
            [what, file.unwrap(), scene.unwrap()]
        };
        let other = values(Some(2e-3), 3.0);
        assert_eq!(told(other), ["water.viscosity", "0.001", "0.002"]);
        let other = values(Some(1e-3), 4.0);
        assert_eq!(told(other), ["water.rows[1][1]", "3.0", "4.0"]);
        let other = values(None, 3.0);
        assert_eq!(told(other), ["water.viscosity", "0.001", "None"]);
    }

    #[test]
    fn addresses_are_left_out() {
        let [sine, cosine] = [Law(f64::sin, 1.5), Law(f64::cos, 1.5)].map(|law| format!("{law:?}"));
        assert_eq!(without_addresses(&sine), "Law(0x, 1.5)");
        assert_eq!(without_addresses(&sine), without_addresses(&cosine));
    }
}
