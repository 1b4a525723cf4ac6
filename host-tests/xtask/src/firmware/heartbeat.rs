//! Prints signs of life while something takes long.

use std::{
    io::Write as _,
    sync::mpsc::{Sender, channel},
    thread::{self, JoinHandle},
    time::{Duration, Instant},
};

/// The longest time without a sign of life.
pub const PERIOD: Duration = Duration::from_secs(8);

/// Prints on standard error what has begun, and then repeats it until it is dropped.
///
/// It writes directly to standard error, past the capture of the test runner, because these lines are
/// for the person who waits for the test.
#[derive(Debug)]
pub struct Heartbeat {
    end: Option<Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Heartbeat {
    /// Prints a line that says what is done, and starts to repeat it.
    pub fn new(what: String) -> Self {
        say(&what);
        let (end, ended) = channel();
        let thread = thread::spawn(move || {
            let begun = Instant::now();
            while ended.recv_timeout(PERIOD) == Err(std::sync::mpsc::RecvTimeoutError::Timeout) {
                say(&format!("{what}: {} s", begun.elapsed().as_secs()));
            }
        });
        Self {
            end: Some(end),
            thread: Some(thread),
        }
    }
}

impl Drop for Heartbeat {
    fn drop(&mut self) {
        self.end = None;
        if let Some(thread) = self.thread.take() {
            // The thread only prints, so its failure is not passed on.
            let _ = thread.join();
        }
    }
}

/// Prints a line on standard error. If that is closed, nobody reads it.
fn say(what: &str) {
    let _ = writeln!(std::io::stderr(), "      Doing {what}");
}
