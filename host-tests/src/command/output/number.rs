//! Numbers in tables and sentences.

/// A number with four significant digits; `∞` if it is not finite.
pub(crate) fn number(value: f64) -> String {
    if value == 0.0 {
        return "0".into();
    }
    if !value.is_finite() {
        return "∞".into();
    }
    let exponent = value.abs().log10().floor() as i32;
    if (-3..=4).contains(&exponent) {
        format!("{value:.*}", (3 - exponent).max(0) as usize)
    } else {
        format!("{value:.3e}")
    }
}

/// A p-value with its relation, such as `= 0.338`.
pub(crate) fn probability(p: f64) -> String {
    if p >= 0.001 {
        format!("= {p:.3}")
    } else if p > 0.0 {
        format!("= {p:.1e}")
    } else {
        // The probability is smaller than any floating-point number.
        "< 1e-307".into()
    }
}

/// A length of time in seconds, minutes, hours or days, whichever is readable.
pub(crate) fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 120.0 => format!("{s:.3} s"),
        s if s < 7200.0 => format!("{:.1} min", s / 60.0),
        s if s < 172_800.0 => format!("{:.1} h", s / 3600.0),
        s if s < 86_400e6 => format!("{:.0} days", s / 86_400.0),
        s => format!("{:.3e} days", s / 86_400.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_digits_are_shown_wherever_the_point_is() {
        let numbers = [
            0.0,
            1.0 / 3.0,
            -0.001_234_56,
            12_345.6,
            1.234_56e-4,
            9_999_999.0,
        ];
        assert_eq!(
            numbers.map(number),
            ["0", "0.3333", "-0.001235", "12346", "1.235e-4", "1.000e7"]
        );
        assert_eq!(number(f64::INFINITY), "∞");
    }

    #[test]
    fn lengths_of_time_have_the_unit_that_suits() {
        let lengths = [0.25, 119.0, 600.0, 10_000.0, 864_000.0];
        assert_eq!(
            lengths.map(duration),
            ["0.250 s", "119.000 s", "10.0 min", "2.8 h", "10 days"]
        );
    }
}
