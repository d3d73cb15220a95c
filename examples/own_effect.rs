//! An effect of your own: a dye that diffuses in a rod, next to the exact decay. It shows a field, a term between pairs, how the
//! field evolves, a limit of the step and a column of the ledger.
//! `cargo run --release --example own_effect` leaves a picture, a table and files for ParaView in `out/own_effect`.

use meshfree::effect::{BySum, Evolved, LedgerColumn, Limit, Setting, StepProgram, View};
use meshfree::name;
use meshfree::particles::{Output, Outputs};
use meshfree::prelude::*;
use meshfree::run::{Failure, Run, Schedule};
use meshfree::term::{In, Layout, Pair, Sums, Term, TermDoc, stage};
use std::f64::consts::PI;

/// A dye of concentration c that diffuses, dc/dt = κ ∇²c.
#[derive(Clone, Copy, Debug)]
struct Diffusion {
    /// κ \[m²/s\].
    diffusivity: f64,
}

const DYE: Field = Field::scalar(name!("dye", "1"));
const FLOW: Output = Output::scalar(name!("flow", "kg/s"));

impl<const D: usize> Effect<D> for Diffusion {
    type Terms = (In<stage::Rates, Diffusion>,);
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(*self),)
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.declare(DYE, 0.0);
        program.evolve(Evolved::kicked(DYE).by(BySum::over_mass(FLOW)));
        program.limit(*self);
        program.ledger(LedgerColumn {
            name: "dye",
            unit: "kg",
            field: DYE,
            times_mass: true,
            factor: 1.0,
        });
    }
}

/// What flows between two particles, after Cleary & Monaghan (1999).
impl<const D: usize> Term<D> for Diffusion {
    const NAME: &'static str = "own::diffusion";
    const READS: Fields = Fields::of(&[DYE, Field::MASS, Field::DENSITY]);
    const WRITES: Outputs = Outputs::of(&[FLOW]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let masses = pair.i(Field::MASS) * pair.j(Field::MASS);
        let density = (pair.i(Field::DENSITY) + pair.j(Field::DENSITY)) * L::of(0.5);
        let jump = pair.i(DYE) - pair.j(DYE);
        let factor = L::of(2.0 * self.diffusivity);
        sums.add(FLOW, factor * masses * jump * pair.f / density);
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: format!("diffusion, κ = {} m²/s", self.diffusivity),
            equation: "mᵢ dcᵢ/dt = Σⱼ mᵢ mⱼ 2κ (cᵢ − cⱼ) F/ρ̄",
            source: "Cleary & Monaghan 1999",
        }
    }
}

/// Without a limit of the step a fast diffusion would overflow.
impl<T: Real, const D: usize> Limit<T, D> for Diffusion {
    fn name(&self) -> &'static str {
        "diffusion: 0.08 h²/κ"
    }
    fn reads(&self) -> Fields {
        Fields::NONE
    }
    fn step(&self, at: &View<'_, T, D>, _slot: usize) -> f64 {
        0.08 * at.around.smoothing_length.powi(2) / self.diffusivity
    }
}

pub(crate) fn main() -> Result<(), Failure> {
    let (length, diffusivity) = (0.02, 5.0);
    let wave = move |x: f64| (PI * x / length).cos();
    let rod = Body::block("rod", catalogue::copper(), [0.0], [length], 2e-4);
    let rod = rod.field(DYE, move |[x]| [0.5 + 0.5 * wave(x)]);
    let mut rod = Scene::<f64, 1>::new(schemes::impact().with(Diffusion { diffusivity }))
        .body(rod)
        .build()?;
    let [x, y] = [Axis::linear("x", "mm"), Axis::linear("dye", "1")];
    let mut panel = Panel::new(x, y);
    let mut table = CsvWriter::create("out/own_effect/dye.csv", &["time_s", "x_m", "dye"])?;
    let times = [0.0, 4e-6, 8e-6, 16e-6];
    let mut series = Vec::new();
    let summary = Run::new(&mut rod, times[3])
        .observe(Schedule::at(times), |now| {
            let decay = (-diffusivity * (PI / length).powi(2) * now.time()).exp();
            let dye = now
                .all()
                .map(|p| (p.position()[0], p.scalar(DYE).unwrap_or(0.0)));
            let points: Vec<_> = dye.collect();
            table.rows(points.iter().map(|(x, dye)| [now.time(), *x, *dye]))?;
            let exact = points
                .iter()
                .map(|(x, _)| (1e3 * x, 0.5 + 0.5 * decay * wave(*x)));
            series.push(Series::line("", exact).reference());
            let shown = points.iter().map(|(x, dye)| (1e3 * x, *dye));
            series.push(Series::markers(
                &format!("{:.0} µs", 1e6 * now.time()),
                shown,
            ));
            Ok(())
        })
        .paraview(Schedule::evenly(9), "out/own_effect/rod.pvd")
        .go()?;
    panel = series.into_iter().fold(panel, Panel::series);
    Figure::new().panel(panel).save("out/own_effect/dye.svg")?;
    println!("{summary}\nwritten to out/own_effect");
    Ok(())
}
