//! The command line of a program: what all of them accept, and what one adds.
//! A bad option names itself, the value it was given, and what it takes.

use clap::builder::PossibleValuesParser;
use clap::{Arg, ArgAction, Args, Command, FromArgMatches};
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// A program: its name, what it computes, its schemes (the first is the default), and its own options.
pub struct Example {
    pub name: &'static str,
    pub about: &'static str,
    pub schemes: &'static [&'static str],
    pub own: &'static [Own],
}

/// An option that one program adds, or a common one that it reads in a unit of its own. Without a value it is a switch.
#[derive(Clone, Copy)]
pub struct Own {
    /// As it is typed, `--reynolds`.
    pub name: &'static str,
    /// What it takes, `RE`; empty for a switch.
    pub value: &'static str,
    pub help: &'static str,
}

/// The command line.
#[derive(Args, Clone, Debug)]
pub struct Options {
    /// Spacing of particles [m]
    #[arg(long, value_name = "M", value_parser = positive)]
    pub spacing: Option<f64>,
    /// Scalar of the run: f64 or f32
    #[arg(long = "precision", value_name = "NAME", value_parser = is_single, action = ArgAction::Set,
          default_value = "f64")]
    pub single: bool,
    /// Threads; all cores if not given
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// How particles act on each other
    #[arg(long, value_name = "NAME")]
    pub scheme: String,
    /// End of the run [s]
    #[arg(long, value_name = "S", value_parser = positive)]
    pub until: Option<f64>,
    /// Coarse and short, to see that it runs
    #[arg(long)]
    pub quick: bool,
    /// Where files go
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    #[arg(skip)]
    own: BTreeMap<String, String>,
}

/// An option that cannot be followed.
pub type BadOption = String;

impl Example {
    fn command(&self) -> Command {
        // The description last: the options bring one of their own.
        let command = Options::augment_args(Command::new(self.name).allow_negative_numbers(true))
            .about(self.about)
            .mut_arg("scheme", |arg| {
                arg.required(false)
                    .value_parser(PossibleValuesParser::new(self.schemes))
                    .default_value(self.schemes.first().copied().unwrap_or_default())
            })
            .mut_arg("out", |arg| {
                arg.required(false)
                    .default_value(format!("out/{}", self.name))
            });
        self.own.iter().fold(command, |command, own| {
            let id = own.name.trim_start_matches('-');
            let taken = command.get_arguments().any(|arg| arg.get_id() == id);
            let describe = |arg: Arg| match own.value {
                "" => arg.action(ArgAction::SetTrue),
                value => arg
                    .action(ArgAction::Append)
                    .value_parser(clap::value_parser!(String))
                    .value_name(value)
                    .allow_hyphen_values(true),
            };
            if taken {
                // The same option in a unit of its own: checked alike, read by its text.
                command.mut_arg(id, |arg| arg.help(own.help).value_name(own.value))
            } else {
                command.arg(describe(Arg::new(id).long(id)).help(own.help))
            }
        })
    }

    /// Reads the program's arguments. Help, and a line that cannot be followed, end the program with status 0 and 2.
    pub fn parse(&self) -> Options {
        let options = self.read(std::env::args_os());
        options.unwrap_or_else(|bad| bad.exit())
    }

    /// Reads arguments, the program's name first.
    pub fn read(
        &self,
        arguments: impl IntoIterator<Item = impl Into<OsString> + Clone>,
    ) -> Result<Options, clap::Error> {
        let matches = self.command().try_get_matches_from(arguments)?;
        let mut options = Options::from_arg_matches(&matches)?;
        for own in self.own {
            let id = own.name.trim_start_matches('-');
            let given = if own.value.is_empty() {
                matches.get_flag(id).then(String::new)
            } else {
                // What is given several times is a list, with spaces between.
                matches.get_raw(id).map(|all| {
                    let all: Vec<_> = all.map(|text| text.to_string_lossy()).collect();
                    all.join(" ")
                })
            };
            options
                .own
                .extend(given.map(|text| (own.name.into(), text)));
            if id == "spacing" {
                options.spacing = None;
            }
        }
        Ok(options)
    }
}

fn positive(value: &str) -> Result<f64, &'static str> {
    let number = value.trim().parse().ok();
    number
        .filter(|x: &f64| x.is_finite() && *x > 0.0)
        .ok_or("it takes a number above 0")
}

fn is_single(value: &str) -> Result<bool, &'static str> {
    match value {
        "f32" => Ok(true),
        "f64" => Ok(false),
        _ => Err("it takes f64 or f32"),
    }
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
    /// Whether a switch of the program's own was given.
    pub fn has(&self, name: &str) -> bool {
        self.own.contains_key(name)
    }
    /// The text of an option of the program's own.
    pub fn text(&self, name: &str) -> Option<&str> {
        self.own.get(name).map(String::as_str)
    }
    /// The number of an option of the program's own, above 0; `default` if it was not given.
    pub fn number(&self, name: &str, default: f64) -> Result<f64, BadOption> {
        self.text(name).map_or(Ok(default), |value| {
            positive(value).map_err(|takes| format!("{name}: `{value}` is not accepted; {takes}"))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const EXAMPLE: Example = Example {
        name: "tank",
        about: "Water in a tank.\nA second line.",
        schemes: &["default", "riemann"],
        own: &[Own {
            name: "--case",
            value: "NAME",
            help: "deep or flat",
        }],
    };

    #[test]
    fn help_begins_with_the_description_and_lists_values() {
        for ask in ["-h", "--help"] {
            let help = EXAMPLE.read(["tank", ask]).unwrap_err().to_string();
            assert!(
                help.starts_with("Water in a tank.\nA second line."),
                "{help}"
            );
            for text in [
                "[possible values: default, riemann]",
                "deep or flat",
                "f64 or f32",
            ] {
                assert!(help.contains(text), "{help}");
            }
        }
    }
}
