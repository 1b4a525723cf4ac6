//! The effects that `simulate --effect` hides in a record.

use allanite::effect::{
    AngleRandomWalk, CATALOGUE, DecimationFilter, Effect, IEEE_952, MAX_PARAMETERS,
};
use allanite_host::{
    effect_argument::EffectArgument,
    own,
    simulate::{Coefficients, Course, Hidden, Thermal},
};
use allanite_log::failure::{Failure, brief, quoted};
use clap::Args;

/// The name of the thermal effect, which a curve without a temperature does not reveal.
const THERMAL: &str = "thermal";

/// The options for effects to hide.
#[derive(Debug, Args)]
pub(super) struct HiddenArguments {
    /// Hide an effect, such as `sinusoid:frequency_hz=0.3,amplitude=0.005`,
    /// `gauss_markov:correlation_time_s=5,rms=0.01`, `decimation_filter:width_s=0.02,stages=2`, or a
    /// temperature on which the rate depends: `thermal:slope=0.01,kelvin=10,time_s=600` for a warm-up,
    /// `thermal:slope=0.01,kelvin=5,period_s=1200` for a cycle, or an effect of your own, such as
    /// `density: 1/(1 + (f/corner_hz)^2); corner_hz=3; size=0.01`
    #[arg(long = "effect", value_name = "NAME:parameter=value,…")]
    effects: Vec<String>,
}

/// The effects of a record other than the five terms.
#[derive(Default)]
pub(super) struct HiddenEffects {
    pub(super) hidden: Vec<Hidden>,
    pub(super) thermal: Option<Thermal>,
}

impl HiddenEffects {
    /// Checks that no decimation filter is wider than the effect of the library can be.
    ///
    /// # Errors
    /// When a filter has more samples.
    pub(super) fn check_widths(&self, rate_hz: f64) -> Result<(), Failure> {
        const WIDEST: f64 = 64.0;
        let filter = DecimationFilter.description().name;
        for hidden in self.hidden.iter().filter(|one| one.effect.name() == filter) {
            let [width_s, ..] = hidden.parameters;
            if width_s * rate_hz > WIDEST {
                return Err(Failure::option(
                    format!(
                        "--effect {filter}: a width of {} s at {} Hz is too wide",
                        brief(width_s),
                        brief(rate_hz)
                    ),
                    format!("give a width of at most {WIDEST} samples"),
                ));
            }
        }
        Ok(())
    }
}

impl HiddenArguments {
    /// Whether nothing is hidden.
    pub(super) fn is_empty(&self) -> bool {
        self.effects.is_empty()
    }

    /// The texts of the options.
    pub(super) fn texts(&self) -> impl Iterator<Item = &str> {
        self.effects.iter().map(String::as_str)
    }

    /// The effects. A filter of white noise filters the record's own white noise unless a coefficient is
    /// given.
    ///
    /// # Errors
    /// When an effect is unknown, is one of the five terms, lacks a parameter, or conflicts with
    /// another.
    pub(super) fn effects(&self, coefficients: Coefficients) -> Result<HiddenEffects, Failure> {
        let mut effects = HiddenEffects::default();
        for text in &self.effects {
            if own::is_formula(text) {
                effects.hidden.push(hidden_own(text)?);
                continue;
            }
            let mut argument = EffectArgument::parse("--effect", text)?;
            if argument.name == THERMAL {
                if effects.thermal.is_some() {
                    return Err(argument.failure("is given twice", "give it once"));
                }
                effects.thermal = Some(thermal(&mut argument)?);
            } else {
                let hidden = hidden(&mut argument, coefficients)?;
                let mut others = effects.hidden.iter();
                if hidden.replaces_white_noise() && others.any(Hidden::replaces_white_noise) {
                    return Err(argument.failure(
                        "two filters replace the same white noise",
                        "drop one of them",
                    ));
                }
                effects.hidden.push(hidden);
            }
            argument.finish()?;
        }
        Ok(effects)
    }
}

/// An effect of the user's own.
fn hidden_own(text: &str) -> Result<Hidden, Failure> {
    let given = own::Given::parse("--effect", text)?;
    let fail = |what: &str, remedy: &str| {
        Failure::option(
            format!("--effect {}: {what}", quoted(text.as_bytes())),
            remedy,
        )
    };
    let effect: &'static dyn Effect = given.effect;
    if given.is_fitted {
        return Err(fail(
            "a parameter has no value",
            "write NAME=VALUE for each",
        ));
    }
    let coefficient = given
        .size
        .ok_or_else(|| fail("size is missing", "add ; size=VALUE"))?;
    Ok(Hidden {
        effect,
        parameters: given.parameters,
        coefficient,
    })
}

fn hidden(
    argument: &mut EffectArgument<'_>,
    coefficients: Coefficients,
) -> Result<Hidden, Failure> {
    let is_term = |effect: &&dyn Effect| effect.name() == argument.name;
    if IEEE_952.iter().any(is_term) {
        let remedy = format!("give --{}", argument.name.replace('_', "-"));
        return Err(argument.failure("is one of the five terms", &remedy));
    }
    if !CATALOGUE.iter().any(is_term) {
        let beyond = CATALOGUE.iter().map(|effect| effect.name());
        let beyond = beyond.filter(|name| !IEEE_952.iter().any(|term| term.name() == *name));
        let names: Vec<&str> = beyond.chain([THERMAL]).collect();
        return Err(argument.failure(
            "no such effect",
            &format!("choose from {}", names.join(", ")),
        ));
    }
    let effect = argument.effect()?;
    let parameters = argument.shape(effect)?;
    check_drift(argument, effect, parameters)?;
    let white = coefficients.angle_random_walk;
    let replaced = effect.replaces().map(|replaced| replaced.name());
    let replaces_white_noise = replaced == Some(AngleRandomWalk.description().name);
    let coefficient = match argument.take_positive(effect.coefficient())? {
        Some(coefficient) => coefficient,
        None if replaces_white_noise && white > 0.0 => white,
        None => argument.require(effect.coefficient())?,
    };
    Ok(Hidden {
        effect,
        parameters,
        coefficient,
    })
}

/// Checks that the range of a drifting frequency is not wider than the effect of the library can be.
fn check_drift(
    argument: &EffectArgument<'_>,
    effect: &dyn Effect,
    parameters: [f64; MAX_PARAMETERS],
) -> Result<(), Failure> {
    let of = |name: &str| {
        let mut named = effect.parameters().iter().zip(parameters);
        named.find_map(|(one, value)| (one.name == name).then_some(value))
    };
    match (of("frequency_hz"), of("drift_hz")) {
        (Some(frequency_hz), Some(drift_hz)) if drift_hz > 0.5 * frequency_hz => Err(argument
            .failure(
                format!(
                    "a range of {} Hz around {} Hz is too wide",
                    brief(drift_hz),
                    brief(frequency_hz)
                ),
                "give a range of at most half the frequency",
            )),
        _ => Ok(()),
    }
}

fn thermal(argument: &mut EffectArgument<'_>) -> Result<Thermal, Failure> {
    // The slope may be negative, and it may be zero.
    let slope = argument.take("slope").ok_or_else(|| {
        argument.failure(
            "slope is missing",
            "write thermal:slope=VALUE, in rate units per kelvin",
        )
    })?;
    let kelvin = argument.require("kelvin")?;
    let times = (
        argument.take_positive("time_s")?,
        argument.take_positive("period_s")?,
    );
    let course = match times {
        (Some(time_s), None) => Course::WarmUp { time_s },
        (None, Some(period_s)) => Course::Cycle { period_s },
        _ => {
            return Err(argument.failure(
                "a temperature needs either time_s or period_s",
                "give time_s for a warm-up or period_s for a cycle",
            ));
        }
    };
    Ok(Thermal {
        slope,
        kelvin,
        course,
    })
}
