//! Recognises units in the names of columns, and rows of units below the names.

use super::names::{TimeUnit, in_brackets, is_degrees, tokens};
use crate::unit::Unit;

/// A unit of another quantity, or an unusual one, in the name of a column: its text.
pub(super) type UnknownUnit = String;

/// The unit in an axis' name, and the factor from a value to that unit: `w_RS_S_x [rad s^-1]`, `gx
/// (deg/s)`, `gyro_x_mdps`, `accelerometer_m_s2[0]`. A name without a unit gives `None`.
///
/// # Errors
/// The text of a unit that is told but not known, such as `rpm`.
pub(super) fn unit(name: &str) -> Result<Option<(Unit, f64)>, UnknownUnit> {
    if let Some((_, text)) = in_brackets(name) {
        let is_axis = ["x", "y", "z", "roll", "pitch", "yaw"].contains(&&*text.to_lowercase());
        return match unit_of_text(text) {
            None if !is_axis => Err(text.to_owned()),
            unit => Ok(unit),
        };
    }
    let name = name.to_lowercase();
    let name = name.split('[').next().unwrap_or_default();
    let tokens: Vec<&str> = tokens(name).collect();
    // The letter of the axis may follow the unit, as in `gyro_rad_s_x`.
    let tokens = match tokens.as_slice() {
        [rest @ .., "x" | "y" | "z"] if rest.len() > 1 => rest,
        all => all,
    };
    let at_end = |count: usize| {
        let start = tokens.len().checked_sub(count).filter(|&start| start > 0)?;
        Some(tokens[start..].join("/"))
    };
    let ends = [at_end(3), at_end(2), at_end(1)];
    let known = ends.iter().flatten().find_map(|text| unit_of_text(text));
    let foreign = |text: &&String| FOREIGN.contains(&text.as_str());
    match ends.iter().flatten().find(foreign) {
        Some(text) if known.is_none() => Err(text.clone()),
        _ => Ok(known),
    }
}

/// Units at the end of an axis' name that are neither those of a gyro nor those of an accelerometer
/// in this program.
const FOREIGN: [&str; 15] = [
    "rpm", "rps", "hz", "counts", "count", "lsb", "adc", "digits", "mas", "as", "rad/h", "rad/hr",
    "rad/min", "deg/min", "rev/s",
];

/// The unit that is written `rad s^-1`, `deg/sec`, `dps` or `m/s²`, and the factor from a value to
/// it.
fn unit_of_text(text: &str) -> Option<(Unit, f64)> {
    // The case tells milligauss from thousandths of gravity.
    if text.trim() == "mG" {
        return None;
    }
    let mut text = text.to_lowercase();
    for (long, short) in [
        ("degrees", "deg"),
        ("degree", "deg"),
        ("°", "deg"),
        ("radians", "rad"),
        ("radian", "rad"),
        ("seconds", "s"),
        ("second", "s"),
        ("sec", "s"),
        ("⁻", "-"),
        ("¹", "1"),
        ("²", "2"),
        ("μ", "u"),
        ("µ", "u"),
    ] {
        text = text.replace(long, short);
    }
    text.retain(|c| !c.is_whitespace() && !['^', '*', '·', '(', ')', '{', '}'].contains(&c));
    let (deg, rad) = (Unit::DegreesPerSecond, Unit::RadiansPerSecond);
    let (metres, g) = (Unit::MetresPerSecondSquared, Unit::StandardGravity);
    Some(match text.as_str() {
        "deg/s" | "degs-1" | "deg.s-1" | "dps" | "degps" | "deg/per/s" | "degpers" | "degs"
        | "degs/s" => (deg, 1.0),
        "mdps" | "mdeg/s" | "mdegs-1" => (deg, 1e-3),
        "deg/h" | "deg/hr" | "dph" => (deg, 1.0 / 3600.0),
        "rad/s" | "rads-1" | "rad.s-1" | "rads" | "radps" | "rad" | "rad/per/s" | "radpers"
        | "rads/s" => (rad, 1.0),
        "mrad/s" | "mrads-1" | "mradps" => (rad, 1e-3),
        "m/s2" | "ms-2" | "m.s-2" | "m/s/s" | "ms2" | "mps2" | "mss" => (metres, 1.0),
        "g" | "gs" | "g0" | "gn" => (g, 1.0),
        "mg" => (g, 1e-3),
        "ug" => (g, 1e-6),
        _ => return None,
    })
}

/// Whether at least half of these texts below the names of columns are units.
pub(super) fn are_units(texts: &[String]) -> bool {
    let texts = texts
        .iter()
        .map(|text| without_brackets(text))
        .filter(|text| !text.is_empty());
    let (all, units) = texts.fold((0, 0), |(all, units), text| {
        (all + 1, units + usize::from(is_unit(text)))
    });
    units > 0 && 2 * units >= all
}

/// The name of a column with the unit that a row below the names gives it.
pub(super) fn with_unit(name: &str, unit: &str) -> String {
    let unit = without_brackets(unit);
    match unit.is_empty()
        || NO_UNITS.contains(&&*unit.to_lowercase())
        || in_brackets(name).is_some()
    {
        true => name.to_owned(),
        false => format!("{name} [{unit}]"),
    }
}

fn without_brackets(text: &str) -> &str {
    text.trim().trim_matches(['[', ']', '(', ')']).trim()
}

/// Texts that stand for no unit.
const NO_UNITS: [&str; 7] = ["-", "--", "n/a", "none", "no_units", "no units", "1"];

/// Whether a text is a unit of anything that a log of inertial sensors may hold.
fn is_unit(text: &str) -> bool {
    const OTHERS: [&str; 17] = [
        "deg", "°", "rad", "ut", "mg", "µt", "mgauss", "gauss", "t", "v", "mv", "pa", "hpa",
        "mbar", "kpa", "m", "%",
    ];
    let lower = text.to_lowercase();
    unit_of_text(text).is_some()
        || TimeUnit::of_token(&lower).is_some()
        || is_degrees(text)
        || FOREIGN.contains(&&*lower)
        || OTHERS.contains(&&*lower)
        || NO_UNITS.contains(&&*lower)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_read_off_names() {
        let (deg, rad) = (Unit::DegreesPerSecond, Unit::RadiansPerSecond);
        let (metres, g) = (Unit::MetresPerSecondSquared, Unit::StandardGravity);
        for (name, expected) in [
            ("w_RS_S_x [rad s^-1]", Some((rad, 1.0))),
            ("gx (deg/s)", Some((deg, 1.0))),
            ("gx [°/s]", Some((deg, 1.0))),
            ("gyro_x_dps", Some((deg, 1.0))),
            ("gyro_mdps_x", Some((deg, 1e-3))),
            ("gyro_rad[0]", Some((rad, 1.0))),
            ("gyro_rad_s_z", Some((rad, 1.0))),
            ("a_RS_S_x [m s^-2]", Some((metres, 1.0))),
            ("accelerometer_m_s2[0]", Some((metres, 1.0))),
            ("ax (m/s²)", Some((metres, 1.0))),
            ("accel_x [mg]", Some((g, 1e-3))),
            ("ax_g", Some((g, 1.0))),
            ("gx", None),
            ("gyro (x)", None),
            ("gx_raw131", None),
            ("g", None),
            ("angular_velocity.x", None),
            ("gyro_x_rad_per_s", Some((rad, 1.0))),
            ("gyro_x_rad_per_sec", Some((rad, 1.0))),
            ("gyro_deg_per_s_x", Some((deg, 1.0))),
            ("gyro_x_degs", Some((deg, 1.0))),
            ("AsX(°/s)", Some((deg, 1.0))),
        ] {
            assert_eq!(unit(name), Ok(expected), "{name}");
        }
        for (name, text) in [
            ("gx [rpm]", "rpm"),
            ("gx [rad/h]", "rad/h"),
            ("gx [counts]", "counts"),
            ("gyro_rpm_x", "rpm"),
            ("gyro_x_rad_h", "rad/h"),
            ("gyro_x_lsb", "lsb"),
            ("Bx (mG)", "mG"),
        ] {
            assert_eq!(unit(name), Err(text.into()), "{name}");
        }
    }

    #[test]
    fn rows_of_units_are_known() {
        let are =
            |texts: &[&str]| are_units(&texts.iter().map(|&text| text.into()).collect::<Vec<_>>());
        assert!(
            are(&["s", "deg/s", "deg/s"])
                && are(&["[ms]", "(rad/s)", ""])
                && are(&["-", "°/s", "what"])
        );
        assert!(!are(&["gx", "gy", "gz"]) && !are(&["", ""]));
        assert_eq!(with_unit("gx", "(deg/s)"), "gx [deg/s]");
        assert_eq!(with_unit("gx [deg/s]", "deg/s"), "gx [deg/s]");
        assert_eq!(with_unit("n", "-"), "n");
    }
}
