//! Runs many random cases, and names the one that panics or takes too long by the number that makes it again.
//! A case that hangs ends the process after a time, with its number.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// The longest that a case may take.
const LONGEST: Duration = Duration::from_secs(60);

/// Runs the cases `from..from + count`; `case` says what became of it in a word. Gives how often each word came.
pub fn all(
    what: &'static str,
    from: u64,
    count: u64,
    mut case: impl FnMut(u64) -> &'static str,
) -> Vec<(&'static str, u64)> {
    let (now, start) = (Arc::new(AtomicU64::new(from)), Instant::now());
    let begun = Arc::new(AtomicU64::new(0));
    let (watched, since) = (now.clone(), begun.clone());
    std::thread::spawn(move || {
        loop {
            std::thread::sleep(Duration::from_secs(1));
            let seed = watched.load(Ordering::Relaxed);
            if seed == u64::MAX {
                return;
            }
            let taken = start.elapsed().as_millis() as u64 - since.load(Ordering::Relaxed);
            if taken > LONGEST.as_millis() as u64 {
                eprintln!("{what}: case {seed} has taken {taken} ms: it hangs");
                std::process::abort();
            }
        }
    });
    let mut words: Vec<(&'static str, u64)> = Vec::new();
    let mut wrong = Vec::new();
    for seed in from..from + count {
        begun.store(start.elapsed().as_millis() as u64, Ordering::Relaxed);
        now.store(seed, Ordering::Relaxed);
        let Ok(word) = catch_unwind(AssertUnwindSafe(|| case(seed))) else {
            eprintln!("{what}: case {seed} panicked");
            wrong.push(seed);
            if wrong.len() >= 20 {
                break;
            }
            continue;
        };
        match words.iter_mut().find(|own| own.0 == word) {
            Some(own) => own.1 += 1,
            None => words.push((word, 1)),
        }
    }
    now.store(u64::MAX, Ordering::Relaxed);
    println!(
        "{what}: {count} cases in {:.1?}: {words:?}",
        start.elapsed()
    );
    assert!(wrong.is_empty(), "{what}: cases {wrong:?} panicked");
    words
}

/// How many of the cases ended in a word.
pub fn share(words: &[(&'static str, u64)], word: &str) -> u64 {
    words
        .iter()
        .find(|own| own.0 == word)
        .map_or(0, |own| own.1)
}

/// How many cases the long forms try: `MESHFREE_CASES`, or a million.
pub fn asked() -> u64 {
    let asked = std::env::var("MESHFREE_CASES").ok();
    asked.and_then(|n| n.parse().ok()).unwrap_or(1_000_000)
}
