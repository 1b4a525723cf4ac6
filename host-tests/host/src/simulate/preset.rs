use super::Coefficients;

/// Gyros with coefficients in deg/s and seconds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Preset {
    /// A tactical-grade MEMS gyro: 0.12 °/√h, 0.96 °/h at the flicker floor.
    Tactical,
    /// A fibre-optic gyro: 0.012 °/√h, 0.07 °/h at the flicker floor.
    Fog,
    /// A consumer MEMS gyro: 0.3 °/√h, 9.6 °/h at the flicker floor.
    Mems,
    /// A fibre-optic gyro of navigation grade, by the class of the SRS2000: 0.001 °/√h, 0.005 °/h.
    Srs2000,
    /// A fibre-optic gyro of tactical grade, by the class of the VG951: 0.015 °/√h, 0.1 °/h.
    Vg951,
    /// A MEMS gyro of industrial grade, by the class of the CRG20: 0.28 °/√h, 5 °/h.
    Crg20,
}

impl Preset {
    /// Typical gyros, whose noise at 100 Hz is white. Most studies are about them.
    pub const TYPICAL: [Self; 3] = [Self::Tactical, Self::Fog, Self::Mems];

    /// Gyros of the three grades that Lv, Liu, Lai & Huang 2015 simulate in section 4. The coefficients
    /// are assumed from the class of each device, because those of the paper are not known. All five
    /// terms show in a record of twelve hours at 2.5 Hz.
    pub const PAPER: [Self; 3] = [Self::Srs2000, Self::Vg951, Self::Crg20];

    /// The coefficients of the preset.
    pub fn coefficients(self) -> Coefficients {
        let [
            quantization,
            angle_random_walk,
            bias_instability,
            rate_random_walk,
            rate_ramp,
        ] = match self {
            Self::Tactical => [5e-5, 2e-3, 4e-4, 1e-5, 0.0],
            Self::Fog => [2e-5, 2e-4, 3e-5, 1e-6, 0.0],
            Self::Mems => [2e-4, 5e-3, 4e-3, 3e-4, 0.0],
            Self::Srs2000 => from_customary([0.01, 0.001, 0.005, 0.01, 0.02]),
            Self::Vg951 => from_customary([0.2, 0.015, 0.1, 0.3, 0.5]),
            Self::Crg20 => from_customary([5.0, 0.28, 5.0, 20.0, 30.0]),
        };
        Coefficients {
            quantization,
            angle_random_walk,
            bias_instability,
            rate_random_walk,
            rate_ramp,
        }
    }
}

/// The units in which data sheets give Q, N, B, K and R, each with its number per unit of deg and seconds.
pub const CUSTOMARY: [(&str, f64); 5] = [
    ("arcsec", 3600.0),
    ("°/√h", 60.0),
    ("°/h", 3600.0),
    ("°/h^1.5", 216_000.0),
    ("°/h²", 12_960_000.0),
];

/// Coefficients in deg and seconds, from those in customary units.
fn from_customary(coefficients: [f64; 5]) -> [f64; 5] {
    std::array::from_fn(|i| coefficients[i] / CUSTOMARY[i].1)
}
