//! Curves and records of many kinds, numbered, whose fits and looks cost different numbers of instructions.

use crate::{
    clock::Clock,
    work::{HIDDEN, Hidden, curve_of, look},
};
use allanite::{Accumulator, Real, ieee_952};
use core::hint::black_box;
use demonstration::simulated::Random;

/// The numbers are below this one.
const NUMBERS: u32 = 1000;

/// The curve whose fit and the record whose look take most instructions, of 14 octaves on a Cortex-M0 and of 20 on a Cortex-M4F.
/// `cargo xtask bench --worst` seeks them.
pub(crate) const fn costliest(octaves: usize) -> [u32; 2] {
    if octaves < 20 { [437, 710] } else { [317, 710] }
}

/// The number of instructions of a fit of the five terms to the curve of this number.
pub(crate) fn five_terms<const OCTAVES: usize>(clock: &Clock, number: u32) -> Option<f64> {
    let mut random = Random::new(number.into());
    let squares = core::array::from_fn(|_| sometimes(&mut random, 10.0));
    let hidden = HIDDEN
        .get(random.bits() as usize % HIDDEN.len())
        .map_or(&[][..], |(_, hidden)| hidden);
    let size = sometimes(&mut random, 5.0);
    let (effects, of_them) = scaled(hidden, size);
    let effects = effects.get(..of_them)?;
    let curve = curve_of::<OCTAVES>(&squares, effects, |n| off(&mut random, n))?;
    Some(clock.instructions(|| {
        let _ = black_box(ieee_952::fit(black_box(&curve)));
    }))
}

/// The same of a look of a self-test at the record of this number.
pub(crate) fn of_look<const OCTAVES: usize>(clock: &Clock, number: u32) -> Option<f64> {
    let accumulator = record::<OCTAVES>(&mut Random::new(number.into()));
    Some(clock.instructions(|| {
        black_box(look(black_box(&accumulator)));
    }))
}

/// What a thousand of them cost.
pub(crate) struct Costs {
    pub(crate) mean: f64,
    pub(crate) most: f64,
    /// The number of the one that costs most.
    pub(crate) costliest: u32,
}

impl Costs {
    /// Of what costs so many instructions for each number.
    pub(crate) fn of(one: impl Fn(u32) -> Option<f64>) -> Self {
        let (mut sum, mut most, mut costliest, mut counted) = (0.0, 0.0, 0, 0_u32);
        for number in 0..NUMBERS {
            let Some(instructions) = one(number) else {
                continue;
            };
            sum += instructions;
            counted += 1;
            if instructions > most {
                (most, costliest) = (instructions, number);
            }
        }
        let mean = sum / f64::from(counted.max(1));
        Self {
            mean,
            most,
            costliest,
        }
    }
}

/// Zero in every third case, and else up to 2^`octaves` and down to its inverse.
fn sometimes(random: &mut Random, octaves: f64) -> Real {
    if random.bits().is_multiple_of(3) {
        return 0.0;
    }
    let uniform = f64::from(random.bits()) / f64::from(u32::MAX);
    libm::exp2((2.0 * uniform - 1.0) * octaves) as Real
}

/// At most two effects with their coefficients multiplied.
fn scaled(hidden: &[Hidden], size: Real) -> ([Hidden; 2], usize) {
    let mut effects = [HIDDEN[1].1[0]; 2];
    let number = if size > 0.0 { hidden.len().min(2) } else { 0 };
    for (to, from) in effects.iter_mut().zip(hidden) {
        *to = (from.0, from.1, from.2 * size);
    }
    (effects, number)
}

/// The relative deviation of an octave of so many differences, of which one in four is independent.
fn off(random: &mut Random, differences: Real) -> Real {
    let bytes = random.bits().to_le_bytes();
    let four = bytes.iter().map(|&byte| Real::from(byte) - 127.5);
    let independent = 0.25 * demonstration::double(differences) + 1.0;
    let scatter = libm::sqrt(2.0 / independent) as Real;
    (four.sum::<Real>() / 147.8 * scatter).max(-0.9)
}

/// A record of 4096 samples of a random mixture of white noise, a walk, slow noise, a line, telegraph noise and a low pass.
fn record<const OCTAVES: usize>(random: &mut Random) -> Accumulator<OCTAVES> {
    let mut size = || match random.bits() % 3 {
        0 => 0,
        _ => 1_i32 << (random.bits() % 9),
    };
    let [white, walk, slow, line, telegraph] = core::array::from_fn(|_| size());
    let filter = random.bits() % 5;
    let memory = 1 + random.bits() % 9;
    let period = 2 + random.bits() % 500;
    let seldom = 2 + random.bits() % 500;
    let (mut walked, mut state, mut level, mut passed) = (0_i32, 0_i32, 1_i32, 0_i32);
    let mut accumulator = Accumulator::new();
    for n in 0..4096_u32 {
        let mut noise = || {
            let bytes = random.bits().to_le_bytes();
            bytes.iter().map(|&byte| i32::from(byte)).sum::<i32>() - 510
        };
        walked += (walk * noise()) >> 6;
        state += (slow * noise() - state) >> memory;
        let fresh = white * noise();
        if random.bits().is_multiple_of(seldom) {
            level = -level;
        }
        let phase = (n % period) as i32 * 4 - 2 * period as i32;
        let triangle = line * (phase.abs() - period as i32) * 64 / period as i32;
        passed += (fresh - passed) >> filter;
        accumulator.push((passed + walked + state + triangle + telegraph * level * 100) >> 4);
    }
    accumulator
}
