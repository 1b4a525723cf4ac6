//! Frames of 16 bits between a sensor and an SPI bus, apart from how the bus is driven. What comes next is decided by a
//! [`Dialogue`], which knows nothing of the bus. A blocking and an asynchronous driver carry it out.

use super::Error;
use embedded_hal::spi::SpiDevice;

/// The pause after every exchange, in µs, during which chip select is high.
const STALL_US: u32 = 16;

/// What a dialogue wants to be done next.
pub(super) enum Turn<'a> {
    /// Send these bytes, which concern `register`, and replace them by those that arrive at the same time.
    Exchange { register: u8, bytes: &'a mut [u8] },
    /// Wait for this number of µs.
    Wait { us: u32 },
    /// The dialogue has ended.
    Done,
}

/// A sequence of exchanges. Each turn may depend on what the turns before have brought.
pub(super) trait Dialogue {
    /// The next turn. It is only asked for after the turn before has succeeded.
    ///
    /// # Errors
    /// What the dialogue found in the bytes that have arrived.
    fn turn<E>(&mut self) -> Result<Turn<'_>, Error<E>>;
}

/// Carries a dialogue out on a blocking bus.
pub(super) fn carry_out<SPI: SpiDevice>(
    spi: &mut SPI,
    delay: &mut impl embedded_hal::delay::DelayNs,
    dialogue: &mut impl Dialogue,
) -> Result<(), Error<SPI::Error>> {
    loop {
        match dialogue.turn()? {
            Turn::Exchange { register, bytes } => {
                spi.transfer_in_place(bytes)
                    .map_err(|error| Error::Bus { register, error })?;
                delay.delay_us(STALL_US);
            }
            Turn::Wait { us } => delay.delay_us(us),
            Turn::Done => return Ok(()),
        }
    }
}

/// Carries a dialogue out on an asynchronous bus.
#[cfg(feature = "async")]
pub(super) async fn carry_out_async<SPI: embedded_hal_async::spi::SpiDevice>(
    spi: &mut SPI,
    delay: &mut impl embedded_hal_async::delay::DelayNs,
    dialogue: &mut impl Dialogue,
) -> Result<(), Error<SPI::Error>> {
    loop {
        match dialogue.turn()? {
            Turn::Exchange { register, bytes } => {
                spi.transfer_in_place(bytes)
                    .await
                    .map_err(|error| Error::Bus { register, error })?;
                delay.delay_us(STALL_US).await;
            }
            Turn::Wait { us } => delay.delay_us(us).await,
            Turn::Done => return Ok(()),
        }
    }
}
