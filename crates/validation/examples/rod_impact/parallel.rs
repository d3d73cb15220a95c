//! Runs independent jobs side by side, one thread each, and shows how far all of them are.
//! A job's result does not depend on how many run beside it.

use super::Failure;
use meshfree::output::progress::Progress;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The progress of many jobs as one line.
pub struct Board {
    inner: Mutex<(Progress, Vec<f64>)>,
    weights: Vec<f64>,
}

impl Board {
    /// Jobs whose cost is in proportion to these weights.
    pub fn new(label: &str, weights: Vec<f64>) -> Self {
        let done = vec![0.0; weights.len()];
        Self {
            inner: Mutex::new((Progress::new(label), done)),
            weights,
        }
    }

    /// Says which part of a job is done.
    pub fn update(&self, job: usize, part: f64, detail: &str) {
        // A poisoned lock means that a job is lost already: its error is what the user should see.
        let Ok(mut inner) = self.inner.lock() else {
            return;
        };
        let (progress, done) = &mut *inner;
        if let Some(own) = done.get_mut(job) {
            *own = part;
        }
        let total: f64 = self.weights.iter().sum();
        let sum: f64 = done.iter().zip(&self.weights).map(|(d, w)| d * w).sum();
        progress.update(sum / total, detail);
    }
}

/// Does all jobs and returns what they return, in their order.
pub fn map<J: Sync, R: Send>(
    jobs: &[J],
    threads: Option<usize>,
    work: impl Fn(usize, &J) -> Result<R, Failure> + Sync,
) -> Result<Vec<R>, Failure> {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let workers = threads.unwrap_or(cores).clamp(1, jobs.len().max(1));
    let next = AtomicUsize::new(0);
    let results: Mutex<Vec<Option<R>>> = Mutex::new(jobs.iter().map(|_| None).collect());
    let worker = || -> Result<(), Failure> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
        loop {
            let k = next.fetch_add(1, Ordering::Relaxed);
            let Some(job) = jobs.get(k) else {
                return Ok(());
            };
            let result = pool.install(|| work(k, job))?;
            if let Ok(mut results) = results.lock() {
                results[k] = Some(result);
            }
        }
    };
    std::thread::scope(|scope| {
        let handles: Vec<_> = (0..workers).map(|_| scope.spawn(worker)).collect();
        handles
            .into_iter()
            .try_for_each(|handle| match handle.join() {
                Ok(result) => result,
                Err(_) => Err("a run stopped unexpectedly".into()),
            })
    })?;
    let results = results
        .into_inner()
        .map_err(|_| "a run stopped unexpectedly")?;
    Ok(results.into_iter().flatten().collect())
}
