//! The spans of a plot's panels, and the positions of values in them. They are the same in a terminal,
//! in a file and on a page.

use super::ticks;
use crate::log::{BINS, OCTAVES};
use allanite::{Comparison, comparison::ComparedOctave};

/// The span of a logarithmic axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// The lowest value, which is above zero.
    pub low: f64,
    /// The highest value.
    pub high: f64,
}

impl Span {
    /// The position of a value, from 0 at the low end to 1 at the high end.
    pub fn along(&self, value: f64) -> f64 {
        (value / self.low).ln() / (self.high / self.low).ln()
    }

    /// Round numbers within the span.
    pub fn ticks(&self) -> Vec<f64> {
        ticks::logarithmic(self.low, self.high)
    }

    /// The ticks, labelled as numbers.
    pub fn labelled(&self) -> Vec<(f64, String)> {
        let labelled = |value| (value, ticks::plain(value));
        self.ticks().into_iter().map(labelled).collect()
    }

    /// The ticks, labelled as times.
    pub fn times(&self) -> Vec<(f64, String)> {
        let labelled = |value| (value, ticks::time(value));
        self.ticks().into_iter().map(labelled).collect()
    }

    /// The span in another unit; `factor` is the size of the present unit in that unit.
    pub fn scaled(&self, factor: f64) -> Self {
        Self {
            low: factor * self.low,
            high: factor * self.high,
        }
    }
}

/// The spans of both panels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Averaging times, in seconds.
    pub tau_s: Span,
    /// Allan deviations, in rate units.
    pub sigma: Span,
    /// The panel of residuals reaches from −z to z standard errors.
    pub z: f64,
}

impl Frame {
    /// A frame with room for all octaves of these comparisons.
    pub fn of<'a>(
        comparisons: impl IntoIterator<Item = &'a Comparison<OCTAVES, BINS>> + Clone,
    ) -> Self {
        let octaves = || {
            let comparisons = comparisons.clone().into_iter();
            comparisons.flat_map(|comparison| &comparison.octaves)
        };
        let times = octaves().map(|octave| octave.tau_s);
        let variances = |octave: &ComparedOctave| [octave.measured, octave.model];
        let positive = octaves()
            .flat_map(variances)
            .filter(|variance| *variance > 0.0);
        let (first, last) = ends(times).unwrap_or((1.0, 2.0));
        let (low, high) = ends(positive.map(f64::sqrt)).unwrap_or((1.0, 1.0));
        // The span is at least a factor of 2.25, with a margin of 5 % at each end.
        let middle = (low * high).sqrt();
        let half = (high / low).sqrt().max(1.5) * 1.05;
        let sizes = octaves().map(|octave| octave.z.abs());
        Self {
            tau_s: Span {
                low: first,
                high: last.max(2.0 * first),
            },
            sigma: Span {
                low: middle / half,
                high: middle * half,
            },
            z: ticks::round_up(sizes.fold(3.0, f64::max)),
        }
    }

    /// The labelled ticks of the panel of residuals, from the top.
    pub fn residuals(&self) -> [(f64, String); 3] {
        [self.z, 0.0, -self.z].map(|z| match z > 0.0 {
            true => (z, format!("+{z}")),
            false => (z, format!("{z}").replace('-', "−")),
        })
    }

    /// The position of a residual, from 0 at the bottom to 1 at the top of its panel.
    pub fn up(&self, z: f64) -> f64 {
        0.5 * (z / self.z + 1.0)
    }
}

/// The smallest and the largest value, or `None` if there are none.
fn ends(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values.fold(None, |ends, value| {
        let (low, high) = ends.unwrap_or((value, value));
        Some((low.min(value), high.max(value)))
    })
}
