//! Lost samples that a filter of HDF5 turned into numbers.
//!
//! The filter scale-offset, number 6, packs the floats of a chunk as whole steps above the lowest one, and has no code for NaN: HDF5
//! 2.0 reads each as the lowest value of its chunk.

use super::arrays::Values;
use crate::failure::one_line;
use hdf5_pure::Dataset;

const SCALE_OFFSET: u16 = 6;

/// The data sets in which the lowest value of chunks occurs again and again.
#[derive(Default)]
pub(super) struct Lowest(Vec<String>);

impl Lowest {
    /// Looks at a data set that was read. The highest values of its chunks show how often noise in such steps repeats an extreme.
    pub(super) fn look(&mut self, place: &str, dataset: &Dataset, values: &Values) {
        let Values::Float(values) = values else {
            return;
        };
        if !dataset.filters().contains(&SCALE_OFFSET) {
            return;
        }
        let length = dataset.chunk_shape().ok().flatten().unwrap_or_default();
        // Chunks that divide the columns too do not lie one behind the other.
        let (Ok(shape), true) = (dataset.shape(), !length.is_empty()) else {
            return;
        };
        let is_whole = length.get(1..) == shape.get(1..);
        let length: u64 = length.iter().product();
        let length = if is_whole { length } else { u64::MAX };
        let length = usize::try_from(length).unwrap_or(usize::MAX).max(1);
        let (mut lowest, mut highest) = (0, 0);
        for chunk in values.chunks(length) {
            lowest += again(chunk, f64::min);
            highest += again(chunk, f64::max);
        }
        if lowest > highest {
            self.0.push(one_line(place));
        }
    }

    pub(super) fn note(&self) -> Option<String> {
        (!self.0.is_empty()).then(|| {
            format!(
                "the filter scale-offset of {} keeps no NaN: lost samples may stand as the lowest value of their chunk, which occurs \
                 repeatedly",
                self.0.join(", ")
            )
        })
    }
}

/// How often the extreme of a chunk occurs again.
fn again(chunk: &[f64], extreme: fn(f64, f64) -> f64) -> usize {
    let extreme = chunk.iter().copied().fold(f64::NAN, extreme);
    let all = chunk.iter().filter(|&&value| value == extreme).count();
    all.saturating_sub(1)
}
