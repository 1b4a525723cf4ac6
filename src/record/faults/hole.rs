//! Zeros, and the hole that a dead band leaves beside them.

/// The zeros of a record, and the values next to them.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct Hole {
    pub(crate) zeros: u64,
    /// The smallest distance from zero of all other values; 0 without any.
    pub(crate) edge: u32,
    /// The values that are less than [`width`](Self::width) beyond the edge.
    pub(crate) beside: u64,
}

impl Hole {
    pub(super) const NEW: Self = Self {
        zeros: 0,
        edge: 0,
        beside: 0,
    };

    /// The width of the band beside the edge, in counts: a step, or a quarter of the edge if that is longer.
    pub(crate) const fn width(edge: u32, step: u32) -> u32 {
        let (quarter, step) = (edge >> 2, if step == 0 { 1 } else { step });
        if quarter > step { quarter } else { step }
    }

    /// Adds the distance of a value from zero.
    #[inline(always)]
    pub(super) fn push(&mut self, distance: u32, step: u32) {
        // Beyond twice the edge, or beyond the edge and a step, a value is not beside it.
        if distance
            >= self
                .edge
                .saturating_mul(2)
                .max(self.edge.saturating_add(step))
            && self.edge > 0
        {
            return;
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
