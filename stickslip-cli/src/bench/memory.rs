//! What this process takes of the machine, and what is left. Linux tells; elsewhere nobody does.

/// Most memory that this process ever held [bytes].
pub fn peak() -> Option<u64> {
    field("/proc/self/status", "VmHWM:")
}

/// Memory that the machine can still give without swapping [bytes].
pub fn available() -> Option<u64> {
    field("/proc/meminfo", "MemAvailable:")
}

/// Time that all threads of this process have had a core [s].
pub fn core_time() -> Option<f64> {
    let mut nanoseconds = 0.0;
    for thread in std::fs::read_dir("/proc/self/task").ok()? {
        let record = std::fs::read_to_string(thread.ok()?.path().join("schedstat")).ok()?;
        nanoseconds += record.split_whitespace().next()?.parse::<f64>().ok()?;
    }
    Some(1e-9 * nanoseconds)
}

/// The number of kilobytes after a name in one of the kernel's tables [bytes].
fn field(file: &str, name: &str) -> Option<u64> {
    let table = std::fs::read_to_string(file).ok()?;
    let line = table.lines().find_map(|line| line.strip_prefix(name))?;
    Some(line.split_whitespace().next()?.parse::<u64>().ok()? * 1024)
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    #[test]
    fn memory_that_is_used_is_seen() {
        let before = peak().unwrap();
        let block = std::hint::black_box(vec![1_u8; 64 << 20]);
        assert!(peak().unwrap() >= before + block.len() as u64 / 2);
        assert!(available().unwrap() > 0);
    }
}
