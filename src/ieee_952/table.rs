//! What two octaves have in common for each pair of terms, as a table.
//!
//! The covariance of two octaves is a sum over all pairs of their differences (see
//! [`curve_covariance`](crate::fit::curve_covariance)). Differences of octave `m` start at multiples of `m/4`, so that the
//! lattice of the distances between starts scales with `m`; and the kernels of the terms are homogeneous, of degree 0 for
//! quantization, 1 for white noise, 2 for flicker noise, whose logarithm of a scale drops out of second differences, and 3
//! for the cubic part of a random walk. The sums scale, therefore, and 28 of them hold all octaves. With the sums
//! `c_a(ℓ)` of a kernel `a` over the nine pairs of places,
//!
//! ```text
//! T0 = Σ_ℓ c_a c_b,     T1 = Σ_ℓ e(ℓ) c_a c_b,     Cov = Σ_ab (n_k T0 − S T1) / (2 n_j n_k)
//! ```
//!
//! where `e` is the number of starts at the distance `ℓ` that the ends of a stretch cost, and `S` is the number of stretches.
//! The ramp is the same at every distance, and enters by `Σ c_a`.

/// The number of distances, in octaves, that the table has.
pub(super) const DISTANCES: usize = 7;

/// The pairs of terms: the first with itself and all later ones, the second with itself and all later ones, and so on up to
/// the fourth. The ramp has no scatter of its own.
pub(super) const PAIRS: usize = 14;

/// The rows of the table: octaves of `m = 1`, of 2, of 4 or more, and of 4 or more beside an octave with few differences.
pub(super) const ROWS: usize = 4;

/// The value of a step of `T0`, as a power of two: relative to the variances of the terms in the two octaves.
pub(super) const STEP_BITS: i32 = -9;

/// The same for `T1`, at each distance.
pub(super) const END_STEP_BITS: [i32; DISTANCES] = [-7, -8, -10, -11, -13, -14, -14];

/// Beyond the last distance, an entry falls by these powers of two an octave.
pub(super) const FALL: [u8; PAIRS] = [0, 1, 2, 3, 0, 1, 2, 2, 0, 1, 1, 1, 0, 0];

/// `T0` and `T1` of every row, distance and pair.
#[rustfmt::skip]
pub(super) static TABLE: [[[[i16; 2]; PAIRS]; DISTANCES]; ROWS] = [
    [
        [[3982, 512], [6827, 683], [5100, 206], [2731, -341], [0, -683], [3072, 256], [4984, 222], [3072, -256], [0, -1024], [2325, 96], [3652, -111], [282, -2103], [2304, 64], [6144, 512]],
        [[1593, 341], [2048, 341], [1196, 95], [512, -43], [0, 0], [1536, 256], [2143, 270], [1152, -64], [0, -512], [1816, 245], [2536, -67], [239, -2747], [2784, 16], [6144, 256]],
        [[2048, 1365], [1024, 683], [264, 130], [64, -21], [0, 0], [768, 512], [734, 403], [336, -32], [0, -512], [1109, 703], [1444, -50], [187, -6486], [2988, 8], [6144, 256]],
        [[2048, 2276], [512, 683], [64, 126], [8, -5], [0, -85], [384, 512], [232, 266], [90, -8], [0, -256], [605, 631], [754, -17], [135, -4475], [3050, 2], [6144, 128]],
        [[2048, 9102], [256, 1365], [16, 150], [1, -3], [0, -85], [192, 1024], [70, 330], [23, -4], [0, -256], [314, 1113], [382, -10], [90, -6668], [3066, 1], [6144, 128]],
        [[2048, 18204], [128, 1365], [4, 86], [0, -1], [0, -43], [96, 1024], [20, 197], [6, -1], [0, -128], [159, 967], [192, -3], [55, -5425], [3071, 0], [6144, 64]],
        [[2048, 18204], [64, 683], [1, 24], [0, 0], [0, -11], [48, 512], [6, 57], [1, 0], [0, -32], [80, 426], [96, 0], [32, -2404], [3072, 0], [6144, 16]],
    ],
    [
        [[3982, 1024], [6827, 1365], [5100, 412], [2731, -683], [0, -1365], [3584, 768], [6540, 1122], [4480, -192], [0, -3072], [3610, 709], [6386, 425], [578, -7538], [4424, 660], [12288, 2688]],
        [[1593, 683], [2048, 683], [1196, 191], [512, -85], [0, 0], [2304, 768], [3633, 930], [2064, -240], [0, -2048], [3440, 939], [4965, -220], [488, -10772], [5547, 189], [12288, 1408]],
        [[2048, 1365], [1024, 683], [264, 130], [64, -21], [0, 0], [1152, 896], [1314, 872], [642, -86], [0, -1280], [2173, 1593], [2875, -164], [381, -13920], [5973, 86], [12288, 1120]],
        [[2048, 2276], [512, 683], [64, 126], [8, -5], [0, -85], [576, 768], [426, 482], [176, -21], [0, -512], [1198, 1334], [1505, -59], [274, -9322], [6099, 22], [12288, 544]],
        [[2048, 9102], [256, 1365], [16, 150], [1, -3], [0, -85], [288, 1536], [131, 611], [46, -10], [0, -512], [625, 2332], [763, -38], [181, -13687], [6132, 11], [12288, 544]],
        [[2048, 18204], [128, 1365], [4, 86], [0, -1], [0, -43], [144, 1536], [39, 369], [12, -3], [0, -256], [317, 2014], [383, -12], [111, -11028], [6141, 3], [12288, 272]],
        [[2048, 18204], [64, 683], [1, 24], [0, 0], [0, -11], [72, 768], [11, 108], [3, 0], [0, -64], [159, 881], [192, -2], [63, -4856], [6143, 0], [12288, 68]],
    ],
    [
        [[3982, 2048], [6827, 2731], [5100, 823], [2731, -1365], [0, -2731], [5888, 2816], [11802, 4776], [8368, 16], [0, -11264], [7034, 3108], [12651, 2324], [1171, -29369], [8836, 2926], [24576, 11296]],
        [[1593, 683], [2048, 683], [1196, 191], [512, -85], [0, 0], [4224, 1568], [6998, 1998], [4026, -558], [0, -4608], [6840, 2043], [9911, -430], [987, -22391], [11092, 642], [24576, 3888]],
        [[2048, 1365], [1024, 683], [264, 130], [64, -21], [0, 0], [2112, 1856], [2567, 1892], [1271, -189], [0, -2816], [4336, 3406], [5748, -383], [769, -28774], [11947, 282], [24576, 2992]],
        [[2048, 2276], [512, 683], [64, 126], [8, -5], [0, -85], [1056, 1408], [837, 944], [351, -44], [0, -1024], [2394, 2752], [3010, -141], [551, -19015], [12197, 70], [24576, 1424]],
        [[2048, 9102], [256, 1365], [16, 150], [1, -3], [0, -85], [528, 2816], [257, 1201], [92, -22], [0, -1024], [1249, 4774], [1527, -94], [363, -27712], [12265, 35], [24576, 1424]],
        [[2048, 18204], [128, 1365], [4, 86], [0, -1], [0, -43], [264, 2816], [76, 729], [23, -6], [0, -512], [634, 4108], [767, -29], [222, -22229], [12282, 9], [24576, 712]],
        [[2048, 18204], [64, 683], [1, 24], [0, 0], [0, -11], [132, 1408], [22, 214], [6, -1], [0, -128], [317, 1791], [384, -4], [127, -9759], [12287, 1], [24576, 178]],
    ],
    [
        [[3868, 1820], [6827, 2731], [5281, 1185], [2731, -1365], [-1365, -5461], [5824, 2704], [11586, 4398], [8372, 23], [1024, -9472], [6677, 2344], [12658, 2336], [8896, -4171], [8836, 2926], [24544, 11240]],
        [[1593, 683], [2048, 683], [1196, 191], [512, -85], [0, 0], [4224, 1568], [6998, 1998], [4026, -558], [0, -4608], [6792, 1818], [9911, -430], [3026, -10587], [11092, 642], [24576, 3888]],
        [[2048, 1365], [1024, 683], [264, 130], [64, -21], [0, 0], [2112, 1856], [2567, 1892], [1271, -189], [0, -2816], [4323, 3171], [5748, -383], [1343, -17870], [11947, 282], [24576, 2992]],
        [[2048, 2276], [512, 683], [64, 126], [8, -5], [0, -85], [1056, 1408], [837, 944], [351, -44], [0, -1024], [2391, 2654], [3010, -141], [678, -14448], [12197, 70], [24576, 1424]],
        [[2048, 9102], [256, 1365], [16, 150], [1, -3], [0, -85], [528, 2816], [257, 1201], [92, -22], [0, -1024], [1248, 4630], [1527, -94], [410, -21516], [12265, 35], [24576, 1424]],
        [[2048, 18204], [128, 1365], [4, 86], [0, -1], [0, -43], [264, 2816], [76, 729], [23, -6], [0, -512], [634, 3993], [767, -29], [240, -17540], [12282, 9], [24576, 712]],
        [[2048, 18204], [64, 683], [1, 24], [0, 0], [0, -11], [132, 1408], [22, 214], [6, -1], [0, -128], [317, 1741], [384, -4], [135, -7787], [12287, 1], [24576, 178]],
    ],
];

#[cfg(test)]
mod tests {
    use super::*;

    /// Ends that cost more starts than this leave nothing of an octave with few differences.
    const FEW: f64 = 6.0;

    /// The generalised covariance of the angle for a term of unit size.
    fn kernel(term: usize, lag: f64) -> f64 {
        let lag = lag.abs();
        match term {
            0 if lag < 0.5 => 1.0,
            1 => -lag / 2.0,
            2 if lag > 0.5 => lag * lag * libm::log(lag) / (2.0 * core::f64::consts::PI),
            3 => lag * lag * lag / 12.0,
            _ => 0.0,
        }
    }

    /// The Allan variance of a term of unit size.
    fn variance(term: usize, m: f64) -> f64 {
        match term {
            0 => 3.0 / (m * m),
            1 => 1.0 / m,
            2 => 2.0 * core::f64::consts::LN_2 / core::f64::consts::PI,
            3 => m / 3.0,
            _ => m * m / 2.0,
        }
    }

    /// `T0` and `T1` by the sum over the distances.
    fn entry(row: usize, distance: usize, [a, b]: [usize; 2]) -> [f64; 2] {
        let (shorter, most) = (row.min(2), if row == 3 { FEW } else { f64::INFINITY });
        let (short, long) = (1_i64 << shorter, 1_i64 << (shorter + distance));
        let (step, long_step) = ((short / 4).max(1), (long / 4).max(1));
        let starts = |samples: i64| libm::ceil(samples.max(0) as f64 / long_step as f64);
        let end = (2 * long + 8 * short) / step;
        let mut sums = [0.0; 2];
        for place in -end..=end {
            let lag = place * step;
            let sum = |term: usize| {
                let places = (0..3).flat_map(|u| (0..3).map(move |v| (u, v)));
                let weights = [1.0, -2.0, 1.0];
                let one = |(u, v): (i64, i64)| {
                    let weight = weights[u as usize] * weights[v as usize];
                    weight * kernel(term, (lag + v * long - u * short) as f64)
                };
                places.map(one).sum::<f64>() / (short * long) as f64
            };
            let cost = starts(lag) + starts(-lag - 2 * (long - short));
            if cost <= most {
                let product = sum(a)
                    * if b == 4 {
                        (short * long) as f64
                    } else {
                        sum(b)
                    };
                sums[0] += product;
                sums[1] += cost * product;
            }
        }
        let both = if a == b { 1.0 } else { 2.0 };
        let unit = variance(a, short as f64) * variance(b, long as f64);
        sums.map(|sum| both * sum / unit)
    }

    #[test]
    fn every_entry_is_the_sum_over_the_distances() {
        for (row, distances) in TABLE.iter().enumerate() {
            for (distance, entries) in distances.iter().enumerate() {
                let pairs = (0..4).flat_map(|a| (a..5).map(move |b| [a, b]));
                for (pair, found) in pairs.zip(entries) {
                    let sums = entry(row, distance, pair);
                    let steps = [STEP_BITS, END_STEP_BITS[distance]];
                    for ((sum, step), &found) in sums.iter().zip(steps).zip(found) {
                        let off = sum / libm::exp2(step.into()) - f64::from(found);
                        assert!(off.abs() < 0.501, "{row} {distance} {pair:?}: {off}");
                    }
                }
            }
        }
    }
}
