use super::{Error, Signal};
use embedded_hal_async::digital::Wait;

/// Waits until a pin signals.
pub(super) async fn wait<P: Wait>(
    pin: &mut P,
    sensor: &'static str,
    signal: Option<Signal>,
) -> Result<(), Error<P::Error>> {
    let waited = match signal {
        Some(Signal::High) => pin.wait_for_high().await,
        Some(Signal::Rising) => pin.wait_for_rising_edge().await,
        Some(Signal::Falling) => pin.wait_for_falling_edge().await,
        None => return Err(Error::NoSignal { sensor }),
    };
    waited.map_err(|error| Error::Pin { error })
}
