//! The noise of one axis in radians and seconds: best fit, limits and overbounds.

use super::given::Given;
use crate::{
    command::{fit::fitted::Fitted, output::number::duration},
    confidence::{Limits, limits},
    equivalent::Equivalent,
    overbound::Overbound,
};
use allanite::{Coefficient, fit::State};

/// The noise of one axis.
pub(super) struct AxisNoise {
    pub(super) name: String,
    pub(super) rate_hz: f64,
    pub(super) samples: u64,
    /// The five coefficients, in radians and seconds.
    pub(super) coefficients: Vec<Coefficient>,
    pub(super) p_value: f64,
    pub(super) overbound: Overbound,
    pub(super) overbound_with_process: Overbound,
    /// A Gauss–Markov process in place of the bias instability; `None` if that is not observable.
    pub(super) equivalent: Option<Equivalent>,
    pub(super) octaves: Vec<Octave>,
}

/// One octave, with deviations in rad/s.
pub(super) struct Octave {
    pub(super) tau_s: f64,
    pub(super) m: u32,
    pub(super) differences: u64,
    pub(super) deviation: f64,
    pub(super) lower: f64,
    pub(super) upper: f64,
    pub(super) model: f64,
    pub(super) overbound: f64,
}

impl AxisNoise {
    /// The noise of a fitted axis, or `None` if the limits of its curve are not finite.
    pub(super) fn of(fitted: Fitted) -> Option<Self> {
        let Fitted {
            axis,
            curve,
            model,
            fit,
            ..
        } = fitted;
        let radians = axis.unit.in_si();
        let limits = limits(&curve, &model, &fit);
        let overbound = Overbound::of(&curve, &limits)?;
        let with_process = Overbound::with_gauss_markov(&curve, &limits)?;
        let squares = fit.squares();
        let interval_s = curve.interval_s();
        let octave = |(point, limits): (&allanite::curve::Point, &Limits)| Octave {
            tau_s: point.tau_s,
            m: point.m,
            differences: point.differences,
            deviation: radians * point.deviation(),
            lower: radians * limits.lower.sqrt(),
            upper: radians * limits.upper.sqrt(),
            model: radians * model.variance(&squares, point.m, interval_s).sqrt(),
            overbound: radians * overbound.variance(point.m, interval_s).sqrt(),
        };
        let octaves = curve.points().iter().zip(&limits).map(octave).collect();
        let flicker = fit.coefficients.iter().find(|one| one.symbol == "B");
        let flicker = flicker.and_then(|one| usable(one).value());
        let equivalent = flicker.and_then(|b| Equivalent::of(&curve, &model, &squares, b));
        Some(Self {
            rate_hz: axis.rate_hz,
            samples: axis.samples,
            name: axis.axis,
            coefficients: fit
                .coefficients
                .iter()
                .map(|one| scaled(one, radians))
                .collect(),
            p_value: fit.p_value,
            overbound: overbound.scaled(radians),
            overbound_with_process: with_process.scaled(radians),
            equivalent: equivalent.map(|found| Equivalent {
                process: crate::overbound::GaussMarkovProcess {
                    sigma: radians * found.process.sigma,
                    ..found.process
                },
                ..found
            }),
            octaves,
        })
    }

    /// The number that a filter may use for the coefficient with this symbol: its value or its upper
    /// bound.
    pub(super) fn best(&self, symbol: &str) -> Given {
        let found = self.coefficients.iter().find(|one| one.symbol == symbol);
        found.map_or_else(
            || Given::Missing {
                why: "not in the model".into(),
            },
            usable,
        )
    }

    /// White noise of the overbound, in rad/s/√Hz.
    pub(super) fn overbound_density(&self) -> Given {
        self.needed(self.overbound.noise_density, "N", "the random walk")
    }

    /// Random walk of the overbound, in rad/s²/√Hz.
    pub(super) fn overbound_walk(&self) -> Given {
        self.needed(self.overbound.random_walk, "K", "white noise")
    }

    /// A coefficient of the overbound. It is zero if the other coefficient alone is above the curve;
    /// then the upper bound of the fit stands in for it.
    fn needed(&self, value: f64, symbol: &str, other: &str) -> Given {
        if value > 0.0 {
            return Given::plain(value);
        }
        let coefficient = self.coefficients.iter().find(|one| one.symbol == symbol);
        let bound = coefficient.map_or(f64::INFINITY, |one| one.upper);
        if bound.is_finite() && bound > 0.0 {
            Given::Number {
                value: bound,
                remark: format!(
                    "{other} alone is above the curve; this is the upper bound (95 %) of the fit"
                ),
            }
        } else {
            Given::Missing {
                why: format!("{other} alone is above the curve, and the record does not bound it"),
            }
        }
    }
}

/// The number that a filter may use for a coefficient, or the reason why there is none.
fn usable(coefficient: &Coefficient) -> Given {
    match coefficient.state {
        State::Measured => Given::plain(coefficient.value),
        State::UpperBound => Given::Number {
            value: coefficient.upper,
            remark: "upper bound: its interval includes 0".into(),
        },
        State::NotObservable { after_s } => Given::Missing {
            why: match after_s {
                Some(after_s) => format!(
                    "not observable in this record; a record of {} would show it",
                    duration(after_s)
                ),
                None => "not observable in this record".into(),
            },
        },
    }
}

fn scaled(coefficient: &Coefficient, factor: f64) -> Coefficient {
    Coefficient {
        value: factor * coefficient.value,
        lower: factor * coefficient.lower,
        upper: factor * coefficient.upper,
        square: factor * factor * coefficient.square,
        square_error: factor * factor * coefficient.square_error,
        ..*coefficient
    }
}
