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
}

/// An axis of the library, whatever number of covariates its type has.
pub(super) trait WatchedAxis: Send {
    /// Adds the counts of some rows, and those of every covariate in the same rows.
    fn push(&mut self, counts: &[i32], covariates: &[Vec<i32>]);

    /// Tells that so many samples are missing here, or an unknown number if it is 0.
    fn gap(&mut self, missing: u64);

    fn accumulator(&self) -> &Accumulator<OCTAVES>;

    /// The sample of time near which motion first showed.
    fn moved_at(&self) -> Option<u64>;

    /// The evidence of the axis. `units` holds the unit per count of every covariate.
    fn evidence(&self, scale: Scale, units: &[f64]) -> Result<AxisEvidence, Error>;
}

/// An axis without a gate, because a log is judged as it is.
struct Watched<const COVARIATES: usize, M: MomentPart> {
    axis: Axis<OCTAVES, COVARIATES, (), M>,
    motion: FirstMotion,
}

/// An axis without covariates, which takes slices. That is several times as fast.
struct Alone<M: MomentPart> {
    axis: Axis<OCTAVES, 0, (), M>,
    motion: FirstMotion,
}

/// The sample of time near which motion first showed.
#[derive(Default)]
struct FirstMotion {
    at: Option<u64>,
    /// The samples that are missing so far.
    missing: u64,
}

/// The number of samples after which motion is looked for: those of the shortest cluster whose mean shows it.
const LOOK: usize = 64;

impl FirstMotion {
    fn look(&mut self, integrity: &Integrity) {
        if self.at.is_none() {
            let tally = integrity.tally();
            let moves = tally.motions > 0 || tally.steps > 0;
            let at = (tally.samples + self.missing).saturating_sub(LOOK as u64);
            self.at = moves.then_some(at);
        }
    }

    const fn gap(&mut self, missing: u64) {
        self.missing = self.missing.saturating_add(missing);
    }
}

impl<const COVARIATES: usize, M: MomentPart> Watched<COVARIATES, M> {
    fn new() -> Self {
        Self {
            axis: Axis::new(),
            motion: FirstMotion::default(),
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
                self.motion.look(integrity);
            }
        }
    }

    fn gap(&mut self, missing: u64) {
        self.motion.gap(missing);
        self.axis.miss(missing);
    }

    fn moved_at(&self) -> Option<u64> {
        self.motion.at
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
        })
    }
}

impl<M> WatchedAxis for Alone<M>
where
    M: MomentPart,
    Axis<OCTAVES, 0, (), M>: Send,
{
    fn push(&mut self, counts: &[i32], _: &[Vec<i32>]) {
        let motion = &mut self.motion;
        let look = |_, integrity: &Integrity| motion.look(integrity);
        self.axis.push_slices_looking([counts], look);
    }

    fn gap(&mut self, missing: u64) {
        self.motion.gap(missing);
        self.axis.miss(missing);
    }

    fn moved_at(&self) -> Option<u64> {
        self.motion.at
    }

    fn accumulator(&self) -> &Accumulator<OCTAVES> {
        let [accumulator] = self.axis.accumulators();
        accumulator
    }

    fn evidence(&self, scale: Scale, _: &[f64]) -> Result<AxisEvidence, Error> {
        let told = self.axis.record_so_far(0, (scale, []))?;
        Ok(AxisEvidence {
            kurtosis: told.kurtosis.unwrap_or_default(),
            covariates: Vec::new(),
            invalid: told.invalid,
        })
    }
}

/// The sums of a covariate and another one, which takes the place of the axis' covariate.
pub(super) type SharedSums = Axis<OCTAVES, 1, (), ()>;

/// An empty axis with the given number of covariates, at most [`MOST`], and with fourth moments or without.
pub(super) fn axis(covariates: usize, moments: bool) -> Box<dyn WatchedAxis> {
    match (covariates, moments) {
        (0, false) => alone::<()>(),
        (0, true) => alone::<Moments>(),
        (_, false) => with_covariates::<()>(covariates),
        (_, true) => with_covariates::<Moments>(covariates),
    }
}

fn alone<M>() -> Box<dyn WatchedAxis>
where
    M: MomentPart + 'static,
    M::Sums<OCTAVES>: Send,
{
    Box::new(Alone::<M> {
        axis: Axis::new(),
        motion: FirstMotion::default(),
    })
}

fn with_covariates<M>(covariates: usize) -> Box<dyn WatchedAxis>
where
    M: MomentPart + 'static,
    M::Sums<OCTAVES>: Send,
{
    match covariates {
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
