//! What the server answers: the page, and questions about the records that were read.

use super::{
    answer::answer, arguments::Arguments, diagnosis::diagnosis, download, fitted::Fitted, page,
    question::Question, record::LoadedRecord, shell,
};
use crate::failure::Failure;
use serde::Serialize;

/// The records, and the options with which they were read.
pub(super) struct Session {
    records: Vec<LoadedRecord>,
    about_log: Vec<String>,
}

/// A reply to a request.
pub(super) struct Reply {
    pub(super) status: u16,
    /// The type of the body, as in the header `Content-Type`.
    pub(super) kind: &'static str,
    pub(super) body: Vec<u8>,
}

#[derive(Serialize)]
struct Refused {
    error: String,
}

const HTML: &str = "text/html; charset=utf-8";
const JSON: &str = "application/json";
const SVG: &str = "image/svg+xml";
const CSV: &str = "text/csv; charset=utf-8";

impl Session {
    /// Reads the inputs.
    ///
    /// # Errors
    /// When one of them cannot be read or fitted.
    pub(super) fn read(arguments: &Arguments) -> Result<Self, Failure> {
        Ok(Self {
            records: LoadedRecord::read(arguments)?,
            about_log: shell::about_log(std::env::args_os(), &arguments.inputs),
        })
    }

    /// The page, whose scripts and styles have this nonce.
    pub(super) fn page(&self, nonce: &str) -> Reply {
        Reply {
            status: 200,
            kind: HTML,
            body: page::page(&self.records, nonce).into_bytes(),
        }
    }

    /// Whether there is something to ask under this name.
    pub(super) fn knows(name: &str) -> bool {
        ["fit", "diagnose", "drawing", "table"].contains(&name)
    }

    /// Answers the question `name` with this body.
    pub(super) fn ask(&self, name: &str, body: &[u8]) -> Reply {
        self.answered(name, body).unwrap_or_else(|error| Reply {
            status: 400,
            kind: JSON,
            body: json(&Refused { error }),
        })
    }

    fn answered(&self, name: &str, body: &[u8]) -> Result<Reply, String> {
        let words = |failure: Failure| failure.to_string();
        let question = Question::parse(body, self.records.len()).map_err(words)?;
        if name == "diagnose" {
            let thought = diagnosis(&self.records[question.record])?;
            return Ok(reply(JSON, json(thought)));
        }
        let fitted = Fitted::of(&self.records, &question).map_err(words)?;
        Ok(match name {
            "drawing" => reply(SVG, download::drawing(&fitted, &question).into_bytes()),
            "table" => {
                let table = download::table(&fitted, &question);
                reply(CSV, table.map_err(|error| error.to_string())?)
            }
            _ => reply(JSON, json(&answer(&fitted, &question, &self.about_log))),
        })
    }
}

fn reply(kind: &'static str, body: Vec<u8>) -> Reply {
    Reply {
        status: 200,
        kind,
        body,
    }
}

/// A document as JSON. Numbers that are not finite are `null`.
fn json(document: &impl Serialize) -> Vec<u8> {
    serde_json::to_vec(document).unwrap_or_default()
}
