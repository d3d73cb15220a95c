//! The gate of `.ci/run`: fails where the composed pair loop takes more than 1.15 of the time of one written out by hand.
//! `cargo bench --bench gate`. A program of its own, since the whole of `throughput` takes minutes to compile.

#[path = "throughput/by_hand.rs"]
mod by_hand;
#[path = "throughput/lattice.rs"]
mod lattice;
#[path = "throughput/pair_loop.rs"]
mod pair_loop;

/// Composed over written out, at most; by the lower end of the interval of its median, or a machine that does other
/// things besides would fail it.
const GATE: f64 = 1.15;

fn main() {
    // `cargo test` runs benches without `--bench`: then small and once.
    let full = std::env::args().any(|argument| argument == "--bench");
    let (side, turns) = if full { (32, 60) } else { (12, 5) };
    let ratio = pair_loop::table(side, turns);
    assert!(
        !full || ratio <= GATE,
        "the composed loop takes at least {ratio:.3} of the time of the one written out, and may take {GATE}"
    );
}
