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
mod manifest;
mod promises;
mod script;
mod seam;
mod source;
mod verdict;
mod words;

use source::Crate;
use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::Path,
};

const HOST: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/..");

/// Describes each group of files that import each other on a line.
fn cycles(of: &Crate) -> Vec<String> {
    cycles_in(&import::graph(of))
}

fn cycles_in(graph: &import::Graph) -> Vec<String> {
    let cycles = cycle::shortest(graph).into_iter();
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
    for (package, files) in [
        ("log", 80),
        ("host", 30),
        ("plot", 15),
        ("cli", 100),
        ("studies", 40),
    ] {
        assert_no_cycles(&Path::new(HOST).join(package).join("src"), files);
    }
    assert_no_cycles(&Path::new(HOST).join("xtask/src"), 14);
    assert_no_cycles(&Path::new(HOST).join("fleet/src"), 9);
}

#[test]
fn the_files_of_python_do_not_import_each_other() {
    let files = script::files(
        &Path::new(HOST).join("../src/python/python/allanite"),
        ".py",
    );
    let graph = script::python(&files, "allanite");
    let imports: usize = graph.values().map(BTreeSet::len).sum();
    assert!(
        graph.len() >= 18 && imports >= 40,
        "{} files, {imports} imports",
        graph.len()
    );
    assert_eq!(cycles_in(&graph), [""; 0]);
}

#[test]
fn the_scripts_of_pages_do_not_import_each_other_and_never_the_program() {
    for (folder, least) in [("page", 8), ("cli/src/report", 10)] {
        let files = script::files(&Path::new(HOST).join(folder), ".js");
        assert!(files.len() >= least, "{} files in {folder}", files.len());
        assert_eq!(cycles_in(&script::javascript(&files)), [""; 0]);
        for (name, text) in files {
            assert!(
                !text.contains("cli/src"),
                "{folder}/{name} names the program"
            );
        }
    }
}

#[test]
fn circles_of_python_and_of_javascript_are_found() {
    let files = |all: &[(&str, &str)]| {
        let owned = all
            .iter()
            .map(|&(name, text)| (name.to_owned(), text.to_owned()));
        owned.collect::<script::Files>()
    };
    let python = files(&[
        ("__init__.py", "from . import egg\nfrom .hen import Hen"),
        (
            "egg.py",
            "import os\nif TYPE_CHECKING:\n    from .hen import (\n        Hen,\n    )",
        ),
        ("hen.py", "from . import (\n    nest as built,\n)"),
        ("nest.py", "def lay():\n    import allanite.egg"),
    ]);
    let found = cycles_in(&script::python(&python, "allanite"));
    assert_eq!(found, ["egg.py → hen.py → nest.py → egg.py"]);
    let scripts = files(&[
        ("a.js", "import { b } from \"./deep/b.js\";"),
        ("deep/b.js", "const a = await import('../a.js');"),
        ("c.js", "import \"./a.js\";"),
    ]);
    let found = cycles_in(&script::javascript(&scripts));
    assert_eq!(found, ["a.js → deep/b.js → a.js"]);
}

/// Every package, and the folder of its manifest below `host-tests`.
const PACKAGES: [(&str, &str); 13] = [
    ("allanite", ".."),
    ("allanite-c", "../src/c"),
    ("allanite-log", "log"),
    ("allanite-plot", "plot"),
    ("allanite-host", "host"),
    ("allanite-cli", "cli"),
    ("allanite-python", "../src/python"),
    ("allanite-fleet", "fleet"),
    ("allanite-studies", "studies"),
    ("fuzz", "fuzz"),
    ("images", "../src/bin"),
    ("program", "tests/program"),
    ("xtask", "xtask"),
];

/// What may not be built from what. A program or a package that others install knows no tools of the project.
const LAWS: [manifest::Law<'_>; 5] = [
    (
        &["allanite"],
        &[
            "allanite-log",
            "allanite-plot",
            "allanite-host",
            "allanite-cli",
        ],
    ),
    (
        &["allanite-log", "allanite-plot"],
        &["allanite-host", "allanite-cli"],
    ),
    (&["allanite-host"], &["allanite-cli"]),
    // They get types, not what the command line prints.
    (&["allanite-python", "allanite-fleet"], &["allanite-cli"]),
    (
        &[
            "allanite",
            "allanite-c",
            "allanite-log",
            "allanite-plot",
            "allanite-host",
            "allanite-cli",
            "allanite-python",
            "allanite-fleet",
        ],
        &["allanite-studies", "fuzz", "program", "xtask"],
    ),
];

#[test]
fn packages_are_built_from_those_below_them_alone() {
    let mut packages = BTreeMap::new();
    for (name, folder) in PACKAGES {
        let path = Path::new(HOST).join(folder).join("Cargo.toml");
        let text =
            fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        assert!(
            text.contains(&format!("name = \"{name}\"")),
            "{name} is not in {folder}"
        );
        packages.insert(name, manifest::dependencies(&text));
    }
    assert!(packages["allanite-cli"].contains("allanite-host"));
    assert_eq!(manifest::breaches(&packages, &LAWS), [""; 0]);
}

#[test]
fn a_package_that_is_built_from_one_above_it_is_found() {
    let manifests = [
        (
            "allanite-log",
            "[dependencies]\nserde = \"1\"\n[dev-dependencies]\nxtask = { path = \"../xtask\" }",
        ),
        (
            "allanite-host",
            "[dependencies]\nallanite-log.workspace = true\n[target.'cfg(unix)'.dependencies]\nshown = { package = \"allanite-cli\" }",
        ),
        (
            "allanite-cli",
            "[dependencies.xtask]\npath = \"../xtask\"\noptional = true",
        ),
        ("xtask", ""),
    ];
    let packages = manifests.map(|(name, text)| (name, manifest::dependencies(text)));
    let found = manifest::breaches(&BTreeMap::from(packages), &LAWS);
    let expected = [
        "allanite-host is built from allanite-cli: allanite-host → allanite-cli",
        "allanite-host is built from xtask: allanite-host → allanite-cli → xtask",
        "allanite-cli is built from xtask: allanite-cli → xtask",
    ];
    assert_eq!(found, expected);
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
