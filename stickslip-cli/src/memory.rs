//! What happens where the system has no more memory to give: a sentence and exit code 1, not an abort.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::path::{Path, PathBuf};
use std::ptr::null_mut;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, AtomicPtr, Ordering};
use stickslip::observe::Checkpoint;

/// The system's memory; where it has none, the program ends as [`ran_out`] says.
pub struct EndsWithASentence;

// SAFETY: each call is the system's own with the same arguments. Where that gives nothing, the program ends.
unsafe impl GlobalAlloc for EndsWithASentence {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as the caller promises.
        given(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as the caller promises.
        given(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: as the caller promises.
        given(unsafe { System.realloc(block, layout, size) }, size)
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        // SAFETY: as the caller promises.
        unsafe { System.dealloc(block, layout) }
    }
}

#[inline]
fn given(block: *mut u8, size: usize) -> *mut u8 {
    if block.is_null() { ran_out(size) } else { block }
}

/// Memory that is given back where there is no more: what is said at the end needs some.
static RESERVE: AtomicPtr<u8> = AtomicPtr::new(null_mut());
const RESERVE_SIZE: usize = 1 << 20;
const RESERVED: Layout = Layout::new::<[u8; RESERVE_SIZE]>();

/// Where the run writes, if there is one.
static RESULTS: OnceLock<PathBuf> = OnceLock::new();

/// Whether the program is about to end.
static ENDS: AtomicBool = AtomicBool::new(false);
thread_local! {
    /// Whether it is this thread that ends it.
    static ENDS_HERE: Cell<bool> = const { Cell::new(false) };
}

/// Keeps some memory for the end; to be called first of all.
pub fn keep_some() {
    // SAFETY: the layout has a size.
    RESERVE.store(unsafe { System.alloc(RESERVED) }, Ordering::Release);
}

/// Says where the run writes that begins now: its newest checkpoint is named if memory runs out.
pub fn run_writes_to(results: &Path) {
    // A second run of the same program would be one of many, of which none is named.
    let _ = RESULTS.set(results.to_path_buf());
}

/// Ends the program where so many bytes more were refused: what is written is whole or has another name.
#[cold]
#[inline(never)]
fn ran_out(size: usize) -> ! {
    if ENDS_HERE.get() {
        end("error: out of memory\n");
    }
    if ENDS.swap(true, Ordering::AcqRel) {
        // Another thread ends the program.
        loop {
            std::thread::park();
        }
    }
    ENDS_HERE.set(true);
    let reserve = RESERVE.swap(null_mut(), Ordering::AcqRel);
    if !reserve.is_null() {
        // SAFETY: it was given by the system with this layout, and nobody else has it.
        unsafe { System.dealloc(reserve, RESERVED) };
    }
    let mut text = format!(
        "\nerror: out of memory: the system has no {} more to give\n",
        bytesize::ByteSize(size as u64).display().si()
    );
    let newest = |results: &PathBuf| Checkpoint::list(results).ok()?.into_iter().next();
    match RESULTS.get().map(|results| (results.display(), newest(results))) {
        None => text += "  help: larger cells, fewer particles, single precision, or a larger machine\n",
        Some((results, None)) => {
            text +=
                &format!("  help: what was written to {results} can be read; there is no checkpoint yet\n");
        }
        Some((results, Some(newest))) => {
            let newest = newest.display();
            text += &format!(
                "  help: what was written can be read, and `stickslip resume {results}` goes on from {newest}\n"
            );
        }
    }
    end(&text);
}

/// Says so without asking for memory, and ends at once: nobody else may wait for a lock that this thread has.
fn end(text: &str) -> ! {
    #[cfg(unix)]
    // SAFETY: the text is valid for its length; `_exit` ends the process.
    unsafe {
        libc::write(libc::STDERR_FILENO, text.as_ptr().cast(), text.len());
        libc::_exit(1);
    }
    #[cfg(not(unix))]
    {
        use std::io::Write;
        let _ = std::io::stderr().write_all(text.as_bytes());
        std::process::exit(1);
    }
}
