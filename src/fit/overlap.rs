//! The variance that estimates have because bins of different levels, and octaves, look at the same samples.
//!
//! The weights of a fit take the levels of a spectrum and the octaves for independent of each other. This loses
//! little, but the errors that follow from it are too small where a level and the next one see the same noise: the next
//! one sees aliases from above its range. A line beats against the same noise in every bin of every level that shows it.
//! The variance of the coefficients is therefore that of the sandwich `H⁻¹A'C⁻¹(C + Δ)C⁻¹AH⁻¹` (Huber 1967), in which
//! `Δ` holds what the weights leave out.
//!
//! Noise is taken to have the same density within the width of a bin. Beside a resonance that is narrower, its
//! coefficient scatters up to a fifth more than its error says (`cargo xtask study calibration`).

use super::{problem::Problem, rows::Rows};
use crate::{
    list::numbered,
    model::Term,
    nnls::Vector,
    real::{Real, real},
    spectrum::{Bin, Lags, octave_lag},
};

/// A sum of octaves and bins, each times a factor.
pub(super) struct Sum<'a, const K: usize, const B: usize> {
    pub(super) problem: &'a Problem<'a, K, B>,
    pub(super) squares: &'a Vector,
    /// The densities of the model's random part, from [`random_parts`].
    pub(super) random: &'a Rows<K, B>,
    pub(super) factors: &'a Rows<K, B>,
}

/// The random part of the model's values.
#[inline(never)]
pub(super) fn random_parts<const K: usize, const B: usize>(
    problem: &Problem<'_, K, B>,
    squares: &Vector,
    model: &Rows<K, B>,
) -> Rows<K, B> {
    let deterministic = problem.deterministic();
    Rows::of(problem.rows(), |row| {
        let share = problem.share_of(&deterministic, row, squares);
        model[row] * (1.0 - share).max(0.0)
    })
}

impl<const K: usize, const B: usize> Sum<'_, K, B> {
    /// The variance of the sum beyond the one that follows from the weights. It may be negative.
    #[inline(never)]
    pub(super) fn excess(&self) -> Real {
        let Some(spectrum) = self.problem.observed.spectrum() else {
            return 0.0;
        };
        let length = spectrum.segment() as usize;
        let mut excess = 0.0;
        let mut row = K;
        let mut finer: Option<(Lags, &Bin)> = None;
        for level in spectrum.levels() {
            let Some(bin) = level.first() else {
                continue;
            };
            let factor = |b: usize| self.factors[row.saturating_add(b)];
            if let Some((finer, above)) = &finer {
                let own = Lags::of_bins(length, level, length / 8, &factor);
                let beside = |l: usize| own.at_eighths(l);
                excess += finer.covariance(&beside, length, above.block, above.segments);
            }
            let noise = Lags::of_bins(length, level, length, &|b| {
                let random = self.random[row.saturating_add(b)];
                factor(b) * random * random
            });
            let octaves = |l: usize| self.octaves(real(l) * real(bin.block));
            excess += noise.covariance(&octaves, length, bin.block, bin.segments);
            finer = Some((noise, bin));
            row = row.saturating_add(level.len());
        }
        let lines = numbered(self.problem.model.terms());
        let lines = lines.filter(|(_, term)| self.is_line(term));
        2.0 * excess + lines.map(|(i, _)| self.of_line(i)).sum::<Real>()
    }

    /// The sum of the octaves as a function of the samples' distance, relative to a density of one.
    fn octaves(&self, distance: Real) -> Real {
        let points = numbered(self.problem.points);
        let terms = points.map(|(k, point)| {
            let m = real(point.m);
            self.factors[k] * octave_lag(distance / m) / m
        });
        0.5 / self.problem.interval_s * terms.sum::<Real>()
    }

    fn is_line(&self, term: &Term) -> bool {
        let shape = term.sampled_shape(self.problem.interval_s);
        let response = term.effect.response(1.0, &shape);
        response.is_some_and(|response| response.phase != 0.0)
    }

    /// The part of a line. The noise at its frequency changes its amplitude by the same share in octaves and in every
    /// level. The variance of the share is `c/((n + 1) Σg)`, with the number `n` of segments of the level that shows
    /// the line best, its densities `g` in the bins of this level, and the density `c` of the noise beside it.
    #[inline(never)]
    fn of_line(&self, i: usize) -> Real {
        let line = |row: usize| self.problem.unit(i, row) * self.squares[i];
        let part = |row: usize| self.factors[row] * line(row);
        let octaves = self.problem.points.len();
        // The octaves count as a level. Within a level, the weights know of the line.
        let mut level: Real = self.problem.rows().take(octaves).map(part).sum();
        let (mut all, mut within) = (0.0, 0.0);
        let mut best: Real = 0.0;
        let (mut block, mut sum, mut highest, mut noise) = (0, 0.0, 0.0, 0.0);
        for (row, bin) in self.problem.rows().skip(octaves).zip(self.problem.bins) {
            if bin.block != block {
                all += level;
                within += level * level;
                (block, level, sum, highest) = (bin.block, 0.0, 0.0, 0.0);
            }
            level += part(row);
            sum += line(row);
            if line(row) > highest {
                (highest, noise) = (line(row), self.random[row]);
            }
            best = best.max(sum * (real(bin.segments) + 1.0) / noise);
        }
        all += level;
        within += level * level;
        if best > 0.0 {
            4.0 / best * (all * all - within)
        } else {
            0.0
        }
    }
}

#[cfg(test)]
mod tests;
