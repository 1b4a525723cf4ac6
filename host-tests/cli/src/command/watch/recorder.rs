//! The thread that receives and saves a recording. It waits for nothing but the input, so that a terminal that is slow,
//! stands still or is gone loses nothing of the record.

use super::{
    recording::{Recording, Snapshot},
    saving::Saving,
    source::Received,
};
use allanite_log::failure::Failure;
use std::{
    sync::{
        Arc, Mutex, MutexGuard, PoisonError,
        atomic::{AtomicBool, Ordering::SeqCst},
        mpsc::{Receiver, RecvTimeoutError, Sender, channel},
    },
    thread::{self, JoinHandle},
    time::{Duration, Instant},
};

/// Longest wait for input before signals and the clock are checked. Chosen by hand.
const MOMENT: Duration = Duration::from_millis(50);

/// After an interruption, input that arrives without a longer pause counts as received before it.
/// Chosen by hand.
const PAUSE: Duration = Duration::from_millis(20);
/// After an interruption, a source that never pauses is read for this long at most. Chosen by hand.
const PATIENCE: Duration = Duration::from_millis(500);

/// From one saving to the next pass at least so many times what a saving takes. Chosen by hand.
const LEISURE: u32 = 4;

/// How a recording ended.
pub(super) struct Ended {
    /// The failure of the source, if it had one.
    pub(super) received: Result<(), Failure>,
    /// The failure of the last saving.
    pub(super) saved: Result<(), Failure>,
}

/// What ends a recording from outside, and what it has reached.
#[derive(Clone, Default)]
pub(super) struct Flags {
    /// The user or the system ends the recording.
    pub(super) interrupted: Arc<AtomicBool>,
    /// The recording has ended and is saved.
    pub(super) saved: Arc<AtomicBool>,
}

/// What the thread shares with the one that shows the recording.
struct Shared {
    recording: Mutex<Recording>,
    saving: Mutex<Saving>,
    flags: Flags,
}

/// A recording that a thread of its own receives. Dropping it ends and saves the recording.
pub(super) struct Recorder {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<Ended>>,
    /// It closes when the thread has ended.
    done: Receiver<()>,
}

/// A thread that panicked has left whole samples, because each is pushed in one go.
fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Recorder {
    /// Begins to receive, and to save every so often.
    ///
    /// # Errors
    /// When no thread can be started.
    pub(super) fn start(
        recording: Recording,
        received: Receiver<Received>,
        saving: Saving,
        save_every: Duration,
        flags: Flags,
    ) -> std::io::Result<Self> {
        let shared = Arc::new(Shared {
            recording: Mutex::new(recording),
            saving: Mutex::new(saving),
            flags,
        });
        let (running, done) = channel();
        let of_thread = shared.clone();
        let work = move || of_thread.record(&received, save_every, running);
        let thread = thread::Builder::new().spawn(work)?;
        Ok(Self {
            shared,
            thread: Some(thread),
            done,
        })
    }

    /// Waits for so long, or until the recording has ended, and returns whether it has.
    pub(super) fn has_ended_within(&self, time: Duration) -> bool {
        self.done.recv_timeout(time) == Err(RecvTimeoutError::Disconnected)
    }

    /// What is recorded so far.
    pub(super) fn recording(&self) -> MutexGuard<'_, Recording> {
        locked(&self.shared.recording)
    }

    /// The curves recorded so far.
    pub(super) fn snapshot(&self) -> Snapshot {
        self.recording().snapshot()
    }

    /// Where the recording is saved.
    pub(super) fn saving(&self) -> MutexGuard<'_, Saving> {
        locked(&self.shared.saving)
    }

    /// Ends the recording, if it has not ended, and waits until it is saved.
    pub(super) fn end(&mut self) -> Option<Ended> {
        let thread = self.thread.take()?;
        if !self.has_ended_within(Duration::ZERO) {
            self.shared.flags.interrupted.store(true, SeqCst);
        }
        thread.join().ok()
    }
}

impl Drop for Recorder {
    fn drop(&mut self) {
        self.end();
    }
}

impl Shared {
    /// Receives and saves until the input ends or the recording is interrupted. `_running` closes at the end.
    fn record(
        &self,
        received: &Receiver<Received>,
        save_every: Duration,
        _running: Sender<()>,
    ) -> Ended {
        let received = self.receive(received, save_every);
        let saved = self.save();
        self.flags.saved.store(true, SeqCst);
        Ended { received, saved }
    }

    fn receive(&self, received: &Receiver<Received>, save_every: Duration) -> Result<(), Failure> {
        let (mut saved, mut pause) = (Instant::now(), save_every);
        while !self.flags.interrupted.load(SeqCst) {
            let wait = pause.saturating_sub(saved.elapsed()).min(MOMENT);
            match received.recv_timeout(wait) {
                Ok(Received::Bytes(bytes)) => locked(&self.recording).take(&bytes),
                Ok(Received::Failure(failure)) => return Err(failure),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => {
                    locked(&self.recording).end();
                    return Ok(());
                }
            }
            if saved.elapsed() >= pause {
                let begun = Instant::now();
                // The trouble is kept, and told by the thread that shows the recording.
                let _ = self.save();
                saved = Instant::now();
                pause = save_every.max(LEISURE * begun.elapsed());
            }
        }
        // What had arrived before the interruption counts.
        let begun = Instant::now();
        while begun.elapsed() < PATIENCE {
            match received.recv_timeout(PAUSE) {
                Ok(Received::Bytes(bytes)) => locked(&self.recording).take(&bytes),
                Ok(Received::Failure(failure)) => return Err(failure),
                Err(_) => break,
            }
        }
        Ok(())
    }

    /// Saves the curves, if the record is long enough. If it stays too short, that is told at the end.
    fn save(&self) -> Result<(), Failure> {
        let curves = locked(&self.recording).curves()?;
        match curves {
            Some(curves) => {
                let curves = curves.into_iter().map(|(curve, _)| curve).collect();
                locked(&self.saving).save(curves)
            }
            None => Ok(()),
        }
    }
}
