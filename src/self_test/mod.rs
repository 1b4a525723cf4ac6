//! A self-test with limits. It looks at a growing record and gives a verdict as early as the record allows.

mod look;
mod plan;
mod quantile;
#[cfg(feature = "storage")]
mod stored;

#[cfg(feature = "storage")]
pub(crate) use stored::LONGEST;

pub use look::Look;
pub use plan::{BIAS, InvalidPlan, Limit, Plan};

use crate::{
    curve::Scale,
    error::Error,
    evidence::axis::AxisRecord,
    fit::{ADEQUATE_P, coefficient::State},
    ieee_952::Fit,
    list::numbered,
    numerics::{
        algebra::Choice,
        real::{Real, real, single},
    },
    record::{integrity::Reason, octave::Accumulator},
};
use look::{Compared, Mark, Observed};
use quantile::quantile;

/// Below this p-value of all looks together the five terms do not explain a curve at the last look, whatever the plan
/// asks for, and an undecided gyro fails. It is so small that it adds next to nothing to the false fails of a plan.
const MISFIT: Real = 1e-6;

/// The state of a self-test.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Status {
    /// The test needs more samples.
    Running {
        /// The length of the record as a share of the longest record, 0 to 1.
        progress: f32,
        /// The time from now to the look at which a verdict is expected, in seconds. Until the first look,
        /// the last look is expected to decide.
        expected_s: Real,
    },
    /// The gyro keeps every limit.
    Passed,
    /// The gyro does not keep a limit.
    Failed(Failure),
    /// The longest record did not decide the test.
    Undecided {
        /// The limit that is undecided.
        limit: Limit,
        /// The length in seconds of a record that would decide if its estimate is right; `None` if no
        /// record of up to 2³⁰ samples would.
        decided_by_s: Option<Real>,
    },
    /// The samples cannot come from a gyro at rest.
    Invalid(Reason),
}

/// What a look shows of a limit.
struct Measured {
    value: Real,
    /// How far it lies above the limit, in standard errors.
    above: Real,
    state: State,
}

/// What a look at a record of so many seconds shows of a limit; `None` if it cannot be compared.
fn measured<const OCTAVES: usize>(
    look: &Look<OCTAVES>,
    fit: &Fit,
    limit: &Limit,
    seconds: Real,
) -> Option<Measured> {
    if limit.effect == BIAS {
        let value = look.mean_rate?.abs();
        return Some(Measured {
            value,
            above: (value - limit.most) / fit.deviation(seconds),
            state: State::Measured,
        });
    }
    let compared = look.compared(limit)?;
    let coefficient = fit.coefficients.get(compared.place)?;
    Some(Measured {
        value: coefficient.value,
        above: compared.above?,
        state: coefficient.state,
    })
}

/// The requirement that a gyro did not meet.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Failure {
    /// The bias is above its limit; or a coefficient is, and the five terms explain the curve: its p-value is
    /// [`ADEQUATE_P`] or more.
    Limit {
        /// The limit that the coefficient exceeds.
        limit: Limit,
        /// The measured value of the coefficient, in the unit of the limit.
        value: Real,
    },
    /// The five terms do not explain the curve. Either its p-value is below the one that the plan asks for, or it is
    /// below [`ADEQUATE_P`] and a coefficient is above its limit, or it is below 10⁻⁶ and a
    /// coefficient is undecided at the last look. Such a curve has an effect that the five terms lack, such as a
    /// vibration. Of the gyros that the five terms explain and that fail a limit, one in a hundred is called so, too.
    Misfit {
        /// The probability of a χ² this large or larger if the five terms explained the curve.
        p_value: Real,
    },
}

/// A self-test of one axis.
///
/// # The statistics
///
/// The test looks at the record at the shortest length, whenever the record has doubled, and at the
/// longest length. At each look it [fits the five terms](crate::ieee_952), and compares each limit with the curve by the
/// likelihood ratio (Wilks 1938): the curve is fitted once more with the coefficient held at its limit and
/// the others free, also those that the first fit held at zero. The covariance of the curve is taken at
/// that fit, because the question is how far chance may carry the curve of a gyro that is at its limit.
/// The signed root of the difference in χ² between this fit and the best one is compared with the
/// quantile of the normal distribution. The standard error of a mean rate, for a limit of the [bias](BIAS), is the Allan
/// deviation that the fit gives for the length of the record.
///
/// Each look is a chance of an error. Therefore the probabilities of the plan are divided evenly among the
/// looks (Bonferroni 1936), and that of a false fail also among the limits. That of a false pass is not,
/// because a false pass requires one particular coefficient above its limit to pass, whatever the others
/// do. Looks share samples, so that the errors are fewer than the plan allows. A decision is final: later
/// looks do not repeat it.
///
/// A gyro fails at any look, and passes limits of quantization, angle random walk and bias at any. Those of bias instability,
/// rate random walk and rate ramp pass at the last look only: noise that is slower than the record so far is not in it, and the
/// longest record of the plan says up to which time the limits hold.
///
/// # How to use it
///
/// The test holds no samples. [`is_due`](Self::is_due) says after each sample whether a look is due, at the
/// cost of one comparison. The caller then takes the [`look`](Self::look) at a curve when it has time for a
/// [fit of the five terms](crate::ieee_952::fit()) and one more for each undecided limit. A late look loses nothing.
///
/// # Example
///
/// ```
/// use allanite::{Axis, Scale, self_test::{Limit, Plan, SelfTest, Status}};
///
/// let plan = Plan {
///     limits: [Limit { effect: "angle_random_walk", most: 0.02 }].into_iter().collect(),
///     least_p: 1e-3,
///     false_pass: 0.01,
///     false_fail: 0.01,
///     shortest_s: 1.0,
///     longest_s: 600.0,
/// };
/// // 131 counts per °/s, at 100 Hz.
/// let scale = Scale::new(1.0 / 131.0, 100.0)?;
/// let mut gyro = Axis::<16>::new();
/// let mut test = SelfTest::<16>::new(plan, scale)?;
/// let mut random = 1_u32;
/// let verdict = loop {
///     random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
///     gyro.push((random >> 28) as i32);
///     if test.is_due(gyro.samples()) {
///         let record = gyro.record_so_far(0, scale)?;
///         match test.look(&record)? {
///             Status::Running { .. } => continue,
///             verdict => break verdict,
///         }
///     }
/// };
/// assert_eq!(verdict, Status::Passed);
/// assert!(gyro.samples() < 1000); // ten seconds instead of ten minutes
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SelfTest<const OCTAVES: usize> {
    plan: Plan,
    scale: Scale,
    /// The number of samples at the last look.
    last: u64,
    /// The distance below a limit at which a gyro passes, in standard errors.
    pass: Real,
    /// The distance above a limit at which a gyro fails, in standard errors.
    fail: Real,
    /// The number of looks in the plan.
    looks: u32,
    progress: Progress,
    /// The looks that were begun since the start.
    begun: u32,
    /// The mark of the look in progress.
    mark: Option<Mark>,
}

/// The state that changes while a test runs.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Progress {
    /// The number of samples at the next look.
    next: u64,
    /// The limits that are known to be kept.
    kept: Choice,
    /// The status at the last look.
    status: Status,
}

impl<const OCTAVES: usize> SelfTest<OCTAVES> {
    /// Makes a test of a record with `OCTAVES` octaves.
    ///
    /// # Errors
    /// [`InvalidPlan`] if the plan cannot be carried out.
    #[inline(never)]
    pub fn new(plan: Plan, scale: Scale) -> Result<Self, InvalidPlan> {
        let (first, last) = plan.check(scale, OCTAVES)?;
        // Each record is twice as long as the one before. A count needs no division of 64 bits.
        let (mut looks, mut samples) = (1_u32, first.max(1));
        while samples < last {
            (looks, samples) = (looks.saturating_add(1), samples.saturating_mul(2));
        }
        let limits = plan.limits.len().max(1) as Real;
        Ok(Self {
            scale,
            last,
            pass: quantile(plan.false_pass / real(looks)),
            fail: quantile(plan.false_fail / (real(looks) * limits)),
            looks,
            begun: 0,
            mark: None,
            progress: Progress {
                next: first,
                kept: Choice::default(),
                status: Status::Running {
                    progress: 0.0,
                    expected_s: last as Real / scale.rate_hz(),
                },
            },
            plan,
        })
    }

    /// Whether the test is running and a [`look`](Self::look) is due at this number of samples.
    #[inline]
    pub fn is_due(&self, samples: u64) -> bool {
        samples >= self.progress.next && matches!(self.progress.status, Status::Running { .. })
    }

    /// The status after the last look, with the progress at this number of samples.
    pub fn status(&self, samples: u64) -> Status {
        match self.progress.status {
            Status::Running { expected_s, .. } => Status::Running {
                progress: self.share(samples),
                expected_s,
            },
            verdict => verdict,
        }
    }

    /// Begins a look at a record, where one [is due](Self::is_due). A look that this test has begun before can no longer
    /// be concluded.
    ///
    /// # Errors
    /// [`Error::OtherRate`] and [`Error::OtherScale`] if the record has another scale than the test was made with.
    pub fn begin_look<const COVARIATES: usize, D>(
        &mut self,
        record: &AxisRecord<OCTAVES, COVARIATES, D>,
    ) -> Result<Look<OCTAVES>, Error> {
        let (record_hz, test_hz) = (record.scale.rate_hz(), self.scale.rate_hz());
        if record_hz != test_hz {
            return Err(Error::OtherRate { record_hz, test_hz });
        }
        let (unit, test) = (record.scale.rate_per_count(), self.scale.rate_per_count());
        if unit != test {
            return Err(Error::OtherScale { record: unit, test });
        }
        let observed = (record.curve.clone(), record.mean_rate, record.invalid);
        Ok(self.begin(record.samples, observed))
    }

    /// Begins a look at an accumulator of counts, whose rate and unit are those of the test: for a sensor that has no room for
    /// an [`Axis`](crate::Axis). What is wrong with the samples, if anything watches them, such as an
    /// [`Integrity`](crate::integrity::Integrity), is passed as well. A look that this test has begun before can no longer be
    /// concluded.
    #[inline(never)]
    pub fn begin_look_at(
        &mut self,
        accumulator: &Accumulator<OCTAVES>,
        invalid: Option<Reason>,
    ) -> Look<OCTAVES> {
        let scale = self.scale;
        let observed = (
            accumulator.curve(scale),
            accumulator.mean_rate(scale),
            invalid,
        );
        self.begin(accumulator.samples(), observed)
    }

    // Apart, so that no copy of the curve lies on the stack while a look is taken up.
    #[inline(never)]
    fn begin(&mut self, samples: u64, observed: Observed<OCTAVES>) -> Look<OCTAVES> {
        // No two tests that have begun a look lie at one place. A test may move afterwards.
        self.begun = self.begun.wrapping_add(1);
        let mark = (core::ptr::from_ref(self).addr(), self.begun);
        self.mark = Some(mark);
        let limits = numbered(self.plan.limits.iter());
        let undecided = limits.filter(|&(i, _)| !self.progress.kept.has(i));
        let compared = undecided.filter_map(|(_, limit)| Compared::new(limit));
        Look::new(mark, samples, observed, compared)
    }

    /// Takes up a look, and says how the test stands. What the look still lacks is done at once, so that a look that was
    /// [advanced](Look::advance) to its end takes next to no time.
    ///
    /// # Errors
    /// [`Error::OtherTest`] if the look is not the last one that this test began, or was concluded before.
    pub fn conclude(&mut self, look: &mut Look<OCTAVES>) -> Result<Status, Error> {
        if self.mark.is_none() || self.mark != look.mark {
            return Err(Error::OtherTest);
        }
        Ok(self.take_up(look))
    }

    #[inline(never)]
    fn take_up(&mut self, look: &mut Look<OCTAVES>) -> Status {
        (self.mark, look.mark) = (None, None);
        while !look.advance() {}
        let samples = look.samples;
        if self.is_due(samples) {
            self.progress.status = match look.invalid {
                Some(reason) => Status::Invalid(reason),
                None => self.judge(look),
            };
            while self.progress.next <= samples {
                let twice = self.progress.next.saturating_mul(2);
                self.progress.next = twice.min(self.last.max(samples.saturating_add(1)));
            }
        }
        self.status(samples)
    }

    /// Takes a whole look at a record in one go, and says how the test stands: [`begin_look`](Self::begin_look) and
    /// [`conclude`](Self::conclude). It takes a [`fit`](crate::fit::fit()) and one more for each undecided limit where a
    /// look is due, and next to nothing otherwise.
    ///
    /// # Errors
    /// As of [`begin_look`](Self::begin_look).
    pub fn look<const COVARIATES: usize, D>(
        &mut self,
        record: &AxisRecord<OCTAVES, COVARIATES, D>,
    ) -> Result<Status, Error> {
        if !self.is_due(record.samples) {
            return Ok(self.status(record.samples));
        }
        let mut look = self.begin_look(record)?;
        self.conclude(&mut look)
    }

    /// Takes a whole look at an accumulator in one go: [`begin_look_at`](Self::begin_look_at) and
    /// [`conclude`](Self::conclude).
    ///
    /// ```
    /// use allanite::{Accumulator, Scale, self_test::{Limit, Plan, SelfTest, Status}};
    ///
    /// let plan = Plan {
    ///     limits: [Limit { effect: "angle_random_walk", most: 0.02 }].into_iter().collect(),
    ///     least_p: 0.0,
    ///     false_pass: 0.01,
    ///     false_fail: 0.01,
    ///     shortest_s: 1.0,
    ///     longest_s: 256.0,
    /// };
    /// let mut test = SelfTest::<14>::new(plan, Scale::new(1.0 / 131.0, 100.0)?)?;
    /// let mut accumulator = Accumulator::new();
    /// let mut random = 1_u32;
    /// while let Status::Running { .. } = test.look_at(&accumulator, None) {
    ///     random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
    ///     accumulator.push((random >> 28) as i32);
    /// }
    /// assert_eq!(test.status(accumulator.samples()), Status::Passed);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[inline(never)]
    pub fn look_at(
        &mut self,
        accumulator: &Accumulator<OCTAVES>,
        invalid: Option<Reason>,
    ) -> Status {
        let samples = accumulator.samples();
        if self.is_due(samples) {
            let mut look = self.begin_look_at(accumulator, invalid);
            self.take_up(&mut look);
        }
        self.status(samples)
    }

    /// Share of the longest record that is there.
    fn share(&self, samples: u64) -> f32 {
        if samples < self.last {
            single(samples as Real / self.last as Real)
        } else {
            1.0
        }
    }

    #[inline(never)]
    fn judge(&mut self, look: &Look<OCTAVES>) -> Status {
        let samples = look.samples;
        let is_last = samples >= self.last;
        let seconds = samples as Real / self.scale.rate_hz();
        let Some(fit) = &look.fit else {
            // Gaps may have left too few differences; the first limit stands for all.
            return if is_last {
                self.undecided(0, None)
            } else {
                self.running(samples, Real::INFINITY)
            };
        };
        let p_value = fit.p_value();
        let misfit = Failure::Misfit { p_value };
        if p_value < self.plan.least_p / real(self.looks) {
            return Status::Failed(misfit);
        }
        let is_misfit = p_value < MISFIT / real(self.looks);
        let mut open: Option<(usize, Real)> = None;
        for (i, limit) in numbered(self.plan.limits.iter()) {
            if self.progress.kept.has(i) {
                continue;
            }
            let Some(Measured {
                value,
                above,
                state,
            }) = measured(look, fit, limit, seconds)
            else {
                open = Some((i, Real::INFINITY));
                continue;
            };
            // The fit must lie on the same side, so that no value within the limit fails.
            if above < -self.pass && value < limit.most {
                if is_last || limit.passes_early() {
                    self.progress.kept.add(i);
                } else {
                    open = Some((i, Real::INFINITY));
                }
            } else if above > self.fail && limit.effect == BIAS {
                // The mean of a record at rest is what it is, whatever effect its curve lacks.
                return Status::Failed(Failure::Limit {
                    limit: *limit,
                    value,
                });
            } else if above > self.fail && value > limit.most {
                // An effect that the five terms lack, such as a vibration, must not be blamed on one of them. The
                // gyro fails either way, so that the usual threshold of an adequate fit adds no false fail.
                return Status::Failed(if p_value < ADEQUATE_P {
                    misfit
                } else {
                    Failure::Limit {
                        limit: *limit,
                        value,
                    }
                });
            } else {
                let needed = self.needed_s(state, above, seconds);
                if open.is_none_or(|(_, longest)| needed > longest) {
                    open = Some((i, needed));
                }
            }
        }
        match open {
            None if self.plan.limits.is_empty() && !is_last => {
                self.running(samples, Real::INFINITY)
            }
            None => Status::Passed,
            Some((_, needed)) if !is_last => self.running(samples, needed),
            // A longer record would not tell more of a gyro that the five terms do not explain.
            Some(_) if is_misfit => Status::Failed(misfit),
            Some((i, needed)) => self.undecided(i, (needed < Real::INFINITY).then_some(needed)),
        }
    }

    /// The length in seconds of a record that would decide, if the estimate is right. Standard errors fall
    /// with the square root of the length.
    fn needed_s(&self, state: State, standard_errors: Real, seconds: Real) -> Real {
        if let State::NotObservable { after_s } = state {
            return after_s.unwrap_or(Real::INFINITY);
        }
        let enough = if standard_errors < 0.0 {
            self.pass
        } else {
            self.fail
        };
        let factor = enough / standard_errors;
        let longest = (1_u64 << 30) as Real / self.scale.rate_hz();
        let needed = seconds * factor * factor;
        if longest < needed {
            Real::INFINITY
        } else {
            needed
        }
    }

    /// The status that expects a verdict at the first look after `needed_s` seconds, or at the last look.
    fn running(&self, samples: u64, needed_s: Real) -> Status {
        let mut look = self.progress.next;
        while look < self.last && (look as Real) < needed_s * self.scale.rate_hz() {
            look = look.saturating_mul(2).min(self.last);
        }
        Status::Running {
            progress: self.share(samples),
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
