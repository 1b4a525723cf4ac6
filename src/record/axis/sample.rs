//! One sample of all axes and covariates that are recorded together.

/// The counts of all axes at one moment, and those of the covariates at the same moment.
///
/// A single count converts into a sample of one axis, and an array of counts into a sample of several axes.
/// A pair converts into a sample with covariates:
///
/// ```
/// use allanite::axis::Sample;
///
/// let one: Sample<1, 0> = 5.into();
/// let three: Sample<3, 0> = [5, -2, 0].into();
/// let with_temperature: Sample<3, 1> = ([5, -2, 0], [2_950]).into();
/// assert_eq!((three.counts, one.counts), (with_temperature.counts, [5]));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Sample<const AXES: usize, const COVARIATES: usize> {
    /// The counts of the gyro, axis by axis.
    pub counts: [i32; AXES],
    /// The counts of the covariates.
    pub covariates: [i32; COVARIATES],
}

impl<const AXES: usize, const COVARIATES: usize> Sample<AXES, COVARIATES> {
    /// The sample whose counts are all zero.
    pub(crate) const ZERO: Self = Self {
        counts: [0; AXES],
        covariates: [0; COVARIATES],
    };
}

impl From<i32> for Sample<1, 0> {
    fn from(count: i32) -> Self {
        [count].into()
    }
}

impl<const AXES: usize> From<[i32; AXES]> for Sample<AXES, 0> {
    fn from(counts: [i32; AXES]) -> Self {
        (counts, []).into()
    }
}

impl<const COVARIATES: usize> From<(i32, [i32; COVARIATES])> for Sample<1, COVARIATES> {
    fn from((count, covariates): (i32, [i32; COVARIATES])) -> Self {
        ([count], covariates).into()
    }
}

impl<const AXES: usize, const COVARIATES: usize> From<([i32; AXES], [i32; COVARIATES])>
    for Sample<AXES, COVARIATES>
{
    fn from((counts, covariates): ([i32; AXES], [i32; COVARIATES])) -> Self {
        Self { counts, covariates }
    }
}
