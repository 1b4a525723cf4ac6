//! The package for Debian and what follows it.

use super::{
    crates::answer,
    files::{self, Packed},
};
use anyhow::{Context as _, Result, bail};
use std::{
    fs,
    process::Command,
    time::{Duration, UNIX_EPOCH},
};

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
        Packed::new(format!("{documents}/changelog.Debian"), about.changes()),
    ];
    for file in files {
        let mut file = file.clone();
        if file.path.ends_with("/CHANGELOG.md") {
            file.path = format!("{documents}/changelog");
        } else if let Some(name) = file.path.strip_prefix("share/zsh/site-functions/") {
            file.path = format!("share/zsh/vendor-completions/{name}");
        } else if file.path.starts_with(&format!("{documents}/LICENSE-")) {
            // They are in `copyright`.
            continue;
        }
        installed.push(file);
    }
    let to_pack = |path: &&Packed| {
        let ends = ["/changelog", "/changelog.Debian", "/licences-of-crates"];
        path.path.starts_with("share/man/") || ends.iter().any(|end| path.path.ends_with(end))
    };
    let packed: Vec<String> = (installed.iter().filter(to_pack))
        .map(|file| file.path.clone())
        .collect();
    let folder = tempfile::tempdir()?;
    let root = folder.path().join("root");
    files::write(&root.join("usr"), &installed)?;
    files::gzip(&root.join("usr"), &packed)?;

    let mut paths: Vec<String> = (installed.iter())
        .map(|file| match packed.contains(&file.path) {
            true => format!("usr/{}.gz", file.path),
            false => format!("usr/{}", file.path),
        })
        .collect();
    paths.sort();
    let mut sums = Command::new("md5sum");
    let sums = answer(sums.args(&paths).current_dir(&root))?;
    let kib = |path: &String| Ok(fs::metadata(root.join(path))?.len().div_ceil(1024));
    let sizes: Vec<u64> = paths.iter().map(kib).collect::<Result<_>>()?;
    let control = [
        Packed::new("DEBIAN/control", about.control(sizes.iter().sum())?),
        Packed::new("DEBIAN/md5sums", sums),
    ];
    files::write(&root, &control)?;
    let mut build = Command::new("dpkg-deb");
    build
        .args(["--build", "--root-owner-group", "-Zgzip", "root", "package"])
        .current_dir(folder.path())
        .env("SOURCE_DATE_EPOCH", about.epoch.to_string());
    answer(&mut build).context("the package for Debian needs its `dpkg-deb`: install dpkg")?;
    Ok(fs::read(folder.path().join("package"))?)
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

    const ABOUT: About = About {
        version: "0.1.0",
        architecture: "x86_64",
        maintainer: "Somebody <somebody@example.org>",
        epoch: 86_400,
    };

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

        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("package.deb"), first).unwrap();
        let mut list = Command::new("dpkg-deb");
        list.args(["--contents", "package.deb"]).env("TZ", "UTC");
        let contents = answer(list.current_dir(folder.path())).unwrap();
        let paths: Vec<_> = (contents.lines().filter(|line| !line.ends_with('/')))
            .map(|line| line.split_whitespace().last().unwrap())
            .collect();
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
        let of_root = |line: &str| line.contains(" root/root ") && line.contains(" 1970-01-02 ");
        assert!(contents.lines().all(of_root), "{contents}");
        assert!(
            contents.contains("-rwxr-xr-x root/root         7 "),
            "{contents}"
        );
        let mut unpack = Command::new("dpkg-deb");
        unpack.args(["--raw-extract", "package.deb", "raw"]);
        answer(unpack.current_dir(folder.path())).unwrap();
        let raw = folder.path().join("raw");
        let mut changes = Command::new("zcat");
        changes.arg(raw.join("usr/share/doc/allanite/changelog.Debian.gz"));
        let changes = answer(&mut changes).unwrap();
        let signature = " -- Somebody <somebody@example.org>  Fri, 02 Jan 1970 00:00:00 +0000\n";
        assert!(changes.ends_with(signature), "{changes}");
        let sums = fs::read_to_string(raw.join("DEBIAN/md5sums")).unwrap();
        // The MD5 of `program`.
        let sum = "a9c449d4fa44e9e5a41c574ae55ce4d9  usr/bin/allanite\n";
        assert!(sums.starts_with(sum), "{sums}");
        let fields = fs::read_to_string(raw.join("DEBIAN/control")).unwrap();
        assert!(fields.contains("\nArchitecture: amd64\n"), "{fields}");
        let installed = 7 + copyright.len().div_ceil(1024);
        let size = format!("\nInstalled-Size: {installed}\n");
        assert!(fields.contains(&size), "{fields}");
        assert!(copyright.contains("\nCopyright: 2026 "), "{copyright}");
        assert!(
            copyright.contains("\nLicense: Expat\n Permission"),
            "{copyright}"
        );
    }
}
