//! The codes of effects, which never change their meaning.

/// The code of `quantization`.
pub const ALLANITE_EFFECT_QUANTIZATION: i32 = 1;
/// The code of `angle_random_walk`.
pub const ALLANITE_EFFECT_ANGLE_RANDOM_WALK: i32 = 2;
/// The code of `bias_instability`.
pub const ALLANITE_EFFECT_BIAS_INSTABILITY: i32 = 3;
/// The code of `rate_random_walk`.
pub const ALLANITE_EFFECT_RATE_RANDOM_WALK: i32 = 4;
/// The code of `rate_ramp`.
pub const ALLANITE_EFFECT_RATE_RAMP: i32 = 5;
/// The code of `gauss_markov`.
pub const ALLANITE_EFFECT_GAUSS_MARKOV: i32 = 6;
/// The code of `sinusoid`.
pub const ALLANITE_EFFECT_SINUSOID: i32 = 7;
/// The code of `resonance`.
pub const ALLANITE_EFFECT_RESONANCE: i32 = 8;
/// The code of `low_pass`.
pub const ALLANITE_EFFECT_LOW_PASS: i32 = 9;
/// The code of `decimation_filter`.
pub const ALLANITE_EFFECT_DECIMATION_FILTER: i32 = 10;
/// The code of `random_telegraph`.
pub const ALLANITE_EFFECT_RANDOM_TELEGRAPH: i32 = 11;
/// The code of `power_law`.
pub const ALLANITE_EFFECT_POWER_LAW: i32 = 12;
/// The code of `notch`.
pub const ALLANITE_EFFECT_NOTCH: i32 = 13;
/// The code of `digital_low_pass`.
pub const ALLANITE_EFFECT_DIGITAL_LOW_PASS: i32 = 14;
/// The code of `cascade`.
pub const ALLANITE_EFFECT_CASCADE: i32 = 15;
/// The code of `mode_split`.
pub const ALLANITE_EFFECT_MODE_SPLIT: i32 = 16;
/// The code of `high_pass`.
pub const ALLANITE_EFFECT_HIGH_PASS: i32 = 17;
/// The code of `drifting_resonance`.
pub const ALLANITE_EFFECT_DRIFTING_RESONANCE: i32 = 18;
/// The code of `drifting_sinusoid`.
pub const ALLANITE_EFFECT_DRIFTING_SINUSOID: i32 = 19;
/// The code of `output_low_pass`.
pub const ALLANITE_EFFECT_OUTPUT_LOW_PASS: i32 = 20;
/// The code of `moving_average`.
pub const ALLANITE_EFFECT_MOVING_AVERAGE: i32 = 21;
