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
    /// [`Contact::solve`] to the bit.
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
        let mut solutions: Vec<Option<Result<Solution>>> = cases.iter().map(|_| None).collect();
        let threads = self.convolution().threads();
        let workers = threads.min(cases.len());
        if workers == 0 {
            return Ok(solutions);
        }
        let [nx, ny] = self.grid().shape();
        let solution = nx as u64 * ny as u64 * 24;
        check_memory(
            [nx, ny],
            workers as u64 * memory(self.grid()) + cases.len() as u64 * solution,
        )?;
        let plan = self.on_threads(&Arc::new(Threads::new(Some(threads / workers))?));
        let (next, stopped) = (AtomicUsize::new(0), AtomicBool::new(false));
        let (sender, finished) = mpsc::channel();
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
            let mut done = 0;
            // Woken for each solution, this thread would take a core from the workers each time.
            let mut working = true;
            while working {
                working = ended.recv_timeout(ASKED) != Err(RecvTimeoutError::Disconnected);
                for (number, solved) in finished.try_iter() {
                    let unfinished = matches!(&solved, Ok(solution)
                        if solution.report.termination == Termination::Stopped);
                    if !unfinished {
                        solutions[number] = Some(solved);
                        done += 1;
                    }
                }
                if progress(done).is_break() {
                    stopped.store(true, Ordering::Relaxed);
                }
            }
        });
        Ok(solutions)
    }
}
