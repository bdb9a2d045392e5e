//! Work on many cells: threads, rows, lanes, and the memory that the work needs.
//!
//! Nothing here knows what is computed. Sums are made in an order that does not depend on the number of
//! threads.

use std::fmt;
use std::ops::{Deref, DerefMut};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::error::{Error, Result};

mod lanes;
mod rows;
mod threads;

pub(crate) use lanes::{
    Lanes, ONE, ZERO, all, dot, sum, update, update_with_largest, where_positive,
};
pub(crate) use rows::{Row, Rows, Total};
pub(crate) use threads::{LEAF, SetOnDrop, Threads, each_chunk, each_row, join, number};

/// Bytes of `arrays` arrays of the cells of a grid as transforms keep them: whole blocks of columns, at lengths that are
/// products of small primes. Together they are a fifth more than the cells.
pub(crate) fn memory_of(shape: [usize; 2], arrays: usize) -> u64 {
    let [nx, ny] = shape.map(|n| n as u64);
    (nx + 1) * (ny + 8) * 8 * arrays as u64 * 6 / 5
}

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

/// A store of memory that is not in use; clones share the store.
pub(crate) struct Pool<T>(Arc<Mutex<Vec<T>>>);

impl<T> Pool<T> {
    fn lock(&self) -> MutexGuard<'_, Vec<T>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<T: Default> Pool<T> {
    /// Memory from the store, or new memory. It holds arbitrary values from earlier use.
    pub(crate) fn lease(&self) -> Lease<T> {
        let memory = self.lock().pop().unwrap_or_default();
        Lease { memory, pool: self.clone() }
    }
}

impl<T> Default for Pool<T> {
    fn default() -> Self {
        Self(Arc::default())
    }
}

impl<T> Clone for Pool<T> {
    fn clone(&self) -> Self {
        Self(Arc::clone(&self.0))
    }
}

impl<T> fmt::Debug for Pool<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Pool({} idle)", self.lock().len())
    }
}

/// Memory in use, which returns to its store when it is dropped.
#[derive(Debug)]
pub(crate) struct Lease<T: Default> {
    memory: T,
    pool: Pool<T>,
}

impl<T: Default> Drop for Lease<T> {
    fn drop(&mut self) {
        self.pool.lock().push(std::mem::take(&mut self.memory));
    }
}

impl<T: Default> Deref for Lease<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.memory
    }
}

impl<T: Default> DerefMut for Lease<T> {
    fn deref_mut(&mut self) -> &mut T {
        &mut self.memory
    }
}
