//! From a curve to coefficients.

use crate::{
    chi_squared::chi_squared_tail,
    coefficient::{Coefficient, State},
    covariance::covariance,
    curve::{Curve, Point},
    effect::Setting,
    error::Error,
    math,
    model::{MAX_EFFECTS, Model},
    nnls::{Free, Matrix, NormalEquations, Vector},
    observability::record_length_s,
};
use heapless::Vec;
use nalgebra::{Cholesky, Const, SMatrix, SVector};

/// How octaves are weighted, and whether squared coefficients may be negative.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Method {
    /// Unweighted least squares on σ², unconstrained: the baseline (Lv, Liu, Lai & Huang 2015,
    /// eq. 7). Long averaging times, the least certain, decide.
    Ordinary,
    /// The weighted least squares of Lv, Liu, Lai & Huang 2015, unconstrained: every octave's
    /// standard error is its relative accuracy `δ = 1/√(2(N/m − 1))` times its value.
    RelativeAccuracy,
    /// Weights δ⁻² without the value: for comparison only, it does worse than `Ordinary`.
    ClusterCount,
    /// Generalised least squares with the full covariance of the curve at the fitted model, and
    /// squared coefficients that cannot be negative.
    #[default]
    Covariance,
}

/// How to fit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Settings {
    /// The weights.
    pub method: Method,
    /// How far an octave of the model may be off, relative to its variance, before it counts:
    /// added in quadrature to the diagonal of the covariance. A million samples show 0.1 %, and no
    /// kernel is that true. For `Method::Covariance`.
    pub tolerance: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            method: Method::Covariance,
            tolerance: 0.01,
        }
    }
}

/// Coefficients of a model, with what they are worth.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Fit {
    /// How the octaves were weighted.
    pub method: Method,
    /// One coefficient an effect, in the model's order.
    pub coefficients: Vec<Coefficient, MAX_EFFECTS>,
    /// Squared residuals in units of their covariance. NaN for the methods without error model,
    /// `Ordinary` and `ClusterCount`; too large for `RelativeAccuracy`, which takes octaves for
    /// independent.
    pub chi_squared: f64,
    /// Octaves less coefficients above zero.
    pub degrees_of_freedom: usize,
    /// Probability of a larger χ² if the model is true. NaN without χ² or degrees of freedom.
    pub p_value: f64,
    /// `−2 ln L = r'C⁻¹r + ln det C`, up to a constant: ranks models of one curve. NaN where χ² is.
    pub minus_two_log_likelihood: f64,
    /// How far correlations had to be shrunk for the covariance to be positive definite; 0 is
    /// usual.
    pub shrinkage: f64,
}

impl Fit {
    /// The squared coefficients, for [`Model::variance`].
    pub fn squares(&self) -> [f64; MAX_EFFECTS] {
        let mut squares = [0.0; MAX_EFFECTS];
        for (square, coefficient) in squares.iter_mut().zip(&self.coefficients) {
            *square = coefficient.square;
        }
        squares
    }
}

/// Fits a model's coefficients to a curve.
///
/// # Errors
/// [`Error::NoNoise`], [`Error::TooFewOctaves`] (two, or for the unconstrained methods as many as
/// there are effects), [`Error::Singular`].
///
/// # Example
///
/// ```
/// use allanite::{fit, Curve, Model, Settings};
///
/// // White noise of 1 count² at 100 Hz: σ²(τ) = N²/τ with N = 0.1.
/// let white = (0..10).map(|k| (1 << k, (40_000 >> k) - 7, 1.0 / f64::from(1 << k)));
/// let curve = Curve::<10>::new(100.0, white)?;
/// let fit = fit(&curve, &Model::ieee_952(), Settings::default())?;
/// assert!((fit.coefficients[1].value - 0.1).abs() < 1e-6);
/// # Ok::<(), allanite::Error>(())
/// ```
pub fn fit<const K: usize>(
    curve: &Curve<K>,
    model: &Model,
    settings: Settings,
) -> Result<Fit, Error> {
    let points = curve.points();
    let needed = match settings.method {
        Method::Covariance => 2,
        _ => model.effects().len(),
    };
    if points.len() < needed {
        return Err(Error::TooFewOctaves {
            found: points.len(),
            needed,
        });
    }
    if let Some(point) = points.iter().find(|point| point.variance == 0.0) {
        return Err(Error::NoNoise { m: point.m });
    }
    let setting = Setting {
        interval_s: curve.interval_s(),
    };
    let problem = Problem {
        points,
        model,
        setting,
        columns: columns::<K>(points, model, &setting),
    };
    match settings.method {
        Method::Covariance => problem.by_covariance(settings.tolerance),
        method => problem.by_weights(method),
    }
}

/// Allan variances of unit coefficients: a row an octave, a column an effect.
type Columns<const K: usize> = SMatrix<f64, K, MAX_EFFECTS>;

fn columns<const K: usize>(points: &[Point], model: &Model, setting: &Setting) -> Columns<K> {
    let mut columns = Columns::zeros();
    for (i, effect) in model.effects().iter().enumerate() {
        for (k, point) in points.iter().enumerate() {
            columns[(k, i)] = effect.variance(f64::from(point.m), setting);
        }
    }
    columns
}

struct Problem<'a, const K: usize> {
    points: &'a [Point],
    model: &'a Model,
    setting: Setting,
    columns: Columns<K>,
}

impl<const K: usize> Problem<'_, K> {
    fn count(&self) -> usize {
        self.model.effects().len()
    }

    /// Length of the record, from the number of differences of its longest octave.
    fn samples(&self) -> f64 {
        self.points
            .last()
            .map_or(0.0, |point| clusters(point) * f64::from(point.m))
    }

    /// Relative standard error of an octave as of Lv, Liu, Lai & Huang 2015: `1/√(2(N/m − 1))`.
    fn relative_accuracy(point: &Point) -> f64 {
        1.0 / math::sqrt(2.0 * (clusters(point) - 1.0))
    }

    /// The normal equations of independent octaves.
    fn weighted(&self, weight: impl Fn(&Point) -> f64) -> Result<NormalEquations, Error> {
        let (mut matrix, mut right) = (Matrix::zeros(), Vector::zeros());
        for (k, point) in self.points.iter().enumerate() {
            let row = self.columns.row(k).transpose();
            let w = weight(point);
            matrix += row * row.transpose() * w;
            right += row * (w * point.variance);
        }
        NormalEquations::new(&matrix, &right, self.count())
    }

    /// The unconstrained fits of independent octaves.
    fn by_weights(&self, method: Method) -> Result<Fit, Error> {
        let weight = |point: &Point| match method {
            Method::Ordinary => 1.0,
            Method::ClusterCount => 1.0 / squared(Self::relative_accuracy(point)),
            _ => 1.0 / squared(Self::relative_accuracy(point) * point.variance),
        };
        let equations = self.weighted(weight)?;
        let squares = equations.solve()?;
        let free = core::array::from_fn(|i| i < self.count());
        let mut covariance = equations.covariance(&free).ok_or(Error::Singular)?;
        let residual = self.points.iter().enumerate().map(|(k, point)| {
            let model = self.columns.row(k).transpose().dot(&squares);
            weight(point) * squared(point.variance - model)
        });
        let mut chi_squared: f64 = residual.sum();
        let degrees_of_freedom = self.points.len() - self.count();
        if method != Method::RelativeAccuracy {
            // No error model: the residuals themselves give the scale.
            covariance *= chi_squared / degrees_of_freedom.max(1) as f64;
            chi_squared = f64::NAN;
        }
        Ok(Fit {
            method,
            coefficients: self.coefficients(&squares, &free, &covariance, |_| None),
            chi_squared,
            degrees_of_freedom,
            p_value: chi_squared_tail(chi_squared, degrees_of_freedom),
            minus_two_log_likelihood: f64::NAN,
            shrinkage: 0.0,
        })
    }

    /// Generalised least squares, with the covariance of the model that the round before found.
    fn by_covariance(&self, tolerance: f64) -> Result<Fit, Error> {
        /// The model converges to 0.1 % in two or three rounds.
        const ROUNDS: usize = 4;
        let start =
            self.weighted(|point| 1.0 / squared(Self::relative_accuracy(point) * point.variance))?;
        let (mut squares, _) = start.solve_non_negative();
        let mut round = 1;
        loop {
            let whitened = self.whiten(&squares, tolerance)?;
            let equations = whitened.equations(self.count())?;
            let (next, free) = equations.solve_non_negative();
            let change = self.largest_change(&squares, &next);
            squares = next;
            if change < 1e-3 || round == ROUNDS {
                return self.finish(&whitened, &equations, &squares, &free);
            }
            round += 1;
        }
    }

    /// Largest relative change of the model between two sets of squared coefficients.
    fn largest_change(&self, before: &Vector, after: &Vector) -> f64 {
        (0..self.points.len())
            .map(|k| {
                let row = self.columns.row(k).transpose();
                let (old, new) = (row.dot(before), row.dot(after));
                if old > new {
                    (old - new) / old
                } else {
                    (new - old) / new
                }
            })
            .fold(0.0, f64::max)
    }

    /// Curve and columns in units in which octaves are independent and have a variance of one.
    fn whiten(&self, squares: &Vector, tolerance: f64) -> Result<Whitened<K>, Error> {
        let model = SVector::<f64, K>::from_fn(|k, _| match self.points.get(k) {
            Some(_) => self.columns.row(k).transpose().dot(squares),
            None => 1.0,
        });
        if model
            .iter()
            .any(|&variance| !(variance.is_finite() && variance > 0.0))
        {
            return Err(Error::Singular);
        }
        let mut matrix =
            covariance::<K>(self.points, self.model, squares.as_slice(), &self.setting);
        for k in 0..K {
            for j in 0..K {
                matrix[(j, k)] /= model[j] * model[k];
            }
            matrix[(k, k)] += match self.points.get(k) {
                Some(_) => tolerance * tolerance,
                // Octaves that the curve does not have.
                None => 1.0,
            };
        }
        let (factor, shrinkage) = factor_positive(matrix)?;
        let lower = factor.l_dirty();
        let mut log_determinant = 0.0;
        let mut columns = self.columns;
        let mut curve = SVector::<f64, K>::zeros();
        for (k, point) in self.points.iter().enumerate() {
            log_determinant += 2.0 * math::log(lower[(k, k)] * model[k]);
            curve[k] = point.variance / model[k];
            for i in 0..self.count() {
                columns[(k, i)] /= model[k];
            }
        }
        let solved = lower.solve_lower_triangular_mut(&mut columns)
            && lower.solve_lower_triangular_mut(&mut curve);
        if !solved {
            return Err(Error::Singular);
        }
        Ok(Whitened {
            columns,
            curve,
            log_determinant,
            shrinkage,
        })
    }

    fn finish(
        &self,
        whitened: &Whitened<K>,
        equations: &NormalEquations,
        squares: &Vector,
        free: &Free,
    ) -> Result<Fit, Error> {
        let residual = whitened.curve - whitened.columns * squares;
        let chi_squared = residual.norm_squared();
        let active = free.iter().filter(|&&free| free).count();
        let degrees_of_freedom = self.points.len().saturating_sub(active);
        let covariance = equations.covariance(free).ok_or(Error::Singular)?;
        // An effect that was held at zero: its standard error if it were free as well.
        let error_if_free = |i: usize| {
            let mut with = *free;
            with[i] = true;
            equations
                .covariance(&with)
                .map(|covariance| covariance[(i, i)])
        };
        Ok(Fit {
            method: Method::Covariance,
            coefficients: self.coefficients(squares, free, &covariance, error_if_free),
            chi_squared,
            degrees_of_freedom,
            p_value: chi_squared_tail(chi_squared, degrees_of_freedom),
            minus_two_log_likelihood: chi_squared + whitened.log_determinant,
            shrinkage: whitened.shrinkage,
        })
    }

    fn coefficients(
        &self,
        squares: &Vector,
        free: &Free,
        covariance: &Matrix,
        error_if_free: impl Fn(usize) -> Option<f64>,
    ) -> Vec<Coefficient, MAX_EFFECTS> {
        let effects = self.model.effects().iter().enumerate();
        effects
            .map(|(i, effect)| {
                let variance = if free[i] {
                    Some(covariance[(i, i)])
                } else {
                    error_if_free(i)
                };
                let mut coefficient = Coefficient::new(*effect, squares[i], variance);
                if coefficient.state == State::UpperBound && !self.bounds(i, &coefficient, squares)
                {
                    let bound = squared(coefficient.upper);
                    let after_s = record_length_s(
                        i,
                        bound,
                        squares,
                        free,
                        self.model,
                        &self.setting,
                        self.samples(),
                    );
                    coefficient.state = State::NotObservable { after_s };
                }
                coefficient
            })
            .collect()
    }

    /// Whether an upper bound says more than that the effect cannot exceed the whole curve.
    fn bounds(&self, i: usize, coefficient: &Coefficient, squares: &Vector) -> bool {
        let bound = squared(coefficient.upper);
        (0..self.points.len()).all(|k| {
            let model = self.columns.row(k).transpose().dot(squares);
            bound * self.columns[(k, i)] < model
        })
    }
}

/// Least squares in units in which octaves are independent.
struct Whitened<const K: usize> {
    columns: Columns<K>,
    curve: SVector<f64, K>,
    log_determinant: f64,
    shrinkage: f64,
}

impl<const K: usize> Whitened<K> {
    fn equations(&self, count: usize) -> Result<NormalEquations, Error> {
        let matrix = self.columns.tr_mul(&self.columns);
        let right = self.columns.tr_mul(&self.curve);
        NormalEquations::new(&matrix, &right, count)
    }
}

/// Cholesky factor of a covariance, its correlations shrunk by as little as makes it positive
/// definite, and by how much that was.
fn factor_positive<const K: usize>(
    matrix: SMatrix<f64, K, K>,
) -> Result<(Cholesky<f64, Const<K>>, f64), Error> {
    for shrinkage in [0.0, 0.01, 0.03, 0.1, 0.3] {
        let keep = 1.0 - shrinkage;
        let shrunk = SMatrix::from_fn(|j, k| matrix[(j, k)] * if j == k { 1.0 } else { keep });
        if let Some(factor) = Cholesky::new(shrunk) {
            return Ok((factor, shrinkage));
        }
    }
    Err(Error::Singular)
}

/// Clusters `N/m` in the record, from an octave's number of differences as of a contiguous one.
fn clusters(point: &Point) -> f64 {
    let m = f64::from(point.m);
    (point.differences - 1) as f64 * (0.25 * m).max(1.0) / m + 2.0
}

fn squared(x: f64) -> f64 {
    x * x
}
