//! A look of a self-test: the five terms are fitted to the record so far.

use crate::{
    curve::Curve,
    fit::{Fitting, Options},
    integrity::Reason,
    model::Model,
};

/// A look in progress, for a main loop that has other work to do: one call of
/// [`advance`](Self::advance) takes as long as one of [`Fitting::advance`]. Samples may be pushed
/// meanwhile; the look is at the record as it was when the look began.
///
/// # Example
///
/// ```
/// use allanite::{Axis, Scale, self_test::{Limit, Plan, SelfTest, Status}};
///
/// let plan = Plan {
///     limits: [Limit { effect: "angle_random_walk", most: 0.02 }].into_iter().collect(),
///     least_p: 0.0,
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
/// let record = gyro.evidence(0, scale, [])?;
/// let mut look = test.begin_look(record.samples, record.curve, record.invalid);
/// while !look.advance() {
///     gyro.push(sample()); // feed the watchdog, take the next samples
/// }
/// assert!(matches!(test.conclude(&look), Status::Running { .. } | Status::Passed));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Look<const OCTAVES: usize> {
    /// Samples of the record.
    pub(super) samples: u64,
    /// Why its curve is not valid.
    pub(super) invalid: Option<Reason>,
    /// `None` where the curve cannot be fitted.
    pub(super) fitting: Option<Fitting<OCTAVES>>,
}

impl<const OCTAVES: usize> Look<OCTAVES> {
    pub(super) fn new(samples: u64, curve: Curve<OCTAVES>, invalid: Option<Reason>) -> Self {
        let fitting = match invalid {
            Some(_) => None,
            None => Some(Fitting::new(curve, Model::ieee_952(), Options::default())),
        };
        Self {
            samples,
            invalid,
            fitting,
        }
    }

    /// Does one piece of work, and returns whether the look is complete.
    pub fn advance(&mut self) -> bool {
        let Some(fitting) = &mut self.fitting else {
            return true;
        };
        match fitting.advance() {
            Ok(fit) => fit.is_some(),
            Err(_) => {
                self.fitting = None;
                true
            }
        }
    }
}
