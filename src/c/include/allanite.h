/* allanite for C: a gyro's record, its fit, diagnosis, self-test, snapshots and certificates.
 *
 * Made by cbindgen from src/c/src. `cargo xtask c` builds the library that this header declares. All memory belongs to
 * the caller; every function returns a status. Define ALLANITE_OCTAVES_14, ALLANITE_OCTAVES_26 or ALLANITE_ONE_AXIS if
 * the library was built with the feature octaves-14 or octaves-26, or without the feature whole. */

#ifndef ALLANITE_H
#define ALLANITE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#if !defined(ALLANITE_ONE_AXIS)
#define ALLANITE_WHOLE
#endif

// The number of terms of IEEE Std 952.
#define ALLANITE_TERMS 5

// The code of `quantization`.
#define ALLANITE_EFFECT_QUANTIZATION 1

// The code of `angle_random_walk`.
#define ALLANITE_EFFECT_ANGLE_RANDOM_WALK 2

// The code of `bias_instability`.
#define ALLANITE_EFFECT_BIAS_INSTABILITY 3

// The code of `rate_random_walk`.
#define ALLANITE_EFFECT_RATE_RANDOM_WALK 4

// The code of `rate_ramp`.
#define ALLANITE_EFFECT_RATE_RAMP 5

// The code of `gauss_markov`.
#define ALLANITE_EFFECT_GAUSS_MARKOV 6

// The code of `sinusoid`.
#define ALLANITE_EFFECT_SINUSOID 7

// The code of `resonance`.
#define ALLANITE_EFFECT_RESONANCE 8

// The code of `low_pass`.
#define ALLANITE_EFFECT_LOW_PASS 9

// The code of `decimation_filter`.
#define ALLANITE_EFFECT_DECIMATION_FILTER 10

// The code of `random_telegraph`.
#define ALLANITE_EFFECT_RANDOM_TELEGRAPH 11

// The code of `power_law`.
#define ALLANITE_EFFECT_POWER_LAW 12

// The code of `notch`.
#define ALLANITE_EFFECT_NOTCH 13

// The code of `digital_low_pass`.
#define ALLANITE_EFFECT_DIGITAL_LOW_PASS 14

// The code of `cascade`.
#define ALLANITE_EFFECT_CASCADE 15

// The code of `mode_split`.
#define ALLANITE_EFFECT_MODE_SPLIT 16

// The code of `high_pass`.
#define ALLANITE_EFFECT_HIGH_PASS 17

// The code of `drifting_resonance`.
#define ALLANITE_EFFECT_DRIFTING_RESONANCE 18

// The code of `drifting_sinusoid`.
#define ALLANITE_EFFECT_DRIFTING_SINUSOID 19

// The code of `output_low_pass`.
#define ALLANITE_EFFECT_OUTPUT_LOW_PASS 20

// The code of `moving_average`.
#define ALLANITE_EFFECT_MOVING_AVERAGE 21

#if defined(ALLANITE_WHOLE)
// The largest number of effects in a model.
#define ALLANITE_MAX_COEFFICIENTS 8
#endif

#if defined(ALLANITE_WHOLE)
// The largest number of fitted shape parameters in a model.
#define ALLANITE_MAX_SHAPES 6
#endif

#if defined(ALLANITE_WHOLE)
// Stands for the mean rate where a limit asks for the code of an effect: the bias of a gyro at rest, with the part of the
// earth's rate that it sees.
#define ALLANITE_LIMIT_BIAS -1
#endif

// The number of axes of a record.
#define ALLANITE_AXES 3

#if defined(ALLANITE_OCTAVES_14)
// The number of octaves of a record. Code for another number is compiled with `ALLANITE_OCTAVES_14` or
// `ALLANITE_OCTAVES_26`, as this library is with a feature.
#define ALLANITE_OCTAVES 14
#endif

#if (defined(ALLANITE_OCTAVES_26) && !defined(ALLANITE_OCTAVES_14))
// The number of octaves of a record. Code for another number is compiled with `ALLANITE_OCTAVES_14` or
// `ALLANITE_OCTAVES_26`, as this library is with a feature.
#define ALLANITE_OCTAVES 26
#endif

#if !(defined(ALLANITE_OCTAVES_14) || defined(ALLANITE_OCTAVES_26))
// The number of octaves of a record. Code for another number is compiled with `ALLANITE_OCTAVES_14` or
// `ALLANITE_OCTAVES_26`, as this library is with a feature.
#define ALLANITE_OCTAVES 20
#endif

// Words of an `AllaniteGyro`.
#define ALLANITE_GYRO_WORDS (4140 + (141 * ALLANITE_OCTAVES))

// Words of an `AllaniteAxis`.
#define ALLANITE_AXIS_WORDS (24 + (12 * ALLANITE_OCTAVES))

// Words of an `AllaniteRecord`.
#define ALLANITE_RECORD_WORDS (500 + (17 * ALLANITE_OCTAVES))

// Words of an `AllaniteSelfTest`.
#define ALLANITE_SELF_TEST_WORDS 38

// Words of an `AllaniteLook`.
#define ALLANITE_LOOK_WORDS (74 + (3 * ALLANITE_OCTAVES))

// Words of an `AllaniteDiagnosis`.
#define ALLANITE_DIAGNOSIS_WORDS (1652 + (10 * ALLANITE_OCTAVES))

// Words of an `AllaniteCertificate`.
#define ALLANITE_CERTIFICATE_WORDS 560

// Bytes of a buffer for any snapshot of a record and a self-test.
#define ALLANITE_SNAPSHOT_BYTES (26115 + (745 * ALLANITE_OCTAVES))

// Bytes of a buffer for any certificate.
#define ALLANITE_CERTIFICATE_BYTES 3700

// What a function returns. A code never changes its meaning.
enum AllaniteStatus
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // All is well.
  ALLANITE_STATUS_OK = 0,
  // A pointer is null.
  ALLANITE_STATUS_NULL_POINTER = 1,
  // A pointer is not aligned as its type wants.
  ALLANITE_STATUS_MISALIGNED = 2,
  // The size that was passed is not that of this library: compile with its header and with the same octaves.
  ALLANITE_STATUS_WRONG_SIZE = 3,
  // The memory holds no such value: call the function that makes it.
  ALLANITE_STATUS_NOT_INITIALISED = 4,
  // An argument is outside of its range.
  ALLANITE_STATUS_INVALID_ARGUMENT = 5,
  // There is no such axis.
  ALLANITE_STATUS_UNKNOWN_AXIS = 6,
  // The record is too short for a fit.
  ALLANITE_STATUS_TOO_SHORT = 7,
  // An octave has no noise: the counts do not change.
  ALLANITE_STATUS_NO_NOISE = 8,
  // The effects of a model cannot be distinguished.
  ALLANITE_STATUS_SINGULAR = 9,
  // A buffer is too small.
  ALLANITE_STATUS_BUFFER_TOO_SMALL = 10,
  // The stored bytes are not of this library, or damaged, or of something else.
  ALLANITE_STATUS_CORRUPT = 11,
  // The stored bytes have an unknown version.
  ALLANITE_STATUS_UNKNOWN_VERSION = 12,
  // The snapshot is of a record with other octaves, axes or parts, or of a self-test with another plan.
  ALLANITE_STATUS_OTHER_PARTS = 13,
  // The plan of a self-test cannot be carried out.
  ALLANITE_STATUS_INVALID_PLAN = 14,
  // Any other error, of a later version.
  ALLANITE_STATUS_OTHER = 15,
  // The look is not the last one that the self-test began, or was concluded before.
  ALLANITE_STATUS_OTHER_TEST = 16,
  // The noise of the other record is not that of this one: it is of another sensor, scale or filter.
  ALLANITE_STATUS_OTHER_SENSOR = 17,
  // The record is not one of a gyro at rest: `allanite_record_summary` gives the reason.
  ALLANITE_STATUS_INVALID_RECORD = 18,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum AllaniteStatus AllaniteStatus;
#else
typedef int32_t AllaniteStatus;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// What a record says about a coefficient.
enum AllaniteState
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // The 95 % interval excludes zero.
  ALLANITE_STATE_MEASURED = 0,
  // The interval includes zero, and `upper` is a one-sided 95 % bound.
  ALLANITE_STATE_UPPER_BOUND = 1,
  // The record says nothing about it.
  ALLANITE_STATE_NOT_OBSERVABLE = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum AllaniteState AllaniteState;
#else
typedef int32_t AllaniteState;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// What limits say of the five terms.
enum AllaniteChecked
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // The interval of each coefficient keeps its limit.
  ALLANITE_CHECKED_PASS = 0,
  // The interval of a coefficient lies above its limit.
  ALLANITE_CHECKED_FAIL = 1,
  // The interval of a coefficient contains its limit: record longer.
  ALLANITE_CHECKED_GUARD_BAND = 2,
  // The terms do not explain the curve, so that their intervals say nothing about limits.
  ALLANITE_CHECKED_MISFIT = 3,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum AllaniteChecked AllaniteChecked;
#else
typedef int32_t AllaniteChecked;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

#if defined(ALLANITE_WHOLE)
// What a diagnosis has led to.
enum AllaniteProgress
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
#if defined(ALLANITE_WHOLE)
  // The pause ended the work. There is more to do.
  ALLANITE_PROGRESS_WORKING = 0,
#endif
#if defined(ALLANITE_WHOLE)
  // A model is judged: `allanite_diagnosis_fit` gives it. There is more to do.
  ALLANITE_PROGRESS_STEP = 1,
#endif
#if defined(ALLANITE_WHOLE)
  // The five terms explain the record.
  ALLANITE_PROGRESS_ADEQUATE = 2,
#endif
#if defined(ALLANITE_WHOLE)
  // The last model, with effects that were missing, explains the record.
  ALLANITE_PROGRESS_IMPROVED = 3,
#endif
#if defined(ALLANITE_WHOLE)
  // The effects that were found improve the model, but it does not explain the record.
  ALLANITE_PROGRESS_INCOMPLETE = 4,
#endif
#if defined(ALLANITE_WHOLE)
  // The five terms do not explain the record, and no effect helps.
  ALLANITE_PROGRESS_UNEXPLAINED = 5,
#endif
#if defined(ALLANITE_WHOLE)
  // The record is too short to judge the five terms.
  ALLANITE_PROGRESS_TOO_SHORT = 6,
#endif
#if defined(ALLANITE_WHOLE)
  // The record is not that of a gyro at rest.
  ALLANITE_PROGRESS_INVALID = 7,
#endif
#if defined(ALLANITE_WHOLE)
  // Another verdict, of a later version.
  ALLANITE_PROGRESS_OTHER = 8,
#endif
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum AllaniteProgress AllaniteProgress;
#else
typedef int32_t AllaniteProgress;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus
#endif

#if defined(ALLANITE_WHOLE)
// Whether a model explains a record.
enum AllaniteAdequacy
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
#if defined(ALLANITE_WHOLE)
  // It does not.
  ALLANITE_ADEQUACY_INADEQUATE = 0,
#endif
#if defined(ALLANITE_WHOLE)
  // It does.
  ALLANITE_ADEQUACY_ADEQUATE = 1,
#endif
#if defined(ALLANITE_WHOLE)
  // The record is too short to tell.
  ALLANITE_ADEQUACY_UNKNOWN = 2,
#endif
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum AllaniteAdequacy AllaniteAdequacy;
#else
typedef int32_t AllaniteAdequacy;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus
#endif

#if defined(ALLANITE_WHOLE)
// Why a record is not that of a gyro at rest.
enum AllaniteReason
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
#if defined(ALLANITE_WHOLE)
  // The record is valid.
  ALLANITE_REASON_VALID = 0,
#endif
#if defined(ALLANITE_WHOLE)
  // The values change too seldom.
  ALLANITE_REASON_STUCK = 1,
#endif
#if defined(ALLANITE_WHOLE)
  // Every sample is there several times.
  ALLANITE_REASON_REPEATED = 2,
#endif
#if defined(ALLANITE_WHOLE)
  // The noise is below half a count.
  ALLANITE_REASON_COARSE = 3,
#endif
#if defined(ALLANITE_WHOLE)
  // Too many values are at a rail of the converter.
  ALLANITE_REASON_RAILED = 4,
#endif
#if defined(ALLANITE_WHOLE)
  // Spikes contribute too much.
  ALLANITE_REASON_SPIKED = 5,
#endif
#if defined(ALLANITE_WHOLE)
  // The gyro was moved.
  ALLANITE_REASON_MOVED = 6,
#endif
#if defined(ALLANITE_WHOLE)
  // Too many samples were lost.
  ALLANITE_REASON_MISSING = 7,
#endif
#if defined(ALLANITE_WHOLE)
  // The gate left out too many samples.
  ALLANITE_REASON_LEFT_OUT = 8,
#endif
#if defined(ALLANITE_WHOLE)
  // Any other reason, of a later version.
  ALLANITE_REASON_OTHER = 9,
#endif
#if defined(ALLANITE_WHOLE)
  // Small values are set to zero.
  ALLANITE_REASON_DEAD_BAND = 10,
#endif
#if defined(ALLANITE_WHOLE)
  // The counts were read without their sign, or with their bytes in the wrong order.
  ALLANITE_REASON_MISREAD = 11,
#endif
#if defined(ALLANITE_WHOLE)
  // The noise changed, as by another range of the sensor.
  ALLANITE_REASON_CHANGED = 12,
#endif
#if defined(ALLANITE_WHOLE)
  // Samples have one number on all axes, as a bus on which no sensor answers gives them.
  ALLANITE_REASON_UNANSWERED = 13,
#endif
#if defined(ALLANITE_WHOLE)
  // Blocks of samples are there a second time, as a buffer that was not refilled leaves them.
  ALLANITE_REASON_STALE = 14,
#endif
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum AllaniteReason AllaniteReason;
#else
typedef int32_t AllaniteReason;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus
#endif

#if defined(ALLANITE_WHOLE)
// How a self-test stands.
enum AllaniteVerdict
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
#if defined(ALLANITE_WHOLE)
  // It needs more samples.
  ALLANITE_VERDICT_RUNNING = 0,
#endif
#if defined(ALLANITE_WHOLE)
  // The gyro keeps every limit.
  ALLANITE_VERDICT_PASSED = 1,
#endif
#if defined(ALLANITE_WHOLE)
  // A coefficient is above its limit.
  ALLANITE_VERDICT_FAILED_LIMIT = 2,
#endif
#if defined(ALLANITE_WHOLE)
  // The five terms do not explain the record.
  ALLANITE_VERDICT_FAILED_MISFIT = 3,
#endif
#if defined(ALLANITE_WHOLE)
  // The longest record did not decide.
  ALLANITE_VERDICT_UNDECIDED = 4,
#endif
#if defined(ALLANITE_WHOLE)
  // The record is not that of a gyro at rest.
  ALLANITE_VERDICT_INVALID = 5,
#endif
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum AllaniteVerdict AllaniteVerdict;
#else
typedef int32_t AllaniteVerdict;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus
#endif

// The record of one axis: its octaves alone, without a watch for motion, stuck values and spikes. It may be copied and
// moved while no function works on it.
typedef struct {
  // Nothing for the caller to read.
  uint64_t words[ALLANITE_AXIS_WORDS];
} AllaniteAxis;

// An octave of a curve.
typedef struct {
  // The averaging factor: samples in a cluster.
  uint32_t m;
  // The averaging time, in seconds.
  float tau_s;
  // The Allan variance, in rate units squared.
  float variance;
  // The number of differences that it is the mean of.
  uint64_t differences;
} AllanitePoint;

// A coefficient, in the unit rate · s^(half_seconds/2).
typedef struct {
  // The code of the effect, for `allanite_effect_name`. A code never changes its meaning.
  int32_t effect;
  // What the record says about it.
  AllaniteState state;
  // Twice the exponent of the second in the unit.
  int32_t half_seconds;
  // The best value.
  float value;
  // The lower end of the 95 % interval; 0 unless the coefficient is measured.
  float lower;
  // The upper end of the interval, or a one-sided 95 % bound.
  float upper;
} AllaniteCoefficient;

// The five terms of a curve.
typedef struct {
  // Quantization, angle random walk, bias instability, rate random walk and rate ramp.
  AllaniteCoefficient coefficients[ALLANITE_TERMS];
  // The squared residuals in units of their covariance.
  float chi_squared;
  // Its degrees of freedom.
  int32_t degrees_of_freedom;
  // The tolerance that was granted to the model, relative to a variance.
  float tolerance;
  // The factor by which the intervals are widened because the terms do not explain the curve.
  float birge_ratio;
} AllaniteFiveTerms;

#if defined(ALLANITE_WHOLE)
// A certificate.
typedef struct {
  // Nothing for the caller to read.
  uint64_t words[ALLANITE_CERTIFICATE_WORDS];
} AllaniteCertificate;
#endif

#if defined(ALLANITE_WHOLE)
// The conditions of a measurement. The rates are in deg/s.
typedef struct {
  // The duration in seconds.
  double duration_s;
  // The number of samples per second.
  double rate_hz;
  // The number of samples.
  uint64_t samples;
  // The number of gaps among them.
  uint64_t gaps;
  // The lowest temperature in °C, or NaN if it was not measured.
  float lowest_c;
  // The highest temperature in °C, or NaN if it was not measured.
  float highest_c;
  // The version of the firmware: major, minor, patch.
  uint16_t firmware[3];
} AllaniteConditions;
#endif

#if defined(ALLANITE_WHOLE)
// A diagnosis of one axis. It must stay where it is.
typedef struct {
  // Nothing for the caller to read.
  uint64_t words[ALLANITE_DIAGNOSIS_WORDS];
} AllaniteDiagnosis;
#endif

#if defined(ALLANITE_WHOLE)
// What a record says about one axis at a moment. It must stay where it is, unchanged, while a look or a diagnosis uses
// it.
typedef struct {
  // Nothing for the caller to read.
  uint64_t words[ALLANITE_RECORD_WORDS];
} AllaniteRecord;
#endif

#if defined(ALLANITE_WHOLE)
// A fitted shape parameter of an effect.
typedef struct {
  // The place of the effect among the coefficients.
  int32_t coefficient;
  // The place of the parameter among those of the effect, for `allanite_parameter_name`.
  int32_t parameter;
  // The best value.
  float value;
  // The lower end of the 95 % interval.
  float lower;
  // The upper end of the interval.
  float upper;
} AllaniteShape;
#endif

#if defined(ALLANITE_WHOLE)
// A fitted model.
typedef struct {
  // The coefficients, of which `coefficient_count` are valid.
  AllaniteCoefficient coefficients[ALLANITE_MAX_COEFFICIENTS];
  // The fitted shape parameters, of which `shape_count` are valid.
  AllaniteShape shapes[ALLANITE_MAX_SHAPES];
  // The number of coefficients.
  int32_t coefficient_count;
  // The number of fitted shape parameters.
  int32_t shape_count;
  // Whether the model explains the record.
  AllaniteAdequacy adequacy;
  // The degrees of freedom of `chi_squared`.
  int32_t degrees_of_freedom;
  // The squared residuals in units of their covariance.
  float chi_squared;
  // The probability of a larger χ² if the model is true; NaN without degrees of freedom.
  float p_value;
} AllaniteFit;
#endif

#if defined(ALLANITE_WHOLE)
// How the rate follows the temperature. All numbers are NaN if it does not.
typedef struct {
  // The change of the rate for each kelvin, in the unit of the rate.
  float slope;
  // Its standard error.
  float slope_error;
  // By how much the rate is late, in seconds.
  float lag_s;
  // The standard error of the lag; NaN if the rate follows one of the bank's temperatures alone, whose lag is then near the true
  // one.
  float lag_error_s;
} AllaniteDependence;
#endif

#if defined(ALLANITE_WHOLE)
// The record of a gyro. It may be copied and moved while no function works on it.
typedef struct {
  // Nothing for the caller to read.
  uint64_t words[ALLANITE_GYRO_WORDS];
} AllaniteGyro;
#endif

#if defined(ALLANITE_WHOLE)
// A self-test of one axis.
typedef struct {
  // Nothing for the caller to read.
  uint64_t words[ALLANITE_SELF_TEST_WORDS];
} AllaniteSelfTest;
#endif

#if defined(ALLANITE_WHOLE)
// The plan of a self-test, as `allanite::self_test::Plan` explains it.
typedef struct {
  // The smallest p-value of the fit of five terms; 0 requires nothing.
  float least_p;
  // The largest probability that a gyro at one of its limits passes.
  float false_pass;
  // The largest probability that a gyro at all of its limits fails.
  float false_fail;
  // The length of the record at the first look, in seconds.
  float shortest_s;
  // The length of the record at the last look, in seconds.
  float longest_s;
} AllanitePlan;
#endif

#if defined(ALLANITE_WHOLE)
// The largest value that a coefficient or the mean rate may have.
typedef struct {
  // The code of one of the five terms of IEEE Std 952, such as `ALLANITE_EFFECT_ANGLE_RANDOM_WALK`, or
  // `ALLANITE_LIMIT_BIAS`.
  int32_t effect;
  // The largest value, in the coefficient's unit; of the mean rate, that of either sign, in rate units.
  float most;
} AllaniteLimit;
#endif

#if defined(ALLANITE_WHOLE)
// How a self-test stands, with numbers.
typedef struct {
  // How it stands.
  AllaniteVerdict verdict;
  // The code of the effect whose limit is not kept or undecided, or `ALLANITE_LIMIT_BIAS`; 0 otherwise.
  int32_t effect;
  // The value above its limit, or the p-value of a misfit, or the progress from 0 to 1; 0 otherwise.
  float value;
  // The time in seconds until a verdict is expected, or the length that would decide; 0 if it is not known.
  float expected_s;
  // Why the record is not valid.
  AllaniteReason reason;
} AllaniteTestStatus;
#endif

#if defined(ALLANITE_WHOLE)
// A look of a self-test at a record, in progress.
typedef struct {
  // Nothing for the caller to read.
  uint64_t words[ALLANITE_LOOK_WORDS];
} AllaniteLook;
#endif

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// Makes an empty record. `bytes` is `sizeof(AllaniteAxis)`.
//
// # Safety
// `axis` is null, or points to an `AllaniteAxis` that nothing else uses.
AllaniteStatus allanite_axis_init(AllaniteAxis *axis, size_t bytes);

// Adds counts, oldest first.
//
// # Safety
// `axis` is null, or points to an `AllaniteAxis`; `counts` is null, or points to `length` counts.
AllaniteStatus allanite_axis_push(AllaniteAxis *axis, const int32_t *counts, size_t length);

// Notes that so many samples were lost before the next one. Long octaves go on across a few.
//
// # Safety
// `axis` is null, or points to an `AllaniteAxis`.
AllaniteStatus allanite_axis_lost(AllaniteAxis *axis, uint64_t samples);

// Writes the octaves of the Allan curve, shortest first, and their number. `rate_per_count` is the rate of one count, and
// `rate_hz` the number of samples per second. [`ALLANITE_OCTAVES`] points always suffice.
//
// # Safety
// `axis` is null, or points to an `AllaniteAxis`; `points` is null, or points to `capacity` points; `number` is null, or points
// to a number.
AllaniteStatus allanite_axis_curve(const AllaniteAxis *axis,
                                   float rate_per_count,
                                   float rate_hz,
                                   AllanitePoint *points,
                                   size_t capacity,
                                   size_t *number);

// Fits the five terms of IEEE Std 952 to the curve: some 3 million instructions on a Cortex-M0+, and 1 million on a
// Cortex-M4F.
//
// # Safety
// `axis` is null, or points to an `AllaniteAxis`; `to` is null, or points to an `AllaniteFiveTerms`.
AllaniteStatus allanite_axis_fit(const AllaniteAxis *axis, float rate_per_count, float rate_hz, AllaniteFiveTerms *to);

// Compares the five terms of a curve with limits: the largest value that each may have, where an infinite one requires
// nothing. `place` becomes that of the first term that fails or is in the guard band.
//
// # Safety
// `axis` is null, or points to an `AllaniteAxis`; `most` is null, or points to [`ALLANITE_TERMS`] limits; `checked` and `place`
// are null, or point to what they say.
AllaniteStatus allanite_axis_check(const AllaniteAxis *axis,
                                   float rate_per_count,
                                   float rate_hz,
                                   const float *most,
                                   AllaniteChecked *checked,
                                   size_t *place);

#if defined(ALLANITE_WHOLE)
// Makes a certificate without axes, for a device with an identity of up to 16 bytes. `bytes` is
// `sizeof(AllaniteCertificate)`.
//
// # Safety
// `certificate` is null, or points to an `AllaniteCertificate` that nothing else uses; `device` is null, or points to
// `length` bytes; `conditions` is null, or points to what it says.
AllaniteStatus allanite_certificate_init(AllaniteCertificate *certificate,
                                         size_t bytes,
                                         const uint8_t *device,
                                         size_t length,
                                         const AllaniteConditions *conditions);
#endif

#if defined(ALLANITE_WHOLE)
// Adds the next axis, as a diagnosis that has ended describes it.
//
// # Safety
// `certificate` is null, or points to an `AllaniteCertificate`; `diagnosis` is null, or points to an `AllaniteDiagnosis`.
AllaniteStatus allanite_certificate_add(AllaniteCertificate *certificate,
                                        const AllaniteDiagnosis *diagnosis);
#endif

#if defined(ALLANITE_WHOLE)
// Writes a certificate to a buffer of `ALLANITE_CERTIFICATE_BYTES`. `written` is set to their
// number. `allanite decode` reads them on a workstation.
//
// # Safety
// `certificate` is null, or points to an `AllaniteCertificate`; `buffer` is null, or points to `capacity` bytes; `written`
// is null, or points to a `size_t`.
AllaniteStatus allanite_certificate_encode(const AllaniteCertificate *certificate,
                                           uint8_t *buffer,
                                           size_t capacity,
                                           size_t *written);
#endif

#if defined(ALLANITE_WHOLE)
// Begins a diagnosis of an axis: what do the five terms lack? `bytes` is `sizeof(AllaniteDiagnosis)`.
//
// # Safety
// `diagnosis` is null, or points to an `AllaniteDiagnosis` that nothing else uses; `record` is null, or points to an
// `AllaniteRecord` that stays there, unchanged, for as long as the diagnosis is used.
AllaniteStatus allanite_diagnosis_begin(AllaniteDiagnosis *diagnosis, size_t bytes, const AllaniteRecord *record);
#endif

#if defined(ALLANITE_WHOLE)
// Works until the next step of a diagnosis and returns what it has led to. That takes long;
// `allanite_diagnosis_advance_with` pauses meanwhile. After the end, it returns the verdict again.
//
// # Safety
// `diagnosis` is null, or points to an `AllaniteDiagnosis`; `progress` is null, or points to an `AllaniteProgress`.
AllaniteStatus allanite_diagnosis_advance(AllaniteDiagnosis *diagnosis, AllaniteProgress *progress);
#endif

#if defined(ALLANITE_WHOLE)
// Does what `allanite_diagnosis_advance` does, and calls `pause` with `context` between two pieces of work, for the
// watchdog and the next samples. A piece takes at most 2 million instructions on a Cortex-M4F, except for the one that
// reports a step, which takes as much as a fit for the correlations of a certificate. If `pause` returns false, the work in
// progress is given up, `progress` is `ALLANITE_PROGRESS_WORKING`, and the next call begins this work anew.
//
// # Safety
// `diagnosis` is null, or points to an `AllaniteDiagnosis`; `progress` is null, or points to an `AllaniteProgress`. `pause`
// is null, or a function that returns, and that uses neither the diagnosis nor its record.
AllaniteStatus allanite_diagnosis_advance_with(AllaniteDiagnosis *diagnosis,
                                               AllaniteProgress *progress,
                                               bool (*pause)(void *context),
                                               void *context);
#endif

#if defined(ALLANITE_WHOLE)
// The model of the last step, fitted.
//
// # Safety
// `diagnosis` is null, or points to an `AllaniteDiagnosis`; `to` is null, or points to an `AllaniteFit`.
AllaniteStatus allanite_diagnosis_fit(const AllaniteDiagnosis *diagnosis, AllaniteFit *to);
#endif

#if defined(ALLANITE_WHOLE)
// How the rate follows the temperature in the model of the last step, also behind a lag: what of the temperature was then taken out of
// the record.
//
// # Safety
// `diagnosis` is null, or points to an `AllaniteDiagnosis`; `to` is null, or points to an `AllaniteDependence`.
AllaniteStatus allanite_diagnosis_dependence(const AllaniteDiagnosis *diagnosis,
                                             AllaniteDependence *to);
#endif

#if defined(ALLANITE_WHOLE)
// Takes the record of an axis from a gyro, to which it does not belong afterwards. `bytes` is
// `sizeof(AllaniteRecord)`. `rate_per_count` is the rate of one count, `rate_hz` the number of samples per second, and
// `kelvin_per_count` the temperature of one count of the thermometer.
//
// # Safety
// `record` is null, or points to an `AllaniteRecord` that nothing else uses; `gyro` is null, or points to an
// `AllaniteGyro`.
AllaniteStatus allanite_record_take(AllaniteRecord *record,
                                    size_t bytes,
                                    const AllaniteGyro *gyro,
                                    size_t axis,
                                    float rate_per_count,
                                    float rate_hz,
                                    float kelvin_per_count);
#endif

#if defined(ALLANITE_WHOLE)
// The number of samples of the record, and whether it is that of a gyro at rest. Either pointer may be null.
//
// # Safety
// `record` is null, or points to an `AllaniteRecord`; the others are null, or point to what they say.
AllaniteStatus allanite_record_summary(const AllaniteRecord *record, uint64_t *samples, AllaniteReason *reason);
#endif

#if defined(ALLANITE_WHOLE)
// Writes the octaves of the Allan curve of a record, shortest first, and their number. [`ALLANITE_OCTAVES`] points always
// suffice.
//
// # Safety
// `record` is null, or points to an `AllaniteRecord`; `points` is null, or points to `capacity` points; `number` is null, or
// points to a number.
AllaniteStatus allanite_record_curve(const AllaniteRecord *record,
                                     AllanitePoint *points,
                                     size_t capacity,
                                     size_t *number);
#endif

#if defined(ALLANITE_WHOLE)
// Fits the five terms of IEEE Std 952 to the curve and to the spectrum of an axis, in one go: some 20 million
// instructions on a Cortex-M4F. A diagnosis begins with the same fit and does it in pieces.
//
// # Safety
// `record` is null, or points to an `AllaniteRecord`; `to` is null, or points to an `AllaniteFit`.
AllaniteStatus allanite_fit(const AllaniteRecord *record, AllaniteFit *to);
#endif

#if defined(ALLANITE_WHOLE)
// Makes an empty record. `bytes` is `sizeof(AllaniteGyro)`. `rate_hz` is the nominal number of samples per second, between 1/16 and
// 4 million: it sets the lags with which the rate may follow the temperature.
//
// # Safety
// `gyro` is null, or points to an `AllaniteGyro` that nothing else uses.
AllaniteStatus allanite_gyro_init(AllaniteGyro *gyro,
                                  size_t bytes,
                                  float rate_hz);
#endif

#if defined(ALLANITE_WHOLE)
// Adds one sample: a count of every axis, and one of the thermometer.
//
// # Safety
// `gyro` is null, or points to an `AllaniteGyro`; `counts` is null, or points to [`ALLANITE_AXES`] counts.
AllaniteStatus allanite_gyro_push(AllaniteGyro *gyro, const int32_t *counts, int32_t temperature);
#endif

#if defined(ALLANITE_WHOLE)
// Notes that the next sample does not adjoin the one before it.
//
// # Safety
// `gyro` is null, or points to an `AllaniteGyro`.
AllaniteStatus allanite_gyro_gap(AllaniteGyro *gyro);
#endif

#if defined(ALLANITE_WHOLE)
// Notes that so many samples are missing at this place. Does nothing for 0.
//
// # Safety
// `gyro` is null, or points to an `AllaniteGyro`.
AllaniteStatus allanite_gyro_lost(AllaniteGyro *gyro, uint64_t samples);
#endif

#if defined(ALLANITE_WHOLE)
// Does a part of the spectra's work that waits, for a main loop with nothing else to do. `more` says whether there is
// more; it may be null.
//
// # Safety
// `gyro` is null, or points to an `AllaniteGyro`; `more` is null, or points to a `bool`.
AllaniteStatus allanite_gyro_advance(AllaniteGyro *gyro, bool *more);
#endif

#if defined(ALLANITE_WHOLE)
// Adds the samples that the gate holds back, at the end of a record.
//
// # Safety
// `gyro` is null, or points to an `AllaniteGyro`.
AllaniteStatus allanite_gyro_release(AllaniteGyro *gyro);
#endif

#if defined(ALLANITE_WHOLE)
// Adds another record of the same gyro, as if a gap lay between the two. Where the noise of an axis differs by more than a
// gyro's does, nothing is added, and the status is `ALLANITE_STATUS_OTHER_SENSOR`.
//
// # Safety
// Both are null or point to an `AllaniteGyro`, and not to the same one.
AllaniteStatus allanite_gyro_merge(AllaniteGyro *gyro,
                                   const AllaniteGyro *other);
#endif

#if defined(ALLANITE_WHOLE)
// The numbers of samples that are kept and that the gate left out. Either pointer may be null.
//
// # Safety
// `gyro` is null, or points to an `AllaniteGyro`; the others are null, or point to a `uint64_t`.
AllaniteStatus allanite_gyro_samples(const AllaniteGyro *gyro, uint64_t *kept, uint64_t *left_out);
#endif

#if defined(ALLANITE_WHOLE)
// The name of the effect with a code, such as "angle_random_walk"; "other" for a code that this library does not know.
const char *allanite_effect_name(int32_t code);
#endif

#if defined(ALLANITE_WHOLE)
// The name of a parameter of the effect with a code, such as "frequency_hz"; an empty text if there is no such parameter.
const char *allanite_parameter_name(int32_t code,
                                    int32_t parameter);
#endif

#if defined(ALLANITE_WHOLE)
// Makes a self-test of a plan with so many limits. `bytes` is `sizeof(AllaniteSelfTest)`.
//
// # Safety
// `test` is null, or points to an `AllaniteSelfTest` that nothing else uses; `plan` is null, or points to a plan; `limits`
// is null, or points to `count` limits.
AllaniteStatus allanite_self_test_init(AllaniteSelfTest *test,
                                       size_t bytes,
                                       const AllanitePlan *plan,
                                       const AllaniteLimit *limits,
                                       size_t count,
                                       float rate_per_count,
                                       float rate_hz);
#endif

#if defined(ALLANITE_WHOLE)
// Whether a look is due at this number of samples.
//
// # Safety
// `test` is null, or points to an `AllaniteSelfTest`; `due` is null, or points to a `bool`.
AllaniteStatus allanite_self_test_is_due(const AllaniteSelfTest *test, uint64_t samples, bool *due);
#endif

#if defined(ALLANITE_WHOLE)
// How the self-test stands at this number of samples.
//
// # Safety
// `test` is null, or points to an `AllaniteSelfTest`; `to` is null, or points to an `AllaniteTestStatus`.
AllaniteStatus allanite_self_test_status(const AllaniteSelfTest *test, uint64_t samples, AllaniteTestStatus *to);
#endif

#if defined(ALLANITE_WHOLE)
// Begins a look of a self-test at the record of its axis. `bytes` is `sizeof(AllaniteLook)`. The record may change
// afterwards. A record of another scale than the test's is refused.
//
// # Safety
// `look` is null, or points to an `AllaniteLook` that nothing else uses; the others are null, or point to what they say.
AllaniteStatus allanite_look_begin(AllaniteLook *look,
                                   size_t bytes,
                                   AllaniteSelfTest *test,
                                   const AllaniteRecord *record);
#endif

#if defined(ALLANITE_WHOLE)
// Does one piece of a look, at most 2 million instructions on a Cortex-M4F. `complete` says whether it was the last.
//
// # Safety
// `look` is null, or points to an `AllaniteLook`; `complete` is null, or points to a `bool`.
AllaniteStatus allanite_look_advance(AllaniteLook *look, bool *complete);
#endif

#if defined(ALLANITE_WHOLE)
// Takes up a look, and returns the state of the self-test. What the look still lacks is done at once. A look that another
// self-test began is refused, and so is one that was concluded before.
//
// # Safety
// All are null, or point to what they say.
AllaniteStatus allanite_look_conclude(AllaniteSelfTest *test,
                                      AllaniteLook *look,
                                      AllaniteTestStatus *to);
#endif

#if defined(ALLANITE_WHOLE)
// Writes a snapshot of the record and of a self-test, which may be null, to a buffer of
// `ALLANITE_SNAPSHOT_BYTES`. `written` is set to the number of those that it took.
//
// # Safety
// `gyro` is null, or points to an `AllaniteGyro`; `test` is null, or points to an `AllaniteSelfTest`; `buffer` is null, or
// points to `capacity` bytes; `written` is null, or points to a `size_t`.
AllaniteStatus allanite_gyro_snapshot(const AllaniteGyro *gyro,
                                      const AllaniteSelfTest *test,
                                      uint8_t *buffer,
                                      size_t capacity,
                                      size_t *written);
#endif

#if defined(ALLANITE_WHOLE)
// Restores a snapshot into a record and into a self-test of the same plan, which must be null if the snapshot was taken
// without one. After an error, the record is empty and the self-test must be made anew.
//
// # Safety
// `gyro` is null, or points to an `AllaniteGyro`; `test` is null, or points to an `AllaniteSelfTest`; `bytes` is null, or
// points to `length` bytes.
AllaniteStatus allanite_gyro_restore(AllaniteGyro *gyro,
                                     AllaniteSelfTest *test,
                                     const uint8_t *bytes,
                                     size_t length);
#endif

// What a status means, as a sentence that ends with NUL. An unknown number gives "unknown status".
const char *allanite_status_text(int32_t status);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* ALLANITE_H */

#if !defined(__cplusplus) && defined(__STDC_VERSION__) && __STDC_VERSION__ >= 201112L
_Static_assert(sizeof(AllaniteAxis) == 8 * ALLANITE_AXIS_WORDS, "AllaniteAxis has padding");
#if defined(ALLANITE_WHOLE)
_Static_assert(sizeof(AllaniteGyro) == 8 * ALLANITE_GYRO_WORDS, "AllaniteGyro has padding");
_Static_assert(sizeof(AllaniteRecord) == 8 * ALLANITE_RECORD_WORDS, "AllaniteRecord has padding");
_Static_assert(sizeof(AllaniteSelfTest) == 8 * ALLANITE_SELF_TEST_WORDS, "AllaniteSelfTest has padding");
_Static_assert(sizeof(AllaniteLook) == 8 * ALLANITE_LOOK_WORDS, "AllaniteLook has padding");
_Static_assert(sizeof(AllaniteDiagnosis) == 8 * ALLANITE_DIAGNOSIS_WORDS, "AllaniteDiagnosis has padding");
_Static_assert(sizeof(AllaniteCertificate) == 8 * ALLANITE_CERTIFICATE_WORDS, "AllaniteCertificate has padding");
#endif
_Static_assert(sizeof(AllaniteStatus) == 4, "compile without -fshort-enums, or with the type int32_t for enumerations");
#endif
