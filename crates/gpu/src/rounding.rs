//! Whether a driver keeps what the rounding of a sum loses, as places in `f32` need it.
//! It is tried, since a driver may reassociate.

use crate::{Device, Error, PointKernel, Precision};
use meshfree::scalar::Record;

/// Refuses a driver that does not keep what the rounding of a sum loses (Knuth's two-sum), as places in `f32` need it.
pub(crate) fn keeps_rounding(device: &Device) -> Result<(), Error> {
    let record = Record::of(2, |given| {
        let [a, b] = [given[0], given[1]];
        let sum = a + b;
        let part = sum - a;
        vec![sum, (a - (sum - part)) + (b - part)]
    });
    let record = record.map_err(|error| Error::recorded("record", "two-sum", &error))?;
    let kernel = PointKernel::new(device, "two-sum", &record, Precision::Single)?;
    let numbers: [f32; 6] = [1.0, 0.3, 1e6, -7.0, 3e-5, 1.0 / 3.0];
    let pairs = numbers.map(|a| numbers.map(|b| (a, b * 1e-4)));
    let [a, b]: [Vec<f64>; 2] = [0, 1].map(|k| {
        let own = pairs.as_flattened().iter();
        own.map(|pair| f64::from([pair.0, pair.1][k])).collect()
    });
    let found = kernel.run(device, &[&a, &b])?;
    let all = a.iter().zip(&b).zip(found[0].iter().zip(&found[1]));
    // In f64 the sum of both is exact.
    let is_kept = |((a, b), (sum, lost)): ((&f64, &f64), (&f64, &f64))| a + b == sum + lost;
    if all.into_iter().all(is_kept) {
        return Ok(());
    }
    Err(Error::Reordered {
        adapter: device.adapter().name.clone(),
    })
}
