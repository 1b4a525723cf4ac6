use super::*;
use crate::{
    Curve, Model, Real, Term,
    diagnosis::{Diagnosis, Options, Step, Verdict},
    fit,
    numerics::real::real,
    theory::effect::{CATALOGUE, DecimationFilter, Effect, GaussMarkov, LowPass, Sinusoid},
};
use core::ops::ControlFlow;
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

fn go_on() -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// The last step of a diagnosis.
fn diagnosed(curve: &Curve<20>) -> (Step<20>, Verdict) {
    let (model, options) = (Model::ieee_952(), Options::default());
    let mut last = None;
    let verdict = Diagnosis::new(curve, &model, &CATALOGUE, options)
        .run(|step| last = Some(step.clone()), &mut go_on)
        .expect("a diagnosis");
    (last.expect("a step"), verdict.expect("no end by a pause"))
}

/// The last step of a diagnosis that finds nothing.
fn adequate(curve: &Curve<20>) -> Step<20> {
    let (step, verdict) = diagnosed(curve);
    assert_eq!(verdict, Verdict::Adequate);
    step
}

fn detection<'a>(curve: &'a Curve<20>, step: &'a Step<20>) -> Detection<'a, 20> {
    Detection::new(curve, step, &CATALOGUE, Options::default())
}

fn term(effect: &'static dyn Effect, parameters: [Real; 2]) -> Term {
    Term {
        fitted: true,
        ..Term::known(effect, parameters)
    }
}

/// What a diagnosis says of the expected curve with an effect at its limit times a factor.
fn at_limit(limit: &Limit, factor: Real) -> Verdict {
    let mut term = limit.term;
    let mut coefficient = limit.coefficient;
    let mut beside = limit.beside;
    if limit.is_of_shape() {
        term.parameters[0] *= factor;
        // The filter takes the place of the angle random walk.
        beside[1] = 0.0;
    } else {
        coefficient *= factor;
    }
    let curve = curve(&beside[..5], &[(term, coefficient * coefficient)]);
    diagnosed(&curve).1
}

/// Chance makes an effect at its limit show in 95 % of the records. The expected curve has no chance in it.
#[test]
fn an_effect_at_its_limit_is_found_in_the_expected_curve_and_a_fifth_of_it_is_not() {
    let curve = curve(&MEMS, &[]);
    let step = adequate(&curve);
    let detection = detection(&curve, &step);
    for (effect, parameters) in [
        (&Sinusoid as &'static dyn Effect, [0.3, 0.0]),
        (&Sinusoid, [7.7, 0.0]),
        (&GaussMarkov, [0.2, 0.0]),
        (&LowPass, [0.0, 1.0]),
        (&DecimationFilter, [0.0, 2.0]),
    ] {
        let name = effect.name();
        let limit = detection.limit_of(term(effect, parameters));
        let Some(limit) = limit else {
            panic!("{name} has no limit");
        };
        assert_eq!(
            at_limit(&limit, 1.0),
            Verdict::Improved,
            "{name}: {limit:?}"
        );
        assert_eq!(
            at_limit(&limit, 0.2),
            Verdict::Adequate,
            "{name}: {limit:?}"
        );
    }
}

#[test]
fn the_limits_lie_on_the_grid_of_shapes_and_in_their_ranges() {
    let curve = curve(&MEMS, &[]);
    let step = adequate(&curve);
    let (mut ranges, mut lines, mut pauses) = (Ranges::default(), 0, 0_u32);
    let mut last: Option<Limit> = None;
    let each = |limit: Limit| {
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
    };
    let mut pause = || {
        pauses += 1;
        ControlFlow::Continue(())
    };
    assert_eq!(detection(&curve, &step).run(each, &mut pause), Some(()));
    assert!((30..64).contains(&lines), "{lines}");
    assert!(pauses > 300, "the work comes in pieces, not in {pauses}");
    let names = |name: &str| {
        let ranges = ranges.as_slice().iter();
        ranges.filter(|range| range.effect.name() == name).count()
    };
    assert!((1..=4).contains(&names("sinusoid")));
    assert!(names("gauss_markov") >= 1 && names("resonance") >= 1);
    assert_eq!((names("low_pass"), names("decimation_filter")), (1, 1));
    // These are in the model.
    assert_eq!((names("quantization"), names("rate_ramp")), (0, 0));
}

/// The unit of the rate is no property of the gyro.
#[test]
fn a_coefficient_scales_with_the_unit_of_the_rate() {
    let shape = term(&Sinusoid, [1.0, 0.0]);
    let [one, other] = [1.0, 1e-3].map(|unit| {
        let curve = curve(&MEMS.map(|x| unit * x), &[]);
        let step = adequate(&curve);
        detection(&curve, &step).limit_of(shape).expect("a limit")
    });
    let ratio = other.coefficient / one.coefficient;
    assert!((1e3 * ratio - 1.0).abs() < 0.01, "{ratio}");
}

#[test]
fn a_pause_ends_the_work() {
    let curve = curve(&MEMS, &[]);
    let step = adequate(&curve);
    let mut limits = 0;
    let mut pause = || ControlFlow::Break(());
    assert_eq!(
        detection(&curve, &step).run(|_| limits += 1, &mut pause),
        None
    );
    assert_eq!(limits, 0);
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
    let each = |limit: Limit| panic!("{limit:?}");
    assert_eq!(detection(&curve, &step).run(each, &mut go_on), Some(()));
    assert!(
        detection(&curve, &step)
            .limit_of(term(&Sinusoid, [1.0, 0.0]))
            .is_none()
    );
}

/// A model with a fitted shape has limits given this shape, but none of the effect that it has.
#[test]
fn an_effect_in_the_model_has_no_limit() {
    let hidden = (term(&Sinusoid, [7.7, 0.0]), 0.04 * 0.04);
    let curve = curve(&MEMS, &[hidden]);
    let (step, verdict) = diagnosed(&curve);
    assert_eq!(verdict, Verdict::Improved);
    assert!(step.model.position("sinusoid").is_some());
    let mut names: Vec<&str, 200> = Vec::new();
    let each = |limit: Limit| names.push(limit.term.effect.name()).expect("room");
    assert_eq!(detection(&curve, &step).run(each, &mut go_on), Some(()));
    assert!(names.contains(&"gauss_markov") && !names.contains(&"sinusoid"));
}
