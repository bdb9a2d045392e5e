//! Many load cases on one plan, side by side.

use std::convert::Infallible;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use super::options::Motion;
use super::options::Options;
use super::plan::Plan;
use super::solution::Solution;
use super::solver::Termination;
use super::start::Sampled;
use crate::error::Result;
use crate::model::surface::Surface;
use crate::numerics::parallel::{SetOnDrop, Threads, check_memory};

/// One of many load cases.
#[derive(Debug, Clone, Copy)]
pub struct Case<'a> {
    /// The shape that is pressed into the body.
    pub shape: &'a dyn Surface,
    /// The motion that is prescribed, or the load.
    pub motion: Motion,
}

/// Time between two calls that ask the caller whether to go on: far below the 0.2 s within which an
/// interrupt must act.
const ASKING_INTERVAL: Duration = Duration::from_millis(20);

/// Solves all cases and keeps the solutions; see [`Contact::solve_many`](super::Contact::solve_many).
pub(super) fn solve_many(
    plan: &Plan,
    cases: &[Case],
    options: &Options,
    progress: &mut dyn FnMut(usize) -> ControlFlow<()>,
) -> Result<Vec<Option<Result<Solution>>>> {
    check_memory_for(plan, cases)?;
    let solutions: Vec<Option<Result<Solution>>> = cases.iter().map(|_| None).collect();
    let (solutions, done) = (Mutex::new(solutions), AtomicUsize::new(0));
    let keep = |number: usize, solved| {
        let mut solutions = solutions.lock().unwrap_or_else(PoisonError::into_inner);
        solutions[number] = Some(solved);
        done.fetch_add(1, Ordering::Relaxed);
    };
    solve_each(plan, cases, options, &keep, &mut || progress(done.load(Ordering::Relaxed)))?;
    Ok(solutions.into_inner().unwrap_or_else(PoisonError::into_inner))
}

/// Solves all cases and hands over each solution; see
/// [`Contact::solve_each`](super::Contact::solve_each).
pub(super) fn solve_each(
    plan: &Plan,
    cases: &[Case],
    options: &Options,
    take: &(dyn Fn(usize, Result<Solution>) + Sync),
    ask: &mut dyn FnMut() -> ControlFlow<()>,
) -> Result<()> {
    let workers = workers(plan, cases);
    if workers == 0 {
        return Ok(());
    }
    check_memory(plan.grid.shape(), workers as u64 * Plan::memory(&plan.grid))?;
    let threads = plan.convolution.threads();
    let plan = plan.on_threads(&Arc::new(Threads::new(Some(threads / workers))?));
    let (next, stopped) = (AtomicUsize::new(0), AtomicBool::new(false));
    // Nothing is ever sent: the channel closes with the last worker.
    let (alive, ended) = mpsc::channel::<Infallible>();
    std::thread::scope(|scope| {
        for _ in 0..workers {
            let alive = alive.clone();
            let (plan, next, stopped) = (&plan, &next, &stopped);
            scope.spawn(move || {
                let (_alive, mut sampled) = (alive, Sampled::default());
                let asked = || match stopped.load(Ordering::Relaxed) {
                    true => ControlFlow::Break(()),
                    false => ControlFlow::Continue(()),
                };
                while asked().is_continue() {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    let Some(Case { shape, motion }) = cases.get(number) else {
                        break;
                    };
                    let (sampled, progress) = (&mut sampled, &mut |_: &_| asked());
                    let solved =
                        plan.run(|| plan.solve(*shape, sampled, motion, options, progress));
                    let unfinished = matches!(&solved, Ok(solution)
                        if solution.report.termination == Termination::Stopped);
                    if !unfinished {
                        take(number, solved);
                    }
                }
            });
        }
        drop(alive);
        // The workers also end where `ask` panics.
        let stop = SetOnDrop(&stopped);
        // A wake-up for each solution would take a core from the workers each time.
        let mut working = true;
        while working {
            working = ended.recv_timeout(ASKING_INTERVAL) != Err(RecvTimeoutError::Disconnected);
            if ask().is_break() {
                stopped.store(true, Ordering::Relaxed);
            }
        }
        drop(stop);
    });
    Ok(())
}

/// An error where there is too little memory to solve `cases` and to keep all solutions.
pub(super) fn check_memory_for(plan: &Plan, cases: &[Case]) -> Result<()> {
    let [nx, ny] = plan.grid.shape();
    // Pressure, displacement, undeformed gap.
    let solution = nx as u64 * ny as u64 * 24;
    let solutions = cases.len() as u64 * solution;
    let workers = workers(plan, cases) as u64;
    check_memory([nx, ny], workers * Plan::memory(&plan.grid) + solutions)
}

/// Number of cases that are solved at once.
fn workers(plan: &Plan, cases: &[Case]) -> usize {
    plan.convolution.threads().min(cases.len())
}
