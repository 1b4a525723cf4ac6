//! Values that are far from each other, from zero and from the ends of the range, which need no closer look.

use super::SampleFaults;

/// The number of counts that are taken together.
pub(super) const MOST: usize = 16;

/// What some counts add.
pub(super) struct Bulk {
    number: u64,
    small: u64,
    around: u64,
    sum: i64,
    squares: u64,
    last: i32,
}

impl Bulk {
    /// The sums of at most [`MOST`] counts, if all of them are far from what is counted one by one.
    #[inline(always)]
    pub(super) fn of(faults: &SampleFaults, counts: &[i32]) -> Option<Self> {
        let (mut before, first) = (faults.last?, faults.spread.first()?);
        let window = u32::try_from(faults.steps.learnt_window()?).ok()?;
        let (mut nearest, mut nearest_zero, mut widest) = (u32::MAX, u32::MAX, 0);
        let (mut highest, mut lowest) = (i32::MIN, i32::MAX);
        let (mut small, mut around) = (0_u32, 0_u32);
        let (mut sum, mut squares) = (0_i64, 0_u64);
        for &count in counts {
            let difference = count.abs_diff(before);
            let from_zero = count.abs_diff(faults.zero);
            let from_first = count.abs_diff(first);
            nearest = nearest.min(difference);
            nearest_zero = nearest_zero.min(from_zero);
            widest = widest.max(from_first);
            highest = highest.max(count);
            lowest = lowest.min(count);
            small = small.wrapping_add(u32::from(difference <= window));
            around = around.wrapping_add(u32::from(from_zero <= window));
            sum = sum.wrapping_add(i64::from(count).wrapping_sub(first.into()));
            squares = squares.wrapping_add(u64::from(from_first).wrapping_mul(from_first.into()));
            before = count;
        }
        let step = faults.steps.step();
        let [high, low] = &faults.ends;
        let inside = |end: i64, value: i64| end.saturating_sub(value) >= i64::from(step) * 3;
        let is_far = counts.len() <= MOST
            && widest < 1 << 28
            && u64::from(nearest) * 2 >= u64::from(step) * 7
            && faults.hole.is_far(nearest_zero, step)
            && inside(high.value(), highest.into())
            && inside(low.value(), i64::from(lowest).wrapping_neg());
        is_far.then_some(Self {
            number: counts.len() as u64,
            small: small.into(),
            around: around.into(),
            sum,
            squares,
            last: before,
        })
    }

    /// Adds the counts.
    #[inline(always)]
    pub(super) fn add_to(&self, faults: &mut SampleFaults) {
        faults.last = Some(self.last);
        faults.samples = faults.samples.saturating_add(self.number);
        faults.steps.push_far(self.number, self.small);
        faults.runs.push(false);
        faults.hole.push_far(self.around);
        faults.spread.push_sums(self.sum, self.squares);
    }
}
