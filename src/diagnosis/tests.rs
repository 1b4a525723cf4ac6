//! The judgement of a model, and whole diagnoses, on computed curves.

extern crate std;

use super::{assessment::Assessment, *};
use crate::{
    Curve, Model, Term,
    fit::{Start, Tolerance, Work},
    numerics::real::{Real, double, real},
    pause::unpaused,
    theory::effect::{CATALOGUE, Effect, LowPass, SampledShape, Sinusoid},
};
use core::ops::ControlFlow;
use std::vec::Vec;

const OCTAVES: usize = 16;
const INTERVAL_S: Real = 0.01;

/// A curve of white and flicker noise with one more effect. Every octave is off by a fraction of its
/// standard error.
fn curve(effect: &dyn Effect, parameters: [Real; 2], square: Real) -> Curve<OCTAVES> {
    let shape = SampledShape::known(INTERVAL_S, parameters);
    let octaves = (0..OCTAVES).map(|k| {
        let m = 1_u32 << k;
        let tau_s = real(m) * INTERVAL_S;
        let noise = 2.5e-5 / tau_s + 7.1e-6 + 3.0e-8 * tau_s;
        let extra = square * effect.variance(real(m), &shape);
        let differences = (1_u64 << 18) / u64::from((m / 4).max(1)) - 7;
        let off = [0.3, -0.5, 0.4, -0.2, -0.3][k % 5] / (0.2 * differences as Real + 9.0);
        (m, differences, (noise + extra) * (1.0 + off))
    });
    Curve::new(1.0 / INTERVAL_S, octaves).unwrap()
}

fn with_sinusoid() -> Curve<OCTAVES> {
    curve(&Sinusoid, [7.7, 0.0], 0.02 * 0.02)
}

fn without() -> Curve<OCTAVES> {
    curve(&Sinusoid, [7.7, 0.0], 0.0)
}

fn assess(
    curve: &Curve<OCTAVES>,
    work: &mut Work<OCTAVES>,
    step: &mut Step<OCTAVES>,
) -> Assessment {
    let tolerance = Tolerance::IfNeeded(0.01);
    let start = Start::Independent;
    unpaused(|pause| super::assessment::assess(curve.into(), start, tolerance, work, step, pause))
        .unwrap()
}

#[test]
fn judging_finds_whether_a_model_is_adequate() {
    let mut work = Work::NEW;
    let mut step = Step::of(&Model::ieee_952());
    let judged = assess(&without(), &mut work, &mut step);
    assert_eq!(judged.adequate, Some(true));
    assert_eq!(judged.tolerance, 0.0);
    assert_eq!(step.fit.chi_squared, step.comparison.chi_squared);

    let judged = assess(&with_sinusoid(), &mut work, &mut step);
    assert_eq!(judged.adequate, Some(false));
    // The scatter does not explain the misfit, so the model is granted the tolerance.
    assert_eq!(judged.tolerance, 0.01);
}

/// The diagnosis of a curve by the whole catalogue.
fn diagnosed(curve: &Curve<OCTAVES>) -> (Verdict, Vec<Step<OCTAVES>>) {
    let (model, options) = (Model::ieee_952(), Options::default());
    let mut steps = Vec::new();
    let mut go_on = || ControlFlow::Continue(());
    let verdict = Diagnosis::new(curve, &model, &CATALOGUE, options)
        .run(|step| steps.push(step.clone()), &mut go_on)
        .unwrap();
    (verdict.unwrap(), steps)
}

fn are_the_same(one: &Step<OCTAVES>, other: &Step<OCTAVES>) -> bool {
    (&one.fit, &one.comparison) == (&other.fit, &other.comparison)
        && one.candidates.len() == other.candidates.len()
        && one.ambiguous == other.ambiguous
}

#[test]
fn a_diagnosis_step_by_step_reports_the_same_as_a_diagnosis_in_one_go() {
    let curve = with_sinusoid();
    let (verdict, whole) = diagnosed(&curve);
    assert_eq!(verdict, Verdict::Improved);

    let (model, options) = (Model::ieee_952(), Options::default());
    let mut diagnosis = Diagnosis::new(&curve, &model, &CATALOGUE, options);
    let (mut at, mut pauses) = (0, 0);
    let mut pause = || {
        pauses += 1;
        ControlFlow::Continue(())
    };
    let verdict = loop {
        match diagnosis.advance(&mut pause).unwrap() {
            Progress::Paused => panic!("no pause ended the work"),
            Progress::Step(step) => {
                assert!(are_the_same(step, &whole[at]));
                at += 1;
            }
            Progress::Finished(verdict) => break verdict,
        }
    };
    assert_eq!((verdict, at), (Verdict::Improved, whole.len()));
    // A finished diagnosis stays finished.
    let again = diagnosis.advance(&mut pause);
    assert!(matches!(again, Ok(Progress::Finished(Verdict::Improved))));
    assert!(pauses > 100, "{pauses} pauses");
}

/// What is in progress begins anew, so that the pause ends the work ever later.
#[test]
fn a_diagnosis_that_pauses_ended_reports_the_same_as_one_in_one_go() {
    let curve = with_sinusoid();
    let (expected, whole) = diagnosed(&curve);
    let (model, options) = (Model::ieee_952(), Options::default());
    let mut diagnosis = Diagnosis::new(&curve, &model, &CATALOGUE, options);
    let (mut steps, mut ended) = (Vec::new(), 0);
    let verdict = loop {
        let mut left = 1_u32 << ended;
        let mut pause = || {
            left -= 1;
            if left > 0 {
                ControlFlow::Continue(())
            } else {
                ControlFlow::Break(())
            }
        };
        match diagnosis.run(|step| steps.push(step.clone()), &mut pause) {
            Ok(None) => ended += 1,
            Ok(Some(verdict)) => break verdict,
            Err(error) => panic!("{error}"),
        }
    };
    assert_eq!((verdict, steps.len()), (expected, whole.len()));
    assert!(
        steps
            .iter()
            .zip(&whole)
            .all(|(one, other)| are_the_same(one, other))
    );
    assert!(ended > 3, "ended {ended} times");
}

#[test]
fn the_first_candidate_is_the_effect_that_the_next_step_has() {
    let (_, steps) = diagnosed(&with_sinusoid());
    let mut compared = 0;
    for pair in steps.windows(2) {
        let Some(Addition::Effect(added)) = pair[0].added else {
            panic!("a step without an addition before the last one");
        };
        let first = &pair[0].candidates[0];
        assert_eq!(first.term.effect.name(), added.effect.name());
        let next = &pair[1].fit;
        if next.tolerance > 0.0 {
            assert_eq!(first.chi_squared, next.chi_squared);
        } else {
            // The last model does not need the tolerance with which the candidates were compared.
            assert!(first.chi_squared < next.chi_squared && next.is_adequate() == Some(true));
        }
        compared += 1;
    }
    assert!(compared >= 1);
}

#[test]
fn a_curve_of_two_octaves_is_too_short() {
    let full = without();
    let points = full.points().iter().take(2);
    let octaves = points.map(|point| (point.m, point.differences, point.variance));
    let short = Curve::<OCTAVES>::new(100.0, octaves).unwrap();
    let (verdict, steps) = diagnosed(&short);
    assert_eq!((verdict, steps.len()), (Verdict::TooShort, 1));
    assert!(steps[0].fit.p_value.is_nan());
}

#[test]
fn a_strong_line_is_found_alone_at_nearly_any_frequency() {
    // Octaves alone hardly tell some frequencies from others with the same alias.
    let (most, mut others) = (3, Vec::new());
    for i in 0..60 {
        let frequency = 0.14 * 1.63_f64.powf(f64::from(i) / 5.0);
        let curve = curve(&Sinusoid, [real(frequency), 0.0], 1.0);
        let (_, steps) = diagnosed(&curve);
        let terms = steps.last().unwrap().model.terms().iter();
        let added: Vec<_> = terms.filter(|term| term.fitted).collect();
        let is_right = |line: &Term| (double(line.parameters[0]) / frequency - 1.0).abs() < 1e-3;
        if !matches!(added.as_slice(), [line] if is_right(line)) {
            others.push(frequency);
        }
    }
    assert!(others.len() <= most, "{others:?}");
}

#[test]
fn a_known_filter_is_neither_missed_nor_named_twice() {
    let filter = [0.02, 2.0];
    // The curve has white noise beside the filtered noise, as it would come from behind the filter.
    let curve = curve(&LowPass, filter, 2.5e-5);
    let mut model = Model::ieee_952();
    let known = Term::known(&LowPass, filter);
    model.put(known).unwrap();
    let options = Options::default();
    let mut diagnosis = Diagnosis::new(&curve, &model, &CATALOGUE, options);
    let mut named = Vec::new();
    let report = |step: &Step<OCTAVES>| {
        let same = |term: &Term| term.effect.name() == "low_pass";
        let mut filters = step.model.terms().iter().filter(|term| same(term));
        assert_eq!(
            filters.next().map(|term| term.parameters),
            Some(known.parameters)
        );
        assert!(filters.next().is_none(), "{:?}", step.model);
        if let Some(Addition::Effect(term)) = step.added {
            named.push(term.effect.name());
        }
    };
    let verdict = diagnosis.run(report, &mut || ControlFlow::Continue(()));
    assert_eq!(verdict, Ok(Some(Verdict::Improved)));
    assert_eq!(named, ["angle_random_walk"]);
}
