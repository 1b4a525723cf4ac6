//! The factor of octaves and bins against that of one dense matrix.

// The indices are those of rows and columns.
#![allow(clippy::needless_range_loop)]

use super::*;
use crate::numerics::test_random::Random;

const OCTAVES: usize = 4;
const BINS: usize = 7;
const ROWS: usize = OCTAVES + BINS;

/// A matrix in which octaves and bins are independent, and bins are correlated with their neighbours.
fn covariance(random: &mut Random) -> [[Real; ROWS]; ROWS] {
    let mut matrix = [[0.0; ROWS]; ROWS];
    for i in 0..ROWS {
        for j in 0..=i {
            let is_known = match (i < OCTAVES, j < OCTAVES) {
                (true, true) => true,
                // Bin 4 begins another block length.
                (false, false) => i - j < BAND && (i < OCTAVES + 4) == (j < OCTAVES + 4),
                _ => false,
            };
            if is_known {
                let value = if i == j { 3.0 } else { 0.0 } + real(random.below(1000)) / 1000.0;
                matrix[i][j] = value;
                matrix[j][i] = value;
            }
        }
    }
    matrix
}

fn factored(matrix: &[[Real; ROWS]; ROWS]) -> Factor<OCTAVES, BINS> {
    let mut factor = Factor::ZEROS;
    for i in 0..OCTAVES {
        for j in 0..=i {
            factor.put_octaves((i, j), single(matrix[i][j]));
        }
    }
    for b in 0..BINS {
        for d in 0..=(BAND - 1).min(b) {
            factor.put_bins(b, d, single(matrix[OCTAVES + b][OCTAVES + b - d]));
        }
    }
    assert!(factor.factor(OCTAVES, BINS));
    factor
}

#[test]
fn the_factor_solves_the_equations_of_the_whole_matrix() {
    let mut random = Random::new(5);
    for _ in 0..20 {
        let matrix = covariance(&mut random);
        let factor = factored(&matrix);
        let solution: [Real; ROWS] =
            core::array::from_fn(|_| real(random.below(1000)) / 500.0 - 1.0);
        let mut x = Rows::<OCTAVES, BINS>::ZEROS;
        for i in 0..ROWS {
            x.put(i, (0..ROWS).map(|j| matrix[i][j] * solution[j]).sum());
        }
        let right = x;
        factor.forward(OCTAVES, BINS, &mut x);
        // The whitened right-hand side has the norm b'A⁻¹b.
        let norm: Real = (0..ROWS).map(|i| right[i] * solution[i]).sum();
        assert!((x.norm_squared() / norm - 1.0).abs() < 1e-5);
        // L'y for y = L'⁻¹x is x again.
        let mut y = x;
        factor.backward(OCTAVES, BINS, &mut y);
        let again = factor.transposed_times(OCTAVES, BINS, &y);
        for i in 0..ROWS {
            assert!((again[i] - x[i]).abs() < 1e-5, "row {i}");
        }
        factor.backward(OCTAVES, BINS, &mut x);
        for i in 0..ROWS {
            assert!((x[i] - solution[i]).abs() < 1e-5, "row {i}");
        }
        for i in 0..ROWS {
            let error = factor.standard_error(i);
            assert!((error * error / matrix[i][i] - 1.0).abs() < 1e-5, "row {i}");
        }
    }
}

#[test]
fn a_matrix_that_is_not_positive_definite_has_no_factor() {
    let mut factor = Factor::<OCTAVES, BINS>::ZEROS;
    for b in 0..BINS {
        factor.put_bins(b, 0, 1.0);
    }
    assert!(factor.factor(0, BINS));
    let mut factor = Factor::<OCTAVES, BINS>::ZEROS;
    for b in 0..BINS {
        factor.put_bins(b, 0, 1.0);
    }
    factor.put_bins(3, 1, 2.0);
    assert!(!factor.factor(0, BINS));
}
