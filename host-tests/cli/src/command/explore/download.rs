//! What the page shows as files: a drawing and a table.

use super::{fitted::Fitted, question::Question, record::SessionRecord};
use crate::command::output::cell::cell;
use allanite::Comparison;
use allanite_host::{confidence::relative_errors, diagnose::words::shown_p, words};
use allanite_log::{BINS, OCTAVES};
use allanite_plot::{Drawing, Figure, Frame, relative_error, svg};

/// A drawing of the record, and of each record that judges the model, in the form of `plot`.
pub(super) fn drawing(fitted: &Fitted, question: &Question) -> String {
    let frames = fitted.frames();
    let draw = |record: &SessionRecord,
                comparison: &Comparison<OCTAVES, BINS>,
                figures: Vec<Figure>,
                role: &str| {
        let pairs: Vec<(Figure, Frame)> = figures.into_iter().zip(frames.iter().copied()).collect();
        Drawing {
            title: format!("{}: {}", record.axis.axis, model(fitted, question)),
            subtitle: format!(
                "{role}χ² {:.1}, {} degrees of freedom, p {}; {}",
                comparison.chi_squared,
                comparison.degrees_of_freedom,
                shown_p(comparison.p_value),
                record.size(),
            ),
            warning: None,
            unit: record.axis.unit,
            figures: pairs
                .into_iter()
                .filter(|(figure, _)| !figure.measured.x.is_empty())
                .collect(),
            course: None,
        }
    };
    let own = draw(
        fitted.record,
        &fitted.comparison,
        fitted.figures(&frames),
        "",
    );
    let judged = fitted.judged.iter().enumerate().map(|(at, one)| {
        let role = format!("fitted to {}; ", fitted.record.name());
        draw(
            one.record,
            &one.comparison,
            fitted.judged_figures(at, &frames),
            &role,
        )
    });
    svg(&std::iter::once(own).chain(judged).collect::<Vec<_>>())
}

/// The model in words: `five terms without rate ramp + sinusoid`.
fn model(fitted: &Fitted, question: &Question) -> String {
    let without = match question.without.as_slice() {
        [] => String::new(),
        names => format!(" without {}", words::list(names.iter().map(String::as_str))),
    };
    let added = question.added(&fitted.model).into_iter();
    let added = added.map(|(_, term)| format!(" + {}", words::plain(term.effect.name())));
    let taken_out = fitted.taken_out();
    let taken_out = taken_out.map_or(String::new(), |words| format!(" + {words}, taken out"));
    format!(
        "five terms{without}{taken_out}{}",
        added.collect::<String>()
    )
}

/// A table of every octave and every bin of every record, beside the model. Deviations and roots of densities are in
/// the unit of the records.
///
/// # Errors
/// None occurs, because the table is in memory.
pub(super) fn table(fitted: &Fitted, question: &Question) -> Result<Vec<u8>, csv::Error> {
    let unit = fitted.record.axis.unit;
    let comment = format!(
        "# {}, fitted to {}: τ in s and deviations in {unit}; frequencies in Hz and roots of densities in {unit}/√Hz; z in standard errors\n",
        model(fitted, question),
        fitted.record.name(),
    );
    let mut table = csv::Writer::from_writer(comment.into_bytes());
    table.write_record([
        "record", "figure", "x", "measured", "lower", "upper", "model", "z",
    ])?;
    let own = (fitted.record, &fitted.curve, &fitted.comparison);
    let judged = fitted
        .judged
        .iter()
        .map(|one| (one.record, &one.curve, &one.comparison));
    for (record, curve, comparison) in std::iter::once(own).chain(judged) {
        let (model, fit) = (&fitted.model, &fitted.fit);
        let errors = relative_errors(curve, model, fit);
        let octaves = comparison.octaves.iter().zip(errors);
        let octaves = octaves.map(|(one, error)| {
            (
                "deviation",
                one.tau_s,
                one.measured,
                error,
                one.model,
                one.z,
            )
        });
        let bins = comparison.bins.iter();
        let bins = bins.map(|one| {
            let (bin, error) = (&one.bin, relative_error(&one.bin));
            (
                "spectrum",
                bin.frequency_hz,
                bin.density,
                error,
                one.model,
                one.z,
            )
        });
        for (figure, x, measured, error, model, z) in octaves.chain(bins) {
            let root = |sign: f64| (measured * (1.0 + sign * error)).max(0.0).sqrt();
            let numbers = [x, root(0.0), root(-1.0), root(1.0), model.sqrt(), z];
            let numbers = numbers.map(|number| number.to_string());
            let names = [cell(&record.name()), figure.to_owned()];
            table.write_record(names.iter().chain(&numbers))?;
        }
    }
    table
        .into_inner()
        .map_err(|error| error.into_error().into())
}
