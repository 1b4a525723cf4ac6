//! Command lines as text for a shell.

use crate::command::output::shell::quoted;
use std::{ffi::OsString, path::Path};

/// The command line of `compare` with the same effects and the same options about the log. What follows a covariate is
/// taken out by `diagnose` alone, which looks for the effects itself.
pub(super) fn command(
    input: &Path,
    about_log: &[String],
    with: &[String],
    without: &[String],
    taken_out: bool,
) -> String {
    let (name, with, without) = match taken_out {
        true => ("diagnose", &[][..], &[][..]),
        false => ("compare", with, without),
    };
    let words = [
        "allanite".into(),
        name.into(),
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
        let is_own = [
            "--open",
            "--session",
            "--quiet",
            "-q",
            "--no-covariates",
            "--plain",
            "--",
        ]
        .contains(&text.as_str());
        let begins = ["--covariates=", "--output=", "--page="];
        if is_own || begins.iter().any(|begin| text.starts_with(begin)) {
            continue;
        }
        if ["--covariates", "--output", "-o", "--page"].contains(&text.as_str()) {
            words.next();
            continue;
        }
        if ["explore", "report"].contains(&text.as_str()) && !has_command {
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
        let words = "allanite explore a.csv --rate 100 b.csv --open -o page.html --unit=deg/s --covariates t -q --columns gx,gy";
        let inputs = ["a.csv", "b.csv"].map(Into::into);
        let about = about_log(words.split(' ').map(Into::into), &inputs);
        assert_eq!(
            about,
            ["--rate", "100", "--unit=deg/s", "--columns", "gx,gy"]
        );
        let with = ["sinusoid:frequency_hz~0.3".to_owned()];
        let line = command(
            Path::new("my log.csv"),
            &about,
            &with,
            &["rate_ramp".to_owned()],
            false,
        );
        assert_eq!(
            line,
            "allanite compare 'my log.csv' --rate 100 --unit=deg/s --columns gx,gy \
             --with sinusoid:frequency_hz~0.3 --without rate_ramp"
        );
    }
}
