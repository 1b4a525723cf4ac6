//! The covariance of bins against the scatter of simulated records of white noise.

use super::records::{Records, mean};
use allanite::{
    effect::{AngleRandomWalk, MAX_PARAMETERS},
    spectrum::covariance_rows,
};

const RECORDS: usize = 2000;

#[test]
fn bins_of_white_noise_scatter_as_they_are_said_to() {
    let mut records = Records::new(&AngleRandomWalk, [0.0; MAX_PARAMETERS]);
    let (expected, bins) = records.expected();
    let found = records.densities(RECORDS);
    let rows: Vec<_> = covariance_rows(&bins, &[]).collect();
    let covariance = |one: usize, other: usize| {
        let products = found.iter().map(|densities| {
            let off = |place: usize| densities[place] / expected[place] - 1.0;
            off(one) * off(other)
        });
        mean(products)
    };
    // Both levels, the variance and its two neighbours: the mean over all bins of a level.
    for level in [0..28, 28..56] {
        for (distance, tolerance) in [(0, 0.02), (1, 0.02), (2, 0.2)] {
            let places = level.start..level.end - distance;
            let found = mean(
                places
                    .clone()
                    .map(|place| covariance(place, place + distance)),
            );
            let expected = mean(places.map(|place| rows[place][distance]));
            assert!(
                (found / expected - 1.0).abs() < tolerance,
                "{level:?}, distance {distance}: {found:e}, expected {expected:e}"
            );
        }
        // Bins further apart do not scatter together.
        let found = mean((level.start..level.end - 3).map(|place| covariance(place, place + 3)));
        assert!(
            found.abs() < 0.02 * rows[level.start][0],
            "{level:?}: {found:e}"
        );
    }
    // Bins of different levels do not either.
    let found = mean((0..28).map(|place| covariance(place, place + 28)));
    assert!(found.abs() < 0.05 * rows[28][0], "{found:e}");
}

#[test]
fn spectral_kurtosis_of_white_noise_is_one() {
    let mut records = Records::new(&AngleRandomWalk, [0.0; MAX_PARAMETERS]);
    let mut low = Vec::new();
    for _ in 0..400 {
        let spectrum = records.next();
        let first = spectrum.bins().iter().take(28);
        low.push(mean(first.map(|bin| bin.spectral_kurtosis)));
    }
    let found = mean(low.iter().copied());
    // Overlapping segments are not independent, which lowers the ratio by a few per mille.
    assert!((found - 1.0).abs() < 0.02, "{found}");
}
