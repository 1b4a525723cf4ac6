//! The record of an axis, and fits of models to it.

use crate::{
    coefficient::{AllaniteCoefficient, AllaniteState},
    curve::{AllanitePoint, write_points},
    gyro::{AllaniteGyro, BINS, COVARIATES},
    memory::{self, Memory, get, put, status},
    reason::AllaniteReason,
    sizes::{ALLANITE_OCTAVES, ALLANITE_RECORD_WORDS},
    status::AllaniteStatus,
};
use allanite::{
    Model, Real, Scale,
    axis::AxisRecord,
    covariate::Lags,
    fit::{Fit, Options, fit},
    spectrum::Spectrum,
    storage::EffectCode,
};

pub(crate) type Record = AxisRecord<ALLANITE_OCTAVES, COVARIATES, Spectrum<BINS>>;

/// A record, and the lags of its thermometer in samples of this rate.
pub(crate) struct Taken {
    pub(crate) record: Record,
    pub(crate) lags: Lags<COVARIATES>,
    pub(crate) rate_hz: Real,
}

/// What a record says about one axis at a moment. It must stay where it is, unchanged, while a look or a diagnosis uses
/// it.
#[repr(C)]
pub struct AllaniteRecord {
    /// Nothing for the caller to read.
    words: [u64; ALLANITE_RECORD_WORDS],
}

// SAFETY: the type is words, and the mark is its own.
unsafe impl Memory for AllaniteRecord {
    type Value = Taken;
    const MARK: u64 = 0x6779_726f_0000_0012 + ALLANITE_OCTAVES as u64 * 0x100;
}

/// Takes the record of an axis from a gyro, to which it does not belong afterwards. `bytes` is
/// `sizeof(AllaniteRecord)`. `rate_per_count` is the rate of one count, `rate_hz` the number of samples per second, and
/// `kelvin_per_count` the temperature of one count of the thermometer.
///
/// # Safety
/// `record` is null, or points to an `AllaniteRecord` that nothing else uses; `gyro` is null, or points to an
/// `AllaniteGyro`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn allanite_record_take(
    record: *mut AllaniteRecord,
    bytes: usize,
    gyro: *const AllaniteGyro,
    axis: usize,
    rate_per_count: f32,
    rate_hz: f32,
    kelvin_per_count: f32,
) -> AllaniteStatus {
    // SAFETY: the caller promises what `get` wants.
    let gyro = match unsafe { get(gyro) } {
        Ok(gyro) => gyro,
        Err(error) => return error,
    };
    let taken = || {
        let scale = Scale::new(Real::from(rate_per_count), Real::from(rate_hz))?;
        let per_count = Lags::<COVARIATES>::PER_COUNT as Real;
        let kelvin = [Real::from(kelvin_per_count) / per_count; COVARIATES];
        Ok(Taken {
            record: gyro.axes.record_so_far(axis, (scale, kelvin))?,
            lags: gyro.lags.clone(),
            rate_hz: Real::from(rate_hz),
        })
    };
    // SAFETY: the caller promises what `make` wants.
    status(unsafe { memory::make(record, bytes, taken) })
}

/// The number of samples of the record, and whether it is that of a gyro at rest. Either pointer may be null.
///
/// # Safety
/// `record` is null, or points to an `AllaniteRecord`; the others are null, or point to what they say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn allanite_record_summary(
    record: *const AllaniteRecord,
    samples: *mut u64,
    reason: *mut AllaniteReason,
) -> AllaniteStatus {
    // SAFETY: the caller promises what `get` wants.
    let record = match unsafe { get(record) } {
        Ok(taken) => &taken.record,
        Err(error) => return error,
    };
    if !samples.is_null() {
        // SAFETY: the caller promises what `put` wants.
        if let Err(error) = unsafe { put(samples, record.samples) } {
            return error;
        }
    }
    if reason.is_null() {
        return AllaniteStatus::Ok;
    }
    // SAFETY: the caller promises what `put` wants.
    status(unsafe { put(reason, AllaniteReason::of(record.invalid)) })
}

/// Writes the octaves of the Allan curve of a record, shortest first, and their number. [`ALLANITE_OCTAVES`] points always
/// suffice.
///
/// # Safety
/// `record` is null, or points to an `AllaniteRecord`; `points` is null, or points to `capacity` points; `number` is null, or
/// points to a number.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn allanite_record_curve(
    record: *const AllaniteRecord,
    points: *mut AllanitePoint,
    capacity: usize,
    number: *mut usize,
) -> AllaniteStatus {
    // SAFETY: the caller promises what `get` wants.
    let record = unsafe { get(record) };
    // SAFETY: the caller promises what `write_points` wants.
    status(
        record.and_then(|it| unsafe { write_points(&it.record.curve, points, capacity, number) }),
    )
}

/// The largest number of effects in a model.
pub const ALLANITE_MAX_COEFFICIENTS: usize = 8;
/// The largest number of fitted shape parameters in a model.
pub const ALLANITE_MAX_SHAPES: usize = 6;

/// A fitted shape parameter of an effect.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct AllaniteShape {
    /// The place of the effect among the coefficients.
    pub coefficient: i32,
    /// The place of the parameter among those of the effect, for `allanite_parameter_name`.
    pub parameter: i32,
    /// The best value.
    pub value: f32,
    /// The lower end of the 95 % interval.
    pub lower: f32,
    /// The upper end of the interval.
    pub upper: f32,
}

/// Whether a model explains a record.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AllaniteAdequacy {
    /// It does not.
    Inadequate = 0,
    /// It does.
    Adequate = 1,
    /// The record is too short to tell.
    Unknown = 2,
}

/// A fitted model.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct AllaniteFit {
    /// The coefficients, of which `coefficient_count` are valid.
    pub coefficients: [AllaniteCoefficient; ALLANITE_MAX_COEFFICIENTS],
    /// The fitted shape parameters, of which `shape_count` are valid.
    pub shapes: [AllaniteShape; ALLANITE_MAX_SHAPES],
    /// The number of coefficients.
    pub coefficient_count: i32,
    /// The number of fitted shape parameters.
    pub shape_count: i32,
    /// Whether the model explains the record.
    pub adequacy: AllaniteAdequacy,
    /// The degrees of freedom of `chi_squared`.
    pub degrees_of_freedom: i32,
    /// The squared residuals in units of their covariance.
    pub chi_squared: f32,
    /// The probability of a larger χ² if the model is true; NaN without degrees of freedom.
    pub p_value: f32,
}

impl AllaniteFit {
    pub(crate) const EMPTY: Self = Self {
        coefficients: [AllaniteCoefficient {
            effect: 0,
            state: AllaniteState::NotObservable,
            half_seconds: 0,
            value: 0.0,
            lower: 0.0,
            upper: 0.0,
        }; ALLANITE_MAX_COEFFICIENTS],
        shapes: [AllaniteShape {
            coefficient: 0,
            parameter: 0,
            value: 0.0,
            lower: 0.0,
            upper: 0.0,
        }; ALLANITE_MAX_SHAPES],
        coefficient_count: 0,
        shape_count: 0,
        adequacy: AllaniteAdequacy::Unknown,
        degrees_of_freedom: 0,
        chi_squared: 0.0,
        p_value: f32::NAN,
    };

    // The casts change nothing in single precision, in which every published library is built.
    #[allow(clippy::unnecessary_cast)]
    pub(crate) fn of(model: &Model, fit: &Fit) -> Self {
        let mut to = Self {
            adequacy: match fit.is_adequate() {
                None => AllaniteAdequacy::Unknown,
                Some(false) => AllaniteAdequacy::Inadequate,
                Some(true) => AllaniteAdequacy::Adequate,
            },
            degrees_of_freedom: fit.degrees_of_freedom as i32,
            chi_squared: fit.chi_squared as f32,
            p_value: fit.p_value as f32,
            ..Self::EMPTY
        };
        let pairs = fit.coefficients.iter().zip(model.terms());
        for (slot, (coefficient, term)) in to.coefficients.iter_mut().zip(pairs) {
            let code = EffectCode::of(term.effect).number();
            *slot = AllaniteCoefficient::of(coefficient, code.into());
            to.coefficient_count = to.coefficient_count.wrapping_add(1);
        }
        for (slot, shape) in to.shapes.iter_mut().zip(&fit.shape) {
            let effect = model.terms().get(shape.term).map(|term| term.effect);
            let names = effect.map_or(&[][..], |effect| effect.parameters());
            let place = names
                .iter()
                .zip(0_i32..)
                .find(|(one, _)| one.name == shape.name);
            *slot = AllaniteShape {
                coefficient: shape.term as i32,
                parameter: place.map_or(0, |(_, place)| place),
                value: shape.value as f32,
                lower: shape.lower as f32,
                upper: shape.upper as f32,
            };
            to.shape_count = to.shape_count.wrapping_add(1);
        }
        to
    }
}

/// Fits the five terms of IEEE Std 952 to the curve and to the spectrum of an axis, in one go: some 20 million
/// instructions on a Cortex-M4F. A diagnosis begins with the same fit and does it in pieces.
///
/// # Safety
/// `record` is null, or points to an `AllaniteRecord`; `to` is null, or points to an `AllaniteFit`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn allanite_fit(
    record: *const AllaniteRecord,
    to: *mut AllaniteFit,
) -> AllaniteStatus {
    // SAFETY: the caller promises what `get` wants.
    let record = match unsafe { get(record) } {
        Ok(taken) => &taken.record,
        Err(error) => return error,
    };
    let model = Model::ieee_952();
    match fit(record, &model, Options::default()) {
        Err(error) => error.into(),
        // SAFETY: the caller promises what `put` wants.
        Ok(fit) => status(unsafe { put(to, AllaniteFit::of(&model, &fit)) }),
    }
}
