//! The runs behind the paper's figures: cases 1, 2 and 3, by our scheme and by the paper's.
//! Each run carries the exact linear waves of its own contact law.

use super::Failure;
use super::cases::{Case, short};
use super::choices::SchemeChoice;
use super::options::Options;
use super::parallel::{self, Board};
use super::record::{self, Record, Watch};
use super::theory::{Theory, waves};
use meshfree::study::acoustic_rods::AcousticSolution;

/// The two schemes that are shown side by side.
pub const SCHEMES: [SchemeChoice; 2] = [SchemeChoice::Impact, SchemeChoice::Lam2002];
/// The targets of cases 1 and 2.
pub const TARGETS: [&str; 5] = ["wall", "copper", "steel", "aluminium", "pmma"];
/// The pads of case 3 \[mm\].
pub const PADS: [f64; 3] = [5.0, 10.0, 20.0];

/// Time shown in figures 3 and 4 \[s\].
pub const SHOWN: f64 = 12e-6;
/// Time shown in figures 6 and 7 \[s\].
pub const PAD_SHOWN: f64 = 26e-6;

/// A run and its exact linear waves.
pub struct Run {
    pub label: String,
    pub record: Record,
    pub waves: AcousticSolution,
    /// The Godunov reference under the run's own contact law, where waves are many and it matters
    /// that compressed material carries them faster.
    pub reference: Option<Theory>,
}

/// All runs.
pub struct Runs {
    schemes: Vec<(SchemeChoice, Vec<Run>)>,
    theories: Vec<(String, Theory)>,
}

/// Label of the run with a pad of so many millimetres.
pub fn pad_label(mm: f64) -> String {
    format!("pad {} mm", short(mm))
}

/// The cases with their labels, the longest first.
pub fn cases(scheme: SchemeChoice, spacing: f64) -> Vec<(String, Case)> {
    let base = Case {
        spacing,
        scheme,
        ..Case::default()
    };
    let mut cases: Vec<_> = PADS
        .iter()
        .rev()
        .map(|&mm| {
            let case = Case {
                pad: Some(("pmma".into(), 1e-3 * mm)),
                probes: vec![5e-3, 10e-3 + 0.5e-3 * mm],
                until: PAD_SHOWN,
                ..base.clone()
            };
            (pad_label(mm), case)
        })
        .collect();
    for target in TARGETS.iter().rev() {
        let (until, snapshots) = match *target {
            // Until the far end's echo parts striker and target.
            "pmma" => (32e-6, vec![5.1e-6]),
            "aluminium" | "steel" => (16e-6, vec![5.1e-6]),
            "copper" => (14e-6, vec![5.1e-6, 7.7e-6, 12.8e-6]),
            _ => (SHOWN, vec![]),
        };
        let is_wall = *target == "wall";
        let case = Case {
            target: (!is_wall).then(|| (*target).into()),
            probes: if is_wall {
                vec![5e-3]
            } else {
                vec![5e-3, 15e-3]
            },
            until,
            snapshots,
            ..base.clone()
        };
        cases.push(((*target).into(), case));
    }
    cases
}

impl Runs {
    /// Runs everything.
    pub fn of(options: &Options) -> Result<Self, Failure> {
        let jobs: Vec<(String, Case)> = SCHEMES
            .iter()
            .flat_map(|&scheme| cases(scheme, options.case.spacing))
            .collect();
        let cells = if options.quick { 500 } else { 2000 };
        let weights = jobs
            .iter()
            .map(|(_, case)| case.length() * case.until)
            .collect();
        let board = Board::new("rods", weights);
        let results = parallel::map(&jobs, options.threads, |k, (label, case)| {
            let record = record::run(case, Watch::Every(4), &mut |time| {
                board.update(
                    k,
                    time / case.until,
                    &format!("{}, {label}", case.scheme.key()),
                );
            })?;
            let needed = case.scheme == SchemeChoice::Impact || case.pad.is_some();
            let theory = needed.then(|| Theory::of(case, cells)).transpose()?;
            let run = Run {
                label: label.clone(),
                record,
                waves: waves(case)?,
                reference: theory.clone().filter(|_| case.pad.is_some()),
            };
            Ok((run, theory.filter(|_| case.scheme == SchemeChoice::Impact)))
        })?;
        let mut runs = Self {
            schemes: SCHEMES.iter().map(|&scheme| (scheme, Vec::new())).collect(),
            theories: Vec::new(),
        };
        for (run, theory) in results {
            if let Some(theory) = theory {
                runs.theories.push((run.label.clone(), theory));
            }
            let scheme = run.record.case.scheme;
            if let Some((_, list)) = runs.schemes.iter_mut().find(|(s, _)| *s == scheme) {
                list.push(run);
            }
        }
        Ok(runs)
    }

    pub fn get(&self, scheme: SchemeChoice, label: &str) -> Result<&Run, Failure> {
        let list = self.schemes.iter().find(|(s, _)| *s == scheme);
        let run = list.and_then(|(_, list)| list.iter().find(|run| run.label == label));
        run.ok_or_else(|| format!("no run of {label} by {}", scheme.key()).into())
    }

    /// Theory of a case with a contact that opens.
    pub fn theory(&self, label: &str) -> Result<&Theory, Failure> {
        let found = self.theories.iter().find(|(name, _)| name == label);
        found
            .map(|(_, theory)| theory)
            .ok_or_else(|| format!("no theory of {label}").into())
    }

    pub fn all(&self) -> impl Iterator<Item = &Run> {
        self.schemes.iter().flat_map(|(_, list)| list)
    }
}
