//! Compression as zlib wants it (RFC 1950, RFC 1951): one block with the fixed Huffman codes.
//! Repeats are found by chains of equal hashes, which is what pictures of large even areas need.

/// How far back a repeat may lie.
const WINDOW: usize = 1 << 15;
/// A shorter repeat takes about as many bits as its bytes.
const SHORTEST: usize = 4;
const LONGEST: usize = 258;
/// How many earlier places are tried: more makes files a few per cent smaller, and slower.
const TRIES: usize = 64;
const HASH_BITS: u32 = 15;
const NOWHERE: u32 = u32::MAX;

/// First length of each code from 257 on (RFC 1951, 3.2.5).
const LENGTHS: [u16; 29] = [
    3, 4, 5, 6, 7, 8, 9, 10, 11, 13, 15, 17, 19, 23, 27, 31, 35, 43, 51, 59, 67, 83, 99, 115, 131,
    163, 195, 227, 258,
];

/// Bits into bytes, the lowest first.
#[derive(Default)]
struct Bits {
    bytes: Vec<u8>,
    held: u64,
    count: u32,
}

impl Bits {
    fn push(&mut self, value: u32, count: u32) {
        self.held |= u64::from(value) << self.count;
        self.count += count;
        while self.count >= 8 {
            self.bytes.push(self.held as u8);
            self.held >>= 8;
            self.count -= 8;
        }
    }

    /// Huffman codes go with the highest bit first.
    fn code(&mut self, code: u32, count: u32) {
        self.push(code.reverse_bits() >> (32 - count), count);
    }

    /// A literal, the end of the block (256), or the code of a length.
    fn symbol(&mut self, symbol: u32) {
        match symbol {
            0..=143 => self.code(0x30 + symbol, 8),
            144..=255 => self.code(0x190 + symbol - 144, 9),
            256..=279 => self.code(symbol - 256, 7),
            _ => self.code(0xc0 + symbol - 280, 8),
        }
    }

    fn repeat(&mut self, length: usize, distance: usize) {
        let code = LENGTHS.partition_point(|&first| usize::from(first) <= length) as u32 - 1;
        // Beyond the first eight, each four codes have one bit more; the last one stands alone.
        let extra = if code == 28 { 0 } else { (code / 4).max(1) - 1 };
        self.symbol(257 + code);
        self.push(length as u32 - u32::from(LENGTHS[code as usize]), extra);
        // Codes of distances come in pairs, each pair twice as long as the one before.
        let from = distance as u32 - 1;
        if from < 4 {
            self.code(from, 5);
        } else {
            let extra = from.ilog2() - 1;
            self.code(2 * extra + (from >> extra), 5);
            self.push(from & ((1 << extra) - 1), extra);
        }
    }
}

/// Where each hash was seen last, and before that.
struct Seen {
    last: Vec<u32>,
    before: Vec<u32>,
}

impl Seen {
    /// Notes a place and gives the one of equal hash before it.
    fn note(&mut self, data: &[u8], at: usize) -> u32 {
        let Some(&[a, b, c, d]) = data.get(at..at + SHORTEST) else {
            return NOWHERE;
        };
        let hash = u32::from_le_bytes([a, b, c, d]).wrapping_mul(0x9e37_79b1) >> (32 - HASH_BITS);
        let before = std::mem::replace(&mut self.last[hash as usize], at as u32);
        self.before[at % WINDOW] = before;
        before
    }

    /// The longest repeat at a place, from the candidate on: its length and distance.
    fn longest(&self, data: &[u8], at: usize, mut candidate: u32) -> (usize, usize) {
        let room = LONGEST.min(data.len() - at);
        let (mut length, mut distance) = (0, 0);
        for _ in 0..TRIES {
            let place = candidate as usize;
            if candidate == NOWHERE || place >= at || at - place > WINDOW {
                break;
            }
            // What does not hold one byte further cannot be longer.
            if data[place + length] == data[at + length] {
                let same = data[at..at + room].iter().zip(&data[place..]);
                let found = same.take_while(|(a, b)| a == b).count();
                if found > length {
                    (length, distance) = (found, at - place);
                    if found == room {
                        break;
                    }
                }
            }
            candidate = self.before[place % WINDOW];
        }
        (length, distance)
    }
}

/// The data as a zlib stream.
pub(super) fn zlib(data: &[u8]) -> Vec<u8> {
    let mut bits = Bits::default();
    bits.bytes.extend([0x78, 0x01]);
    // The only block, of fixed codes.
    bits.push(0b011, 3);
    let mut seen = Seen {
        last: vec![NOWHERE; 1 << HASH_BITS],
        before: vec![NOWHERE; WINDOW],
    };
    let mut at = 0;
    while at < data.len() {
        let candidate = seen.note(data, at);
        let (length, distance) = seen.longest(data, at, candidate);
        if length < SHORTEST {
            bits.symbol(u32::from(data[at]));
            at += 1;
        } else {
            bits.repeat(length, distance);
            for inner in at + 1..at + length {
                seen.note(data, inner);
            }
            at += length;
        }
    }
    bits.symbol(256);
    bits.push(0, (8 - bits.count) % 8);
    bits.bytes.extend(adler32(data).to_be_bytes());
    bits.bytes
}

/// The checksum of zlib (RFC 1950).
fn adler32(data: &[u8]) -> u32 {
    let (mut a, mut b) = (1_u32, 0_u32);
    // The most bytes after which neither sum can have overflowed.
    for part in data.chunks(5552) {
        for &byte in part {
            a += u32::from(byte);
            b += a;
        }
        (a, b) = (a % 65521, b % 65521);
    }
    b << 16 | a
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// Reads a zlib stream of stored blocks and blocks of fixed codes, bit by bit, with the
    /// ranges of lengths and distances summed up from their extra bits.
    pub(in crate::output) fn unzlib(stream: &[u8]) -> Vec<u8> {
        assert_eq!((stream[0] & 15, stream[0] >> 4), (8, 7), "deflate, 32 KiB");
        assert_eq!(u16::from_be_bytes([stream[0], stream[1]]) % 31, 0);
        let (body, sum) = stream[2..].split_at(stream.len() - 6);
        let mut at = 0;
        let mut bit = || {
            at += 1;
            usize::from(body[(at - 1) / 8] >> ((at - 1) % 8) & 1)
        };
        let mut data: Vec<u8> = Vec::new();
        loop {
            let last = bit() == 1;
            assert_eq!([bit(), bit()], [1, 0], "fixed codes");
            loop {
                let mut code = 0;
                let mut take = |code: &mut usize| *code = 2 * *code + bit();
                (0..7).for_each(|_| take(&mut code));
                let symbol = if code < 0b001_1000 {
                    256 + code
                } else {
                    take(&mut code);
                    match code {
                        0x30..0xc0 => code - 0x30,
                        0xc0..0xc8 => code - 0xc0 + 280,
                        _ => {
                            take(&mut code);
                            code - 0x190 + 144
                        }
                    }
                };
                if symbol < 256 {
                    data.push(symbol as u8);
                    continue;
                }
                if symbol == 256 {
                    break;
                }
                let mut number = |count: usize| (0..count).map(|i| bit() << i).sum::<usize>();
                let extra = |code: usize| if code < 8 { 0 } else { code / 4 - 1 };
                let code = symbol - 257;
                let length = if code == 28 {
                    258
                } else {
                    3 + (0..code).map(|c| 1 << extra(c)).sum::<usize>() + number(extra(code))
                };
                let code = (0..5).fold(0, |code, _| 2 * code + number(1));
                let extra = |code: usize| if code < 4 { 0 } else { code / 2 - 1 };
                let distance =
                    1 + (0..code).map(|c| 1 << extra(c)).sum::<usize>() + number(extra(code));
                (0..length).for_each(|_| data.push(data[data.len() - distance]));
            }
            if last {
                break;
            }
        }
        assert_eq!(at.div_ceil(8), body.len(), "nothing is left");
        // Both sums as they are defined, without any trick.
        let a = data
            .iter()
            .fold(1_u64, |a, &byte| (a + u64::from(byte)) % 65521);
        let n = data.len() as u64;
        let weighted = data
            .iter()
            .zip(0..)
            .map(|(&byte, i)| (n - i) * u64::from(byte));
        let b = (n + weighted.sum::<u64>()) % 65521;
        assert_eq!(sum, ((b << 16 | a) as u32).to_be_bytes());
        data
    }

    /// Bytes below `most`, the same ones every time.
    fn random(count: usize, most: u32) -> Vec<u8> {
        let mut state = 1_u32;
        let next = |_| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            ((state >> 16) % most) as u8
        };
        (0..count).map(next).collect()
    }

    #[test]
    fn any_data_comes_back() {
        let mut far = random(40_000, 256);
        far.extend_from_within(8_000..9_000);
        far.extend_from_within(7_232..8_500);
        for data in [
            vec![],
            vec![200],
            b"abcabcabcabcabc".to_vec(),
            vec![255; 100_000],
            random(5_000, 256),
            random(20_000, 2),
            random(20_000, 7),
            far,
        ] {
            assert!(unzlib(&zlib(&data)) == data, "{} bytes", data.len());
        }
    }

    #[test]
    fn every_length_and_distance_comes_back() {
        for length in 1..=300 {
            let mut data = random(700, 256);
            data.extend_from_within(length..2 * length);
            assert!(unzlib(&zlib(&data)) == data, "{length}");
        }
        let noise = random(33_000, 256);
        for distance in (0..16).flat_map(|i| [(1 << i) - 1, 1 << i, (3 << i >> 1) + 1]) {
            if (1..=WINDOW).contains(&distance) {
                let mut data = noise.clone();
                data.extend_from_within(noise.len() - distance..);
                assert!(unzlib(&zlib(&data)) == data, "{distance}");
            }
        }
    }

    #[test]
    fn repeats_make_small_streams() {
        assert!(zlib(&vec![255; 100_000]).len() < 700);
        let mut twice = random(10_000, 256);
        let once = zlib(&twice).len();
        twice.extend_from_within(..);
        assert!(zlib(&twice).len() < once + 200);
    }
}
