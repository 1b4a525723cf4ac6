//! Formulas beside effects of the catalogue whose covariances have closed forms.

use super::{Given, is_formula};
use allanite::effect::{
    AngleRandomWalk, BiasInstability, Effect, GaussMarkov, RateRandomWalk, SampledShape, Sinusoid,
    padded,
};

const INTERVAL_S: f64 = 0.02;

fn given(text: &str) -> Given {
    assert!(is_formula(text), "{text}");
    Given::parse("--with", text).unwrap_or_else(|failure| panic!("{failure}"))
}

fn refused(text: &str) -> String {
    match Given::parse("--with", text) {
        Ok(_) => panic!("{text} is read"),
        Err(failure) => failure.to_string(),
    }
}

/// Whether the Allan variances from an octave on, and the second differences far away, are those of the catalogue, to this share.
#[track_caller]
fn is_as(text: &str, effect: &dyn Effect, parameters: [f64; 3], from: u32, share: f64) {
    let own = given(text);
    let shape = |parameters| SampledShape {
        interval_s: INTERVAL_S,
        parameters,
    };
    let (own_shape, shape) = (shape(own.parameters), shape(parameters));
    for octave in from..20 {
        let m = f64::from(1_u32 << octave);
        let (one, other) = (
            own.effect.variance(m, &own_shape),
            effect.variance(m, &shape),
        );
        assert!(
            (one / other - 1.0).abs() < share,
            "{text}: the variance of {m} samples is {one}, not {other}"
        );
        // Far away, second differences are less than those at a distance of zero by far.
        let near = (own.effect.second_difference(0.0, m, &own_shape)
            - own.effect.second_difference(m, m, &own_shape))
        .abs();
        for x in [4.0 * m, 64.0 * m] {
            let constant = |effect: &dyn Effect, shape: &SampledShape| {
                effect.second_difference(x, m, shape) - effect.second_difference(2.0 * x, m, shape)
            };
            let (one, other) = (constant(own.effect, &own_shape), constant(effect, &shape));
            let bar = share * near.max(other.abs());
            assert!(
                (one - other).abs() < bar,
                "{text}: {one}, not {other}, {x} samples away at {m}"
            );
        }
    }
}

#[test]
fn densities_are_those_of_the_catalogue() {
    is_as("density: 1", &AngleRandomWalk, [0.0; 3], 0, 1e-4);
    // Exponentially correlated noise, sampled: 1 − z² over |1 − z e^(−iω)|².
    let z = (-INTERVAL_S / 0.8).exp();
    let text = format!(
        "density: {} / ({} - {} * cos(2*pi*f*{INTERVAL_S}))",
        INTERVAL_S * (1.0 - z * z),
        1.0 + z * z,
        2.0 * z
    );
    is_as(&text, &GaussMarkov, padded([0.8]), 0, 1e-4);
    // The noise of B and K goes on beyond half of the rate, which shows in short octaves.
    is_as("density: 1/(2*pi*f)", &BiasInstability, [0.0; 3], 6, 0.02);
    is_as("density: 1/(2*pi*f)^2", &RateRandomWalk, [0.0; 3], 6, 0.02);
}

#[test]
fn covariances_are_those_of_the_catalogue() {
    is_as(
        "covariance: exp(-t/0.8)",
        &GaussMarkov,
        padded([0.8]),
        0,
        1e-6,
    );
    is_as(
        "covariance: exp(-t/80)",
        &GaussMarkov,
        padded([80.0]),
        0,
        1e-5,
    );
    is_as(
        "covariance: 0.5*cos(2*pi*0.0317*t)",
        &Sinusoid,
        padded([0.0317]),
        0,
        2e-3,
    );
}

#[test]
fn narrow_densities_and_slow_oscillations_agree_with_each_other() {
    // A Lorentzian around 3 Hz is the density of an oscillation that forgets its phase.
    let width = 0.01_f64;
    let density = format!(
        "density: 1/({width}^2 + (2*pi*(f - 3))^2)*{width} + {width}/({width}^2 + (2*pi*(f + 3))^2)"
    );
    let covariance = format!("covariance: exp(-{width}*t)*cos(2*pi*3*t)");
    let [one, other] = [density, covariance].map(|text| given(&text));
    let shape = SampledShape::new(INTERVAL_S);
    for octave in 0..14 {
        let m = f64::from(1_u32 << octave);
        let [one, other] = [&one, &other].map(|own| own.effect.variance(m, &shape));
        assert!(
            (one / other - 1.0).abs() < 0.02,
            "{m}: {one} beside {other}"
        );
    }
}

#[test]
fn the_same_text_is_the_same_effect_and_is_written_back() {
    let text = "density: 1/(1 + (f/corner_hz)^2); corner_hz=0.1..30; name=servo";
    let (one, other) = (given(text), given(text));
    assert!(std::ptr::eq(one.effect, other.effect));
    assert!(one.is_fitted && one.parameters == [0.0; 3]);
    assert_eq!(one.effect.written(&one.parameters, true), one_line(text));
    let written = one.effect.written(&[2.9, 0.0, 0.0], true);
    let again = given(&written);
    assert!(std::ptr::eq(one.effect, again.effect), "{written}");
    assert_eq!(again.parameters, [2.9, 0.0, 0.0]);
    let known = given(&one.effect.written(&[2.9, 0.0, 0.0], false));
    assert!(!known.is_fitted && std::ptr::eq(one.effect, known.effect));
    assert_eq!(one.effect.description().parameters[0].unit, "Hz");
}

/// The order in which the name and the parameters are written back.
fn one_line(text: &str) -> String {
    let parts: Vec<&str> = text.split("; ").collect();
    format!("{}; {}; {}", parts[0], parts[2], parts[1])
}

#[test]
fn points_of_a_file_are_a_density() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("points.csv");
    std::fs::write(&path, "f,S\n# flat\n0.001,1\n1, 1\n100,1\n").expect("written");
    let text = format!("density: @{}", path.display());
    is_as(&text, &AngleRandomWalk, [0.0; 3], 0, 1e-4);
    std::fs::write(&path, "1 1\n2\n").expect("written");
    let told = refused(&text);
    assert!(
        told.contains("\"2\" is no point; give two numbers in each line"),
        "{told}"
    );
    let told = refused("density: @nowhere.csv");
    assert!(told.contains("nowhere.csv"), "{told}");
}

#[test]
fn forty_bad_effects_are_refused_in_a_line() {
    for (text, expected) in [
        ("density:", "the formula is empty"),
        ("density: ", "the formula is empty"),
        ("density: 1/(1+(f/3)^2", "close the parenthesis"),
        ("density: f**2", "write ^ for a power"),
        ("density: 2f", "write * between factors"),
        ("density: exp f", "write * between factors"),
        ("density: 1/t", "a density is a function of f"),
        ("covariance: 1/f", "a covariance is a function of t"),
        ("density: 1/g", "g has no value"),
        ("density: 1/corner_hz", "add ; corner_hz=LOW..HIGH"),
        ("density: f/a; a", "\"a\" has no value"),
        ("density: f/a; a=", "a=\"\" is no number above 0"),
        ("density: f/a; a=x", "a=\"x\" is no number above 0"),
        ("density: f/a; a=0", "no number above 0"),
        ("density: f/a; a=-1", "no number above 0"),
        ("density: f/a; a=nan", "no number above 0"),
        ("density: f/a; a=1e999", "no number above 0"),
        ("density: f/a; a=1..", "no number above 0"),
        ("density: f/a; a=..3", "no number above 0"),
        ("density: f/a; a=3..1", "a=3..1 is no range"),
        ("density: f/a; a=1..1", "is no range"),
        ("density: f/a; a=0..1", "no number above 0"),
        ("density: f/a; a~1..2", "no number above 0"),
        ("density: f/a; a=1; a=2", "a is given twice"),
        ("density: f/a; a=1; b=2", "the formula has no \"b\""),
        ("density: f/a/b; a=1; b=1..2", "some parameters are known"),
        ("density: f/a/b; a~1; b=1..2", "some parameters are known"),
        ("density: a*b*c*d*f; a=1; b=1; c=1; d=1", "has 4 parameters"),
        (
            "density: 1; name=sinusoid",
            "no name for an effect, or taken",
        ),
        ("density: 1; name=My Effect", "no name for an effect"),
        ("density: 1; name=", "no name for an effect"),
        ("density: -1", "the density is -1"),
        ("density: 1 - f", "the density is -"),
        ("density: sqrt(1 - f)", "the density is NaN"),
        ("density: 1/(f - a)^0.5; a=1..3", "the density is NaN"),
        ("density: 1/0", "the density is inf"),
        ("density: 0/0", "the density is NaN"),
        ("density: f^-60", "the density is inf"),
        ("density: f^-5", "rises as f^-3 or faster"),
        ("density: 1/(f/a)^3; a=1", "rises as f^-3 or faster"),
        ("covariance: -exp(-t)", "at t = 0 the covariance is -1"),
        ("covariance: 1/t", "at t = 0 the covariance is inf"),
        ("covariance: ln(t)", "at t = 0 the covariance is -inf"),
        ("covariance: 1 + t", "the Allan variance of"),
        ("covariance: exp(t)", "the covariance is inf"),
        ("covariance: sin(t)", "at t = 0 the covariance is 0"),
    ] {
        let told = refused(text);
        assert!(told.contains(expected), "{text}: {told}");
        assert!(!told.contains('\n'), "{told}");
        let remedy = told.split("; ").count() > 1;
        assert!(remedy, "{text} has no remedy: {told}");
    }
}
