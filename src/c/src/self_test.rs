//! The self-test of an axis, in pieces.

use crate::{
    fit::AllaniteRecord,
    memory::{self, Memory, get, get_mut, put, slice, status},
    reason::AllaniteReason,
    sizes::{ALLANITE_LOOK_WORDS, ALLANITE_OCTAVES, ALLANITE_SELF_TEST_WORDS},
    status::AllaniteStatus,
};
use allanite::{
    Real, Scale,
    effect::IEEE_952,
    self_test::{BIAS, Failure, Limit, Look, Plan, SelfTest, Status},
    storage::EffectCode,
};
use heapless::Vec;

/// A self-test of one axis.
#[repr(C)]
pub struct AllaniteSelfTest {
    /// Nothing for the caller to read.
    words: [u64; ALLANITE_SELF_TEST_WORDS],
}

// SAFETY: the type is words, and the mark is its own.
unsafe impl Memory for AllaniteSelfTest {
    type Value = SelfTest<ALLANITE_OCTAVES>;
    const MARK: u64 = 0x6779_726f_0000_0003 + ALLANITE_OCTAVES as u64 * 0x100;
}

/// A look of a self-test at a record, in progress.
#[repr(C)]
pub struct AllaniteLook {
    /// Nothing for the caller to read.
    words: [u64; ALLANITE_LOOK_WORDS],
}

// SAFETY: the type is words, and the mark is its own.
unsafe impl Memory for AllaniteLook {
    type Value = Look<ALLANITE_OCTAVES>;
    const MARK: u64 = 0x6779_726f_0000_0004 + ALLANITE_OCTAVES as u64 * 0x100;
}

/// Stands for the mean rate where a limit asks for the code of an effect: the bias of a gyro at rest, with the part of the
/// earth's rate that it sees.
pub const ALLANITE_LIMIT_BIAS: i32 = -1;

/// The largest value that a coefficient or the mean rate may have.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct AllaniteLimit {
    /// The code of one of the five terms of IEEE Std 952, such as `ALLANITE_EFFECT_ANGLE_RANDOM_WALK`, or
    /// `ALLANITE_LIMIT_BIAS`.
    pub effect: i32,
    /// The largest value, in the coefficient's unit; of the mean rate, that of either sign, in rate units.
    pub most: f32,
}

/// The plan of a self-test, as `allanite::self_test::Plan` explains it.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct AllanitePlan {
    /// The smallest p-value of the fit of five terms; 0 requires nothing.
    pub least_p: f32,
    /// The largest probability that a gyro at one of its limits passes.
    pub false_pass: f32,
    /// The largest probability that a gyro at all of its limits fails.
    pub false_fail: f32,
    /// The length of the record at the first look, in seconds.
    pub shortest_s: f32,
    /// The length of the record at the last look, in seconds.
    pub longest_s: f32,
}

/// How a self-test stands.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AllaniteVerdict {
    /// It needs more samples.
    Running = 0,
    /// The gyro keeps every limit.
    Passed = 1,
    /// A coefficient is above its limit.
    FailedLimit = 2,
    /// The five terms do not explain the record.
    FailedMisfit = 3,
    /// The longest record did not decide.
    Undecided = 4,
    /// The record is not that of a gyro at rest.
    Invalid = 5,
}

/// How a self-test stands, with numbers.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct AllaniteTestStatus {
    /// How it stands.
    pub verdict: AllaniteVerdict,
    /// The code of the effect whose limit is not kept or undecided, or `ALLANITE_LIMIT_BIAS`; 0 otherwise.
    pub effect: i32,
    /// The value above its limit, or the p-value of a misfit, or the progress from 0 to 1; 0 otherwise.
    pub value: f32,
    /// The time in seconds until a verdict is expected, or the length that would decide; 0 if it is not known.
    pub expected_s: f32,
    /// Why the record is not valid.
    pub reason: AllaniteReason,
}

/// The code of a limit, by its name.
fn code(name: &str) -> i32 {
    if name == BIAS {
        return ALLANITE_LIMIT_BIAS;
    }
    let effect = IEEE_952.iter().find(|effect| effect.name() == name);
    effect.map_or(0, |effect| EffectCode::of(*effect).number().into())
}

impl AllaniteTestStatus {
    // The casts change nothing in single precision, in which every published library is built.
    #[allow(clippy::unnecessary_cast)]
    fn of(status: Status) -> Self {
        let none = Self {
            verdict: AllaniteVerdict::Running,
            effect: 0,
            value: 0.0,
            expected_s: 0.0,
            reason: AllaniteReason::Valid,
        };
        match status {
            Status::Running {
                progress,
                expected_s,
            } => Self {
                value: progress,
                expected_s: expected_s as f32,
                ..none
            },
            Status::Passed => Self {
                verdict: AllaniteVerdict::Passed,
                ..none
            },
            Status::Failed(Failure::Limit { limit, value }) => Self {
                verdict: AllaniteVerdict::FailedLimit,
                effect: code(limit.effect),
                value: value as f32,
                ..none
            },
            Status::Failed(Failure::Misfit { p_value }) => Self {
                verdict: AllaniteVerdict::FailedMisfit,
                value: p_value as f32,
                ..none
            },
            Status::Undecided {
                limit,
                decided_by_s,
            } => Self {
                verdict: AllaniteVerdict::Undecided,
                effect: code(limit.effect),
                expected_s: decided_by_s.unwrap_or(0.0) as f32,
                ..none
            },
            Status::Invalid(reason) => Self {
                verdict: AllaniteVerdict::Invalid,
                reason: AllaniteReason::of(Some(reason)),
                ..none
            },
        }
    }
}

/// Makes a self-test of a plan with so many limits. `bytes` is `sizeof(AllaniteSelfTest)`.
///
/// # Safety
/// `test` is null, or points to an `AllaniteSelfTest` that nothing else uses; `plan` is null, or points to a plan; `limits`
/// is null, or points to `count` limits.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn allanite_self_test_init(
    test: *mut AllaniteSelfTest,
    bytes: usize,
    plan: *const AllanitePlan,
    limits: *const AllaniteLimit,
    count: usize,
    rate_per_count: f32,
    rate_hz: f32,
) -> AllaniteStatus {
    // SAFETY: the caller promises what `slice` wants.
    let plan = match unsafe { slice(plan, 1) } {
        Ok([plan]) => *plan,
        Ok(_) => return AllaniteStatus::NullPointer,
        Err(error) => return error,
    };
    // SAFETY: the caller promises what `slice` wants.
    let limits = match unsafe { slice(limits, count) } {
        Ok(limits) => limits,
        Err(error) => return error,
    };
    // The conversions change nothing in single precision, in which every published library is built.
    #[allow(clippy::useless_conversion)]
    let made = || {
        let mut named = Vec::new();
        for limit in limits {
            let mut effects = IEEE_952.iter();
            let effect =
                effects.find(|one| i32::from(EffectCode::of(**one).number()) == limit.effect);
            let name = match limit.effect {
                ALLANITE_LIMIT_BIAS => BIAS,
                _ => effect.ok_or(AllaniteStatus::InvalidPlan)?.name(),
            };
            let limit = Limit {
                effect: name,
                most: limit.most.into(),
            };
            named.push(limit).map_err(|_| AllaniteStatus::InvalidPlan)?;
        }
        let plan = Plan {
            limits: named,
            least_p: plan.least_p.into(),
            false_pass: plan.false_pass.into(),
            false_fail: plan.false_fail.into(),
            shortest_s: plan.shortest_s.into(),
            longest_s: plan.longest_s.into(),
        };
        let scale = Scale::new(Real::from(rate_per_count), Real::from(rate_hz))?;
        Ok(SelfTest::new(plan, scale)?)
    };
    // SAFETY: the caller promises what `make` wants.
    status(unsafe { memory::make(test, bytes, made) })
}

/// Whether a look is due at this number of samples.
///
/// # Safety
/// `test` is null, or points to an `AllaniteSelfTest`; `due` is null, or points to a `bool`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn allanite_self_test_is_due(
    test: *const AllaniteSelfTest,
    samples: u64,
    due: *mut bool,
) -> AllaniteStatus {
    // SAFETY: the caller promises what `get` wants.
    match unsafe { get(test) } {
        Err(error) => error,
        // SAFETY: the caller promises what `put` wants.
        Ok(test) => status(unsafe { put(due, test.is_due(samples)) }),
    }
}

/// How the self-test stands at this number of samples.
///
/// # Safety
/// `test` is null, or points to an `AllaniteSelfTest`; `to` is null, or points to an `AllaniteTestStatus`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn allanite_self_test_status(
    test: *const AllaniteSelfTest,
    samples: u64,
    to: *mut AllaniteTestStatus,
) -> AllaniteStatus {
    // SAFETY: the caller promises what `get` wants.
    match unsafe { get(test) } {
        Err(error) => error,
        Ok(test) => {
            let stands = AllaniteTestStatus::of(test.status(samples));
            // SAFETY: the caller promises what `put` wants.
            status(unsafe { put(to, stands) })
        }
    }
}

/// Begins a look of a self-test at the record of its axis. `bytes` is `sizeof(AllaniteLook)`. The record may change
/// afterwards. A record of another scale than the test's is refused.
///
/// # Safety
/// `look` is null, or points to an `AllaniteLook` that nothing else uses; the others are null, or point to what they say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn allanite_look_begin(
    look: *mut AllaniteLook,
    bytes: usize,
    test: *mut AllaniteSelfTest,
    record: *const AllaniteRecord,
) -> AllaniteStatus {
    // SAFETY: the caller promises what `get_mut` wants.
    let test = match unsafe { get_mut(test) } {
        Ok(test) => test,
        Err(error) => return error,
    };
    // SAFETY: the caller promises what `get` wants.
    let record = match unsafe { get(record) } {
        Ok(taken) => &taken.record,
        Err(error) => return error,
    };
    let begun = || test.begin_look(record).map_err(Into::into);
    // SAFETY: the caller promises what `make` wants.
    status(unsafe { memory::make(look, bytes, begun) })
}

/// Does one piece of a look, at most 2 million instructions on a Cortex-M4F. `complete` says whether it was the last.
///
/// # Safety
/// `look` is null, or points to an `AllaniteLook`; `complete` is null, or points to a `bool`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn allanite_look_advance(
    look: *mut AllaniteLook,
    complete: *mut bool,
) -> AllaniteStatus {
    // SAFETY: the caller promises what `get_mut` wants.
    match unsafe { get_mut(look) } {
        Err(error) => error,
        // SAFETY: the caller promises what `put` wants.
        Ok(look) => status(unsafe { put(complete, look.advance()) }),
    }
}

/// Takes up a look, and returns the state of the self-test. What the look still lacks is done at once. A look that another
/// self-test began is refused, and so is one that was concluded before.
///
/// # Safety
/// All are null, or point to what they say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn allanite_look_conclude(
    test: *mut AllaniteSelfTest,
    look: *mut AllaniteLook,
    to: *mut AllaniteTestStatus,
) -> AllaniteStatus {
    // SAFETY: the caller promises what `get_mut` wants.
    let look = match unsafe { get_mut(look) } {
        Ok(look) => look,
        Err(error) => return error,
    };
    // SAFETY: the caller promises what `get_mut` wants.
    match unsafe { get_mut(test) } {
        Err(error) => error,
        Ok(test) => match test.conclude(look) {
            Err(error) => error.into(),
            // SAFETY: the caller promises what `put` wants.
            Ok(stands) => status(unsafe { put(to, AllaniteTestStatus::of(stands)) }),
        },
    }
}
