//! The curve as a CSV table, with deviations in rad/s.

use super::characterisation::Characterisation;
use crate::command::output::cell::cell;
use csv::{QuoteStyle, WriterBuilder};

/// The comment that explains the columns.
const COMMENT: &str = "# deviations in rad/s; lower and upper: 95 % interval of each octave; model: that of the \
                       fitted model; overbound: white noise and random walk above every upper limit\n";

/// The table of every octave of every axis: the measured Allan deviation, its 95 % interval, the best
/// fit and the overbound.
pub(super) fn table(known: &Characterisation) -> Result<String, csv::Error> {
    let columns = [
        "axis",
        "tau_s",
        "m",
        "differences",
        "deviation",
        "lower",
        "upper",
        "model",
        "overbound",
    ];
    // Names are quoted, so that none of them is taken for a comment or a number.
    let mut writer = WriterBuilder::new()
        .quote_style(QuoteStyle::NonNumeric)
        .from_writer(COMMENT.as_bytes().to_vec());
    writer.write_record(columns)?;
    for axis in &known.axes {
        for octave in &axis.octaves {
            writer.write_record([
                cell(&axis.name),
                octave.tau_s.to_string(),
                octave.m.to_string(),
                octave.differences.to_string(),
                octave.deviation.to_string(),
                octave.lower.to_string(),
                octave.upper.to_string(),
                octave.model.to_string(),
                octave.overbound.to_string(),
            ])?;
        }
    }
    let bytes = writer.into_inner().map_err(|error| error.into_error())?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}
