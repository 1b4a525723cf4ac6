//! How long a record must be before an effect can be measured.

use crate::{
    limits::SHOWN_IN_80,
    list::numbered,
    numerics::{
        nnls::{Matrix, NormalEquations, PassiveSet, Vector},
        real::{Real, real},
    },
    theory::model::Model,
};

/// The length of the longest record that is considered, in samples: that of the longest octave.
const LONGEST: Real = (1_u64 << 30) as Real;

/// The length, in seconds, of a record in which effect `i` would be measured. The present length is
/// doubled as often as needed. The effect is measured where its square exceeds half the width of its 95
/// % interval in four of five records, with `square` for this effect and `squares` for the others. No term is taken for
/// absent, because a longer record shows some that this one does not. `None` if no length is enough.
/// `cargo xtask study limits --promises` counts how many lengths come true.
///
/// The standard errors are those of independent octaves of `N/m − 1` clusters each. This is a
/// compromise: overlapping estimates gain information, and their correlation takes some of it away.
#[inline(never)]
pub(crate) fn record_length_s(
    i: usize,
    square: Real,
    squares: &Vector,
    free: &PassiveSet,
    model: &Model,
    interval_s: Real,
    samples: Real,
) -> Option<Real> {
    let mut assumed = *squares;
    assumed.put(i, square);
    let count = model.terms().len();
    let with = (0..count).fold(free.with(i), |set, j| set.with(j));
    let mut equations = NormalEquations::EMPTY;
    // The equations are `samples · Σ q/2m − Σ q/2`, where q is an octave's share. Each doubling adds an
    // octave.
    let (mut growing, mut fixed): (Matrix, Matrix) = (Matrix::ZEROS, Matrix::ZEROS);
    let (mut m, mut samples) = (1.0, 2.0 * samples);
    while samples <= LONGEST {
        while samples / m >= 4.0 {
            let mut row: Vector = Vector::zeros();
            for (j, term) in numbered(model.terms().iter()) {
                row.put(j, term.effect.variance(m, &term.sampled_shape(interval_s)));
            }
            let variance = row.dot(&assumed);
            // The variance of a variance from N/m clusters, relative to its square, is 2/(N/m − 1).
            let weight = 0.5 / (variance * variance);
            for a in 0..count {
                for b in 0..=a {
                    let share = weight * row[a] * row[b];
                    growing.put((a, b), growing[(a, b)] + share / m);
                    fixed.put((a, b), fixed[(a, b)] + share);
                }
            }
            m *= 2.0;
        }
        let set = equations.set(count, &|a, row| {
            for b in 0..=a {
                row.put(b, samples * growing[(a, b)] - fixed[(a, b)]);
            }
            0.0
        });
        set.ok()?;
        let variance = equations.variance(i, &with);
        if variance.is_some_and(|variance| square * square > real(SHOWN_IN_80) * variance) {
            return Some(samples * interval_s);
        }
        samples *= 2.0;
    }
    None
}

#[cfg(test)]
mod tests;
