//! Names of columns, as products write them and as people make them up.

use super::{
    quantity::{Quantity, Written},
    random::Random,
};

/// The names of one product: `@` is the letter of an axis, `$` the capital letter, `%` the number from 0.
struct Product {
    rate: &'static str,
    force: &'static str,
    field: &'static str,
    temperature: &'static str,
}

const fn product(
    rate: &'static str,
    force: &'static str,
    field: &'static str,
    temperature: &'static str,
) -> Product {
    Product {
        rate,
        force,
        field,
        temperature,
    }
}

const PRODUCTS: [Product; 22] = [
    product(
        "gyroRotation$",
        "accelerometerAcceleration$",
        "magnetometer$",
        "temp",
    ),
    product("w@", "a@", "B@", "temperature"),
    product("Gyr_$", "Acc_$", "Mag_$", "Temperature"),
    product("UncompGyro$", "UncompAcc$", "UncompMag$", "Temp"),
    product("$_GYRO_OUT", "$_ACCL_OUT", "$_MAGN_OUT", "TEMP_OUT"),
    product("g@", "a@", "m@", "t"),
    product(
        "gyro_rad[%]",
        "accelerometer_m_s2[%]",
        "magnetometer_ga[%]",
        "baro_temp_celcius",
    ),
    product(
        "field.angular_velocity.@",
        "field.linear_acceleration.@",
        "field.magnetic_field.@",
        "field.temperature",
    ),
    product(
        "Shimmer_6749_Gyro_$_CAL",
        "Shimmer_6749_Accel_LN_$_CAL",
        "Shimmer_6749_Mag_$_CAL",
        "Shimmer_6749_Temperature_BMP280_CAL",
    ),
    product(
        "Gyroscope @",
        "Acceleration @",
        "Magnetic field @",
        "Temperature",
    ),
    product(
        "GYROSCOPE $",
        "ACCELEROMETER $",
        "MAGNETIC FIELD $",
        "TEMPERATURE",
    ),
    product("Gyro$", "Acc$", "Mag$", "Temp"),
    product("G_$", "A_$", "M_$", "T"),
    product("w_RS_S_@", "a_RS_S_@", "m_S_@", "temp"),
    product("scaledGyro$", "scaledAccel$", "scaledMag$", "temp"),
    product("pqr[%]", "acc[%]", "mag[%]", "temp"),
    product("gyro-@", "accel-@", "magnetometer-@", "temperature"),
    product("@Rate", "@Accel", "@Mag", "boardTemp"),
    product("imu/gyro/@", "imu/accel/@", "imu/mag/@", "imu/temp"),
    product(
        "Static/Angular Velocity/$",
        "Static/Acceleration/$",
        "Static/Magnetic Field/$",
        "Static/Temperature/Scalar",
    ),
    product(
        "GyroscopeData.@",
        "AccelerometerData.@",
        "MagnetometerData.@",
        "TemperatureData",
    ),
    product(
        "Angular velocity $",
        "Acceleration $",
        "Magnetic field $",
        "Temperature",
    ),
];

/// The products that always write rad/s and m/s².
const METRIC: [usize; 3] = [6, 7, 13];

const RATE: [&str; 18] = [
    "gyro_@",
    "gyr_@",
    "Gyro $",
    "w_@",
    "omega_@",
    "angular_velocity_@",
    "angular_velocity.@",
    "rotation_rate_@",
    "imu_g@",
    "gyro[%]",
    "@_gyro",
    "GYRO_$",
    "ang_vel_@",
    "gyroscope_@",
    "turn_rate_@",
    "Gyro.$",
    "imu0.gyro.@",
    "rot_@",
];
const FORCE: [&str; 10] = [
    "acc_@",
    "accel_@",
    "a@",
    "Accel $",
    "acceleration_@",
    "linear_acceleration.@",
    "acc[%]",
    "ACC_$",
    "@_acc",
    "specific_force_@",
];
const ANGLE_INCREMENT: [&str; 9] = [
    "dtheta_@",
    "delta_angle[%]",
    "deltaTheta$",
    "$_DELTANG",
    "dAng$",
    "DeltaAngle$",
    "delta_theta_@",
    "Delta Angle $",
    "angle_increment_@",
];
const VELOCITY_INCREMENT: [&str; 7] = [
    "dvel_@",
    "delta_velocity[%]",
    "deltaVel$",
    "$_DELTVEL",
    "dv_@",
    "Delta Velocity $",
    "velocity_increment_@",
];
const ANGLE: [&str; 4] = ["angle_@", "Euler_$", "euler.@", "Angle $"];
const VELOCITY: [&str; 4] = ["vel_@", "v@", "velocity.@", "Velocity $"];
const FIELD: [&str; 5] = ["mag_@", "Mag$", "m@", "magnetic_field.@", "magnetometer_@"];
const TEMPERATURE: [&str; 5] = ["temp", "Temperature", "temp_C", "die_temp", "T"];
const PRESSURE: [&str; 3] = ["pressure", "baro", "Pressure_Pa"];
const STATUS: [&str; 5] = ["status", "flags", "valid", "error_count", "clip_counter"];
const LABEL: [&str; 3] = ["frame_id", "header.frame_id", "location"];
const CONSTANT: [&str; 3] = ["device_id", "serial", "address"];
const COUNTER: [&str; 6] = ["seq", "PacketCounter", "n", "count", "sample", "frame"];

/// How a header writes units.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum UnitStyle {
    None,
    Round,
    Square,
    Tight,
    /// A word behind an underscore, such as `_dps`.
    Word,
    /// A second row.
    Row,
}

/// The names of all quantities of a log, in one manner.
pub(super) struct Namer {
    product: Option<usize>,
    pub(super) style: UnitStyle,
}

impl Namer {
    /// Some products always write rad/s and m/s².
    pub(super) fn new(style: UnitStyle, is_metric: bool, random: &mut Random) -> Self {
        let product = random.chance(0.5).then(|| random.below(PRODUCTS.len()));
        let product = product.filter(|product| is_metric || !METRIC.contains(product));
        Self { product, style }
    }

    /// The names of the columns of a quantity, and what stands in the second row of the header.
    pub(super) fn names(
        &self,
        quantity: Quantity,
        unit: Option<Written>,
        random: &mut Random,
    ) -> (Vec<String>, String) {
        let product = self.product.map(|product| &PRODUCTS[product]);
        let template = match (quantity, product) {
            (Quantity::Rate, Some(product)) => product.rate,
            (Quantity::Force, Some(product)) => product.force,
            (Quantity::Field, Some(product)) => product.field,
            (Quantity::Temperature, Some(product)) => product.temperature,
            (Quantity::Rate, None) => random.of(&RATE),
            (Quantity::Force, None) => random.of(&FORCE),
            (Quantity::Field, None) => random.of(&FIELD),
            (Quantity::Temperature, None) => random.of(&TEMPERATURE),
            (Quantity::AngleIncrement, _) => random.of(&ANGLE_INCREMENT),
            (Quantity::VelocityIncrement, _) => random.of(&VELOCITY_INCREMENT),
            (Quantity::Angle, _) => random.of(&ANGLE),
            (Quantity::Velocity, _) => random.of(&VELOCITY),
            (Quantity::Pressure, _) => random.of(&PRESSURE),
            (Quantity::Status, _) => random.of(&STATUS),
            (Quantity::Counter, _) => random.of(&COUNTER),
            (Quantity::Label, _) => random.of(&LABEL),
            (Quantity::Constant, _) => random.of(&CONSTANT),
            (Quantity::Covariance, _) => "covariance_%",
            (Quantity::Attitude, _) => "",
        };
        let text = unit.map(|unit| random.of(unit.texts));
        let behind = match (self.style, text) {
            (UnitStyle::Round, Some(text)) => format!(" ({text})"),
            (UnitStyle::Square, Some(text)) => format!(" [{text}]"),
            (UnitStyle::Tight, Some(text)) => format!("({text})"),
            (UnitStyle::Word, Some(_)) => word(quantity, unit.unwrap()),
            _ => String::new(),
        };
        let below = text.unwrap_or_default().to_owned();
        if quantity == Quantity::Attitude {
            let names = random.of(&[["qw", "qx", "qy", "qz"], ["q0", "q1", "q2", "q3"]]);
            return (names.map(String::from).to_vec(), below);
        }
        let euler = quantity == Quantity::Angle && random.chance(0.6);
        let name = |axis: usize| {
            if euler {
                return ["roll", "pitch", "yaw"][axis].to_owned() + &behind;
            }
            let name = template
                .replace('@', ["x", "y", "z"][axis % 3])
                .replace('$', ["X", "Y", "Z"][axis % 3])
                .replace('%', &axis.to_string());
            name + &behind
        };
        ((0..quantity.columns()).map(name).collect(), below)
    }
}

fn word(quantity: Quantity, unit: Written) -> String {
    let text = match (quantity, unit.texts[0]) {
        (_, "deg/s") => "_dps",
        (_, "rad/s") => "_rad_s",
        (_, "mdps") => "_mdps",
        (_, "deg/h") => "_deg_per_h",
        (_, "m/s^2") => "_m_s2",
        (_, "g") => "_g",
        (_, "mg") => "_mg",
        (_, "deg") => "_deg",
        (_, "rad") => "_rad",
        (_, "m/s") => "_mps",
        (_, "uT") => "_uT",
        _ => "_mG",
    };
    text.to_owned()
}
