//! A quantity behind first-order lags, in integers.

/// Bits behind the point of what [`Lags::push`] returns. A thermometer of whole degrees then still changes smoothly behind a lag.
const FRACTION: u32 = 8;
/// Bits behind the point of the state.
const STATE: u32 = 30;
/// The largest logarithm of a lag: 2^30 samples.
const LONGEST: u32 = 30;

/// A quantity as it is, such as a temperature, and behind first-order lags: the covariates of a gyro that follows it late.
///
/// A gyro has a thermal mass, so that its rate follows a thermometer with a lag of seconds to minutes. Subtracting the temperature as
/// it is then leaves a rest that looks like rate random walk. The sum of two neighbouring covariates of this bank follows any
/// lag up to a third of the longest one. So a [diagnosis](crate::diagnosis) that tries them
/// [in pairs](crate::covariate::Pair) explains the record, and
/// [`dependence`](crate::diagnosis::FollowedCovariate::dependence) gives the slope and the lag. Longer lags leave a rest.
///
/// ```
/// use allanite::{Axes, covariate::Lags};
///
/// // 100 Hz: the temperature, and behind lags of 2^11 and 2^13 samples, which are 20 s and 82 s.
/// let mut lags = Lags::new([0, 11, 13]);
/// let mut axes = Axes::<16, 3>::new();
/// # let read = || ([0, 0, 0], 2950);
/// let (counts, temperature) = read();
/// axes.push((counts, lags.push(temperature)));
/// ```
///
/// A lag takes 8 bytes, a subtraction, a shift and an addition of 64 bits a sample.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Lags<const COVARIATES: usize> {
    log2: [u32; COVARIATES],
    /// The values behind each lag, with [`STATE`] bits behind the point. `None` before the first count.
    states: Option<[i64; COVARIATES]>,
}

impl<const COVARIATES: usize> Lags<COVARIATES> {
    /// What one count of the quantity is in counts of the covariates: the unit of each covariate is the 256th part of that of the
    /// quantity.
    pub const PER_COUNT: u32 = 1 << FRACTION;

    /// Lags of 2^`log2` samples, shortest first; 0 stands for the quantity as it is. More than 30 count as 30.
    pub const fn new(log2: [u32; COVARIATES]) -> Self {
        Self { log2, states: None }
    }

    /// Takes the count of a sample, and returns the covariates of that sample: 256 times the count behind each lag. The first count is
    /// taken for that of all times before. Counts beyond ±2^22 are clipped.
    #[inline]
    pub fn push(&mut self, count: i32) -> [i32; COVARIATES] {
        let most = 1 << (STATE - FRACTION);
        let count = i64::from(count.clamp(-most, most)) << STATE;
        let states = self.states.get_or_insert([count; COVARIATES]);
        let mut covariates = [0; COVARIATES];
        let all = states.iter_mut().zip(&self.log2).zip(&mut covariates);
        for ((state, &log2), covariate) in all {
            *state += (count - *state) >> log2.min(LONGEST);
            *covariate = (*state >> (STATE - FRACTION)) as i32;
        }
        covariates
    }

    /// The mean age of the counts behind each lag, in samples: by so much is a slow change late.
    pub fn ages(&self) -> [u32; COVARIATES] {
        // An age of n samples has the weight (1 − 2^-k)^n / 2^k.
        self.log2
            .map(|log2| (1_u32 << log2.min(LONGEST)).saturating_sub(1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_is_followed_with_the_lag() {
        let mut lags = Lags::new([0, 4, 9]);
        assert_eq!(lags.push(100), [25_600; 3]);
        for samples in 1..3000 {
            let [own, short, long] = lags.push(-1100);
            assert_eq!(own, -1100 * 256);
            for (value, log2) in [(short, 4), (long, 9)] {
                let left = (1.0 - 0.5_f64.powi(log2)).powi(samples);
                let exact = 256.0 * (-1100.0 + 1200.0 * left);
                assert!(
                    (f64::from(value) - exact).abs() < 1.001,
                    "{samples}: {value} {exact}"
                );
            }
        }
    }

    #[test]
    fn a_ramp_is_followed_as_late_as_the_mean_age() {
        let mut lags = Lags::new([3, 6, 10]);
        for n in 0..20_000 {
            lags.push(n);
        }
        let late = lags
            .push(20_000)
            .map(|value| 20_000.0 - f64::from(value) / 256.0);
        for (late, age) in late.into_iter().zip(lags.ages()) {
            assert!((late - f64::from(age)).abs() < 0.01, "{late} {age}");
        }
    }

    #[test]
    fn counts_of_any_size_are_taken() {
        let mut lags = Lags::new([0, 1, 31]);
        let most = 1 << 30;
        for (count, [own, half]) in [(i32::MIN, [-most, -most]), (i32::MAX, [most, 0])] {
            let [is, behind, long] = lags.push(count);
            assert_eq!(([is, behind], long < 0), ([own, half], true));
        }
    }
}
