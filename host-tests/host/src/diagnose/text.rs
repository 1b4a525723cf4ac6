//! The text of a diagnosis.

use super::{
    conclusion,
    diagnosed::Diagnosed,
    pictures::Pictures,
    words::{Finding, candidate_name, limits, shown_p, unexplained, verdict},
};
use crate::{fit, known_filter::described, number::two_digits, verdict::INVALID_CURVE, words};
use allanite::{
    diagnosis::{Candidate, Step},
    fit::Fit,
};
use allanite_log::{BINS, OCTAVES};
use allanite_plot::{Frame, Plot, Timeline};
use std::io::{self, Write};

/// Prints the conclusion of all axes, then the steps of every axis, from the five terms to the last model.
pub fn print(diagnosed: &[Diagnosed], output: &mut impl Write) -> io::Result<()> {
    for line in conclusion::lines(&diagnosed.iter().collect::<Vec<_>>()) {
        writeln!(output, "{line}")?;
    }
    writeln!(output, "{}", conclusion::next(diagnosed))?;
    for diagnosed in diagnosed {
        writeln!(output)?;
        print_axis(diagnosed, output)?;
    }
    Ok(())
}

fn print_axis(diagnosed: &Diagnosed, output: &mut impl Write) -> io::Result<()> {
    let axis = &diagnosed.axis;
    let Some((first, last)) = diagnosed.ends() else {
        return Ok(());
    };
    let record = words::record(axis.samples, axis.rate_hz, axis.octaves.len());
    writeln!(output, "{}: {record}", axis.axis)?;
    if let Some(filter) = diagnosed.filter() {
        writeln!(output, "given: {}", described(filter))?;
    }
    if let Some(reason) = diagnosed.invalid() {
        writeln!(output, "{INVALID_CURVE}: {reason}")?;
    }
    writeln!(
        output,
        "{}: {}",
        diagnosed.model_name(0),
        beginning(diagnosed, &first.fit)
    )?;
    writeln!(output, "  {}", first.comparison)?;
    print_unexplained(first, output)?;
    for (number, pair) in diagnosed.steps.windows(2).enumerate() {
        let [before, after] = pair else { continue };
        if let Some(finding) = Finding::new(diagnosed, before, after) {
            let errors = [number, number + 1].map(|at| diagnosed.chi_squared(at));
            print_step(number + 1, errors, [before, after], &finding, output)?;
        }
    }
    if last.added.is_none() && !last.candidates.is_empty() {
        writeln!(
            output,
            "\nno further effect of the catalogue improves the model; candidates:"
        )?;
        print_candidates(last, output)?;
    }
    let notes = diagnosed.notes();
    if !notes.is_empty() {
        writeln!(output, "\nnotes:")?;
    }
    for note in notes {
        writeln!(output, "  {note}")?;
    }
    writeln!(output)?;
    for (at, term) in last.model.terms().iter().enumerate() {
        let shape = words::shape(term, Some((&last.fit, at)));
        if !shape.is_empty() {
            let mut lines = diagnosed.lines.iter().filter(|line| line.place == at);
            let width = lines.next().and_then(|line| line.narrower_than_hz);
            let width = width.map_or(String::new(), |width_hz| {
                format!(", narrower than {} Hz", two_digits(width_hz))
            });
            writeln!(
                output,
                "{}: {shape}{width}",
                words::plain(term.effect.name())
            )?;
        }
    }
    writeln!(output, "{}", fit::table::table(&last.fit, axis.unit))?;
    writeln!(output)?;
    print_plots(diagnosed, last, output)?;
    writeln!(output, "{}: {}", axis.axis, verdict(diagnosed))?;
    let limits = limits(diagnosed);
    if !limits.is_empty() {
        writeln!(output, "\n{}", words::LIMITS)?;
    }
    for limit in limits {
        writeln!(output, "  {limit}")?;
    }
    Ok(())
}

/// χ² of the five terms, with the part that a covariate explains.
fn beginning(diagnosed: &Diagnosed, fit: &Fit) -> String {
    let of_curve = format!("{}, p {}", words::goodness(fit), shown_p(fit.p_value));
    match diagnosed.dependence() {
        Some((channels, squares)) => format!(
            "χ² {:.1}: {of_curve}, and {squares:.1} of what follows {channels}",
            diagnosed.chi_squared(0)
        ),
        None => format!("χ² {of_curve}"),
    }
}

/// Prints the record beside the model of a step, and the record over time.
fn print_plots(
    diagnosed: &Diagnosed,
    step: &Step<OCTAVES, BINS>,
    output: &mut impl Write,
) -> io::Result<()> {
    let axis = &diagnosed.axis;
    let pictures = Pictures::of(diagnosed);
    for frame in pictures.frames() {
        // A single model needs no room for the residuals of others.
        let frame = Frame::of(frame.quantity, [&step.comparison]);
        let title = format!(
            "{}: {} of the record and of the model",
            axis.axis,
            frame.quantity.name()
        );
        let figure = pictures.figure(step, &frame);
        let plot = Plot::new(&title, axis.unit, &figure, &frame);
        writeln!(output, "{plot}")?;
    }
    if let Some(course) = pictures.course() {
        let title = format!("{}: the record over time", axis.axis);
        writeln!(output, "{}", Timeline::new(&title, &course))?;
    }
    Ok(())
}

/// Prints one line with the error before and after, then the addition, its explanation and the
/// candidates.
fn print_step(
    number: usize,
    errors: [f64; 2],
    [before, after]: [&Step<OCTAVES, BINS>; 2],
    finding: &Finding,
    output: &mut impl Write,
) -> io::Result<()> {
    writeln!(
        output,
        "\n{number}. + {}: χ² {:.1} → {:.1}, p {}",
        finding.name,
        errors[0],
        errors[1],
        shown_p(after.fit.p_value)
    )?;
    if let Some(found) = &finding.found {
        writeln!(output, "  {found}")?;
    }
    let labelled = |(label, text): &(&str, &str)| format!("  {:<22}{text}", format!("{label}:"));
    for line in finding.lines().iter().map(labelled) {
        writeln!(output, "{line}")?;
    }
    // A single candidate is the addition.
    if before.candidates.len() > 1 {
        writeln!(output, "  candidates by a quick fit, best first:")?;
        print_candidates(before, output)?;
    }
    if let Some(ambiguous) = &finding.ambiguous {
        writeln!(output, "  ambiguous: {ambiguous}")?;
    }
    writeln!(output, "  after this step: {}", after.comparison)?;
    print_unexplained(after, output)
}

/// Prints where the spectrum differs from the model, if it does.
fn print_unexplained(step: &Step<OCTAVES, BINS>, output: &mut impl Write) -> io::Result<()> {
    let bands = unexplained(&step.comparison);
    if bands.is_empty() {
        return Ok(());
    }
    writeln!(
        output,
        "  unexplained in the spectrum: {}",
        bands.join("; ")
    )
}

fn print_candidates(step: &Step<OCTAVES, BINS>, output: &mut impl Write) -> io::Result<()> {
    let line = |candidate: &Candidate| {
        format!(
            "χ² {:>8.1}, improvement {:>8.1}: {}",
            candidate.chi_squared,
            candidate.improvement,
            candidate_name(candidate)
        )
    };
    for candidate in &step.candidates {
        writeln!(output, "    {}", line(candidate))?;
    }
    Ok(())
}
