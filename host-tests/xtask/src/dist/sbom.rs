//! The list of what the program consists of, as CycloneDX 1.5 in JSON.

use super::{crates::Crate, files::hexadecimal};
use anyhow::Result;
use serde_json::{Value, json};
use sha2::{Digest as _, Sha256};
use std::time::{Duration, UNIX_EPOCH};

/// The component that the crates are part of, and the C library that is linked to them.
pub(super) struct Whole<'a> {
    pub(super) version: &'a str,
    /// The name and the version of the C library.
    pub(super) c_library: Option<(&'a str, &'a str)>,
    pub(super) epoch: u64,
}

/// The document.
pub(super) fn document(crates: &[Crate], root: &str, whole: &Whole) -> Result<String> {
    let reference = |it: &Crate| format!("{}@{}", it.name, it.version);
    let program = format!("program:allanite@{}", whole.version);
    let mut components: Vec<Value> = crates.iter().map(component).collect();
    let mut dependencies: Vec<Value> = crates
        .iter()
        .map(|it| {
            let on = it.depends_on.iter().map(|&place| reference(&crates[place]));
            json!({"ref": reference(it), "dependsOn": on.collect::<Vec<_>>()})
        })
        .collect();
    let mut parts: Vec<String> = crates
        .iter()
        .filter(|it| it.name == root)
        .map(reference)
        .collect();
    if let Some((name, version)) = whole.c_library {
        let at = format!("{name}@{version}");
        components.push(json!({
            "type": "library", "bom-ref": at, "name": name, "version": version,
        }));
        parts.push(at);
    }
    dependencies.push(json!({"ref": program, "dependsOn": parts}));
    let time = humantime::format_rfc3339_seconds(UNIX_EPOCH + Duration::from_secs(whole.epoch));
    let mut document = json!({
        "bomFormat": "CycloneDX",
        "specVersion": "1.5",
        "version": 1,
        "metadata": {
            "timestamp": time.to_string(),
            "tools": {"components": [{
                "type": "application",
                "name": "cargo xtask dist",
                "version": env!("CARGO_PKG_VERSION"),
            }]},
            "component": {
                "type": "application",
                "bom-ref": program,
                "name": "allanite",
                "version": whole.version,
                "licenses": [{"expression": "MIT OR Apache-2.0"}],
            },
        },
        "components": components,
        "dependencies": dependencies,
    });
    // A number of its own for every content, so that two builds have the same: a UUID of version 8.
    let hash = Sha256::digest(serde_json::to_vec(&document)?);
    let mut number: [u8; 16] = std::array::from_fn(|i| hash[i]);
    number[6] = 0x80 | number[6] & 0x0F;
    number[8] = 0x80 | number[8] & 0x3F;
    let digits = hexadecimal(&number);
    let groups = [0..8, 8..12, 12..16, 16..20, 20..32].map(|range| &digits[range]);
    document["serialNumber"] = format!("urn:uuid:{}", groups.join("-")).into();
    Ok(serde_json::to_string_pretty(&document)? + "\n")
}

fn component(it: &Crate) -> Value {
    let mut component = json!({
        "type": "library",
        "bom-ref": format!("{}@{}", it.name, it.version),
        "name": it.name,
        "version": it.version,
    });
    if let Some(description) = &it.description {
        component["description"] = description.trim().into();
    }
    if let Some(license) = &it.license {
        component["licenses"] = json!([{"expression": license}]);
    }
    if let Some(checksum) = &it.checksum {
        component["hashes"] = json!([{"alg": "SHA-256", "content": checksum}]);
        // A `+` in a version is `%2B` in a purl.
        let version = it.version.replace('+', "%2B");
        component["purl"] = format!("pkg:cargo/{}@{version}", it.name).into();
    }
    if let Some(repository) = &it.repository {
        component["externalReferences"] = json!([{"type": "vcs", "url": repository}]);
    }
    component
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        dist::crates::{Program, crates, licences},
        firmware::workspace,
    };
    use std::collections::BTreeSet;

    /// The parts of this package itself, which is small.
    #[test]
    fn document_names_every_crate_once_with_its_licence_and_checksum() {
        let program = Program {
            package: "xtask",
            features: "dist",
            target: "x86_64-unknown-linux-gnu",
        };
        let crates = crates(workspace(), &program).unwrap();
        let whole = Whole {
            version: "0.1.0",
            c_library: Some(("glibc", "2.36")),
            epoch: 86_400,
        };
        let text = document(&crates, program.package, &whole).unwrap();
        assert_eq!(document(&crates, program.package, &whole).unwrap(), text);
        let document: Value = serde_json::from_str(&text).unwrap();
        assert_eq!(document["bomFormat"], "CycloneDX");
        assert_eq!(document["specVersion"], "1.5");
        assert_eq!(document["metadata"]["timestamp"], "1970-01-02T00:00:00Z");
        let serial = document["serialNumber"].as_str().unwrap();
        assert_eq!(serial.len(), "urn:uuid:".len() + 36);

        let components = document["components"].as_array().unwrap();
        assert_eq!(components.len(), crates.len() + 1);
        let field = |value: &Value, name: &str| value[name].as_str().map(str::to_owned);
        let mut references = BTreeSet::new();
        for component in components {
            assert_eq!(component["type"], "library");
            assert!(references.insert(field(component, "bom-ref").unwrap()));
            let (name, version) = (field(component, "name"), field(component, "version"));
            assert!(name.is_some_and(|it| !it.is_empty()) && version.is_some());
        }
        let of = |name: &str| components.iter().find(|it| it["name"] == name).unwrap();
        let sha2 = of("sha2");
        assert_eq!(sha2["licenses"][0]["expression"], "MIT OR Apache-2.0");
        assert_eq!(field(&sha2["hashes"][0], "content").unwrap().len(), 64);
        let purl = field(sha2, "purl").unwrap();
        assert_eq!(
            purl,
            format!("pkg:cargo/sha2@{}", field(sha2, "version").unwrap())
        );
        // A macro is not in the program.
        assert!(!components.iter().any(|it| it["name"] == "clap_derive"));

        references.insert(field(&document["metadata"]["component"], "bom-ref").unwrap());
        let dependencies = document["dependencies"].as_array().unwrap();
        assert!(dependencies.len() > crates.len());
        for dependency in dependencies {
            assert!(references.contains(&field(dependency, "ref").unwrap()));
            for on in dependency["dependsOn"].as_array().unwrap() {
                assert!(references.contains(on.as_str().unwrap()), "{on}");
            }
        }
        let own = dependencies.iter().find(|it| it["ref"] == "xtask@0.1.0");
        let own = own.unwrap()["dependsOn"].to_string();
        assert!(own.contains("\"sha2@") && own.contains("\"clap@"), "{own}");

        let licences = licences(&crates).unwrap();
        assert!(licences.contains("\nsha2 ") && !licences.contains("\nxtask "));
        assert!(licences.matches("Permission is hereby granted").count() > 3);
    }
}
