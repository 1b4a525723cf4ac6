//! An axis of a log with everything that is kept beside its curve, for any number of covariates.

use super::OCTAVES;
use allanite::{
    Accumulator, Axis, Error, Scale,
    axis::{MomentPart, Moments},
    covariate::CrossCurve,
    integrity::{Integrity, Reason},
    kurtosis::Kurtosis,
};

/// The largest number of covariates that a log can be read with. Chosen by hand.
pub(super) const MOST: usize = 8;

/// What an axis shows beside its curve.
pub(super) struct AxisEvidence {
    pub(super) kurtosis: Kurtosis<OCTAVES>,
    pub(super) covariates: Vec<CrossCurve<OCTAVES>>,
    pub(super) invalid: Option<Reason>,
    /// The sample near which motion first showed.
    pub(super) moved_at: Option<u64>,
}

/// An axis of the library, whatever number of covariates its type has.
pub(super) trait WatchedAxis: Send {
    /// Adds the counts of some rows, and those of every covariate in the same rows.
    fn push(&mut self, counts: &[i32], covariates: &[Vec<i32>]);

    /// Tells that samples are missing here.
    fn gap(&mut self, lost: u64);

    fn accumulator(&self) -> &Accumulator<OCTAVES>;

    /// The evidence of the axis. `units` holds the unit per count of every covariate.
    fn evidence(&self, scale: Scale, units: &[f64]) -> Result<AxisEvidence, Error>;
}

/// An axis without a gate, because a log is judged as it is.
struct Watched<const COVARIATES: usize, M: MomentPart> {
    axis: Axis<OCTAVES, COVARIATES, (), M>,
    moved_at: Option<u64>,
}

/// An axis of which only the curve and the integrity are kept. Both take slices, which is several times as fast.
struct Alone {
    accumulator: Accumulator<OCTAVES>,
    integrity: Integrity,
    moved_at: Option<u64>,
}

/// The number of samples after which motion is looked for: those of the shortest cluster whose mean shows it.
const LOOK: usize = 64;

/// Remembers the first motion.
fn look(integrity: &Integrity, moved_at: &mut Option<u64>) {
    if moved_at.is_none() {
        let tally = integrity.tally();
        let moves = tally.motions > 0 || tally.steps > 0;
        *moved_at = moves.then(|| tally.samples.saturating_sub(LOOK as u64));
    }
}

impl<const COVARIATES: usize, M: MomentPart> Watched<COVARIATES, M> {
    const fn new() -> Self {
        Self {
            axis: Axis::new(),
            moved_at: None,
        }
    }
}

impl<const COVARIATES: usize, M> WatchedAxis for Watched<COVARIATES, M>
where
    M: MomentPart,
    Axis<OCTAVES, COVARIATES, (), M>: Send,
{
    fn push(&mut self, counts: &[i32], covariates: &[Vec<i32>]) {
        for (row, &count) in counts.iter().enumerate() {
            let beside: [i32; COVARIATES] = std::array::from_fn(|i| covariates[i][row]);
            self.axis.push((count, beside));
            if row % LOOK == LOOK - 1 {
                let [integrity] = self.axis.integrity();
                look(integrity, &mut self.moved_at);
            }
        }
    }

    fn gap(&mut self, lost: u64) {
        self.axis.miss(lost);
    }

    fn accumulator(&self) -> &Accumulator<OCTAVES> {
        let [accumulator] = self.axis.accumulators();
        accumulator
    }

    fn evidence(&self, scale: Scale, units: &[f64]) -> Result<AxisEvidence, Error> {
        let told = self
            .axis
            .record_so_far(0, (scale, std::array::from_fn(|i| units[i])))?;
        Ok(AxisEvidence {
            kurtosis: told.kurtosis.unwrap_or_default(),
            covariates: told.covariates.into_iter().collect(),
            invalid: told.invalid,
            moved_at: self.moved_at,
        })
    }
}

impl WatchedAxis for Alone {
    fn push(&mut self, counts: &[i32], _: &[Vec<i32>]) {
        self.accumulator.push_slice(counts);
        let (blocks, rest) = counts.as_chunks::<LOOK>();
        for block in blocks {
            self.integrity.push_slice(block);
            look(&self.integrity, &mut self.moved_at);
        }
        self.integrity.push_slice(rest);
    }

    fn gap(&mut self, lost: u64) {
        match lost {
            0 => self.accumulator.gap(),
            lost => self.accumulator.lost(lost),
        }
        self.integrity.gap();
    }

    fn accumulator(&self) -> &Accumulator<OCTAVES> {
        &self.accumulator
    }

    fn evidence(&self, _: Scale, _: &[f64]) -> Result<AxisEvidence, Error> {
        Ok(AxisEvidence {
            kurtosis: Kurtosis::default(),
            covariates: Vec::new(),
            invalid: self.integrity.verdict(),
            moved_at: self.moved_at,
        })
    }
}

/// The sums of a covariate and another one, which takes the place of the axis' covariate.
pub(super) type SharedSums = Axis<OCTAVES, 1, (), ()>;

/// An empty axis with the given number of covariates, at most [`MOST`], and with fourth moments or without.
pub(super) fn axis(covariates: usize, moments: bool) -> Box<dyn WatchedAxis> {
    match (covariates, moments) {
        (0, false) => Box::new(Alone {
            accumulator: Accumulator::new(),
            integrity: Integrity::new(),
            moved_at: None,
        }),
        (_, false) => with_covariates::<()>(covariates),
        (_, true) => with_covariates::<Moments>(covariates),
    }
}

fn with_covariates<M>(covariates: usize) -> Box<dyn WatchedAxis>
where
    M: MomentPart + 'static,
    M::Sums<OCTAVES>: Send,
{
    match covariates {
        0 => Box::new(Watched::<0, M>::new()),
        1 => Box::new(Watched::<1, M>::new()),
        2 => Box::new(Watched::<2, M>::new()),
        3 => Box::new(Watched::<3, M>::new()),
        4 => Box::new(Watched::<4, M>::new()),
        5 => Box::new(Watched::<5, M>::new()),
        6 => Box::new(Watched::<6, M>::new()),
        7 => Box::new(Watched::<7, M>::new()),
        _ => Box::new(Watched::<MOST, M>::new()),
    }
}
