//! The state of a self-test in a snapshot: the next look, the limits kept, the verdict.

use super::{Failure, Limit, Plan, Progress, SelfTest, Status};
use crate::{
    numerics::{
        algebra::Choice,
        real::{double, real},
    },
    storage::Error,
    storage::{certificate::WireReason, envelope::CRC},
};
use serde::{Deserialize, Serialize};

/// The largest number of bytes of a stored test.
pub(crate) const LONGEST: usize = 80;

/// The rule by which limits are decided. It is a part of the plan's checksum.
const RULE: &[u8] = b"likelihood ratio";

#[derive(Serialize, Deserialize)]
struct Stored {
    /// The CRC-32 of the rule, the plan and the scale.
    plan: u32,
    next: u64,
    kept: u16,
    verdict: Verdict,
}

/// A [`Status`] that names a limit by its position in the plan.
#[derive(Serialize, Deserialize)]
enum Verdict {
    Running {
        expected_s: f64,
    },
    Passed,
    AboveLimit {
        limit: u8,
        value: f64,
    },
    Misfit {
        p_value: f64,
    },
    Undecided {
        /// `None` stands for the misfit.
        limit: Option<u8>,
        decided_by_s: Option<f64>,
    },
    Invalid(WireReason),
}

impl<const OCTAVES: usize> SelfTest<OCTAVES> {
    /// The state that a snapshot holds.
    pub(crate) fn stored(&self) -> impl Serialize + use<OCTAVES> {
        let Progress { next, kept, status } = self.progress;
        Stored {
            plan: self.fingerprint(),
            next,
            kept: kept.bits(),
            verdict: self.stored_verdict(status),
        }
    }

    fn stored_verdict(&self, status: Status) -> Verdict {
        let place = |limit: Limit| {
            let mut limits = self.plan.limits.iter();
            limits.position(|own| *own == limit).map(|i| i as u8)
        };
        match status {
            Status::Running { expected_s, .. } => Verdict::Running {
                expected_s: double(expected_s),
            },
            Status::Passed => Verdict::Passed,
            Status::Failed(Failure::Limit { limit, value }) => Verdict::AboveLimit {
                limit: place(limit).unwrap_or(0),
                value: double(value),
            },
            Status::Failed(Failure::Misfit { p_value }) => Verdict::Misfit {
                p_value: double(p_value),
            },
            Status::Undecided {
                limit,
                decided_by_s,
            } => Verdict::Undecided {
                limit: place(limit),
                decided_by_s: decided_by_s.map(double),
            },
            Status::Invalid(reason) => Verdict::Invalid(reason.into()),
        }
    }

    /// Continues the test from the state that was [stored](Self::stored), and returns the bytes after it.
    pub(crate) fn restore<'b>(&mut self, bytes: &'b [u8]) -> Result<&'b [u8], Error> {
        let taken = postcard::take_from_bytes::<Stored>(bytes);
        let (stored, rest) = taken.map_err(|_| Error::Impossible)?;
        if stored.plan != self.fingerprint() {
            return Err(Error::OtherPlan);
        }
        let status = self.status_of(stored.verdict);
        self.progress = Progress {
            next: stored.next,
            kept: Choice::from_bits(stored.kept),
            status: status.ok_or(Error::Impossible)?,
        };
        Ok(rest)
    }

    fn status_of(&self, verdict: Verdict) -> Option<Status> {
        let limit = |i: u8| self.plan.limits.get(usize::from(i)).copied();
        Some(match verdict {
            Verdict::Running { expected_s } => Status::Running {
                progress: 0.0,
                expected_s: real(expected_s),
            },
            Verdict::Passed => Status::Passed,
            Verdict::AboveLimit { limit: i, value } => Status::Failed(Failure::Limit {
                limit: limit(i)?,
                value: real(value),
            }),
            Verdict::Misfit { p_value } => Status::Failed(Failure::Misfit {
                p_value: real(p_value),
            }),
            Verdict::Undecided {
                limit: i,
                decided_by_s,
            } => {
                let decided_by_s = decided_by_s.map(real);
                match i {
                    Some(i) => Status::Undecided {
                        limit: limit(i)?,
                        decided_by_s,
                    },
                    None => self.undecided(usize::MAX, decided_by_s),
                }
            }
            Verdict::Invalid(reason) => Status::Invalid(reason.into()),
        })
    }

    /// The CRC-32 that distinguishes one plan and scale from another.
    fn fingerprint(&self) -> u32 {
        let Plan {
            limits,
            least_p,
            false_pass,
            false_fail,
            shortest_s,
            longest_s,
        } = &self.plan;
        let mut digest = CRC.digest();
        // A test that another rule has begun cannot be continued.
        digest.update(RULE);
        for limit in limits {
            digest.update(limit.effect.as_bytes());
            digest.update(&double(limit.most).to_le_bytes());
        }
        let scale = [self.scale.rate_per_count(), self.scale.rate_hz()];
        let numbers = [*least_p, *false_pass, *false_fail, *shortest_s, *longest_s];
        for number in numbers.into_iter().chain(scale) {
            digest.update(&double(number).to_le_bytes());
        }
        digest.finalize()
    }
}
