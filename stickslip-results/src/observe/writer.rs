//! A thread that writes, so that the run goes on while files grow.

use super::file::OutputError;
use super::waiting::{LOOK_UP, Waiting};
use super::work::Work;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::{Builder, JoinHandle};
use std::time::Instant;

/// Bytes that may wait: what is handed over next is made once less than this is waiting, so that neither many small
/// records nor two large ones pile up in memory.
const ROOM: usize = 64 << 20;

/// Writes what it is handed, in that order, on a thread of its own that owns the files `F`.
///
/// The first error ends it: it is returned by the next call, and nothing that was handed over later is written. A disk
/// that takes nothing is waited for as [`Waiting`] says; then the thread is left to itself.
pub struct Writer<F> {
    tasks: Option<Sender<(usize, WriterTask<F>)>>,
    done: Receiver<Done>,
    /// Bytes handed over and not yet written.
    queued: usize,
    thread: Option<JoinHandle<()>>,
    /// The file or the folder that it writes.
    about: PathBuf,
    waiting: Arc<Waiting>,
    /// What the thread is at, and how much of that is known.
    work: Arc<Work>,
    seen: u64,
}

/// Bytes of what was handed over, and how writing it went.
type Done = (usize, Result<(), OutputError>);
type WriterTask<F> = Box<dyn FnOnce(&mut F) -> Result<(), OutputError> + Send>;

impl<F: Send + 'static> Writer<F> {
    /// Starts the thread, which writes a file or the files of a folder.
    ///
    /// # Errors
    /// The system gives no thread.
    pub fn start(mut files: F, about: &Path, waiting: &Arc<Waiting>) -> Result<Self, OutputError> {
        let (tasks, handed_over) = channel::<(usize, WriterTask<F>)>();
        let (report, done) = channel();
        let work = Arc::new(Work::default());
        let own = work.clone();
        let thread = Builder::new().name("writer".to_string()).spawn(move || {
            own.adopt();
            for (bytes, task) in handed_over {
                let result = task(&mut files);
                let failed = result.is_err();
                // Nobody listens any more: then nobody waits for the rest either, but it is written.
                let _ = report.send((bytes, result));
                if failed {
                    return;
                }
            }
        });
        Ok(Writer {
            tasks: Some(tasks),
            done,
            queued: 0,
            thread: Some(thread.map_err(OutputError::at(about))?),
            about: about.to_path_buf(),
            waiting: waiting.clone(),
            work,
            seen: 0,
        })
    }

    /// The file or the folder that it writes.
    pub(super) fn about(&self) -> &Path {
        &self.about
    }

    /// How long it waits.
    pub(super) fn waiting(&self) -> &Waiting {
        &self.waiting
    }

    /// Waits until there is room for another record.
    ///
    /// # Errors
    /// Something that was handed over before could not be written, or the disk takes nothing and the run is to stop; so
    /// for the others.
    pub fn make_room(&mut self) -> Result<(), OutputError> {
        while self.queued >= ROOM {
            if self.next_done()?.is_none() {
                return Ok(());
            }
        }
        self.take_note().map(drop)
    }

    /// Hands over what is to be written, and how many bytes it keeps in memory until then.
    pub fn hand_over(
        &mut self,
        bytes: usize,
        task: impl FnOnce(&mut F) -> Result<(), OutputError> + Send + 'static,
    ) {
        let Some(tasks) = &self.tasks else { return };
        // A writer that failed takes nothing more; the next look at it says why.
        if tasks.send((bytes, Box::new(task))).is_ok() {
            self.queued += bytes;
        }
    }

    /// Waits until everything is written, and asks the thread about its files.
    ///
    /// # Errors
    /// Something could not be written, or the question has no answer.
    pub fn ask<R: Send + 'static>(
        &mut self,
        question: impl FnOnce(&mut F) -> Result<R, OutputError> + Send + 'static,
    ) -> Result<R, OutputError> {
        let (answer, answered) = channel();
        self.hand_over(0, move |files| {
            // Who asked waits for it.
            let _ = answer.send(question(files)?);
            Ok(())
        });
        let mut since = Instant::now();
        loop {
            match answered.recv_timeout(LOOK_UP) {
                Ok(answer) => return Ok(answer),
                Err(RecvTimeoutError::Timeout) => {
                    if self.take_note()? || self.work.goes_on(&mut self.seen) {
                        since = Instant::now();
                    }
                    self.look_up(since)?;
                }
                // The thread has failed, and said why.
                Err(RecvTimeoutError::Disconnected) => {
                    while self.next_done()?.is_some() {}
                    return Err(OutputError::at(&self.about)(io::ErrorKind::BrokenPipe.into()));
                }
            }
        }
    }

    /// Waits until everything is written.
    ///
    /// # Errors
    /// Something could not be written.
    pub fn finish(&mut self) -> Result<(), OutputError> {
        self.tasks = None;
        while self.next_done()?.is_some() {}
        self.end();
        Ok(())
    }

    /// Takes note of what was written; true if something was.
    fn take_note(&mut self) -> Result<bool, OutputError> {
        let mut noted = false;
        while let Ok((bytes, result)) = self.done.try_recv() {
            (self.queued, noted) = (self.queued - bytes, true);
            result?;
        }
        Ok(noted)
    }
}

impl<F> Writer<F> {
    /// Waits until one more task is done; `None` once there will be none.
    fn next_done(&mut self) -> Result<Option<()>, OutputError> {
        let mut since = Instant::now();
        loop {
            match self.done.recv_timeout(LOOK_UP) {
                Ok((bytes, result)) => {
                    self.queued -= bytes;
                    return result.map(Some);
                }
                Err(RecvTimeoutError::Disconnected) => return Ok(None),
                Err(RecvTimeoutError::Timeout) => {
                    if self.work.goes_on(&mut self.seen) {
                        since = Instant::now();
                    }
                    self.look_up(since)?;
                }
            }
        }
    }

    fn look_up(&mut self, since: Instant) -> Result<(), OutputError> {
        self.waiting.look_up(&self.about, since).inspect_err(|_| {
            // Nobody waits for it any more; if the disk comes back, what was handed over is written.
            (self.tasks, self.thread) = (None, None);
        })
    }

    fn end(&mut self) {
        self.tasks = None;
        // What fails now is what failed before, or has nobody to be told to.
        while self.thread.is_some() && matches!(self.next_done(), Ok(Some(())) | Err(_)) {}
        if let Some(Err(panic)) = self.thread.take().map(JoinHandle::join)
            && !std::thread::panicking()
        {
            std::panic::resume_unwind(panic);
        }
    }
}

impl<F> Drop for Writer<F> {
    /// Whatever ended the run: what was handed over is written.
    fn drop(&mut self) {
        self.end();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observe::waiting::Patience;
    use std::sync::Mutex;
    use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
    use std::time::Duration;

    type Log = Arc<Mutex<Vec<usize>>>;

    /// A run that is to stop waits as long as its files are made, and no longer than it may for the disk.
    #[test]
    fn what_is_made_is_waited_for_and_a_disk_that_takes_nothing_is_not() {
        let [short, long] = [30, 400].map(Duration::from_millis);
        let patience = Patience { given_up_after: short, ..Patience::default() };
        let stopped = Arc::new(Waiting::new(patience, Arc::new(true.into()), None));
        let mut writer = Writer::start(Log::default(), Path::new("log"), &stopped).unwrap();
        writer.hand_over(1, move |log| {
            note(1)(crate::observe::work::work(|| {
                std::thread::sleep(long);
                log
            }))
        });
        assert_eq!(writer.ask(|log| Ok(log.lock().unwrap().clone())).unwrap(), [1]);
        writer.hand_over(1, move |_| {
            std::thread::sleep(long);
            Ok(())
        });
        assert_eq!(writer.finish().unwrap_err().source.kind(), io::ErrorKind::TimedOut);
    }

    fn writer() -> (Writer<Log>, Log) {
        let log = Log::default();
        (Writer::start(log.clone(), Path::new("log"), &Arc::default()).unwrap(), log)
    }

    fn note(number: usize) -> impl FnOnce(&mut Log) -> Result<(), OutputError> {
        move |log| {
            log.lock().unwrap().push(number);
            Ok(())
        }
    }

    fn full() -> OutputError {
        OutputError { path: "frame".into(), source: io::ErrorKind::StorageFull.into() }
    }

    #[test]
    fn everything_is_written_in_order() {
        let (mut writer, log) = writer();
        for number in 0..100 {
            writer.make_room().unwrap();
            writer.hand_over(1, note(number));
        }
        writer.finish().unwrap();
        assert_eq!(*log.lock().unwrap(), (0..100).collect::<Vec<_>>());
    }

    #[test]
    fn the_first_error_is_told_once_and_what_follows_is_not_written() {
        let (mut writer, log) = writer();
        writer.hand_over(1, note(0));
        writer.hand_over(1, |_| Err(full()));
        writer.hand_over(1, note(1));
        let error = writer.finish().unwrap_err();
        assert_eq!(error.source.kind(), io::ErrorKind::StorageFull);
        assert_eq!(*log.lock().unwrap(), [0]);
        writer.hand_over(1, note(2));
        writer.finish().unwrap();
        assert_eq!(*log.lock().unwrap(), [0]);
    }

    #[test]
    fn an_answer_comes_after_all_that_was_handed_over_and_errors_take_its_place() {
        let (mut writer, _) = writer();
        writer.hand_over(1, note(3));
        assert_eq!(writer.ask(|log| Ok(log.lock().unwrap().clone())).unwrap(), [3]);
        writer.hand_over(1, |_| Err(full()));
        let error = writer.ask(|log| Ok(log.lock().unwrap().clone())).unwrap_err();
        assert_eq!(error.source.kind(), io::ErrorKind::StorageFull);
        let (mut writer, _) = self::writer();
        assert!(writer.ask(|_| Err::<(), _>(full())).is_err());
    }

    #[test]
    fn an_error_reaches_a_run_that_goes_on() {
        let (mut writer, _) = writer();
        writer.hand_over(ROOM, |_| Err(full()));
        assert!(writer.make_room().is_err(), "no room until it is known whether the large record is written");
    }

    #[test]
    fn a_large_record_waits_for_the_one_before() {
        let (mut writer, log) = writer();
        let (go, wait) = channel::<()>();
        writer.hand_over(ROOM, move |_| {
            // Hangs until the test lets it go, or for ever where the writer does not wait.
            let _ = wait.recv();
            Ok(())
        });
        let (through, watched) = channel();
        let waiter = std::thread::spawn(move || {
            writer.make_room().unwrap();
            through.send(()).unwrap();
            writer.hand_over(1, note(7));
        });
        assert_eq!(watched.recv_timeout(Duration::from_millis(50)), Err(RecvTimeoutError::Timeout));
        go.send(()).unwrap();
        watched.recv().unwrap();
        waiter.join().unwrap();
        assert_eq!(*log.lock().unwrap(), [7], "dropping a writer writes the rest");
    }

    /// A disk that takes nothing: the user is told once, a run goes on waiting, and one that is to stop does.
    #[test]
    fn a_disk_that_stands_still_is_told_of_once_and_waited_for_until_the_run_is_to_stop() {
        static TOLD: AtomicUsize = AtomicUsize::new(0);
        let patience = Patience {
            told_after: Duration::from_millis(60),
            given_up_after: Duration::from_millis(120),
            tell: |path, waited| {
                assert!(path == Path::new("slow") && waited >= Duration::from_millis(60));
                TOLD.fetch_add(1, Ordering::Relaxed);
            },
            ..Patience::default()
        };
        let stop = Arc::new(AtomicBool::new(false));
        let waiting = Arc::new(Waiting::new(patience, stop.clone(), None));
        let mut writers = [(), ()].map(|()| {
            let mut writer = Writer::start((), Path::new("slow"), &waiting).unwrap();
            let (hold, held) = channel::<()>();
            writer.hand_over(ROOM, move |()| {
                // For ever.
                let _ = held.recv();
                Ok(())
            });
            (writer, hold)
        });
        let begun = Instant::now();
        let stopper = std::thread::spawn(move || {
            std::thread::sleep(Duration::from_millis(300));
            stop.store(true, Ordering::Relaxed);
        });
        let error = writers[0].0.make_room().unwrap_err();
        stopper.join().unwrap();
        assert_eq!(error.source.kind(), io::ErrorKind::TimedOut);
        assert!(
            error.to_string().contains("slow") && begun.elapsed() >= Duration::from_millis(300),
            "{error}"
        );
        // The other does not wait as long again, and leaving does not wait at all.
        let error = writers[1].0.ask(|()| Ok(())).unwrap_err();
        assert_eq!(error.source.kind(), io::ErrorKind::TimedOut);
        let last = Instant::now();
        let holds: Vec<_> = writers.into_iter().map(|(_, hold)| hold).collect();
        assert!(last.elapsed() < Duration::from_millis(100));
        assert_eq!(TOLD.load(Ordering::Relaxed), 1);
        drop(holds);
    }
}
