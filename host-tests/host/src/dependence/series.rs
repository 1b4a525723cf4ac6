//! Series of block means that are formed from those of a column.

/// The column behind a thermal mass: `T dx_l/dt = x − x_l`, in blocks, where the lag `T` is given in durations of a
/// block. Every block takes the mean of its column for a constant, so that the solution is exact and has no delay of
/// its own. The mass starts at the temperature of the first block.
pub fn lagged(means: &[f64], lag_blocks: f64) -> Vec<f64> {
    let mut state = means.first().copied().unwrap_or(0.0);
    let kept = (-1.0 / lag_blocks).exp();
    // The mean of a decaying exponential over a block.
    let share = -(-1.0 / lag_blocks).exp_m1() * lag_blocks;
    let next = |&mean: &f64| {
        let away = state - mean;
        state = mean + away * kept;
        mean + away * share
    };
    means.iter().map(next).collect()
}

/// The rate of change per second, from the means of the blocks before and after. The first block and the last one take
/// their own mean in the place of the one that is missing.
pub fn rate_of_change(means: &[f64], block_s: f64) -> Vec<f64> {
    let last = means.len().saturating_sub(1);
    let at = |b: usize| {
        let (before, after) = (b.saturating_sub(1), (b + 1).min(last));
        let blocks = (after - before).max(1) as f64;
        (means[after] - means[before]) / (blocks * block_s)
    };
    (0..means.len()).map(at).collect()
}

/// The mean of a series.
pub fn mean(means: &[f64]) -> f64 {
    means.iter().sum::<f64>() / means.len().max(1) as f64
}

/// The square of the distance from a centre.
pub fn squared(means: &[f64], centre: f64) -> Vec<f64> {
    means.iter().map(|x| (x - centre).powi(2)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lag_solves_its_equation() {
        // The response to a ramp of one per block follows it by the lag.
        let ramp: Vec<f64> = (0..400).map(f64::from).collect();
        for lag in [0.3, 2.0, 20.0] {
            let behind = lagged(&ramp, lag);
            assert!((ramp[399] - behind[399] - lag).abs() < 1e-6, "{lag}");
        }
        // A step decays exponentially from its block on.
        let step: Vec<f64> = (0..60).map(|b| f64::from(b >= 1)).collect();
        let behind = lagged(&step, 5.0);
        for b in 1..60 {
            let away = |t: f64| (-t / 5.0).exp();
            let before = f64::from(b) - 1.0;
            let mean = 1.0 - 5.0 * (away(before) - away(before + 1.0));
            assert!((behind[b as usize] - mean).abs() < 1e-12, "{b}");
        }
    }

    #[test]
    fn a_rate_of_change_is_that_of_a_parabola() {
        let parabola: Vec<f64> = (0..9).map(|b| f64::from(b * b)).collect();
        let rate = rate_of_change(&parabola, 0.5);
        assert_eq!(rate[3..6], [12.0, 16.0, 20.0]);
        assert_eq!(rate_of_change(&[3.0], 1.0), [0.0]);
    }
}
