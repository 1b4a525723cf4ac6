//! What a figure shows of a record: its Allan deviation or its spectrum.

use allanite::Comparison;
use allanite_log::{BINS, OCTAVES, unit::Unit};
use serde::Serialize;

/// What a figure shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Quantity {
    /// Allan deviations over averaging times.
    Deviation,
    /// Roots of power spectral densities over frequencies.
    #[serde(rename = "spectrum")]
    Density,
}

/// An octave or a bin beside a model, in squares of what is drawn.
pub(super) struct Row {
    pub(super) x: f64,
    pub(super) measured: f64,
    pub(super) model: f64,
    pub(super) z: f64,
}

impl Quantity {
    /// Both, in the order in which they are drawn.
    pub const ALL: [Self; 2] = [Self::Deviation, Self::Density];

    /// The name of the quantity.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Deviation => "Allan deviation",
            Self::Density => "spectrum",
        }
    }

    /// The name in a drawing and on the command line.
    pub const fn class(self) -> &'static str {
        match self {
            Self::Deviation => "deviation",
            Self::Density => "spectrum",
        }
    }

    /// The title of the horizontal axis.
    pub const fn across(self) -> &'static str {
        match self {
            Self::Deviation => "averaging time τ",
            Self::Density => "frequency, Hz",
        }
    }

    /// The name of the horizontal coordinate, and its unit.
    pub const fn coordinate(self) -> (&'static str, &'static str) {
        match self {
            Self::Deviation => ("averaging time τ", "s"),
            Self::Density => ("frequency", "Hz"),
        }
    }

    /// The title of the vertical axis, without the unit.
    pub const fn up(self) -> &'static str {
        match self {
            Self::Deviation => "Allan deviation σ",
            Self::Density => "√density",
        }
    }

    /// What the worst point of a figure is called.
    pub const fn point(self) -> &'static str {
        match self {
            Self::Deviation => "octave",
            Self::Density => "bin",
        }
    }

    /// The unit of the vertical axis.
    pub fn unit(self, unit: Unit) -> String {
        match self {
            Self::Deviation => unit.to_string(),
            Self::Density => format!("{unit}/√Hz"),
        }
    }

    /// The octaves or the bins of a comparison, with ascending averaging times or frequencies.
    pub(super) fn rows(self, comparison: &Comparison<OCTAVES, BINS>) -> Vec<Row> {
        match self {
            Self::Deviation => comparison
                .octaves
                .iter()
                .map(|octave| Row {
                    x: octave.tau_s,
                    measured: octave.measured,
                    model: octave.model,
                    z: octave.z,
                })
                .collect(),
            Self::Density => {
                let bins = comparison.bins.iter().map(|compared| Row {
                    x: compared.bin.frequency_hz,
                    measured: compared.bin.density,
                    model: compared.model,
                    z: compared.z,
                });
                let mut rows: Vec<Row> = bins.collect();
                rows.sort_by(|one, other| one.x.total_cmp(&other.x));
                rows
            }
        }
    }

    /// The sum of the squared residuals of a comparison, in those octaves or bins that another one has as well.
    pub fn squared_error(
        self,
        comparison: &Comparison<OCTAVES, BINS>,
        other: &Comparison<OCTAVES, BINS>,
    ) -> f64 {
        let others = self.rows(other);
        let is_in_both = |row: &Row| others.iter().any(|other| other.x == row.x);
        let rows = self.rows(comparison).into_iter().filter(is_in_both);
        rows.map(|row| row.z * row.z).sum()
    }
}
