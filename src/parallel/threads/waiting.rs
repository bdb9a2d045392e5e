//! How threads of a pool wait for each other.
//!
//! A solve divides its work hundreds of times, for a few milliseconds or less each. Left to itself, a
//! thread of rayon's that waits, or finds nothing to do, gives its core away; beside programs that keep
//! all cores busy it is back milliseconds later. So whoever waits within a solve looks for work
//! for some 0.1 ms, then between naps, after which it has its core at once; and what is done often
//! there is divided by [`join`], not by rayon's iterators.

use std::cell::{Cell, OnceCell};
use std::hint::spin_loop;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;
use std::time::Duration;

use rayon::Yield;

/// Looks for work, in vain, before a thread that waits takes naps.
const LOOKS: usize = 100;

/// Pauses of the processor between two looks: a microsecond or so.
const PAUSES: usize = 50;

/// The first naps, with which the system takes about as long again; each hundred is as much longer.
const NAP: Duration = Duration::from_micros(50);

/// The longest naps, in these.
const LONGEST: usize = 20;

/// Looks and naps, in vain, before a thread without work sleeps until it is woken: some 50 ms.
const PATIENCE: usize = 4 * LOOKS;

thread_local! {
    /// Calls of the pool whose thread this is; none where there are more threads than cores, which
    /// leave these to each other.
    static CALLS: OnceCell<Arc<AtomicUsize>> = const { OnceCell::new() };

    /// Whether this thread is within work of its pool.
    static WITHIN: Cell<bool> = const { Cell::new(false) };
}

/// From now on this thread, which is one of a pool's, looks for more work while there are `calls` of that.
pub(crate) fn linger_during(calls: &Arc<AtomicUsize>) {
    CALLS.with(|known| _ = known.set(Arc::clone(calls)));
}

/// What [`WITHIN`] was before this, and is again when this is dropped.
pub(crate) struct Within(bool);

impl Within {
    pub(crate) fn enter() -> Self {
        Self(WITHIN.replace(true))
    }
}

impl Drop for Within {
    fn drop(&mut self) {
        WITHIN.set(self.0);
    }
}

/// Whether there was something to do for the pool, which is done then; else, having looked so often
/// in vain, it took a pause, or a nap.
fn found_work(looks: &mut usize) -> bool {
    if rayon::yield_now() == Some(Yield::Executed) {
        *looks = 0;
        return true;
    }
    match (*looks / LOOKS).min(LONGEST) {
        0 => pause(),
        naps => thread::sleep(NAP * naps as u32),
    }
    *looks += 1;
    false
}

fn pause() {
    (0..PAUSES).for_each(|_| spin_loop());
}

/// Looks for more work on a thread that has nothing else to do, while its pool is used. Where it is not
/// known to be `idle` but may be within a wait for something else, that ends once it found some, and
/// goes on afterwards.
pub(crate) fn linger(idle: bool) {
    let within = Within::enter();
    let used = || CALLS.with(|calls| calls.get().map_or(0, |calls| calls.load(Ordering::Acquire)));
    let mut looks = 0;
    while !within.0 && looks < PATIENCE && used() > 0 {
        if found_work(&mut looks) && !idle {
            rayon::spawn(|| linger(false));
            return;
        }
    }
}

/// Becomes true when this is dropped, by a panic or not.
pub(crate) struct SetOnDrop<'a>(pub(crate) &'a AtomicBool);

impl Drop for SetOnDrop<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Release);
    }
}

/// Calls both, at once where another thread of the pool is free for the second.
pub(crate) fn join<A: Send, B: Send>(
    first: impl FnOnce() -> A + Send,
    second: impl FnOnce() -> B + Send,
) -> (A, B) {
    let ended = AtomicBool::new(false);
    rayon::join_context(
        |_| {
            let _within = Within::enter();
            let done = first();
            // If nobody has taken the second, it is found at the first look. All waiting is done here:
            // where rayon waits it gives its core away.
            let (mut looks, mut found) = (0, true);
            while !ended.load(Ordering::Acquire) {
                found = found_work(&mut looks);
            }
            if !found {
                // Until rayon has heard of it, too.
                pause();
            }
            done
        },
        |context| {
            let within = Within::enter();
            let end = SetOnDrop(&ended);
            let done = second();
            drop(end);
            if context.migrated() && !within.0 {
                // Found at once when this returns.
                rayon::spawn(|| linger(false));
            }
            done
        },
    )
}
