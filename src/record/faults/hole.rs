//! Zeros, and the hole that a dead band leaves next to them.

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

    /// The distance from zero from which on a value does not adjoin the edge: twice that of the edge, or three steps beyond it. Before
    /// there is an edge, any value may be it.
    #[inline(always)]
    pub(super) fn reach(&self, step: u32) -> u32 {
        match self.edge {
            0 => u32::MAX,
            edge => edge
                .saturating_mul(2)
                .max(edge.saturating_add(step.saturating_mul(3))),
        }
    }

    /// Adds the distance of a value from zero.
    #[inline(always)]
    pub(super) fn push(&mut self, distance: u32, repeats: bool, steps: &Steps) {
        let step = steps.step();
        if self.edge > 0 && distance >= self.reach(step) {
            return;
        }
        if !repeats {
            if let Some(level) = self.levels.get_mut(usize::from(steps.class(distance))) {
                *level = level.saturating_add(1);
            }
            let around = distance > 0 && u64::from(distance) <= steps.window();
            self.around = self.around.saturating_add(u64::from(around));
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
