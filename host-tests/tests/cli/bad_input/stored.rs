//! Bad certificates and snapshots.

use super::case::{Case, refused};
use crate::sealed::sealed;

/// The head of a certificate's payload, for one axis: device, firmware, temperature, time, rate, samples and
/// gaps.
fn head(duration_s: f64, rate_hz: f64, [samples, gaps]: [u8; 2], axes: u8) -> Vec<u8> {
    let mut bytes = vec![2, b'S', b'N', 1, 2, 3, 0];
    bytes.extend(duration_s.to_le_bytes());
    bytes.extend(rate_hz.to_le_bytes());
    bytes.extend([samples, gaps, 0, axes]);
    bytes
}

/// An axis with these terms and correlations.
fn axis(chi_squared: f64, p_value: f64, terms: &[Vec<u8>], correlations: &[f32]) -> Vec<u8> {
    let mut bytes = [chi_squared, p_value].map(f64::to_le_bytes).concat();
    bytes.push(9);
    bytes.extend(0.0_f32.to_le_bytes());
    bytes.push(1);
    bytes.push(terms.len() as u8);
    bytes.extend(terms.concat());
    bytes.extend(correlations.iter().flat_map(|one| one.to_le_bytes()));
    bytes
}

/// A measured term without a shape.
fn term(effect: u8, numbers: [f32; 4]) -> Vec<u8> {
    let numbers = numbers.map(f32::to_le_bytes).concat();
    [&[effect], numbers.as_slice(), &[0, 0]].concat()
}

/// A decimation filter of this width and so many stages.
fn filter(code: u8, stages: f32) -> Vec<u8> {
    let mut bytes = term(code, [1.0, 0.5, 2.0, 0.1]);
    bytes.pop();
    bytes.push(2);
    for value in [0.02, f32::NAN, f32::NAN, stages, f32::NAN, f32::NAN] {
        bytes.extend(value.to_le_bytes());
    }
    bytes
}

pub(crate) fn cases() -> Vec<Case> {
    let conditions = head(1.0, 100.0, [100, 3], 1);
    let white = || term(2, [1.0, 0.5, 2.0, 0.1]);
    let flicker = || term(3, [1.0, 0.5, 2.0, 0.1]);
    let of = |terms: &[Vec<u8>], correlations: &[f32]| {
        let axis = axis(5.0, 0.5, terms, correlations);
        sealed(2, 1, &[conditions.clone(), axis].concat())
    };
    let good = of(&[white(), flicker()], &[0.5]);
    let nobody = |head: Vec<u8>| sealed(2, 1, &head);
    let mut flipped = good.clone();
    flipped[20] ^= 1;
    let code = (1..=11).find(|&code| {
        let bytes = of(&[filter(code, 2.0)], &[]);
        allanite::storage::Certificate::decode(&bytes)
            .is_ok_and(|record| record.axes[0].terms[0].effect.name() == "decimation_filter")
    });
    let code = code.unwrap();
    let files: Vec<Vec<u8>> = vec![
        Vec::new(),
        b"ALNT".to_vec(),
        vec![7; 100],
        good[..good.len() - 1].to_vec(),
        flipped,
        sealed(9, 1, &conditions),
        sealed(2, 99, &conditions),
        sealed(2, 1, &[0xff; 500]),
        sealed(1, 1, &[0xff; 500]),
        nobody(head(1.0, 100.0, [0, 0], 0)),
        nobody(head(1.0, 100.0, [100, 101], 0)),
        nobody(head(0.5, 100.0, [100, 0], 0)),
        nobody(head(f64::NAN, 100.0, [100, 0], 0)),
        nobody(head(1.0, 1e300, [100, 0], 0)),
        nobody(head(1.0, -1.0, [100, 0], 0)),
        of(&[term(2, [-1.0, 0.5, 2.0, 0.1])], &[]),
        of(&[term(2, [1.0, 0.5, -5.0, 0.1])], &[]),
        of(&[term(2, [1.0, 0.5, f32::NAN, 0.1])], &[]),
        of(&[term(2, [1.0, 0.5, 2.0, f32::NAN])], &[]),
        of(&[term(2, [1.0, 0.5, 2.0, -0.1])], &[]),
        of(&[term(99, [1.0, 0.5, 2.0, 0.1])], &[]),
        of(&[white(), white()], &[0.5]),
        of(&vec![white(); 8], &[0.5; 28]),
        of(&[white(), flicker()], &[f32::NAN]),
        of(&[white(), flicker()], &[1.5]),
        of(&[filter(code, 99.5)], &[]),
        of(&[filter(code, 0.0)], &[]),
        of(&[filter(2, 2.0)], &[]),
    ];
    let case = |bytes| refused("a.bin", bytes, "decode a.bin", "a.bin: ");
    let mut cases: Vec<Case> = files.into_iter().map(case).collect();
    cases.push(refused("a.bin", good, "decode a.bin", "").status(0));
    cases
}
