/// One sample, in the sensor's counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Reading {
    /// The rates about x, y and z, as [`Accumulator::push`](crate::Accumulator::push) takes them.
    /// One count is [`Description::scale_dps`](super::Description::scale_dps) °/s, or
    /// [`Adis16470::SCALE_DPS`](super::Adis16470::SCALE_DPS).
    pub gyro: [i32; 3],
    /// The temperature count, which [`Temperature::celsius`](super::Temperature::celsius) converts;
    /// `None` if the sensor has no temperature, or has not sent one yet.
    pub temperature: Option<i16>,
    /// What was lost before this sample. A FIFO with the sensor's own time knows it. Otherwise few sensors
    /// report it, so a caller that knows better may set it: see [`Pace`](super::Pace).
    pub loss: Loss,
    /// The sensor's own time of the sample, in ticks of [`Fifo::tick_ps`](super::Fifo::tick_ps). It does not
    /// wrap. `None` if the sample was not read from a FIFO.
    pub ticks: Option<u64>,
}

/// What was lost before a sample.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Loss {
    /// As far as is known, the sample follows the one before.
    #[default]
    Nothing,
    /// This number of samples.
    Samples(u32),
    /// Samples were lost, but it is not known how many.
    Unknown,
}

impl Loss {
    /// The loss if `intervals` sample intervals have passed since the sample before, as
    /// [`Pace::stamp`](super::Pace::stamp) returns them.
    pub const fn of_intervals(intervals: u32) -> Self {
        match intervals {
            0 | 1 => Self::Nothing,
            _ => Self::Samples(intervals - 1),
        }
    }

    /// This loss, or `other` if this one is not known in number.
    pub const fn or(self, other: Self) -> Self {
        match (self, other) {
            (Self::Samples(_), _) | (Self::Unknown, Self::Nothing) => self,
            _ => other,
        }
    }
}
