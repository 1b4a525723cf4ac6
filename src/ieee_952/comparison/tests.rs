use super::above;
use crate::{
    Curve, Model, Real, ieee_952,
    numerics::{
        real::{double, real},
        test_random::Random,
    },
    theory::covariance::curve_covariance,
};
use nalgebra::{SMatrix, SVector};

const OCTAVES: usize = 12;
/// One column for each of the five terms.
type Columns = SMatrix<f64, OCTAVES, 5>;
type Square = SMatrix<f64, OCTAVES, OCTAVES>;
/// The squared coefficients of a gyro with white, flicker and random-walk noise.
const SQUARES: [f64; 5] = [0.0, 1e-2, 4e-3, 2e-4, 0.0];

/// The curve of such a gyro, with octaves that are off by about their standard error.
fn curve(random: &mut Random) -> Curve<OCTAVES> {
    let squares = SQUARES.map(real);
    let octaves = (0..OCTAVES).map(|k| {
        let (m, clusters) = (1_u32 << k, 4096.0 * 4.0 / f64::from(1_u32 << k));
        let off = 1.5 * random.signed() / libm::sqrt(clusters);
        let variance = double(Model::ieee_952().variance(&squares, m, 0.01)) * (1.0 + off);
        let differences = 65_536 / u64::from((m / 4).max(1)) / 4 - 7;
        (m, differences, real(variance))
    });
    Curve::new(100.0, octaves).unwrap()
}

/// The statistic of the test.
fn tested(curve: &Curve<OCTAVES>, place: usize, limit: f64) -> Option<Real> {
    above(curve, &ieee_952::fit(curve).ok()?, place, real(limit))
}

/// The non-negative least squares of `y` in units of the covariance, by descent along one coordinate
/// after the other. Coefficients without a column in `free` keep their value. Returns χ².
fn descend(
    columns: &Columns,
    inverse: &Square,
    squares: &mut SVector<f64, 5>,
    free: impl Fn(usize) -> bool,
) -> f64 {
    let ones = SVector::<f64, OCTAVES>::from_element(1.0);
    let hessian = columns.transpose() * inverse * columns;
    let right = columns.transpose() * inverse * ones;
    for _ in 0..4000 {
        for i in (0..5).filter(|&i| free(i)) {
            let slope = right[i] - hessian.row(i).transpose().dot(squares);
            squares[i] = (squares[i] + slope / hessian[(i, i)]).max(0.0);
        }
    }
    let residual = ones - columns * *squares;
    (residual.transpose() * inverse * residual)[(0, 0)]
}

/// The same statistic by a slow, separate computation relative to the measured curve.
fn expected(curve: &Curve<OCTAVES>, place: usize, limit: f64) -> f64 {
    let (points, model) = (curve.points(), Model::ieee_952());
    let measured = |k: usize| double(points[k].variance);
    let columns = Columns::from_fn(|k, i| {
        let mut one = [0.0; 5];
        one[i] = 1.0;
        double(model.variance(&one, points[k].m, 0.01)) / measured(k)
    });
    let mut squares = SVector::from(SQUARES);
    squares[place] = limit * limit;
    let mut inverse = Square::zeros();
    for _ in 0..40 {
        let assumed: [Real; 5] = core::array::from_fn(|i| real(squares[i]));
        let covariance = curve_covariance(curve, &model, &assumed);
        let relative =
            Square::from_fn(|j, k| double(covariance[(j, k)]) / (measured(j) * measured(k)));
        inverse = relative.try_inverse().unwrap();
        let mut solution = squares;
        descend(&columns, &inverse, &mut solution, |i| i != place);
        squares = 0.5 * (squares + solution);
    }
    let at_limit = descend(&columns, &inverse, &mut squares, |i| i != place);
    let free = descend(&columns, &inverse, &mut squares, |_| true);
    let root = libm::sqrt((at_limit - free).max(0.0));
    root.copysign(squares[place] - limit * limit)
}

#[test]
fn the_statistic_is_that_of_a_slow_computation() {
    let mut random = Random::new(61);
    let mut signs = [0; 2];
    for _ in 0..4 {
        let curve = curve(&mut random);
        for (place, factors) in [(1, [0.9, 1.0, 1.15]), (2, [0.5, 1.0, 1.6])] {
            for factor in factors {
                let limit = factor * libm::sqrt(SQUARES[place]);
                let found = double(tested(&curve, place, limit).unwrap());
                let expected = expected(&curve, place, limit);
                // The rounds end when the model changes by less than 0.3 %, or at the second one beyond eight standard
                // errors.
                let share = if expected.abs() < 8.0 { 0.02 } else { 0.1 };
                assert!(
                    (found - expected).abs() < 0.03 + share * expected.abs(),
                    "{place}, {factor} times: {found}, not {expected}"
                );
                signs[usize::from(found > 0.0)] += 1;
            }
        }
    }
    assert!(signs[0] > 5 && signs[1] > 5, "{signs:?}");
}

#[test]
fn the_statistic_falls_with_the_limit_however_high_it_is() {
    let curve = curve(&mut Random::new(62));
    for (place, square) in SQUARES.into_iter().enumerate() {
        let root = libm::sqrt(square.max(1e-4));
        let limits = [0.3, 0.6, 1.5, 3.0, 10.0, 1e3, 1e6, 1e15].map(|factor| factor * root);
        let above = limits.map(|limit| tested(&curve, place, limit).map_or(f64::NAN, double));
        for pair in above.windows(2) {
            // A lower limit may stand for one at which nothing scatters.
            let most = (pair[0] + 0.05).max(-40.0);
            assert!(pair[1] <= most, "{place}: {above:?}");
        }
        // A thousand times the coefficient is out of the question, and so is more.
        assert!(above[5] < -4.0 && above[7] < -4.0, "{place}: {above:?}");
    }
}

#[test]
fn a_limit_that_the_curve_cannot_show_is_neither_exceeded_nor_kept() {
    let curve = curve(&mut Random::new(63));
    // The ramp adds a millionth to the longest octave.
    let above = tested(&curve, 4, 1e-6).unwrap();
    assert!(above.abs() < 0.1, "{above}");
}
