//! What is called between two pieces of work.

use crate::error::Error;
use core::ops::ControlFlow;

/// What is called between two pieces of work. It may end the work.
pub(crate) type Pause<'p> = dyn FnMut() -> ControlFlow<()> + 'p;

/// Why a piece of work ended before its result.
pub(super) enum Stop {
    Paused,
    Failed(Error),
}

impl From<Error> for Stop {
    fn from(error: Error) -> Self {
        Self::Failed(error)
    }
}

/// Calls the pause.
pub(super) fn call(pause: &mut Pause<'_>) -> Result<(), Stop> {
    match pause() {
        ControlFlow::Continue(()) => Ok(()),
        ControlFlow::Break(()) => Err(Stop::Paused),
    }
}
