//! The images on every core and the same computation here agree to the bit.

use allanite::{
    Addition, Step, Verdict,
    demonstration::{
        characterise::Characterised,
        diagnose::{HIDDEN, diagnose},
    },
};
use host_tests::firmware::{CORES, Core, Image, run, run_with};

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
fn every_core_and_the_host_agree_to_the_bit() {
    for core in &CORES {
        assert_agrees(core);
    }
}

fn assert_agrees(core: &Core) {
    println!("{}", core.name);
    let image = Image::build_for("characterise", core).unwrap_or_else(|error| panic!("{error:#}"));
    let run = run(&image).unwrap_or_else(|error| panic!("{error:#}"));
    println!("{}", run.lines.join("\n"));
    assert!(run.status.success(), "the image ended with {}", run.status);

    let here = Characterised::run().unwrap();
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

/// The lines that the image logs of a step, with the bits of every number.
fn logged<const K: usize>(step: &Step<K>) -> Vec<String> {
    let mut lines = Vec::new();
    for octave in &step.comparison.octaves {
        lines.push(format!("octave {} {:x}", octave.m, octave.z.to_bits()));
    }
    lines.push(format!("comparison {}", step.comparison));
    let numbers = [
        step.fit.chi_squared,
        step.fit.p_value,
        step.comparison.rms_percent,
    ];
    let [chi_squared, p_value, rms] = numbers.map(f64::to_bits);
    let freedom = step.fit.degrees_of_freedom;
    lines.push(format!("fit {freedom} {chi_squared:x} {p_value:x} {rms:x}"));
    for one in &step.fit.coefficients {
        lines.push(format!(
            "coefficient {} {:x}",
            one.name,
            one.value.to_bits()
        ));
    }
    for one in &step.candidates {
        let name = one.term.effect.name();
        lines.push(format!("candidate {name} {:x}", one.improvement.to_bits()));
    }
    if let Some(swap) = step.swap() {
        let [taken, dropped] = [swap.taken, swap.dropped].map(|effect| effect.name());
        lines.push(format!("{taken} instead of {dropped}"));
    }
    for name in &step.ambiguous {
        lines.push(format!("ambiguous {name}"));
    }
    if let Some(Addition::Effect(term)) = &step.added {
        let name = term.effect.name();
        lines.push(format!("added {name} {:x}", term.parameters[0].to_bits()));
    }
    lines
}

/// A line of the image with names and decimals taken out: what [`logged`] writes.
fn condensed(line: &str) -> String {
    let words: Vec<&str> = line.split(' ').collect();
    match words[..] {
        ["octave", _, m, .., bits] => format!("octave {m} {bits}"),
        [
            "fit",
            _,
            freedom,
            _,
            _,
            chi_squared,
            _,
            _,
            p_value,
            _,
            _,
            rms,
        ] => {
            format!("fit {freedom} {chi_squared} {p_value} {rms}")
        }
        ["comparison", ..] | ["ambiguous", _] | [_, "instead", ..] => line.to_owned(),
        [kind, name, .., bits] => format!("{kind} {name} {bits}"),
        _ => line.to_owned(),
    }
}

#[test]
fn image_finds_hidden_effects_as_the_host_does_to_the_bit() {
    let image = Image::build("hidden_effect").unwrap_or_else(|error| panic!("{error:#}"));
    for (name, disturbance) in HIDDEN {
        let run = run_with(&image, &[name]).unwrap_or_else(|error| panic!("{error:#}"));
        println!("{}", run.lines.join("\n"));
        assert!(run.status.success(), "the image ended with {}", run.status);

        let (mut here, mut errors, mut found) = (Vec::new(), Vec::new(), Vec::new());
        let verdict = diagnose(Some(disturbance), |step| {
            here.extend(logged(step));
            errors.push(step.fit.chi_squared);
            if let Some(Addition::Effect(term)) = &step.added {
                found.push(term.effect.name());
                found.extend(&step.ambiguous);
            }
        });
        assert_eq!(verdict, Ok(Verdict::Improved), "{name}");
        assert!(found.contains(&name), "{name}: {found:?}");
        let (first, last) = (errors[0], errors[errors.len() - 1]);
        assert!(last < 0.3 * first, "{name}: {errors:?}");

        let there = run
            .lines
            .iter()
            .filter_map(|line| line.strip_prefix("info "));
        let there: Vec<String> = there.map(condensed).collect();
        assert_eq!(there[..there.len() - 1], here, "{name}");
        assert_eq!(there[there.len() - 1], "verdict Improved");
    }
}
