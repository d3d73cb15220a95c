//! The command line: what it accepts, and messages that say what was wrong.
//! A bad option names itself, the value it was given, and what it takes.

use crate::cases::{Case, material};
use crate::choices::{
    ContactChoice, IntegratorChoice, Precision, SchemeChoice, StateChoice, StrengthChoice,
};
use core::fmt;
use meshfree::kernel::{Kernel, KernelKind};
use meshfree::material::catalogue;
use meshfree::term::ArtificialViscosity;
use meshfree::term::viscosity::ViscosityKind;
use std::path::PathBuf;

pub const HELP: &str = "\
Axial impact of rods (Lam, Shen & Gong 2002).

Without options: figures 1 to 7 of the paper, and a table of its claims, into out/rod_impact.
--quick, --out and --threads apply to that too; any other option runs one case.

The case
  --striker MATERIAL        copper
  --target MATERIAL|wall    copper
  --pad MATERIAL:MM         a pad on the striker's head, moving with it
  --speed M/S               20
  --striker-length MM       10
  --target-length MM        40
  --state NAME              hydrodynamic, uniaxial-strain, uniaxial-stress
  --strength on|off         whether rods of the last two yield; on
The method
  --spacing MM              0.05 (--quick: 0.2)
  --scheme NAME             impact, continuity, lam2002; rods that bear shear take continuity
  --kernel NAME             cubic, quartic, quintic, wendland-c2, wendland-c4, wendland-c6, gaussian
  --h-over-dx RATIO         as the kernel recommends
  --integrator NAME         kick-drift-kick, drift-kick-drift, position-verlet, midpoint, ssp-rk3,
                            rk4, lam-fresh, lam-lagged
  --viscosity NAME          mg, limited, signal, balsara, ... or none; mg:0.5 or mg:0.5,1 sets alpha, beta
  --contact NAME            unilateral, bonded
  --precision NAME          f64, f32
  --threads N               all cores
What is written
  --until US                one passage of the waves through the chain
  --probe MM                a material point, by its first distance from the striker's free end
                            (repeatable)
  --snapshot US             (repeatable; the end if none is given)
  --out DIR                 out/rod_impact
Studies
  --bars                    measures every quantity that the method must meet, for all schemes
  --convergence             error of figure 1 against spacing, into docs/ (or --out)
";

/// An option that cannot be followed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BadOption(String);

impl BadOption {
    pub fn value(option: &str, value: &str, accepted: impl fmt::Display) -> Self {
        Self(format!(
            "{option}: `{value}` is not accepted; it takes {accepted}"
        ))
    }
    pub fn conflict(text: String) -> Self {
        Self(text)
    }
}

impl fmt::Display for BadOption {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// What to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Task {
    Help,
    Figures,
    Case,
    Bars,
    Convergence,
}

/// The command line.
#[derive(Clone, Debug)]
pub struct Options {
    pub task: Task,
    pub case: Case,
    pub quick: bool,
    pub threads: Option<usize>,
    pub out: Option<PathBuf>,
}

const TAKES_VALUE: [&str; 20] = [
    "--striker",
    "--target",
    "--pad",
    "--speed",
    "--striker-length",
    "--target-length",
    "--state",
    "--strength",
    "--spacing",
    "--scheme",
    "--kernel",
    "--h-over-dx",
    "--integrator",
    "--viscosity",
    "--contact",
    "--until",
    "--probe",
    "--snapshot",
    "--precision",
    "--threads",
];
const FLAGS: [&str; 4] = ["--quick", "--bars", "--convergence", "--help"];

/// Most particles that a case may have.
const MOST_PARTICLES: f64 = 2e7;

/// Reads the command line, without the program's name.
pub fn parse(arguments: impl IntoIterator<Item = String>) -> Result<Options, BadOption> {
    let mut options = Options {
        task: Task::Figures,
        case: Case::default(),
        quick: false,
        threads: None,
        out: None,
    };
    let (mut spacing, mut until, mut scheme) = (None, None, None);
    let mut arguments = arguments.into_iter();
    while let Some(argument) = arguments.next() {
        let (name, inline) = match argument.split_once('=') {
            Some((name, value)) => (name.to_string(), Some(value.to_string())),
            None => (argument.clone(), None),
        };
        let name = if name == "-h" { "--help".into() } else { name };
        if FLAGS.contains(&name.as_str()) {
            match (name.as_str(), inline) {
                (_, Some(value)) => return Err(BadOption::value(&name, &value, "no value")),
                ("--quick", None) => options.quick = true,
                ("--bars", None) => options.task = Task::Bars,
                ("--convergence", None) => options.task = Task::Convergence,
                _ => options.task = Task::Help,
            }
            if options.task == Task::Help {
                return Ok(options);
            }
            continue;
        }
        if name != "--out" && !TAKES_VALUE.contains(&name.as_str()) {
            let known = [&TAKES_VALUE[..], &["--out"], &FLAGS[..]]
                .concat()
                .join(", ");
            return Err(BadOption(format!(
                "`{argument}` is not an option; there are {known}"
            )));
        }
        let Some(value) = inline.or_else(|| arguments.next()) else {
            return Err(BadOption(format!("{name} needs a value: see --help")));
        };
        if !matches!(name.as_str(), "--out" | "--threads") && options.task == Task::Figures {
            options.task = Task::Case;
        }
        let case = &mut options.case;
        let positive = |unit: &str| number(&name, &value, unit);
        match name.as_str() {
            "--striker" => case.striker = solid(&name, &value)?,
            "--target" if value == "wall" => case.target = None,
            "--target" => case.target = Some(solid(&name, &value)?),
            "--pad" => case.pad = Some(pad(&value)?),
            "--speed" => case.speed = positive("m/s")?,
            "--striker-length" => case.striker_length = 1e-3 * positive("mm")?,
            "--target-length" => case.target_length = 1e-3 * positive("mm")?,
            "--spacing" => spacing = Some(1e-3 * positive("mm")?),
            "--state" => case.state = StateChoice::parse(&value)?,
            "--strength" => case.strength = Some(StrengthChoice::parse(&value)?),
            "--scheme" => scheme = Some(SchemeChoice::parse(&value)?),
            "--kernel" => case.kernel = Some(kernel(&value)?),
            "--h-over-dx" => case.h_over_dx = Some(positive("times the spacing")?),
            "--integrator" => case.integrator = Some(IntegratorChoice::parse(&value)?),
            "--viscosity" => case.viscosity = Some(viscosity(&value)?),
            "--contact" => case.contact = Some(ContactChoice::parse(&value)?),
            "--until" => until = Some(1e-6 * positive("µs")?),
            "--probe" => case.probes.push(1e-3 * not_negative(&name, &value, "mm")?),
            "--snapshot" => case
                .snapshots
                .push(1e-6 * not_negative(&name, &value, "µs")?),
            "--precision" => case.precision = Precision::parse(&value)?,
            "--threads" => options.threads = Some(threads(&value)?),
            _ => options.out = Some(PathBuf::from(value)),
        }
    }
    options.case.spacing = spacing.unwrap_or(if options.quick { 2e-4 } else { 5e-5 });
    options.case.scheme = match (scheme, options.case.bears_shear()) {
        (Some(scheme), _) => scheme,
        (None, true) => SchemeChoice::Continuity,
        (None, false) => SchemeChoice::Impact,
    };
    shear(&options.case)?;
    complete(&mut options.case, until)?;
    Ok(options)
}

/// What does not go with rods that bear shear, and with those that do not.
fn shear(case: &Case) -> Result<(), BadOption> {
    let state = case.state.key();
    if !case.bears_shear() {
        return match case.strength {
            Some(StrengthChoice::On) => Err(BadOption::conflict(format!(
                "--strength: `on` needs shear, which --state {state} has not; take --state uniaxial-strain or \
                 uniaxial-stress"
            ))),
            _ => Ok(()),
        };
    }
    let refuse = |option: &str, value: &str| {
        Err(BadOption::conflict(format!(
            "{option}: `{value}` does not go with --state {state}, which has --scheme continuity with its own kernel \
             and viscosity, and an integrator that kicks; leave it out"
        )))
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
fn complete(case: &mut Case, until: Option<f64>) -> Result<(), BadOption> {
    let transit = |rod: &crate::cases::Rod| {
        material::<f64>(&rod.material).map_or(0.0, |material| {
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
            return Err(BadOption::value(
                "--probe",
                &crate::cases::short(1e3 * probe),
                format!(
                    "a distance within the chain, 0 to {} mm",
                    crate::cases::short(1e3 * length)
                ),
            ));
        }
    }
    for &time in &case.snapshots {
        if time > case.until * (1.0 + 1e-12) {
            return Err(BadOption::value(
                "--snapshot",
                &crate::cases::short(1e6 * time),
                format!(
                    "a time up to --until, {} µs",
                    crate::cases::short(1e6 * case.until)
                ),
            ));
        }
    }
    let spacing = crate::cases::short(1e3 * case.spacing);
    if length / case.spacing > MOST_PARTICLES {
        let least = crate::cases::short(1e3 * length / MOST_PARTICLES);
        return Err(BadOption::value(
            "--spacing",
            &spacing,
            format!("at least {least} mm for this chain (2e7 particles)"),
        ));
    }
    if let Some(rod) = rods.iter().find(|rod| rod.count(case.spacing) < 5.0) {
        let most = crate::cases::short(1e3 * rod.length() / 5.0);
        return Err(BadOption::value(
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
        return Err(BadOption::value(
            "--h-over-dx",
            &ratio.to_string(),
            format!("{low} to {high} for the kernel {kernel}"),
        ));
    }
    let integrator = case.integrator();
    if case.scheme == SchemeChoice::Continuity && !integrator.make().integrates_density() {
        return Err(BadOption::conflict(format!(
            "--integrator: `{}` does not integrate a density, which --scheme continuity has; take \
             another integrator, or --scheme impact or lam2002",
            integrator.key()
        )));
    }
    Ok(())
}

fn finite(option: &str, value: &str, accepted: &str) -> Result<f64, BadOption> {
    let number = value
        .trim()
        .parse::<f64>()
        .ok()
        .filter(|number| number.is_finite());
    number.ok_or_else(|| BadOption::value(option, value, accepted))
}

fn number(option: &str, value: &str, unit: &str) -> Result<f64, BadOption> {
    let accepted = format!("a number above 0, in {unit}");
    let number = finite(option, value, &accepted)?;
    if number > 0.0 {
        Ok(number)
    } else {
        Err(BadOption::value(option, value, accepted))
    }
}

fn not_negative(option: &str, value: &str, unit: &str) -> Result<f64, BadOption> {
    let accepted = format!("a number, 0 or more, in {unit}");
    let number = finite(option, value, &accepted)?;
    if number >= 0.0 {
        Ok(number)
    } else {
        Err(BadOption::value(option, value, accepted))
    }
}

fn threads(value: &str) -> Result<usize, BadOption> {
    let accepted = "a whole number of threads, 1 to 1024";
    let count = value
        .trim()
        .parse()
        .ok()
        .filter(|count| (1..=1024).contains(count));
    count.ok_or_else(|| BadOption::value("--threads", value, accepted))
}

fn kernel(value: &str) -> Result<KernelKind, BadOption> {
    value.parse().map_err(|_| {
        let names: Vec<_> = KernelKind::ALL.iter().map(|kind| kind.key()).collect();
        BadOption::value("--kernel", value, format!("one of {}", names.join(", ")))
    })
}

fn viscosity(value: &str) -> Result<ViscosityKind, BadOption> {
    let sound = |kind: &ViscosityKind| ArtificialViscosity::<1>::problems(kind).is_empty();
    value.parse().ok().filter(sound).ok_or_else(|| {
        let names: Vec<_> = ViscosityKind::ALL.iter().map(ViscosityKind::key).collect();
        let form = "as name, name:alpha or name:alpha,beta with numbers, 0 or more";
        BadOption::value(
            "--viscosity",
            value,
            format!("one of {}, {form}", names.join(", ")),
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

fn solid(option: &str, value: &str) -> Result<String, BadOption> {
    let found = material::<f64>(value).ok().filter(|_| is_stiff(value));
    found.map(|material| material.name).ok_or_else(|| {
        let names: Vec<_> = catalogue::NAMES
            .iter()
            .copied()
            .filter(|name| is_stiff(name))
            .collect();
        let wall = if option == "--target" {
            "wall, or "
        } else {
            ""
        };
        BadOption::value(option, value, format!("{wall}one of {}", names.join(", ")))
    })
}

fn pad(value: &str) -> Result<(String, f64), BadOption> {
    let Some((name, length)) = value.split_once(':') else {
        return Err(BadOption::value(
            "--pad",
            value,
            "MATERIAL:MM, such as pmma:20",
        ));
    };
    Ok((solid("--pad", name)?, 1e-3 * number("--pad", length, "mm")?))
}
