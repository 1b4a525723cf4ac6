//! The quantities that an inertial sensor writes, as columns of text whose white noise is known from the text.

use super::random::Random;

/// What a group of columns holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Quantity {
    /// The rate of turn.
    Rate,
    /// The angle turned since the sample before.
    AngleIncrement,
    /// The angle turned since the start.
    Angle,
    /// The specific force.
    Force,
    /// The change of velocity since the sample before.
    VelocityIncrement,
    /// The velocity since the start.
    Velocity,
    /// The magnetic field.
    Field,
    /// A quaternion of the attitude, four columns.
    Attitude,
    /// A temperature, one column.
    Temperature,
    /// A pressure, one column.
    Pressure,
    /// A flag that hardly ever changes, one column.
    Status,
    /// A counter of packets, one column.
    Counter,
    /// A word that stands in every row, one column.
    Label,
    /// A number that stands in every row, such as that of a device, one column.
    Constant,
    /// A covariance that nobody filled in, nine columns.
    Covariance,
}

impl Quantity {
    pub(super) const fn columns(self) -> usize {
        match self {
            Self::Attitude => 4,
            Self::Covariance => 9,
            Self::Temperature
            | Self::Pressure
            | Self::Status
            | Self::Counter
            | Self::Label
            | Self::Constant => 1,
            _ => 3,
        }
    }
}

/// A unit as it is written behind a name, and its size in deg, m/s and their rates.
#[derive(Clone, Copy, Debug)]
pub(super) struct Written {
    pub(super) texts: &'static [&'static str],
    pub(super) size: f64,
    /// The value of `--unit` that goes with it.
    pub(super) option: &'static str,
    /// The factor to the unit of the option.
    pub(super) scale: f64,
}

const fn unit(
    texts: &'static [&'static str],
    size: f64,
    option: &'static str,
    scale: f64,
) -> Written {
    Written {
        texts,
        size,
        option,
        scale,
    }
}

const DEGREES: f64 = 180.0 / std::f64::consts::PI;
const G: f64 = 9.80665;

const RATES: [Written; 4] = [
    unit(
        &["deg/s", "°/s", "dps", "deg/sec", "degrees/s"],
        1.0,
        "deg/s",
        1.0,
    ),
    unit(
        &["rad/s", "rad s^-1", "rad/sec", "radians/s"],
        DEGREES,
        "rad/s",
        1.0,
    ),
    unit(&["mdps"], 1e-3, "deg/s", 1e-3),
    unit(&["deg/h", "°/h"], 1.0 / 3600.0, "deg/s", 1.0 / 3600.0),
];
const ANGLES: [Written; 2] = [
    unit(&["deg", "°"], 1.0, "deg/s", 1.0),
    unit(&["rad"], DEGREES, "rad/s", 1.0),
];
const FORCES: [Written; 3] = [
    unit(&["g"], G, "g", 1.0),
    unit(&["m/s^2", "m/s²", "m/s2"], 1.0, "m/s^2", 1.0),
    unit(&["mg"], G * 1e-3, "g", 1e-3),
];
const VELOCITIES: [Written; 1] = [unit(&["m/s"], 1.0, "m/s^2", 1.0)];
const FIELDS: [Written; 2] = [
    unit(&["uT", "µT"], 1.0, "", 1.0),
    unit(&["mG", "gauss"], 0.1, "", 1.0),
];

/// Columns of one quantity of one source: their text, sample by sample.
pub(super) struct Columns {
    pub(super) quantity: Quantity,
    pub(super) unit: Option<Written>,
    /// The size of one count, if the values are counts.
    pub(super) count: Option<f64>,
    pub(super) cells: Vec<Vec<String>>,
}

/// How large and how fine the values of a source are.
#[derive(Clone, Copy)]
pub(super) struct Style {
    pub(super) rate_hz: f64,
    pub(super) samples: usize,
    pub(super) counts: bool,
}

impl Columns {
    pub(super) fn new(
        quantity: Quantity,
        unit: Option<Written>,
        style: Style,
        random: &mut Random,
    ) -> Self {
        let counts = style.counts
            && matches!(
                quantity,
                Quantity::Rate | Quantity::Force | Quantity::Field | Quantity::AngleIncrement
            );
        let mut columns = Self {
            quantity,
            unit,
            count: None,
            cells: vec![Vec::new(); quantity.columns()],
        };
        let size = unit.map_or(1.0, |unit| unit.size);
        let mut values = values(quantity, style, random);
        values.iter_mut().flatten().for_each(|value| *value /= size);
        let scatter = scatter(&values[0]);
        // A logger writes a fixed number of decimals, or whole counts. One step is at most a third of the noise.
        let step = match quantity {
            // All sensors of a kind have the same count.
            Quantity::Rate if counts => 1.0 / 131.0 / size,
            Quantity::Force if counts => G / 16_384.0 / size,
            Quantity::AngleIncrement if counts => 1.0 / f64::from(1 << 26) / size,
            Quantity::Field if counts => 0.15 / size,
            _ => scatter * random.log_between(0.003, 0.3),
        };
        if counts {
            columns.count = Some(step * size);
        }
        let is_scientific = !counts && random.chance(0.06);
        let decimals = (-step.log10()).ceil().clamp(0.0, 12.0) as usize;
        for (cells, values) in columns.cells.iter_mut().zip(&values) {
            let written = |value: &f64| match quantity {
                _ if counts => format!("{}", (value / step).round()),
                Quantity::Status | Quantity::Counter | Quantity::Constant => format!("{value:.0}"),
                Quantity::Label => "imu_link".into(),
                Quantity::Covariance => "0.0".into(),
                Quantity::Attitude => format!("{value:.7}"),
                Quantity::Temperature => format!("{value:.2}"),
                Quantity::Pressure => format!("{value:.1}"),
                _ if is_scientific => format!("{value:.9e}"),
                _ => format!("{value:.decimals$}"),
            };
            cells.extend(values.iter().map(written));
        }
        columns
    }

    /// The deviation of the difference of adjacent samples over √2, in deg/s or m/s² or their units over a sample, of the samples
    /// that are kept, as far as neighbours are.
    pub(super) fn deviation(&self, axis: usize, kept: &[usize]) -> f64 {
        let size = self.unit.map_or(1.0, |unit| unit.size);
        let size = self.count.map_or(size, |count| count);
        let value = |sample: usize| self.cells[axis][sample].parse::<f64>().unwrap() * size;
        let (mut sum, mut differences) = (0.0, 0);
        for pair in kept.windows(2).filter(|pair| pair[1] == pair[0] + 1) {
            sum += (value(pair[1]) - value(pair[0])).powi(2);
            differences += 1;
        }
        (sum / 2.0 / f64::from(differences)).sqrt()
    }
}

/// The unit in which a log writes a quantity. Radians and m/s² mostly go together.
pub(super) fn choose_unit(
    quantity: Quantity,
    is_metric: bool,
    random: &mut Random,
) -> Option<Written> {
    let is_usual = random.chance(0.85);
    Some(match quantity {
        Quantity::Rate if random.chance(0.06) => RATES[2 + random.below(2)],
        Quantity::Rate => RATES[usize::from(is_metric == is_usual)],
        Quantity::AngleIncrement | Quantity::Angle => ANGLES[usize::from(is_metric)],
        Quantity::Force if random.chance(0.06) => FORCES[2],
        Quantity::Force => FORCES[usize::from(is_metric == is_usual)],
        Quantity::Velocity | Quantity::VelocityIncrement => VELOCITIES[0],
        Quantity::Field => random.of(&FIELDS),
        _ => return None,
    })
}

fn scatter(values: &[f64]) -> f64 {
    let squares: f64 = values
        .windows(2)
        .map(|pair| (pair[1] - pair[0]).powi(2))
        .sum();
    (squares / 2.0 / (values.len() - 1) as f64)
        .sqrt()
        .max(1e-12)
}

/// The values of a sensor at rest, in deg and m/s and their rates.
fn values(quantity: Quantity, style: Style, random: &mut Random) -> Vec<Vec<f64>> {
    let root = style.rate_hz.sqrt();
    let interval = 1.0 / style.rate_hz;
    let noise = random.log_between(0.002, 0.05) * root;
    let bias = random.log_between(0.02, 1.5);
    let force_noise = random.log_between(5e-4, 3e-3) * root;
    let down = random.below(3);
    let mut axes = Vec::new();
    // The axes differ by at least 15 %, so that no two can be taken for one another.
    let shares = [[1.0, 1.3, 0.8], [0.8, 1.0, 1.25], [1.4, 0.8, 1.1]];
    let shares = random.of(&shares);
    for axis in 0..quantity.columns() {
        let share = *shares.get(axis).unwrap_or(&1.0);
        let offset = bias * random.between(-1.0, 1.0);
        let gravity = if axis == down {
            G
        } else {
            G * random.between(-0.02, 0.02)
        };
        let start = random.between(-1.0, 1.0);
        let mut sum = start;
        let values = (0..style.samples).map(|sample| match quantity {
            Quantity::Rate => offset + noise * share * random.normal(),
            Quantity::AngleIncrement => (offset + noise * share * random.normal()) * interval,
            Quantity::Angle => {
                sum += (offset + noise * share * random.normal()) * interval;
                sum
            }
            Quantity::Force => gravity + force_noise * share * random.normal(),
            Quantity::VelocityIncrement => {
                (gravity + force_noise * share * random.normal()) * interval
            }
            Quantity::Velocity => {
                sum += (0.01 * start + force_noise * random.normal()) * interval;
                sum
            }
            Quantity::Field => 30.0 * start + 0.4 * share * random.normal(),
            Quantity::Attitude => {
                if axis == 0 {
                    0.999 + 1e-4 * random.normal()
                } else {
                    0.02 * start + 1e-4 * random.normal()
                }
            }
            Quantity::Temperature => {
                25.0 + 3.0 * start + 2e-4 * sample as f64 + 0.02 * random.normal()
            }
            Quantity::Pressure => 101_325.0 + 3.0 * random.normal(),
            Quantity::Status => f64::from(sample % 997 == 5),
            Quantity::Counter => (sample % 65_536) as f64,
            Quantity::Constant => 3_014_666.0,
            Quantity::Label | Quantity::Covariance => 0.0,
        });
        axes.push(values.collect::<Vec<f64>>());
    }
    if quantity == Quantity::Attitude {
        for sample in 0..style.samples {
            let norm = axes
                .iter()
                .map(|axis| axis[sample].powi(2))
                .sum::<f64>()
                .sqrt();
            axes.iter_mut().for_each(|axis| axis[sample] /= norm);
        }
    }
    axes
}
