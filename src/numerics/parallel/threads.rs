//! Threads that belong to a plan, and the division of work among them.

use std::fmt;
use std::hint::spin_loop;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use rayon::{ThreadPool, ThreadPoolBuilder, Yield};

use crate::error::{Error, Result};
use crate::numerics::clock;

/// Largest permitted number of threads. Larger numbers are taken for mistakes, since each thread has a
/// stack and working memory.
const THREAD_LIMIT: usize = 256;

/// Smallest number of cells for which work is divided among sleeping threads: 2¹⁵ ≈ 181². With fewer
/// cells, one transform or pass over a grid is finished before a second thread wakes, which takes a
/// tenth of a millisecond (measured, `benches/README.md`).
const DIVIDED_CELLS: usize = 1 << 15;

/// Smallest number of cells for which work is divided among threads that are awake, as within a solve:
/// 2¹³ ≈ 91². Measured: solves of 256² cells on two threads take 3.1 ms, and 3.5 ms with the value
/// for sleeping threads (`benches/README.md`).
const DIVIDED_CELLS_AWAKE: usize = 1 << 13;

/// Number of cells that one task processes without further division: a few microseconds of work, in
/// arrays of 64 KiB that stay in the caches of one core. The value was chosen by trial.
pub(crate) const LEAF: usize = 1 << 13;

/// Whether work on `cells` cells takes long enough to be divided among threads.
pub(crate) fn worth_dividing(cells: usize) -> bool {
    match rayon::current_thread_index() {
        Some(_) => cells >= DIVIDED_CELLS_AWAKE,
        None => cells >= DIVIDED_CELLS,
    }
}

/// Whether the system can start threads: not in a browser.
pub(crate) const CAN_START_THREADS: bool = !cfg!(target_family = "wasm");

/// Environment variable that limits the number of threads of plans.
const OWN_VARIABLE: &str = "NACRE_NUM_THREADS";

/// Variables that take its place where it is not set: batch scripts and pools of processes set them, so that
/// processes on one machine do not start cores × cores threads. Values that are no number of threads are
/// ignored, since they are meant for others.
const SHARED_VARIABLES: [&str; 2] = ["RAYON_NUM_THREADS", "OMP_NUM_THREADS"];

/// Number of threads that can be had of those that are wanted: one where none can be started.
fn startable(wanted: usize, can_start: bool) -> usize {
    if can_start { wanted.min(THREAD_LIMIT) } else { 1 }
}

/// Number of threads where none is given: as many as the machine offers this process, and not more than the
/// first of the environment variables says. `variable` returns the value of one.
///
/// # Errors
/// Where the value of [`OWN_VARIABLE`] is no number of threads.
fn default_count(variable: impl Fn(&str) -> Option<String>) -> Result<usize> {
    let offered =
        startable(thread::available_parallelism().map_or(1, usize::from), CAN_START_THREADS);
    let set = |name: &str| variable(name).filter(|value| !value.trim().is_empty());
    let number = |value: &str| value.trim().parse().ok().filter(|&count: &usize| count > 0);
    if let Some(value) = set(OWN_VARIABLE) {
        let requirement = "a whole number of at least 1";
        let limit = number(&value).ok_or(Error::Choice { name: OWN_VARIABLE, requirement, value });
        return Ok(offered.min(limit?));
    }
    // OpenMP permits a list: the numbers of nested levels.
    let first = |value: String| number(value.split(',').next()?);
    let limit = SHARED_VARIABLES.into_iter().find_map(|name| set(name).and_then(first));
    Ok(limit.map_or(offered, |limit| offered.min(limit)))
}

/// A number of threads, and the pool of these threads, which is created at first use.
///
/// The threads sleep when idle. A forked process has the plan but not the threads, and creates a new
/// pool.
pub(crate) struct Threads {
    count: usize,
    /// The pool, with the identifier of the process that created it.
    pool: Mutex<Option<(u32, Arc<SharedPool>)>>,
}

/// A pool of threads, and the calls from other threads that share it.
struct SharedPool {
    threads: ThreadPool,
    /// Number of calls from other threads that have not returned.
    calls: AtomicUsize,
}

impl fmt::Debug for Threads {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Threads({})", self.count)
    }
}

impl Threads {
    /// `count` threads; where it is `None`, as many as the machine offers this process, or fewer where environment
    /// variables say so.
    ///
    /// # Errors
    /// Unless there are 1 to 256; a wrong value of the variable.
    pub(crate) fn new(count: Option<usize>) -> Result<Self> {
        let default = || default_count(|name| std::env::var(name).ok());
        match count.map_or_else(default, Ok)? {
            0 => Err(Error::Parameter { name: "threads", requirement: "at least 1", value: 0.0 }),
            count if count > THREAD_LIMIT => Err(Error::Parameter {
                name: "threads",
                requirement: "at most 256",
                value: count as f64,
            }),
            count => {
                Ok(Self { count: startable(count, CAN_START_THREADS), pool: Mutex::new(None) })
            }
        }
    }

    pub(crate) fn count(&self) -> usize {
        self.count
    }

    /// Whether work on `cells` cells is to be divided among the threads.
    pub(crate) fn divide(&self, cells: usize) -> bool {
        self.count > 1 && worth_dividing(cells)
    }

    /// Calls `work` on one of the threads, where rayon's parallel iterators use all of them.
    pub(crate) fn run<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        match self.pool().filter(|pool| pool.threads.current_thread_index().is_none()) {
            Some(pool) => {
                pool.calls.fetch_add(1, Ordering::AcqRel);
                pool.install(work)
            }
            None => {
                stay_here();
                work()
            }
        }
    }

    /// Calls `work`, which processes `cells` cells many times, on one of the threads where the cells are
    /// many and no other call uses the threads; otherwise on the calling thread. Inside, work is divided
    /// at once, whereas each division from outside the pool takes a tenth of a millisecond.
    ///
    /// At most one call runs inside, so that `work` leaves a thread of the pool to calls that it waits for. It does not
    /// run inside while another call is under way, which might have to wait for it.
    pub(crate) fn run_inside<R: Send>(&self, cells: usize, work: impl FnOnce() -> R + Send) -> R {
        let alone = |pool: &Arc<SharedPool>| {
            let (none, one) = (0, 1);
            pool.calls.compare_exchange(none, one, Ordering::AcqRel, Ordering::Acquire).is_ok()
        };
        match self.divide(cells).then(|| self.pool()).flatten().filter(alone) {
            Some(pool) => pool.install(work),
            None => work(),
        }
    }

    /// Calls both functions, in parallel where the caller is one of the threads. Another caller calls them
    /// one after the other: in the pool, a function that waits for other work would keep a thread from
    /// that work.
    pub(crate) fn both<A: Send, B: Send>(
        &self,
        first: impl FnOnce() -> A + Send,
        second: impl FnOnce() -> B + Send,
    ) -> (A, B) {
        match self.pool() {
            Some(pool) if pool.threads.current_thread_index().is_some() => join(first, second),
            _ => (first(), second()),
        }
    }

    fn pool(&self) -> Option<Arc<SharedPool>> {
        let process = clock::process();
        let mut pool = self.pool.lock().unwrap_or_else(PoisonError::into_inner);
        match &*pool {
            Some((owner, pool)) if *owner == process => Some(Arc::clone(pool)),
            _ => {
                let new = Arc::new(SharedPool {
                    threads: ThreadPoolBuilder::new().num_threads(self.count).build().ok()?,
                    calls: AtomicUsize::new(0),
                });
                if let Some((_, forked)) = pool.replace((process, Arc::clone(&new))) {
                    // The threads of the old pool do not exist in a forked process and cannot be joined.
                    std::mem::forget(forked);
                }
                Some(new)
            }
        }
    }
}

/// Makes a pool of the calling thread alone where it belongs to none, as where the system starts no more threads.
/// Parallel iterators would start rayon's global pool otherwise, and panic. The pool lasts as long as the thread.
fn stay_here() {
    if rayon::current_thread_index().is_none()
        && let Ok(pool) = ThreadPoolBuilder::new().num_threads(1).use_current_thread().build()
    {
        std::mem::forget(pool);
    }
}

impl SharedPool {
    /// Calls `work`, which was counted as a call, on one of the threads.
    fn install<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        let _call = RunningCall(&self.calls);
        self.threads.install(work)
    }
}

/// A call that is under way.
struct RunningCall<'a>(&'a AtomicUsize);

impl Drop for RunningCall<'_> {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::AcqRel);
    }
}

/// Sets a flag when it is dropped, also by a panic.
pub(crate) struct SetOnDrop<'a>(pub(crate) &'a AtomicBool);

impl Drop for SetOnDrop<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Release);
    }
}

/// Number of times that a waiting thread looks for other work before it naps between two looks.
const LOOKS: usize = 200;

/// Duration of a nap, to which the system adds about as much.
const NAP: Duration = Duration::from_micros(50);

/// Spins for about a microsecond.
fn pause() {
    (0..50).for_each(|_| spin_loop());
}

/// Calls both functions, in parallel where another thread of the pool is free.
///
/// A solve divides its work hundreds of times, into pieces of a few milliseconds or less. A thread that
/// waits as rayon does yields its core and, beside programs that keep all cores busy, gets it back only
/// milliseconds later. Therefore all waiting is done here, by spinning and then by naps, after which the
/// system gives the thread a core at once.
pub(crate) fn join<A: Send, B: Send>(
    first: impl FnOnce() -> A + Send,
    second: impl FnOnce() -> B + Send,
) -> (A, B) {
    let ended = AtomicBool::new(false);
    rayon::join(
        || {
            let done = first();
            // If no other thread has taken the second function, the first look finds it.
            let mut looks = 0;
            while !ended.load(Ordering::Acquire) {
                match rayon::yield_now() {
                    Some(Yield::Executed) => looks = 0,
                    _ if looks < LOOKS => {
                        pause();
                        looks += 1;
                    }
                    _ => thread::sleep(NAP),
                }
            }
            // Gives rayon time to register the end of the second function.
            if looks > 0 {
                pause();
            }
            done
        },
        || {
            let _end = SetOnDrop(&ended);
            second()
        },
    )
}

/// Index of the current thread in its pool; 0 for a thread outside any pool.
pub(crate) fn number() -> usize {
    rayon::current_thread_index().unwrap_or(0)
}

/// Divides `data` into chunks of `length` elements, and calls `work` for each with the index of the
/// chunk and its elements; `first` is the index of the first chunk.
pub(crate) fn each_chunk<T: Send>(
    data: &mut [T],
    length: usize,
    first: usize,
    work: &(impl Fn(usize, &mut [T]) + Sync),
) {
    if data.len() <= length {
        if !data.is_empty() {
            work(first, data);
        }
        return;
    }
    let half = data.len().div_ceil(length) / 2;
    let (near, far) = data.split_at_mut(half * length);
    join(|| each_chunk(near, length, first, work), || each_chunk(far, length, first + half, work));
}

/// Calls `work` for each row of `data`, of `length` elements, with the index of the row; in parallel where
/// the caller is a thread of a pool. (Rayon's global pool would not survive a fork.)
pub(crate) fn each_row<T: Send>(
    data: &mut [T],
    length: usize,
    work: impl Fn(usize, &mut [T]) + Sync,
) {
    let length = length.max(1);
    let rows = (LEAF / length).max(1);
    let some = |k: usize, part: &mut [T]| {
        for (i, row) in part.chunks_exact_mut(length).enumerate() {
            work(k * rows + i, row);
        }
    };
    if rayon::current_thread_index().is_some() && worth_dividing(data.len()) {
        each_chunk(data, rows * length, 0, &some);
    } else {
        some(0, data);
    }
}

#[cfg(test)]
mod tests {
    use std::panic::{AssertUnwindSafe, catch_unwind};
    use std::sync::Arc;
    use std::sync::mpsc::channel;
    use std::thread;
    use std::time::Duration;

    use super::{
        DIVIDED_CELLS, LEAF, THREAD_LIMIT, Threads, default_count, each_chunk, each_row, join,
        number, startable, stay_here,
    };
    use crate::error::Result;

    /// Time after which a call counts as hanging, on a busy machine too.
    const HANG: Duration = Duration::from_secs(600);

    #[test]
    fn one_thread_does_all_where_none_can_be_started() -> Result<()> {
        for wanted in [1, 2, 8, THREAD_LIMIT, 4000] {
            assert_eq!(startable(wanted, false), 1);
            assert_eq!(startable(wanted, true), wanted.min(THREAD_LIMIT));
        }
        // As in a browser, where no pool can be had: the caller does all, nothing is divided.
        let alone = Threads::new(Some(startable(8, false)))?;
        assert_eq!(alone.count(), 1);
        assert!(!alone.divide(DIVIDED_CELLS));
        assert_eq!(alone.run(rayon::current_num_threads), 1);
        Ok(())
    }

    /// Whether the caller is a thread of a pool.
    fn in_pool() -> bool {
        rayon::current_thread_index().is_some()
    }

    #[test]
    fn the_first_variable_that_is_set_limits_the_threads() -> Result<()> {
        let [nacre, rayon, openmp] = ["NACRE_NUM_THREADS", "RAYON_NUM_THREADS", "OMP_NUM_THREADS"];
        let count = |set: &[(&str, &str)]| {
            default_count(|name| Some(set.iter().find(|(n, _)| *n == name)?.1.to_owned()))
        };
        let all = count(&[])?;
        assert!((1..=256).contains(&all));
        for name in [nacre, rayon, openmp] {
            assert_eq!(count(&[(name, "1")])?, 1);
            assert_eq!(count(&[(name, " 1 ")])?, 1);
            assert_eq!(count(&[(name, "4000")])?, all);
            assert_eq!(count(&[(name, "")])?, all);
        }
        assert_eq!(count(&[(nacre, "4000"), (rayon, "1"), (openmp, "1")])?, all);
        assert_eq!(count(&[(rayon, "4000"), (openmp, "1")])?, all);
        assert_eq!(count(&[(openmp, "1,4")])?, 1);
        // In RAYON_NUM_THREADS, 0 stands for all.
        for ignored in ["0", "-1", "many", "1.5"] {
            assert_eq!(count(&[(rayon, ignored), (openmp, "1")])?, 1);
            assert_eq!(count(&[(openmp, ignored)])?, all);
            let message = count(&[(nacre, ignored)]).expect_err("no number of threads").to_string();
            let wanted = "NACRE_NUM_THREADS must be a whole number of at least 1, got";
            assert_eq!(message, format!("{wanted} {ignored:?}"));
        }
        Ok(())
    }

    #[test]
    fn each_chunk_is_seen_once() -> Result<()> {
        for count in [1, 2, 5] {
            let threads = Threads::new(Some(count))?;
            for (elements, length) in [(0, 3), (1, 3), (3, 3), (4, 3), (700, 9), (1000, 1)] {
                let mut data = vec![0; elements];
                threads.run(|| {
                    each_chunk(&mut data, length, 7, &|k, part| {
                        assert_eq!(part.len(), length.min(elements - (k - 7) * length));
                        assert!(number() < count);
                        part.iter_mut().for_each(|element| *element += k);
                    });
                });
                for (element, number) in data.iter().enumerate() {
                    assert_eq!(*number, 7 + element / length);
                }
            }
        }
        Ok(())
    }

    #[test]
    fn each_row_is_seen_once() -> Result<()> {
        let threads = Threads::new(Some(3))?;
        for (rows, length) in [(0, 3), (5, 0), (1, 2 * LEAF), (7, LEAF / 2 + 1), (9 * LEAF, 1)] {
            let seen = |data: &mut [usize]| {
                each_row(data, length, |k, row| {
                    assert_eq!(row.len(), length);
                    row.iter_mut().for_each(|element| *element += k);
                });
            };
            let (mut here, mut there) = (vec![0; rows * length], vec![0; rows * length]);
            seen(&mut here);
            threads.run(|| seen(&mut there));
            let expected: Vec<_> = (0..rows * length).map(|n| n / length).collect();
            assert_eq!([&here, &there], [&expected; 2]);
        }
        Ok(())
    }

    #[test]
    fn both_are_done_here_unless_this_is_one_of_the_threads() -> Result<()> {
        let threads = Threads::new(Some(2))?;
        assert_eq!(threads.both(in_pool, in_pool), (false, false));
        let within = threads.run(|| threads.both(in_pool, in_pool));
        assert_eq!(within, (true, true));
        Ok(())
    }

    #[test]
    fn a_thread_that_stays_alone_does_all_work() -> Result<()> {
        let threads = Threads::new(Some(2))?;
        let alone = thread::spawn(|| {
            stay_here();
            stay_here();
            let (here, there) = join(|| thread::current().id(), || thread::current().id());
            here == there && rayon::current_num_threads() == 1
        });
        assert!(alone.join().is_ok_and(|alone| alone));
        assert_eq!(threads.run(rayon::current_num_threads), 2);
        Ok(())
    }

    /// Calls that wait for calls from other threads end, as of solves whose callbacks solve with the same
    /// plan.
    #[test]
    fn calls_that_wait_for_calls_end() -> Result<()> {
        fn nested(threads: Arc<Threads>, depth: u32) -> Option<u32> {
            let (sender, receiver) = channel();
            let within = Arc::clone(&threads);
            thread::spawn(move || {
                let _ = sender.send(threads.run_inside(DIVIDED_CELLS, || {
                    let deeper = match depth {
                        0 => 0,
                        _ => nested(within, depth - 1)?,
                    };
                    let (one, more) = threads.run(|| join(|| 1, || deeper));
                    Some(one + more)
                }));
            });
            // The time limit makes the test fail where the calls do not end.
            receiver.recv_timeout(HANG).ok()?
        }
        assert_eq!(nested(Arc::new(Threads::new(Some(2))?), 5), Some(6));
        Ok(())
    }

    #[test]
    fn a_panic_of_the_other_half_reaches_the_caller() -> Result<()> {
        let threads = Threads::new(Some(2))?;
        let (sender, receiver) = channel();
        thread::spawn(move || {
            let (started, starts) = channel();
            let wait = move || starts.recv_timeout(HANG / 2).is_ok();
            let panics = move || {
                let _ = started.send(());
                panic!("on purpose");
            };
            let call = || threads.run_inside(DIVIDED_CELLS, || join(wait, panics));
            let _ = sender.send(catch_unwind(AssertUnwindSafe(call)).is_err());
        });
        // The time limit makes the test fail where the first half waits forever.
        assert_eq!(receiver.recv_timeout(HANG), Ok(true));
        Ok(())
    }

    #[test]
    fn a_panic_reaches_the_caller_and_leaves_the_threads_as_they_were() -> Result<()> {
        let threads = Threads::new(Some(2))?;
        for cells in [DIVIDED_CELLS, DIVIDED_CELLS - 1] {
            let call = || threads.run_inside(cells, || threads.run(|| panic!("on purpose")));
            assert!(catch_unwind(AssertUnwindSafe(call)).is_err());
            assert_eq!(threads.run_inside(cells, in_pool), cells == DIVIDED_CELLS);
        }
        Ok(())
    }
}
