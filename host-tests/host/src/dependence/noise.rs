//! The noise beside which a dependence is judged.

use allanite::{
    Curve, Error, Model, Record,
    covariate::CrossCurve,
    curve::Point,
    fit::{Options, fit},
    spectrum::Spectrum,
};
use allanite_log::{BINS, OCTAVES};

/// The Allan variance of a fitted model in every octave of a curve, in rate units squared.
#[derive(Clone, Debug)]
pub struct Noise(Vec<f64>);

impl Noise {
    /// The noise of a model that is fitted to a curve and a spectrum.
    ///
    /// # Errors
    /// Those of a fit.
    pub fn fitted(
        curve: &Curve<OCTAVES>,
        spectrum: &Spectrum<BINS>,
        model: &Model,
    ) -> Result<Self, Error> {
        let fit = fit(Record::new(curve, spectrum), model, Options::default())?;
        let squares = fit.squares();
        let variance = |point: &Point| model.variance(&squares, point.m, curve.interval_s());
        Ok(Self(curve.points().iter().map(variance).collect()))
    }

    /// The variance in an octave.
    pub fn at(&self, octave: usize) -> f64 {
        self.0.get(octave).copied().unwrap_or(f64::INFINITY)
    }

    /// The product of a gyro with a covariate and the square of the covariate, each octave in proportion to what it
    /// tells: `Σ (n/m) C/σ²` of a record of `samples`.
    pub fn sums(&self, cross: &CrossCurve<OCTAVES>, samples: f64) -> (f64, f64) {
        let points = cross.points().iter().enumerate();
        points.fold((0.0, 0.0), |(product, square), (k, point)| {
            let weight = samples / f64::from(point.m) / self.at(k);
            (
                product + weight * point.covariance,
                square + weight * point.variance,
            )
        })
    }
}
