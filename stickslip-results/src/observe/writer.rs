//! A thread that writes, so that the run goes on while files grow.

use super::file::OutputError;
use std::io;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::{Builder, JoinHandle};

/// Bytes that may wait: what is handed over next is made once less than this is waiting, so that neither many small
/// records nor two large ones pile up in memory.
const ROOM: usize = 64 << 20;

/// Writes what it is handed, in that order, on a thread of its own that owns the files `F`.
///
/// The first error ends it: it is returned by the next call, and nothing that was handed over later is written.
pub struct Writer<F> {
    tasks: Option<Sender<(usize, WriterTask<F>)>>,
    done: Receiver<(usize, Result<(), OutputError>)>,
    /// Bytes handed over and not yet written.
    waiting: usize,
    thread: Option<JoinHandle<()>>,
}

type WriterTask<F> = Box<dyn FnOnce(&mut F) -> Result<(), OutputError> + Send>;

impl<F: Send + 'static> Writer<F> {
    /// Starts the thread.
    ///
    /// # Errors
    /// The system gives no thread.
    pub fn start(mut files: F) -> io::Result<Self> {
        let (tasks, handed_over) = channel::<(usize, WriterTask<F>)>();
        let (report, done) = channel();
        let thread = Builder::new().name("writer".to_string()).spawn(move || {
            for (bytes, task) in handed_over {
                let result = task(&mut files);
                let failed = result.is_err();
                // Nobody listens any more: then nobody waits for the rest either, but it is written.
                let _ = report.send((bytes, result));
                if failed {
                    return;
                }
            }
        })?;
        Ok(Writer { tasks: Some(tasks), done, waiting: 0, thread: Some(thread) })
    }

    /// Waits until there is room for another record.
    ///
    /// # Errors
    /// Something that was handed over before could not be written.
    pub fn make_room(&mut self) -> Result<(), OutputError> {
        self.wait_until(|waiting| waiting < ROOM)
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
            self.waiting += bytes;
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
        answered.recv().map_err(|_| {
            let ended = || OutputError { path: "writer".into(), source: io::ErrorKind::BrokenPipe.into() };
            self.wait_until(|_| false).err().unwrap_or_else(ended)
        })
    }

    /// Waits until everything is written.
    ///
    /// # Errors
    /// Something could not be written.
    pub fn finish(&mut self) -> Result<(), OutputError> {
        self.tasks = None;
        let result = self.wait_until(|_| false);
        self.end();
        result
    }

    /// Takes note of what was written, until so few bytes wait or nothing will be written any more.
    fn wait_until(&mut self, few: impl Fn(usize) -> bool) -> Result<(), OutputError> {
        loop {
            let report = if few(self.waiting) { self.done.try_recv().ok() } else { self.done.recv().ok() };
            let Some((bytes, result)) = report else { return Ok(()) };
            self.waiting -= bytes;
            result?;
        }
    }
}

impl<F> Writer<F> {
    fn end(&mut self) {
        self.tasks = None;
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
    use std::sync::mpsc::RecvTimeoutError;
    use std::sync::{Arc, Mutex};
    use std::time::Duration;

    type Log = Arc<Mutex<Vec<usize>>>;

    fn writer() -> (Writer<Log>, Log) {
        let log = Log::default();
        (Writer::start(log.clone()).unwrap(), log)
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
}
