//! One axis, or several axes that are recorded together: one `push` feeds everything that is kept of a
//! record.

pub(crate) mod courses;
pub(crate) mod gate;
pub(crate) mod kept;
pub(crate) mod moments;
mod sample;
pub(crate) mod spectra;

pub use courses::{CoursePart, Courses};
pub use gate::{GatePart, Gated};
pub use moments::{MomentPart, Moments};
pub use sample::Sample;
pub use spectra::SpectrumPart;

use crate::{
    list::numbered,
    record::course::Course,
    record::{
        integrity::{Integrity, InvalidLimit, Limits},
        octave::Accumulator,
    },
};
use courses::CourseSums as _;
use gate::{Missing, Passed, Passing};
use kept::AxesSums;

/// One axis: [`Axes`] for a gyro of which a single axis is recorded.
pub type Axis<
    const OCTAVES: usize,
    const COVARIATES: usize = 0,
    G = Gated,
    M = Moments,
    S = (),
    T = (),
> = Axes<OCTAVES, COVARIATES, G, M, 1, S, T>;

/// Everything that is kept of a record, for three axes or for as many as `AXES` says.
///
/// Every sample takes this path, in integers only:
///
/// ```text
/// counts + covariates ─► gate ─► integrity, accumulator, fourth moments, products with covariates, spectrum
/// ```
///
/// The gate sees every sample. It passes on those of a gyro at rest, and treats the others as lost.
/// The parts behind the gate all see the same record of samples and gaps. So the curve, the evidence
/// for a diagnosis, the snapshot and the verdict on the record's integrity all describe the record that
/// is kept, and none of the samples that were left out.
///
/// # Parts
///
/// | parameter | stands for | default |
/// |---|---|---|
/// | `OCTAVES` | octaves of averaging time, 2 to 30 | – |
/// | `COVARIATES` | covariates sampled with every count, such as a temperature or a supply voltage | 0 |
/// | `G` | [`Gated`], or `()` to keep every sample | [`Gated`] |
/// | `M` | [`Moments`], or `()`: then telegraph and Gauss–Markov noise cannot be distinguished | [`Moments`] |
/// | `AXES` | axes that share the gate's decision and the covariates; see [`Axis`] for one | 3 |
/// | `S` | [`Spectral`](crate::spectrum::Spectral), or `()`: then the diagnosis sees octaves alone | `()` |
/// | `T` | [`Courses`], or `()`: then it is not known when something happened | `()` |
///
/// A part that is left out takes no memory, no flash and no time. If only the curve is needed, an
/// [`Accumulator`] is enough.
///
/// # Cost
///
/// With the parts that are the default, 20 octaves and one covariate, three axes take 5.7 KiB per axis on a 32-bit
/// core. A spectrum takes 3.9 KiB more per axis, and a course 2.6 KiB. An empty state is all zero, so that a
/// `static` is placed in `.bss`. `cargo xtask bench` measures the memory and the instructions per sample.
///
/// # Example
///
/// ```
/// use allanite::{Axes, Model, Scale, diagnosis::{Diagnosis, Options}, effect::CATALOGUE};
/// use allanite::axis::{Gated, Moments, Spectral};
/// use core::ops::ControlFlow;
///
/// // Three axes of 12 octaves, with a temperature as the covariate, and with a spectrum of three levels.
/// type Gyro = Axes<12, 1, Gated, Moments, 3, Spectral<64, 3, 84>>;
/// static EMPTY: Gyro = Gyro::new();
/// let mut axes = EMPTY.clone();
/// let mut random = 1_u32;
/// let mut noise = || {
///     random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
///     (random >> 27) as i32
/// };
/// for n in 0..10_000_i32 {
///     let spike = if n == 5000 { 20_000 } else { 0 };
///     axes.push(([noise() + spike, noise(), noise()], [n / 100]));
/// }
///
/// // The gyro gives 131 counts per °/s at 100 Hz; the thermometer gives 100 counts per kelvin.
/// let x = axes.record(0, (Scale::new(1.0 / 131.0, 100.0)?, [0.01]))?;
/// assert_eq!((axes.left_out(), axes.samples()), (1, 9999));
/// assert_eq!(x.invalid, None);
/// let (model, options) = (Model::ieee_952(), Options::default());
/// let mut diagnosis = Diagnosis::new(&x, &model, &CATALOGUE, options);
/// let mut pause = || ControlFlow::Continue(()); // feed the watchdog, take the next samples
/// diagnosis.run(|step| println!("{}", step.comparison), &mut pause)?;
/// assert_eq!(x.spectrum.bins().len(), 2 * 28); // a third level needs 35 000 samples
/// # Ok::<(), allanite::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Axes<
    const OCTAVES: usize,
    const COVARIATES: usize = 0,
    G: GatePart = Gated,
    M: MomentPart = Moments,
    const AXES: usize = 3,
    S: SpectrumPart = (),
    T: CoursePart = (),
> {
    pub(crate) gate: G::State<AXES, COVARIATES>,
    pub(crate) kept: AxesSums<OCTAVES, COVARIATES, M, AXES, S, T>,
    pub(crate) losses: u64,
}

impl<const OCTAVES: usize, const COVARIATES: usize, G, M, const AXES: usize, S, T>
    Axes<OCTAVES, COVARIATES, G, M, AXES, S, T>
where
    G: GatePart,
    M: MomentPart,
    S: SpectrumPart,
    T: CoursePart,
{
    /// An empty record that is judged by the [default limits](Limits::DEFAULT).
    pub const fn new() -> Self {
        Self {
            gate: <G::State<AXES, COVARIATES> as Passing<AXES, COVARIATES>>::NEW,
            kept: AxesSums::NEW,
            losses: 0,
        }
    }

    /// An empty record that is judged by these limits.
    ///
    /// # Errors
    /// [`InvalidLimit`] if a limit is outside the range that its field documents.
    pub fn with_limits(limits: &'static Limits) -> Result<Self, InvalidLimit> {
        let mut axes = Self::new();
        axes.gate.set_limits(limits)?;
        axes.kept.set_limits(limits)?;
        Ok(axes)
    }

    /// Adds one sample: one count of every axis and of every covariate.
    #[inline]
    pub fn push(&mut self, sample: impl Into<Sample<AXES, COVARIATES>>) {
        match self.gate.push(sample.into()) {
            Passed::Nothing => {}
            Passed::Sample(sample) => self.kept.push(&sample),
            Passed::Gap(missing) => self.kept.miss(missing),
        }
    }

    /// Does a part of the pending work of the spectra, and returns whether there is more. A call transforms
    /// at most one segment of one axis.
    ///
    /// Calling it is optional. If a main loop calls it while it has nothing else to do, [`push`](Self::push)
    /// finds less to do. Otherwise `push` itself transforms a segment, at most one for a sample unless more
    /// than four axes are recorded.
    pub fn advance(&mut self) -> bool {
        self.kept.advance()
    }

    /// Marks a place where samples were lost or the gyro was disturbed. No difference spans this place.
    pub fn gap(&mut self) {
        self.miss(0);
    }

    /// Marks a place where so many samples are missing, or an unknown number if it is 0, as [`lost`](Self::lost) does. They
    /// do not count as [missing](crate::integrity::Tally::missing).
    pub fn miss(&mut self, samples: u64) {
        self.losses = self.losses.saturating_add(1);
        let passed = self.gate.gap(Missing::new(samples));
        self.keep(passed);
    }

    /// Counts samples that were lost at this place. Does nothing for 0 samples.
    ///
    /// A few samples are filled with the mean of those before, as [`Accumulator::lost`] says, and the results take off
    /// what this adds or takes away. So are samples that the gate leaves out. More samples are a [`gap`](Self::gap).
    pub fn lost(&mut self, samples: u64) {
        if samples > 0 {
            self.kept.add_missing(samples);
            self.miss(samples);
        }
    }

    /// Keeps the samples that the gate still holds back, up to 128, as if they were known to be at
    /// rest, and does all the work that waits. [`record`](Self::record) does so at the end of a record. It is not a gap.
    pub fn release(&mut self) {
        loop {
            let passed = self.gate.release();
            if passed == Passed::Nothing {
                break;
            }
            self.keep(passed);
        }
        while self.advance() {}
    }

    fn keep(&mut self, passed: Passed<AXES, COVARIATES>) {
        match passed {
            Passed::Nothing => {}
            Passed::Sample(sample) => self.kept.push_any(&sample, true),
            Passed::Gap(missing) => self.kept.miss(missing),
        }
    }

    /// Whether another record can be one of the same sensor, read with the same scale and filter: the noise of single samples
    /// of each axis is [like](crate::octave::OctaveSum::is_like) that of this one.
    pub fn is_like(&self, other: &Self) -> bool {
        let mut axes = self.kept.axes.iter().zip(&other.kept.axes);
        axes.all(|(ours, theirs)| ours.accumulator.is_like(&theirs.accumulator))
    }

    /// Adds another record of the same sensor, as if a gap lay between the two. [`is_like`](Self::is_like)
    /// checks whether it can be one. Both gates first
    /// release the samples that they hold back. The courses stay those of this record, because another record has
    /// no place in its time.
    pub fn merge(&mut self, other: &Self) {
        let mut other = other.clone();
        self.release();
        other.release();
        self.kept.merge(&other.kept);
        self.gate.merge(&other.gate);
        self.losses = self.losses.saturating_add(other.losses);
    }

    /// Forgets everything but the limits.
    pub fn reset(&mut self) {
        let limits = self.limits();
        *self = Self::new();
        // The limits were checked when they were set.
        let _ = self.gate.set_limits(limits);
        let _ = self.kept.set_limits(limits);
    }

    /// The limits by which the record is judged.
    pub fn limits(&self) -> &'static Limits {
        match self.kept.axes.first() {
            Some(axis) => axis.integrity.limits(),
            None => &Limits::DEFAULT,
        }
    }

    /// The number of samples that are kept, without those that the gate still holds back.
    pub fn samples(&self) -> u64 {
        self.kept
            .axes
            .first()
            .map_or(0, |axis| axis.accumulator.samples())
    }

    /// The number of samples that the gate left out; 0 without a gate.
    pub fn left_out(&self) -> u64 {
        self.gate.gate().map_or(0, gate::Gate::left_out)
    }

    /// How often samples were lost: the number of calls of [`gap`](Self::gap) and
    /// [`lost`](Self::lost). [`Accumulator::gaps`] is smaller where several calls follow each
    /// other without a sample in between, and larger where a gate leaves samples out.
    pub const fn losses(&self) -> u64 {
        self.losses
    }

    /// The accumulator of every axis.
    pub fn accumulators(&self) -> [&Accumulator<OCTAVES>; AXES] {
        self.kept.axes.each_ref().map(|axis| &axis.accumulator)
    }

    /// The integrity of the record that is kept, for every axis.
    pub fn integrity(&self) -> [&Integrity; AXES] {
        self.kept.axes.each_ref().map(|axis| &axis.integrity)
    }

    /// The course of every axis, if it is kept. Samples that were left out or are known to be missing count as time.
    pub fn courses(&self) -> [Option<&Course<COVARIATES>>; AXES] {
        self.kept.axes.each_ref().map(|axis| axis.course.course())
    }

    /// The integrity of all samples, for every axis: the gate counts the spikes and motions of the
    /// samples that it leaves out as well. Without a gate, this is the integrity of the record.
    pub fn seen(&self) -> [&Integrity; AXES] {
        match self.gate.gate() {
            Some(gate) => gate.integrity().each_ref(),
            None => self.integrity(),
        }
    }
}

impl<const OCTAVES: usize, M, const AXES: usize, T> Axes<OCTAVES, 0, (), M, AXES, (), T>
where
    M: MomentPart,
    T: CoursePart,
{
    /// Adds counts of every axis, as many as the shortest slice has. The state afterwards is the same as if they were pushed one
    /// by one, but it is reached sooner.
    pub fn push_slices(&mut self, counts: [&[i32]; AXES]) {
        self.push_slices_as(counts, |integrity, _, counts| integrity.push_slice(counts));
    }

    /// As [`push_slices`](Self::push_slices). `look` is shown the integrity of each axis after every 64 of its samples here, by
    /// which it finds about when something began.
    pub fn push_slices_looking(
        &mut self,
        counts: [&[i32]; AXES],
        mut look: impl FnMut(usize, &Integrity),
    ) {
        self.push_slices_as(counts, |integrity, axis, counts| {
            let (blocks, rest) = counts.as_chunks::<64>();
            for block in blocks {
                integrity.push_slice(block);
                look(axis, integrity);
            }
            integrity.push_slice(rest);
        });
    }

    /// Adds counts of every axis; `watch` adds them to the integrity.
    #[inline(always)]
    fn push_slices_as(
        &mut self,
        counts: [&[i32]; AXES],
        mut watch: impl FnMut(&mut Integrity, usize, &[i32]),
    ) {
        let length = counts.iter().map(|counts| counts.len()).min().unwrap_or(0);
        let counts = counts.map(|counts| counts.get(..length).unwrap_or(counts));
        for place in 0..length {
            let sample = counts.map(|counts| counts.get(place).copied().unwrap_or(0));
            self.kept.reads.push(sample);
        }
        for (number, (axis, counts)) in numbered(self.kept.axes.iter_mut().zip(counts)) {
            watch(&mut axis.integrity, number, counts);
            axis.course.push_counts(counts);
            axis.push_slice(counts);
        }
    }
}

impl<const OCTAVES: usize, const COVARIATES: usize, G, M, const AXES: usize, S, T> Default
    for Axes<OCTAVES, COVARIATES, G, M, AXES, S, T>
where
    G: GatePart,
    M: MomentPart,
    S: SpectrumPart,
    T: CoursePart,
{
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slices_of_any_length_make_the_same_record() {
        let mut random = 1_u32;
        let columns = [(); 3].map(|()| {
            let mut noise = || {
                random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                (random >> 26) as i32
            };
            core::array::from_fn::<i32, 3000, _>(|_| noise())
        });
        let mut singly = Axes::<12, 0, (), (), 3, (), Courses>::new();
        for place in 0..3000 {
            singly.push(columns.map(|column| column[place]));
        }
        for length in [1, 7, 64, 3000] {
            let mut sliced = Axes::new();
            for from in (0..3000).step_by(length) {
                let until = 3000.min(from + length);
                // What one axis has more than another is not taken.
                let [x, y, z] = columns.each_ref().map(|column| &column[from..until]);
                let longer = &columns[1][from..3000.min(until + 5)];
                sliced.push_slices([x, if length == 7 { longer } else { y }, z]);
            }
            assert_eq!(sliced, singly, "{length}");
        }
    }

    /// Counts of 8 bits take the narrow path, those of 30 bits the wide one, and larger ones none.
    #[test]
    fn fourth_moments_of_slices_are_those_of_samples() {
        let mut random = 1_u32;
        for bits in [8, 20, 30, 32] {
            let counts: [i32; 5000] = core::array::from_fn(|_| {
                random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                (random as i32) >> (32 - bits)
            });
            let mut singly = Axis::<14, 0, (), Moments>::new();
            let mut sliced = Axis::<14, 0, (), Moments>::new();
            let mut looks = 0;
            for (number, some) in counts.chunks(700).enumerate() {
                some.iter().for_each(|&count| singly.push(count));
                match number % 2 {
                    0 => sliced.push_slices([some]),
                    _ => sliced.push_slices_looking([some], |_, _| looks += 1),
                }
                if number == 2 {
                    singly.miss(3);
                    sliced.miss(3);
                }
            }
            assert_eq!(sliced, singly, "{bits}");
            assert_eq!(looks, 3 * (700 / 64) + 100 / 64);
        }
    }
}
