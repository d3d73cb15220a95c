//! The composed pair loop beside one that is written out by hand, kernels and viscosities of a user's own beside those of
//! the crate, and the share of useful lanes. A module of `throughput`, and all of `gate`.

use super::by_hand;
use super::lattice::{H, Lattice, print_ratio, ratios};
use meshfree::kernel::{Kernel, WendlandC4};
use meshfree::neighbors::CHUNK;
use meshfree::particles::{Field, Fields, Output};
use meshfree::prelude::*;
use meshfree::scalar::Lane;
use meshfree::sweep::{FusedKernel, PairSweep, Pass, Records, Results};
use meshfree::term::viscosity::{ArtificialViscosity, MonaghanGingold, Viscous};
use meshfree::term::{self, Pair, PressureForce, TermDoc, Viscosity};

/// The share of lanes with a pair that acts, of those for which terms are evaluated: rows of particles against
/// neighbours that come within the support of any of the row.
fn useful_lanes<T: Real>(side: usize) {
    let lattice = Lattice::<T>::new(side, Fields::NONE);
    let width = <T::Wide<false> as Lane>::WIDTH;
    let positions = lattice.columns.vectors(Field::POSITION);
    let (mut useful, mut evaluated) = (0, 0);
    for (c, chunk) in lattice.lists.chunks().iter().enumerate() {
        for (k, bounds) in chunk.starts.windows(2).enumerate() {
            let first = (c * CHUNK + k) * width;
            for segment in &chunk.segments[bounds[0] as usize..bounds[1] as usize] {
                for &j in &chunk.neighbors[segment.start as usize..segment.end as usize] {
                    let acts = |i: &usize| {
                        let apart = (0..3).map(|d| positions[*i][d] - positions[j as usize][d]);
                        let square: f64 = apart.map(|r| r.to_f64().powi(2)).sum();
                        square < 4.0 * H * H && *i != j as usize
                    };
                    let lanes = (first..first + width).filter(acts).count();
                    useful += lanes;
                    evaluated += if lanes > 0 { width } else { 0 };
                }
            }
        }
    }
    println!(
        "useful lanes, {} × {width}, 3D: {:.2}",
        T::NAME,
        f64::from(useful as u32) / f64::from(evaluated as u32)
    );
}

/// Pressure and an artificial viscosity under a kernel, in one loop.
fn pair_loop<K, V>(kernel: K, viscosity: V) -> FusedKernel<K, (PressureForce, Viscosity<V>)> {
    let terms = (PressureForce, Viscosity(viscosity));
    FusedKernel::new(kernel, terms)
}

/// The Wendland C4 kernel in 3D as a user's crate would write it.
#[derive(Clone, Copy, Debug)]
struct OwnKernel;

impl Kernel<3> for OwnKernel {
    fn name(&self) -> &'static str {
        "own Wendland C4"
    }
    fn support(&self) -> f64 {
        2.0
    }
    fn normalisation(&self) -> f64 {
        495.0 / (256.0 * std::f64::consts::PI)
    }
    fn h_over_dx(&self) -> f64 {
        1.8
    }
    fn h_over_dx_range(&self) -> (f64, f64) {
        (1.3, 2.3)
    }
    fn stable_step(&self) -> f64 {
        1.0
    }
    #[inline(always)]
    fn shape<L: Lane>(&self, q: L) -> L {
        let q = q.min(L::of(2.0));
        let t = q.mul_add(L::of(-0.5), L::one());
        let polynomial = q.mul_add(L::of(35.0 / 12.0), L::of(3.0));
        t.powi(6) * polynomial.mul_add(q, L::one())
    }
    #[inline(always)]
    fn slope_over_q<L: Lane>(&self, q: L) -> L {
        let q = q.min(L::of(2.0));
        let t = q.mul_add(L::of(-0.5), L::one());
        t.powi(5) * q.mul_add(L::of(-35.0 / 3.0), L::of(-14.0 / 3.0))
    }
}

/// The viscosity of Monaghan & Gingold as a user's crate would write it.
#[derive(Clone, Debug)]
struct OwnViscosity {
    alpha: f64,
    beta: f64,
}

impl<const D: usize> ArtificialViscosity<D> for OwnViscosity {
    const READS: Fields = Fields::NONE;
    #[inline(always)]
    fn pair<L: Lane, P: term::Layout>(&self, pair: &Pair<'_, L, D, P>) -> Viscous<L> {
        // Twice the means, and one division: the arithmetic of the crate's own, or the comparison says nothing.
        let sound_speeds = pair.i(Field::SOUND_SPEED) + pair.j(Field::SOUND_SPEED);
        let densities = pair.i(Field::DENSITY) + pair.j(Field::DENSITY);
        let approaching = pair.v_dot_r.lt(L::zero());
        let over_h = pair.r2.mul_add(pair.h.recip(), pair.h * L::of(0.01));
        let quotient = pair.v_dot_r / (over_h * densities);
        let quotient = L::select(approaching, quotient, L::zero());
        let mu = quotient * densities;
        let speed = mu.mul_add(L::of(-2.0 * self.beta), L::of(self.alpha) * sound_speeds);
        Viscous {
            pi: -(quotient * speed),
            signal: speed * L::of(0.3),
        }
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: format!("own viscosity, α = {}, β = {}", self.alpha, self.beta),
            equation: "Π = (−α c̄ μ + β μ²)/ρ̄",
            source: "Monaghan & Gingold 1983",
        }
    }
}

/// What a user's crate writes against the same in the crate, taking turns: at most 1.05.
fn own_against_built_in<T: Real>(side: usize, turns: usize) {
    let against = |what: &str, own: &dyn PairSweep<T, 3>, built_in: &dyn PairSweep<T, 3>| {
        let lattice = Lattice::new(side, own.fields());
        let input = lattice.input();
        let (mut records, mut rows) =
            (Records::default(), [Results::default(), Results::default()]);
        own.pack(Pass::Rates, &input, &mut records);
        let [own_rows, rows] = &mut rows;
        let ratios = ratios(
            turns,
            || own.run(Pass::Rates, &input, &records, own_rows),
            || built_in.run(Pass::Rates, &input, &records, rows),
        );
        let force = |rows: &Results<T, 3>, slot| rows.get(Output::FORCE, 0, slot).to_f64();
        let slots = 0..lattice.columns.slots();
        let largest = slots
            .clone()
            .fold(0.0_f64, |m, slot| m.max(force(rows, slot).abs()));
        for slot in slots {
            let (a, b) = (force(own_rows, slot), force(rows, slot));
            assert!(
                (a - b).abs() < 1e-4 * largest,
                "{what}, slot {slot}: {a} and {b}"
            );
        }
        print!(
            "{what} of one's own over the same in the crate, {}, ",
            T::NAME
        );
        print_ratio(&ratios);
    };
    let (alpha, beta) = (1.0, 2.0);
    let built_in = MonaghanGingold { alpha, beta };
    against(
        "kernel",
        &pair_loop(OwnKernel, built_in),
        &pair_loop(WendlandC4, built_in),
    );
    against(
        "viscosity",
        &pair_loop(WendlandC4, OwnViscosity { alpha, beta }),
        &pair_loop(WendlandC4, built_in),
    );
}

/// Prints all of it: the least that the median ratio of composed to written out may be.
pub fn table(side: usize, turns: usize) -> f64 {
    let ratio = by_hand::forces::with_viscosity(side, turns);
    useful_lanes::<f64>(side);
    useful_lanes::<f32>(side);
    own_against_built_in::<f64>(side, turns);
    own_against_built_in::<f32>(side, turns);
    ratio
}
