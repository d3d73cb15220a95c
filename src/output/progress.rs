//! A line on the terminal that says how far a run is and when it should end, with the feature `progress`.
//! It writes nothing where no person looks, and leaves nothing when it is done; without the feature it is silent.

use core::fmt;
use core::time::Duration;
#[cfg(feature = "progress")]
use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressStyle};
#[cfg(feature = "progress")]
use std::time::Instant;

/// Shortest time between two redraws.
#[cfg(feature = "progress")]
const INTERVAL: Duration = Duration::from_millis(100);
/// The whole of a run, in steps of the bar.
#[cfg(feature = "progress")]
const WHOLE: f64 = 1000.0;
#[cfg(feature = "progress")]
const LINE: &str = "{prefix} {bar:24} {percent:>3} %  {msg}";

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
#[derive(Debug)]
pub struct Progress {
    #[cfg(feature = "progress")]
    bar: ProgressBar,
    #[cfg(feature = "progress")]
    shown: Option<Instant>,
    /// The last estimate of the time left, and when it was made.
    #[cfg(feature = "progress")]
    told: Option<(Duration, Instant)>,
}

impl Progress {
    /// Starts the clock of a line that begins with `label`.
    ///
    /// ```
    /// # use meshfree::output::progress::Progress;
    /// let progress = Progress::new("dam break");
    /// # let _ = progress;
    /// ```
    #[must_use]
    pub fn new(label: impl Into<String>) -> Self {
        #[cfg(not(feature = "progress"))]
        let _ = label.into();
        Self {
            #[cfg(feature = "progress")]
            bar: bar(label.into()),
            #[cfg(feature = "progress")]
            shown: None,
            #[cfg(feature = "progress")]
            told: None,
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
    pub fn resumed_at(self, done: f64) -> Self {
        #[cfg(feature = "progress")]
        {
            self.bar.set_position(steps(done));
            self.bar.reset_eta();
        }
        #[cfg(not(feature = "progress"))]
        let _ = done;
        self
    }

    /// Whether a person sees it, and it is time to draw it again: a reason to ask what is left.
    ///
    /// ```
    /// # use meshfree::output::progress::Progress;
    /// // Nobody looks at the output of a test.
    /// assert!(!Progress::new("dam break").is_due());
    /// ```
    #[must_use]
    pub fn is_due(&self) -> bool {
        #[cfg(feature = "progress")]
        return !self.bar.is_hidden() && self.is_old();
        #[cfg(not(feature = "progress"))]
        false
    }

    /// Says what time is left from now, by a [cost model](crate::study::cost_model) for instance; until the next estimate the line
    /// counts down from it. Without it the line takes the rest to be as fast as all before.
    ///
    /// ```
    /// # use meshfree::output::progress::Progress;
    /// # use std::time::Duration;
    /// let mut progress = Progress::new("dam break");
    /// progress.expect(Duration::from_secs(60));
    /// ```
    pub fn expect(&mut self, left: Duration) {
        #[cfg(feature = "progress")]
        {
            self.told = Some((left, Instant::now()));
        }
        #[cfg(not(feature = "progress"))]
        let _ = left;
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
        #[cfg(feature = "progress")]
        if self.is_old() {
            self.shown = Some(Instant::now());
            self.bar.set_position(steps(done));
            if !self.bar.is_hidden() {
                self.bar
                    .set_message(format!("{:#} left  {detail}", HumanDuration(self.left())));
            }
        }
        #[cfg(not(feature = "progress"))]
        let _ = (done, detail);
    }

    /// Erases the line. Dropping does the same.
    ///
    /// ```
    /// # use meshfree::output::progress::Progress;
    /// Progress::new("dam break").finish();
    /// ```
    pub fn finish(self) {}

    #[cfg(feature = "progress")]
    fn is_old(&self) -> bool {
        self.shown.is_none_or(|shown| shown.elapsed() >= INTERVAL)
    }

    #[cfg(feature = "progress")]
    fn left(&self) -> Duration {
        match self.told {
            Some((left, told)) => left.saturating_sub(told.elapsed()),
            None => self.bar.eta(),
        }
    }
}

#[cfg(feature = "progress")]
impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

#[cfg(feature = "progress")]
fn bar(label: String) -> ProgressBar {
    let dumb = std::env::var_os("TERM").is_some_and(|term| term == "dumb");
    let target = if dumb {
        ProgressDrawTarget::hidden()
    } else {
        ProgressDrawTarget::stderr_with_hz(10)
    };
    let style = ProgressStyle::with_template(LINE).unwrap_or_else(|_| ProgressStyle::default_bar());
    let bar = ProgressBar::with_draw_target(Some(WHOLE as u64), target);
    bar.with_style(style.progress_chars("█░"))
        .with_prefix(label)
}

/// A fraction in steps of the bar; what is no number is nothing done.
#[cfg(feature = "progress")]
fn steps(done: f64) -> u64 {
    (WHOLE * done.clamp(0.0, 1.0)) as u64
}

#[cfg(all(test, feature = "progress"))]
mod tests {
    use super::*;

    #[test]
    fn the_bar_follows_what_is_done_and_bears_what_is_no_fraction() {
        assert!(ProgressStyle::with_template(LINE).is_ok());
        for (done, position) in [(0.25, 250), (2.0, 1000), (-1.0, 0), (f64::NAN, 0)] {
            let mut progress = Progress::new("run").resumed_at(0.1);
            assert_eq!(progress.bar.position(), 100);
            progress.update(done, "");
            assert_eq!(progress.bar.position(), position, "{done}");
        }
    }

    #[test]
    fn what_is_told_counts_down() {
        let mut progress = Progress::new("run");
        progress.expect(Duration::from_secs(60));
        let left = progress.left().as_secs_f64();
        assert!(left < 60.0 && left > 59.0, "{left}");
    }

    #[test]
    fn redraws_are_rare() {
        let mut progress = Progress::new("run");
        progress.update(0.5, "");
        progress.update(0.6, "");
        assert_eq!(progress.bar.position(), 500);
    }
}
