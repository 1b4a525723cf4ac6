//! The crates that a program consists of.

use crate::firmware::cargo;
use anyhow::{Context as _, Result, bail};
use serde_json::Value;
use std::{
    collections::{BTreeMap, BTreeSet},
    fmt::Write as _,
    fs,
    path::{Path, PathBuf},
    process::Command,
};

/// A crate in the program.
#[derive(Clone, Debug)]
pub(super) struct Crate {
    pub(super) name: String,
    pub(super) version: String,
    /// An expression of SPDX.
    pub(super) license: Option<String>,
    pub(super) repository: Option<String>,
    pub(super) description: Option<String>,
    /// The SHA-256 of the published crate; none of a crate of this project.
    pub(super) checksum: Option<String>,
    pub(super) folder: PathBuf,
    /// The places of what it depends on, among the crates of the program.
    pub(super) depends_on: Vec<usize>,
}

/// What is built.
pub(super) struct Program<'a> {
    pub(super) package: &'a str,
    pub(super) features: &'a str,
    pub(super) target: &'a str,
}

/// The crates whose code is in the program, in the order of their names; the program's own is among them.
pub(super) fn crates(root: &Path, program: &Program) -> Result<Vec<Crate>> {
    let mut tree = cargo();
    tree.current_dir(root).args([
        "tree",
        "--locked",
        "--package",
        program.package,
        "--no-default-features",
        "--features",
        program.features,
        "--target",
        program.target,
    ]);
    tree.args(["--edges", "normal,no-proc-macro", "--prefix", "none"]);
    let linked: BTreeSet<(String, String)> = answer(tree.args(["--format", "{p}"]))?
        .lines()
        .filter_map(|line| {
            let (name, rest) = line.split_once(" v")?;
            let version = rest.split(' ').next()?;
            Some((name.to_owned(), version.to_owned()))
        })
        .collect();
    let mut metadata = cargo();
    metadata.current_dir(root);
    metadata.args(["metadata", "--locked", "--format-version", "1"]);
    metadata.args(["--filter-platform", program.target]);
    let metadata: Value = serde_json::from_str(&answer(&mut metadata)?)?;
    let lock = fs::read_to_string(root.join("Cargo.lock")).context("Cargo.lock")?;
    let checksums = checksums(&lock);

    let text = |value: &Value| value.as_str().map(str::to_owned);
    let mut found = Vec::new();
    for package in metadata["packages"].as_array().context("no packages")? {
        let name = text(&package["name"]).context("a package without a name")?;
        let version = text(&package["version"]).context("a package without a version")?;
        if !linked.contains(&(name.clone(), version.clone())) {
            continue;
        }
        let manifest = text(&package["manifest_path"]).context("a package without a folder")?;
        let folder = Path::new(&manifest).parent().unwrap_or(root).to_owned();
        let license = text(&package["license"]).map(|license| license.replace('/', " OR "));
        found.push((
            text(&package["id"]).context("a package without an id")?,
            Crate {
                checksum: checksums.get(&(name.clone(), version.clone())).cloned(),
                license,
                repository: text(&package["repository"]),
                description: text(&package["description"]),
                folder,
                depends_on: Vec::new(),
                name,
                version,
            },
        ));
    }
    if found.len() != linked.len() {
        bail!(
            "{} crates of {} have no metadata",
            linked.len(),
            found.len()
        );
    }
    found.sort_by(|(_, a), (_, b)| (&a.name, &a.version).cmp(&(&b.name, &b.version)));
    let places: BTreeMap<String, usize> = found
        .iter()
        .enumerate()
        .map(|(place, (id, _))| (id.clone(), place))
        .collect();
    let mut crates: Vec<Crate> = found.into_iter().map(|(_, it)| it).collect();
    let nodes = &metadata["resolve"]["nodes"];
    for node in nodes.as_array().context("no resolution")? {
        let Some(&place) = places.get(node["id"].as_str().unwrap_or_default()) else {
            continue;
        };
        for dependency in node["deps"].as_array().into_iter().flatten() {
            let kinds = dependency["dep_kinds"].as_array();
            let is_normal = kinds.is_some_and(|kinds| kinds.iter().any(|it| it["kind"].is_null()));
            let of = places.get(dependency["pkg"].as_str().unwrap_or_default());
            if let (true, Some(&of)) = (is_normal, of) {
                crates[place].depends_on.push(of);
            }
        }
        crates[place].depends_on.sort_unstable();
        crates[place].depends_on.dedup();
    }
    Ok(crates)
}

/// The checksums of a `Cargo.lock`.
fn checksums(lock: &str) -> BTreeMap<(String, String), String> {
    let package = |text: &str| {
        let value = |key: &str| {
            let mut lines = text.lines();
            let line = lines.find_map(|line| line.strip_prefix(key)?.strip_prefix(" = "));
            line.map(|value| value.trim_matches('"').to_owned())
        };
        Some(((value("name")?, value("version")?), value("checksum")?))
    };
    lock.split("[[package]]").filter_map(package).collect()
}

/// The licences of all crates that are not of this project, with their texts. A text that several crates have in common is
/// there once.
pub(super) fn licences(crates: &[Crate]) -> Result<String> {
    let mut of_text: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let mut list = String::from(
        "The program allanite contains these crates. Their licences follow, each with the crates that it is from.\n\n",
    );
    for it in crates.iter().filter(|it| it.checksum.is_some()) {
        let name = format!("{} {}", it.name, it.version);
        let license = it.license.as_deref().unwrap_or("see below");
        writeln!(list, "{name}: {license}")?;
        let read = fs::read_dir(&it.folder).with_context(|| it.folder.display().to_string());
        let mut paths: Vec<PathBuf> = read?
            .map(|entry| Ok(entry?.path()))
            .collect::<std::io::Result<_>>()?;
        paths.sort();
        for path in paths.iter().filter(|path| is_licence(path)) {
            let bytes = fs::read(path).with_context(|| path.display().to_string())?;
            let text = String::from_utf8_lossy(&bytes).replace('\r', "");
            let names = of_text.entry(text.trim().to_owned()).or_default();
            if names.last() != Some(&name) {
                names.push(name.clone());
            }
        }
    }
    let mut texts: Vec<_> = of_text.into_iter().collect();
    texts.sort_by(|(a, of_a), (b, of_b)| (of_a, a).cmp(&(of_b, b)));
    for (text, names) in texts {
        write!(
            list,
            "\n{}\n{}:\n\n{text}\n",
            "=".repeat(80),
            names.join(", ")
        )?;
    }
    Ok(list)
}

fn is_licence(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let name = name.to_uppercase();
    let begins = |begin: &&str| name.starts_with(*begin);
    let words = [
        "LICENSE",
        "LICENCE",
        "COPYING",
        "COPYRIGHT",
        "NOTICE",
        "UNLICENSE",
    ];
    words.iter().any(begins) && path.is_file()
}

/// What a command prints.
pub(super) fn answer(command: &mut Command) -> Result<String> {
    let shown = crate::step::shown(command);
    let output = command
        .output()
        .with_context(|| format!("`{shown}` did not start"))?;
    if !output.status.success() {
        bail!(
            "`{shown}` failed: {}",
            String::from_utf8_lossy(&output.stderr).trim()
        );
    }
    Ok(String::from_utf8(output.stdout)?)
}
