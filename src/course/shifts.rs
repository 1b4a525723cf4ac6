//! Finds steps and warm-ups in the contrasts of block means, and estimates their sizes.

use super::{
    BLOCKS,
    contrasts::{BlockMeans, Contrasts, EXPLAINED},
    form::{COLUMNS, Form, MAX_SHIFTS, PER_SHIFT},
    slow_noise::{Needed, needed},
};
use crate::{
    list::{self, numbered},
    numerics::{
        algebra::{Triangle, Vector},
        cholesky, math,
        real::{Real, consts::SQRT_2, real},
    },
};
use heapless::Vec;

/// The number of places within a block at which a step is tried.
const FRACTIONS: u32 = 8;

/// A shift of the mean: a form and its size.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shift {
    pub(super) form: Form,
    /// The size in rate units, and its standard error with the time or the time constant free.
    pub(super) size: Real,
    pub(super) error: Real,
}

/// The shifts that were found, with what their sizes are worth.
pub(super) struct Shifts {
    pub(super) shifts: Vec<Shift, MAX_SHIFTS>,
    /// The coefficients of the columns: of the form and of its derivative, shift by shift.
    pub(super) coefficients: Vector<COLUMNS>,
    /// The covariance of the coefficients.
    pub(super) covariance: Triangle<9, 4>,
}

/// The largest standardised sizes of a step and of a warm-up.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct LargestShift {
    pub(super) step: Real,
    pub(super) warm_up: Real,
}

/// A form that was tried, with its size in standard errors.
#[derive(Clone, Copy)]
struct Tried {
    form: Form,
    z: Real,
}

/// The shifts of the mean that the noise of a model does not explain, whatever the sizes of its slow terms; `None` if
/// there are none, or if there are too few blocks. `squares` are the squared coefficients of the model.
///
/// A search under these coefficients finds the forms of possible shifts. The likelihood decides how many of them are
/// shifts ([`needed`]).
pub(super) fn shifts(
    means: &BlockMeans<'_>,
    squares: &[Real],
    largest: &mut LargestShift,
) -> Option<Shifts> {
    // Each part has the memory of its contrasts back before the next one begins.
    let forms = search(means, squares, largest)?;
    if forms.is_empty() {
        return None;
    }
    let Needed { number, squares } = needed(means, squares, &forms);
    let forms = forms.get(..number).filter(|forms| !forms.is_empty())?;
    estimate(means, &squares, forms)
}

/// The forms of possible shifts, the most significant first, until none is significant.
#[inline(never)]
fn search(
    means: &BlockMeans<'_>,
    squares: &[Real],
    largest: &mut LargestShift,
) -> Option<Vec<Form, MAX_SHIFTS>> {
    let mut contrasts = means.contrasts(squares)?;
    let mut forms: Vec<Form, MAX_SHIFTS> = Vec::new();
    while !forms.is_full() {
        let is_warm_up = |form: &Form| matches!(form, Form::WarmUp { .. });
        let step = contrasts.step();
        let warm_up = if forms.iter().any(is_warm_up) {
            None
        } else {
            contrasts.warm_up()
        };
        if forms.is_empty() {
            let size = |tried| contrasts.standardised(tried);
            *largest = LargestShift {
                step: step.map_or(0.0, size),
                warm_up: warm_up.map_or(0.0, size),
            };
        }
        let best = match (step, warm_up) {
            (Some(step), Some(warm_up)) if step.z * step.z < warm_up.z * warm_up.z => warm_up,
            (Some(step), _) => step,
            (None, Some(warm_up)) => warm_up,
            (None, None) => break,
        };
        let z = contrasts.standardised(best);
        if z * z <= best.form.limit_square() {
            break;
        }
        contrasts.remove_form(best.form);
        let _ = forms.push(best.form);
    }
    Some(forms)
}

/// The sizes of shifts, estimated together with a slope by generalised least squares.
#[inline(never)]
fn estimate(means: &BlockMeans<'_>, squares: &[Real], forms: &[Form]) -> Option<Shifts> {
    let mut contrasts = means.contrasts(squares)?;
    contrasts.remove_slope_of(means.model);
    contrasts.estimated(forms)
}

impl Contrasts {
    /// The standardised size of a form, reduced where what remains of the data scatters more than the model says.
    fn standardised(&self, tried: Tried) -> Real {
        let rest = self.data.norm_squared() - tried.z * tried.z;
        let left = self.count().saturating_sub(self.basis.len());
        let freedom = left.saturating_sub(1).max(1);
        let ratio = rest / real(freedom as u32);
        if ratio > 1.0 {
            tried.z / math::sqrt(ratio)
        } else {
            tried.z
        }
    }

    /// The most significant step.
    fn step(&self) -> Option<Tried> {
        let mut best: Option<Tried> = None;
        let mut before: Option<(u32, Vector<BLOCKS>)> = None;
        for &place in self.places.iter().skip(1) {
            let form = Form::Step {
                place,
                fraction: 0.0,
            };
            let column = self.orthogonal(&self.whitened(|block| form.mean(block)));
            // A step within a block is a mixture of those at its two ends.
            if let (Some((first, one)), Some(other)) = (&before, &column) {
                let (product, own) = (one.dot(other), [one.norm_squared(), other.norm_squared()]);
                let data = [one.dot(&self.data), other.dot(&self.data)];
                for part in 1..FRACTIONS {
                    let fraction = real(part) / real(FRACTIONS);
                    let rest = 1.0 - fraction;
                    let square = rest * rest * own[0]
                        + fraction * fraction * own[1]
                        + 2.0 * rest * fraction * product;
                    let along = rest * data[0] + fraction * data[1];
                    let form = Form::Step {
                        place: *first,
                        fraction,
                    };
                    keep_better(&mut best, form, along, square);
                }
            }
            if let Some(column) = &column {
                keep_better(
                    &mut best,
                    form,
                    column.dot(&self.data),
                    column.norm_squared(),
                );
            }
            before = column.map(|column| (place, column));
        }
        best
    }

    /// The most significant warm-up. The time constants reach from one block to half of the record.
    fn warm_up(&self) -> Option<Tried> {
        let mut best = None;
        let longest = 0.5 * real(self.places.last().copied()?);
        let mut time_constant = longest;
        while time_constant >= 1.0 {
            self.try_warm_up(time_constant, &mut best);
            time_constant /= SQRT_2;
        }
        let Form::WarmUp { time_constant } = best?.form else {
            return best;
        };
        // Steps of 4 % within one step of the grid.
        let fine = real(1.04);
        let mut factor = 1.0 / SQRT_2;
        while factor < SQRT_2 {
            let time_constant = time_constant * factor;
            if time_constant >= 1.0 && time_constant <= longest {
                self.try_warm_up(time_constant, &mut best);
            }
            factor *= fine;
        }
        best
    }

    fn try_warm_up(&self, time_constant: Real, best: &mut Option<Tried>) {
        let form = Form::WarmUp { time_constant };
        if let Some(column) = self.orthogonal(&self.whitened(|block| form.mean(block))) {
            keep_better(best, form, column.dot(&self.data), column.norm_squared());
        }
    }

    /// The sizes of shifts with these forms. `None` if they cannot be distinguished.
    fn estimated(&self, forms: &[Form]) -> Option<Shifts> {
        let number = forms.len().saturating_mul(PER_SHIFT).min(COLUMNS);
        let column = |p: usize| {
            let form = forms.get(p / PER_SHIFT)?;
            self.orthogonal(&self.whitened(|block| form.column(p % PER_SHIFT == 1, block)))
        };
        let column = |p: usize| column(p).unwrap_or(Vector::ZEROS);
        let mut normal: Triangle<9, 4> = Triangle::ZEROS;
        let mut right: Vector<COLUMNS> = Vector::ZEROS;
        let mut units: Vector<COLUMNS> = Vector::ZEROS;
        for p in 0..number {
            let own = column(p);
            let square = own.norm_squared();
            let unit = if square > 0.0 {
                1.0 / math::sqrt(square)
            } else {
                0.0
            };
            units.put(p, unit);
            right.put(p, own.dot(&self.data) * unit);
            for q in 0..p {
                normal.put((p, q), own.dot(&column(q)) * unit * units[q]);
            }
            // A derivative that the form explains, as at the last block, keeps the matrix regular and is unknown.
            normal.put((p, p), 1.0 + EXPLAINED * EXPLAINED);
        }
        if !cholesky::factor(&mut normal, number) {
            return None;
        }
        cholesky::forward(&normal, number, &mut right);
        cholesky::backward(&normal, number, &mut right);
        let mut found = Shifts {
            shifts: Vec::new(),
            coefficients: Vector::ZEROS,
            covariance: Triangle::ZEROS,
        };
        for p in 0..number {
            found.coefficients.put(p, right[p] * units[p]);
            let mut inverse: Vector<COLUMNS> = Vector::ZEROS;
            inverse.put(p, 1.0);
            cholesky::forward(&normal, number, &mut inverse);
            cholesky::backward(&normal, number, &mut inverse);
            for q in 0..=p {
                found
                    .covariance
                    .put((p, q), inverse[q] * units[p] * units[q]);
            }
        }
        found.shifts = list::fill(numbered(forms).map(|(i, form)| {
            let p = i.saturating_mul(PER_SHIFT);
            Shift {
                form: *form,
                size: found.coefficients[p],
                error: math::sqrt(found.covariance[(p, p)]),
            }
        }));
        Some(found)
    }
}

/// Keeps a form if it is more significant than the best one so far. `along` is its product with the data, and
/// `square` is its own square.
fn keep_better(best: &mut Option<Tried>, form: Form, along: Real, square: Real) {
    if square > 0.0 {
        let z = along / math::sqrt(square);
        if best.is_none_or(|best| z * z > best.z * best.z) {
            *best = Some(Tried { form, z });
        }
    }
}
