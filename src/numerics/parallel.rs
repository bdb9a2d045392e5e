//! Work on many cells: threads, rows, lanes, and the memory that the work needs.
//!
//! Nothing here knows what is computed. Sums are made in an order that does not depend on the number of
//! threads.

use std::fmt;
use std::ops::{Deref, DerefMut};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

mod lanes;
mod memory;
mod rows;
mod threads;

pub(crate) use lanes::{
    Lanes, ONE, ZERO, all, dot, sum, update, update_with_largest, where_positive,
};
#[cfg(feature = "python")]
pub(crate) use memory::too_little;
pub(crate) use memory::{check_memory, memory_of};
pub(crate) use rows::{Row, Rows, Total};
pub(crate) use threads::{
    CAN_START_THREADS, LEAF, SetOnDrop, Threads, each_chunk, each_row, join, number,
};

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
