//! Standard errors by resampling records (Efron, The Annals of Statistics 7, 1, 1979).

use allanite_host::simulate::Random;
use rand::{RngExt, SeedableRng};

/// The number of resamples. The error of an error is then 2 %.
const RESAMPLES: u64 = 1000;

/// A statistic of numbers and its bootstrap error.
pub fn bootstrap<T: Clone>(records: &[T], statistic: impl Fn(&[T]) -> f64) -> [f64; 2] {
    if records.is_empty() {
        return [f64::NAN; 2];
    }
    let mut random = Random::seed_from_u64(RESAMPLES);
    let drawn: Vec<f64> = (0..RESAMPLES)
        .map(|_| {
            let draw = |_| records[random.random_range(0..records.len())].clone();
            statistic(&(0..records.len()).map(draw).collect::<Vec<T>>())
        })
        .collect();
    let mean = drawn.iter().sum::<f64>() / drawn.len() as f64;
    let squares = drawn.iter().map(|one| (one - mean).powi(2));
    let variance = squares.sum::<f64>() / (drawn.len() - 1) as f64;
    [statistic(records), variance.sqrt()]
}

/// The root of the mean square.
pub fn rms(errors: &[f64]) -> f64 {
    let squares: f64 = errors.iter().map(|error| error * error).sum();
    (squares / errors.len() as f64).sqrt()
}

/// The mean.
pub fn mean(numbers: &[f64]) -> f64 {
    numbers.iter().sum::<f64>() / numbers.len() as f64
}

/// The median.
pub fn median(numbers: &[f64]) -> f64 {
    let mut sorted = numbers.to_vec();
    sorted.sort_by(f64::total_cmp);
    let n = sorted.len();
    0.5 * (sorted[n / 2] + sorted[(n - 1) / 2])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_error_of_a_mean_is_that_of_theory() {
        let numbers: Vec<f64> = (0..400).map(f64::from).collect();
        let [mean, error] = bootstrap(&numbers, mean);
        assert_eq!(mean, 199.5);
        // The deviation of equally spaced numbers is n / √12, and its error by 1000 resamples 2 %.
        let theory = 400.0 / 12_f64.sqrt() / 20.0;
        assert!((error / theory - 1.0).abs() < 0.1, "{error} {theory}");
        assert_eq!(median(&numbers), 199.5);
        assert_eq!(median(&[3.0, 1.0, 2.0]), 2.0);
        assert_eq!(rms(&[3.0, -4.0, 0.0, 0.0]), 2.5);
    }
}
