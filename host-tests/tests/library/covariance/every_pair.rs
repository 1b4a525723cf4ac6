//! The covariance of a curve as the sum over every pair of its differences, for records of any length.
//!
//! The kernel enters by its second differences over one sample, which are the autocovariance. Sums of these
//! give the differences of longer clusters without cancellation.

use allanite::{
    Curve,
    effect::{Effect, SampledShape},
    model::Model,
};

/// An octave of a record.
pub(crate) struct Octave {
    pub(crate) m: usize,
    /// The distance of two starts, and the number of them.
    advance: usize,
    pub(crate) count: usize,
}

/// The octaves of a record without gaps that have at least six differences.
pub(crate) fn octaves(samples: usize) -> Vec<Octave> {
    let octave = |k: u32| {
        let m = 1_usize << k;
        let advance = (m / 4).max(1);
        let room = samples.checked_sub(2 * m);
        Octave {
            m,
            advance,
            count: room.map_or(0, |room| room / advance + 1),
        }
    };
    let all = (0..).map(octave);
    all.take_while(|octave| octave.count >= 6).collect()
}

/// The curve of such a record, with these variances.
pub(crate) fn curve<const K: usize>(
    octaves: &[Octave],
    interval_s: f64,
    variances: impl Fn(usize) -> f64,
) -> Curve<K> {
    let points = octaves.iter().enumerate();
    let points = points.map(|(k, o)| (o.m as u32, o.count as u64, variances(k)));
    Curve::new(1.0 / interval_s, points).expect("possible")
}

/// The second differences `G(x + m) − 2 G(x) + G(x − m)` of a kernel at all lags `x ≥ 0`, in samples.
struct Differences(Vec<f64>);

impl Differences {
    fn at(&self, lag: i64) -> f64 {
        self.0[lag.unsigned_abs() as usize]
    }

    /// The differences for clusters of twice the length `m`.
    fn doubled(&self, m: i64) -> Self {
        let lags = 0..self.0.len() as i64 - m;
        Self(
            lags.map(|x| self.at(x - m) + 2.0 * self.at(x) + self.at(x + m))
                .collect(),
        )
    }

    /// The covariance of two differences whose middles lie `lag` apart, times τ².
    fn covariance(&self, lag: i64, long: i64) -> f64 {
        let here = self.at(lag);
        (self.at(lag - long) - here) + (self.at(lag + long) - here)
    }
}

/// The random effects of a model together, and each of the deterministic ones.
struct Parts {
    random: Differences,
    /// Each deterministic effect with its square and its shape.
    deterministic: Vec<(&'static dyn Effect, f64, SampledShape)>,
}

impl Parts {
    fn new(model: &Model, squares: &[f64], interval_s: f64, longest: usize) -> Self {
        let mut parts = Self {
            random: Differences(vec![0.0; longest]),
            deterministic: Vec::new(),
        };
        for (term, square) in model.terms().iter().zip(squares) {
            let shape = SampledShape {
                interval_s,
                parameters: term.parameters,
            };
            let at = |lag| square * term.effect.second_difference(lag as f64, 1.0, &shape);
            match term.effect.response(1.0, &shape) {
                None => {
                    let sums = parts.random.0.iter_mut().enumerate();
                    sums.for_each(|(lag, sum)| *sum += at(lag));
                }
                Some(_) => parts.deterministic.push((term.effect, *square, shape)),
            }
        }
        parts
    }

    fn doubled(&self, m: i64) -> Self {
        Self {
            random: self.random.doubled(m),
            deterministic: self.deterministic.clone(),
        }
    }

    /// The amplitudes and the phases of what the deterministic effects make of two differences.
    fn amplitudes(&self, short: i64, long: i64) -> Vec<(f64, f64)> {
        let amplitude = |(effect, square, shape): &(&dyn Effect, f64, SampledShape)| {
            let response = |m: i64| effect.response(m as f64, shape).expect("deterministic");
            let (short, long) = (response(short), response(long));
            (square * short.amplitude * long.amplitude, short.phase)
        };
        self.deterministic.iter().map(amplitude).collect()
    }

    /// Half the covariance of the squares of two differences, times τ⁴.
    fn of_squares(&self, lag: i64, long: i64, amplitudes: &[(f64, f64)]) -> f64 {
        let c = self.random.covariance(lag, long);
        let mut sum = c * c;
        for (a, phase) in amplitudes {
            let g = a * (phase * lag as f64).cos();
            sum += 2.0 * c * g;
            if *phase != 0.0 {
                // The squares of two differences of one oscillation of random phase have this covariance.
                sum += 0.5 * g * g - 0.25 * a * a;
            }
        }
        sum
    }
}

/// `Cov(σ̂²_j, σ̂²_k) = ½ Σ_ℓ N_jk(ℓ) [(c_ℓ + g_ℓ)² − g_ℓ²]/(n_j n_k)`, and the scatter that the random phase
/// of an oscillation adds.
pub(crate) fn covariance(
    octaves: &[Octave],
    model: &Model,
    squares: &[f64],
    interval_s: f64,
    samples: usize,
) -> Vec<Vec<f64>> {
    let mut matrix = vec![vec![0.0; octaves.len()]; octaves.len()];
    let mut parts = Parts::new(model, squares, interval_s, 3 * samples);
    for (j, short) in octaves.iter().enumerate() {
        for (k, long) in octaves.iter().enumerate().skip(j) {
            let (m, last) = (long.m as i64, (short.count - 1) * short.advance);
            let inside = m - short.m as i64;
            let pairs = |lag: i64| {
                // A start `t` of the longer difference meets `t + inside − lag` of the shorter one.
                let first = (lag - inside).max(0) as usize;
                let first = first.div_ceil(long.advance) as i64;
                let end = (last as i64 + lag - inside).div_euclid(long.advance as i64);
                (end.min(long.count as i64 - 1) - first + 1).max(0)
            };
            let amplitudes = parts.amplitudes(short.m as i64, m);
            let mut sum = 0.0;
            for lag in (0..samples as i64).step_by(short.advance) {
                let both = match lag {
                    0 => pairs(0),
                    _ => pairs(lag) + pairs(-lag),
                };
                if both == 0 {
                    break;
                }
                sum += both as f64 * parts.of_squares(lag, m, &amplitudes);
            }
            let tau2 = short.m as f64 * m as f64 * interval_s * interval_s;
            let value = 0.5 * sum / (tau2 * tau2 * (short.count * long.count) as f64);
            matrix[j][k] = value;
            matrix[k][j] = value;
        }
        if j + 1 < octaves.len() {
            parts = parts.doubled(short.m as i64);
        }
    }
    matrix
}
