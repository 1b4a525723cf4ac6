//! The covariance of every effect of the catalogue, in five shapes, alone and among the five terms.

use super::every_pair;
use allanite::{
    Model, Term,
    effect::{
        CATALOGUE, DecimationFilter, Distribution, Effect, GaussMarkov, MAX_PARAMETERS, Resonance,
        SampledShape, Sinusoid, Span,
    },
    fit::curve_covariance,
};
use rayon::prelude::*;

const OCTAVES: usize = 18;
const INTERVAL_S: f64 = 0.01;

/// The error that the covariance of two octaves may have, relative to the root of their variances.
const ALLOWED: f64 = 0.02;

/// The scatter of a variance, relative to its square, that is as good as none.
const NO_SCATTER: f64 = 1e-7;

/// The squared coefficients of the terms that every effect is added to: white noise, flicker noise and a random
/// walk.
const BASE: [f64; 5] = [0.0, 2.5e-5, 1.6e-5, 9e-8, 0.0];

/// The places of five shapes in the ranges of the parameters, on a logarithmic scale from 0 to 1.
const PLACES: [[f64; MAX_PARAMETERS]; 5] = [
    [0.0, 0.5, 0.0],
    [0.25, 1.0, 0.25],
    [0.5, 0.0, 0.5],
    [0.75, 0.75, 0.75],
    [1.0, 0.25, 1.0],
];

/// Five shapes that a search may try on a record.
pub(crate) fn shapes(effect: &dyn Effect, longest_tau_s: f64) -> Vec<[f64; MAX_PARAMETERS]> {
    let span = Span {
        interval_s: INTERVAL_S,
        longest_tau_s,
    };
    let shape = |places: [f64; MAX_PARAMETERS]| {
        let mut parameters = [0.0; MAX_PARAMETERS];
        for (i, place) in places.into_iter().enumerate() {
            if let Some(range) = effect.search_range(i, &span) {
                let value = range.low * (range.high.max(range.low) / range.low).powf(place);
                parameters[i] = if effect.is_whole(i) {
                    value.round()
                } else {
                    value
                };
            }
        }
        parameters
    };
    let all = PLACES.map(shape);
    let count = if effect.parameters().is_empty() { 1 } else { 5 };
    all[..count].to_vec()
}

/// Whether nothing is left in single precision of the scatter of the shortest octaves: a slow cascade has next to no
/// variance there, and its poles of large weights cancel. Among other effects, nothing of that is seen.
pub(crate) fn is_cancelled(effect: &dyn Effect, [time_s, ..]: [f64; MAX_PARAMETERS]) -> bool {
    effect.name() == "cascade" && time_s > 7.0 * INTERVAL_S
}

/// A model, its squared coefficients, and a name for messages.
pub(crate) type Case = (String, Model, Vec<f64>);

/// An effect alone.
pub(crate) fn alone(effect: &'static dyn Effect, parameters: [f64; MAX_PARAMETERS]) -> Case {
    let mut model = Model::new(&[]).expect("empty");
    let term = Term {
        parameters,
        ..Term::new(effect)
    };
    model.add(term).expect("there is room");
    (
        format!("{} {parameters:?}", effect.name()),
        model,
        vec![1.0],
    )
}

/// An effect among the five terms. It makes up as much of the variance as these in the octave where it makes up most.
fn among(effect: &'static dyn Effect, parameters: [f64; MAX_PARAMETERS], octaves: usize) -> Case {
    let mut model = Model::ieee_952();
    let shape = SampledShape {
        interval_s: INTERVAL_S,
        parameters,
    };
    let share = |k: usize| {
        let m = 1 << k;
        effect.variance(f64::from(m), &shape) / model.variance(&BASE, m, INTERVAL_S)
    };
    let most = (0..octaves).map(share).fold(0.0, f64::max);
    let term = Term {
        parameters,
        ..Term::new(effect)
    };
    model.add(term).expect("there is room");
    let squares = BASE.into_iter().chain([1.0 / most]).collect();
    (
        format!("{} {parameters:?} among others", effect.name()),
        model,
        squares,
    )
}

/// The entries that differ from the sum over all pairs by more than is allowed.
fn errors(samples: usize, (name, model, squares): &Case) -> Vec<String> {
    let octaves = every_pair::octaves(samples);
    let expected = every_pair::covariance(&octaves, model, squares, INTERVAL_S, samples);
    let curve = every_pair::curve::<OCTAVES>(&octaves, INTERVAL_S, |_| 1.0);
    let found = curve_covariance(&curve, model, squares);
    let mut errors = Vec::new();
    for j in 0..octaves.len() {
        for k in 0..=j {
            // A record of many periods of a sinusoid hardly scatters.
            let variance = |k: usize| model.variance(squares, 1 << k, INTERVAL_S);
            let unit = (expected[j][j] * expected[k][k]).sqrt();
            let unit = unit.max(NO_SCATTER * variance(j) * variance(k));
            let error = (found[(j, k)] - expected[j][k]) / unit;
            if error.is_nan() || error.abs() > ALLOWED {
                errors.push(format!(
                    "{name}, {samples} samples, octaves {k} and {j}: off by {error:.3}"
                ));
            }
        }
    }
    errors
}

fn assert_right(samples: usize, cases: &[Case]) {
    let errors: Vec<_> = cases
        .par_iter()
        .flat_map(|case| errors(samples, case))
        .collect();
    assert!(errors.is_empty(), "{}\n{}", errors.len(), errors.join("\n"));
}

fn assert_every_effect(samples: usize) {
    let octaves = every_pair::octaves(samples);
    let longest_tau_s = octaves[octaves.len() - 1].m as f64 * INTERVAL_S;
    let mut cases = Vec::new();
    // To the covariance, a drifting oscillation is a resonance that forgets its phase as fast.
    let is_exact = |effect: &&dyn Effect| effect.description().distribution != Distribution::Swept;
    for effect in CATALOGUE.into_iter().filter(is_exact) {
        for (i, parameters) in shapes(effect, longest_tau_s).into_iter().enumerate() {
            if !is_cancelled(effect, parameters) {
                cases.push(alone(effect, parameters));
            }
            // The sum over all pairs of a long record takes a second.
            if samples < 1 << 16 || i % 2 == 0 {
                cases.push(among(effect, parameters, octaves.len()));
            }
        }
    }
    assert!(cases.len() > 60, "{}", cases.len());
    assert_right(samples, &cases);
}

/// A model of two effects, and of the five terms with them.
fn of_two(effects: [(&'static dyn Effect, [f64; MAX_PARAMETERS], f64); 2]) -> [Case; 2] {
    let mut model = Model::new(&[]).expect("empty");
    let mut among = Model::ieee_952();
    let mut squares = Vec::new();
    for (effect, parameters, coefficient) in effects {
        let term = Term {
            parameters,
            ..Term::new(effect)
        };
        model.add(term).expect("there is room");
        among.add(term).expect("there is room");
        squares.push(coefficient * coefficient);
    }
    let name = format!("{:?}", model.terms());
    let more = BASE.into_iter().chain(squares.clone()).collect();
    let among = (format!("{name} among others"), among, more);
    [(name, model, squares), among]
}

#[test]
fn products_of_two_effects_are_right() {
    let pairs: [[(&'static dyn Effect, _, _); 2]; 8] = [
        [
            (&Resonance, [3.0, 3.0, 0.0], 0.1),
            (&Resonance, [4.0, 20.0, 0.0], 0.05),
        ],
        [
            (&Resonance, [3.0, 3.0, 0.0], 0.1),
            (&Resonance, [3.0, 3.0, 0.0], 0.1),
        ],
        [
            (&Resonance, [0.02, 1.0, 0.0], 0.1),
            (&Resonance, [40.0, 32.0, 0.0], 0.1),
        ],
        [
            (&Resonance, [10.0, 32.0, 0.0], 0.1),
            (&Sinusoid, [10.1, 0.0, 0.0], 0.1),
        ],
        [
            (&Resonance, [1.0, 5.0, 0.0], 0.1),
            (&Sinusoid, [30.0, 0.0, 0.0], 0.1),
        ],
        [
            (&Resonance, [0.1, 5.0, 0.0], 0.1),
            (&GaussMarkov, [1.0, 0.0, 0.0], 0.1),
        ],
        [
            (&Resonance, [10.0, 32.0, 0.0], 0.1),
            (&DecimationFilter, [0.2, 2.0, 0.0], 0.01),
        ],
        [
            (&Sinusoid, [5.0, 0.0, 0.0], 0.1),
            (&DecimationFilter, [0.2, 1.0, 0.0], 0.01),
        ],
    ];
    let cases: Vec<_> = pairs.into_iter().flat_map(of_two).collect();
    for samples in [100, 777, 1 << 12, 1 << 16] {
        assert_right(samples, &cases);
    }
}

#[test]
fn every_effect_is_right_in_short_records() {
    assert_every_effect(1 << 12);
    assert_every_effect(3000);
}

mod thorough {
    use super::*;

    #[test]
    fn every_effect_is_right_in_long_records() {
        assert_every_effect(1 << 18);
    }
}
