//! A pool of threads that belongs to a plan.

use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::error::{Error, Result};

/// More threads than that are a mistake: each has a stack and memory of its own.
const MOST: usize = 256;

/// Below this number of cells a transform, or a pass over a grid, is done before a second thread
/// is awake: a tenth of a millisecond (measured: `benches/README.md`).
const WORTH: usize = 1 << 15;

/// A number of threads, and the pool that is made at the first use.
///
/// The pool sleeps when idle. A process that was forked has the plan but not its threads: there
/// the pool is made anew.
pub(crate) struct Threads {
    count: usize,
    pool: Mutex<Option<(u32, Arc<ThreadPool>)>>,
}

impl fmt::Debug for Threads {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Threads({})", self.count)
    }
}

impl Threads {
    /// `count` threads, or as many as the machine offers this process.
    pub(crate) fn new(count: Option<usize>) -> Result<Self> {
        let available = || std::thread::available_parallelism().map_or(1, usize::from);
        match count.unwrap_or_else(available) {
            0 => Err(Error::Parameter {
                name: "threads",
                requirement: "at least 1",
                value: 0.0,
            }),
            count if count > MOST => Err(Error::Parameter {
                name: "threads",
                requirement: "at most 256",
                value: count as f64,
            }),
            count => Ok(Self {
                count,
                pool: Mutex::new(None),
            }),
        }
    }

    pub(crate) fn count(&self) -> usize {
        self.count
    }

    /// Whether to divide among them what is done with `cells` cells.
    pub(crate) fn divide(&self, cells: usize) -> bool {
        self.count > 1 && cells >= WORTH
    }

    /// Calls `work` where rayon's parallel iterators use these threads.
    pub(crate) fn run<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        match self.pool() {
            Some(pool) => pool.install(work),
            None => work(),
        }
    }

    fn pool(&self) -> Option<Arc<ThreadPool>> {
        let process = std::process::id();
        let mut pool = self.pool.lock().unwrap_or_else(PoisonError::into_inner);
        match &*pool {
            Some((owner, pool)) if *owner == process => Some(Arc::clone(pool)),
            _ => {
                let new = ThreadPoolBuilder::new()
                    .num_threads(self.count)
                    .build()
                    .ok()?;
                let new = Arc::new(new);
                if let Some((_, forked)) = pool.replace((process, Arc::clone(&new))) {
                    // Its threads do not exist here: there is nothing that could be joined.
                    std::mem::forget(forked);
                }
                Some(new)
            }
        }
    }
}
