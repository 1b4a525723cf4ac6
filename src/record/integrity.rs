//! Whether a record is that of a gyro at rest, or has stuck values, rail hits, spikes, motion or
//! missing samples.

mod cluster;
mod differences;
mod limits;
mod observation;
mod rails;
mod reason;
mod runs;
mod slice;
mod state;
mod watch;

pub use limits::{InvalidLimit, Limits};
pub use observation::Observation;
pub use reason::Reason;

pub use super::screen::Screen;

use state::{CLUSTERS, State};

/// Watches the counts of an [`Accumulator`](crate::Accumulator), in fixed memory and integers only,
/// and decides whether the Allan curve is valid.
///
/// An Allan variance assumes a gyro at rest whose noise stays the same. It averages whatever it is
/// given: one corrupt word on the bus raises every octave as white noise would, a hand on the bench
/// looks like a random walk, and a sensor that hangs looks quiet. None of this can be seen in the curve
/// any more, so it is counted before it is averaged.
///
/// # The statistics
///
/// *Repeats.* A quiet gyro behind a coarse converter repeats values, so no fixed length of a run is
/// suspicious. The record itself gives its mean run, which is the number of samples over the number of
/// changes. Runs of independent noise have a geometric distribution: a run longer than `r` times the
/// mean has a probability below `e^−r`. At 41, about one is expected in 10⁹ records of 10⁹ samples. The
/// default of 128 leaves room for a level that drifts between the middle of a quantum, where runs are
/// long, and its edge, where they are short. It holds for a noise of 0.2 counts rms or more. Below
/// that, the curve is called `Stuck`. It is also called `Stuck` where fewer than one sample in a
/// thousand changes at all. If at least half of the runs have just two samples, or three, or four,
/// each sample was read as many times, and the curve is called `Repeated`.
///
/// *Rounding.* Rounding to whole counts adds a white noise of 1/12 count² to a noise of half a count
/// rms or more, which raises angle random walk by 15 % there and by 4 % at one count. Below half a
/// count, what it adds follows from where between two counts the mean lies, and the curve is called
/// `Coarse`. The noise is taken from the mean square of the differences of neighbours, without spikes
/// and steps.
///
/// *Misread counts.* Values about zero that are read without their sign jump between the ends of a range of 16, 18, 19, 20
/// or 24 bits, and values whose bytes are swapped lie anywhere in it. No gyro at rest does. So the extremes are near both ends
/// of such a range, and the mean square of the differences of neighbours is a large part of its square.
///
/// *Rails.* A converter that clips returns its extreme value. A sample counts as a hit if it equals a
/// rail and is the extreme of the record too: a value beyond proves that the sensor does not have this
/// rail.
///
/// *Spikes.* A spike lies further from the last ordinary sample than 20 times the mean absolute
/// difference of neighbours, and is over within three samples. The scale follows the record over some
/// 256 samples. Each difference enters it with at most twice the usual size, so that a spike of any
/// size raises the scale by 1 %. For white noise, the limit lies at 16 standard deviations of a
/// difference, which no number of samples reaches. A spike adds the same share to every octave that
/// white noise dominates. Where the squares of the spikes make up 5 % of ΣD² at `m = 1`, angle random
/// walk comes out 2.5 % too high, and the record is invalid. In 2^16 samples, one spike of 42 standard
/// deviations is enough for that. Rarer or smaller spikes are counted and tolerated.
///
/// *Motion.* The same statistic is applied to the means of 64 and of 1024 samples, without spikes. A
/// cluster is in motion if it lies further from the last ordinary one than 64 times the usual
/// difference of neighbours. For clusters of 1024 samples, the usual difference is at least that of
/// clusters of 64. Motion lasts until a cluster is back, or for 64 clusters. Jumps beyond the limit of
/// spikes that do not come back count as motion too, of clusters of one sample. The scale is that of
/// the record's own clusters, so that it includes whatever goes on all the time: flicker noise, random
/// walk, ramps, a sinusoid, noise with memory. What remains is what happens a few times and is much
/// larger than the rest. For a consumer gyro of 0.005 °/√s at 100 Hz, the limit lies at 0.5 °/s, for a
/// tactical one at 0.2 °/s. No hand is that steady. Telegraph noise whose jumps exceed the limit and
/// are rare is taken for motion; its rms would have to be three to five times that of the white noise
/// of a sample. Motion makes the record invalid from 5 % of the clusters' ΣD² on.
///
/// *Missing samples.* At most one in ten samples may be lost, as reported by
/// [`lost`](Self::lost).
///
/// Two kinds of motion are not seen. One is motion that sets in as gradually as the scale follows, by
/// about a factor of two in a hundred clusters. The other is a shake of zero mean that lasts while the
/// scale is learnt.
///
/// Nothing is judged while a scale is learnt, from 64 differences of samples and 16 of clusters. After
/// that, the largest difference so far is judged.
///
/// # Cost
///
/// The watch uses integers only, and no division. A sample takes a handful of comparisons, additions
/// and multiplications; every 64th sample takes those of a cluster as well. The state takes at most 480
/// bytes.
///
/// # Example
///
/// ```
/// use allanite::{integrity::{Integrity, Reason}};
///
/// let mut integrity = Integrity::default();
/// for n in 0..10_000_i32 {
///     let noise = (n.wrapping_mul(1_103_515_245) >> 16) % 50;
///     integrity.push(if n == 5000 { 30_000 } else { noise });
/// }
/// assert_eq!(integrity.tally().spikes, 1);
/// assert!(matches!(integrity.verdict(), Some(Reason::Spiked { .. })));
/// ```
///
/// The limits are configuration. They lie apart from the state, in flash. An empty state is all zero,
/// so that a `static` that holds one takes no flash for its initial value.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Integrity {
    /// `None` stands for the default limits.
    limits: Option<&'static Limits>,
    state: State,
}

/// What was counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Tally {
    /// Samples seen.
    pub samples: u64,
    /// Samples lost.
    pub missing: u64,
    /// Samples that equal the sample before.
    pub repeats: u64,
    /// Samples in the longest run of equal values.
    pub longest_run: u32,
    /// Runs that were implausibly long, judged by what was known when they happened.
    pub stuck_runs: u64,
    /// Samples in these runs.
    pub stuck_samples: u64,
    /// Samples at a rail.
    pub rail_hits: u64,
    /// Excursions of one to three samples far beyond the noise.
    pub spikes: u64,
    /// Jumps of the size of a spike that did not come back.
    pub steps: u64,
    /// Stretches in which clusters lay far from those before.
    pub motions: u64,
}

impl Integrity {
    /// A watch with the default limits.
    pub const fn new() -> Self {
        Self {
            limits: None,
            state: State::NEW,
        }
    }

    /// A watch with these limits.
    ///
    /// # Errors
    /// [`InvalidLimit`] if a limit is outside the range that its field documents.
    pub const fn with_limits(limits: &'static Limits) -> Result<Self, InvalidLimit> {
        match limits.check() {
            Ok(()) => Ok(Self {
                limits: Some(limits),
                state: State::NEW,
            }),
            Err(error) => Err(error),
        }
    }

    /// The limits by which the record is judged.
    pub const fn limits(&self) -> &'static Limits {
        match self.limits {
            Some(limits) => limits,
            None => &Limits::DEFAULT,
        }
    }

    /// Adds one count and says what is odd about it.
    #[inline]
    pub fn push(&mut self, count: i32) -> Observation {
        let (limits, state) = (self.limits(), &mut self.state);
        if state.push_usual(count, limits) {
            return Observation {
                moving: state.moving,
                ..Observation::USUAL
            };
        }
        state.push(count, limits)
    }

    /// Adds counts. The state afterwards is the same as if they were pushed one by one, but it is reached sooner.
    pub fn push_slice(&mut self, counts: &[i32]) {
        self.state.push_slice(counts, self.limits());
    }

    /// Counts samples that were lost at this place, and marks a [`gap`](Self::gap). Does nothing for 0
    /// samples.
    pub fn lost(&mut self, samples: u64) {
        if samples > 0 {
            self.add_missing(samples);
            self.gap();
        }
    }

    /// Counts samples that were lost, at a place that a [`gap`](Self::gap) marks separately.
    pub(crate) fn add_missing(&mut self, samples: u64) {
        self.state.missing = self.state.missing.saturating_add(samples);
    }

    /// Marks a place where the next sample does not adjoin the one before. No run, difference or
    /// cluster spans this place. What was counted and learnt stays.
    pub fn gap(&mut self) {
        self.state.gap();
    }

    /// Adds another record of the same sensor, as if a gap lay between the two. The limits of this one
    /// judge the whole.
    pub fn merge(&mut self, other: &Self) {
        self.state.merge(&other.state);
    }

    /// Forgets everything but the limits.
    pub fn reset(&mut self) {
        self.state = State::NEW;
    }

    /// What has been counted so far.
    pub fn tally(&self) -> Tally {
        let state = &self.state;
        let motions = state.clusters.iter().map(|c| c.motions).max();
        Tally {
            samples: state.samples(),
            missing: state.missing,
            repeats: state.repeats,
            longest_run: state.runs.longest,
            stuck_runs: state.runs.stuck,
            stuck_samples: state.runs.stuck_samples,
            rail_hits: state.rails.hits(),
            spikes: state.spikes,
            steps: state.steps,
            motions: motions.unwrap_or(0),
        }
    }

    /// Why the Allan curve of this record is not valid; `None` where it is valid. If there are several
    /// reasons, it is the one that may have caused the others, in this order: misread counts, rails, repeated samples,
    /// stuck values, noise below half a count, motion, spikes, missing samples.
    pub fn verdict(&self) -> Option<Reason> {
        let (limits, state) = (self.limits(), &self.state);
        let samples = state.samples();
        if let Some(bits) = self.misread() {
            return Some(Reason::Misread { bits });
        }
        let hits = state.rails.hits();
        if exceeds(hits.into(), samples.into(), limits.rail_per_mille) {
            return Some(Reason::Railed { hits, samples });
        }
        let found = self.repeated().or_else(|| self.stuck());
        if let Some(reason) = found.or_else(|| self.coarse()) {
            return Some(reason);
        }
        let steps = (1, state.steps, state.step_squares, &state.neighbours);
        let clusters = state.clusters.iter().zip(CLUSTERS);
        let clusters = clusters.map(|(c, length)| (length, c.motions, c.squares, &c.watch));
        for (cluster, motions, squares, watch) in clusters.chain([steps]) {
            if exceeds(squares, watch.total(), limits.motion_per_mille) {
                return Some(Reason::Moved {
                    motions,
                    cluster,
                    percent: percent(squares, watch.total()),
                });
            }
        }
        let total = state.neighbours.total();
        if exceeds(state.spike_squares, total, limits.spike_per_mille) {
            return Some(Reason::Spiked {
                spikes: state.spikes,
                percent: percent(state.spike_squares, total),
            });
        }
        let (missing, sent) = (state.missing, samples.saturating_add(state.missing));
        exceeds(missing.into(), sent.into(), limits.missing_per_mille)
            .then_some(Reason::Missing { missing, sent })
    }

    /// Judges whether the counts jump between the ends of their range. A value about zero that is read without its sign
    /// does in up to half of the samples; one whose bytes are swapped lies anywhere.
    fn misread(&self) -> Option<u8> {
        let state = &self.state;
        let pairs = state.repeats.saturating_add(state.changes);
        let (bits, unsigned) = state.rails.range()?;
        let least = if unsigned { MISREAD.0 } else { MISREAD.1 };
        let span = u128::from(state.rails.span());
        let squares = (span * span).saturating_mul(pairs.into());
        let jumps = exceeds(state.neighbours.total(), squares, least);
        (pairs >= JUDGED && jumps).then_some(bits)
    }

    /// Judges whether most samples are there equally often.
    fn repeated(&self) -> Option<Reason> {
        let state = &self.state;
        let runs = state.firsts.saturating_add(state.changes);
        state.runs.times(runs).map(|times| Reason::Repeated {
            times,
            changes: state.changes,
            samples: state.samples(),
        })
    }

    /// Judges whether the differences of neighbours are those of noise rather than of rounding.
    fn coarse(&self) -> Option<Reason> {
        let (state, least) = (&self.state, self.limits().difference_per_mille);
        let pairs = state.repeats.saturating_add(state.changes);
        // Neither stuck samples nor disturbances tell of the noise.
        let pairs = pairs.saturating_sub(state.runs.stuck_samples);
        let odd = state.spike_squares.saturating_add(state.step_squares);
        let squares = state.neighbours.total().saturating_sub(odd);
        let per_mille = squares.saturating_mul(1000).checked_div(pairs.into())?;
        (pairs >= JUDGED && per_mille < least.into()).then_some(Reason::Coarse {
            per_mille: per_mille as u16,
        })
    }

    /// Judges the runs by the mean run of the whole record, which was not yet known when an early run
    /// happened.
    fn stuck(&self) -> Option<Reason> {
        let (limits, state) = (self.limits(), &self.state);
        let (samples, runs) = (state.samples(), &state.runs);
        let pairs = state.repeats.saturating_add(state.changes);
        let changes = u128::from(state.changes) * 1000;
        let frozen =
            pairs >= JUDGED && changes < u128::from(pairs) * u128::from(limits.change_per_mille);
        let stuck = runs.stuck_samples.max(runs.longest.into());
        let beyond = runs.is_longest_implausible(limits.run_factor)
            && exceeds(stuck.into(), samples.into(), limits.stuck_per_mille);
        (frozen || beyond).then_some(Reason::Stuck {
            longest_run: runs.longest,
            changes: state.changes,
            samples,
        })
    }
}

impl Default for Integrity {
    /// A watch with the default limits.
    fn default() -> Self {
        Self::new()
    }
}

impl PartialEq for Integrity {
    fn eq(&self, other: &Self) -> bool {
        self.limits() == other.limits() && self.state == other.state
    }
}

impl Eq for Integrity {}

#[cfg(feature = "storage")]
impl Integrity {
    /// What a snapshot stores: the state after a gap, without the limits.
    pub(crate) fn stored(&self) -> impl serde::Serialize + use<> {
        let mut state = self.state.clone();
        state.gap();
        state
    }

    /// Reads what was [stored](Self::stored), and returns the bytes behind it. `None` if no record
    /// leads to such a state.
    pub(crate) fn restore<'b>(&mut self, bytes: &'b [u8]) -> Option<&'b [u8]> {
        let (state, rest) = postcard::take_from_bytes::<State>(bytes).ok()?;
        if !state.is_possible() {
            return None;
        }
        self.state = state;
        Some(rest)
    }
}

/// The number of differences of neighbours from which the share of changes and the noise are judged.
const JUDGED: u64 = 1000;

/// The mean square of the differences of neighbours from which counts jump between the ends of their range, in thousandths
/// of that of the range: without a sign, and with one. One spike in a thousand samples has 2, independent noise from one
/// end to the other 30 or less in a thousand samples, and uniform noise 167. Chosen by hand.
const MISREAD: (u16, u16) = (10, 60);

/// Whether a part is more than `per_mille` thousandths of the whole.
pub(crate) fn exceeds(part: u128, whole: u128, per_mille: u16) -> bool {
    part.saturating_mul(1000) > whole.saturating_mul(per_mille.into())
}

/// A part of a whole in percent, rounded down.
fn percent(part: u128, whole: u128) -> u8 {
    let percent = part.saturating_mul(100) / whole.max(1);
    percent.min(100) as u8
}
