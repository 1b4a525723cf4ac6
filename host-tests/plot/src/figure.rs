//! The data that a plot shows of a comparison.

use super::{
    frame::Frame,
    lines::{self, Line, Weighted},
    quantity::{Quantity, Row},
};
use allanite::{
    Comparison, Model, Term,
    effect::{CATALOGUE, Distribution, Effect},
    fit::Fit,
    spectrum::{Bin, Spectrum},
};
use allanite_log::{BINS, OCTAVES};
use serde::Serialize;

/// An effect is shown if its share of the model is at least this large somewhere. A smaller one rounds
/// to 0 %.
const LEAST_SHARE: f64 = 0.005;

/// A model that was fitted to a record, and their comparison.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    /// The model.
    pub model: &'a Model,
    /// Its fit.
    pub fit: &'a Fit,
    /// The record beside the model.
    pub comparison: &'a Comparison<OCTAVES, BINS>,
    /// The spectrum of the record.
    pub spectrum: &'a Spectrum<BINS>,
    /// The standard errors of the octaves' measured variances, relative to the variances.
    pub errors: &'a [f64],
    /// Sample interval, in seconds.
    pub interval_s: f64,
}

/// A record and a model octave by octave or bin by bin, in rate units or in rate units per √Hz. Single
/// precision is enough for a drawing.
#[derive(Clone, Debug)]
pub struct Figure {
    /// What is measured.
    pub measured: Measured,
    /// Residuals, in standard errors.
    pub z: Vec<f32>,
    /// What the model predicts at each of the points.
    pub expected: Vec<f32>,
    /// The line of the model.
    pub model: Line,
    /// The effects that are large enough to be shown.
    pub shares: Vec<Share>,
}

/// The points of a figure, with ascending averaging times or frequencies.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Measured {
    /// Averaging times in seconds, or frequencies in Hz.
    pub x: Vec<f32>,
    /// Measured deviations, or roots of densities.
    pub measured: Vec<f32>,
    /// The same less one standard error of the measurement.
    pub lower: Vec<f32>,
    /// The same plus one standard error.
    pub upper: Vec<f32>,
}

/// The contribution of an effect to a model.
#[derive(Clone, Debug, Serialize)]
pub struct Share {
    /// Name of the effect.
    pub effect: &'static str,
    /// Index of its colour. Effects that replace each other share a colour.
    pub colour: usize,
    /// 0 for the first line of a colour, or the number among the other ones, which have colours of their own.
    pub twin: usize,
    /// The frequency of an effect that has one, in Hz.
    pub frequency_hz: Option<f32>,
    /// Deviations, or roots of densities, of the effect.
    pub line: Line,
}

impl Figure {
    /// The figure of a model beside a record. Effects that lie below the frame are left out.
    pub fn new(view: &View, frame: &Frame) -> Self {
        let rows = frame.quantity.rows(view.comparison);
        let errors = match frame.quantity {
            Quantity::Deviation => view.errors.to_vec(),
            Quantity::Density => {
                let bins = view.comparison.bins.iter();
                let mut bins: Vec<&Bin> = bins.map(|compared| &compared.bin).collect();
                bins.sort_by(|one, other| one.frequency_hz.total_cmp(&other.frequency_hz));
                bins.into_iter().map(relative_error).collect()
            }
        };
        let weighted = Weighted {
            model: view.model,
            squares: &view.fit.squares(),
            interval_s: view.interval_s,
        };
        let octaves = &view.comparison.octaves;
        let ends = octaves.first().zip(octaves.last());
        let pieces = match frame.quantity {
            Quantity::Deviation => ends
                .map(|(first, last)| weighted.variances(first.m, last.m))
                .into_iter()
                .collect(),
            Quantity::Density => weighted.densities(view.spectrum),
        };
        let terms = view.model.terms().iter().enumerate();
        let shown = terms.filter(|(at, _)| {
            let mut pieces = pieces.iter();
            pieces.any(|piece| piece.shows(*at, LEAST_SHARE, frame.y.low))
        });
        // The twins are those of the whole model, so that a line keeps its colour where another one is too small.
        let terms_of_model = view.model.terms().iter();
        let colours: Vec<usize> = terms_of_model.map(|term| colour(term.effect)).collect();
        let twins = twins(&colours);
        let shares = shown.map(|(at, term)| Share {
            effect: term.effect.name(),
            colour: colours[at],
            twin: twins[at],
            frequency_hz: frequency_hz(term).map(short),
            line: lines::effect(&pieces, at),
        });
        Self {
            measured: Measured::new(&rows, &errors),
            z: rows.iter().map(|row| short(row.z)).collect(),
            expected: rows
                .iter()
                .map(|row| short(row.model.max(0.0).sqrt()))
                .collect(),
            shares: shares.collect(),
            model: lines::model(&pieces),
        }
    }

    /// Index of the octave or the bin with the largest residual, or 0 if there are none.
    pub fn worst(&self) -> usize {
        let sizes = self.z.iter().map(|z| z.abs()).enumerate();
        let worst = sizes.max_by(|(_, a), (_, b)| a.total_cmp(b));
        worst.map_or(0, |(at, _)| at)
    }
}

impl Measured {
    fn new(rows: &[Row], errors: &[f64]) -> Self {
        let roots = |sign: f64| -> Vec<f32> {
            // Without an error, a bar has no length.
            let errors = errors.iter().copied().chain(std::iter::repeat(0.0));
            let squares = rows.iter().zip(errors);
            squares
                .map(|(row, error)| {
                    let error = if error.is_finite() { error } else { 0.0 };
                    short((row.measured * (1.0 + sign * error)).max(0.0).sqrt())
                })
                .collect()
        };
        Self {
            x: rows.iter().map(|row| short(row.x)).collect(),
            measured: roots(0.0),
            lower: roots(-1.0),
            upper: roots(1.0),
        }
    }
}

/// The standard error of a density relative to the density, from the scatter of the segments' powers: their spectral
/// kurtosis `SK` and their number `n` give the unbiased relative variance `SK n/(n+1)` of one segment. For Gaussian
/// noise it is 1.
pub fn relative_error(bin: &Bin) -> f64 {
    let n = f64::from(bin.segments);
    (bin.spectral_kurtosis * n / (n + 1.0) / bin.effective_segments()).sqrt()
}

/// A number with six digits.
fn short(value: f64) -> f32 {
    format!("{value:.5e}").parse().unwrap_or(f32::NAN)
}

/// For each line of these colours, 0 if it is the first of its colour, or else its number among all that are not, from 1.
fn twins(colours: &[usize]) -> Vec<usize> {
    let mut count = 0;
    let number = |(at, colour): (usize, &usize)| {
        if !colours[..at].contains(colour) {
            return 0;
        }
        count += 1;
        count
    };
    colours.iter().enumerate().map(number).collect()
}

/// The frequency of a line or a resonance.
fn frequency_hz(term: &Term) -> Option<f64> {
    let mut parameters = term.effect.parameters().iter().zip(term.parameters);
    let (_, value) = parameters.find(|(parameter, _)| parameter.name == "frequency_hz")?;
    Some(value)
}

/// Index of an effect's colour: its place among those effects of the catalogue that neither mirror nor
/// replace another one, and do not drift. An effect that does so has the colour of the other effect, or of the one that
/// does not drift.
fn colour(effect: &dyn Effect) -> usize {
    let drifts = |effect: &dyn Effect| effect.description().distribution == Distribution::Swept;
    let steady = effect.description().special_case;
    let steady = steady.filter(|_| drifts(effect));
    let shown = effect.replaces().or(effect.mirror()).or(steady);
    let name = shown.map_or(effect.name(), |shown| shown.name());
    let own = |effect: &&&dyn Effect| {
        effect.replaces().is_none() && effect.mirror().is_none() && !drifts(**effect)
    };
    let mut effects = CATALOGUE.iter().filter(own);
    // One that is not in the catalogue has the colour after all others.
    let after = effects.clone().count();
    effects
        .position(|other| other.name() == name)
        .unwrap_or(after)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_effect_that_is_not_in_the_catalogue_has_a_colour_of_its_own() {
        let known = CATALOGUE.map(colour);
        let most = known.into_iter().max().expect("an effect");
        assert_eq!(most + 2, crate::sheet::EFFECTS.len());
    }

    #[test]
    fn lines_of_one_colour_are_told_apart() {
        assert_eq!(twins(&[1, 2, 1, 3, 2, 1]), [0, 0, 1, 0, 2, 3]);
    }

    #[test]
    fn the_error_of_a_density_is_that_of_the_mean_of_its_segments() {
        // Powers of segments, most of them small and a few large, as in a record with bursts.
        let powers: Vec<f64> = (0..40)
            .map(|k| {
                if k % 9 == 0 {
                    7.0
                } else {
                    0.5 + 0.03 * f64::from(k)
                }
            })
            .collect();
        let n = powers.len() as f64;
        let (sum, squares) = powers.iter().fold((0.0, 0.0), |(sum, squares), power| {
            (sum + power, squares + power * power)
        });
        let bin = Bin {
            block: 1,
            index: 4,
            frequency_hz: 6.25,
            density: sum / n,
            segments: 40,
            spectral_kurtosis: (n + 1.0) / (n - 1.0) * (n * squares / (sum * sum) - 1.0),
        };
        let deviations = powers.iter().map(|power| (power - sum / n).powi(2));
        let variance = deviations.sum::<f64>() / (n - 1.0);
        // Segments that overlap by half count as 18/19 of as many that do not.
        let error = (variance / (n * 18.0 / 19.0)).sqrt() / (sum / n);
        assert!((relative_error(&bin) / error - 1.0).abs() < 1e-12);
    }
}
