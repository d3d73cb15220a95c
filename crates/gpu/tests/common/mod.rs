//! What the tests share: a device if there is one, and numbers without pattern.
//! Where there is no driver a test says that it was skipped, by its name.

use meshfree_gpu::{Device, Error};

/// The device of a test, or nothing where there is none: the fastest, or the adapter that `MESHFREE_ADAPTER` names.
pub fn device(test: &str) -> Option<Device> {
    let named = std::env::var("MESHFREE_ADAPTER");
    match named.map_or_else(|_| Device::open(), |name| Device::named(&name)) {
        Ok(device) => {
            println!("{test} on {:?}", device.adapter());
            Some(device)
        }
        Err(Error::NoAdapter) => {
            println!("skipped: {test}: {}", Error::NoAdapter);
            None
        }
        Err(error) => panic!("{error}"),
    }
}

/// Asserts that bits are the same twice, and for work groups of 64, 128 and 256 threads.
pub fn in_any_groups(mut device: Device, bits: impl Fn(&Device) -> Vec<u64>) {
    let first = bits(&device);
    for threads in [64, 128, 256] {
        device = device
            .with_threads(threads)
            .expect("a size that devices have");
        assert_eq!(bits(&device), first, "{threads}");
    }
}

/// Numbers without pattern (Steele, Lea & Flood 2014).
pub struct Random(pub u64);

impl Random {
    /// Between 0 and 1.
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
    /// Between −1 and 1.
    pub fn sign(&mut self) -> f64 {
        2.0 * self.next() - 1.0
    }
}
