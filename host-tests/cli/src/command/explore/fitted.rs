//! A model fitted to one record and judged by others.

use super::{question::Question, record::SessionRecord};
use crate::command::input::record::library_failure;
use allanite::{
    Comparison, Curve, Model, Record,
    fit::{Fit, Options},
    spectrum::Spectrum,
};
use allanite_host::{
    compare::{compared::fitted, visible::check_visible},
    confidence::relative_errors,
};
use allanite_log::{
    BINS, OCTAVES,
    failure::{Failure, Place},
};
use allanite_plot::{Figure, Frame, Quantity, View};

/// A model, its fit to a record, and the records that judge it.
pub(super) struct Fitted<'a> {
    pub(super) record: &'a SessionRecord,
    /// All records of the session.
    pub(super) records: &'a [SessionRecord],
    pub(super) model: Model,
    pub(super) fit: Fit,
    pub(super) curve: Curve<OCTAVES>,
    spectrum: Spectrum<BINS>,
    pub(super) comparison: Comparison<OCTAVES, BINS>,
    /// The record as it is beside the five terms. The frames of all figures have room for it, so that they rest while the
    /// model changes.
    five: Comparison<OCTAVES, BINS>,
    /// The other records.
    pub(super) judged: Vec<Judged<'a>>,
    taken_out: bool,
}

/// A record beside a model that was fitted to another one.
pub(super) struct Judged<'a> {
    /// Its number among all records.
    pub(super) number: usize,
    pub(super) record: &'a SessionRecord,
    pub(super) curve: Curve<OCTAVES>,
    spectrum: Spectrum<BINS>,
    pub(super) comparison: Comparison<OCTAVES, BINS>,
}

impl<'a> Fitted<'a> {
    /// Fits the model of a question with the functions of `compare`.
    ///
    /// # Errors
    /// Those of `compare`, and when records of different units are to be compared.
    pub(super) fn of(records: &'a [SessionRecord], question: &Question) -> Result<Self, Failure> {
        let record = &records[question.record];
        let fail = |record: &SessionRecord, error| {
            library_failure(record.path(), &record.axis.axis, error)
        };
        let asked = question.model()?;
        let (curve, spectrum) = record
            .observed(question.taken_out)
            .map_err(|error| fail(record, error))?;
        check_visible(&asked, &curve)?;
        let (model, fit, comparison) =
            fitted(Record::new(&curve, &spectrum), &asked).map_err(|error| fail(record, error))?;
        let five = || {
            let (curve, spectrum) = record.observed(false)?;
            let (_, _, five) = fitted(Record::new(&curve, &spectrum), &Model::ieee_952())?;
            Ok(five)
        };
        let five = five().map_err(|error| fail(record, error))?;
        let judge = |&number: &usize| {
            let other = &records[number];
            if other.axis.unit != record.axis.unit {
                let what = format!(
                    "{} is in {}, not in {}",
                    other.name(),
                    other.axis.unit,
                    record.axis.unit
                );
                return Err(Place::file(other.path()).failure(what, "compare records of one unit"));
            }
            let (curve, spectrum) = other
                .observed(question.taken_out)
                .map_err(|error| fail(other, error))?;
            let tolerance = Options::default().tolerance;
            let observed = Record::new(&curve, &spectrum);
            let comparison = Comparison::held_out(observed, &model, &fit, tolerance)
                .map_err(|error| fail(other, error))?;
            Ok(Judged {
                number,
                record: other,
                curve,
                spectrum,
                comparison,
            })
        };
        let judged = question
            .judged
            .iter()
            .map(judge)
            .collect::<Result<_, _>>()?;
        Ok(Self {
            record,
            records,
            model,
            fit,
            curve,
            spectrum,
            comparison,
            five,
            judged,
            taken_out: question.taken_out,
        })
    }

    /// The covariates whose share is taken out of the record; `None` if nothing is.
    pub(super) fn taken_out(&self) -> Option<&'a str> {
        let taken_out = self.record.taken_out.as_ref().filter(|_| self.taken_out);
        taken_out.map(|taken_out| taken_out.words.as_str())
    }

    /// χ² of the record, and what follows its covariates as long as it is not taken out.
    pub(super) fn error(&self) -> f64 {
        let left = self.record.taken_out.as_ref().filter(|_| !self.taken_out);
        self.comparison.chi_squared + left.map_or(0.0, |left| left.chi2)
    }

    /// The frames of what the records have. They have room for the five terms too, so that they rest while one drags.
    pub(super) fn frames(&self) -> Vec<Frame> {
        let others = self.judged.iter().map(|one| &one.comparison);
        let own = [&self.five, &self.comparison];
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
        self.view((&self.curve, &self.spectrum), &self.comparison, frames)
    }

    /// A record that judges the model, and the model, in each of these frames.
    pub(super) fn judged_figures(&self, judged: usize, frames: &[Frame]) -> Vec<Figure> {
        let one = &self.judged[judged];
        self.view((&one.curve, &one.spectrum), &one.comparison, frames)
    }

    fn view(
        &self,
        (curve, spectrum): (&Curve<OCTAVES>, &Spectrum<BINS>),
        comparison: &Comparison<OCTAVES, BINS>,
        frames: &[Frame],
    ) -> Vec<Figure> {
        let (model, fit) = (&self.model, &self.fit);
        let view = View {
            model,
            fit,
            comparison,
            spectrum,
            errors: &relative_errors(curve, model, fit),
            interval_s: curve.interval_s(),
        };
        frames
            .iter()
            .map(|frame| Figure::new(&view, frame))
            .collect()
    }
}
