//! A self-test with limits: samples go in, a verdict comes out as soon as the record bears one.

mod decide;
mod plan;

pub use plan::{InvalidPlan, Limit, Plan};

use crate::{
    algebra::Choice,
    coefficient::{Coefficient, State},
    curve::Scale,
    fit::{Estimator, Fit, Options, Problem, Start, Tolerance, Work, check},
    integrity::{Integrity, Reason},
    list::numbered,
    model::Model,
    octave::Accumulator,
    real::{Real, real, single},
};
use decide::{Side, quantile, side};

/// How a self-test stands.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Status {
    /// Push more samples.
    Running {
        /// Share of the longest record that is there, 0 to 1.
        progress: f32,
        /// Seconds from now to the look at which a verdict is expected: the last one until the first
        /// has been taken.
        expected_s: Real,
    },
    /// Every limit is kept.
    Passed,
    /// One is not.
    Failed(Failure),
    /// The longest record did not tell.
    Undecided {
        /// The limit that is open.
        limit: Limit,
        /// Length of a record that would decide if its estimate is right, in seconds; `None` where no
        /// length up to 2³⁰ samples would.
        decided_by_s: Option<Real>,
    },
    /// The samples cannot be those of a gyro at rest.
    Invalid(Reason),
}

/// What a gyro failed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Failure {
    /// A coefficient above its limit.
    Limit {
        /// The limit.
        limit: Limit,
        /// What was measured.
        value: Real,
    },
    /// The five terms do not explain the curve.
    Misfit {
        /// Probability of a larger χ² if they did.
        p_value: Real,
    },
}

/// A self-test of one axis.
///
/// # The statistics
///
/// A look is taken at the shortest length, and whenever the record has doubled, and at the longest:
/// the coefficients are fitted, and a limit is decided as soon as an interval leaves it. Each look is
/// a chance to err, so the probabilities of the plan are divided among the looks (Bonferroni 1936), that
/// of a false fail also among the limits; a false pass needs the coefficient that lies above its limit,
/// whatever the others do. A decision stands: later looks do not ask again.
///
/// # Example
///
/// ```
/// use allanite::{Scale, self_test::{Limit, Plan, SelfTest, Status}};
///
/// let plan = Plan {
///     limits: [Limit { effect: "angle_random_walk", most: 0.02 }].into_iter().collect(),
///     least_p: 0.0,
///     false_pass: 0.01,
///     false_fail: 0.01,
///     shortest_s: 1.0,
///     longest_s: 600.0,
/// };
/// // 131 counts per °/s, 100 Hz.
/// let mut test = SelfTest::<16>::new(plan, Scale::new(1.0 / 131.0, 100.0)?)?;
/// let mut random = 1_u32;
/// let verdict = loop {
///     random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
///     test.push((random >> 28) as i32);
///     match test.status() {
///         Status::Running { .. } => continue,
///         verdict => break verdict,
///     }
/// };
/// assert_eq!(verdict, Status::Passed);
/// assert!(test.accumulator().samples() < 1000); // ten seconds instead of ten minutes
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct SelfTest<const OCTAVES: usize> {
    accumulator: Accumulator<OCTAVES>,
    integrity: Integrity,
    plan: Plan,
    scale: Scale,
    last: u64,
    next: u64,
    /// Standard errors that pass a gyro.
    pass: Real,
    /// Probability of a false fail that is left for the looks to come: each spends half of it, the last
    /// one all. Early looks have most need of it, and a gyro that is far off fails at one.
    fail_left: Real,
    looks: u32,
    kept: Choice,
    status: Status,
}

impl<const OCTAVES: usize> SelfTest<OCTAVES> {
    /// Ready for samples.
    ///
    /// # Errors
    /// [`InvalidPlan`].
    pub fn new(plan: Plan, scale: Scale) -> Result<Self, InvalidPlan> {
        let (first, last) = plan.check(scale, OCTAVES)?;
        let looks = 1 + last.div_ceil(first).next_power_of_two().ilog2();
        let limits = plan.limits.len().max(1) as Real;
        Ok(Self {
            accumulator: Accumulator::new(),
            integrity: Integrity::default(),
            scale,
            last,
            next: first,
            pass: quantile(plan.false_pass / real(looks)),
            fail_left: plan.false_fail / limits,
            looks,
            kept: Choice::default(),
            status: Status::Running {
                progress: 0.0,
                expected_s: last as Real / scale.rate_hz(),
            },
            plan,
        })
    }

    /// With limits of what a record must be like to be believed.
    #[must_use]
    pub fn with_integrity(mut self, integrity: Integrity) -> Self {
        self.integrity = integrity;
        self
    }

    /// Adds a count: the accumulator's work and that of the integrity, no more.
    pub fn push(&mut self, count: i32) {
        self.accumulator.push(count);
        self.integrity.push(count);
    }

    /// Samples were lost.
    pub fn gap(&mut self) {
        self.accumulator.gap();
        self.integrity.gap();
    }

    /// The record so far.
    pub fn accumulator(&self) -> &Accumulator<OCTAVES> {
        &self.accumulator
    }

    /// How the test stands. Where a look is due it takes that of a [`fit`](crate::fit()), otherwise next to
    /// nothing; nothing is lost by asking late.
    pub fn status(&mut self) -> Status {
        let samples = self.accumulator.samples();
        if let Status::Running { progress, .. } = &mut self.status {
            *progress = single((samples as Real / self.last as Real).min(1.0));
            if samples >= self.next {
                self.status = self.look(samples);
                while self.next <= samples {
                    let twice = self.next.saturating_mul(2);
                    self.next = twice.min(self.last.max(samples.saturating_add(1)));
                }
            }
        }
        self.status
    }

    #[inline(never)]
    fn look(&mut self, samples: u64) -> Status {
        if let Some(reason) = self.integrity.verdict() {
            return Status::Invalid(reason);
        }
        let is_last = samples >= self.last;
        let seconds = samples as Real / self.scale.rate_hz();
        let curve = self.accumulator.curve(self.scale);
        let model = Model::ieee_952();
        let mut work = Work::new();
        let tolerance = Tolerance::IfNeeded(Options::default().tolerance);
        let solved = check(curve.points(), 2)
            .and_then(|()| work.begin_at(&curve, &model, Start::Independent, tolerance))
            .and_then(|()| {
                let problem = Problem::new(&curve, &model, &work.columns);
                while !work.solver.advance(&problem)? {}
                Ok(())
            });
        let problem = Problem::new(&curve, &model, &work.columns);
        let solver = &work.solver;
        if solved.is_err() {
            // Gaps may have left too few differences; the first limit stands for all.
            return if is_last {
                self.undecided(0, None)
            } else {
                self.running(samples, Real::INFINITY)
            };
        }
        let mut fit = Fit::empty();
        let mut estimator = Estimator::new(&problem, solver, &mut fit);
        while !estimator.advance(&problem, solver, &mut fit) {}
        let spent = if is_last { 1.0 } else { 0.5 } * self.fail_left;
        self.fail_left -= spent;
        let fail = quantile(spent);
        if fit.p_value < self.plan.least_p / real(self.looks) {
            return Status::Failed(Failure::Misfit {
                p_value: fit.p_value,
            });
        }
        let mut open: Option<(usize, Real)> = None;
        for (i, limit) in numbered(self.plan.limits.iter()) {
            if self.kept.has(i) {
                continue;
            }
            let Some(at) = model.position(limit.effect) else {
                continue;
            };
            let Some(coefficient) = fit.coefficients.get(at) else {
                continue;
            };
            let beside = solver.error_beside(&problem, at);
            match side(coefficient, beside, limit.most, self.pass, fail) {
                Side::Below => self.kept.add(i),
                Side::Above => {
                    return Status::Failed(Failure::Limit {
                        limit: *limit,
                        value: coefficient.value,
                    });
                }
                Side::Open { standard_errors } => {
                    let needed = self.needed_s(coefficient, standard_errors, fail, seconds);
                    if open.is_none_or(|(_, longest)| needed > longest) {
                        open = Some((i, needed));
                    }
                }
            }
        }
        match open {
            None if self.plan.limits.is_empty() && !is_last => {
                self.running(samples, Real::INFINITY)
            }
            None => Status::Passed,
            Some((_, needed)) if !is_last => self.running(samples, needed),
            Some((i, needed)) => self.undecided(i, needed.is_finite().then_some(needed)),
        }
    }

    /// Length of a record that would decide, if the estimate is right: errors fall with its root.
    fn needed_s(
        &self,
        coefficient: &Coefficient,
        standard_errors: Real,
        fail: Real,
        seconds: Real,
    ) -> Real {
        if let State::NotObservable { after_s } = coefficient.state {
            return after_s.unwrap_or(Real::INFINITY);
        }
        let enough = if standard_errors < 0.0 {
            self.pass
        } else {
            fail
        };
        let factor = enough / standard_errors;
        let longest = (1_u64 << 30) as Real / self.scale.rate_hz();
        let needed = seconds * factor * factor;
        if needed <= longest {
            needed
        } else {
            Real::INFINITY
        }
    }

    /// The look after that many seconds, or the last.
    fn running(&self, samples: u64, needed_s: Real) -> Status {
        let mut look = self.next;
        while look < self.last && (look as Real) < needed_s * self.scale.rate_hz() {
            look = look.saturating_mul(2).min(self.last);
        }
        Status::Running {
            progress: single(samples as Real / self.last as Real),
            expected_s: look.saturating_sub(samples) as Real / self.scale.rate_hz(),
        }
    }

    fn undecided(&self, i: usize, decided_by_s: Option<Real>) -> Status {
        let of_misfit = Limit {
            effect: "misfit",
            most: self.plan.least_p,
        };
        Status::Undecided {
            limit: self.plan.limits.get(i).copied().unwrap_or(of_misfit),
            decided_by_s,
        }
    }
}
