//! Envelopes with a correct checksum for any contents.

/// An envelope around the payload. Its checksum is computed bit by bit.
pub(crate) fn sealed(kind: u8, version: u8, payload: &[u8]) -> Vec<u8> {
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
