//! Ticks: round numbers along an axis, and their labels.

/// Powers of ten between two positive numbers. If there are fewer than four, also 2 and 5 times a power of ten, and
/// if there are fewer than three of all these, more digits.
pub(super) fn logarithmic(low: f64, high: f64) -> Vec<f64> {
    let between = |factors: &[f64]| -> Vec<f64> {
        let exponents = low.log10().floor() as i32..=high.log10().ceil() as i32;
        exponents
            .flat_map(|exponent| factors.iter().map(move |f| f * 10_f64.powi(exponent)))
            .filter(|value| (low * (1.0 - 1e-9)..=high * (1.0 + 1e-9)).contains(value))
            .collect()
    };
    let powers = between(&[1.0]);
    if powers.len() >= 4 {
        return powers;
    }
    let few = between(&[1.0, 2.0, 5.0]);
    if few.len() >= 3 {
        return few;
    }
    between(&[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0])
}

/// Multiples of a round step from one number to another, at least two and at most six.
pub(super) fn linear(low: f64, high: f64) -> Vec<f64> {
    let step = round_up((high - low) / 6.0 * (1.0 - 1e-9));
    let first = (low / step - 1e-9).ceil() as i64;
    let last = (high / step + 1e-9).floor() as i64;
    (first..=last).map(|k| k as f64 * step).collect()
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

/// A number as a digit, or two, and a power of ten, such as `2e1`.
pub(super) fn power(value: f64) -> String {
    format!("{value:.1e}").replace(".0e", "e")
}

/// A number as people write it: with its zeros if they are few, otherwise with a power of ten.
pub(super) fn plain(value: f64) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let text = power(value);
    let (factor, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    if (-3..5).contains(&exponent) {
        let more = i32::from(factor.contains('.'));
        return format!("{value:.*}", usize::try_from(more - exponent).unwrap_or(0));
    }
    let sign = if exponent < 0 { "⁻" } else { "" };
    let digits = exponent.unsigned_abs().to_string();
    let digits = digits
        .bytes()
        .map(|digit| DIGITS[usize::from(digit - b'0')]);
    let power = format!("10{sign}{}", digits.collect::<String>());
    match factor {
        "1" => power,
        factor => format!("{factor}·{power}"),
    }
}

/// Labels of numbers with the digits that tell them apart.
pub(super) fn told_apart(values: &[f64]) -> Vec<(f64, String)> {
    let steps = values.windows(2).map(|pair| pair[1] - pair[0]);
    let step = steps.fold(f64::INFINITY, f64::min);
    // Rounding can leave the logarithm of a power of ten slightly too small.
    let exponent = (step.log10() + 1e-9).floor();
    let label = |value: &f64| {
        let value = if value.abs() < 1e-9 * step {
            0.0
        } else {
            *value
        };
        let label = if exponent < -5.0 {
            power(value)
        } else {
            format!("{value:.*}", (-exponent).max(0.0) as usize)
        };
        (value, label.replace('-', "−"))
    };
    values.iter().map(label).collect()
}

/// A unit of time in which a record of this many seconds is a number of few digits, and its length in seconds.
pub(super) const fn time_unit(seconds: f64) -> (&'static str, f64) {
    match seconds {
        s if s < 300.0 => ("s", 1.0),
        s if s < 3.0 * 3600.0 => ("min", 60.0),
        s if s < 72.0 * 3600.0 => ("h", 3600.0),
        _ => ("days", 86_400.0),
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
        assert_eq!(logarithmic(0.02, 300.0), [0.1, 1.0, 10.0, 100.0]);
        assert_eq!(logarithmic(0.7, 30.0), [1.0, 2.0, 5.0, 10.0, 20.0]);
        assert_eq!(
            logarithmic(0.015, 0.06),
            [0.015, 0.02, 0.03, 0.04, 0.05, 0.06]
        );
        let steps = linear(-0.11, 0.4);
        assert_eq!(steps.len(), 6);
        let off = |(k, tick): (usize, &f64)| (tick - 0.1 * (k as f64 - 1.0)).abs();
        assert!(steps.iter().enumerate().map(off).all(|off| off < 1e-12));
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
        assert_eq!([1.5, 0.15, 1.5e-5].map(plain), ["1.5", "0.15", "1.5·10⁻⁵"]);
        let labels = told_apart(&[-0.1, 0.0, 0.1]);
        let labels: Vec<&str> = labels.iter().map(|(_, label)| label.as_str()).collect();
        assert_eq!(labels, ["−0.1", "0.0", "0.1"]);
        assert_eq!([0.001, 0.1, 20.0].map(power), ["1e-3", "1e-1", "2e1"]);
    }

    #[test]
    fn every_axis_of_a_factor_of_two_and_a_quarter_has_two_ticks() {
        for k in 0..200 {
            let low = 1e-4 * 1.05_f64.powi(k);
            let ticks = logarithmic(low, 2.25 * low);
            assert!(ticks.len() >= 2, "{low}: {ticks:?}");
            let labels: Vec<String> = ticks.iter().copied().map(plain).collect();
            assert!(
                labels.windows(2).all(|pair| pair[0] != pair[1]),
                "{labels:?}"
            );
            let (from, to) = (-low, low * f64::from(k + 1));
            let ticks = linear(from, to);
            assert!((2..=7).contains(&ticks.len()), "{from} {to}: {ticks:?}");
        }
    }
}
