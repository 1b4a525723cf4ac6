//! The limits beyond which a record is not valid.

/// The limits of [`Integrity`](crate::integrity::Integrity). Shares are in thousandths, from 0, which allows
/// no such sample, to 1000, which allows any number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Limits {
    /// The values at which the sensor clips, by default those of 16, 20, 24 and 32 bits. A sensor of 14 bits
    /// has `[-8192, 8191]`.
    pub rails: &'static [i32],
    /// The largest share of samples at a rail. Default 1. The default is chosen by hand;
    /// `host-tests/tests/library/integrity/disturbed.rs` runs with it.
    pub rail_per_mille: u16,
    /// A run of equal values is implausible if it is longer than this multiple of the record's mean
    /// run, `8 … 256`. Default 128. `host-tests/tests/library/integrity/rest.rs` holds the default: no record
    /// with a noise of 0.2 counts rms or more is refused.
    pub run_factor: u16,
    /// The largest share of samples in implausibly long runs. Default 1. The default is chosen by hand;
    /// no study varies it.
    pub stuck_per_mille: u16,
    /// The smallest share of samples that differ from the sample before. It is judged from 1000 samples
    /// on. Default 1. The default is chosen by hand: 1000 samples are the fewest of which a thousandth
    /// is one.
    pub change_per_mille: u16,
    /// The smallest mean square of the differences of neighbouring samples, in thousandths of a squared
    /// count. It is judged from 1000 differences on. Default 640. White noise of 0.475 to 0.495 counts rms
    /// has it, which depends on where between two counts the mean lies.
    /// `host-tests/tests/library/integrity/coarse.rs` sets the default: above it, angle random walk depends on that
    /// place by less than 2 %, and a record of 0.5 counts rms is valid wherever its mean lies. The
    /// noise from sample to sample is taken for white. Noise that changes more slowly counts only as far
    /// as neighbours differ, because the short averaging times show no more of it.
    pub difference_per_mille: u16,
    /// A sample is an outlier if it deviates by more than this multiple of the mean absolute difference
    /// of neighbours, `8 … 256`. Default 20. For white noise, the default is 16 standard deviations of
    /// a difference.
    pub spike_factor: u16,
    /// The largest share of ΣD² at `m = 1` that may come from spikes. Default 50. With the default,
    /// angle random walk comes out at most 2.5 % too high.
    pub spike_per_mille: u16,
    /// A cluster of samples has moved if its mean deviates by more than this multiple of the mean
    /// absolute difference of neighbouring clusters, `8 … 256`. Default 64. The default is chosen by
    /// hand. `host-tests/tests/library/integrity` holds it from both sides: no hidden effect is taken for
    /// motion, and a rotation of 10 deg/s for a second is refused.
    pub motion_factor: u16,
    /// The largest share of ΣD² of the clusters that may come from motion. Default 50. The default is
    /// that of spikes, chosen by hand.
    pub motion_per_mille: u16,
    /// The largest share of samples that may be missing. Default 100. The default is chosen by hand; no
    /// study varies it.
    pub missing_per_mille: u16,
    /// The largest share of samples that a gate may leave out. Default 250. The default is chosen by
    /// hand; no study varies it.
    pub left_out_per_mille: u16,
}

impl Limits {
    /// The limits with the default of every field.
    pub const DEFAULT: Self = Self {
        rails: &[
            i16::MIN as i32,
            i16::MAX as i32,
            -(1 << 19),
            (1 << 19) - 1,
            -(1 << 23),
            (1 << 23) - 1,
            i32::MIN,
            i32::MAX,
        ],
        rail_per_mille: 1,
        run_factor: 128,
        stuck_per_mille: 1,
        change_per_mille: 1,
        difference_per_mille: 640,
        spike_factor: 20,
        spike_per_mille: 50,
        motion_factor: 64,
        motion_per_mille: 50,
        missing_per_mille: 100,
        left_out_per_mille: 250,
    };

    pub(super) const fn check(&self) -> Result<(), InvalidLimit> {
        let ranges = [
            ("rail_per_mille", self.rail_per_mille, SHARE),
            ("run_factor", self.run_factor, FACTOR),
            ("stuck_per_mille", self.stuck_per_mille, SHARE),
            ("change_per_mille", self.change_per_mille, SHARE),
            ("difference_per_mille", self.difference_per_mille, SHARE),
            ("spike_factor", self.spike_factor, FACTOR),
            ("spike_per_mille", self.spike_per_mille, SHARE),
            ("motion_factor", self.motion_factor, FACTOR),
            ("motion_per_mille", self.motion_per_mille, SHARE),
            ("missing_per_mille", self.missing_per_mille, SHARE),
            ("left_out_per_mille", self.left_out_per_mille, SHARE),
        ];
        let mut i = 0;
        while i < ranges.len() {
            let (name, value, (least, most)) = ranges[i];
            if value < least || value > most {
                return Err(InvalidLimit {
                    name,
                    value,
                    least,
                    most,
                });
            }
            i += 1;
        }
        Ok(())
    }
}

/// No share and every share, in thousandths.
const SHARE: (u16, u16) = (0, 1000);
/// A smaller factor would find ordinary noise odd, and a larger one would find nothing. For white noise, 8 is
/// 6.4 standard deviations of a difference, which one difference in 6·10⁹ exceeds. 256 is chosen by hand.
const FACTOR: (u16, u16) = (8, 256);

impl Default for Limits {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// A limit outside the range in which a record can be judged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct InvalidLimit {
    /// The name of the field of [`Limits`].
    pub name: &'static str,
    /// The value of the field.
    pub value: u16,
    /// The smallest value allowed.
    pub least: u16,
    /// The largest value allowed.
    pub most: u16,
}

impl core::fmt::Display for InvalidLimit {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let Self {
            name,
            value,
            least,
            most,
        } = self;
        write!(
            f,
            "the limit {name} = {value} is impossible: choose {least} to {most}"
        )
    }
}

impl core::error::Error for InvalidLimit {}
