//! Which effect is missing.

mod alternative;
mod follow;
mod revise;
mod scan;
mod standing;
mod step;
mod trial;
mod twins;

pub use step::{Addition, Candidate, Follows, MAX_AMBIGUOUS, MAX_CANDIDATES, Step, Swap};

use crate::{
    covariate::CrossCurve, curve::Curve, effect::Effect, error::Error, fit::check,
    integrity::Reason, kurtosis::Kurtosis, model::Model, real::Real,
};
use standing::Standing;

/// How to look for missing effects.
#[derive(Clone, Copy, Debug)]
pub struct Diagnosis {
    /// Tolerance of the model, as of [`Settings`](crate::Settings).
    pub tolerance: Real,
    /// A model of lower p-value is not adequate, and an effect is looked for.
    pub adequate_p: Real,
    /// Least improvement of `−2 ln L`, less what the effect's own parameters cost, that an effect is
    /// accepted for.
    pub threshold: Real,
    /// Candidates whose scores lie within this of the best are ambiguous.
    pub ambiguity: Real,
    /// A covariate is believed from a slope of so many standard errors on.
    pub covariate_z: Real,
    /// Most effects to add, a covariate among them.
    pub max_effects: usize,
}

impl Default for Diagnosis {
    fn default() -> Self {
        Self {
            tolerance: 0.01,
            adequate_p: 0.05,
            threshold: 8.0,
            ambiguity: 6.0,
            covariate_z: 3.5,
            max_effects: 3,
        }
    }
}

/// What is known of a record beside its curve: all of it optional.
#[derive(Clone, Copy, Debug)]
pub struct Evidence<'a, const K: usize> {
    /// Tells effects apart that the curve does not.
    pub kurtosis: Option<&'a Kurtosis<K>>,
    /// What the rate may follow. One of them is taken into account, the one with the surest slope: of
    /// two that share their course, cross sums with the gyro do not tell which it is.
    pub covariates: &'a [CrossCurve<K>],
    /// Why the curve cannot mean what it says, as of [`Integrity`](crate::Integrity).
    pub invalid: Option<Reason>,
}

impl<const K: usize> Evidence<'_, K> {
    /// The curve alone.
    pub const NONE: Self = Self {
        kurtosis: None,
        covariates: &[],
        invalid: None,
    };
}

/// How a diagnosis ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Verdict {
    /// The model that was asked about explains the curve.
    Adequate,
    /// With the effects that were added, the model explains the curve, or more of it.
    Improved,
    /// The model does not explain the curve, and no effect in the list helps.
    Unexplained,
    /// The curve cannot mean what it says: no effect was looked for.
    Invalid(Reason),
}

impl Diagnosis {
    /// Looks for what a model lacks, in a list of effects such as
    /// [`CATALOGUE`](crate::effect::CATALOGUE): fits, compares, tries every effect, adds the best,
    /// and again, until the model is adequate or nothing helps. A covariate is tried first: it
    /// carries its own evidence. Every step is handed to `report`, the last one included.
    ///
    /// With 20 octaves it takes less than 16 KiB of stack and, where an effect is found, some 4·10⁸
    /// instructions on a Cortex-M4F, in single precision 10⁸: `cargo xtask bench` measures this.
    ///
    /// # Errors
    /// As of [`fit`](crate::fit).
    pub fn run<const K: usize>(
        &self,
        curve: &Curve<K>,
        evidence: &Evidence<'_, K>,
        model: &Model,
        effects: &[&'static dyn Effect],
        mut report: impl FnMut(&Step<K>),
    ) -> Result<Verdict, Error> {
        check(curve.points(), 2)?;
        let mut standing = Standing::at(model);
        if !evidence.covariates.is_empty() {
            return self.run_with_covariates(curve, evidence, effects, &mut standing, &mut report);
        }
        loop {
            let end = self.advance(curve, evidence, effects, &mut standing, &mut report)?;
            if let Some(verdict) = end {
                return Ok(verdict);
            }
        }
    }

    /// [`run`](Self::run) on a copy of the curve, which what follows a covariate is taken off.
    #[inline(never)]
    fn run_with_covariates<const K: usize>(
        &self,
        curve: &Curve<K>,
        evidence: &Evidence<'_, K>,
        effects: &[&'static dyn Effect],
        standing: &mut Standing<K>,
        report: &mut impl FnMut(&Step<K>),
    ) -> Result<Verdict, Error> {
        let mut rest = curve.clone();
        loop {
            let end = self.advance(&rest, evidence, effects, standing, report)?;
            if let Some(verdict) = end {
                return Ok(verdict);
            }
            if let Some(Addition::Covariate(follows)) = &standing.step.added
                && let Some(cross) = evidence.covariates.get(follows.covariate)
            {
                cross.correct(&mut rest, &follows.slope);
            }
        }
    }

    /// One step: judges the model, reports, and adds to it; at the end, the verdict.
    fn advance<const K: usize>(
        &self,
        curve: &Curve<K>,
        evidence: &Evidence<'_, K>,
        effects: &[&'static dyn Effect],
        standing: &mut Standing<K>,
        report: &mut impl FnMut(&Step<K>),
    ) -> Result<Option<Verdict>, Error> {
        let room = standing.additions < self.max_effects && evidence.invalid.is_none();
        let effects = if room { effects } else { &[] };
        self.judge(curve, effects, standing)?;
        standing.step.added = None;
        standing.step.candidates.clear();
        standing.step.ambiguous.clear();
        if room && standing.step.follows.is_none() {
            standing.step.added = self.follow(curve, evidence, standing)?;
        }
        if room && standing.step.added.is_none() && !standing.adequate {
            self.try_all(curve, None, standing);
            self.revise(curve, effects, standing);
            self.choose(&mut standing.step);
            twins::tell(curve, evidence.kurtosis, effects, standing);
        }
        report(&standing.step);
        match standing.step.added {
            Some(Addition::Covariate(follows)) => standing.step.follows = Some(follows),
            Some(Addition::Effect(_)) => standing.accept(self.threshold),
            None => {
                return Ok(Some(
                    match (evidence.invalid, standing.additions, standing.adequate) {
                        (Some(reason), ..) => Verdict::Invalid(reason),
                        (_, 0, true) => Verdict::Adequate,
                        (_, 0, false) => Verdict::Unexplained,
                        _ => Verdict::Improved,
                    },
                ));
            }
        }
        standing.additions = standing.additions.saturating_add(1);
        Ok(None)
    }
}
