//! A line on the terminal that says how far a run is and when it should end.
//! It writes nothing where no person looks, and leaves nothing when it is done.

use core::fmt;
use core::time::Duration;
use std::io::{self, IsTerminal, Write};
use std::time::Instant;

/// Shortest time between two redraws.
const INTERVAL: Duration = Duration::from_millis(100);
/// Time before a first estimate can be trusted.
const WARM_UP: Duration = Duration::from_millis(500);
/// Longest line, so that it does not wrap on a common terminal.
const COLUMNS: usize = 79;
const BAR: usize = 24;

/// The time that is left when `done` of the work, beyond what was done at the start, took
/// `elapsed`; nothing when that cannot be known.
///
/// ```
/// use meshfree::output::progress::remaining;
/// use std::time::Duration;
/// let left = remaining(0.25, 0.0, Duration::from_secs(10));
/// assert_eq!(left, Some(Duration::from_secs(30)));
/// assert_eq!(remaining(0.0, 0.0, Duration::from_secs(10)), None);
/// ```
#[must_use]
pub fn remaining(done: f64, at_start: f64, elapsed: Duration) -> Option<Duration> {
    let gained = done - at_start;
    if gained.is_nan() || gained <= 0.0 {
        return None;
    }
    let (done, gained) = (done.min(1.0), gained.min(1.0 - at_start));
    // A start at the very end gives 0 / 0, which is no duration either.
    Duration::try_from_secs_f64(elapsed.as_secs_f64() * (1.0 - done) / gained).ok()
}

/// A duration for people, two units at most.
///
/// ```
/// use meshfree::output::progress::duration_text;
/// use std::time::Duration;
/// assert_eq!(duration_text(Duration::from_secs(42)), "42 s");
/// assert_eq!(duration_text(Duration::from_secs(3_725)), "1 h 02 min");
/// ```
#[must_use]
pub fn duration_text(duration: Duration) -> String {
    let seconds = duration.as_secs_f64().round() as u64;
    let (minutes, hours, days) = (seconds / 60, seconds / 3_600, seconds / 86_400);
    match (days, hours, minutes) {
        (0, 0, 0) => format!("{seconds} s"),
        (0, 0, _) => format!("{minutes} min {:02} s", seconds % 60),
        (0, _, _) => format!("{hours} h {:02} min", minutes % 60),
        _ => format!("{days} d {:02} h", hours % 24),
    }
}

/// The line itself: label, bar, per cent, time left, detail.
///
/// ```
/// use meshfree::output::progress::line;
/// use std::time::Duration;
/// let text = line("jet", 0.5, 0.0, Duration::from_secs(60), "t = 1 ms");
/// assert!(text.contains("50 %") && text.contains("1 min 00 s left"));
/// ```
#[must_use]
pub fn line(label: &str, done: f64, at_start: f64, elapsed: Duration, detail: &str) -> String {
    let done = if done.is_nan() {
        0.0
    } else {
        done.clamp(0.0, 1.0)
    };
    let full = (done * BAR as f64) as usize;
    let bar = "█".repeat(full) + &"░".repeat(BAR - full);
    let left = remaining(done, at_start, elapsed)
        .filter(|_| elapsed >= WARM_UP)
        .map_or_else(String::new, |left| {
            format!("  {} left", duration_text(left))
        });
    let gap = if detail.is_empty() { "" } else { "  " };
    format!(
        "{label} {bar} {:3.0} %{left}{gap}{detail}",
        (done * 100.0).floor()
    )
    .chars()
    .map(|c| if c.is_control() { ' ' } else { c })
    .take(COLUMNS)
    .collect()
}

/// Shows how far a run is, on standard error if that is a terminal and not at all otherwise.
/// The line is redrawn at most ten times a second, and erased at the end.
///
/// ```
/// use meshfree::output::progress::Progress;
/// let mut progress = Progress::new("dam break");
/// for step in 0..1000 {
///     progress.update(f64::from(step) / 1000.0, format_args!("step {step}"));
/// }
/// progress.finish();
/// ```
pub struct Progress {
    label: String,
    screen: Option<Box<dyn Write + Send>>,
    started: Instant,
    at_start: f64,
    shown: Option<Duration>,
}

impl fmt::Debug for Progress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Progress")
            .field("label", &self.label)
            .field("visible", &self.screen.is_some())
            .finish_non_exhaustive()
    }
}

impl Progress {
    /// Starts the clock.
    ///
    /// ```
    /// # use meshfree::output::progress::Progress;
    /// let progress = Progress::new("dam break");
    /// # let _ = progress;
    /// ```
    #[must_use]
    pub fn new(label: impl Into<String>) -> Self {
        let stderr = io::stderr();
        let dumb = std::env::var_os("TERM").is_some_and(|term| term == "dumb");
        let screen: Option<Box<dyn Write + Send>> = if stderr.is_terminal() && !dumb {
            Some(Box::new(stderr))
        } else {
            None
        };
        Self {
            label: label.into(),
            screen,
            started: Instant::now(),
            at_start: 0.0,
            shown: None,
        }
    }

    /// Says what fraction was already done when the clock started, for a run that is resumed.
    ///
    /// ```
    /// # use meshfree::output::progress::Progress;
    /// let progress = Progress::new("dam break").resumed_at(0.4);
    /// # let _ = progress;
    /// ```
    #[must_use]
    pub fn resumed_at(mut self, done: f64) -> Self {
        self.at_start = done;
        self
    }

    /// Says what fraction is done now, with a detail such as the simulated time, which is only
    /// formatted when the line is redrawn.
    ///
    /// ```
    /// # use meshfree::output::progress::Progress;
    /// let mut progress = Progress::new("dam break");
    /// progress.update(0.1, format_args!("t = {:.3} s", 0.2));
    /// ```
    pub fn update(&mut self, done: f64, detail: impl fmt::Display) {
        if self.screen.is_some() {
            self.update_at(self.started.elapsed(), done, detail);
        }
    }

    /// Erases the line. Dropping does the same.
    ///
    /// ```
    /// # use meshfree::output::progress::Progress;
    /// Progress::new("dam break").finish();
    /// ```
    pub fn finish(self) {}

    fn update_at(&mut self, elapsed: Duration, done: f64, detail: impl fmt::Display) {
        let Some(screen) = &mut self.screen else {
            return;
        };
        if self.shown.is_some_and(|shown| elapsed < shown + INTERVAL) {
            return;
        }
        self.shown = Some(elapsed);
        let text = line(
            &self.label,
            done,
            self.at_start,
            elapsed,
            &detail.to_string(),
        );
        // A terminal that went away is no reason to stop the run.
        let _ = write!(screen, "\r{text}\x1b[K");
        let _ = screen.flush();
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let (Some(screen), Some(_)) = (&mut self.screen, self.shown) {
            let _ = write!(screen, "\r\x1b[2K");
            let _ = screen.flush();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::{Arc, Mutex};

    const SECOND: Duration = Duration::from_secs(1);

    #[derive(Clone, Default)]
    struct Screen(Arc<Mutex<Vec<u8>>>);

    impl Write for Screen {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.0.lock().unwrap().extend_from_slice(bytes);
            Ok(bytes.len())
        }
        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn what_is_left_follows_from_what_was_gained() {
        assert_eq!(remaining(0.5, 0.0, SECOND), Some(SECOND));
        assert_eq!(remaining(0.5, 0.25, SECOND), Some(2 * SECOND));
        assert_eq!(remaining(1.5, 0.0, SECOND), Some(Duration::ZERO));
        for done in [0.0, -1.0, f64::NAN, 1e-300] {
            assert_eq!(remaining(done, 0.0, SECOND), None, "{done}");
        }
    }

    #[test]
    fn durations_carry_into_the_next_unit() {
        let text = |seconds| duration_text(Duration::from_secs_f64(seconds));
        assert_eq!(text(0.2), "0 s");
        assert_eq!(text(59.6), "1 min 00 s");
        assert_eq!(text(3_599.9), "1 h 00 min");
        assert_eq!(text(90_000.0), "1 d 01 h");
    }

    #[test]
    fn the_line_stays_on_one_row() {
        let text = line("a\nb", f64::NAN, 0.0, SECOND, &"long ".repeat(40));
        assert_eq!(text.chars().count(), COLUMNS);
        assert!(!text.contains('\n'));
        assert!(line("a", 0.999, 0.0, SECOND, "").contains(" 99 %"));
    }

    #[test]
    fn redraws_are_rare_and_the_end_erases() {
        let screen = Screen::default();
        let mut progress = Progress::new("run");
        progress.screen = Some(Box::new(screen.clone()));
        for millisecond in 0..1000 {
            progress.update_at(Duration::from_millis(millisecond), 0.5, "");
        }
        progress.finish();
        let text = String::from_utf8(screen.0.lock().unwrap().clone()).unwrap();
        assert_eq!(text.matches("50 %").count(), 10);
        assert!(text.ends_with("\r\x1b[2K"));
    }
}
