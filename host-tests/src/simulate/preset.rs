use super::Coefficients;

/// Typical gyros, with coefficients in deg/s and seconds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Preset {
    /// A tactical-grade MEMS gyro: 0.12 °/√h, 0.96 °/h at the flicker floor.
    Tactical,
    /// A fibre-optic gyro: 0.012 °/√h, 0.07 °/h at the flicker floor.
    Fog,
    /// A consumer MEMS gyro: 0.3 °/√h, 9.6 °/h at the flicker floor.
    Mems,
}

impl Preset {
    /// All presets.
    pub const ALL: [Self; 3] = [Self::Tactical, Self::Fog, Self::Mems];

    /// The coefficients of the preset.
    pub fn coefficients(self) -> Coefficients {
        let [
            quantization,
            angle_random_walk,
            bias_instability,
            rate_random_walk,
        ] = match self {
            Self::Tactical => [5e-5, 2e-3, 4e-4, 1e-5],
            Self::Fog => [2e-5, 2e-4, 3e-5, 1e-6],
            Self::Mems => [2e-4, 5e-3, 4e-3, 3e-4],
        };
        Coefficients {
            quantization,
            angle_random_walk,
            bias_instability,
            rate_random_walk,
            rate_ramp: 0.0,
        }
    }
}
