//! Least squares whose unknowns cannot be negative, and intervals by the likelihood ratio, by pivots of one tableau.

use super::terms::{TERMS, is_positive, positive, sqrt};

/// An unknown can be told from the others if its pivot, relative to one, is larger.
const LEAST_PIVOT: f32 = 1e-5;

/// A gradient is zero below this size.
const LEAST_GRADIENT: f32 = 1e-6;

/// The equations of an interval's end, which never takes as many pivots.
const MOST_PIVOTS: usize = 12;

/// The numbers of a row.
const WIDTH: usize = TERMS + 1;

/// The equations `w = b − Hx` with unknowns scaled so that the diagonal of `H` is one, some of them solved for their `x`. The
/// last number of a row is the value of `x` if the row is solved, and of `w`, half of what the squared residuals fall by
/// where `x` grows, if it is not: with all `x` that are not solved at zero.
#[derive(Clone, Copy)]
pub(super) struct Tableau {
    /// Row by row, in one piece, so that an element is one step away.
    elements: [f32; WIDTH * TERMS],
    scale: [f32; TERMS],
    free: u8,
}

impl Tableau {
    pub(super) const EMPTY: Self = Self {
        elements: [0.0; WIDTH * TERMS],
        scale: [0.0; TERMS],
        free: 0,
    };

    /// Sets the equations from the products of columns, of which the last one is that of the curve.
    pub(super) fn set(&mut self, product: impl Fn(usize, usize) -> f32) {
        self.free = 0;
        // The products below the diagonal are those above it.
        for a in 0..TERMS {
            for b in a..=TERMS {
                let product = product(a, b);
                self.put(a, b, product);
                if b < TERMS {
                    self.put(b, a, product);
                }
            }
        }
        for a in 0..TERMS {
            let scale = 1.0 / sqrt(self.pivot_of(a));
            if let Some(place) = self.scale.get_mut(a) {
                *place = scale;
            }
        }
        for (row, own) in self.elements.chunks_exact_mut(WIDTH).zip(self.scale) {
            let others = self.scale.iter().chain([&1.0]);
            for (element, other) in row.iter_mut().zip(others) {
                *element *= own * other;
            }
        }
    }

    fn put(&mut self, i: usize, j: usize, element: f32) {
        if let Some(place) = self.elements.get_mut(i.wrapping_mul(WIDTH).wrapping_add(j)) {
            *place = element;
        }
    }

    /// The element in row `i` and column `j`.
    #[inline(never)]
    fn at(&self, i: usize, j: usize) -> f32 {
        let place = i.wrapping_mul(WIDTH).wrapping_add(j);
        self.elements.get(place).copied().unwrap_or(0.0)
    }

    fn pivot_of(&self, i: usize) -> f32 {
        self.at(i, i)
    }

    /// Whether unknown `i`, which is not solved, can be distinguished from those that are.
    fn can_be_told(&self, i: usize) -> bool {
        LEAST_PIVOT < self.pivot_of(i)
    }

    /// The last number of row `i`.
    fn value(&self, i: usize) -> f32 {
        self.at(i, TERMS)
    }

    pub(super) fn scale(&self, i: usize) -> f32 {
        self.scale.get(i).copied().unwrap_or(0.0)
    }

    /// Whether an unknown is solved.
    pub(super) const fn has(&self, i: usize) -> bool {
        self.free.wrapping_shr(i as u32) & 1 == 1
    }

    /// The set of unknowns that are solved.
    pub(super) const fn free(&self) -> u8 {
        self.free
    }

    /// Solves an unknown, or holds a solved one at zero.
    #[inline(never)]
    fn pivot(&mut self, p: usize) {
        let reciprocal = 1.0 / self.pivot_of(p);
        for j in 0..WIDTH {
            let element = if j == p { 1.0 } else { self.at(p, j) };
            self.put(p, j, element * reciprocal);
        }
        for i in (0..TERMS).filter(|i| *i != p) {
            let factor = self.at(i, p);
            self.put(i, p, 0.0);
            for j in 0..WIDTH {
                self.put(i, j, self.at(i, j) - factor * self.at(p, j));
            }
        }
        self.free ^= 1_u8.wrapping_shl(p as u32);
    }

    /// Solves the unknowns of a set, of any sign, as far as they can be told from each other. Returns whether all can.
    pub(super) fn release(&mut self, set: u8) -> bool {
        for i in 0..TERMS {
            if set.wrapping_shr(i as u32) & 1 == 1 && self.can_be_told(i) {
                self.pivot(i);
            }
        }
        self.free == set
    }

    /// Holds an unknown at zero, and solves the others.
    pub(super) fn hold(&mut self, i: usize) {
        if self.has(i) {
            self.pivot(i);
        }
    }

    /// Finds the smallest squared residuals with unknowns that are not negative (Murty 1974, Math. Program. 7, 250: the
    /// first unknown on the wrong side changes it). Those of `held` stay at zero, and those of `guess` are tried first.
    /// Returns by how much the squared residuals fall.
    #[inline(never)]
    pub(super) fn solve(&mut self, guess: u8, held: u8) -> f32 {
        let is_in = |set: u8, i: usize| set.wrapping_shr(i as u32) & 1 == 1;
        let mut fall = 0.0;
        for i in 0..TERMS {
            if is_in(guess & !held, i) && !self.has(i) {
                fall += self.change(i);
            }
        }
        for _ in 0..40 {
            let is_wrong = |i: &usize| {
                let value = self.value(*i);
                if self.has(*i) {
                    !is_positive(value)
                } else {
                    !is_in(held, *i) && LEAST_GRADIENT < value && self.can_be_told(*i)
                }
            };
            let Some(i) = (0..TERMS).find(is_wrong) else {
                break;
            };
            fall += self.change(i);
        }
        fall
    }

    /// Lets an unknown change sides, if it can be distinguished from the others. Returns by how much the squared residuals fall.
    fn change(&mut self, i: usize) -> f32 {
        let (value, own, was_free) = (self.value(i), self.pivot_of(i), self.has(i));
        if !was_free && !self.can_be_told(i) {
            return 0.0;
        }
        self.pivot(i);
        let change = value * value / own;
        if was_free { -change } else { change }
    }

    /// The squared coefficients.
    pub(super) fn squares(&self) -> [f32; TERMS] {
        let mut squares = [0.0; TERMS];
        for (i, square) in (0..TERMS).zip(&mut squares) {
            if self.has(i) {
                *square = self.value(i) * self.scale(i);
            }
        }
        squares
    }

    /// Takes back what rounding left in squared coefficients, by the gradient that they have.
    pub(super) fn refine(&self, squares: &mut [f32; TERMS], gradient: &[f32; TERMS]) -> f32 {
        let mut fall = 0.0;
        for (i, square) in (0..TERMS).zip(squares) {
            if !self.has(i) {
                continue;
            }
            let mut step = 0.0;
            for (j, gradient) in (0..TERMS).zip(gradient) {
                if self.has(j) {
                    step += self.at(i, j) * gradient * self.scale(j);
                }
            }
            let step = step * self.scale(i);
            fall += step * gradient.get(i).copied().unwrap_or(0.0);
            let refined = *square + step;
            if is_positive(refined) {
                *square = refined;
            }
        }
        fall
    }

    /// The variance of a squared coefficient where all are solved.
    pub(super) fn solved_variance(&self, i: usize) -> f32 {
        let scale = self.scale(i);
        self.pivot_of(i) * scale * scale
    }

    /// The variance of a squared coefficient with the others that are solved; `None` if it cannot be told from them. It is
    /// held at zero.
    pub(super) fn variance(&self, i: usize) -> Option<f32> {
        let own = self.pivot_of(i);
        let scale = self.scale(i);
        self.can_be_told(i).then(|| scale * scale / own)
    }

    /// The square of coefficient `i`, which is held at zero, and was `square`, where the squared residuals are by `rise`
    /// above their minimum, with the others fitted anew, at zero or above.
    #[inline(never)]
    pub(super) fn end(&self, i: usize, square: f32, rise: f32, up: bool) -> f32 {
        let mut path = *self;
        let (scale, mut left) = (self.scale(i), rise);
        let mut at = square / scale;
        for _ in 0..MOST_PIVOTS {
            let curvature = path.pivot_of(i);
            let slope = path.value(i) - curvature * at;
            let root = sqrt(slope * slope + curvature * left);
            let goal = at + if up { slope + root } else { slope - root } / curvature;
            let (next, other) = path.next_change(i, at, positive(goal), up);
            let step = next - at;
            left -= step * (curvature * step - 2.0 * slope);
            at = next;
            let Some(other) = other else {
                break;
            };
            path.pivot(other);
        }
        at * scale
    }

    /// By how much the squared residuals fall where coefficient `i`, whose square is `held` more than the unknown, which is
    /// zero, is fitted too, at zero or above; and whether its square grows.
    #[inline(never)]
    pub(super) fn fall(mut self, i: usize, held: f32) -> (f32, bool) {
        let least = -held / self.scale(i);
        let up = is_positive(self.value(i));
        let (mut at, mut fall) = (0.0, 0.0);
        for _ in 0..MOST_PIVOTS {
            let curvature = self.pivot_of(i);
            if !self.can_be_told(i) {
                break;
            }
            let slope = self.value(i) - curvature * at;
            if is_positive(slope) != up {
                break;
            }
            let goal = at + slope / curvature;
            let (next, other) =
                self.next_change(i, at, if goal > least { goal } else { least }, up);
            let step = next - at;
            fall += step * (2.0 * slope - curvature * step);
            at = next;
            let Some(other) = other else {
                break;
            };
            self.pivot(other);
        }
        (fall, up)
    }

    /// Where unknown `i`, which is not solved, goes from `at` to `goal`: the first of the others that falls to zero on the way,
    /// or leaves it, and the place; or the goal.
    fn next_change(&self, i: usize, at: f32, goal: f32, up: bool) -> (f32, Option<usize>) {
        let mut next = (goal, None);
        for j in 0..TERMS {
            let change = self.at(j, i);
            let is_turning = is_positive(change) == (up == self.has(j));
            let turns = is_turning && change.abs().to_bits() >= f32::MIN_POSITIVE.to_bits();
            if j == i || !turns || !self.can_be_told(j) {
                continue;
            }
            let place = self.value(j) / change;
            let (is_behind, is_nearer) = if up {
                (place < at, place < next.0)
            } else {
                (at < place, next.0 < place)
            };
            if is_nearer && !is_behind {
                next = (place, Some(j));
            }
        }
        next
    }
}
