//! A look of a self-test: the five terms are fitted to the record so far, and each limit is compared with it.

use super::plan::Limit;
use crate::{
    curve::Curve,
    ieee_952::{self, Fit, TERMS},
    list,
    numerics::real::Real,
    record::integrity::Reason,
};
use heapless::Vec;

/// What distinguishes a look from those of other tests: where its test lay when the look began, and which of its looks it is.
pub(super) type Mark = (usize, u32);

/// The curve, the mean rate if it is known, and why the curve is not valid.
pub(super) type Observed<const OCTAVES: usize> = (Curve<OCTAVES>, Option<Real>, Option<Reason>);

/// A look in progress, for a main loop that has other work to do: the first call of [`advance`](Self::advance) takes as long
/// as a [fit of the five terms](crate::ieee_952::fit()), and each other one compares it with a limit that is not decided yet,
/// which takes no longer. Samples may be pushed meanwhile; the look is at the record as it was when the look began.
///
/// # Example
///
/// ```
/// use allanite::{Axis, Scale, self_test::{Limit, Plan, SelfTest, Status}};
///
/// let plan = Plan {
///     limits: [Limit { effect: "angle_random_walk", most: 0.02 }].into_iter().collect(),
///     least_p: 1e-3,
///     false_pass: 0.01,
///     false_fail: 0.01,
///     shortest_s: 1.0,
///     longest_s: 600.0,
/// };
/// let scale = Scale::new(1.0 / 131.0, 100.0)?;
/// let mut gyro = Axis::<16>::new();
/// let mut test = SelfTest::<16>::new(plan, scale)?;
/// let mut random = 1_u32;
/// let mut sample = || {
///     random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
///     (random >> 28) as i32
/// };
/// while !test.is_due(gyro.samples()) {
///     gyro.push(sample());
/// }
/// let record = gyro.record_so_far(0, scale)?;
/// let mut look = test.begin_look(&record)?;
/// while !look.advance() {
///     gyro.push(sample()); // feed the watchdog, take the next samples
/// }
/// assert!(matches!(test.conclude(&mut look)?, Status::Running { .. } | Status::Passed));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Look<const OCTAVES: usize> {
    /// The mark of the test that began it; `None` once it is concluded.
    pub(super) mark: Option<Mark>,
    /// Samples of the record.
    pub(super) samples: u64,
    /// Why its curve is not valid.
    pub(super) invalid: Option<Reason>,
    /// The mean rate, in rate units, if it is known.
    pub(super) mean_rate: Option<Real>,
    /// `None` where it cannot be fitted.
    curve: Option<Curve<OCTAVES>>,
    /// The fit, once it is known.
    pub(super) fit: Option<Fit>,
    /// The limits that were undecided when the look began.
    limits: Vec<Compared, TERMS>,
    /// The place in `limits` of the next comparison.
    next: usize,
}

/// A limit, and how far its coefficient lies above it.
#[derive(Clone, Copy)]
pub(super) struct Compared {
    most: Real,
    /// The coefficient's place among the five terms.
    pub(super) place: usize,
    /// The signed root of the likelihood ratio, in standard errors. It is `None` until it is known, and
    /// stays so where the curve cannot be compared with the limit.
    pub(super) above: Option<Real>,
}

impl Compared {
    /// The limit of one of the five terms, before the comparison.
    pub(super) fn new(limit: &Limit) -> Option<Self> {
        Some(Self {
            most: limit.most,
            place: ieee_952::place(limit.effect)?,
            above: None,
        })
    }
}

impl<const OCTAVES: usize> Look<OCTAVES> {
    pub(super) fn new(
        mark: Mark,
        samples: u64,
        (curve, mean_rate, invalid): Observed<OCTAVES>,
        limits: impl Iterator<Item = Compared>,
    ) -> Self {
        Self {
            mark: Some(mark),
            samples,
            invalid,
            mean_rate,
            curve: invalid.is_none().then_some(curve),
            fit: None,
            limits: list::fill(limits),
            next: 0,
        }
    }

    /// Does one piece of work, and returns whether the look is complete.
    pub fn advance(&mut self) -> bool {
        let Some(curve) = &self.curve else {
            return true;
        };
        let Some(fit) = &self.fit else {
            match ieee_952::fit_curve(curve) {
                Ok(fit) => self.fit = Some(fit),
                Err(_) => self.curve = None,
            }
            return self.curve.is_none() || self.limits.is_empty();
        };
        let Some(compared) = self.limits.get_mut(self.next) else {
            return true;
        };
        // A limit that the curve cannot be compared with stays undecided.
        compared.above = ieee_952::above(curve, fit, compared.place, compared.most);
        self.next = self.next.saturating_add(1);
        self.next >= self.limits.len()
    }

    /// The comparison with a limit. It is `None` if the look has none with this limit.
    pub(super) fn compared(&self, limit: &Limit) -> Option<&Compared> {
        let place = ieee_952::place(limit.effect)?;
        let mut compared = self.limits.iter();
        compared.find(|compared| {
            compared.place == place && compared.most.to_bits() == limit.most.to_bits()
        })
    }
}
