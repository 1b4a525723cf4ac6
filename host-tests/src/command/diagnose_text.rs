//! A diagnosis for people.

use super::{
    diagnose::Diagnosed,
    fit_table,
    number::{self, probability},
    words,
};
use crate::{log::OCTAVES, plot::Plot, unit::Unit};
use allanite::{
    Addition, Candidate, Follows, Step, Swap, Term, Verdict,
    effect::{Story, covariate},
};
use std::io::{self, Write};

/// Prints the way of every axis, from the five terms to the model that the diagnosis ends with.
pub(super) fn print(diagnosed: &[Diagnosed], output: &mut impl Write) -> io::Result<()> {
    for (i, diagnosed) in diagnosed.iter().enumerate() {
        if i > 0 {
            writeln!(output)?;
        }
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
    writeln!(
        output,
        "five terms: χ² {:.1}, {} degrees of freedom, p {}; misfit {:.1} % rms",
        first.fit.chi_squared,
        first.fit.degrees_of_freedom,
        shown_p(first.fit.p_value),
        first.comparison.rms_percent
    )?;
    writeln!(output, "  {}", first.comparison)?;
    for (number, pair) in diagnosed.steps.windows(2).enumerate() {
        let [before, after] = pair else { continue };
        match &before.added {
            Some(Addition::Effect(added)) => {
                print_step(number + 1, before, after, added, axis.unit, output)?;
            }
            Some(Addition::Covariate(follows)) => {
                print_covariate(number + 1, diagnosed, before, after, follows, output)?;
            }
            None => {}
        }
    }
    if last.added.is_none() && !last.candidates.is_empty() {
        writeln!(output, "\nnothing in the catalogue helps further; tried:")?;
        print_candidates(last, output)?;
    }
    let notes = diagnosed.notes();
    if !notes.is_empty() {
        writeln!(output, "\nto note:")?;
    }
    for note in notes {
        writeln!(output, "  {note}")?;
    }
    writeln!(output)?;
    for (at, term) in last.model.terms().iter().enumerate() {
        let shape = words::shape(term, Some((&last.fit, at)));
        if !shape.is_empty() {
            writeln!(output, "{}: {shape}", words::plain(term.effect.name()))?;
        }
    }
    writeln!(
        output,
        "{}",
        fit_table::table(&last.fit, axis.unit).trim_fmt()
    )?;
    writeln!(output)?;
    let title = format!(
        "{}: Allan deviation of the record and of the model",
        axis.axis
    );
    write!(output, "{}", Plot::new(&title, axis.unit, &last.comparison))?;
    writeln!(output)?;
    writeln!(output, "{}: {}", axis.axis, verdict(diagnosed, first, last))
}

/// One line “error before → after”.
fn print_fall(
    number: usize,
    name: &str,
    before: &Step<OCTAVES>,
    after: &Step<OCTAVES>,
    output: &mut impl Write,
) -> io::Result<()> {
    writeln!(
        output,
        "\n{number}. + {name}: χ² {:.1} → {:.1}, misfit {:.1} % → {:.1} % rms, p {}",
        before.fit.chi_squared,
        after.fit.chi_squared,
        before.comparison.rms_percent,
        after.comparison.rms_percent,
        shown_p(after.fit.p_value)
    )
}

fn print_story(story: &Story, output: &mut impl Write) -> io::Result<()> {
    writeln!(output, "  what it is:           {}", story.what)?;
    writeln!(output, "  where it comes from:  {}", story.origin)?;
    writeln!(output, "  what to check:        {}", story.check)
}

/// What the rate follows.
fn print_covariate(
    number: usize,
    diagnosed: &Diagnosed,
    before: &Step<OCTAVES>,
    after: &Step<OCTAVES>,
    follows: &Follows,
    output: &mut impl Write,
) -> io::Result<()> {
    let channel = diagnosed.covariate(follows);
    let name = format!("{} {channel}", words::plain(covariate::NAME));
    print_fall(number, &name, before, after, output)?;
    let (slope, (lower, upper)) = (follows.slope, follows.slope.interval());
    writeln!(
        output,
        "  slope {} {} per unit of {channel} ({} … {}), 95 % interval; {:.1} standard errors",
        number::number(slope.value),
        diagnosed.axis.unit,
        number::number(lower),
        number::number(upper),
        slope.z()
    )?;
    print_story(&covariate::STORY, output)?;
    writeln!(
        output,
        "  in the curve:         what follows {channel} is taken off, here and below"
    )?;
    writeln!(output, "  now {}", after.comparison)
}

/// One line “error before → after”, then what was added and why.
fn print_step(
    number: usize,
    before: &Step<OCTAVES>,
    after: &Step<OCTAVES>,
    added: &Term,
    unit: Unit,
    output: &mut impl Write,
) -> io::Result<()> {
    let effect = added.effect;
    let name = words::plain(effect.name()) + &instead(before.swap());
    print_fall(number, &name, before, after, output)?;
    let at = after.model.position(effect.name());
    let fitted = at.and_then(|at| {
        let term = after.model.terms().get(at)?;
        Some((at, term, after.fit.coefficients.get(at)?))
    });
    if let Some((at, term, coefficient)) = fitted {
        let mut found = words::shape(term, Some((&after.fit, at)));
        if !found.is_empty() {
            found += "; ";
        }
        found += &words::coefficient(effect, coefficient, unit);
        writeln!(output, "  {found}, 95 % intervals")?;
    }
    print_story(&effect.story(), output)?;
    if let Some(replaced) = effect.replaces() {
        let name = words::plain(replaced.name());
        writeln!(output, "  in the model:         takes the place of {name}")?;
    }
    writeln!(output, "  candidates, best first:")?;
    print_candidates(before, output)?;
    if !before.ambiguous.is_empty() {
        let others = words::list(before.ambiguous.iter().copied());
        writeln!(
            output,
            "  ambiguous: {others} cannot be told from it on this curve"
        )?;
    }
    writeln!(output, "  now {}", after.comparison)
}

/// What else changes with an addition: `, sinusoid instead of resonance`.
fn instead(swap: Option<Swap>) -> String {
    swap.map_or(String::new(), |swap| {
        let [taken, dropped] = [swap.taken, swap.dropped].map(|effect| words::plain(effect.name()));
        format!(", {taken} instead of {dropped}")
    })
}

fn print_candidates(step: &Step<OCTAVES>, output: &mut impl Write) -> io::Result<()> {
    let line = |candidate: &Candidate| {
        let shape = words::shape(&candidate.term, None);
        let name = words::plain(candidate.term.effect.name());
        let instead = instead(candidate.swap);
        let shape = if shape.is_empty() {
            String::new()
        } else {
            format!(" ({shape})")
        };
        format!(
            "χ² {:>8.1}, improvement {:>8.1}: {name}{shape}{instead}",
            candidate.chi_squared, candidate.improvement
        )
    };
    for candidate in &step.candidates {
        writeln!(output, "    {}", line(candidate))?;
    }
    Ok(())
}

fn shown_p(p: f64) -> String {
    if p.is_finite() {
        probability(p)
    } else {
        "unknown".into()
    }
}

fn verdict(diagnosed: &Diagnosed, first: &Step<OCTAVES>, last: &Step<OCTAVES>) -> String {
    let p = shown_p(last.fit.p_value);
    match diagnosed.verdict {
        Verdict::Invalid(_) => "the record is invalid: its curve cannot mean what it says, and no \
                                effect was looked for."
            .into(),
        Verdict::Adequate => format!("the five terms are adequate (p {p}): no effect is missing."),
        Verdict::Unexplained if !last.fit.p_value.is_finite() => {
            "there are too few octaves to judge the five terms: record longer.".into()
        }
        Verdict::Unexplained => format!(
            "the five terms are not adequate (p {p}), and no effect in the catalogue explains it."
        ),
        Verdict::Improved => {
            let names = diagnosed.missing().map(|name| match &last.follows {
                Some(follows) if name == covariate::NAME => {
                    format!("{name} {}", diagnosed.covariate(follows))
                }
                _ => words::plain(name),
            });
            let names = words::list_of(names.collect());
            let alike = if diagnosed.ambiguous().next().is_some() {
                " (or what is ambiguous with it)"
            } else {
                ""
            };
            let error = format!(
                "χ² {:.1} → {:.1}, misfit {:.1} % → {:.1} % rms",
                first.fit.chi_squared,
                last.fit.chi_squared,
                first.comparison.rms_percent,
                last.comparison.rms_percent
            );
            let lack = if first.fit.p_value >= diagnosed.adequate_p {
                "the five terms explain the curve, and yet lack"
            } else {
                "the five terms lack"
            };
            let missing = format!("{lack} {names}{alike}: {error}");
            if last.fit.p_value >= diagnosed.adequate_p {
                format!("{missing}; the model is adequate now (p {p}).")
            } else {
                format!("{missing}; something small is left that no effect explains (p {p}).")
            }
        }
    }
}
