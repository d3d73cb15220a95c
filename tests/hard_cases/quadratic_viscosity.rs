//! Viscosity quadratic in the approach, in cold gas that starts in collision and in a blast of 10⁶:1. Others step too far for it: explicit
//! steps turn neighbours back. The cure is a step that resolves the slope of the law; the control has that of Monaghan.

use super::gas::{density_error, plateau_error, tube};
use super::harness::Row;
use meshfree::kernel::WendlandC4;
use meshfree::particles::{Field, Fields, Outputs};
use meshfree::prelude::*;
use meshfree::scalar::Lane;
use meshfree::sweep::Interaction;
use meshfree::term::viscosity::{
    ArtificialViscosity, CullenDehnen, MonaghanGingold, SwitchObject, Viscous,
};
use meshfree::term::{Layout, Pair, Sums, TermDoc};

/// A law whose step sees 0.6 (α c̄ + β |μ|) and not 0.6 α c̄ + 2 β |μ|.
#[derive(Clone, Copy, Debug)]
struct LongerSteps<V> {
    law: V,
    /// None if each particle has its own.
    alpha: Option<f64>,
}

impl<V: ArtificialViscosity<1>> ArtificialViscosity<1> for LongerSteps<V> {
    const READS: Fields = V::READS;
    const WRITES: Outputs = V::WRITES;
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, 1, P>) -> Viscous<L> {
        let own = self.law.pair(pair);
        let both = |field| pair.i(field) + pair.j(field);
        let twice_alpha = match self.alpha {
            Some(alpha) => L::of(2.0 * alpha),
            None => both(Field::VISCOSITY_COEFFICIENT),
        };
        let linear = twice_alpha * both(Field::SOUND_SPEED) * L::of(0.25);
        Viscous {
            signal: own.signal.mul_add(L::of(0.3), linear * L::of(0.42)),
            ..own
        }
    }
    #[inline(always)]
    fn sums<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, 1, P>, sums: &mut Sums<L, 1, P>) {
        self.law.sums(pair, sums);
    }
    fn document(&self) -> TermDoc {
        self.law.document()
    }
    fn switch(&self) -> Option<Box<dyn SwitchObject>> {
        self.law.switch()
    }
}

fn scheme<V: ArtificialViscosity<1>>(viscosity: V) -> Scheme<f64, 1> {
    SchemeBuilder::new(WendlandC4, viscosity)
        .density(DensityForm::Summation)
        .between_bodies(Interaction::Bonded)
        .with(ConsistentSmoothing {
            smallest: 0.02,
            largest: 50.0,
        })
        .compose()
}

/// Mean error of the plateau of cold gas that runs into itself.
fn collision(scheme: Scheme<f64, 1>) -> f64 {
    let start = |x: f64| (1e-6, -x.signum());
    let mut own = tube(scheme, 5.0 / 3.0, [-1.0, 1.0], 0.005, start);
    own.run_until(0.6).expect("a run");
    println!("{} steps", own.steps());
    plateau_error(&own)
}

/// L1 error of the density of a blast.
fn blast(scheme: Scheme<f64, 1>) -> f64 {
    let sides = [1e3, 1e-3];
    let start = |x: f64| (if x < 0.0 { sides[0] } else { sides[1] }, 0.0);
    let mut own = tube(scheme, 1.4, [-0.5, 0.5], 0.0025, start);
    own.run_until(0.01).expect("a run");
    println!("{} steps", own.steps());
    density_error(&own, sides)
}

/// A law, and the same with longer steps.
fn both<V: ArtificialViscosity<1>>(
    law: V,
    alpha: Option<f64>,
    run: fn(Scheme<f64, 1>) -> f64,
) -> [f64; 2] {
    let longer = LongerSteps {
        law: law.clone(),
        alpha,
    };
    [run(scheme(law)), run(scheme(longer))]
}

fn row(case: &'static str, criterion: &'static str, [value, control]: [f64; 2]) -> Row {
    Row {
        case,
        criterion,
        value,
        control,
    }
}

#[test]
fn cold_gas_in_collision_finds_its_plateau() {
    let criterion = "mean error of the plateau; control: longer steps";
    let own = both(CullenDehnen::STANDARD, None, collision);
    row("Noh's implosion 1D, 400, Cullen–Dehnen", criterion, own).at_most(0.01);
    for (case, alpha) in [
        ("Noh's implosion 1D, 400, Monaghan–Gingold 1, 2", 1.0),
        ("Noh's implosion 1D, 400, Monaghan–Gingold 2, 4", 2.0),
    ] {
        let law = MonaghanGingold {
            alpha,
            beta: 2.0 * alpha,
        };
        row(case, criterion, both(law, Some(alpha), collision)).at_most(0.01);
    }
}

#[test]
fn a_strong_blast_keeps_its_density() {
    let own = both(CullenDehnen::STANDARD, None, blast);
    let criterion = "L1 error of density; control: longer steps";
    row("blast 10⁶:1, 400, Cullen–Dehnen", criterion, own).at_most(0.03);
}
