//! A session: the records that are explored, as the page keeps them, and the questions about them.

use super::{
    answer::answer,
    arguments::Arguments,
    catalogue::{Listed, catalogue},
    download,
    fitted::Fitted,
    question::{Question, What},
    record::{self, ListedRecord, SessionRecord},
    shell,
};
use crate::command::{
    diagnose::arguments::OfPage,
    input::record::library_failure,
    output::glossary::{self, Word},
};
use allanite_log::failure::Failure;
use allanite_plot as plot;
use clap::Parser;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// The version of the format. A page carries the program of its own version, so that no other is read.
const VERSION: u32 = 1;

/// The records, and the options with which they were read.
#[derive(Serialize, Deserialize)]
pub struct Session {
    version: u32,
    about_log: Vec<String>,
    records: Vec<SessionRecord>,
}

/// A session with what the page alone needs.
#[derive(Serialize)]
struct Document<'a> {
    session: &'a Session,
    page: Page,
}

/// What the page shows before its first question.
#[derive(Serialize)]
struct Page {
    styles: String,
    catalogue: Vec<Listed>,
    glossary: Vec<Word>,
    records: Vec<ListedRecord>,
}

/// What is read of a document.
#[derive(Deserialize)]
struct Read {
    session: Session,
}

/// Reads and diagnoses the inputs, and writes them as the document that a page keeps.
///
/// # Errors
/// When an input cannot be read, or an axis cannot be fitted.
pub(super) fn document(arguments: &Arguments) -> Result<String, Failure> {
    written(record::read(arguments)?, &arguments.inputs)
}

/// The document of records that are diagnosed already.
///
/// # Errors
/// When an axis cannot be compared without what follows its covariates.
pub(super) fn of_diagnosed(input: &Path, diagnosed: &[OfPage]) -> Result<String, Failure> {
    let records = diagnosed.iter().map(|(diagnosed, spectrogram)| {
        record::explored(input, diagnosed, spectrogram.clone())
            .map_err(|error| library_failure(input, &diagnosed.axis.axis, error))
    });
    written(records.collect::<Result<_, _>>()?, &[input.to_owned()])
}

fn written(
    records: Vec<(SessionRecord, ListedRecord)>,
    inputs: &[PathBuf],
) -> Result<String, Failure> {
    let (records, listed) = records.into_iter().unzip();
    let session = Session {
        version: VERSION,
        about_log: shell::about_log(std::env::args_os(), inputs),
        records,
    };
    let page = Page {
        styles: plot::effect_styles(),
        catalogue: catalogue(&session.records),
        glossary: glossary::words(),
        records: listed,
    };
    let document = Document {
        session: &session,
        page,
    };
    serde_json::to_string(&document).map_err(|error| damaged(&error.to_string()))
}

fn damaged(what: &str) -> Failure {
    Failure::option(
        format!("the page's records are damaged: {what}"),
        "make the page again with `explore`",
    )
}

/// The options as on a command line.
#[derive(Parser)]
struct Options {
    #[command(flatten)]
    arguments: Arguments,
}

impl Session {
    /// Reads and diagnoses an input, and returns its document.
    ///
    /// # Errors
    /// When it cannot be read or fitted.
    pub fn about(input: &Path) -> Result<String, Failure> {
        let options = Options::try_parse_from([Path::new("explore"), input]);
        let Options { arguments } = options
            .map_err(|error| Failure::option(error.to_string(), "give the path of a file"))?;
        document(&arguments)
    }

    /// Reads the document of a session, and checks every number in it.
    ///
    /// # Errors
    /// When it is not the document of a session of this version.
    pub fn parse(text: &[u8]) -> Result<Self, Failure> {
        let Read { session } =
            serde_json::from_slice(text).map_err(|error| damaged(&error.to_string()))?;
        if session.version != VERSION {
            return Err(damaged(&format!("they have version {}", session.version)));
        }
        for record in &session.records {
            record.check().map_err(|what| damaged(&what))?;
        }
        Ok(session)
    }

    /// Answers a question about some of the records.
    ///
    /// # Errors
    /// When the question is not understood, or the model cannot be fitted.
    pub fn ask(&self, what: What, question: &[u8]) -> Result<Vec<u8>, Failure> {
        let question = Question::parse(question, self.records.len())?;
        let fitted = Fitted::of(&self.records, &question)?;
        Ok(match what {
            What::Fit => serde_json::to_vec(&answer(&fitted, &question, &self.about_log))
                .map_err(|error| damaged(&error.to_string()))?,
            What::Drawing => download::drawing(&fitted, &question).into_bytes(),
            What::Table => {
                let table = download::table(&fitted, &question);
                table.map_err(|error| damaged(&error.to_string()))?
            }
        })
    }
}
