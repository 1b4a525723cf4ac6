//! The curves of arrays alone, in the fewest steps: without integrity, spectrum, course and threads.

use super::{
    OCTAVES,
    arrays::Arrays,
    columns::AxisColumn,
    field::Field,
    quantum::{Quantum, Range},
    table::{Ended, RUN, Stop, Table, Visitor, visit_each},
};
use crate::failure::{Failure, Place};
use allanite::Accumulator;
use indicatif::ProgressBar;

/// The accumulator of every column, with the size of its counts. `progress` ends the work when it is ended itself.
///
/// # Errors
/// When a value is not a finite number.
pub fn accumulate(
    arrays: &Arrays<'_>,
    progress: &ProgressBar,
) -> Result<Vec<(Accumulator<OCTAVES>, f64)>, Failure> {
    let columns: Vec<AxisColumn> = (0..arrays.width())
        .map(|column| AxisColumn {
            axis: arrays.name(column),
            column,
        })
        .collect();
    let whole = vec![Quantum::WHOLE; columns.len()];
    let mut counts = Octaves::new(whole, true);
    if let Ended::AtTheLastRow = arrays.pass(&columns, &mut counts, progress)? {
        return Ok(counts.finish());
    }
    let mut ranges = Ranges(vec![Range::EMPTY; columns.len()]);
    arrays.pass(&columns, &mut ranges, progress)?;
    let quanta = columns.iter().zip(ranges.0).map(|(column, range)| {
        Quantum::of(range).ok_or_else(|| {
            let what = format!(
                "axis {}: the range of its values is impossible",
                column.axis
            );
            Place::file(arrays.path()).failure(what, "scale the values or remove the outliers")
        })
    });
    let mut rounded = Octaves::new(quanta.collect::<Result<_, _>>()?, false);
    arrays.pass(&columns, &mut rounded, progress)?;
    Ok(rounded.finish())
}

/// Finds the range of each column.
struct Ranges(Vec<Range>);

impl Visitor for Ranges {
    type Followed = ();

    fn visit<F: Field>(&mut self, axis: usize, value: F) -> Result<(), Stop> {
        self.0[axis].include(value.exact().map_err(Stop::Flaw)?);
        Ok(())
    }

    fn visit_run<F: Field>(&mut self, axis: usize, values: &[F]) -> Result<(), (usize, Stop)> {
        match F::floats(values) {
            Some(floats) => {
                self.0[axis].include_floats(&range_of(floats));
                Ok(())
            }
            None => visit_each(self, axis, values),
        }
    }
}

/// The range of finite floats, which are no counts. Eight lowest values side by side make it a loop over vectors.
fn range_of(floats: &[f64]) -> Range {
    const LANES: usize = 8;
    let mut lowest = [f64::INFINITY; LANES];
    let mut highest = [f64::NEG_INFINITY; LANES];
    let mut include = |chunk: &[f64]| {
        for ((low, high), &float) in lowest.iter_mut().zip(&mut highest).zip(chunk) {
            *low = if float < *low { float } else { *low };
            *high = if float > *high { float } else { *high };
        }
    };
    let (chunks, rest) = floats.as_chunks::<LANES>();
    chunks.iter().for_each(|chunk| include(chunk));
    include(rest);
    let low = lowest.into_iter().fold(f64::INFINITY, f64::min);
    let high = highest.into_iter().fold(f64::NEG_INFINITY, f64::max);
    Range::of_floats(low, high, false)
}

/// Accumulates counts.
struct Octaves {
    accumulators: Vec<Accumulator<OCTAVES>>,
    quanta: Vec<Quantum>,
    /// Whether a value that is no count ends the pass. It is rounded otherwise.
    only_counts: bool,
}

impl Octaves {
    fn new(quanta: Vec<Quantum>, only_counts: bool) -> Self {
        Self {
            accumulators: vec![Accumulator::new(); quanta.len()],
            quanta,
            only_counts,
        }
    }

    fn count<F: Field>(&self, axis: usize, value: &F) -> Result<i32, Stop> {
        if self.only_counts {
            return value.count().ok_or(Stop::NotCounts);
        }
        let quantum = &self.quanta[axis];
        Ok(quantum.count(quantum.relative(value.exact().map_err(Stop::Flaw)?)))
    }

    fn finish(self) -> Vec<(Accumulator<OCTAVES>, f64)> {
        let steps = self.quanta.iter().map(Quantum::step);
        self.accumulators.into_iter().zip(steps).collect()
    }
}

impl Visitor for Octaves {
    type Followed = ();

    fn visit<F: Field>(&mut self, axis: usize, value: F) -> Result<(), Stop> {
        value.number().map_err(Stop::Flaw)?;
        let count = self.count(axis, &value)?;
        self.accumulators[axis].push_slice(&[count]);
        Ok(())
    }

    fn visit_run<F: Field>(&mut self, axis: usize, values: &[F]) -> Result<(), (usize, Stop)> {
        let mut counts = [0; RUN];
        let counts = &mut counts[..values.len()];
        // Decimals end the first pass at once, and all others are rounded many at a time.
        let all = match F::floats(values).filter(|_| !self.only_counts) {
            Some(floats) => self.quanta[axis].count_all(floats, counts),
            None => false,
        };
        if !all {
            for (place, (count, value)) in counts.iter_mut().zip(values).enumerate() {
                *count = self.count(axis, value).map_err(|stop| (place, stop))?;
            }
        }
        self.accumulators[axis].push_slice(counts);
        Ok(())
    }
}
