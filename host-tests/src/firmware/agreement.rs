//! Whether an image and this host compute the same bits.

use super::{Core, Image, run};
use allanite::{Point, demonstration::characterise::Characterised};
use anyhow::{Result, ensure};

/// The first line in which `characterise` on a core and the same here differ; `None` if every number
/// has the same bits.
///
/// # Errors
/// If the image cannot be built or run, or ends with a failure.
pub fn difference(core: &Core) -> Result<Option<String>> {
    let run = run(&Image::build_for("characterise", core)?)?;
    let (status, there) = (run.status, run.lines);
    ensure!(status.success(), "the image ended with {status}: {there:?}");
    let here = expected(&Characterised::run()?);
    let lines = here.iter().zip(&there).find(|(here, there)| here != there);
    Ok(match lines {
        Some((here, there)) => Some(format!("{here:?} here, {there:?} there")),
        None if here.len() != there.len() => {
            Some(format!("{} lines here, {} there", here.len(), there.len()))
        }
        None => None,
    })
}

/// What the image logs.
fn expected(characterised: &Characterised) -> Vec<String> {
    let Characterised { curve, fit, truth } = characterised;
    let mut lines: Vec<String> = curve.points().iter().map(octave).collect();
    for (one, truth) in fit.coefficients.iter().zip(truth) {
        let [value, lower, upper] = [one.value, one.lower, one.upper].map(number);
        let truth = ryu::Buffer::new().format(*truth).to_owned();
        let (name, state) = (one.name, one.state);
        lines.push(format!(
            "info coefficient {name} value {value} lower {lower} upper {upper} truth {truth} {state:?}"
        ));
    }
    let [chi_squared, p_value] = [fit.chi_squared, fit.p_value].map(number);
    let freedom = fit.degrees_of_freedom;
    lines.push(format!(
        "info fit degrees_of_freedom {freedom} chi_squared {chi_squared} p_value {p_value}"
    ));
    lines.push("info passed".into());
    lines
}

/// What images log of one octave.
pub fn octave(point: &Point) -> String {
    let (m, differences) = (point.m, point.differences);
    let variance = number(point.variance);
    format!("info octave m {m} differences {differences} variance {variance}")
}

/// A number as the images log it: the shortest decimal, and the bits.
fn number(number: f64) -> String {
    let decimal = ryu::Buffer::new().format(number).to_owned();
    format!("{decimal} {:x}", number.to_bits())
}
