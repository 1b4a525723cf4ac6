//! What has been seen of a record, independently of the limits.

use super::{
    cluster::Cluster,
    limits::Limits,
    observation::Observation,
    rails::Rails,
    runs::Runs,
    watch::{Fate, Rule, Watch, square},
};

/// The lengths in samples of the clusters whose means show motion: 0.64 s and 10 s at 100 Hz, 8 ms and
/// 0.13 s at 8 kHz. Chosen by hand; `host-tests/tests/library/integrity/disturbed.rs` shakes and turns gyros
/// for 1 to 30 s with them.
pub(super) const CLUSTERS: [u16; 2] = [64, 1024];

/// The whole state of integrity, without its configuration.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "storage", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct State {
    /// The samples that begin a stretch. All other samples either repeat the sample before or change.
    pub(super) firsts: u64,
    pub(super) missing: u64,
    pub(super) repeats: u64,
    pub(super) changes: u64,
    pub(super) runs: Runs,
    pub(super) rails: Rails,
    pub(super) neighbours: Watch,
    pub(super) spikes: u64,
    pub(super) steps: u64,
    /// Σ D² of the spikes.
    pub(super) spike_squares: u128,
    /// Σ D² of the steps.
    pub(super) step_squares: u128,
    /// Σ D² of the excursion that has not ended yet.
    pub(super) pending_squares: u128,
    pub(super) clusters: [Cluster; CLUSTERS.len()],
    /// Whether the last cluster of either length deviates far from the ordinary ones.
    pub(super) moving: bool,
}

impl State {
    pub(super) const NEW: Self = Self {
        firsts: 0,
        missing: 0,
        repeats: 0,
        changes: 0,
        runs: Runs::NEW,
        rails: Rails::NEW,
        neighbours: Watch::NEW,
        spikes: 0,
        steps: 0,
        spike_squares: 0,
        step_squares: 0,
        pending_squares: 0,
        clusters: [Cluster::NEW, Cluster::NEW],
        moving: false,
    };

    /// The number of samples seen.
    pub(super) fn samples(&self) -> u64 {
        let others = self.repeats.saturating_add(self.changes);
        self.firsts.saturating_add(others)
    }

    /// Adds a count if it needs no closer look, and returns whether it was added. Nearly every sample takes
    /// this path. If the result is `false`, nothing has changed.
    #[inline(always)]
    pub(super) fn push_usual(&mut self, count: i32, limits: &Limits) -> bool {
        let [short, long] = &mut self.clusters;
        let [short_length, long_length] = CLUSTERS;
        // A full longer cluster is judged at the sample after it. A repeated value needs a closer look.
        let repeats = self.runs.value == count;
        if !self.rails.is_between(count) || long.filled == long_length || repeats {
            return false;
        }
        let rule = Rule::neighbours(limits.spike_factor);
        if !self.neighbours.push_usual(count, &rule) {
            return false;
        }
        self.changes = self.changes.saturating_add(1);
        self.runs.change(count);
        short.add(count);
        if short.filled == short_length {
            self.end_short_cluster(limits.motion_factor);
        }
        true
    }

    /// Adds any count and returns what is odd about it.
    #[inline(never)]
    pub(super) fn push(&mut self, count: i32, limits: &Limits) -> Observation {
        let counter = match (self.runs.present, self.runs.value == count) {
            (0, _) => &mut self.firsts,
            (_, true) => &mut self.repeats,
            (_, false) => &mut self.changes,
        };
        *counter = counter.saturating_add(1);
        let stuck = self.runs.push(count, limits.run_factor);
        let railed = self.rails.push(count, limits.rails);
        let mut outlying = false;
        // A stuck value says nothing about the noise.
        if !stuck {
            let ordinary;
            (outlying, ordinary) = self.push_neighbour(count, limits.spike_factor);
            if let Some(count) = ordinary {
                self.push_clusters(count, limits.motion_factor);
            }
        }
        Observation {
            stuck,
            railed,
            outlying,
            moving: self.moving,
        }
    }

    /// Returns whether the count is far from the last ordinary one, and the count that the clusters take
    /// instead of it. The latter is `None` until the scale is known.
    fn push_neighbour(&mut self, count: i32, factor: u16) -> (bool, Option<i32>) {
        let (fate, difference) = self
            .neighbours
            .push(count.into(), &Rule::neighbours(factor));
        match fate {
            Fate::Learning => return (false, None),
            Fate::Learnt { outlier: 0 } => {}
            Fate::Learnt { outlier } => self.add_spike(outlier),
            Fate::Start | Fate::Ordinary => {}
            Fate::Out { .. } => {
                self.pending_squares = self.with_pending(difference);
                return (true, Some(self.neighbours.reference() as i32));
            }
            Fate::Back => {
                self.add_spike(self.with_pending(difference));
            }
            Fate::Accepted => {
                let squares = self.with_pending(difference);
                self.step_squares = self.step_squares.saturating_add(squares);
                self.steps = self.steps.saturating_add(1);
                self.pending_squares = 0;
                return (true, Some(count));
            }
        }
        (false, Some(count))
    }

    fn with_pending(&self, difference: u64) -> u128 {
        self.pending_squares.saturating_add(square(difference))
    }

    #[cold]
    #[inline(never)]
    pub(super) fn add_spike(&mut self, squares: u128) {
        self.spikes = self.spikes.saturating_add(1);
        self.spike_squares = self.spike_squares.saturating_add(squares);
        self.pending_squares = 0;
    }

    /// Adds a count to the clusters. At most one cluster is judged at each sample: a short cluster at its
    /// last sample, a long one at the sample after it.
    fn push_clusters(&mut self, count: i32, factor: u16) {
        let [short, long] = &mut self.clusters;
        let [short_length, long_length] = CLUSTERS;
        if long.filled == long_length {
            let rule = Rule::clusters(factor, long_length);
            long.judge(&rule.with_least(&short.watch, long_length / short_length));
            self.moving = short.watch.is_outside() || long.watch.is_outside();
        }
        short.add(count);
        if short.filled == short_length {
            self.end_short_cluster(factor);
        }
    }

    #[cold]
    #[inline(never)]
    pub(super) fn end_short_cluster(&mut self, factor: u16) {
        let [short, long] = &mut self.clusters;
        let [short_length, _] = CLUSTERS;
        // The sum of 1024 counts of 32 bits is far from the limit of 64 bits.
        long.sum = long.sum.wrapping_add(short.sum);
        long.filled = long.filled.wrapping_add(short_length);
        short.judge(&Rule::clusters(factor, short_length));
        self.moving = short.watch.is_outside() || long.watch.is_outside();
    }

    pub(super) fn gap(&mut self) {
        (self.runs.present, self.runs.value) = (0, 0);
        self.neighbours.gap();
        self.pending_squares = 0;
        for cluster in &mut self.clusters {
            cluster.sum = 0;
            cluster.filled = 0;
            cluster.watch.gap();
        }
        self.moving = false;
    }

    /// Whether a record that ended with a gap can have left this state.
    #[cfg(feature = "storage")]
    pub(super) fn is_possible(&self) -> bool {
        let clusters = self.clusters.iter();
        let empty = |cluster: &Cluster| cluster.sum == 0 && cluster.filled == 0;
        self.runs.present == 0
            && !self.moving
            && self.pending_squares == 0
            && self.neighbours.is_possible()
            && clusters
                .clone()
                .all(|cluster| empty(cluster) && cluster.watch.is_possible())
    }

    pub(super) fn merge(&mut self, other: &Self) {
        self.gap();
        let add = |sum: &mut u64, other: u64| *sum = sum.saturating_add(other);
        add(&mut self.firsts, other.firsts);
        add(&mut self.missing, other.missing);
        add(&mut self.repeats, other.repeats);
        add(&mut self.changes, other.changes);
        add(&mut self.spikes, other.spikes);
        add(&mut self.steps, other.steps);
        self.spike_squares = self.spike_squares.saturating_add(other.spike_squares);
        self.step_squares = self.step_squares.saturating_add(other.step_squares);
        self.runs.merge(&other.runs);
        self.rails.merge(&other.rails);
        self.neighbours.merge(&other.neighbours);
        for (cluster, other) in self.clusters.iter_mut().zip(&other.clusters) {
            cluster.watch.merge(&other.watch);
            cluster.squares = cluster.squares.saturating_add(other.squares);
            add(&mut cluster.motions, other.motions);
        }
    }
}
