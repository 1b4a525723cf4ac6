//! Blocks, segments, gaps, merges and a late main loop.

use super::{
    counts, densities,
    std::{self, vec::Vec},
};
use crate::{
    Scale,
    numerics::real::double,
    numerics::test_random::Random,
    spectrum::{Spectrum, SpectrumAccumulator},
};

const RATE_HZ: f64 = 100.0;

fn scale() -> Scale {
    Scale::new(1.0, 100.0).expect("valid")
}

/// Asserts that a spectrum is the mean of the densities of all segments in these stretches without a gap.
#[track_caller]
fn assert_is_direct<const P: usize, const LEVELS: usize>(
    found: &SpectrumAccumulator<P, LEVELS>,
    stretches: &[&[i32]],
) {
    let spectrum: Spectrum<800> = found.spectrum(scale());
    let mut compared = 0;
    for (level, bins) in spectrum.levels().enumerate() {
        let block = 8_usize.pow(level as u32);
        let mut sums = std::vec![(0.0, 0.0); 7 * P / 16];
        let mut segments = 0;
        for stretch in stretches {
            let mean = |block: &[i32]| {
                let sum: f64 = block.iter().map(|&count| f64::from(count)).sum();
                sum / block.len() as f64
            };
            let means: Vec<f64> = stretch.chunks_exact(block).map(mean).collect();
            for segment in means.windows(P).step_by(P / 2) {
                // A constant has no power in these bins, and without it less is rounded.
                let less: Vec<f64> = segment.iter().map(|value| value - segment[0]).collect();
                let densities = densities(&less, RATE_HZ / block as f64);
                segments += 1;
                for (sum, density) in sums.iter_mut().zip(densities) {
                    sum.0 += density;
                    sum.1 += density * density;
                }
            }
        }
        assert_eq!(bins.len(), sums.len());
        let n = f64::from(segments);
        for (bin, (sum, square)) in bins.iter().zip(sums) {
            assert_eq!((bin.block as usize, bin.segments), (block, segments));
            let off = double(bin.density) / (sum / n) - 1.0;
            assert!(off.abs() < 1e-4, "{block}, {}: {off:e}", bin.index);
            let kurtosis = (n + 1.0) / (n - 1.0) * (n * square / (sum * sum) - 1.0);
            let off = double(bin.spectral_kurtosis) - kurtosis;
            assert!(off.abs() < 1e-3, "{block}, {}: {off:e}", bin.index);
            compared += 1;
        }
    }
    assert!(compared >= 7 * P / 16);
}

fn of<const P: usize, const LEVELS: usize>(stretches: &[&[i32]]) -> SpectrumAccumulator<P, LEVELS> {
    let mut accumulator = SpectrumAccumulator::new();
    for stretch in stretches {
        accumulator.push_slice(stretch);
        accumulator.gap();
    }
    accumulator
}

#[test]
fn a_spectrum_is_the_mean_over_half_overlapping_segments() {
    let counts = counts(20_000);
    assert_is_direct(&of::<32, 3>(&[&counts]), &[&counts]);
    assert_is_direct(&of::<64, 3>(&[&counts]), &[&counts]);
    assert_is_direct(&of::<128, 2>(&[&counts]), &[&counts]);
    assert_is_direct(&of::<256, 2>(&[&counts]), &[&counts]);
}

#[test]
fn no_segment_spans_a_gap() {
    let counts = counts(12_000);
    let (first, rest) = counts.split_at(3_333);
    let (second, third) = rest.split_at(31);
    let stretches = [first, second, third];
    assert_is_direct(&of::<64, 2>(&stretches), &stretches);
}

#[test]
fn merged_records_are_as_one_with_a_gap() {
    let counts = counts(9_000);
    let (first, second) = counts.split_at(4_001);
    let mut merged = SpectrumAccumulator::<64, 2>::new();
    first.iter().take(30).for_each(|&count| merged.push(count));
    merged.push_slice(&first[30..]);
    let mut other = SpectrumAccumulator::<64, 2>::new();
    other.push_slice(&second[..4_900]);
    // Some counts still wait.
    second[4_900..]
        .iter()
        .take(64)
        .for_each(|&count| other.push(count));
    merged.merge(&other);
    let stretches = [first, &second[..4_964]];
    assert_is_direct(&merged, &stretches);
    assert_eq!(merged.lost(), 0);
}

#[test]
fn slices_lead_to_the_state_of_single_counts() {
    let mut random = Random::new(91);
    let [mut one_by_one, mut at_once] = [const { SpectrumAccumulator::<64, 3>::new() }; 2];
    for _ in 0..600 {
        if random.below(20) == 0 {
            one_by_one.gap();
            at_once.gap();
        }
        // A long slice has several segments, which are transformed together.
        let longest = if random.below(8) == 0 { 2000 } else { 150 };
        let length = random.below(longest);
        let shift = if random.below(8) == 0 { 0 } else { 20 };
        for _ in 0..length.min(3) {
            // What waits is worked on before a slice.
            let count = random.bits() as i32 >> shift;
            one_by_one.push(count);
            at_once.push(count);
        }
        while one_by_one.advance() {}
        let counts: std::vec::Vec<i32> =
            (0..length).map(|_| random.bits() as i32 >> shift).collect();
        for &count in &counts {
            one_by_one.push(count);
            while one_by_one.advance() {}
        }
        at_once.push_slice(&counts);
        assert_eq!(one_by_one, at_once);
    }
}

#[test]
fn the_main_loop_may_come_at_any_time_before_the_store_is_full() {
    let counts = counts(6_000);
    let mut at_once = SpectrumAccumulator::<64, 3>::new();
    at_once.push_slice(&counts);
    let mut in_parts = SpectrumAccumulator::<64, 3>::new();
    for (n, &count) in counts.iter().enumerate() {
        // Sometimes there is time for all the work, and mostly for a part of it.
        in_parts.push(count);
        if n % 50 == 49 {
            while in_parts.advance() {}
        } else if n % 3 == 0 {
            in_parts.advance();
        }
    }
    assert_eq!(in_parts.lost(), 0);
    in_parts.gap();
    at_once.gap();
    assert_eq!(in_parts, at_once);
}

#[test]
fn a_late_main_loop_loses_samples_as_at_a_gap() {
    let counts = counts(10_000);
    let mut late = SpectrumAccumulator::<64, 2>::new();
    late.push_slice(&counts[..5_000]);
    // There is room for 64 counts, and 17 more are lost.
    counts[5_000..5_081]
        .iter()
        .for_each(|&count| late.push(count));
    assert_eq!(late.lost(), 17);
    // As long as some of those before the loss wait, nothing can follow them.
    assert!(late.advance());
    late.push(counts[5_081]);
    assert_eq!(late.lost(), 18);
    while late.advance() {}
    for &count in &counts[5_082..] {
        late.push(count);
        while late.advance() {}
    }
    assert_eq!(late.lost(), 18);
    assert_is_direct(&late, &[&counts[..5_064], &counts[5_082..]]);
}

#[test]
fn full_scale_input_overflows_nothing() {
    // The slow square wave has power at the low bins of each level, the fast one at the highest.
    for half in [1, 4, 40] {
        let mut accumulator = SpectrumAccumulator::<64, 3>::new();
        let wave = |n: usize| {
            if (n / half).is_multiple_of(2) {
                i32::MIN
            } else {
                i32::MAX
            }
        };
        let counts: Vec<i32> = (0..64 * 600).map(wave).collect();
        accumulator.push_slice(&counts);
        let spectrum: Spectrum<84> = accumulator.spectrum(scale());
        let mut largest = 0.0;
        for bin in spectrum.bins() {
            assert!(bin.density.is_finite() && bin.spectral_kurtosis.is_finite());
            largest = bin.density.max(largest);
        }
        // Every segment is the same, so that nothing scatters.
        let segment: Vec<f64> = counts[..64].iter().map(|&count| f64::from(count)).collect();
        let expected = densities(&segment, RATE_HZ);
        if half == 4 {
            for (bin, expected) in spectrum.bins().iter().zip(expected) {
                let off = double(bin.density) - expected;
                // A thousand equal powers are all rounded the same way.
                assert!(off.abs() < 1e-4 * double(largest), "{}: {off:e}", bin.index);
            }
        }
    }
}

/// Ten levels of full-scale counts: the largest sums of counts there can be.
#[test]
fn the_highest_level_takes_full_scale_input() {
    let mut level = crate::spectrum::level::Level::<64>::EMPTY;
    let largest = (1_i64 << 59) - 1;
    for block in 0..640_u32 {
        level.push(block, if block % 2 == 0 { largest } else { -largest });
        if block % 32 == 31 && block > 32 {
            level.add_segment(block + 1, 27);
        }
    }
    for (power, square) in level.sums() {
        assert!(power.is_finite() && square.is_finite());
    }
    assert!(
        level
            .sums()
            .any(|(power, square)| power > 0.0 && square > 0.0)
    );
}

#[test]
fn a_constant_has_no_density() {
    for constant in [0, 1, -77, i32::MIN, i32::MAX] {
        let mut accumulator = SpectrumAccumulator::<64, 3>::new();
        accumulator.push_slice(&std::vec![constant; 64 * 600]);
        let spectrum: Spectrum<84> = accumulator.spectrum(scale());
        assert_eq!(spectrum.bins().len(), 84);
        let bins = spectrum.bins().iter();
        assert!(
            bins.clone()
                .all(|bin| bin.density == 0.0 && bin.spectral_kurtosis == 1.0)
        );
    }
}

#[test]
fn an_offset_cancels_exactly() {
    let counts = counts(9_000);
    let of = |offset: i32| {
        let mut accumulator = SpectrumAccumulator::<64, 2>::new();
        let moved: Vec<i32> = counts.iter().map(|count| count + offset).collect();
        accumulator.push_slice(&moved);
        accumulator.spectrum::<56>(scale())
    };
    assert_eq!(of(0), of(123_456));
    assert_eq!(of(0), of(i32::MIN));
}

#[test]
fn sums_of_many_segments_are_halved_and_stay_right() {
    let mut level = crate::spectrum::level::Level::<64>::EMPTY;
    let counts = counts(64 * 33);
    for (block, &count) in (0_u32..).zip(&counts) {
        level.push(block, i64::from(count));
        if block % 32 == 31 && block > 32 {
            level.add_segment(block + 1, 0);
        }
    }
    let n = level.segments();
    let before: Vec<(f32, f32)> = level.sums().collect();
    for _ in 0..24 {
        let other = level;
        level.merge(&other);
    }
    assert!((1 << 19..=1 << 20).contains(&level.segments()));
    let ratio = level.segments() as f32 / n as f32;
    for ((power, square), (first_power, first_square)) in level.sums().zip(before) {
        assert!((power / first_power / ratio - 1.0).abs() < 1e-3);
        assert!((square / first_square / ratio - 1.0).abs() < 1e-3);
    }
}

/// The numbers were printed by an image on a Cortex-M4F in QEMU, built for size and built for speed.
#[test]
#[cfg(not(feature = "double"))]
fn a_target_computes_the_same_bits() {
    let mut random = 1_u32;
    let next = |_| {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (random >> 16) as i32
    };
    let counts: Vec<i32> = (0..40_000).map(next).collect();
    let spectrum = of::<64, 3>(&[&counts]).spectrum::<84>(scale());
    let bins = spectrum.bins().iter().filter(|bin| bin.index % 9 == 4);
    let found: Vec<_> = bins
        .map(|bin| {
            let bits = (bin.density.to_bits(), bin.spectral_kurtosis.to_bits());
            (bin.block, bin.index, bits.0, bits.1)
        })
        .collect();
    let expected = [
        (1, 4, 0x4adc_a20c, 0x3f80_68a0),
        (1, 13, 0x4ade_14f1, 0x3f71_d584),
        (1, 22, 0x4adb_85a8, 0x3f74_382a),
        (1, 31, 0x4ada_9eb5, 0x3f67_2d5a),
        (8, 4, 0x4abb_3b79, 0x3f68_363a),
        (8, 13, 0x4aea_c6a8, 0x3f8a_7bf9),
        (8, 22, 0x4af0_a9e5, 0x3f6a_e091),
        (8, 31, 0x4ac5_ac78, 0x3f73_1408),
        (64, 4, 0x4b20_8e52, 0x3f12_e54c),
        (64, 13, 0x4b15_77ec, 0x3f73_2609),
        (64, 22, 0x4b09_bfdd, 0x3fcd_41fc),
        (64, 31, 0x4aba_c638, 0x3f81_b7a2),
    ];
    assert_eq!(found, expected);
}

#[test]
fn only_whole_levels_enter_a_spectrum() {
    let accumulator = of::<64, 3>(&[&counts(40_000)]);
    let lengths = [
        accumulator.spectrum::<27>(scale()).bins().len(),
        accumulator.spectrum::<28>(scale()).bins().len(),
        accumulator.spectrum::<83>(scale()).bins().len(),
        accumulator.spectrum::<84>(scale()).bins().len(),
    ];
    assert_eq!(lengths, [0, 28, 56, 84]);
    // The third level has fewer than 16 segments.
    let short = of::<64, 3>(&[&counts(30_000)]);
    assert_eq!(short.spectrum::<84>(scale()).bins().len(), 56);
}

#[test]
fn the_state_of_a_target_fits_in_four_kibibytes() {
    assert!(size_of::<SpectrumAccumulator<64, 7>>() <= 3936);
}
