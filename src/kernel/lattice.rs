//! Kernel sums over a cubic lattice: what a neighbourhood at rest adds up to.
//! Schemes divide by them, so that liquid at rest has the weight and the space that it should.

use super::Kernel;
use crate::scalar::Lane;

/// −Σ V r·∇W/D over a cubic lattice, by which sums of gradients fall short or exceed.
pub(crate) fn lattice_consistency_factor<K: Kernel<D>, const D: usize>(
    kernel: &K,
    h_over_dx: f64,
) -> f64 {
    let sum = lattice_sum(kernel, h_over_dx, |r| {
        -r * r * Kernel::<D>::slope_over_q(kernel, r / h_over_dx)
    });
    sum / (D as f64 * h_over_dx.powi(2))
}

/// Σ V W over a cubic lattice.
pub(crate) fn lattice_unity<K: Kernel<D>, const D: usize>(kernel: &K, h_over_dx: f64) -> f64 {
    lattice_sum(kernel, h_over_dx, |r| {
        Kernel::<D>::shape(kernel, r / h_over_dx)
    })
}

/// The longest step of an undamped leapfrog, in units of h/c, for longitudinal waves along an axis of a cubic lattice at rest: 2/(h k),
/// where k is the largest of the wave numbers Σ V F x sin(k x) that a difference of neighbours makes. It is one of several limits, so
/// no kernel is stable with more.
pub(crate) fn longest_step<K: Kernel<D>, const D: usize>(kernel: &K, h_over_dx: f64) -> f64 {
    const WAVES: u32 = 256;
    if !has_layers(kernel, h_over_dx) {
        return f64::NAN;
    }
    let sums = slopes_of_layers(kernel, h_over_dx);
    let wave_number = |n: u32| {
        let k = core::f64::consts::PI * f64::from(n) / f64::from(WAVES);
        let layers = sums.iter().enumerate().map(|(n, sum)| {
            let x = (n + 1) as f64;
            2.0 * sum * x * Lane::sin(k * x)
        });
        layers.sum::<f64>().abs()
    };
    let largest = (1..WAVES).map(wave_number).fold(0.0, f64::max);
    2.0 / (h_over_dx * largest)
}

/// Σ V |∇W| of the layers that a row of a lattice lacks at a flat surface, in units of 1/dx: row by row from the surface on.
pub(crate) fn gradients_at_surface<K: Kernel<D>, const D: usize>(
    kernel: &K,
    h_over_dx: f64,
) -> Vec<f64> {
    if !has_layers(kernel, h_over_dx) {
        return Vec::new();
    }
    let slopes = slopes_of_layers(kernel, h_over_dx);
    let beyond = |row: usize| (row..slopes.len()).map(|n| slopes[n] * (n + 1) as f64);
    (0..slopes.len()).map(|row| beyond(row).sum()).collect()
}

/// −V F of all neighbours in each layer of a cubic lattice on one side, in units of the spacing.
fn slopes_of_layers<K: Kernel<D>, const D: usize>(kernel: &K, h_over_dx: f64) -> Vec<f64> {
    let side = (kernel.support() * h_over_dx).ceil() as i64;
    let across = (2 * side + 1).pow(D as u32 - 1);
    let norm = kernel.normalisation() / h_over_dx.powi(D as i32 + 2);
    let of_layer = |layer: i64| -> f64 {
        let slopes = (0..across).map(|k| {
            let offsets = [k % (2 * side + 1), k / (2 * side + 1)];
            let beside = offsets[..D - 1].iter().map(|n| (n - side).pow(2));
            let r2 = (layer * layer + beside.sum::<i64>()) as f64;
            -Kernel::<D>::slope_over_q(kernel, r2.sqrt() / h_over_dx)
        });
        norm * slopes.sum::<f64>()
    };
    (1..=side).map(of_layer).collect()
}

/// Whether a kernel reaches over a number of layers of a lattice that can be summed.
fn has_layers<K: Kernel<D>, const D: usize>(kernel: &K, h_over_dx: f64) -> bool {
    let layers = (kernel.support() * h_over_dx).ceil();
    h_over_dx > 0.0 && (1.0..=MOST_LAYERS).contains(&layers)
}

/// Layers of a lattice that a kernel can reach over.
const MOST_LAYERS: f64 = 32.0;

/// The sum of `of` (distance in spacings) over a cubic lattice, times the kernel's norm for this h.
fn lattice_sum<K: Kernel<D>, const D: usize>(
    kernel: &K,
    h_over_dx: f64,
    of: impl Fn(f64) -> f64,
) -> f64 {
    let reach = (kernel.support() * h_over_dx).ceil();
    // What is no number of layers, or takes minutes to add up, is no number here, and refused with the scene.
    if !(h_over_dx > 0.0 && (1.0..=MOST_LAYERS).contains(&reach)) {
        return f64::NAN;
    }
    let reach = reach as i64;
    let side = (2 * reach + 1) as usize;
    let sum: f64 = (0..side.pow(D as u32))
        .map(|k| {
            let mut rest = k;
            let r2: f64 = (0..D)
                .map(|_| {
                    let offset = (rest % side) as i64 - reach;
                    rest /= side;
                    (offset * offset) as f64
                })
                .sum();
            of(r2.sqrt())
        })
        .sum();
    sum * kernel.normalisation() / h_over_dx.powi(D as i32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::WendlandC2;

    #[test]
    fn the_moment_of_a_lattice_is_that_of_its_sum() {
        // Σ r |dW/dr| / 2 over the unit lattice, with the slope by differences of W.
        for (h_over_dx, expected) in [(1.3, 0.973_921), (1.5, 0.997_399)] {
            let moment = lattice_consistency_factor::<_, 2>(&WendlandC2, h_over_dx);
            assert!((moment - expected).abs() < 1e-6, "{h_over_dx}: {moment}");
        }
        // In a row at h = dx the neighbours at 1 alone count, W' = -5/8 · 3 q (1 - q/2)² = -15/32.
        let row = lattice_consistency_factor::<_, 1>(&WendlandC2, 1.0);
        assert!((row - 15.0 / 16.0).abs() < 1e-15, "{row}");
    }

    #[test]
    fn what_no_lattice_has_is_no_number() {
        for h_over_dx in [-1.0, 0.0, 1e5, 1e39, f64::INFINITY, f64::NAN] {
            assert!(lattice_consistency_factor::<_, 3>(&WendlandC2, h_over_dx).is_nan());
            assert!(lattice_unity::<_, 2>(&WendlandC2, h_over_dx).is_nan());
        }
    }

    #[test]
    fn a_lattice_fills_space_to_a_hundredth() {
        // Sums of the 3D and 2D kernels, added up elsewhere.
        let plane = lattice_unity::<_, 2>(&WendlandC2, 1.5);
        assert!((plane - 1.005_142_340_777).abs() < 1e-12, "{plane}");
        let space = lattice_unity::<_, 3>(&WendlandC2, 1.3);
        assert!((space - 1.009_500_783_785).abs() < 1e-12, "{space}");
    }
}
