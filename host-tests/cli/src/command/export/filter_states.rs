//! What a model has beside white noise and a random walk, sorted by what a filter does with it: states that it carries,
//! oscillations that a notch takes out, dependences that are subtracted, and what it leaves.

use super::explained::{Dependence, Explained};
use allanite::{
    Term,
    effect::{AngleRandomWalk, BiasInstability, Effect, GaussMarkov, RateRandomWalk, Resonance},
    fit::ShapeEstimate,
};
use allanite_host::{
    dependence::candidates::Form, known_filter::is_filter, overbound::GaussMarkovProcess,
    words::plain,
};
use std::f64::consts::PI;

/// What a model has beside its white noise and its random walk, in radians and seconds.
#[derive(Default)]
pub(super) struct FilterStates {
    /// Processes that a filter can follow.
    pub(super) processes: Vec<Process>,
    /// Processes that are white noise to every filter.
    pub(super) fast: Vec<Process>,
    /// Oscillations that a notch takes out.
    pub(super) notched: Vec<Oscillation>,
    /// Oscillations that are too slow for a notch.
    pub(super) slow: Vec<Oscillation>,
    /// Oscillations that are white noise to every filter.
    pub(super) damped: Vec<Oscillation>,
    pub(super) dependences: Vec<Correction>,
    /// The filters that the white noise has passed.
    pub(super) filters: Vec<Term>,
    /// The effects that are in none of these places, by name. Bias instability has a place of its own.
    pub(super) left: Vec<&'static str>,
}

/// A process whose correlation time is no longer than this number of samples is white noise to a filter: that of the
/// density which it has at low frequencies. White noise behind a low pass of one pole is such a process. Chosen by hand:
/// no filter is told the angle more than once in ten samples.
pub(super) const FAST_SAMPLES: f64 = 10.0;

/// A value with its 95 % interval.
#[derive(Clone, Copy, Default)]
pub(super) struct Interval {
    pub(super) value: f64,
    pub(super) lower: f64,
    pub(super) upper: f64,
}

/// A Gauss–Markov process of the model, or one with its covariances.
pub(super) struct Process {
    pub(super) process: GaussMarkovProcess,
    /// The intervals of σ, in rad/s, and of the correlation time, in seconds.
    pub(super) sigma: Interval,
    pub(super) time_s: Interval,
}

/// An oscillation.
pub(super) struct Oscillation {
    pub(super) effect: &'static str,
    pub(super) frequency_hz: Interval,
    /// Amplitude of a sinusoid or root-mean-square of a resonance, in rad/s, and the name of that number.
    pub(super) size: Interval,
    pub(super) size_name: &'static str,
    /// The time in seconds in which its phase is lost, with the quality factor; `None` for a line, whose phase lasts.
    pub(super) decay: Option<Decay>,
}

/// How an oscillation loses its phase.
pub(super) struct Decay {
    pub(super) time_s: f64,
    pub(super) quality: Interval,
}

/// A dependence that is subtracted before the filter.
pub(super) struct Correction {
    pub(super) column: String,
    /// The power of the column less its reference.
    pub(super) kind: Kind,
    /// The coefficient in rad/s per unit of the column to that power, with its 95 % interval.
    pub(super) slope: Interval,
    /// What is subtracted from the column: the centre of a square, or else its mean. `None` if that is not known.
    pub(super) reference: Option<f64>,
    pub(super) lag_s: Option<f64>,
}

/// What of a column the rate follows.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Column,
    RateOfChange,
    Square,
}

impl Kind {
    /// The name in files.
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Column => "column",
            Self::RateOfChange => "rate_of_change",
            Self::Square => "square",
        }
    }
}

/// An oscillation with a period of more samples is too slow for a notch, which would take out motion, and a filter
/// carries it as two states. Chosen by hand.
const SLOW_SAMPLES: f64 = 100.0;

/// Whether a term is a line or another hump at a frequency of its own.
fn is_oscillation(term: &Term) -> bool {
    let description = term.effect.description();
    let first = description.parameters.first();
    first.is_some_and(|first| first.name == "frequency_hz") && description.replaces.is_none()
}

/// Whether a term is an oscillation that a notch takes out at this sample rate.
pub(super) fn is_notched(term: &Term, rate_hz: f64) -> bool {
    is_oscillation(term) && term.parameters[0] * SLOW_SAMPLES >= rate_hz
}

/// Whether a term is Gauss–Markov noise, or has its covariances: a Kalman filter knows no more of a noise.
fn is_first_order(term: &Term) -> bool {
    let gauss_markov = GaussMarkov.description().name;
    let mirror = term.effect.mirror().map(|mirror| mirror.name());
    term.effect.name() == gauss_markov || mirror == Some(gauss_markov)
}

impl FilterStates {
    /// Sorts the terms of a model.
    pub(super) fn of(explained: &Explained) -> Self {
        let radians = explained.axis.unit.in_si();
        let fit = &explained.fit;
        let shape = |at: usize, place: usize| {
            let term = &explained.model.terms()[at];
            let value = term.parameters[place];
            let name = term.effect.parameters().get(place).map(|one| one.name);
            let mut fitted = fit.shape.iter();
            let estimate = fitted.find(|one| one.term == at && Some(one.name) == name);
            let ends = estimate.map_or([value; 2], |ShapeEstimate { lower, upper, .. }| {
                [*lower, *upper]
            });
            Interval {
                value,
                lower: ends[0],
                upper: ends[1],
            }
        };
        let size = |at: usize| {
            let one = &fit.coefficients[at];
            Interval {
                value: radians * one.value,
                lower: radians * one.lower,
                upper: radians * one.upper,
            }
        };
        let mut states = Self {
            dependences: explained
                .dependences
                .iter()
                .map(|one| Correction::of(one, radians))
                .collect(),
            ..Self::default()
        };
        let carried = [
            AngleRandomWalk.description().name,
            BiasInstability.description().name,
            RateRandomWalk.description().name,
        ];
        for (at, term) in explained.model.terms().iter().enumerate() {
            let name = term.effect.name();
            if fit.coefficients[at].value == 0.0 || carried.contains(&name) {
                continue;
            }
            if is_first_order(term) {
                let (sigma, time_s) = (size(at), shape(at, 0));
                let is_fast = time_s.value * explained.axis.rate_hz <= FAST_SAMPLES;
                let list = match is_fast {
                    true => &mut states.fast,
                    false => &mut states.processes,
                };
                list.push(Process {
                    process: GaussMarkovProcess {
                        sigma: sigma.value,
                        correlation_time_s: time_s.value,
                    },
                    sigma,
                    time_s,
                });
            } else if is_oscillation(term) {
                let is_resonance = name == Resonance.description().name;
                let oscillation = Oscillation {
                    effect: name,
                    frequency_hz: shape(at, 0),
                    size: size(at),
                    size_name: term.effect.coefficient(),
                    decay: is_resonance.then(|| Decay {
                        time_s: term.parameters[1] / (PI * term.parameters[0]),
                        quality: shape(at, 1),
                    }),
                };
                let list = if oscillation.is_white(explained.axis.rate_hz) {
                    &mut states.damped
                } else if is_notched(term, explained.axis.rate_hz) {
                    &mut states.notched
                } else {
                    &mut states.slow
                };
                list.push(oscillation);
            } else if is_filter(term.effect) {
                states.filters.push(*term);
            } else {
                states.left.push(name);
            }
        }
        states
    }

    /// What the model has beside white noise, random walk and bias instability, a line each.
    pub(super) fn lines(&self) -> Vec<String> {
        use allanite_host::number::number;
        let interval = |one: &Interval, unit: &str| {
            format!(
                "{} {unit} ({} to {}, 95 %)",
                number(one.value),
                number(one.lower),
                number(one.upper)
            )
        };
        let mut lines = Vec::new();
        let slow = self.processes.iter().map(|one| (one, ""));
        let fast = self
            .fast
            .iter()
            .map(|one| (one, ", which is white noise to a filter"));
        for (Process { sigma, time_s, .. }, remark) in slow.chain(fast) {
            lines.push(format!(
                "Gauss-Markov process: sigma {}, correlation time {}{remark}",
                interval(sigma, "rad/s"),
                interval(time_s, "s")
            ));
        }
        let notched = self.notched.iter().map(|one| (one, "notch at"));
        let slow = self
            .slow
            .iter()
            .map(|one| (one, "two states, too slow for a notch, at"));
        let damped = self
            .damped
            .iter()
            .map(|one| (one, "white noise to a filter, without a notch, at"));
        for (one, what) in notched.chain(slow).chain(damped) {
            lines.push(format!(
                "{what} {}: {}, {} {}",
                interval(&one.frequency_hz, "Hz"),
                plain(one.effect),
                plain(one.size_name),
                interval(&one.size, "rad/s")
            ));
        }
        for one in &self.dependences {
            lines.push(format!("subtract {}", one.words()));
        }
        for filter in &self.filters {
            lines.push(format!(
                "white noise has passed a filter ({}): N is its density far below the cutoff, and what a sample scatters \
                 by is less than N times the root of the rate",
                plain(filter.effect.name())
            ));
        }
        lines
    }
}

impl Process {
    /// The density of the process far below its corner, `σ √(2T)` in rad/s/√Hz, with the ends of both intervals.
    fn density(&self) -> Interval {
        let density = |sigma: f64, time_s: f64| sigma * (2.0 * time_s).sqrt();
        Interval {
            value: density(self.sigma.value, self.time_s.value),
            lower: density(self.sigma.lower, self.time_s.lower),
            upper: density(self.sigma.upper, self.time_s.upper),
        }
    }

    /// The density of the white noise that drives the process, `σ √(2/T)` in rad/s²/√Hz.
    pub(super) fn driving(&self) -> f64 {
        self.process.driving()
    }
}

impl Oscillation {
    /// The time in which its phase is lost, in seconds.
    pub(super) fn time_s(&self) -> Option<f64> {
        self.decay.as_ref().map(|decay| decay.time_s)
    }

    /// The density of the white noise that drives it, `σ √(2/T)` in rad/s²/√Hz; zero for a line, whose phase lasts.
    pub(super) fn driving(&self) -> f64 {
        self.time_s()
            .map_or(0.0, |time_s| self.size.value * (2.0 / time_s).sqrt())
    }

    /// Whether it dies away within a period and within the samples that no filter resolves, so that it is a rounded step
    /// in the spectrum, and nothing that a notch takes out.
    fn is_white(&self, rate_hz: f64) -> bool {
        let samples = |decay: &Decay| decay.time_s * rate_hz;
        self.decay
            .as_ref()
            .is_some_and(|decay| decay.quality.value < 1.0 && samples(decay) <= FAST_SAMPLES)
    }

    /// Its density far below its frequency, `σ √(2T / (1 + (2πfT)²))` in rad/s/√Hz with `2πfT` twice the quality factor,
    /// with the ends of the three intervals; zero for a line. No notch takes this part out.
    fn density(&self) -> Interval {
        let Some(decay) = &self.decay else {
            return Interval::default();
        };
        let density = |sigma: f64, frequency_hz: f64, quality: f64| {
            let time_s = quality / (PI * frequency_hz);
            sigma * (2.0 * time_s / (1.0 + 4.0 * quality * quality)).sqrt()
        };
        let Interval {
            value: frequency_hz,
            lower: slowest_hz,
            upper: fastest_hz,
        } = self.frequency_hz;
        // It falls with the frequency, and with the quality factor above a half.
        let Interval {
            value: quality,
            lower: broadest,
            upper: narrowest,
        } = decay.quality;
        Interval {
            value: density(self.size.value, frequency_hz, quality),
            lower: density(self.size.lower, fastest_hz, narrowest),
            upper: density(self.size.upper, slowest_hz, broadest.max(0.5)),
        }
    }
}

impl FilterStates {
    /// White noise of a density together with what is white noise to a filter: the fast processes, and what the
    /// oscillations have far below their frequencies.
    pub(super) fn with_fast(&self, white: Interval) -> Interval {
        let processes = self.fast.iter().map(Process::density);
        let oscillations = self.damped.iter().chain(&self.notched);
        let oscillations = oscillations.map(Oscillation::density);
        processes
            .chain(oscillations)
            .fold(white, |sum, density| Interval {
                value: sum.value.hypot(density.value),
                lower: sum.lower.hypot(density.lower),
                upper: sum.upper.hypot(density.upper),
            })
    }

    /// Whether anything but N is white noise to a filter.
    pub(super) fn has_fast(&self) -> bool {
        let mut oscillations = self.damped.iter().chain(&self.notched);
        !self.fast.is_empty() || oscillations.any(|one| one.decay.is_some())
    }
}

impl Correction {
    fn of(dependence: &Dependence, radians: f64) -> Self {
        let (lower, upper) = dependence.slope.interval();
        let (kind, reference, lag_s) = match &dependence.series.form {
            Form::Itself => (Kind::Column, dependence.mean, None),
            Form::Behind(lag) => (Kind::Column, dependence.mean, Some(lag.lag_s)),
            Form::RateOfChange => (Kind::RateOfChange, None, None),
            Form::Square { centre, lag_s } => (Kind::Square, Some(*centre), *lag_s),
        };
        Self {
            column: dependence.series.column.clone(),
            kind,
            slope: Interval {
                value: radians * dependence.slope.value,
                lower: radians * lower,
                upper: radians * upper,
            },
            reference,
            lag_s,
        }
    }

    /// The dependence as a formula.
    fn words(&self) -> String {
        use allanite_host::number::number;
        let column = format!("{:?}", self.column);
        let column = match self.lag_s {
            Some(lag_s) => format!("{column} behind a lag of {} s", number(lag_s)),
            None => column,
        };
        let from = self.reference.map_or_else(
            || column.clone(),
            |reference| format!("({column} - {})", number(reference)),
        );
        let of = match self.kind {
            Kind::Column => from,
            Kind::RateOfChange => format!("the change per second of {from}"),
            Kind::Square => format!("{from}^2"),
        };
        format!(
            "{} rad/s ({} to {}, 95 %) times {of}",
            number(self.slope.value),
            number(self.slope.lower),
            number(self.slope.upper)
        )
    }
}
