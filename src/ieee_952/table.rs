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
/// the fourth. The ramp has no scatter of its own. Beyond the last distance, an entry falls by a power of two an octave, which is
/// that of its kernels.
pub(super) const PAIRS: usize = 14;

/// The rows of the table: octaves of `m = 1`, of 2, of 4 or more, and of 4 or more beside an octave with few differences.
pub(super) const ROWS: usize = 4;

/// The value of a step of `T0`, as a power of two: relative to the variances of the terms in the two octaves.
pub(super) const STEP_BITS: i32 = -9;

/// The same for `T1`, at each distance.
pub(super) const END_STEP_BITS: [i32; DISTANCES] = [-7, -8, -10, -11, -13, -14, -14];

/// `T0` and `T1` of every row and distance, each of all pairs.
#[rustfmt::skip]
pub(super) static TABLE: [[[[i16; PAIRS]; 2]; DISTANCES]; ROWS] = [
    [
        [[3982, 6827, 5100, 2731, 0, 3072, 4984, 3072, 0, 2325, 3652, 282, 2304, 6144], [512, 683, 206, -341, -683, 256, 222, -256, -1024, 96, -111, -2103, 64, 512]],
        [[1593, 2048, 1196, 512, 0, 1536, 2143, 1152, 0, 1816, 2536, 239, 2784, 6144], [341, 341, 95, -43, 0, 256, 270, -64, -512, 245, -67, -2747, 16, 256]],
        [[2048, 1024, 264, 64, 0, 768, 734, 336, 0, 1109, 1444, 187, 2988, 6144], [1365, 683, 130, -21, 0, 512, 403, -32, -512, 703, -50, -6486, 8, 256]],
        [[2048, 512, 64, 8, 0, 384, 232, 90, 0, 605, 754, 135, 3050, 6144], [2276, 683, 126, -5, -85, 512, 266, -8, -256, 631, -17, -4475, 2, 128]],
        [[2048, 256, 16, 1, 0, 192, 70, 23, 0, 314, 382, 90, 3066, 6144], [9102, 1365, 150, -3, -85, 1024, 330, -4, -256, 1113, -10, -6668, 1, 128]],
        [[2048, 128, 4, 0, 0, 96, 20, 6, 0, 159, 192, 55, 3071, 6144], [18204, 1365, 86, -1, -43, 1024, 197, -1, -128, 967, -3, -5425, 0, 64]],
        [[2048, 64, 1, 0, 0, 48, 6, 1, 0, 80, 96, 32, 3072, 6144], [18204, 683, 24, 0, -11, 512, 57, 0, -32, 426, 0, -2404, 0, 16]],
    ],
    [
        [[3982, 6827, 5100, 2731, 0, 3584, 6540, 4480, 0, 3610, 6386, 578, 4424, 12288], [1024, 1365, 412, -683, -1365, 768, 1122, -192, -3072, 709, 425, -7538, 660, 2688]],
        [[1593, 2048, 1196, 512, 0, 2304, 3633, 2064, 0, 3440, 4965, 488, 5547, 12288], [683, 683, 191, -85, 0, 768, 930, -240, -2048, 939, -220, -10772, 189, 1408]],
        [[2048, 1024, 264, 64, 0, 1152, 1314, 642, 0, 2173, 2875, 381, 5973, 12288], [1365, 683, 130, -21, 0, 896, 872, -86, -1280, 1593, -164, -13920, 86, 1120]],
        [[2048, 512, 64, 8, 0, 576, 426, 176, 0, 1198, 1505, 274, 6099, 12288], [2276, 683, 126, -5, -85, 768, 482, -21, -512, 1334, -59, -9322, 22, 544]],
        [[2048, 256, 16, 1, 0, 288, 131, 46, 0, 625, 763, 181, 6132, 12288], [9102, 1365, 150, -3, -85, 1536, 611, -10, -512, 2332, -38, -13687, 11, 544]],
        [[2048, 128, 4, 0, 0, 144, 39, 12, 0, 317, 383, 111, 6141, 12288], [18204, 1365, 86, -1, -43, 1536, 369, -3, -256, 2014, -12, -11028, 3, 272]],
        [[2048, 64, 1, 0, 0, 72, 11, 3, 0, 159, 192, 63, 6143, 12288], [18204, 683, 24, 0, -11, 768, 108, 0, -64, 881, -2, -4856, 0, 68]],
    ],
    [
        [[3982, 6827, 5100, 2731, 0, 5888, 11802, 8368, 0, 7034, 12651, 1171, 8836, 24576], [2048, 2731, 823, -1365, -2731, 2816, 4776, 16, -11264, 3108, 2324, -29369, 2926, 11296]],
        [[1593, 2048, 1196, 512, 0, 4224, 6998, 4026, 0, 6840, 9911, 987, 11092, 24576], [683, 683, 191, -85, 0, 1568, 1998, -558, -4608, 2043, -430, -22391, 642, 3888]],
        [[2048, 1024, 264, 64, 0, 2112, 2567, 1271, 0, 4336, 5748, 769, 11947, 24576], [1365, 683, 130, -21, 0, 1856, 1892, -189, -2816, 3406, -383, -28774, 282, 2992]],
        [[2048, 512, 64, 8, 0, 1056, 837, 351, 0, 2394, 3010, 551, 12197, 24576], [2276, 683, 126, -5, -85, 1408, 944, -44, -1024, 2752, -141, -19015, 70, 1424]],
        [[2048, 256, 16, 1, 0, 528, 257, 92, 0, 1249, 1527, 363, 12265, 24576], [9102, 1365, 150, -3, -85, 2816, 1201, -22, -1024, 4774, -94, -27712, 35, 1424]],
        [[2048, 128, 4, 0, 0, 264, 76, 23, 0, 634, 767, 222, 12282, 24576], [18204, 1365, 86, -1, -43, 2816, 729, -6, -512, 4108, -29, -22229, 9, 712]],
        [[2048, 64, 1, 0, 0, 132, 22, 6, 0, 317, 384, 127, 12287, 24576], [18204, 683, 24, 0, -11, 1408, 214, -1, -128, 1791, -4, -9759, 1, 178]],
    ],
    [
        [[3868, 6827, 5281, 2731, -1365, 5824, 11586, 8372, 1024, 6677, 12658, 8896, 8836, 24544], [1820, 2731, 1185, -1365, -5461, 2704, 4398, 23, -9472, 2344, 2336, -4171, 2926, 11240]],
        [[1593, 2048, 1196, 512, 0, 4224, 6998, 4026, 0, 6792, 9911, 3026, 11092, 24576], [683, 683, 191, -85, 0, 1568, 1998, -558, -4608, 1818, -430, -10587, 642, 3888]],
        [[2048, 1024, 264, 64, 0, 2112, 2567, 1271, 0, 4323, 5748, 1343, 11947, 24576], [1365, 683, 130, -21, 0, 1856, 1892, -189, -2816, 3171, -383, -17870, 282, 2992]],
        [[2048, 512, 64, 8, 0, 1056, 837, 351, 0, 2391, 3010, 678, 12197, 24576], [2276, 683, 126, -5, -85, 1408, 944, -44, -1024, 2654, -141, -14448, 70, 1424]],
        [[2048, 256, 16, 1, 0, 528, 257, 92, 0, 1248, 1527, 410, 12265, 24576], [9102, 1365, 150, -3, -85, 2816, 1201, -22, -1024, 4630, -94, -21516, 35, 1424]],
        [[2048, 128, 4, 0, 0, 264, 76, 23, 0, 634, 767, 240, 12282, 24576], [18204, 1365, 86, -1, -43, 2816, 729, -6, -512, 3993, -29, -17540, 9, 712]],
        [[2048, 64, 1, 0, 0, 132, 22, 6, 0, 317, 384, 135, 12287, 24576], [18204, 683, 24, 0, -11, 1408, 214, -1, -128, 1741, -4, -7787, 1, 178]],
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
                let [common, at_ends] = entries;
                for (pair, found) in pairs.zip(common.iter().zip(at_ends)) {
                    let sums = entry(row, distance, pair);
                    let steps = [STEP_BITS, END_STEP_BITS[distance]];
                    let found = [*found.0, *found.1];
                    for ((sum, step), found) in sums.iter().zip(steps).zip(found) {
                        let off = sum / libm::exp2(step.into()) - f64::from(found);
                        assert!(off.abs() < 0.501, "{row} {distance} {pair:?}: {off}");
                    }
                }
            }
        }
    }
}
