//! Whether the numbers of a curve are possible.

use super::{AxisCurve, Octave, TOLERANCE, variances};
use allanite::Curve;
use allanite_log::{OCTAVES, failure::brief, sizes::MOST_SAMPLES};
use std::ops::Range;

impl AxisCurve {
    /// Whether every number is possible, and follows from the others where it has to.
    pub fn check(&self) -> Result<(), String> {
        let positive = |name: &str, value: f64| {
            let valid = value.is_finite() && value > 0.0;
            valid
                .then_some(())
                .ok_or_else(|| format!("{name} {} is impossible", brief(value)))
        };
        positive("rate_hz", self.rate_hz)?;
        if !(1e-6..=1e9).contains(&self.rate_hz) {
            return Err(format!("rate_hz {} is impossible", brief(self.rate_hz)));
        }
        positive("rate_per_count", self.rate_per_count)?;
        if let Some(mean) = self.mean_rate.filter(|mean| !mean.is_finite()) {
            return Err(format!("mean_rate {} is impossible", brief(mean)));
        }
        if self.samples > MOST_SAMPLES || self.first_sample > MOST_SAMPLES {
            return Err(format!("{} samples are impossible", self.samples));
        }
        if self.gaps > self.samples {
            let (gaps, samples) = (self.gaps, self.samples);
            return Err(format!("{gaps} gaps in {samples} samples are impossible"));
        }
        if self.octaves.len() < 2 {
            return Err(format!(
                "a fit needs two octaves, and the file has {}",
                self.octaves.len()
            ));
        }
        if !self.bridged.is_possible() {
            return Err("the gaps that were filled are impossible".into());
        }
        let raw = self.octaves.iter();
        let raw = raw.map(|octave| (octave.m, octave.differences, octave.sum));
        let variances = variances(raw, self.rate_per_count, &self.bridged, self.samples);
        let mut last = 0;
        for (octave, variance) in self.octaves.iter().zip(variances) {
            let here = |what: String| format!("octave m = {}: {what}", octave.m);
            if octave.m <= last {
                return Err(here("averaging factors must ascend".into()));
            }
            last = octave.m;
            self.check_octave(octave, variance).map_err(here)?;
        }
        for short in &self.short {
            let here = |what: String| format!("short octave m = {}: {what}", short.m);
            if short.m <= last {
                return Err(here("averaging factors must ascend".into()));
            }
            last = short.m;
            let few = 1..Curve::<OCTAVES>::MIN_DIFFERENCES;
            self.check_sum(short.m, short.differences, short.sum, few)
                .map_err(here)?;
        }
        let variance = |m| {
            let mut octaves = self.octaves.iter();
            octaves
                .find(|octave| octave.m == m)
                .map(|octave| octave.variance)
        };
        if let Some(spectrum) = &self.spectrum {
            spectrum.check(self.samples, self.rate_hz, variance)?;
        }
        if let Some(pieces) = &self.pieces {
            self.check_pieces(pieces)?;
        }
        if let Some(course) = &self.course {
            // Missing samples count as time.
            let samples = (self.gaps == 0).then_some(self.samples);
            course.check(samples, self.rate_hz, variance)?;
        }
        Ok(())
    }

    fn check_octave(&self, octave: &Octave, variance: f64) -> Result<(), String> {
        let least = Curve::<OCTAVES>::MIN_DIFFERENCES;
        self.check_sum(octave.m, octave.differences, octave.sum, least..u64::MAX)?;
        if !close(octave.tau_s, f64::from(octave.m) / self.rate_hz) {
            return Err(format!("tau_s {} is not m / rate_hz", brief(octave.tau_s)));
        }
        if !close(octave.variance, variance) {
            return Err(format!(
                "variance {} does not follow from the sum",
                brief(octave.variance)
            ));
        }
        Ok(())
    }

    fn check_sum(
        &self,
        m: u32,
        differences: u64,
        sum: u128,
        allowed: Range<u64>,
    ) -> Result<(), String> {
        if !m.is_power_of_two() || m.ilog2() >= OCTAVES as u32 {
            return Err("the averaging factor is not a power of two up to 2^29".into());
        }
        let samples = self.samples.saturating_add(self.bridged.lost());
        let possible = possible_differences(self.first_sample, samples, m);
        let right = match self.gaps {
            0 if self.bridged.is_empty() => differences == possible,
            _ => differences <= possible,
        };
        if !right || !allowed.contains(&differences) {
            return Err(format!(
                "{differences} differences of {} samples are impossible",
                self.samples
            ));
        }
        // The sums of two clusters of m counts differ by less than 2^32 m.
        if sum as f64 > differences as f64 * (f64::from(m) * 2f64.powi(32)).powi(2) {
            return Err(format!("a sum of {sum} is too large for 32-bit counts"));
        }
        Ok(())
    }
}

/// Number of quarter-overlapping differences of the samples from this one on, without gaps.
fn possible_differences(first_sample: u64, samples: u64, m: u32) -> u64 {
    let (block, last) = match m {
        1 => (1, 1),
        2 => (1, 3),
        _ => (u64::from(m / 4), 7),
    };
    let end = first_sample.saturating_add(samples) / block;
    let blocks = end.saturating_sub(first_sample.div_ceil(block));
    blocks.saturating_sub(last)
}

fn close(value: f64, expected: f64) -> bool {
    expected.is_finite() && (value - expected).abs() <= TOLERANCE * expected
}
