//! How long a record must be for an effect to show.

use crate::{
    model::Model,
    nnls::{Free, Matrix, NormalEquations, Vector},
};

/// Longest record that is considered, in samples: the longest octave's.
const LONGEST: f64 = (1_u64 << 30) as f64;

/// Length in seconds, the present one doubled as often as needed, of a record in which effect `i`
/// would be measured: with its square at `square`, and the others as `squares` has them, 1.96
/// standard errors are less than the square. `None` if no length does it.
///
/// Standard errors come from independent octaves of `N/m − 1` clusters each, which is between
/// what overlapping estimates gain and their correlation takes away.
pub(crate) fn record_length_s(
    i: usize,
    square: f64,
    squares: &Vector,
    free: &Free,
    model: &Model,
    interval_s: f64,
    samples: f64,
) -> Option<f64> {
    let mut assumed = *squares;
    assumed[i] = square;
    let mut with = *free;
    with[i] = true;
    let mut samples = 2.0 * samples;
    while samples <= LONGEST {
        let variance = equations(&assumed, model, interval_s, samples)?.covariance(&with);
        if variance.is_some_and(|matrix| square * square > 1.96 * 1.96 * matrix[(i, i)]) {
            return Some(samples * interval_s);
        }
        samples *= 2.0;
    }
    None
}

fn equations(
    squares: &Vector,
    model: &Model,
    interval_s: f64,
    samples: f64,
) -> Option<NormalEquations> {
    let mut matrix: Matrix = Matrix::zeros();
    let mut m = 1.0;
    while samples / m >= 4.0 {
        let mut row: Vector = Vector::zeros();
        for (share, term) in row.iter_mut().zip(model.terms()) {
            *share = term.effect.variance(m, &term.setting(interval_s));
        }
        let variance = row.dot(squares);
        // Relative variance of a variance from so many clusters: 2/(N/m − 1).
        let weight = 0.5 * (samples / m - 1.0) / (variance * variance);
        for i in 0..model.terms().len() {
            for j in 0..=i {
                matrix[(i, j)] += weight * row[i] * row[j];
                matrix[(j, i)] = matrix[(i, j)];
            }
        }
        m *= 2.0;
    }
    NormalEquations::new(&matrix, &Vector::zeros(), model.terms().len()).ok()
}
