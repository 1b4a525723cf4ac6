//! Axes keep one record of samples and gaps for all their parts, whatever was left out, lost,
//! merged or restored.

mod histories;
mod stored;

use allanite::{
    Accumulator, Axes, Axis, Model, Real, Scale,
    axis::{CoursePart, Courses, GatePart, Gated, MomentPart, Moments, Spectral, SpectrumReading},
    course::Course,
    fit::{Options, fit},
    integrity::{Integrity, Reason},
    self_test::{Limit, Plan, SelfTest, Status},
    spectrum::{Spectrum, SpectrumAccumulator},
};
use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;
use rand_xoshiro::Xoshiro256PlusPlus;

const OCTAVES: usize = 12;
const RATE_HZ: Real = 100.0;
/// The size of a count, in °/s.
const UNIT: Real = 1e-3;
const SAMPLES: usize = 1 << 16;

fn scale() -> Scale {
    Scale::new(UNIT, RATE_HZ).unwrap()
}

type Counts = ([i32; 3], [i32; 1]);

/// Three levels of spectrum.
type Bins = Spectral<64, 3, 84>;

/// Three axes and a temperature with every part, and the gate and the course as chosen.
type Whole<G = Gated, T = ()> = Axes<OCTAVES, 1, G, Moments, 3, Bins, T>;

/// The counts of three axes at rest, whose noise is white, and of a temperature.
fn rest() -> Vec<Counts> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(3);
    let mut sample = |n: usize| {
        let counts =
            [(); 3].map(|()| (50.0 * random.sample::<f64, _>(StandardNormal)).round() as i32);
        (counts, [(n as i32 / 50) % 900])
    };
    (0..SAMPLES).map(&mut sample).collect()
}

/// The same counts with one spike in each axis, and with a motion about the second axis.
fn disturbed() -> Vec<Counts> {
    let mut samples = rest();
    samples[9000].0[0] = 32_767;
    samples[25_000].0[1] = -20_000;
    samples[33_000].0[2] = 5000;
    for (i, (counts, _)) in samples[40_000..40_500].iter_mut().enumerate() {
        counts[1] += (3000.0 * (i as f64 / 40.0).sin().abs()) as i32;
    }
    samples
}

/// An independent statement of what the gate keeps of a record: the indices of samples, and `None`
/// for gaps.
///
/// A sample that is odd in any axis becomes a gap. Motion and stuck values also remove the 128
/// samples before them, and motion removes the 64 samples after it.
struct Cleaning {
    seen: [Integrity; 3],
    /// The samples that have left the gate.
    kept: Vec<Option<usize>>,
    held: Vec<Option<usize>>,
    behind: usize,
}

impl Cleaning {
    fn new() -> Self {
        Self {
            seen: [(); 3].map(|()| Integrity::default()),
            kept: Vec::new(),
            held: Vec::new(),
            behind: 0,
        }
    }

    fn push(&mut self, at: usize, counts: [i32; 3]) {
        let seen = [0, 1, 2].map(|axis| self.seen[axis].push(counts[axis]));
        let moving = seen.iter().any(|axis| axis.moving);
        if moving || seen.iter().any(|axis| axis.stuck) {
            self.held.clear();
        }
        let is_odd = self.behind > 0 || seen.iter().any(|axis| axis.is_odd());
        self.behind = if moving {
            64
        } else {
            self.behind.saturating_sub(1)
        };
        let place = (!is_odd).then_some(at);
        if place.is_some() || self.held.last() != Some(&None) {
            self.held.push(place);
        }
        if self.held.len() > 128 {
            self.kept.push(self.held.remove(0));
        }
    }

    /// Samples were lost before the next one.
    fn gap(&mut self) {
        if self.held.last() != Some(&None) {
            self.held.push(None);
        }
        if self.held.len() > 128 {
            self.kept.push(self.held.remove(0));
        }
        self.seen.iter_mut().for_each(Integrity::gap);
    }

    /// Simulates a power failure: the samples that the gate holds back are lost.
    fn cut(&mut self) {
        self.held = vec![None];
        self.behind = 0;
        self.seen.iter_mut().for_each(Integrity::gap);
    }
}

fn plan() -> Plan {
    Plan {
        limits: [Limit {
            effect: "angle_random_walk",
            most: 0.00495,
        }]
        .into_iter()
        .collect(),
        least_p: 0.0,
        false_pass: 0.01,
        false_fail: 0.01,
        shortest_s: 10.0,
        longest_s: 300.0,
    }
}

/// Takes a look at the first axis if one is due.
fn look<G: GatePart, M: MomentPart, S: SpectrumReading, T: CoursePart>(
    axes: &Axes<OCTAVES, 1, G, M, 3, S, T>,
    test: &mut SelfTest<OCTAVES>,
    looks: &mut Vec<(u64, Status)>,
) {
    if test.is_due(axes.samples()) {
        let x = axes.record_so_far(0, (scale(), [0.01])).unwrap();
        looks.push((x.samples, test.look(&x).unwrap()));
    }
}

#[test]
fn spikes_a_motion_and_a_power_loss_give_the_same_result_as_the_cleaned_record() {
    type Gyro = Whole;
    let samples = disturbed();
    let new_test = || SelfTest::<OCTAVES>::new(plan(), scale()).unwrap();
    let (mut gyro, mut test, mut looks) = (Gyro::new(), new_test(), Vec::new());
    let mut cleaning = Cleaning::new();
    let mut buffer = vec![0; Gyro::snapshot_bytes(1)];
    for (n, &sample) in samples.iter().enumerate() {
        // The power fails some time after a snapshot, and the product starts again.
        if n == 20_000 {
            let length = gyro
                .snapshot(std::slice::from_ref(&test), &mut buffer)
                .unwrap()
                .len();
            buffer.truncate(length);
            (gyro, test) = (Gyro::new(), new_test());
            gyro.restore(std::slice::from_mut(&mut test), &buffer)
                .unwrap();
            cleaning.cut();
        }
        if (20_000..21_000).contains(&n) {
            continue;
        }
        gyro.push(sample);
        cleaning.push(n, sample.0);
        look(&gyro, &mut test, &mut looks);
    }
    gyro.release();
    look(&gyro, &mut test, &mut looks);

    // The reference is the cleaned record without a gate, with a self-test that was never
    // interrupted.
    let mut places = cleaning.kept;
    places.extend(cleaning.held);
    let mut clean = Whole::<()>::new();
    let (mut clean_test, mut clean_looks) = (new_test(), Vec::new());
    // The number of missing samples is known, but where the power failed it does not matter.
    let mut next = 0;
    let mut places = places.into_iter().peekable();
    while let Some(place) = places.next() {
        match place {
            Some(at) => {
                clean.push(samples[at]);
                next = at + 1;
            }
            None => match places.peek() {
                Some(Some(at)) if !(19_000..21_001).contains(at) => clean.miss((at - next) as u64),
                _ => clean.gap(),
            },
        }
        look(&clean, &mut clean_test, &mut clean_looks);
    }

    assert_eq!(gyro.accumulators(), clean.accumulators());
    assert_eq!(gyro.integrity(), clean.integrity());
    for axis in 0..3 {
        let [one, other] = [
            gyro.record_so_far(axis, (scale(), [0.01])),
            clean.record_so_far(axis, (scale(), [0.01])),
        ];
        let one = one.unwrap();
        assert_eq!((one.invalid, one.kurtosis.is_some()), (None, true));
        assert_eq!(one.covariates.len(), 1);
        assert_eq!(one.spectrum.bins().len(), 84);
        assert_eq!(one, other.unwrap());
    }
    assert!(looks.len() >= 5, "{looks:?}");
    assert_eq!(looks, clean_looks);
    // The envelope's head, the parts and the size of the spectrum take 8 + 5 + 2 bytes before the kept record. The losses, one byte,
    // and the checksum of four bytes follow it.
    let (mut buffer, mut clean_buffer) = ([0; 16_384], [0; 16_384]);
    let stored = gyro.snapshot(&[], &mut buffer).unwrap();
    let of_clean = clean.snapshot(&[], &mut clean_buffer).unwrap();
    let kept = 15..of_clean.len() - 4 - 1;
    assert!(kept.len() > 500);
    assert_eq!(stored[kept.clone()], of_clean[kept]);
    // The gate leaves out three spikes, the motion, and the clusters of 1024 samples in which the
    // motion ends. The spikes take no cluster with them.
    assert!(
        (600..4000).contains(&gyro.left_out()),
        "{}",
        gyro.left_out()
    );
    let seen = gyro.seen().map(|seen| seen.tally());
    assert_eq!(seen.map(|tally| tally.spikes), [1, 1, 1]);
    assert!(seen[1].motions > 0);
}

#[test]
fn motions_and_shocks_now_and_then_do_not_change_the_measured_noise() {
    let mut counts: Vec<i32> = rest().iter().map(|(counts, _)| counts[0]).collect();
    for at in [9000, 30_000, 50_000] {
        for (i, count) in counts[at..at + 500].iter_mut().enumerate() {
            *count += (3000.0 * (i as f64 / 40.0).sin().abs()) as i32;
        }
    }
    counts[20_000] = 32_767;
    counts[25_000] = -20_000;
    let (mut gated, mut plain) = (Axis::<16>::new(), Axis::<16, 0, (), ()>::new());
    for &count in &counts {
        gated.push(count);
        plain.push(count);
    }
    gated.release();
    assert!(plain.verdict(0).is_some(), "without a gate it is invalid");
    assert_eq!(gated.verdict(0), None);
    let left_out = gated.left_out();
    // Two spikes, and at each motion at most three clusters of 1024 samples.
    assert!((1502..=9218).contains(&left_out), "{left_out}");
    assert_eq!(gated.samples() + left_out, SAMPLES as u64);
    let record = gated.record_so_far(0, scale()).unwrap();
    let fit = fit(&record.curve, &Model::ieee_952(), Options::default()).unwrap();
    assert!(fit.p_value > 1e-3, "{}", fit.p_value);
    let value = fit.coefficients[1].value;
    assert!((value / 0.005 - 1.0).abs() < 0.03, "{value}");
}

#[test]
fn a_record_of_which_too_much_is_left_out_is_invalid() {
    let mut gyro = Axis::<OCTAVES>::new();
    for (n, (counts, _)) in rest().iter().take(20_000).enumerate() {
        let hangs = (5000..12_000).contains(&n);
        gyro.push(if hangs { 5 } else { counts[0] });
    }
    gyro.release();
    let Some(Reason::LeftOut { left_out, samples }) = gyro.verdict(0) else {
        panic!("{:?}", gyro.verdict(0));
    };
    assert_eq!((left_out, samples), (gyro.left_out(), 20_000));
    assert!((6900..7100).contains(&left_out), "{left_out}");
}

#[test]
fn stuck_values_are_left_out_from_the_first_one_on() {
    let mut samples = rest();
    let value = samples[20_000].0[0];
    for (counts, _) in &mut samples[20_000..20_500] {
        counts[0] = value;
    }
    let mut gyro = Axes::<OCTAVES, 1>::new();
    samples.iter().for_each(|&sample| gyro.push(sample));
    gyro.release();
    assert!((490..520).contains(&gyro.left_out()), "{}", gyro.left_out());
    let longest = gyro.integrity().map(|axis| axis.tally().longest_run);
    assert!(longest[0] < 20, "{longest:?}");
    assert_eq!(gyro.verdict(0), None);
}

#[test]
fn motion_about_one_axis_makes_all_of_them_invalid() {
    let mut axes = Axes::<OCTAVES, 1, (), ()>::new();
    let (still, moved) = (rest(), disturbed());
    for (n, sample) in still.into_iter().enumerate() {
        let turned = (39_000..42_000).contains(&n);
        axes.push(if turned { moved[n] } else { sample });
    }
    for axis in 0..3 {
        let verdict = axes.verdict(axis);
        assert!(matches!(verdict, Some(Reason::Moved { .. })), "{verdict:?}");
    }
}

#[test]
fn three_axes_at_rest_are_three_single_axes() {
    let mut axes = Axes::<OCTAVES, 1>::new();
    let mut single = [(); 3].map(|()| Axis::<OCTAVES, 1>::new());
    for (n, &(counts, covariates)) in rest().iter().enumerate() {
        if n % 20_000 == 19_999 {
            axes.lost(3);
            single.iter_mut().for_each(|axis| axis.lost(3));
        }
        axes.push((counts, covariates));
        for (axis, count) in single.iter_mut().zip(counts) {
            axis.push((count, covariates));
        }
    }
    axes.release();
    assert_eq!((axes.left_out(), axes.losses()), (0, 3));
    for (i, axis) in single.iter_mut().enumerate() {
        axis.release();
        assert_eq!(
            axes.record_so_far(i, (scale(), [0.01])),
            axis.record_so_far(0, (scale(), [0.01]))
        );
    }
}

/// The spectrum of an axis beside that of its samples and of the values that fill its gaps.
#[test]
fn a_spectrum_goes_on_across_a_few_lost_samples() {
    let mut axis = Axis::<OCTAVES, 0, (), (), Bins>::new();
    let mut beside = Accumulator::<OCTAVES>::new();
    let [mut sums, mut gapped] = [(); 2].map(|()| SpectrumAccumulator::<64, 3>::new());
    let mut lost = 0;
    for (n, (counts, _)) in rest().into_iter().enumerate() {
        if lost > 0 {
            lost -= 1;
            continue;
        }
        // One in a hundred samples singly, and five more gaps of 20 and of 70, which are too many to be filled.
        lost = match n {
            _ if n % 10_000 == 9999 => 20,
            _ if n % 10_000 == 5000 => 70,
            _ if n % 100 == 50 => 1,
            _ => 0,
        };
        if lost > 0 {
            axis.lost(lost);
            match beside.filling(lost) {
                Some(filling) => filling.for_each(|count| sums.push_slice(&[count])),
                None => sums.gap(),
            }
            beside.lost(lost);
            gapped.gap();
            lost -= 1;
            continue;
        }
        let count = counts[0];
        axis.push(count);
        beside.push(count);
        sums.push_slice(&[count]);
        gapped.push_slice(&[count]);
    }
    let found = axis.record(0, scale()).unwrap().spectrum;
    let filled: Spectrum<84> = sums.spectrum(scale());
    assert_eq!(
        found,
        filled
            .clone()
            .without_bridges(beside.bridged(), beside.samples())
    );
    assert_ne!(found, filled);
    // With a gap at each loss, a level would have no segment whose blocks are of more than one sample.
    let gapped: Spectrum<84> = gapped.spectrum(scale());
    assert_eq!((gapped.all().len(), found.all().len()), (28, 84));
}

#[test]
fn samples_that_are_left_out_or_missing_count_as_time_of_the_course() {
    let samples = disturbed();
    let mut gyro = Whole::<Gated, Courses>::new();
    let mut cleaning = Cleaning::new();
    for (n, &sample) in samples.iter().enumerate() {
        // A hundred samples are lost on the way, and their number is known.
        if (50_000..50_100).contains(&n) {
            continue;
        }
        if n == 50_100 {
            gyro.lost(100);
            cleaning.gap();
        }
        gyro.push(sample);
        cleaning.push(n, sample.0);
    }
    gyro.release();
    let mut places = cleaning.kept;
    places.extend(cleaning.held);
    for axis in 0..3 {
        let mut expected = Course::<1>::new();
        let mut next = 0;
        for at in places.iter().copied().flatten() {
            expected.lost((at - next) as u64);
            let (counts, covariates) = samples[at];
            expected.push(counts[axis], covariates);
            next = at + 1;
        }
        assert_eq!(expected.time(), SAMPLES as u64);
        assert_eq!(gyro.courses()[axis], Some(&expected));
    }
    assert!(gyro.left_out() > 600, "{}", gyro.left_out());
}
