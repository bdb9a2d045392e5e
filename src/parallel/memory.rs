//! The machine's memory, looked at before much of it is asked for.

use crate::error::{Error, Result};

/// An error where the machine has less than `needed` bytes.
pub(crate) fn check_memory(shape: [usize; 2], needed: u64) -> Result<()> {
    // A small grid needs no look at the machine.
    if needed < 64 << 20 {
        return Ok(());
    }
    let Ok(mut system) = sysinfo::System::new() else {
        return Ok(());
    };
    system.refresh_memory();
    let machine = system.available_memory();
    let available = system
        .cgroup_limits()
        .map_or(machine, |limits| machine.min(limits.free_memory));
    if available > 0 && needed > available {
        return Err(Error::Memory {
            shape,
            needed,
            available,
        });
    }
    Ok(())
}
