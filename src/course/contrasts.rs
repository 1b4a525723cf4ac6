//! Steps and warm-ups in the means of blocks, against the covariance of a model.

use super::{BLOCKS, Level, response::decayed};
use crate::{
    algebra::{Triangle, Vector},
    cholesky,
    list::{self, numbered},
    math,
    model::{Model, Term},
    real::{Real, by_precision, consts::SQRT_2, real},
};
use heapless::Vec;

/// The number of steps and warm-ups that are told at most.
pub(super) const MAX_SHIFTS: usize = 4;

/// The number of columns of a shift: its form, and the derivative of the form by its time or its time constant.
const PER_SHIFT: usize = 2;

/// The number of columns of all shifts.
pub(super) const COLUMNS: usize = PER_SHIFT * MAX_SHIFTS;

/// A step is told from this standardised size on. `cargo xtask study course` measures how often it is exceeded in
/// clean records.
const STEP: f64 = 5.0;

/// A warm-up is told from this standardised size on: less than that of a step, because it has no choice of a time.
/// `cargo xtask study course` measures how often it is exceeded in clean records.
const WARM_UP: f64 = 4.6;

/// The blocks that the tests of the mean need.
const MIN_BLOCKS: usize = 8;

/// The samples that a block needs before the mean is tested: below, blocks would follow the correlation of
/// neighbouring samples.
const MIN_SAMPLES: Real = 16.0;

/// The share by which variances are increased, so that rounding leaves their matrix positive definite.
const RIDGE: Real = by_precision(1e-12, 1e-6);

/// A column that the others explain up to this share of its square is not tried.
const EXPLAINED: Real = 1e-3;

/// The number of places within a block at which a step is tried.
const FRACTIONS: u32 = 8;

/// The form of a shift of the mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Form {
    /// A step in the block `place`, when `fraction` of it has passed.
    Step { place: u32, fraction: Real },
    /// An exponential with this time constant, in blocks.
    WarmUp { time_constant: Real },
}

impl Form {
    /// The mean of the form over a block.
    pub(super) fn mean(self, block: u32) -> Real {
        match self {
            Self::Step { place, .. } if block < place => 0.0,
            Self::Step { place, fraction } if block == place => 1.0 - fraction,
            Self::Step { .. } => 1.0,
            Self::WarmUp { time_constant } => {
                let rate = 1.0 / time_constant;
                math::exp(-rate * real(block)) * time_constant * decayed(rate)
            }
        }
    }

    /// The derivative of the mean by the fraction of a step, or by the logarithm of a time constant.
    pub(super) fn derivative(self, block: u32) -> Real {
        match self {
            Self::Step { place, .. } => {
                if block == place {
                    -1.0
                } else {
                    0.0
                }
            }
            Self::WarmUp { time_constant } => {
                let at = |factor: Real| {
                    let time_constant = time_constant * factor;
                    Self::WarmUp { time_constant }.mean(block)
                };
                let step = real(1.02);
                (at(step) - at(1.0 / step)) / (2.0 * math::log(step))
            }
        }
    }

    /// The mean, or its derivative.
    pub(super) fn column(self, derivative: bool, block: u32) -> Real {
        if derivative {
            self.derivative(block)
        } else {
            self.mean(block)
        }
    }
}

/// A shift of the mean: a form and its size.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shift {
    pub(super) form: Form,
    /// The size in rate units, and its standard error with the time or the time constant free.
    pub(super) size: Real,
    pub(super) error: Real,
    /// The standardised size when it was found.
    pub(super) z: Real,
}

/// The shifts that were found, with what their sizes are worth.
pub(super) struct Shifts {
    pub(super) shifts: Vec<Shift, MAX_SHIFTS>,
    /// The coefficients of the columns: of the form and of its derivative, shift by shift.
    pub(super) coefficients: Vector<COLUMNS>,
    /// The covariance of the coefficients.
    pub(super) covariance: Triangle<9, 4>,
}

/// The largest standardised sizes of a step and of a warm-up.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct LargestShift {
    pub(super) step: Real,
    pub(super) warm_up: Real,
}

/// A form that was tried.
#[derive(Clone, Copy)]
struct Tried {
    form: Form,
    z: Real,
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
    places: Vec<u32, BLOCKS>,
    /// The whitened differences.
    whole: Vector<BLOCKS>,
    /// What the shifts that were found leave of them.
    data: Vector<BLOCKS>,
    /// Orthonormal columns that the data has lost already.
    basis: Vec<Vector<BLOCKS>, COLUMNS>,
}

impl Contrasts {
    /// The contrasts of the complete blocks that hold at least half of their samples. `None` if there are too few of
    /// them, or if the model has no noise.
    #[inline(never)]
    pub(super) fn new(
        levels: &[Level],
        model: &Model,
        squares: &[Real],
        block_length: u32,
        interval_s: Real,
    ) -> Option<Self> {
        let length = real(block_length);
        let is_usable = |level: &&Level| is_complete(level, block_length) && level.mean.is_finite();
        let levels: Vec<Level, BLOCKS> = list::fill(levels.iter().filter(is_usable).copied());
        if levels.len() < MIN_BLOCKS || length < MIN_SAMPLES {
            return None;
        }
        let covariances = covariances(model, squares, length, interval_s);
        // The part of a mean's variance that falls with the number of samples.
        let white = model.variance(squares, 1, interval_s);
        let mut contrasts = Self {
            factor: Triangle::ZEROS,
            places: list::fill(levels.iter().map(|level| level.place)),
            whole: Vector::ZEROS,
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
        contrasts.whole = contrasts.data;
        Some(contrasts)
    }

    /// The number of contrasts.
    fn count(&self) -> usize {
        self.places.len().saturating_sub(1)
    }

    /// The contrasts of a function of the block, whitened.
    fn whitened(&self, f: impl Fn(u32) -> Real) -> Vector<BLOCKS> {
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
    fn orthogonal(&self, column: &Vector<BLOCKS>) -> Option<Vector<BLOCKS>> {
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

    /// Finds shifts, the most significant first, until none is significant.
    #[inline(never)]
    pub(super) fn shifts(&mut self, largest: &mut LargestShift) -> Shifts {
        let mut tried: Vec<Tried, MAX_SHIFTS> = Vec::new();
        let mut found = LargestShift::default();
        while !tried.is_full() {
            let has_warm_up = tried
                .iter()
                .any(|tried| matches!(tried.form, Form::WarmUp { .. }));
            let step = self.step();
            let warm_up = if has_warm_up { None } else { self.warm_up() };
            if tried.is_empty() {
                found.step = step.map_or(0.0, |step| self.standardised(step));
                found.warm_up = warm_up.map_or(0.0, |warm_up| self.standardised(warm_up));
            }
            let best = match (step, warm_up) {
                (Some(step), Some(warm_up)) if step.z * step.z < warm_up.z * warm_up.z => warm_up,
                (Some(step), _) => step,
                (None, Some(warm_up)) => warm_up,
                (None, None) => break,
            };
            let z = self.standardised(best);
            let limit = match best.form {
                Form::Step { .. } => real(STEP),
                Form::WarmUp { .. } => real(WARM_UP),
            };
            if z * z <= limit * limit {
                break;
            }
            for derivative in [false, true] {
                let column = self.whitened(|block| best.form.column(derivative, block));
                self.remove(&column);
            }
            let _ = tried.push(Tried { z, ..best });
        }
        *largest = found;
        self.estimated(&tried)
    }

    /// The standardised size of a form, reduced where what remains of the data scatters more than the model says.
    fn standardised(&self, tried: Tried) -> Real {
        let rest = self.data.norm_squared() - tried.z * tried.z;
        let left = self.count().saturating_sub(self.basis.len());
        let freedom = left.saturating_sub(1).max(1);
        let ratio = rest / real(freedom as u32);
        if ratio > 1.0 {
            tried.z / math::sqrt(ratio)
        } else {
            tried.z
        }
    }

    /// The most significant step.
    fn step(&self) -> Option<Tried> {
        let mut best: Option<Tried> = None;
        let mut before: Option<(u32, Vector<BLOCKS>)> = None;
        for &place in self.places.iter().skip(1) {
            let form = Form::Step {
                place,
                fraction: 0.0,
            };
            let column = self.orthogonal(&self.whitened(|block| form.mean(block)));
            // A step within a block is a mixture of those at its two ends.
            if let (Some((first, one)), Some(other)) = (&before, &column) {
                let (product, own) = (one.dot(other), [one.norm_squared(), other.norm_squared()]);
                let data = [one.dot(&self.data), other.dot(&self.data)];
                for part in 1..FRACTIONS {
                    let fraction = real(part) / real(FRACTIONS);
                    let rest = 1.0 - fraction;
                    let square = rest * rest * own[0]
                        + fraction * fraction * own[1]
                        + 2.0 * rest * fraction * product;
                    let along = rest * data[0] + fraction * data[1];
                    let form = Form::Step {
                        place: *first,
                        fraction,
                    };
                    keep_better(&mut best, form, along, square);
                }
            }
            if let Some(column) = &column {
                keep_better(
                    &mut best,
                    form,
                    column.dot(&self.data),
                    column.norm_squared(),
                );
            }
            before = column.map(|column| (place, column));
        }
        best
    }

    /// The most significant warm-up. The time constants reach from one block to half of the record.
    fn warm_up(&self) -> Option<Tried> {
        let mut best = None;
        let longest = 0.5 * real(self.places.last().copied()?);
        let mut time_constant = longest;
        while time_constant >= 1.0 {
            self.try_warm_up(time_constant, &mut best);
            time_constant /= SQRT_2;
        }
        let Form::WarmUp { time_constant } = best?.form else {
            return best;
        };
        // Steps of 4 % within one step of the grid.
        let fine = real(1.04);
        let mut factor = 1.0 / SQRT_2;
        while factor < SQRT_2 {
            let time_constant = time_constant * factor;
            if time_constant >= 1.0 && time_constant <= longest {
                self.try_warm_up(time_constant, &mut best);
            }
            factor *= fine;
        }
        best
    }

    fn try_warm_up(&self, time_constant: Real, best: &mut Option<Tried>) {
        let form = Form::WarmUp { time_constant };
        if let Some(column) = self.orthogonal(&self.whitened(|block| form.mean(block))) {
            keep_better(best, form, column.dot(&self.data), column.norm_squared());
        }
    }

    /// The sizes of the shifts, estimated together by generalised least squares.
    fn estimated(&self, tried: &[Tried]) -> Shifts {
        let mut found = Shifts {
            shifts: Vec::new(),
            coefficients: Vector::ZEROS,
            covariance: Triangle::ZEROS,
        };
        if tried.is_empty() {
            return found;
        }
        let number = tried.len().saturating_mul(PER_SHIFT).min(COLUMNS);
        let column = |p: usize| {
            let form = tried.get(p / PER_SHIFT).map(|tried| tried.form);
            form.map_or(Vector::ZEROS, |form| {
                self.whitened(|block| form.column(p % PER_SHIFT == 1, block))
            })
        };
        let mut normal: Triangle<9, 4> = Triangle::ZEROS;
        let mut right: Vector<COLUMNS> = Vector::ZEROS;
        let mut units: Vector<COLUMNS> = Vector::ZEROS;
        for p in 0..number {
            let own = column(p);
            let square = own.norm_squared();
            let unit = if square > 0.0 {
                1.0 / math::sqrt(square)
            } else {
                0.0
            };
            units.put(p, unit);
            right.put(p, own.dot(&self.whole) * unit);
            for q in 0..p {
                normal.put((p, q), own.dot(&column(q)) * unit * units[q]);
            }
            // A derivative that the form explains, as at the last block, keeps the matrix regular and is unknown.
            normal.put((p, p), 1.0 + EXPLAINED * EXPLAINED);
        }
        if !cholesky::factor(&mut normal, number) {
            return found;
        }
        cholesky::forward(&normal, number, &mut right);
        cholesky::backward(&normal, number, &mut right);
        for p in 0..number {
            found.coefficients.put(p, right[p] * units[p]);
            let mut inverse: Vector<COLUMNS> = Vector::ZEROS;
            inverse.put(p, 1.0);
            cholesky::forward(&normal, number, &mut inverse);
            cholesky::backward(&normal, number, &mut inverse);
            for q in 0..=p {
                found
                    .covariance
                    .put((p, q), inverse[q] * units[p] * units[q]);
            }
        }
        found.shifts = list::fill(numbered(tried.iter()).map(|(i, tried)| {
            let p = i.saturating_mul(PER_SHIFT);
            Shift {
                form: tried.form,
                size: found.coefficients[p],
                error: math::sqrt(found.covariance[(p, p)]),
                z: tried.z,
            }
        }));
        found
    }
}

/// Whether a block has ended, and holds at least half of its samples.
pub(super) fn is_complete(level: &Level, block_length: u32) -> bool {
    level.filled >= 1.0 && 2.0 * level.samples >= real(block_length)
}

/// Keeps a form if it is more significant than the best one so far. `along` is its product with the data, and
/// `square` is its own square.
fn keep_better(best: &mut Option<Tried>, form: Form, along: Real, square: Real) {
    if square > 0.0 {
        let z = along / math::sqrt(square);
        if best.is_none_or(|best| z * z > best.z * best.z) {
            *best = Some(Tried { form, z });
        }
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
