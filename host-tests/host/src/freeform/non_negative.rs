//! Least squares with coefficients that are not negative (Lawson & Hanson 1974, chapter 23).

use nalgebra::{DMatrix, DVector};

/// Rounds for each column before the solution is taken as it is.
const ROUNDS: usize = 6;
/// A gradient below this share of the largest right side is none.
const NONE: f64 = 1e-10;

/// The coefficients with the least squares for normal equations, none of them below zero. The columns are scaled to a length of
/// one.
pub(super) fn solve(gram: &DMatrix<f64>, right: &DVector<f64>) -> DVector<f64> {
    let count = right.len();
    let mut free = vec![false; count];
    let mut found = DVector::zeros(count);
    let bar = NONE * right.amax();
    for _ in 0..ROUNDS * count {
        let gradient = right - gram * &found;
        let fixed = (0..count).filter(|&i| !free[i] && gradient[i] > bar);
        let Some(next) = fixed.max_by(|&a, &b| gradient[a].total_cmp(&gradient[b])) else {
            break;
        };
        free[next] = true;
        loop {
            let places: Vec<usize> = (0..count).filter(|&i| free[i]).collect();
            let Some(tried) = within(gram, right, &places) else {
                // The column adds nothing to the others.
                free[next] = false;
                found[next] = 0.0;
                return found;
            };
            if tried.iter().all(|&value| value > 0.0) {
                found.fill(0.0);
                for (&place, &value) in places.iter().zip(&tried) {
                    found[place] = value;
                }
                break;
            }
            // As far as no coefficient becomes negative, and those that reach zero stay there.
            let reach = |place: usize, value: f64| match (value <= 0.0, found[place] > 0.0) {
                (true, true) => found[place] / (found[place] - value),
                (true, false) => 0.0,
                (false, _) => 1.0,
            };
            let pairs = || places.iter().copied().zip(tried.iter().copied());
            let reached: Vec<f64> = pairs().map(|(place, value)| reach(place, value)).collect();
            let share = reached.iter().copied().fold(1.0, f64::min);
            for ((place, value), reached) in pairs().zip(reached) {
                found[place] += share * (value - found[place]);
                if value <= 0.0 && reached <= share {
                    found[place] = 0.0;
                    free[place] = false;
                }
            }
            if free.iter().all(|&is_free| !is_free) {
                break;
            }
        }
    }
    found
}

/// The solution in these columns alone; `None` if they depend on each other.
fn within(gram: &DMatrix<f64>, right: &DVector<f64>, places: &[usize]) -> Option<Vec<f64>> {
    let part = DMatrix::from_fn(places.len(), places.len(), |i, j| {
        gram[(places[i], places[j])] + if i == j { 1e-12 } else { 0.0 }
    });
    let side = DVector::from_iterator(places.len(), places.iter().map(|&place| right[place]));
    let solved = part.cholesky()?.solve(&side);
    Some(solved.iter().copied().collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_coefficient_that_would_be_negative_is_zero_and_the_others_fit() {
        // The unconstrained solution of these is (2, −1).
        let columns = DMatrix::from_row_slice(3, 2, &[1.0, 0.5, 0.0, 1.0, 1.0, 1.0]);
        let data = &columns * DVector::from_vec(vec![2.0, -1.0]);
        let (gram, right) = (columns.transpose() * &columns, columns.transpose() * data);
        let found = solve(&gram, &right);
        assert_eq!(found[1], 0.0);
        assert!((found[0] - right[0] / gram[(0, 0)]).abs() < 1e-9, "{found}");
        let data = &columns * DVector::from_vec(vec![2.0, 3.0]);
        let found = solve(&gram, &(columns.transpose() * data));
        assert!((found - DVector::from_vec(vec![2.0, 3.0])).amax() < 1e-6);
    }
}
