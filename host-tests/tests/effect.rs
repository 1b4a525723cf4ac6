//! Tests every effect of the catalogue: its closed forms against its kernel, and its kernel against
//! sums over single samples. A new effect is tested as soon as it is in the catalogue.

use allanite::{
    Curve, Model, Term,
    effect::{
        AngleRandomWalk, BiasInstability, Description, Distribution, EXPLAINED, Effect, Explain,
        FIRST_OWN_CODE, GaussMarkov, IEEE_952, MAX_PARAMETERS, Quantization, RateRamp,
        RateRandomWalk, Resonance, Response, SampledShape, Span,
    },
    fit::curve_covariance,
};
use nalgebra::SMatrix;
use std::f64::consts::{LN_2, PI};

/// The sample intervals, in seconds: of a fast gyro, of the one that the design assumes, of one
/// second, and of a slow gyro.
const INTERVALS_S: [f64; 4] = [1e-4, 0.01, 1.0, 37.5];

/// An effect of which only the kernel is known, so that the trait's defaults compute the rest.
struct KernelOnly(&'static dyn Effect);

impl Effect for KernelOnly {
    fn description(&self) -> &'static Description {
        self.0.description()
    }

    fn kernel(&self, lag: f64, shape: &SampledShape) -> f64 {
        self.0.kernel(lag, shape)
    }

    fn response(&self, m: f64, shape: &SampledShape) -> Option<Response> {
        self.0.response(m, shape)
    }
}

/// The span of a record of 11 minutes.
const SPAN: Span = Span {
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
fn for_every_shape(test: impl Fn(&'static dyn Effect, &SampledShape, &str)) {
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
fn octaves(last: u32) -> impl Iterator<Item = f64> {
    (0..=last).map(|k| f64::from(1_u32 << k))
}

/// The rounding error where kernels up to lag `lag` cancel. It is 5e-13 of the largest kernel
/// value, plus the phase error of an oscillation after that many turns. The largest value is sought
/// at several lags, because a kernel may have a zero. It is at least that of white noise of the
/// same variance, because an oscillation near half the sample rate leaves little of its own terms.
fn rounding(effect: &dyn Effect, lag: f64, shape: &SampledShape) -> f64 {
    let lags = [0.0, 0.13, 0.29, 0.5, 0.8, 1.0].map(|share| (share * lag).round());
    let sizes = lags.map(|lag| effect.kernel(lag, shape).abs());
    let white = lag * effect.second_difference(0.0, 1.0, shape).abs();
    2048.0 * f64::EPSILON * (1.0 + 0.01 * lag) * (white + sizes.iter().sum::<f64>())
}

fn assert_relative(found: f64, expected: f64, tolerance: f64, what: &str) {
    assert!(
        (found - expected).abs() <= tolerance * expected.abs(),
        "{what}: {found:e}, expected {expected:e}"
    );
}

fn assert_variances(effect: &dyn Effect, expected: impl Fn(f64, f64) -> f64) {
    for interval_s in INTERVALS_S {
        for m in octaves(29) {
            let found = effect.variance(m, &SampledShape::new(interval_s));
            let what = format!("{}, m = {m}, {interval_s} s", effect.name());
            assert_relative(found, expected(m, interval_s), 1e-12, &what);
        }
    }
}

#[test]
fn quantization_falls_with_the_square_of_the_averaging_time() {
    assert_variances(&Quantization, |m, interval_s| {
        3.0 / (m * interval_s).powi(2)
    });
}

#[test]
fn angle_random_walk_falls_with_the_averaging_time() {
    assert_variances(&AngleRandomWalk, |m, interval_s| 1.0 / (m * interval_s));
}

#[test]
fn bias_instability_is_flat() {
    assert_variances(&BiasInstability, |_, _| 2.0 * LN_2 / PI);
    let factor = BiasInstability
        .variance(8.0, &SampledShape::new(1.0))
        .sqrt();
    assert_relative(factor, 0.664, 1e-3, "the factor of IEEE Std 952");
}

#[test]
fn rate_random_walk_rises_with_the_averaging_time() {
    assert_variances(&RateRandomWalk, |m, interval_s| {
        interval_s * (2.0 * m * m + 1.0) / (6.0 * m)
    });
    // The random walk of the standard is continuous, whereas ours takes one step per sample.
    for m in octaves(29).skip(6) {
        let found = RateRandomWalk.variance(m, &SampledShape::new(0.01));
        assert_relative(found, 0.01 * m / 3.0, 0.51 / (m * m) + 1e-13, "K²τ/3");
    }
}

#[test]
fn rate_ramp_rises_with_the_square_of_the_averaging_time() {
    assert_variances(&RateRamp, |m, interval_s| 0.5 * (m * interval_s).powi(2));
}

/// The relation is `σ²(m) = [3 G(0) − 4 G(m) + G(2m)]/τ²`.
#[test]
fn variances_follow_from_the_kernel() {
    for_every_shape(|effect, shape, name| {
        for m in octaves(14) {
            let kernel = |lag: f64| effect.kernel(lag, shape);
            let tau2 = (m * shape.interval_s).powi(2);
            let expected = 3.0 * kernel(0.0) - 4.0 * kernel(m) + kernel(2.0 * m);
            let difference = effect.variance(m, shape) * tau2 - expected;
            let allowed = rounding(effect, 2.0 * m, shape);
            assert!(
                difference.abs() <= allowed,
                "{name}, m = {m}: {difference:e} of {expected:e}, allowed {allowed:e}"
            );
        }
    });
}

/// The autocovariance of the rate, `−G″/τ₀²`, up to a constant, from the kernel at single lags.
fn autocovariance(effect: &dyn Effect, lag: usize, shape: &SampledShape) -> f64 {
    let at = |lag: usize| effect.kernel(lag as f64, shape);
    let second = at(lag + 1) - 2.0 * at(lag) + at(lag.abs_diff(1));
    -second / shape.interval_s.powi(2)
}

/// The Allan variance is half the mean square of the difference of two means, each over `m`
/// samples. This is a double sum over the autocovariance.
#[test]
fn variances_equal_double_sums_over_the_autocovariance() {
    for_every_shape(|effect, shape, name| {
        for m in [1_usize, 2, 3, 5, 8, 17] {
            let pairs = (0..m).flat_map(|i| (0..m).map(move |j| (i, j)));
            let at = |lag: usize| autocovariance(effect, lag, shape);
            let sum: f64 = pairs.map(|(i, j)| at(i.abs_diff(j)) - at(m + i - j)).sum();
            let expected = sum / (m * m) as f64;
            let found = effect.variance(m as f64, shape);
            let allowed = 1e-9 * expected.abs()
                + 16.0 * rounding(effect, 2.0 * m as f64, shape) / shape.interval_s.powi(2);
            assert!(
                (found - expected).abs() <= allowed,
                "{name}, m = {m}: {found:e}, not {expected:e}, allowed {allowed:e}"
            );
        }
    });
}

/// The covariance matrix of the differences of a process has no negative eigenvalue.
#[test]
fn kernels_are_covariances() {
    for_every_shape(|effect, shape, name| {
        let at = |lag: usize| autocovariance(effect, lag, shape);
        let differences: Vec<f64> = (0..24_usize)
            .map(|lag| 2.0 * at(lag) - at(lag + 1) - at(lag.abs_diff(1)))
            .collect();
        let matrix = SMatrix::<f64, 24, 24>::from_fn(|i, j| differences[i.abs_diff(j)]);
        let eigenvalues = matrix.symmetric_eigenvalues();
        let (least, largest) = (eigenvalues.min(), eigenvalues.max());
        let rounding = 1e3 * rounding(effect, 24.0, shape) / shape.interval_s.powi(2);
        assert!(largest > 0.0, "{name}");
        assert!(
            least >= -1e-9 * largest - rounding,
            "{name}: {least:e} beside {largest:e}"
        );
    });
}

#[test]
fn variances_computed_together_equal_those_computed_one_by_one() {
    for_every_shape(|effect, shape, name| {
        let mut found = Vec::new();
        effect.variances(&mut octaves(16), shape, &mut |variance| {
            found.push(variance);
        });
        let expected: Vec<f64> = octaves(16).map(|m| effect.variance(m, shape)).collect();
        assert_eq!(found.len(), expected.len());
        let largest = expected.iter().fold(0.0, |most: f64, x| most.max(*x));
        for (found, expected) in found.iter().zip(&expected) {
            // The recursion for an oscillation loses digits where the variance is close to a zero.
            let allowed = 1e-9 * expected + 1e-13 * largest;
            assert!(
                (found - expected).abs() <= allowed,
                "{name}: {found:e}, not {expected:e}"
            );
        }
    });
}

/// The lags on both sides of every kink, in samples.
fn lags(m: f64) -> Vec<f64> {
    let quarters = (0..40).map(|i| 0.25 * m * f64::from(i));
    let far = (0..12).map(|k| m * (11.0 + 1.4 * f64::from(1_u32 << k)));
    let around = [m - 1.0, m + 1.0, 1.0, 2.0 * m - 1.0, 3.0 * m + 1.0];
    quarters
        .chain(far)
        .chain(around)
        .filter(|lag| lag.fract() == 0.0)
        .collect()
}

/// The constant is arbitrary, because the next difference removes it.
#[test]
fn second_differences_are_those_of_the_kernel_up_to_a_constant() {
    for_every_shape(|effect, shape, name| {
        let kernel = KernelOnly(effect);
        for m in octaves(12) {
            let excess = |x: f64| {
                effect.second_difference(x, m, shape) - kernel.second_difference(x, m, shape)
            };
            let constant = excess(0.0);
            for x in lags(m) {
                let left = excess(x) - constant;
                let allowed = rounding(effect, x + m, shape);
                assert!(
                    left.abs() <= allowed,
                    "{name}, m = {m}, x = {x}: {left:e}, allowed {allowed:e}"
                );
            }
        }
    });
}

/// The covariance of two differences of adjacent cluster sums whose middles lie `offset` apart.
fn cross_difference(
    effect: &dyn Effect,
    short: f64,
    long: f64,
    offset: f64,
    shape: &SampledShape,
) -> f64 {
    let at = |x: f64| effect.second_difference(x, short, shape);
    at((offset - long).abs()) - 2.0 * at(offset) + at(offset + long)
}

#[test]
fn cross_differences_are_those_of_the_kernel() {
    for_every_shape(|effect, shape, name| {
        for short in octaves(6) {
            for long in octaves(6).filter(|&long| long >= short) {
                for offset in lags(short).into_iter().chain(lags(long)) {
                    // The definition has nine terms, because G is even.
                    let weights = [1.0, -2.0, 1.0];
                    let mut expected = 0.0;
                    for (u, w_u) in [-1.0, 0.0, 1.0].into_iter().zip(weights) {
                        for (v, w_v) in [-1.0, 0.0, 1.0].into_iter().zip(weights) {
                            let lag: f64 = offset + v * long - u * short;
                            expected += w_u * w_v * effect.kernel(lag.abs(), shape);
                        }
                    }
                    let allowed = rounding(effect, offset + 2.0 * long, shape);
                    let found = cross_difference(effect, short, long, offset, shape);
                    assert!(
                        (found - expected).abs() <= allowed,
                        "{name}, m = {short}, {long}, {offset}: {found:e}, not {expected:e}"
                    );
                }
            }
        }
    });
}

#[test]
fn variances_of_poles_are_those_of_the_sum_over_pairs() {
    let interval_s = 0.01;
    for exponent in -10..=30 {
        // The decay rates per sample reach from 1e-9 to some hundreds.
        let decay = 10_f64.powf(-0.3 * f64::from(exponent));
        for cycles in [0.0, 1e-4, 0.03, 0.3, 0.49, 0.8] {
            let time_s = interval_s / decay;
            let frequency_hz = cycles / interval_s;
            let (effect, parameters): (&dyn Effect, _) = if cycles == 0.0 {
                (&GaussMarkov, [time_s, 0.0])
            } else {
                (&Resonance, [frequency_hz, PI * frequency_hz * time_s])
            };
            let shape = SampledShape {
                interval_s,
                parameters,
            };
            // This computes 1 − r_n without cancellation.
            let fallen = |n: usize| {
                let n = n as f64;
                let half_turn = (PI * cycles * n).sin();
                -(-decay * n).exp_m1() + (-decay * n).exp() * 2.0 * half_turn * half_turn
            };
            for m in [1_usize, 2, 4, 32] {
                let pairs = (0..m).flat_map(|i| (0..m).map(move |j| (i, j)));
                let sum: f64 = pairs
                    .map(|(i, j)| fallen(m + i - j) - fallen(i.abs_diff(j)))
                    .sum();
                let expected = sum / (m * m) as f64;
                let found = effect.variance(m as f64, &shape);
                let what = format!(
                    "{}, decay {decay:e}, cycles {cycles}, m = {m}",
                    effect.name()
                );
                // The terms of a pole may cancel in the sum, as they do where the pole oscillates.
                assert!(
                    (found - expected).abs() < 1e-9 * expected + 1e-13,
                    "{what}: {found:e}, not {expected:e}"
                );
            }
        }
    }
}

/// A response describes a signal whose differences have the Allan variance and the autocovariance
/// of the effect.
#[test]
fn responses_are_those_of_the_kernel() {
    for_every_shape(|effect, shape, name| {
        let is_deterministic = effect.description().distribution == Distribution::Deterministic;
        assert_eq!(effect.response(4.0, shape).is_some(), is_deterministic);
        if !is_deterministic {
            return;
        }
        for m in octaves(14) {
            let response = effect.response(m, shape).expect("deterministic");
            // The relation is σ² = ½ mean D², and the amplitude divided by τ is the root of that
            // mean.
            let mean_square = (response.amplitude / (m * shape.interval_s)).powi(2);
            assert_relative(0.5 * mean_square, effect.variance(m, shape), 1e-9, name);
            for offset in lags(m).into_iter().filter(|&offset| offset < 1e4) {
                let expected = response.amplitude.powi(2) * (response.phase * offset).cos();
                let found = cross_difference(effect, m, m, offset, shape);
                let allowed = rounding(effect, offset + 2.0 * m, shape);
                assert!(
                    (found - expected).abs() <= allowed,
                    "{name}, m = {m}, {offset}: {found:e}, not {expected:e}"
                );
            }
        }
    });
}

/// Each effect fills the lattice of sums that the covariance reads in its own way.
#[test]
fn lattice_sums_are_those_of_the_kernel() {
    const OCTAVES: usize = 12;
    let samples: u64 = 1 << 15;
    for_every_shape(|effect, shape, name| {
        if effect.response(1.0, shape).is_some() {
            return;
        }
        let octaves = (0..OCTAVES as u32).map(|k| {
            let m = 1_u64 << k;
            (m as u32, (samples - 2 * m) / (m / 4).max(1) + 1, 1.0)
        });
        let curve = Curve::<OCTAVES>::new(1.0 / shape.interval_s, octaves).expect("possible");
        let covariance = |effect: &'static dyn Effect| {
            let mut model = Model::default();
            let term = Term {
                parameters: shape.parameters,
                ..Term::new(effect)
            };
            model.add(term).expect("one effect");
            curve_covariance(&curve, &model, &[1.0])
        };
        let kernel = Box::leak(Box::new(KernelOnly(effect)));
        let (found, expected) = (covariance(effect), covariance(kernel));
        for j in 0..OCTAVES {
            for k in 0..OCTAVES {
                let unit = (expected[(j, j)] * expected[(k, k)]).sqrt();
                let difference = (found[(j, k)] - expected[(j, k)]) / unit;
                assert!(difference.abs() < 1e-6, "{name}, {j}, {k}: {difference:e}");
            }
        }
    });
}

/// If the unit of time changes, a variance changes by a power of it. The unit of the coefficient
/// must contain that power.
#[test]
fn units_are_those_of_the_variances() {
    const FACTOR: f64 = 4.0;
    for_every_shape(|effect, shape, name| {
        let mut slower = *shape;
        slower.interval_s *= FACTOR;
        for (parameter, value) in effect.parameters().iter().zip(&mut slower.parameters) {
            *value *= match parameter.unit {
                "s" => FACTOR,
                "Hz" => 1.0 / FACTOR,
                "" => 1.0,
                unit => panic!("{name}: {unit} is not a power of time"),
            };
        }
        let ratio = effect.variance(16.0, shape) / effect.variance(16.0, &slower);
        let expected = FACTOR.powi(effect.half_seconds().into());
        assert_relative(ratio, expected, 1e-9, name);
    });
}

#[test]
fn descriptions_are_complete_and_distinct() {
    for (i, explained) in EXPLAINED.into_iter().enumerate() {
        let effect: &dyn Effect = explained;
        let description = effect.description();
        let name = description.name;
        let is_plain = |name: &str| {
            !name.is_empty() && name.chars().all(|c| c.is_ascii_lowercase() || c == '_')
        };
        assert!(is_plain(name), "{name}");
        assert!(is_plain(description.coefficient), "{name}");
        assert!((1..FIRST_OWN_CODE).contains(&description.code), "{name}");
        for other in &EXPLAINED[..i] {
            let other = other.description();
            assert!(
                other.name != name && other.code != description.code,
                "{name}"
            );
        }
        assert!(description.parameters.len() <= MAX_PARAMETERS, "{name}");
        for parameter in description.parameters {
            let unit = parameter.unit.to_lowercase();
            assert!(parameter.name.ends_with(&unit), "{name}: {parameter:?}");
        }
        if let Some(mirror) = description.mirror {
            assert_eq!(mirror.parameters().len(), description.parameters.len());
        }
        let explanation = explained.explanation();
        for text in [explanation.what, explanation.origin, explanation.check] {
            assert!(text.len() > 20, "{name}: {text}");
        }
        assert!(!explained.typical_shapes().is_empty(), "{name}");
        for shape in explained.typical_shapes() {
            for (i, value) in shape.iter().enumerate() {
                let range = effect.search_range(i, &SPAN);
                let within = range.map_or(*value == 0.0, |range| {
                    (range.low..=range.high).contains(value)
                });
                assert!(within, "{name}: {shape:?}");
            }
        }
    }
}

#[test]
fn terms_have_the_names_symbols_and_units_of_the_standard() {
    let known = IEEE_952.map(|effect| (effect.name(), effect.symbol(), effect.half_seconds()));
    let expected = [
        ("quantization", "Q", 2),
        ("angle_random_walk", "N", 1),
        ("bias_instability", "B", 0),
        ("rate_random_walk", "K", -1),
        ("rate_ramp", "R", -2),
    ];
    assert_eq!(known, expected);
}
