use super::{
    Effect, Explain, GaussMarkov, Parameter, Range, SecondDifferences, Setting, Span, Story,
    gauss_markov::{PARAMETERS, correlation_times},
};
use crate::real::Real;

/// Random telegraph noise, coefficient its rms in rate, correlation time T_c: the rate jumps
/// between two levels, `2 rms` apart, on average every `2 T_c` (Machlup 1954).
///
/// Its autocovariance, and so its Allan variance, is that of [`GaussMarkov`] noise: only the
/// kurtosis of the differences at `τ ≲ T_c` tells the two apart.
#[derive(Clone, Copy, Debug)]
pub struct RandomTelegraph;

impl Effect for RandomTelegraph {
    fn name(&self) -> &'static str {
        "random_telegraph"
    }

    fn symbol(&self) -> &'static str {
        "s"
    }

    fn coefficient(&self) -> &'static str {
        "rms"
    }

    fn half_seconds(&self) -> i8 {
        0
    }

    fn parameters(&self) -> &'static [Parameter] {
        PARAMETERS
    }

    fn range(&self, _: usize, span: &Span) -> Range {
        correlation_times(span)
    }

    fn twin(&self) -> Option<&'static dyn Effect> {
        Some(&GaussMarkov)
    }

    fn kernel(&self, lag: Real, setting: &Setting) -> Real {
        GaussMarkov.kernel(lag, setting)
    }

    fn second_difference(&self, x: Real, m: Real, setting: &Setting) -> Real {
        GaussMarkov.second_difference(x, m, setting)
    }

    fn variance(&self, m: Real, setting: &Setting) -> Real {
        GaussMarkov.variance(m, setting)
    }

    fn variances(
        &self,
        factors: &mut dyn Iterator<Item = Real>,
        setting: &Setting,
        each: &mut dyn FnMut(Real),
    ) {
        GaussMarkov.variances(factors, setting, each);
    }

    fn add_second_differences(
        &self,
        m: Real,
        weight: Real,
        setting: &Setting,
        sum: &mut SecondDifferences,
    ) {
        GaussMarkov.add_second_differences(m, weight, setting, sum);
    }
}

impl Explain for RandomTelegraph {
    fn story(&self) -> Story {
        Story {
            what: "random telegraph noise: the rate jumps between two levels",
            origin: "a single defect in the sense electronics that captures and releases charge (popcorn noise), a stick-slip contact in the package",
            check: "plot the rate averaged over a fifth of the correlation time: are there two levels? exchange the amplifier or cool it",
        }
    }
}
