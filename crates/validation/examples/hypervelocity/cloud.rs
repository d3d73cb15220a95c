//! What is measured of an impact: the hole, and the cloud behind it.
//! A cloud is what is behind the plate and fast; the rim of a hole is what is slow.

use super::cases::{Case, off_axis};
use meshfree::effect::Damage;
use meshfree::prelude::*;

/// Speeds over that of the impact: what goes along at more is cloud, and what moves at less is plate.
const CLOUD: f64 = 0.1;
const PLATE: f64 = 0.05;
/// Share of a cloud's mass that may be outside of its length and width.
const STRAY: f64 = 0.005;
/// Sectors of a quarter.
const SECTORS: usize = 9;

/// Lengths \[m\] and speeds \[m/s\] at a time.
pub struct Measured {
    /// Diameter of the hole between the faces of the plate: the mean over sectors of what is nearest to the axis and has not
    /// failed.
    pub hole: f64,
    /// The same with what has failed and still lies at the rim.
    pub clear: f64,
    /// Diameter within which what belongs to the plate stands out from its faces by more than a quarter of its thickness.
    pub lips: f64,
    /// Place of the front behind the plate's back.
    pub front: f64,
    /// Width of the cloud.
    pub width: f64,
    /// Mean speed of the foremost of the cloud.
    pub front_speed: f64,
    /// Mass of the cloud over that of the projectile.
    pub mass: f64,
}

impl Measured {
    /// Of a simulation as it is.
    pub fn of<const D: usize>(now: &Simulation<f64, D>, case: &Case, spacing: f64) -> Self {
        let mut rims = [[f64::INFINITY; SECTORS]; 2];
        let mut lips = 0.0_f64;
        let mut cloud = Vec::new();
        let mut projectile = 0.0;
        for (body, name) in ["projectile", "plate"].into_iter().enumerate() {
            for p in now.body(name).into_iter().flatten() {
                let (x, v) = (p.position(), p.velocity());
                let speed = v.iter().map(|v| v * v).sum::<f64>().sqrt();
                let r = off_axis(&x);
                if body == 0 {
                    projectile += p.mass();
                }
                if v[0] > CLOUD * case.speed && x[0] > case.thickness {
                    cloud.push((x[0] - case.thickness, r, v[0], p.mass()));
                }
                if body == 1 && speed < PLATE * case.speed {
                    let out = (x[0] - 0.5 * case.thickness).abs() - 0.5 * case.thickness;
                    if out < 0.0 {
                        let angle = if D == 3 { x[2].atan2(x[1]) } else { 0.0 };
                        let share = angle / std::f64::consts::FRAC_PI_2;
                        let sector = ((share * SECTORS as f64) as usize).min(SECTORS - 1);
                        let failed = p.scalar(Damage::FAILED).is_some_and(|own| own > 0.0);
                        for rim in &mut rims[usize::from(failed)..] {
                            rim[sector] = rim[sector].min(r);
                        }
                    } else if out > 0.25 * case.thickness {
                        lips = lips.max(r);
                    }
                }
            }
        }
        let [hole, clear] = rims.map(|rim| {
            let seen = || rim.iter().filter(|r| r.is_finite());
            let mean = seen().sum::<f64>() / seen().count().max(1) as f64;
            (2.0 * mean - spacing).max(0.0)
        });
        let mass: f64 = cloud.iter().map(|own| own.3).sum();
        // The foremost and the widest, but for what strays.
        let mut bound = |key: fn(&(f64, f64, f64, f64)) -> f64| {
            cloud.sort_by(|a, b| key(b).total_cmp(&key(a)));
            let (mut passed, mut speed) = (0.0, 0.0);
            for own in &cloud {
                passed += own.3;
                speed += own.2 * own.3;
                if passed > STRAY * mass {
                    return [key(own), speed / passed];
                }
            }
            [0.0; 2]
        };
        let [front, front_speed] = bound(|own| own.0);
        let [half_width, _] = bound(|own| own.1);
        Self {
            hole,
            clear,
            lips: 2.0 * lips,
            front,
            width: 2.0 * half_width,
            front_speed,
            mass: mass / projectile,
        }
    }

    /// Lines of a report, beside what is known.
    pub fn report(&self, case: &Case, dimensions: usize) -> String {
        let known = case.known;
        let ratio = self.front / self.width;
        let beside = |own: f64, its: f64, whose: &str, unit: f64| {
            if its > 0.0 {
                let off = 100.0 * (own / its - 1.0);
                format!(", {whose} {:.2} ({off:+.1} %)", its / unit)
            } else {
                String::new()
            }
        };
        let plane = |k: usize| if dimensions == 2 { known.plane[k] } else { 0.0 };
        format!(
            "diameter of the hole        {:.2} mm{}{}\n\
             clear of what has failed    {:.2} mm\n\
             across the lips             {:.2} mm{}\n\
             length of the cloud         {:.2} mm from the back of the plate\n\
             width of the cloud          {:.2} mm\n\
             length over width           {ratio:.3}{}{}\n\
             speed of the front          {:.3} of that of the impact\n\
             mass of the cloud           {:.3} of the projectile's\n",
            1e3 * self.hole,
            beside(self.hole, known.hole, "measured", 1e-3),
            beside(self.hole, plane(0), "computed by them in a plane", 1e-3),
            1e3 * self.clear,
            1e3 * self.lips,
            beside(self.lips, known.lips, "measured", 1e-3),
            1e3 * self.front,
            1e3 * self.width,
            beside(ratio, known.ratio, "measured", 1.0),
            beside(ratio, plane(1), "computed by them in a plane", 1.0),
            self.front_speed / case.speed,
            self.mass,
        )
    }
}
