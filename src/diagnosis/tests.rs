//! The stages of a diagnosis, alone and together, on computed curves.

extern crate std;

use super::{
    dropped::Dropping,
    judged::{Judged, Judging},
    run::{Diagnosis, Progress},
    scanned::Scanning,
    step::{Addition, Step},
    trial::Fitted,
    tried::{Base, Contest, Trying},
    *,
};
use crate::{
    Curve, Model, Term,
    effect::{CATALOGUE, Effect, GaussMarkov, LowPass, SampledShape, Sinusoid},
    fit::{Problem, Start, Tolerance, Work},
    real::{Real, double, real},
};

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

fn judge(curve: &Curve<OCTAVES>, work: &mut Work<OCTAVES>, step: &mut Step<OCTAVES>) -> Judged {
    let tolerance = Tolerance::IfNeeded(0.01);
    work.begin_at(curve.into(), &step.model, Start::Independent, tolerance)
        .unwrap();
    let mut judging = Judging::new();
    loop {
        let judged = judging.advance(curve.into(), &curve.span(), work, step);
        if let Some(judged) = judged.unwrap() {
            return judged;
        }
    }
}

#[test]
fn judging_finds_whether_a_model_is_adequate() {
    let mut work = Work::NEW;
    let mut step = Step::of(&Model::ieee_952());
    let judged = judge(&without(), &mut work, &mut step);
    assert_eq!(judged.adequate, Some(true));
    assert_eq!(judged.tolerance, 0.0);
    assert_eq!(step.fit.chi_squared, step.comparison.chi_squared);

    let judged = judge(&with_sinusoid(), &mut work, &mut step);
    assert_eq!(judged.adequate, Some(false));
    // The scatter does not explain the misfit, so the model is granted the tolerance.
    assert_eq!(judged.tolerance, 0.01);
    assert_eq!(judged.score, step.fit.minus_two_log_likelihood);
}

#[test]
fn solving_again_from_the_assumed_squares_gives_the_same_solution() {
    let curve = with_sinusoid();
    let mut work = Work::NEW;
    let mut step = Step::of(&Model::ieee_952());
    let judged = judge(&curve, &mut work, &mut step);
    let tolerance = Tolerance::Fixed(judged.tolerance);
    work.begin_at(
        (&curve).into(),
        &step.model,
        Start::Once(judged.assumed),
        tolerance,
    )
    .unwrap();
    let problem = Problem::new((&curve).into(), &step.model, &work.columns);
    while !work.solver.advance(&problem).unwrap() {}
    assert_eq!(work.solver.chi_squared, step.fit.chi_squared);
    assert_eq!(work.solver.squares.as_slice(), judged.squares.as_slice());
}

#[test]
fn a_scan_finds_the_hidden_shape_and_a_trial_fits_its_size() {
    let curve = with_sinusoid();
    let span = curve.span();
    let mut work = Work::NEW;
    let mut step = Step::of(&Model::ieee_952());
    let judged = judge(&curve, &mut work, &mut step);
    let problem = Problem::new((&curve).into(), &step.model, &work.columns);
    let mut scanning = Scanning::new();
    scanning.begin(&problem, &mut work.solver);
    let effects: [&'static dyn Effect; 2] = [&Sinusoid, &GaussMarkov];
    while !scanning.advance(&problem, &work.solver, &effects, &span) {}
    let shapes = scanning.shapes().clone();
    assert_eq!(shapes.len(), 2);
    assert_eq!(shapes[0].term.effect.name(), "sinusoid");
    assert!((shapes[0].term.parameters[0] / 7.7 - 1.0).abs() < 0.05);
    assert!(shapes[0].chi_squared <= shapes[1].chi_squared);

    let mut trying = Trying::new(shapes);
    let base = Base {
        model: &step.model,
        swap: None,
    };
    let contest = Contest {
        score: judged.score,
        tolerance: judged.tolerance,
        span,
    };
    let mut best = Fitted::empty();
    while !trying.advance(
        (&curve).into(),
        &contest,
        base,
        &mut work,
        &mut step.candidates,
        &mut best,
    ) {}
    let first = &step.candidates[0];
    assert_eq!(first.term.effect.name(), "sinusoid");
    assert!((first.term.parameters[0] / 7.7 - 1.0).abs() < 0.01);
    assert!((first.coefficient / 0.02 - 1.0).abs() < 0.03, "{first:?}");
    assert!(
        step.candidates
            .iter()
            .all(|candidate| candidate.improvement > 0.0)
    );
    assert!(
        step.candidates
            .is_sorted_by(|a, b| a.improvement >= b.improvement)
    );
    assert_eq!(best.model.terms().last().unwrap().effect.name(), "sinusoid");
}

#[test]
fn a_diagnosis_in_pieces_reports_the_same_as_a_diagnosis_in_one_go() {
    let (model, options) = (Model::ieee_952(), Options::default());
    let new = || Diagnosis::new(with_sinusoid(), Evidence::NONE, &model, &CATALOGUE, options);
    let mut whole = heapless::Vec::<Step<OCTAVES>, 4>::new();
    let verdict = new().run(|step| whole.push(step.clone()).unwrap());
    assert_eq!(verdict, Ok(Verdict::Improved));

    let mut diagnosis = new();
    let mut at = 0;
    let mut pieces = 0;
    let verdict = loop {
        match diagnosis.advance().unwrap() {
            Progress::Working => pieces += 1,
            Progress::Step(step) => {
                let same = &whole[at];
                assert_eq!((&step.fit, &step.comparison), (&same.fit, &same.comparison));
                at += 1;
            }
            Progress::Finished(verdict) => break verdict,
        }
    };
    assert_eq!((verdict, at), (Verdict::Improved, whole.len()));
    assert!(pieces > 100, "{pieces} pieces");
    // A finished diagnosis stays finished.
    assert!(matches!(diagnosis.advance(), Ok(Progress::Finished(_))));
}

#[test]
fn the_first_candidate_is_the_effect_that_the_next_step_has() {
    let (model, options) = (Model::ieee_952(), Options::default());
    let mut steps = heapless::Vec::<Step<OCTAVES>, 4>::new();
    Diagnosis::new(with_sinusoid(), Evidence::NONE, &model, &CATALOGUE, options)
        .run(|step| steps.push(step.clone()).unwrap())
        .unwrap();
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
    let (model, options) = (Model::ieee_952(), Options::default());
    let mut steps = 0;
    let mut diagnosis = Diagnosis::new(short, Evidence::NONE, &model, &CATALOGUE, options);
    let verdict = diagnosis.run(|step| {
        assert!(step.fit.p_value.is_nan());
        steps += 1;
    });
    assert_eq!((verdict, steps), (Ok(Verdict::TooShort), 1));
}

/// The diagnosis of a curve by the whole catalogue.
fn steps(curve: Curve<OCTAVES>) -> (Verdict, std::vec::Vec<Step<OCTAVES>>) {
    let mut steps = std::vec::Vec::new();
    let (evidence, options) = (Evidence::NONE, Options::default());
    let model = Model::ieee_952();
    let mut diagnosis = Diagnosis::new(curve, evidence, &model, &CATALOGUE, options);
    let verdict = diagnosis.run(|step| steps.push(step.clone())).unwrap();
    (verdict, steps)
}

#[test]
fn a_strong_line_is_found_alone_at_any_frequency() {
    for i in 0..12 {
        // Octaves alone show 118 of 120 frequencies in this range, and not the nearest to 0.7765 and 12.578 Hz.
        let frequency = 0.14 * 1.63_f64.powi(i);
        let curve = curve(&Sinusoid, [real(frequency), 0.0], 1.0);
        let (verdict, steps) = steps(curve);
        let last = steps.last().unwrap();
        let added: std::vec::Vec<_> = last
            .model
            .terms()
            .iter()
            .filter(|term| term.fitted)
            .collect();
        let [line] = added.as_slice() else {
            panic!("{frequency} Hz: {verdict:?} {added:?}");
        };
        let off = double(line.parameters[0]) / frequency - 1.0;
        assert!(off.abs() < 1e-3, "{frequency} Hz: {off:e}");
    }
}

#[test]
fn an_addition_that_the_model_does_not_need_is_dropped() {
    let curve = with_sinusoid();
    let mut model = Model::ieee_952();
    for (effect, first) in [(&GaussMarkov as &dyn Effect, 1.0), (&Sinusoid, 7.7)] {
        let parameters = [first, 0.0, 0.0];
        let term = Term::fitted(effect);
        model.add(Term { parameters, ..term }).unwrap();
    }
    let mut work = Work::NEW;
    let mut step = Step::of(&model);
    let judged = judge(&curve, &mut work, &mut step);
    assert_eq!(judged.adequate, Some(true));
    let contest = Contest {
        score: judged.score,
        tolerance: judged.tolerance,
        span: curve.span(),
    };
    // An effect that was given, or that was added last, stays.
    assert!(Dropping::new(&model, 1).is_none());
    let mut dropping = Dropping::new(&model, 0).unwrap();
    while !dropping.advance(
        (&curve).into(),
        &contest,
        &model,
        &judged.squares,
        &mut work,
    ) {}
    let (term, fitted) = dropping.dropped(8.0).unwrap();
    assert_eq!(term.effect.name(), "gauss_markov");
    let last = fitted.model.terms().last();
    assert_eq!(last.map(|term| term.effect.name()), Some("sinusoid"));
    assert_eq!(fitted.model.terms().len(), 6);
    // One that lowers the score by more than is asked for stays as well.
    assert!(dropping.dropped(-100.0).is_none());
}

#[test]
fn a_known_filter_is_neither_missed_nor_dropped_nor_named_twice() {
    let filter = [0.02, 2.0];
    // The curve has white noise beside the filtered noise, as it would come from behind the filter.
    let curve = curve(&LowPass, filter, 2.5e-5);
    let mut model = Model::ieee_952();
    let known = Term::known(&LowPass, filter);
    model.put(known).unwrap();
    let options = Options::default();
    let mut diagnosis = Diagnosis::new(curve, Evidence::NONE, &model, &CATALOGUE, options);
    let mut named = std::vec::Vec::new();
    let verdict = diagnosis.run(|step| {
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
    });
    assert_eq!(verdict, Ok(Verdict::Improved));
    assert_eq!(named, ["angle_random_walk"]);
}
