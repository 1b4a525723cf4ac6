//! The package for Debian and what follows it.

use super::files::{Packed, gzip, hexadecimal, tar};
use anyhow::{Result, bail};
use md5::{Digest as _, Md5};
use std::time::{Duration, UNIX_EPOCH};

/// What the package says of itself.
pub(super) struct About<'a> {
    /// The version of the program.
    pub(super) version: &'a str,
    /// The architecture as Rust names it, such as x86_64.
    pub(super) architecture: &'a str,
    /// Who answers for the package: a name, and an address in `<>`.
    pub(super) maintainer: &'a str,
    pub(super) epoch: u64,
}

impl About<'_> {
    /// The architecture as Debian names it.
    fn architecture(&self) -> Result<&'static str> {
        Ok(match self.architecture {
            "x86_64" => "amd64",
            "aarch64" => "arm64",
            "riscv64gc" => "riscv64",
            other => bail!("the name of {other} at Debian is not known: add it to deb.rs"),
        })
    }

    /// The version of the package: the first one of this version of the program.
    fn version(&self) -> String {
        format!("{}-1", self.version)
    }

    /// The name of the file.
    pub(super) fn file(&self) -> Result<String> {
        Ok(format!(
            "allanite_{}_{}.deb",
            self.version(),
            self.architecture()?
        ))
    }

    fn control(&self, installed_kib: u64) -> Result<String> {
        Ok(format!(
            "Package: allanite\n\
             Version: {}\n\
             Architecture: {}\n\
             Maintainer: {}\n\
             Installed-Size: {installed_kib}\n\
             Section: science\n\
             Priority: optional\n\
             Description: noise coefficients of gyros and accelerometers from recorded logs\n \
             Allan curves, the five terms of IEEE Std 952 with intervals, and a diagnosis\n \
             that names the effects they lack: from logs as text, bags of ROS, flight logs\n \
             and tables of data science, to pages, pictures and the models of filters.\n \
             .\n \
             The program needs no library and no network.\n",
            self.version(),
            self.architecture()?,
            self.maintainer,
        ))
    }

    /// The changes of the package, which Debian asks for beside those of the program.
    fn changes(&self) -> String {
        let time = httpdate::fmt_http_date(UNIX_EPOCH + Duration::from_secs(self.epoch));
        format!(
            "allanite ({}) unstable; urgency=medium\n\n  * Version {} of the program: see changelog.gz.\n\n -- {}  {}\n",
            self.version(),
            self.version,
            self.maintainer,
            time.replace("GMT", "+0000"),
        )
    }
}

/// What Debian's checker reports and is right here: a static program that can be loaded anywhere looks like a library, and the
/// package answers no request for a package.
const OVERRIDES: &str = "allanite: shared-library-lacks-prerequisites [usr/bin/allanite]\n\
    allanite: initial-upload-closes-no-bugs *\n";

/// The package with files that are installed below `/usr`. Pages of `man`, changes and licences of others are packed, as Debian
/// asks for.
pub(super) fn package(files: &[Packed], copyright: &str, about: &About) -> Result<Vec<u8>> {
    let documents = "share/doc/allanite";
    let mut installed = vec![
        Packed::new(format!("{documents}/copyright"), copyright),
        Packed::new("share/lintian/overrides/allanite", OVERRIDES),
        Packed::new(
            format!("{documents}/changelog.Debian.gz"),
            gzip(about.changes().as_bytes())?,
        ),
    ];
    for file in files {
        let path = &file.path;
        installed.push(
            if path.starts_with("share/man/") || path.ends_with("/licences-of-crates") {
                Packed::new(format!("{path}.gz"), gzip(&file.bytes)?)
            } else if path.ends_with("/CHANGELOG.md") {
                Packed::new(format!("{documents}/changelog.gz"), gzip(&file.bytes)?)
            } else if let Some(name) = path.strip_prefix("share/zsh/site-functions/") {
                Packed::new(format!("share/zsh/vendor-completions/{name}"), &*file.bytes)
            } else if path.starts_with(&format!("{documents}/LICENSE-")) {
                // They are in `copyright`.
                continue;
            } else {
                file.clone()
            },
        );
    }
    installed.sort();
    let kib = |file: &Packed| (file.bytes.len() as u64).div_ceil(1024);
    let control = about.control(installed.iter().map(kib).sum())?;
    let sum = |file: &Packed| {
        let sum = hexadecimal(&Md5::digest(&file.bytes));
        format!("{sum}  usr/{}\n", file.path)
    };
    let sums: String = installed.iter().map(sum).collect();
    let control = [
        Packed::new("control", control),
        Packed::new("md5sums", sums),
    ];
    let parts = [
        ("debian-binary", b"2.0\n".to_vec()),
        ("control.tar.gz", gzip(&tar(&control, ".", about.epoch)?)?),
        (
            "data.tar.gz",
            gzip(&tar(&installed, "./usr", about.epoch)?)?,
        ),
    ];
    let mut archive = ar::Builder::new(Vec::new());
    for (name, bytes) in parts {
        let mut header = ar::Header::new(name.into(), bytes.len() as u64);
        header.set_mode(0o100_644);
        header.set_mtime(about.epoch);
        archive.append(&header, &*bytes)?;
    }
    Ok(archive.into_inner()?)
}

/// The licences of the program, in the form that Debian reads.
pub(super) fn copyright(mit: &str, c_library: Option<(&str, &str)>) -> Result<String> {
    let is_holder = |line: &&str| line.starts_with("Copyright");
    let Some(holder) = mit.lines().find(is_holder) else {
        bail!("LICENSE-MIT names no holder of the copyright");
    };
    let holder = holder.trim_start_matches("Copyright (c) ");
    let (_, terms) = mit.split_once(holder).unwrap_or_default();
    let terms: String = terms
        .trim()
        .lines()
        .map(|line| {
            if line.is_empty() {
                " .\n".into()
            } else {
                format!(" {line}\n")
            }
        })
        .collect();
    let linked = match c_library {
        Some((name, version)) => format!(
            " It is linked with {name} {version}, which has the licence LGPL-2.1-or-later. The\n \
             source of the program builds it with any other version: `cargo xtask dist`.\n"
        ),
        None => String::new(),
    };
    Ok(format!(
        "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/\n\
         Upstream-Name: allanite\n\
         Comment: The licences of the crates in the program are in licences-of-crates.gz\n \
         beside this file.\n{linked}\n\
         Files: *\n\
         Copyright: {holder}\n\
         License: Expat or Apache-2.0\n\n\
         License: Expat\n{terms}\n\
         License: Apache-2.0\n \
         On Debian systems, the text of the licence is in\n \
         /usr/share/common-licenses/Apache-2.0.\n"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read as _;

    const ABOUT: About = About {
        version: "0.1.0",
        architecture: "x86_64",
        maintainer: "Somebody <somebody@example.org>",
        epoch: 86_400,
    };

    fn parts(package: &[u8]) -> Vec<(String, Vec<u8>)> {
        let mut archive = ar::Archive::new(package);
        let mut parts = Vec::new();
        while let Some(entry) = archive.next_entry() {
            let mut entry = entry.unwrap();
            let name = String::from_utf8(entry.header().identifier().to_vec()).unwrap();
            assert_eq!(entry.header().mtime(), ABOUT.epoch);
            let mut bytes = Vec::new();
            entry.read_to_end(&mut bytes).unwrap();
            parts.push((name, bytes));
        }
        parts
    }

    fn unpacked(gz: &[u8]) -> Vec<u8> {
        let mut bytes = Vec::new();
        flate2::read::GzDecoder::new(gz)
            .read_to_end(&mut bytes)
            .unwrap();
        bytes
    }

    fn texts(archive: &[u8]) -> Vec<(String, Vec<u8>)> {
        let mut archive = tar::Archive::new(archive);
        let entries = archive.entries().unwrap();
        let read = entries.map(|entry| {
            let mut entry = entry.unwrap();
            let mut bytes = Vec::new();
            entry.read_to_end(&mut bytes).unwrap();
            let path = String::from_utf8(entry.path_bytes().into_owned()).unwrap();
            (path, bytes)
        });
        read.filter(|(path, _)| !path.ends_with('/')).collect()
    }

    #[test]
    fn package_is_the_same_in_any_order_and_holds_what_debian_asks_for() {
        let mut files = vec![
            Packed::new("bin/allanite", "program"),
            Packed::new("share/man/man1/allanite.1", "page"),
            Packed::new("share/zsh/site-functions/_allanite", "script"),
            Packed::new("share/doc/allanite/CHANGELOG.md", "changes"),
            Packed::new("share/doc/allanite/LICENSE-MIT", "licence"),
            Packed::new("share/doc/allanite/licences-of-crates", "licences"),
        ];
        files[0].is_program = true;
        let mit = include_str!("../../../../LICENSE-MIT");
        let copyright = copyright(mit, Some(("glibc", "2.36"))).unwrap();
        let package = |files: &[Packed]| super::package(files, &copyright, &ABOUT).unwrap();
        let first = package(&files);
        files.reverse();
        assert_eq!(package(&files), first);

        let parts = parts(&first);
        let names: Vec<_> = parts.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["debian-binary", "control.tar.gz", "data.tar.gz"]);
        assert_eq!(parts[0].1, b"2.0\n");
        let data = texts(&unpacked(&parts[2].1));
        let paths: Vec<_> = data.iter().map(|(path, _)| path.as_str()).collect();
        assert_eq!(
            paths,
            [
                "./usr/bin/allanite",
                "./usr/share/doc/allanite/changelog.Debian.gz",
                "./usr/share/doc/allanite/changelog.gz",
                "./usr/share/doc/allanite/copyright",
                "./usr/share/doc/allanite/licences-of-crates.gz",
                "./usr/share/lintian/overrides/allanite",
                "./usr/share/man/man1/allanite.1.gz",
                "./usr/share/zsh/vendor-completions/_allanite",
            ]
        );
        let changes = String::from_utf8(unpacked(&data[1].1)).unwrap();
        let signature = " -- Somebody <somebody@example.org>  Fri, 02 Jan 1970 00:00:00 +0000\n";
        assert!(changes.ends_with(signature), "{changes}");
        let control = texts(&unpacked(&parts[1].1));
        assert_eq!(control[0].0, "./control");
        let fields = String::from_utf8(control[0].1.clone()).unwrap();
        assert!(fields.contains("\nArchitecture: amd64\n"), "{fields}");
        let installed = 7 + copyright.len().div_ceil(1024);
        let size = format!("\nInstalled-Size: {installed}\n");
        assert!(fields.contains(&size), "{fields}");
        let sums = String::from_utf8(control[1].1.clone()).unwrap();
        // The MD5 of `program`.
        let sum = "a9c449d4fa44e9e5a41c574ae55ce4d9  usr/bin/allanite\n";
        assert!(sums.starts_with(sum), "{sums}");
        assert!(copyright.contains("\nCopyright: 2026 "), "{copyright}");
        assert!(
            copyright.contains("\nLicense: Expat\n Permission"),
            "{copyright}"
        );
    }
}
