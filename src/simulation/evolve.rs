//! What a state consists of, and how its numbers change: by rates, as their declarations say, and with what rounding loses.
//! On slices of columns; which of these change when is in `state`.

use crate::effect::{Evolved, StepProgram, Update, View};
use crate::parallel::{GRAIN, cut, for_each};
use crate::particles::Field;
use crate::scalar::Real;
use crate::sweep::{add_compensated, two_sum};
use crate::tensor::{Symmetric, rotation};

/// Numbers whose rates are on the stack at a time; a whole number of rows of particles of any shape and either scalar. With a
/// quarter as many, looking up what rates read took a twelfth of a step of a solid.
pub(super) const RATES: usize = 2304;

/// Positions, and what their rounding has lost.
pub(super) const POSITIONS: [Field; 2] = [Field::POSITION, Field::POSITION_RESIDUAL];

/// What a state consists of.
pub(super) fn state<T: Real, const D: usize>(
    program: &StepProgram<T, D>,
) -> impl Iterator<Item = Field> {
    let evolved = program.evolved.iter();
    let evolved = evolved.flat_map(|own| core::iter::once(own.field).chain(own.residual));
    POSITIONS
        .into_iter()
        .chain([Field::VELOCITY])
        .chain(evolved)
}

/// dY/dt = g Y + s of some particles from slot `first` on, whose present values are `values`.
pub(super) fn rates<T: Real, const D: usize>(
    own: &Evolved<T, D>,
    view: &View<'_, T, D>,
    first: usize,
    values: &[T],
    rates: &mut [T; RATES],
) {
    let width = own.field.components(D);
    let mut growths = [T::zero(); RATES];
    let growths = &mut growths[..values.len() / width];
    let rates = &mut rates[..values.len()];
    parts(own, view, first, values, growths, rates);
    if own.update == Update::Rotated {
        add_growth(values, growths, rates);
        for (n, rates) in rates.chunks_exact_mut(width).enumerate() {
            let tensor = Symmetric::from_slice(&values[n * width..]);
            let turn = tensor.spun(&view.spin(first + n));
            for (rate, turn) in rates.iter_mut().zip(turn.components()) {
                *rate += *turn;
            }
        }
        return;
    }
    // A length spans a volume.
    let share = match own.update {
        Update::Within { .. } => T::from_f64(D as f64),
        _ => T::one(),
    };
    for (k, rate) in rates.iter_mut().enumerate() {
        *rate = values[k] * growths[k / width] / share + *rate;
    }
}

/// The parts g and s of the rates of some particles.
fn parts<T: Real, const D: usize>(
    own: &Evolved<T, D>,
    view: &View<'_, T, D>,
    first: usize,
    values: &[T],
    growths: &mut [T],
    sources: &mut [T],
) {
    growths.fill(T::zero());
    sources.fill(T::zero());
    for rate in &own.rates {
        let view = view.of_rate(&**rate, own.field);
        rate.growth(&view, first, values, growths);
        rate.source(&view, first, sources);
    }
}

/// s + g Y for tensors, of one growth each.
fn add_growth<T: Real>(values: &[T], growths: &[T], sources: &mut [T]) {
    let width = values.len() / growths.len();
    for (k, source) in sources.iter_mut().enumerate() {
        *source += values[k] * growths[k / width];
    }
}

/// Values of the particles from slot `first` on over `dt` \[s\] as their declaration says; how many were held at a
/// limit.
pub(super) fn update<T: Real, const D: usize>(
    own: &Evolved<T, D>,
    view: &View<'_, T, D>,
    first: usize,
    (column, residual): (&mut [T], &mut [T]),
    dt: T,
) -> u64 {
    let width = own.field.components(D);
    let slots = column.len() / width;
    if slots > GRAIN {
        let half = (slots / GRAIN).div_ceil(2) * GRAIN;
        let kept = residual.len().min(half * width);
        let (low, high) = column.split_at_mut(half * width);
        let (low_residual, high_residual) = residual.split_at_mut(kept);
        let (a, b) = crate::parallel::join(
            || update(own, view, first, (low, low_residual), dt),
            || update(own, view, first + half, (high, high_residual), dt),
        );
        return a + b;
    }
    let (mut growths, mut sources) = ([T::zero(); RATES], [T::zero(); RATES]);
    let mut limited = 0;
    let piece = RATES / width * width;
    for (k, values) in column.chunks_mut(piece).enumerate() {
        let (start, slot) = (k * piece, first + k * piece / width);
        let growths = &mut growths[..values.len() / width];
        let sources = &mut sources[..values.len()];
        parts(own, view, slot, values, growths, sources);
        match own.update {
            Update::Increment => {
                for (k, y) in values.iter_mut().enumerate() {
                    let change = dt * (*y * growths[k / width] + sources[k]);
                    add_compensated(y, residual.get_mut(start + k), change);
                }
            }
            Update::Exponential => {
                for (k, y) in values.iter_mut().enumerate() {
                    let change = *y * expm1(growths[k / width] * dt) + dt * sources[k];
                    add_compensated(y, residual.get_mut(start + k), change);
                }
            }
            Update::Within { smallest, largest } => {
                let [low, high] = [smallest, largest]
                    .map(|limit| T::from_f64(limit * view.around.smoothing_length));
                let dimension = T::from_f64(D as f64);
                for (k, y) in values.iter_mut().enumerate() {
                    let next = *y * (growths[k / width] * dt / dimension).exp();
                    *y = next.max(low).min(high);
                    limited += u64::from(*y != next);
                }
            }
            Update::Rotated => {
                add_growth(values, growths, sources);
                for (n, values) in values.chunks_exact_mut(width).enumerate() {
                    let source = Symmetric::from_slice(&sources[n * width..]);
                    let moved = Symmetric::from_slice(values).plus(dt, &source);
                    let turn = rotation(&(view.spin(slot + n) * dt));
                    values.copy_from_slice(moved.rotated(&turn).components());
                }
            }
        }
    }
    limited
}

/// x ← x + dt v, with the rounding error kept where there is a column for it.
pub(super) fn add_scaled<T: Real>(x: &mut [T], residual: &mut [T], v: &[T], dt: T) {
    if residual.is_empty() {
        for_each(cut(x, GRAIN), |piece, x| {
            for (x, v) in x.iter_mut().zip(&v[piece * GRAIN..]) {
                *x += dt * *v;
            }
        });
        return;
    }
    for_each((cut(x, GRAIN), cut(residual, GRAIN)), |piece, (x, lost)| {
        // Indices into slices of one length are vector instructions, three iterators are not.
        let v = &v[piece * GRAIN..][..x.len()];
        let lost = &mut lost[..x.len()];
        for k in 0..x.len() {
            (x[k], lost[k]) = two_sum(x[k], lost[k] + dt * v[k]);
        }
    });
}

/// x ← a · before + b · x + dt v. Positions and what their rounding has lost, in `f64` where the scalar keeps the loss.
pub(super) fn combine_positions<T: Real>(
    [x, residual, v]: [&mut [T]; 3],
    [before, lost]: [&[T]; 2],
    [a, b, dt]: [f64; 3],
) {
    let v = &*v;
    if residual.is_empty() {
        let (a, b, dt) = (T::from_f64(a), T::from_f64(b), T::from_f64(dt));
        for_each(cut(x, GRAIN), |piece, x| {
            for (n, x) in x.iter_mut().enumerate() {
                let k = piece * GRAIN + n;
                *x = a * before[k] + b * *x + dt * v[k];
            }
        });
        return;
    }
    for_each((cut(x, GRAIN), cut(residual, GRAIN)), |piece, own| {
        let own = own.0.iter_mut().zip(own.1);
        for (n, (x, residual)) in own.enumerate() {
            let k = piece * GRAIN + n;
            let sum = a * (before[k].to_f64() + lost[k].to_f64())
                + b * (x.to_f64() + residual.to_f64())
                + dt * v[k].to_f64();
            *x = T::from_f64(sum);
            *residual = T::from_f64(sum - x.to_f64());
        }
    });
}

/// eˣ − 1 for the small x of a time step, without cancellation.
#[inline(always)]
fn expm1<T: Real>(x: T) -> T {
    if x.abs() > T::from_f64(0.01) {
        return x.exp() - T::one();
    }
    let term = |n: f64| T::from_f64(1.0 / n);
    x * (T::one() + x * (term(2.0) + x * (term(6.0) + x * (term(24.0) + x * term(120.0)))))
}
