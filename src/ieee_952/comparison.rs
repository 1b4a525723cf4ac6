//! How far a coefficient lies above or below a limit.

use super::{
    Fit,
    estimate::{NAMES, Scale},
    memory::{Memory, consecutive},
    rounds::{CONVERGED, IsClear, USUAL, is_far, iterate},
    rows::Rows,
    tableau::Tableau,
    terms::{TERMS, sqrt},
};
use crate::{
    curve::Curve,
    numerics::real::{Real, real, single},
};

/// A limit at which the term alone would be this many times the curve in every octave is replaced by the lowest limit for
/// which this is so. The curve is as far below the one as below the other, and the square stays within the range of numbers.
/// Chosen by hand.
const BEYOND: f32 = 1e3;

/// The limits that are tried, each lower than the one before by this factor.
const ATTEMPTS: u8 = 12;
const LOWER: f32 = 1.0 / 16.0;

/// The place of a term among the five, by its name.
pub(crate) fn place(name: &str) -> Option<usize> {
    NAMES.iter().position(|names| names.0 == name)
}

/// The signed root of the likelihood ratio of a limit, in standard errors: positive if the curve asks for more than the limit.
///
/// The curve is fitted with the coefficient at the limit, with the covariance that the curve has there, and by the same
/// covariance with the coefficient free. χ² falls by the square. If the coefficient is at the limit, the root is nearly
/// normal with a variance of one (Wilks 1938), or nearer to zero where the others are at zero too (Chernoff 1954). Beyond eight
/// standard errors it is rough, because no plan asks for as much.
///
/// `None` if neither the covariance at the limit nor one at a lower limit that is out of the question is positive definite.
#[inline(never)]
pub(crate) fn above<const K: usize>(
    curve: &Curve<K>,
    fit: &Fit,
    term: usize,
    limit: Real,
) -> Option<Real> {
    let points = consecutive(curve.points());
    let mut memory = Memory::<K>::EMPTY;
    let (mut rows, reference) = memory.rows(points);
    rows.tolerance = single(fit.tolerance * fit.tolerance);
    let scale = Scale::new(reference, curve.interval_s(), rows.units);
    let root = single(limit / scale.root(term));
    let beyond = rows.beyond(term, BEYOND);
    // Not even its square may be beyond the range of numbers.
    let mut square = if root < sqrt(beyond) {
        root * root
    } else {
        beyond
    };
    let mut start = [0.0; TERMS];
    for (other, (start, own)) in (0..TERMS).zip(start.iter_mut().zip(&fit.coefficients)) {
        let root = single(own.value / scale.root(other));
        *start = root * root;
    }
    // A ramp far above the curve scatters so little that there is no covariance. The root falls with the limit, so that one
    // below zero at a lower limit is one here too.
    for attempt in 0..ATTEMPTS {
        if let Some(above) = compared(&mut rows, start, (term, square)) {
            return (attempt == 0 || above < 0.0).then_some(real(above));
        }
        square *= LOWER;
    }
    None
}

/// The signed root of the likelihood ratio where the square of a term is held.
#[inline(never)]
fn compared<const K: usize>(
    rows: &mut Rows<'_, K>,
    mut start: [f32; TERMS],
    held: (usize, f32),
) -> Option<f32> {
    let (term, square) = held;
    rows.held = held;
    if let Some(own) = start.get_mut(term) {
        *own = square;
    }
    let set = 1_u8.wrapping_shl(term as u32);
    let mut tableau = Tableau::EMPTY;
    let is_clear: IsClear<'_, K> = &|_, tableau, _| is_far(tableau, term, square);
    iterate(rows, &mut tableau, start, CONVERGED, [USUAL, set], is_clear)?;
    let (fall, is_above) = tableau.fall(term, square);
    let root = sqrt(fall);
    Some(if is_above { root } else { -root })
}

#[cfg(test)]
mod tests;
