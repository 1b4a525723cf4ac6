//! The cosine transform of a course, which holds what lies below the bins of a spectrum.

use super::is_complete;
use crate::{
    curve::Scale,
    error::Error,
    list::{self, numbered},
    numerics::{
        math,
        real::{Real, real},
    },
    record::course::{BLOCKS, Course, LONGEST},
    theory::effect::{Effect, SampledShape},
};
use heapless::Vec;

/// The blocks that a transform needs. Chosen by hand: a record of fewer is hardly longer than one segment of a spectrum.
const MIN_BLOCKS: usize = 32;

/// The cosine transform (DCT-II) of the block means of a whole record, as one-sided densities. For the means `y_j` of
/// `n` blocks of `M` samples,
///
/// ```text
/// P_k = 2Mτ₀ (Σ_j d_kj y_j)²,   d_kj = √(2/n) cos(πk(j + ½)/n),   f_k = k/(2nMτ₀),   k = 1 … n − 1.
/// ```
///
/// The transform nearly diagonalises white noise, flicker and random walks (Ahmed, Natarajan & Rao 1974, IEEE Trans.
/// Comput. C-23, 90, for the first-order process), so that the `P_k` are almost independent, each a square of one normal
/// variable. A segment of a spectrum sees a sixteenth of its length at best; these see the whole record.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CosineTransform {
    block: u32,
    rate_hz: Real,
    /// The number of blocks.
    blocks: u32,
    powers: Vec<Real, { BLOCKS - 1 }>,
}

impl CosineTransform {
    /// A transform from stored densities: of `blocks` blocks of `block` samples, the `P_k` from `k = 1` on, in rate units
    /// squared per hertz.
    ///
    /// # Errors
    /// [`Error::InvalidRate`] if `rate_hz` is not positive and finite, [`Error::InvalidCourse`] if a course cannot have
    /// such blocks, or if its densities are not one less than its blocks, or if one is negative or not finite.
    pub fn new(
        rate_hz: Real,
        block: u32,
        blocks: u32,
        densities: impl IntoIterator<Item = Real>,
    ) -> Result<Self, Error> {
        Scale::new(1.0, rate_hz)?;
        let invalid = Error::InvalidCourse { block, blocks };
        let mut powers = Vec::new();
        for density in densities {
            let is_number = density.is_finite() && density >= 0.0;
            if !is_number || powers.push(density).is_err() {
                return Err(invalid);
            }
        }
        let is_possible = (MIN_BLOCKS..=BLOCKS).contains(&(blocks as usize))
            && block.is_power_of_two()
            && block <= LONGEST;
        if !is_possible || powers.len().saturating_add(1) != blocks as usize {
            return Err(invalid);
        }
        Ok(Self {
            block,
            rate_hz,
            blocks,
            powers,
        })
    }

    /// Samples in a block, `M`.
    pub const fn block(&self) -> u32 {
        self.block
    }

    /// The number of blocks, `n`.
    pub const fn blocks(&self) -> u32 {
        self.blocks
    }

    /// The densities `P_k` from `k = 1` on, in rate units squared per hertz.
    pub fn densities(&self) -> &[Real] {
        &self.powers
    }

    /// The frequency of the density at a place, `k = place + 1`, in Hz.
    pub fn frequency_hz(&self, place: usize) -> Real {
        real(place.saturating_add(1) as u32) * self.rate_hz
            / (2.0 * real(self.blocks) * real(self.block))
    }

    /// Hands the expected densities of an effect with a coefficient of one to `each`, for the first `count` places.
    ///
    /// With the semivariogram γ of the block means, `E P_k = −4Mτ₀ Σ_{l≥1} γ(l) c_k(l)`, where
    /// `c_k(l) = Σ_j d_kj d_k,j+l = [(n − l) cos al − sin al/sin a]/n` and `a = πk/n`. A constant in γ drops out, because
    /// the cosines sum to zero.
    #[inline(never)]
    pub(crate) fn each_expected(
        &self,
        effect: &dyn Effect,
        parameters: [Real; crate::limits::MAX_PARAMETERS],
        count: usize,
        each: &mut dyn FnMut(Real),
    ) {
        let shape = SampledShape {
            interval_s: 1.0 / self.rate_hz,
            parameters,
        };
        let mut values = [0.0; BLOCKS];
        let distances = (self.blocks as usize).saturating_sub(1).min(BLOCKS);
        if let Some(values) = values.get_mut(..distances) {
            effect.variogram(real(self.block), &shape, values);
        }
        // The constant that is taken away keeps the terms small.
        let middle = values.get(distances / 8).copied().unwrap_or(0.0);
        let n = real(self.blocks);
        let scale = -4.0 * real(self.block) / self.rate_hz;
        for k in 1..=count.min(self.powers.len()) {
            let turns = 0.5 * real(k as u32) / n;
            let (sine, cosine) = math::sincos_of_turns(turns);
            let per_sine = 1.0 / sine;
            // Powers of a rotation by `a`.
            let (mut s, mut c) = (0.0, 1.0);
            // The distance 0 has half of its weight, c_k(0) = 1.
            let mut sum = -0.5 * middle;
            for (l, value) in numbered(values).take(distances) {
                (s, c) = (s * cosine + c * sine, c * cosine - s * sine);
                let left = n - 1.0 - real(l as u32);
                sum += (value - middle) * (left * c - s * per_sine) / n;
            }
            each((scale * sum).max(0.0));
        }
    }
}

impl<const COVARIATES: usize> Course<COVARIATES> {
    /// The cosine transform of the means of the complete blocks. `None` if there are fewer than 32 of them, or if one
    /// lacks more than half of its samples.
    pub fn cosine_transform(&self, scale: Scale) -> Option<CosineTransform> {
        let levels = self.levels(scale);
        let whole = levels.iter().take_while(|level| level.filled >= 1.0);
        let blocks = list::count(whole);
        let complete = levels.get(..blocks)?;
        let is_sound = |(b, level): (usize, &super::Level)| {
            level.place as usize == b && is_complete(level, self.block_length())
        };
        if blocks < MIN_BLOCKS || !numbered(complete).all(is_sound) {
            return None;
        }
        let n = real(blocks as u32);
        let unit = 4.0 * real(self.block_length()) / (scale.rate_hz() * n);
        let powers = (1..blocks).map(|k| {
            let (sine, cosine) = math::sincos_of_turns(0.5 * real(k as u32) / n);
            let (mut s, mut c) = math::sincos_of_turns(0.25 * real(k as u32) / n);
            let mut sum = 0.0;
            for level in complete {
                sum += level.mean * c;
                (s, c) = (s * cosine + c * sine, c * cosine - s * sine);
            }
            unit * sum * sum
        });
        Some(CosineTransform {
            block: self.block_length(),
            rate_hz: scale.rate_hz(),
            blocks: blocks as u32,
            powers: list::fill(powers),
        })
    }
}
