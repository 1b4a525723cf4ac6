//! Where a logger repeats samples. Two clocks repeat them at regular places, which tell the ratio of the clocks better than
//! the number of repeats does: that also counts those by chance.

use allanite::faults::Repeats;
use rustfft::{Fft as _, FftDirection, algorithm::Radix4, num_complex::Complex};
use std::f64::consts::PI;

/// The most rows that are looked at. Their transform takes 30 MB, and finds a share to 2·10^-6.
const MOST: usize = 1 << 18;
/// The fewest rows of each kind, because a line is not told from noise by fewer.
const FEWEST_OF_EACH: usize = 16;
/// The fewest rows. A line is found to a bin of so many, which is finer than what their number tells.
const FEWEST: usize = 1 << 10;
/// The power of a line over that of the noise about it, which noise reaches once in 10^8 bins. Chosen by hand.
const LINE: f64 = 25.0;
/// The shares about the counted one in which the line is looked for: so many of its standard errors, and this part of it.
const AROUND: (f64, f64) = (1.5, 0.01);
/// The bins beyond these shares that tell the noise as well.
const ABOUT: usize = 64;
/// The part of the amplitude that a perfectly regular logger would give. Scattered reading leaves less, and a vibration that
/// changes the chance of repeats has still less.
const LEAST_AMPLITUDE: f64 = 0.15;

/// The rows that repeat the one before, of one stretch without a gap: the longest.
#[derive(Clone, Debug, Default)]
pub struct Places {
    repeats: Vec<bool>,
    longest: Vec<bool>,
}

impl Places {
    /// Adds a row, unless enough of them are known.
    pub fn push(&mut self, repeats: bool) {
        if self.repeats.len() < MOST && self.longest.len() < MOST {
            self.repeats.push(repeats);
        }
    }

    /// Marks a place where the next row does not adjoin the one before.
    pub fn gap(&mut self) {
        if self.repeats.len() > self.longest.len() {
            std::mem::swap(&mut self.repeats, &mut self.longest);
        }
        self.repeats.clear();
    }

    /// The share of the rows that the logger repeated, by their places; `None` if these are not regular. `counted` tells
    /// about which share it is.
    ///
    /// A sensor of rate ρ that is read at rate 1 gives a new sample in the rows n in which ⌊ρ·n⌋ changes. The others have
    /// a Fourier line at the frequency 1 − ρ, which is their share, with the amplitude sin(π·ρ)/π.
    pub fn share(&self, counted: &Repeats) -> Option<f64> {
        let rows = match self.repeats.len() > self.longest.len() {
            true => &self.repeats,
            false => &self.longest,
        };
        let number = rows.len();
        if !counted.told || number < FEWEST {
            return None;
        }
        let repeats = rows.iter().filter(|&&repeats| repeats).count();
        if repeats.min(number - repeats) < FEWEST_OF_EACH {
            return None;
        }
        let mean = repeats as f64 / number as f64;
        let length = 2 * number.next_power_of_two();
        let centred = rows
            .iter()
            .map(|&repeats| f64::from(u8::from(repeats)) - mean);
        let mut values: Vec<Complex<f64>> = centred.map(Complex::from).collect();
        values.resize(length, Complex::default());
        // The length is a power of two. A planner would bring the algorithms of all other lengths into the page.
        Radix4::new(length, FftDirection::Forward).process(&mut values);
        let around = (AROUND.0 * counted.least)
            .max(AROUND.1 * counted.share)
            .min(0.3 * counted.share);
        let bin = |share: f64| (share * length as f64).clamp(1.0, length as f64 - 1.0);
        let bins = bin(counted.share - around).floor() as usize
            ..=bin(counted.share + around).ceil() as usize;
        let power = |at: usize| (values[at].norm_sqr(), at);
        let (line, at) = bins.clone().map(power).max_by(|a, b| a.0.total_cmp(&b.0))?;
        // Repeats that come in bursts are not white: their slow frequencies have more power.
        let about =
            bins.start().saturating_sub(ABOUT).max(1)..=(bins.end() + ABOUT).min(length - 1);
        let mut about: Vec<f64> = about.map(|at| power(at).0).collect();
        let middle = about.len() / 2;
        let median = *about.select_nth_unstable_by(middle, f64::total_cmp).1;
        let white = number as f64 * mean * (1.0 - mean);
        let noise = white.max(median / std::f64::consts::LN_2);
        let share = at as f64 / length as f64;
        let regular = (1.0 - counted.chance) * (PI * share).sin() / PI * number as f64;
        (line > LINE * noise && line.sqrt() > LEAST_AMPLITUDE * regular).then_some(share)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn counted(share: f64) -> Repeats {
        let mut faults = allanite::faults::SampleFaults::new();
        let (mut state, mut random) = (0.0, 1_u32);
        for _ in 0..1 << 14 {
            state += share;
            if state < 1.0 {
                random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            } else {
                state -= 1.0;
            }
            faults.push((random >> 8) as i32);
        }
        faults.repeats(None)
    }

    #[test]
    fn regular_places_tell_the_share_beside_repeats_by_chance() {
        let mut random = 7_u32;
        for share in [0.05, 0.0577, 0.2, 0.3371, 0.5, 0.6, 2.0 / 3.0] {
            for chance in [0, 20, 40] {
                let (mut places, mut state) = (Places::default(), 0.3);
                for _ in 0..1 << 14 {
                    state += share;
                    random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                    places.push(state >= 1.0 || random >> 16 < chance * 65_536 / 100);
                    state -= f64::from(u8::from(state >= 1.0));
                }
                let found = places.share(&counted(share * 1.004)).unwrap();
                assert!(
                    ((1.0 - found) / (1.0 - share) - 1.0).abs() < 3e-4,
                    "{share} {chance}: {found}"
                );
            }
        }
    }

    #[test]
    fn random_places_tell_nothing() {
        let mut random = 7_u64;
        for share in [0.02, 0.05, 0.1, 0.3] {
            let mut places = Places::default();
            for _ in 0..1 << 14 {
                random = random
                    .wrapping_mul(6_364_136_223_846_793_005)
                    .wrapping_add(1_442_695_040_888_963_407);
                places.push(((random >> 33) as f64) < share * 2_f64.powi(31));
            }
            assert_eq!(places.share(&counted(share)), None, "{share}");
        }
    }

    #[test]
    fn the_longest_stretch_without_a_gap_counts() {
        let mut places = Places::default();
        let mut push = |rows: std::ops::Range<usize>, every: usize| {
            for row in rows {
                places.push(row % every == 0);
            }
            places.gap();
        };
        push(0..3000, 7);
        push(0..6000, 5);
        push(0..4000, 6);
        let share = places.share(&counted(0.2)).unwrap();
        assert!((share - 0.2).abs() < 1e-3, "{share}");
    }
}
