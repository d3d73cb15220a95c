//! The command line of an example: what all of them accept, and what one adds.
//! A bad option names itself, the value it was given, and what it takes.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// An example: its name, what it computes, its schemes (the first is the default), and its own options.
pub struct Example {
    pub name: &'static str,
    pub about: &'static str,
    pub schemes: &'static [&'static str],
    pub own: &'static [Own],
}

/// An option that one example adds. Without a value it is a switch.
#[derive(Clone, Copy)]
pub struct Own {
    /// As it is typed, `--reynolds`.
    pub name: &'static str,
    /// What it takes, `RE`; empty for a switch.
    pub value: &'static str,
    pub help: &'static str,
}

/// The command line.
#[derive(Clone, Debug)]
pub struct Options {
    /// Particle spacing \[m\].
    pub spacing: Option<f64>,
    /// Whether in `f32`.
    pub single: bool,
    pub threads: Option<usize>,
    pub scheme: String,
    /// End \[s\].
    pub until: Option<f64>,
    pub quick: bool,
    out: PathBuf,
    own: BTreeMap<String, String>,
}

const COMMON: &str = "  --spacing M             distance of particles
  --precision NAME        f64, f32
  --threads N             all cores
  --until S               end of the run
  --out DIR               where files go
  --quick                 coarse and short, to see that it runs
  --help
";

/// An option that cannot be followed.
pub type BadOption = String;

fn bad(option: &str, value: &str, accepted: &str) -> BadOption {
    format!("{option}: `{value}` is not accepted; it takes {accepted}")
}

impl Example {
    /// What `--help` prints.
    pub fn help(&self) -> String {
        let mut own = String::new();
        for option in self.own {
            let usage = format!("{} {}", option.name, option.value);
            own += &format!("  {usage:<22}  {}\n", option.help);
        }
        // What an example reads in a unit of its own stands in place of the common option.
        let common: String = COMMON
            .split_inclusive('\n')
            .filter(|line| {
                let name = line.split_whitespace().next();
                !self.own.iter().any(|own| Some(own.name) == name)
            })
            .collect();
        format!(
            "{}\n\n{own}{common}  --scheme NAME           {}\n",
            self.about,
            self.schemes.join(", ")
        )
    }

    /// Reads arguments without the program's name; `None` if help was asked for.
    pub fn parse(
        &self,
        arguments: impl IntoIterator<Item = String>,
    ) -> Result<Option<Options>, BadOption> {
        let mut options = Options {
            spacing: None,
            single: false,
            threads: None,
            scheme: self.schemes.first().copied().unwrap_or_default().into(),
            until: None,
            quick: false,
            out: Path::new("out").join(self.name),
            own: BTreeMap::new(),
        };
        let mut arguments = arguments.into_iter();
        while let Some(argument) = arguments.next() {
            let (name, inline) = match argument.split_once('=') {
                Some((name, value)) => (name.to_string(), Some(value.to_string())),
                None => (argument.clone(), None),
            };
            let own = self.own.iter().find(|own| own.name == name);
            let switch = own.is_some_and(|own| own.value.is_empty());
            if switch || matches!(name.as_str(), "--quick" | "--help" | "-h") {
                if let Some(value) = inline {
                    return Err(bad(&name, &value, "no value"));
                }
                match name.as_str() {
                    "--quick" => options.quick = true,
                    "--help" | "-h" => return Ok(None),
                    _ => {
                        options.own.insert(name, String::new());
                    }
                }
                continue;
            }
            let known = [
                "--spacing",
                "--precision",
                "--threads",
                "--scheme",
                "--until",
                "--out",
            ];
            if own.is_none() && !known.contains(&name.as_str()) {
                return Err(format!("`{argument}` is not an option\n\n{}", self.help()));
            }
            let Some(value) = inline.or_else(|| arguments.next()) else {
                return Err(format!("{name} needs a value: see --help"));
            };
            match name.as_str() {
                "--spacing" if own.is_none() => options.spacing = Some(positive(&name, &value)?),
                "--until" => options.until = Some(positive(&name, &value)?),
                "--precision" => {
                    options.single = match value.as_str() {
                        "f32" => true,
                        "f64" => false,
                        _ => return Err(bad(&name, &value, "f64 or f32")),
                    }
                }
                "--threads" => {
                    let count = value.parse().ok().filter(|n| (1..=1024).contains(n));
                    let accepted = "a whole number, 1 to 1024";
                    options.threads = Some(count.ok_or_else(|| bad(&name, &value, accepted))?);
                }
                "--scheme" if self.schemes.contains(&value.as_str()) => options.scheme = value,
                "--scheme" => return Err(bad(&name, &value, &self.schemes.join(", "))),
                "--out" => options.out = PathBuf::from(value),
                // What is given several times is a list, with spaces between.
                _ => {
                    let all = options.own.entry(name).or_default();
                    if !all.is_empty() {
                        all.push(' ');
                    }
                    all.push_str(&value);
                }
            }
        }
        Ok(Some(options))
    }
}

fn positive(option: &str, value: &str) -> Result<f64, BadOption> {
    let number = value.trim().parse().ok();
    number
        .filter(|x: &f64| x.is_finite() && *x > 0.0)
        .ok_or_else(|| bad(option, value, "a number above 0, in SI units"))
}

impl Options {
    /// A path in the output folder.
    pub fn file(&self, name: &str) -> PathBuf {
        self.out.join(name)
    }
    /// The output folder.
    pub fn folder(&self) -> &Path {
        &self.out
    }
    /// `full`, or `quick` with `--quick`.
    pub fn pick<X>(&self, full: X, quick: X) -> X {
        if self.quick { quick } else { full }
    }
    /// The spacing asked for \[m\], or else one of these for a full and a quick run.
    pub fn spacing_or(&self, full: f64, quick: f64) -> f64 {
        self.spacing.unwrap_or(self.pick(full, quick))
    }
    /// The end asked for \[s\], or else one of these for a full and a quick run.
    pub fn until_or(&self, full: f64, quick: f64) -> f64 {
        self.until.unwrap_or(self.pick(full, quick))
    }
    /// Whether a switch of the example's own was given.
    pub fn has(&self, name: &str) -> bool {
        self.own.contains_key(name)
    }
    /// The text of an option of the example's own.
    pub fn text(&self, name: &str) -> Option<&str> {
        self.own.get(name).map(String::as_str)
    }
    /// The number of an option of the example's own, above 0; `default` if it was not given.
    pub fn number(&self, name: &str, default: f64) -> Result<f64, BadOption> {
        self.text(name)
            .map_or(Ok(default), |value| positive(name, value))
    }
}
