//! Second differences of a kernel at every lag at which two octaves of a curve can meet.

use crate::{
    list::numbered,
    numerics::{
        math::floor_log2,
        real::{Real, real, single},
    },
};
use nalgebra::Complex;

/// Up to this one, every position is kept. Positions are counted in quarters of a cluster.
const FINE: u32 = 16;
const FINE_SLOTS: usize = FINE as usize + 1;
/// The number of positions in each octave beyond [`FINE`].
const STEPS: u32 = 4;
/// The number of octaves beyond [`FINE`].
const COARSE_OCTAVES: u32 = 18;

/// The number of slots of the lattice.
pub(crate) const LEN: usize = FINE_SLOTS + (STEPS * COARSE_OCTAVES) as usize;

/// The largest position.
pub(crate) const END: u32 = FINE << COARSE_OCTAVES;

/// The lag of a slot, in quarters of a cluster: 0, 1, … 16, 20, 24, 28, 32, 40, ….
pub(crate) const fn position(slot: usize) -> u32 {
    if slot < FINE_SLOTS {
        return slot as u32;
    }
    let beyond = (slot - FINE_SLOTS) as u32 + 1;
    let octave = beyond / STEPS;
    let step = beyond % STEPS;
    (FINE + FINE / STEPS * step).wrapping_shl(octave)
}

const ONE: Complex<Real> = Complex::new(1.0, 0.0);

/// The powers of `w` at every position. Multiplication leads from each slot to the next.
pub(crate) struct Powers {
    fine: [Complex<Real>; FINE_SLOTS],
    /// The powers of the last slots. Slot `s` is kept at `s % STEPS`.
    last: [Complex<Real>; STEPS as usize],
}

impl Powers {
    pub(crate) fn new(w: Complex<Real>) -> Self {
        let mut fine = [ONE; FINE_SLOTS];
        let mut power = ONE;
        for slot in &mut fine {
            *slot = power;
            power *= w;
        }
        Self {
            fine,
            last: [ONE; STEPS as usize],
        }
    }

    /// The power at a position of up to 16.
    pub(crate) fn near(&self, position: usize) -> Complex<Real> {
        self.fine.get(position).copied().unwrap_or(ONE)
    }

    /// The power at the next slot. Slots must be asked for in their order.
    pub(crate) fn next(&mut self, slot: usize) -> Complex<Real> {
        let steps = STEPS as usize;
        let power = if slot < FINE_SLOTS {
            self.near(slot)
        } else if slot < FINE_SLOTS + steps {
            // The positions 20, 24, 28, 32 are 16 + 4, 16 + 8, 16 + 12, 16 + 16.
            self.near(FINE as usize) * self.near(steps * (slot - FINE as usize))
        } else {
            // The position is twice that of the slot an octave below.
            let below = self.last.get(slot % steps).copied().unwrap_or(ONE);
            below * below
        };
        if let Some(last) = self.last.get_mut(slot % steps) {
            *last = power;
        }
        power
    }
}

/// Second differences `G(x + m) − 2 G(x) + G(|x − m|)` for one averaging factor `m`. They are kept at
/// lags `x` on a lattice that is fine near 0 and coarsens with the distance, because their kinks lie
/// within `m`.
#[derive(Clone, Debug)]
pub struct SecondDifferences {
    values: [Real; LEN],
    used: usize,
    stride: u32,
}

impl SecondDifferences {
    /// Second differences of zero, for clusters of `m` samples and lags up to `end` quarters of a
    /// cluster.
    pub(crate) fn zero(m: u32, end: u32) -> Self {
        let used = (0..LEN).find(|&slot| position(slot) >= end);
        Self {
            values: [0.0; LEN],
            used: used.map_or(LEN, |slot| slot + 1),
            stride: stride(m),
        }
    }

    /// Adds `f(x)` at every lag `x`, in samples, for clusters of `m` samples.
    pub fn add(&mut self, m: Real, f: impl Fn(Real) -> Real) {
        self.add_below(m, Real::INFINITY, f);
    }

    /// Does the same for an effect whose second differences vanish from the lag `end` on, in samples.
    pub fn add_below(&mut self, m: Real, end: Real, f: impl Fn(Real) -> Real) {
        for (slot, value) in numbered(self.values.iter_mut()).take(self.used) {
            let position = position(slot);
            // Quarters of a cluster that fall between two samples are never asked for.
            if !position.is_multiple_of(self.stride) {
                continue;
            }
            let lag = 0.25 * m * real(position);
            if lag >= end {
                break;
            }
            *value += f(lag);
        }
    }

    /// Does the same at lags of a cluster and more.
    pub(crate) fn add_from(&mut self, m: Real, f: impl Fn(Real) -> Real) {
        let slots = numbered(self.values.iter_mut());
        for (slot, value) in slots.take(self.used).skip(STEPS as usize) {
            let position = position(slot);
            if position.is_multiple_of(self.stride) {
                *value += f(0.25 * m * real(position));
            }
        }
    }

    /// Adds `f(slot)` in every slot, one after the other.
    pub(crate) fn add_slots(&mut self, mut f: impl FnMut(usize) -> Real) {
        for (slot, value) in numbered(self.values.iter_mut()).take(self.used) {
            *value += f(slot);
        }
    }

    /// Adds `weight` times a table that has a number for every slot.
    pub(crate) fn add_scaled(&mut self, weight: Real, table: &[Real; LEN]) {
        for (value, unit) in self.values.iter_mut().zip(table).take(self.used) {
            *value += weight * unit;
        }
    }

    /// Adds `value` at one position of up to 16 quarters of a cluster.
    pub fn add_at(&mut self, position: u32, value: Real) {
        if let Some(slot) = self.values.get_mut(position.min(FINE) as usize) {
            *slot += value;
        }
    }

    /// τ² times the Allan variance of what is on the lattice.
    #[cfg(test)]
    pub(crate) fn unit(&self) -> Real {
        self.values[4] - self.values[0]
    }

    /// The same differences in single precision, in this unit: τ² times the Allan variance of everything, above zero.
    pub(crate) fn rounded(&self, unit: Real) -> Rounded {
        let reciprocal = 1.0 / unit;
        Rounded {
            values: self.values.map(|value| single(value * reciprocal)),
            unit,
        }
    }
}

/// Second differences in units of τ² times their octave's Allan variance.
pub(crate) struct Rounded {
    values: [f32; LEN],
    unit: Real,
}

impl Rounded {
    /// τ² times the octave's Allan variance.
    pub(crate) fn unit(&self) -> Real {
        self.unit
    }

    /// The difference at a slot, or at the last slot if there is no such slot.
    #[inline]
    fn slot(&self, slot: usize) -> f32 {
        let [.., last] = self.values;
        self.values.get(slot).copied().unwrap_or(last)
    }

    /// The second difference at a lag in quarters of a cluster, interpolated linearly between the
    /// lattice's positions.
    #[inline]
    pub(crate) fn at(&self, position: u32) -> f32 {
        if position <= FINE {
            return self.slot(position as usize);
        }
        let position = position.min(END - 1);
        // These are the octave of the position, and the position's step within the octave.
        let octave = floor_log2(position).saturating_sub(FINE.ilog2());
        let width_bits = octave + (FINE / STEPS).ilog2();
        let start = FINE.wrapping_shl(octave);
        let step = position.saturating_sub(start).wrapping_shr(width_bits);
        let slot = FINE as usize + (STEPS * octave) as usize + (step % STEPS) as usize;
        let rest = position & 1_u32.wrapping_shl(width_bits).wrapping_sub(1);
        let low = self.slot(slot);
        if rest == 0 {
            return low;
        }
        // This is 2^-width_bits, made from its bits: in software, a division costs as much as ten
        // multiplications.
        let reciprocal = f32::from_bits(127_u32.saturating_sub(width_bits) << 23);
        low + (self.slot(slot.saturating_add(1)) - low) * (rest as f32 * reciprocal)
    }
}

/// The number of quarters of a cluster by which the starts of differences advance. It is one where a
/// quarter is a whole number of samples.
pub(crate) const fn stride(m: u32) -> u32 {
    match m {
        1 => 4,
        2 => 2,
        _ => 1,
    }
}

#[cfg(test)]
mod tests;
