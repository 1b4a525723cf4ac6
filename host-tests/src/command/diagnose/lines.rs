//! The lines of a last model: how narrow each one is, and which of them are harmonics of one fundamental.

use crate::{
    comb::{self, Comb},
    command::output::{number::number, words},
    log::{BINS, OCTAVES},
};
use allanite::{
    Error, Observed,
    diagnosis::{Step, line_width},
    effect::{Effect, Resonance, Sinusoid},
};

/// The standard errors from the middle of a 95 % interval to its end.
const TWO_SIDED_95: f64 = 1.959_964;

/// A sinusoid of a model.
pub(crate) struct Line {
    /// The place of the sinusoid in the model.
    pub(crate) place: usize,
    pub(crate) frequency_hz: f64,
    pub(crate) lower_hz: f64,
    pub(crate) upper_hz: f64,
    pub(crate) amplitude: f64,
    /// The width that a resonance in the place of the sinusoid does not exceed with a probability of 95 %.
    pub(crate) narrower_than_hz: Option<f64>,
}

/// The fitted sinusoids of a step, in the order of the model.
pub(super) fn lines(
    observed: Observed<'_, OCTAVES, BINS>,
    step: &Step<OCTAVES, BINS>,
) -> Result<Vec<Line>, Error> {
    let name = Sinusoid.description().name;
    let fitted = step.fit.shape.iter().filter(|shape| {
        let term = step.model.terms().get(shape.term);
        term.is_some_and(|term| term.effect.name() == name)
    });
    let line = |shape: &allanite::fit::ShapeEstimate| {
        let (place, tolerance) = (shape.term, step.fit.tolerance);
        let width = line_width(observed, &step.model, place, &Resonance, tolerance)?;
        Ok(Line {
            place,
            frequency_hz: shape.value,
            lower_hz: shape.lower,
            upper_hz: shape.upper,
            amplitude: step.fit.coefficients[place].value,
            narrower_than_hz: width,
        })
    };
    fitted.map(line).collect()
}

/// The combs among the lines of a record with this sample rate. A line whose frequency has no finite interval is not in
/// a comb, and neither is the alias of a frequency above half the sample rate, because a line is fitted below it.
pub(super) fn combs(lines: &[Line], rate_hz: f64) -> Vec<Comb> {
    let as_seen = |line: &Line| comb::Line {
        frequency_hz: line.frequency_hz,
        error_hz: (line.upper_hz - line.lower_hz) / (2.0 * TWO_SIDED_95),
    };
    let seen: Vec<comb::Line> = lines.iter().map(as_seen).collect();
    comb::combs(&seen, rate_hz)
}

/// What each comb consists of, one sentence each.
pub(super) fn comb_notes(lines: &[Line], combs: &[Comb]) -> Vec<String> {
    let note = |comb: &Comb| {
        let frequency = |(line, _): &(usize, u32)| number(lines[*line].frequency_hz);
        let frequencies = words::list_of(comb.members.iter().map(frequency).collect());
        let origin = match comb.mains_hz {
            Some(_) => "which come in through wires or the supply",
            None => "which one source makes, such as a motor or a clock",
        };
        format!(
            "the sinusoids at {frequencies} Hz are one comb: {}, {origin}",
            comb_words(comb)
        )
    };
    combs.iter().map(note).collect()
}

/// A comb in words: `6.100 Hz and 2 harmonics`, `50 Hz mains and 2 harmonics`.
pub(crate) fn comb_words(comb: &Comb) -> String {
    let first = match comb.mains_hz {
        Some(mains_hz) => format!("{mains_hz} Hz mains"),
        None => format!("{} Hz", number(comb.fundamental_hz)),
    };
    let orders: Vec<u32> = comb
        .members
        .iter()
        .skip(1)
        .map(|(_, order)| *order)
        .collect();
    let consecutive = orders.iter().zip(2..).all(|(order, next)| *order == next);
    match orders.as_slice() {
        [2] => format!("{first} and 1 harmonic"),
        orders if consecutive => format!("{first} and {} harmonics", orders.len()),
        orders => {
            let orders: Vec<String> = orders.iter().map(u32::to_string).collect();
            format!("{first} and {} times as much", orders.join(", "))
        }
    }
}
