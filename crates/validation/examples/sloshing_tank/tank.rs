//! The case: a closed tank, part full of water, that is accelerated along its length.
//! What Vesenjak & Ren (2007) do not state is chosen here, and the console says so.

use super::elastic;
use super::pulse::{Pulse, STANDARD_GRAVITY};
use meshfree::effect::ArbitraryLagrangian;
use meshfree::error::{BuildError, Error, Problem};
use meshfree::material::{Liquid, SoundSpeed};
use meshfree::observe::PressureProbe;
use meshfree::prelude::*;
use meshfree::term::viscosity::{MonaghanGingold, Riemann};
use meshfree::term::{Molteni, RiemannDiffusion};

/// Gravity \[m/s²\].
pub const GRAVITY: f64 = 9.81;
/// Density of the water \[kg/m³\].
pub const WATER: f64 = 1000.0;
/// Diameter of a sensor \[m\]; our choice.
const SENSOR: f64 = 0.020;
/// Smoothing length over spacing.
pub const H_OVER_DX: f64 = 1.5;
/// Layers of wall particles that this needs.
pub const LAYERS: usize = 3;
/// Coefficient of the artificial viscosity. It acts as ν = α h c/10, so at the physical sound speed
/// a tenth of the usual 0.02 still is 4·10⁻³ m²/s at 10 mm.
pub const ALPHA: f64 = 0.002;
/// Fewest particles over the depth of the water.
const FEWEST: f64 = 4.0;

/// The form whose particles lie as those of a liquid do: shifting, from a lattice that is displaced. From an even one layers of it
/// stay at the struck wall. `ConsistentShifting` drives one particle in 25 into the walls in three dimensions.
const EVEN: &str = "even";
/// The same places at the start; particles exchange mass on their way.
const ALE: &str = "ale";
/// By how many spacings.
pub const JITTER: f64 = 0.15;

/// The forms of the scheme that can be compared.
pub const SCHEMES: [&str; 11] = [
    EVEN,
    ALE,
    "standard",
    "riemann",
    "shifting",
    "molteni",
    "by-mass",
    "ls-dyna-default",
    "ls-dyna-renormalised",
    "ls-dyna-fluid",
    "ls-dyna-fluid-renormalised",
];

/// The tank and how it is computed.
#[derive(Clone, Debug)]
pub struct Case {
    /// Inner length, width and height \[m\].
    pub size: [f64; 3],
    /// Share of the tank that is full.
    pub fill: f64,
    pub spacing: f64,
    pub pulse: Pulse,
    /// Peak of the pulse in g.
    pub peak_g: f64,
    /// Lowest pressure of water and wall \[Pa\].
    pub cut_off: f64,
    pub sound_speed: SoundSpeed,
    pub scheme: String,
    /// Sensors on the walls \[m\], in the tank's coordinates.
    pub probes: Vec<[f64; 3]>,
    /// Young's modulus \[Pa\] of elastic walls, which are in the frame of the tank; rigid without.
    pub youngs: Option<f64>,
    /// Whether the tank rests and the frame is accelerated.
    pub in_frame: bool,
    pub until: f64,
    /// A fixed step \[s\].
    pub step: Option<f64>,
}

impl Case {
    pub fn depth(&self) -> f64 {
        self.fill * self.size[2]
    }
    /// Greatest acceleration \[m/s²\] of the pulses that have a peak.
    pub fn peak(&self) -> f64 {
        self.peak_g * STANDARD_GRAVITY
    }
    pub fn mass(&self) -> f64 {
        WATER * self.size[0] * self.size[1] * self.depth()
    }

    /// What is wrong with the tank, its probes and its spacing.
    pub fn problems(&self) -> Vec<Problem> {
        let mut problems = Vec::new();
        let mut refuse = |what: String, value: f64, must_be: &'static str| {
            problems.push(Problem::Parameter {
                what,
                value,
                must_be,
            });
        };
        for (name, size) in ["length", "width", "height"].into_iter().zip(self.size) {
            if !(size.is_finite() && size > 0.0) {
                let must_be = "it must be finite and positive, in metres";
                refuse(format!("{name} of the tank"), size, must_be);
            }
        }
        if !(self.fill > 0.0 && self.fill <= 1.0) {
            let must_be = "it must be above 0 and at most 1 (100 %), a share of the tank's volume";
            refuse("fill".into(), self.fill, must_be);
        }
        if !(self.peak_g.is_finite() && self.peak_g >= 0.0) {
            let must_be = "it must be finite and not negative, in g";
            refuse("peak of the pulse".into(), self.peak_g, must_be);
        }
        let least = self.size.into_iter().fold(self.depth(), f64::min);
        if !(self.spacing > 0.0 && self.spacing * FEWEST <= least * (1.0 + 1e-9)) {
            let must_be = "it must be positive and at most a quarter of the depth of the water and of \
                           each side of the tank, in metres: a column of fewer particles has no pressure";
            refuse("spacing".into(), self.spacing, must_be);
        }
        for probe in &self.probes {
            if self.normal(probe).is_none() {
                let outside = (0..3).find(|&d| !(0.0..=self.size[d]).contains(&probe[d]));
                let what = |d: usize| {
                    format!(
                        "coordinate {} of the probe at {probe:?}",
                        "xyz".as_bytes()[d] as char
                    )
                };
                match outside {
                    Some(d) => refuse(
                        what(d),
                        probe[d],
                        "it must be inside of the tank, in metres",
                    ),
                    None => refuse(
                        what(0),
                        probe[0],
                        "the probe must lie on a wall: one coordinate is 0 or the tank's size",
                    ),
                }
            }
        }
        if let Some(youngs) = self.youngs {
            problems.extend(elastic::problems(self, youngs));
        }
        problems
    }

    /// The normal, into the tank, of the wall that a probe is on; `None` if it is on none.
    fn normal(&self, probe: &[f64; 3]) -> Option<[f64; 3]> {
        let near = |x: f64, wall: f64| (x - wall).abs() <= 1e-6 * wall.abs().max(1e-3);
        let inside = (0..3)
            .all(|d| (0.0..=self.size[d]).contains(&probe[d]) || near(probe[d], self.size[d]));
        let wall = (0..3).find_map(|d| {
            let inwards = |sign: f64| core::array::from_fn(|k| if k == d { sign } else { 0.0 });
            if near(probe[d], self.size[d]) {
                Some(inwards(-1.0))
            } else if near(probe[d], 0.0) {
                Some(inwards(1.0))
            } else {
                None
            }
        });
        wall.filter(|_| inside)
    }

    /// The sensors, on the wall that the scene has.
    pub fn sensors<T: Real>(
        &self,
        simulation: &Simulation<T, 3>,
    ) -> Result<Vec<PressureProbe<3>>, Error> {
        let sensor = |probe: &[f64; 3]| {
            let normal = self.normal(probe)?;
            let name = format!("{},{},{}", probe[0], probe[1], probe[2]);
            let sensor = PressureProbe::disc(simulation, &name, *probe, normal, SENSOR);
            // Elastic walls move by a hundredth of a spacing, which a sensor need not follow.
            Some(match self.youngs {
                Some(_) => sensor,
                None => sensor.and_then(|sensor| sensor.on_wall("tank")),
            })
        };
        self.probes.iter().filter_map(sensor).collect()
    }

    /// Builds the simulation.
    pub fn build<T: Real>(&self) -> Result<Simulation<T, 3>, Error> {
        let problems = self.problems();
        if !problems.is_empty() {
            return Err(Error::Build(BuildError { problems }));
        }
        let water = Liquid::water()
            .material::<T>("water", self.sound_speed)
            .with_pressure_cut_off(self.cut_off);
        let surface = [0.0, 0.0, self.depth()];
        let gravity = [0.0, 0.0, -GRAVITY];
        let filled = [self.size[0], self.size[1], self.depth()];
        let water = Body::block("water", water, [0.0; 3], filled, self.spacing)
            .jitter(
                if [EVEN, ALE].contains(&self.scheme.as_str()) {
                    JITTER
                } else {
                    0.0
                },
                1,
            )
            .hydrostatic(gravity, surface);
        let closed = [[true; 2]; 3];
        let tank = Wall::around("tank", [0.0; 3], self.size, self.spacing, LAYERS, closed)
            .container_frame();
        let motion = self.pulse.motion::<3>(self.peak())?;
        let scene = Scene::<T, 3>::new(self.scheme::<T>()?).body(water);
        let step = self.step;
        let scene = scene.steps(|steps| StepControl {
            fixed: step,
            ..steps
        });
        // What the tank does not do the frame does.
        if let Some(youngs) = self.youngs {
            let scene = elastic::add(scene, self, youngs);
            scene.acceleration(in_frame(motion)).build()
        } else if self.in_frame {
            scene.wall(tank).acceleration(in_frame(motion)).build()
        } else {
            let scene = scene.wall(tank.motion(motion));
            scene.acceleration(move |_| gravity).build()
        }
    }

    fn scheme<T: Real>(&self) -> Result<Scheme<T, 3>, Error> {
        let viscosity = MonaghanGingold {
            alpha: ALPHA,
            beta: 0.0,
        };
        let floor = ExtrapolatedPressure {
            floor: self.cut_off,
        };
        let standard = schemes::weakly_compressible()
            .h_over_dx(H_OVER_DX)
            .with_viscosity(viscosity)
            .walls(floor)
            .named(&self.scheme);
        Ok(match self.scheme.as_str() {
            "standard" => standard.with(ExpansionMemory).compose(),
            "riemann" => standard
                .with_viscosity(Riemann::STANDARD)
                .density_diffusion(RiemannDiffusion)
                .with(ExpansionMemory)
                .compose(),
            EVEN | "shifting" => standard
                .with(ExpansionMemory)
                .with(Shifting::STANDARD)
                .compose(),
            ALE => standard
                .with(ExpansionMemory)
                .with(ArbitraryLagrangian::<false>::default())
                .compose(),
            "molteni" => standard
                .density_diffusion(Molteni::default())
                .with(ExpansionMemory)
                .compose(),
            "by-mass" => SchemeBuilder::liquid(WendlandC2, viscosity)
                .h_over_dx(H_OVER_DX)
                .walls(floor)
                .named("by mass, without diffusion")
                .density(DensityForm::ContinuityByMass)
                .compose(),
            "ls-dyna-default" => schemes::ls_dyna_default().walls(floor).compose(),
            "ls-dyna-renormalised" => schemes::ls_dyna_renormalised().walls(floor).compose(),
            "ls-dyna-fluid" => schemes::ls_dyna_fluid().walls(floor).compose(),
            "ls-dyna-fluid-renormalised" => {
                schemes::ls_dyna_fluid_renormalised().walls(floor).compose()
            }
            other => {
                return Err(Error::Argument(Problem::UnknownName {
                    kind: "scheme",
                    name: other.into(),
                    known: SCHEMES.join(", "),
                }));
            }
        })
    }

    /// The lines that say what is ours.
    pub fn choices(&self) -> String {
        let [length, width, height] = self.size;
        let speed = (2.0 * self.peak() * length).sqrt();
        format!(
            "Vesenjak & Ren (2007): closed tank, 60 % water, about 30 g for 80 ms, surface at 38 ms.\n\
             Our choice, which the paper does not state: inner size {length} x {width} x {height} m, depth \
             {depth:.4} m ({mass:.2} kg), pulse {pulse} of {peak} g, Point 1 at 50 mm above the bottom of the \
             wall x = L at mid width, sensors of {sensor} mm. {walls}; pressures are above that of \
             the air.\nGreatest speed expected: sqrt(2 a L) = {speed:.1} m/s. {price}\n",
            depth = self.depth(),
            mass = self.mass(),
            pulse = self.pulse.name(),
            peak = self.peak_g,
            sensor = 1e3 * SENSOR,
            walls = if self.youngs.is_some() {
                "Walls are elastic"
            } else {
                "Walls are rigid"
            },
            price = Liquid::water().price(self.sound_speed, self.spacing, H_OVER_DX),
        )
    }
}

/// What acts on what is in the frame of a tank \[m/s²\].
fn in_frame(motion: Translation<3>) -> impl Fn(f64) -> [f64; 3] + Send + Sync + 'static {
    move |t| {
        let a = motion.pose(t).shift[2];
        [-a[0], -a[1], -a[2] - GRAVITY]
    }
}
