//! Whether the contents of a certificate are possible: every number has a range, and numbers agree.

use super::{
    AxisCertificate, CertifiedBand, CertifiedEvent, CertifiedLimit, CertifiedShape, CertifiedSlope,
    CertifiedState, CertifiedTerm, CertifiedWhat, Conditions, Doubt, EffectCode, Findings,
};
use crate::{
    diagnosis::Verdict,
    numerics::real::real,
    record::integrity::Reason,
    theory::effect::{Effect, Span},
};

/// The largest ratio of two durations of one record, by the clock of the gyro and by that of whoever measured the time.
const CLOCKS: f64 = 1.1;

impl Conditions {
    /// Whether a gyro can have been measured under these conditions.
    pub(super) fn are_possible(&self) -> bool {
        let temperature = self
            .temperature_c
            .is_none_or(|(low, high)| (-273.15..=high).contains(&low) && high.is_finite());
        // The longest time is thirty thousand years. Samples may be missing, but there are no more than the time allows.
        let most = CLOCKS * self.duration_s * self.rate_hz + 1.0;
        temperature
            && (1e-6..=1e12).contains(&self.duration_s)
            && (1e-6..=1e9).contains(&self.rate_hz)
            && self.samples > 0
            && self.samples as f64 <= most
            && self.gaps <= self.samples
    }
}

impl AxisCertificate {
    /// Whether a fit of a record under these conditions can have these results.
    pub(super) fn is_possible(&self, conditions: &Conditions) -> bool {
        let chi_squared = self.chi_squared.is_nan() || self.chi_squared >= 0.0;
        let p_value = self.p_value.is_nan() || (0.0..=1.0).contains(&self.p_value);
        let tolerance = self.tolerance.is_finite() && self.tolerance >= 0.0;
        let known =
            |i: usize| self.chi_squared.is_finite() && self.terms.get(i).is_some_and(is_known);
        let mut pairs = (0..self.terms.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
        chi_squared
            && p_value
            && (self.chi_squared.is_nan() <= self.p_value.is_nan())
            && tolerance
            && self.terms.iter().all(CertifiedTerm::is_possible)
            && pairs.all(|(i, j)| {
                let correlation = self.correlations.get(i, j);
                let twice = self.terms.get(i).zip(self.terms.get(j));
                let distinct = twice.is_none_or(|(one, other)| !one.repeats(other));
                // Rounding can make a correlation slightly larger than one. It may be unknown unless
                // both coefficients were measured.
                let ranged = correlation.abs() <= 1.001;
                distinct && (ranged || (correlation.is_nan() && !(known(i) && known(j))))
            })
            && self.limits.iter().all(CertifiedLimit::is_possible)
            && self.verdict.is_none_or(is_possible_verdict)
            && self.findings.are_possible(&self.terms, conditions)
    }
}

fn is_known(term: &CertifiedTerm) -> bool {
    term.state == CertifiedState::Measured && term.square_error.is_finite()
}

impl CertifiedTerm {
    fn is_possible(&self) -> bool {
        let value = self.value.is_finite() && self.value >= 0.0;
        // A comparison with NaN is false.
        let interval = self.lower >= 0.0 && self.lower.is_finite() && self.lower <= self.upper;
        let state = match self.state {
            CertifiedState::Measured => {
                self.lower <= self.value && self.value <= self.upper && self.upper.is_finite()
            }
            CertifiedState::UpperBound => self.lower == 0.0,
            CertifiedState::NotObservable { after_s } => {
                self.lower == 0.0 && after_s.is_none_or(|after_s| after_s > 0.0)
            }
        };
        value && interval && self.square_error >= 0.0 && state && self.has_possible_shape()
    }

    fn has_possible_shape(&self) -> bool {
        let Some(effect) = self.effect.effect() else {
            return self.shape.iter().all(CertifiedShape::is_possible);
        };
        let mut shape = self.shape.iter().enumerate();
        self.shape.len() == effect.parameters().len()
            && shape.all(|(i, one)| one.is_possible() && one.is_in_range(effect, i))
    }

    /// Whether this is the same effect with the same shape as another term, which a model holds once.
    fn repeats(&self, other: &Self) -> bool {
        let mut shapes = self.shape.iter().zip(&other.shape);
        self.effect != EffectCode::OTHER
            && self.effect == other.effect
            && self.shape.len() == other.shape.len()
            && shapes.all(|(one, other)| one.value == other.value)
    }
}

impl CertifiedLimit {
    fn is_possible(&self) -> bool {
        // A comparison with NaN is false.
        let size = self.size > 0.0 && self.size.is_finite();
        size && 0.0 <= self.low && self.low <= self.high && self.high.is_finite()
    }
}

impl Findings {
    /// Whether a diagnosis of a record under these conditions that ends with these terms can find this.
    fn are_possible(&self, terms: &[CertifiedTerm], conditions: &Conditions) -> bool {
        let one = self.covariates.first().map(|slope| slope.covariate);
        let twice = self
            .covariates
            .get(1)
            .is_some_and(|other| one == Some(other.covariate));
        let mut events = self.events.iter().flatten();
        // Two effects may be in doubt with the same other one, and one effect that is there twice with two.
        let in_model = |doubt: &Doubt| terms.iter().any(|term| term.effect == doubt.effect);
        let highest_hz = 0.5 * CLOCKS * conditions.rate_hz;
        let in_spectrum = |band: &CertifiedBand| f64::from(band.to_hz) <= highest_hz;
        let latest_s = CLOCKS * conditions.duration_s;
        let in_record = |event: &CertifiedEvent| f64::from(event.at_s) <= latest_s;
        !twice
            && self.covariates.iter().all(CertifiedSlope::is_possible)
            && self.doubts.iter().all(in_model)
            && self
                .bands
                .iter()
                .all(|band| band.is_possible() && in_spectrum(band))
            && events.all(|event| event.is_possible() && in_record(event))
    }
}

impl CertifiedSlope {
    fn is_possible(&self) -> bool {
        self.value.is_finite() && self.error > 0.0 && self.error.is_finite()
    }
}

impl CertifiedBand {
    fn is_possible(&self) -> bool {
        // A comparison with NaN is false.
        let ends = 0.0 < self.from_hz && self.from_hz <= self.to_hz && self.to_hz.is_finite();
        ends && self.z.is_finite() && self.z != 0.0
    }
}

impl CertifiedEvent {
    fn is_possible(&self) -> bool {
        let interval = self.lower <= self.size && self.size <= self.upper;
        let ends = self.lower.is_finite() && self.upper.is_finite();
        let is_time = |seconds: f32| seconds >= 0.0 && seconds.is_finite();
        let kind = match self.what {
            CertifiedWhat::NoiseChange => self.size > 0.0,
            CertifiedWhat::Bursts { blocks } => self.size > 0.0 && (1..=64).contains(&blocks),
            CertifiedWhat::Step => true,
            CertifiedWhat::WarmUp { time_constant_s } => {
                time_constant_s > 0.0 && is_time(time_constant_s)
            }
        };
        interval && ends && is_time(self.at_s) && self.z.is_finite() && kind
    }
}

impl CertifiedShape {
    fn is_possible(&self) -> bool {
        let unknown = self.lower.is_nan() && self.upper.is_nan();
        let ordered = 0.0 <= self.lower && self.lower <= self.value && self.value <= self.upper;
        self.value.is_finite() && self.value > 0.0 && (unknown || ordered)
    }

    /// Whether a parameter that takes whole numbers only has one of them.
    fn is_in_range(&self, effect: &dyn Effect, parameter: usize) -> bool {
        // The range of a whole number does not depend on the span.
        const ANY: Span = Span {
            interval_s: 1.0,
            longest_tau_s: 1.0,
        };
        let range = effect.search_range(parameter, &ANY);
        let value = real(self.value);
        let allowed = range.is_none_or(|range| (range.low..=range.high).contains(&value));
        !effect.is_whole(parameter) || (value % 1.0 == 0.0 && allowed)
    }
}

fn is_possible_verdict(verdict: Verdict) -> bool {
    let Verdict::Invalid(reason) = verdict else {
        return true;
    };
    match reason {
        Reason::Stuck {
            longest_run,
            changes,
            samples,
        } => u64::from(longest_run) <= samples && changes <= samples,
        Reason::Railed { hits, samples } => hits <= samples,
        Reason::Spiked { percent, .. } | Reason::Moved { percent, .. } => percent <= 100,
        Reason::Missing { missing, sent } => missing <= sent,
        Reason::LeftOut { left_out, samples } => left_out <= samples,
        Reason::Repeated {
            times,
            changes,
            samples,
        } => times <= 4 && changes <= samples,
        Reason::DeadBand { zeros, samples } => zeros <= samples,
        Reason::Misread { bits } => bits <= 32,
        Reason::Coarse { per_mille } => per_mille < 1000,
        Reason::Changed { percent, .. } => percent != 100,
        Reason::Unanswered { reads, samples } => reads <= samples,
        Reason::Stale { stale, samples, .. } => stale <= samples,
    }
}
