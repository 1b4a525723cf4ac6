//! Zeros, and the hole that a dead band leaves beside them.

use super::steps::Steps;

/// The zeros of a record, and the values next to them.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct Hole {
    pub(crate) zeros: u64,
    /// The smallest distance from zero of all other values; 0 without any.
    pub(crate) edge: u32,
    /// The values that are less than [`width`](Self::width) beyond the edge.
    pub(crate) beside: u64,
    /// The values at zero, one step from it, and two, that do not repeat the one before.
    pub(crate) levels: [u64; 3],
    /// Those within a 64th of the usual difference of neighbours, other than zero, once that is known.
    pub(crate) around: u64,
}

impl Hole {
    pub(super) const NEW: Self = Self {
        zeros: 0,
        edge: 0,
        beside: 0,
        levels: [0; 3],
        around: 0,
    };

    /// The width of the band beside the edge, in counts: a step, or a quarter of the edge if that is longer.
    pub(crate) const fn width(edge: u32, step: u32) -> u32 {
        let (quarter, step) = (edge >> 2, if step == 0 { 1 } else { step });
        if quarter > step { quarter } else { step }
    }

    /// Whether a value is neither beside the edge nor within two steps of zero: it is beyond twice the edge, and beyond the
    /// edge and three steps.
    #[inline(always)]
    pub(super) fn is_far(&self, distance: u32, step: u32) -> bool {
        let far = self.edge.saturating_mul(2);
        self.edge > 0 && distance >= far.max(self.edge.saturating_add(step.saturating_mul(3)))
    }

    /// Adds values that are far from zero and do not repeat, some of which are within the window.
    pub(super) fn push_far(&mut self, around: u64) {
        self.around = self.around.saturating_add(around);
    }

    /// Adds the distance of a value from zero.
    #[inline(always)]
    pub(super) fn push(&mut self, distance: u32, repeats: bool, steps: &Steps) {
        let step = steps.step();
        if !repeats {
            let around = distance > 0 && u64::from(distance) <= steps.window();
            self.push_far(around.into());
        }
        if self.is_far(distance, step) {
            return;
        }
        if !repeats {
            if let Some(level) = self.levels.get_mut(usize::from(steps.class(distance))) {
                *level = level.saturating_add(1);
            }
        }
        if distance == 0 {
            self.zeros = self.zeros.saturating_add(1);
            return;
        }
        if distance < self.edge || self.edge == 0 {
            if u64::from(distance) * 4 < u64::from(self.edge) * 3 {
                self.beside = 0;
            }
            self.edge = distance;
        }
        let beside = distance.saturating_sub(self.edge) < Self::width(self.edge, step);
        self.beside = self.beside.saturating_add(u64::from(beside));
    }
}
