use super::{
    Description, Distribution, Effect, Explain, Explanation, MAX_PARAMETERS, Parameter,
    SampledShape, SearchRange, bias_instability::BiasInstability,
};
use crate::numerics::real::{Real, consts::LN_2};
use crate::{
    numerics::math,
    theory::lattice::{self, SecondDifferences},
};

/// Power-law noise of the rate, averaged over each sample interval: flicker noise whose exponent is free.
/// It takes the place of [`BiasInstability`], which is power-law noise of exponent 1. The coefficient is
/// the Allan deviation `P` at an averaging time of one second, in rate units; the shape parameter is the
/// exponent `α` of the spectral density `S(f) ∝ f^(−α)`, above 0 and below 3.
///
/// `σ²(τ) = P² (τ/1 s)^(α−1)` (Barnes et al. 1971, IEEE Trans. Instrum. Meas. IM-20, 105, table II), and
/// with `t = nτ₀/1 s` and `ε = α − 1`, `G(n) = (nτ₀)² (t^ε − 1)/(4 (2^ε − 1))`, 0 at `n = 0`. The part with
/// `t²` alone has no second differences of second differences. It makes the kernel continuous in α: at
/// `α = 1` it is `(nτ₀)² ln t/(4 ln 2)`, that of bias instability with `P = 0.664 B`.
///
/// The kernel has no time scale: up to a constant, its second differences are `τ² t^ε` times a function of
/// `x/m` that depends on the exponent only.
#[derive(Clone, Copy, Debug)]
pub struct PowerLaw;

pub(super) static DESCRIPTION: Description = Description {
    name: "power_law",
    symbol: "P",
    coefficient: "deviation_at_one_second",
    half_seconds: 0,
    reference_s: Some(1.0),
    parameters: &[Parameter {
        name: "exponent",
        unit: "",
        is_whole: false,
        // Angle random walk has the exponent 0, and rate random walk has 2.
        search_range: |_| SearchRange {
            low: 0.5,
            high: 1.8,
            steps_per_octave: 6.0,
        },
        reciprocal: None,
    }],
    code: 12,
    replaces: Some(&BiasInstability),
    mirror: None,
    special_case: None,
    distribution: Distribution::Gaussian,
};

/// The exponent of the Allan variance, `ε = α − 1`.
fn variance_exponent(shape: &SampledShape) -> Real {
    shape.parameters[0] - 1.0
}

impl Effect for PowerLaw {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn kernel(&self, lag: Real, shape: &SampledShape) -> Real {
        let t = lag * shape.interval_s;
        t * t * Growth::new(variance_exponent(shape)).scaled(t)
    }

    fn second_difference(&self, x: Real, m: Real, shape: &SampledShape) -> Real {
        let growth = Growth::new(variance_exponent(shape));
        let ratio = x / m;
        let value = if ratio < NEAR {
            growth.near(ratio, |s| growth.log_like(s))
        } else {
            growth.far(ratio, growth.log_like(ratio))
        };
        growth.unit(m * shape.interval_s) * value
    }

    fn variance(&self, m: Real, shape: &SampledShape) -> Real {
        math::exp(variance_exponent(shape) * math::log(m * shape.interval_s))
    }

    fn variances(
        &self,
        factors: &mut dyn Iterator<Item = Real>,
        shape: &SampledShape,
        each: &mut dyn FnMut(Real),
    ) {
        let per_octave = math::exp(variance_exponent(shape) * LN_2);
        let mut last: Option<(Real, Real)> = None;
        for m in factors {
            let variance = match last {
                Some((before, variance)) if m == 2.0 * before => variance * per_octave,
                _ => self.variance(m, shape),
            };
            last = Some((m, variance));
            each(variance);
        }
    }

    fn add_second_differences(
        &self,
        m: Real,
        weight: Real,
        shape: &SampledShape,
        sum: &mut SecondDifferences,
    ) {
        let growth = Growth::new(variance_exponent(shape));
        let unit = weight * growth.unit(m * shape.interval_s);
        let double = growth.log_like(2.0);
        let near: [Real; LOGS.len()] =
            core::array::from_fn(|i| growth.of_log(LOGS.get(i).copied().unwrap_or(0.0)));
        // The values at the last four slots, one of which is half of the present one.
        let mut last = [0.0; 4];
        sum.add_slots(|slot| {
            let s = quarters(lattice::position(slot));
            if s < NEAR {
                let at = |s: Real| near.get((4.0 * s) as usize).copied().unwrap_or(0.0);
                return unit * growth.near(s, at);
            }
            let Some(half) = last.get_mut(slot % 4) else {
                return 0.0;
            };
            // From (2s)^ε − 1 = 2^ε (s^ε − 1) + (2^ε − 1).
            *half = if s < 2.0 * NEAR {
                near.get((4.0 * s) as usize).copied().unwrap_or(0.0)
            } else {
                *half * (1.0 + growth.exponent * double) + double
            };
            unit * growth.far(s, *half)
        });
    }

    fn variogram(&self, m: Real, shape: &SampledShape, values: &mut [Real]) {
        let growth = Growth::new(variance_exponent(shape));
        let unit = self.variance(m, shape);
        let mut distance = 1.0;
        for value in values {
            // The second difference at 0 vanishes in this unit.
            *value = unit
                * if distance < NEAR {
                    growth.near(distance, |s| growth.log_like(s))
                } else {
                    growth.far(distance, growth.log_like(distance))
                };
            distance += 1.0;
        }
    }
}

impl Explain for PowerLaw {
    fn explanation(&self) -> Explanation {
        Explanation {
            what: "power-law noise: flicker noise of the rate whose slope is not that of 1/f",
            origin: "many traps or relaxations whose time constants are not spread evenly, in the electronics, the package or the light source; slow drift of temperature",
            check: "record for longer: does the slope persist? log temperature beside the rate",
        }
    }

    fn typical_shapes(&self) -> &'static [[Real; MAX_PARAMETERS]] {
        &[[0.7, 0.0, 0.0], [1.3, 0.0, 0.0], [1.5, 0.0, 0.0]]
    }
}

/// From this lag on, in clusters, second differences are a series, because their terms would cancel.
const NEAR: Real = 4.0;

/// A position of the lattice in clusters.
fn quarters(position: u32) -> Real {
    0.25 * crate::numerics::real::real(position)
}

/// The logarithms of 0, 1, … 31 quarters of a cluster. The first one is never multiplied by anything but 0.
static LOGS: [Real; 32] = {
    let mut logs = [0.0; 32];
    let mut i = 1;
    while i < logs.len() {
        logs[i] = (math::log_of_integer(i as u32) - math::log_of_integer(4)) as Real;
        i += 1;
    }
    logs
};

/// The function `h(s) = s² (s^ε − 1)/(4 (2^ε − 1))` and its second differences over steps of 1.
struct Growth {
    /// The exponent `ε`.
    exponent: Real,
    /// The factor `ε/(4 (2^ε − 1))`.
    scale: Real,
    /// The numbers `C(2+ε, 2k)/ε` for k = 2, 3, …, of the series in `1/s²`.
    series: [Real; SERIES],
}

/// The number of terms of the series. The first one that is left out is below 2e-9 of the sum, or below 1e-17
/// in double precision.
const SERIES: usize = if cfg!(feature = "double") { 10 } else { 4 };

impl Growth {
    fn new(exponent: Real) -> Self {
        let mut series = [0.0; SERIES];
        let (mut term, mut k) = (
            (2.0 + exponent) * (1.0 + exponent) * (exponent - 1.0) / 24.0,
            4.0,
        );
        for slot in &mut series {
            *slot = term;
            term *= (2.0 + exponent - k) * (1.0 + exponent - k) / ((k + 1.0) * (k + 2.0));
            k += 2.0;
        }
        let per_octave = LN_2 * relative_growth(exponent * LN_2);
        Self {
            exponent,
            scale: 0.25 / per_octave,
            series,
        }
    }

    /// `τ² τ^ε`, the unit of the second differences for clusters of `τ` seconds.
    fn unit(&self, tau_s: Real) -> Real {
        tau_s * tau_s * math::exp(self.exponent * math::log(tau_s))
    }

    /// `(s^ε − 1)/ε` for `ln s`. It is `ln s` for `ε = 0`.
    fn of_log(&self, log: Real) -> Real {
        log * relative_growth(self.exponent * log)
    }

    /// `(s^ε − 1)/ε`, and 0 for `s = 0`, where it is always multiplied by `s²`.
    fn log_like(&self, s: Real) -> Real {
        if s == 0.0 {
            return 0.0;
        }
        self.of_log(math::log(s))
    }

    /// `h(s)/s²`.
    fn scaled(&self, s: Real) -> Real {
        self.scale * self.log_like(s)
    }

    /// The second difference, from the values of [`log_like`](Self::log_like) at the three places.
    fn near(&self, s: Real, log_like: impl Fn(Real) -> Real) -> Real {
        let apart = if s < 1.0 { 1.0 - s } else { s - 1.0 };
        let at = |s: Real| s * s * log_like(s);
        self.scale * (at(s + 1.0) - 2.0 * at(s) + at(apart))
    }

    /// The second difference as a series in `1/s²`, given `log_like` at `s`. The parts of it that do not
    /// vanish with `ε` cancel, so that everything is divided by `ε`.
    fn far(&self, s: Real, log_like: Real) -> Real {
        let square = 1.0 / (s * s);
        let rest = self.series.iter().rev();
        let rest = rest.fold(0.0, |sum, term| (sum + term) * square);
        let power = 1.0 + self.exponent * log_like;
        2.0 * self.scale * (log_like + power * (1.5 + 0.5 * self.exponent + rest))
    }
}

/// `(e^u − 1)/u`, and 1 for `u = 0`.
fn relative_growth(u: Real) -> Real {
    if !(-1.0..=1.0).contains(&u) {
        return (math::exp(u) - 1.0) / u;
    }
    // The series is 1 + u/2 (1 + u/3 (1 + …)).
    RECIPROCALS
        .iter()
        .fold(1.0, |sum, reciprocal| 1.0 + u * reciprocal * sum)
}

/// The numbers 1/k, from the last one of the series to 1/2. At `u = 1`, the terms left out are below 1e-17,
/// or below 1e-9 in single precision.
const RECIPROCALS: [Real; if cfg!(feature = "double") { 18 } else { 11 }] = {
    let mut reciprocals = [0.0; if cfg!(feature = "double") { 18 } else { 11 }];
    let mut i = 0;
    while i < reciprocals.len() {
        reciprocals[i] = 1.0 / (reciprocals.len() + 1 - i) as Real;
        i += 1;
    }
    reciprocals
};

#[cfg(test)]
mod tests {
    //! The arithmetic of either precision against double precision, and against bias instability.

    use super::*;
    use crate::numerics::real::{by_precision, double, real};

    const INTERVAL_S: f64 = 0.01;

    fn shape(exponent: f64) -> SampledShape {
        SampledShape::known(real(INTERVAL_S), [real(exponent)])
    }

    /// The second difference over one cluster, in units of τ² times the Allan variance, from its definition.
    fn expected(exponent: f64, s: f64) -> f64 {
        let epsilon = exponent - 1.0;
        let h = |s: f64| {
            if s == 0.0 {
                return 0.0;
            }
            let log = libm::log(s);
            let (part, whole) = if epsilon == 0.0 {
                (log, core::f64::consts::LN_2)
            } else {
                let growth = |x: f64| libm::expm1(epsilon * x);
                (growth(log), growth(core::f64::consts::LN_2))
            };
            s * s * part / (4.0 * whole)
        };
        h(s + 1.0) - 2.0 * h(s) + h(libm::fabs(s - 1.0))
    }

    const EXPONENTS: [f64; 10] = [0.3, 0.5, 0.9, 0.9999, 1.0, 1.000_001, 1.01, 1.3, 1.8, 1.95];

    #[test]
    fn second_differences_have_the_precision_of_their_numbers() {
        for exponent in EXPONENTS {
            for m in [1_u32, 8, 4096, 1 << 20] {
                let mut sum = SecondDifferences::zero(m, lattice::END);
                PowerLaw.add_second_differences(real(m), 3.0, &shape(exponent), &mut sum);
                let rounded = sum.rounded(sum.unit());
                let zero = f64::from(rounded.at(0));
                for slot in 0..lattice::LEN {
                    let position = lattice::position(slot);
                    // Beyond this, double precision has lost too many digits.
                    let ratio = 0.25 * f64::from(position);
                    if ratio > 300.0 {
                        break;
                    }
                    let difference = expected(exponent, ratio);
                    let found = f64::from(rounded.at(position)) - zero;
                    let off = found - (difference - expected(exponent, 0.0));
                    let most = 3e-6 * (1.0 + libm::fabs(difference));
                    assert!(
                        libm::fabs(off) < most,
                        "{exponent}, m {m}, {position}: off by {off:e} of {difference}"
                    );
                    let single = PowerLaw.second_difference(
                        real(ratio) * real(m),
                        real(m),
                        &shape(exponent),
                    );
                    let unit = double(PowerLaw.variance(real(m), &shape(exponent)))
                        * (f64::from(m) * INTERVAL_S)
                        * (f64::from(m) * INTERVAL_S);
                    let off = double(single) / unit - difference;
                    assert!(
                        libm::fabs(off) < 3.0 * most,
                        "{exponent}, m {m}, {position}: alone off by {off:e} of {difference}"
                    );
                }
            }
        }
    }

    #[test]
    fn variances_are_powers_of_the_averaging_time() {
        for exponent in EXPONENTS {
            let shape = shape(exponent);
            let mut factors = (0..30).map(|k| real(1_u32 << k));
            let mut k = 0;
            PowerLaw.variances(&mut factors, &shape, &mut |variance| {
                let tau_s = INTERVAL_S * f64::from(1_u32 << k);
                let expected = libm::pow(tau_s, exponent - 1.0);
                let off = double(variance) / expected - 1.0;
                let most = double(by_precision(1e-13, 4e-6));
                assert!(libm::fabs(off) < most, "{exponent}, octave {k}: {off:e}");
                k += 1;
            });
            assert_eq!(k, 30);
        }
    }

    #[test]
    fn exponent_one_is_bias_instability() {
        let (law, flicker) = (shape(1.0), SampledShape::new(real(INTERVAL_S)));
        for m in [1.0, 64.0, 65_536.0] {
            let scale = BiasInstability.variance(m, &flicker);
            assert!((PowerLaw.variance(m, &law) - 1.0).abs() < by_precision(1e-14, 1e-6));
            for x in [0.0, 0.25, 1.0, 3.0, 5.0, 100.0] {
                let change = |effect: &dyn Effect, shape| {
                    let from = effect.second_difference(2.0 * m, m, shape);
                    effect.second_difference(x * m, m, shape) - from
                };
                let tau2 = m * m * real(INTERVAL_S * INTERVAL_S);
                let found = scale * change(&PowerLaw, &law) / tau2;
                let expected = change(&BiasInstability, &flicker) / tau2;
                let most = by_precision(1e-10, 1e-4);
                assert!(
                    (found - expected).abs() < most,
                    "m {m}, {x}: {found}, {expected}"
                );
            }
        }
    }
}
