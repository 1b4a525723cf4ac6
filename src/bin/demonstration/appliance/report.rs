//! The product after the record: the sums of every axis, the diagnosis of the first one, and its certificate.

use super::{Failure, Gyro, Progress, recorder::accounted};
use crate::{lines, product::OCTAVES};
use allanite::{
    Model,
    axis::AxisRecord,
    diagnosis::{self, Diagnosis, Options, Verdict},
    effect::CATALOGUE,
    self_test::Status,
    spectrum::Spectrum,
    storage::{AxisCertificate, Certificate, Conditions, RateUnit},
};
use core::{fmt::Arguments, ops::ControlFlow};

/// The largest number of bins of a spectrum.
const BINS: usize = 84;

/// the record of an axis of the product's gyro.
pub type GyroRecord = AxisRecord<OCTAVES, 1, Spectrum<BINS>>;

/// A report in progress.
pub struct Report<'r> {
    gyro: &'r Gyro,
    self_test: Status,
    records: &'r [GyroRecord; 3],
    diagnosis: Diagnosis<'r, OCTAVES, BINS>,
    certificate: AxisCertificate,
    next: Next,
}

/// The next part of a report.
#[derive(Clone, Copy)]
enum Next {
    Record,
    Axis(usize),
    Diagnosis,
    Certificate(Verdict),
    Nothing,
}

impl<'r> Report<'r> {
    /// A report on a complete record, with those of its axes.
    // Inlined, so that the diagnosis is built where it stays.
    #[inline(always)]
    pub fn new(gyro: &'r Gyro, self_test: Status, records: &'r [GyroRecord; 3]) -> Self {
        let [x, ..] = records;
        Self {
            gyro,
            self_test,
            records,
            diagnosis: Diagnosis::new(x, &Model::ieee_952(), &CATALOGUE, Options::default()),
            certificate: AxisCertificate::empty(),
            next: Next::Record,
        }
    }

    /// Whether the next part is a step of the diagnosis.
    pub const fn is_diagnosing(&self) -> bool {
        matches!(self.next, Next::Diagnosis)
    }

    /// Does one part of the report, such as a step of the diagnosis. A step takes long, so that `pause` is called between
    /// its pieces.
    ///
    /// # Errors
    /// [`Failure`], if the record cannot be diagnosed.
    pub fn step(
        &mut self,
        line: &mut impl FnMut(Arguments<'_>),
        pause: &mut dyn FnMut() -> ControlFlow<()>,
    ) -> Result<Progress, Failure> {
        self.next = match self.next {
            Next::Record => {
                self.record(line);
                Next::Axis(0)
            }
            Next::Axis(axis) => match self.records.get(axis) {
                Some(records) => {
                    line(format_args!("axis {axis}"));
                    lines::record(records, line);
                    Next::Axis(axis + 1)
                }
                None => Next::Diagnosis,
            },
            Next::Diagnosis => match self.diagnosis.advance(pause)? {
                diagnosis::Progress::Paused => Next::Diagnosis,
                diagnosis::Progress::Step(step) => {
                    let [x, ..] = self.records;
                    self.certificate.take(x, step)?;
                    lines::step(step, line);
                    Next::Diagnosis
                }
                diagnosis::Progress::Finished(verdict) => Next::Certificate(verdict),
            },
            Next::Certificate(verdict) => {
                self.certificate(verdict, line)?;
                Next::Nothing
            }
            Next::Nothing => return Ok(Progress::Complete),
        };
        Ok(Progress::Working)
    }

    fn record(&self, line: &mut impl FnMut(Arguments<'_>)) {
        let gyro = self.gyro;
        let [x, ..] = gyro.integrity();
        line(format_args!(
            "record samples {} left_out {} missing {} accounted {} losses {}",
            gyro.samples(),
            gyro.left_out(),
            x.tally().missing,
            accounted(gyro),
            gyro.losses()
        ));
        line(format_args!("self_test {:?}", self.self_test));
        for (axis, accumulator) in gyro.accumulators().into_iter().enumerate() {
            for octave in accumulator.octaves() {
                let sum = octave.sum.limbs();
                line(format_args!("sum axis {axis} m {} {sum:x?}", octave.m));
            }
        }
    }

    #[inline(never)]
    fn certificate(
        &mut self,
        verdict: Verdict,
        line: &mut impl FnMut(Arguments<'_>),
    ) -> Result<(), Failure> {
        line(format_args!("verdict {verdict:?}"));
        self.certificate.verdict = Some(verdict);
        let [x, ..] = self.gyro.accumulators();
        let conditions = Conditions {
            temperature_c: None,
            duration_s: x.samples() as f64 / 100.0,
            rate_hz: 100.0,
            samples: x.samples(),
            gaps: x.gaps(),
        };
        let unit = RateUnit::DegreesPerSecond;
        let mut certificate = Certificate::new(b"appliance", [0, 1, 0], conditions, unit)?;
        // There is room for three axes.
        let _ = certificate.axes.push(self.certificate.clone());
        let mut buffer = [0; Certificate::MAX_BYTES];
        let bytes = certificate.encode(&mut buffer)?;
        for part in bytes.chunks(32) {
            line(format_args!("certificate {part:02x?}"));
        }
        Ok(())
    }
}
