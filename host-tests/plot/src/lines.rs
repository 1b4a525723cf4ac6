//! The lines of a model: its Allan variances between the octaves, and its densities between the bins.

use allanite::{
    Model, Term,
    effect::{Behind, Effect, SampledShape},
    spectrum::{Spectrum, WHITE_DENSITY},
};
use allanite_log::BINS;
use serde::Serialize;
use std::f64::consts::TAU;

/// The number of points from one octave to the next.
const PER_OCTAVE: u32 = 8;
/// The number of points from one bin to the next.
const PER_BIN: u32 = 2;
/// A point is left out where the line between its neighbours is nearer than this, relative to its value. It is less
/// than a tenth of a pixel.
const NEAR: f64 = 1e-3;

/// A line: its pieces, each of which is a list of points.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Line(pub Vec<Vec<[f32; 2]>>);

/// What the effects of a model add to the squares of a plot along a piece of its axis.
pub(super) struct Piece {
    /// Averaging times or frequencies.
    x: Vec<f64>,
    /// Variances or densities of each effect, in the order of the model.
    effects: Vec<Vec<f64>>,
}

impl Piece {
    fn total(&self) -> Vec<f64> {
        let at = |place: usize| self.effects.iter().map(|effect| effect[place]).sum();
        (0..self.x.len()).map(at).collect()
    }

    /// Whether an effect has at least this share of the model at a point where its root is at least `low`.
    pub(super) fn shows(&self, effect: usize, share: f64, low: f64) -> bool {
        let mut pairs = self.effects[effect].iter().zip(self.total());
        pairs.any(|(square, total)| *square >= share * total && square.sqrt() >= low)
    }
}

/// The line of the whole model.
pub(super) fn model(pieces: &[Piece]) -> Line {
    let line = |piece: &Piece| roots(&piece.x, &piece.total());
    Line(pieces.iter().map(line).collect())
}

/// The line of one effect.
pub(super) fn effect(pieces: &[Piece], effect: usize) -> Line {
    let line = |piece: &Piece| roots(&piece.x, &piece.effects[effect]);
    Line(pieces.iter().map(line).collect())
}

/// A model with squared coefficients, at a sample interval in seconds.
pub(super) struct Weighted<'a> {
    pub(super) model: &'a Model,
    pub(super) squares: &'a [f64],
    pub(super) interval_s: f64,
}

impl Weighted<'_> {
    fn terms(&self) -> impl Iterator<Item = (&Term, f64, SampledShape)> {
        let terms = self.model.terms().iter().zip(self.squares);
        terms.map(|(term, square)| (term, *square, term.sampled_shape(self.interval_s)))
    }

    /// The Allan variances from one averaging factor to another, both of which are powers of two.
    pub(super) fn variances(&self, first: u32, last: u32) -> Piece {
        let octaves = (last / first.max(1)).max(1).ilog2();
        let factors: Vec<f64> = (0..=octaves * PER_OCTAVE)
            .map(|step| f64::from(first) * (f64::from(step) / f64::from(PER_OCTAVE)).exp2())
            .collect();
        let effects = self.terms().enumerate().map(|(i, (term, square, shape))| {
            let at = |m: f64| square * self.model.unit_variance(i, m, self.interval_s);
            if is_random(term.effect, &shape) {
                return factors.iter().map(|m| at(*m)).collect();
            }
            // A sinusoid turns many times between two octaves; a ramp is a power of the time anyway.
            let octaves: Vec<f64> = factors
                .iter()
                .step_by(PER_OCTAVE as usize)
                .map(|m| at(*m))
                .collect();
            between(&octaves, PER_OCTAVE)
        });
        Piece {
            effects: effects.collect(),
            x: factors.iter().map(|m| m * self.interval_s).collect(),
        }
    }

    /// The densities of each level of a spectrum.
    pub(super) fn densities(&self, spectrum: &Spectrum<BINS>) -> Vec<Piece> {
        let expected: Vec<Vec<f64>> = self
            .terms()
            .map(|(term, square, _)| {
                let densities = spectrum.expected(term.effect, term.parameters);
                densities.iter().map(|density| square * density).collect()
            })
            .collect();
        let mut start = 0;
        let mut pieces = Vec::new();
        for level in spectrum.levels() {
            let bins = start..start + level.len();
            start = bins.end;
            let Some(first) = level.first() else { continue };
            let per_index = first.frequency_hz / f64::from(first.index);
            let places = (level.len() as u32 - 1) * PER_BIN;
            let indices: Vec<f64> = (0..=places)
                .map(|step| f64::from(first.index) + f64::from(step) / f64::from(PER_BIN))
                .collect();
            let effects = self.terms().zip(&expected).enumerate();
            let effects = effects.map(|(i, ((term, square, shape), expected))| {
                let mut line = between(&expected[bins.clone()], PER_BIN);
                // The density of a ramp exists at whole numbers of periods only: elsewhere the window shows the jump
                // from the ramp's end to its start.
                if square > 0.0 && !is_ramp(term.effect, &shape) {
                    let window = Window::new(term.effect, &shape, spectrum.segment(), first.block);
                    let places = line.iter_mut().zip(&indices).enumerate();
                    for (_, (density, index)) in
                        places.filter(|(place, _)| place % PER_BIN as usize != 0)
                    {
                        let exact = square * window.density(*index);
                        // Far from a sinusoid nothing remains but rounding and leakage.
                        if exact > 0.0 {
                            *density = exact;
                        }
                    }
                }
                if let Some(filter) = self.model.filter_of(i) {
                    let shape = filter.sampled_shape(self.interval_s);
                    let window = |effect: &dyn Effect| {
                        Window::new(effect, &shape, spectrum.segment(), first.block)
                    };
                    if let Some(behind) = Behind::new(term.effect, filter.effect, &shape) {
                        let window = window(&behind);
                        let densities = indices.iter().map(|index| window.density(*index));
                        line = densities.map(|density| square * density.max(0.0)).collect();
                    } else {
                        let window = window(filter.effect);
                        for (density, index) in line.iter_mut().zip(&indices) {
                            *density *= window.density(*index).max(0.0) / f64::from(WHITE_DENSITY);
                        }
                    }
                }
                line
            });
            pieces.push(Piece {
                effects: effects.collect(),
                x: indices.iter().map(|index| index * per_index).collect(),
            });
        }
        pieces
    }
}

fn is_random(effect: &dyn Effect, shape: &SampledShape) -> bool {
    effect.response(1.0, shape).is_none()
}

fn is_ramp(effect: &dyn Effect, shape: &SampledShape) -> bool {
    let response = effect.response(1.0, shape);
    response.is_some_and(|response| response.phase == 0.0)
}

/// Values with points in between, which are on the straight lines between their logarithms.
fn between(values: &[f64], per_step: u32) -> Vec<f64> {
    let mut all = Vec::new();
    for pair in values.windows(2) {
        let [from, to] = [pair[0], pair[1]].map(f64::ln);
        for step in 0..per_step {
            let share = f64::from(step) / f64::from(per_step);
            // A value of zero has no logarithm.
            let value = match step {
                0 => pair[0],
                _ if pair[0] > 0.0 && pair[1] > 0.0 => (from + share * (to - from)).exp(),
                _ => 0.0,
            };
            all.push(value);
        }
    }
    all.extend(values.last());
    all
}

/// The expected density of an effect at any number of periods in a segment of Hann-windowed block means.
///
/// It is Welch's (1967) expectation with the semivariogram of the block means, as in the library's
/// [`expected_densities`](allanite::spectrum::expected_densities), which has it at whole numbers of periods.
struct Window {
    /// The semivariogram less its value in the middle, times the window's products, times the scale.
    terms: Vec<f64>,
}

impl Window {
    fn new(effect: &dyn Effect, shape: &SampledShape, length: u32, block: u32) -> Self {
        let turn = TAU / f64::from(length);
        let weight = |j: u32| 0.5 - 0.5 * (turn * f64::from(j)).cos();
        let weights: Vec<f64> = (0..length).map(weight).collect();
        let product = |l: usize| -> f64 {
            let pairs = weights.iter().zip(&weights[l..]);
            pairs.map(|(one, other)| one * other).sum()
        };
        let mut variogram = vec![0.0; weights.len()];
        effect.variogram(f64::from(block), shape, &mut variogram[1..]);
        // The window ignores a constant at whole numbers of periods, and nearly ignores it elsewhere.
        let middle = variogram[weights.len() / 8];
        let per_block = f64::from(block) * shape.interval_s;
        let scale = -4.0 * per_block / product(0);
        let terms = variogram.iter().enumerate().map(|(l, value)| {
            let sides = if l == 0 { 0.5 } else { 1.0 };
            scale * sides * (value - middle) * product(l)
        });
        Self {
            terms: terms.collect(),
        }
    }

    fn density(&self, periods: f64) -> f64 {
        let turn = TAU * periods / self.terms.len() as f64;
        let terms = self.terms.iter().enumerate();
        terms.map(|(l, term)| term * (turn * l as f64).cos()).sum()
    }
}

/// The roots of squares over x. Points that lie on the line between their neighbours are left out, and so are those
/// without a root.
fn roots(x: &[f64], squares: &[f64]) -> Vec<[f32; 2]> {
    let points: Vec<[f64; 2]> = x
        .iter()
        .zip(squares)
        .filter(|(_, square)| **square > 0.0)
        .map(|(x, square)| [x.ln(), 0.5 * square.ln()])
        .collect();
    let mut kept = Vec::new();
    keep(&points, &mut kept);
    kept.extend(points.last());
    kept.iter().map(|point| point.map(short)).collect()
}

/// Keeps the first point and those that a straight line to the last one would miss (Douglas & Peucker 1973, with
/// vertical distances).
fn keep(points: &[[f64; 2]], kept: &mut Vec<[f64; 2]>) {
    let ([first, .., last], inner) = (points, points.len().saturating_sub(1)) else {
        return;
    };
    let slope = (last[1] - first[1]) / (last[0] - first[0]);
    let off = |at: usize| (points[at][1] - first[1] - slope * (points[at][0] - first[0])).abs();
    let farthest = (1..inner).max_by(|one, other| off(*one).total_cmp(&off(*other)));
    match farthest.filter(|at| off(*at) > NEAR) {
        Some(at) => {
            keep(&points[..=at], kept);
            keep(&points[at..], kept);
        }
        None => kept.push(*first),
    }
}

/// The number with this logarithm, with few digits.
fn short(logarithm: f64) -> f32 {
    format!("{:.4e}", logarithm.exp()).parse().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use allanite::spectrum::Bin;

    /// A level of every block, with a density that is not used.
    fn spectrum() -> Spectrum<BINS> {
        let bins = [1_u32, 8, 64].into_iter().flat_map(|block| {
            (4..32).map(move |index| Bin {
                block,
                index,
                frequency_hz: 0.0,
                density: 1.0,
                segments: 100,
                spectral_kurtosis: 1.0,
            })
        });
        Spectrum::new(100.0, 64, bins).unwrap()
    }

    #[test]
    fn densities_between_bins_continue_those_of_the_bins() {
        let spectrum = spectrum();
        for effect in allanite::effect::EXPLAINED {
            let parameters = effect.typical_shapes().first().copied().unwrap_or_default();
            let shape = SampledShape {
                interval_s: 0.01,
                parameters,
            };
            if is_ramp(effect, &shape) {
                continue;
            }
            let expected = spectrum.expected(effect, parameters);
            let largest = expected.iter().copied().fold(0.0, f64::max);
            for (bin, expected) in spectrum.bins().iter().zip(&expected) {
                let window = Window::new(effect, &shape, 64, bin.block);
                let density = window.density(bin.index.into());
                let off = (density - expected).abs();
                assert!(
                    off <= 1e-6 * expected + 1e-9 * largest,
                    "{off:e} {expected:e}"
                );
            }
        }
    }

    #[test]
    fn variances_at_octaves_are_those_of_the_model() {
        let model = Model::ieee_952();
        let squares = [1e-8, 1e-4, 1e-5, 1e-6, 1e-9];
        let weighted = Weighted {
            model: &model,
            squares: &squares,
            interval_s: 0.01,
        };
        let piece = weighted.variances(1, 1 << 16);
        let total = piece.total();
        for octave in 0..=16 {
            let at = octave * PER_OCTAVE as usize;
            let expected = model.variance(&squares, 1 << octave, 0.01);
            assert!((total[at] / expected - 1.0).abs() < 1e-12);
            assert!((piece.x[at] / (0.01 * f64::from(1 << octave)) - 1.0).abs() < 1e-12);
        }
        // Half an octave on, angle random walk has fallen by the root of two.
        let walk = &piece.effects[1];
        let half = walk[8] / walk[8 + PER_OCTAVE as usize / 2];
        assert!((half - 2_f64.sqrt()).abs() < 1e-9, "{half}");
    }

    #[test]
    fn lines_leave_out_what_a_straight_line_shows() {
        let x: Vec<f64> = (0..=40).map(|k| f64::from(k).exp2()).collect();
        let power: Vec<f64> = x.iter().map(|x| 3.0 / x).collect();
        assert_eq!(roots(&x, &power).len(), 2);
        let bent: Vec<f64> = x.iter().map(|x| 1.0 / x + 1e-6).collect();
        let line = roots(&x, &bent);
        assert!((5..30).contains(&line.len()), "{}", line.len());
        for [at, root] in &line {
            let exact = (1.0 / f64::from(*at) + 1e-6).sqrt();
            assert!((f64::from(*root) / exact - 1.0).abs() < 2e-4);
        }
    }
}
