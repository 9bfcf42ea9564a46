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
}

impl Default for Patience {
    /// Half a minute and ten seconds; nobody is told.
    fn default() -> Self {
        Patience {
            told_after: Duration::from_secs(30),
            given_up_after: Duration::from_secs(10),
            tell: |_, _| {},
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

    /// Writes a file or a folder by a thread that cannot be left, while another looks after the clock: the user is told
    /// of a disk that takes nothing, but the run waits for it, whatever it is asked.
    pub fn watch<X>(&self, path: &Path, write: impl FnOnce() -> X) -> X {
        let (written, done) = channel::<()>();
        let since = Instant::now();
        std::thread::scope(|scope| {
            scope.spawn(move || {
                while done.recv_timeout(LOOK_UP) == Err(RecvTimeoutError::Timeout) {
                    self.tell(path, since.elapsed());
                }
            });
            let result = write();
            drop(written);
            result
        })
    }

    /// Tells the user of a file or a folder that was waited for that long, once.
    fn tell(&self, path: &Path, waited: Duration) {
        if waited >= self.patience.told_after && !self.told.swap(true, Ordering::Relaxed) {
            (self.patience.tell)(path, waited);
        }
    }

    /// Looks up from waiting for a file or a folder, into which nothing went since then.
    ///
    /// # Errors
    /// The run is to stop, and has waited long enough.
    pub(super) fn look_up(&self, path: &Path, since: Instant) -> Result<(), OutputError> {
        let waited = since.elapsed();
        self.tell(path, waited);
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
