//! Snapshots and certificates of any contents, whose checksums are right so that the contents are read.

use allanite::{
    Accumulator, Axis,
    storage::{Certificate, Snapshot},
};

/// Opens the bytes as they are, then their first byte's kind and second byte's version in a sealed envelope.
pub fn check(bytes: &[u8]) {
    open(bytes);
    if let [kind, version, payload @ ..] = bytes {
        open(&sealed(kind % 4, version % 6, payload));
    }
}

fn open(bytes: &[u8]) {
    if let Ok(snapshot) = Snapshot::open(bytes) {
        assert!(snapshot.gaps() <= snapshot.samples());
        assert!((2..=30).contains(&snapshot.octaves().len()));
        snapshot
            .octaves()
            .for_each(|octave| assert!(octave.m.is_power_of_two()));
    }
    restore::<2>(bytes);
    restore::<12>(bytes);
    let mut axis = Axis::<12, 1>::new();
    if axis.restore(&mut [], bytes).is_ok() {
        axis.lost(1);
    }
    if let Ok(certificate) = Certificate::decode(bytes) {
        let terms = certificate.axes.iter().flat_map(|axis| &axis.terms);
        terms.for_each(|term| assert!(!term.effect.name().is_empty()));
    }
}

/// What is restored can go on, and be stored and restored again.
fn restore<const OCTAVES: usize>(bytes: &[u8]) {
    if let Ok(mut accumulator) = Accumulator::<OCTAVES>::restore(bytes) {
        let mut buffer = vec![0; Accumulator::<OCTAVES>::SNAPSHOT_BYTES];
        let stored = accumulator.snapshot(&mut buffer).unwrap();
        assert_eq!(Accumulator::restore(stored).as_ref(), Ok(&accumulator));
        accumulator.push_slice(&[i32::MIN, i32::MAX, 0, 7]);
        accumulator.merge(&accumulator.clone());
        accumulator.octaves().for_each(drop);
    }
}

/// An envelope around the payload. Its checksum is computed bit by bit.
fn sealed(kind: u8, version: u8, payload: &[u8]) -> Vec<u8> {
    let payload = &payload[..payload.len().min(usize::from(u16::MAX))];
    let mut bytes = b"ALNT".to_vec();
    bytes.extend([kind, version]);
    bytes.extend((payload.len() as u16).to_le_bytes());
    bytes.extend(payload);
    let mut crc = u32::MAX;
    for &byte in &bytes {
        crc ^= u32::from(byte);
        for _ in 0..8 {
            crc = (crc >> 1) ^ ((crc & 1) * 0xEDB8_8320);
        }
    }
    bytes.extend((!crc).to_le_bytes());
    bytes
}
