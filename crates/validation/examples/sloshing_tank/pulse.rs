//! How the tank is accelerated: the pulses that can be chosen, and records from files.
//! The acceleration is that by which water is thrown at the wall at x = L: the tank's own is the opposite.

use meshfree::boundary::Translation;
use meshfree::error::Error;
use meshfree::study::records::Record;
use std::path::PathBuf;

/// One g \[m/s²\], as peaks are counted.
pub const STANDARD_GRAVITY: f64 = 9.80665;
/// Length of the half sine and of the trapezoid \[s\]; our choice.
const LENGTH: f64 = 0.080;
/// Ramps of the trapezoid \[s\]; our choice.
const RAMP: f64 = 0.005;
/// Straight lines that make the half sine: its speed is right to 2·10⁻⁶.
const PIECES: u32 = 800;

/// A pulse.
#[derive(Clone, Debug, PartialEq)]
pub enum Pulse {
    HalfSine,
    Trapezoid,
    Constant,
    File(PathBuf),
}

impl Pulse {
    /// By its name; anything else is the path of a file.
    pub fn named(name: &str) -> Self {
        match name {
            "half-sine" => Self::HalfSine,
            "trapezoid" => Self::Trapezoid,
            "constant" => Self::Constant,
            path => Self::File(path.strip_prefix("file:").unwrap_or(path).into()),
        }
    }

    pub fn name(&self) -> String {
        match self {
            Self::HalfSine => "half sine of 80 ms".into(),
            Self::Trapezoid => "trapezoid of 80 ms with ramps of 5 ms".into(),
            Self::Constant => "constant".into(),
            Self::File(path) => format!("record {}", path.display()),
        }
    }

    /// Times \[s\] and accelerations \[m/s²\] with a greatest of `peak` \[m/s²\], which a record from a
    /// file does not heed.
    pub fn record(&self, peak: f64) -> Result<Vec<(f64, f64)>, Error> {
        Ok(match self {
            Self::HalfSine => (0..=PIECES)
                .map(|k| f64::from(k) / f64::from(PIECES))
                .map(|s| (LENGTH * s, peak * (core::f64::consts::PI * s).sin()))
                .collect(),
            Self::Trapezoid => vec![
                (0.0, 0.0),
                (RAMP, peak),
                (LENGTH - RAMP, peak),
                (LENGTH, 0.0),
            ],
            Self::Constant => vec![(0.0, peak), (1e3, peak)],
            Self::File(path) => {
                let record = Record::read(path)?;
                let times = record.column("time_s")?;
                let accelerations = record
                    .column("acceleration")
                    .or_else(|_| record.column("acceleration_m_s2"))?;
                times.into_iter().zip(accelerations).collect()
            }
        })
    }

    /// The motion of a tank that is accelerated against its x axis.
    pub fn motion<const D: usize>(&self, peak: f64) -> Result<Translation<D>, Error> {
        let against = |a: f64| core::array::from_fn(|d| if d == 0 { -a } else { 0.0 });
        let record: Vec<_> = self.record(peak)?;
        let record: Vec<_> = record.into_iter().map(|(t, a)| (t, against(a))).collect();
        Translation::from_acceleration(&record)
    }
}
