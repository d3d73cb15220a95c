//! Running with a progress line, and what is kept of a run: frames for ParaView and pictures.
//! A run stops at the times asked for, and shows the simulation there.

use super::Failure;
use meshfree::error::Error;
use meshfree::output::picture::Picture;
use meshfree::output::progress::Progress;
use meshfree::output::svg::{Axis, Cloud, Panel};
use meshfree::output::vtu::{Pvd, Vtu};
use meshfree::scalar::Real;
use meshfree::simulation::Simulation;
use meshfree::study::cost_model::CostModel;
use std::fmt;
use std::path::Path;
use std::time::{Duration, Instant};

/// What a run cost.
#[derive(Clone, Copy, Debug)]
pub struct Summary {
    pub particles: usize,
    pub steps: u64,
    pub seconds: f64,
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let each = 1e6 * self.seconds / (self.steps.max(1) as f64 * self.particles.max(1) as f64);
        write!(
            f,
            "{} particles, {} steps in {:.1} s ({each:.2} µs a particle and step)",
            self.particles, self.steps, self.seconds
        )
    }
}

/// `count` times from 0 to `until`, both ends among them.
pub fn evenly(until: f64, count: usize) -> Vec<f64> {
    let last = count.max(2) - 1;
    (0..=last).map(|k| until * k as f64 / last as f64).collect()
}

/// Runs to each of the rising `times` \[s\] and shows the simulation there.
///
/// A time that is not ahead, such as the first of [`evenly`], shows the simulation as it is.
pub fn watch<T: Real, const D: usize>(
    label: &str,
    simulation: &mut Simulation<T, D>,
    times: &[f64],
    mut show: impl FnMut(&Simulation<T, D>) -> Result<(), Failure>,
) -> Result<Summary, Failure> {
    let started = Instant::now();
    let mut progress = Progress::new(label);
    let mut model = CostModel::new();
    let end = times.last().copied().unwrap_or(0.0);
    let (from, steps) = (simulation.time(), simulation.steps());
    let span = times.last().map_or(1.0, |end| end - from);
    for &time in times {
        if time > simulation.time() {
            simulation.run_with(time, |now| {
                let done = (now.time() - from) / span;
                if progress.is_due() {
                    model.see(now);
                    let forecast = model.forecast(end);
                    let left = forecast.map(|left| Duration::try_from_secs_f64(left.seconds));
                    if let Ok(Ok(left)) = left {
                        progress.expect(left);
                    }
                }
                progress.update(done, format_args!("t = {:.4} s", now.time()));
            })?;
        }
        show(simulation)?;
    }
    progress.finish();
    Ok(Summary {
        particles: simulation.particles(),
        steps: simulation.steps() - steps,
        seconds: started.elapsed().as_secs_f64(),
    })
}

/// A series of particle files with velocity, pressure and density.
pub struct Movie(Pvd);

impl Movie {
    /// A series that `path`, a `.pvd` file, lists.
    pub fn create(path: impl AsRef<Path>) -> Result<Self, Error> {
        Pvd::create(path).map(Self)
    }
    /// Adds the present state.
    pub fn frame<T: Real, const D: usize>(
        &mut self,
        simulation: &Simulation<T, D>,
    ) -> Result<(), Error> {
        // Single precision is what a picture needs.
        let single = |x: [f64; D]| x.map(|x| x as f32);
        let vtu = Vtu::new(simulation.all().map(|particle| single(particle.position())))
            .vector(
                "velocity_m_s",
                simulation.all().map(|particle| single(particle.velocity())),
            )
            .scalar(
                "pressure_pa",
                simulation.all().map(|particle| particle.pressure() as f32),
            )
            .scalar(
                "density_kg_m3",
                simulation.all().map(|particle| particle.density() as f32),
            )
            .time(simulation.time());
        self.0.frame(simulation.time(), &vtu).map(|_| ())
    }
}

/// Writes a picture as `.svg`, with title and bar, and as `.png`: with the feature `pictures`, and else not.
// It can fail with the feature.
#[cfg_attr(not(feature = "pictures"), allow(clippy::unnecessary_wraps))]
pub fn save_picture(picture: &Picture, path: impl AsRef<Path>) -> Result<(), Error> {
    #[cfg(feature = "pictures")]
    {
        let path = path.as_ref();
        picture.save(path.with_extension("svg"))?;
        picture.save_png(path.with_extension("png"))
    }
    #[cfg(not(feature = "pictures"))]
    {
        static SAID: std::sync::Once = std::sync::Once::new();
        SAID.call_once(|| println!("no pictures: run with --features pictures"));
        let _ = (picture, path.as_ref());
        Ok(())
    }
}

/// What colours particles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shade {
    Pressure,
    Speed,
}

/// Particles as seen along the axis that `axes` leaves out, coloured. In 3D the last ones hide others.
pub fn picture<T: Real, const D: usize>(
    simulation: &Simulation<T, D>,
    shade: Shade,
    axes: [usize; 2],
    spacing: f64,
) -> Panel {
    const NAMES: [&str; 3] = ["x", "y", "z"];
    let value = match shade {
        Shade::Pressure => Axis::linear("pressure", "Pa"),
        Shade::Speed => Axis::linear("speed", "m/s").from(0.0),
    };
    let points = simulation.all().map(|particle| {
        let (x, v) = (particle.position(), particle.velocity());
        let value = match shade {
            Shade::Pressure => particle.pressure(),
            Shade::Speed => v.iter().map(|v| v * v).sum::<f64>().sqrt(),
        };
        (x[axes[0]], x[axes[1]], value)
    });
    let axis = |d: usize| Axis::linear(NAMES.get(d).copied().unwrap_or(""), "m");
    Panel::new(axis(axes[0]), axis(axes[1]))
        .cloud(Cloud::new(value, points).diameter(spacing))
        .equal_aspect()
        .title(&format!("t = {:.4} s", simulation.time()))
}
