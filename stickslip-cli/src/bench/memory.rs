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

/// Time that the processors have spent on this process, on threads that have ended too, in ticks of the system's clock
/// [s].
pub fn processor_time() -> Option<f64> {
    let record = std::fs::read_to_string("/proc/self/stat").ok()?;
    // Behind the name, which may hold anything: the state, ten other fields, time of its own and of the system for it.
    let (_, fields) = record.rsplit_once(')')?;
    let times = fields.split_whitespace().skip(11).take(2);
    Some(times.filter_map(|ticks| ticks.parse::<f64>().ok()).sum::<f64>() / TICKS)
}

/// Ticks in a second, as the kernel tells them to programs.
const TICKS: f64 = 100.0;

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
    fn time_of_threads_that_have_ended_counts() {
        let before = processor_time().unwrap();
        let work = || {
            let start = std::time::Instant::now();
            while start.elapsed().as_secs_f64() < 0.1 {
                std::hint::black_box((0..1000).sum::<u64>());
            }
        };
        while processor_time().unwrap() < before + 0.05 {
            std::thread::spawn(work).join().unwrap();
        }
    }

    #[test]
    fn memory_that_is_used_is_seen() {
        let before = peak().unwrap();
        let block = std::hint::black_box(vec![1_u8; 64 << 20]);
        assert!(peak().unwrap() >= before + block.len() as u64 / 2);
        assert!(available().unwrap() > 0);
    }
}
