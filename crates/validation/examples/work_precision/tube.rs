//! Sod's shock tube in three dimensions: the same gas on cubic lattices, periodic across the tube.
//! The cross-section is as many spacings wide whatever the spacing, since nothing varies over it.

use super::implosion;
use super::problem::{Problem, Text, sweep};
use meshfree::material::eos::IdealGas;
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::study::sod::Sod;
use meshfree::study::work_precision::{Case, Failure, Outcome, Quantity, relative_l1};

const SOD: Text = Text {
    key: "sod_3d",
    title: "Sod's shock tube in three dimensions",
    setting: "The tube of one dimension with particles of equal mass on cubic lattices, twice as wide on the right, sixteen spacings \
              of the left across between periods. Mean error of density over mean density after 0.2 s.",
    words: include_str!("words/sod_3d.md"),
};
const DENSITY: &str = "density";
/// Spacings of the left across the tube.
const ACROSS: usize = 16;

/// A lattice of so many layers from `start` on \[m\], as wide as the tube.
fn lattice(start: f64, layers: usize, dx: f64, across: usize) -> impl Iterator<Item = [f64; 3]> {
    let cell = move |k: usize| (k as f64 + 0.5) * dx;
    let one = across * across;
    (0..layers * one).map(move |k| {
        [
            start + cell(k / one),
            cell(k / across % across),
            cell(k % across),
        ]
    })
}

fn run(case: &Case<'_>) -> Result<Outcome, Failure> {
    let gas = IdealGas::new(1.4, 1.0);
    let dx = case.spacing();
    let layers = (0.5 / dx).round() as usize;
    let right = lattice(0.0, layers / 2, 2.0 * dx, ACROSS / 2);
    let points = lattice(-0.5, layers, dx, ACROSS).chain(right).collect();
    let tube = Body::points_of("tube", Material::new("gas", gas), points, dx);
    let tube = tube.start(|x, start| Start {
        energy: if x[0] < 0.0 {
            gas.energy(1.0, 1.0)
        } else {
            gas.energy(0.1, 0.125)
        },
        ..start
    });
    let width = ACROSS as f64 * dx;
    let mut tube = Scene::new(implosion::scheme(case)?)
        .body(tube)
        .boundary(MirrorPlane::symmetry([-0.5, 0.0, 0.0], [-1.0, 0.0, 0.0]))
        .boundary(MirrorPlane::symmetry([0.5, 0.0, 0.0], [1.0, 0.0, 0.0]))
        .boundary(Periodic::along(1, 0.0, width))
        .boundary(Periodic::along(2, 0.0, width))
        .build()?;
    tube.run_until(0.2)?;
    let x: Vec<f64> = tube.all().map(|p| p.position()[0]).collect();
    let exact = Sod::new()?.profile(&x, 0.2)?;
    let pairs = tube.all().zip(exact);
    let error =
        relative_l1(pairs.map(|(p, exact)| (p.density(), exact.density, p.mass() / p.density())));
    Ok(Outcome::of(&tube).value(DENSITY, error))
}

pub fn problem(quick: bool) -> Problem {
    let counts: &[u32] = if quick {
        &[16, 24, 32]
    } else {
        &[32, 48, 64, 96]
    };
    let study = sweep(SOD, counts, quick, implosion::methods(), run);
    Problem {
        text: SOD,
        study: study.quantity(Quantity::measured(DENSITY)),
    }
}
