//! The status of a recording: its length, losses, fits and verdicts at a moment.

use super::{
    diagnosis::{Diagnoser, Found},
    recording::Snapshot,
};
use allanite::{
    Coefficient, Comparison, Model, Record,
    fit::{Fit, State},
};
use allanite_host::{
    confidence::TWO_SIDED_95,
    fit::{
        self,
        fitted::{Fitted, MethodName},
    },
    number::duration,
    verdict::with_p,
};
use allanite_log::{BINS, OCTAVES};
use std::path::Path;

/// The status of a recording at a moment.
pub(super) struct Status {
    pub(super) rate_hz: f64,
    pub(super) samples: u64,
    pub(super) gaps: u64,
    pub(super) garbled: u64,
    /// A sentence that tells where and when the curve was saved.
    pub(super) saving: String,
    pub(super) axes: Vec<AxisStatus>,
}

/// The status of one axis.
pub(super) struct AxisStatus {
    pub(super) name: String,
    /// The fit, or `None` while the record is too short or the values do not change.
    pub(super) fitted: Option<Fitted>,
    /// Why there is no fit.
    pub(super) why: Option<String>,
    /// Where the fit and the measurement disagree.
    pub(super) comparison: Option<Comparison<OCTAVES, BINS>>,
    /// What the last diagnosis found.
    pub(super) found: Option<Found>,
}

/// The method by which the axes are fitted.
const METHOD: MethodName = MethodName::Covariance;

impl Status {
    /// Fits the samples that every axis has so far. What is missing is what the last diagnosis found.
    pub(super) fn of(recorded: Snapshot, diagnoser: &Diagnoser, saving: String) -> Self {
        let model = Model::ieee_952();
        let axes = recorded.curves.into_iter().map(|(curve, evidence)| {
            let name = curve.axis.clone();
            let is_constant = curve.octaves.iter().all(|octave| octave.sum == 0);
            // An axis that cannot be fitted yet may be fitted later.
            let (fitted, why) =
                match Fitted::with_evidence(Path::new(""), curve, &model, METHOD, evidence) {
                    Ok(fitted) => (Some(fitted), None),
                    Err(_) if is_constant => (None, Some("its values never change".into())),
                    Err(_) => (None, Some("the fit failed".into())),
                };
            let comparison = fitted.as_ref().and_then(|fitted| {
                let spectrum = fitted.axis.spectrum().ok()?;
                let observed = Record::new(&fitted.curve, &spectrum);
                Comparison::new(observed, &fitted.model, &fitted.fit).ok()
            });
            let found = diagnoser.found(&name).cloned();
            AxisStatus {
                name,
                fitted,
                why,
                comparison,
                found,
            }
        });
        Self {
            rate_hz: recorded.rate_hz,
            samples: recorded.samples,
            gaps: recorded.gaps,
            garbled: recorded.garbled,
            saving,
            axes: axes.collect(),
        }
    }

    /// Length of the record, in seconds.
    pub(super) fn length_s(&self) -> f64 {
        self.samples as f64 / self.rate_hz
    }

    /// The numbers of invalid lines and of gaps, in words.
    pub(super) fn losses(&self) -> String {
        format!("invalid lines: {}, gaps: {}", self.garbled, self.gaps)
    }

    /// The whole status in one line.
    pub(super) fn line(&self) -> String {
        let mut parts = vec![format!(
            "{} ({} samples)",
            duration(self.length_s()),
            self.samples
        )];
        if self.garbled > 0 {
            parts.push(self.losses());
        }
        for axis in &self.axes {
            parts.push(match &axis.fitted {
                None => format!("{}: nothing to fit yet", axis.name),
                Some(fitted) => {
                    let coefficients = fitted.fit.coefficients.iter().map(|one| {
                        let value = fit::table::customary(one, fitted.axis.unit);
                        format!("{} {value}", one.symbol)
                    });
                    let coefficients: Vec<String> = coefficients.collect();
                    let missing = axis.found.as_ref();
                    let missing =
                        missing.map_or(String::new(), |found| format!(", {}", found.brief));
                    format!(
                        "{}: {}, {}{missing}",
                        axis.name,
                        coefficients.join(" "),
                        verdict(&fitted.fit)
                    )
                }
            });
        }
        parts.join("; ")
    }
}

/// The verdict on the five terms, with the p-value.
pub(super) fn verdict(fit: &Fit) -> String {
    with_p(fit)
}

/// How much longer to record until a coefficient is measured, in words; empty for a measured
/// coefficient.
///
/// A coefficient that is not observable is assumed to be at its bound, as in the fit. For a coefficient
/// whose interval includes zero, the squared coefficient is assumed to be its best value or one standard
/// error, whichever is larger. The standard error is assumed to fall with the square root of the
/// record's length. The record is long enough when [`TWO_SIDED_95`] standard errors are less than the squared
/// coefficient.
pub(super) fn waiting(coefficient: &Coefficient, length_s: f64) -> String {
    let needed_s = match coefficient.state {
        State::Measured => return String::new(),
        State::NotObservable { after_s: None } => return "never".into(),
        State::NotObservable {
            after_s: Some(after_s),
        } => after_s,
        State::UpperBound => {
            let error = coefficient.square_error;
            length_s * (TWO_SIDED_95 * error / coefficient.square.max(error)).powi(2)
        }
    };
    if needed_s > length_s {
        format!("{} more", duration(needed_s - length_s))
    } else {
        // The record is long enough by its length, but gaps have made it worth less.
        format!("{} without gaps", duration(needed_s))
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::{
        super::recording::{Numbers, Recording},
        *,
    };
    use allanite::diagnosis::Verdict;
    use allanite_host::verdict::{ADEQUATE, brief};
    use allanite_log::unit::Unit;
    use std::time::Duration;

    /// The status of half a minute of white noise with one invalid line.
    pub(in super::super) fn status() -> Status {
        let mut recording = Recording::new(
            100.0,
            0.01,
            Numbers::Counts,
            Unit::DegreesPerSecond,
            Some(vec!["left".into(), "right".into()]),
        )
        .unwrap();
        let mut random = 1_u32;
        for i in 0..3000 {
            let [a, b] = [(); 2].map(|()| {
                random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                random >> 25
            });
            recording.take(format!("{a} {b}\n").as_bytes());
            if i == 1000 {
                recording.take(b"oops\n");
            }
        }
        let curves = recording.curves().unwrap().unwrap();
        let mut diagnoser = Diagnoser::new(Duration::from_secs(60));
        while diagnoser.found("right").is_none() {
            diagnoser.advance(|| Some(curves.clone()));
            std::thread::yield_now();
        }
        let saving = "curve.json was saved 3 s ago";
        Status::of(recording.snapshot(), &diagnoser, saving.into())
    }

    #[test]
    fn line_has_every_axis_with_values_bounds_and_a_verdict() {
        let line = status().line();
        assert!(line.starts_with("30.000 s (3000 samples); invalid lines: 1, gaps: 1; left: Q "));
        assert_eq!(
            line.matches(&format!("{ADEQUATE}, p = 0.")).count(),
            2,
            "{line}"
        );
        assert_eq!(
            line.matches(&format!(", {}", brief(Verdict::Adequate, "")))
                .count(),
            2,
            "{line}"
        );
        assert!(
            line.contains("; right: Q ") && line.contains(" N 2."),
            "{line}"
        );
    }

    #[test]
    fn longer_record_is_asked_for_until_a_coefficient_is_measured() {
        let status = status();
        let fitted = status.axes[0].fitted.as_ref().unwrap();
        for coefficient in &fitted.fit.coefficients {
            let waiting = waiting(coefficient, status.length_s());
            match coefficient.state {
                State::Measured => assert_eq!(waiting, ""),
                State::NotObservable { after_s: None } => {
                    assert_eq!(waiting, "never");
                }
                State::UpperBound => assert!(waiting.ends_with(" more"), "{waiting}"),
                State::NotObservable { .. } => {
                    let ends = [" more", " without gaps"];
                    assert!(ends.iter().any(|end| waiting.ends_with(end)), "{waiting}");
                }
            }
        }
        assert_eq!(fitted.fit.coefficients[1].state, State::Measured);
    }
}
