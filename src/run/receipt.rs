//! The receipt of a run, in JSON: scene and machine, predicted and actual cost, error indicators, ledger.
//! It ends with a hash of the bits, by which two runs compare.

use super::Summary;
use crate::error::Error;
use crate::output::json::{json_list, json_number, json_object, json_text, processor};
use crate::scalar::Real;
use crate::simulation::{Budget, Simulation, Spread, Work};

/// What a receipt is of.
pub(super) struct Receipt<'a, T: Real, const D: usize> {
    pub now: &'a Simulation<T, D>,
    pub label: Option<&'a str>,
    /// What the run was to take.
    pub expected: Work,
    /// What had been done before it.
    pub first: Work,
    pub outcome: Result<&'a Summary, &'a Error>,
}

impl<T: Real, const D: usize> Receipt<'_, T, D> {
    /// The file, a line for each part.
    pub fn json(&self) -> String {
        let now = self.now;
        let (end, wall) = match self.outcome {
            Ok(summary) => (
                json_object([
                    ("why", json_text(&summary.end.to_string())),
                    ("early", summary.end.is_early().to_string()),
                    ("failed", "false".into()),
                ]),
                json_number(summary.seconds),
            ),
            Err(error) => (
                json_object([
                    ("why", json_text(&error.to_string())),
                    ("early", "true".into()),
                    ("failed", "true".into()),
                ]),
                "null".into(),
            ),
        };
        let parts = [
            ("label", self.label.map_or("null".into(), json_text)),
            ("version", json_text(env!("CARGO_PKG_VERSION"))),
            ("scene", self.scene()),
            ("fingerprint", self.fingerprint()),
            ("machine", self.machine()),
            ("time_s", json_number(now.time())),
            ("end", end),
            ("predicted", work(&self.expected)),
            ("actual", work(&since(now.work(), &self.first))),
            ("wall_clock_s", wall),
            ("indicators", self.indicators()),
            (
                "limits_applied",
                json_object(
                    now.limits()
                        .iter()
                        .map(|(name, count)| (*name, count.to_string())),
                ),
            ),
            ("ledger", self.ledger()),
            ("bits_hash", json_text(&format!("{:016x}", now.bits_hash()))),
        ];
        let lines = parts.map(|(name, value)| format!("  {}: {value}", json_text(name)));
        format!("{{\n{}\n}}\n", lines.join(",\n"))
    }

    fn scene(&self) -> String {
        let now = self.now;
        let bodies = now.bodies().enumerate().map(|(k, name)| {
            let particles = now.body(k).map_or(0, Iterator::count);
            let mut parts = vec![
                ("name", json_text(name)),
                ("particles", particles.to_string()),
            ];
            if let Ok((material, spacing)) = now.material_and_spacing(k) {
                parts.push(("material", json_text(&material.name)));
                parts.push(("spacing_m", json_number(spacing)));
            }
            json_object(parts)
        });
        let walls = now.walls().enumerate().map(|(k, name)| {
            let particles = now.wall(k).map_or(0, Iterator::count);
            json_object([
                ("name", json_text(name)),
                ("particles", particles.to_string()),
            ])
        });
        let boundaries = now.boundaries().iter();
        json_object([
            ("dimensions", D.to_string()),
            ("scalar", json_text(T::NAME)),
            (
                "schemes",
                json_list(now.schemes().map(|own| json_text(own.name()))),
            ),
            ("integrator", json_text(&now.integrator_name())),
            ("bodies", json_list(bodies)),
            ("walls", json_list(walls)),
            (
                "boundaries",
                json_list(boundaries.map(|own| json_text(&own.name()))),
            ),
        ])
    }

    /// The hashes by which checkpoints know the scene.
    fn fingerprint(&self) -> String {
        #[cfg(feature = "checkpoint")]
        return json_object(
            self.now
                .scene
                .iter()
                .map(|(part, hash)| (*part, json_text(&format!("{hash:016x}")))),
        );
        #[cfg(not(feature = "checkpoint"))]
        "null".into()
    }

    fn machine(&self) -> String {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        json_object([
            ("architecture", json_text(std::env::consts::ARCH)),
            ("processor", json_text(&processor())),
            ("cores", cores.to_string()),
            ("threads", crate::parallel::threads().to_string()),
            (
                "instructions",
                json_text(&format!("{:?}", self.now.instructions())),
            ),
        ])
    }

    fn indicators(&self) -> String {
        if self.outcome.is_err() {
            return "null".into();
        }
        let all = self.now.indicators();
        let spread = |own: &Option<Spread>| {
            own.as_ref().map_or("null".into(), |own| {
                json_object([
                    ("median", json_number(own.median)),
                    ("worst", json_number(own.worst.value)),
                ])
            })
        };
        json_object([
            ("particles", all.particles.to_string()),
            ("inside", all.inside.to_string()),
            ("unity", spread(&all.unity)),
            ("gradient", spread(&all.gradient)),
            ("disorder", spread(&all.disorder)),
            ("density", spread(&all.density)),
            ("drift", all.drift.map_or("null".into(), json_number)),
            ("fronts", spread(&all.fronts)),
            ("layers", spread(&all.layers)),
            (
                "limited_by",
                json_list(all.limits.iter().map(|own| json_text(&own.to_string()))),
            ),
        ])
    }

    fn ledger(&self) -> String {
        let ledger = self.now.ledger();
        let bodies = ledger.bodies.iter().map(|(name, own)| (name, budget(own)));
        json_object([
            ("whole", budget(&ledger.whole)),
            ("bodies", json_object(bodies)),
            ("boundary_impulse_kg_m_s", numbers(&ledger.boundary_impulse)),
            ("law_impulse_kg_m_s", numbers(&ledger.law_impulse)),
            ("joint_impulse_kg_m_s", numbers(&ledger.joint_impulse)),
        ])
    }
}

fn numbers(all: &[f64]) -> String {
    json_list(all.iter().map(|own| json_number(*own)))
}

fn budget(own: &Budget) -> String {
    let totals = own.totals.iter();
    let totals = totals.map(|total| {
        (
            format!("{} [{}]", total.name, total.unit),
            json_number(total.value),
        )
    });
    json_object([
        ("mass_kg", json_number(own.mass)),
        ("momentum_kg_m_s", numbers(&own.momentum)),
        ("kinetic_j", json_number(own.kinetic)),
        ("internal_j", json_number(own.internal)),
        ("totals", json_object(totals)),
    ])
}

/// What was done after `first`.
fn since(now: Work, first: &Work) -> Work {
    Work {
        steps: now.steps - first.steps,
        evaluations: now.evaluations - first.evaluations,
        list_builds: now.list_builds - first.list_builds,
        pairs: now.pairs - first.pairs,
        time: now.time.saturating_sub(first.time),
        ..now
    }
}

fn work(own: &Work) -> String {
    json_object([
        ("particles", own.particles.to_string()),
        ("steps", own.steps.to_string()),
        ("evaluations", own.evaluations.to_string()),
        ("list_builds", own.list_builds.to_string()),
        ("pairs", own.pairs.to_string()),
        ("bytes", own.bytes.to_string()),
        ("seconds", json_number(own.time.as_secs_f64())),
    ])
}
