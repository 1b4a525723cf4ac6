//! Words as text for a shell.

/// A word with the quotes that a shell needs.
pub(crate) fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=,:+%@".contains(c);
    // A tilde stands for a folder only at the beginning of a word or behind a colon or an equals sign.
    let is_plain = |(at, c): (usize, char)| {
        plain(c) || (c == '~' && !before(word, at).is_some_and(|c| "=:".contains(c)) && at > 0)
    };
    if !word.is_empty() && word.char_indices().all(is_plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
    }
}

fn before(word: &str, at: usize) -> Option<char> {
    word.get(..at)?.chars().next_back()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_that_a_shell_would_change_is_quoted() {
        assert_eq!(quoted("it's"), "'it'\\''s'");
        assert_eq!(quoted("~a"), "'~a'");
        assert_eq!(quoted(""), "''");
        assert_eq!(quoted("a~b=1"), "a~b=1");
    }
}
