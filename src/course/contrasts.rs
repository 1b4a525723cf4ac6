//! The contrasts of the means of blocks, whitened with the covariance of a model.

use super::{
    BLOCKS,
    form::{COLUMNS, Form},
};
use crate::{
    evidence::course::{Level, is_complete},
    list::{self, numbered},
    numerics::{
        algebra::{Triangle, Vector},
        cholesky, math,
        real::{Real, by_precision, real},
    },
    theory::{
        effect::{Effect, RateRamp},
        model::{Model, Term},
    },
};
use heapless::Vec;

/// The blocks that the tests of the mean need.
const MIN_BLOCKS: usize = 8;

/// The samples that a block needs before the mean is tested: below, blocks would follow the correlation of
/// neighbouring samples.
const MIN_SAMPLES: Real = 16.0;

/// The share by which variances are increased, so that rounding leaves their matrix positive definite.
const RIDGE: Real = by_precision(1e-12, 1e-6);

/// A column that the others explain up to this share of its square is not tried.
pub(super) const EXPLAINED: Real = 1e-3;

/// The blocks of a course, and the model of their noise.
#[derive(Clone, Copy)]
pub(super) struct BlockMeans<'a> {
    pub(super) levels: &'a [Level],
    pub(super) model: &'a Model,
    /// The length of a block, in samples.
    pub(super) length: u32,
    pub(super) interval_s: Real,
}

/// The differences of neighbouring block means, made independent by the Cholesky factor of their covariance.
///
/// ```text
/// Cov(y_b, y_c) = −[G((k+1)M) − 2 G(kM) + G((k−1)M)]/(Mτ₀)²,      k = |b − c|,
/// ```
///
/// for blocks of `M` samples, up to a constant that differences remove. They exist for every effect, a random walk and
/// flicker noise included. A deterministic ramp counts as one of random slope.
pub(super) struct Contrasts {
    factor: Triangle<BLOCKS, { BLOCKS / 2 }>,
    /// The numbers of the blocks.
    pub(super) places: Vec<u32, BLOCKS>,
    /// What the columns of the basis leave of the whitened differences.
    pub(super) data: Vector<BLOCKS>,
    /// Orthonormal columns that the data has lost already: the slope of the course, and those of the shifts.
    pub(super) basis: Vec<Vector<BLOCKS>, { COLUMNS + 1 }>,
}

impl BlockMeans<'_> {
    /// The contrasts of the complete blocks that hold at least half of their samples, under these squared coefficients
    /// of the model. `None` if there are too few of them, or if the model has no noise.
    #[inline(never)]
    pub(super) fn contrasts(&self, squares: &[Real]) -> Option<Contrasts> {
        let Self {
            levels,
            model,
            length: block_length,
            interval_s,
        } = *self;
        let length = real(block_length);
        let is_usable = |level: &&Level| is_complete(level, block_length) && level.mean.is_finite();
        let levels: Vec<Level, BLOCKS> = list::fill(levels.iter().filter(is_usable).copied());
        if levels.len() < MIN_BLOCKS || length < MIN_SAMPLES {
            return None;
        }
        let covariances = covariances(model, squares, length, interval_s);
        // The part of a mean's variance that falls with the number of samples.
        let white = model.variance(squares, 1, interval_s);
        let mut contrasts = Contrasts {
            factor: Triangle::ZEROS,
            places: list::fill(levels.iter().map(|level| level.place)),
            data: Vector::ZEROS,
            basis: Vec::new(),
        };
        let count = levels.len().saturating_sub(1);
        let extra = |level: &Level| white * (1.0 / level.samples - 1.0 / length);
        for (i, pair) in numbered(levels.windows(2)) {
            let [a, b] = pair else { continue };
            contrasts.data.put(i, b.mean - a.mean);
            for (j, other) in numbered(levels.windows(2)).take(i.saturating_add(1)) {
                let [c, d] = other else { continue };
                let at = |x: &Level, y: &Level| {
                    let distance = x.place.abs_diff(y.place) as usize;
                    covariances.get(distance).copied().unwrap_or(0.0)
                };
                let mut covariance = at(b, d) - at(b, c) - at(a, d) + at(a, c);
                if a.place == d.place {
                    covariance -= extra(a);
                } else if a.place == c.place {
                    covariance += extra(a) + extra(b);
                    covariance += RIDGE * covariance;
                }
                contrasts.factor.put((i, j), covariance);
            }
        }
        if !cholesky::factor(&mut contrasts.factor, count) {
            return None;
        }
        cholesky::forward(&contrasts.factor, count, &mut contrasts.data);
        Some(contrasts)
    }
}

impl Contrasts {
    /// The number of contrasts.
    pub(super) fn count(&self) -> usize {
        self.places.len().saturating_sub(1)
    }

    /// The contrasts of a function of the block, whitened.
    pub(super) fn whitened(&self, f: impl Fn(u32) -> Real) -> Vector<BLOCKS> {
        let mut column = Vector::<BLOCKS>::ZEROS;
        for (i, pair) in numbered(self.places.windows(2)) {
            if let [a, b] = pair {
                column.put(i, f(*b) - f(*a));
            }
        }
        cholesky::forward(&self.factor, self.count(), &mut column);
        column
    }

    /// Subtracts from a column what the basis explains. Returns `None` if too little is left.
    pub(super) fn orthogonal(&self, column: &Vector<BLOCKS>) -> Option<Vector<BLOCKS>> {
        let mut rest = **column;
        for known in &self.basis {
            rest -= **known * known.dot(&rest);
        }
        let (left, whole) = (rest.norm_squared(), column.norm_squared());
        (left > EXPLAINED * whole && left.is_finite()).then(|| rest.into())
    }

    /// Takes what a column explains from the data.
    fn remove(&mut self, column: &Vector<BLOCKS>) {
        let Some(rest) = self.orthogonal(column) else {
            return;
        };
        let unit = *rest / math::sqrt(rest.norm_squared());
        let share = unit.dot(&self.data);
        self.data = (*self.data - unit * share).into();
        let _ = self.basis.push(unit.into());
    }

    /// Takes the slope of the course from the data, whatever its size, if the model has a rate ramp. The covariance must
    /// be that of a ramp of zero.
    pub(super) fn remove_slope_of(&mut self, model: &Model) {
        let ramp: &dyn Effect = &RateRamp;
        if model.position(ramp.name()).is_some() {
            let column = self.whitened(real);
            self.remove(&column);
        }
    }

    /// Takes a shift of any size, and of a slightly other time or time constant, from the data.
    pub(super) fn remove_form(&mut self, form: Form) {
        for derivative in [false, true] {
            let column = self.whitened(|block| form.column(derivative, block));
            self.remove(&column);
        }
    }

    /// `−2 ln L` of what is left of the data, up to a constant.
    pub(super) fn deviance(&self) -> Real {
        // The diagonal of the factor holds reciprocals.
        let diagonal = (0..self.count()).map(|i| math::log(self.factor[(i, i)]));
        self.data.norm_squared() - 2.0 * diagonal.sum::<Real>()
    }
}

/// The covariance of two block means at every distance, up to a constant.
fn covariances(model: &Model, squares: &[Real], length: Real, interval_s: Real) -> [Real; BLOCKS] {
    let duration_s = length * interval_s;
    core::array::from_fn(|k| {
        let lag = real(k as u32) * length;
        let of = |(term, square): (&Term, &Real)| {
            let shape = term.sampled_shape(interval_s);
            square * term.effect.second_difference(lag, length, &shape)
        };
        let terms = model.terms().iter().zip(squares);
        let sum: Real = terms.filter(|&(_, &square)| square > 0.0).map(of).sum();
        -sum / (duration_s * duration_s)
    })
}
