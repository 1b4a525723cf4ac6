//! A model fitted to an axis, and its comparison with the record.

use allanite::{
    Comparison, Curve, Error, Model, Record,
    diagnosis::fit_shapes,
    fit::{Fit, Options, fit},
    spectrum::Spectrum,
};
use allanite_host::curve_file::AxisCurve;
use allanite_log::{BINS, OCTAVES};

/// One axis, the model that was fitted to it, and the comparison octave by octave.
pub(in crate::command) struct Compared {
    pub(in crate::command) axis: AxisCurve,
    pub(in crate::command) model: Model,
    pub(in crate::command) fit: Fit,
    /// The comparison with the held-out part, or with the fitted record if nothing was held out.
    pub(in crate::command) comparison: Comparison<OCTAVES, BINS>,
    /// The spectrum of what is compared.
    pub(in crate::command) spectrum: Spectrum<BINS>,
    pub(in crate::command) held_out: Option<HeldOut>,
}

/// The part of a record that no coefficient was fitted to.
pub(in crate::command) struct HeldOut {
    pub(in crate::command) axis: AxisCurve,
    /// Rms misfit, in percent, in the part that was fitted.
    pub(in crate::command) fitted_rms_percent: f64,
}

impl Compared {
    /// Fits a model to an axis, shapes included, and compares it with the same axis or with the part that was held
    /// out.
    pub(in crate::command) fn new(
        axis: AxisCurve,
        model: &Model,
        held_out: Option<AxisCurve>,
    ) -> Result<Self, Error> {
        let observed = (axis.curve()?, axis.spectrum()?);
        Self::with_part(axis, observed, model, held_out)
    }

    /// Fits a model to a curve and a spectrum of an axis, from which something may have been subtracted, and compares it
    /// with both.
    pub(in crate::command) fn beside(
        axis: AxisCurve,
        observed: (Curve<OCTAVES>, Spectrum<BINS>),
        model: &Model,
    ) -> Result<Self, Error> {
        Self::with_part(axis, observed, model, None)
    }

    fn with_part(
        axis: AxisCurve,
        (curve, spectrum): (Curve<OCTAVES>, Spectrum<BINS>),
        model: &Model,
        held_out: Option<AxisCurve>,
    ) -> Result<Self, Error> {
        let options = Options::default();
        let (model, fit, own) = fitted(Record::new(&curve, &spectrum), model)?;
        let (comparison, spectrum, held_out) = match held_out {
            None => (own, spectrum, None),
            Some(axis) => {
                let tolerance = options.tolerance;
                let (curve, spectrum) = (axis.curve()?, axis.spectrum()?);
                let observed = Record::new(&curve, &spectrum);
                let comparison = Comparison::held_out(observed, &model, &fit, tolerance)?;
                let held_out = HeldOut {
                    axis,
                    fitted_rms_percent: own.rms_percent,
                };
                (comparison, spectrum, Some(held_out))
            }
        };
        Ok(Self {
            axis,
            model,
            fit,
            comparison,
            spectrum,
            held_out,
        })
    }
}

/// Fits a model to a record, shapes included, and compares it with the same record. Returns the model with its shapes.
///
/// # Errors
/// Those of the fits.
pub(in crate::command) fn fitted(
    record: Record<'_, OCTAVES, BINS>,
    model: &Model,
) -> Result<(Model, Fit, Comparison<OCTAVES, BINS>), Error> {
    let options = Options::default();
    let model = fit_shapes(record, model, options.tolerance)?;
    let fit = fit(record, &model, options)?;
    let comparison = Comparison::new(record, &model, &fit)?;
    Ok((model, fit, comparison))
}
