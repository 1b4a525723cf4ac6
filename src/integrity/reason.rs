//! In words, why a record is not to be believed.

/// Why the Allan curve of a record cannot mean what it says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Reason {
    /// The sensor, or who reads it, hung, or its quanta are too coarse for its noise.
    Stuck {
        /// Samples in the longest run of equal values.
        longest_run: u32,
        /// Samples that differ from the one before.
        changes: u64,
        /// Samples of the record.
        samples: u64,
    },
    /// The rate left the sensor's range, or the sensor marks bad data by a rail.
    Railed {
        /// Samples at a rail.
        hits: u64,
        /// Samples of the record.
        samples: u64,
    },
    /// Single samples far beyond the noise make up a good part of the curve.
    Spiked {
        /// How many.
        spikes: u64,
        /// Their share of ΣD² at `m = 1`.
        percent: u8,
    },
    /// The gyro was not at rest.
    Moved {
        /// Stretches of motion.
        motions: u64,
        /// Samples of the clusters that showed it.
        cluster: u16,
        /// Their share of ΣD² of such clusters.
        percent: u8,
    },
    /// Too many samples were lost.
    Missing {
        /// How many.
        missing: u64,
        /// Samples that the sensor must have sent.
        sent: u64,
    },
    /// A gate left out too many samples that were odd.
    LeftOut {
        /// How many.
        left_out: u64,
        /// Samples of the record, those that were left out included.
        samples: u64,
    },
}

impl core::fmt::Display for Reason {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Stuck {
                longest_run,
                changes,
                samples,
            } => write!(
                f,
                "stuck: {longest_run} equal values in a row, {changes} changes in {samples} \
                 samples; check that the sensor is read as often as it measures, or use a finer \
                 range"
            ),
            Self::Railed { hits, samples } => write!(
                f,
                "railed: {hits} of {samples} samples at the end of the scale; record at rest, on a \
                 wider range, or check the bus"
            ),
            Self::Spiked { spikes, percent } => write!(
                f,
                "spiked: {spikes} single samples far beyond the noise make up {percent} % of the \
                 squares at one sample; check supply and bus, or leave them out as gaps"
            ),
            Self::Moved {
                motions,
                cluster,
                percent,
            } => write!(
                f,
                "moved: {motions} times the mean of {cluster} samples left its level, {percent} % \
                 of the squares there; record again at rest, untouched"
            ),
            Self::Missing { missing, sent } => write!(
                f,
                "missing: {missing} of {sent} samples lost; read faster or record at a lower rate"
            ),
            Self::LeftOut { left_out, samples } => write!(
                f,
                "left out: {left_out} of {samples} samples were odd (moved, stuck, railed or \
                 spiked); record again at rest, untouched"
            ),
        }
    }
}
