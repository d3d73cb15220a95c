//! How the tank of SPHERIC 10 rolls: as measured, or by the fit of it.
//! Angles are smooth to the second derivative, which the water feels.

use super::common::{Failure, Options};
use super::violent::Choices;
use meshfree::study::records::Record;

/// The record's file.
const RECORD: &str = "spheric10_lateral_water/roll_angle.csv";

/// A roll angle in time, with its first two derivatives \[rad, rad/s, rad/s²\].
pub type Roll = Box<dyn Fn(f64) -> [f64; 3] + Send + Sync>;

/// The fit of the record: 3.99° with a period of 1.637 s, begun within its first period as the machine
/// does. What the first peak meets depends on the begin, so it is for a machine without the record.
fn sine() -> Roll {
    let (amplitude, omega) = (3.99_f64.to_radians(), core::f64::consts::TAU / 1.637);
    let begin = 0.4;
    Box::new(move |t| {
        // 0 → 1 with two continuous derivatives: 10 s³ − 15 s⁴ + 6 s⁵.
        let s = (t / begin).clamp(0.0, 1.0);
        let envelope = [
            s * s * s * (10.0 + s * (6.0 * s - 15.0)),
            30.0 * s * s * (1.0 - s) * (1.0 - s) / begin,
            60.0 * s * (1.0 - s) * (1.0 - 2.0 * s) / (begin * begin),
        ];
        let (sine, cosine) = (omega * t).sin_cos();
        let wave = [sine, omega * cosine, -omega * omega * sine].map(|w| amplitude * w);
        [
            envelope[0] * wave[0],
            envelope[1] * wave[0] + envelope[0] * wave[1],
            envelope[2] * wave[0] + 2.0 * envelope[1] * wave[1] + envelope[0] * wave[2],
        ]
    })
}

/// The measured angle as a smooth function: a cubic B-spline over means over `window` \[s\], which is
/// continuous with its first two derivatives.
///
/// The record keeps 0.0023°, of which a second difference over a sample would make 50 rad/s².
fn smooth(record: &Record) -> Result<Roll, Failure> {
    let window = 0.02;
    let (time, angle) = (record.column("time_s")?, record.column("roll_deg")?);
    let end = time.last().copied().unwrap_or(0.0);
    // Rows stand where the angle changed: a straight line between them is the angle.
    let at = |t: f64| {
        let right = time
            .partition_point(|own| *own < t)
            .clamp(1, time.len() - 1);
        let share = (t - time[right - 1]) / (time[right] - time[right - 1]);
        angle[right - 1] + (angle[right] - angle[right - 1]) * share.clamp(0.0, 1.0)
    };
    let knots = (end / window).floor() as usize;
    let samples = 40;
    let mean = |k: usize| {
        let sum: f64 = (0..samples)
            .map(|n| ((f64::from(n) + 0.5) / f64::from(samples) - 0.5) * 2.0 * window)
            // A triangle, twice the window wide, has no step in its slope.
            .map(|s| (1.0 - (s / window).abs()) * at((k as f64 * window + s).clamp(0.0, end)))
            .sum();
        (2.0 * sum / f64::from(samples)).to_radians()
    };
    let values: Vec<f64> = (0..=knots).map(mean).collect();
    Ok(Box::new(move |t| {
        // The four means that the spline weighs here.
        let u = (t / window).clamp(0.0, (values.len() - 2) as f64);
        let k = (u.floor() as usize).min(values.len() - 2);
        let s = u - k as f64;
        let v = |n: isize| {
            let index = k.saturating_add_signed(n).min(values.len() - 1);
            values[index]
        };
        let [a, b, c, d] = [v(-1), v(0), v(1), v(2)];
        let (s2, s3) = (s * s, s * s * s);
        let angle = ((1.0 - s).powi(3) * a
            + (3.0 * s3 - 6.0 * s2 + 4.0) * b
            + (-3.0 * s3 + 3.0 * s2 + 3.0 * s + 1.0) * c
            + s3 * d)
            / 6.0;
        let rate = (-(1.0 - s).powi(2) * a
            + (3.0 * s2 - 4.0 * s) * b
            + (-3.0 * s2 + 2.0 * s + 1.0) * c
            + s2 * d)
            / (2.0 * window);
        let growth = ((1.0 - s) * a + (3.0 * s - 2.0) * b + (-3.0 * s + 1.0) * c + s * d)
            / (window * window);
        [angle, rate, growth]
    }))
}

/// The roll asked for, with a word on where it comes from.
pub fn asked_for(options: &Options, choices: &Choices) -> Result<(Roll, &'static str), Failure> {
    match options.text("--case") {
        Some("sine") => Ok((sine(), "sine")),
        None | Some("record") => Ok(match choices.records.read(RECORD) {
            Some(record) => (smooth(&record)?, "record"),
            None => (sine(), "sine"),
        }),
        Some(other) => {
            Err(format!("--case: `{other}` is not accepted; it takes record or sine").into())
        }
    }
}
