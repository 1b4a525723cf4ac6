//! The effects of the catalogue in many shapes, and how their numbers are compared.

use allanite::effect::{EXPLAINED, Effect, Explain, MAX_PARAMETERS, SampledShape, Span};

/// The span of a record of 11 minutes.
pub(crate) const SPAN: Span = Span {
    interval_s: 0.01,
    longest_tau_s: 163.84,
};

/// The typical shapes of an effect, and the corners and the middle of its search range.
fn shapes(effect: &'static dyn Explain) -> Vec<SampledShape> {
    let described: &dyn Effect = effect;
    let at = |share: f64| {
        let mut parameters = [0.0; MAX_PARAMETERS];
        for (i, parameter) in described.parameters().iter().enumerate() {
            let range = (parameter.search_range)(&SPAN);
            let value = range.low * (range.high / range.low).powf(share);
            parameters[i] = if parameter.is_whole {
                value.round()
            } else {
                value
            };
        }
        parameters
    };
    let typical = effect.typical_shapes().iter().copied();
    let searched = [0.0, 0.2, 0.5, 0.8, 1.0].map(at);
    let searched = searched
        .into_iter()
        .filter(|_| !described.parameters().is_empty());
    let shape = |parameters| SampledShape {
        interval_s: SPAN.interval_s,
        parameters,
    };
    typical.chain(searched).map(shape).collect()
}

/// Calls `test` with every effect in each of its shapes, and with a name for messages.
pub(crate) fn for_every_shape(test: impl Fn(&'static dyn Effect, &SampledShape, &str)) {
    let mut tried = 0;
    for explained in EXPLAINED {
        let effect: &'static dyn Effect = explained;
        for shape in shapes(explained) {
            test(
                effect,
                &shape,
                &format!("{} {:?}", effect.name(), shape.parameters),
            );
            tried += 1;
        }
    }
    assert!(tried > 40, "{tried}");
}

/// The averaging factors up to `2^last`.
pub(crate) fn octaves(last: u32) -> impl Iterator<Item = f64> {
    (0..=last).map(|k| f64::from(1_u32 << k))
}

/// The rounding error where kernels up to lag `lag` cancel. It is 5e-13 of the largest kernel
/// value, plus the phase error of an oscillation after that many turns. The largest value is sought
/// at several lags, because a kernel may have a zero. It is at least that of white noise of the
/// same variance, because an oscillation near half the sample rate leaves little of its own terms. The poles of a
/// cascade lie close together, and their weights of some hundreds cancel.
pub(crate) fn rounding(effect: &dyn Effect, lag: f64, shape: &SampledShape) -> f64 {
    let lags = [0.0, 0.13, 0.29, 0.5, 0.8, 1.0].map(|share| (share * lag).round());
    let sizes = lags.map(|lag| effect.kernel(lag, shape).abs());
    let white = lag * effect.second_difference(0.0, 1.0, shape).abs();
    let weights = if effect.name() == "cascade" {
        16.0
    } else {
        1.0
    };
    2048.0 * f64::EPSILON * weights * (1.0 + 0.01 * lag) * (white + sizes.iter().sum::<f64>())
}

pub(crate) fn assert_relative(found: f64, expected: f64, tolerance: f64, what: &str) {
    assert!(
        (found - expected).abs() <= tolerance * expected.abs(),
        "{what}: {found:e}, expected {expected:e}"
    );
}
