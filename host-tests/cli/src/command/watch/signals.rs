//! The signals that end a recording.

use super::recorder::Flags;
use std::io;

/// The exit status of a program that was interrupted, by the convention of shells.
#[cfg(unix)]
const INTERRUPTED: i32 = 130;

/// From now on, the signals by which terminals, users and the system end a program end the recording, which is saved
/// first. Once it is saved, the next of them ends the program at once, even if its terminal stands still.
#[cfg(unix)]
pub(super) fn catch(flags: &Flags) -> io::Result<()> {
    use signal_hook::{
        consts::{SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGXFSZ},
        flag,
    };
    for signal in [SIGHUP, SIGINT, SIGQUIT, SIGTERM] {
        flag::register_conditional_shutdown(signal, INTERRUPTED, flags.saved.clone())?;
        flag::register(signal, flags.interrupted.clone())?;
    }
    // A file beyond the limit of its size is an error of writing it, and no end of the program.
    flag::register(SIGXFSZ, std::sync::Arc::default())?;
    Ok(())
}

/// From now on, an interruption ends the recording.
#[cfg(not(unix))]
pub(super) fn catch(flags: &Flags) -> io::Result<()> {
    let interrupted = flags.interrupted.clone();
    let handler = move || interrupted.store(true, std::sync::atomic::Ordering::SeqCst);
    ctrlc::set_handler(handler).map_err(io::Error::other)
}
