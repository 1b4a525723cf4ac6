//! The sum over two octaves of what effects without detail add.

use super::{
    starts::{NEAR, NEGLIGIBLE, Starts, places, step_after},
    wave::{Turn, Wave},
};
use crate::{
    curve::Point,
    numerics::real::{Real, real},
    theory::lattice::{self, Rounded},
};

/// Two octaves of a curve.
pub(super) struct Pair<'a> {
    pub(super) shorter: &'a Point,
    pub(super) longer: &'a Point,
}

impl Pair<'_> {
    /// The length of the longer cluster in quarters of the shorter one: the lag of the outer kinks.
    pub(super) fn middle(&self) -> u32 {
        let ratio = self.longer.m.checked_div(self.shorter.m).unwrap_or(0);
        ratio.saturating_mul(4)
    }

    pub(super) fn covariance(
        &self,
        differences: &Rounded,
        turns: &[Turn],
        waves: &mut [Wave<'_>],
    ) -> Real {
        let middle = self.middle();
        let stride = lattice::stride(self.shorter.m);
        let starts = Starts::new(self.shorter, self.longer);
        let outer = middle.saturating_add(NEAR);
        let (mut sum, mut beats, mut quiet) = (0.0_f32, 0.0_f32, 0_u32);
        let (mut lag, mut step_before) = (0_u32, 0);
        loop {
            let step = step_after(lag, middle, stride);
            let pairs = starts.pairs(lag);
            let here = differences.at(lag);
            let random = differences.at(lag.abs_diff(middle)) - (here + here)
                + differences.at(lag.saturating_add(middle));
            if random != 0.0 {
                // The trapezoidal rule weights a lag with half the steps to either side. The factor of
                // one half follows below, and so does the division by the stride. `pairs` counts both
                // signs of the lag.
                let weight =
                    (u64::from(step_before) + u64::from(step)).saturating_mul(pairs) as f32;
                let mut beat = 0.0;
                for wave in &*waves {
                    beat += wave.value();
                }
                let term = weight * (random * random);
                let beat = weight * (random * beat);
                sum += term;
                beats += beat;
                let counts = lag <= outer || (term + beat).abs() > NEGLIGIBLE * (sum + beats).abs();
                quiet = if counts { 0 } else { quiet.saturating_add(1) };
            } else {
                quiet = quiet.saturating_add(1);
            }
            for wave in &mut *waves {
                wave.advance(lag, step, turns);
            }
            lag = lag.saturating_add(step);
            step_before = step;
            let far = lag > outer && quiet >= 2;
            if far || pairs == 0 || lag >= lattice::END / 2 {
                break;
            }
        }
        // The beats of waves against noise cannot lower the variance of one octave. Where a wave is strong and turns far
        // over a step, the rule leaves of it more than the noise scatters, of either sign.
        let is_variance = self.shorter.m == self.longer.m;
        let beats = if is_variance { beats.max(0.0) } else { beats };
        self.scaled(sum + beats, stride, differences)
    }

    /// The covariance that belongs to a sum over pairs, which took every pair `2 stride` times.
    pub(super) fn scaled(&self, sum: f32, stride: u32, differences: &Rounded) -> Real {
        let counts = places(self.shorter, self.longer) as Real * self.longer.differences as Real;
        // The square of τ² would leave the range of single precision, so τ² is divided out first.
        let unit = differences.unit() / (self.shorter.tau_s * self.longer.tau_s);
        0.25 * real(sum) * (unit * unit) / (real(stride) * counts)
    }
}
