//! The variance of estimates beyond the one that the weights of a fit say.
//!
//! The weights take the levels of a spectrum and the octaves for independent of each other, and the noise for the same
//! over the width of a bin. This loses little, but the errors that follow from it are wrong in three ways:
//!
//! * A level and the next one see the same noise, since the next one sees aliases from above its range, and so do octaves.
//! * Noise that is narrower than a bin scatters more in one bin, and lets neighbouring bins scatter together.
//! * A line beats against the same noise in every bin of every level that shows it. Within a level, how much of the noise
//!   is the same in two bins depends on the line's place between them.
//!
//! The variance of the coefficients is therefore that of the sandwich `H⁻¹A'C⁻¹(C + Δ)C⁻¹AH⁻¹` (Huber 1967), in which
//! `Δ` holds what the weights leave out. Between levels, noise is taken to have the width of the finer level's
//! [`Fine`] density at least.

use super::{problem::Problem, rows::Rows};
use crate::{
    limits::MAX_EFFECTS,
    list::numbered,
    numerics::{
        nnls::{PassiveSet, Vector},
        real::{Real, real},
    },
    spectrum::{BAND, Bin, Fine, Lags, Lobe, Sum, octave_lag, relative_covariance},
    theory::{effect::Behind, model::Term},
};

/// The power of a line in a bin, relative to that in a bin at the line, from which on it tells the power in other bins.
/// Chosen by hand: further off, only the leakage of the window is left.
const SHOWN: Real = 1e-3;

/// The sum of a line's powers over all bins, relative to that in a bin at the line: that of the Hann window.
const SQUARES: Real = 1.5;

/// A solved model, with what its weights leave out.
pub(super) struct Overlap<'a, const K: usize, const B: usize> {
    problem: &'a Problem<'a, K, B>,
    squares: &'a Vector,
    /// The effects that are lines: deterministic effects with a frequency.
    lines: PassiveSet,
    /// The densities of the model's random part.
    random: Rows<K, B>,
}

/// One level of the spectrum.
#[derive(Clone, Copy)]
pub(super) struct Level<'a> {
    /// The row of its first bin.
    row: usize,
    bins: &'a [Bin],
}

impl Level<'_> {
    fn row(&self, b: usize) -> usize {
        self.row.saturating_add(b)
    }
}

impl<'a, const K: usize, const B: usize> Overlap<'a, K, B> {
    /// A model with these squared coefficients. `model` are its values.
    #[inline(never)]
    pub(super) fn new(
        problem: &'a Problem<'a, K, B>,
        squares: &'a Vector,
        model: &Rows<K, B>,
    ) -> Self {
        let deterministic = problem.deterministic();
        let random = Rows::of(problem.rows(), |row| {
            let share = problem.share_of(&deterministic, row, squares);
            model[row] * (1.0 - share).max(0.0)
        });
        let is_line = |term: &Term| {
            let shape = term.sampled_shape(problem.interval_s);
            let response = term.effect.response(1.0, &shape);
            response.is_some_and(|response| response.phase != 0.0)
        };
        let terms = problem.model.terms();
        Self {
            problem,
            squares,
            lines: PassiveSet::of(|i| terms.get(i).is_some_and(is_line)),
            random,
        }
    }

    /// The levels, shortest blocks first.
    pub(super) fn levels(&self) -> impl Iterator<Item = Level<'a>> + use<'a, K, B> {
        let mut row = K;
        let spectrum = self.problem.observed.spectrum();
        let levels = spectrum.into_iter().flat_map(|spectrum| spectrum.levels());
        levels.map(move |bins| {
            let level = Level { row, bins };
            row = row.saturating_add(bins.len());
            level
        })
    }

    /// The density of the noise between the bins of a level.
    #[inline(never)]
    pub(super) fn fine(&self, level: &Level<'_>) -> Fine {
        let block = level.bins.first().map_or(1, |bin| bin.block);
        let model = self.problem.model;
        let Some((_, filter)) = model.passing() else {
            return self.noise(block, None);
        };
        let mut fine = self.noise(block, Some(false));
        let mut alone = Fine::new(self.segment());
        let shape = filter.sampled_shape(self.problem.interval_s);
        alone.add(filter.effect, &shape, block, 1.0);
        let mut behind = self.noise(block, Some(true));
        behind.pass(&alone);
        fine.add_all(&behind);
        for (i, term) in numbered(model.terms().iter()) {
            let through = model.filter_of(i).is_some();
            let exact = Behind::new(term.effect, filter.effect, &shape).filter(|_| through);
            if let Some(exact) = exact.filter(|_| self.squares[i] > 0.0) {
                fine.add(&exact, &shape, block, self.squares[i]);
            }
        }
        fine
    }

    /// The density of the model's noise without the filter that all noise passes. Of a model with such a filter, it is the
    /// noise that passes it, as far as it has no closed form behind it, or the noise that does not.
    fn noise(&self, block: u32, passes: Option<bool>) -> Fine {
        let mut fine = Fine::new(self.segment());
        let deterministic = self.problem.deterministic();
        let model = self.problem.model;
        for (i, term) in numbered(model.terms().iter()) {
            let through = model.filter_of(i);
            let has_closed_form = through.is_some_and(|filter| {
                let shape = filter.sampled_shape(self.problem.interval_s);
                Behind::new(term.effect, filter.effect, &shape).is_some()
            });
            let is_wanted = passes.is_none_or(|passes| passes == through.is_some());
            if !deterministic.has(i) && self.squares[i] > 0.0 && is_wanted && !has_closed_form {
                let shape = term.sampled_shape(self.problem.interval_s);
                fine.add(term.effect, &shape, block, self.squares[i]);
            }
        }
        fine
    }

    fn segment(&self) -> usize {
        let spectrum = self.problem.observed.spectrum();
        spectrum.map_or(0, |spectrum| spectrum.segment() as usize)
    }

    /// What a level adds to the variance of a sum of octaves and bins, each times its factor, beyond the variance that
    /// follows from the weights. It may be negative. `next` is the level behind it, with which it shares noise.
    #[inline(never)]
    pub(super) fn of_level(
        &self,
        level: &Level<'_>,
        next: Option<&Level<'_>>,
        fine: &Fine,
        factors: &Rows<K, B>,
    ) -> Real {
        let Some(first) = level.bins.first() else {
            return 0.0;
        };
        let length = self.segment();
        let weighted = Sum::new(level.bins, |b| factors[level.row(b)]);
        let noise = fine.lags(&weighted);
        let octaves = |l: usize| self.octaves(factors, real(l) * real(first.block));
        let mut shared = noise.covariance(&octaves, length, first.block, first.segments);
        if let Some(next) = next {
            let own = Lags::of_bins(length, next.bins, length / 8, &|b| factors[next.row(b)]);
            let beside = |l: usize| own.at_eighths(l);
            shared += noise.covariance(&beside, length, first.block, first.segments);
        }
        let lines = (0..MAX_EFFECTS).filter(|&i| self.lines.has(i));
        let beats: Real = lines.map(|i| self.beats(level, i, factors)).sum();
        fine.variance(&weighted, first.segments) + beats - self.weighted(level, factors)
            + 2.0 * shared
    }

    /// The variance of the bins' sum that follows from the weights, of noise and of lines that beat against it.
    fn weighted(&self, level: &Level<'_>, factors: &Rows<K, B>) -> Real {
        let part = |b: usize| {
            let row = level.row(b);
            let lines = (0..MAX_EFFECTS).filter(|&i| self.lines.has(i));
            let line: Real = lines.map(|i| self.value(i, row)).sum();
            let all = self.random[row] + line;
            (factors[row] * all, if all > 0.0 { line / all } else { 0.0 })
        };
        let mut sum = 0.0;
        for (b, bin) in numbered(level.bins.iter()) {
            let (own, share) = part(b);
            let later = numbered(level.bins.iter()).skip(b).take(BAND);
            for (c, later) in later {
                let (other, other_share) = part(c);
                let distance = later.index.wrapping_sub(bin.index) as usize;
                let effective = bin.effective_segments();
                let relative = relative_covariance(distance, effective, [share, other_share]);
                let twice = if c == b { 1.0 } else { 2.0 };
                sum += twice * own * other * relative;
            }
        }
        sum
    }

    /// What an effect adds to a row.
    fn value(&self, i: usize, row: usize) -> Real {
        self.problem.unit(i, row) * self.squares[i]
    }

    /// The bin of a level that shows a line best, and what the noise beside it makes of the line's share: the variance
    /// `4c/((n + 1) Σg)`, with the number `n` of segments, the densities `g` of the line in the bins, and the density `c`
    /// of the noise. `None` for a level that does not show the line.
    fn shown(&self, level: &Level<'_>, i: usize) -> Option<(usize, Real)> {
        let (mut best, mut highest, mut sum) = (0, 0.0, 0.0);
        for (b, _) in numbered(level.bins.iter()) {
            let here = self.value(i, level.row(b));
            sum += here;
            if here > highest {
                (best, highest) = (b, here);
            }
        }
        let segments = real(level.bins.first()?.segments);
        let noise = self.random[level.row(best)];
        if sum <= 0.0 {
            return None;
        }
        // The bins that a level does not have show the line as well, such as those from half the rate of its blocks on.
        let lobe = self.lobe(level, i)?;
        let index = level.bins.get(best)?.index;
        let shown = lobe.power(index);
        let all = if shown > SHOWN {
            highest / shown * SQUARES
        } else {
            sum
        };
        Some((best, 4.0 * noise / ((segments + 1.0) * all)))
    }

    /// The place of a line among the bins of a level.
    fn lobe(&self, level: &Level<'_>, i: usize) -> Option<Lobe> {
        let block = level.bins.first()?.block;
        let term = self.problem.model.terms().get(i)?;
        let shape = term.sampled_shape(self.problem.interval_s);
        let response = term.effect.response(1.0, &shape)?;
        Some(Lobe::new(response, self.segment(), block))
    }

    /// The variance that the beats of a line against the noise give the sum of a level's bins.
    ///
    /// The mean over segments that overlap by half lets the line beat against the noise at its own frequency and at those
    /// two bins beside it. The two ends of the record, which a single segment sees, add those one bin beside it. With the
    /// bins' factors `a`, the line's densities `g = Σg h²/Σh²` and the amplitudes `h(k)` that it has in all bins, whether
    /// the level has these or not,
    ///
    /// ```text
    /// (4c/((n + 1) Σg)) [(Σ a_k g_k)² + b_2 + b_1/2n],    b_d = Σ_± (Σ_k a_k g_k h(k ± d)/h(k))²
    /// ```
    ///
    /// Of the sums in `b`, those bins count that are in the main lobe of the line.
    fn beats(&self, level: &Level<'_>, i: usize, factors: &Rows<K, B>) -> Real {
        let (Some((best, variance)), Some(lobe)) = (self.shown(level, i), self.lobe(level, i))
        else {
            return 0.0;
        };
        let beside = |distance: i32| {
            let (mut above, mut below) = (0.0, 0.0);
            for b in best.saturating_sub(2)..=best.saturating_add(2) {
                let Some(bin) = level.bins.get(b) else {
                    continue;
                };
                let here = self.value(i, level.row(b)) / lobe.power(bin.index).max(SHOWN);
                let row = factors[level.row(b)] * here;
                above += row * lobe.product(bin.index, distance);
                below += row * lobe.product(bin.index, distance.wrapping_neg());
            }
            above * above + below * below
        };
        let own = self.line_in(level, i, factors);
        let segments = level.bins.first().map_or(1, |bin| bin.segments);
        variance * (own * own + beside(2) + beside(1) / (2.0 * real(segments)))
    }

    /// The part of a line in the sum of a level's bins.
    fn line_in(&self, level: &Level<'_>, i: usize, factors: &Rows<K, B>) -> Real {
        let rows = (0..level.bins.len()).map(|b| level.row(b));
        rows.map(|row| factors[row] * self.value(i, row)).sum()
    }

    /// What lines add to the variance because the noise at a line's frequency changes its amplitude by the same share in
    /// octaves and in every level. The share has the variance that the level with the smallest one gives.
    #[inline(never)]
    pub(super) fn of_lines(&self, factors: &Rows<K, B>) -> Real {
        let lines = (0..MAX_EFFECTS).filter(|&i| self.lines.has(i));
        let of_line = |i: usize| {
            // The octaves count as a level.
            let octaves = self.problem.rows().take(self.problem.points.len());
            let mut all: Real = octaves.map(|row| factors[row] * self.value(i, row)).sum();
            let mut within = all * all;
            let mut least = Real::INFINITY;
            for level in self.levels() {
                let own = self.line_in(&level, i, factors);
                all += own;
                within += own * own;
                if let Some((_, variance)) = self.shown(&level, i) {
                    least = least.min(variance);
                }
            }
            if least < Real::INFINITY {
                least * (all * all - within)
            } else {
                0.0
            }
        };
        lines.map(of_line).sum()
    }

    /// The sum of the octaves as a function of the samples' distance, relative to a density of one.
    fn octaves(&self, factors: &Rows<K, B>, distance: Real) -> Real {
        let points = numbered(self.problem.points);
        let terms = points.map(|(k, point)| {
            let m = real(point.m);
            factors[k] * octave_lag(distance / m) / m
        });
        0.5 / self.problem.interval_s * terms.sum::<Real>()
    }
}

#[cfg(test)]
mod tests;
