//! An effect that is not in the catalogue. This file contains all of it.

use allanite::{
    Real,
    effect::{
        Description, Distribution, Effect, Explain, Explanation, FIRST_OWN_CODE, MAX_PARAMETERS,
        Parameter, SampledShape, SearchRange,
    },
};

/// A critically damped Gauss–Markov process of second order. The coefficient is its rms `s` in rate
/// units, and the shape parameter is its time constant `T` in seconds.
///
/// The autocovariance is `r(n) = s² (1 + an) zⁿ` with `a = τ₀/T` and `z = e^(−a)` (Gelb, Applied
/// Optimal Estimation, 1974, table 2.2-1). If `P(z)` is the kernel of one real pole, whose
/// autocovariance is `zⁿ`, the kernel of this process is `G = P + a z ∂P/∂z`.
pub(crate) struct SecondOrderGaussMarkov;

impl Effect for SecondOrderGaussMarkov {
    fn description(&self) -> &'static Description {
        &Description {
            name: "second_order_gauss_markov",
            symbol: "s",
            coefficient: "rms",
            half_seconds: 0,
            reference_s: None,
            parameters: &[Parameter {
                name: "time_constant_s",
                unit: "s",
                is_whole: false,
                search_range: |span| SearchRange {
                    low: span.interval_s,
                    high: 0.1 * span.longest_tau_s,
                    steps_per_octave: 2.0,
                },
                reciprocal: None,
            }],
            code: FIRST_OWN_CODE,
            replaces: None,
            mirror: None,
            special_case: None,
            distribution: Distribution::Gaussian,
        }
    }

    fn kernel(&self, lag: Real, shape: &SampledShape) -> Real {
        let a = shape.interval_s / shape.parameters[0];
        let (n, z, power) = (lag, (-a).exp(), (-a * lag).exp());
        let (rest, gone) = (-(-a).exp_m1(), -(-a * lag).exp_m1());
        let pole = n * (1.0 + z) / rest - 2.0 * z * gone / rest.powi(2);
        let derivative =
            2.0 * z * n * (1.0 + power) / rest.powi(2) - 2.0 * z * (1.0 + z) * gone / rest.powi(3);
        -0.5 * shape.interval_s.powi(2) * (pole + a * derivative)
    }
}

impl Explain for SecondOrderGaussMarkov {
    fn explanation(&self) -> Explanation {
        Explanation {
            what: "a slow disturbance that is smooth: its rate of change is finite",
            origin: "thermal masses in series",
            check: "insulate the gyro and see the time constant grow",
        }
    }

    fn typical_shapes(&self) -> &'static [[Real; MAX_PARAMETERS]] {
        &[[0.2, 0.0, 0.0]]
    }
}
