//! No two files of a crate import each other, not even through other files, and what runs for every sample knows no
//! floating-point number.
//!
//! A node of the graph is a file. An edge leads from a file to every file whose items it names, in
//! a `use` declaration or anywhere else. It ends at the file that defines the item, even if the
//! name is re-exported on the way. A re-export (`pub use`) alone is not an edge, and neither is the
//! declaration of a module. The file `mod.rs` of a folder may therefore define what its children
//! use and re-export what they define, but it may not use their items itself. Test modules are left
//! out.

mod cycle;
mod import;
mod promises;
mod seam;
mod source;

use source::Crate;
use std::path::Path;

const HOST: &str = env!("CARGO_MANIFEST_DIR");

/// Describes each group of files that import each other on a line.
fn cycles(of: &Crate) -> Vec<String> {
    let graph = import::graph(of);
    let cycles = cycle::shortest(&graph).into_iter();
    cycles.map(|files| files.join(" → ")).collect()
}

fn assert_no_cycles(root: &Path, files: usize) {
    let of = Crate::read(root);
    let graph = import::graph(&of);
    assert!(
        graph.len() >= files,
        "{} files in {}",
        graph.len(),
        root.display()
    );
    let edges: usize = graph.values().map(|imported| imported.len()).sum();
    assert!(edges >= graph.len(), "{edges} imports");
    let cycles = cycles(&of);
    assert!(
        cycles.is_empty(),
        "files of {} import each other:\n{}",
        root.display(),
        cycles.join("\n")
    );
}

#[test]
fn the_host_tools_have_no_import_cycles() {
    assert_no_cycles(&Path::new(HOST).join("src"), 100);
    assert_no_cycles(&Path::new(HOST).join("xtask/src"), 14);
}

#[test]
fn the_library_has_no_import_cycles() {
    assert_no_cycles(&Path::new(HOST).join("../src"), 60);
    assert_no_cycles(&Path::new(HOST).join("../src/c/src"), 10);
    assert_no_cycles(&Path::new(HOST).join("../src/python/src"), 9);
}

/// What runs for every sample is in `record`: it has no floating-point number, and names nothing that has one.
#[test]
fn what_runs_for_every_sample_has_no_floats() {
    let of = Crate::read(&Path::new(HOST).join("../src"));
    let below: Vec<_> = (of.files.iter())
        .filter(|(name, _)| name.starts_with("record/"))
        .collect();
    assert!(below.len() >= 20, "{} files in record", below.len());
    for (name, file) in below {
        assert_eq!(seam::floats(file), [""; 0], "{name}");
    }
    let allowed = [
        "record/",
        "list.rs",
        "storage/envelope.rs",
        "storage/snapshot.rs",
    ];
    for (name, imported) in import::graph(&of) {
        let outside = imported
            .iter()
            .find(|other| !allowed.iter().any(|file| other.starts_with(file)));
        if let Some(other) = outside.filter(|_| name.starts_with("record/")) {
            panic!("{name} names what is in {other}");
        }
    }
}

#[test]
fn floats_are_found_wherever_they_stand() {
    let text = "fn f(x: Real) -> f32 { assert!(x < 2.5); 1e3 } #[cfg(test)] mod tests { fn g() -> f64 { 0.5 } }";
    let of = Crate::of([("lib.rs", text)].into_iter());
    assert_eq!(
        seam::floats(&of.files["lib.rs"]),
        ["Real", "f32", "2.5", "1e3"]
    );
    let text = "fn f(x: i32) -> u64 { assert!(x < 2); 1_000 }";
    let of = Crate::of([("lib.rs", text)].into_iter());
    assert_eq!(seam::floats(&of.files["lib.rs"]), [""; 0]);
}

/// The cycles of a crate that consists of these files.
fn cycles_of(files: &[(&str, &str)]) -> Vec<String> {
    cycles(&Crate::of(files.iter().copied()))
}

#[test]
fn files_that_import_each_other_are_found() {
    let found = cycles_of(&[
        ("lib.rs", "mod egg; mod hen; mod nest;"),
        (
            "hen.rs",
            "use crate::egg::Egg; pub struct Hen(Egg); pub fn lay() {}",
        ),
        ("egg.rs", "pub struct Egg; fn laid() { super::hen::lay() }"),
        ("nest.rs", "use crate::{egg::Egg, hen};"),
    ]);
    assert_eq!(found, ["egg.rs → hen.rs → egg.rs"]);
}

#[test]
fn a_cycle_through_a_third_file_or_a_macro_is_found() {
    let found = cycles_of(&[
        ("lib.rs", "mod a; mod b; mod c;"),
        ("a.rs", "use crate::b; fn f() { b::f() }"),
        ("b.rs", "pub fn f() { println!(\"{}\", crate::c::NUMBER) }"),
        (
            "c.rs",
            "pub const NUMBER: u8 = self::inner::N; mod inner { pub const N: u8 = 1; fn g() { super::super::a::f() } }",
        ),
    ]);
    assert_eq!(found, ["a.rs → b.rs → c.rs → a.rs"]);
}

#[test]
fn a_reexport_leads_to_the_file_that_defines_the_item() {
    let mut files = [
        ("lib.rs", "pub mod log; pub use log::{Log, Record};"),
        (
            "log/mod.rs",
            "mod record; mod reader; pub use record::*; pub use reader::Reader; pub struct Log(Record);",
        ),
        ("log/record.rs", "pub struct Record;"),
        (
            "log/reader.rs",
            "use super::{Log, Record}; use crate::log; pub struct Reader(log::Record);",
        ),
    ];
    assert_eq!(cycles_of(&files), [""; 0]);
    // In this version of the folder, the parent uses an item that it re-exports.
    let parent = "mod record; mod reader; pub use record::*; pub use reader::Reader; pub struct Log(Reader);";
    files[1].1 = parent;
    let expected = ["log/mod.rs → log/reader.rs → log/mod.rs"];
    assert_eq!(cycles_of(&files), expected);
}

#[test]
fn tests_may_import_anything() {
    let found = cycles_of(&[
        ("lib.rs", "mod a; mod b;"),
        (
            "a.rs",
            "pub fn f() {} #[cfg(test)] mod tests { use crate::b::g; }",
        ),
        ("b.rs", "use crate::a::f; pub fn g() {}"),
    ]);
    assert_eq!(found, [""; 0]);
}
