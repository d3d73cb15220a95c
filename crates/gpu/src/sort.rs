//! Sorting by keys on the device, digit after digit: slots of one key stay in their order.
//! Each thread counts the digits of a run of its own, so nothing depends on the order of threads.

use crate::device::{Bound, Buffer, Extent, Kernel};
use crate::kernel::Array;
use crate::{Device, Dialect, Error};

/// Bits of a digit, and slots that a thread takes.
const BITS: usize = 8;
const RUN: usize = 128;
/// Numbers that a thread adds.
const SHARE: usize = 256;

/// Sums of all numbers before each, in their place.
#[derive(Debug)]
pub(crate) struct Scan {
    add: Kernel,
    spread: Kernel,
}

/// The levels of sums over some numbers, and of sums over those: where each starts, and its length.
fn levels(count: usize) -> Vec<(usize, usize)> {
    let mut all = vec![(0, count)];
    let mut last = all[0];
    while last.1 > SHARE {
        last = (last.0 + last.1, last.1.div_ceil(SHARE));
        all.push(last);
    }
    all
}

impl Scan {
    pub fn new(device: &Device, dialect: Dialect) -> Result<Self, Error> {
        let end = format!("scene.stride + min(n * {SHARE}u + {SHARE}u, scene.length)");
        let share = dialect.index("start", &format!("scene.stride + n * {SHARE}u"))
            + &dialect.index("end", &end)
            + &dialect.counter("sum", "0u");
        let each = dialect.each("k", "start", "end");
        let add = format!(
            "{share}{each}sum = sum + counts[k];\n}}\ncounts[scene.target_at + n] = sum;\n"
        );
        // The last level has none above it.
        let spread = format!(
            "{share}if (scene.target_at > 0u) {{ sum = counts[scene.target_at + n]; }}\n{each}{}\
             counts[k] = sum;\nsum = sum + own;\n}}\n",
            dialect.index("own", "counts[k]")
        );
        let buffers = [Array::indices("counts").written()];
        let kernel = |name, body: &str| device.kernel(("sort", name), (dialect, &buffers), body);
        Ok(Self {
            add: kernel("sums", &add)?,
            spread: kernel("starts", &spread)?,
        })
    }

    /// Numbers that `count` of them take with sums over them.
    pub fn room(count: usize) -> usize {
        levels(count).iter().map(|own| own.1).sum()
    }

    pub fn bind(&self, device: &Device, counts: &Buffer, count: usize) -> Vec<Bound> {
        let all = levels(count);
        let bind = |kernel, level: (usize, usize), target| {
            let extent = Extent {
                count: level.1.div_ceil(SHARE),
                length: level.1,
                stride: level.0,
                target,
                ..Extent::default()
            };
            device.bind_over(kernel, &[counts], extent)
        };
        let pairs = all.windows(2);
        let up = pairs.map(|own| bind(&self.add, own[0], own[1].0));
        let above = |k: usize| all.get(k + 1).map_or(0, |own| own.0);
        let down = (0..all.len()).rev();
        let down = down.map(|k| bind(&self.spread, all[k], above(k)));
        up.chain(down).collect()
    }
}

/// The kernels of a sort.
#[derive(Debug)]
pub(crate) struct Sort {
    count: Kernel,
    place: Kernel,
    pub scan: Scan,
}

/// What is sorted: words of keys one after another, and two rooms for the order of slots, of which the first has that before.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sorted<'a> {
    pub keys: &'a Buffer,
    pub orders: [&'a Buffer; 2],
    pub counts: &'a Buffer,
    /// Slots of all, and those that are sorted, from the first on.
    pub slots: usize,
    pub count: usize,
}

/// Digits of so many bits.
pub(crate) fn digits(bits: usize) -> usize {
    bits.div_ceil(BITS)
}

impl Sort {
    pub fn new(device: &Device, dialect: Dialect) -> Result<Self, Error> {
        let [keys, order] = [Array::indices("keys"), Array::indices("order")];
        let counts = Array::indices("counts").written();
        let each = dialect.each(
            "k",
            &format!("n * {RUN}u"),
            &format!("min(n * {RUN}u + {RUN}u, scene.length)"),
        );
        let slot = dialect.index("slot", "order[k]");
        let digit = format!(
            "((keys[scene.stride + slot] >> scene.target_at) & {}u)",
            (1 << BITS) - 1
        );
        let at = dialect.index("at", &format!("{digit} * scene.count + n"));
        let none = dialect.each("digit", "0u", &format!("{}u", 1 << BITS));
        let count = format!(
            "{none}counts[digit * scene.count + n] = 0u;\n}}\n{each}{slot}{at}counts[at] = counts[at] + 1u;\n}}\n"
        );
        let place = format!(
            "{each}{slot}{at}{}counts[at] = to_place + 1u;\nsorted[to_place] = slot;\n}}\n",
            dialect.index("to_place", "counts[at]")
        );
        let kernel = |name, buffers: &[Array], body: &str| {
            device.kernel(("sort", name), (dialect, buffers), body)
        };
        let sorted = Array::indices("sorted").written();
        Ok(Self {
            count: kernel("digits", &[keys, order, counts], &count)?,
            place: kernel("places", &[keys, order, counts, sorted], &place)?,
            scan: Scan::new(device, dialect)?,
        })
    }

    /// Counts that a sort of `count` slots needs.
    pub fn room(count: usize) -> usize {
        Scan::room(count.div_ceil(RUN) << BITS)
    }

    /// The passes over some digits of words of keys, the lowest first; and which of the orders has the result.
    pub fn bind(
        &self,
        device: &Device,
        of: Sorted<'_>,
        digits: &[(usize, usize)],
    ) -> (Vec<Bound>, usize) {
        let mut all = Vec::new();
        for (pass, (word, digit)) in digits.iter().enumerate() {
            let [order, sorted] = [of.orders[pass % 2], of.orders[1 - pass % 2]];
            let own = Extent {
                count: of.count.div_ceil(RUN),
                length: of.count,
                stride: word * of.slots,
                target: digit * BITS,
                ..Extent::default()
            };
            all.push(device.bind_over(&self.count, &[of.keys, order, of.counts], own));
            all.extend(self.scan.bind(device, of.counts, own.count << BITS));
            let buffers = [of.keys, order, of.counts, sorted];
            all.push(device.bind_over(&self.place, &buffers, own));
        }
        (all, digits.len() % 2)
    }
}
