//! The image on a Cortex-M4F and the same computation here agree to the bit.

use allanite::self_test::SelfTest;
use host_tests::firmware::{Image, run};

/// The words that are bits of a number: those after each decimal one.
fn bits(line: &str, names: &[&str]) -> Vec<u64> {
    let words: Vec<_> = line.split(' ').collect();
    let value = |name: &&str| {
        let place = words.iter().position(|word| word == name)?;
        u64::from_str_radix(words.get(place + 2)?, 16).ok()
    };
    let bits: Vec<_> = names.iter().filter_map(value).collect();
    assert_eq!(bits.len(), names.len(), "{line:?} lacks some of {names:?}");
    bits
}

fn lines<'a>(log: &'a [String], kind: &str) -> Vec<&'a str> {
    let start = format!("info {kind} ");
    log.iter()
        .filter_map(|line| line.strip_prefix(&start))
        .collect()
}

#[test]
fn image_and_host_agree_to_the_bit() {
    let image = Image::build("self_test").unwrap_or_else(|error| panic!("{error:#}"));
    let run = run(&image).unwrap_or_else(|error| panic!("{error:#}"));
    println!("{}", run.lines.join("\n"));
    assert!(run.status.success(), "the image ended with {}", run.status);

    let here = SelfTest::run().unwrap();
    assert!(here.passed());

    let octaves = lines(&run.lines, "octave");
    assert_eq!(octaves.len(), here.curve.points().len());
    for (line, point) in octaves.iter().zip(here.curve.points()) {
        let start = format!("m {} differences {} ", point.m, point.differences);
        assert!(
            line.starts_with(&start),
            "{line:?} does not start with {start:?}"
        );
        assert_eq!(
            bits(line, &["variance"]),
            [point.variance.to_bits()],
            "{line}"
        );
    }

    let coefficients = lines(&run.lines, "coefficient");
    assert_eq!(coefficients.len(), here.fit.coefficients.len());
    for (line, coefficient) in coefficients.iter().zip(&here.fit.coefficients) {
        assert!(line.starts_with(coefficient.name), "{line}");
        let expected = [coefficient.value, coefficient.lower, coefficient.upper];
        let bits = bits(line, &["value", "lower", "upper"]);
        assert_eq!(bits, expected.map(f64::to_bits), "{line}");
    }

    let [fit] = lines(&run.lines, "fit")[..] else {
        panic!("the image says nothing of the fit");
    };
    let start = format!("degrees_of_freedom {} ", here.fit.degrees_of_freedom);
    assert!(fit.starts_with(&start), "{fit}");
    let expected = [here.fit.chi_squared, here.fit.p_value];
    assert_eq!(
        bits(fit, &["chi_squared", "p_value"]),
        expected.map(f64::to_bits),
        "{fit}"
    );
}
