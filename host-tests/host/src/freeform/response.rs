//! The response of a low pass of any form that explains a record's densities best.

use super::{
    bands::Bands,
    family::{FAMILIES, Family},
    non_negative::solve,
};
use allanite::{
    Model, Term,
    effect::{Distribution, IEEE_952},
    spectrum::Spectrum,
};
use nalgebra::{DMatrix, DVector};
use std::sync::Arc;

/// The corners that are tried, in cycles per sample, and their number.
const LOWEST_CORNER: f64 = 0.012;
const HIGHEST_CORNER: f64 = 0.42;
const CORNERS: i32 = 14;
/// Rounds of the refinement of a corner: each leaves 0.62 of the range. A long record shows the right family only at its corner.
const ROUNDS: u32 = 12;
/// A response within this score of the best is as good.
const AS_GOOD: f64 = 6.0;
/// Bins of a Hann window are correlated with their neighbours, so that of two of them one is independent.
const INDEPENDENT: f64 = 1.0 / 1.944;
/// No density is known better than to this share.
const TOLERANCE: f64 = 0.005;
/// How far a response may rise again, relative to its value at zero. Chosen by hand.
const RISE: f64 = 0.03;
/// Correlation times below so many samples compete with every filter.
const SLOW: f64 = 20.0;

/// A response, relative to one at zero.
#[derive(Clone, Debug)]
pub(super) struct Response {
    family: Family,
    /// The corner or the first knot, in cycles per sample.
    corner: f64,
    /// The coefficients of the family's columns, which add up to one at zero.
    coefficients: Vec<f64>,
    /// The frequency in cycles per sample at which half of the power is left.
    pub(super) cutoff: f64,
    /// The number of parameters.
    pub(super) parameters: usize,
    /// The coefficient of the white noise in front of the filter, squared, and its standard error.
    pub(super) white: [f64; 2],
    score: f64,
}

impl Response {
    /// The share of the power that is left at a frequency in cycles per sample.
    pub(super) fn at(&self, frequency: f64) -> f64 {
        let mut columns = Vec::new();
        let frequency = frequency.clamp(0.0, 0.5);
        self.family.columns(self.corner, frequency, &mut columns);
        let pairs = columns.iter().zip(&self.coefficients);
        pairs
            .map(|(column, coefficient)| column * coefficient)
            .sum()
    }
}

/// The best responses, the best first, with those that are as good. Empty where the spectrum has too few bins.
pub(super) fn responses<const B: usize>(
    spectrum: &Spectrum<B>,
    model: &Model,
    bands: Arc<Bands>,
) -> Vec<Response> {
    let bins = spectrum.bins();
    if bins.len() < 28 {
        return Vec::new();
    }
    let densities = Densities::new(spectrum, model, bands);
    let mut tried: Vec<Response> = Vec::new();
    for family in FAMILIES {
        let corners = (0..CORNERS).map(|at| {
            let share = f64::from(at) / f64::from(CORNERS - 1);
            LOWEST_CORNER * (HIGHEST_CORNER / LOWEST_CORNER).powf(share)
        });
        let found = corners.filter_map(|corner| densities.response(family, corner));
        tried.extend(found.min_by(|a, b| a.score.total_cmp(&b.score)));
    }
    let step = (HIGHEST_CORNER / LOWEST_CORNER).powf(1.0 / f64::from(CORNERS - 1));
    for response in &mut tried {
        densities.refine(response, step);
    }
    tried.sort_by(|a, b| a.score.total_cmp(&b.score));
    let best = tried.first().map_or(0.0, |best| best.score);
    tried.retain(|response| response.score < best + AS_GOOD);
    tried
}

/// The densities of a record, and what adds to the white noise.
struct Densities {
    measured: Vec<f64>,
    /// The shape of the gamma distribution of each density.
    weight: Vec<f64>,
    /// What adds to the white noise.
    others: Vec<Vec<f64>>,
    /// The measured densities, smoothed.
    smooth: Vec<f64>,
    bands: Arc<Bands>,
    /// For each band, what the bins are expected to show of it.
    shown: Vec<Vec<f64>>,
}

impl Densities {
    fn new<const B: usize>(spectrum: &Spectrum<B>, model: &Model, bands: Arc<Bands>) -> Self {
        let bins = spectrum.bins();
        let measured: Vec<f64> = bins.iter().map(|bin| bin.density.max(1e-300)).collect();
        let weight = bins.iter().map(|bin| {
            let independent = INDEPENDENT * bin.effective_segments();
            1.0 / (1.0 / independent + TOLERANCE * TOLERANCE)
        });
        let interval_s = 1.0 / spectrum.rate_hz();
        let terms = model.terms().iter().copied();
        let kept = terms.filter(|term| adds_beside_filter(term, interval_s));
        let mut others: Vec<Term> = kept.collect();
        for effect in [IEEE_952[0], IEEE_952[2], IEEE_952[3]] {
            if others
                .iter()
                .all(|term| term.effect.name() != effect.name())
            {
                others.push(Term::new(effect));
            }
        }
        let others = others.iter().map(|term| {
            let expected = spectrum.expected(term.effect, term.parameters);
            expected.iter().copied().collect()
        });
        let mut smooth = Vec::new();
        for level in spectrum.levels() {
            let logs: Vec<f64> = level
                .iter()
                .map(|bin| bin.density.max(1e-300).ln())
                .collect();
            smooth.extend((0..logs.len()).map(|at| {
                let near = &logs[at.saturating_sub(2)..(at + 3).min(logs.len())];
                (near.iter().sum::<f64>() / near.len() as f64).exp()
            }));
        }
        Self {
            weight: weight.collect(),
            others: others.collect(),
            smooth,
            shown: bands.shown(spectrum),
            bands,
            measured,
        }
    }

    /// The columns of what adds to the white noise, and then those of a family.
    fn columns(&self, family: Family, corner: f64) -> Vec<Vec<f64>> {
        let mut values: Vec<Vec<f64>> = Vec::new();
        let mut columns = Vec::new();
        for &frequency in &self.bands.frequencies {
            family.columns(corner, frequency, &mut columns);
            values.resize(columns.len(), Vec::new());
            for (values, column) in values.iter_mut().zip(&columns) {
                values.push(*column);
            }
        }
        let shown = values.into_iter().map(|values| {
            let mut shown = vec![0.0; self.measured.len()];
            for (value, of_band) in values.iter().zip(&self.shown) {
                if *value != 0.0 {
                    add(*value, of_band, &mut shown);
                }
            }
            shown
        });
        self.others.iter().cloned().chain(shown).collect()
    }

    /// The response of a family with this corner; `None` if it rises.
    fn response(&self, family: Family, corner: f64) -> Option<Response> {
        let columns = self.columns(family, corner);
        let (deviance, squares, model) = self.solve(&columns);
        let own = &squares[self.others.len()..];
        let mut at_zero = Vec::new();
        family.columns(corner, 0.0, &mut at_zero);
        let pairs = || at_zero.iter().zip(own);
        let density: f64 = pairs().map(|(column, square)| column * square).sum();
        if !(density > 0.0 && density.is_finite()) {
            return None;
        }
        let active = own.iter().filter(|square| **square > 0.0).count();
        let parameters = active - 1 + family.corners();
        let mut response = Response {
            family,
            corner,
            coefficients: own.iter().map(|square| square / density).collect(),
            cutoff: 0.5,
            parameters,
            white: [density, 0.0],
            score: deviance + 2.0 * parameters as f64,
        };
        let passed: Vec<f64> = self
            .bands
            .frequencies
            .iter()
            .map(|f| response.at(*f))
            .collect();
        let mut least = f64::INFINITY;
        for passed in &passed {
            if *passed > least + RISE {
                return None;
            }
            least = least.min(*passed);
        }
        let below = passed.iter().position(|passed| *passed < 0.5);
        response.cutoff = below.map_or(0.5, |at| self.bands.frequencies[at]);
        response.white[1] = self.error(&columns, &squares, &model, &at_zero);
        Some(response)
    }

    /// Least squares with the weights of the model, round by round: deviance, coefficients and densities.
    fn solve(&self, columns: &[Vec<f64>]) -> (f64, Vec<f64>, Vec<f64>) {
        let mut model = self.smooth.clone();
        let mut best: Option<(f64, Vec<f64>, Vec<f64>)> = None;
        for _ in 0..5 {
            let (gram, right, scales) = self.equations(columns, &model);
            let found = solve(&gram, &right);
            let squares: Vec<f64> = found.iter().zip(&scales).map(|(x, s)| x * s).collect();
            model = vec![0.0; self.measured.len()];
            for (square, column) in squares.iter().zip(columns) {
                add(*square, column, &mut model);
            }
            for (model, measured) in model.iter_mut().zip(&self.measured) {
                *model = model.max(1e-6 * measured);
            }
            let deviance = self.deviance(&model);
            let is_last = best
                .as_ref()
                .is_some_and(|(least, ..)| deviance > least - 0.02);
            if best.as_ref().is_none_or(|(least, ..)| deviance < *least) {
                best = Some((deviance, squares, model.clone()));
            }
            if is_last {
                break;
            }
        }
        best.unwrap_or_default()
    }

    /// Twice the logarithm of the likelihood ratio of gamma-distributed densities.
    fn deviance(&self, model: &[f64]) -> f64 {
        let rows = self.measured.iter().zip(model).zip(&self.weight);
        rows.map(|((measured, model), weight)| {
            let ratio = measured / model;
            2.0 * weight * (ratio - 1.0 - ratio.ln())
        })
        .sum()
    }

    /// Normal equations of columns of length one, and the scales that make them so.
    fn equations(
        &self,
        columns: &[Vec<f64>],
        model: &[f64],
    ) -> (DMatrix<f64>, DVector<f64>, Vec<f64>) {
        let roots: Vec<f64> = self
            .weight
            .iter()
            .zip(model)
            .map(|(weight, model)| weight.sqrt() / model)
            .collect();
        let mut weighted = DMatrix::from_fn(self.measured.len(), columns.len(), |i, j| {
            columns[j][i] * roots[i]
        });
        let mut scales = Vec::new();
        for mut column in weighted.column_iter_mut() {
            let scale = 1.0 / column.norm().max(1e-300);
            column *= scale;
            scales.push(scale);
        }
        let data = DVector::from_iterator(
            self.measured.len(),
            self.measured.iter().zip(&roots).map(|(y, root)| y * root),
        );
        (weighted.tr_mul(&weighted), weighted.tr_mul(&data), scales)
    }

    /// The standard error of the squared white noise, for coefficients that are not zero.
    fn error(&self, columns: &[Vec<f64>], squares: &[f64], model: &[f64], at_zero: &[f64]) -> f64 {
        let free: Vec<usize> = (0..squares.len()).filter(|&i| squares[i] > 0.0).collect();
        let used: Vec<Vec<f64>> = free.iter().map(|&i| columns[i].clone()).collect();
        let (gram, _, scales) = self.equations(&used, model);
        let others = self.others.len();
        let part = free.iter().zip(&scales).map(|(&i, scale)| {
            let own = i.checked_sub(others).and_then(|own| at_zero.get(own));
            own.map_or(0.0, |own| own * scale)
        });
        let part = DVector::from_iterator(free.len(), part);
        let Ok(inverse) = gram.pseudo_inverse(1e-9) else {
            return f64::INFINITY;
        };
        part.dot(&(inverse * &part)).max(0.0).sqrt()
    }

    /// Moves the corner within a factor on either side to the least score (golden section).
    fn refine(&self, response: &mut Response, factor: f64) {
        let family = response.family;
        let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
        let [mut low, mut high] = [response.corner / factor, response.corner * factor].map(f64::ln);
        let mut at = |corner: f64| {
            let found = self.response(family, corner.exp());
            let score = found.as_ref().map_or(f64::INFINITY, |found| found.score);
            if let Some(found) = found
                && found.score < response.score
            {
                *response = found;
            }
            score
        };
        let mut inner = [high - golden * (high - low), low + golden * (high - low)];
        let mut scores = inner.map(&mut at);
        for _ in 0..ROUNDS {
            if scores[0] < scores[1] {
                high = inner[1];
                inner = [high - golden * (high - low), inner[0]];
                scores = [at(inner[0]), scores[0]];
            } else {
                low = inner[0];
                inner = [inner[1], low + golden * (high - low)];
                scores = [scores[1], at(inner[1])];
            }
        }
    }
}

/// Adds a multiple of a column to a sum.
fn add(factor: f64, column: &[f64], sum: &mut [f64]) {
    for (sum, value) in sum.iter_mut().zip(column) {
        *sum += factor * value;
    }
}

/// Whether a term is certain to be no artefact of a wrong filter: a line, or slow noise.
fn adds_beside_filter(term: &Term, interval_s: f64) -> bool {
    let effect = term.effect;
    if crate::known_filter::is_filter(effect) || effect.passes_all() {
        return false;
    }
    let first = effect.parameters().first();
    match first.map(|first| first.unit) {
        None => {
            effect.description().distribution != Distribution::Deterministic
                && effect.name() != "angle_random_walk"
        }
        Some("Hz") => effect.description().distribution == Distribution::Deterministic,
        Some("s") => term.parameters[0] > SLOW * interval_s,
        _ => false,
    }
}
