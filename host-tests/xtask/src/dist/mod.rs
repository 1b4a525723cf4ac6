//! Packs the program for others to install: a static program, its completions, its pages of `man`, a package for Debian, an
//! archive for other systems, the list of what is in it, and checksums. Each file is the same bytes wherever it is built.

mod alone;
mod crates;
mod deb;
mod files;
mod sbom;

use crate::{
    firmware::{cargo, target_directory, workspace},
    page,
    step::step,
    supply_chain::{Copy, SOURCES, cargo_home},
};
use anyhow::{Context as _, Result, bail, ensure};
use crates::{Program, answer};
use files::{Packed, archive, hexadecimal};
use sha2::{Digest as _, Sha256};
use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

const VERSION: &str = env!("CARGO_PKG_VERSION");

/// The parts of the program.
const FEATURES: &str = "bags,pictures,tables,watch";

/// Who answers for the package, unless the variables DEBFULLNAME and DEBEMAIL say so. The address is left for the owner to give;
/// this one is nobody's, and Debian's programs read no package without any.
const MAINTAINER: &str = "The allanite developers";
const ADDRESS: &str = "root@localhost";

/// The shells, the names of their scripts, and where they look for them.
const SHELLS: [(&str, &str); 3] = [
    ("bash", "share/bash-completion/completions/allanite"),
    ("fish", "share/fish/vendor_completions.d/allanite.fish"),
    ("zsh", "share/zsh/site-functions/_allanite"),
];

/// Where the program is built from, and how.
struct Build {
    root: PathBuf,
    artefacts: PathBuf,
    target: String,
    /// The time of everything in the packages, in seconds since 1970.
    epoch: u64,
}

/// Packs everything into a folder. With `check`, builds all of it once more from nothing, in another folder, and compares.
pub(crate) fn run(output: &Path, check: bool) -> Result<()> {
    let compiler = answer(Command::new(rustc()).arg("-vV"))?;
    let host = compiler
        .lines()
        .find_map(|line| line.strip_prefix("host: "));
    let target = host.context("the compiler does not name its target")?;
    ensure!(
        target.contains("-linux-"),
        "the packages are for Linux, and this machine is {target}: build them on Linux"
    );
    let build = Build {
        root: workspace().to_owned(),
        artefacts: target_directory().with_file_name("dist-build"),
        target: target.to_owned(),
        epoch: epoch()?,
    };
    let packed = build.everything()?;
    write(output, &packed)?;
    let program = output.join("allanite");
    alone::check(&program)?;
    if check {
        let copy = Copy::new("another/folder")?;
        let again = Build {
            artefacts: copy.path.join("target"),
            root: copy.path.clone(),
            ..build
        };
        let again = again.everything()?;
        for (first, second) in packed.iter().zip(&again) {
            ensure!(
                first == second,
                "{} differs when it is built again elsewhere: look for a path or a time in it",
                first.path
            );
        }
        ensure!(
            packed.len() == again.len(),
            "a second build has other files"
        );
        println!("\n{} files, the same in both builds", packed.len());
    }
    for file in &packed {
        println!(
            "{:>9}  {}",
            file.bytes.len(),
            output.join(&file.path).display()
        );
    }
    Ok(())
}

impl Build {
    /// Every file, in the order of the paths.
    fn everything(&self) -> Result<Vec<Packed>> {
        let folder = self.programs()?;
        let read = |path: &Path| fs::read(path).with_context(|| path.display().to_string());
        let program = folder.join("allanite");
        let mut files = vec![Packed::new("bin/allanite", read(&program)?)];
        files[0].is_program = true;
        for (shell, path) in SHELLS {
            let script = answer(Command::new(&program).args(["completions", shell]))?;
            files.push(Packed::new(path, script));
        }
        let manual = tempfile::tempdir()?;
        answer(Command::new(folder.join("manual")).arg(manual.path()))?;
        for entry in fs::read_dir(manual.path())? {
            let entry = entry?;
            let name = entry.file_name().to_string_lossy().into_owned();
            files.push(Packed::new(
                format!("share/man/man1/{name}"),
                read(&entry.path())?,
            ));
        }
        match page::compiler() {
            Ok(()) => {
                let page = self.artefacts.join("allanite.html");
                page::build(&self.root, &self.artefacts.join("page"), &page)?;
                files.push(Packed::new("share/allanite/allanite.html", read(&page)?));
            }
            Err(error) => println!(
                "without the page, so that `explore` needs --page: {error:#}; rustup has its compiler"
            ),
        }
        let program = Program {
            package: "allanite-cli",
            features: FEATURES,
            target: &self.target,
        };
        let crates = crates::crates(&self.root, &program)?;
        let documents = "share/doc/allanite";
        for (name, from) in [
            ("LICENSE-MIT", "LICENSE-MIT"),
            ("LICENSE-APACHE", "LICENSE-APACHE"),
            ("CHANGELOG.md", "src/CHANGELOG.md"),
        ] {
            let bytes = read(&self.root.join(from))?;
            files.push(Packed::new(format!("{documents}/{name}"), bytes));
        }
        let licences = crates::licences(&crates)?;
        files.push(Packed::new(
            format!("{documents}/licences-of-crates"),
            licences,
        ));

        let c_library = c_library(&self.target);
        let c_library = c_library
            .as_ref()
            .map(|version| ("glibc", version.as_str()));
        let whole = sbom::Whole {
            version: VERSION,
            c_library,
            epoch: self.epoch,
        };
        let sbom = sbom::document(&crates, program.package, &whole)?;
        let architecture = self.target.split('-').next().unwrap_or_default();
        let about = deb::About {
            version: VERSION,
            architecture,
            maintainer: &maintainer(),
            epoch: self.epoch,
        };
        let mit = fs::read_to_string(self.root.join("LICENSE-MIT"))?;
        let copyright = deb::copyright(&mit, c_library)?;
        let package = deb::package(&files, &copyright, &about)?;
        files.push(Packed::new(format!("{documents}/copyright"), copyright));
        let name = format!("allanite-{VERSION}-{architecture}-linux");
        let archive = archive(&files, &name, self.epoch)?;
        // What is in the packages, for whoever installs single files.
        let mut all = Vec::new();
        for mut file in files {
            let prefix = ["share/allanite/", "share/", "bin/"].into_iter();
            let mut below = prefix.filter_map(|prefix| file.path.strip_prefix(prefix));
            let path = below.next().unwrap_or(&file.path).to_owned();
            if !path.starts_with("doc/") {
                file.path = path;
                all.push(file);
            }
        }
        all.push(Packed::new(about.file()?, package));
        all.push(Packed::new(format!("{name}.tar.gz"), archive));
        all.push(Packed::new(format!("allanite-{VERSION}.cdx.json"), sbom));
        all.sort();
        let sum = |file: &Packed| {
            format!(
                "{}  {}\n",
                hexadecimal(&Sha256::digest(&file.bytes)),
                file.path
            )
        };
        let sums: String = all.iter().map(sum).collect();
        all.push(Packed::new("SHA256SUMS", sums));
        Ok(all)
    }

    /// Builds the program and the one that writes its manual. Returns the folder with both.
    fn programs(&self) -> Result<PathBuf> {
        let home = cargo_home()?;
        let paths = [(&*self.root, SOURCES), (&*home, "/cargo")];
        let mut flags = vec!["-Ctarget-feature=+crt-static".to_owned()];
        let remapped = |(path, name): &(&Path, &str)| format!("{}={name}", path.display());
        flags.extend(
            paths
                .iter()
                .map(|it| format!("--remap-path-prefix={}", remapped(it))),
        );
        // The same for the sources in C.
        let of_c = paths.map(|it| format!("-ffile-prefix-map={}", remapped(&it)));
        let mut build = cargo();
        build.current_dir(&self.root);
        build.args([
            "build",
            "--locked",
            "--profile",
            "dist",
            "--package",
            "allanite-cli",
        ]);
        build.args(["--no-default-features", "--features"]);
        build.arg(format!("{FEATURES},manual"));
        // With a target, the flags are not those of build scripts and macros, which are no static programs.
        build.args([
            "--bin",
            "allanite",
            "--bin",
            "manual",
            "--target",
            &self.target,
        ]);
        build.arg("--target-dir").arg(&self.artefacts);
        build
            .env_remove("RUSTFLAGS")
            .env_remove("CARGO_BUILD_RUSTFLAGS");
        build.env("CARGO_ENCODED_RUSTFLAGS", flags.join("\x1f"));
        build.env("CFLAGS", of_c.join(" "));
        build.env("ALLANITE_SOURCES", SOURCES);
        let built = step("the static program", &mut build);
        built.context(
            "a static program needs the C library as an archive: install libc6-dev (Debian) or glibc-static (Fedora)",
        )?;
        Ok(self.artefacts.join(&self.target).join("dist"))
    }
}

/// Writes the files to a folder of their own.
fn write(output: &Path, files: &[Packed]) -> Result<()> {
    // What an earlier version left would not be in the checksums.
    if output.join("SHA256SUMS").is_file() {
        fs::remove_dir_all(output).with_context(|| output.display().to_string())?;
    } else if output.is_dir() && output.read_dir()?.next().is_some() {
        bail!("{} is not empty: name another folder", output.display());
    }
    files::write(output, files)
}

/// The time of everything that is packed: `SOURCE_DATE_EPOCH`, or that of the last commit.
fn epoch() -> Result<u64> {
    if let Some(set) = std::env::var_os("SOURCE_DATE_EPOCH") {
        let set = set.to_string_lossy();
        return set
            .parse()
            .with_context(|| format!("SOURCE_DATE_EPOCH={set:?} is no number of seconds"));
    }
    let mut log = Command::new("git");
    log.args(["log", "-1", "--format=%ct"])
        .current_dir(workspace());
    let time = answer(&mut log).context("set SOURCE_DATE_EPOCH, or run this in a clone")?;
    Ok(time.trim().parse()?)
}

/// Who answers for the package, as Debian's own programs find it.
fn maintainer() -> String {
    let set = |name| std::env::var(name).ok().filter(|value| !value.is_empty());
    let name = set("DEBFULLNAME").unwrap_or_else(|| MAINTAINER.to_owned());
    let address = set("DEBEMAIL").unwrap_or_else(|| {
        println!("the package for Debian names no address: set DEBEMAIL and DEBFULLNAME");
        ADDRESS.to_owned()
    });
    format!("{name} <{address}>")
}

/// The version of glibc, if the program is linked with it.
fn c_library(target: &str) -> Option<String> {
    let is_glibc = target.ends_with("-gnu");
    let answer = is_glibc.then(|| answer(Command::new("getconf").arg("GNU_LIBC_VERSION")));
    let version = answer?.ok()?;
    Some(version.trim().trim_start_matches("glibc ").to_owned())
}

fn rustc() -> std::ffi::OsString {
    std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into())
}
