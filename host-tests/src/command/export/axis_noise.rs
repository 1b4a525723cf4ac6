//! The noise of one axis in radians and seconds: best fit, limits and overbounds.

use super::given::Given;
use crate::{
    command::{fit::fitted::Fitted, output::number::duration},
    confidence::{Limits, limits},
    curve_file::AxisCurve,
    equivalent::Equivalent,
    log::{BINS, OCTAVES},
    overbound::Overbound,
    plot::relative_error,
};
use allanite::{
    Coefficient, Comparison, Curve, Model, Record, Scale,
    course::Course,
    fit::{Fit, State},
};

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
    pub(super) bins: Vec<Bin>,
    pub(super) blocks: Vec<Block>,
}

/// One bin of the spectrum, with roots of one-sided densities in rad/s/√Hz.
pub(super) struct Bin {
    pub(super) frequency_hz: f64,
    pub(super) block: u32,
    pub(super) segments: u32,
    pub(super) density: f64,
    pub(super) standard_error: f64,
    pub(super) expected: f64,
    /// How far the measured density lies above the expected one, in standard errors.
    pub(super) z: f64,
}

/// One block of the course of a log, with rates in rad/s.
pub(super) struct Block {
    pub(super) start_s: f64,
    pub(super) duration_s: f64,
    pub(super) samples: u32,
    pub(super) mean: f64,
    /// Root of half the mean square of the differences of neighbouring samples.
    pub(super) noise: f64,
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

/// The bins of an axis beside the fit of its five terms, in order of their frequencies.
fn bins(axis: &AxisCurve, curve: &Curve<OCTAVES>, model: &Model, fit: &Fit) -> Option<Vec<Bin>> {
    let spectrum = axis.spectrum().ok()?;
    let observed = Record::<OCTAVES, BINS>::new(curve, &spectrum);
    let comparison = Comparison::new(observed, model, fit).ok()?;
    let radians = axis.unit.in_si();
    let bins = comparison.bins.iter().map(|compared| {
        let density = radians * compared.bin.density.sqrt();
        Bin {
            frequency_hz: compared.bin.frequency_hz,
            block: compared.bin.block,
            segments: compared.bin.segments,
            density,
            // The relative error of a root is half that of its square.
            standard_error: 0.5 * density * relative_error(&compared.bin),
            expected: radians * compared.model.sqrt(),
            z: compared.z,
        }
    });
    let mut bins: Vec<Bin> = bins.collect();
    bins.sort_by(|one, other| one.frequency_hz.total_cmp(&other.frequency_hz));
    Some(bins)
}

impl AxisNoise {
    /// The noise of a fitted axis, or `None` if the limits of its curve are not finite.
    /// The course is that of a log.
    pub(super) fn of(fitted: Fitted, course: Option<Course>) -> Option<Self> {
        let Fitted {
            axis,
            curve,
            model,
            fit,
            ..
        } = fitted;
        let radians = axis.unit.in_si();
        let bins = bins(&axis, &curve, &model, &fit);
        let scale = Scale::new(axis.rate_per_count, axis.rate_hz).ok()?;
        let blocks = course.iter().flat_map(|course| course.blocks(scale));
        let blocks = blocks.filter(|block| block.samples > 0).map(|block| Block {
            start_s: block.start_s,
            duration_s: block.duration_s,
            samples: block.samples,
            mean: radians * block.mean,
            noise: radians * (0.5 * block.mean_square_difference).sqrt(),
        });
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
            bins: bins.unwrap_or_default(),
            blocks: blocks.collect(),
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
