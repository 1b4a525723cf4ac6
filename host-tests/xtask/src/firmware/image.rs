//! Builds an image and examines it.

use super::{
    CORTEX_M4F, Core, Heartbeat, REMEDY, Toolchain,
    toolchain::{exclusive, target_directory},
};
use anyhow::{Context as _, Result, bail, ensure};
use object::{Object as _, ObjectSection as _, ObjectSymbol as _, SectionKind, SymbolKind};
use std::{
    io::Write as _,
    path::{Path, PathBuf},
};

/// Parts of the names of functions that a panic needs: the panic handler and the functions that
/// call it.
const PANICS: [&str; 8] = [
    "rust_begin_unwind",
    "core::panicking::",
    "panic_fmt",
    "panic_bounds_check",
    "unwrap_failed",
    "expect_failed",
    "slice::index::slice_",
    "copy_from_slice_impl::len_mismatch_fail",
];

/// The images that need a feature of their package, with the feature.
const FEATURES: [(&str, &str); 2] = [("appliance_rtic", "rtic"), ("appliance_embassy", "embassy")];

/// A linked image.
#[derive(Clone, Debug)]
pub struct Image {
    /// The core that the image is built for.
    pub core: Core,
    /// The path of the image.
    pub path: PathBuf,
    /// The contents of the file.
    pub elf: Vec<u8>,
}

impl Image {
    /// Builds the image `name` for a Cortex-M4F.
    ///
    /// # Errors
    /// Fails if no compiler for the target is found, if the build fails, or if the image holds no
    /// code.
    pub fn build(name: &str) -> Result<Self> {
        Self::build_for(name, &CORTEX_M4F)
    }

    /// Builds an image for another core.
    ///
    /// # Errors
    /// The errors are those of [`build`](Self::build).
    pub fn build_for(name: &str, core: &Core) -> Result<Self> {
        Self::build_with(name, core, "firmware")
    }

    /// Builds an image with a profile of the workspace: `firmware`, or `checked` for checked
    /// arithmetic.
    ///
    /// # Errors
    /// The errors are those of [`build`](Self::build).
    pub fn build_with(name: &str, core: &Core, profile: &str) -> Result<Self> {
        let target = core.target;
        let toolchain = Toolchain::find(core)?;
        let _heartbeat = Heartbeat::new(format!("the build of {name} for {core}"));
        let mut command = toolchain.cargo("build")?;
        command
            .args(["--package", "images", "--bin", name])
            .args(["--profile", profile])
            .args(core.precision.arguments());
        for (_, feature) in FEATURES.iter().filter(|(image, _)| *image == name) {
            command.args(["--features", feature]);
        }
        // The images of both precisions have the same path, and another program may be building.
        let lock = exclusive()?;
        let status = command
            .status()
            .with_context(|| format!("cargo did not start: {REMEDY}"))?;
        if !status.success() {
            bail!("building the image {name} failed ({status}): {REMEDY}");
        }
        let built = target_directory().join(target).join(profile).join(name);
        let path = built.with_file_name(format!("{name}-{}", core.precision.name()));
        let elf = std::fs::read(&built).with_context(|| format!("reading {}", built.display()))?;
        replace(&path, &elf).with_context(|| format!("writing {}", path.display()))?;
        drop(lock);
        let image = Self {
            core: *core,
            path,
            elf,
        };
        // If the linker script's flags were replaced, the image is linked without code.
        ensure!(
            image.code_bytes()? > 64,
            "the image {name} holds no code: unset RUSTFLAGS and the like"
        );
        Ok(image)
    }

    /// The functions in the image that a panic needs, sorted. If there are none, no code in the
    /// image can panic.
    ///
    /// # Errors
    /// Fails if the file is not an ELF file or contains no names of functions.
    pub fn panic_paths(&self) -> Result<Vec<String>> {
        let file = self.file()?;
        let functions = file
            .symbols()
            .filter(|symbol| symbol.kind() == SymbolKind::Text);
        let mut names = functions
            .map(|symbol| Ok(format!("{:#}", rustc_demangle::demangle(symbol.name()?))))
            .collect::<Result<Vec<_>>>()?;
        ensure!(
            names.iter().any(|name| name == "main"),
            "{} names no functions",
            self.path.display()
        );
        names.retain(|name| PANICS.iter().any(|part| name.contains(part)));
        names.sort();
        names.dedup();
        Ok(names)
    }

    /// The section that holds a static of the image, such as `.bss` for one that is zero at first.
    ///
    /// # Errors
    /// Fails if the file is not an ELF file, or if no static has a name with this end.
    pub fn section_of(&self, name: &str) -> Result<String> {
        let file = self.file()?;
        let is_named = |symbol: &object::Symbol<'_, '_>| {
            let name_there = symbol.name().unwrap_or_default();
            let name_there = format!("{:#}", rustc_demangle::demangle(name_there));
            symbol.kind() == SymbolKind::Data && name_there.ends_with(name)
        };
        let symbol = file.symbols().find(is_named);
        let index = symbol.and_then(|symbol| symbol.section_index());
        let index = index.with_context(|| format!("there is no static {name}"))?;
        Ok(file.section_by_index(index)?.name()?.to_owned())
    }

    fn file(&self) -> Result<object::File<'_>> {
        object::File::parse(&*self.elf).with_context(|| format!("reading {}", self.path.display()))
    }

    /// The size of the sections with instructions, in bytes.
    fn code_bytes(&self) -> Result<u64> {
        self.sum(|kind| kind == SectionKind::Text)
    }

    /// The size of the image in flash, in bytes: instructions, constants and initial values, with
    /// the vector table and the start-up code.
    ///
    /// # Errors
    /// Fails if the file is not an ELF file.
    pub fn flash_bytes(&self) -> Result<u64> {
        self.sum(is_in_flash)
    }

    /// The size of all statics in RAM, in bytes.
    ///
    /// # Errors
    /// Fails if the file is not an ELF file.
    pub fn ram_bytes(&self) -> Result<u64> {
        self.sum(|kind| matches!(kind, SectionKind::Data | SectionKind::UninitializedData))
    }

    /// The first two words of the vector table of a Cortex-M: the end of its stack, and the address of its first instruction.
    ///
    /// # Errors
    /// Fails if the image has no vector table.
    pub fn vectors(&self) -> Result<[u32; 2]> {
        let file = self.file()?;
        let table = file.section_by_name(".vector_table");
        let table = table.context("the image has no vector table")?;
        let [a, b, c, d, e, f, g, h, ..] = *table.data()? else {
            bail!("the vector table is empty");
        };
        Ok([[a, b, c, d], [e, f, g, h]].map(u32::from_le_bytes))
    }

    fn sum(&self, counts: impl Fn(SectionKind) -> bool) -> Result<u64> {
        let file = self.file()?;
        let sections = file.sections().filter(|section| counts(section.kind()));
        Ok(sections.map(|section| section.size()).sum())
    }
}

/// The size of a program in flash, in bytes: instructions, constants and initial values.
///
/// # Errors
/// Fails if the file is not an ELF file.
pub fn flash_of(program: &Path) -> Result<u64> {
    let elf = std::fs::read(program).with_context(|| format!("reading {}", program.display()))?;
    let file = object::File::parse(&*elf)?;
    let sections = file
        .sections()
        .filter(|section| is_in_flash(section.kind()));
    Ok(sections.map(|section| section.size()).sum())
}

fn is_in_flash(kind: SectionKind) -> bool {
    matches!(
        kind,
        SectionKind::Text
            | SectionKind::ReadOnlyData
            | SectionKind::ReadOnlyString
            | SectionKind::Data
    )
}

/// Replaces a file by a new one. A program that is running the old file keeps it.
fn replace(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    let mut file = tempfile::NamedTempFile::new_in(path.parent().unwrap_or(path))?;
    file.write_all(bytes)?;
    file.persist(path)?;
    Ok(())
}
