//! Decodes `sensor_msgs/msg/Imu`. ROS 2 serialises it as CDR after four bytes of encapsulation; ROS
//! 1 packs it without padding.

use byteorder::{BigEndian, LittleEndian};
use serde::Deserialize;

/// How a message is serialised.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Cdr,
    Ros1,
}

impl Encoding {
    /// The encoding of a channel with this message type and this name of an encoding, or `None` if
    /// its messages are not those of an IMU.
    pub(super) fn of(schema: &str, encoding: &str) -> Option<Self> {
        match (schema, encoding) {
            ("sensor_msgs/msg/Imu" | "sensor_msgs::msg::dds_::Imu_", "cdr") => Some(Self::Cdr),
            ("sensor_msgs/Imu", "ros1") => Some(Self::Ros1),
            _ => None,
        }
    }
}

/// The columns of the table: the time stamp of the header and six values.
pub(super) const COLUMNS: [&str; 7] = [
    "header.stamp [ns]",
    "angular_velocity.x [rad/s]",
    "angular_velocity.y [rad/s]",
    "angular_velocity.z [rad/s]",
    "linear_acceleration.x [m/s^2]",
    "linear_acceleration.y [m/s^2]",
    "linear_acceleration.z [m/s^2]",
];

/// The part of a message that a log uses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ImuMessage {
    /// The time stamp, in nanoseconds since 1970.
    pub(super) stamp_ns: i64,
    /// The angular rates, in rad/s, and then the accelerations, in m/s².
    pub(super) values: [f64; 6],
    /// Whether the first element of the covariance of the rates, and of the accelerations, is −1. The definition of the message says:
    /// then there is no estimate of this quantity.
    pub(super) unmeasured: [bool; 2],
}

/// The mark in a covariance of a quantity that is not measured.
const UNMEASURED: f64 = -1.0;

const SHORT: &str = "a message is shorter than sensor_msgs/msg/Imu";

#[derive(Deserialize)]
struct Imu {
    header: Header,
    _orientation: ([f64; 4], [f64; 9]),
    angular_velocity: [f64; 3],
    angular_velocity_covariance: [f64; 9],
    linear_acceleration: [f64; 3],
    linear_acceleration_covariance: [f64; 9],
}

#[derive(Deserialize)]
struct Header {
    sec: i32,
    nanosec: u32,
    _frame_id: String,
}

/// The frame of a message, which tells the sensors of one topic apart. `None` if the message cannot be decoded.
pub(super) fn frame_of(bytes: &[u8], encoding: Encoding) -> Option<String> {
    // Behind the sequence number, or the encapsulation, are two words of the stamp.
    let is_big = encoding == Encoding::Cdr && bytes.get(1) == Some(&0);
    let (length, rest) = bytes.get(12..)?.split_first_chunk::<4>()?;
    let length = if is_big {
        u32::from_be_bytes(*length)
    } else {
        u32::from_le_bytes(*length)
    };
    let frame = rest.get(..usize::try_from(length).ok()?)?;
    let frame = frame.strip_suffix(b"\0").unwrap_or(frame);
    Some(String::from_utf8_lossy(frame).into_owned())
}

impl ImuMessage {
    /// Decodes a message, or returns the reason why it cannot be decoded.
    pub(super) fn read(bytes: &[u8], encoding: Encoding) -> Result<Self, &'static str> {
        match encoding {
            Encoding::Cdr => Self::read_cdr(bytes),
            Encoding::Ros1 => Self::read_ros1(bytes).ok_or(SHORT),
        }
    }

    fn read_ros1(bytes: &[u8]) -> Option<Self> {
        /// The number of floats: orientation, angular rates and accelerations, each followed by its
        /// covariance.
        const FLOATS: usize = 37;
        let mut bytes = bytes;
        let mut word = || {
            let (word, rest) = bytes.split_first_chunk()?;
            bytes = rest;
            Some(u32::from_le_bytes(*word))
        };
        let [_sequence, secs, nsecs, frame] = [word()?, word()?, word()?, word()?];
        let mut floats = [0.0; FLOATS];
        let rest = bytes.get(usize::try_from(frame).ok()?..)?;
        let (rest, _) = rest.split_at_checked(8 * FLOATS)?;
        for (float, bytes) in floats.iter_mut().zip(rest.chunks_exact(8)) {
            *float = f64::from_le_bytes(bytes.try_into().ok()?);
        }
        let [a, b, c] = [floats[13], floats[14], floats[15]];
        let [d, e, f] = [floats[25], floats[26], floats[27]];
        Some(Self {
            stamp_ns: i64::from(secs) * 1_000_000_000 + i64::from(nsecs),
            values: [a, b, c, d, e, f],
            unmeasured: [floats[16], floats[28]].map(|first| first == UNMEASURED),
        })
    }

    fn read_cdr(bytes: &[u8]) -> Result<Self, &'static str> {
        let Some((encapsulation, payload)) = bytes.split_first_chunk::<4>() else {
            return Err("a message has no encapsulation header");
        };
        let imu = match encapsulation {
            [0, 0, ..] => cdr_encoding::from_bytes::<Imu, BigEndian>(payload),
            [0, 1, ..] => cdr_encoding::from_bytes::<Imu, LittleEndian>(payload),
            _ => return Err("a message is not plain CDR"),
        };
        let (imu, _) = imu.map_err(|_| SHORT)?;
        let [a, b, c] = imu.angular_velocity;
        let [d, e, f] = imu.linear_acceleration;
        let [of_rates, ..] = imu.angular_velocity_covariance;
        let [of_forces, ..] = imu.linear_acceleration_covariance;
        Ok(Self {
            stamp_ns: i64::from(imu.header.sec) * 1_000_000_000 + i64::from(imu.header.nanosec),
            values: [a, b, c, d, e, f],
            unmeasured: [of_rates, of_forces].map(|first| first == UNMEASURED),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A message in the given byte order, built by hand.
    fn message(frame: &[u8], values: [f64; 6], covariances: [f64; 2], big: bool) -> Vec<u8> {
        let mut bytes = vec![0, u8::from(!big), 0, 0];
        let word = |value: u32| {
            if big {
                value.to_be_bytes()
            } else {
                value.to_le_bytes()
            }
        };
        let float = |value: f64| {
            if big {
                value.to_be_bytes()
            } else {
                value.to_le_bytes()
            }
        };
        bytes.extend(word(7));
        bytes.extend(word(250_000_000));
        bytes.extend(word(frame.len() as u32 + 1));
        bytes.extend(frame);
        bytes.push(0);
        // CDR aligns floats to multiples of eight bytes after the encapsulation.
        bytes.resize(4 + (bytes.len() - 4).next_multiple_of(8), 0);
        bytes.extend(floats(values, covariances).into_iter().flat_map(float));
        bytes
    }

    /// The floats of a message, of which each covariance begins with this element.
    fn floats(values: [f64; 6], covariances: [f64; 2]) -> Vec<f64> {
        let [rates, forces] = [&values[..3], &values[3..]];
        let [of_rates, of_forces] = covariances.map(|first| {
            let mut covariance = [0.0; 9];
            covariance[0] = first;
            covariance
        });
        [&[0.0; 13][..], rates, &of_rates, forces, &of_forces].concat()
    }

    proptest! {
        #[test]
        fn messages_of_either_byte_order_are_read(
            frame in "[a-z]{0,12}",
            values in prop::array::uniform6(-1e3..1e3),
            covariances in prop::array::uniform2(prop_oneof![Just(-1.0), 0.0..1.0]),
            big: bool,
        ) {
            let bytes = message(frame.as_bytes(), values, covariances, big);
            let unmeasured = covariances.map(|first| first == -1.0);
            let expected = ImuMessage { stamp_ns: 7_250_000_000, values, unmeasured };
            prop_assert_eq!(ImuMessage::read(&bytes, Encoding::Cdr), Ok(expected));
            for cut in 0..bytes.len() {
                prop_assert!(ImuMessage::read(&bytes[..cut], Encoding::Cdr).is_err());
            }
        }

        #[test]
        fn packed_messages_are_read(
            frame in "[a-z]{0,12}",
            values in prop::array::uniform6(-1e3..1e3),
            covariances in prop::array::uniform2(prop_oneof![Just(-1.0), 0.0..1.0]),
        ) {
            let words = [3, 7, 250_000_000, frame.len() as u32];
            let mut bytes: Vec<u8> = words.into_iter().flat_map(u32::to_le_bytes).collect();
            bytes.extend(frame.as_bytes());
            let floats = floats(values, covariances);
            bytes.extend(floats.into_iter().flat_map(f64::to_le_bytes));
            let expected = ImuMessage {
                stamp_ns: 7_250_000_000,
                values,
                unmeasured: covariances.map(|first| first == -1.0),
            };
            prop_assert_eq!(ImuMessage::read(&bytes, Encoding::Ros1), Ok(expected));
            for cut in 0..bytes.len() {
                prop_assert!(ImuMessage::read(&bytes[..cut], Encoding::Ros1).is_err());
            }
        }

        #[test]
        fn any_bytes_are_read_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..500)) {
            let _ = ImuMessage::read(&bytes, Encoding::Cdr);
            let _ = ImuMessage::read(&bytes, Encoding::Ros1);
            let _ = ImuMessage::read(&[&[0, 1, 0, 0], bytes.as_slice()].concat(), Encoding::Cdr);
        }
    }
}
