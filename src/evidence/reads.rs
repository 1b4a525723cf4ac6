//! What a reader made of the samples of three axes, judged from its counts.

use super::faults::{Reads, StaleRuns};
use crate::{
    numerics::{
        math::sqrt,
        real::{Real, real},
    },
    record::{integrity::Reason, reads::SAMPLED},
};

/// The number of samples from which a record is judged.
const JUDGED: u32 = 1000;
/// The fewest reads without an answer, the fewest that lie far from those before, and their smallest share of the samples, as one in so
/// many.
const FEWEST: u32 = 12;
const FEWEST_FAR: u32 = 6;
const ONE_IN: u32 = 10_000;
/// The significance from which reads without an answer are recognised, in standard errors. `cargo xtask study faults` counts with it.
const SURE: Real = 4.0;
/// The significance of pairs of equal axes from which the axes move together, so that nothing is known.
const TOGETHER: Real = 3.0;
/// The bits of surprise of a sample below which nothing is known, and those below which pulses may be periodic.
const LEAST_BITS: u32 = 2;
const PERIODIC: u32 = 7;
/// The largest share of reads without an answer, and of stale samples: more is a sensor that is stuck, and a line with a period of whole
/// samples.
const MOST: Real = 0.3;
/// The runs that show stale blocks: of one axis, and of several.
const RUNS: [u32; 2] = [3, 2];

impl<const AXES: usize> Reads<AXES> {
    /// What is wrong with the reads of the axes; `None` if nothing is. Reads without an answer come first, because they are the largest
    /// error.
    pub fn verdict(&self) -> Option<Reason> {
        let second = || self.repeated().or_else(|| self.stale());
        self.unanswered().or_else(second)
    }

    /// Samples with one number on all axes, far from the samples before, or more often 0 or −1 than by chance.
    fn unanswered(&self) -> Option<Reason> {
        let (samples, equal) = (self.samples(), &self.equal);
        let far = if equal.far >= FEWEST_FAR {
            equal.far
        } else {
            0
        };
        let joint = self.joint();
        let again = joint.share_of_all().min(0.95);
        // Samples that repeat come in clumps.
        let clump = (1.0 + again) / (1.0 - again);
        let neighbours = (joint.shares_of_axes(), clump);
        let values = equal.all.iter().zip(&equal.at);
        let none =
            values.filter(|(reads, cells)| self.is_beyond_chance(**reads, cells, neighbours));
        let reads = none.map(|(reads, _)| *reads).max().unwrap_or(0).max(far);
        (samples >= JUDGED && reads > samples / ONE_IN).then_some(Reason::Unanswered {
            reads: reads.into(),
            samples: samples.into(),
        })
    }

    /// Whether so many samples with one value on all axes are more than chance makes. `cells` says which axes have it, of one sample in
    /// [`SAMPLED`]. An axis has it by chance as often as while another one has not. Motion that moves axes alike makes pairs as well, and
    /// the third axis has the value with them at most as often as its neighbours are equal.
    fn is_beyond_chance(
        &self,
        reads: u32,
        cells: &[u32; 8],
        (neighbours, clump): ([Real; 3], Real),
    ) -> bool {
        let [_, x, y, xy, z, xz, yz, all] = cells.map(|number| real(number) + 0.5);
        let samples = real(self.samples());
        if reads < FEWEST || real(reads) > MOST * samples {
            return false;
        }
        let sampled = samples / real(SAMPLED);
        let none = (sampled - x - y - z - xy - xz - yz - all).max(0.5);
        let any = none + x + y + z + xy + xz + yz;
        // Samples in which another axis has it not.
        let [with_x, with_y, with_z] = [any - yz, any - xz, any - xy];
        let there = [x + xy + xz, y + xy + yz, z + xz + yz];
        let [at_x, at_y, at_z] = there;
        let [of_x, of_y, of_z] = [at_x / with_x, at_y / with_y, at_z / with_z];
        // The relative variance of the chance.
        let unknown: Real = there.iter().map(|number| 1.0 / number).sum();
        let chance = of_x * of_y * of_z * samples;
        let [equal_x, equal_y, equal_z] = neighbours;
        let pairs = [
            (xy, of_x * of_y * (1.0 - of_z), equal_z),
            (xz, of_x * of_z * (1.0 - of_y), equal_y),
            (yz, of_y * of_z * (1.0 - of_x), equal_x),
        ];
        let mut common: Real = 0.0;
        for (pair, expected, equal) in pairs {
            let (pair, expected) = (pair - 0.5, expected * sampled);
            let excess = pair - expected;
            if excess > TOGETHER * sqrt(1.3 * (pair + expected) + 2.0) {
                return false;
            }
            let equal = (1.5 * equal).clamp(0.02, 0.95);
            let all = excess.max(0.0) * equal / (1.0 - equal) * real(SAMPLED);
            common = common.max(all);
        }
        let error = sqrt(1.5 * clump * (chance + common) + chance * chance * unknown + 2.0);
        real(reads) - chance - common > SURE * error
    }

    /// Repeats of all axes at once.
    fn repeated(&self) -> Option<Reason> {
        let joint = self.joint();
        let repeats = joint.repeats();
        let is_judged = self.samples() >= JUDGED && repeats.told;
        is_judged.then(|| joint.reason(&repeats, self.samples().into()))
    }

    /// Blocks that are there twice, most of them at one distance.
    fn stale(&self) -> Option<Reason> {
        let runs = &self.stale.runs;
        // Pulses of an angle come back at the periods of their rate.
        if self.joint().is_alternating() && runs.bits() < PERIODIC {
            return None;
        }
        runs.verdict(self.samples(), AXES)
    }
}

impl StaleRuns {
    /// Whether so many samples of so many axes have blocks that are there twice, most of them at one distance.
    pub fn verdict(&self, samples: u32, axes: usize) -> Option<Reason> {
        let (distance, most) = self.most()?;
        let needed = self.needed()?;
        if most.longest < needed || self.bits() < LEAST_BITS {
            return None;
        }
        let is_one = most.runs.saturating_mul(10) >= self.whole.saturating_mul(7);
        // Counts of few levels come back in runs of other lengths, too.
        let least = if self.bits() < PERIODIC { 17 } else { 12 };
        let is_whole = self.whole.saturating_mul(20) >= self.long.saturating_mul(least);
        let [of_one, of_several] = RUNS;
        let fewest = if axes == 1 { of_one } else { of_several };
        let is_sure =
            most.runs >= fewest || most.longest.saturating_mul(10) >= needed.saturating_mul(17);
        let share = real(most.samples) / real(samples.max(1));
        let is_stale = samples >= JUDGED && is_one && is_whole && is_sure;
        (is_stale && share < MOST).then_some(Reason::Stale {
            stale: most.samples.into(),
            distance,
            samples: samples.into(),
        })
    }
}
