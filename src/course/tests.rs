//! The exactness of the sums, and where the course's time goes.

extern crate std;

use super::*;
use crate::{
    curve::Scale,
    numerics::{
        real::{Real, by_precision, double},
        test_random::Random,
    },
    record::course::LONGEST,
};
use std::vec::Vec as List;

/// What one sample of time held: a count with a covariate, and whether it follows the sample before it.
type Slot = Option<(i32, i32, bool)>;

/// The course, and every sample of time.
struct Recorded {
    course: Course<1>,
    slots: List<Slot>,
    is_running: bool,
}

impl Recorded {
    fn new() -> Self {
        Self {
            course: Course::new(),
            slots: List::new(),
            is_running: false,
        }
    }

    fn push(&mut self, count: i32, covariate: i32) {
        self.course.push(count, [covariate]);
        self.slots.push(Some((count, covariate, self.is_running)));
        self.is_running = true;
    }

    fn lost(&mut self, samples: usize) {
        self.course.lost(samples as u64);
        self.slots.resize(self.slots.len() + samples, None);
        self.is_running &= samples == 0;
    }

    fn gap(&mut self) {
        self.course.gap();
        self.is_running = false;
    }

    /// Compares every block with plain sums over its samples.
    fn assert_exact(&self) {
        let length = self.course.block_length() as usize;
        assert_eq!(self.course.time(), self.slots.len() as u64);
        let expected = self.slots.chunks(length);
        assert!(expected.len() <= BLOCKS);
        assert!(length == 1 || expected.len() > BLOCKS / 2);
        let scale = Scale::new(1.0, 1.0).expect("positive");
        let found: List<_> = self
            .course
            .exact_sums()
            .zip(self.course.blocks(scale))
            .collect();
        assert_eq!(found.len(), expected.len());
        let mut before = 0_i64;
        for (slots, ((counts, squares), block)) in expected.zip(found) {
            let (mut sum, mut sum_of_squares, mut samples, mut differences) = (0, 0, 0, 0);
            let mut covariates = 0;
            for (count, covariate, has_difference) in slots.iter().flatten() {
                sum += i64::from(*count);
                covariates += i64::from(*covariate);
                samples += 1;
                if *has_difference {
                    let difference = i128::from(i64::from(*count) - before);
                    sum_of_squares += (difference * difference) as u128;
                    differences += 1;
                }
                before = i64::from(*count);
            }
            assert_eq!((counts, squares), (sum, sum_of_squares));
            assert_eq!(block.samples, samples);
            assert_eq!(block.duration_s, slots.len() as Real);
            if samples == 0 {
                assert!(block.mean.is_nan() && block.covariates[0].is_nan());
                continue;
            }
            let close = |found: Real, expected: f64| {
                let off = double(found) - expected;
                off.abs() <= double(by_precision(1e-12, 1e-5)) * expected.abs()
            };
            assert!(close(block.mean, sum as f64 / f64::from(samples)));
            assert!(close(
                block.covariates[0],
                covariates as f64 / f64::from(samples)
            ));
            if differences == 0 {
                assert!(block.mean_square_difference.is_nan());
            } else {
                let mean = sum_of_squares as f64 / f64::from(differences);
                assert!(close(block.mean_square_difference, mean));
            }
        }
    }
}

#[test]
fn slices_lead_to_the_state_of_single_counts() {
    let mut random = Random::new(72);
    let [mut one_by_one, mut at_once] = [const { Course::<0>::new() }; 2];
    for _ in 0..400 {
        if random.below(10) == 0 {
            one_by_one.gap();
            at_once.gap();
        }
        let length = random.below(70);
        let shift = if random.below(8) == 0 { 0 } else { 20 };
        let counts: List<i32> = (0..length).map(|_| random.bits() as i32 >> shift).collect();
        counts.iter().for_each(|&count| one_by_one.push(count, []));
        at_once.push_slice(&counts);
        assert_eq!(one_by_one, at_once);
    }
    assert!(one_by_one.block_length() > 1);
}

#[test]
fn sums_are_exact_through_doublings_and_gaps() {
    let mut random = Random::new(71);
    for wide in [false, true] {
        let mut recorded = Recorded::new();
        for n in 0..3000 {
            match random.below(40) {
                0 => recorded.gap(),
                1 => recorded.lost(random.below(30)),
                _ => {}
            }
            // Counts of a gyro at rest, or those at both ends of their range.
            let count = match random.below(3) {
                _ if !wide => random.below(1000) as i32 - 480,
                0 => i32::MIN,
                1 => i32::MAX,
                _ => (random.signed() * 2_147_483_647.0) as i32,
            };
            recorded.push(count, random.below(100) as i32);
            if n < 300 || n % 97 == 0 {
                recorded.assert_exact();
            }
        }
        assert!(recorded.course.block_length() >= 64);
    }
}

#[test]
fn blocks_double_when_the_sample_after_the_last_block_comes() {
    let mut course = Course::<0>::new();
    for n in 1..=4096_u32 {
        course.push(1, []);
        let length = n.div_ceil(64).next_power_of_two();
        assert_eq!(
            (course.block_length(), course.time()),
            (length, u64::from(n))
        );
        assert_eq!(course.exact_sums().count() as u32, n.div_ceil(length));
    }
}

#[test]
fn a_course_ends_after_its_longest_blocks_and_keeps_what_it_has() {
    let mut course = Course::<0>::new();
    course.push(7, []);
    course.lost(u64::MAX);
    assert_eq!(course.time(), 1 << 37);
    assert_eq!(course.block_length(), LONGEST);
    let full = course.clone();
    course.push(5, []);
    course.lost(3);
    assert_eq!(course.exact_sums().next(), Some((7, 0)));
    assert!(course.exact_sums().eq(full.exact_sums()));
    assert_eq!(course.time(), full.time());
}

#[test]
fn an_offset_of_the_counts_leaves_the_levels_as_they_are() {
    let scale = Scale::new(0.5, 100.0).expect("positive");
    let mut random = Random::new(72);
    let counts: List<i32> = (0..5000).map(|_| random.below(200) as i32).collect();
    let levels = |offset: i32| {
        let mut course = Course::<0>::new();
        counts
            .iter()
            .for_each(|count| course.push(count + offset, []));
        course.levels(scale)
    };
    for (plain, shifted) in levels(0).iter().zip(&levels(1 << 30)) {
        assert_eq!((plain.mean, plain.square), (shifted.mean, shifted.square));
    }
}

#[test]
fn a_new_course_is_empty_and_takes_the_memory_that_is_documented() {
    let scale = Scale::new(1.0, 1.0).expect("positive");
    assert_eq!(Course::<2>::new().blocks(scale).count(), 0);
    assert_eq!(size_of::<Course>(), 2096);
    assert_eq!(size_of::<Course<1>>(), 2096 + 520);
}

/// A record of white noise of 100 counts, with whatever `change` makes of a count.
fn told(change: impl Fn(u32, f64) -> f64) -> List<Event> {
    let mut random = Random::new(73);
    let mut course = Course::<0>::new();
    for n in 0..1 << 14 {
        // The sum of twelve uniform numbers between −1 and 1 has the variance 4.
        let noise: f64 = (0..12).map(|_| random.signed()).sum::<f64>() * 50.0;
        course.push(libm::round(change(n, noise)) as i32, []);
    }
    let scale = Scale::new(0.01, 100.0).expect("positive");
    // The rate has a standard deviation of 1, N² = 1/100, and a little flicker noise and random walk.
    let squares = [0.0, 0.01, 1e-6, 1e-8, 0.0];
    let events = events(&course, scale, &crate::Model::ieee_952(), &squares);
    events.iter().copied().collect()
}

#[test]
fn events_in_white_noise_are_told_in_either_precision() {
    assert_eq!(told(|_, noise| noise), []);
    let contains = |event: &Event, size: Real| event.lower < size && size < event.upper;
    let one = |events: List<Event>| {
        assert_eq!(events.len(), 1, "{events:?}");
        events[0]
    };
    // Blocks are 2.56 s long. An offset of a million counts is no event.
    let step = one(told(|n, noise| {
        noise + 1e6 + if n >= 9000 { 30.0 } else { 0.0 }
    }));
    assert_eq!(step.what, What::Step);
    assert!(
        (step.at_s - 90.0).abs() < 2.56 && contains(&step, 0.3),
        "{step:?}"
    );
    let warm_up = one(told(|n, noise| {
        noise + 60.0 * libm::exp(-f64::from(n) / 2000.0)
    }));
    let What::WarmUp { time_constant_s } = warm_up.what else {
        panic!("{warm_up:?}")
    };
    assert!(
        (12.0..32.0).contains(&time_constant_s) && contains(&warm_up, 0.6),
        "{warm_up:?}"
    );
    let change = one(told(|n, noise| noise * if n < 4096 { 1.0 } else { 0.8 }));
    assert_eq!(change.what, What::NoiseChange);
    assert!(
        (change.at_s - 40.96).abs() < 2.57 && contains(&change, 0.8),
        "{change:?}"
    );
    let bursts = one(told(|n, noise| {
        noise * if n % 5000 < 30 { 5.0 } else { 1.0 }
    }));
    assert!(
        matches!(bursts.what, What::Bursts { blocks: 3..=5 }),
        "{bursts:?}"
    );
}
