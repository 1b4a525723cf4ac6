//! Why a table of another program cannot be read.

use std::{fmt, io};

/// The reason why a table cannot be rewritten.
pub(super) enum Wrong {
    /// The file cannot be read, or the temporary file cannot be written.
    Io(io::Error),
    /// What the crate of the format says about the file.
    Damaged(String),
    /// What is wrong, and the remedy.
    Unfit(String, String),
}

impl From<io::Error> for Wrong {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

impl Wrong {
    pub(super) fn damaged(error: impl fmt::Display) -> Self {
        Self::Damaged(error.to_string())
    }

    pub(super) fn unfit(what: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self::Unfit(what.into(), remedy.into())
    }
}
