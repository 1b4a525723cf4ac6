//! Factors and solutions are compared with the product `L L'` and with nalgebra's own decomposition.

use super::*;
use crate::numerics::{
    real::{double, single},
    test_random::Random,
};
use nalgebra::{SMatrix, SVector};

/// The number of rows of the largest matrix in these tests.
const MOST: usize = 12;
/// A triangle of [`MOST`] rows.
type Full<E = Real> = Triangle<{ MOST + 1 }, { MOST / 2 }, E>;
type Matrix = SMatrix<f64, MOST, MOST>;
type Column = SVector<f64, MOST>;

/// The tolerance for the rounding errors of a factor, relative to the diagonal.
const ROUNDING: f64 = if cfg!(feature = "double") {
    1e-14
} else {
    3e-6
};
/// The same tolerance for a factor that is kept in single precision.
const KEPT_SINGLE: f64 = 3e-6;

/// A positive definite matrix with ones on the diagonal, and numbers that resemble correlations off the
/// diagonal. It is the identity beyond `n` rows.
fn positive_definite(n: usize, random: &mut Random) -> Matrix {
    let columns = Matrix::from_fn(|_, _| random.signed() + 0.5);
    let product = columns * columns.transpose() + Matrix::identity();
    Matrix::from_fn(|i, j| {
        if i < n && j < n {
            product[(i, j)] / libm::sqrt(product[(i, i)] * product[(j, j)])
        } else {
            f64::from(u8::from(i == j))
        }
    })
}

/// The first `n` rows of a matrix, in the precision to which `to` rounds.
fn triangle<E: Number>(matrix: &Matrix, n: usize, to: impl Fn(f64) -> E) -> Full<E> {
    let mut triangle = Full::zeros();
    for i in 0..n {
        for j in 0..=i {
            triangle.put((i, j), to(matrix[(i, j)]));
        }
    }
    triangle
}

/// The factor `L`, made from its stored form, which has the reciprocals of the diagonal. It is the
/// identity beyond `n` rows.
fn lower<E: Number + AsPrimitive<f64>>(factor: &Full<E>, n: usize) -> Matrix {
    Matrix::from_fn(|i, j| match i.cmp(&j) {
        core::cmp::Ordering::Greater if i < n => factor[(i, j)].as_(),
        core::cmp::Ordering::Equal if i < n => 1.0 / factor[(i, j)].as_(),
        core::cmp::Ordering::Equal => 1.0,
        _ => 0.0,
    })
}

/// Calls `check` with matrices of every number of rows.
fn matrices(mut check: impl FnMut(usize, &Matrix, &mut Random)) {
    let mut random = Random::new(11);
    for n in 1..=MOST {
        for _ in 0..30 {
            let matrix = positive_definite(n, &mut random);
            check(n, &matrix, &mut random);
        }
    }
}

#[test]
fn the_factor_times_its_transpose_is_the_matrix() {
    matrices(|n, matrix, _| {
        let mut found = triangle(matrix, n, |x| x as Real);
        assert!(factor(&mut found, n));
        let lower = lower(&found, n);
        let off = lower * lower.transpose() - matrix;
        assert!(off.amax() < ROUNDING, "{n} rows are {:e} off", off.amax());

        let mut kept = triangle(matrix, n, |x| x as f32);
        assert!(factor(&mut kept, n));
        let lower = self::lower(&kept, n);
        let off = lower * lower.transpose() - matrix;
        assert!(off.amax() < KEPT_SINGLE, "{n} rows in single precision");
    });
}

#[test]
fn the_factor_equals_that_of_nalgebra() {
    matrices(|n, matrix, _| {
        let mut found = triangle(matrix, n, |x| x as Real);
        assert!(factor(&mut found, n));
        let expected = matrix.cholesky().expect("positive definite").l();
        let off = lower(&found, n) - expected;
        assert!(off.amax() < 20.0 * ROUNDING, "{:e} off", off.amax());
    });
}

#[test]
fn rows_beyond_the_given_number_do_not_change() {
    matrices(|n, matrix, random| {
        let mut found = triangle(matrix, n, |x| x as Real);
        for j in 0..MOST {
            if n < MOST {
                found.put((n, j.min(n)), 1234.5);
            }
        }
        let before = found;
        assert!(factor(&mut found, n));
        let place = row_start(n)..;
        assert_eq!(found.rows()[place.clone()], before.rows()[place]);

        let mut x = Vector::<MOST>::from_fn(|_| random.real());
        let before = x;
        forward(&found, n, &mut x);
        backward(&found, n, &mut x);
        assert!((n..MOST).all(|i| x[i] == before[i]));
    });
}

#[test]
fn solutions_in_every_precision_fulfil_their_equations() {
    matrices(|n, matrix, random| {
        let right = Column::from_fn(|_, _| random.signed());
        let mut found = triangle(matrix, n, |x| x as Real);
        let mut kept = triangle(matrix, n, |x| x as f32);
        assert!(factor(&mut found, n) && factor(&mut kept, n));

        let mut x = Vector::<MOST>::from_fn(|i| right[i] as Real);
        forward(&found, n, &mut x);
        let solved = Column::from_fn(|i, _| double(x[i]));
        let off = lower(&found, n) * solved - right;
        assert!(off.amax() < ROUNDING * 4.0, "{:e}", off.amax());
        backward(&found, n, &mut x);
        let solved = Column::from_fn(|i, _| double(x[i]));
        let off = matrix * solved - right;
        assert!(off.amax() < ROUNDING * 40.0, "{:e}", off.amax());

        // The factor is in single precision, and the unknowns are in either precision.
        let mut x = Vector::<MOST>::from_fn(|i| right[i] as Real);
        forward(&kept, n, &mut x);
        let solved = Column::from_fn(|i, _| double(x[i]));
        let off = lower(&kept, n) * solved - right;
        assert!(off.amax() < ROUNDING * 4.0, "{:e}", off.amax());
        let mut x = Vector::<MOST, f32>::from_fn(|i| right[i] as f32);
        forward(&kept, n, &mut x);
        let solved = Column::from_fn(|i, _| f64::from(x[i]));
        let off = lower(&kept, n) * solved - right;
        assert!(off.amax() < KEPT_SINGLE * 4.0, "{:e}", off.amax());
    });
}

#[test]
fn packed_and_square_storage_give_the_same_factor() {
    matrices(|n, matrix, _| {
        let mut packed = triangle(matrix, n, single_of);
        let mut square = Triangle::<MOST, MOST, f32>::zeros();
        for i in 0..n {
            for j in 0..=i {
                square.put((i, j), packed[(i, j)]);
            }
        }
        assert!(factor(&mut packed, n) && factor(&mut square, n));
        let end = row_start(n);
        assert_eq!(packed.rows()[..end], square.rows()[..end]);
    });
}

fn single_of(x: f64) -> f32 {
    single(x as Real)
}

#[test]
fn matrices_that_are_not_positive_definite_are_refused() {
    matrices(|n, matrix, random| {
        let place = random.below(n);
        for bad in [0.0, -0.1, f64::NAN, f64::INFINITY] {
            let mut matrix = *matrix;
            matrix[(place, place)] = bad;
            assert!(!factor(&mut triangle(&matrix, n, |x| x as Real), n));
            assert!(!factor(&mut triangle(&matrix, n, |x| x as f32), n));
        }
        if n > 1 {
            // This gives two unknowns a correlation above one.
            let mut matrix = *matrix;
            let other = (place + 1) % n;
            matrix[(place, other)] = 1.01;
            matrix[(other, place)] = 1.01;
            assert!(!factor(&mut triangle(&matrix, n, |x| x as Real), n));
        }
    });
}

#[test]
fn too_large_a_number_of_rows_is_refused_or_limited_to_the_capacity() {
    let mut triangle = Full::<Real>::zeros();
    for i in 0..MOST {
        triangle.put((i, i), 4.0);
    }
    assert!(!factor(&mut triangle, MOST + 1));
    let mut x = Vector::<2>::from_fn(|_| 8.0);
    forward(&triangle, MOST + 1, &mut x);
    assert_eq!((x[0], x[1]), (4.0, 4.0));
    backward(&triangle, MOST + 1, &mut x);
    assert_eq!((x[0], x[1]), (2.0, 2.0));
}
