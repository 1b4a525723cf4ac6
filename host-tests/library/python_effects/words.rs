//! The words of the catalogue as those of Python.

/// The columns of a line.
const WIDTH: usize = 120;

/// The first paragraph of the documentation of a type of this name, from the text of its file.
///
/// # Panics
/// If the file has no such type, or the type no documentation.
pub(crate) fn paragraph(source: &str, name: &str) -> String {
    let lines: Vec<&str> = source.lines().collect();
    let declared = format!("pub struct {name};");
    let at = lines.iter().position(|line| *line == declared);
    let at = at.unwrap_or_else(|| panic!("there is no {declared}"));
    let above = lines[..at].iter().rev();
    let mut documented: Vec<&str> = above
        .skip_while(|line| line.starts_with("#["))
        .map_while(|line| line.strip_prefix("///"))
        .map(str::trim)
        .collect();
    documented.reverse();
    let first: Vec<&str> = documented
        .into_iter()
        .take_while(|line| !line.is_empty())
        .collect();
    assert!(!first.is_empty(), "{name} is not documented");
    first.join(" ")
}

/// Code between backquotes, alone or as a link to an item, as Python writes it: between two of them.
pub(crate) fn in_python(text: &str) -> String {
    let mut parts = text.split('`');
    let mut written = parts.next().unwrap_or_default().to_owned();
    while let Some(code) = parts.next() {
        let rest = parts.next().unwrap_or_else(|| panic!("{code} has no end"));
        let rest = match written.strip_suffix('[') {
            Some(before) => {
                written.truncate(before.len());
                without_address(rest)
            }
            None => rest,
        };
        written += &format!("``{code}``{rest}");
    }
    assert!(!written.contains(['[', ']', '\\', '"']), "{written}");
    written
}

/// What follows the text of a link: without the bracket, and the address if there is one.
fn without_address(rest: &str) -> &str {
    let rest = rest.strip_prefix(']').unwrap_or(rest);
    let address = rest.strip_prefix('(').and_then(|rest| rest.split_once(')'));
    address.map_or(rest, |(_, after)| after)
}

/// Words as a sentence.
pub(crate) fn sentence(words: &str) -> String {
    let mut letters = words.chars();
    let first = letters.next().into_iter().flat_map(char::to_uppercase);
    format!("{}{}.", first.collect::<String>(), letters.as_str())
}

/// A paragraph in lines that fit, behind this many spaces.
pub(crate) fn wrapped(text: &str, indent: usize) -> String {
    let space = " ".repeat(indent);
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        let fits = |line: &String| line.chars().count() + 1 + word.chars().count() <= WIDTH;
        match lines.last_mut().filter(|line| fits(line)) {
            Some(line) => *line += &format!(" {word}"),
            None => lines.push(format!("{space}{word}")),
        }
    }
    lines.iter().map(|line| format!("{line}\n")).collect()
}

#[test]
fn documentation_of_rust_becomes_that_of_python() {
    let source = "use x;\n\n/// An [`A`](super::A) or [`B`] of `x_1`,\n/// in s.\n///\n/// More.\n#[derive(Debug)]\npub struct One;\n";
    let first = paragraph(source, "One");
    assert_eq!(first, "An [`A`](super::A) or [`B`] of `x_1`, in s.");
    assert_eq!(in_python(&first), "An ``A`` or ``B`` of ``x_1``, in s.");
    assert_eq!(sentence("a ramp: it drifts"), "A ramp: it drifts.");
    let words = "word ".repeat(30);
    let lines = wrapped(&words, 8);
    assert!(lines.lines().all(|line| line.len() <= WIDTH), "{lines}");
    assert_eq!(lines.split_whitespace().count(), 30);
}
