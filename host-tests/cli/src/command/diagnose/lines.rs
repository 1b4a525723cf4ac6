//! The lines of a last model: how narrow each one is, and which of them are harmonics of one fundamental.

use allanite::{
    Error, Record,
    diagnosis::{Step, line_width},
    effect::{Effect, Resonance, Sinusoid},
};
use allanite_host::{
    comb::{self, Comb},
    number::number,
    words,
};
use allanite_log::{BINS, OCTAVES};

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
    /// Whether the model has nothing else near the frequency, and explains the spectrum there. Where a frequency wanders
    /// during the record, one sinusoid leaves a rest, which a resonance or a drifting oscillation explains or nothing does.
    pub(crate) is_alone: bool,
}

/// The relative rounding of a frequency that is half the sample rate.
const ROUNDING: f64 = 1e-6;

/// How near to a line, relative to its frequency, a rest of the spectrum may be a part of it. Chosen by hand: the speed of
/// an engine or a fan wanders by a few per cent.
const NEAR: f64 = 0.05;

/// The fitted sinusoids of a step, in the order of the model.
pub(super) fn lines(
    observed: Record<'_, OCTAVES, BINS>,
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
            is_alone: is_alone(step, shape.value),
        })
    };
    fitted.map(line).collect()
}

/// Whether a step has no oscillation but sinusoids near a frequency, and no difference from the spectrum there.
fn is_alone(step: &Step<OCTAVES, BINS>, frequency_hz: f64) -> bool {
    let reaches = |from_hz: f64, to_hz: f64| {
        from_hz <= (1.0 + NEAR) * frequency_hz && to_hz >= (1.0 - NEAR) * frequency_hz
    };
    let mut humps = step.model.terms().iter().filter(|term| {
        let description = term.effect.description();
        let mut parameters = description.parameters.iter();
        let is_narrow = parameters
            .next()
            .is_some_and(|first| first.name == "frequency_hz");
        is_narrow
            && description.replaces.is_none()
            && description.name != Sinusoid.description().name
    });
    let mut bands = step.comparison.bands().into_iter();
    !humps.any(|term| reaches(term.parameters[0], term.parameters[0]))
        && !bands.any(|band| reaches(band.from_hz, band.to_hz))
}

/// The combs among the lines of a record with this sample rate. A line whose frequency has no finite interval is not in
/// a comb, and neither is the alias of a frequency above half the sample rate, because a line is fitted below it.
pub(super) fn combs(lines: &[Line], rate_hz: f64) -> Vec<Comb> {
    let as_seen = |line: &Line| comb::Line {
        frequency_hz: line.frequency_hz,
        error_hz: (line.upper_hz - line.lower_hz) / (2.0 * TWO_SIDED_95),
        width_hz: line.narrower_than_hz.filter(|_| line.is_alone),
    };
    let seen: Vec<comb::Line> = lines.iter().map(as_seen).collect();
    comb::combs(&seen, rate_hz)
}

/// What each comb consists of, one sentence each.
pub(super) fn comb_notes(lines: &[Line], combs: &[Comb]) -> Vec<String> {
    let note = |comb: &Comb| {
        let frequency = |(line, _): &(usize, u32)| number(lines[*line].frequency_hz);
        let frequencies = words::list_of(comb.members.iter().map(frequency).collect());
        let lines = match comb.members.len() {
            1 => format!("the sinusoid at {frequencies} Hz is steady and agrees with"),
            _ => format!("the sinusoids at {frequencies} Hz are one comb:"),
        };
        let origin = match comb.mains_hz {
            Some(_) => "which come in through wires or the supply",
            None => "which one source makes, such as a motor or a clock",
        };
        format!("{lines} {}, {origin}", comb_words(comb))
    };
    combs.iter().map(note).collect()
}

/// What the record cannot tell of lines at half the sample rate, one sentence each.
pub(super) fn half_rate_notes(lines: &[Line], rate_hz: f64) -> Vec<String> {
    let half_hz = 0.5 * rate_hz;
    let reaches =
        |line: &&Line| line.upper_hz.is_finite() && line.upper_hz >= (1.0 - ROUNDING) * half_hz;
    let note = |line: &Line| {
        format!(
            "the sinusoid between {} and {} Hz cannot be told from one at half the sample rate, where it alternates from \
             sample to sample and its amplitude depends on its phase: another sample rate tells its frequency",
            number(line.lower_hz),
            number(half_hz),
        )
    };
    lines.iter().filter(reaches).map(note).collect()
}

/// A comb in words: `6.100 Hz and 2 harmonics`, `50 Hz mains and 2 harmonics`, `3 and 5 times 50 Hz mains`.
pub(crate) fn comb_words(comb: &Comb) -> String {
    let first = match comb.mains_hz {
        Some(mains_hz) => format!("{mains_hz} Hz mains"),
        None => format!("{} Hz", number(comb.fundamental_hz)),
    };
    let orders: Vec<u32> = comb.members.iter().map(|(_, order)| *order).collect();
    let named = |orders: &[u32]| -> Vec<String> { orders.iter().map(u32::to_string).collect() };
    let [1, higher @ ..] = orders.as_slice() else {
        return format!("{} times {first}", words::list_of(named(&orders)));
    };
    let consecutive = higher.iter().zip(2..).all(|(order, next)| *order == next);
    match higher {
        [] => first,
        [2] => format!("{first} and 1 harmonic"),
        higher if consecutive => format!("{first} and {} harmonics", higher.len()),
        higher => format!("{first} and {} times as much", named(higher).join(", ")),
    }
}
