//! The diagnosis of an axis, step by step.

use crate::{
    fit::{AllaniteFit, AllaniteRecord, Taken},
    gyro::BINS,
    memory::{self, Memory, get, get_mut, put, status},
    sizes::{ALLANITE_DIAGNOSIS_WORDS, ALLANITE_OCTAVES},
    status::AllaniteStatus,
};
use allanite::{
    Model,
    diagnosis::{Addition, Dependence, Diagnosis, Options, Progress, Verdict},
    effect::CATALOGUE,
    storage::AxisCertificate,
};
use core::{ffi::c_void, ops::ControlFlow};

/// A diagnosis in progress, and what it has found.
pub(crate) struct Diagnosing {
    taken: &'static Taken,
    diagnosis: Diagnosis<'static, ALLANITE_OCTAVES, BINS>,
    fit: AllaniteFit,
    dependence: AllaniteDependence,
    pub(crate) certificate: AxisCertificate,
    pub(crate) verdict: Option<Verdict>,
}

/// A diagnosis of one axis. It must stay where it is.
#[repr(C)]
pub struct AllaniteDiagnosis {
    /// Nothing for the caller to read.
    words: [u64; ALLANITE_DIAGNOSIS_WORDS],
}

// SAFETY: the type is words, and the mark is its own.
unsafe impl Memory for AllaniteDiagnosis {
    type Value = Diagnosing;
    const MARK: u64 = 0x6779_726f_0000_0005 + ALLANITE_OCTAVES as u64 * 0x100;
}

/// What a diagnosis has led to.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AllaniteProgress {
    /// The pause ended the work. There is more to do.
    Working = 0,
    /// A model is judged: `allanite_diagnosis_fit` gives it. There is more to do.
    Step = 1,
    /// The five terms explain the record.
    Adequate = 2,
    /// The last model, with effects that were missing, explains the record.
    Improved = 3,
    /// The effects that were found improve the model, but it does not explain the record.
    Incomplete = 4,
    /// The five terms do not explain the record, and no effect helps.
    Unexplained = 5,
    /// The record is too short to judge the five terms.
    TooShort = 6,
    /// The record is not that of a gyro at rest.
    Invalid = 7,
    /// Another verdict, of a later version.
    Other = 8,
}

impl AllaniteProgress {
    fn of(verdict: Verdict) -> Self {
        match verdict {
            Verdict::Adequate => Self::Adequate,
            Verdict::Improved => Self::Improved,
            Verdict::Incomplete => Self::Incomplete,
            Verdict::Unexplained => Self::Unexplained,
            Verdict::TooShort => Self::TooShort,
            Verdict::Invalid(_) => Self::Invalid,
            _ => Self::Other,
        }
    }
}

/// How the rate follows the temperature. All numbers are NaN if it does not.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct AllaniteDependence {
    /// The change of the rate for each kelvin, in the unit of the rate.
    pub slope: f32,
    /// Its standard error.
    pub slope_error: f32,
    /// By how much the rate is late, in seconds.
    pub lag_s: f32,
    /// The standard error of the lag; NaN if the rate follows one of the bank's temperatures alone, whose lag is then near the true
    /// one.
    pub lag_error_s: f32,
}

impl AllaniteDependence {
    const NONE: Self = Self {
        slope: f32::NAN,
        slope_error: f32::NAN,
        lag_s: f32::NAN,
        lag_error_s: f32::NAN,
    };
}

impl From<Dependence> for AllaniteDependence {
    // The conversions change nothing in single precision.
    #[allow(clippy::unnecessary_cast)]
    fn from(found: Dependence) -> Self {
        Self {
            slope: found.slope.value as f32,
            slope_error: found.slope.error as f32,
            lag_s: found.lag_s as f32,
            lag_error_s: found.lag_error_s.map_or(f32::NAN, |error| error as f32),
        }
    }
}

/// Begins a diagnosis of an axis: what do the five terms lack? `bytes` is `sizeof(AllaniteDiagnosis)`.
///
/// # Safety
/// `diagnosis` is null, or points to an `AllaniteDiagnosis` that nothing else uses; `record` is null, or points to an
/// `AllaniteRecord` that stays there, unchanged, for as long as the diagnosis is used.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn allanite_diagnosis_begin(
    diagnosis: *mut AllaniteDiagnosis,
    bytes: usize,
    record: *const AllaniteRecord,
) -> AllaniteStatus {
    // SAFETY: the caller promises what `get` wants, for as long as the diagnosis is used.
    let taken: &'static Taken = match unsafe { get(record) } {
        Ok(taken) => taken,
        Err(error) => return error,
    };
    let begun = || {
        let (model, options) = (Model::ieee_952(), Options::default());
        Ok(Diagnosing {
            taken,
            diagnosis: Diagnosis::new(&taken.record, &model, &CATALOGUE, options),
            fit: AllaniteFit::EMPTY,
            dependence: AllaniteDependence::NONE,
            certificate: AxisCertificate::empty(),
            verdict: None,
        })
    };
    // SAFETY: the caller promises what `make` wants.
    status(unsafe { memory::make(diagnosis, bytes, begun) })
}

/// Works until the next step of a diagnosis and returns what it has led to. That takes long;
/// `allanite_diagnosis_advance_with` pauses meanwhile. After the end, it returns the verdict again.
///
/// # Safety
/// `diagnosis` is null, or points to an `AllaniteDiagnosis`; `progress` is null, or points to an `AllaniteProgress`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn allanite_diagnosis_advance(
    diagnosis: *mut AllaniteDiagnosis,
    progress: *mut AllaniteProgress,
) -> AllaniteStatus {
    // SAFETY: the caller promises what `advance` wants.
    unsafe { advance(diagnosis, progress, &mut || ControlFlow::Continue(())) }
}

/// Does what `allanite_diagnosis_advance` does, and calls `pause` with `context` between two pieces of work, for the
/// watchdog and the next samples. A piece takes at most 2 million instructions on a Cortex-M4F, except for the one that
/// reports a step, which takes as much as a fit for the correlations of a certificate. If `pause` returns false, the work in
/// progress is given up, `progress` is `ALLANITE_PROGRESS_WORKING`, and the next call begins this work anew.
///
/// # Safety
/// `diagnosis` is null, or points to an `AllaniteDiagnosis`; `progress` is null, or points to an `AllaniteProgress`. `pause`
/// is null, or a function that returns, and that uses neither the diagnosis nor its record.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn allanite_diagnosis_advance_with(
    diagnosis: *mut AllaniteDiagnosis,
    progress: *mut AllaniteProgress,
    pause: Option<unsafe extern "C" fn(context: *mut c_void) -> bool>,
    context: *mut c_void,
) -> AllaniteStatus {
    let Some(pause) = pause else {
        return AllaniteStatus::NullPointer;
    };
    let mut pause = || {
        // SAFETY: the caller promises that it is a function that may be called here.
        match unsafe { pause(context) } {
            true => ControlFlow::Continue(()),
            false => ControlFlow::Break(()),
        }
    };
    // SAFETY: the caller promises what `advance` wants.
    unsafe { advance(diagnosis, progress, &mut pause) }
}

/// Works until the next step, or until the pause ends the work.
///
/// # Safety
/// As of [`allanite_diagnosis_advance`].
unsafe fn advance(
    diagnosis: *mut AllaniteDiagnosis,
    progress: *mut AllaniteProgress,
    pause: &mut dyn FnMut() -> ControlFlow<()>,
) -> AllaniteStatus {
    // SAFETY: the caller promises what `get_mut` wants.
    let it = match unsafe { get_mut(diagnosis) } {
        Ok(it) => it,
        Err(error) => return error,
    };
    let Diagnosing {
        taken,
        diagnosis,
        fit,
        dependence,
        certificate,
        verdict,
    } = it;
    let reached = match diagnosis.advance(pause) {
        Err(error) => return error.into(),
        Ok(Progress::Paused) => AllaniteProgress::Working,
        Ok(Progress::Step(step)) => {
            *fit = AllaniteFit::of(&step.model, &step.fit);
            if let Some(Addition::Covariate(followed)) = &step.added {
                let found = followed.dependence(&taken.lags, taken.rate_hz);
                *dependence = found.map_or(AllaniteDependence::NONE, Into::into);
            }
            if let Err(error) = certificate.take(&taken.record, step) {
                return error.into();
            }
            AllaniteProgress::Step
        }
        Ok(Progress::Finished(reached)) => {
            *verdict = Some(reached);
            certificate.verdict = Some(reached);
            AllaniteProgress::of(reached)
        }
    };
    // SAFETY: the caller promises what `put` wants.
    status(unsafe { put(progress, reached) })
}

/// The model of the last step, fitted.
///
/// # Safety
/// `diagnosis` is null, or points to an `AllaniteDiagnosis`; `to` is null, or points to an `AllaniteFit`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn allanite_diagnosis_fit(
    diagnosis: *const AllaniteDiagnosis,
    to: *mut AllaniteFit,
) -> AllaniteStatus {
    // SAFETY: the caller promises what `get` wants.
    match unsafe { get(diagnosis) } {
        Err(error) => error,
        // SAFETY: the caller promises what `put` wants.
        Ok(it) => status(unsafe { put(to, it.fit) }),
    }
}

/// How the rate follows the temperature in the model of the last step, also behind a lag: what of the temperature was then taken out of
/// the record.
///
/// # Safety
/// `diagnosis` is null, or points to an `AllaniteDiagnosis`; `to` is null, or points to an `AllaniteDependence`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn allanite_diagnosis_dependence(
    diagnosis: *const AllaniteDiagnosis,
    to: *mut AllaniteDependence,
) -> AllaniteStatus {
    // SAFETY: the caller promises what `get` wants.
    match unsafe { get(diagnosis) } {
        Err(error) => error,
        // SAFETY: the caller promises what `put` wants.
        Ok(it) => status(unsafe { put(to, it.dependence) }),
    }
}
