//! The five effects of IEEE Std 952 against their closed forms, and everything that an effect
//! computes sooner against its kernel.

use allanite::{
    Curve, Model, curve_covariance,
    effect::{
        AngleRandomWalk, BiasInstability, Effect, GaussMarkov, IEEE_952, Quantization, RateRamp,
        RateRandomWalk, Resonance, Response, Setting,
    },
};
use std::f64::consts::{LN_2, PI};

/// Sample intervals, in seconds: of a fast gyro, of the design's, of one second, of a slow one.
const INTERVALS_S: [f64; 4] = [1e-4, 0.01, 1.0, 37.5];

/// An effect of which only the kernel is known: everything else comes from the trait's defaults.
struct KernelOnly(&'static dyn Effect);

impl Effect for KernelOnly {
    fn name(&self) -> &'static str {
        self.0.name()
    }

    fn symbol(&self) -> &'static str {
        self.0.symbol()
    }

    fn half_seconds(&self) -> i8 {
        self.0.half_seconds()
    }

    fn kernel(&self, lag: f64, setting: &Setting) -> f64 {
        self.0.kernel(lag, setting)
    }

    fn response(&self, m: f64, setting: &Setting) -> Option<Response> {
        self.0.response(m, setting)
    }
}

static KERNELS: [KernelOnly; 5] = [
    KernelOnly(&Quantization),
    KernelOnly(&AngleRandomWalk),
    KernelOnly(&BiasInstability),
    KernelOnly(&RateRandomWalk),
    KernelOnly(&RateRamp),
];

/// Averaging factors up to `2^last`.
fn octaves(last: u32) -> impl Iterator<Item = f64> {
    (0..=last).map(|k| f64::from(1_u32 << k))
}

/// What rounding leaves where kernels up to lag `lag` cancel: some units in the last place of the
/// largest (at three lags, because the logarithm of flicker noise has a zero).
fn rounding(effect: &dyn Effect, lag: f64, setting: &Setting) -> f64 {
    let lags = [0.0, 0.5 * lag, 0.8 * lag, lag];
    let sizes = lags.map(|lag| effect.kernel(lag, setting).abs());
    64.0 * f64::EPSILON * sizes.iter().sum::<f64>()
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
            let found = effect.variance(m, &Setting::new(interval_s));
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
    let factor = BiasInstability.variance(8.0, &Setting::new(1.0)).sqrt();
    assert_relative(factor, 0.664, 1e-3, "the factor of IEEE Std 952");
}

#[test]
fn rate_random_walk_rises_with_the_averaging_time() {
    assert_variances(&RateRandomWalk, |m, interval_s| {
        interval_s * (2.0 * m * m + 1.0) / (6.0 * m)
    });
    // The standard's walk is continuous, ours takes a step a sample.
    for m in octaves(29).skip(6) {
        let found = RateRandomWalk.variance(m, &Setting::new(0.01));
        assert_relative(found, 0.01 * m / 3.0, 0.51 / (m * m) + 1e-13, "K²τ/3");
    }
}

#[test]
fn rate_ramp_rises_with_the_square_of_the_averaging_time() {
    assert_variances(&RateRamp, |m, interval_s| 0.5 * (m * interval_s).powi(2));
}

/// `σ²(m) = [3 G(0) − 4 G(m) + G(2m)]/τ²`.
#[test]
fn variances_follow_from_the_kernel() {
    for effect in IEEE_952 {
        for interval_s in INTERVALS_S {
            let setting = Setting::new(interval_s);
            for m in octaves(20) {
                let kernel = |lag: f64| effect.kernel(lag, &setting);
                let tau2 = (m * interval_s).powi(2);
                let expected = 3.0 * kernel(0.0) - 4.0 * kernel(m) + kernel(2.0 * m);
                let difference = effect.variance(m, &setting) * tau2 - expected;
                let (name, left) = (effect.name(), rounding(effect, 2.0 * m, &setting));
                assert!(
                    difference.abs() <= left,
                    "{name}, m = {m}: {difference:e} of {expected:e}"
                );
            }
        }
    }
}

#[test]
fn variances_of_many_octaves_are_those_of_each() {
    for effect in IEEE_952 {
        let setting = Setting::new(0.01);
        let mut found = Vec::new();
        effect.variances(&mut octaves(29), &setting, &mut |variance| {
            found.push(variance);
        });
        let expected: Vec<f64> = octaves(29).map(|m| effect.variance(m, &setting)).collect();
        for (found, expected) in found.iter().zip(&expected) {
            assert_relative(*found, *expected, 1e-12, effect.name());
        }
        assert_eq!(found.len(), expected.len());
    }
}

/// Lags on both sides of every kink, in samples.
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

/// Second differences may differ from the kernel's by a straight line in the lag, which the next
/// difference removes: it is fitted through two lags, and then there is none.
#[test]
fn second_differences_are_those_of_the_kernel_up_to_a_straight_line() {
    for (effect, kernel) in IEEE_952.iter().zip(&KERNELS) {
        for interval_s in INTERVALS_S {
            let setting = Setting::new(interval_s);
            for m in octaves(16) {
                let excess = |x: f64| {
                    effect.second_difference(x, m, &setting)
                        - kernel.second_difference(x, m, &setting)
                };
                let (start, slope) = (excess(0.0), (excess(m) - excess(0.0)) / m);
                for x in lags(m) {
                    let left = excess(x) - start - slope * x;
                    let allowed = rounding(*effect, x + m, &setting) * (1.0 + x / m);
                    let name = effect.name();
                    assert!(left.abs() <= allowed, "{name}, m = {m}, x = {x}: {left:e}");
                }
            }
        }
    }
}

/// Covariance of two differences of adjacent cluster sums, whose middles lie `offset` apart.
fn cross_difference(
    effect: &dyn Effect,
    short: f64,
    long: f64,
    offset: f64,
    setting: &Setting,
) -> f64 {
    let at = |x: f64| effect.second_difference(x, short, setting);
    at((offset - long).abs()) - 2.0 * at(offset) + at(offset + long)
}

#[test]
fn variances_of_poles_are_those_of_the_sum_over_pairs() {
    let interval_s = 0.01;
    for exponent in -10..=30 {
        // A sample's decay, from a thousandth of a millionth to some hundreds.
        let decay = 10_f64.powf(-0.3 * f64::from(exponent));
        for cycles in [0.0, 1e-4, 0.03, 0.3, 0.49, 0.8] {
            let time_s = interval_s / decay;
            let frequency_hz = cycles / interval_s;
            let (effect, parameters): (&dyn Effect, _) = if cycles == 0.0 {
                (&GaussMarkov, [time_s, 0.0])
            } else {
                (&Resonance, [frequency_hz, PI * frequency_hz * time_s])
            };
            let setting = Setting {
                interval_s,
                parameters,
            };
            // 1 − r_n, which does not cancel.
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
                let found = effect.variance(m as f64, &setting);
                let what = format!(
                    "{}, decay {decay:e}, cycles {cycles}, m = {m}",
                    effect.name()
                );
                // A pole's terms may cancel in the sum, as they do where it swings.
                assert!(
                    (found - expected).abs() < 1e-9 * expected + 1e-13,
                    "{what}: {found:e}, not {expected:e}"
                );
            }
        }
    }
}

#[test]
fn cross_differences_are_those_of_the_kernel() {
    for (effect, kernel) in IEEE_952.iter().zip(&KERNELS) {
        for interval_s in INTERVALS_S {
            let setting = Setting::new(interval_s);
            for short in octaves(8) {
                for long in octaves(8).filter(|&long| long >= short) {
                    for offset in lags(short).into_iter().chain(lags(long)) {
                        // Nine terms of the definition, with G even.
                        let weights = [1.0, -2.0, 1.0];
                        let mut expected = 0.0;
                        for (u, w_u) in [-1.0, 0.0, 1.0].into_iter().zip(weights) {
                            for (v, w_v) in [-1.0, 0.0, 1.0].into_iter().zip(weights) {
                                let lag: f64 = offset + v * long - u * short;
                                expected += w_u * w_v * effect.kernel(lag.abs(), &setting);
                            }
                        }
                        let allowed = rounding(*effect, offset + 2.0 * long, &setting);
                        for effect in [*effect, kernel] {
                            let found = cross_difference(effect, short, long, offset, &setting);
                            assert!(
                                (found - expected).abs() <= allowed,
                                "{}, m = {short}, {long}, {offset}: {found:e}, not {expected:e}",
                                effect.name()
                            );
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn the_ramp_alone_is_deterministic_and_the_same_in_every_difference() {
    for effect in IEEE_952 {
        let responds = effect.response(4.0, &Setting::new(0.01)).is_some();
        assert_eq!(responds, effect.name() == "rate_ramp", "{}", effect.name());
    }
    for interval_s in INTERVALS_S {
        let setting = Setting::new(interval_s);
        for m in octaves(29) {
            let response = RateRamp.response(m, &setting).expect("deterministic");
            assert_eq!(response.phase, 0.0);
            // σ² = ½ mean D², and D is the amplitude over τ.
            let mean_square = (response.amplitude / (m * interval_s)).powi(2);
            assert_relative(
                0.5 * mean_square,
                RateRamp.variance(m, &setting),
                1e-12,
                "ramp",
            );
        }
    }
}

/// The lattice that the covariance reads is filled by each effect in its own way.
#[test]
fn covariances_of_curves_are_those_of_the_kernel() {
    const OCTAVES: usize = 12;
    let samples: u64 = 1 << 15;
    for interval_s in INTERVALS_S {
        let octaves = (0..OCTAVES as u32).map(|k| {
            let m = 1_u64 << k;
            (m as u32, (samples - 2 * m) / (m / 4).max(1) + 1, 1.0)
        });
        let curve = Curve::<OCTAVES>::new(1.0 / interval_s, octaves).expect("possible");
        for (effect, kernel) in IEEE_952.iter().zip(&KERNELS).take(4) {
            let covariance = |effect: &'static dyn Effect| {
                let model = Model::new(&[effect]).expect("one effect");
                curve_covariance(&curve, &model, &[1.0])
            };
            let (found, expected) = (covariance(*effect), covariance(kernel));
            for j in 0..OCTAVES {
                for k in 0..OCTAVES {
                    let unit = (expected[(j, j)] * expected[(k, k)]).sqrt();
                    let difference = (found[(j, k)] - expected[(j, k)]) / unit;
                    let name = effect.name();
                    assert!(difference.abs() < 1e-6, "{name}, {j}, {k}: {difference:e}");
                }
            }
        }
    }
}

#[test]
fn effects_bear_the_names_symbols_and_units_of_the_standard() {
    let known = IEEE_952.map(|effect| (effect.name(), effect.symbol(), effect.half_seconds()));
    let expected = [
        ("quantization", "Q", 2),
        ("angle_random_walk", "N", 1),
        ("bias_instability", "B", 0),
        ("rate_random_walk", "K", -1),
        ("rate_ramp", "R", -2),
    ];
    assert_eq!(known, expected);
    // The unit is that power of time by which a variance changes with the unit of time.
    for effect in IEEE_952 {
        let (now, later) = (Setting::new(0.01), Setting::new(0.04));
        let ratio = effect.variance(16.0, &now) / effect.variance(16.0, &later);
        let expected = 4_f64.powi(i32::from(effect.half_seconds()));
        assert_relative(ratio, expected, 1e-12, effect.name());
    }
}
