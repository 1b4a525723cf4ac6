//! What is called between two pieces of work.

use crate::error::Error;
use core::ops::ControlFlow;

/// What is called between two pieces of work. It may end the work.
pub(crate) type Pause<'p> = dyn FnMut() -> ControlFlow<()> + 'p;

/// Why a piece of work ended before its result.
pub(crate) enum Stop {
    Paused,
    Failed(Error),
}

impl From<Error> for Stop {
    fn from(error: Error) -> Self {
        Self::Failed(error)
    }
}

/// Calls the pause.
pub(crate) fn call(pause: &mut Pause<'_>) -> Result<(), Stop> {
    match pause() {
        ControlFlow::Continue(()) => Ok(()),
        ControlFlow::Break(()) => Err(Stop::Paused),
    }
}

/// Does work that nothing pauses.
pub(crate) fn unpaused<T>(
    work: impl FnOnce(&mut Pause<'_>) -> Result<T, Stop>,
) -> Result<T, Error> {
    work(&mut || ControlFlow::Continue(())).map_err(|stop| match stop {
        Stop::Failed(error) => error,
        // This pause never ends the work.
        Stop::Paused => Error::Singular,
    })
}
