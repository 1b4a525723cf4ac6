//! A log in a layout that is drawn at random, with what is true of it.

use super::{
    glue::Glue,
    names::{Namer, UnitStyle},
    quantity::{Columns, Quantity, Style, choose_unit},
    random::Random,
    stamp::{Manner, Stamps},
};

/// How the sources and quantities of a log are arranged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Kind {
    /// One source, all quantities in each row.
    Single,
    /// One source whose gyro writes increments of an angle.
    Increments,
    /// One source without a gyro.
    Forces,
    /// One source that writes angles, and no rates.
    Angles,
    /// Two or three devices whose columns stand side by side.
    Twins,
    /// The sensors of one device in rows of their own, marked by a tag.
    Tags,
    /// The sensors of one device in rows of their own, in columns of their own.
    Sparse,
    /// Several devices in rows of their own, marked by an id.
    Devices,
    /// One value in a row.
    Melted,
    /// Several devices in rows of their own, without a mark.
    Keyless,
}

/// How the names and units stand above the rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Header {
    /// Quantity, unit and unit of time.
    Full,
    /// Names, but not all units.
    Names,
    /// No header.
    Bare,
}

/// The axes of one source, and how they are asked for.
pub(super) struct Source {
    /// The value of the column that marks the rows of this source.
    pub(super) id: String,
    /// White noise by axis, in deg/s/√Hz or m/s²/√Hz.
    pub(super) noise: Vec<f64>,
    /// The columns of the axes, from 1.
    pub(super) columns: Vec<usize>,
    pub(super) rate_hz: f64,
    pub(super) unit: &'static str,
    pub(super) scale: f64,
}

/// A log and what is true of it.
pub(super) struct Layout {
    pub(super) kind: Kind,
    pub(super) header: Header,
    pub(super) text: String,
    /// All sources of the sensor that is read if nothing is said.
    pub(super) sources: Vec<Source>,
    /// The column that marks the source, from 1, and its name.
    pub(super) key: Option<(usize, String)>,
    /// The column of the stamps, from 1, and the unit of the stamps.
    pub(super) time: Option<usize>,
    pub(super) time_unit: Option<&'static str>,
    /// Whether only a refusal is right.
    pub(super) is_unreadable: bool,
    /// The relative error that stamps and losses leave in the rate, and in the noise.
    pub(super) rate_error: f64,
    pub(super) noise_error: f64,
    /// What was drawn, in words.
    pub(super) drawn: String,
}

const RATES: [f64; 36] = [
    20.0, 25.0, 31.25, 50.0, 52.0, 59.5, 60.0, 75.0, 100.0, 104.0, 119.0, 120.0, 125.0, 128.0,
    148.5, 200.0, 208.0, 225.0, 238.0, 250.0, 256.0, 400.0, 416.0, 476.0, 500.0, 512.0, 562.5,
    800.0, 833.0, 952.0, 1000.0, 1125.0, 1600.0, 3200.0, 4000.0, 8000.0,
];

/// A part of the log: the columns of one device or of one sensor, and the rows that were kept.
struct Part {
    id: String,
    columns: Vec<Columns>,
    rate_hz: f64,
    kept: Vec<usize>,
    moments_ns: Vec<u64>,
}

/// The order in which the rows of several parts are written.
#[derive(Clone, Copy, Debug)]
enum Order {
    ByTime,
    Blocks(usize),
    Whole,
}

impl Layout {
    /// The layout of a seed.
    pub(super) fn new(seed: u64) -> Self {
        let mut random = Random::new(seed);
        let random = &mut random;
        let kind = match random.below(100) {
            0..44 => Kind::Single,
            44..52 => Kind::Increments,
            52..57 => Kind::Forces,
            57..60 => Kind::Angles,
            60..65 => Kind::Twins,
            65..76 => Kind::Tags,
            76..81 => Kind::Sparse,
            81..94 => Kind::Devices,
            94..97 => Kind::Melted,
            _ => Kind::Keyless,
        };
        let has_header = random.chance(0.7);
        let style = match random.below(8) {
            _ if !has_header => UnitStyle::None,
            0 | 1 => UnitStyle::Round,
            2 => UnitStyle::Square,
            3 => UnitStyle::Tight,
            4 => UnitStyle::Word,
            5 => UnitStyle::Row,
            _ => UnitStyle::None,
        };
        let mut rate_hz = random.of(&RATES);
        if random.chance(0.3) {
            rate_hz *= 1.0 + 0.004 * random.normal();
        }
        let stamps = Stamps::new(rate_hz, has_header, random);
        let parts = parts(kind, rate_hz, random);
        Written::new(kind, has_header, style, stamps, parts, random).layout()
    }
}

/// The quantities of a source, in the order of their columns.
fn quantities(kind: Kind, random: &mut Random) -> Vec<Quantity> {
    use Quantity::*;
    let sets: &[&[Quantity]] = match kind {
        Kind::Increments => &[
            &[AngleIncrement],
            &[AngleIncrement, VelocityIncrement],
            &[VelocityIncrement, AngleIncrement],
            &[AngleIncrement, Force],
            &[Counter, AngleIncrement, VelocityIncrement, Temperature],
        ],
        Kind::Forces => &[
            &[Force],
            &[Force, Field],
            &[Force, Temperature],
            &[Counter, Force],
        ],
        Kind::Angles => &[&[Angle], &[Attitude, Angle], &[Angle, Velocity]],
        Kind::Devices | Kind::Twins | Kind::Keyless => &[
            &[Rate],
            &[Rate, Force],
            &[Force, Rate],
            &[Rate, Temperature],
        ],
        _ => &[
            &[Rate],
            &[Rate],
            &[Rate, Force],
            &[Rate, Force],
            &[Force, Rate],
            &[Force, Rate],
            &[Force, Rate, Field],
            &[Rate, Force, Field],
            &[Attitude, Rate, Force],
            &[Rate, Force, Attitude],
            &[Angle, Rate, Force],
            &[Force, Rate, Angle],
            &[Force, Rate, Temperature],
            &[Temperature, Rate, Force],
            &[Rate, Temperature],
            &[Rate, Velocity],
            &[Velocity, Angle, Rate],
            &[Rate, AngleIncrement],
            &[Rate, AngleIncrement, Force, VelocityIncrement],
            &[Counter, Rate],
            &[Counter, Force, Rate, Temperature],
            &[Status, Rate, Force],
            &[Force, Rate, Status],
            &[Rate, Pressure, Temperature],
            &[Counter, Rate, Force, Field, Temperature, Pressure, Status],
            &[
                Label, Attitude, Covariance, Rate, Covariance, Force, Covariance,
            ],
            &[Constant, Rate, Temperature, Status],
            &[Constant, Rate, Force],
            &[Rate, Force, Label],
        ],
    };
    random.of(sets).to_vec()
}

/// Ids of devices, from which some follow one another.
fn ids(random: &mut Random) -> [&'static str; 3] {
    random.of(&[
        ["1", "2", "3"],
        ["0", "1", "2"],
        ["17", "42", "99"],
        ["0x68", "0x69", "0x6A"],
        ["left", "right", "pelvis"],
        [
            "D4:22:CD:00:12:34",
            "D4:22:CD:00:12:35",
            "D4:22:CD:00:13:01",
        ],
        ["00B42D4F", "00B42D50", "00B42D63"],
        ["imu0", "imu1", "imu2"],
        ["SN-1041", "SN-1042", "SN-1050"],
        ["a", "b", "c"],
        ["foot_l", "foot_r", "chest"],
        ["104", "104.5", "107"],
    ])
}

/// Tags of a gyro, an accelerometer and a magnetometer.
fn tags(random: &mut Random) -> [&'static str; 3] {
    random.of(&[
        ["GYR", "ACC", "MAG"],
        ["gyro", "acc", "mag"],
        ["gyroscope", "accelerometer", "magnetometer"],
        ["G", "A", "M"],
        ["4", "1", "2"],
        ["GYRO", "ACCL", "MAGN"],
        [
            "android.sensor.gyroscope",
            "android.sensor.accelerometer",
            "android.sensor.magnetic_field",
        ],
        ["Gyroscope", "Accelerometer", "Magnetometer"],
        ["0x02", "0x01", "0x03"],
        ["imu_gyr", "imu_acc", "imu_mag"],
    ])
}

fn parts(kind: Kind, rate_hz: f64, random: &mut Random) -> Vec<Part> {
    let is_apart = matches!(kind, Kind::Tags | Kind::Sparse);
    let devices = match kind {
        Kind::Devices | Kind::Twins | Kind::Keyless => 2 + usize::from(random.chance(0.3)),
        _ if is_apart => 2 + usize::from(random.chance(0.4)),
        _ => 1,
    };
    let samples = 2000 + random.below(2000);
    let is_metric = random.chance(0.5);
    let counts = random.chance(0.12);
    let set = if is_apart {
        vec![Quantity::Rate, Quantity::Force, Quantity::Field]
    } else {
        quantities(kind, random)
    };
    let set: Vec<_> = set
        .into_iter()
        .map(|quantity| (quantity, choose_unit(quantity, is_metric, random)))
        .collect();
    let names = if is_apart { tags(random) } else { ids(random) };
    let other_rate = random.chance(0.2) && kind != Kind::Twins;
    let loss = random.below(10);
    let jitter = random.of(&[0.0, 0.0, 0.0, 0.0, 0.01, 0.05]);
    let is_in_step = random.chance(0.5);
    let mut parts = Vec::new();
    for device in 0..devices {
        let factor = if device > 0 && other_rate { 0.5 } else { 1.0 };
        let style = Style {
            rate_hz: rate_hz * factor,
            samples: (samples as f64 * factor) as usize,
            counts,
        };
        let set = if is_apart {
            &set[device..=device]
        } else {
            &set[..]
        };
        let columns = set
            .iter()
            .map(|&(quantity, unit)| Columns::new(quantity, unit, style, random))
            .collect();
        let kept = kept(
            style.samples,
            if kind == Kind::Twins { 9 } else { loss },
            random,
        );
        let interval_ns = 1e9 / style.rate_hz;
        let late = if is_in_step {
            0.0
        } else {
            interval_ns * 0.3 * device as f64
        };
        let moments_ns = (0..style.samples)
            .map(|sample| {
                let jitter = jitter * random.normal().clamp(-3.0, 3.0);
                (interval_ns * (sample as f64 + 0.2 + jitter) + late).max(0.0) as u64
            })
            .collect();
        parts.push(Part {
            id: names[device].into(),
            columns,
            rate_hz: style.rate_hz,
            kept,
            moments_ns,
        });
    }
    parts
}

/// The samples that were not lost.
fn kept(samples: usize, loss: usize, random: &mut Random) -> Vec<usize> {
    let mut is_kept = vec![true; samples];
    match loss {
        0 => is_kept
            .iter_mut()
            .skip(20)
            .for_each(|kept| *kept = !random.chance(0.002)),
        1 => {
            for _ in 0..3 {
                let (start, length) = (20 + random.below(samples - 100), 2 + random.below(40));
                is_kept[start..start + length].fill(false);
            }
        }
        _ => {}
    }
    (0..samples).filter(|sample| is_kept[*sample]).collect()
}

/// What the rows are written from.
struct Written {
    kind: Kind,
    has_header: bool,
    style: UnitStyle,
    stamps: Stamps,
    parts: Vec<Part>,
    separator: &'static str,
    decimal_comma: bool,
    glue: Glue,
    order: Order,
    /// Where the column of the source stands: in front, behind the stamps, or at the end.
    key_place: usize,
    key_name: &'static str,
    has_index: bool,
    preamble: usize,
    line_end: &'static str,
    names: Vec<String>,
    below: Vec<String>,
    /// The first column of each quantity of the first part, from 0, without index, stamps and key.
    firsts: Vec<usize>,
}

impl Written {
    fn new(
        kind: Kind,
        has_header: bool,
        style: UnitStyle,
        stamps: Stamps,
        parts: Vec<Part>,
        random: &mut Random,
    ) -> Self {
        // Counts have no unit.
        let has_counts = parts
            .iter()
            .flat_map(|part| &part.columns)
            .any(|columns| columns.count.is_some());
        let style = if has_counts { UnitStyle::None } else { style };
        let glue = match kind {
            Kind::Single | Kind::Increments | Kind::Forces => {
                Glue::new(stamps.manner, has_header, random)
            }
            _ => Glue::None,
        };
        let is_dated = matches!(stamps.manner, Manner::Date(' ', ..));
        let mut separator = random.of(&[",", ",", ",", ",", ", ", ";", "\t", " ", "  "]);
        if separator.starts_with(' ')
            && (is_dated || kind == Kind::Sparse || glue == Glue::CommaBehind)
        {
            separator = ",";
        }
        if separator == ";" && glue == Glue::SemicolonBehind {
            separator = ",";
        }
        if glue == Glue::Quotes && separator == ", " {
            separator = ",";
        }
        // Firmware does not write decimal commas.
        let is_plain = matches!(glue, Glue::None | Glue::Quotes);
        let decimal_comma = is_plain && [";", "\t"].contains(&separator) && random.chance(0.3);
        let order = match random.below(6) {
            0..4 => Order::ByTime,
            4 => Order::Blocks(random.of(&[2, 8, 25, 32])),
            _ => Order::Whole,
        };
        let key_names: &[&str] = match kind {
            Kind::Tags => &["sensor", "type", "tag", "name", "kind", "sensor_type"],
            _ => &[
                "SensorId", "id", "device", "sensor", "imu", "addr", "mac", "node", "source",
                "dev_id",
            ],
        };
        let mut stamps = stamps;
        if separator.starts_with(' ') {
            stamps
                .names
                .iter_mut()
                .for_each(|name| *name = name.replace(' ', "_"));
        }
        let mut written = Self {
            kind,
            has_header,
            style,
            stamps,
            parts,
            separator,
            decimal_comma,
            glue,
            order,
            key_place: random.below(3),
            key_name: random.of(key_names),
            has_index: has_header && separator == "," && random.chance(0.08),
            preamble: if has_header && !glue.has_time() && random.chance(0.12) {
                1 + random.below(3)
            } else {
                0
            },
            line_end: if random.chance(0.15) { "\r\n" } else { "\n" },
            names: Vec::new(),
            below: Vec::new(),
            firsts: Vec::new(),
        };
        written.name(random);
        written
    }

    /// Names the columns of values.
    fn name(&mut self, random: &mut Random) {
        let is_metric = self
            .parts
            .iter()
            .flat_map(|part| &part.columns)
            .all(|columns| {
                columns.count.is_none()
                    && columns.unit.is_none_or(|unit| {
                        !matches!(unit.option, "deg/s" | "g") && unit.scale == 1.0
                    })
            });
        let namer = Namer::new(self.style, is_metric, random);
        let mut column = 0;
        let mut first: Vec<(Vec<String>, String)> = Vec::new();
        for (number, part) in self.parts.iter().enumerate() {
            for (place, columns) in part.columns.iter().enumerate() {
                // Devices of one make have the same names.
                let (mut names, below) = if number > 0 && self.kind != Kind::Sparse {
                    first[place].clone()
                } else {
                    namer.names(columns.quantity, columns.unit, random)
                };
                if number == 0 {
                    first.push((names.clone(), below.clone()));
                }
                if self.kind == Kind::Twins {
                    let prefix = ["imu0_", "imu1_", "imu2_"][number];
                    names.iter_mut().for_each(|name| name.insert_str(0, prefix));
                }
                if number == 0 {
                    self.firsts.push(column);
                }
                column += names.len();
                if self.separator.starts_with(' ') {
                    names
                        .iter_mut()
                        .for_each(|name| *name = name.replace(' ', "_"));
                }
                if number > 0 && matches!(self.kind, Kind::Devices | Kind::Keyless | Kind::Tags) {
                    continue;
                }
                let below = vec![below; names.len()];
                self.names.extend(names);
                self.below.extend(below);
            }
        }
        match self.kind {
            Kind::Tags => {
                let plain = [
                    ["x", "y", "z"],
                    ["X", "Y", "Z"],
                    ["value0", "value1", "value2"],
                    ["v1", "v2", "v3"],
                ];
                self.names = random.of(&plain).map(String::from).to_vec();
                self.below = vec![String::new(); 3];
            }
            Kind::Melted => {
                self.names = vec!["value".into()];
                self.below = vec![String::new()];
            }
            _ => {}
        }
    }

    fn has_key(&self) -> bool {
        matches!(self.kind, Kind::Tags | Kind::Devices | Kind::Melted)
    }

    /// The columns in front of the values.
    fn in_front(&self) -> usize {
        self.before_stamps()
            + self.stamps.columns()
            + usize::from(self.has_key() && self.key_place == 1)
    }

    /// The columns in front of the stamps.
    fn before_stamps(&self) -> usize {
        usize::from(self.has_index)
            + usize::from(self.glue == Glue::Nmea || self.glue.has_time())
            + usize::from(self.has_key() && self.key_place == 0)
    }

    /// A row of all columns: stamps and key stand where they are wanted.
    fn row(&self, index: &str, stamps: Vec<String>, key: &str, values: Vec<String>) -> Vec<String> {
        let mut row = if self.has_index {
            vec![index.to_owned()]
        } else {
            Vec::new()
        };
        if self.has_key() && self.key_place == 0 {
            row.push(key.into());
        }
        row.extend(stamps);
        if self.has_key() && self.key_place == 1 {
            row.push(key.into());
        }
        row.extend(values);
        if self.has_key() && self.key_place == 2 {
            row.push(key.into());
        }
        row
    }

    /// The moments of all rows in their order: part and sample.
    fn rows(&self) -> Vec<(usize, usize)> {
        let mut rows: Vec<(usize, usize)> = Vec::new();
        for (number, part) in self.parts.iter().enumerate() {
            rows.extend(part.kept.iter().map(|sample| (number, *sample)));
        }
        if self.kind == Kind::Twins {
            rows.retain(|(part, _)| *part == 0);
        }
        match self.order {
            Order::ByTime => {
                rows.sort_by_key(|&(part, sample)| (self.parts[part].moments_ns[sample], part));
            }
            Order::Blocks(length) => rows.sort_by_key(|&(part, sample)| {
                let factor = self.parts[0].rate_hz / self.parts[part].rate_hz;
                ((sample as f64 * factor) as usize / length, part, sample)
            }),
            Order::Whole => {}
        }
        rows
    }

    fn values(&self, part: usize, sample: usize) -> Vec<String> {
        let cells = |columns: &Columns| -> Vec<String> {
            columns
                .cells
                .iter()
                .map(|cells| cells[sample].clone())
                .collect()
        };
        let parts: Vec<usize> = match self.kind {
            Kind::Twins | Kind::Sparse => (0..self.parts.len()).collect(),
            _ => vec![part],
        };
        let is_empty = |number: usize| self.kind == Kind::Sparse && number != part;
        let mut values = Vec::new();
        for number in parts {
            for columns in &self.parts[number].columns {
                if is_empty(number) {
                    values.extend(vec![String::new(); columns.cells.len()]);
                } else {
                    values.extend(cells(columns));
                }
            }
        }
        values
    }

    fn text(&self) -> String {
        let mut lines: Vec<String> = ["Logger v2.31", "Range: 2000 dps, 16 g", "Session 7"]
            [..self.preamble]
            .iter()
            .map(|line| format!("# {line}"))
            .collect();
        if self.has_header {
            let names = self.row(
                "",
                self.stamps.names.clone(),
                self.key_name,
                self.names.clone(),
            );
            lines.push(self.glue.header(&names, self.separator));
            if self.style == UnitStyle::Row {
                let mut units = vec![self.stamps.below.clone()];
                units.resize(self.stamps.columns(), String::new());
                let units = self.row("", units, "", self.below.clone());
                let is_known = self.below.iter().any(|unit| !unit.is_empty());
                if is_known && !self.separator.starts_with(' ') {
                    lines.push(self.glue.header(&units, self.separator));
                }
            }
        }
        for (index, (part, sample)) in self.rows().into_iter().enumerate() {
            let moment = self.parts[part].moments_ns[sample];
            let stamps = self.stamps.written(moment);
            let mut push = |key: &str, values: Vec<String>| {
                let mut row = self.row(&index.to_string(), stamps.clone(), key, values);
                if self.decimal_comma {
                    row.iter_mut()
                        .filter(|cell| !cell.contains(':'))
                        .for_each(|cell| {
                            *cell = cell.replace('.', ",");
                        });
                }
                lines.push(self.glue.around(&row, self.separator, moment));
            };
            let values = self.values(part, sample);
            if self.kind == Kind::Melted {
                for (value, name) in values.into_iter().zip(self.melted()) {
                    push(&name, vec![value]);
                }
            } else {
                push(&self.parts[part].id, values);
            }
        }
        lines.push(String::new());
        lines.join(self.line_end)
    }

    /// What marks the rows of a log of one value in a row.
    fn melted(&self) -> Vec<String> {
        let mut names = Vec::new();
        for columns in &self.parts[0].columns {
            let word = match columns.quantity {
                Quantity::Rate => "gyro",
                Quantity::Force => "acc",
                Quantity::Field => "mag",
                Quantity::Angle => "euler",
                Quantity::Velocity => "vel",
                Quantity::Attitude => "quat",
                Quantity::AngleIncrement => "dtheta",
                Quantity::VelocityIncrement => "dvel",
                Quantity::Temperature => "temp",
                Quantity::Pressure => "baro",
                Quantity::Status => "status",
                Quantity::Counter => "seq",
                Quantity::Constant => "device",
                Quantity::Label | Quantity::Covariance => "other",
            };
            let axes = ["_x", "_y", "_z", "_w"].map(|axis| format!("{word}{axis}"));
            names.extend(axes.into_iter().take(columns.cells.len()));
        }
        names
    }

    /// The sensor that is read: the gyro, or the accelerometer of a log without one.
    fn is_read(&self, quantity: Quantity) -> bool {
        match self.kind {
            Kind::Increments => quantity == Quantity::AngleIncrement,
            Kind::Forces => quantity == Quantity::Force,
            _ => quantity == Quantity::Rate,
        }
    }

    fn sources(&self) -> Vec<Source> {
        let in_front = self.in_front();
        let mut sources = Vec::new();
        let mut side = 0;
        for part in &self.parts {
            let width: usize = part.columns.iter().map(|columns| columns.cells.len()).sum();
            for (number, columns) in part.columns.iter().enumerate() {
                if !self.is_read(columns.quantity) {
                    continue;
                }
                let unit = columns.unit.unwrap();
                let of_option = match unit.option {
                    "rad/s" => 180.0 / std::f64::consts::PI,
                    "g" => 9.80665,
                    _ => 1.0,
                };
                let mut scale = columns.count.unwrap_or(unit.size) / of_option;
                let mut per_root = part.rate_hz.sqrt();
                if columns.quantity == Quantity::AngleIncrement {
                    scale *= part.rate_hz;
                    per_root = 1.0 / per_root;
                }
                let noise = |axis| columns.deviation(axis, &part.kept) / per_root;
                let first = in_front + side + self.firsts.get(number).copied().unwrap_or(0) + 1;
                sources.push(Source {
                    id: part.id.clone(),
                    noise: (0..3).map(noise).collect(),
                    columns: (first..first + 3).collect(),
                    rate_hz: part.rate_hz,
                    unit: unit.option,
                    scale,
                });
            }
            if self.kind == Kind::Twins {
                side += width;
            }
        }
        if self.kind == Kind::Melted {
            let source = sources.remove(0);
            let names = self.melted();
            let first = self.firsts[self.parts[0]
                .columns
                .iter()
                .position(|columns| self.is_read(columns.quantity))
                .unwrap()];
            let one = |axis: usize| Source {
                id: names[first + axis].clone(),
                noise: vec![source.noise[axis]],
                columns: vec![in_front + 1],
                ..source
            };
            return (0..3).map(one).collect();
        }
        sources
    }

    fn layout(self) -> Layout {
        let sources = self.sources();
        let text = self.text();
        let is_row_of_blanks = self.style == UnitStyle::Row && self.separator.starts_with(' ');
        let has_unit = self.style != UnitStyle::None && !is_row_of_blanks;
        let has_counts = self.parts[0]
            .columns
            .iter()
            .any(|columns| columns.count.is_some());
        let is_full = has_unit
            && (self.stamps.is_told
                || self.style == UnitStyle::Row && !self.stamps.below.is_empty())
            && self.stamps.manner != Manner::None
            && !has_counts
            && !matches!(self.kind, Kind::Tags | Kind::Melted);
        let header = match (self.has_header, is_full) {
            (false, _) => Header::Bare,
            (true, true) => Header::Full,
            (true, false) => Header::Names,
        };
        let rate_hz = self.parts[0].rate_hz;
        let rows = self.parts[0].moments_ns.len() as f64;
        let resolution = if self.glue.has_time() {
            1e-3
        } else {
            self.stamps.resolution()
        };
        let rate_error = 1e-3_f64.max(2.0 * resolution * rate_hz / rows);
        let is_lossy = self.parts[0].kept.len() < self.parts[0].moments_ns.len();
        let before = self.before_stamps();
        let key = self.has_key().then(|| {
            let place = match self.key_place {
                0 => usize::from(self.has_index) + 1,
                1 => before + self.stamps.columns() + 1,
                _ => self.in_front() + self.names.len() + 1,
            };
            (
                place,
                if self.has_header {
                    self.key_name.to_owned()
                } else {
                    String::new()
                },
            )
        });
        let drawn = format!(
            "{:?} {:?} {:?} at {rate_hz:.3} Hz, {:?}, {:?}, {:?}, {:?}{}",
            self.kind,
            header,
            self.style,
            self.stamps.manner,
            self.glue,
            self.order,
            self.parts[0]
                .columns
                .iter()
                .map(|columns| columns.quantity)
                .collect::<Vec<_>>(),
            if has_counts { ", counts" } else { "" },
        );
        Layout {
            kind: self.kind,
            header,
            text,
            is_unreadable: matches!(self.kind, Kind::Angles | Kind::Keyless),
            sources,
            key,
            time: match self.stamps.manner {
                Manner::None
                | Manner::Whole {
                    per_second: 32_768 | 10_000,
                    ..
                } => None,
                Manner::Week(_) | Manner::TwoColumns(_) => Some(before + 2),
                _ => Some(before + 1),
            },
            time_unit: self.stamps.time_unit(),
            rate_error,
            noise_error: if is_lossy { 0.03 } else { 0.01 } + rate_error,
            drawn,
        }
    }
}
