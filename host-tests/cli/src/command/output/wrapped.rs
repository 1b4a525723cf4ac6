//! Sentences that are broken between words where a terminal is narrower than they are, in text that shows all of its
//! characters.

use allanite_log::visible::visible;
use console::Term;
use std::io::{self, Write};
use textwrap::{Options, core::display_width};

/// The widest text, in columns. Longer lines are tiring to read.
const WIDEST: usize = 100;
/// A sentence is not broken into columns narrower than this one.
const NARROWEST: usize = 40;
/// What a line is about may take so many columns before its sentence, which is continued below its beginning.
const DEEPEST: usize = 30;

/// Writes lines, of which sentences are broken if the output is a terminal. A file or another program gets them whole,
/// so that they can be searched.
pub(crate) struct Wrapped<W: Write> {
    to: W,
    /// The width of the terminal; `None` if the output is not one.
    width: Option<usize>,
    line: Vec<u8>,
}

impl<W: Write> Wrapped<W> {
    /// A writer of standard output.
    pub(crate) fn new(to: W) -> Self {
        let terminal = Term::stdout();
        let width = || usize::from(terminal.size().1).clamp(NARROWEST, WIDEST);
        Self {
            to,
            width: terminal.is_term().then(width),
            line: Vec::new(),
        }
    }

    fn write_line(&mut self) -> io::Result<()> {
        let line = std::mem::take(&mut self.line);
        let Ok(text) = std::str::from_utf8(&line) else {
            return self.to.write_all(&line);
        };
        let text = visible(text);
        match self.width {
            Some(width) => self.to.write_all(broken(&text, width).as_bytes()),
            None => self.to.write_all(text.as_bytes()),
        }
    }
}

impl<W: Write> Write for Wrapped<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        // Nearly all that is written to a file or another program is ASCII, and needs no line.
        if self.width.is_none() && self.line.is_empty() && is_plain(bytes) {
            return self.to.write(bytes);
        }
        for line in bytes.split_inclusive(|&byte| byte == b'\n') {
            self.line.extend_from_slice(line);
            if line.ends_with(b"\n") {
                self.write_line()?;
            }
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.write_line()?;
        self.to.flush()
    }
}

/// Whether bytes are characters of ASCII that can be seen.
fn is_plain(bytes: &[u8]) -> bool {
    bytes.iter().all(|&byte| byte < 0x7f)
}

/// A line with its end, broken if it is wider than so many columns and a sentence. A row of a table, in which more than
/// two gaps have several blanks, stays whole, and so does JSON.
fn broken(line: &str, width: usize) -> String {
    let (text, end) = match line.strip_suffix('\n') {
        Some(text) => (text, "\n"),
        None => (line, ""),
    };
    let indented = text.len() - text.trim_start_matches(' ').len();
    let gaps: Vec<(usize, &str)> = text[indented..].match_indices("  ").collect();
    let apart = gaps.windows(2).filter(|pair| pair[1].0 > pair[0].0 + 2);
    let is_table = apart.count() > 1;
    if display_width(text) <= width || is_table || text.starts_with(['{', '[']) {
        return line.into();
    }
    // The sentence begins behind the gap, if there is one.
    let begins = gaps.last().map_or(indented, |&(at, gap)| {
        let blanks = &text[indented + at + gap.len()..];
        text.len() - blanks.trim_start_matches(' ').len()
    });
    let column = match gaps.is_empty() {
        true => indented + 2,
        false => display_width(&text[..begins]),
    };
    let (first, column) = match column <= DEEPEST {
        true => (&text[..begins], column),
        false => (&text[..indented], indented + 2),
    };
    let below = " ".repeat(column);
    let options = Options::new(width)
        .initial_indent(first)
        .subsequent_indent(&below)
        .break_words(false);
    textwrap::fill(&text[first.len()..], options) + end
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn characters_that_cannot_be_seen_are_escaped_however_they_are_written() {
        let text = "a\u{202e}gnp, τ\n\u{200b}end".as_bytes();
        for piece in 1..=text.len() {
            let mut wrapped = Wrapped {
                to: Vec::new(),
                width: None,
                line: Vec::new(),
            };
            for bytes in text.chunks(piece) {
                wrapped.write_all(bytes).unwrap();
            }
            wrapped.flush().unwrap();
            let shown = String::from_utf8(wrapped.to).unwrap();
            assert_eq!(shown, "a\\u202egnp, τ\n\\u200bend", "pieces of {piece}");
        }
    }

    #[test]
    fn sentences_are_continued_below_their_beginning() {
        let sentence = "  what it is:    white noise is averaged over longer than a sample\n";
        let expected = "  what it is:    white noise is averaged\n                 over longer than a sample\n";
        assert_eq!(broken(sentence, 44), expected);
        let plain = "  the last p-value takes the added effects for known: they were the best\n";
        let expected =
            "  the last p-value takes the added effects\n    for known: they were the best\n";
        assert_eq!(broken(plain, 44), expected);
    }

    #[test]
    fn tables_json_and_short_lines_stay_whole() {
        for line in [
            "effect              value  95 % interval      unit       customary\n",
            "{\"axes\": [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15]}\n",
            "a short line\n",
            "\n",
            "",
        ] {
            assert_eq!(broken(line, 44), line);
        }
    }

    #[test]
    fn a_long_word_stays_whole() {
        let path = format!("  {}\n", "x".repeat(60));
        assert_eq!(broken(&path, 44).trim_start(), path.trim_start());
    }

    #[test]
    fn a_file_gets_every_byte_as_it_is() {
        let mut written = Vec::new();
        let mut wrapped = Wrapped {
            to: &mut written,
            width: None,
            line: Vec::new(),
        };
        wrapped.write_all(b"one \xff line\nand a part").unwrap();
        wrapped.flush().unwrap();
        assert_eq!(written, b"one \xff line\nand a part");
        let mut written = Vec::new();
        let mut wrapped = Wrapped {
            to: &mut written,
            width: Some(50),
            line: Vec::new(),
        };
        wrapped.write_all(b"one \xff line\nand a ").unwrap();
        wrapped.write_all(b"part").unwrap();
        wrapped.flush().unwrap();
        assert_eq!(written, b"one \xff line\nand a part");
    }
}
