use super::{Significance, normal, skewness};
use crate::{
    Curve, Model,
    evidence::observed::Observed,
    fit::{
        Fit, Fitting, Options, Problem, Start, Tolerance, Work,
        coefficient::{Coefficient, State},
        estimate::Estimator,
    },
    numerics::{
        chi_squared::chi_squared_tail,
        math::erfc,
        real::{double, real},
    },
    spectrum::Spectrum,
    theory::{
        covariance::curve_covariance,
        effect::{Effect, IEEE_952},
    },
};
use core::f64::consts::SQRT_2;
use nalgebra::{SMatrix, SVector};

const OCTAVES: usize = 14;
/// The squared coefficients of a gyro with white noise and a random walk.
const SQUARES: [f64; 5] = [0.0, 1e-2, 0.0, 2e-3, 0.0];
/// The same with a random walk that the record hardly shows.
const WEAK: [f64; 5] = [0.0, 1e-2, 0.0, 1e-5, 0.0];

/// The curve of such a gyro from 2^16 samples, whose longest octave is off by this factor.
fn curve(squares: [f64; 5], longest: f64) -> Curve<OCTAVES> {
    let squares = squares.map(real);
    let octaves = (0..OCTAVES).map(|k| {
        let m = 1_u32 << k;
        let factor = if k == OCTAVES - 1 { longest } else { 1.0 };
        let variance = double(Model::ieee_952().variance(&squares, m, 0.01)) * factor;
        let stride = u64::from((m / 4).max(1));
        (m, 65_536 / stride - 7, real(variance))
    });
    Curve::new(100.0, octaves).unwrap()
}

/// The ramp of a curve's fit, and whether its interval excludes zero before it is tested.
fn ramp(curve: &Curve<OCTAVES>) -> (Coefficient, bool) {
    let model = Model::ieee_952();
    let mut work = Work::<OCTAVES>::NEW;
    let (start, tolerance) = (Start::Independent, Tolerance::IfNeeded(0.01));
    let (spectrum, mut fit) = (Spectrum::EMPTY, Fit::EMPTY);
    let observed = Observed::new(curve, &spectrum);
    work.begin_at(observed, &model, start, tolerance).unwrap();
    let problem = Problem::new(observed, &model, &work.columns);
    while !work.solver.advance(&problem).unwrap() {}
    let mut estimator = Estimator::NEW;
    estimator.begin(&problem, &work.solver, &mut fit);
    while !estimator.advance(&problem, &work.solver, &mut fit) {}
    let before = fit.coefficients[4].state;
    let mut significance = Significance::NEW;
    while !significance.advance(&problem, &mut work.solver, &mut fit) {}
    (fit.coefficients[4], before == State::Measured)
}

#[test]
fn a_coefficient_that_only_the_scatter_of_the_longest_octave_shows_is_not_measured() {
    let mut taken_back = 0;
    // A curve whose longest octave alone is still higher is one that no ramp explains, by its deviance.
    let states = [1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 10.0].map(|longest| {
        let (ramp, before) = ramp(&curve(WEAK, longest));
        // A tested coefficient keeps its value and the upper end of its interval.
        assert!(
            ramp.upper >= ramp.value && ramp.upper.is_finite(),
            "{ramp:?}"
        );
        let measured = ramp.state == State::Measured;
        assert_eq!(measured, ramp.lower > 0.0);
        assert!(before || !measured);
        taken_back += usize::from(before && !measured);
        measured
    });
    assert!(states.is_sorted() && !states[1] && states[6], "{states:?}");
    assert!(taken_back > 0);
}

#[test]
fn deviates_of_a_skewed_variable_have_the_probability_of_chi_squared() {
    for degrees in [1, 2, 4, 9, 40] {
        let nu = degrees as f64;
        for z in [1.0, 2.0, 3.0, 4.0] {
            let chi_squared = nu + z * libm::sqrt(2.0 * nu);
            let expected = double(chi_squared_tail(real(chi_squared), degrees));
            let deviate = double(normal(real(z), real(libm::sqrt(8.0 / nu))));
            let found = 0.5 * double(erfc(real(deviate / SQRT_2)));
            // With one degree of freedom, the cube root is a rougher approximation.
            let most = if degrees == 1 { 0.25 } else { 0.12 };
            assert!(
                (found / expected - 1.0).abs() < most,
                "{degrees}, {z}: {found}, not {expected}"
            );
        }
    }
    for skewness in [-2.0, -0.1, 0.0, 0.01] {
        assert_eq!(normal(2.5, real(skewness)), 2.5);
    }
    // The approximation continues where the skewness vanishes.
    assert!((normal(2.5, 0.021) - 2.5).abs() < 0.02);
}

#[test]
fn the_skewness_is_that_of_a_sum_of_independent_octaves() {
    let curve = curve(SQUARES, 1.0);
    for place in [1, 3] {
        let effect: &'static dyn Effect = IEEE_952[place];
        let model = Model::new(&[IEEE_952[1], IEEE_952[3]]).unwrap();
        let own = usize::from(place == 3);
        let mut fitting = Fitting::new(&curve, model.clone(), Options::default());
        while fitting.advance().unwrap().is_none() {}
        // The solver keeps the weights of the last solution.
        let (problem, solver, _) = fitting.parts();
        let found = double(skewness(&problem, solver, own));

        let squares = [real(SQUARES[1]), real(SQUARES[3])];
        let covariance = curve_covariance(&curve, &model, &squares);
        let covariance =
            SMatrix::<f64, OCTAVES, OCTAVES>::from_fn(|a, b| double(covariance[(a, b)]));
        let mean = |k: usize| double(model.variance(&squares, curve.points()[k].m, 0.01));
        let columns = SMatrix::<f64, OCTAVES, 2>::from_fn(|k, i| {
            let mut one = [0.0; 2];
            one[i] = 1.0;
            double(model.variance(&one, curve.points()[k].m, 0.01))
        });
        let inverse = covariance.try_inverse().unwrap();
        let normal = (columns.transpose() * inverse * columns)
            .try_inverse()
            .unwrap();
        let factors: SVector<f64, OCTAVES> = (normal * columns.transpose() * inverse)
            .row(own)
            .transpose();
        let third: f64 = (0..OCTAVES)
            .map(|k| {
                let degrees = 2.0 * mean(k) * mean(k) / covariance[(k, k)];
                libm::sqrt(8.0 / degrees) * (factors[k] * libm::sqrt(covariance[(k, k)])).powi(3)
            })
            .sum();
        let expected = third / normal[(own, own)].powf(1.5);
        let off = (found - expected).abs();
        assert!(
            off < 2e-3 * (1.0 + expected.abs()),
            "{}: {found}, not {expected}",
            effect.name()
        );
        assert!(found > 0.0, "{found}");
    }
}
