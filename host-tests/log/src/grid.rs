//! The step of which all numbers of a column are multiples, if they were rounded to it before they were written.

/// A difference is a multiple of a step if it is within this share of it. Chosen by hand.
const NEAR: u32 = 64;

/// A step of fewer counts cannot be distinguished from the rounding to counts. Chosen by hand.
const LEAST: u32 = 1 << 12;

/// The greatest common step of differences of counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Grid {
    /// The step so far, 0 before the first difference. `None` if there is no common step.
    step: Option<u32>,
}

impl Default for Grid {
    fn default() -> Self {
        Self { step: Some(0) }
    }
}

impl Grid {
    /// The common step of all differences so far, in counts.
    pub(super) fn step(&self) -> Option<u32> {
        self.step.filter(|&step| step > 0)
    }

    /// Whether there may still be a common step.
    pub(super) const fn is_open(&self) -> bool {
        self.step.is_some()
    }

    /// Takes account of a difference. This is Euclid's algorithm, with remainders that rounding leaves taken for none.
    #[inline]
    pub(super) fn include(&mut self, difference: u32) {
        let Some(step) = self.step else {
            return;
        };
        if difference == 0 {
            return;
        }
        let (mut large, mut small) = (step.max(difference), step.min(difference));
        if small == 0 {
            (large, small) = (large, large);
        }
        self.step = loop {
            if small < LEAST {
                break None;
            }
            let rest = (large % small).min(small - large % small);
            if rest <= small / NEAR {
                break Some(small);
            }
            (large, small) = (small, rest);
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(differences: impl IntoIterator<Item = u32>) -> Option<u32> {
        let mut grid = Grid::default();
        differences
            .into_iter()
            .for_each(|difference| grid.include(difference));
        grid.step()
    }

    #[test]
    fn multiples_have_their_common_step_in_any_order() {
        let step = 7_654_321.37;
        for multiples in [[6_u32, 10, 15, 0, 35], [15, 10, 6, 35, 0], [0, 1, 2, 3, 1]] {
            let counts = multiples.map(|multiple| (step * f64::from(multiple)) as u32);
            let found = of(counts).map(f64::from).unwrap();
            assert!((found / step - 1.0).abs() < 1e-5, "{multiples:?}: {found}");
        }
    }

    #[test]
    fn noise_that_was_not_rounded_has_no_step() {
        let mut state = 1_u32;
        let noise = |_| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            state >> 4
        };
        assert_eq!(of((0..64).map(noise)), None);
        assert_eq!(of([]), None);
    }
}
