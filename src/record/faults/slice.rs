//! The bulk path of the faults: it takes many counts at once and leads to the same state.

use super::{
    SampleFaults,
    ends::End,
    steps::{CHUNK, FAR},
};

impl SampleFaults {
    /// Adds counts, and writes for each how many steps it is away from the one before, as [`push`](Self::push) does; 4 behind a gap.
    /// Takes as many counts as there is room for steps. The state afterwards is the same as if they were pushed one by one, but it
    /// is reached sooner.
    pub fn push_slice(&mut self, counts: &[i32], steps: &mut [u8]) {
        let length = counts.len().min(steps.len());
        let (counts, steps) = (
            counts.get(..length).unwrap_or(counts),
            steps.get_mut(..length).unwrap_or_default(),
        );
        let (chunks, rest) = counts.as_chunks::<CHUNK>();
        let (chunks_of_steps, rest_of_steps) = steps.as_chunks_mut::<CHUNK>();
        for (counts, steps) in chunks.iter().zip(chunks_of_steps) {
            if !self.push_chunk(counts, steps) {
                self.push_each(counts, steps);
            }
        }
        self.push_each(rest, rest_of_steps);
    }

    fn push_each(&mut self, counts: &[i32], steps: &mut [u8]) {
        for (&count, step) in counts.iter().zip(steps) {
            *step = self.push(count).unwrap_or(FAR);
        }
    }

    /// Adds counts whose differences are not shorter than the step that is known. If one is, or if not enough is learnt, it does
    /// nothing and returns `false`.
    #[inline(never)]
    fn push_chunk(&mut self, counts: &[i32; CHUNK], steps: &mut [u8; CHUNK]) -> bool {
        let (Some(last), Some(limits)) = (self.last, self.end_limits()) else {
            return false;
        };
        let mut differences = [0; CHUNK];
        let before = core::iter::once(&last).chain(counts);
        for ((difference, count), before) in differences.iter_mut().zip(counts).zip(before) {
            *difference = count.abs_diff(*before);
        }
        let Some(repeats) = self.steps.push_chunk(&differences, steps) else {
            return false;
        };
        self.samples = self.samples.saturating_add(CHUNK as u64);
        self.last = counts.last().copied();
        match repeats {
            0 => self.runs.push(false),
            _ => steps.iter().for_each(|step| self.runs.push(*step == 0)),
        }
        self.spread.push_chunk(counts);
        self.push_near_zero(counts, steps);
        self.push_near_ends(counts, steps, limits);
        true
    }

    /// Adds the counts next to zero, of a chunk whose steps are known.
    fn push_near_zero(&mut self, counts: &[i32; CHUNK], steps: &[u8; CHUNK]) {
        let reach = self.hole.reach(self.steps.step());
        let near = |count: &i32| self.hole.edge == 0 || count.abs_diff(self.zero) < reach;
        // Without an early end, the loop is spread over vectors.
        if counts
            .iter()
            .fold(0, |any, count| any | u8::from(near(count)))
            == 0
        {
            return;
        }
        for (count, step) in counts.iter().zip(steps) {
            let distance = count.abs_diff(self.zero);
            self.hole.push(distance, *step == 0, &self.steps);
        }
    }

    /// The counts beyond which a count is next to the largest or the smallest one, if they are known.
    fn end_limits(&self) -> Option<[i32; 2]> {
        let reach = (5 * u64::from(self.steps.step())).div_ceil(2) as i64;
        let [high, low] = &self.ends;
        let limit = |end: &End| end.has_begun().then(|| end.value().saturating_sub(reach));
        let high = i32::try_from(limit(high)?).ok()?;
        let low = i32::try_from(limit(low)?.saturating_neg()).ok()?;
        Some([high, low])
    }

    /// Adds the counts next to the largest and the smallest one, of a chunk whose steps are known.
    fn push_near_ends(
        &mut self,
        counts: &[i32; CHUNK],
        steps: &[u8; CHUNK],
        [highest, lowest]: [i32; 2],
    ) {
        let near = |count: &i32| *count > highest || *count < lowest;
        if counts
            .iter()
            .fold(0, |any, count| any | u8::from(near(count)))
            == 0
        {
            return;
        }
        let [high, low] = &mut self.ends;
        for (count, step) in counts.iter().zip(steps) {
            let count = i64::from(*count);
            for (end, value) in [(&mut *high, count), (&mut *low, -count)] {
                end.push(value, *step == 0, |distance| self.steps.class(distance));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Counts of many kinds: coarse and fine, with an offset, repeats, an end of the range, and a step that becomes shorter.
    #[test]
    fn slices_of_any_length_lead_to_the_same_state() {
        let mut random = 1_u32;
        let mut next = || {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (random >> 8) as i32
        };
        for kind in 0..12 {
            let size = [6, 60, 4000, 1 << 20][kind % 4];
            let offset = [0, 3000, -70_000][kind / 4];
            let (mut singly, mut together) = (
                SampleFaults::with_zero(offset / 3),
                SampleFaults::with_zero(offset / 3),
            );
            let mut before = 0;
            for round in 0..200 {
                let length = (next() % 300) as usize;
                let counts: [i32; 300] = core::array::from_fn(|_| {
                    let noise = [next(), next(), next()]
                        .map(|one| one % size)
                        .iter()
                        .sum::<i32>();
                    let fine = if round < 100 { 3 * noise } else { noise };
                    let count = offset + fine;
                    before = match next() % 50 {
                        0 => before,
                        1 => offset + 6 * size,
                        _ => count,
                    };
                    before
                });
                let counts = &counts[..length];
                let mut steps = [9; 300];
                together.push_slice(counts, &mut steps[..length]);
                for (count, step) in counts.iter().zip(steps) {
                    assert_eq!(singly.push(*count).unwrap_or(4), step);
                }
                assert_eq!(singly, together, "kind {kind}, round {round}");
                if round % 7 == 0 {
                    singly.gap();
                    together.gap();
                }
            }
        }
    }

    #[test]
    fn as_many_counts_are_taken_as_there_is_room_for_steps() {
        let mut faults = SampleFaults::new();
        faults.push_slice(&[1, 2, 3], &mut [0; 2]);
        assert_eq!(faults.samples, 2);
    }
}
