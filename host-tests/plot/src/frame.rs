//! The spans of a plot's panels, and the positions of values in them. They are the same in a terminal,
//! in a file and on a page.

use super::{quantity::Quantity, ticks};
use allanite::Comparison;
use allanite_log::{BINS, OCTAVES};

/// Residuals up to about this many standard errors have a linear scale, and larger ones a logarithmic one, so that
/// both a residual of thousands and what remains when it is gone can be seen on the same scale. Chosen by hand.
const LINEAR: f64 = 3.0;

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

/// The spans of a panel of a curve and of the panel of its residuals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// What is shown.
    pub quantity: Quantity,
    /// Averaging times in seconds, or frequencies in Hz.
    pub x: Span,
    /// Deviations in rate units, or roots of densities in rate units per √Hz.
    pub y: Span,
    /// The panel of residuals reaches from −z to z standard errors.
    pub z: f64,
}

impl Frame {
    /// A frame with room for all octaves, or all bins, of these comparisons.
    pub fn of<'a>(
        quantity: Quantity,
        comparisons: impl IntoIterator<Item = &'a Comparison<OCTAVES, BINS>>,
    ) -> Self {
        let rows = comparisons
            .into_iter()
            .flat_map(|comparison| quantity.rows(comparison));
        let rows: Vec<_> = rows.collect();
        let squares = rows.iter().flat_map(|row| [row.measured, row.model]);
        let positive = squares.filter(|square| *square > 0.0);
        let (first, last) = ends(rows.iter().map(|row| row.x)).unwrap_or((1.0, 2.0));
        let (low, high) = ends(positive.map(f64::sqrt)).unwrap_or((1.0, 1.0));
        // The span is at least a factor of 2.25, with a margin of 5 % at each end.
        let middle = (low * high).sqrt();
        let half = (high / low).sqrt().max(1.5) * 1.05;
        let sizes = rows.iter().map(|row| row.z.abs());
        Self {
            quantity,
            x: Span {
                low: first,
                high: last.max(2.25 * first),
            },
            y: Span {
                low: middle / half,
                high: middle * half,
            },
            z: ticks::round_up(sizes.fold(LINEAR, f64::max)),
        }
    }

    /// The ticks of the horizontal axis.
    pub fn across(&self) -> Vec<(f64, String)> {
        match self.quantity {
            Quantity::Deviation => self.x.times(),
            Quantity::Density => self.x.labelled(),
        }
    }

    /// The labelled ticks of the panel of residuals, from the top.
    pub fn residuals(&self) -> Vec<(f64, String)> {
        // A power of ten next to the end would touch its label.
        let powers = (1..).map(|exponent| 10_f64.powi(exponent));
        let sizes = powers.take_while(|power| 3.0 * power <= self.z);
        let mut sizes: Vec<f64> = sizes.chain([self.z]).collect();
        let below: Vec<f64> = sizes.iter().map(|z| -z).collect();
        sizes.reverse();
        let all = sizes.into_iter().chain([0.0]).chain(below);
        all.map(|z| match z > 0.0 {
            true => (z, format!("+{z}")),
            false => (z, format!("{z}").replace('-', "−")),
        })
        .collect()
    }

    /// The position of a residual, from 0 at the bottom to 1 at the top of its panel.
    pub fn up(&self, z: f64) -> f64 {
        0.5 * ((z / LINEAR).asinh() / (self.z / LINEAR).asinh() + 1.0)
    }
}

/// The smallest and the largest value, or `None` if there are none.
pub(super) fn ends(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values.fold(None, |ends, value| {
        let (low, high) = ends.unwrap_or((value, value));
        Some((low.min(value), high.max(value)))
    })
}
