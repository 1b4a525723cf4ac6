//! A model fitted to one record and judged by others.

use super::{question::Question, record::LoadedRecord};
use crate::{
    command::{
        compare::{check_visible, compared::Compared},
        input::record::library_failure,
    },
    confidence::relative_errors,
    failure::{Failure, Place},
    log::{BINS, OCTAVES},
    plot::{Figure, Frame, Quantity, View},
};
use allanite::{
    Comparison,
    fit::{Fit, Options},
};

/// A model, its fit to a record, and the records that judge it.
pub(super) struct Fitted<'a> {
    pub(super) record: &'a LoadedRecord,
    pub(super) compared: Compared,
    /// The other records, each with its number and its comparison with the model.
    pub(super) judged: Vec<(usize, &'a LoadedRecord, Comparison<OCTAVES, BINS>)>,
}

impl<'a> Fitted<'a> {
    /// Fits the model of a question with the functions of `compare`.
    ///
    /// # Errors
    /// Those of `compare`, and when records of different units are to be compared.
    pub(super) fn of(records: &'a [LoadedRecord], question: &Question) -> Result<Self, Failure> {
        let record = &records[question.record];
        let fail =
            |record: &LoadedRecord, error| library_failure(&record.path, &record.axis.axis, error);
        let model = question.model()?;
        check_visible(&model, &record.curve)?;
        let compared = Compared::new(record.axis.clone(), &model, None);
        let compared = compared.map_err(|error| fail(record, error))?;
        let judge = |number: &usize| {
            let other = &records[*number];
            if other.axis.unit != record.axis.unit {
                let what = format!(
                    "{} is in {}, not in {}",
                    other.name(),
                    other.axis.unit,
                    record.axis.unit
                );
                return Err(Place::file(&other.path).failure(what, "compare records of one unit"));
            }
            let observed = allanite::Record::new(&other.curve, &other.spectrum);
            let (model, fit) = (&compared.model, &compared.fit);
            let tolerance = Options::default().tolerance;
            let comparison = Comparison::held_out(observed, model, fit, tolerance);
            let comparison = comparison.map_err(|error| fail(other, error))?;
            Ok((*number, other, comparison))
        };
        let judged = question
            .judged
            .iter()
            .map(judge)
            .collect::<Result<_, _>>()?;
        Ok(Self {
            record,
            compared,
            judged,
        })
    }

    /// The fit.
    pub(super) fn fit(&self) -> &Fit {
        &self.compared.fit
    }

    /// The frames of what the records have. They have room for the five terms too, so that they rest while one drags.
    pub(super) fn frames(&self) -> Vec<Frame> {
        let others = self.judged.iter().map(|(_, _, comparison)| comparison);
        let own = [&self.record.five, &self.compared.comparison];
        let comparisons: Vec<_> = own.into_iter().chain(others).collect();
        let has_bins = comparisons
            .iter()
            .any(|comparison| !comparison.bins.is_empty());
        let shown = Quantity::ALL.into_iter();
        shown
            .filter(|quantity| *quantity == Quantity::Deviation || has_bins)
            .map(|quantity| Frame::of(quantity, comparisons.iter().copied()))
            .collect()
    }

    /// The record and the model in each of these frames.
    pub(super) fn figures(&self, frames: &[Frame]) -> Vec<Figure> {
        let Compared {
            comparison,
            spectrum,
            ..
        } = &self.compared;
        self.view(self.record, comparison, spectrum, frames)
    }

    /// A record that judges the model, and the model, in each of these frames.
    pub(super) fn judged_figures(&self, judged: usize, frames: &[Frame]) -> Vec<Figure> {
        let (_, record, comparison) = &self.judged[judged];
        self.view(record, comparison, &record.spectrum, frames)
    }

    fn view(
        &self,
        record: &LoadedRecord,
        comparison: &Comparison<OCTAVES, BINS>,
        spectrum: &allanite::spectrum::Spectrum<BINS>,
        frames: &[Frame],
    ) -> Vec<Figure> {
        let (model, fit) = (&self.compared.model, self.fit());
        let view = View {
            model,
            fit,
            comparison,
            spectrum,
            errors: &relative_errors(&record.curve, model, fit),
            interval_s: record.curve.interval_s(),
        };
        frames
            .iter()
            .map(|frame| Figure::new(&view, frame))
            .collect()
    }
}
