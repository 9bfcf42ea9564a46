//! Which job is done when, and by how many threads.

use std::sync::{Condvar, Mutex, MutexGuard};
use stickslip::check::free_memory;

/// What a job needs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Need {
    /// Number of the job.
    pub job: usize,
    /// Particles times steps.
    pub work: f64,
    /// Memory, estimated [bytes].
    pub memory: f64,
}

/// Threads and memory that are free, and the jobs that wait for them.
pub struct FreeResources {
    threads: usize,
    state: Mutex<ResourceState>,
    freed: Condvar,
}

struct ResourceState {
    /// The longest last.
    waiting: Vec<Need>,
    threads: usize,
    memory: f64,
    running: usize,
}

/// A run takes more memory than its particles and its grid: files under way, the order of particles, the program.
const MARGIN: f64 = 1.5;

impl FreeResources {
    /// This many threads and the memory that the machine has free.
    pub fn new(needs: Vec<Need>, threads: usize) -> Self {
        Self::with_memory(needs, threads, free_memory())
    }

    fn with_memory(mut needs: Vec<Need>, threads: usize, memory: f64) -> Self {
        needs.sort_by(|a, b| a.work.total_cmp(&b.work));
        let state = ResourceState { waiting: needs, threads, memory, running: 0 };
        FreeResources { threads, state: Mutex::new(state), freed: Condvar::new() }
    }

    /// Calls `run` with each job and a number of threads, and gives what came out, in no order.
    pub fn work<T: Send>(self, run: impl Fn(usize, usize) -> T + Sync) -> Vec<T> {
        let done = Mutex::new(Vec::new());
        std::thread::scope(|scope| {
            for _ in 0..self.threads.min(self.lock().waiting.len()) {
                scope.spawn(|| {
                    while let Some((need, threads)) = self.take() {
                        let outcome = run(need.job, threads);
                        done.lock().expect("no thread panics with the list").push(outcome);
                        self.give_back(need, threads);
                    }
                });
            }
        });
        done.into_inner().expect("no thread panics with the list")
    }

    /// The longest job for which there is memory, with its share of threads; waits until there is one.
    /// `None` when all are taken.
    fn take(&self) -> Option<(Need, usize)> {
        let mut state = self.lock();
        loop {
            if state.waiting.is_empty() {
                return None;
            }
            if let Some(taken) = state.take(self.threads) {
                return Some(taken);
            }
            state = self.freed.wait(state).expect("no thread panics with the bench");
        }
    }

    fn give_back(&self, need: Need, threads: usize) {
        let mut state = self.lock();
        state.threads += threads;
        state.memory += MARGIN * need.memory;
        state.running -= 1;
        drop(state);
        self.freed.notify_all();
    }

    fn lock(&self) -> MutexGuard<'_, ResourceState> {
        self.state.lock().expect("no thread panics with the bench")
    }
}

impl ResourceState {
    /// A job takes as many of all `threads` as its part of the work that waits, at least one. A job too large for the
    /// memory runs alone: the estimate may be wrong, and nothing else would ever run it.
    fn take(&mut self, threads: usize) -> Option<(Need, usize)> {
        if self.threads == 0 {
            return None;
        }
        let work: f64 = self.waiting.iter().map(|need| need.work).sum();
        let fits = |need: &Need| MARGIN * need.memory <= self.memory || self.running == 0;
        let need = self.waiting.remove(self.waiting.iter().rposition(fits)?);
        let share = if work > 0.0 { need.work / work } else { 1.0 };
        let share = ((threads as f64 * share).round() as usize).clamp(1, self.threads);
        self.threads -= share;
        self.memory -= MARGIN * need.memory;
        self.running += 1;
        Some((need, share))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    fn needs(works: &[f64], memory: f64) -> Vec<Need> {
        works.iter().enumerate().map(|(job, &work)| Need { job, work, memory }).collect()
    }

    #[test]
    fn every_job_is_done_once() {
        let mut done =
            FreeResources::with_memory(needs(&[3.0, 1.0, 2.0, 5.0], 1.0), 3, 100.0).work(|job, _| job);
        done.sort_unstable();
        assert_eq!(done, [0, 1, 2, 3]);
    }

    #[test]
    fn the_longest_comes_first_and_gets_its_share_of_threads() {
        let bench = FreeResources::with_memory(needs(&[1.0, 6.0, 1.0], 0.0), 8, 1.0);
        let taken = [(); 2].map(|()| bench.take().map(|(need, threads)| (need.job, threads)));
        assert_eq!(taken[0], Some((1, 6)));
        assert_eq!(
            taken[1].map(|(_, threads)| threads),
            Some(2),
            "half of the work that is left, two threads are free"
        );
    }

    #[test]
    fn jobs_run_together_only_while_memory_lasts() {
        let most = AtomicUsize::new(0);
        let now = AtomicUsize::new(0);
        FreeResources::with_memory(needs(&[1.0; 6], 10.0), 4, 2.0 * MARGIN * 10.0).work(|_, _| {
            most.fetch_max(now.fetch_add(1, Ordering::SeqCst) + 1, Ordering::SeqCst);
            std::thread::sleep(std::time::Duration::from_millis(5));
            now.fetch_sub(1, Ordering::SeqCst);
        });
        assert!(most.into_inner() <= 2);
    }

    #[test]
    fn a_job_that_is_too_large_runs_alone() {
        assert_eq!(
            FreeResources::with_memory(needs(&[1.0, 1.0], 1e9), 2, 1.0).work(|_, threads| threads).len(),
            2
        );
    }
}
