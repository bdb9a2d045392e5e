//! Many load cases on one plan, side by side.

use std::convert::Infallible;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::Duration;

use super::freedoms::Motion;
use super::problem::Termination;
use super::solution::Solution;
use super::start::Sampled;
use super::{Contact, Options, memory};
use crate::error::Result;
use crate::memory::check_memory;
use crate::surface::Surface;
use crate::threads::Threads;

/// One of many load cases.
#[derive(Debug, Clone, Copy)]
pub struct Case<'a> {
    /// What is pressed.
    pub shape: &'a dyn Surface,
    /// How.
    pub motion: Motion,
}

/// How often the caller is asked whether to go on.
const ASKED: Duration = Duration::from_millis(20);

impl Contact {
    /// Solves many cases side by side, each on one of the plan's threads (on several, where there
    /// are fewer cases). Solutions come in the order of the cases, and are those of
    /// [`Contact::solve`] to the bit; those of the same shape, by its address, share its undeformed gap.
    ///
    /// `progress` is told how many cases are finished, on the calling thread, every 20 ms and at the
    /// end; its break stops the rest: those that are not finished are `None`.
    ///
    /// # Errors
    /// Too little memory. What is wrong with a case is its own result.
    ///
    /// ```
    /// use std::ops::ControlFlow;
    /// use nacre::{Case, Contact, Elastic, Grid, Motion, Options, Paraboloid, Setup};
    ///
    /// let contact = Contact::plan(&Elastic::new(1.0, 0.0)?.into(), Grid::new([64, 64], [4.0, 4.0])?, Setup::default())?;
    /// let shape = Paraboloid::new(1e3, 1e3)?;
    /// let cases = [1e-3, 8e-3].map(|load| Case { shape: &shape, motion: Motion::load(load) });
    /// let solved = contact.solve_many(&cases, &Options::default(), &mut |_| ControlFlow::Continue(()))?;
    /// // Hertz: δ grows as W^{2/3}
    /// let approach: Vec<f64> = solved.into_iter().flatten().map(|s| Ok(s?.approach)).collect::<nacre::Result<_>>()?;
    /// assert!((approach[1] / approach[0] / 4.0 - 1.0).abs() < 1e-3);
    /// # Ok::<(), nacre::Error>(())
    /// ```
    pub fn solve_many(
        &self,
        cases: &[Case],
        options: &Options,
        progress: &mut dyn FnMut(usize) -> ControlFlow<()>,
    ) -> Result<Vec<Option<Result<Solution>>>> {
        self.check_many(cases)?;
        let mut solutions: Vec<Option<Result<Solution>>> = cases.iter().map(|_| None).collect();
        let mut done = 0;
        self.solve_each(cases, options, &mut |finished| {
            done += finished.len();
            for (number, solved) in finished {
                solutions[number] = Some(solved);
            }
            progress(done)
        })?;
        Ok(solutions)
    }

    /// [`Contact::solve_many`] that gives solutions away, so that not all of them need be kept: 50 times
    /// a second and at the end, on the calling thread, `finished` is given those that were finished since,
    /// each with the number of its case.
    ///
    /// # Errors
    /// Too little memory.
    pub fn solve_each(
        &self,
        cases: &[Case],
        options: &Options,
        finished: &mut dyn FnMut(Vec<(usize, Result<Solution>)>) -> ControlFlow<()>,
    ) -> Result<()> {
        let workers = self.workers(cases);
        if workers == 0 {
            return Ok(());
        }
        let grid = self.grid();
        check_memory(grid.shape(), workers as u64 * memory(grid))?;
        let threads = self.convolution().threads();
        let plan = self.on_threads(&Arc::new(Threads::new(Some(threads / workers))?));
        let (next, stopped) = (AtomicUsize::new(0), AtomicBool::new(false));
        let (sender, solutions) = mpsc::channel();
        // Nothing is ever sent: it ends with the last worker.
        let (working, ended) = mpsc::channel::<Infallible>();
        std::thread::scope(|scope| {
            for _ in 0..workers {
                let (sender, working) = (sender.clone(), working.clone());
                let (plan, next, stopped) = (&plan, &next, &stopped);
                scope.spawn(move || {
                    let (_working, mut sampled) = (working, Sampled::default());
                    let asked = || match stopped.load(Ordering::Relaxed) {
                        true => ControlFlow::Break(()),
                        false => ControlFlow::Continue(()),
                    };
                    while asked().is_continue() {
                        let number = next.fetch_add(1, Ordering::Relaxed);
                        let Some(case) = cases.get(number) else {
                            break;
                        };
                        let Case { shape, motion } = case;
                        let solved =
                            plan.solve_sampled(*shape, &mut sampled, motion, options, &mut |_| {
                                asked()
                            });
                        if sender.send((number, solved)).is_err() {
                            break;
                        }
                    }
                });
            }
            drop(working);
            // Woken for each solution, this thread would take a core from the workers each time.
            let mut working = true;
            while working {
                working = ended.recv_timeout(ASKED) != Err(RecvTimeoutError::Disconnected);
                let is_finished = |(_, solved): &(usize, Result<Solution>)| {
                    !matches!(solved, Ok(solution)
                        if solution.report.termination == Termination::Stopped)
                };
                if finished(solutions.try_iter().filter(is_finished).collect()).is_break() {
                    stopped.store(true, Ordering::Relaxed);
                }
            }
        });
        Ok(())
    }

    /// An error where there is too little memory to solve `cases` and to keep all solutions.
    pub(crate) fn check_many(&self, cases: &[Case]) -> Result<()> {
        let [nx, ny] = self.grid().shape();
        // Pressure, displacement, undeformed gap.
        let solution = nx as u64 * ny as u64 * 24;
        let solutions = cases.len() as u64 * solution;
        let workers = self.workers(cases) as u64;
        check_memory([nx, ny], workers * memory(self.grid()) + solutions)
    }

    /// How many cases are solved at once.
    fn workers(&self, cases: &[Case]) -> usize {
        self.convolution().threads().min(cases.len())
    }
}
