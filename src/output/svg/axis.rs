//! Axes: name, unit, scale, range, and ticks at round numbers.
//! A logarithmic axis leaves out what is not positive.

/// One axis of a panel.
///
/// ```
/// use meshfree::output::svg::Axis;
/// let time = Axis::linear("time", "ms").range(0.0, 2.0);
/// let error = Axis::log("L_{1} error of density", "");
/// # let _ = (time, error);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    pub(super) label: String,
    pub(super) log: bool,
    pub(super) low: Option<f64>,
    pub(super) high: Option<f64>,
    pub(super) including: Vec<f64>,
}

impl Axis {
    fn new(name: &str, unit: &str, log: bool) -> Self {
        let label = match unit {
            "" => name.to_string(),
            unit => format!("{name} [{unit}]"),
        };
        Self {
            label,
            log,
            low: None,
            high: None,
            including: Vec::new(),
        }
    }

    /// A linear axis; an empty unit is left out. `^{}` raises and `_{}` lowers.
    ///
    /// ```
    /// # use meshfree::output::svg::Axis;
    /// let density = Axis::linear("density", "kg/m^{3}");
    /// # let _ = density;
    /// ```
    #[must_use]
    pub fn linear(name: &str, unit: &str) -> Self {
        Self::new(name, unit, false)
    }

    /// A logarithmic axis.
    ///
    /// ```
    /// # use meshfree::output::svg::Axis;
    /// let spacing = Axis::log("spacing", "mm");
    /// # let _ = spacing;
    /// ```
    #[must_use]
    pub fn log(name: &str, unit: &str) -> Self {
        Self::new(name, unit, true)
    }

    /// Fixes both ends, which otherwise follow the data.
    ///
    /// ```
    /// # use meshfree::output::svg::Axis;
    /// let x = Axis::linear("x", "m").range(-0.5, 0.5);
    /// # let _ = x;
    /// ```
    #[must_use]
    pub fn range(self, low: f64, high: f64) -> Self {
        self.from(low).to(high)
    }

    /// Fixes the lower end.
    ///
    /// ```
    /// # use meshfree::output::svg::Axis;
    /// let energy = Axis::linear("energy", "J").from(0.0);
    /// # let _ = energy;
    /// ```
    #[must_use]
    pub fn from(mut self, low: f64) -> Self {
        self.low = Some(low);
        self
    }

    /// Fixes the upper end.
    ///
    /// ```
    /// # use meshfree::output::svg::Axis;
    /// let fraction = Axis::linear("fraction", "").to(1.0);
    /// # let _ = fraction;
    /// ```
    #[must_use]
    pub fn to(mut self, high: f64) -> Self {
        self.high = Some(high);
        self
    }

    /// Widens the range that follows the data so that it holds this value.
    ///
    /// ```
    /// # use meshfree::output::svg::Axis;
    /// let pressure = Axis::linear("pressure", "GPa").including(0.0);
    /// # let _ = pressure;
    /// ```
    #[must_use]
    pub fn including(mut self, value: f64) -> Self {
        self.including.push(value);
        self
    }

    /// The scale for these values, with a margin as a fraction of the range at free ends.
    pub(in crate::output) fn scale(&self, values: impl Iterator<Item = f64>, margin: f64) -> Scale {
        let log = self.log;
        let place = move |value: f64| if log { value.log10() } else { value };
        let usable = move |value: &f64| value.is_finite() && (!log || *value > 0.0);
        let (mut low, mut high) = values
            .chain(self.including.iter().copied())
            .filter(usable)
            .map(place)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
                (low.min(v), high.max(v))
            });
        if low > high {
            (low, high) = (0.0, 1.0);
        }
        let least = if log {
            0.05
        } else {
            (1e-7 * low.abs().max(high.abs())).max(1e-300)
        };
        if high - low < least {
            let half = match (log, low == 0.0 && high == 0.0) {
                (true, _) => 0.5,
                (false, true) => 1.0,
                (false, false) => 0.05 * low.abs().max(high.abs()).max(1e-290),
            };
            let middle = 0.5 * (low + high);
            (low, high) = (middle - half, middle + half);
        }
        let room = margin * (high - low);
        let fixed = |end: Option<f64>| end.filter(usable).map(place);
        let (from, to) = (fixed(self.low), fixed(self.high));
        low = from.unwrap_or(low - room);
        high = to.unwrap_or(high + room);
        if high <= low {
            // A fixed end beyond the data, or a range given backwards.
            (low, high) = match (from, to) {
                (Some(a), Some(b)) if a > b => (b, a),
                (None, Some(b)) => (b - b.abs().max(1.0), b),
                _ => (low, low + low.abs().max(1.0)),
            };
        }
        Scale { low, high, log }
    }
}

/// The map from values to places between 0 and 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::output) struct Scale {
    pub(super) low: f64,
    pub(super) high: f64,
    pub(super) log: bool,
}

/// The labelled ticks, the unlabelled ones, and the power of ten that the labels leave out.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::output) struct Ticks {
    pub(in crate::output) major: Vec<(f64, String)>,
    pub(super) minor: Vec<f64>,
    pub(in crate::output) power: i32,
}

impl Scale {
    /// Between 0 and 1 inside the range; not a number where the scale has no place.
    pub(in crate::output) fn place(&self, value: f64) -> f64 {
        let value = match self.log {
            true if value > 0.0 => value.log10(),
            true => f64::NAN,
            false => value,
        };
        (value - self.low) / (self.high - self.low)
    }

    /// About `count` ticks.
    pub(in crate::output) fn ticks(&self, count: f64) -> Ticks {
        let span = self.high - self.low;
        if self.log && span >= 0.9 {
            self.decade_ticks(count)
        } else if self.log {
            let (low, high) = (10_f64.powf(self.low), 10_f64.powf(self.high));
            linear_ticks(low, high, count)
        } else {
            linear_ticks(self.low, self.high, count)
        }
    }

    fn decade_ticks(&self, count: f64) -> Ticks {
        let tolerance = 1e-9 * (self.high - self.low);
        let inside = |place: f64| place >= self.low - tolerance && place <= self.high + tolerance;
        let decades = self.low.floor() as i32..=self.high.ceil() as i32;
        let span = self.high - self.low;
        let every = (span / (1.5 * count)).ceil().max(1.0) as i32;
        // Few decades have room for labels between them.
        let labelled: &[u32] = match span {
            span if span < 1.6 && count >= 3.0 => &[1, 2, 5],
            span if span < 2.2 && count >= 3.0 => &[1, 3],
            _ => &[1],
        };
        let plain = self.low >= -3.3 && self.high <= 4.3 && span < 4.0;
        let mut ticks = Ticks::default();
        for decade in decades {
            for digit in 1..10_u32 {
                let place = f64::from(decade) + f64::from(digit).log10();
                if !inside(place) || (every > 1 && digit > 1) {
                    continue;
                }
                let value = f64::from(digit) * 10_f64.powi(decade);
                if !value.is_normal() {
                    continue;
                }
                if !labelled.contains(&digit) || decade.rem_euclid(every) != 0 {
                    ticks.minor.push(value);
                    continue;
                }
                let label = match (plain, digit) {
                    (true, _) => {
                        let decimals = (-decade).max(0) as usize;
                        format!("{value:.decimals$}")
                    }
                    (false, 1) => format!("10^{{{}}}", signed(&decade.to_string())),
                    _ => format!("{digit}×10^{{{}}}", signed(&decade.to_string())),
                };
                ticks.major.push((value, label));
            }
        }
        ticks
    }
}

/// A true minus sign instead of a hyphen.
pub(super) fn signed(number: &str) -> String {
    number.replace('-', "−")
}

fn linear_ticks(low: f64, high: f64, count: f64) -> Ticks {
    let rough = (high - low) / count.max(1.0);
    let mut exponent = rough.log10().floor();
    let mut digit = match rough / 10_f64.powf(exponent) {
        d if d < 1.5 => 1.0,
        d if d < 3.0 => 2.0,
        d if d < 7.0 => 5.0,
        _ => 10.0,
    };
    if digit == 10.0 {
        digit = 1.0;
        exponent += 1.0;
    }
    let step = digit * 10_f64.powf(exponent);
    let (first, last) = ((low / step - 1e-9).ceil(), (high / step + 1e-9).floor());
    if !step.is_normal() || !first.is_finite() || last - first > 1000.0 {
        return Ticks::default();
    }
    let largest = low.abs().max(high.abs());
    let magnitude = largest.log10();
    let power = if (-2.0..5.0).contains(&magnitude) {
        0
    } else {
        (magnitude / 3.0).floor() as i32 * 3
    };
    let decimals = (f64::from(power) - exponent).max(0.0) as usize;
    let mut ticks = Ticks {
        power,
        ..Ticks::default()
    };
    for index in 0..=(last - first).max(0.0) as usize {
        let multiple = first + index as f64;
        let scaled = multiple * digit * 10_f64.powf(exponent - f64::from(power)) + 0.0;
        let label = signed(&format!("{scaled:.decimals$}"));
        ticks.major.push((multiple * step, label));
    }
    let parts = if digit == 2.0 { 4 } else { 5 };
    let fine = step / f64::from(parts);
    let (first, last) = ((low / fine).ceil() as i64, (high / fine).floor() as i64);
    let minor = (first..=last).filter(|i| i % i64::from(parts) != 0);
    ticks.minor = minor.map(|i| i as f64 * fine).collect();
    ticks
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(ticks: &Ticks) -> Vec<&str> {
        ticks
            .major
            .iter()
            .map(|(_, label)| label.as_str())
            .collect()
    }

    #[test]
    fn ticks_stand_at_round_numbers() {
        assert_eq!(
            labels(&linear_ticks(0.0, 1.0, 5.0)),
            ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]
        );
        assert_eq!(labels(&linear_ticks(-3.0, 7.0, 2.0)), ["0", "5"]);
        assert_eq!(
            labels(&linear_ticks(-1.0, 1.0, 4.0)),
            ["−1.0", "−0.5", "0.0", "0.5", "1.0"]
        );
        let large = linear_ticks(0.0, 2.5e9, 3.0);
        assert_eq!((labels(&large), large.power), (vec!["0", "1", "2"], 9));
        let small = linear_ticks(0.0, 4e-6, 2.0);
        assert_eq!((labels(&small), small.power), (vec!["0", "2", "4"], -6));
    }

    #[test]
    fn logarithmic_ticks_stand_at_decades() {
        let scale = |low, high| Scale {
            low,
            high,
            log: true,
        };
        assert_eq!(
            labels(&scale(-8.0, -5.0).ticks(5.0)),
            ["10^{−8}", "10^{−7}", "10^{−6}", "10^{−5}"]
        );
        assert_eq!(
            labels(&scale(-2.0, -1.0).ticks(5.0)),
            ["0.01", "0.02", "0.05", "0.1"]
        );
        assert_eq!(scale(-8.0, -5.0).ticks(5.0).minor.len(), 24);
        assert_eq!(scale(-30.0, 0.0).ticks(5.0).major.len(), 8);
    }

    #[test]
    fn every_range_can_be_drawn() {
        for log in [false, true] {
            let axis = Axis::new("x", "", log);
            for values in [
                vec![],
                vec![0.0],
                vec![-1.0, -2.0],
                vec![5.0; 3],
                vec![f64::NAN, f64::INFINITY],
                vec![1e-308, 1e308],
                vec![1.0, 1.0 + 1e-15],
            ] {
                let scale = axis.scale(values.iter().copied(), 0.04);
                assert!(scale.low < scale.high, "{values:?}");
                let ticks = scale.ticks(5.0);
                assert!(ticks.major.len() < 20, "{values:?} {ticks:?}");
            }
        }
        let scale = Axis::linear("x", "")
            .range(3.0, 1.0)
            .scale([].into_iter(), 0.0);
        assert_eq!((scale.low, scale.high), (1.0, 3.0));
        assert_eq!(scale.place(2.5), 0.75);
    }
}
