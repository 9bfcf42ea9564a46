//! What a thread that writes is at: it makes what it is to write, or the disk has it.
//!
//! Who waits for the thread counts only how long the disk takes nothing: making a large file takes as long as the
//! processors need, on which others may work too.

use std::cell::RefCell;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

thread_local! {
    static OWN: RefCell<Option<Arc<Work>>> = const { RefCell::new(None) };
}

/// The work of a thread that writes, as others see it.
#[derive(Debug, Default)]
pub(super) struct Work {
    /// Tasks of the processors that it is at.
    under_way: AtomicUsize,
    /// Such tasks that are done, and pieces that the disk took.
    done: AtomicU64,
}

impl Work {
    /// That of this thread from now on.
    pub(super) fn adopt(self: Arc<Self>) {
        OWN.set(Some(self));
    }

    /// Whether the thread is at a task of the processors, or something was done since `seen`, which is brought up to
    /// now.
    pub(super) fn goes_on(&self, seen: &mut u64) -> bool {
        let done = self.done.load(Ordering::Relaxed);
        let before = std::mem::replace(seen, done);
        done != before || self.under_way.load(Ordering::Relaxed) > 0
    }
}

/// Does a task of the processors, for which no disk is waited.
pub(super) fn work<X>(task: impl FnOnce() -> X) -> X {
    let own = OWN.with_borrow(Clone::clone);
    if let Some(own) = &own {
        own.under_way.fetch_add(1, Ordering::Relaxed);
    }
    let made = task();
    if let Some(own) = own {
        own.done.fetch_add(1, Ordering::Relaxed);
        own.under_way.fetch_sub(1, Ordering::Relaxed);
    }
    made
}

/// Takes note that the disk took something.
pub(super) fn took() {
    OWN.with_borrow(|own| {
        if let Some(own) = own {
            own.done.fetch_add(1, Ordering::Relaxed);
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_works_or_has_written_goes_on() {
        let own = Arc::new(Work::default());
        own.clone().adopt();
        let mut seen = 0;
        assert!(!own.goes_on(&mut seen));
        work(|| {
            assert!(own.goes_on(&mut seen));
            assert!(own.goes_on(&mut seen));
        });
        assert_eq!([0; 2].map(|_| own.goes_on(&mut seen)), [true, false]);
        took();
        assert_eq!([0; 2].map(|_| own.goes_on(&mut seen)), [true, false]);
        // Of another thread nothing counts.
        std::thread::spawn(took).join().unwrap();
        assert!(!own.goes_on(&mut seen));
    }
}
