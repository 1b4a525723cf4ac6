//! A FIFO whose packets the program decodes itself, beside the same FIFO read by the library's format.

use super::chip::Kind;
use super::wire::{NoDelay, Wire};
use allanite::sensor::{
    Description, Fifo, FifoImu, Flaw, Format, ICM_42688_P, Malformed, Packet, PacketCount,
    PacketFormat, Packets, Reading, SpiBus,
};

/// The packets of the ICM-42688-P, by section 6.1 of its data sheet.
struct Mine;

impl Packets for Mine {
    fn count(&self, [flags, high, low]: [u8; 3]) -> PacketCount {
        PacketCount {
            packets: usize::from(u16::from_be_bytes([high, low])) / 16,
            is_full: flags & 2 != 0,
        }
    }

    fn decode(&self, packet: &[u8]) -> Result<Option<Packet>, Malformed> {
        if packet[0] & 0xFC != 0x68 {
            return Err(Malformed::Header { found: packet[0] });
        }
        let number = |at: usize| i16::from_be_bytes([packet[at], packet[at + 1]]);
        let gyro = [7, 9, 11].map(number);
        let degrees = packet[13].cast_signed();
        Ok((gyro != [i16::MIN; 3]).then(|| Packet {
            gyro: gyro.map(i32::from),
            time: u32::from(number(14).cast_unsigned()),
            temperature: (degrees != i8::MIN).then(|| i16::from(degrees) * 64),
            is_rate_changed: packet[0] & 3 != 0,
        }))
    }
}

const FORMAT: PacketFormat = PacketFormat {
    packet_bytes: 16,
    count_bytes: 3,
    is_flushed_when_full: true,
    packets: &Mine,
};

const fn with(format: PacketFormat) -> Description {
    let Some(fifo) = ICM_42688_P.fifo else {
        panic!("it has a FIFO");
    };
    Description {
        fifo: Some(Fifo {
            format: Format::Packets(format),
            ..fifo
        }),
        ..ICM_42688_P
    }
}

static OWN: Description = with(FORMAT);
const _: () = assert!(OWN_IS_POSSIBLE);
const OWN_IS_POSSIBLE: bool = with(FORMAT).check().is_ok();

/// What a burst gives.
type Read = Vec<Result<Reading, Malformed>>;

/// Reads bursts of a sensor that loses samples, fills its FIFO, and sends a damaged byte.
fn bursts(description: &'static Description, size: usize) -> Vec<(Read, bool, usize)> {
    let wire = Wire::new(Kind::Icm42688P);
    let mut imu = FifoImu::<SpiBus<Wire>>::start(wire.spi(), description, &mut NoDelay).unwrap();
    let mut all = Vec::new();
    for burst in 0..60_usize {
        wire.take([3, 1, 0, 7, 2, 200, 40][burst % 7]);
        let now_us = u32::try_from(wire.taken() * 10_000).unwrap();
        if burst % 11 == 0 {
            wire.0.borrow_mut().damage = Some((burst % 14, 0x5A));
        }
        let mut buffer = vec![0; size];
        let burst = imu.read(now_us, &mut buffer).unwrap();
        let (is_flushed, kept) = (burst.is_flushed(), burst.kept());
        all.push((burst.collect(), is_flushed, kept));
    }
    all
}

#[test]
fn packets_of_ones_own_are_read_as_those_of_the_library() {
    for size in [16, 40, 200, 4096] {
        let (own, built_in) = (bursts(&OWN, size), bursts(&ICM_42688_P, size));
        assert_eq!(own, built_in, "{size}");
        let readings = own.iter().flat_map(|(read, ..)| read);
        assert!(readings.clone().filter(|reading| reading.is_ok()).count() > 20);
        assert!(own.iter().any(|(_, is_flushed, _)| *is_flushed));
    }
    assert!(
        bursts(&OWN, 4096)
            .iter()
            .any(|(read, ..)| read.iter().any(Result::is_err))
    );
}

#[test]
fn impossible_packets_are_found_at_compile_time() {
    for impossible in [
        PacketFormat {
            packet_bytes: 0,
            ..FORMAT
        },
        PacketFormat {
            count_bytes: 0,
            ..FORMAT
        },
        PacketFormat {
            count_bytes: 4,
            ..FORMAT
        },
    ] {
        assert_eq!(with(impossible).check(), Err(Flaw::Fifo));
        assert_ne!(Format::Packets(impossible), Format::Packets(FORMAT));
    }
    // A buffer without room for a packet is refused.
    let wire = Wire::new(Kind::Icm42688P);
    let mut imu = FifoImu::start(wire.spi(), &OWN, &mut NoDelay).unwrap();
    assert!(imu.read(0, &mut [0; 15]).is_err());
}
