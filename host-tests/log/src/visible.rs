//! Text that shows all of its characters.
//!
//! Some characters turn the direction of those behind them or cannot be seen, so that a name looks like another one
//! (<https://www.unicode.org/reports/tr36/>). They are shown as the escapes of JSON, which stay the same text in a JSON
//! document.

use std::{borrow::Cow, fmt::Write as _};

/// Whether a terminal shows nothing for a character, or changes what it shows of others. The marks of emphasis and
/// colour, which begin with an escape of ASCII, are not among them.
pub const fn is_invisible(character: char) -> bool {
    matches!(
        character,
        '\u{7f}'..='\u{9f}'
            | '\u{ad}'
            | '\u{34f}'
            | '\u{61c}'
            | '\u{115f}'..='\u{1160}'
            | '\u{17b4}'..='\u{17b5}'
            | '\u{180b}'..='\u{180f}'
            | '\u{200b}'..='\u{200f}'
            | '\u{2028}'..='\u{202e}'
            | '\u{2060}'..='\u{206f}'
            | '\u{3164}'
            | '\u{fe00}'..='\u{fe0f}'
            | '\u{feff}'
            | '\u{ffa0}'
            | '\u{fff0}'..='\u{fffb}'
            | '\u{1bca0}'..='\u{1bca3}'
            | '\u{1d173}'..='\u{1d17a}'
            | '\u{e0000}'..='\u{e0fff}'
    )
}

/// The text with escapes in the place of characters that cannot be seen.
pub fn visible(text: &str) -> Cow<'_, str> {
    if text.is_ascii() && !text.contains('\u{7f}') || !text.contains(is_invisible) {
        return text.into();
    }
    let mut shown = String::with_capacity(text.len());
    for character in text.chars() {
        if is_invisible(character) {
            for unit in character.encode_utf16(&mut [0; 2]) {
                // Writing to a string does not fail.
                let _ = write!(shown, "\\u{unit:04x}");
            }
        } else {
            shown.push(character);
        }
    }
    shown.into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn characters_that_cannot_be_seen_are_escaped_as_json_does() {
        assert_eq!(visible("a\u{202e}gnp.exe"), "a\\u202egnp.exe");
        assert_eq!(visible("\u{e0041}\u{7f}"), "\\udb40\\udc41\\u007f");
        let plain = "τ 1 °/√h ≤ 3 … ⣿ 中文 \u{1b}[31m";
        assert!(matches!(visible(plain), Cow::Borrowed(text) if text == plain));
        let json: String = serde_json::from_str(&visible("\"\u{200b}\u{e0041}\"")).unwrap();
        assert_eq!(json, "\u{200b}\u{e0041}");
    }
}
