//! Pictures of particles that programs draw.
//! One is a panel of a figure, another a page of its own.

use meshfree::error::Error;
use meshfree::output::picture::Picture;
use meshfree::output::svg::{Axis, Cloud, Panel};
use meshfree::scalar::Real;
use meshfree::simulation::Simulation;
use std::path::Path;

/// `count` numbers from 0 to `end`, both among them.
pub fn evenly(end: f64, count: usize) -> Vec<f64> {
    let last = count.max(2) - 1;
    (0..=last).map(|k| end * k as f64 / last as f64).collect()
}

/// Writes a picture as `.svg`, with title and bar, and as `.png`.
pub fn save_picture(picture: &Picture, path: impl AsRef<Path>) -> Result<(), Error> {
    let path = path.as_ref();
    picture.save(path.with_extension("svg"))?;
    picture.save_png(path.with_extension("png"))
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
    let (scale, unit) = if spacing < 1e-3 {
        (1e3, "mm")
    } else {
        (1.0, "m")
    };
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
        (scale * x[axes[0]], scale * x[axes[1]], value)
    });
    let axis = |d: usize| Axis::linear(NAMES.get(d).copied().unwrap_or(""), unit);
    Panel::new(axis(axes[0]), axis(axes[1]))
        .cloud(Cloud::new(value, points).diameter(scale * spacing))
        .equal_aspect()
        .title(&format!("t = {:.4} s", simulation.time()))
}
