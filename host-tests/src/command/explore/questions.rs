//! The questions of the page without its server, for those who ask many.

use super::{
    arguments::Arguments,
    session::{Reply, Session},
};
use crate::failure::Failure;
use clap::Parser;
use std::path::Path;

/// The inputs of `explore`, about which questions can be asked.
pub struct Questions(Session);

/// A reply to a question.
pub struct Answered {
    /// The status of HTTP.
    pub status: u16,
    /// The type of the body.
    pub kind: &'static str,
    /// The body.
    pub body: Vec<u8>,
}

/// The options as on a command line.
#[derive(Parser)]
struct Options {
    #[command(flatten)]
    arguments: Arguments,
}

impl Questions {
    /// Reads an input.
    ///
    /// # Errors
    /// When it cannot be read or fitted.
    pub fn about(input: &Path) -> Result<Self, Failure> {
        let options = Options::try_parse_from([Path::new("explore"), input]);
        let Options { arguments } = options
            .map_err(|error| Failure::option(error.to_string(), "give the path of a file"))?;
        Session::read(&arguments).map(Self)
    }

    /// Answers a question as the server does; `None` if there is no question of this name.
    pub fn ask(&self, name: &str, body: &[u8]) -> Option<Answered> {
        let Reply { status, kind, body } = Session::knows(name).then(|| self.0.ask(name, body))?;
        Some(Answered { status, kind, body })
    }
}
