//! The failure of a command: one line with the place, what is wrong and the remedy.

use crate::visible::visible;
use std::{
    fmt,
    io::{self, ErrorKind, Write as _},
    path::{Path, PathBuf},
};

/// The reason why a command could not do its work.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// An input or option that cannot be used. It is printed as `FILE:ROW: what; remedy`.
    #[error("{place}{what}; {remedy}")]
    Input {
        /// Where it was found.
        place: Place,
        /// What is wrong.
        what: String,
        /// What to do about it.
        remedy: String,
    },
    /// An axis of a record that cannot be measured or fitted, whereas others may. It is printed as
    /// `FILE: axis NAME: what; remedy`.
    #[error("{place}axis {axis}: {what}; {remedy}")]
    Axis {
        /// The record.
        place: Place,
        /// The name of the axis.
        axis: String,
        /// What is wrong.
        what: String,
        /// What to do about it.
        remedy: String,
    },
    /// A coefficient is not known to keep its limit. What was found is printed, and the command ends without a message.
    #[error("a limit is not kept")]
    Limit {
        /// Whether a coefficient exceeds its limit. It may also be that the record does not tell.
        is_exceeded: bool,
    },
    /// The reader of standard output has closed it. The command ends without a message.
    #[error("standard output was closed")]
    Closed,
}

/// A file, a row of a file, or neither.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Place {
    file: Option<PathBuf>,
    row: Option<u64>,
}

impl Place {
    /// A file as a whole.
    pub fn file(path: &Path) -> Self {
        Self {
            file: Some(path.to_owned()),
            row: None,
        }
    }

    /// A row of a file, counted from 1.
    pub fn row(path: &Path, row: u64) -> Self {
        Self {
            file: Some(path.to_owned()),
            row: Some(row),
        }
    }

    /// The file, if there is one.
    pub fn path(&self) -> Option<&Path> {
        self.file.as_deref()
    }

    /// The row of the file, counted from 1, if there is one.
    pub fn at_row(&self) -> Option<u64> {
        self.row
    }

    /// The failure at this place.
    pub fn failure(self, what: impl fmt::Display, remedy: impl fmt::Display) -> Failure {
        Failure::Input {
            place: self,
            what: one_line(&what.to_string()),
            remedy: one_line(&remedy.to_string()),
        }
    }

    /// The failure of an axis of the record at this place.
    pub fn axis_failure(
        self,
        axis: &str,
        what: impl fmt::Display,
        remedy: impl fmt::Display,
    ) -> Failure {
        Failure::Axis {
            place: self,
            axis: one_line(axis),
            what: one_line(&what.to_string()),
            remedy: one_line(&remedy.to_string()),
        }
    }

    /// The failure of opening, reading or writing the file at this place.
    pub fn io(self, error: &io::Error) -> Failure {
        let (what, remedy) = match error.kind() {
            ErrorKind::NotFound => ("no such file".into(), "check the path"),
            ErrorKind::PermissionDenied => {
                ("permission denied".into(), "check the file's permissions")
            }
            ErrorKind::IsADirectory => ("is a directory".into(), "name a file in it"),
            ErrorKind::UnexpectedEof => (
                "the file ends in the middle".into(),
                "copy or record it again",
            ),
            ErrorKind::StorageFull => ("no space left".into(), "make room or write elsewhere"),
            _ => (error.to_string(), "check the file and the disk"),
        };
        self.failure(what, remedy)
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(file) = &self.file {
            write!(f, "{}:", one_line(&file.to_string_lossy()))?;
            if let Some(row) = self.row {
                write!(f, "{row}:")?;
            }
            f.write_str(" ")?;
        }
        Ok(())
    }
}

impl Failure {
    /// A failure in an option rather than in a file.
    pub fn option(what: impl fmt::Display, remedy: impl fmt::Display) -> Self {
        Place::default().failure(what, remedy)
    }

    /// The same failure in this file, if it names none.
    pub fn about(mut self, path: &Path) -> Self {
        if let Self::Input { place, .. } | Self::Axis { place, .. } = &mut self
            && place.file.is_none()
        {
            place.file = Some(path.to_owned());
        }
        self
    }

    /// The same failure with more of what is wrong.
    pub fn and(self, more: &str) -> Self {
        match self {
            Self::Input {
                place,
                what,
                remedy,
            } => place.failure(format!("{what}, and {more}"), remedy),
            Self::Axis {
                place,
                axis,
                what,
                remedy,
            } => place.axis_failure(&axis, format!("{what}, and {more}"), remedy),
            Self::Closed | Self::Limit { .. } => self,
        }
    }

    /// The same failure in another file, if it is in this one.
    pub fn moved(mut self, from: &Path, to: &Path) -> Self {
        if let Self::Input { place, .. } | Self::Axis { place, .. } = &mut self
            && place.file.as_deref() == Some(from)
        {
            place.file = Some(to.to_owned());
        }
        self
    }

    /// What was found, with its row and without the file and the remedy.
    pub fn found(&self) -> String {
        match self {
            Self::Input { place, what, .. } => match place.row {
                Some(row) => format!("row {row}: {what}"),
                None => what.clone(),
            },
            Self::Axis { axis, what, .. } => format!("axis {axis}: {what}"),
            Self::Closed | Self::Limit { .. } => self.to_string(),
        }
    }

    /// The failure of a part that was left out when the program was built.
    pub fn not_built_in(part: &str) -> Self {
        Self::option(
            format!("{part} is not part of this build"),
            "run `cargo allanite-full` instead of `cargo allanite`; its first build takes minutes longer",
        )
    }

    /// The failure of work that its caller has ended, who knows why.
    pub fn interrupted() -> Self {
        Self::option("interrupted", "start again")
    }

    /// A failure to print results.
    pub fn standard_output(error: &io::Error) -> Self {
        if error.kind() == ErrorKind::BrokenPipe {
            Self::Closed
        } else {
            Self::option(
                format!("standard output: {error}"),
                "write to another place",
            )
        }
    }
}

/// Writes a line to standard error. If that is closed or full, nobody reads it, and the program goes on.
pub fn report(text: impl fmt::Display) {
    let _ = writeln!(io::stderr().lock(), "allanite: {text}");
}

/// Text of an input for a message: quoted, with control characters escaped, and of 40 characters at
/// most.
pub fn quoted(text: &[u8]) -> String {
    const LONGEST: usize = 40;
    // A character has four bytes at most, and a text may be a line of a megabyte.
    let begin = text.get(..4 * LONGEST + 4).unwrap_or(text);
    let lossy = String::from_utf8_lossy(begin);
    let mut shown: String = lossy.chars().take(LONGEST).collect();
    if shown.len() < lossy.len() {
        shown.push('…');
    }
    format!("{shown:?}")
}

/// A hint at the name that is most like one that does not exist, with a blank behind it, or nothing.
pub fn did_you_mean<'a>(wanted: &str, names: impl IntoIterator<Item = &'a str>) -> String {
    /// The similarity from which a name is named. It is that with which options are.
    const LIKE: f64 = 0.7;
    let wanted = wanted.to_lowercase();
    let like = |name: &'a str| (strsim::jaro_winkler(&wanted, &name.to_lowercase()), name);
    let most = names
        .into_iter()
        .map(like)
        .max_by(|one, other| one.0.total_cmp(&other.0));
    most.filter(|(like, _)| *like > LIKE)
        .map_or(String::new(), |(_, name)| format!("did you mean {name}? "))
}

/// A number of things: `1 gap`, `2 gaps`.
pub fn plural(count: u64, noun: &str) -> String {
    let plural = if count == 1 { "" } else { "s" };
    format!("{count} {noun}{plural}")
}

/// A number for a message: as it is written, or with four digits and an exponent if it would otherwise
/// be long.
pub fn brief(value: f64) -> String {
    let text = value.to_string();
    if text.len() <= 12 {
        text
    } else if (1e-3..1e9).contains(&value.abs()) {
        // Six significant digits, without zeros at the end.
        let digits = (5 - value.abs().log10().floor() as i32).max(0) as usize;
        let text = format!("{value:.digits$}");
        match text.contains('.') {
            true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
            false => text,
        }
    } else {
        format!("{value:.3e}")
    }
}

/// The text without line breaks and other control characters, and with escapes in the place of characters that cannot
/// be seen.
pub fn one_line(text: &str) -> String {
    visible(&text.replace(char::is_control, " ")).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_built_in_names_the_file_that_needs_it() {
        let failure = Failure::not_built_in("reading bags").about(Path::new("a.mcap"));
        let text = failure.to_string();
        assert!(
            text.starts_with("a.mcap: reading bags is not part"),
            "{text}"
        );
        // A failure that knows its file keeps it.
        let other = Place::file(Path::new("b.csv")).failure("no rows", "record some");
        assert!(
            other
                .about(Path::new("a.mcap"))
                .to_string()
                .starts_with("b.csv")
        );
    }

    #[test]
    fn a_text_of_any_length_is_quoted_up_to_forty_characters() {
        for (sign, times, shown) in [
            ("é", 40, "é".repeat(40)),
            ("a", 1 << 20, "a".repeat(40) + "…"),
        ] {
            assert_eq!(quoted(sign.repeat(times).as_bytes()), format!("{shown:?}"));
        }
        let four_bytes = "\u{1d49c}";
        let shown = four_bytes.repeat(40) + "…";
        assert_eq!(
            quoted(four_bytes.repeat(41).as_bytes()),
            format!("{shown:?}")
        );
        // Each byte that is no text is one character.
        assert_eq!(
            quoted(&[0xff; 1000])
                .chars()
                .filter(|c| *c == '\u{fffd}')
                .count(),
            40
        );
    }
}
