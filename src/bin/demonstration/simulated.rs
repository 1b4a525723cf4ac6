//! A simulated gyro that computes in integers only, so that it gives the same counts on every machine.

mod disturbance;

pub use disturbance::Disturbance;

use super::double;
use allanite::Scale;
use core::f64::consts::{LN_2, PI};
use disturbance::Source;

/// The number of fraction bits of every amplitude.
const FRACTION: u32 = 24;

/// The number of relaxation processes that make up the flicker noise. The slowest has a relaxation time of
/// 2^23 samples.
const POLES: usize = 24;

/// The amplitudes of the five terms of IEEE Std 952, in 2^-24 counts; each is below 256 counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Amplitudes {
    /// The standard deviation of the angle's jitter, in count · samples. The rounding of the angle to
    /// whole counts adds a variance of 1/12.
    pub quantization: u32,
    /// The standard deviation of the white noise of one sample.
    pub white: u32,
    /// The standard deviation of each of the flicker noise's relaxation processes.
    pub flicker: u32,
    /// The standard deviation of the random walk's step from sample to sample.
    pub walk: u32,
    /// The increase of the rate from sample to sample.
    pub ramp: i32,
}

impl Amplitudes {
    /// The coefficients Q, N, B, K and R of IEEE Std 952 that a sensor of this scale shows, in its
    /// rate unit and seconds. With amplitudes `a` in counts, the sample interval τ₀ and the rate
    /// `u` per count:
    ///
    /// ```text
    /// Q = u τ₀ √(a² + 1/12)      N = u √τ₀ a      B = u √(π/ln 2) a      K = u a/√τ₀      R = u a/τ₀
    /// ```
    pub fn coefficients(&self, scale: Scale) -> [f64; 5] {
        let one = f64::from(1 << FRACTION);
        let counts = |amplitude: u32| f64::from(amplitude) / one;
        let rate = double(scale.rate_per_count());
        let interval_s = 1.0 / double(scale.rate_hz());
        let jitter = counts(self.quantization);
        [
            rate * interval_s * libm::sqrt(jitter * jitter + 1.0 / 12.0),
            rate * libm::sqrt(interval_s) * counts(self.white),
            rate * libm::sqrt(PI / LN_2) * counts(self.flicker),
            rate / libm::sqrt(interval_s) * counts(self.walk),
            rate / interval_s * f64::from(self.ramp) / one,
        ]
    }
}

/// A gyro at rest with the five terms of IEEE Std 952: an endless iterator over its counts.
///
/// The rate is the sum of white noise, flicker noise, a random walk and a ramp. At any moment, the sensor's
/// counts add up to its angle plus a jitter, rounded to whole counts. Therefore the rounding is quantization
/// noise too.
///
/// Flicker noise is the sum of 24 first-order Gauss–Markov processes `x ← x − x/2^p ± a √(2/2^p)`
/// with `p = 0 … 23`. Their time constants are an octave apart. Each has the variance `a²`, or a
/// larger one if its time constant is below 8 samples (van der Ziel 1950; Kasdin 1995, section III).
/// Their two-sided spectral densities add up to `a²/(2 ln 2 · f)`, so that `B² = π a²/ln 2`. The
/// Allan variance is flat to 1 % from `m = 8` to 2^17. At smaller `m`, flicker noise averaged over
/// each sample would have a smaller variance: by 3, 14 and 38 % at `m = 4, 2, 1`. The signs are
/// random bits, whose sum over a relaxation time is nearly normal.
///
/// A normal number is the number of ones in 32 random bits plus a uniform number, scaled to unit
/// variance. Its excess kurtosis is −0.06, and it never exceeds 5.8 standard deviations. The random bits come
/// from xoshiro128++ (Blackman & Vigna 2021), seeded by SplitMix64.
#[derive(Clone, Debug)]
pub struct SimulatedGyro {
    amplitudes: Amplitudes,
    random: Random,
    poles: [Pole; POLES],
    source: Source,
    walk: i64,
    ramp: i64,
    /// The angle that the counts do not contain yet. Its magnitude is below one count plus the jitter.
    rest: i64,
}

impl SimulatedGyro {
    /// A gyro whose flicker noise is stationary from the first sample, and whose random walk and ramp start
    /// at zero.
    pub fn new(amplitudes: Amplitudes, seed: u64) -> Self {
        Self::disturbed(amplitudes, None, seed)
    }

    /// The same gyro with a disturbance that the five terms do not describe.
    pub fn disturbed(amplitudes: Amplitudes, disturbance: Option<Disturbance>, seed: u64) -> Self {
        let mut random = Random::new(seed);
        let mut relaxation = 0;
        let poles = [(); POLES].map(|()| {
            let pole = Pole::new(amplitudes.flicker, relaxation, &mut random);
            relaxation += 1;
            pole
        });
        let source = Source::new(disturbance, &mut random);
        Self {
            amplitudes,
            random,
            poles,
            source,
            walk: 0,
            ramp: 0,
            rest: 0,
        }
    }
}

impl Iterator for SimulatedGyro {
    type Item = i32;

    fn next(&mut self) -> Option<i32> {
        let Amplitudes {
            quantization,
            white,
            walk,
            ramp,
            ..
        } = self.amplitudes;
        self.walk += self.random.normal(walk);
        self.ramp += i64::from(ramp);
        let mut flicker = 0;
        let mut signs = self.random.bits();
        for (relaxation, pole) in (0..).zip(&mut self.poles) {
            flicker += pole.next(relaxation, signs & 1 == 1);
            signs >>= 1;
        }
        let white = self.random.normal(white);
        let white = self.source.next(white, &mut self.random);
        let angle = self.rest + white + flicker + self.walk + self.ramp;
        let count = rounded(angle + self.random.normal(quantization), FRACTION);
        self.rest = angle - (count << FRACTION);
        // A walk or a ramp that leaves 32 bits clips, as it does in a sensor.
        Some(count.clamp(i32::MIN.into(), i32::MAX.into()) as i32)
    }
}

/// A first-order Gauss–Markov process with a relaxation time of 2^p samples, in 2^-24 counts.
#[derive(Clone, Copy, Debug)]
struct Pole {
    state: i64,
    step: i64,
}

impl Pole {
    fn new(deviation: u32, relaxation: u32, random: &mut Random) -> Self {
        let variance = u128::from(deviation) * u128::from(deviation);
        Self {
            state: random.normal(deviation),
            step: ((2 * variance) >> relaxation).isqrt() as i64,
        }
    }

    fn next(&mut self, relaxation: u32, up: bool) -> i64 {
        let step = if up { self.step } else { -self.step };
        self.state += step - rounded(self.state, relaxation);
        self.state
    }
}

/// `value/2^bits`, rounded to the nearest integer.
fn rounded(value: i64, bits: u32) -> i64 {
    (value + (1 << bits >> 1)) >> bits
}

/// The generator xoshiro128++, whose random bits are the same on every machine.
#[derive(Clone, Debug)]
pub struct Random {
    state: [u32; 4],
}

impl Random {
    /// A generator whose sequence depends on the seed.
    pub fn new(seed: u64) -> Self {
        // SplitMix64 never returns two successive words of zero, so that xoshiro's state is never zero.
        let mut seed = seed;
        let mut word = || {
            seed = seed.wrapping_add(0x9E37_79B9_7F4A_7C15);
            let mixed = (seed ^ seed >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
            let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
            mixed ^ mixed >> 31
        };
        let (first, second) = (word(), word());
        Self {
            state: [
                first as u32,
                (first >> 32) as u32,
                second as u32,
                (second >> 32) as u32,
            ],
        }
    }

    /// The next 32 random bits.
    pub fn bits(&mut self) -> u32 {
        let s = &mut self.state;
        let result = s[0].wrapping_add(s[3]).rotate_left(7).wrapping_add(s[0]);
        let shifted = s[1] << 9;
        s[2] ^= s[0];
        s[3] ^= s[1];
        s[1] ^= s[2];
        s[0] ^= s[3];
        s[2] ^= shifted;
        s[3] = s[3].rotate_left(11);
        result
    }

    /// A normal number with this standard deviation, exact to 1e-5.
    fn normal(&mut self, deviation: u32) -> i64 {
        if deviation == 0 {
            return 0;
        }
        // The number of ones has the variance 8, and the uniform number 1/12. √(97/12) · 23051 = 2^16.
        const SCALE: i64 = 23_051;
        let ones = i64::from(self.bits().count_ones()) - 16;
        let uniform = i64::from(self.bits() >> 16) - (1 << 15);
        let unit = rounded(((ones << 16) + uniform) * SCALE, 16);
        rounded(unit * i64::from(deviation), 16)
    }
}
