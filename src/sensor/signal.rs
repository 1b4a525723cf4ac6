/// What an interrupt pin does when data are ready.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Signal {
    /// The pin is high until the data have been read.
    High,
    /// A pulse begins with a rising edge.
    Rising,
    /// A pulse begins with a falling edge. The pin is an open drain and needs a pull-up.
    Falling,
}
