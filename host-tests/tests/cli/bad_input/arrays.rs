//! Bad NumPy arrays.

use super::{
    case::{Case, refused},
    text::noise,
};

/// An array file with this text as its header.
fn array(header: &str, elements: &[u8]) -> Vec<u8> {
    let length = (header.len() as u16).to_le_bytes();
    [b"\x93NUMPY\x01\0", &length[..], header.as_bytes(), elements].concat()
}

fn header(descr: &str, order: &str, shape: &str) -> String {
    format!("{{'descr': {descr}, 'fortran_order': {order}, 'shape': {shape}, }}\n")
}

pub(crate) fn cases() -> Vec<Case> {
    let floats: Vec<f64> = noise().take(150).map(|count| count as f64).collect();
    let bytes = |floats: &[f64]| {
        floats
            .iter()
            .flat_map(|x| x.to_le_bytes())
            .collect::<Vec<u8>>()
    };
    let good = bytes(&floats);
    let spoilt = |value: f64| {
        let mut floats = floats.clone();
        floats[100] = value;
        array(&header("'<f8'", "False", "(50, 3)"), &bytes(&floats))
    };
    // A single row would be a lost sample.
    let often_spoilt = |value: f64| {
        let mut floats = floats.clone();
        floats
            .iter_mut()
            .skip(4)
            .step_by(6)
            .for_each(|float| *float = value);
        array(&header("'<f8'", "False", "(50, 3)"), &bytes(&floats))
    };
    let of = |descr: &str, order: &str, shape: &str| array(&header(descr, order, shape), &good);
    let shaped = |shape: &str| of("'<f8'", "False", shape);
    let arrays: Vec<(Vec<u8>, &str)> = table! {
        Vec::new() => "the file ends within its header";
        b"\x93NUMPY".to_vec() => "the file ends within its header";
        b"PK\x03\x04 a zip archive of arrays".to_vec() => "this is not a NumPy array file";
        b"\x93NUMPY\x09\0\x10\0abc".to_vec() => "version 9 of the format is not supported";
        b"\x93NUMPY\x02\0\xff\xff\xff\xff".to_vec() => "too many for a plain array";
        b"\x93NUMPY\x01\0\xff\x3f{'descr'".to_vec() => "the file ends within its header";
        array("{}", &good) => "the header has no descr";
        of("'<c16'", "False", "(50, 3)") => "are not plain numbers";
        of("'|O'", "False", "(50, 3)") => "are not plain numbers";
        of("'<f2'", "False", "(50, 3)") => "are not plain numbers";
        of("'<f18446744073709551616'", "False", "(50, 3)") => "are not plain numbers";
        of("[('a', '<i4')]", "False", "(50, 3)") => "a structured array";
        of("'<f8'", "Maybe", "(50, 3)") => "does not give the memory order";
        shaped("50") => "the header gives no shape";
        shaped("(-1,)") => "the header gives no shape";
        shaped("()") => "the array has 0 dimensions";
        shaped("(5, 10, 3)") => "the array has 3 dimensions";
        shaped("(0, 3)") => "a.npy: no rows";
        shaped("(50, 0)") => "the array has 50 rows and 0 columns";
        shaped("(3, 50000)") => "the array has 3 rows and 50000 columns";
        shaped("(18446744073709551615, 3)") => "a.npy: an array of 18446744073709551615 rows is impossible";
        shaped("(1000000000000, 3)") => "the file ends before";
        of("'<f8'", "True", "(1000000000000, 3)") => "the file ends before";
        shaped("(51, 3)") => "a.npy:51: the file ends before the 51 rows that the header declares";
        shaped("(49, 3)") => "a.npy: more data follow the 49 rows that the header declares";
        shaped("(5,)") => "more data follow";
        often_spoilt(f64::NAN) => "a.npy:2: axis gy: NaN is not a finite number";
        often_spoilt(f64::INFINITY) => "a.npy:2: axis gy: inf is not a finite number";
        spoilt(1e300) => "2^-30 of the range";
        array(&header("'<f8'", "False", "(9,)"), &bytes(&[1.5; 9])) => "never changes its value";
    };
    let refused = |(bytes, expected)| refused("a.npy", bytes, "fit a.npy --rate 100", expected);
    arrays.into_iter().map(refused).collect()
}
