//! The lines that the images log and the host prints. They hold the bits of every number, so that equal
//! lines mean equal bits.

use super::{
    characterise::{Characterised, OCTAVES},
    double,
};
use allanite::{
    Curve, Real,
    axis::AxisRecord,
    course::Block,
    diagnosis::{Addition, Dependence, Step},
    ieee_952,
    spectrum::Spectrum,
};
use core::fmt::{self, Arguments, Display, Formatter};

/// A number, printed with its bits in double precision.
struct Exact(Real);

impl Display for Exact {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{:e} {:x}", self.0, double(self.0).to_bits())
    }
}

/// Prints one line for each octave of a curve.
pub fn curve<const K: usize>(curve: &Curve<K>, mut line: impl FnMut(Arguments<'_>)) {
    for point in curve.points() {
        line(format_args!(
            "octave m {} differences {} variance {}",
            point.m,
            point.differences,
            Exact(point.variance)
        ));
    }
}

/// Prints the curve of an axis and what else a diagnosis takes.
pub fn record<const K: usize, const C: usize, const B: usize>(
    axis: &AxisRecord<K, C, Spectrum<B>>,
    mut line: impl FnMut(Arguments<'_>),
) {
    curve(&axis.curve, &mut line);
    for point in axis.kurtosis.iter().flat_map(|kurtosis| &kurtosis.points) {
        let excess = Exact(point.excess);
        line(format_args!("kurtosis m {} excess {excess}", point.m));
    }
    for point in axis.covariates.iter().flat_map(|cross| cross.points()) {
        let [covariance, variance] = [point.covariance, point.variance].map(Exact);
        line(format_args!(
            "covariate m {} covariance {covariance} variance {variance}",
            point.m
        ));
    }
    for bin in axis.spectrum.all() {
        let (density, kurtosis) = (Exact(bin.density), Exact(bin.spectral_kurtosis));
        line(format_args!(
            "bin block {} index {} segments {} density {density} kurtosis {kurtosis}",
            bin.block, bin.index, bin.segments
        ));
    }
    for density in axis.course.iter().flat_map(|course| course.densities()) {
        line(format_args!("course density {}", Exact(*density)));
    }
    line(format_args!("invalid {:?}", axis.invalid));
}

/// Prints a block of a course.
pub fn block<const C: usize>(block: &Block<C>, mut line: impl FnMut(Arguments<'_>)) {
    let [mean, square] = [block.mean, block.mean_square_difference].map(Exact);
    line(format_args!(
        "block start_s {} samples {} mean {mean} mean_square_difference {square}",
        block.start_s, block.samples
    ));
}

/// Prints the curve, one line for each coefficient, and one line for the fit, and the same of the small fit of the five terms.
pub fn characterised(test: &Characterised, mut line: impl FnMut(Arguments<'_>)) {
    curve(&test.curve, &mut line);
    for (coefficient, truth) in test.fit.coefficients.iter().zip(test.truth) {
        line(format_args!(
            "coefficient {} value {} lower {} upper {} truth {truth:e} {:?}",
            coefficient.name,
            Exact(coefficient.value),
            Exact(coefficient.lower),
            Exact(coefficient.upper),
            coefficient.state
        ));
    }
    line(format_args!(
        "fit degrees_of_freedom {} chi_squared {} p_value {}",
        test.fit.degrees_of_freedom,
        Exact(test.fit.chi_squared),
        Exact(test.fit.p_value)
    ));
    small(&test.curve, line);
}

/// Fits the five terms alone in a separate call: on a core with 16 KiB of RAM, this leaves the stack before numbers are printed.
#[inline(never)]
fn five_terms(curve: &Curve<OCTAVES>) -> Result<ieee_952::Fit, allanite::Error> {
    ieee_952::fit(curve)
}

/// Prints the small fit of the five terms.
#[inline(never)]
fn small(curve: &Curve<OCTAVES>, mut line: impl FnMut(Arguments<'_>)) {
    let fit = match five_terms(curve) {
        Ok(fit) => fit,
        Err(error) => return line(format_args!("small {error:?}")),
    };
    for coefficient in &fit.coefficients {
        line(format_args!(
            "small {} value {} lower {} upper {} error {} {:?}",
            coefficient.name,
            Exact(coefficient.value),
            Exact(coefficient.lower),
            Exact(coefficient.upper),
            Exact(coefficient.square_error),
            coefficient.state
        ));
    }
    line(format_args!(
        "small degrees_of_freedom {} chi_squared {}",
        fit.degrees_of_freedom,
        Exact(fit.chi_squared)
    ));
}

/// Prints a step of a diagnosis: the error of each octave and of each bin, the fit, the candidates, and the effect added.
pub fn step<const K: usize, const B: usize>(
    step: &Step<K, B>,
    mut line: impl FnMut(Arguments<'_>),
) {
    for octave in &step.comparison.octaves {
        line(format_args!(
            "octave m {} measured {:e} model {:e} z {}",
            octave.m,
            octave.measured,
            octave.model,
            Exact(octave.z)
        ));
    }
    for bin in &step.comparison.bins {
        line(format_args!(
            "bin {:e} Hz measured {:e} model {:e} z {}",
            bin.bin.frequency_hz,
            bin.bin.density,
            bin.model,
            Exact(bin.z)
        ));
    }
    line(format_args!("comparison {}", step.comparison));
    line(format_args!(
        "fit degrees_of_freedom {} chi_squared {} p_value {} rms_percent {}",
        step.fit.degrees_of_freedom,
        Exact(step.fit.chi_squared),
        Exact(step.fit.p_value),
        Exact(step.comparison.rms_percent)
    ));
    for coefficient in &step.fit.coefficients {
        let value = Exact(coefficient.value);
        line(format_args!(
            "coefficient {} value {value}",
            coefficient.name
        ));
    }
    for candidate in &step.candidates {
        let (name, improvement) = (candidate.term.effect.name(), Exact(candidate.improvement));
        line(format_args!("candidate {name} improvement {improvement}"));
    }
    for name in &step.ambiguous {
        line(format_args!("ambiguous {name}"));
    }
    match &step.added {
        Some(Addition::Effect(term)) => {
            let first = Exact(term.parameters[0]);
            line(format_args!("added {} first {first}", term.effect.name()));
        }
        Some(Addition::Covariate(follows)) => {
            let slope = Exact(follows.slope.value);
            line(format_args!("added covariate slope {slope}"));
        }
        None => {}
    }
}

/// Prints the slope and the lag with which the rate follows a temperature.
pub(super) fn dependence(found: Option<Dependence>, line: &mut impl FnMut(Arguments<'_>)) {
    let Some(found) = found else { return };
    let [slope, error, lag_s] = [found.slope.value, found.slope.error, found.lag_s].map(Exact);
    let lag_error_s = found.lag_error_s.map_or(Exact(-1.0), Exact);
    line(format_args!(
        "dependence slope {slope} error {error} lag {lag_s} error {lag_error_s}"
    ));
}
