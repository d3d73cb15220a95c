//! Every part of the crate that can be recorded, on the device against the host, with 2000 random inputs.
//! The host follows the record, which has the bits of its loops (`meshfree::effect`, `meshfree::material`, the contract of terms).

#[path = "../common/mod.rs"]
#[allow(dead_code)]
mod common;
mod downstream;
mod laws;
mod materials;
mod table;
mod terms;

use common::Random;
use meshfree::scalar::{Lane, Record, Traced};
use meshfree_gpu::{Device, PointKernel, Precision};

/// How many random inputs a record is given.
const COUNT: usize = 2000;

/// How far the device may be from the host, over the largest value of each result.
fn tolerance(precision: Precision) -> f64 {
    match precision {
        Precision::Single => 1e-5,
        Precision::Double => 1e-12,
    }
}

/// Whether a difference is too large, or no number.
fn exceeds(own: f64, precision: Precision) -> bool {
    own.is_nan() || own > tolerance(precision)
}

/// The largest difference between device and host over the largest value, of all results of a record.
fn difference(
    device: &Device,
    name: &str,
    record: &Record,
    columns: &[Vec<f64>],
    precision: Precision,
) -> f64 {
    let given: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
    let kernel = PointKernel::new(device, name, record, precision);
    let kernel = kernel.unwrap_or_else(|error| panic!("{error}"));
    let found = kernel.run(device, &given).expect("a device that answers");
    let results = record.results().len();
    let mut expected = vec![Vec::new(); results];
    for n in 0..columns[0].len() {
        let own: Vec<f64> = match precision {
            Precision::Double => {
                record.follow(&columns.iter().map(|own| own[n]).collect::<Vec<_>>())
            }
            Precision::Single => {
                let own: Vec<f32> = columns.iter().map(|own| own[n] as f32).collect();
                record.follow(&own).into_iter().map(f64::from).collect()
            }
        };
        for (all, own) in expected.iter_mut().zip(own) {
            all.push(own);
        }
    }
    let mut worst = 0.0f64;
    for (result, (found, expected)) in found.iter().zip(&expected).enumerate() {
        let finite = expected.iter().filter(|own| own.is_finite());
        let largest = finite.fold(0.0f64, |most, own| most.max(own.abs()));
        for (n, (found, expected)) in found.iter().zip(expected).enumerate() {
            if !expected.is_finite() {
                assert!(
                    !found.is_finite(),
                    "{name}, {result} of {n}: {found} {expected}"
                );
                continue;
            }
            let apart = (found - expected).abs();
            let own = if apart == 0.0 { 0.0 } else { apart / largest };
            if exceeds(own, precision) && !exceeds(worst, precision) {
                println!(
                    "{name}, result {result} of {n}, {precision:?}: {found:e} {expected:e} of {largest:e}"
                );
            }
            if worst.is_nan() || own <= worst {
                continue;
            }
            worst = own;
        }
    }
    worst
}

/// What a test has found.
struct Outcome {
    records: usize,
    worst: [(f64, String); 2],
    failed: Vec<String>,
}

impl Outcome {
    fn new() -> Self {
        Self {
            records: 0,
            worst: [(0.0, String::new()), (0.0, String::new())],
            failed: Vec::new(),
        }
    }
    fn check(
        &mut self,
        device: &Device,
        name: &str,
        record: &Record,
        columns: &[Vec<f64>],
        single: bool,
    ) {
        self.records += 1;
        for (n, precision) in [Precision::Double, Precision::Single]
            .into_iter()
            .enumerate()
        {
            if n == 1 && !single {
                continue;
            }
            let own = difference(device, name, record, columns, precision);
            if exceeds(own, precision) {
                self.failed.push(format!("{name}, {precision:?}: {own:e}"));
            }
            if own > self.worst[n].0 {
                self.worst[n] = (own, name.to_owned());
            }
        }
    }
    fn end(self) -> usize {
        let [double, single] = &self.worst;
        println!(
            "{} records; worst {:.1e} in f64 ({}), {:.1e} in f32 ({})",
            self.records, double.0, double.1, single.0, single.1
        );
        assert!(self.failed.is_empty(), "{}", self.failed.join("\n"));
        self.records
    }
}

#[test]
fn elementary_functions_are_those_of_the_host() {
    let Some(device) = common::device("elementary functions") else {
        return;
    };
    let mut random = Random(1);
    let mut outcome = Outcome::new();
    let mut check = |name: &str, low: f64, high: f64, text: fn(Traced) -> Traced| {
        let record = Record::of(1, |given| vec![text(given[0])]).expect("lanes");
        // In shares, so that what is near zero counts as what is large.
        let own = (0..COUNT)
            .map(|_| low + (high - low) * random.next())
            .collect();
        outcome.check(&device, name, &record, &[own], true);
    };
    check("exp", -1.0, 1.0, |x| x.exp());
    check("exp", -60.0, -20.0, |x| x.exp());
    check("exp", 20.0, 60.0, |x| x.exp());
    check("ln", 1e-6, 0.5, |x| x.ln());
    check("ln", 0.5, 2.0, |x| x.ln());
    check("ln", 2.0, 1e9, |x| x.ln());
    check("power 7.15", 0.5, 2.0, |x| x.powf(7.15));
    check("power -2", -3.0, -0.5, |x| x.powf(-2.0));
    check("power 3", -3.0, 3.0, |x| x.powf(3.0));
    check("cube root", -8.0, 8.0, |x| x.cbrt());
    check("sine", -40.0, 40.0, |x| x.sin());
    check("cosine", -40.0, 40.0, |x| x.cos());
    check("arccosine", -1.0, 1.0, |x| x.acos());
    check("arctangent", -9.0, 9.0, |x| x.atan());
    outcome.end();
}

#[test]
fn ends_of_functions_and_constants_without_literals() {
    let Some(device) = common::device("ends of functions") else {
        return;
    };
    let record = Record::of(1, |given| {
        let x = given[0];
        let endless = Traced::splat(f64::INFINITY);
        let undefined = Traced::splat(f64::NAN);
        let all = [
            x.exp(),
            x.ln(),
            x.powf(0.5),
            x.powf(-0.5),
            x.cbrt(),
            x.atan(),
        ];
        all.into_iter()
            .chain([x.min(endless), -endless + x, undefined + x])
            .collect()
    });
    let columns = [vec![0.0, -2000.0, 2000.0, 1.0]];
    let record = record.expect("lanes");
    for precision in [Precision::Double, Precision::Single] {
        let worst = difference(&device, "ends", &record, &columns, precision);
        assert!(worst <= tolerance(precision), "{worst:e}");
    }
}
