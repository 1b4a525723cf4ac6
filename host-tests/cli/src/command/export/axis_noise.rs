//! The noise of one axis in radians and seconds: best fit, limits and overbounds.

use super::{
    explained::Explained,
    filter_states::{self, FilterStates, Interval, Oscillation, Process},
    given::Given,
};
use allanite::{Coefficient, Comparison, Record, Scale, course::Course, fit::State};
use allanite_host::{
    confidence::{Limits, limits},
    equivalent::Equivalent,
    number::{duration, number},
    overbound::{GaussMarkovProcess, Overbound},
};
use allanite_log::{BINS, OCTAVES, unit::Sensor};
use allanite_plot::relative_error;

/// The ratio of neighbouring correlation times of processes that stand for flicker noise. Chosen by hand: the sum differs
/// from flicker noise by some per cent in between.
const FLICKER_STEP: f64 = 4.0;

/// What the walk of flicker noise is multiplied by. Bias instability and white noise have the same density at an angular
/// frequency of `(B/N)²`, and so has a random walk of `B²/N`. Twice that walk has, with the white noise, at no frequency
/// less than 94 % of the density of flicker and white noise together. The page of the study `export` set it, with 200 gyros
/// apart from those that the study counts.
const FLICKER_WALK: f64 = 2.0;

/// The noise of one axis.
pub(super) struct AxisNoise {
    pub(super) name: String,
    /// Rates are in rad/s for a gyro, and accelerations in m/s² for an accelerometer.
    pub(super) sensor: Sensor,
    pub(super) rate_hz: f64,
    pub(super) samples: u64,
    /// The model in words, and what is said of it.
    pub(super) model: String,
    pub(super) verdict: String,
    /// The coefficients of the model, in radians and seconds.
    pub(super) coefficients: Vec<Coefficient>,
    /// What the model has beside its noise: what a filter carries, takes out or leaves.
    pub(super) states: FilterStates,
    pub(super) is_adequate: Option<bool>,
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

/// The bins of an axis beside its model, in order of their frequencies.
fn bins(explained: &Explained) -> Vec<Bin> {
    let observed = Record::<OCTAVES, BINS>::new(&explained.curve, &explained.spectrum);
    let Ok(comparison) = Comparison::new(observed, &explained.model, &explained.fit) else {
        return Vec::new();
    };
    let radians = explained.axis.unit.in_si();
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
    bins
}

/// The blocks of a course that have samples.
fn blocks(course: Option<&Course>, scale: Option<Scale>, radians: f64) -> Vec<Block> {
    let both = course.zip(scale);
    let blocks = both.map_or_else(Vec::new, |(course, scale)| course.blocks(scale).collect());
    let blocks = blocks.into_iter().filter(|block| block.samples > 0);
    let blocks = blocks.map(|block| Block {
        start_s: block.start_s,
        duration_s: block.duration_s,
        samples: block.samples,
        mean: radians * block.mean,
        noise: radians * (0.5 * block.mean_square_difference).sqrt(),
    });
    blocks.collect()
}

/// The limits of every octave without what is taken out before a filter. The share of the rest is that of the model.
fn without_oscillations(explained: &Explained, limits: &[Limits]) -> Vec<Limits> {
    let Explained {
        curve, model, fit, ..
    } = explained;
    let all = fit.squares();
    let mut rest = all;
    for (square, term) in rest.iter_mut().zip(model.terms()) {
        if filter_states::is_notched(term, explained.axis.rate_hz) {
            *square = 0.0;
        }
    }
    let interval_s = curve.interval_s();
    let octaves = curve.points().iter().zip(limits);
    let of_rest = octaves.map(|(point, limits)| {
        let [rest, all] = [&rest, &all].map(|squares| model.variance(squares, point.m, interval_s));
        let share = rest / all;
        Limits {
            lower: share * limits.lower,
            upper: share * limits.upper,
        }
    });
    of_rest.collect()
}

impl AxisNoise {
    /// The noise of an axis, or `None` if the limits of its curve are not finite.
    pub(super) fn of(explained: &Explained) -> Option<Self> {
        let Explained {
            axis,
            curve,
            model,
            fit,
            ..
        } = explained;
        let radians = axis.unit.in_si();
        let scale = Scale::new(axis.rate_per_count, axis.rate_hz).ok();
        let limits = limits(curve, model, fit);
        let rest = without_oscillations(explained, &limits);
        let overbound = Overbound::of(curve, &rest)?;
        let with_process = Overbound::with_gauss_markov(curve, &rest)?;
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
        let flicker = fit.coefficients.iter().find(|one| one.symbol == "B");
        let flicker = flicker.and_then(|one| usable(one).value());
        let equivalent = flicker.and_then(|b| Equivalent::of(curve, model, &squares, b));
        Some(Self {
            rate_hz: axis.rate_hz,
            samples: axis.samples,
            name: axis.axis.clone(),
            sensor: axis.unit.sensor(),
            model: explained.model_name.clone(),
            verdict: explained.verdict.clone(),
            coefficients: fit
                .coefficients
                .iter()
                .map(|one| scaled(one, radians))
                .collect(),
            states: FilterStates::of(explained),
            is_adequate: fit.is_adequate(),
            p_value: fit.p_value,
            overbound: overbound.scaled(radians),
            overbound_with_process: with_process.scaled(radians),
            equivalent: equivalent.map(|found| Equivalent {
                process: GaussMarkovProcess {
                    sigma: radians * found.process.sigma,
                    ..found.process
                },
                ..found
            }),
            octaves: curve.points().iter().zip(&limits).map(octave).collect(),
            bins: bins(explained),
            blocks: blocks(explained.course.as_ref(), scale, radians),
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

    /// White noise for a filter, in rad/s/√Hz: N and the processes that are too fast for it.
    pub(super) fn white(&self) -> Given {
        let own = self.best("N");
        if !self.states.has_fast() {
            return own;
        }
        Given::Number {
            value: self.white_interval().value,
            remark: "N and what else is white noise to a filter".into(),
        }
    }

    /// White noise for a filter with its 95 % interval; infinite above if the record does not bound N.
    pub(super) fn white_interval(&self) -> Interval {
        let own = self.coefficients.iter().find(|one| one.symbol == "N");
        let own = own.map_or(Interval::default(), |one| Interval {
            value: one.value,
            lower: one.lower,
            upper: one.upper,
        });
        self.states.with_fast(own)
    }

    /// The random walk for a filter that has no other state for the bias, in rad/s²/√Hz: one that is driven by as much
    /// white noise as K, the Gauss–Markov processes and the walk of flicker noise together changes as fast.
    /// Where the record shows neither of them, it is the least walk above the limits of the curve, which the bias may have.
    pub(super) fn walk(&self) -> Given {
        match self.walk_with(self.flicker_walk()) {
            Given::Missing { why } => match self.overbound_walk().value() {
                Some(value) => Given::Number {
                    value,
                    remark: format!(
                        "the least random walk above the limits of the curve, because K is {why}"
                    ),
                },
                None => Given::Missing { why },
            },
            given => given,
        }
    }

    /// The random walk for a program that takes the bias instability beside it, in rad/s²/√Hz.
    pub(super) fn walk_beside_flicker(&self) -> Given {
        self.walk_with(0.0)
    }

    fn walk_with(&self, flicker: f64) -> Given {
        let processes = self.states.processes.iter().map(Process::driving);
        let slow = self.states.slow.iter().map(Oscillation::driving);
        let processes = processes.chain(slow).fold(0.0, f64::hypot);
        let driving = processes.hypot(flicker);
        if driving == 0.0 {
            return self.best("K");
        }
        let what = match (flicker > 0.0, processes > 0.0) {
            (true, true) => "K, the bias instability and the slow processes change",
            (true, false) => "K and the bias instability change",
            _ => "K and the slow processes change",
        };
        Given::Number {
            value: self.measured("K").unwrap_or(0.0).hypot(driving),
            remark: format!("as fast as {what} the bias"),
        }
    }

    /// The length of the record in seconds.
    pub(super) fn duration_s(&self) -> f64 {
        self.samples as f64 / self.rate_hz
    }

    /// A Gauss–Markov process for a filter that has one state for the bias: the only process of the model, or one as long
    /// as the record. Over times far below T, a process with `σ = W √(T/2)` is a random walk of W. `None` without a walk.
    pub(super) fn bias_process(&self) -> Option<(GaussMarkovProcess, &'static str)> {
        let is_measured = |symbol: &&str| self.measured(symbol).is_some();
        let has_others = !self.states.slow.is_empty() || ["B", "K"].iter().any(is_measured);
        if let ([only], false) = (self.states.processes.as_slice(), has_others) {
            return Some((only.process, ""));
        }
        let walk = self.walk().value()?;
        let process = GaussMarkovProcess::of_walk(walk, self.duration_s());
        let words = match has_others || !self.states.processes.is_empty() {
            true => "all changes of the bias as a process as long as the record",
            false => "a bound of the bias's random walk as a process as long as the record",
        };
        Some((process, words))
    }

    /// The random walk in the place of the bias instability, in rad/s²/√Hz: `2 B²/N`, or less where flicker noise exceeds
    /// the white noise up to the frequencies that no filter resolves; zero if B is not measured.
    fn flicker_walk(&self) -> f64 {
        let Some(coefficient) = self.measured("B") else {
            return 0.0;
        };
        let fastest = self.rate_hz / filter_states::FAST_SAMPLES;
        let white = self.white().value();
        let corner = white.map_or(fastest, |white| (coefficient / white).powi(2).min(fastest));
        FLICKER_WALK * coefficient * corner.sqrt()
    }

    /// Gauss–Markov processes whose sum stands for the bias instability, from the sample interval to the length of the
    /// record; none if B is not measured. Flicker noise is a sum over the logarithm of the correlation time, with a
    /// variance of `B²/π` for each unit of it (Bernamont, Proc. Phys. Soc. 49, 138, 1937): `∫ 2T/(1 + ω²T²) dT/T = π/ω`.
    pub(super) fn flicker(&self) -> Vec<GaussMarkovProcess> {
        let Some(coefficient) = self.measured("B") else {
            return Vec::new();
        };
        let (shortest, longest) = (1.0 / self.rate_hz, self.duration_s());
        let steps = (longest / shortest).ln() / FLICKER_STEP.ln();
        let sigma = coefficient * (FLICKER_STEP.ln() / std::f64::consts::PI).sqrt();
        (0..=steps.ceil() as i32)
            .map(|step| GaussMarkovProcess {
                sigma,
                correlation_time_s: shortest * FLICKER_STEP.powi(step),
            })
            .collect()
    }

    /// The value of a coefficient that is measured.
    pub(super) fn measured(&self, symbol: &str) -> Option<f64> {
        let mut coefficients = self.coefficients.iter();
        let found = coefficients.find(|one| one.symbol == symbol)?;
        (found.state == State::Measured).then_some(found.value)
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
                    "not observable in this record; a record of {} would show it above {}",
                    duration(after_s),
                    number(coefficient.upper)
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
