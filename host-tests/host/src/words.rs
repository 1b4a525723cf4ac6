//! Effects, coefficients and records in words, for tables, sentences and the notes of JSON documents.

use super::{
    number::{duration, number, rounded_up, two_digits},
    own, units,
    verdict::ADEQUATE_MODEL,
};
use allanite::{
    Coefficient, Model, Term,
    comparison::Band,
    course::{Event, What},
    detection::Range,
    effect::{Effect, Explanation, MAX_PARAMETERS, Parameter},
    fit::{Fit, State},
};
use allanite_log::unit::{Sensor, Unit};

/// A name as people write it.
pub fn plain(name: &str) -> String {
    match name {
        // Named after two people.
        "gauss_markov" => "Gauss–Markov".into(),
        _ => name.replace('_', " "),
    }
}

/// A coefficient's name as people write it. An accelerometer has velocity and acceleration where a gyro
/// has angle and rate.
pub fn of_sensor(name: &str, unit: Unit) -> String {
    match (unit.sensor(), name) {
        (Sensor::Accelerometer, "angle_random_walk") => "velocity random walk".into(),
        (Sensor::Accelerometer, "rate_random_walk") => "acceleration random walk".into(),
        (Sensor::Accelerometer, "rate_ramp") => "acceleration ramp".into(),
        _ => plain(name),
    }
}

/// Names of effects as a list in a sentence: `sinusoid, low pass and resonance`.
pub fn list<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    list_of(names.into_iter().map(plain).collect())
}

/// Texts that are readable already, as a list in a sentence: `a, b and c`.
pub fn list_of(names: Vec<String>) -> String {
    match names.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        _ => names.concat(),
    }
}

/// Names of effects as alternatives in a sentence: `a low pass or a resonance`.
pub fn alternatives<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    let names: Vec<String> = names.into_iter().map(in_sentence).collect();
    names.join(" or ")
}

/// The name of white noise beside a filter that took the place of the gyro's own white noise: it entered behind the filter.
pub const BEHIND_FILTER: &str = "white_noise_behind_the_filter";

/// The explanation of an effect, or of [`BEHIND_FILTER`].
pub fn explanation(name: &str) -> Option<Explanation> {
    if name == BEHIND_FILTER {
        return Some(Explanation {
            what: "white noise that enters behind the filter: the filter leaves less than this at high frequency",
            origin: "rounding of the values, an analogue-to-digital converter or a wire behind the filter",
            check: "rounding to steps of q at a rate r adds q/√(12 r); log with a finer step: is there less of it?",
        });
    }
    let own = || own::named(name).map(|effect| effect.explanation());
    allanite::effect::explanation(name).or_else(own)
}

/// Whether an effect of a model stands beside one that takes its place.
pub fn is_behind_filter(effect: &dyn Effect, model: &Model) -> bool {
    let mut others = model
        .terms()
        .iter()
        .filter_map(|term| term.effect.replaces());
    others.any(|replaced| replaced.name() == effect.name())
}

/// The name of an effect in a model.
pub fn name_in(effect: &'static dyn Effect, model: &Model) -> &'static str {
    match is_behind_filter(effect, model) {
        true => BEHIND_FILTER,
        false => effect.name(),
    }
}

/// The noun with which the explanation of an effect begins.
fn noun(name: &str) -> &'static str {
    let what = explanation(name).map_or("", |explanation| explanation.what);
    what.split(':').next().unwrap_or_default()
}

/// The article of an effect's name, with a blank behind it, or nothing.
pub fn article(name: &str) -> &'static str {
    if noun(name).starts_with("a ") {
        "a "
    } else {
        ""
    }
}

/// The name of an effect in a sentence: `a sinusoid`, `random telegraph noise`. The explanation of the effect
/// begins with a noun, which tells whether there is an article and whether the effect is a noise.
pub fn in_sentence(name: &str) -> String {
    let noun = noun(name);
    let article = article(name);
    let noise = if noun.ends_with(" noise") {
        " noise"
    } else {
        ""
    };
    format!("{article}{}{noise}", plain(name))
}

/// The shape parameters of a term: `frequency 19.6 Hz (19.5 … 19.7), quality 4`. Intervals are shown
/// where a fit gives them. A parameter that is known by its reciprocal as well is shown as both:
/// `cutoff 42 Hz, time constant 0.003789 s`.
pub fn shape(term: &Term, fit: Option<(&Fit, usize)>) -> String {
    let parameters = term.effect.parameters().iter().zip(term.parameters);
    let one = |(parameter, value): (&Parameter, f64)| {
        let estimate = fit.and_then(|(fit, at)| {
            let mut shape = fit.shape.iter();
            shape.find(|one| one.term == at && one.name == parameter.name)
        });
        let interval = |ends: [f64; 2]| match estimate {
            Some(estimate) if !estimate.upper.is_finite() => " (any value)".into(),
            Some(_) => format!(" ({})", ends.map(short).join(" … ")),
            None => String::new(),
        };
        let ends = estimate.map_or([f64::NAN; 2], |estimate| [estimate.lower, estimate.upper]);
        let own = shape_value(parameter, value) + &interval(ends);
        let Some(reciprocal) = parameter.reciprocal else {
            return own;
        };
        let [upper, lower] = ends.map(|end| reciprocal.product / end);
        let other = short(reciprocal.product / value);
        let other = named(reciprocal.name, reciprocal.unit, &other);
        format!("{other}{}, {own}", interval([lower, upper]))
    };
    parameters.map(one).collect::<Vec<_>>().join(", ")
}

/// A shape parameter and its value: `frequency 19.6 Hz`.
pub fn shape_value(parameter: &Parameter, value: f64) -> String {
    shape_words(parameter, &short(value))
}

/// A shape parameter and its values in words: `frequency 19 … 20 Hz`.
pub fn shape_words(parameter: &Parameter, values: &str) -> String {
    named(parameter.name, parameter.unit, values)
}

/// The name of a quantity as people write it, without its unit: `frequency` for `frequency_hz`.
pub fn without_unit(name: &str, unit: &str) -> String {
    let suffix = format!("_{}", unit.to_lowercase());
    plain(name.strip_suffix(&suffix).unwrap_or(name))
}

/// Values of a quantity in words: `frequency 19 … 20 Hz` for `frequency_hz`.
fn named(name: &str, unit: &str, values: &str) -> String {
    // The unit is written after the value.
    let name = without_unit(name, unit);
    match unit {
        "" => format!("{name} {values}"),
        unit => format!("{name} {values} {unit}"),
    }
}

/// Four significant digits; a whole number below 10 000 has no fraction.
fn short(value: f64) -> String {
    if value.fract() == 0.0 && value.abs() < 1e4 {
        format!("{value}")
    } else {
        number(value)
    }
}

/// A coefficient of a model with its value and interval: `angle random walk 1.95 °/√h (1.93 … 1.97)`.
pub fn coefficient(
    effect: &'static dyn Effect,
    model: &Model,
    coefficient: &Coefficient,
    unit: Unit,
) -> String {
    let name = match is_behind_filter(effect, model) {
        true => plain(BEHIND_FILTER),
        false => of_sensor(effect.coefficient(), unit),
    };
    // Amplitudes are rates and keep the log's unit; customary units in hours are for drifts.
    let (factor, unit) = match effect.coefficient() {
        "amplitude" | "rms" => (1.0, units::unit(unit, coefficient.half_seconds)),
        _ => customary(unit, coefficient.half_seconds),
    };
    let value = |value: f64| number(factor * value);
    match coefficient.state {
        State::Measured => format!(
            "{name} {} {unit} ({} … {})",
            value(coefficient.value),
            value(coefficient.lower),
            value(coefficient.upper)
        ),
        State::UpperBound => format!("{name} < {} {unit}", value(coefficient.upper)),
        State::NotObservable { .. } => format!("{name} not observable"),
    }
}

/// What limits of detection are, as the heading of their list.
pub const LIMITS: &str =
    "Beside this model, the record would have shown with a probability of 95 %:";

/// A limit of detection: `a sinusoid of amplitude 0.0047 deg/s, frequency 0.026 … 0.41 Hz`.
pub fn limit(range: &Range, unit: Unit) -> String {
    let effect = range.effect;
    let name = in_sentence(effect.name());
    let parameter = effect.parameters().first();
    let limit = rounded_up(range.size);
    if let Some(parameter) = parameter.filter(|_| range.is_of_shape) {
        let shape = shape_words(parameter, &limit);
        return format!("{name} with a {shape} or more");
    }
    let size = format!(
        "{name} of {} {limit} {}",
        of_sensor(effect.coefficient(), unit),
        units::unit(unit, effect.half_seconds()),
    );
    let Some(parameter) = parameter else {
        return size;
    };
    let (low, high) = range.ends;
    let values = if low == high {
        two_digits(low)
    } else {
        format!("{} … {}", two_digits(low), two_digits(high))
    };
    format!("{size}, {}", shape_words(parameter, &values))
}

/// The factor to the customary unit and its name, or 1 and the log's own unit if there is none.
pub fn customary(unit: Unit, half_seconds: i8) -> (f64, String) {
    match units::customary(unit, half_seconds) {
        Some((factor, name)) => (factor, name.into()),
        None => (1.0, units::unit(unit, half_seconds)),
    }
}

/// An effect's shape parameters by the names that options use, each with its reciprocal if it is known by
/// that as well. The coefficient is added where its name
/// differs from that of the effect.
pub fn parameters(term: &Term, coefficient: Option<f64>) -> Vec<(&'static str, f64)> {
    let shape = term.effect.parameters().iter().take(MAX_PARAMETERS);
    let both = |(parameter, value): (&Parameter, f64)| {
        let reciprocal = parameter.reciprocal;
        let other = reciprocal.map(|other| (other.name, other.product / value));
        std::iter::once((parameter.name, value)).chain(other)
    };
    let mut named: Vec<_> = shape.zip(term.parameters).flat_map(both).collect();
    let name = term.effect.coefficient();
    if name != term.effect.name() {
        named.extend(coefficient.map(|value| (name, value)));
    }
    named
}

/// A note that names the frequencies of which a term's frequency may be the alias.
pub fn alias(term: &Term, rate_hz: f64) -> Option<String> {
    if term.effect.replaces().is_some() {
        // A filter is not sampled.
        return None;
    }
    let mut parameters = term.effect.parameters().iter().zip(term.parameters);
    let (_, frequency_hz) = parameters.find(|(parameter, _)| parameter.name == "frequency_hz")?;
    Some(format!(
        "{}: at a sample rate of {rate_hz} Hz, {} Hz may be the alias of {} Hz, {} Hz or any other k × {rate_hz} Hz ± {} Hz",
        plain(term.effect.name()),
        short(frequency_hz),
        short(rate_hz - frequency_hz),
        short(rate_hz + frequency_hz),
        short(frequency_hz),
    ))
}

/// By how much the intervals of a model that is not adequate are widened.
pub fn widened(fit: &Fit) -> Option<String> {
    (fit.birge_ratio > 1.0).then(|| {
        let factor = number(fit.birge_ratio);
        format!("The intervals are {factor} times as wide as those of {ADEQUATE_MODEL}: √(χ²/degrees of freedom).")
    })
}

/// An interval of the angle random walk whose ends are further apart than by this factor is explained.
const WIDE: f64 = 2.0;

/// That a diagnosis leaves the angle random walk open, because explanations that fit as well have another one.
pub fn open_white_noise(fit: &Fit, unit: Unit) -> Option<String> {
    let mut coefficients = fit.coefficients.iter();
    let white = coefficients.find(|one| one.symbol == "N" && one.state == State::Measured)?;
    (white.upper > WIDE * white.lower).then(|| {
        let [lower, upper] = [white.lower, white.upper].map(number);
        format!("angle random walk is anything from {lower} to {upper} {unit}/√Hz: explanations that fit as well have another one")
    })
}

/// An effect is told if it adds more than this share to the square of the plateau. Chosen by hand: it is 5 % of the root.
const SHARED: f64 = 0.1;
/// The Allan variance of white noise halves from one octave to the next. What falls by a factor between these looks like it.
const LIKE_WHITE: std::ops::Range<f64> = 0.4..0.6;

/// That the curve reads more than the angle random walk at its plateau, the octave in which it has its largest share, because
/// another effect is flat there as well.
pub fn shared_plateau(
    model: &Model,
    fit: &Fit,
    rate_hz: f64,
    octaves: usize,
    unit: Unit,
) -> Option<String> {
    let interval_s = rate_hz.recip();
    let symbols = fit.coefficients.iter().map(|one| one.symbol);
    let white = symbols.clone().position(|symbol| symbol == "N")?;
    let variance = |i: usize, m: f64| {
        let square = fit.coefficients.get(i).map_or(0.0, |one| one.square);
        square * model.unit_variance(i, m, interval_s)
    };
    let terms = 0..model.terms().len();
    let share = |m: f64| variance(white, m) / terms.clone().map(|i| variance(i, m)).sum::<f64>();
    let plateau = fit.coefficients.get(white).map_or(0.0, |one| one.square);
    let factors = (0..octaves).map(|k| (k as f64).exp2());
    // A filter or a rise has changed the white noise of shorter octaves.
    let factors = factors.filter(|m| {
        let square = variance(white, *m) * m * interval_s;
        (square - plateau).abs() <= SHARED * plateau
    });
    let m = factors.max_by(|a, b| share(*a).total_cmp(&share(*b)))?;
    let tau_s = m * interval_s;
    let own = variance(white, m) * tau_s;
    let beside: Vec<(usize, f64)> = terms
        .filter(|i| *i != white && !model.terms()[*i].effect.parameters().is_empty())
        .filter(|i| LIKE_WHITE.contains(&(variance(*i, 2.0 * m) / variance(*i, m))))
        .map(|i| (i, variance(i, m) * tau_s))
        .filter(|(_, square)| *square > SHARED * own)
        .collect();
    let sum = own + beside.iter().map(|(_, square)| square).sum::<f64>();
    let names = beside.iter().map(|(i, _)| model.terms()[*i].effect.name());
    (!beside.is_empty()).then(|| {
        format!(
            "at its plateau, τ = {}, the curve reads {} {unit}/√Hz: angle random walk is {} of it, and the rest is {}",
            duration(tau_s),
            number(sum.sqrt()),
            number(own.sqrt()),
            names.map(plain).collect::<Vec<_>>().join(" and "),
        )
    })
}

/// What is added to the square of the angle random walk where flicker noise ends at half the sample rate, instead of being
/// averaged over each sample interval: this times `B²τ₀`. Measured in the records of an independent simulator.
const UNSEEN_FLICKER: f64 = 0.09;

/// That nobody sees in a record what flicker noise is below the sample interval, if this matters beside the interval of the
/// angle random walk.
pub fn unseen_flicker(fit: &Fit, rate_hz: f64) -> Option<String> {
    let measured = |name: &str| {
        let mut coefficients = fit.coefficients.iter();
        coefficients.find(|one| one.name == name && one.state == State::Measured)
    };
    let white = measured("angle_random_walk")?;
    let flicker = measured("bias_instability")?;
    let change = 0.5 * UNSEEN_FLICKER * flicker.square / (rate_hz * white.square);
    // A quarter of the half-width, chosen by hand: less hardly changes what the interval says.
    let matters = change > 0.25 * 0.5 * (white.upper - white.lower) / white.value;
    matters.then(|| {
        format!(
            "If the flicker noise ends at half the sample rate, the angle random walk is {} % lower: no record shows \
             what it is below the sample interval.",
            number(100.0 * change)
        )
    })
}

/// How the coefficients of one model were wrong, and are right in another one.
pub fn damage<'a>(
    before: (&'a Model, &'a Fit),
    after: (&'a Model, &'a Fit),
    unit: Unit,
) -> Vec<String> {
    let terms = |(model, fit): (&'a Model, &'a Fit)| model.terms().iter().zip(&fit.coefficients);
    let sentence = |(term, was): (&Term, &Coefficient)| {
        let name = term.effect.coefficient();
        let (_, is) = terms(after).find(|(term, _)| term.effect.coefficient() == name)?;
        changed(&of_sensor(name, unit), was, is, unit)
    };
    terms(before).filter_map(sentence).collect()
}

fn changed(name: &str, was: &Coefficient, is: &Coefficient, unit: Unit) -> Option<String> {
    let (factor, unit) = customary(unit, is.half_seconds);
    let shown = |value: f64| format!("{} {unit}", number(factor * value));
    let measured = |one: &Coefficient| one.state == State::Measured;
    if measured(was) && measured(is) {
        let inside = (is.lower..=is.upper).contains(&was.value);
        let side = if was.value > is.value { "high" } else { "low" };
        let difference = shown((was.value - is.value).abs());
        return (!inside).then(|| {
            format!(
                "{name} was {difference} too {side}: {} instead of {}",
                shown(was.value),
                shown(is.value)
            )
        });
    }
    if measured(was) {
        return match is.state {
            State::UpperBound if was.value > is.upper => Some(format!(
                "{name} was at least {} too high: {} instead of at most {}",
                shown(was.value - is.upper),
                shown(was.value),
                shown(is.upper)
            )),
            State::NotObservable { .. } => Some(format!(
                "{name} is no longer supported by the data (was {})",
                shown(was.value)
            )),
            _ => None,
        };
    }
    measured(is).then(|| format!("{name} is now measured: {}", shown(is.value)))
}

/// The size of a record: `1000000 samples at 100 Hz (2.8 h), 18 octaves`.
pub fn record(samples: u64, rate_hz: f64, octaves: usize) -> String {
    let length = duration(samples as f64 / rate_hz);
    format!("{samples} samples at {rate_hz} Hz ({length}), {octaves} octaves")
}

/// A band of a spectrum that lies on one side of the model: `12 σ above the model at 14.1–26.6 Hz`.
pub fn band(band: &Band) -> String {
    let ends = [band.from_hz, band.to_hz].map(number);
    let place = if band.from_hz == band.to_hz {
        ends[0].clone()
    } else {
        ends.join("–")
    };
    let side = if band.z > 0.0 { "above" } else { "below" };
    format!("{:.0} σ {side} the model at {place} Hz", band.z.abs())
}

/// What happened during a record, in a sentence: `the noise rose 1.50-fold at 11 min 20 s (40 σ)`.
pub fn event(event: &Event, unit: Unit) -> String {
    let z = format!("{:.0} σ", event.z.abs());
    let at = duration(event.at_s);
    let size = number(event.size.abs());
    match event.what {
        What::NoiseChange if event.size > 1.0 => {
            format!("the noise rose {:.2}-fold at {at} ({z})", event.size)
        }
        What::NoiseChange => format!(
            "the noise fell to {:.2} of what it was at {at} ({z})",
            event.size
        ),
        What::Bursts { blocks } => format!(
            "bursts of noise in {blocks} of 64 parts of the record, the strongest at {at}, {:.1} times as large ({z})",
            event.size
        ),
        What::Step => format!("the rate stepped by {size} {unit} at {at} ({z})"),
        What::WarmUp { time_constant_s } => format!(
            "the gyro warmed up: the rate began {size} {unit} off, time constant {} s ({z})",
            two_digits(time_constant_s)
        ),
        _ => format!("something happened at {at} ({z})"),
    }
}

/// An event in a few words, for a place that shows when it happened.
pub fn brief_event(event: &Event, unit: Unit) -> String {
    let size = event.size;
    match event.what {
        What::NoiseChange => format!("noise × {size:.2}"),
        What::Bursts { blocks: 1 } => format!("burst, noise × {size:.1}"),
        What::Bursts { blocks } => format!("{blocks} bursts, noise × {size:.1}"),
        What::Step => format!("step, {}{} {unit}", sign(size), two_digits(size.abs())),
        What::WarmUp { .. } => {
            format!("warm-up, {}{} {unit}", sign(size), two_digits(size.abs()))
        }
        _ => "event".into(),
    }
}

fn sign(size: f64) -> &'static str {
    if size < 0.0 { "−" } else { "+" }
}

/// χ² of a fit with its degrees of freedom.
pub fn goodness(fit: &Fit) -> String {
    let (chi_squared, degrees) = (fit.chi_squared, fit.degrees_of_freedom);
    format!("{chi_squared:.1}, {degrees} degrees of freedom")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn effects_in_a_sentence_have_their_article_or_are_called_a_noise() {
        let names = [
            "low_pass",
            "sinusoid",
            "random_telegraph",
            "rate_random_walk",
        ];
        assert_eq!(
            alternatives(names),
            "a low pass or a sinusoid or random telegraph noise or rate random walk"
        );
    }
}
