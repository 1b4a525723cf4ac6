//! The lag with which a rate follows a column.
//!
//! For every lag `T`, the column behind a thermal mass is a covariate `x_T` with a cross curve. Beside noise of the Allan
//! variances `σ²_k`, it explains
//!
//! ```text
//! z²(T) = b²/(a c),      b = Σ_k (n/m_k) C_gx,k/σ²_k,      a = Σ_k (n/m_k) σ²_x,k/σ²_k
//! ```
//!
//! of the record, with the factor `c` of the [slope's](allanite::covariate) variance. The lag is where `z²` is largest, and
//! its 95 % interval reaches as far as `z²` has fallen by 3.84. The noise is then fitted again without what follows
//! the column, until the lag settles.

use super::{
    cross::{Differences, cross_curve},
    noise::Noise,
    series::lagged,
};
use crate::confidence::TWO_SIDED_95;
use allanite::{
    Curve, Error, Model,
    covariate::{CrossCurve, Slope},
    curve::Point,
    diagnosis::FollowedCovariate,
    spectrum::Spectrum,
};
use allanite_log::{BINS, OCTAVES, block_means::BlockMeans};

/// The ratio of neighbouring lags that are tried. Chosen by hand: within it, `z²` has one maximum.
const RATIO: f64 = 1.25;

/// The longest lag, as a share of the record. A longer one can not be told from a sum over the record.
const LONGEST: f64 = 1.0 / 6.0;

/// The most rounds that alternate between the lag and the noise, and the first ones in which nothing is added back for
/// the error of the slope, as the diagnosis does.
const ROUNDS: usize = 8;
const FIRST_ROUNDS: usize = 2;

/// The lag has settled when its logarithm changes by less. Chosen by hand.
const SETTLED: f64 = 0.01;

/// The lag with which a rate follows a column.
#[derive(Clone, Debug)]
pub struct Lag {
    /// The lag in seconds.
    pub lag_s: f64,
    /// Lower end of its 95 % interval.
    pub lower_s: f64,
    /// Upper end of its 95 % interval.
    pub upper_s: f64,
    /// The slope on the column behind the lag. Its error includes that of the lag.
    pub slope: Slope,
    /// What the axis has in common with the column behind the lag.
    pub cross: CrossCurve<OCTAVES>,
}

/// A record whose rate may follow a column.
pub struct Record<'a> {
    /// The curve of the record as it is.
    pub curve: &'a Curve<OCTAVES>,
    /// The spectrum of the record as it is.
    pub spectrum: &'a Spectrum<BINS>,
    /// The model of the noise.
    pub model: &'a Model,
    /// The means of the rate and of the columns.
    pub means: &'a BlockMeans,
    /// The differences of the mean rates.
    pub rate: &'a Differences,
}

impl Record<'_> {
    pub(super) fn points(&self) -> &[Point] {
        self.curve.points()
    }

    /// The differences of a series beside the rate.
    pub(super) fn differences(&self, series: &[f64]) -> Differences {
        let BlockMeans {
            broken, samples, ..
        } = self.means;
        Differences::new(series, broken, *samples, self.points())
    }

    /// What the axis has in common with a series.
    pub(super) fn cross(&self, series: &[f64], shortest: u32) -> CrossCurve<OCTAVES> {
        let points = self.points();
        cross_curve(self.rate, &self.differences(series), points, shortest)
    }

    /// The number of samples.
    pub(super) fn samples(&self) -> f64 {
        f64::from(self.means.samples) * self.means.rate.len() as f64
    }

    fn noise_without(&self, cross: &CrossCurve<OCTAVES>, slope: Slope) -> Result<Noise, Error> {
        let followed = FollowedCovariate {
            index: 0,
            slope,
            beside: None,
        };
        let record = allanite::Record {
            covariates: std::slice::from_ref(cross),
            ..allanite::Record::new(self.curve, self.spectrum)
        };
        let (mut curve, mut spectrum) = (self.curve.clone(), self.spectrum.clone());
        followed.correct(&record, &mut curve, &mut spectrum);
        Noise::fitted(&curve, &spectrum, self.model)
    }
}

/// A lag that a record neither shows nor excludes. A slope without a lag may be wrong by what the lag would change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unresolved {
    /// The longest lag that is not excluded, in seconds.
    pub longest_s: f64,
    /// The most that such a lag changes of the slope, in rate units per unit of the column.
    pub shift: f64,
}

impl Unresolved {
    /// A slope whose interval includes what the lag may change.
    pub fn widened(&self, slope: Slope) -> Slope {
        Slope {
            error: slope.error.hypot(self.shift / TWO_SIDED_95),
            ..slope
        }
    }
}

/// What was found about a column.
pub struct Found {
    /// The lag; `None` if no lag is the best one within the range.
    pub lag: Option<Lag>,
    /// The lags that are not excluded, if the lag is not told.
    pub unresolved: Option<Unresolved>,
    /// The noise without what follows the column.
    pub noise: Noise,
    /// What the column explains behind its lag, as `z²`.
    pub explained: f64,
    /// The factor `c` of the variance of its slope.
    pub factor: f64,
}

/// The search for the lag of one column.
pub struct Search<'a> {
    /// The record.
    pub record: &'a Record<'a>,
    /// The means of the column.
    pub column: &'a [f64],
    /// The shortest averaging factor that counts: in shorter ones, the column is the noise of its sensor.
    pub shortest: u32,
}

impl Search<'_> {
    /// What the axis has in common with the column behind a lag.
    fn cross(&self, lag_s: f64) -> CrossCurve<OCTAVES> {
        let series = lagged(self.column, lag_s / self.record.means.block_s);
        self.record.cross(&series, self.shortest)
    }

    /// What the axis has in common with the column itself.
    fn without_lag(&self) -> CrossCurve<OCTAVES> {
        self.record.cross(self.column, self.shortest)
    }

    /// `b²/a`.
    fn explained(&self, cross: &CrossCurve<OCTAVES>, noise: &Noise) -> f64 {
        let (product, square) = noise.sums(cross, self.record.samples());
        if square > 0.0 {
            product * product / square
        } else {
            0.0
        }
    }

    /// The lag in a range of logarithms where a function of it is largest, by golden sections.
    fn largest(mut low: f64, mut high: f64, of: impl Fn(f64) -> f64) -> f64 {
        let golden = 0.5 * (5_f64.sqrt() - 1.0);
        let mut one = high - golden * (high - low);
        let mut other = low + golden * (high - low);
        let (mut of_one, mut of_other) = (of(one), of(other));
        while high - low > 0.2 * SETTLED {
            if of_one > of_other {
                (high, other, of_other) = (other, one, of_one);
                one = high - golden * (high - low);
                of_one = of(one);
            } else {
                (low, one, of_one) = (one, other, of_other);
                other = low + golden * (high - low);
                of_other = of(other);
            }
        }
        0.5 * (low + high)
    }

    /// Where a falling function of the logarithm passes zero, between one end where it is positive and another one.
    fn zero(mut inside: f64, mut outside: f64, of: impl Fn(f64) -> f64) -> f64 {
        while (inside - outside).abs() > 0.2 * SETTLED {
            let middle = 0.5 * (inside + outside);
            if of(middle) > 0.0 {
                inside = middle;
            } else {
                outside = middle;
            }
        }
        0.5 * (inside + outside)
    }

    /// Searches for the lag, beginning with the noise of the record as it is.
    ///
    /// # Errors
    /// Those of a fit.
    pub fn run(&self, before: &Noise) -> Result<Option<Found>, Error> {
        let means = self.record.means;
        let (shortest, longest) = (means.block_s.ln(), (LONGEST * means.duration_s()).ln());
        let step = RATIO.ln();
        let steps = ((longest - shortest) / step).floor();
        if steps < 2.0 {
            return Ok(None);
        }
        let grid: Vec<_> = (0..=steps as u32)
            .map(|i| shortest + step * f64::from(i))
            .map(|log| (log, self.cross(log.exp())))
            .collect();
        let mut noise = before.clone();
        let mut settled: Option<f64> = None;
        for round in 0..ROUNDS {
            let best = grid
                .iter()
                .map(|(log, cross)| (*log, self.explained(cross, &noise)));
            let Some((near, _)) = best.max_by(|a, b| a.1.total_cmp(&b.1)) else {
                return Ok(None);
            };
            let log = Self::largest(near - step, near + step, |log| {
                self.explained(&self.cross(log.exp()), &noise)
            });
            let cross = self.cross(log.exp());
            let Some(mut slope) = Slope::of(&cross, self.record.points(), |k| noise.at(k)) else {
                return Ok(None);
            };
            if round < FIRST_ROUNDS {
                slope.error = 0.0;
            }
            let change = settled.map_or(f64::INFINITY, |before| (log - before).abs());
            settled = Some(log);
            noise = self.record.noise_without(&cross, slope)?;
            if round > FIRST_ROUNDS && change < SETTLED {
                break;
            }
        }
        Ok(settled.and_then(|log| self.found(log, (shortest - step, longest), noise)))
    }

    /// The lag with its interval and its slope.
    fn found(&self, log: f64, (shortest, longest): (f64, f64), noise: Noise) -> Option<Found> {
        let slope_at = |log: f64| {
            let cross = self.cross(log.exp());
            let slope = Slope::of(&cross, self.record.points(), |k| noise.at(k));
            slope.map(|slope| (cross, slope))
        };
        let (cross, slope) = slope_at(log)?;
        let (_, square) = noise.sums(&cross, self.record.samples());
        let factor = slope.error * slope.error * square;
        let of = |log: f64| self.explained(&self.cross(log.exp()), &noise) / factor;
        let explained = of(log);
        let above = |log: f64| of(log) - explained + TWO_SIDED_95 * TWO_SIDED_95;
        let is_within = log > shortest && log < longest && above(longest) < 0.0;
        let lag = is_within.then(|| {
            let lower = match above(shortest) < 0.0 {
                true => Self::zero(log, shortest, above),
                false => f64::NEG_INFINITY,
            };
            let upper = Self::zero(log, longest, above);
            let at = |log: f64| slope_at(log).map_or(slope.value, |(_, slope)| slope.value);
            let by_lag = (at(upper) - at(lower.max(shortest))) / (2.0 * TWO_SIDED_95);
            Lag {
                lag_s: log.exp(),
                lower_s: lower.exp(),
                upper_s: upper.exp(),
                slope: Slope {
                    error: slope.error.hypot(by_lag),
                    ..slope
                },
                cross,
            }
        });
        let not_excluded = || {
            let upper = match above(longest) < 0.0 {
                true => Self::zero(log, longest, above),
                false => longest,
            };
            let without = Slope::of(&self.without_lag(), self.record.points(), |k| noise.at(k))?;
            let shift = [log, upper].map(|log| {
                let slope = slope_at(log).map_or(without.value, |(_, slope)| slope.value);
                (slope - without.value).abs()
            });
            Some(Unresolved {
                longest_s: upper.exp(),
                shift: shift[0].max(shift[1]),
            })
        };
        Some(Found {
            lag,
            unresolved: not_excluded(),
            noise,
            explained,
            factor,
        })
    }
}
