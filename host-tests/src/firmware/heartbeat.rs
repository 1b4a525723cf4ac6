//! Signs of life while something takes long.

use std::{
    io::Write as _,
    sync::mpsc::{Sender, channel},
    thread::{self, JoinHandle},
    time::{Duration, Instant},
};

/// Nobody waits longer for a sign.
pub const PERIOD: Duration = Duration::from_secs(8);

/// Says on standard error what has begun and, as long as it is not dropped, that it goes on.
///
/// It writes past what a test captures: these lines are for whoever waits for the test.
#[derive(Debug)]
pub struct Heartbeat {
    end: Option<Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Heartbeat {
    /// Begins with a line that says what is done.
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
            // It only prints; one that fails is no reason to.
            let _ = thread.join();
        }
    }
}

/// A line on standard error; where that is closed nobody waits.
fn say(what: &str) {
    let _ = writeln!(std::io::stderr(), "      Doing {what}");
}
