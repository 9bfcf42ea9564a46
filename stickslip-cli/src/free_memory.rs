//! What the machine has to give to a run.

/// Memory that the machine has free [bytes]; infinite where it does not say.
pub fn free_memory() -> f64 {
    let memory = sysinfo::MemoryRefreshKind::nothing().with_ram();
    let system = sysinfo::System::new_with_specifics(sysinfo::RefreshKind::nothing().with_memory(memory));
    let free = system.available_memory();
    let free = system.cgroup_limits().map_or(free, |limits| free.min(limits.free_memory));
    if free > 0 { free as f64 } else { f64::INFINITY }
}
