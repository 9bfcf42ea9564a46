//! Large pages of memory: what streams through much memory spends less time on finding out where it is.

/// Asks the system to keep a range of memory in large pages, where it can; what is smaller than a few of them is left
/// alone.
pub fn ask_for_large<T>(first: *const T, count: usize) {
    /// Bytes of a large page of most processors.
    const LARGE: usize = 2 << 20;
    let bytes = count * size_of::<T>();
    if bytes < 2 * LARGE {
        return;
    }
    #[cfg(target_os = "linux")]
    {
        // SAFETY: it only asks.
        let page = usize::try_from(unsafe { libc::sysconf(libc::_SC_PAGESIZE) }).unwrap_or(LARGE);
        // With the pages at its ends, which are then asked for as all others: memory that is asked for in part cannot
        // grow where it is.
        let start = first.addr() / page * page;
        let end = (first.addr() + bytes).next_multiple_of(page);
        // SAFETY: the call changes nothing that a program can see but its speed, whoever has memory in these pages.
        // Where the system does not do as it is asked nothing is lost.
        unsafe { libc::madvise(start as *mut libc::c_void, end - start, libc::MADV_HUGEPAGE) };
    }
    #[cfg(not(target_os = "linux"))]
    let _ = first;
}
