//! A check of the memory of the machine before large allocations.

use crate::error::{Error, Result};

/// Returns an error where the machine has less than `needed` bytes for a grid of `shape`.
pub(crate) fn check_memory(shape: [usize; 2], needed: u64) -> Result<()> {
    // Small allocations are not checked, since the check itself takes time.
    if needed < 64 << 20 {
        return Ok(());
    }
    let Ok(mut system) = sysinfo::System::new() else {
        return Ok(());
    };
    system.refresh_memory();
    let machine = system.available_memory();
    let available =
        system.cgroup_limits().map_or(machine, |limits| machine.min(limits.free_memory));
    if available > 0 && needed > available {
        return Err(Error::Memory { shape, needed, available });
    }
    Ok(())
}
