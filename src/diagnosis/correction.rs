//! A curve and a spectrum without what follows covariates.

use super::step::FollowedCovariate;
use crate::{
    curve::Curve,
    evidence::{covariate::CrossCurve, record::Record},
    numerics::{math, real::Real, real::real},
    spectrum::Spectrum,
};

/// The share of a bin's standard error by which a covariate may change what a level sees. Chosen by hand: a line in
/// the middle of a bin changes it 3.3 times as much as the octave that ends there, so by a third of its error.
const UNNOTICED: Real = 0.1;

/// The change of the lowest bin by a ramp of the rate, relative to that of the octave of `8M` samples. With segments of
/// 64 blocks and Hann's window, `(16/3) (64M)³/(2π · 4 · 15)²` of a density of two, over `(8M)³/2`.
const LEAKED: Real = 0.02;

/// What an octave of half the averaging factor sees of a change that is slow enough to be seen by the longer octave,
/// at most: the ratio of the responses `sin⁴u/u²` at `u = 1/2` and 1. It is a quarter for a ramp.
const SEEN_BY_HALF: Real = 0.42;

/// The shares of the next octave's variance that an octave has of a smooth change, and of a random walk.
const SMOOTH: Real = 0.25;
const WALKING: Real = 0.5;

impl FollowedCovariate {
    /// Subtracts what follows the covariate from the gyro's curve, and leaves out the levels of the spectrum in which
    /// it is noticeable.
    ///
    /// An octave becomes `σ²_g − 2α C_gx + α² σ²_x`. The slope's own error ε takes some of the noise away as well,
    /// `ε² σ²_x` on average, which is added back. Octaves in which the covariate is its sensor's noise have
    /// no information about what the rate follows there. It is taken to fall on towards shorter ones as it does between the first
    /// two octaves that are no noise: as `τ`, like a random walk, to `τ²`, like a smooth change.
    ///
    /// No sums say what a bin has in common with the covariate. A covariate is slow, so that it reaches the levels
    /// with the longest blocks only, and the octaves take the place of these levels. The frequencies of the level of
    /// blocks of `M` samples are those of the octaves of `2M`, `4M` and `8M` samples. The level is left out if what
    /// follows the covariate there, and is not slower, exceeds a tenth of a bin's standard error in one of them, or
    /// if what leaks into the bins from slower changes does.
    ///
    /// `record` is that of the diagnosis that found the covariate.
    pub fn correct<const K: usize, const B: usize>(
        &self,
        record: &Record<'_, K, B>,
        curve: &mut Curve<K>,
        spectrum: &mut Spectrum<B>,
    ) {
        self.correct_up_to(Real::INFINITY, record, curve, spectrum);
    }

    /// As [`correct`](Self::correct), where at most `most` times the rest of an octave is added back.
    #[inline(never)]
    pub(super) fn correct_up_to<const K: usize, const B: usize>(
        &self,
        most: Real,
        record: &Record<'_, K, B>,
        curve: &mut Curve<K>,
        spectrum: &mut Spectrum<B>,
    ) {
        let Some(one) = record.covariates.get(self.index) else {
            return;
        };
        let beside = self.beside.and_then(|beside| {
            let other = record.covariates.get(beside.index)?;
            Some((beside, other, record.pairs.get(beside.pair)?))
        });
        let others = beside.map_or(0, |(_, other, _)| other.first_octave());
        let first = one.first_octave().max(others);
        // What follows the covariates in an octave and is subtracted, what their slopes' errors take away, and the
        // Allan variance of what follows.
        let shares = |k: usize| {
            let at = |cross: &CrossCurve<K>| cross.points().get(k).copied();
            let point = at(one)?;
            let (slope, error) = (self.slope.value, self.slope.error);
            let mut follows = slope * (2.0 * point.covariance - slope * point.variance);
            let mut taken = error * error * point.variance;
            let mut power = slope * slope * point.variance;
            if let Some((beside, other, pair)) = beside {
                let (other, shared) = (at(other)?, at(&pair.shared)?.covariance);
                let (beside_slope, beside_error) = (beside.slope.value, beside.slope.error);
                follows += beside_slope * (2.0 * other.covariance - beside_slope * other.variance);
                follows -= 2.0 * slope * beside_slope * shared;
                taken += beside_error * beside_error * other.variance;
                taken += 2.0 * beside.correlation * error * beside_error * shared;
                power += beside_slope * beside_slope * other.variance;
                power += 2.0 * slope * beside_slope * shared;
            }
            (k >= first).then_some((follows, taken, power))
        };
        // What follows in the first octave that is no noise, by its product with the rate, and the share of it that an
        // octave before has of the next one.
        let product = |k: usize| {
            let own = one.points().get(k).map_or(0.0, |point| point.covariance);
            let other = beside.and_then(|(beside, other, _)| {
                Some(beside.slope.value * other.points().get(k)?.covariance)
            });
            (self.slope.value * own + other.unwrap_or(0.0)).max(0.0)
        };
        let of_first = product(first);
        let of_next = product(first.saturating_add(1));
        let share = if of_next > 0.0 {
            (of_first / of_next).clamp(SMOOTH, WALKING)
        } else {
            SMOOTH
        };
        let behind_noise = |k: usize| {
            let octaves = first.checked_sub(k).filter(|&octaves| octaves > 0)?;
            let follows = (0..octaves).fold(of_first, |follows, _| follows * share);
            Some((follows, 0.0, follows))
        };
        let shares = |k: usize| shares(k).or_else(|| behind_noise(k));
        curve.change_variances(|k, variance| match shares(k) {
            Some((follows, taken, _)) => {
                // The rest is a mean square. Only rounding makes it negative.
                let rest = (variance - follows).max(variance * Real::EPSILON);
                rest + taken.min(most * rest)
            }
            None => variance,
        });
        let touched = spectrum.levels().find_map(|level| {
            let lowest = level.first()?;
            let unnoticed = UNNOTICED / math::sqrt(real(lowest.segments));
            let octaves = (0..K).zip(curve.points());
            let mut near = octaves.filter(|(_, point)| {
                point.m > lowest.block && point.m <= lowest.block.saturating_mul(8)
            });
            let power = |k: usize| shares(k).map_or(0.0, |(_, _, power)| power);
            let is_touched = near.any(|(k, point)| {
                let (own, longer) = (power(k), power(k.saturating_add(1)));
                let change = (own - SEEN_BY_HALF * longer).max(LEAKED * own);
                change > unnoticed * point.variance
            });
            is_touched.then_some(lowest.block)
        });
        if let Some(block) = touched {
            spectrum.leave_out_from(block);
        }
    }

    /// The least square of a slope, in standard errors.
    pub(super) fn least_square(&self) -> Real {
        let own = square(self.slope.z());
        let beside = self.beside.map(|beside| square(beside.slope.z()));
        beside.map_or(own, |beside| own.min(beside))
    }

    /// χ² of the slopes.
    pub(super) fn chi_squared(&self) -> Real {
        let z = self.slope.z();
        let Some(beside) = self.beside else {
            return square(z);
        };
        let (other, r) = (beside.slope.z(), beside.correlation);
        // Rounding makes the correlation of two slopes one where their errors are large.
        (square(z) - 2.0 * r * z * other + square(other)) / (1.0 - r * r).max(Real::EPSILON)
    }
}

fn square(x: Real) -> Real {
    x * x
}
