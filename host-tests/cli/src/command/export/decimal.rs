//! Numbers in a notation that every parser reads as a number.

/// The shortest decimal that reads back as the same number. It has a point, and a sign in the exponent
/// if there is one, because parsers of YAML 1.1 take `1e-5` for a string.
pub(super) fn decimal(value: f64) -> String {
    let magnitude = value.abs();
    if value == 0.0 || (1e-3..1e7).contains(&magnitude) {
        return format!("{value:?}");
    }
    let text = format!("{value:e}");
    let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let point = if digits.contains('.') { "" } else { ".0" };
    let sign = if exponent.starts_with('-') { "" } else { "+" };
    format!("{digits}{point}e{sign}{exponent}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_a_point_and_a_signed_exponent_and_read_back_the_same() {
        let numbers = [0.0, 100.0, 0.012, 1e-5, 6.643e-4, 1e22, 1.0 / 3.0 * 1e-9];
        let shown = numbers.map(decimal);
        assert_eq!(
            shown[..6],
            ["0.0", "100.0", "0.012", "1.0e-5", "6.643e-4", "1.0e+22"]
        );
        for (number, shown) in numbers.iter().zip(&shown) {
            assert_eq!(shown.parse::<f64>().unwrap(), *number);
        }
    }
}
