//! What a plot shows of a comparison.

use super::frame::Frame;
use crate::log::OCTAVES;
use allanite::{
    Comparison, Model,
    effect::{CATALOGUE, Effect},
};
use serde::Serialize;

/// An effect whose share of the model's variance is nowhere as large does not show.
const LEAST_SHARE: f32 = 0.005;

/// A record and a model, octave by octave: deviations in rate units, as exact as a drawing needs.
#[derive(Clone, Debug, Serialize)]
pub struct Figure {
    /// Averaging times, in seconds.
    pub tau_s: Vec<f32>,
    /// Measured deviations.
    pub measured: Vec<f32>,
    /// One standard error below them …
    pub lower: Vec<f32>,
    /// … and above.
    pub upper: Vec<f32>,
    /// The model's.
    pub model: Vec<f32>,
    /// Residuals, in standard errors.
    pub z: Vec<f32>,
    /// The effects that show in the model.
    pub shares: Vec<Share>,
}

/// What an effect contributes to a model.
#[derive(Clone, Debug, Serialize)]
pub struct Share {
    /// The effect.
    pub effect: &'static str,
    /// Its place among the colours: effects that take each other's place have one.
    pub colour: usize,
    /// Its deviations, in rate units.
    pub sigma: Vec<f32>,
}

impl Figure {
    /// The figure of a model beside a record; effects that lie below the frame do not show.
    pub fn new(model: &Model, comparison: &Comparison<OCTAVES>, frame: &Frame) -> Self {
        let octaves = comparison.octaves.iter();
        let roots = |variance: &dyn Fn(&allanite::comparison::ComparedOctave) -> f64| {
            let root = |variance: f64| variance.max(0.0).sqrt() as f32;
            octaves
                .clone()
                .map(|octave| root(variance(octave)))
                .collect()
        };
        // An octave that agrees to the last bit has no error to show.
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

    /// The octave that lies farthest off; 0 of no octaves.
    pub fn worst(&self) -> usize {
        let sizes = self.z.iter().map(|z| z.abs()).enumerate();
        let worst = sizes.max_by(|(_, a), (_, b)| a.total_cmp(b));
        worst.map_or(0, |(at, _)| at)
    }
}

/// An effect's place in the catalogue without mirrors and without those that replace another: these have
/// the other's.
fn colour(effect: &dyn Effect) -> usize {
    let shown = effect.replaces().or(effect.mirror());
    let name = shown.map_or(effect.name(), |shown| shown.name());
    let own = |effect: &&&dyn Effect| effect.replaces().is_none() && effect.mirror().is_none();
    let mut effects = CATALOGUE.iter().filter(own);
    effects.position(|other| other.name() == name).unwrap_or(0)
}
