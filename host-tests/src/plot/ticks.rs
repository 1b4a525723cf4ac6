//! Ticks: round numbers along an axis, and their labels.

/// Powers of ten between two positive numbers. If there are fewer than two, also 2 and 5 times a power
/// of ten.
pub(super) fn logarithmic(low: f64, high: f64) -> Vec<f64> {
    let between = |factors: &[f64]| -> Vec<f64> {
        let exponents = low.log10().floor() as i32..=high.log10().ceil() as i32;
        exponents
            .flat_map(|exponent| factors.iter().map(move |f| f * 10_f64.powi(exponent)))
            .filter(|value| (low * (1.0 - 1e-9)..=high * (1.0 + 1e-9)).contains(value))
            .collect()
    };
    let powers = between(&[1.0]);
    if powers.len() < 2 {
        between(&[1.0, 2.0, 5.0])
    } else {
        powers
    }
}

/// The next number of the sequence 1, 2, 5, 10, … .
pub(super) fn round_up(value: f64) -> f64 {
    let power = 10_f64.powi(value.log10().floor() as i32);
    let rounds = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * power);
    rounds
        .into_iter()
        .find(|round| *round >= value)
        .unwrap_or(value)
}

/// A number as a digit and a power of ten, such as `2e1`.
pub(super) fn power(value: f64) -> String {
    format!("{value:.0e}")
}

/// A number as people write it: with its zeros if they are few, otherwise with a power of ten.
pub(super) fn plain(value: f64) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    // Rounding can leave the logarithm of a power of ten slightly too small.
    let exponent = (value.log10() + 1e-9).floor() as i32;
    if (-3..5).contains(&exponent) {
        return format!("{value:.*}", usize::try_from(-exponent).unwrap_or(0));
    }
    let sign = if exponent < 0 { "⁻" } else { "" };
    let digits = exponent.unsigned_abs().to_string();
    let digits = digits
        .bytes()
        .map(|digit| DIGITS[usize::from(digit - b'0')]);
    let power = format!("10{sign}{}", digits.collect::<String>());
    match (value / 10_f64.powi(exponent)).round() {
        1.0 => power,
        factor => format!("{factor}·{power}"),
    }
}

/// A length of time in µs, ms or s.
pub(super) fn time(seconds: f64) -> String {
    let short = |value: f64, unit: &str| format!("{} {unit}", (value * 1e6).round() / 1e6);
    match seconds {
        s if s < 1e-3 => short(s * 1e6, "µs"),
        s if s < 1.0 => short(s * 1e3, "ms"),
        s => short(s, "s"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        assert_eq!(logarithmic(0.02, 30.0), [0.1, 1.0, 10.0]);
        assert_eq!(logarithmic(0.015, 0.06), [0.02, 0.05]);
        assert_eq!(
            [3.0, 10.0, 51.0, 200.0].map(round_up),
            [5.0, 10.0, 100.0, 200.0]
        );
        assert_eq!(
            [1e-4, 0.01, 0.1, 1.0, 1000.0].map(time),
            ["100 µs", "10 ms", "100 ms", "1 s", "1000 s"]
        );
        assert_eq!(
            [2e-5, 0.001, 0.5, 20.0, 1e6].map(plain),
            ["2·10⁻⁵", "0.001", "0.5", "20", "10⁶"]
        );
        assert_eq!([0.001, 0.1, 20.0].map(power), ["1e-3", "1e-1", "2e1"]);
    }
}
