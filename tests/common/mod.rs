//! What the integration tests share: random particle sets, and measures of what a run has done.
#![allow(dead_code)]

pub mod folder;

use meshfree::kernel::{Kernel, KernelKind};
use meshfree::material::eos::IdealGas;
use meshfree::material::{Material, catalogue};
use meshfree::scalar::Lane;
use meshfree::scene::{Body, Start};
use meshfree::simulation::Simulation;

/// A small generator of reproducible numbers (SplitMix64, Steele et al. 2014).
#[derive(Clone, Debug)]
pub struct Random(pub u64);

impl Random {
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }
    /// Between −1 and 1.
    pub fn sign(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
    /// Between 0 and 1.
    pub fn unit(&mut self) -> f64 {
        0.5 * (self.sign() + 1.0)
    }
    pub fn vector<const D: usize>(&mut self, size: f64) -> [f64; D] {
        core::array::from_fn(|_| size * self.sign())
    }
    pub fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }
}

/// A lattice of `counts` points of unit spacing from `corner`, each moved by up to `jitter`.
pub fn jittered<const D: usize>(
    corner: [f64; D],
    counts: [usize; D],
    jitter: f64,
    random: &mut Random,
) -> Vec<[f64; D]> {
    (0..counts.iter().product())
        .map(|k| {
            let mut rest = k;
            core::array::from_fn(|d| {
                let index = rest % counts[d];
                rest /= counts[d];
                corner[d] + index as f64 + 0.5 + jitter * random.sign()
            })
        })
        .collect()
}

/// Five materials from 1.2e3 to 8.9e3 kg/m³.
pub fn material(k: usize) -> Material<f64> {
    let all = [
        catalogue::copper(),
        catalogue::steel(),
        catalogue::aluminium(),
        catalogue::pmma(),
        catalogue::water(),
    ];
    all[k % all.len()].clone()
}

/// Sod's tube from −0.5 to 0.5: `n` particles of unit density on the left, of equal mass on the right.
pub fn shock_tube(n: usize) -> Body<f64, 1> {
    let gas = IdealGas::new(1.4, 1.0);
    let dx = 0.5 / n as f64;
    // Eight times the spacing at an eighth of the density: the same mass.
    let left = (0..n).map(|k| [-0.5 + (k as f64 + 0.5) * dx]);
    let right = (0..n / 8).map(|k| [(k as f64 + 0.5) * 8.0 * dx]);
    let places = left.chain(right).collect();
    Body::points_of("tube", Material::new("gas", gas), places, dx).start(move |x, start| Start {
        energy: if x[0] < 0.0 {
            gas.energy(1.0, 1.0)
        } else {
            gas.energy(0.1, 0.125)
        },
        ..start
    })
}

pub fn kernel(k: usize) -> KernelKind {
    KernelKind::ALL[k % KernelKind::ALL.len()]
}

/// Momentum, and Σ m |v| to compare it with.
pub fn momentum<const D: usize>(simulation: &Simulation<f64, D>) -> ([f64; D], f64) {
    let (mut sum, mut scale) = ([0.0; D], 0.0);
    for particle in simulation.all() {
        for (sum, v) in sum.iter_mut().zip(particle.velocity()) {
            *sum += particle.mass() * v;
            scale += particle.mass() * v.abs();
        }
    }
    (sum, scale)
}

/// Σ m (xₐ v_b − x_b vₐ) for every pair of axes, and Σ m |x| |v| to compare it with.
pub fn angular_momentum<const D: usize>(simulation: &Simulation<f64, D>) -> (Vec<f64>, f64) {
    let mut sum = vec![0.0; D * D];
    let mut scale = 0.0;
    for particle in simulation.all() {
        let (x, v, m) = (particle.position(), particle.velocity(), particle.mass());
        for a in 0..D {
            for b in 0..D {
                sum[a * D + b] += m * (x[a] * v[b] - x[b] * v[a]);
                scale += m * (x[a] * v[b]).abs();
            }
        }
    }
    (sum, scale)
}

/// A rotation matrix from random angles, in any dimension (a product of plane rotations).
pub fn rotation<const D: usize>(random: &mut Random) -> [[f64; D]; D] {
    let mut matrix: [[f64; D]; D] =
        core::array::from_fn(|a| core::array::from_fn(|b| f64::from(u8::from(a == b))));
    for a in 0..D {
        for b in a + 1..D {
            let (sin, cos) = (3.0 * random.sign()).sin_cos();
            for row in &mut matrix {
                (row[a], row[b]) = (cos * row[a] - sin * row[b], sin * row[a] + cos * row[b]);
            }
        }
    }
    matrix
}

pub fn turn<const D: usize>(matrix: &[[f64; D]; D], x: [f64; D]) -> [f64; D] {
    core::array::from_fn(|a| (0..D).map(|b| matrix[a][b] * x[b]).sum())
}

pub fn assert_close(value: f64, expected: f64, tolerance: f64, what: &str) {
    assert!(
        (value - expected).abs() <= tolerance,
        "{what}: {value} instead of {expected} (off by {:.3e}, allowed {tolerance:.3e})",
        value - expected
    );
}

/// A kernel chosen at run time behind calls that are not inlined: one copy of every pair loop serves
/// all kernels, which keeps the tests' compile time down. Tests of speed do not use it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AnyKernel(pub KernelKind);

impl<const D: usize> Kernel<D> for AnyKernel
where
    KernelKind: Kernel<D>,
{
    /// In space on the baseline alone: what wider instructions do is tested in a plane.
    const CHOSEN_AT_RUN_TIME: bool = D == 3;

    fn name(&self) -> &'static str {
        Kernel::<D>::name(&self.0)
    }
    fn support(&self) -> f64 {
        Kernel::<D>::support(&self.0)
    }
    fn normalisation(&self) -> f64 {
        Kernel::<D>::normalisation(&self.0)
    }
    fn h_over_dx(&self) -> f64 {
        Kernel::<D>::h_over_dx(&self.0)
    }
    fn h_over_dx_range(&self) -> (f64, f64) {
        Kernel::<D>::h_over_dx_range(&self.0)
    }
    fn stable_step(&self) -> f64 {
        Kernel::<D>::stable_step(&self.0)
    }
    #[inline(never)]
    fn shape<L: Lane>(&self, q: L) -> L {
        Kernel::<D>::shape(&self.0, q)
    }
    #[inline(never)]
    fn slope_over_q<L: Lane>(&self, q: L) -> L {
        Kernel::<D>::slope_over_q(&self.0, q)
    }
}
