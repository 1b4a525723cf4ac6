//! Command lines as text for a shell.

use crate::command::output::shell::quoted;
use std::{ffi::OsString, path::Path};

/// The command line of `compare` with the same effects and the same options about the log.
pub(super) fn compare(
    input: &Path,
    about_log: &[String],
    with: &[String],
    without: &[String],
) -> String {
    let words = [
        "allanite".into(),
        "compare".into(),
        input.to_string_lossy().into_owned(),
    ];
    let option = |name: &str, values: &[String]| {
        let pairs = values.iter().map(|value| [name.to_owned(), value.clone()]);
        pairs.flatten().collect::<Vec<_>>()
    };
    let words = words.into_iter().chain(about_log.iter().cloned());
    let words = words
        .chain(option("--with", with))
        .chain(option("--without", without));
    words
        .map(|word| quoted(&word))
        .collect::<Vec<_>>()
        .join(" ")
}

/// The options about logs among the words of a command line: all words but the program, the command, its own options,
/// those about covariates and the inputs.
pub(super) fn about_log(
    words: impl IntoIterator<Item = OsString>,
    inputs: &[std::path::PathBuf],
) -> Vec<String> {
    let mut words = words.into_iter().skip(1).peekable();
    let mut about = Vec::new();
    let mut has_command = false;
    while let Some(word) = words.next() {
        let text = word.to_string_lossy().into_owned();
        let is_own = ["--open", "--quiet", "-q", "--no-covariates", "--"].contains(&text.as_str());
        if is_own || text.starts_with("--covariates=") {
            continue;
        }
        if text == "--covariates" {
            words.next();
            continue;
        }
        if text == "explore" && !has_command {
            has_command = true;
            continue;
        }
        if text.starts_with("--") {
            about.push(text.clone());
            // Every option about logs has a value.
            if !text.contains('=') {
                about.extend(
                    words
                        .next()
                        .map(|value| value.to_string_lossy().into_owned()),
                );
            }
        } else if !inputs.iter().any(|input| input.as_os_str() == word) {
            about.push(text);
        }
    }
    about
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_line_keeps_options_about_the_log_and_quotes_what_a_shell_would_change() {
        let words = "allanite explore a.csv --rate 100 b.csv --open --unit=deg/s --covariates t -q --columns gx,gy";
        let inputs = ["a.csv", "b.csv"].map(Into::into);
        let about = about_log(words.split(' ').map(Into::into), &inputs);
        assert_eq!(
            about,
            ["--rate", "100", "--unit=deg/s", "--columns", "gx,gy"]
        );
        let with = ["sinusoid:frequency_hz~0.3".to_owned()];
        let line = compare(
            Path::new("my log.csv"),
            &about,
            &with,
            &["rate_ramp".to_owned()],
        );
        assert_eq!(
            line,
            "allanite compare 'my log.csv' --rate 100 --unit=deg/s --columns gx,gy \
             --with sinusoid:frequency_hz~0.3 --without rate_ramp"
        );
    }
}
