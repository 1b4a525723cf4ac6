//! Work without the interpreter's lock, which Ctrl-C ends.

use crate::error::raised;
use allanite_log::failure::Failure;
use indicatif::ProgressBar;
use pyo3::{exceptions::PyRuntimeError, prelude::*};
use std::{
    sync::mpsc::{Receiver, RecvTimeoutError::Timeout, channel},
    thread,
    time::Duration,
};

/// Python is asked for signals and told the progress this often. Chosen by hand: a user does not notice it, and neither does
/// the work.
const PIECE: Duration = Duration::from_millis(50);

/// Does work that borrows something, in a thread of its own, and waits until it has ended. The bar follows the work; after
/// Ctrl-C, or when the callback raises, the bar is ended, which ends the work.
pub(crate) fn watched<T: Send>(
    py: Python<'_>,
    progress: Option<&Py<PyAny>>,
    work: impl FnOnce(&ProgressBar) -> Result<T, Failure> + Send,
) -> PyResult<T> {
    let bar = ProgressBar::hidden();
    let result = py.detach(|| {
        thread::scope(|scope| {
            let (done, waiting) = channel();
            let own = bar.clone();
            let worker = scope.spawn(move || {
                let result = work(&own);
                // The receiver is there until the thread has been joined.
                let _ = done.send(());
                result
            });
            let ended = wait(&waiting, &bar, progress);
            let result = worker.join();
            ended.map(|()| result)
        })
    })?;
    let result = result.map_err(|_| PyRuntimeError::new_err("a thread of allanite panicked"))?;
    finish(py, progress)?;
    result.map_err(raised)
}

/// Does work that borrows nothing, in a thread of its own. After Ctrl-C it is left to end by itself, which it does soon.
pub(crate) fn left<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<&Py<PyAny>>,
    work: impl FnOnce(&ProgressBar) -> Result<T, Failure> + Send + 'static,
) -> PyResult<T> {
    let bar = ProgressBar::hidden();
    let result = py.detach(|| {
        let (done, waiting) = channel();
        let own = bar.clone();
        let worker = thread::spawn(move || {
            let result = work(&own);
            // Nobody waits after Ctrl-C.
            let _ = done.send(());
            result
        });
        wait(&waiting, &bar, progress).map(|()| worker.join())
    })?;
    let result = result.map_err(|_| PyRuntimeError::new_err("a thread of allanite panicked"))?;
    finish(py, progress)?;
    result.map_err(raised)
}

/// Waits until the work is done, and asks Python in between.
///
/// # Errors
/// The exception that ended the work.
fn wait(waiting: &Receiver<()>, bar: &ProgressBar, progress: Option<&Py<PyAny>>) -> PyResult<()> {
    while let Err(Timeout) = waiting.recv_timeout(PIECE) {
        let asked = Python::attach(|py| {
            py.check_signals()?;
            match progress {
                Some(progress) => progress.call1(py, (share(bar),)).map(drop),
                None => Ok(()),
            }
        });
        if let Err(error) = asked {
            bar.abandon();
            return Err(error);
        }
    }
    Ok(())
}

/// The share of the work that is done.
fn share(bar: &ProgressBar) -> f64 {
    let length = bar.length().unwrap_or(0);
    (bar.position() as f64 / length.max(1) as f64).min(1.0)
}

fn finish(py: Python<'_>, progress: Option<&Py<PyAny>>) -> PyResult<()> {
    match progress {
        Some(progress) => progress.call1(py, (1.0,)).map(drop),
        None => Ok(()),
    }
}
