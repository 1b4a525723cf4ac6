use super::{Description, Distribution, Effect, Explain, Explanation, SampledShape};
use crate::numerics::real::{
    Real,
    consts::{LN_2, PI},
};
use crate::{
    numerics::math,
    theory::lattice::{self, SecondDifferences},
};

/// Bias instability, which is flicker noise of the rate, averaged over each sample interval. The
/// coefficient is `B` in rate units; the spectral density of the rate is `B²/(2πf)`.
///
/// `G(n) = (nτ₀)² ln(nτ₀)/2π`, 0 at `n = 0`, and `σ² = (2 ln 2/π) B² = (0.664 B)²` at every τ (IEEE
/// Std 952-1997, eq. C.17, for τ beyond its cut-off; Allan 1966 for the kernel of flicker frequency
/// noise).
///
/// The kernel has no time scale: up to a constant, its second differences are `m²` times a function
/// of `x/m`. A table holds that function, so that a target takes no logarithm.
#[derive(Clone, Copy, Debug)]
pub struct BiasInstability;

pub(super) static DESCRIPTION: Description = Description {
    name: "bias_instability",
    symbol: "B",
    coefficient: "bias_instability",
    half_seconds: 0,
    reference_s: None,
    parameters: &[],
    code: 3,
    replaces: None,
    mirror: None,
    special_case: None,
    distribution: Distribution::Gaussian,
};

impl Effect for BiasInstability {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn kernel(&self, lag: Real, shape: &SampledShape) -> Real {
        if lag == 0.0 {
            return 0.0;
        }
        let t = lag * shape.interval_s;
        t * t * math::log(t) / (2.0 * PI)
    }

    fn second_difference(&self, x: Real, m: Real, shape: &SampledShape) -> Real {
        if x < 32.0 * m {
            let apart = if x < m { m - x } else { x - m };
            return self.kernel(x + m, shape) - 2.0 * self.kernel(x, shape)
                + self.kernel(apart, shape);
        }
        // The three terms would cancel. Therefore this is the Taylor series of their sum in m/x.
        let (tau_s, ratio) = (m * shape.interval_s, m / x);
        let square = ratio * ratio;
        let series = square * (1.0 / 6.0 + square * (1.0 / 30.0 + square / 84.0));
        tau_s * tau_s * (2.0 * math::log(x * shape.interval_s) + 3.0 - series) / (2.0 * PI)
    }

    fn variance(&self, _: Real, _: &SampledShape) -> Real {
        2.0 * LN_2 / PI
    }

    fn add_second_differences(
        &self,
        m: Real,
        weight: Real,
        shape: &SampledShape,
        sum: &mut SecondDifferences,
    ) {
        let tau_s = m * shape.interval_s;
        sum.add_scaled(weight * tau_s * tau_s / (2.0 * PI), &SCALE_FREE);
    }

    fn variogram(&self, _: Real, _: &SampledShape, values: &mut [Real]) {
        // The kernel has no time scale, so that only the distance matters.
        let square_log = |x: Real| x * x * math::log(x);
        let mut distance = 1.0;
        for value in values {
            let apart: Real = distance - 1.0;
            let difference = if apart < 1.0 {
                square_log(2.0)
            } else if distance < 4.0 {
                square_log(distance + 1.0) - 2.0 * square_log(distance) + square_log(apart)
            } else {
                let square = 1.0 / (distance * distance);
                let series = SERIES.iter().fold(0.0, |sum, term| (sum + term) * square);
                2.0 * math::log(distance) + 3.0 - series
            };
            *value = difference / (2.0 * PI);
            distance += 1.0;
        }
    }
}

/// The factors of `1/l²`, `1/l⁴`, … in the second difference of `l² ln l`, the last one first. From a distance of
/// four blocks on, the terms left out are below 1e-17, or below 1e-9 in single precision.
const SERIES: [Real; if cfg!(feature = "double") { 12 } else { 6 }] = {
    let mut series = [0.0; if cfg!(feature = "double") { 12 } else { 6 }];
    let mut i = 0;
    while i < series.len() {
        let even = 2 * (series.len() + 1 - i);
        series[i] = 4.0 / (even * (even - 1) * (even - 2)) as Real;
        i += 1;
    }
    series
};

impl Explain for BiasInstability {
    fn explanation(&self) -> Explanation {
        Explanation {
            what: "bias instability: flicker noise of the rate",
            origin: "1/f noise of the electronics, discharge in a laser gyro, surface charge in MEMS",
            check: "compare with the datasheet; does chopping or another bias current change it?",
        }
    }
}

/// `[(i+4)² ln(i+4) − 2 i² ln i + (i−4)² ln|i−4|]/16` at the lattice's positions `i = 4x/m`.
static SCALE_FREE: [Real; lattice::LEN] = {
    let mut table = [0.0; lattice::LEN];
    let mut slot = 0;
    while slot < lattice::LEN {
        table[slot] = scale_free(lattice::position(slot)) as Real;
        slot += 1;
    }
    table
};

const fn scale_free(position: u32) -> f64 {
    let i = position as f64;
    if position < 64 {
        (square_log(position + 4) - 2.0 * square_log(position) + square_log(position.abs_diff(4)))
            / 16.0
    } else {
        // The three terms would cancel. Therefore this is the Taylor series of their sum.
        let i2 = i * i;
        2.0 * math::log_of_integer(position) + 3.0 - 8.0 / (3.0 * i2) - 128.0 / (15.0 * i2 * i2)
    }
}

const fn square_log(i: u32) -> f64 {
    if i == 0 {
        return 0.0;
    }
    let x = i as f64;
    x * x * math::log_of_integer(i)
}
