//! The data that a plot shows of a comparison.

use super::frame::Frame;
use crate::log::{BINS, OCTAVES};
use allanite::{
    Comparison, Model,
    effect::{CATALOGUE, Effect},
};
use serde::Serialize;

/// An effect is shown if its share of the model's variance is at least this large in some octave. A
/// smaller one rounds to 0 %.
const LEAST_SHARE: f32 = 0.005;

/// A record and a model octave by octave, with deviations in rate units. Single precision is enough for
/// a drawing.
#[derive(Clone, Debug, Serialize)]
pub struct Figure {
    /// Averaging times, in seconds.
    pub tau_s: Vec<f32>,
    /// Measured deviations.
    pub measured: Vec<f32>,
    /// The measured deviations less one standard error.
    pub lower: Vec<f32>,
    /// The measured deviations plus one standard error.
    pub upper: Vec<f32>,
    /// Deviations of the model.
    pub model: Vec<f32>,
    /// Residuals, in standard errors.
    pub z: Vec<f32>,
    /// The effects that are large enough to be shown.
    pub shares: Vec<Share>,
}

/// The contribution of an effect to a model.
#[derive(Clone, Debug, Serialize)]
pub struct Share {
    /// Name of the effect.
    pub effect: &'static str,
    /// Index of its colour. Effects that replace each other share a colour.
    pub colour: usize,
    /// Deviations of the effect, in rate units.
    pub sigma: Vec<f32>,
}

impl Figure {
    /// The figure of a model beside a record. Effects that lie below the frame are left out.
    pub fn new(model: &Model, comparison: &Comparison<OCTAVES, BINS>, frame: &Frame) -> Self {
        let octaves = comparison.octaves.iter();
        let roots = |variance: &dyn Fn(&allanite::comparison::ComparedOctave) -> f64| {
            let root = |variance: f64| variance.max(0.0).sqrt() as f32;
            octaves
                .clone()
                .map(|octave| root(variance(octave)))
                .collect()
        };
        // The standard error of an octave that agrees to the last bit is NaN; it is drawn as zero.
        let error = |octave: &allanite::comparison::ComparedOctave| match octave.standard_error() {
            error if error.is_finite() => error,
            _ => 0.0,
        };
        let share = |(at, term): (usize, &allanite::Term)| Share {
            effect: term.effect.name(),
            colour: colour(term.effect),
            sigma: roots(&|octave| octave.model * f64::from(octave.shares[at])),
        };
        let shows = |at: usize| {
            octaves.clone().any(|octave| {
                let share = octave.shares[at];
                let sigma = (octave.model * f64::from(share)).sqrt();
                share >= LEAST_SHARE && sigma >= frame.sigma.low
            })
        };
        let terms = model.terms().iter().enumerate();
        Self {
            tau_s: octaves.clone().map(|octave| octave.tau_s as f32).collect(),
            measured: roots(&|octave| octave.measured),
            lower: roots(&|octave| octave.measured - error(octave)),
            upper: roots(&|octave| octave.measured + error(octave)),
            model: roots(&|octave| octave.model),
            z: octaves.clone().map(|octave| octave.z as f32).collect(),
            shares: terms.filter(|(at, _)| shows(*at)).map(share).collect(),
        }
    }

    /// Index of the octave with the largest residual, or 0 if there are no octaves.
    pub fn worst(&self) -> usize {
        let sizes = self.z.iter().map(|z| z.abs()).enumerate();
        let worst = sizes.max_by(|(_, a), (_, b)| a.total_cmp(b));
        worst.map_or(0, |(at, _)| at)
    }
}

/// Index of an effect's colour: its place among those effects of the catalogue that neither mirror nor
/// replace another one. An effect that does so has the colour of the other effect.
fn colour(effect: &dyn Effect) -> usize {
    let shown = effect.replaces().or(effect.mirror());
    let name = shown.map_or(effect.name(), |shown| shown.name());
    let own = |effect: &&&dyn Effect| effect.replaces().is_none() && effect.mirror().is_none();
    let mut effects = CATALOGUE.iter().filter(own);
    effects.position(|other| other.name() == name).unwrap_or(0)
}
