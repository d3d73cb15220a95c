//! Viscosity that rises in a shock (Cullen & Dehnen 2010), in cold gas that starts in collision and in a blast of 10⁶:1. Others step too
//! far for it: explicit steps turn neighbours back. The cure is a step that resolves the slope of the law; the control has that of Monaghan.

use super::gas::{density_error, plateau_error, tube};
use super::harness::Row;
use meshfree::particles::{Field, Fields, Outputs};
use meshfree::prelude::*;
use meshfree::scalar::Lane;
use meshfree::term::viscosity::{ArtificialViscosity, CullenDehnen, Switch, Viscous};
use meshfree::term::{Layout, Pair, Sums, TermDoc};

type Law = CullenDehnen;

/// The law whose step sees 0.6 (α c̄ + β |μ|) and not α c̄ + 2 β |μ|.
#[derive(Clone, Copy, Debug)]
struct LongerSteps(Law);

impl ArtificialViscosity<1> for LongerSteps {
    const READS: Fields = <Law as ArtificialViscosity<1>>::READS;
    const WRITES: Outputs = <Law as ArtificialViscosity<1>>::WRITES;
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, 1, P>) -> Viscous<L> {
        let own = self.0.pair(pair);
        let field = Field::VISCOSITY_COEFFICIENT;
        let coefficients = pair.i(field) + pair.j(field);
        let sound_speeds = pair.i(Field::SOUND_SPEED) + pair.j(Field::SOUND_SPEED);
        let linear = coefficients * sound_speeds * L::of(0.25);
        Viscous {
            signal: (own.signal + linear) * L::of(0.3),
            ..own
        }
    }
    #[inline(always)]
    fn sums<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, 1, P>, sums: &mut Sums<L, 1, P>) {
        self.0.sums(pair, sums);
    }
    fn document(&self) -> TermDoc {
        <Law as ArtificialViscosity<1>>::document(&self.0)
    }
    fn switch(&self) -> Option<Switch> {
        <Law as ArtificialViscosity<1>>::switch(&self.0)
    }
}

fn scheme<V: ArtificialViscosity<1>>(viscosity: V) -> Scheme<f64, 1> {
    schemes::gas()
        .with_viscosity(viscosity)
        .smoothing(Smoothing::Consistent {
            smallest: 0.02,
            largest: 50.0,
        })
        .compose()
}

#[test]
fn cold_gas_in_collision_finds_its_plateau() {
    let run = |scheme| {
        let start = |x: f64| (1e-6, -x.signum());
        let mut own = tube(scheme, 5.0 / 3.0, [-1.0, 1.0], 0.005, start);
        own.run_until(0.6).expect("a run");
        println!("{} steps", own.steps());
        plateau_error(&own)
    };
    Row {
        case: "Noh's implosion 1D, 400, Cullen–Dehnen",
        criterion: "mean error of the plateau; control: longer steps",
        value: run(scheme(Law::STANDARD)),
        control: run(scheme(LongerSteps(Law::STANDARD))),
    }
    .at_most(0.01);
}

#[test]
fn a_strong_blast_keeps_its_density() {
    let run = |scheme| {
        let sides = [1e3, 1e-3];
        let start = |x: f64| (if x < 0.0 { sides[0] } else { sides[1] }, 0.0);
        let mut own = tube(scheme, 1.4, [-0.5, 0.5], 0.0025, start);
        own.run_until(0.01).expect("a run");
        println!("{} steps", own.steps());
        density_error(&own, sides)
    };
    Row {
        case: "blast 10⁶:1, 400, Cullen–Dehnen",
        criterion: "L1 error of density; control: longer steps",
        value: run(scheme(Law::STANDARD)),
        control: run(scheme(LongerSteps(Law::STANDARD))),
    }
    .at_most(0.03);
}
