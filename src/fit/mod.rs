//! From a curve to coefficients.

mod correlation;
pub(crate) mod generalized;
mod independent;
pub(crate) mod shape;
pub(crate) mod weights;

#[cfg(feature = "storage")]
pub(crate) use correlation::PAIRS;

pub use correlation::Correlations;
pub use shape::{MAX_SHAPE, ShapeEstimate};

use crate::{
    algebra,
    coefficient::Coefficient,
    curve::{Curve, Point, clusters},
    error::Error,
    math,
    model::{MAX_EFFECTS, Model, Term},
    nnls::{Free, Vector},
    real::{Real, real, single},
};
use generalized::Solution;
use heapless::Vec;

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
    /// How far an octave of the model may be off, relative to its variance: a million samples show
    /// 0.1 %, and no kernel is that true. Granted, in quadrature to the diagonal of the covariance,
    /// only to a curve that its scatter alone does not explain (p < 5 %): where it does, every
    /// octave keeps its full weight. For `Method::Covariance`.
    pub tolerance: Real,
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
    /// The shape parameters that were fitted.
    pub shape: Vec<ShapeEstimate, MAX_SHAPE>,
    /// Squared residuals in units of their covariance. NaN for the methods without error model,
    /// `Ordinary` and `ClusterCount`; too large for `RelativeAccuracy`, which takes octaves for
    /// independent.
    pub chi_squared: Real,
    /// Octaves less coefficients above zero.
    pub degrees_of_freedom: usize,
    /// Probability of a larger χ² if the model is true. NaN without χ² or degrees of freedom.
    pub p_value: Real,
    /// `−2 ln L = r'C⁻¹r + ln det C`, up to a constant: ranks models of one curve. NaN where χ² is.
    pub minus_two_log_likelihood: Real,
    /// The tolerance that was granted, `Settings::tolerance` or 0.
    pub tolerance: Real,
    /// How far correlations had to be shrunk for the covariance to be positive definite; 0 is
    /// usual.
    pub shrinkage: Real,
}

impl Fit {
    /// Of nothing yet, by `Covariance`.
    pub(crate) const fn empty() -> Self {
        Self {
            method: Method::Covariance,
            coefficients: Vec::new(),
            shape: Vec::new(),
            chi_squared: Real::NAN,
            degrees_of_freedom: 0,
            p_value: Real::NAN,
            minus_two_log_likelihood: Real::NAN,
            tolerance: 0.0,
            shrinkage: 0.0,
        }
    }

    /// The squared coefficients, for [`Model::variance`].
    pub fn squares(&self) -> [Real; MAX_EFFECTS] {
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
        _ => model.terms().len(),
    };
    check(points, needed)?;
    let problem = Problem::new(curve, model);
    match settings.method {
        Method::Covariance => {
            let mut solution = Solution::new(&problem);
            solution.solve(settings.tolerance)?;
            let mut fit = Fit::empty();
            solution.report(&mut fit);
            Ok(fit)
        }
        method => independent::fit(&problem, method),
    }
}

/// Whether octaves can be fitted.
pub(crate) fn check(points: &[Point], needed: usize) -> Result<(), Error> {
    if points.len() < needed {
        return Err(Error::TooFewOctaves {
            found: points.len(),
            needed,
        });
    }
    if let Some(point) = points.iter().find(|point| point.variance == 0.0) {
        return Err(Error::NoNoise { m: point.m });
    }
    Ok(())
}

/// A curve, and what a model can make of it.
pub(crate) struct Problem<'a, const K: usize> {
    pub(crate) points: &'a [Point],
    pub(crate) model: &'a Model,
    pub(crate) interval_s: Real,
    /// What variances and squared coefficients are counted in here.
    pub(crate) variance_unit: Real,
    per_unit: Real,
    /// Allan variances of unit coefficients, of each effect: single precision is far below what any
    /// record tells of them.
    columns: Vec<algebra::Vector<K, f32>, MAX_EFFECTS>,
}

impl<'a, const K: usize> Problem<'a, K> {
    pub(crate) fn new(curve: &'a Curve<K>, model: &'a Model) -> Self {
        let mut problem = Self {
            points: curve.points(),
            model,
            interval_s: curve.interval_s(),
            variance_unit: curve.variance_unit(),
            per_unit: 1.0 / curve.variance_unit(),
            columns: Vec::new(),
        };
        for term in model.terms() {
            // As many columns as effects.
            let _ = problem
                .columns
                .push(problem.column(term).map(single).into());
        }
        problem
    }

    /// The Allan variances of one effect, for a coefficient of one.
    pub(crate) fn column(&self, term: &Term) -> algebra::Vector<K> {
        let mut column = algebra::Vector::<K>::zeros();
        let mut k = 0_usize;
        let mut factors = self.points.iter().map(|point| real(point.m));
        let setting = term.setting(self.interval_s);
        term.effect
            .variances(&mut factors, &setting, &mut |variance| {
                column.put(k, variance);
                k = k.saturating_add(1);
            });
        column
    }

    /// The curve's variance in octave `k`.
    pub(crate) fn measured(&self, k: usize) -> Real {
        let point = self.points.get(k);
        point.map_or(0.0, |point| point.variance * self.per_unit)
    }

    /// The squared coefficients of a fit.
    pub(crate) fn squares_of(&self, fit: &Fit) -> Vector {
        Vector::from_fn(|i| {
            let coefficient = fit.coefficients.get(i);
            coefficient.map_or(0.0, |coefficient| coefficient.square * self.per_unit)
        })
    }

    /// Variance of an effect in octave `k`, for a coefficient of one.
    pub(crate) fn unit(&self, i: usize, k: usize) -> Real {
        self.columns.get(i).map_or(0.0, |column| real(column[k]))
    }

    /// An effect's share of the model's variance in octave `k`; 0 beyond the model.
    pub(crate) fn share(&self, k: usize, i: usize, squares: &Vector) -> Real {
        if i < self.count() {
            self.unit(i, k) * squares[i] / self.variance(k, squares)
        } else {
            0.0
        }
    }

    /// Which coefficients are held at zero.
    pub(crate) fn held(&self) -> Free {
        Free::of(|i| self.model.terms().get(i).is_some_and(|term| term.held))
    }

    /// Number of coefficients.
    pub(crate) fn count(&self) -> usize {
        self.model.terms().len()
    }

    /// The model's variance in octave `k`.
    pub(crate) fn variance(&self, k: usize, squares: &Vector) -> Real {
        (0..self.count())
            .map(|i| self.unit(i, k) * squares[i])
            .sum()
    }
}

/// Relative accuracy of an octave as of Lv, Liu, Lai & Huang 2015: `δ = 1/√(2(N/m − 1))`.
fn relative_accuracy(point: &Point) -> Real {
    1.0 / math::sqrt(2.0 * (clusters(point) - 1.0))
}

fn squared(x: Real) -> Real {
    x * x
}
