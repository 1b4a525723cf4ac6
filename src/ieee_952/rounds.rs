//! Rounds of covariance and solution.

use super::{
    goodness::birge_ratio,
    rows::Rows,
    tableau::Tableau,
    terms::{TERMS, is_positive, positive},
};
use crate::limits::CHI_SQUARED_95;

/// The most rounds of covariance and solution. Of curves that the five terms explain, a twentieth has not converged by then,
/// and hardly differs.
const ROUNDS: u8 = 5;

/// A curve whose χ² divided by this is still not explained by chance is not explained at all.
const BEYOND_CHANCE: f32 = 2.0;

/// The fall of χ² beyond which a limit is too far from the curve for any plan: eight standard errors.
const FAR: f32 = 64.0;

/// The falls of χ², as multiples of the one that is significant, below and above which a term is clearly absent or there.
const ABSENT: f32 = 0.4;
const THERE: f32 = 3.0;

/// Whether the equations of a round, whose solution lets the squared residuals fall by this, leave no doubt about what the rounds
/// are to tell. Each question is a function of its own, so that an image links those that it asks.
pub(super) type IsClear<'a, const K: usize> = &'a dyn Fn(&Rows<'_, K>, &Tableau, f32) -> bool;

/// Whether no coefficients explain the curve.
#[inline(never)]
fn is_hopeless<const K: usize>(rows: &Rows<'_, K>, tableau: &Tableau, fall: f32) -> bool {
    let free = tableau.free().count_ones() as usize;
    let degrees = rows.rows.len().saturating_sub(free);
    1.0 < birge_ratio((rows.squared() - fall) / BEYOND_CHANCE, degrees)
}

/// Whether the curve is far from this square of a term, which is held.
pub(super) fn is_far(tableau: &Tableau, term: usize, square: f32) -> bool {
    FAR < tableau.fall(term, square).0
}

/// Whether a term, which is held at zero, is clearly absent or there.
pub(super) fn is_certain(tableau: &Tableau, term: usize) -> bool {
    let mut free = *tableau;
    let fall = free.solve(0, 0) / CHI_SQUARED_95 as f32;
    fall < ABSENT || (free.has(term) && THERE < fall)
}

/// The terms that most records have, which the solution tries first: quantization, white noise and flicker noise.
pub(super) const USUAL: u8 = 0b111;

/// The rounds end when the relative change of the model is smaller than this.
pub(super) const CONVERGED: f32 = 3e-3;

/// The squared coefficients for independent octaves.
#[inline(never)]
pub(super) fn begin<const K: usize>(rows: &mut Rows<'_, K>, tableau: &mut Tableau) -> [f32; TERMS] {
    rows.weigh_independent();
    rows.set_equations(None, tableau);
    tableau.solve(USUAL, 0);
    tableau.squares()
}

/// Alternates between the covariance at a model and the solution with it, until the relative change of the model is smaller
/// than `converged` or it is clear what the rounds are to tell. The terms of `held` stay at zero, and those of `guess` are tried first. The weights are those of the last round. `None` if the covariance is not positive definite, or if a
/// solution has no term.
///
/// The changes of rounds that swing to and fro, or that creep, have a ratio, and the next round starts where it leads (Aitken
/// 1926), as in the general fit.
#[inline(never)]
pub(super) fn iterate<const K: usize>(
    rows: &mut Rows<'_, K>,
    tableau: &mut Tableau,
    start: [f32; TERMS],
    converged: f32,
    [guess, held]: [u8; 2],
    is_clear: IsClear<'_, K>,
) -> Option<()> {
    let (mut assumed, mut stride) = (start, 1.0);
    for round in 0..ROUNDS {
        if !assumed.iter().any(|square| is_positive(*square)) {
            return None;
        }
        rows.set_models(&assumed);
        if !rows.weigh() {
            return None;
        }
        rows.set_equations(None, tableau);
        let fall = tableau.solve(guess, held);
        if round > 0 && is_clear(rows, tableau, fall) {
            break;
        }
        let mut squares = tableau.squares();
        if let Some(square) = squares.get_mut(rows.held.0) {
            *square += rows.held.1;
        }
        let (largest, ratio) = rows.change(&squares);
        if largest < converged {
            break;
        }
        if round > 0 {
            stride /= 1.0 - within(ratio, f32::MIN, 0.5);
            stride = within(stride, 0.3, 2.0);
        }
        for (from, to) in assumed.iter_mut().zip(squares) {
            // However far a step goes, it loses no term that both ends of it have.
            let least = 0.5 * within(to, 0.0, *from);
            *from = within(*from + (to - *from) * stride, least, f32::INFINITY);
        }
    }
    Some(())
}

/// The number, or the limit that it lies beyond.
#[inline(never)]
fn within(number: f32, least: f32, most: f32) -> f32 {
    if number < least {
        least
    } else if most < number {
        most
    } else {
        number
    }
}

/// Finds the squared coefficients by rounds of covariance and solution, and returns χ². `None` if the covariance is not
/// positive definite.
#[inline(never)]
pub(super) fn solve<const K: usize>(
    rows: &mut Rows<'_, K>,
    tableau: &mut Tableau,
    squares: &mut [f32; TERMS],
) -> Option<f32> {
    iterate(rows, tableau, *squares, CONVERGED, [USUAL, 0], &is_hopeless)?;
    *squares = tableau.squares();
    let (gradient, residuals) = rows.residuals(squares);
    let fall = tableau.refine(squares, &gradient);
    let chi_squared = residuals - fall - rows.excess(squares);
    Some(positive(chi_squared))
}
