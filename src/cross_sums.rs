//! Beside the gyro's own sums: what it shares with a covariate.

use crate::{
    curve::{Curve, Scale},
    effect::covariate::Slope,
    error::Error,
    octave::Accumulator,
    real::{Real, real},
};
use heapless::Vec;

/// The sums that a gyro shares with a covariate `x`, anything sampled alongside: temperature, its
/// rate of change, acceleration, supply voltage.
///
/// With the second differences `D` of an [`Accumulator`], `Σ D_x²` and `Σ (D_g + D_x)²` are kept, of
/// which with the gyro's own `Σ D_g²` follows `Σ D_g D_x`, exact: polarisation. So every promise of the
/// accumulator holds here too, at the price of two more of them, the first of which all axes of a
/// gyro could share.
///
/// # Example
///
/// ```
/// use allanite::{Accumulator, CrossSums, Scale};
///
/// let mut gyro = Accumulator::<8>::new();
/// let mut cross = CrossSums::<8>::new();
/// for n in 0..1000_i32 {
///     let (noise, temperature) = ((n * 7919) % 13, n / 10);
///     let count = noise + 3 * temperature;
///     gyro.push(count);
///     cross.push(count, temperature);
/// }
/// let curve = cross.curve(&gyro, Scale::new(1.0, 100.0)?, 1.0)?;
/// let longest = curve.points().last().unwrap();
/// assert!((longest.covariance / longest.variance - 3.0).abs() < 0.1);
/// # Ok::<(), allanite::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CrossSums<const OCTAVES: usize> {
    covariate: Accumulator<OCTAVES>,
    both: Accumulator<OCTAVES>,
}

impl<const OCTAVES: usize> CrossSums<OCTAVES> {
    /// Nothing yet.
    pub const fn new() -> Self {
        Self {
            covariate: Accumulator::new(),
            both: Accumulator::new(),
        }
    }

    /// Adds the gyro's count, the same that goes to its own accumulator, and the covariate's. Their sum
    /// saturates at 32 bits, which 16 bits of either are far from.
    pub fn push(&mut self, gyro: i32, covariate: i32) {
        self.covariate.push(covariate);
        self.both.push(gyro.saturating_add(covariate));
    }

    /// Samples were lost, as [`Accumulator::gap`].
    pub fn gap(&mut self) {
        self.covariate.gap();
        self.both.gap();
    }

    /// Adds another record of the same sensors.
    pub fn merge(&mut self, other: &Self) {
        self.covariate.merge(&other.covariate);
        self.both.merge(&other.both);
    }

    /// Forgets everything.
    pub fn reset(&mut self) {
        *self = Self::new();
    }

    /// The cross curve as of now, of the octaves that the gyro's curve has. `scale` is the gyro's,
    /// `per_count` the covariate's unit per count.
    ///
    /// # Errors
    /// [`Error::InvalidScale`] unless `per_count` is positive and finite; [`Error::Misaligned`] where
    /// `gyro` has not seen the same samples and gaps.
    pub fn curve(
        &self,
        gyro: &Accumulator<OCTAVES>,
        scale: Scale,
        per_count: Real,
    ) -> Result<CrossCurve<OCTAVES>, Error> {
        Scale::new(per_count, scale.rate_hz())?;
        let mut points = Vec::new();
        let own = self.covariate.octaves().zip(self.both.octaves());
        for (gyro, (covariate, both)) in gyro.octaves().zip(own) {
            if gyro.differences != covariate.differences {
                return Err(Error::Misaligned {
                    gyro: gyro.differences,
                    covariate: covariate.differences,
                });
            }
            if gyro.differences < Curve::<OCTAVES>::MIN_DIFFERENCES {
                continue;
            }
            // ½ mean (D_g/m)(D_x/m), and 2 Σ D_g D_x = Σ (D_g + D_x)² − Σ D_g² − Σ D_x².
            let m = real(gyro.m);
            let half_mean = 0.5 / (gyro.differences as Real * m * m);
            let product = 0.5 * both.sum.excess(&gyro.sum, &covariate.sum);
            // As many octaves as capacity.
            let _ = points.push(CrossPoint {
                m: gyro.m,
                covariance: half_mean * product * scale.rate_per_count() * per_count,
                variance: half_mean * covariate.sum.to_real() * per_count * per_count,
            });
        }
        Ok(CrossCurve { points })
    }
}

impl<const OCTAVES: usize> Default for CrossSums<OCTAVES> {
    fn default() -> Self {
        Self::new()
    }
}

/// One octave of a gyro beside a covariate.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CrossPoint {
    /// Averaging factor.
    pub m: u32,
    /// Allan covariance `½ mean (D_g D_x)/m²`, in rate units times the covariate's.
    pub covariance: Real,
    /// The covariate's Allan variance, in its unit squared.
    pub variance: Real,
}

/// What a gyro and a covariate share, octave by octave: all that a diagnosis knows of the covariate.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CrossCurve<const K: usize> {
    points: Vec<CrossPoint, K>,
}

impl<const K: usize> CrossCurve<K> {
    /// The octaves, shortest averaging time first: those of the gyro's curve.
    pub fn points(&self) -> &[CrossPoint] {
        &self.points
    }

    /// Takes what follows the covariate off the gyro's curve, `σ²_g − 2α C_gx + α² σ²_x`. The slope's own
    /// error ε takes some of the noise away with it, on average `ε² σ²_x`, which is put back.
    #[inline(never)]
    pub fn correct(&self, curve: &mut Curve<K>, slope: &Slope) {
        let Slope { value, error } = *slope;
        curve.change_variances(|k, variance| match self.points.get(k) {
            Some(cross) => {
                let follows = value * (2.0 * cross.covariance - value * cross.variance);
                // A mean square, but for rounding.
                let rest = (variance - follows).max(variance * Real::EPSILON);
                rest + error * error * cross.variance
            }
            None => variance,
        });
    }
}
