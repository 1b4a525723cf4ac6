//! Finds which package depends on which, from the manifests.

use std::collections::{BTreeMap, BTreeSet};

/// The packages that a package is built from: those of its tests are left out.
pub(crate) fn dependencies(manifest: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    let mut counts = false;
    for line in manifest.lines().map(str::trim) {
        if let Some(section) = line.strip_prefix('[') {
            let section = section.trim_end_matches(']');
            let last = section.rsplit('.').next().unwrap_or(section);
            counts = matches!(last, "dependencies" | "build-dependencies");
            // `[dependencies.name]` is a section of its own.
            if let Some((before, name)) = section.rsplit_once('.')
                && matches!(before, "dependencies" | "build-dependencies")
            {
                found.insert(unquoted(name));
            }
            continue;
        }
        if let Some((name, rest)) = line.split_once('=').filter(|_| counts) {
            found.insert(unquoted(name.trim()));
            // A package may have another name than the crate that is imported.
            if let Some((_, renamed)) = rest.split_once("package = \"") {
                found.insert(renamed.split('"').next().unwrap_or_default().to_owned());
            }
        }
    }
    found
}

fn unquoted(name: &str) -> String {
    name.trim_matches('"').to_owned()
}

/// A law: packages, and those that they may not be built from, not even through others.
pub(crate) type Law<'a> = (&'a [&'a str], &'a [&'a str]);

/// What breaks the laws: `host is built from cli: host → cli`.
pub(crate) fn breaches(
    packages: &BTreeMap<&str, BTreeSet<String>>,
    laws: &[Law<'_>],
) -> Vec<String> {
    let mut found = Vec::new();
    for (below, above) in laws {
        for package in *below {
            let mut ways = vec![vec![*package]];
            let mut seen = BTreeSet::new();
            while let Some(way) = ways.pop() {
                let last = way[way.len() - 1];
                if above.contains(&last) {
                    found.push(format!(
                        "{package} is built from {last}: {}",
                        way.join(" → ")
                    ));
                }
                let next = packages.get(last).into_iter().flatten();
                for name in next.filter(|name| packages.contains_key(name.as_str())) {
                    if seen.insert(name.as_str()) {
                        ways.push([&way[..], &[name.as_str()]].concat());
                    }
                }
            }
        }
    }
    found
}
