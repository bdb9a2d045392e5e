//! Many load cases on one plan, side by side.

use std::convert::Infallible;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use crate::contact::options::{Motion, Options};
use crate::contact::plan::Contact;
use crate::contact::solution::Solution;
use crate::contact::solver::Termination;
use crate::contact::start::Sampled;
use crate::error::Result;
use crate::model::surface::Surface;
use crate::numerics::parallel::{CAN_START_THREADS, SetOnDrop, Threads, check_memory};

/// One of many load cases.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct Case<'a> {
    /// The shape that is pressed into the body.
    pub shape: &'a dyn Surface,
    /// The motion that is prescribed, or the load.
    pub motion: Motion,
}

impl<'a> Case<'a> {
    /// `shape`, under `motion`.
    pub fn new(shape: &'a dyn Surface, motion: Motion) -> Self {
        Self { shape, motion }
    }
}

/// Time between two calls that ask the caller whether to go on: far below the 0.2 s within which an
/// interrupt must act.
const ASKING_INTERVAL: Duration = Duration::from_millis(20);

impl Contact {
    /// Solves many cases side by side, each on one of the plan's threads, or on several where there
    /// are fewer cases than threads. Solutions come in the order of the cases, and equal those of
    /// [`Contact::solve`] to the bit. Under a load, successive cases of one shape (at one address) share
    /// its undeformed gap.
    ///
    /// `progress` gets the number of finished cases, on the calling thread, every 20 ms and at the
    /// end. Its break stops the rest: cases that are not finished are `None`.
    ///
    /// # Errors
    /// Too little memory. An error of one case is that case's own result.
    ///
    /// ```
    /// use std::ops::ControlFlow;
    /// use nacre::{Case, Contact, Elastic, Grid, Motion, Options, Paraboloid, Setup};
    ///
    /// let contact = Contact::plan(Elastic::new(1.0, 0.0)?, Grid::new([64, 64], [4.0, 4.0])?, Setup::default())?;
    /// let shape = Paraboloid::new(1e3, 1e3)?;
    /// let cases = [1e-3, 8e-3].map(|load| Case::new(&shape, Motion::load(load)));
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
        self.check_memory_for(cases)?;
        let solutions: Vec<Option<Result<Solution>>> = cases.iter().map(|_| None).collect();
        let (solutions, done) = (Mutex::new(solutions), AtomicUsize::new(0));
        let keep = |number: usize, solved| {
            let mut solutions = solutions.lock().unwrap_or_else(PoisonError::into_inner);
            solutions[number] = Some(solved);
            done.fetch_add(1, Ordering::Relaxed);
        };
        self.solve_each(cases, options, &keep, &mut || progress(done.load(Ordering::Relaxed)))?;
        Ok(solutions.into_inner().unwrap_or_else(PoisonError::into_inner))
    }

    /// [`Contact::solve_many`] that hands over each solution, so that not all of them need be kept.
    ///
    /// `take` gets the number of a case and its solution as soon as it is finished, on the thread
    /// that solved it. `ask` is called on the calling thread, every 20 ms and at the end; its break
    /// stops the rest, which are not handed over. Where no thread can be started, as in a browser, the cases are
    /// solved on the calling thread, which asks before each.
    ///
    /// # Errors
    /// Too little memory for the cases that are solved at once. An error of one case is that case's own
    /// result.
    ///
    /// ```
    /// use std::ops::ControlFlow;
    /// use std::sync::Mutex;
    /// use nacre::{Case, Contact, Elastic, Grid, Motion, Options, Paraboloid, Setup};
    ///
    /// let contact = Contact::plan(Elastic::new(1.0, 0.0)?, Grid::new([64, 64], [4.0, 4.0])?, Setup::default())?;
    /// let shape = Paraboloid::new(1e3, 1e3)?;
    /// let cases = [1e-3, 2e-3, 8e-3].map(|load| Case::new(&shape, Motion::load(load)));
    /// let peak = Mutex::new(0.0_f64);
    /// let take = |_, solved: nacre::Result<nacre::Solution>| {
    ///     if let (Ok(solution), Ok(mut peak)) = (solved, peak.lock()) {
    ///         *peak = peak.max(solution.peak_pressure());
    ///     }
    /// };
    /// contact.solve_each(&cases, &Options::default(), &take, &mut || ControlFlow::Continue(()))?;
    /// // Hertz: p0 = (6 W E*² / π³ R²)^{1/3}
    /// let hertz = (6.0 * 8e-3 / std::f64::consts::PI.powi(3) / 1e6).powf(1.0 / 3.0);
    /// assert!((peak.into_inner().unwrap_or(0.0) / hertz - 1.0).abs() < 0.01);
    /// # Ok::<(), nacre::Error>(())
    /// ```
    pub fn solve_each(
        &self,
        cases: &[Case],
        options: &Options,
        take: &(dyn Fn(usize, Result<Solution>) + Sync),
        ask: &mut dyn FnMut() -> ControlFlow<()>,
    ) -> Result<()> {
        let workers = self.workers(cases);
        if workers == 0 {
            return Ok(());
        }
        check_memory(self.grid.shape(), workers as u64 * self.own_memory())?;
        let threads = self.convolution().threads();
        let plan = self.on_threads(&Arc::new(Threads::new(Some(threads / workers))?));
        let (next, stopped) = (AtomicUsize::new(0), AtomicBool::new(false));
        let go_on = || match stopped.load(Ordering::Relaxed) {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        };
        let work = |before_each: &mut dyn FnMut() -> ControlFlow<()>| {
            let mut sampled = Sampled::default();
            while before_each().is_continue() {
                let number = next.fetch_add(1, Ordering::Relaxed);
                let Some(Case { shape, motion }) = cases.get(number) else {
                    break;
                };
                let progress = &mut |_: &_| go_on();
                let solved = plan.solve_watched(*shape, &mut sampled, motion, options, progress);
                let unfinished = matches!(&solved, Ok(solution)
                    if solution.report.termination == Termination::Stopped);
                if !unfinished {
                    take(number, solved);
                }
            }
        };
        let mut ask_and_stop = || {
            if ask().is_break() {
                stopped.store(true, Ordering::Relaxed);
            }
            go_on()
        };
        if !CAN_START_THREADS {
            work(&mut ask_and_stop);
            return Ok(());
        }
        // Nothing is ever sent: the channel closes with the last worker.
        let (alive, ended) = mpsc::channel::<Infallible>();
        std::thread::scope(|scope| {
            for _ in 0..workers {
                let (alive, work) = (alive.clone(), &work);
                scope.spawn(move || {
                    let _alive = alive;
                    work(&mut || go_on());
                });
            }
            drop(alive);
            // The workers also end where `ask` panics.
            let stop = SetOnDrop(&stopped);
            // A wake-up for each solution would take a core from the workers each time.
            let mut working = true;
            while working {
                working =
                    ended.recv_timeout(ASKING_INTERVAL) != Err(RecvTimeoutError::Disconnected);
                let _ = ask_and_stop();
            }
            drop(stop);
        });
        Ok(())
    }

    /// An error where there is too little memory to solve `cases` and to keep all solutions.
    pub(crate) fn check_memory_for(&self, cases: &[Case]) -> Result<()> {
        let [nx, ny] = self.grid.shape();
        // Pressure, displacement, undeformed gap.
        let solution = nx as u64 * ny as u64 * 24;
        let solutions = cases.len() as u64 * solution;
        let workers = self.workers(cases) as u64;
        check_memory([nx, ny], workers * self.own_memory() + solutions)
    }

    /// Number of cases that are solved at once.
    fn workers(&self, cases: &[Case]) -> usize {
        self.convolution().threads().min(cases.len())
    }
}
