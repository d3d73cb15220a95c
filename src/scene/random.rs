//! Numbers that look random, the same on every machine and in every order.
//! By SplitMix64, each follows from a seed and its index alone.

/// The number of a sequence at `index`, even between −1 and 1 (SplitMix64; Steele, Lea & Flood 2014).
pub(super) fn random(seed: u64, index: u64) -> f64 {
    let mut z = index
        .wrapping_add(1)
        .wrapping_mul(0x9e37_79b9_7f4a_7c15)
        .wrapping_add(seed);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^= z >> 31;
    (z >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

#[cfg(test)]
mod tests {
    use super::random;

    #[test]
    fn random_numbers_are_even_and_of_their_own() {
        // The first number of the published generator for the seed 0: 0xE220A8397B1DCDAF.
        let first = (0xe220_a839_7b1d_cdaf_u64 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0;
        assert_eq!(random(0, 0), first);
        let count = 20_000;
        let numbers = || (0..count).map(|k| random(7, k));
        let mean = numbers().sum::<f64>() / count as f64;
        let variance = numbers().map(|x| x * x).sum::<f64>() / count as f64;
        let [least, most] = [
            numbers().fold(1.0, f64::min),
            numbers().fold(-1.0, f64::max),
        ];
        assert!(
            mean.abs() < 0.02 && (variance - 1.0 / 3.0).abs() < 0.01,
            "{mean} {variance}"
        );
        assert!(
            least >= -1.0 && most < 1.0 && least < -0.999 && most > 0.999,
            "{least} {most}"
        );
    }
}
