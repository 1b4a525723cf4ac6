//! Where a model and a measurement disagree.

mod band;

pub use band::{Band, MAX_BANDS};

use crate::{
    curve::Point,
    error::Error,
    evidence::{observed::Observed, record::Record},
    fit::{Columns, Fit, Problem, Weights},
    limits::MAX_EFFECTS,
    list::{self, numbered},
    numerics::{
        deviance::judged,
        math,
        nnls::Vector,
        real::{Real, real, single},
    },
    spectrum::Bin,
    theory::{covariance::covariance_row, model::Model},
};
use heapless::Vec;

/// The number of standard errors from which on the disagreement of an octave is noticeable. By
/// convention: an octave of a true model exceeds it with a probability of 5 %.
const NOTICEABLE: Real = 2.0;

/// One octave of a measurement and of a model.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ComparedOctave {
    /// Averaging factor.
    pub m: u32,
    /// Averaging time, in seconds.
    pub tau_s: Real,
    /// Measured Allan variance, in rate units squared.
    pub measured: Real,
    /// The model's Allan variance, in rate units squared.
    pub model: Real,
    /// How far the measured variance lies above the model's, in standard errors of the measured
    /// variance. The standard error includes the model's tolerance.
    pub z: Real,
    /// Each effect's share of the model's variance, from 0 to 1, in the model's order.
    pub shares: [f32; MAX_EFFECTS],
}

impl ComparedOctave {
    /// How far the measured variance lies above the model's, in percent of the model's.
    pub fn percent(&self) -> Real {
        100.0 * (self.measured / self.model - 1.0)
    }

    /// Standard error of the measured variance, in rate units squared, the model's tolerance included.
    /// It is the unit of `z`. NaN where measurement and model agree to the last bit.
    pub fn standard_error(&self) -> Real {
        (self.measured - self.model) / self.z
    }
}

/// One bin of a measured density and of a model.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ComparedBin {
    /// What was measured.
    pub bin: Bin,
    /// The model's density, in rate units squared per hertz.
    pub model: Real,
    /// How far the measured density lies above the model's, in standard errors of the measured density. The
    /// standard error includes the model's tolerance.
    pub z: Real,
}

/// Neighbouring octaves that all disagree noticeably to the same side.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Stretch {
    /// Whether the measurement lies above the model.
    pub above: bool,
    /// Averaging time of the first octave, in seconds.
    pub from_s: Real,
    /// Averaging time of the last octave, in seconds.
    pub to_s: Real,
}

/// A measurement compared with a model, octave by octave and as a whole.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Comparison<const K: usize, const B: usize = 0> {
    /// The octaves, shortest averaging time first.
    pub octaves: Vec<ComparedOctave, K>,
    /// The bins of the density, those of the shortest blocks first. Empty without a density.
    pub bins: Vec<ComparedBin, B>,
    /// χ²: the squared disagreement of all that is fitted, in units of its covariance, corrected as that of a
    /// [`Fit`].
    pub chi_squared: Real,
    /// The number of octaves and bins that are fitted, less the number of unknowns.
    pub degrees_of_freedom: usize,
    /// Probability of a larger χ² or deviance if the model is true, as that of a [`Fit`]. NaN without degrees of freedom.
    pub p_value: Real,
    /// Root-mean-square disagreement of the octaves, in percent of the model's variance.
    pub rms_percent: Real,
}

impl<const K: usize, const B: usize> Comparison<K, B> {
    /// Compares the fit of a model with the curve that it was fitted to.
    ///
    /// # Errors
    /// The same as those of [`fit`](crate::fit::fit()), and [`Error::OtherModel`] if the fit is one of another model.
    pub fn new<'a>(
        record: impl Into<Record<'a, K, B>>,
        model: &Model,
        fit: &Fit,
    ) -> Result<Self, Error> {
        let observed = record.into().observed();
        let unknowns = observed.rows().saturating_sub(fit.degrees_of_freedom);
        let mut comparison = Self::with_unknowns(observed, model, fit, fit.tolerance, unknowns)?;
        if !fit.chi_squared.is_nan() {
            // The covariance at the end of a fit differs a little from the covariance at its result.
            comparison.chi_squared = fit.chi_squared;
            comparison.p_value = fit.p_value;
        }
        Ok(comparison)
    }

    /// Compares a fit with a curve that it was not fitted to, such as the curve of the other half of a
    /// record. No degree of freedom is spent. The model is granted `tolerance`, relative to its
    /// variance.
    ///
    /// # Errors
    /// The same as those of [`fit`](crate::fit::fit()), and [`Error::OtherModel`] if the fit is one of another model.
    pub fn held_out<'a>(
        record: impl Into<Record<'a, K, B>>,
        model: &Model,
        fit: &Fit,
        tolerance: Real,
    ) -> Result<Self, Error> {
        Self::with_unknowns(record.into().observed(), model, fit, tolerance, 0)
    }

    fn with_unknowns(
        observed: Observed<'_, K, B>,
        model: &Model,
        fit: &Fit,
        tolerance: Real,
        unknowns: usize,
    ) -> Result<Self, Error> {
        let names = model.terms().iter().map(|term| term.effect.name());
        if !names.eq(fit.coefficients.iter().map(|coefficient| coefficient.name)) {
            return Err(Error::OtherModel);
        }
        let columns = Columns::new(observed, model);
        let problem = Problem::new(observed, model, &columns);
        let squares = problem.squares_of(fit);
        let mut weights = Weights::EMPTY;
        weights.set(&problem, &squares, tolerance)?;
        let mut comparison = Self::EMPTY;
        comparison.set(&problem, &weights, &squares, unknowns);
        Ok(comparison)
    }

    /// Of nothing yet.
    // All zero, so that it is set where it stays and not moved there.
    pub(crate) const EMPTY: Self = Self {
        octaves: Vec::new(),
        bins: Vec::new(),
        chi_squared: 0.0,
        degrees_of_freedom: 0,
        p_value: 0.0,
        rms_percent: 0.0,
    };

    /// Compares the problem's curve with the model, in place.
    #[inline(never)]
    pub(crate) fn set(
        &mut self,
        problem: &Problem<'_, K, B>,
        weights: &Weights<K, B>,
        squares: &Vector,
        unknowns: usize,
    ) {
        self.octaves.clear();
        let mut sum_of_squares = 0.0;
        let points = problem.observed.curve().points();
        // The short octaves are not fitted where a density takes their place.
        let (short, fitted) = points.split_at(points.len().saturating_sub(problem.points.len()));
        for point in short {
            let octave = compare_short(problem, point, squares, weights.tolerance);
            sum_of_squares += octave.percent() * octave.percent();
            let _ = self.octaves.push(octave);
        }
        for (k, point) in numbered(fitted.iter()) {
            let model = problem.variance(k, squares);
            let octave = ComparedOctave {
                m: point.m,
                tau_s: point.tau_s,
                measured: point.variance,
                model: model * problem.variance_unit,
                z: (problem.measured(k) - model) / (weights.model[k] * weights.relative_error(k)),
                shares: core::array::from_fn(|i| single(problem.share(k, i, squares))),
            };
            sum_of_squares += octave.percent() * octave.percent();
            // There is a place for every octave of the curve.
            let _ = self.octaves.push(octave);
        }
        let bins = problem.rows().skip(fitted.len()).zip(problem.bins);
        self.bins = list::fill(bins.map(|(row, bin)| {
            let model = problem.variance(row, squares);
            let error = weights.model[row] * weights.relative_error(row);
            ComparedBin {
                bin: *bin,
                model: model * problem.variance_unit,
                z: (problem.measured(row) - model) / error,
            }
        }));
        let squared_residuals = weights.squared_residuals(problem, squares);
        let chi_squared = weights.chi_squared(problem, squares, squared_residuals);
        self.degrees_of_freedom = problem.row_count().saturating_sub(unknowns);
        let deviance = weights.deviance(problem, squares);
        let degrees = self.degrees_of_freedom;
        (self.chi_squared, self.p_value) = judged(chi_squared, deviance, degrees);
        self.rms_percent = math::sqrt(sum_of_squares / self.octaves.len().max(1) as Real);
    }

    /// The stretches of octaves that disagree noticeably to one side, shortest averaging time first.
    pub fn stretches(&self) -> impl Iterator<Item = Stretch> + '_ {
        let noticeable = |octave: &ComparedOctave| octave.z > NOTICEABLE || octave.z < -NOTICEABLE;
        let alike = move |a: &ComparedOctave, b: &ComparedOctave| {
            noticeable(a) == noticeable(b) && (a.z > 0.0) == (b.z > 0.0)
        };
        let runs = self.octaves.chunk_by(alike);
        runs.filter_map(move |run| {
            let (first, last) = (run.first()?, run.last()?);
            noticeable(first).then_some(Stretch {
                above: first.z > 0.0,
                from_s: first.tau_s,
                to_s: last.tau_s,
            })
        })
    }

    /// The octave that disagrees most, counted in standard errors; `None` for an empty curve.
    pub fn worst(&self) -> Option<&ComparedOctave> {
        let size = |octave: &&ComparedOctave| if octave.z < 0.0 { -octave.z } else { octave.z };
        self.octaves
            .iter()
            .max_by(|a, b| size(a).total_cmp(&size(b)))
    }
}

/// Writes one sentence: the worst octave comes first, then the stretches.
impl<const K: usize, const B: usize> core::fmt::Display for Comparison<K, B> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let Some(worst) = self.worst() else {
            return write!(f, "the curve has no octaves to compare");
        };
        if self.stretches().next().is_none() {
            let (percent, z) = (worst.percent().abs(), worst.z.abs());
            return write!(
                f,
                "no octave disagrees noticeably: the largest difference is {percent:.1} % at τ = {} ({z:.1} σ)",
                Time(worst.tau_s)
            );
        }
        write!(
            f,
            "measured is {:.0} % {} the model at τ = {} ({:.0} σ)",
            worst.percent().abs(),
            side(worst.z > 0.0),
            Time(worst.tau_s),
            worst.z.abs()
        )?;
        for stretch in self.stretches() {
            if stretch.from_s == stretch.to_s && stretch.from_s == worst.tau_s {
                continue;
            }
            write!(f, "; {} it ", side(stretch.above))?;
            let last = self.octaves.last().map_or(0.0, |octave| octave.tau_s);
            let first = self.octaves.first().map_or(0.0, |octave| octave.tau_s);
            if stretch.from_s == stretch.to_s {
                write!(f, "at τ = {}", Time(stretch.from_s))?;
            } else if stretch.to_s == last {
                write!(f, "for τ ≥ {}", Time(stretch.from_s))?;
            } else if stretch.from_s == first {
                write!(f, "for τ ≤ {}", Time(stretch.to_s))?;
            } else {
                write!(
                    f,
                    "for τ from {} to {}",
                    Time(stretch.from_s),
                    Time(stretch.to_s)
                )?;
            }
        }
        Ok(())
    }
}

/// An octave that is not fitted, compared with a model that is.
#[inline(never)]
fn compare_short<const K: usize, const B: usize>(
    problem: &Problem<'_, K, B>,
    point: &Point,
    squares: &Vector,
    tolerance: Real,
) -> ComparedOctave {
    let mut shares = [0.0; MAX_EFFECTS];
    let mut model = 0.0;
    for (i, share) in numbered(shares.iter_mut()).take(problem.count()) {
        // Rounding may leave less than zero of an effect far beyond what a record can tell.
        let unit = problem
            .model
            .unit_variance(i, real(point.m), problem.interval_s);
        *share = squares[i] * unit.max(0.0);
        model += *share;
    }
    let mut relative = tolerance * tolerance;
    let squares = problem.squares_at(real(point.m), squares);
    let squares = squares.as_slice();
    covariance_row(
        core::slice::from_ref(point),
        problem.model,
        squares,
        problem.interval_s,
        (0, 0),
        &mut |_, covariance| relative += covariance / (model * model),
    );
    // The effects of a model may all vanish so far from where they were fitted. Then nothing is a share of it.
    let exists = model > 0.0;
    ComparedOctave {
        m: point.m,
        tau_s: point.tau_s,
        measured: point.variance,
        model: model * problem.variance_unit,
        z: match exists {
            true => (point.variance / problem.variance_unit / model - 1.0) / math::sqrt(relative),
            false => Real::INFINITY,
        },
        shares: shares.map(|share| if exists { single(share / model) } else { 0.0 }),
    }
}

const fn side(above: bool) -> &'static str {
    if above { "above" } else { "below" }
}

/// A time that is written in milliseconds or seconds, with three digits.
pub(crate) struct Time(pub(crate) Real);

impl core::fmt::Display for Time {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let (value, unit) = if self.0 < 1.0 {
            (self.0 * 1e3, "ms")
        } else {
            (self.0, "s")
        };
        let digits = match value {
            v if v >= 100.0 => 0,
            v if v >= 10.0 => 1,
            _ => 2,
        };
        write!(f, "{value:.digits$} {unit}")
    }
}
