//! Arguments that the command line does not accept, in one line like every other failure.

use allanite_log::failure::Failure;

/// The failure of a command line that could not be parsed. The remedy is the parser's tip, or else the help of the
/// command.
pub fn failure(error: &clap::Error) -> Failure {
    let text = error.render().to_string();
    let paragraphs: Vec<String> = text.split("\n\n").map(joined).collect();
    let after = |start: &str| {
        let mut found = paragraphs
            .iter()
            .filter_map(|text| text.strip_prefix(start));
        found.next().map(str::to_owned)
    };
    let what = after("error: ").unwrap_or_else(|| "a command is missing".into());
    let command = after("Usage: ").map_or("allanite".into(), |usage| command(&usage));
    let remedy = after("tip: ").unwrap_or_else(|| format!("see `{command} --help`"));
    Failure::option(what, remedy)
}

/// The lines of a paragraph, joined.
fn joined(paragraph: &str) -> String {
    let words: Vec<&str> = paragraph.split_whitespace().collect();
    words.join(" ")
}

/// The program and its subcommands at the beginning of a line of usage.
fn command(usage: &str) -> String {
    let is_name = |word: &&str| !word.starts_with(['[', '<', '-']);
    let names: Vec<&str> = usage.split(' ').take_while(is_name).collect();
    names.join(" ")
}
