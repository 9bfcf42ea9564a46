//! How long a run waits for a disk that takes nothing.

use super::file::OutputError;
use std::io;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::{Duration, Instant};

/// How long a run waits where a disk takes nothing: it may come back, as those of a network do.
#[derive(Clone, Debug)]
pub struct Patience {
    /// The user is told after so long, once.
    pub told_after: Duration,
    /// A run that is to stop waits no longer than that; others wait until the disk takes something.
    pub given_up_after: Duration,
    /// Tells the user which file or folder is waited for, and for how long so far.
    pub tell: fn(&Path, Duration),
    /// Tells the user which file is not written yet, for which the run waits whatever it is asked, and after how long.
    pub tell_slow: fn(&Path, Duration),
}

impl Default for Patience {
    /// Half a minute and ten seconds; nobody is told.
    fn default() -> Self {
        Patience {
            told_after: Duration::from_secs(30),
            given_up_after: Duration::from_secs(10),
            tell: |_, _| {},
            tell_slow: |_, _| {},
        }
    }
}

/// The patience of a run, which all its writers share.
#[derive(Debug, Default)]
pub struct Waiting {
    patience: Patience,
    /// Set where the run is to stop.
    stop: Arc<AtomicBool>,
    /// When it is to stop at the latest.
    until: Option<Instant>,
    told: AtomicBool,
    given_up: AtomicBool,
}

/// How often those who wait look up.
pub(super) const LOOK_UP: Duration = Duration::from_millis(50);
/// Part of the time after which one writer gives up that another one waits once one has.
const LAST_CHANCE: u32 = 10;

impl Waiting {
    /// Of a run that stops where `stop` is set, or `until` comes.
    pub fn new(patience: Patience, stop: Arc<AtomicBool>, until: Option<Instant>) -> Self {
        Waiting { patience, stop, until, ..Waiting::default() }
    }

    /// Writes a file by a thread that cannot be left, while another looks after the clock: the user is told if it takes
    /// long, but the run waits for it, whatever it is asked.
    pub fn watch<X>(&self, path: &Path, write: impl FnOnce() -> X) -> X {
        let (written, done) = channel::<()>();
        let Patience { told_after, tell_slow, .. } = self.patience;
        std::thread::scope(|scope| {
            let watcher = move || {
                if done.recv_timeout(told_after) == Err(RecvTimeoutError::Timeout) {
                    tell_slow(path, told_after);
                }
            };
            // Where the system gives no thread, nobody watches.
            let _ = std::thread::Builder::new().spawn_scoped(scope, watcher);
            let result = write();
            drop(written);
            result
        })
    }

    /// Looks up from waiting for a file or a folder, into which nothing went since then.
    ///
    /// # Errors
    /// The run is to stop, and has waited long enough.
    pub(super) fn look_up(&self, path: &Path, since: Instant) -> Result<(), OutputError> {
        let waited = since.elapsed();
        if waited >= self.patience.told_after && !self.told.swap(true, Ordering::Relaxed) {
            (self.patience.tell)(path, waited);
        }
        let stops =
            self.stop.load(Ordering::Relaxed) || self.until.is_some_and(|until| Instant::now() >= until);
        let longest = match self.given_up.load(Ordering::Relaxed) {
            true => self.patience.given_up_after / LAST_CHANCE,
            false => self.patience.given_up_after,
        };
        if !stops || waited < longest {
            return Ok(());
        }
        self.given_up.store(true, Ordering::Relaxed);
        let told =
            format!("the disk has taken nothing for {:.0} s, and the run was to stop", waited.as_secs_f64());
        Err(OutputError::at(path)(io::Error::new(io::ErrorKind::TimedOut, told)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::AtomicUsize;

    /// Once, if it takes long; whoever writes is waited for.
    #[test]
    fn what_takes_long_is_told_of() {
        static TOLD: AtomicUsize = AtomicUsize::new(0);
        let patience = Patience {
            told_after: Duration::from_millis(50),
            tell_slow: |path, _| {
                assert_eq!(path, Path::new("slow"));
                TOLD.fetch_add(1, Ordering::Relaxed);
            },
            ..Patience::default()
        };
        let waiting = Waiting::new(patience, Arc::default(), None);
        assert_eq!(waiting.watch(Path::new("fast"), || 1), 1);
        assert_eq!(TOLD.load(Ordering::Relaxed), 0);
        let write = || {
            std::thread::sleep(Duration::from_millis(300));
            2
        };
        assert_eq!(waiting.watch(Path::new("slow"), write), 2);
        assert_eq!(TOLD.load(Ordering::Relaxed), 1);
    }
}
