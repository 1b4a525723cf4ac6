//! Columns that are tried as covariates although nobody asked for them.

use super::{field::Field, quantum::Quantum};

/// The columns from a place on whose values never stop the reading. A value that is no number, or far beyond the first
/// ones, is a flaw of its column, which is then not tried.
#[derive(Clone, Debug)]
pub(super) struct TriedColumns {
    /// The place of the first column.
    pub(super) first: usize,
    columns: Vec<TriedColumn>,
}

#[derive(Clone, Copy, Debug)]
struct TriedColumn {
    step: f64,
    last: i32,
    flawed: bool,
}

impl TriedColumns {
    /// The columns with these first values, which follow `first` other ones.
    pub(super) fn new<'a>(first: usize, heads: impl Iterator<Item = &'a [f64]>) -> Self {
        let column = |head: &[f64]| TriedColumn {
            step: step(head),
            last: 0,
            flawed: false,
        };
        Self {
            first,
            columns: heads.map(column).collect(),
        }
    }

    /// The value as a count, or `None` if the column is not one of these.
    #[inline]
    pub(super) fn count<F: Field>(&mut self, column: usize, value: &F) -> Option<i32> {
        let column = self.columns.get_mut(column.checked_sub(self.first)?)?;
        let count = value
            .number()
            .map_or(f64::NAN, |number| number / column.step);
        // Counts stay below half the range, so that their differences do not saturate.
        if count.abs() < f64::from(1 << 30) {
            column.last = count.round() as i32;
        } else {
            column.flawed = true;
        }
        Some(column.last)
    }

    /// The quantum of every column, and whether the column has a flaw.
    pub(super) fn quanta(&self) -> impl Iterator<Item = (Quantum, bool)> {
        self.columns
            .iter()
            .map(|column| (Quantum::with_step(column.step), column.flawed))
    }
}

/// The size of a count: a power of two that leaves room for 16 times the largest of the first values.
fn step(head: &[f64]) -> f64 {
    let largest = head
        .iter()
        .fold(1.0, |largest: f64, value| largest.max(value.abs()));
    2f64.powi(largest.log2().ceil() as i32 - 26)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_resolved_far_below_their_noise_and_flaws_are_remembered() {
        let heads: [&[f64]; 2] = [&[25.0, 25.0625], &[-1200.0]];
        let mut columns = TriedColumns::new(3, heads.into_iter());
        assert_eq!(columns.count(2, &25.0), None);
        let step = 2f64.powi(-21);
        assert_eq!(columns.count(3, &25.0625), Some((25.0625 / step) as i32));
        assert_eq!(columns.count(4, &-1201.0), Some(-1201 << 15));
        assert_eq!(columns.count(4, &f64::NAN), Some(-1201 << 15));
        let quanta: Vec<_> = columns.quanta().collect();
        let steps = [step, 2f64.powi(-15)].map(Quantum::with_step);
        assert_eq!(quanta, [(steps[0], false), (steps[1], true)]);
    }
}
