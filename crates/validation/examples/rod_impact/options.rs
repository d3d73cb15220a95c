//! The command line: what it accepts, and messages that say what was wrong.
//! A bad option names itself, the value it was given, and what it takes.

use super::cases::{Case, material};
use super::choices::{ContactChoice, IntegratorChoice, SchemeChoice, StateChoice, StrengthChoice};
use clap::error::ErrorKind;
use clap::parser::ValueSource;
use clap::{CommandFactory, FromArgMatches, Parser};
use core::fmt;
use meshfree::kernel::{Kernel, KernelKind};
use meshfree::material::catalogue;
use meshfree::term::ArtificialViscosity;
use meshfree::term::viscosity::ViscosityKind;
use std::ffi::OsString;
use std::path::PathBuf;

/// The command line as it is typed, in its units.
#[derive(Parser)]
#[command(allow_negative_numbers = true)]
#[command(about = "Axial impact of rods (Lam, Shen & Gong 2002).\n\n\
    Without options: figures 1 to 7 of the paper, and a table of its claims, into out/rod_impact.\n\
    --quick, --out and --threads apply to that too; any other option runs one case.")]
struct Line {
    /// Material of the rod that moves
    #[arg(long, value_name = "MATERIAL", value_parser = solid, default_value = "copper", help_heading = CASE)]
    striker: String,
    /// Material of the rod at rest, or wall
    #[arg(long, value_name = "MATERIAL|wall", value_parser = solid_or_wall, default_value = "copper", help_heading = CASE)]
    target: String,
    /// A pad on the striker's head, moving with it
    #[arg(long, value_name = "MATERIAL:MM", value_parser = pad, help_heading = CASE)]
    pad: Option<(String, f64)>,
    #[arg(long, value_name = "M/S", value_parser = positive, default_value = "20", help_heading = CASE)]
    speed: f64,
    #[arg(long, value_name = "MM", value_parser = positive, default_value = "10", help_heading = CASE)]
    striker_length: f64,
    #[arg(long, value_name = "MM", value_parser = positive, default_value = "40", help_heading = CASE)]
    target_length: f64,
    #[arg(long, value_name = "NAME", default_value = "hydrodynamic", help_heading = CASE)]
    state: StateChoice,
    /// Whether rods that support shear yield [default: on]
    #[arg(long, value_name = "NAME", help_heading = CASE)]
    strength: Option<StrengthChoice>,
    /// 0.05, with --quick 0.2
    #[arg(long, value_name = "MM", value_parser = positive, help_heading = METHOD)]
    spacing: Option<f64>,
    /// [default: impact; continuity for rods that support shear]
    #[arg(long, value_name = "NAME", help_heading = METHOD)]
    scheme: Option<SchemeChoice>,
    /// cubic, quartic, quintic, wendland-c2, wendland-c4, wendland-c6, gaussian
    #[arg(long, value_name = "NAME", value_parser = kernel, help_heading = METHOD)]
    kernel: Option<KernelKind>,
    /// Smoothing length over spacing; as the kernel recommends
    #[arg(long, value_name = "RATIO", value_parser = positive, help_heading = METHOD)]
    h_over_dx: Option<f64>,
    #[arg(long, value_name = "NAME", help_heading = METHOD)]
    integrator: Option<IntegratorChoice>,
    /// mg, limited, signal, balsara, ... or none; mg:0.5 or mg:0.5,1 sets alpha, beta
    #[arg(long, value_name = "NAME", value_parser = viscosity, help_heading = METHOD)]
    viscosity: Option<ViscosityKind>,
    #[arg(long, value_name = "NAME", help_heading = METHOD)]
    contact: Option<ContactChoice>,
    /// All cores if not given
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024), help_heading = METHOD)]
    threads: Option<u16>,
    /// One passage of the waves through the chain if not given
    #[arg(long, value_name = "US", value_parser = positive, help_heading = WRITTEN)]
    until: Option<f64>,
    /// A material point, by its first distance from the striker's free end (repeatable)
    #[arg(long, value_name = "MM", value_parser = not_negative, help_heading = WRITTEN)]
    probe: Vec<f64>,
    /// A time for a profile (repeatable; the end if none is given)
    #[arg(long, value_name = "US", value_parser = not_negative, help_heading = WRITTEN)]
    snapshot: Vec<f64>,
    /// out/rod_impact, of --convergence docs
    #[arg(long, value_name = "DIR", help_heading = WRITTEN)]
    out: Option<PathBuf>,
    /// Coarse, to see that it runs
    #[arg(long)]
    quick: bool,
    /// Measures every quantity that the method must meet, for all schemes
    #[arg(long)]
    bars: bool,
    /// Error of figure 1 against spacing
    #[arg(long)]
    convergence: bool,
}

const CASE: &str = "The case";
const METHOD: &str = "The method";
const WRITTEN: &str = "What is written";

/// An option that cannot be followed: what it is, what it was given, what it takes.
fn bad(option: &str, value: &str, accepted: impl fmt::Display) -> String {
    format!("{option}: `{value}` is not accepted; it takes {accepted}")
}

/// What to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Task {
    Figures,
    Case,
    Bars,
    Convergence,
}

/// The command line, in SI units.
#[derive(Clone, Debug)]
pub struct Options {
    pub task: Task,
    pub case: Case,
    pub quick: bool,
    pub threads: Option<usize>,
    pub out: Option<PathBuf>,
}

/// Most particles that a case may have.
const MOST_PARTICLES: f64 = 2e7;

/// Reads the command line, the program's name first.
pub fn parse(arguments: impl IntoIterator<Item = OsString>) -> Result<Options, clap::Error> {
    let matches = Line::command().try_get_matches_from(arguments)?;
    let line = Line::from_arg_matches(&matches)?;
    // What says something of the case asks for it.
    let given = |id: &str| matches.value_source(id) == Some(ValueSource::CommandLine);
    let of_case = Line::command()
        .get_arguments()
        .map(|arg| arg.get_id().to_string())
        .any(|id| !matches!(id.as_str(), "quick" | "threads" | "out") && given(&id));
    let task = match (line.bars, line.convergence, of_case) {
        (true, ..) => Task::Bars,
        (_, true, _) => Task::Convergence,
        (.., true) => Task::Case,
        _ => Task::Figures,
    };
    let (quick, threads, out) = (line.quick, line.threads.map(usize::from), line.out.clone());
    let case = line
        .case()
        .map_err(|text| Line::command().error(ErrorKind::ValueValidation, text))?;
    Ok(Options {
        task,
        case,
        quick,
        threads,
        out,
    })
}

impl Line {
    fn case(self) -> Result<Case, String> {
        let all = |values: Vec<f64>, unit: f64| values.into_iter().map(|x| unit * x).collect();
        let mut case = Case {
            striker: self.striker,
            target: Some(self.target).filter(|name| name != "wall"),
            pad: self.pad,
            speed: self.speed,
            striker_length: 1e-3 * self.striker_length,
            target_length: 1e-3 * self.target_length,
            state: self.state,
            strength: self.strength,
            spacing: 1e-3 * self.spacing.unwrap_or(if self.quick { 0.2 } else { 0.05 }),
            scheme: self.scheme.unwrap_or(match self.state {
                StateChoice::Hydrodynamic => SchemeChoice::Impact,
                _ => SchemeChoice::Continuity,
            }),
            kernel: self.kernel,
            h_over_dx: self.h_over_dx,
            integrator: self.integrator,
            viscosity: self.viscosity,
            contact: self.contact,
            until: 0.0,
            probes: all(self.probe, 1e-3),
            snapshots: all(self.snapshot, 1e-6),
        };
        shear(&case)?;
        complete(&mut case, self.until.map(|end| 1e-6 * end))?;
        Ok(case)
    }
}

/// What does not go with rods that support shear, and with those that do not.
fn shear(case: &Case) -> Result<(), String> {
    let state = case.state.key();
    if !case.bears_shear() {
        return match case.strength {
            Some(StrengthChoice::On) => Err(format!(
                "--strength: `on` needs shear, which --state {state} has not; take --state uniaxial-strain or \
                 uniaxial-stress"
            )),
            _ => Ok(()),
        };
    }
    let refuse = |option: &str, value: &str| {
        Err(format!(
            "{option}: `{value}` does not go with --state {state}, which has --scheme continuity with its own kernel \
             and viscosity, and an integrator that kicks; leave it out"
        ))
    };
    if case.scheme != SchemeChoice::Continuity {
        return refuse("--scheme", case.scheme.key());
    }
    if let Some(kernel) = case.kernel {
        return refuse("--kernel", kernel.key());
    }
    if let Some(viscosity) = &case.viscosity {
        return refuse("--viscosity", viscosity.key());
    }
    let integrator = case.integrator();
    if !integrator.make().kicks() {
        return refuse("--integrator", integrator.key());
    }
    Ok(())
}

/// Fills in what follows from the rest, and checks what options mean together.
fn complete(case: &mut Case, until: Option<f64>) -> Result<(), String> {
    let transit = |rod: &super::cases::Rod| {
        material(&rod.material).map_or(0.0, |material| {
            rod.length() * material.reference_density() / material.impedance()
        })
    };
    let rods = case.rods();
    let passage: f64 = rods.iter().map(transit).sum();
    let passage = if case.target.is_none() {
        3.0 * passage
    } else {
        passage
    };
    // A tenth of a microsecond is fine enough for a default.
    case.until = until.unwrap_or((1e7 * passage).ceil() / 1e7);
    if case.probes.is_empty() {
        case.probes.push(0.5 * case.striker_length);
        if let Some((_, length)) = &case.pad {
            case.probes.push(case.striker_length + 0.5 * length);
        }
        if case.target.is_some() {
            case.probes
                .push(case.contact_place() + 5e-3_f64.min(0.5 * case.target_length));
        }
    }
    if case.snapshots.is_empty() {
        case.snapshots.push(case.until);
    }
    let length = case.length();
    for &probe in &case.probes {
        if probe > length * (1.0 + 1e-12) {
            return Err(bad(
                "--probe",
                &super::cases::short(1e3 * probe),
                format!(
                    "a distance within the chain, 0 to {} mm",
                    super::cases::short(1e3 * length)
                ),
            ));
        }
    }
    for &time in &case.snapshots {
        if time > case.until * (1.0 + 1e-12) {
            return Err(bad(
                "--snapshot",
                &super::cases::short(1e6 * time),
                format!(
                    "a time up to --until, {} µs",
                    super::cases::short(1e6 * case.until)
                ),
            ));
        }
    }
    let spacing = super::cases::short(1e3 * case.spacing);
    if length / case.spacing > MOST_PARTICLES {
        let least = super::cases::short(1e3 * length / MOST_PARTICLES);
        return Err(bad(
            "--spacing",
            &spacing,
            format!("at least {least} mm for this chain (2e7 particles)"),
        ));
    }
    if let Some(rod) = rods.iter().find(|rod| rod.count(case.spacing) < 5.0) {
        let most = super::cases::short(1e3 * rod.length() / 5.0);
        return Err(bad(
            "--spacing",
            &spacing,
            format!(
                "at most {most} mm, so that the {} has five particles",
                rod.name
            ),
        ));
    }
    let kernel = case.kernel.unwrap_or(KernelKind::CubicSpline);
    let (low, high) = Kernel::<1>::h_over_dx_range(&kernel);
    if let Some(ratio) = case.h_over_dx.filter(|ratio| !(low..=high).contains(ratio)) {
        return Err(bad(
            "--h-over-dx",
            &ratio.to_string(),
            format!("{low} to {high} for the kernel {kernel}"),
        ));
    }
    let integrator = case.integrator();
    if case.scheme == SchemeChoice::Continuity && !integrator.make().integrates_density() {
        return Err(format!(
            "--integrator: `{}` does not integrate a density, which --scheme continuity has; take \
             another integrator, or --scheme impact or lam2002",
            integrator.key()
        ));
    }
    Ok(())
}

fn finite(value: &str) -> Option<f64> {
    let number = value.trim().parse::<f64>().ok();
    number.filter(|number| number.is_finite())
}

fn positive(value: &str) -> Result<f64, &'static str> {
    let number = finite(value).filter(|number| *number > 0.0);
    number.ok_or("it takes a number above 0")
}

fn not_negative(value: &str) -> Result<f64, &'static str> {
    let number = finite(value).filter(|number| *number >= 0.0);
    number.ok_or("it takes a number, 0 or more")
}

fn kernel(value: &str) -> Result<KernelKind, String> {
    value.parse().map_err(|_| {
        let names: Vec<_> = KernelKind::ALL.iter().map(|kind| kind.key()).collect();
        format!("it takes one of {}", names.join(", "))
    })
}

fn viscosity(value: &str) -> Result<ViscosityKind, String> {
    let sound = |kind: &ViscosityKind| ArtificialViscosity::<1>::problems(kind).is_empty();
    value.parse().ok().filter(sound).ok_or_else(|| {
        let names: Vec<_> = ViscosityKind::ALL.iter().map(ViscosityKind::key).collect();
        format!(
            "it takes one of {}, as name, name:alpha or name:alpha,beta with numbers, 0 or more",
            names.join(", ")
        )
    })
}

/// Whether rods can be made of it: a gas without energy has no stiffness.
fn is_stiff(name: &str) -> bool {
    let sound_speed = |m: meshfree::material::Material<f64>| m.impedance() / m.reference_density();
    material(name)
        .map(sound_speed)
        .is_ok_and(|c| c.is_finite() && c > 1.0)
}

fn solid(value: &str) -> Result<String, String> {
    let found = material(value).ok().filter(|_| is_stiff(value));
    found.map(|material| material.name).ok_or_else(|| {
        let names = catalogue::NAMES.iter().copied();
        let names: Vec<_> = names.filter(|name| is_stiff(name)).collect();
        format!("it takes one of {}", names.join(", "))
    })
}

fn solid_or_wall(value: &str) -> Result<String, String> {
    if value == "wall" {
        return Ok(value.into());
    }
    solid(value).map_err(|takes| takes.replacen("one of", "wall, or one of", 1))
}

fn pad(value: &str) -> Result<(String, f64), String> {
    let (name, length) = value
        .split_once(':')
        .ok_or("it takes MATERIAL:MM, such as pmma:20")?;
    Ok((solid(name)?, 1e-3 * positive(length)?))
}
