//! The Allan curve, which is what remains of the samples.

mod bridged;
mod sums;

pub(crate) use sums::LIMB;

use crate::{
    error::Error,
    list::{fill, numbered},
    numerics::{
        math,
        real::{Real, real, single},
    },
    record::octave::{Accumulator, Bridged},
};
use heapless::Vec;

/// The time that a curve spans.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Span {
    /// The sample interval τ₀, in seconds.
    pub interval_s: Real,
    /// The averaging time of the longest octave, in seconds.
    pub longest_tau_s: Real,
}

/// The scale that turns counts and sample numbers into rates and seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Scale {
    rate_per_count: Real,
    rate_hz: Real,
    per_degree: Option<Real>,
}

/// No gyro has a larger count than this, in deg/s: one of ±4000 deg/s and 16 bits has 0.122. A larger one is of another unit.
const LARGEST_COUNT: Real = 0.2;

impl Scale {
    /// The scale of a sensor that gives `rate_per_count` rate units per count and is sampled at
    /// `rate_hz`. Coefficients come out in the same unit. It is taken for deg/s where a count is at most 0.2 of it, and is not
    /// known otherwise; [`in_unit`](Self::in_unit) says another one.
    ///
    /// # Errors
    /// [`Error::InvalidScale`] and [`Error::InvalidRate`] if the number is not positive and finite.
    pub fn new(rate_per_count: Real, rate_hz: Real) -> Result<Self, Error> {
        let valid = |x: Real| x.is_finite() && x > 0.0;
        if !valid(rate_per_count) {
            return Err(Error::InvalidScale(rate_per_count));
        }
        if !valid(rate_hz) {
            return Err(Error::InvalidRate(rate_hz));
        }
        Ok(Self {
            rate_per_count,
            rate_hz,
            per_degree: (rate_per_count <= LARGEST_COUNT).then_some(1.0),
        })
    }

    /// The same scale in another unit: `per_degree` is that of 1 deg/s in rate units, such as π/180 for rad/s; `None` for what is no
    /// rate, such as an acceleration. Coefficients do not depend on it. How large the noise of a gyro can be does, by which
    /// [motion](crate::motion) is recognised.
    #[must_use]
    pub const fn in_unit(self, per_degree: Option<Real>) -> Self {
        Self { per_degree, ..self }
    }

    /// 1 deg/s in rate units; `None` if that is not known.
    pub const fn per_degree(&self) -> Option<Real> {
        self.per_degree
    }

    /// Rate units per count.
    pub const fn rate_per_count(&self) -> Real {
        self.rate_per_count
    }

    /// Samples per second.
    pub const fn rate_hz(&self) -> Real {
        self.rate_hz
    }
}

/// One octave of an Allan curve.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Point {
    /// Averaging factor: samples in a cluster, a power of two.
    pub m: u32,
    /// Averaging time τ = m τ₀, in seconds.
    pub tau_s: Real,
    /// The number of quarter-overlapping differences that the variance is computed from.
    pub differences: u64,
    /// Allan variance σ²(τ), in rate units squared.
    pub variance: Real,
    /// The number of stretches without gaps that have differences of this octave. It is estimated from the numbers of
    /// differences of neighbouring octaves, and is 1 for a record without gaps.
    pub stretches: u32,
}

impl Point {
    /// Allan deviation σ(τ), in rate units.
    pub fn deviation(&self) -> Real {
        math::sqrt(self.variance)
    }
}

/// An Allan curve of up to `K` octaves. The fit, the comparison and the diagnosis work on it, without
/// the samples.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Curve<const K: usize> {
    rate_hz: Real,
    /// A power of four near the smallest variance. In this unit, the squares of variances stay within
    /// the range of single precision.
    variance_unit: Real,
    points: Vec<Point, K>,
}

impl<const K: usize> Curve<K> {
    /// The number of differences that an octave needs to enter a curve, unless another number is asked
    /// for. With fewer, the distribution of the estimate is too far from any that a fit can weight. The
    /// number is chosen by hand; no study varies it.
    pub const MIN_DIFFERENCES: u64 = 6;

    /// A curve from stored octaves, each given by its averaging factor, its number of differences and
    /// its Allan variance in rate units squared, shortest averaging time first.
    ///
    /// # Errors
    /// [`Error::InvalidRate`] if `rate_hz` is not positive and finite, [`Error::InvalidPoint`] if an
    /// octave is not possible, [`Error::TooManyOctaves`] if there are more than `K`.
    pub fn new(
        rate_hz: Real,
        octaves: impl IntoIterator<Item = (u32, u64, Real)>,
    ) -> Result<Self, Error> {
        Scale::new(1.0, rate_hz)?;
        let mut points: Vec<Point, K> = Vec::new();
        let mut last = 0;
        for (m, differences, variance) in octaves {
            let possible = m.is_power_of_two() && m <= 1 << 29 && m > last;
            if !(possible && differences > 0 && variance.is_finite() && variance >= 0.0) {
                return Err(Error::InvalidPoint { m });
            }
            last = m;
            let point = Point {
                m,
                tau_s: real(m) / rate_hz,
                differences,
                variance,
                stretches: 1,
            };
            if points.push(point).is_err() {
                return Err(Error::TooManyOctaves { capacity: K });
            }
        }
        set_stretches(&mut points, K);
        Ok(Self {
            rate_hz,
            variance_unit: power_of_four(&points),
            points,
        })
    }

    /// The curve without what filled gaps change in its variances, for a record of so many samples without those that were
    /// lost. [`Accumulator::curve`] does this itself; sums that were stored need it. The curve stays as it is if no gap was
    /// filled.
    #[must_use]
    pub fn without_bridges(mut self, bridged: &Bridged, samples: u64) -> Self {
        if !bridged.is_empty() {
            let places = samples.saturating_add(bridged.lost());
            let points = self.points.iter();
            let mut octaves: Vec<_, K> = fill(points.map(|point| (point.m, point.variance)));
            bridged::take_off(&mut octaves, bridged, places);
            for (point, (_, variance)) in self.points.iter_mut().zip(&octaves) {
                point.variance = *variance;
            }
            self.variance_unit = power_of_four(&self.points);
        }
        self
    }

    /// Replaces every variance in place. The new variances must be finite and not negative.
    pub(crate) fn change_variances(&mut self, variance: impl Fn(usize, Real) -> Real) {
        for (k, point) in numbered(self.points.iter_mut()) {
            point.variance = variance(k, point.variance);
        }
    }

    /// Samples per second.
    pub const fn rate_hz(&self) -> Real {
        self.rate_hz
    }

    /// Sample interval τ₀, in seconds.
    pub fn interval_s(&self) -> Real {
        1.0 / self.rate_hz
    }

    /// The range of times that the curve covers.
    pub(crate) fn span(&self) -> Span {
        Span {
            interval_s: self.interval_s(),
            longest_tau_s: self.points.last().map_or(0.0, |point| point.tau_s),
        }
    }

    /// The unit, in rate units squared, in which a fit counts variances and squared coefficients. It
    /// stays the same when something is subtracted from the curve.
    pub(crate) const fn variance_unit(&self) -> Real {
        self.variance_unit
    }

    /// The octaves, shortest averaging time first.
    pub fn points(&self) -> &[Point] {
        &self.points
    }
}

/// The number of clusters `N/m` in the record, from an octave's number of differences. The record is
/// taken to be without gaps.
pub(crate) fn clusters(point: &Point) -> Real {
    let m = real(point.m);
    point.differences.saturating_sub(1) as Real * (0.25 * m).max(1.0) / m + 2.0
}

/// Estimates the number of stretches in every octave.
///
/// A stretch of `n` samples has room for differences that span `x = 2m` of them at nearly `n − x` places. So the number of
/// places in all stretches falls by as many, with each further sample of `x`, as there are stretches longer than `x`. This
/// slope is taken from the octaves on both sides. Differences start a quarter of a cluster apart. Rounded to whole quarters,
/// a stretch seems shorter by half a quarter on average, and the fall between two octaves smaller by a sixteenth. Behind
/// the last octave, the record is too short for a further one, unless there was no room for it among `capacity`.
fn set_stretches(points: &mut [Point], capacity: usize) {
    let places = |point: &Point| {
        let quarter = u64::from(point.m / 4).max(1);
        point.differences.wrapping_mul(quarter)
    };
    // The difference is exact before it is rounded.
    let between = |one: &Point, next: &Point| {
        let lost = places(one).saturating_sub(places(next)) as Real;
        let rounded = if one.m < 4 { 1.0 } else { 16.0 / 15.0 };
        lost * rounded / real(next.m.saturating_sub(one.m).wrapping_mul(2).max(1))
    };
    let is_complete = points.len() < capacity;
    let mut before: Option<Real> = None;
    let mut left = points;
    while let Some((first, rest)) = left.split_first_mut() {
        let after = match rest.first() {
            Some(next) => Some(between(first, next)),
            None if is_complete && before.is_some() => Some(first.differences as Real / 8.0),
            None => None,
        };
        // The octave before is half as far away as the one behind, and has as many stretches or more.
        // Where one of them is not known, the other stands for it.
        let behind = after.or(before).unwrap_or(1.0);
        let ahead = before.unwrap_or(behind);
        let stretches = (2.0 * ahead + lesser(behind, ahead)) / 3.0;
        let stretches = lesser(stretches, first.differences as Real);
        // Rounded, and 1 at least.
        first.stretches = (math::truncated(single(stretches + 0.5)) as u32).max(1);
        before = after;
        left = rest;
    }
}

/// The smaller number. What `min` does for one that is no number is a further call on a core that has no unit for floats.
#[inline(never)]
fn lesser(one: Real, other: Real) -> Real {
    if one < other { one } else { other }
}

/// The power of four nearest to the smallest positive variance, or 1 if there is none. It is a normal number, even if
/// the variance is not: what is below the least normal number would be rounded to zero, which no product leaves.
fn power_of_four(points: &[Point]) -> Real {
    let positive = points.iter().map(|point| point.variance);
    let least = positive
        .filter(|&variance| variance > 0.0)
        .fold(Real::INFINITY, lesser);
    let mut unit = 1.0;
    if least.to_bits() < Real::INFINITY.to_bits() {
        while least < unit && unit > Real::MIN_POSITIVE {
            unit *= 0.25;
        }
        let is_large = |unit: Real| {
            let is_near = least < 4.0 * unit;
            !is_near
        };
        while is_large(unit) {
            unit *= 4.0;
        }
    }
    unit
}

/// The number of clusters from which an octave shows that rounding is carried over. A cluster makes up to four differences.
const CARRIED: u64 = 250;
/// By how much σ² then exceeds m times that of m samples. White noise of 0.1 to 0.47 counts that is rounded reaches 1.31 in 4262 simulated
/// records of 1100 to 20 000 samples, but for one with hardly any sample off its level, which reached 2. Coarse pulses reach 1.5 in 311 of
/// 311 records of 20 000 samples, and in 303 of 309 of 5000.
const MORE_THAN_WHITE: Real = 1.5;

/// Whether rounding is carried over to the next sample, as in counts of pulses of an angle: what is rounded off a sample is not lost
/// but part of the next one, so that the mean of several samples varies less than that of independent ones. Then noise below
/// half a count is no reason to reject a record. `octaves` are averaging factor, number of differences, and Allan variance in any
/// unit, shortest averaging time first.
pub fn carries_rounding(octaves: impl IntoIterator<Item = (u32, u64, Real)>) -> bool {
    let mut octaves = octaves
        .into_iter()
        .take_while(|&(m, differences, _)| differences >= CARRIED * u64::from(m.min(4)));
    let Some((1, _, first)) = octaves.next() else {
        return false;
    };
    octaves.any(|(m, _, variance)| first > MORE_THAN_WHITE * real(m) * variance)
}

impl<const K: usize> Accumulator<K> {
    /// Whether [rounding is carried over](carries_rounding) to the next sample.
    pub fn carries_rounding(&self) -> bool {
        carries_rounding(self.octaves().map(|octave| {
            let m = real(octave.m);
            let mean_square = octave.sum.to_real() / octave.differences.max(1) as Real;
            (octave.m, octave.differences, mean_square / (m * m))
        }))
    }

    /// The mean rate, in rate units: the bias of a gyro at rest, with the part of the earth's rate that it sees. `None` without
    /// samples, for 2³² samples and more, and for a record from a snapshot that does not hold it.
    pub fn mean_rate(&self, scale: Scale) -> Option<Real> {
        let (total, values) = self.summed()?;
        Some(total as Real / real(values) * scale.rate_per_count())
    }

    /// The Allan curve so far, of the octaves with at least [`Curve::MIN_DIFFERENCES`] differences.
    pub fn curve(&self, scale: Scale) -> Curve<K> {
        self.curve_of(scale, Curve::<K>::MIN_DIFFERENCES)
    }

    /// The Allan curve so far, of the octaves with at least `min_differences` differences, and at least
    /// one.
    pub fn curve_of(&self, scale: Scale, min_differences: u64) -> Curve<K> {
        let curve = self.sums(scale, min_differences);
        curve.without_bridges(self.bridged(), self.samples())
    }

    /// The Allan curve so far of a record in which no gap was filled: the same as [`curve`](Self::curve), which also takes
    /// off what filled gaps change. `None` if one was.
    ///
    /// For a sensor that never calls [`lost`](Self::lost), and has no room for the 2.8 KB of what it does not need.
    pub fn unbridged_curve(&self, scale: Scale) -> Option<Curve<K>> {
        let is_whole = self.bridged().is_empty();
        is_whole.then(|| self.sums(scale, Curve::<K>::MIN_DIFFERENCES))
    }

    /// The curve with what filled gaps change.
    fn sums(&self, scale: Scale, min_differences: u64) -> Curve<K> {
        let mut points = Vec::new();
        for octave in self.octaves() {
            if octave.differences < min_differences.max(1) {
                continue;
            }
            // σ² = ½ mean (D/m)², in counts² until it is scaled.
            let cluster_scale = scale.rate_per_count / real(octave.m);
            let mean_square = octave.sum.to_real() / octave.differences as Real;
            let point = Point {
                m: octave.m,
                tau_s: real(octave.m) / scale.rate_hz,
                differences: octave.differences,
                variance: 0.5 * mean_square * cluster_scale * cluster_scale,
                stretches: 1,
            };
            // There is room for every octave.
            let _ = points.push(point);
        }
        set_stretches(&mut points, K);
        Curve {
            rate_hz: scale.rate_hz,
            variance_unit: power_of_four(&points),
            points,
        }
    }
}

impl<const K: usize> core::fmt::Display for Curve<K> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        writeln!(
            f,
            "{:>12} {:>12} {:>14} {:>12}",
            "m", "tau_s", "deviation", "differences"
        )?;
        for point in &self.points {
            writeln!(
                f,
                "{:>12} {:>12.5} {:>14.6e} {:>12}",
                point.m,
                point.tau_s,
                point.deviation(),
                point.differences
            )?;
        }
        Ok(())
    }
}
