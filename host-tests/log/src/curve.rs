//! Curves of deviations that are given as logs.

use super::{
    columns::{Columns, Look},
    names,
};
use crate::failure::{Failure, Place};
use std::path::Path;

/// Averaging times grow by a factor, whose excess over 1 varies by less than this from one to the next. Stamps of equal
/// distance that grow by [`GROWS`] in all vary by more. Chosen by hand.
const VARIES: f64 = 5.0;

/// The least ratio of the last averaging time to the first one. Chosen by hand.
const GROWS: f64 = 10.0;

/// The words for averaging times and for deviations in the names of columns.
const TIMES: [&str; 4] = ["tau", "averaging", "cluster time", "cluster_time"];
const DEVIATIONS: [&str; 9] = [
    "adev",
    "mdev",
    "hdev",
    "avar",
    "allan",
    "deviation",
    "sigma",
    "variance",
    "tdev",
];

impl Columns {
    /// Checks that the table is not a curve: averaging times with the deviations there.
    ///
    /// # Errors
    /// When the names say so, or when the first column grows by a factor from row to row.
    pub(super) fn check_curve(&self, path: &Path) -> Result<(), Failure> {
        let has = |words: &[&str], column: usize| {
            let name = self.name(column).unwrap_or_default().to_lowercase();
            words.iter().any(|word| match *word {
                "tau" => names::tokens(&name).next() == Some("tau"),
                word => name.contains(word),
            })
        };
        let columns = 0..self.looks.len();
        let is_named = columns.clone().any(|column| has(&TIMES, column))
            && columns.clone().any(|column| has(&DEVIATIONS, column));
        let grows = || {
            self.looks.first() == Some(&Look::Rising)
                && self.looks.len() > 1
                && grows(&self.heads[0])
        };
        if !is_named && !grows() {
            return Ok(());
        }
        Err(Place::file(path).failure(
            "this is a curve of deviations over averaging times, not a log of samples",
            "give the log that it was computed from",
        ))
    }
}

/// Whether numbers grow by about the same factor from each to the next.
fn grows(numbers: &[f64]) -> bool {
    let (Some(&first), Some(&last)) = (numbers.first(), numbers.last()) else {
        return false;
    };
    let excess = numbers.windows(2).map(|pair| pair[1] / pair[0] - 1.0);
    let least = excess.clone().fold(f64::INFINITY, f64::min);
    let most = excess.fold(0.0, f64::max);
    first > 0.0 && last > GROWS * first && least > 0.0 && most < VARIES * least
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn averaging_times_grow_by_a_factor_and_stamps_do_not() {
        let times = |n: i32, factor: f64| (0..n).map(move |i| 0.01 * factor.powi(i));
        for (n, factor) in [(12, 2.0), (45, 1.34), (100, 1.05)] {
            assert!(grows(&times(n, factor).collect::<Vec<_>>()), "{factor}");
        }
        assert!(grows(&[1.0, 2.0, 4.0, 8.0, 10.0, 20.0, 40.0, 80.0, 100.0]));
        for first in [0.0, 1.0, 3.0, 100.0] {
            let stamps: Vec<f64> = (0..100).map(|i| first + f64::from(i)).collect();
            assert!(!grows(&stamps), "{first}");
        }
    }
}
