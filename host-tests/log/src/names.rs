//! Recognises times, temperatures and angles by the names of columns.

/// Whether a column is named like an angle or an orientation, which is no rate: `roll_deg`, `yaw`, `Heading [°]`,
/// `orientation.x`, `q_w`. The rates `roll_rate`, `gyro_yaw` and `pitch [deg/s]` are none.
pub(super) fn is_angle(name: &str) -> bool {
    let name = name.trim().to_lowercase();
    let angles = [
        "roll", "pitch", "yaw", "heading", "angle", "attitude", "euler", "orient", "quat",
    ];
    let rates = [
        "rate", "speed", "veloc", "gyr", "omega", "/s", "s^-1", "dps", "_vel", "_w", "per_s",
        "delta", "rad_s", "deg_s",
    ];
    let is_quaternion = || {
        let mut parts = tokens(&name);
        let (first, second, end) = (parts.next(), parts.next(), parts.next());
        let index = |text: &str| matches!(text, "w" | "x" | "y" | "z" | "0" | "1" | "2" | "3");
        first == Some("q") && second.is_some_and(index) && end.is_none()
    };
    is_quaternion()
        || (angles.iter().any(|angle| name.contains(angle))
            && !rates.iter().any(|rate| name.contains(rate)))
}

/// Whether a column is named like a time: `t`, `time_us`, `timestamp [ns]`, `header.stamp`.
pub(super) fn is_time(name: &str) -> bool {
    let name = name.trim().to_lowercase();
    if ["relative", "delta", "zone", "offset"]
        .iter()
        .any(|other| name.contains(other))
    {
        return false;
    }
    let first = tokens(&name).next().unwrap_or_default();
    ["time", "stamp", "zeit", "elapsed", "epoch", "gps seconds", "gps_seconds"]
        .iter()
        .any(|word| name.contains(word))
        || first == "t"
        // The time of the week of GPS.
        || first == "tow"
        || TimeUnit::of_token(first).is_some()
}

/// Whether a column is named like something that is neither a time nor an axis: an index, a date, an angle, a
/// temperature, or another quantity of a navigation log.
pub(super) fn is_other(name: &str) -> bool {
    let name = name.trim().to_lowercase();
    let words = [
        "date",
        "index",
        "temp",
        "sample",
        "seq",
        "latitude",
        "longitude",
        "altitude",
        "pressure",
        "voltage",
        "magn",
        "baro",
        "battery",
        "satellite",
        "packet",
        "iteration",
        "status",
        "counter",
        "device",
    ];
    let first = tokens(&name).next().unwrap_or_default();
    words.iter().any(|word| name.contains(word))
        || [
            "i", "n", "id", "mx", "my", "mz", "mag", "magx", "magy", "magz", "lat", "lon", "alt",
        ]
        .contains(&first)
        || is_angle(&name)
        || is_velocity(&name)
}

/// Whether a column is named like a velocity or its increment: `vel_x`, `vx`, `delta_velocity[0]`, `dv_y`, `Z_DELTVEL`. The
/// velocity of an angle is none.
fn is_velocity(name: &str) -> bool {
    let name = name.to_lowercase();
    let turns = ["ang", "rot", "turn", "gyr", "omega", "roll", "pitch", "yaw"];
    let is_short = |token: &str| {
        matches!(
            token,
            "v" | "vx" | "vy" | "vz" | "dv" | "dvx" | "dvy" | "dvz"
        )
    };
    !turns.iter().any(|turn| name.contains(turn))
        && (["veloc", "deltav", "deltvel", "dvel"]
            .iter()
            .any(|word| name.contains(word))
            || tokens(&name).any(|token| token.starts_with("vel") || is_short(token)))
}

/// Whether a column is named like a number that tells sensors apart: `I`, `instance`, `SensorId`, `device_id`, `imu`.
pub(super) fn is_source(name: &str) -> bool {
    let name = name.trim().to_lowercase();
    let plain: String = name.chars().filter(|c| c.is_alphanumeric()).collect();
    let words = [
        "i", "id", "instance", "sensor", "device", "imu", "channel", "source", "unit", "node",
        "board", "port", "address",
    ];
    let things = [
        "sensor", "device", "imu", "gyro", "node", "board", "source", "unit", "chip",
    ];
    let suffixes = ["id", "no", "nr", "number", "index", "idx"];
    words.contains(&plain.as_str())
        || suffixes.iter().any(|suffix| {
            let thing = plain.strip_suffix(suffix);
            thing.is_some_and(|thing| things.contains(&thing))
        })
}

/// Whether a column is named like an increment of an angle since the sample before: `dtheta_x`, `delta_angle[0]`, `X_DELTANG`.
pub(super) fn is_increment(name: &str) -> bool {
    let name = name.trim().to_lowercase();
    let plain: String = name.chars().filter(|c| c.is_alphanumeric()).collect();
    [
        "deltaangle",
        "deltaang",
        "deltang",
        "dtheta",
        "deltatheta",
        "dangle",
        "dangx",
        "dangy",
        "dangz",
        "angleincrement",
        "incrementofangle",
    ]
    .iter()
    .any(|word| plain.contains(word))
}

/// Whether a column is named like a temperature: `temp_C`, `gyro.temperature`, `IMUTemp`, `t [°C]`.
pub fn is_temperature(name: &str) -> bool {
    let text = name.trim().to_lowercase();
    let others = ["attempt", "template", "temporal", "tempo_"];
    let is_other = others.iter().any(|other| text.contains(other));
    let is_of_unit = in_brackets(name).is_some_and(|(_, unit)| is_degrees(unit));
    (text.contains("temp") && !is_other) || is_of_unit || text.contains("celsius")
}

/// Whether a column's name tells that its values are degrees Celsius or kelvins: `temp_C`, `t [K]`.
pub fn is_degrees_column(name: &str) -> bool {
    let in_brackets = in_brackets(name).map(|(_, unit)| unit);
    let last = tokens(name).last();
    in_brackets.or(last).is_some_and(is_degrees)
}

/// Whether a text is a unit of temperature whose steps are kelvins.
pub(super) fn is_degrees(unit: &str) -> bool {
    let unit = unit.trim().to_lowercase();
    [
        "c", "k", "°c", "degc", "deg c", "deg_c", "celsius", "kelvin",
    ]
    .contains(&unit.as_str())
}

pub(super) fn tokens(name: &str) -> impl Iterator<Item = &str> {
    name.split(|c: char| !c.is_alphanumeric())
        .filter(|token| !token.is_empty())
}

/// The name without the unit in brackets at its end: `gx` for `gx [deg/s]`. An index such as the
/// one in `gyro_rad[0]` belongs to the name.
pub(super) fn bare(name: &str) -> &str {
    match in_brackets(name) {
        Some((bare, _)) if !bare.is_empty() => bare,
        _ => name.trim(),
    }
}

/// The name and the text in brackets at its end, unless that text is an index.
pub(super) fn in_brackets(name: &str) -> Option<(&str, &str)> {
    let name = name.trim();
    let open = name.rfind(['[', '('])?;
    let inner = name[open + 1..].strip_suffix([']', ')'])?.trim();
    let is_index = inner.parse::<u32>().is_ok();
    (!is_index && !inner.is_empty()).then(|| (name[..open].trim(), inner))
}

/// Words in brackets behind the name of a time that are no units.
const ZONES: [&str; 6] = ["utc", "gmt", "gps", "local", "unix", "epoch"];

/// Units at the end of a time's name that are not those of time stamps in this program.
const FOREIGN_TIMES: [&str; 14] = [
    "min", "mins", "minute", "minutes", "h", "hr", "hrs", "hour", "hours", "day", "days", "ticks",
    "cycles", "jiffies",
];

/// The unit of time stamps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum TimeUnit {
    /// Seconds.
    S,
    /// Milliseconds.
    Ms,
    /// Microseconds.
    Us,
    /// Nanoseconds.
    Ns,
}

impl TimeUnit {
    pub(super) const ALL: [Self; 4] = [Self::S, Self::Ms, Self::Us, Self::Ns];

    /// The number of these units in a second.
    pub(super) const fn per_second(self) -> f64 {
        match self {
            Self::S => 1.0,
            Self::Ms => 1e3,
            Self::Us => 1e6,
            Self::Ns => 1e9,
        }
    }

    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::S => "s",
            Self::Ms => "ms",
            Self::Us => "µs",
            Self::Ns => "ns",
        }
    }

    /// The unit at the end of a column's name: `timestamp [ns]`, `time_us`, `TimeUS`, `t (s)`. A name
    /// without a unit gives `None`.
    ///
    /// # Errors
    /// The text of a unit that is told but not known, such as `min` or `10us`.
    pub(super) fn of_name(name: &str) -> Result<Option<Self>, String> {
        if let Some((_, unit)) = in_brackets(name) {
            let text = unit.to_lowercase();
            return match Self::of_token(&text) {
                None if !ZONES.contains(&text.as_str()) => Err(unit.to_owned()),
                unit => Ok(unit),
            };
        }
        let name = name.to_lowercase();
        let Some(last) = tokens(&name).last() else {
            return Ok(None);
        };
        let glued = ["timestamp", "time", "stamp"]
            .iter()
            .find_map(|word| last.strip_prefix(word));
        let text = glued.unwrap_or(last);
        let digits = text.trim_start_matches(|c: char| c.is_ascii_digit());
        let is_multiple = digits.len() < text.len() && Self::of_token(digits).is_some();
        match Self::of_token(text) {
            None if is_multiple || FOREIGN_TIMES.contains(&text) => Err(text.to_owned()),
            unit => Ok(unit),
        }
    }

    pub(super) fn of_token(token: &str) -> Option<Self> {
        Some(match token {
            "s" | "sec" | "secs" | "second" | "seconds" => Self::S,
            "ms" | "msec" | "msecs" | "millis" | "millisecond" | "milliseconds" => Self::Ms,
            "us" | "µs" | "μs" | "usec" | "usecs" | "micros" | "microsecond" | "microseconds" => {
                Self::Us
            }
            "ns" | "nsec" | "nsecs" | "nanos" | "nanosec" | "nanosecond" | "nanoseconds" => {
                Self::Ns
            }
            _ => return None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_times_are_known_with_their_units() {
        for (name, unit) in [
            ("timestamp [ns]", Some(TimeUnit::Ns)),
            ("#timestamp [ns]", Some(TimeUnit::Ns)),
            ("time_us", Some(TimeUnit::Us)),
            ("TimeUS", Some(TimeUnit::Us)),
            ("Time (sec)", Some(TimeUnit::S)),
            ("t_s", Some(TimeUnit::S)),
            ("ms", Some(TimeUnit::Ms)),
            ("t", None),
            ("field.header.stamp", None),
            ("%time", None),
            ("timestamp", None),
        ] {
            assert!(is_time(name), "{name}");
            assert_eq!(TimeUnit::of_name(name), Ok(unit), "{name}");
        }
        for (name, unit) in [
            ("t [min]", "min"),
            ("time_10us", "10us"),
            ("time100ns", "100ns"),
            ("time (h)", "h"),
            ("time_minutes", "minutes"),
        ] {
            assert_eq!(TimeUnit::of_name(name), Err(unit.into()), "{name}");
        }
        for name in [
            "temp_C",
            "gx",
            "accelerometer_timestamp_relative",
            "delta_time",
        ] {
            assert!(!is_time(name), "{name}");
        }
    }

    #[test]
    fn angles_are_no_rates() {
        for name in [
            "roll_deg",
            "Yaw",
            "Heading [°]",
            "pitch (rad)",
            "orientation.x",
            "q_w",
            "q[0]",
            "Euler_Y",
        ] {
            assert!(is_angle(name) && is_other(name), "{name}");
        }
        for name in [
            "vel_x",
            "velocity.y",
            "vz",
            "delta_velocity[0]",
            "dv_y",
            "Z_DELTVEL",
            "deltaVelX_mps",
        ] {
            assert!(is_other(name), "{name}");
        }
        for name in ["ang_vel_x", "angular_velocity.y", "value", "v1", "level"] {
            assert!(!is_other(name), "{name}");
        }
        for name in [
            "roll_rate",
            "rollspeed",
            "gyro_yaw",
            "pitch [deg/s]",
            "gx",
            "delta_angle[0]",
            "q",
        ] {
            assert!(!is_angle(name), "{name}");
        }
    }

    #[test]
    fn temperatures_are_known_by_name_or_unit() {
        for name in [
            "temp_C",
            "temperature",
            "gyro.temperature",
            "IMUTemp",
            "t1 [°C]",
        ] {
            assert!(is_temperature(name), "{name}");
        }
        assert!(is_degrees_column("temp_C") && is_degrees_column("t [°C]"));
        assert!(!is_degrees_column("temperature") && !is_degrees_column("temp_F"));
        for name in ["attempts", "t", "gx [deg/s]", "template_id", "t [s]"] {
            assert!(!is_temperature(name), "{name}");
        }
    }

    #[test]
    fn brackets_are_cut_off_and_indices_are_not() {
        for (name, expected) in [
            ("w_RS_S_x [rad s^-1]", "w_RS_S_x"),
            ("gyro_rad[0]", "gyro_rad[0]"),
            ("[gx]", "[gx]"),
            (" gx ", "gx"),
        ] {
            assert_eq!(bare(name), expected);
        }
    }
}
