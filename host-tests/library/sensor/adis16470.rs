//! The ADIS16470, simulated frame by frame and independently of the library.

use super::wire::Fault;
use crate::common::precision::double;
use allanite::sensor::{Adis16470, Error, Loss, Reading};
use allanite::{Accumulator, Axes};
use embedded_hal::spi;
use embedded_hal::{digital, spi::SpiDevice};
use pollster::block_on;
use proptest::prelude::*;
use std::{cell::RefCell, rc::Rc};

/// The rates of sample `n`, in counts of 32 bits. The upper and the lower half change with every sample.
fn gyro(n: u16) -> [i32; 3] {
    let n = i32::from(n);
    [
        n.wrapping_mul(0x0002_0003).wrapping_add(7),
        -n.wrapping_mul(0x3001) - 1,
        i32::MIN + n,
    ]
}

#[derive(Debug)]
struct Chip {
    /// The registers by half their address.
    registers: [u16; 64],
    /// The answer to the last frame.
    answer: u16,
    counter: u16,
    product: u16,
    flags: u16,
    /// The time in ns, and that of the end of the last exchange.
    now_ns: u64,
    end_ns: Option<u64>,
    /// When the sensor answers again after a reset.
    ready_ns: u64,
    exchanges: usize,
    /// The exchange that fails.
    fault: Option<usize>,
    /// The exchanges before which the sensor takes a sample.
    takes: Vec<usize>,
    /// The exchange and the byte of it that is damaged, and how.
    damage: Option<(usize, usize, u8)>,
    /// A write that is lost.
    deaf_to: Option<u8>,
}

const DATA_CNTR: usize = 0x22 / 2;

impl Chip {
    fn new() -> Self {
        Self {
            registers: [0; 64],
            answer: 0xDEAD,
            counter: 0,
            product: 0x4056,
            flags: 0,
            now_ns: 0,
            end_ns: None,
            ready_ns: 0,
            exchanges: 0,
            fault: None,
            takes: Vec::new(),
            damage: None,
            deaf_to: None,
        }
    }

    /// Takes samples.
    fn take(&mut self, samples: u16) {
        self.counter = self.counter.wrapping_add(samples);
        let halves = gyro(self.counter).map(i32::to_be_bytes);
        for (k, [a, b, c, d]) in halves.into_iter().enumerate() {
            self.registers[2 + 2 * k] = u16::from_be_bytes([c, d]);
            self.registers[3 + 2 * k] = u16::from_be_bytes([a, b]);
        }
        // Accelerations, the temperature of 24.7 °C, and the counter.
        self.registers[0x12 / 2] = 0x8001;
        self.registers[0x16 / 2] = 0x1234;
        self.registers[0x1A / 2] = 0x0320;
        self.registers[0x1C / 2] = 247;
        self.registers[DATA_CNTR] = self.counter;
    }

    fn burst(&mut self) -> [u8; 22] {
        let mut words = vec![std::mem::take(&mut self.flags)];
        words.extend(
            [0x06, 0x0A, 0x0E, 0x12, 0x16, 0x1A, 0x1C, 0x22].map(|at| self.registers[at / 2]),
        );
        let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_be_bytes()).collect();
        let sum: u16 = bytes.iter().copied().map(u16::from).sum();
        let mut burst = [0xA5; 22];
        burst[2..20].copy_from_slice(&bytes);
        burst[20..].copy_from_slice(&sum.to_be_bytes());
        burst
    }

    fn exchange(&mut self, bytes: &mut [u8]) -> Result<(), Fault> {
        let at = self.exchanges;
        self.exchanges += 1;
        if let Some(end_ns) = self.end_ns {
            let stall_ns = self.now_ns - end_ns;
            assert!(stall_ns >= 16_000, "a stall of {stall_ns} ns");
        }
        let samples = self.takes.iter().filter(|take| **take == at).count();
        if samples > 0 {
            self.take(samples as u16);
        }
        // 1 MHz.
        self.now_ns += 8000 * bytes.len() as u64;
        self.end_ns = Some(self.now_ns);
        if self.fault == Some(at) {
            bytes.fill(0xFF);
            return Err(Fault::Before);
        }
        assert!(self.now_ns >= self.ready_ns, "during the reset");
        match *bytes {
            [address, value] => {
                let [high, low] = self.answer.to_be_bytes();
                (bytes[0], bytes[1]) = (high, low);
                if address & 0x80 == 0 {
                    assert_eq!(address % 2, 0);
                    self.registers[0x72 / 2] = self.product;
                    self.answer = self.registers[usize::from(address / 2)];
                } else if self.deaf_to != Some(address & 0x7F) {
                    self.write(address & 0x7F, value);
                }
            }
            _ => {
                assert_eq!(bytes[..2], [0x68, 0x00]);
                assert!(bytes[2..].iter().all(|byte| *byte == 0));
                bytes.copy_from_slice(&self.burst());
            }
        }
        if let Some((_, byte, with)) = self.damage.filter(|it| it.0 == at) {
            bytes[byte] ^= with;
        }
        Ok(())
    }

    fn write(&mut self, address: u8, value: u8) {
        if (address, value) == (0x68, 0x80) {
            self.registers = [0; 64];
            // As another program may have left it in flash.
            self.registers[0x5C / 2] = 0x0004;
            self.registers[0x60 / 2] = 0x00C1;
            self.counter = 0;
            self.take(0);
            return;
        }
        if address == 0x69 {
            self.ready_ns = self.now_ns + 193_000_000;
            return;
        }
        assert!(matches!(address, 0x5C | 0x5D | 0x60 | 0x61 | 0x64 | 0x65));
        let register = &mut self.registers[usize::from(address / 2)];
        let mut bytes = register.to_le_bytes();
        bytes[usize::from(address % 2)] = value;
        *register = u16::from_le_bytes(bytes);
    }
}

/// A bus to a chip, and a delay that moves its time on. Clones lead to the same chip.
#[derive(Clone, Debug)]
struct Wire(Rc<RefCell<Chip>>);

impl Wire {
    fn new() -> Self {
        let mut chip = Chip::new();
        chip.take(0);
        Self(Rc::new(RefCell::new(chip)))
    }

    fn start(&self, rate_hz: u16) -> Result<Adis16470<Self>, Error<Fault>> {
        Adis16470::start(self.clone(), rate_hz, &mut self.clone())
    }

    /// A source that was started, and its sensor with the first sample.
    fn started() -> (Self, Adis16470<Self>) {
        let wire = Self::new();
        let imu = wire.start(100).unwrap();
        (wire, imu)
    }

    fn take(&self, samples: u16) {
        self.0.borrow_mut().take(samples);
    }

    fn counter(&self) -> u16 {
        self.0.borrow().counter
    }

    fn transaction(&self, operations: &mut [spi::Operation<'_, u8>]) -> Result<(), Fault> {
        match operations {
            [spi::Operation::TransferInPlace(bytes)] => self.0.borrow_mut().exchange(bytes),
            _ => panic!("odd operations"),
        }
    }
}

impl spi::ErrorType for Wire {
    type Error = Fault;
}

impl SpiDevice for Wire {
    fn transaction(&mut self, operations: &mut [spi::Operation<'_, u8>]) -> Result<(), Fault> {
        Wire::transaction(self, operations)
    }
}

impl embedded_hal_async::spi::SpiDevice for Wire {
    async fn transaction(
        &mut self,
        operations: &mut [spi::Operation<'_, u8>],
    ) -> Result<(), Fault> {
        Wire::transaction(self, operations)
    }
}

impl embedded_hal::delay::DelayNs for Wire {
    fn delay_ns(&mut self, ns: u32) {
        self.0.borrow_mut().now_ns += u64::from(ns);
    }
}

impl embedded_hal_async::delay::DelayNs for Wire {
    async fn delay_ns(&mut self, ns: u32) {
        self.0.borrow_mut().now_ns += u64::from(ns);
    }
}

fn reading(n: u16, loss: Loss) -> Reading {
    Reading {
        gyro: gyro(n),
        temperature: Some(247),
        loss,
        ticks: None,
    }
}

#[test]
fn the_start_resets_the_sensor_and_sets_filter_and_rate() {
    for (rate_hz, decimation) in [(1000, 1), (100, 19), (1, 1999)] {
        for product in [0x4056, 0x4256] {
            for is_async in [false, true] {
                let wire = Wire::new();
                wire.0.borrow_mut().product = product;
                wire.0.borrow_mut().registers[0x64 / 2] = 4;
                let mut delay = wire.clone();
                let imu = match is_async {
                    false => wire.start(rate_hz),
                    true => block_on(Adis16470::start_async(wire.clone(), rate_hz, &mut delay)),
                }
                .unwrap();
                let scale = imu.scale().unwrap();
                assert_eq!(scale.rate_hz(), allanite::Real::from(rate_hz));
                let chip = wire.0.borrow();
                assert_eq!(chip.registers[0x5C / 2], 0, "no filter");
                assert_eq!(chip.registers[0x60 / 2], 0x00C1);
                assert_eq!(chip.registers[0x64 / 2], decimation);
                // The reset, and at least two samples.
                let least_ns = 193_000_000 + 2_000_000_000 / u64::from(rate_hz);
                assert!(chip.now_ns > least_ns);
            }
        }
    }
}

#[test]
fn rates_that_do_not_divide_the_sensors_are_refused_without_a_transfer() {
    let mut accepted = Vec::new();
    for rate_hz in 0..=3000 {
        let wire = Wire::new();
        match wire.start(rate_hz) {
            Ok(_) => accepted.push(rate_hz),
            Err(error) => {
                let sensor = "ADIS16470";
                assert_eq!(error, Error::Rate { sensor, rate_hz });
                assert_eq!(wire.0.borrow().exchanges, 0);
            }
        }
    }
    let expected = [
        1, 2, 4, 5, 8, 10, 16, 20, 25, 40, 50, 80, 100, 125, 200, 250, 400, 500, 1000,
    ];
    assert_eq!(accepted, expected);
}

#[test]
fn another_sensor_is_refused_before_anything_is_written() {
    for product in [0x0000, 0xFFFF, 0x405D] {
        let wire = Wire::new();
        wire.0.borrow_mut().product = product;
        let error = wire.start(100).unwrap_err();
        let expected = Error::WrongWord {
            sensor: "ADIS16470",
            register: 0x72,
            found: product,
            expected: 0x4056,
        };
        assert_eq!(error, expected);
        assert_eq!(wire.0.borrow().exchanges, 2);
        assert!(error.to_string().contains("instead of 0x4056"), "{error}");
    }
}

#[test]
fn a_setting_that_does_not_arrive_ends_the_start() {
    for (deaf_to, register, found, expected) in [(0x5C, 0x5C, 4, 0), (0x64, 0x64, 0, 19)] {
        let wire = Wire::new();
        wire.0.borrow_mut().deaf_to = Some(deaf_to);
        let sensor = "ADIS16470";
        let error = Error::WrongWord {
            sensor,
            register,
            found,
            expected,
        };
        assert_eq!(wire.start(100).unwrap_err(), error);
    }
}

#[test]
fn a_sample_has_32_bits_of_either_sign_and_comes_once() {
    let (wire, mut imu) = Wire::started();
    let mut delay = wire.clone();
    let n = wire.counter();
    assert_eq!(imu.read(&mut delay), Ok(Some(reading(n, Loss::Nothing))));
    for n in n + 1..n + 50 {
        assert_eq!(imu.read(&mut delay), Ok(None), "nothing is new");
        wire.take(1);
        let expected = reading(n, Loss::Nothing);
        // Both ways alternate.
        let outcome = match n % 2 {
            0 => imu.read(&mut delay),
            _ => block_on(imu.read_async(&mut delay)),
        };
        assert_eq!(outcome, Ok(Some(expected)));
    }
    // One count is a 65 536th of 0.1 °/s.
    let full = f64::from(i32::MAX) * double(Adis16470::<Wire>::SCALE_DPS);
    assert!((full - 3276.8).abs() < 1e-3, "{full}");
    let celsius = Adis16470::<Wire>::TEMPERATURE.celsius(247);
    assert!((double(celsius) - 24.7).abs() < 1e-5);
}

#[test]
fn the_number_of_lost_samples_follows_from_the_counter() {
    let (wire, mut imu) = Wire::started();
    let mut delay = wire.clone();
    imu.read(&mut delay).unwrap();
    // The last step takes the counter over its end.
    for step in [2, 3, 1, 100, 40_000, 25_000, 65_535] {
        wire.take(step);
        let loss = match step {
            1 => Loss::Nothing,
            _ => Loss::Samples(u32::from(step) - 1),
        };
        let expected = reading(wire.counter(), loss);
        assert_eq!(imu.read(&mut delay), Ok(Some(expected)), "{step}");
    }
}

#[test]
fn a_damaged_burst_is_refused_and_counted_as_lost() {
    // Every bit of what the checksum covers, and of the checksum.
    for byte in 2..22 {
        for bit in 0..8 {
            let (wire, mut imu) = Wire::started();
            let mut delay = wire.clone();
            imu.read(&mut delay).unwrap();
            wire.take(1);
            let at = wire.0.borrow().exchanges;
            wire.0.borrow_mut().damage = Some((at, byte, 1 << bit));
            let error = imu.read(&mut delay).unwrap_err();
            let Error::Checksum { found, expected } = error else {
                panic!("{byte} {bit}: {error:?}")
            };
            assert_ne!(found, expected);
            wire.take(1);
            let expected = reading(wire.counter(), Loss::Samples(1));
            assert_eq!(imu.read(&mut delay), Ok(Some(expected)), "{byte} {bit}");
        }
    }
}

#[test]
fn a_bus_without_a_sensor_is_no_sample() {
    struct Silent(u8);
    impl spi::ErrorType for Silent {
        type Error = Fault;
    }
    impl SpiDevice for Silent {
        fn transaction(&mut self, operations: &mut [spi::Operation<'_, u8>]) -> Result<(), Fault> {
            if let [spi::Operation::TransferInPlace(bytes)] = operations {
                bytes.fill(self.0);
            }
            Ok(())
        }
    }
    for level in [0x00, 0xFF] {
        let started = Adis16470::start(Silent(level), 100, &mut Wire::new());
        assert!(matches!(started, Err(Error::WrongWord { .. })));
    }
    // The sensor falls silent after its start: zeros have the right checksum.
    let (wire, mut imu) = Wire::started();
    let mut delay = wire.clone();
    imu.read(&mut delay).unwrap();
    wire.0.borrow_mut().registers = [0; 64];
    let (found, expected) = (0, 0);
    assert_eq!(
        imu.read(&mut delay),
        Err(Error::Checksum { found, expected })
    );
}

#[test]
fn flags_of_a_failure_are_an_error_and_others_are_not() {
    for bit in 0..16 {
        let (wire, mut imu) = Wire::started();
        let mut delay = wire.clone();
        imu.read(&mut delay).unwrap();
        wire.take(1);
        let flags = 1 << bit;
        wire.0.borrow_mut().flags = flags;
        let outcome = imu.read(&mut delay);
        // Overrun, standby, sensor, memory and clock.
        if [1, 4, 5, 6, 7].contains(&bit) {
            let sensor = "ADIS16470";
            assert_eq!(outcome, Err(Error::Failure { sensor, flags }));
            // Reading clears the flags, and the sample is still there.
            assert!(imu.read(&mut delay).unwrap().is_some());
        } else {
            assert!(outcome.unwrap().is_some(), "bit {bit}");
        }
    }
}

/// A sample takes the burst and five frames. If the sensor takes another one meanwhile, all is read again.
#[test]
fn halves_of_two_samples_are_never_put_together() {
    for is_twice in [false, true] {
        for frame in 1..6 {
            let (wire, mut imu) = Wire::started();
            let mut delay = wire.clone();
            imu.read(&mut delay).unwrap();
            wire.take(1);
            let at = wire.0.borrow().exchanges + frame;
            wire.0.borrow_mut().takes = match is_twice {
                false => vec![at],
                true => vec![at, at + 6],
            };
            let outcome = imu.read(&mut delay);
            // The counter is fetched when the last frame but one has been sent.
            if frame == 5 {
                let n = wire.counter() - 1;
                assert_eq!(outcome, Ok(Some(reading(n, Loss::Nothing))));
            } else if is_twice {
                let sensor = "ADIS16470";
                assert_eq!(outcome, Err(Error::Overtaken { sensor }));
                let expected = reading(wire.counter(), Loss::Samples(2));
                assert_eq!(imu.read(&mut delay), Ok(Some(expected)));
            } else {
                let expected = reading(wire.counter(), Loss::Samples(1));
                assert_eq!(outcome, Ok(Some(expected)), "{frame}");
            }
        }
    }
}

#[test]
fn a_fault_at_any_exchange_is_told_and_loses_no_more_than_its_sample() {
    let wire = Wire::new();
    wire.start(100).unwrap();
    for at in 0..wire.0.borrow().exchanges {
        let wire = Wire::new();
        wire.0.borrow_mut().fault = Some(at);
        let error = wire.start(100).unwrap_err();
        assert!(matches!(error, Error::Bus { .. }));
        assert_eq!(wire.0.borrow().exchanges, at + 1);
        let mut delay = wire.clone();
        embedded_hal::delay::DelayNs::delay_ms(&mut delay, 200);
        wire.start(100).unwrap();
    }
    for (frame, register) in [0x68, 0x04, 0x08, 0x0C, 0x22, 0x00].into_iter().enumerate() {
        for is_async in [false, true] {
            let (wire, mut imu) = Wire::started();
            let mut delay = wire.clone();
            imu.read(&mut delay).unwrap();
            wire.take(1);
            let at = wire.0.borrow().exchanges + frame;
            wire.0.borrow_mut().fault = Some(at);
            let error = Fault::Before;
            let outcome = match is_async {
                false => imu.read(&mut delay),
                true => block_on(imu.read_async(&mut delay)),
            };
            assert_eq!(outcome, Err(Error::Bus { register, error }));
            // The stall is kept by the time that the program needs.
            embedded_hal::delay::DelayNs::delay_us(&mut delay, 16);
            wire.take(1);
            let expected = reading(wire.counter(), Loss::Samples(1));
            assert_eq!(imu.read(&mut delay), Ok(Some(expected)));
        }
    }
}

#[test]
fn a_record_without_its_errors_bridges_what_was_lost() {
    let (wire, mut imu) = Wire::started();
    let mut delay = wire.clone();
    let mut axes = Axes::<8, 0, (), ()>::new();
    let mut expected = [(); 3].map(|()| Accumulator::<8>::new());
    for n in 0..200_usize {
        wire.take(1);
        let is_lost = n % 50 == 20;
        if is_lost {
            let at = wire.0.borrow().exchanges;
            wire.0.borrow_mut().damage = Some((at, 5, 0x10));
        }
        let outcome = imu.read(&mut delay);
        assert_eq!(outcome.is_err(), is_lost);
        if outcome.is_ok() {
            axes.record_outcome(&outcome, |_| []);
        }
        for (accumulator, count) in expected.iter_mut().zip(gyro(wire.counter())) {
            match is_lost {
                true => accumulator.lost(1),
                false => accumulator.push(count),
            }
        }
    }
    assert_eq!(axes.accumulators(), expected.each_ref());
    assert_eq!((axes.samples(), axes.losses()), (196, 4));
}

#[test]
fn the_data_ready_pin_rises() {
    struct Pin(usize);
    impl digital::ErrorType for Pin {
        type Error = digital::ErrorKind;
    }
    impl embedded_hal_async::digital::Wait for Pin {
        async fn wait_for_high(&mut self) -> Result<(), digital::ErrorKind> {
            unreachable!()
        }
        async fn wait_for_low(&mut self) -> Result<(), digital::ErrorKind> {
            unreachable!()
        }
        async fn wait_for_rising_edge(&mut self) -> Result<(), digital::ErrorKind> {
            self.0 += 1;
            Ok(())
        }
        async fn wait_for_falling_edge(&mut self) -> Result<(), digital::ErrorKind> {
            unreachable!()
        }
        async fn wait_for_any_edge(&mut self) -> Result<(), digital::ErrorKind> {
            unreachable!()
        }
    }
    let (_, imu) = Wire::started();
    let mut pin = Pin(0);
    block_on(imu.wait(&mut pin)).unwrap();
    assert_eq!(pin.0, 1);
}

/// A chip, and what is answered instead of it.
struct Nonsense {
    wire: Wire,
    bytes: Rc<RefCell<Vec<u8>>>,
    at: usize,
}

impl spi::ErrorType for Nonsense {
    type Error = Fault;
}

impl SpiDevice for Nonsense {
    fn transaction(&mut self, operations: &mut [spi::Operation<'_, u8>]) -> Result<(), Fault> {
        let bytes = self.bytes.borrow();
        match operations {
            [spi::Operation::TransferInPlace(place)] if !bytes.is_empty() => {
                for byte in place.iter_mut() {
                    *byte = bytes[self.at % bytes.len()];
                    self.at += 1;
                }
                assert!(self.at < 10_000, "too many transfers");
                Ok(())
            }
            _ => self.wire.transaction(operations),
        }
    }
}

proptest! {
    #[test]
    fn nonsense_is_read_without_panic_and_in_bounded_time(
        nonsense in prop::collection::vec(any::<u8>(), 1..200),
        reads in 1_usize..20,
    ) {
        let wire = Wire::new();
        let bytes = Rc::new(RefCell::new(Vec::new()));
        let mut delay = wire.clone();
        let spi = Nonsense { wire, bytes: bytes.clone(), at: 0 };
        let mut imu = Adis16470::start(spi, 100, &mut delay).unwrap();
        *bytes.borrow_mut() = nonsense;
        for _ in 0..reads {
            let _ = imu.read(&mut delay);
        }
    }
}
