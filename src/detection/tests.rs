use super::*;
use crate::{
    Curve, Model, Real, Term,
    diagnosis::{Diagnosis, Evidence, Options, Progress as Diagnosed, Step, Verdict},
    effect::{CATALOGUE, DecimationFilter, Effect, GaussMarkov, LowPass, Sinusoid},
    fit,
    real::real,
};
use heapless::Vec;

const RATE_HZ: Real = 100.0;
const SAMPLES: u32 = 1 << 16;
/// Q, N, B, K and R of a consumer gyro, in °/s and seconds.
const MEMS: [Real; 5] = [2e-4, 5e-3, 4e-3, 3e-4, 0.0];

/// The curve that is expected of a gyro with these coefficients and some effects. Each effect has the
/// square of its coefficient.
fn curve(coefficients: &[Real], effects: &[(Term, Real)]) -> Curve<20> {
    let model = Model::ieee_952();
    let squares: Vec<Real, 8> = coefficients.iter().map(|x| x * x).collect();
    let octaves = (0..15).filter_map(|k| {
        let m = 1_u32 << k;
        let differences = (SAMPLES - 2 * m) / (m / 4).max(1) + 1;
        let effect = |(term, square): &(Term, Real)| {
            let shape = term.sampled_shape(1.0 / RATE_HZ);
            square * term.effect.variance(real(m), &shape)
        };
        let added: Real = effects.iter().map(effect).sum();
        let variance = model.variance(&squares, m, 1.0 / RATE_HZ) + added;
        (differences >= 6).then_some((m, u64::from(differences), variance))
    });
    Curve::new(RATE_HZ, octaves).expect("a curve")
}

/// The last step of a diagnosis.
fn diagnosed(curve: &Curve<20>) -> (Step<20>, Verdict) {
    let (model, options) = (Model::ieee_952(), Options::default());
    let mut diagnosis = Diagnosis::new(curve.clone(), Evidence::NONE, &model, &CATALOGUE, options);
    let mut last = None;
    loop {
        match diagnosis.advance().expect("a diagnosis") {
            Diagnosed::Working => {}
            Diagnosed::Step(step) => last = Some(step.clone()),
            Diagnosed::Finished(verdict) => return (last.expect("a step"), verdict),
        }
    }
}

fn detection(curve: &Curve<20>) -> Detection<'static, 20> {
    let (step, verdict) = diagnosed(curve);
    assert_eq!(verdict, Verdict::Adequate);
    Detection::new(curve.clone(), &step, &CATALOGUE, Options::default())
}

fn term(effect: &'static dyn Effect, parameters: [Real; 2]) -> Term {
    Term {
        fitted: true,
        ..Term::known(effect, parameters)
    }
}

/// χ² of the five terms, and its p-value, on the expected curve with an effect at its limit times a factor.
fn at_limit(limit: &Limit, factor: Real) -> (Real, Real) {
    let mut term = limit.term;
    let mut coefficient = limit.coefficient;
    if limit.is_of_shape() {
        term.parameters[0] *= factor;
    } else {
        coefficient *= factor;
    }
    let curve = curve(&limit.beside[..5], &[(term, coefficient * coefficient)]);
    let fit = fit::fit(&curve, &Model::ieee_952(), fit::Options::default()).expect("a fit");
    (fit.chi_squared, fit.p_value)
}

/// The χ² of the expected curve is the noncentrality: some 32 at the limit. Half of the coefficient would have a
/// sixteenth of it if the weights stayed the same, but the smaller effect scatters less.
#[test]
fn an_effect_at_its_limit_makes_the_expected_curve_inadequate() {
    let mut detection = detection(&curve(&MEMS, &[]));
    for (effect, parameters) in [
        (&Sinusoid as &'static dyn Effect, [0.3, 0.0]),
        (&Sinusoid, [7.7, 0.0]),
        (&GaussMarkov, [0.2, 0.0]),
        (&LowPass, [0.0; 2]),
        (&DecimationFilter, [0.0, 2.0]),
    ] {
        let found = detection
            .limit_of(term(effect, parameters))
            .expect("limits");
        let limit = found.expect("a limit");
        let (chi_squared, p) = at_limit(&limit, 1.0);
        let name = effect.name();
        assert!(
            (24.0..40.0).contains(&chi_squared),
            "{name}: χ² {chi_squared}"
        );
        assert!(p < 0.01, "{name}: p {p}");
        let (smaller, _) = at_limit(&limit, 0.5);
        assert!(
            smaller < 0.5 * chi_squared,
            "{name}: χ² {smaller} below the limit"
        );
    }
}

#[test]
fn the_limits_lie_on_the_grid_of_shapes_and_in_their_ranges() {
    let mut detection = detection(&curve(&MEMS, &[]));
    let (mut ranges, mut lines, mut pieces) = (Ranges::default(), 0, 0_u32);
    let mut last: Option<Limit> = None;
    loop {
        pieces += 1;
        let limit = match detection.advance().expect("limits") {
            Progress::Working => continue,
            Progress::Limit(limit) => limit,
            Progress::Finished => break,
        };
        ranges.push(&limit);
        assert!(limit.size() > 0.0 && limit.size().is_finite());
        if limit.term.effect.name() == "sinusoid" {
            lines += 1;
            let last = last.filter(|last| last.term.effect.name() == "sinusoid");
            if let Some(last) = last {
                let ratio = limit.term.parameters[0] / last.term.parameters[0];
                assert!(ratio > 1.1, "the frequencies ascend");
            }
        }
        last = Some(limit);
    }
    assert!((30..60).contains(&lines), "{lines}");
    assert!(pieces > 300, "the work comes in pieces, not in {pieces}");
    let names = |name: &str| {
        let ranges = ranges.as_slice().iter();
        ranges.filter(|range| range.effect.name() == name).count()
    };
    assert!((1..=3).contains(&names("sinusoid")));
    assert!(names("gauss_markov") >= 1 && names("resonance") >= 1);
    assert_eq!((names("low_pass"), names("decimation_filter")), (1, 1));
    // These are in the model.
    assert_eq!((names("quantization"), names("rate_ramp")), (0, 0));
}

/// The unit of the rate is no property of the gyro.
#[test]
fn a_coefficient_scales_with_the_unit_of_the_rate() {
    let shape = term(&Sinusoid, [1.0, 0.0]);
    let one = detection(&curve(&MEMS, &[])).limit_of(shape);
    let scaled = MEMS.map(|x| 1e-3 * x);
    let other = detection(&curve(&scaled, &[])).limit_of(shape);
    let (one, other) = (
        one.expect("limits").expect("one"),
        other.expect("limits").expect("one"),
    );
    let ratio = other.coefficient / one.coefficient;
    assert!((1e3 * ratio - 1.0).abs() < 0.01, "{ratio}");
}

#[test]
fn a_model_that_is_not_adequate_has_no_limits() {
    let hidden = (term(&Sinusoid, [7.7, 0.0]), 0.04 * 0.04);
    let curve = curve(&MEMS, &[hidden]);
    let fit = fit::fit(&curve, &Model::ieee_952(), fit::Options::default()).expect("a fit");
    assert_eq!(fit.is_adequate(), Some(false));
    let (mut step, _) = diagnosed(&curve);
    step.model = Model::ieee_952();
    step.fit = fit;
    let mut detection = Detection::new(curve, &step, &CATALOGUE, Options::default());
    assert!(matches!(detection.advance(), Ok(Progress::Finished)));
}

/// A model with a fitted shape has limits beside this shape, but none of the effect that it has.
#[test]
fn an_effect_in_the_model_has_no_limit() {
    let hidden = (term(&Sinusoid, [7.7, 0.0]), 0.04 * 0.04);
    let curve = curve(&MEMS, &[hidden]);
    let (step, verdict) = diagnosed(&curve);
    assert_eq!(verdict, Verdict::Improved);
    assert!(step.model.position("sinusoid").is_some());
    let mut names: Vec<&str, 200> = Vec::new();
    Detection::new(curve, &step, &CATALOGUE, Options::default())
        .run(|limit| names.push(limit.term.effect.name()).expect("room"))
        .expect("limits");
    assert!(names.contains(&"gauss_markov") && !names.contains(&"sinusoid"));
}
