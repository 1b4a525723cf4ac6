//! Takes from an Allan curve what steps and a warm-up add to it.

use super::{
    BLOCKS,
    form::{COLUMNS, Form, MAX_SHIFTS},
    response::{Starts, allan_variance_of_step, allan_variance_of_warm_up, warm_up_response},
    shifts::{Shift, Shifts},
};
use crate::{
    curve::{Curve, Point},
    evidence::course::{Level, is_complete},
    numerics::{
        algebra::Vector,
        math,
        real::{Real, real},
    },
};

/// The share of an octave's variance that a correction leaves at least.
const LEAST: Real = 0.1;

/// The course of the means and of the columns of the shifts, as sums from the first block on.
struct Sums {
    /// The numbers of blocks that are present.
    present: [u32; BLOCKS + 1],
    means: [Real; BLOCKS + 1],
    columns: [[Real; BLOCKS + 1]; COLUMNS],
    /// The number of blocks.
    places: usize,
}

/// The mean squares of one octave, from block means.
#[derive(Clone, Copy, Default)]
struct MeanSquares {
    /// Of the differences as they are.
    measured: Real,
    /// Of the differences without the shifts.
    rest: Real,
    /// What the errors of the shifts take away on average.
    lost: Real,
}

/// Subtracts the shifts from a curve. The record has `time` samples, in blocks of `block_length`.
///
/// Octaves of a block and more are computed again from the means of the blocks: the difference between their mean
/// squares with and without the shifts is subtracted, which is exact from four blocks on. The estimates of the shifts have taken away
/// some noise as well, `Var(D_shift)` on average, which is added back. Shorter octaves lose the contribution of the
/// shifts themselves.
#[inline(never)]
pub(super) fn subtract<const K: usize>(
    curve: &mut Curve<K>,
    levels: &[Level],
    shifts: &Shifts,
    block_length: u32,
    time: u64,
) {
    let sums = Sums::new(levels, shifts, block_length);
    let corrected = |point: &Point| {
        if point.m >= block_length {
            let width = point.m.checked_div(block_length).unwrap_or(1);
            let Some(of) = sums.mean_squares(width as usize, shifts) else {
                return point.variance;
            };
            let rest = point.variance - 0.5 * (of.measured - of.rest);
            rest.max(0.25 * of.rest) + 0.5 * of.lost
        } else {
            let starts = Starts::new(point.m, time);
            let share = starts.number as Real / point.differences as Real;
            let added = allan_variance(&shifts.shifts, block_length, starts, time);
            point.variance - added * share
        }
    };
    let mut variances = [0.0; 30];
    for (variance, point) in variances.iter_mut().zip(curve.points()) {
        *variance = corrected(point).max(LEAST * LEAST * point.variance);
    }
    curve.change_variances(|k, variance| variances.get(k).copied().unwrap_or(variance));
}

/// The contribution of some shifts to an Allan variance of clusters shorter than a block: each alone, and products
/// where two have a part in the same difference.
fn allan_variance(shifts: &[Shift], block_length: u32, starts: Starts, time: u64) -> Real {
    let length = real(block_length);
    let at = |form: Form| match form {
        Form::Step { place, fraction } => (real(place) + fraction) * length,
        Form::WarmUp { .. } => 0.0,
    };
    let mut sum = 0.0;
    let mut rest = shifts;
    while let Some((shift, later)) = rest.split_first() {
        rest = later;
        match shift.form {
            Form::Step { .. } => {
                sum += allan_variance_of_step(starts.m, time, at(shift.form), shift.size);
            }
            Form::WarmUp { time_constant } => {
                let time_constant = time_constant * length;
                sum += allan_variance_of_warm_up(starts.m, time, time_constant, shift.size);
            }
        }
        for other in later {
            let (step, second) = match shift.form {
                Form::Step { .. } => (shift, other),
                Form::WarmUp { .. } => (other, shift),
            };
            let product: Real = starts
                .around(at(step.form))
                .map(|(j, response)| {
                    let start = j as Real * real(starts.distance);
                    response * response_at(second.form, start, at(second.form), starts, length)
                })
                .sum();
            sum += step.size * second.size * product / starts.number as Real;
        }
    }
    sum
}

/// The difference of cluster means that a form of size 1 makes from a start on.
fn response_at(form: Form, start: Real, at: Real, starts: Starts, length: Real) -> Real {
    match form {
        Form::Step { .. } => {
            let u = (at - start) / real(starts.m);
            if u < 1.0 {
                u.max(0.0)
            } else {
                (2.0 - u).max(0.0)
            }
        }
        Form::WarmUp { time_constant } => {
            let time_constant = time_constant * length;
            -math::exp(-start / time_constant) * warm_up_response(starts.m, time_constant)
        }
    }
}

impl Sums {
    fn new(levels: &[Level], shifts: &Shifts, block_length: u32) -> Self {
        let mut sums = Self {
            present: [0; BLOCKS + 1],
            means: [0.0; BLOCKS + 1],
            columns: [[0.0; BLOCKS + 1]; COLUMNS],
            places: 0,
        };
        let (mut present, mut mean) = (0_u32, 0.0);
        for (block, (count, total)) in
            (0..u32::MAX).zip(sums.present.iter_mut().zip(&mut sums.means))
        {
            (*count, *total) = (present, mean);
            let mut usable = levels
                .iter()
                .filter(|level| is_complete(level, block_length));
            if let Some(level) = usable.find(|level| level.place == block) {
                present = present.saturating_add(1);
                mean += level.mean;
                sums.places = (block as usize).saturating_add(1);
            }
        }
        for (p, column) in (0..2 * MAX_SHIFTS).zip(&mut sums.columns) {
            let Some(shift) = shifts.shifts.get(p / 2) else {
                break;
            };
            let mut total = 0.0;
            for (block, sum) in (0..u32::MAX).zip(column.iter_mut()) {
                *sum = total;
                total += shift.form.column(p % 2 == 1, block);
            }
        }
        sums
    }

    /// The mean squares for clusters of `width` blocks. `None` if no difference has all of its blocks.
    fn mean_squares(&self, width: usize, shifts: &Shifts) -> Option<MeanSquares> {
        let distance = (width / 4).max(1);
        let per_cluster = 1.0 / real(width as u32);
        let mut found = MeanSquares::default();
        let mut number = 0_u32;
        let mut start = 0_usize;
        loop {
            let middle = start.saturating_add(width);
            let end = middle.saturating_add(width);
            if end > self.places {
                break;
            }
            let difference = |sums: &[Real; BLOCKS + 1]| {
                let at = |i: usize| sums.get(i).copied().unwrap_or(0.0);
                (at(end) - 2.0 * at(middle) + at(start)) * per_cluster
            };
            let present = |i: usize| self.present.get(i).copied().unwrap_or(0);
            let whole = present(end).saturating_sub(present(start));
            if whole as usize == width.saturating_mul(2) {
                let measured = difference(&self.means);
                let columns: Vector<COLUMNS> =
                    Vector::from_fn(|p| self.columns.get(p).map_or(0.0, difference));
                let rest = measured - columns.dot(&shifts.coefficients);
                found.measured += measured * measured;
                found.rest += rest * rest;
                for p in 0..COLUMNS {
                    for q in 0..COLUMNS {
                        found.lost += shifts.covariance[(p, q)] * columns[p] * columns[q];
                    }
                }
                number = number.saturating_add(1);
            }
            start = start.saturating_add(distance);
        }
        (number > 0).then(|| {
            let share = 1.0 / real(number);
            MeanSquares {
                measured: found.measured * share,
                rest: found.rest * share,
                lost: found.lost * share,
            }
        })
    }
}
