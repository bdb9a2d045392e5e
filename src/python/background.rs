//! Work on a thread of its own, while Python's thread looks for Ctrl-C. A signal is seen within
//! [`POLL_INTERVAL`], whatever the work does; interrupted work ends by itself, at its next iteration. Where no thread
//! can be started, the work runs on Python's thread, and each call looks for signals.

use std::ops::ControlFlow;
use std::panic::resume_unwind;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;

use pyo3::call::PyCallArgs;
use pyo3::prelude::*;

use crate::numerics::parallel::CAN_START_THREADS;

/// Time between two looks for Ctrl-C: short enough to feel immediate, long enough to cost nothing.
const POLL_INTERVAL: Duration = Duration::from_millis(50);

enum Message<M, T> {
    /// Arguments for the callback, and whether its answer counts.
    Call(M, bool),
    Done(T),
}

/// Link of the work to its caller: it tells progress, and asks whether to go on.
pub(super) struct Caller<M> {
    stopped: Arc<AtomicBool>,
    /// Calls Python's callback and returns whether to go on.
    callback: Option<Box<dyn FnMut(M, bool) -> bool + Send>>,
}

impl<M> Caller<M> {
    /// Break if the work was interrupted.
    pub(super) fn go_on(&self) -> ControlFlow<()> {
        if self.stopped.load(Ordering::Relaxed) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }

    /// Calls the callback, if there is one. Break if it says to stop, or the work was interrupted.
    pub(super) fn ask(&mut self, message: impl FnOnce() -> M) -> ControlFlow<()> {
        if let Some(callback) = &mut self.callback
            && !callback(message(), true)
        {
            self.stopped.store(true, Ordering::Relaxed);
        }
        self.go_on()
    }

    /// Calls the callback, if there is one, and ignores its result.
    pub(super) fn tell(&mut self, message: impl FnOnce() -> M) {
        if let Some(callback) = &mut self.callback {
            callback(message(), false);
        }
    }
}

/// Result of `work`, which runs on a thread of its own. `callback` is called on this thread.
pub(super) fn run<M, T>(
    py: Python<'_>,
    callback: Option<Py<PyAny>>,
    work: impl FnOnce(&mut Caller<M>) -> T + Send + 'static,
) -> PyResult<T>
where
    M: for<'py> PyCallArgs<'py> + Send + 'static,
    T: Send + 'static,
{
    if !CAN_START_THREADS {
        return run_on_calling_thread(py, callback, work);
    }
    let (sender, mut messages) = mpsc::channel();
    let (answer, answers) = mpsc::channel::<bool>();
    let stopped = Arc::new(AtomicBool::new(false));
    let calls = sender.clone();
    let mut caller = Caller {
        stopped: Arc::clone(&stopped),
        callback: callback.is_some().then(|| {
            // After an interrupt nobody listens any more.
            Box::new(move |message, asks| {
                calls.send(Message::Call(message, asks)).is_ok() && answers.recv().unwrap_or(false)
            }) as Box<dyn FnMut(M, bool) -> bool + Send>
        }),
    };
    let worker = thread::Builder::new().name("nacre".into()).spawn(move || {
        let done = work(&mut caller);
        drop(caller);
        // After an interrupt nobody waits for the result.
        let _ = sender.send(Message::Done(done));
    })?;
    let outcome = loop {
        let messages = &mut messages;
        match py.detach(move || messages.recv_timeout(POLL_INTERVAL)) {
            Ok(Message::Done(done)) => break Ok(done),
            Ok(Message::Call(message, asks)) => match tell(py, callback.as_ref(), message, asks) {
                Ok(go_on) => {
                    let _ = answer.send(go_on);
                }
                Err(error) => break Err(error),
            },
            Err(RecvTimeoutError::Timeout) => {
                if let Err(error) = py.check_signals() {
                    break Err(error);
                }
            }
            Err(RecvTimeoutError::Disconnected) => match worker.join() {
                Err(panic) => resume_unwind(panic),
                Ok(()) => unreachable!("the worker sends its result before it ends"),
            },
        }
    };
    stopped.store(true, Ordering::Relaxed);
    outcome.and_then(|done| py.check_signals().map(|()| done))
}

/// [`run`] on this thread.
fn run_on_calling_thread<M, T>(
    py: Python<'_>,
    callback: Option<Py<PyAny>>,
    work: impl FnOnce(&mut Caller<M>) -> T + Send,
) -> PyResult<T>
where
    M: for<'py> PyCallArgs<'py> + Send + 'static,
    T: Send,
{
    let (failure, failures) = mpsc::channel();
    let stopped = Arc::new(AtomicBool::new(false));
    let failed = Arc::clone(&stopped);
    let call = move |message, asks| {
        Python::attach(|py| tell(py, callback.as_ref(), message, asks)).unwrap_or_else(|error| {
            failed.store(true, Ordering::Relaxed);
            failure.send(error).is_err()
        })
    };
    let mut caller = Caller { stopped, callback: Some(Box::new(call)) };
    let done = py.detach(move || work(&mut caller));
    failures.try_recv().map_or(Ok(done), Err)
}

/// Calls the callback; returns whether to go on.
fn tell<M: for<'py> PyCallArgs<'py>>(
    py: Python<'_>,
    callback: Option<&Py<PyAny>>,
    message: M,
    asks: bool,
) -> PyResult<bool> {
    py.check_signals()?;
    let Some(callback) = callback else {
        return Ok(true);
    };
    let answer = callback.bind(py).call1(message)?;
    Ok(!asks || answer.is_none() || answer.is_truthy()?)
}
