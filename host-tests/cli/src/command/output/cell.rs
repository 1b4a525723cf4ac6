//! Cells of tables that spreadsheets open.

use allanite_log::failure::one_line;

/// The cell of a table for text: a spreadsheet takes text that begins like a formula for one, so that an apostrophe
/// stands before it. A number stays as it is.
pub(crate) fn cell(text: &str) -> String {
    let text = one_line(text);
    // The second row is that of the wide forms, which some spreadsheets take for the same.
    let begins = [
        '=', '+', '-', '@', '\u{ff1d}', '\u{ff0b}', '\u{ff0d}', '\u{ff20}',
    ];
    match text.trim_start().starts_with(begins) && text.parse::<f64>().is_err() {
        true => format!("'{text}"),
        false => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_that_begins_like_a_formula_is_no_formula() {
        for formula in ["=1", "+a", "-a", "@a", " =1", "\t=1", "\u{ff1d}1", "-1e"] {
            assert!(cell(formula).starts_with('\''), "{formula:?}");
        }
        for other in ["", "gx", "-1", "+2.5e-3", "a=1", "'=1"] {
            assert_eq!(cell(other), other);
        }
    }
}
