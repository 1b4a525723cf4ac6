//! The spectrum and the course of a record as CSV tables, in radians.

use super::characterisation::Characterisation;
use crate::command::output::cell::cell;
use csv::{QuoteStyle, WriterBuilder};

/// The comment that explains the columns of the spectrum.
const SPECTRUM: &str = "# density: root of the one-sided power spectral density, in rad/s/sqrt(Hz), with its standard \
                        error; expected: that of the model; z: measured less expected density, in standard \
                        errors; block: samples in a block mean\n";

/// The comment that explains the columns of the course.
const COURSE: &str = "# mean: mean rate of a part of the record, in rad/s, less a constant if the log has fractions; \
                      noise: root of half the mean square of the differences of neighbouring samples, in rad/s\n";

/// The bins of every axis, or `None` if there are none.
pub(super) fn spectrum(known: &Characterisation) -> Result<Option<String>, csv::Error> {
    let columns = [
        "axis",
        "frequency_hz",
        "density",
        "standard_error",
        "expected",
        "z",
        "segments",
        "block",
    ];
    let rows = known.axes.iter().flat_map(|axis| {
        axis.bins.iter().map(|bin| {
            [
                cell(&axis.name),
                bin.frequency_hz.to_string(),
                bin.density.to_string(),
                bin.standard_error.to_string(),
                bin.expected.to_string(),
                bin.z.to_string(),
                bin.segments.to_string(),
                bin.block.to_string(),
            ]
        })
    });
    table(SPECTRUM, columns, rows)
}

/// The blocks of every axis over time, or `None` if there are none.
pub(super) fn course(known: &Characterisation) -> Result<Option<String>, csv::Error> {
    let columns = ["axis", "start_s", "duration_s", "samples", "mean", "noise"];
    let rows = known.axes.iter().flat_map(|axis| {
        axis.blocks.iter().map(|block| {
            [
                cell(&axis.name),
                block.start_s.to_string(),
                block.duration_s.to_string(),
                block.samples.to_string(),
                block.mean.to_string(),
                block.noise.to_string(),
            ]
        })
    });
    table(COURSE, columns, rows)
}

/// A table below a comment, or `None` without rows.
fn table<const N: usize>(
    comment: &str,
    columns: [&str; N],
    rows: impl Iterator<Item = [String; N]>,
) -> Result<Option<String>, csv::Error> {
    let mut rows = rows.peekable();
    if rows.peek().is_none() {
        return Ok(None);
    }
    // Names are quoted, so that none of them is taken for a comment or a number.
    let mut writer = WriterBuilder::new()
        .quote_style(QuoteStyle::NonNumeric)
        .from_writer(comment.as_bytes().to_vec());
    writer.write_record(columns)?;
    for row in rows {
        writer.write_record(row)?;
    }
    let bytes = writer.into_inner().map_err(|error| error.into_error())?;
    Ok(Some(String::from_utf8_lossy(&bytes).into_owned()))
}
