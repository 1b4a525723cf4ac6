//! What there is to be said of a recording at a moment.

use super::recording::Recording;
use crate::command::{
    fit::{
        self,
        fitted::{Fitted, MethodName},
    },
    output::number::{duration, probability},
};
use allanite::fit::ADEQUATE_P;
use allanite::{
    Coefficient,
    fit::{Fit, State},
};
use std::path::Path;

/// Two-sided 95 % of a normal distribution, in standard errors.
const TWO_SIDED: f64 = 1.96;

/// A recording at a moment.
pub(super) struct Status {
    pub(super) rate_hz: f64,
    pub(super) samples: u64,
    pub(super) gaps: u64,
    pub(super) garbled: u64,
    /// When and where the curve was saved, in words.
    pub(super) saving: String,
    pub(super) axes: Vec<AxisStatus>,
}

/// One axis.
pub(super) struct AxisStatus {
    pub(super) name: String,
    /// Nothing as long as the record is too short, or the axis does not move.
    pub(super) fitted: Option<Fitted>,
}

impl Status {
    /// Fits every axis as it is now.
    pub(super) fn of(recording: &Recording, saving: String) -> Self {
        let curves = recording.curves().ok().flatten().unwrap_or_default();
        let axes = curves.into_iter().map(|curve| AxisStatus {
            name: curve.axis.clone(),
            // What cannot be fitted yet may be later.
            fitted: Fitted::new(Path::new(""), curve, MethodName::Covariance).ok(),
        });
        Self {
            rate_hz: recording.rate_hz(),
            samples: recording.samples(),
            gaps: recording.gaps(),
            garbled: recording.garbled(),
            saving,
            axes: axes.collect(),
        }
    }

    /// Length of the record, in seconds.
    pub(super) fn length_s(&self) -> f64 {
        self.samples as f64 / self.rate_hz
    }

    /// What was lost.
    pub(super) fn losses(&self) -> String {
        format!(
            "lines that were no samples: {}, gaps: {}",
            self.garbled, self.gaps
        )
    }

    /// All in one line.
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
                    format!(
                        "{}: {}, {}",
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

/// Whether the five terms are enough.
pub(super) fn verdict(fit: &Fit) -> String {
    match fit.p_value {
        p if p >= ADEQUATE_P => format!("adequate, p {}", probability(p)),
        p if p < ADEQUATE_P => format!("not adequate, p {}", probability(p)),
        _ => "too few octaves to judge".into(),
    }
}

/// How much longer to record for a coefficient; nothing for one that is measured.
///
/// One that is not observable is taken to be at its bound, as the fit does. Of one with zero within its
/// interval the square is taken to be the best value or one standard error, whichever is larger, and the
/// standard error to fall with the root of the record's length until 1.96 of it are less.
pub(super) fn waiting(coefficient: &Coefficient, length_s: f64) -> String {
    let needed_s = match coefficient.state {
        State::Measured => return String::new(),
        State::NotObservable { after_s: None } => return "no record would show it".into(),
        State::NotObservable {
            after_s: Some(after_s),
        } => after_s,
        State::UpperBound => {
            let error = coefficient.square_error;
            length_s * (TWO_SIDED * error / coefficient.square.max(error)).powi(2)
        }
    };
    if needed_s > length_s {
        format!("{} more", duration(needed_s - length_s))
    } else {
        // Gaps have made less of this record than its length.
        format!("{} without gaps", duration(needed_s))
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::unit::Unit;

    /// Half a minute of white counts, with a line that is none.
    pub(in super::super) fn status() -> Status {
        let mut recording = Recording::new(
            100.0,
            0.01,
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
        Status::of(&recording, "curve.json saved 3 s ago".into())
    }

    #[test]
    fn line_has_every_axis_with_values_bounds_and_a_verdict() {
        let line = status().line();
        assert!(line.starts_with(
            "30.000 s (3000 samples); lines that were no samples: 1, gaps: 1; left: Q "
        ));
        assert_eq!(line.matches("adequate, p = 0.").count(), 2, "{line}");
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
                    assert_eq!(waiting, "no record would show it");
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
