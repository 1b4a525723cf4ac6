//! Searches and intervals are compared with a brute-force scan of the profile.

use super::{likelihood::Found, search::GridSearch, *};
use crate::{
    Curve, Model,
    fit::{Columns, Problem, Solver, Start, Tolerance},
    numerics::{
        math,
        real::{Real, real},
    },
    theory::{
        effect::{DecimationFilter, Effect, SampledShape, Sinusoid},
        model::Term,
    },
};

const OCTAVES: usize = 14;
const INTERVAL_S: Real = 0.01;

/// A curve of white noise, an effect and flicker noise, with a known scatter.
fn curve(effect: &dyn Effect, parameters: [Real; 2], square: Real, white: Real) -> Curve<OCTAVES> {
    let shape = SampledShape::known(INTERVAL_S, parameters);
    let octaves = (0..OCTAVES).map(|k| {
        let m = 1_u32 << k;
        let tau_s = real(m) * INTERVAL_S;
        let noise = white / tau_s + 7.1e-6;
        let differences = (1_u64 << 16) / u64::from((m / 4).max(1)) - 7;
        let off = [0.4, -0.3, -0.2, 0.5][k % 4] / math::sqrt(differences as Real);
        let variance = noise + square * effect.variance(real(m), &shape);
        (m, differences, variance * (1.0 + off))
    });
    Curve::new(1.0 / INTERVAL_S, octaves).unwrap()
}

/// The five terms of IEEE Std 952, solved on a curve.
fn solved(curve: &Curve<OCTAVES>) -> (Model, Columns<OCTAVES>, Solver<OCTAVES>) {
    solve(curve, Model::ieee_952())
}

/// A model, solved on a curve.
fn solve(curve: &Curve<OCTAVES>, model: Model) -> (Model, Columns<OCTAVES>, Solver<OCTAVES>) {
    let columns = Columns::new(curve.into(), &model);
    let mut solver = Solver::NEW;
    let problem = Problem::new(curve.into(), &model, &columns);
    let tolerance = Tolerance::Fixed(0.01);
    solver
        .begin(&problem, Start::Independent, tolerance)
        .unwrap();
    while !solver.advance(&problem).unwrap() {}
    (model, columns, solver)
}

#[test]
fn a_search_finds_a_minimum_as_low_as_that_of_a_fine_grid() {
    let curve = curve(&Sinusoid, [3.1, 0.0], 0.03 * 0.03, 2.5e-5);
    let (model, columns, solver) = solved(&curve);
    let problem = Problem::new((&curve).into(), &model, &columns);
    let mut profile = Profile::EMPTY;
    profile.begin(&problem, &solver.weights);
    profile
        .choose(&problem, problem.count(), &solver.squares)
        .unwrap();
    let mut evaluation = Evaluation::new(&mut profile, &problem, &solver.weights);
    let mut search = GridSearch::new(&Sinusoid, &curve.span());
    let found = loop {
        if let Some(found) = search.advance(&mut evaluation) {
            break found;
        }
    };
    let mut least = Found::none(found.term);
    for step in 0..4000 {
        let mut term = Term::fitted(&Sinusoid);
        // The scan goes from 0.05 to 50 Hz.
        term.set_parameter(0, 0.05 * math::exp(real(step) * math::log(1000.0) / 4000.0));
        least.improve(evaluation.found(term));
    }
    assert!(least.chi_squared.is_finite());
    let behind = found.chi_squared - least.chi_squared;
    assert!(behind < 0.05 * least.chi_squared.abs() + 0.5, "{behind}");
    assert!((found.term.parameters[0] / least.term.parameters[0] - 1.0).abs() < 0.02);
}

#[test]
fn an_interval_ends_where_chi_squared_has_risen_by_that_of_95_percent() {
    let curve = curve(&Sinusoid, [3.1, 0.0], 0.01 * 0.01, 2.5e-5);
    let (model, columns, solver) = solved(&curve);
    let problem = Problem::new((&curve).into(), &model, &columns);
    let mut profile = Profile::EMPTY;
    profile.begin(&problem, &solver.weights);
    profile
        .choose(&problem, problem.count(), &solver.squares)
        .unwrap();
    profile.release();
    let span = curve.span();
    let mut evaluation = Evaluation::new(&mut profile, &problem, &solver.weights);
    let mut search = GridSearch::new(&Sinusoid, &span);
    let best = loop {
        if let Some(found) = search.advance(&mut evaluation) {
            break found;
        }
    };
    let mut interval = JointInterval::new(&mut evaluation, best.term, 0, &span, 1.0);
    let (lower, upper) = loop {
        if let Some(interval) = interval.advance(&mut evaluation, &span) {
            break interval;
        }
    };
    assert!(lower < best.term.parameters[0] && best.term.parameters[0] < upper);
    let mut rise = |frequency_hz: Real| {
        let mut term = best.term;
        term.set_parameter(0, frequency_hz);
        evaluation.found(term).chi_squared - best.chi_squared
    };
    for (end, outwards) in [(lower, 0.99), (upper, 1.01)] {
        assert!(rise(end) <= 3.85, "inside at {end}");
        assert!(rise(end * outwards) > 3.0, "outside of {end}");
    }
}

#[test]
fn an_interval_includes_those_of_other_whole_numbers_that_explain_the_curve_as_well() {
    // At 1.5 samples, one stage and two stages differ by less than the scatter.
    let filter = [0.015, 2.0];
    let curve = curve(&DecimationFilter, filter, 2.5e-5, 0.0);
    let replaced = Term {
        fitted: true,
        ..Term::known(&DecimationFilter, filter)
    };
    let mut model = Model::ieee_952();
    model.remove("angle_random_walk");
    model.add(replaced).unwrap();
    let columns = Columns::new((&curve).into(), &model);
    let problem = Problem::new((&curve).into(), &model, &columns);
    let mut solver = Solver::NEW;
    let tolerance = Tolerance::Fixed(0.01);
    solver
        .begin(&problem, Start::Independent, tolerance)
        .unwrap();
    while !solver.advance(&problem).unwrap() {}
    let place = problem.count() - 1;
    let mut profile = Profile::EMPTY;
    profile.begin(&problem, &solver.weights);
    profile.choose(&problem, place, &solver.squares).unwrap();
    profile.release();
    let span = curve.span();
    let mut evaluation = Evaluation::new(&mut profile, &problem, &solver.weights);
    let bounded = |evaluation: &mut Evaluation<'_, OCTAVES>, term: Term| {
        let mut interval = JointInterval::new(evaluation, term, 0, &span, 1.0);
        loop {
            if let Some(interval) = interval.advance(evaluation, &span) {
                return interval;
            }
        }
    };
    let shape = |stages: u8, step: u32| Term {
        parameters: [0.01 * math::exp(real(step) * 0.01), real(stages), 0.0],
        ..replaced
    };
    let mut best = evaluation.found(replaced);
    for (stages, step) in (1..=2).flat_map(|stages| (0..200).map(move |step| (stages, step))) {
        best.improve(evaluation.found(shape(stages, step)));
    }
    let (lower, upper) = bounded(&mut evaluation, best.term);
    assert!(lower < 0.015 && 0.015 < upper);
    // Every value that the brute-force scan over both parameters finds as good must lie inside. More
    // than one number of stages must have such values.
    let mut inside = [0; 5];
    for (stages, step) in (1..=2).flat_map(|stages| (0..200).map(move |step| (stages, step))) {
        let term = shape(stages, step);
        if evaluation.found(term).chi_squared < best.chi_squared + 3.8 {
            let (margin, width_s) = (1.03, term.parameters[0]);
            assert!(
                lower / margin < width_s && width_s < upper * margin,
                "{stages} {width_s} not in {lower} … {upper}"
            );
            inside[usize::from(stages)] += 1;
        }
    }
    assert!(
        inside.iter().filter(|count| **count > 0).count() > 1,
        "{inside:?}"
    );
}
