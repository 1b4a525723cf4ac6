//! Inputs of few bytes that unpack to many, or claim to be large.

use super::super::{
    case::{Case, refused},
    text::gzip,
};
use arrow::{
    array::{ArrayRef, Float64Array, RecordBatch},
    ipc::{
        CompressionType,
        writer::{FileWriter, IpcWriteOptions},
    },
};
use flate2::{Compression, write::ZlibEncoder};
use parquet::{
    arrow::ArrowWriter,
    basic::{Compression as Packing, ZstdLevel},
    file::properties::WriterProperties,
};
use std::{io::Write as _, sync::Arc};

/// Packs bytes as a workbook's archive does.
fn deflated(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = flate2::write::DeflateEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

/// An archive of these files.
fn archive(files: &[(&str, Vec<u8>)]) -> Vec<u8> {
    let (mut archive, mut directory) = (Vec::new(), Vec::new());
    for (name, bytes) in files {
        let packed = deflated(bytes);
        let mut checksum = flate2::Crc::new();
        checksum.update(bytes);
        let at = archive.len() as u32;
        let mut head = vec![20, 0, 0, 0, 8, 0, 0, 0, 0, 0];
        head.extend(checksum.sum().to_le_bytes());
        head.extend((packed.len() as u32).to_le_bytes());
        head.extend((bytes.len() as u32).to_le_bytes());
        head.extend((name.len() as u16).to_le_bytes());
        head.extend([0, 0]);
        archive.extend(b"PK\x03\x04");
        archive.extend(&head);
        archive.extend(name.as_bytes());
        archive.extend(packed);
        directory.extend(b"PK\x01\x02\x14\0");
        directory.extend(&head);
        directory.extend([0; 10]);
        directory.extend(at.to_le_bytes());
        directory.extend(name.as_bytes());
    }
    let start = archive.len() as u32;
    let count = (files.len() as u16).to_le_bytes();
    archive.extend(&directory);
    archive.extend(b"PK\x05\x06\0\0\0\0");
    archive.extend([count, count].concat());
    archive.extend((directory.len() as u32).to_le_bytes());
    archive.extend(start.to_le_bytes());
    archive.extend([0, 0]);
    archive
}

/// A workbook with this text as the rows of its sheet.
fn workbook(rows: &str, shared: &str) -> Vec<u8> {
    let name = "http://schemas.openxmlformats.org";
    let sheet = format!(
        "<?xml version=\"1.0\"?><worksheet xmlns=\"{name}/spreadsheetml/2006/main\"><sheetData>{rows}</sheetData></worksheet>"
    );
    let book = format!(
        "<?xml version=\"1.0\"?><workbook xmlns=\"{name}/spreadsheetml/2006/main\" \
         xmlns:r=\"{name}/officeDocument/2006/relationships\"><sheets>\
         <sheet name=\"a\" sheetId=\"1\" r:id=\"r1\"/></sheets></workbook>"
    );
    let relations = format!(
        "<?xml version=\"1.0\"?><Relationships xmlns=\"{name}/package/2006/relationships\">\
         <Relationship Id=\"r1\" Type=\"{name}/officeDocument/2006/relationships/worksheet\" Target=\"worksheets/sheet1.xml\"/>\
         <Relationship Id=\"r2\" Type=\"{name}/officeDocument/2006/relationships/sharedStrings\" Target=\"sharedStrings.xml\"/>\
         </Relationships>"
    );
    let strings = format!(
        "<?xml version=\"1.0\"?><sst xmlns=\"{name}/spreadsheetml/2006/main\">{shared}</sst>"
    );
    let root = format!(
        "<?xml version=\"1.0\"?><Relationships xmlns=\"{name}/package/2006/relationships\">\
         <Relationship Id=\"r1\" Type=\"{name}/officeDocument/2006/relationships/officeDocument\" Target=\"xl/workbook.xml\"/>\
         </Relationships>"
    );
    archive(&[
        ("_rels/.rels", root.into_bytes()),
        ("xl/workbook.xml", book.into_bytes()),
        ("xl/_rels/workbook.xml.rels", relations.into_bytes()),
        ("xl/sharedStrings.xml", strings.into_bytes()),
        ("xl/worksheets/sheet1.xml", sheet.into_bytes()),
    ])
}

fn workbooks() -> Vec<Vec<u8>> {
    let cell = |place: &str| format!("<c r=\"{place}\"><v>1</v></c>");
    let row = |number: u32, cells: &str| format!("<row r=\"{number}\">{cells}</row>");
    let few = format!("{}{}", row(1, &cell("A1")), row(2, &cell("A2")));
    vec![
        workbook(&few, ""),
        // Two cells in the opposite corners of a sheet.
        workbook(
            &format!(
                "{}{}",
                row(1, &cell("A1")),
                row(1_048_576, &cell("XFD1048576"))
            ),
            "",
        ),
        workbook(
            &format!(
                "{}{}",
                row(1, &cell("A1")),
                row(1_048_576, &cell("C1048576"))
            ),
            "",
        ),
        // A sheet and texts of some hundred megabytes.
        workbook(&row(1, &cell("A1")).repeat(3_000_000), ""),
        workbook(&few, &"<si><t>aaaaaaaaaa</t></si>".repeat(4_000_000)),
        workbook(
            &few,
            &format!("<si><t>{}</t></si>", "a".repeat(100_000_000)),
        ),
        workbook(&(few.clone() + &" ".repeat(200_000_000)), ""),
    ]
}

/// A file of Parquet with so many zeros in a page.
fn parquet(rows: usize, is_packed: bool, pages: usize) -> Vec<u8> {
    let column: ArrayRef = Arc::new(Float64Array::from(vec![0.0; rows]));
    let names = ["gx", "gy", "gz"].map(|name| (name, column.clone()));
    let batch = RecordBatch::try_from_iter(names).unwrap();
    let properties = WriterProperties::builder()
        .set_dictionary_enabled(!is_packed)
        .set_compression(Packing::ZSTD(ZstdLevel::try_new(3).unwrap()))
        .set_data_page_size_limit(rows * 9 / pages)
        .set_data_page_row_count_limit(rows / pages)
        .set_write_batch_size(rows / pages)
        .build();
    let mut writer = ArrowWriter::try_new(Vec::new(), batch.schema(), Some(properties)).unwrap();
    writer.write(&batch).unwrap();
    writer.into_inner().unwrap()
}

/// A file of Arrow with so many zeros in a batch.
fn arrow_file(rows: usize) -> Vec<u8> {
    let column: ArrayRef = Arc::new(Float64Array::from(vec![0.0; rows]));
    let batch = RecordBatch::try_from_iter([("gx", column.clone()), ("gy", column)]).unwrap();
    let options = IpcWriteOptions::default()
        .try_with_compression(Some(CompressionType::ZSTD))
        .unwrap();
    let mut writer =
        FileWriter::try_new_with_options(Vec::new(), &batch.schema(), options).unwrap();
    writer.write(&batch).unwrap();
    writer.finish().unwrap();
    writer.into_inner().unwrap()
}

/// An array of MATLAB, packed.
fn matlab(rows: u32, claimed: u32) -> Vec<u8> {
    let word = |value: u32| value.to_le_bytes();
    let mut array = Vec::new();
    array.extend([word(6), word(8), word(6), word(0)].concat());
    array.extend([word(5), word(8), word(claimed), word(1)].concat());
    array.extend([word(1), word(2), *b"gx\0\0", word(0)].concat());
    array.extend([word(9), word(8 * rows)].concat());
    array.resize(array.len() + 8 * rows as usize, 0);
    let element = [&word(14)[..], &word(array.len() as u32), &array].concat();
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(&element).unwrap();
    let packed = encoder.finish().unwrap();
    let mut file = b"MATLAB 5.0 MAT-file".to_vec();
    file.resize(124, b' ');
    file.extend([0, 1, b'I', b'M']);
    file.extend([word(15), word(packed.len() as u32)].concat());
    file.extend(packed);
    file
}

pub(super) fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    let mut add = |name: &str, bytes: Vec<u8>| {
        assert!(bytes.len() <= 1 << 20, "{name}: {} bytes", bytes.len());
        let command = format!("diagnose {name} --rate 100");
        cases.push(refused(name, bytes, &command, "").ambiguous());
    };
    for bytes in workbooks() {
        add("a.xlsx", bytes);
    }
    for (rows, is_packed, pages) in [
        (30_000_000, true, 1),
        (30_000_000, true, 100),
        (60_000_000, false, 1),
        (1_000_000, true, 1),
    ] {
        add("a.parquet", parquet(rows, is_packed, pages));
    }
    for rows in [1_000_000, 30_000_000] {
        add("a.arrow", arrow_file(rows));
    }
    for (rows, claimed) in [
        (1000, 1000),
        (30_000_000, 30_000_000),
        (1000, u32::MAX),
        (1000, 0),
    ] {
        add("a.mat", matlab(rows, claimed));
    }
    let megabyte = 1 << 20;
    for text in [
        ",".repeat(megabyte),
        "\"".repeat(megabyte),
        "\n".repeat(megabyte),
        "1".repeat(megabyte),
        "a,".repeat(megabyte / 2),
        "#\n".repeat(megabyte / 2),
        "1\n".repeat(megabyte / 2),
        "1,".repeat(100) + "\n",
        "\"\n".repeat(megabyte / 2),
        "1,2,3\n\n".repeat(megabyte / 7),
        "1;2,3 4\t5\n".repeat(megabyte / 10),
        "2026-01-01T00:00:00Z,1\n".repeat(megabyte / 23),
        (0..90_000)
            .map(|i| format!("{i},{}\n", i * 7 % 11))
            .collect::<String>(),
        (0..4000)
            .map(|i| format!("{i}{}\n", ",1".repeat(120)))
            .collect::<String>(),
        "x,".repeat(255) + "x\n" + &("1,".repeat(255) + "1\n").repeat(2000),
        "time,".to_owned() + &"t".repeat(megabyte - 100) + "\n1,2\n",
    ] {
        let mut text = text.into_bytes();
        text.truncate(megabyte);
        add("a.csv", text.clone());
        add("a.csv.gz", gzip(&text));
        add("a.gz", gzip(&gzip(&text.repeat(20))));
    }
    add("a.csv.gz", gzip(&b"1,2,3\n".repeat(30_000_000)));
    add("a.csv.gz", gzip(&vec![b'1'; 300_000_000]));
    add("a.csv.gz", gzip(b"1,2,3\n").repeat(40_000));
    add("a.json", "[".repeat(megabyte).into_bytes());
    add(
        "a.json",
        format!("{{\"format\":\"{}\"}}", "x".repeat(megabyte - 20)).into_bytes(),
    );
    cases
}
