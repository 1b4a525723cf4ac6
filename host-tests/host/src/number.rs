//! Numbers in tables and sentences.

/// A number with four significant digits; `∞` if it is not finite.
pub fn number(value: f64) -> String {
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

/// A positive number with two significant digits.
pub fn two_digits(value: f64) -> String {
    round_to_two(value, f64::round)
}

/// A positive number with two significant digits, rounded up, so that what is said of a limit holds.
pub fn rounded_up(value: f64) -> String {
    // A number with two digits stays what it is, whatever its last bit.
    round_to_two(value, |digits| (digits - 1e-9).ceil())
}

fn round_to_two(value: f64, round: impl Fn(f64) -> f64) -> String {
    let exponent = value.log10().floor() as i32 - 1;
    let unit = 10_f64.powi(exponent);
    let rounded = round(value / unit) * unit;
    if (-5..=3).contains(&exponent) {
        format!("{rounded:.*}", (-exponent).max(0) as usize)
    } else {
        format!("{rounded:.1e}")
    }
}

/// A p-value with its relation, such as `= 0.338`.
pub fn probability(p: f64) -> String {
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
pub fn duration(seconds: f64) -> String {
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
    fn limits_have_two_digits_and_are_rounded_up() {
        let numbers = [0.004_61, 0.0046, 1.21, 12.01, 990.1, 3.3e-9];
        let texts = numbers.map(rounded_up);
        assert_eq!(texts, ["0.0047", "0.0046", "1.3", "13", "1000", "3.3e-9"]);
        assert_eq!(
            [0.004_64, 49.5, 0.1].map(two_digits),
            ["0.0046", "50", "0.10"]
        );
    }

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
