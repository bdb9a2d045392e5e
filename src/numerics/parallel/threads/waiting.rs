//! Waiting of the threads of a pool for each other.
//!
//! A solve divides its work hundreds of times, into pieces of a few milliseconds or less. A waiting or
//! idle thread of rayon yields its core; beside programs that keep all cores busy, it gets the core back
//! only milliseconds later. Therefore a thread that waits within a solve looks for work for about 0.1 ms,
//! and then alternates between looks and naps, after which the system gives it a core at once. Frequent
//! work is divided by [`join`], which waits in this way, and not by rayon's iterators.
//!
//! The method is nacre's own, and the values below were chosen by trial.

use std::cell::{Cell, OnceCell};
use std::hint::spin_loop;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;
use std::time::Duration;

use rayon::Yield;

/// Number of unsuccessful looks for work before a waiting thread begins to nap.
const LOOKS_BEFORE_NAPS: usize = 100;

/// Number of spin-loop hints between two looks, which take about a microsecond.
const SPINS: usize = 50;

/// Duration of the first naps, to which the system adds about as much. After every
/// [`LOOKS_BEFORE_NAPS`] naps, naps become longer by this duration.
const SHORTEST_NAP: Duration = Duration::from_micros(50);

/// Duration of the longest naps, in units of [`SHORTEST_NAP`].
const LONGEST_NAP: usize = 20;

/// Number of unsuccessful looks before a thread without work sleeps until it is woken: about 50 ms.
const LOOKS_BEFORE_SLEEP: usize = 4 * LOOKS_BEFORE_NAPS;

thread_local! {
    /// Number of calls that the pool of this thread is doing. Not set for a pool with more threads than
    /// cores, whose threads yield the cores to each other at once.
    static CALLS: OnceCell<Arc<AtomicUsize>> = const { OnceCell::new() };

    /// Whether this thread is doing work of its pool.
    static WITHIN: Cell<bool> = const { Cell::new(false) };
}

/// Makes this thread of a pool look for more work while `calls`, the number of calls of the pool, is
/// above 0.
pub(crate) fn linger_during(calls: &Arc<AtomicUsize>) {
    CALLS.with(|known| _ = known.set(Arc::clone(calls)));
}

/// Sets [`WITHIN`] until it is dropped, and then restores the previous value, which it holds.
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

/// Looks for work of the pool once and does it; returns whether there was any. Without work, `looks` is
/// increased, and the thread spins or naps, depending on the number of unsuccessful `looks`.
fn found_work(looks: &mut usize) -> bool {
    if rayon::yield_now() == Some(Yield::Executed) {
        *looks = 0;
        return true;
    }
    match (*looks / LOOKS_BEFORE_NAPS).min(LONGEST_NAP) {
        0 => pause(),
        naps => thread::sleep(SHORTEST_NAP * naps as u32),
    }
    *looks += 1;
    false
}

/// Spins for about a microsecond.
fn pause() {
    (0..SPINS).for_each(|_| spin_loop());
}

/// Looks for more work while the pool of this thread is used. A thread that is not `idle` may be inside
/// a wait for other work. After work was found, it returns to that wait, and a new task continues the
/// search later.
pub(crate) fn linger(idle: bool) {
    let within = Within::enter();
    let used = || CALLS.with(|calls| calls.get().map_or(0, |calls| calls.load(Ordering::Acquire)));
    let mut looks = 0;
    while !within.0 && looks < LOOKS_BEFORE_SLEEP && used() > 0 {
        if found_work(&mut looks) && !idle {
            rayon::spawn(|| linger(false));
            return;
        }
    }
}

/// Sets a flag when it is dropped, also by a panic.
pub(crate) struct SetOnDrop<'a>(pub(crate) &'a AtomicBool);

impl Drop for SetOnDrop<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Release);
    }
}

/// Calls both functions, in parallel where another thread of the pool is free.
pub(crate) fn join<A: Send, B: Send>(
    first: impl FnOnce() -> A + Send,
    second: impl FnOnce() -> B + Send,
) -> (A, B) {
    let ended = AtomicBool::new(false);
    rayon::join_context(
        |_| {
            let _within = Within::enter();
            let done = first();
            // If no other thread has taken the second function, the first look finds it. All waiting is
            // done here, since rayon yields the core while it waits.
            let (mut looks, mut found) = (0, true);
            while !ended.load(Ordering::Acquire) {
                found = found_work(&mut looks);
            }
            if !found {
                // Gives rayon time to register the end of the second function.
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
                // This thread finds the new task as soon as this function returns.
                rayon::spawn(|| linger(false));
            }
            done
        },
    )
}
