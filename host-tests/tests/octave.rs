//! The accumulator against its definition in big integers, and what must not change its state.

use allanite::Accumulator;
use num_bigint::BigUint;
use proptest::{collection::vec, prelude::*, test_runner::RngSeed};
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

/// What a record holds by definition: every count, and where the stretches end.
#[derive(Clone, Default)]
struct Record {
    ended: Vec<Vec<i32>>,
    running: Vec<i32>,
    gaps: u64,
}

/// `m`, number of differences, Σ D².
type Octave = (u32, u64, BigUint);

impl Record {
    fn samples(&self) -> u64 {
        let ended: usize = self.ended.iter().map(Vec::len).sum();
        (ended + self.running.len()) as u64
    }

    fn gap(&mut self) {
        if !self.running.is_empty() {
            self.ended.push(std::mem::take(&mut self.running));
            self.gaps += 1;
        }
    }

    fn merge(&mut self, mut other: Self) {
        if other.samples() > 0 {
            self.gap();
            other.gap();
            self.ended.append(&mut other.ended);
            self.gaps += other.gaps;
        }
    }

    fn octaves(&self, count: usize) -> Vec<Octave> {
        let stretches = || self.ended.iter().chain([&self.running]);
        let angles: Vec<Vec<i128>> = stretches().map(|counts| angles(counts)).collect();
        (0..count)
            .map(|k| {
                let m = 1 << k;
                let (mut differences, mut sum) = (0, BigUint::ZERO);
                for theta in &angles {
                    for start in (0..theta.len().saturating_sub(2 * m)).step_by((m / 4).max(1)) {
                        let d = theta[start + 2 * m] - 2 * theta[start + m] + theta[start];
                        differences += 1;
                        sum += square(d);
                    }
                }
                (m as u32, differences, sum)
            })
            .collect()
    }
}

/// `θ_0 … θ_N`.
fn angles(counts: &[i32]) -> Vec<i128> {
    let sums = counts.iter().scan(0, |theta, &count| {
        *theta += i128::from(count);
        Some(*theta)
    });
    std::iter::once(0).chain(sums).collect()
}

fn square(d: i128) -> BigUint {
    BigUint::from(d.unsigned_abs()).pow(2)
}

fn big(limbs: [u64; 3]) -> BigUint {
    let words = limbs
        .iter()
        .flat_map(|limb| [*limb as u32, (limb >> 32) as u32]);
    BigUint::new(words.collect())
}

fn octaves<const K: usize>(accumulator: &Accumulator<K>) -> Vec<Octave> {
    let octaves = accumulator.octaves();
    octaves
        .map(|octave| (octave.m, octave.differences, big(octave.sum.limbs())))
        .collect()
}

/// A stretch of counts.
#[derive(Clone, Copy, Debug)]
enum Counts {
    /// Any 32 bits, a full-scale one now and then.
    Wide { seed: u64 },
    /// A gyro at rest.
    Small { seed: u64 },
    /// Full scale up and down.
    Square { half_period: usize },
}

impl Counts {
    fn take(self, len: usize) -> Vec<i32> {
        match self {
            Self::Wide { seed } => {
                let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
                let mut next = || match random.next_u32() {
                    bits if bits % 16 == 0 => i32::MIN,
                    bits if bits % 16 == 1 => i32::MAX,
                    bits => bits.rotate_left(7) as i32,
                };
                (0..len).map(|_| next()).collect()
            }
            Self::Small { seed } => {
                let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
                (0..len)
                    .map(|_| (random.next_u32() % 41) as i32 - 20)
                    .collect()
            }
            Self::Square { half_period } => (0..len)
                .map(|i| {
                    if i / half_period % 2 == 0 {
                        i32::MIN
                    } else {
                        i32::MAX
                    }
                })
                .collect(),
        }
    }
}

fn counts(longest: usize) -> impl Strategy<Value = Vec<i32>> {
    let shape = prop_oneof![
        any::<u64>().prop_map(|seed| Counts::Wide { seed }),
        any::<u64>().prop_map(|seed| Counts::Small { seed }),
        (1_usize..200).prop_map(|half_period| Counts::Square { half_period }),
    ];
    (shape, 0..=longest).prop_map(|(shape, len)| shape.take(len))
}

/// Something that happens to an accumulator.
#[derive(Clone, Debug)]
enum Event {
    Push(Vec<i32>),
    PushSlice(Vec<i32>),
    Gap,
    Read,
    Merge(Vec<Event>),
    /// The accumulator so far is merged into another that has seen these.
    MergeInto(Vec<Event>),
    Reset,
}

fn events() -> impl Strategy<Value = Vec<Event>> {
    let plain = prop_oneof![
        3 => counts(30).prop_map(Event::Push),
        3 => counts(30).prop_map(Event::PushSlice),
        2 => counts(900).prop_map(Event::PushSlice),
        1 => Just(Event::Gap),
        2 => Just(Event::Read),
    ];
    let other = || {
        vec(
            prop_oneof![counts(300).prop_map(Event::PushSlice), Just(Event::Gap)],
            0..4,
        )
    };
    vec(
        prop_oneof![
            20 => plain,
            1 => other().prop_map(Event::Merge),
            1 => other().prop_map(Event::MergeInto),
            1 => Just(Event::Reset),
        ],
        0..24,
    )
}

fn play<const K: usize>(events: &[Event]) -> (Accumulator<K>, Record) {
    let (mut accumulator, mut record) = (Accumulator::<K>::new(), Record::default());
    for event in events {
        match event {
            Event::Push(counts) => {
                counts.iter().for_each(|&count| accumulator.push(count));
                record.running.extend(counts);
            }
            Event::PushSlice(counts) => {
                accumulator.push_slice(counts);
                record.running.extend(counts);
            }
            Event::Gap => {
                accumulator.gap();
                record.gap();
            }
            Event::Read => check(&accumulator, &record),
            Event::Merge(events) => {
                let (other, other_record) = play(events);
                accumulator.merge(&other);
                record.merge(other_record);
            }
            Event::MergeInto(events) => {
                let (mut other, mut other_record) = play(events);
                other.merge(&accumulator);
                other_record.merge(record);
                (accumulator, record) = (other, other_record);
            }
            Event::Reset => {
                accumulator.reset();
                record = Record::default();
            }
        }
    }
    (accumulator, record)
}

fn check<const K: usize>(accumulator: &Accumulator<K>, record: &Record) {
    assert_eq!(octaves(accumulator), record.octaves(K));
    assert_eq!(accumulator.samples(), record.samples(), "samples");
    assert_eq!(accumulator.gaps(), record.gaps, "gaps");
}

/// The same cases in every run.
fn seeded(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        rng_seed: RngSeed::Fixed(952),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

proptest! {
    #![proptest_config(seeded(256))]

    #[test]
    fn any_sequence_of_events_sums_what_the_definition_sums(events in events()) {
        let (accumulator, record) = play::<13>(&events);
        check(&accumulator, &record);
        // Fewer octaves are the first of more, down to the least, and the most.
        check(&play::<2>(&events).0, &record);
        check(&play::<3>(&events).0, &record);
        check(&play::<4>(&events).0, &record);
        check(&play::<30>(&events).0, &record);
    }

    #[test]
    fn slices_of_any_cut_leave_the_state_of_single_counts(
        stretches in vec((counts(2000), vec(any::<prop::sample::Index>(), 0..8)), 1..3),
    ) {
        let (mut singly, mut sliced) = (Accumulator::<13>::new(), Accumulator::<13>::new());
        for (counts, cuts) in stretches {
            singly.gap();
            sliced.gap();
            counts.iter().for_each(|&count| singly.push(count));
            let mut cuts: Vec<_> = cuts.iter().map(|cut| cut.index(counts.len() + 1)).collect();
            cuts.extend([0, counts.len()]);
            cuts.sort_unstable();
            cuts.windows(2).for_each(|cut| sliced.push_slice(&counts[cut[0]..cut[1]]));
            prop_assert_eq!(&singly, &sliced);
        }
    }

    #[test]
    fn a_copy_goes_on_where_the_original_stopped(before in counts(1500), after in counts(1500)) {
        let mut one = Accumulator::<13>::new();
        one.push_slice(&before);
        let mut restarted = one.clone();
        let mut whole = Accumulator::<13>::new();
        let all: Vec<i32> = before.iter().chain(&after).copied().collect();
        restarted.push_slice(&after);
        whole.push_slice(&all);
        prop_assert_eq!(restarted, whole);
    }

    #[test]
    fn merging_is_one_record_with_a_gap_between(first in counts(1500), second in counts(1500)) {
        let accumulate = |counts: &[i32]| {
            let mut accumulator = Accumulator::<13>::new();
            accumulator.push_slice(counts);
            accumulator
        };
        let mut merged = accumulate(&first);
        merged.merge(&accumulate(&second));
        let mut batch = accumulate(&first);
        batch.gap();
        batch.push_slice(&second);
        // An empty second record leaves the first one open.
        prop_assert_eq!(octaves(&merged), octaves(&batch));
        if !second.is_empty() {
            batch.gap();
            prop_assert_eq!(merged, batch);
        }
    }

    #[test]
    fn the_order_of_merging_does_not_show(first in events(), second in events()) {
        let ((mut one, _), (mut other, _)) = (play::<13>(&first), play::<13>(&second));
        let before = one.clone();
        one.merge(&other);
        other.merge(&before);
        prop_assert_eq!(octaves(&one), octaves(&other));
        prop_assert_eq!(one.samples(), other.samples());
    }

    #[test]
    fn a_constant_offset_cancels_exactly(counts in counts(2000), offset in any::<i32>()) {
        let halves = counts.iter().map(|count| count / 2);
        let mut plain = Accumulator::<13>::new();
        halves.clone().for_each(|count| plain.push(count));
        let mut shifted = Accumulator::<13>::new();
        halves.for_each(|count| shifted.push(count + offset / 2));
        prop_assert_eq!(octaves(&plain), octaves(&shifted));
    }

    #[test]
    fn sums_scale_with_the_square_of_the_counts(counts in counts(2000), factor in -63_i32..=64) {
        let narrow = counts.iter().map(|count| count / 64);
        let mut unit = Accumulator::<13>::new();
        narrow.clone().for_each(|count| unit.push(count));
        let mut scaled = Accumulator::<13>::new();
        narrow.for_each(|count| scaled.push(count * factor));
        for (unit, scaled) in octaves(&unit).into_iter().zip(octaves(&scaled)) {
            prop_assert_eq!(unit.1, scaled.1);
            prop_assert_eq!(unit.2 * square(i128::from(factor)), scaled.2);
        }
    }
}

#[test]
fn every_octave_is_complete_after_every_sample() {
    const OCTAVES: usize = 9;
    let counts = Counts::Wide { seed: 1 }.take(1300);
    let mut accumulator = Accumulator::<OCTAVES>::new();
    let theta = angles(&counts);
    let (mut differences, mut sums) = ([0; OCTAVES], [BigUint::ZERO; OCTAVES]);
    for n in 1..=counts.len() {
        accumulator.push(counts[n - 1]);
        for k in 0..OCTAVES {
            let m = 1 << k;
            // A difference ends here if it starts at 0 or later, at a multiple of h.
            if n >= 2 * m && (n - 2 * m).is_multiple_of((m / 4).max(1)) {
                differences[k] += 1;
                sums[k] += square(theta[n] - 2 * theta[n - m] + theta[n - 2 * m]);
            }
            let octave = accumulator.octave(k).expect("an octave of the accumulator");
            let read = (octave.m, octave.differences, big(octave.sum.limbs()));
            assert_eq!(read, (m as u32, differences[k], sums[k].clone()), "n = {n}");
        }
        assert!(accumulator.octave(OCTAVES).is_none());
    }
}

#[test]
fn reading_leaves_the_state_alone() {
    let counts = Counts::Wide { seed: 2 }.take(5000);
    let (mut read, mut unread) = (Accumulator::<13>::new(), Accumulator::<13>::new());
    for chunk in counts.chunks(37) {
        read.push_slice(chunk);
        let before = read.clone();
        assert_eq!(octaves(&read), octaves(&read));
        assert_eq!(read, before);
        unread.push_slice(chunk);
    }
    assert_eq!(read, unread);
}

#[test]
fn nothing_comes_of_nothing() {
    let mut accumulator = Accumulator::<30>::new();
    accumulator.gap();
    accumulator.push_slice(&[]);
    accumulator.merge(&Accumulator::new());
    assert_eq!(accumulator, Accumulator::default());
    assert_eq!((accumulator.samples(), accumulator.gaps()), (0, 0));
    accumulator.push(i32::MIN);
    assert!(accumulator.octaves().all(|octave| octave.differences == 0));
    accumulator.reset();
    assert_eq!(accumulator, Accumulator::new());
}

/// A full-scale square wave whose sums follow from where its edges are.
#[derive(Clone, Copy)]
struct SquareWave {
    half_period: u64,
    samples: u64,
}

impl SquareWave {
    fn accumulate(self) -> Accumulator<30> {
        let mut accumulator = Accumulator::new();
        self.push_to(&mut accumulator);
        accumulator
    }

    fn push_to(self, accumulator: &mut Accumulator<30>) {
        const CHUNK: u64 = 1 << 16;
        if self.half_period < CHUNK {
            let half_period = self.half_period as usize;
            let counts = Counts::Square { half_period }.take(CHUNK as usize);
            for _ in 0..self.samples / CHUNK {
                accumulator.push_slice(&counts);
            }
        } else {
            let (low, high) = ([i32::MIN; CHUNK as usize], [i32::MAX; CHUNK as usize]);
            for chunk in 0..self.samples / CHUNK {
                let up = chunk * CHUNK / self.half_period % 2 == 1;
                accumulator.push_slice(if up { &high } else { &low });
            }
        }
    }

    /// The angle at `n`, in closed form.
    fn angle(self, n: u64) -> i128 {
        let (p, n) = (i128::from(self.half_period), i128::from(n));
        let (periods, rest) = (n / (2 * p), n % (2 * p));
        let (low, high) = (rest.min(p), (rest - p).max(0));
        -periods * p + low * i128::from(i32::MIN) + high * i128::from(i32::MAX)
    }

    fn octave(self, k: u32) -> Octave {
        let m = 1_u64 << k;
        let h = (m / 4).max(1);
        if self.samples < 2 * m {
            return (m as u32, 0, BigUint::ZERO);
        }
        let last = (self.samples - 2 * m) / h;
        let squared = |i: u64| {
            let s = i * h;
            square(self.angle(s + 2 * m) - 2 * self.angle(s + m) + self.angle(s))
        };
        // Differences repeat with the period; within it, only those that span an edge are not 0.
        let period = (2 * self.half_period / h).max(1);
        let (whole, rest) = ((last + 1) / period, (last + 1) % period);
        let spans_edge = |i: &u64| {
            let (first, end) = (
                i * h / self.half_period,
                (i * h + 2 * m - 1) / self.half_period,
            );
            first != end
        };
        let mut in_period = BigUint::ZERO;
        let mut sum = BigUint::ZERO;
        let starts = |end: u64| {
            // Starts of differences over the edges at every half-period, each once.
            let edges = 1..=(end * h + 2 * m) / self.half_period;
            let mut next = 0;
            edges.flat_map(move |edge| {
                let edge = edge * self.half_period;
                let from = (edge.saturating_sub(2 * m) / h).max(next);
                let to = (edge / h + 1).min(end).max(from);
                next = to;
                from..to
            })
        };
        for i in starts(period.min(last + 1)).filter(spans_edge) {
            in_period += squared(i);
        }
        for i in starts(rest).filter(spans_edge) {
            sum += squared(i);
        }
        if whole > 0 {
            sum += in_period * whole;
        }
        (m as u32, last + 1, sum)
    }

    fn octaves(self) -> Vec<Octave> {
        (0..30).map(|k| self.octave(k)).collect()
    }
}

/// The closed form itself, on records short enough for the definition.
#[test]
fn the_closed_form_of_square_waves_follows_the_definition() {
    for half_period in [1_u64, 2, 16, 256, 2048, 1 << 15] {
        let wave = SquareWave {
            half_period,
            samples: 1 << 16,
        };
        let record = Record {
            running: Counts::Square {
                half_period: half_period as usize,
            }
            .take(1 << 16),
            ..Record::default()
        };
        assert_eq!(
            wave.octaves(),
            record.octaves(30),
            "half-period {half_period}"
        );
    }
}

#[test]
fn full_scale_square_waves_overflow_no_octave() {
    for (exponent, length) in [(0, 24), (3, 24), (12, 24), (18, 24), (21, 24), (26, 27)] {
        let wave = SquareWave {
            half_period: 1 << exponent,
            samples: 1 << length,
        };
        assert_eq!(
            octaves(&wave.accumulate()),
            wave.octaves(),
            "half-period 2^{exponent}"
        );
    }
}

#[test]
fn the_largest_difference_there_is_fits_the_longest_octave() {
    let wave = SquareWave {
        half_period: 1 << 29,
        samples: 1 << 30,
    };
    let found = octaves(&wave.accumulate());
    assert_eq!(found, wave.octaves());
    assert_eq!(found[29].2, square((1 << 29) * ((1 << 32) - 1)));
}

/// A wave of the period that an octave sums most of, as often as there are samples to count: 192
/// bits hold it, and both ways of adding carry into the third limb.
#[test]
fn sums_beyond_128_bits_stay_exact() {
    const OCTAVE: usize = 20;
    let wave = SquareWave {
        half_period: 1 << OCTAVE,
        samples: 1 << 23,
    };
    let once = wave.octaves();
    let mut records = vec![wave.accumulate()];
    for i in 0..39 {
        let mut twice = records[i].clone();
        twice.merge(&records[i]);
        records.push(twice);
    }
    let limit = BigUint::from(1_u8) << 128_u32;

    // As close below 2^128 as whole records come, and over it by single differences.
    let mut times = &limit / &once[OCTAVE].2;
    let mut accumulator = Accumulator::<30>::new();
    for (i, record) in records.iter().enumerate() {
        if times.bit(i as u64) {
            accumulator.merge(record);
        }
    }
    let multiple =
        |times: &BigUint| -> Vec<BigUint> { once.iter().map(|octave| &octave.2 * times).collect() };
    let sums = |accumulator: &Accumulator<30>| -> Vec<BigUint> {
        octaves(accumulator)
            .into_iter()
            .map(|octave| octave.2)
            .collect()
    };
    assert_eq!(sums(&accumulator), multiple(&times));
    assert!(
        accumulator
            .octave(OCTAVE)
            .is_some_and(|octave| octave.sum.to_u128().is_some())
    );
    wave.push_to(&mut accumulator);
    times += 1_u8;
    assert_eq!(sums(&accumulator), multiple(&times));
    assert!(
        accumulator
            .octave(OCTAVE)
            .is_some_and(|octave| octave.sum.to_u128().is_none())
    );

    // 2^62 samples.
    let longest = &records[39];
    assert_eq!(longest.samples(), 1 << 62);
    assert_eq!(sums(longest), multiple(&(BigUint::from(1_u8) << 39_u32)));
    let sum = longest
        .octave(OCTAVE)
        .expect("an octave of the accumulator")
        .sum;
    assert!(big(sum.limbs()).bits() > 144);
    let expected = once[OCTAVE].2.to_string().parse::<f64>().expect("digits") * 2_f64.powi(39);
    assert!((sum.to_real() / expected - 1.0).abs() < 4.0 * f64::EPSILON);
}
