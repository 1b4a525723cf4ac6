//! The words of a diagnosis, which `diagnose` prints and the page of `report` shows.

use super::{diagnosed::Diagnosed, given_filter::Better, lines::comb_words};
use crate::{
    dependence::candidates::{Form, seconds},
    known_filter,
    number::{self, probability},
    tried::per,
    verdict::{brief as in_brief, sentence},
    words,
};
use allanite::{
    Comparison, Term, covariate,
    detection::Range,
    diagnosis::{Addition, Candidate, FollowedCovariate, Step, Verdict},
    effect::Explanation,
};
use allanite_log::{BINS, OCTAVES};

/// What a step of a diagnosis added, with its explanation.
pub struct Finding {
    /// The name of the effect or of the covariate.
    pub name: String,
    /// Its shape and its coefficient, with intervals.
    pub found: Option<String>,
    explanation: Option<Explanation>,
    /// A label, and what the addition changes in the model or in the curve.
    change: Option<(&'static str, String)>,
    /// The effects that would explain the curve as well.
    pub ambiguous: Option<String>,
}

impl Finding {
    /// The finding that leads from one step to the next, or `None` if nothing was added.
    pub fn new(
        diagnosed: &Diagnosed,
        before: &Step<OCTAVES, BINS>,
        after: &Step<OCTAVES, BINS>,
    ) -> Option<Self> {
        let mut finding = match before.added.as_ref()? {
            Addition::Effect(added) => Self::effect(diagnosed, after, added),
            Addition::Covariate(follows) => Self::covariate(diagnosed, follows),
        };
        if !before.ambiguous.is_empty() {
            let others = words::alternatives(before.ambiguous.iter().copied());
            finding.ambiguous = Some(format!("{others} would explain this curve as well"));
        }
        Some(finding)
    }

    fn effect(diagnosed: &Diagnosed, after: &Step<OCTAVES, BINS>, added: &Term) -> Self {
        let effect = added.effect;
        let place = |replaced: &str| format!("replaces {}", words::plain(replaced));
        let change = effect.replaces().map(|replaced| place(replaced.name()));
        let name = words::name_in(effect, &after.model);
        Self {
            name: words::plain(name),
            found: found(after, effect.name(), diagnosed),
            explanation: words::explanation(name),
            change: change.map(|change| ("in the model", change)),
            ambiguous: None,
        }
    }

    fn covariate(diagnosed: &Diagnosed, followed: &FollowedCovariate) -> Self {
        let channels = diagnosed.covariate(followed);
        let found = diagnosed.slopes(followed).into_iter();
        let unit = diagnosed.axis.unit;
        let found = found.map(|(slope, series)| {
            let (lower, upper) = slope.interval();
            let per = per(&series.column, &series.form, unit);
            let lag = match &series.form {
                Form::Behind(lag) => format!(
                    "lag {} ({} … {}); ",
                    seconds(lag.lag_s),
                    seconds(lag.lower_s),
                    seconds(lag.upper_s)
                ),
                _ => String::new(),
            };
            format!(
                "{lag}slope {} {per} of {} ({} … {}), 95 % interval; {:.1} standard errors",
                number::number(slope.value),
                series.name,
                number::number(lower),
                number::number(upper),
                slope.z()
            )
        });
        let found = found.collect::<Vec<_>>().join("; ");
        let channels = channels.join(" and ");
        let change = format!("the part that follows {channels} is subtracted from this step on");
        Self {
            name: format!("{} {channels}", words::plain(covariate::NAME)),
            found: Some(found),
            explanation: Some(covariate::EXPLANATION),
            change: Some(("in the curve", change)),
            ambiguous: None,
        }
    }

    /// Lines of the explanation, each with its label: what the effect is, where it comes from, what to
    /// check, and what it changes.
    pub fn lines(&self) -> Vec<(&'static str, &str)> {
        let explanation = self.explanation.map(|explanation| {
            [
                ("what it is", explanation.what),
                ("where it comes from", explanation.origin),
                ("what to check", explanation.check),
            ]
        });
        let change = self.change.as_ref();
        let change = change.map(|(label, text)| (*label, text.as_str()));
        explanation.into_iter().flatten().chain(change).collect()
    }
}

/// The shape and the coefficient of an effect in a step, with their 95 % intervals. Of several effects of one name, it is
/// the one that was added last.
pub fn found(step: &Step<OCTAVES, BINS>, effect: &str, diagnosed: &Diagnosed) -> Option<String> {
    let mut terms = step.model.terms().iter();
    let at = terms.rposition(|term| term.effect.name() == effect)?;
    let term = step.model.terms().get(at)?;
    let mut found = words::shape(term, Some((&step.fit, at)));
    if !found.is_empty() {
        found += "; ";
    }
    let coefficient = step.fit.coefficients.get(at)?;
    found += &words::coefficient(term.effect, &step.model, coefficient, diagnosed.axis.unit);
    Some(found + ", 95 % intervals")
}

/// Bands of frequencies in which the spectrum lies on one side of the model, those that differ most first.
pub fn unexplained(comparison: &Comparison<OCTAVES, BINS>) -> Vec<String> {
    comparison.bands().iter().map(words::band).collect()
}

/// Where a record and a model disagree, in octaves and in the spectrum.
pub fn disagreement(comparison: &Comparison<OCTAVES, BINS>) -> String {
    let bands = unexplained(comparison);
    if bands.is_empty() {
        return comparison.to_string();
    }
    format!("{comparison}; the spectrum is {}", bands.join(", "))
}

/// A candidate with its shape.
pub fn candidate_name(candidate: &Candidate) -> String {
    let shape = words::shape(&candidate.term, None);
    let name = words::plain(candidate.term.effect.name());
    if shape.is_empty() {
        name
    } else {
        format!("{name} ({shape})")
    }
}

/// The limits of detection, a line for each range of shapes.
pub fn limits(diagnosed: &Diagnosed) -> Vec<String> {
    let unit = diagnosed.axis.unit;
    let line = |range: &Range| words::limit(range, unit);
    diagnosed.ranges().as_slice().iter().map(line).collect()
}

/// A p-value with its relation, such as `= 0.338`, or `unknown` if there is none.
pub fn shown_p(p: f64) -> String {
    if p.is_finite() {
        probability(p)
    } else {
        "unknown".into()
    }
}

/// By how much χ² fell when a term of the last model was added, or the covariate. `None` if no step added it as it is.
pub fn added_chi_squared(diagnosed: &Diagnosed, term: Option<&Term>) -> Option<f64> {
    let is_it = |added: &Addition| match (added, term) {
        (Addition::Effect(added), Some(term)) => {
            let near = |a: f64, b: f64| (a / b - 1.0).abs() < SAME_SHAPE || a == b;
            added.effect.name() == term.effect.name()
                && near(added.parameters[0], term.parameters[0])
        }
        (Addition::Covariate(_), None) => true,
        _ => false,
    };
    let mut steps = diagnosed.steps.iter();
    let at = steps.position(|step| step.added.as_ref().is_some_and(is_it))?;
    let after = at + 1;
    (after < diagnosed.steps.len())
        .then(|| diagnosed.chi_squared(at) - diagnosed.chi_squared(after))
}

/// A shape of an effect changes by less than this share while others are added beside it. Chosen by hand.
const SAME_SHAPE: f64 = 0.2;

/// An effect, with its frequency if it is at one: `sinusoid (31.00 Hz)`.
fn with_frequency(term: &Term) -> String {
    let name = words::plain(term.effect.name());
    let first = term.effect.parameters().first();
    match first.filter(|first| first.name == "frequency_hz") {
        Some(_) => format!("{name} ({} Hz)", number::number(term.parameters[0])),
        None => name,
    }
}

/// The covariate and the effects that were added, in words. Lines that are one comb are said as one.
fn missing(diagnosed: &Diagnosed) -> Vec<String> {
    let Some((_, last)) = diagnosed.ends() else {
        return Vec::new();
    };
    let followed = last.covariate.as_ref();
    let covariate = followed.map(|followed| {
        let channels = diagnosed.covariate(followed).join(" and ");
        format!("{} {channels}", covariate::NAME)
    });
    let in_a_comb = |term: &Term| {
        let members = diagnosed.combs.iter().flat_map(|comb| &comb.members);
        let mut places = members.map(|(line, _)| diagnosed.lines[*line].place);
        places.any(|place| std::ptr::eq(term, &last.model.terms()[place]))
    };
    let combs = diagnosed.combs.iter();
    let combs = combs.map(|comb| {
        let lines = match comb.members.len() {
            1 => "sinusoid",
            _ => "sinusoids",
        };
        format!("{lines} ({})", comb_words(comb))
    });
    let single = diagnosed.added().filter(|term| !in_a_comb(term));
    let single = single.map(with_frequency);
    covariate.into_iter().chain(combs).chain(single).collect()
}

/// The result of the diagnosis in a sentence. What happened during the record comes first.
pub fn verdict(diagnosed: &Diagnosed) -> String {
    let of_curve = verdict_on_curve(diagnosed);
    let stationarity = &diagnosed.stationarity;
    let strongest = stationarity.strongest(diagnosed.axis.unit);
    match strongest.filter(|_| stationarity.is_disturbed()) {
        Some(event) => sentence::not_stationary(&event, &of_curve),
        None => of_curve,
    }
}

/// The result of the diagnosis in a few words.
pub fn brief(diagnosed: &Diagnosed) -> String {
    let added = diagnosed.added().map(|term| {
        let shape = words::shape(term, None);
        format!("{} ({shape})", words::plain(term.effect.name()))
    });
    in_brief(diagnosed.verdict, &words::list_of(added.collect()))
}

/// What the diagnosis says of the curve and the spectrum.
fn verdict_on_curve(diagnosed: &Diagnosed) -> String {
    let Some((first, last)) = diagnosed.ends() else {
        return String::new();
    };
    let p = shown_p(last.fit.p_value);
    let terms = known_filter::terms(&first.model);
    match diagnosed.verdict {
        Verdict::Invalid(_) => sentence::invalid(&diagnosed.invalid().unwrap_or_default()),
        Verdict::Adequate if diagnosed.stationarity.is_disturbed() => sentence::mixture(&terms, &p),
        Verdict::Adequate => sentence::adequate(&terms, &p),
        Verdict::TooShort => sentence::too_short(&terms),
        Verdict::Unexplained | Verdict::Incomplete if diagnosed.better.is_some() => {
            let better = diagnosed
                .better
                .as_ref()
                .map_or(String::new(), Better::words);
            let why = format!("because the filter does not fit: {better}");
            sentence::inadequate(&terms, &p, &why)
        }
        Verdict::Unexplained => sentence::inadequate(
            &terms,
            &p,
            "and no effect in the catalogue explains the difference",
        ),
        _ => {
            let names = missing(diagnosed);
            let effects = match names.len() {
                1 if diagnosed.combs.iter().all(|comb| comb.members.len() == 1) => "missing effect",
                _ => "missing effects",
            };
            let names = words::list_of(names);
            let alike = if diagnosed.ambiguous().next().is_some() {
                " (or an ambiguous alternative)"
            } else {
                ""
            };
            let error = format!(
                "χ² {:.1} → {:.1}",
                diagnosed.chi_squared(0),
                last.fit.chi_squared
            );
            let missing = if first.fit.is_adequate() == Some(true) {
                format!("{effects}: {names}{alike}, although the {terms} fit the curve; {error}")
            } else {
                format!("{effects}: {names}{alike}; {error}")
            };
            if diagnosed.verdict == Verdict::Improved {
                sentence::improved(&missing, &p)
            } else {
                sentence::incomplete(&missing, &p)
            }
        }
    }
}

/// The whole diagnosis in one sentence: where the five terms fail, which effect is missing, and how much
/// the error falls.
pub fn lead(diagnosed: &Diagnosed) -> String {
    let verdict = verdict(diagnosed);
    let Some((first, _)) = diagnosed.ends() else {
        return verdict;
    };
    if let Some(reason) = diagnosed.invalid() {
        return sentence::invalid_curve(&reason);
    }
    if matches!(diagnosed.verdict, Verdict::Adequate) {
        return verdict;
    }
    // The worst octave comes first, in `measured is 59 % above the model at τ = 20.0 ms (58 σ); …`. Where no octave
    // shows what is missing, the spectrum may.
    let bands = unexplained(&first.comparison);
    let failure = match (first.comparison.stretches().next(), bands.first()) {
        (None, Some(band)) => format!(
            "the spectrum is {}",
            band.replace(" σ ", " standard errors ")
        ),
        _ => first.comparison.to_string(),
    };
    let worst = failure.split(';').next().unwrap_or_default();
    let worst = worst.replace("the model", "the five-term model");
    let worst = worst.replace(" σ)", " standard errors)");
    format!("{worst}; {verdict}")
}
