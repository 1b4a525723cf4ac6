//! Transfers between a sensor and a bus, apart from how the bus is driven. What comes next is decided by a
//! [`Procedure`], which knows nothing of the bus. A blocking and an asynchronous driver carry it out.

#[cfg(feature = "async")]
use super::AsyncRegisters;
use super::{Error, Interface, Registers};
use embedded_hal::delay::DelayNs;

/// What a procedure wants to be done next.
pub(super) enum Step<'a> {
    /// Read from `register` on, and then ask for the next step.
    Read { register: u8, bytes: &'a mut [u8] },
    /// Write `value` to `register`.
    Write { register: u8, value: u8 },
    /// Write a register, which is the first byte, and what follows it.
    Frame { frame: &'a [u8] },
    /// Wait for this number of µs.
    Wait { us: u32 },
    /// The procedure has ended.
    Done,
}

/// A sequence of transfers. Each step may depend on what the steps before have read.
pub(super) trait Procedure {
    /// The next step. It is only asked for after the step before has succeeded.
    ///
    /// # Errors
    /// What the procedure found in the bytes that it has read.
    fn step<E>(&mut self) -> Result<Step<'_>, Error<E>>;
}

/// A delay for procedures that never wait.
pub(super) struct NoDelay;

impl DelayNs for NoDelay {
    fn delay_ns(&mut self, _: u32) {}
}

#[cfg(feature = "async")]
impl embedded_hal_async::delay::DelayNs for NoDelay {
    async fn delay_ns(&mut self, _: u32) {}
}

/// The error of the bus at a frame.
fn failed<E>(frame: &[u8], error: E) -> Error<E> {
    let register = frame.first().copied().unwrap_or(0);
    Error::Bus { register, error }
}

/// Carries a procedure out on a blocking bus.
pub(super) fn run<B: Registers>(
    bus: &mut B,
    interface: &Interface,
    delay: &mut impl DelayNs,
    procedure: &mut impl Procedure,
) -> Result<(), Error<B::Error>> {
    loop {
        match procedure.step()? {
            Step::Read { register, bytes } => bus
                .read(interface, register, bytes)
                .map_err(|error| Error::Bus { register, error })?,
            Step::Write { register, value } => bus
                .write(interface, register, value)
                .map_err(|error| Error::Bus { register, error })?,
            Step::Frame { frame } => bus
                .write_frame(interface, frame)
                .map_err(|error| failed(frame, error))?,
            Step::Wait { us } => delay.delay_us(us),
            Step::Done => return Ok(()),
        }
    }
}

/// Carries a procedure out on an asynchronous bus.
#[cfg(feature = "async")]
pub(super) async fn run_async<B: AsyncRegisters>(
    bus: &mut B,
    interface: &Interface,
    delay: &mut impl embedded_hal_async::delay::DelayNs,
    procedure: &mut impl Procedure,
) -> Result<(), Error<B::Error>> {
    loop {
        match procedure.step()? {
            Step::Read { register, bytes } => bus
                .read(interface, register, bytes)
                .await
                .map_err(|error| Error::Bus { register, error })?,
            Step::Write { register, value } => bus
                .write(interface, register, value)
                .await
                .map_err(|error| Error::Bus { register, error })?,
            Step::Frame { frame } => bus
                .write_frame(interface, frame)
                .await
                .map_err(|error| failed(frame, error))?,
            Step::Wait { us } => delay.delay_us(us).await,
            Step::Done => return Ok(()),
        }
    }
}
