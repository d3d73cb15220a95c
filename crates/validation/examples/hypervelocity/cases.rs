//! The two impacts: what strikes what, how fast, and what is known of the outcome.
//! Hiermaier et al. 1997 and Howell & Ball 2002.

use super::common::{Failure, Options};
use meshfree::material::eos::Tillotson;
use meshfree::material::failure::SpallStrength;
use meshfree::prelude::*;

/// What others have of an impact \[m\], zero where nothing is known.
#[derive(Clone, Copy, Debug, Default)]
pub struct Known {
    /// Diameter of the hole, measured.
    pub hole: f64,
    /// The same across its lips.
    pub lips: f64,
    /// Length over width of the cloud, measured.
    pub ratio: f64,
    /// Hole and ratio of the SPH in a plane of those who measured.
    pub plane: [f64; 2],
}

/// An impact along the first axis; the plate lies between 0 and its thickness.
pub struct Case {
    pub about: &'static str,
    pub projectile: Material<f64>,
    pub target: Material<f64>,
    /// Diameter of sphere or cylinder \[m\].
    pub diameter: f64,
    /// Thickness of the plate \[m\].
    pub thickness: f64,
    /// Half of the side of the slab, or the radius of the plate \[m\].
    pub reach: f64,
    /// Speed \[m/s\].
    pub speed: f64,
    /// Time at which it is looked at.
    pub microseconds: f64,
    pub known: Known,
}

/// Spall strengths \[Pa\]: of the order of what plate impacts give, 1 to 1.5 GPa for 6061-T6 and 2 to 3 GPa for steels.
/// Neither source says what it took.
const ALUMINIUM_SPALLS: f64 = 1.2e9;
const STEEL_SPALLS: f64 = 2.5e9;

impl Case {
    /// The case of `--case`.
    pub fn of(options: &Options) -> Result<Self, Failure> {
        match options.text("--case").unwrap_or("hiermaier") {
            "hiermaier" => {
                let metal = || {
                    catalogue::aluminium_6061_t6()
                        .with_eos(Tillotson::aluminium())
                        .with_failure(SpallStrength::new(ALUMINIUM_SPALLS))
                };
                Ok(Self {
                    about: "aluminium on aluminium at 6.18 km/s (Hiermaier et al. 1997)",
                    projectile: metal(),
                    target: metal(),
                    diameter: 10e-3,
                    thickness: 4e-3,
                    reach: 40e-3,
                    speed: 6180.0,
                    microseconds: 20.0,
                    known: Known {
                        hole: 27.5e-3,
                        lips: 34.5e-3,
                        ratio: 1.39,
                        plane: [35e-3, 1.11],
                    },
                })
            }
            // Thickness and time are those of the example of PySPH after this paper.
            "howell" => Ok(Self {
                about: "steel on aluminium at 3.1 km/s (Howell & Ball 2002)",
                projectile: catalogue::hypervelocity_steel()
                    .with_failure(SpallStrength::new(STEEL_SPALLS)),
                target: catalogue::hypervelocity_aluminium()
                    .with_failure(SpallStrength::new(ALUMINIUM_SPALLS)),
                diameter: 10e-3,
                thickness: 2e-3,
                reach: 20e-3,
                speed: 3100.0,
                microseconds: 8.0,
                known: Known::default(),
            }),
            other => Err(format!(
                "--case: `{other}` is not accepted; it takes hiermaier or howell"
            )
            .into()),
        }
    }

    /// The part of a lattice on the positive side of the planes of symmetry.
    fn lattice<const D: usize>(
        [low, high]: [f64; 2],
        reach: f64,
        spacing: f64,
        inside: impl Fn(f64, f64) -> bool,
    ) -> Vec<[f64; D]> {
        let along = ((high - low) / spacing).round().max(1.0);
        let across = (reach / spacing).ceil() as usize;
        let others = across.pow(D as u32 - 1);
        let mut points = Vec::new();
        for layer in 0..along as usize {
            for n in 0..others {
                let mut point = [low + (layer as f64 + 0.5) * (high - low) / along; D];
                for (axis, x) in point.iter_mut().enumerate().skip(1) {
                    let place = n / across.pow(axis as u32 - 1) % across;
                    *x = (place as f64 + 0.5) * spacing;
                }
                if inside(point[0], off_axis(&point)) {
                    points.push(point);
                }
            }
        }
        points
    }

    /// What strikes, a spacing before the plate.
    pub fn projectile<const D: usize>(&self, spacing: f64) -> Body<f64, D> {
        let radius = 0.5 * self.diameter;
        let ends = [-self.diameter - 0.5 * spacing, -0.5 * spacing];
        let centre = 0.5 * (ends[0] + ends[1]);
        let points = Self::lattice(ends, radius, spacing, |x, r| (x - centre).hypot(r) < radius);
        let mut velocity = [0.0; D];
        velocity[0] = self.speed;
        Body::points_of("projectile", self.projectile.clone(), points, spacing).velocity(velocity)
    }

    /// What is struck.
    pub fn plate<const D: usize>(&self, spacing: f64) -> Body<f64, D> {
        let ends = [0.0, self.thickness];
        let points = Self::lattice(ends, self.reach, spacing, |_, r| r < self.reach);
        Body::points_of("plate", self.target.clone(), points, spacing)
    }
}

/// Distance from the axis of the impact \[m\].
pub fn off_axis<const D: usize>(point: &[f64; D]) -> f64 {
    point[1..].iter().map(|x| x * x).sum::<f64>().sqrt()
}
