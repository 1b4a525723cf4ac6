//! One image, built.

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

/// What the names of such functions have in common: the handler, and the way to it.
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

/// A linked image.
#[derive(Clone, Debug)]
pub struct Image {
    /// What it is built for.
    pub core: Core,
    /// Where it lies.
    pub path: PathBuf,
    /// The file itself.
    pub elf: Vec<u8>,
}

impl Image {
    /// Builds the binary `name` of the library's package for a Cortex-M4F.
    ///
    /// # Errors
    /// If no compiler for the target is found, the build fails, or its result holds no code.
    pub fn build(name: &str) -> Result<Self> {
        Self::build_for(name, &CORTEX_M4F)
    }

    /// The same for another core.
    ///
    /// # Errors
    /// As of [`build`](Self::build).
    pub fn build_for(name: &str, core: &Core) -> Result<Self> {
        Self::build_with(name, core, "firmware")
    }

    /// The same with a profile of the workspace: `firmware`, or `checked` with arithmetic checked.
    ///
    /// # Errors
    /// As of [`build`](Self::build).
    pub fn build_with(name: &str, core: &Core, profile: &str) -> Result<Self> {
        let target = core.target;
        let toolchain = Toolchain::find(core)?;
        let _heartbeat = Heartbeat::new(format!("the build of {name} for {core}"));
        let mut command = toolchain.cargo("build")?;
        command
            .args(["--package", "allanite", "--bin", name])
            .args(["--features", "firmware", "--profile", profile])
            .args(core.precision.arguments());
        // Both precisions' images have one path, and others may be building.
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
        // Flags that replaced the linker script's leave an image without code.
        ensure!(
            image.code_bytes()? > 64,
            "the image {name} holds no code: unset RUSTFLAGS and the like"
        );
        Ok(image)
    }

    /// Functions in the image that something that panics would need, sorted. Nothing that remains in
    /// it can panic if there is none.
    ///
    /// # Errors
    /// If the file is no ELF file, or names no functions.
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

    /// The section that holds a static of the image, such as `.bss` for one that is all zero at first.
    ///
    /// # Errors
    /// If the file is no ELF file, or has no static whose name ends so.
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

    /// Bytes of its sections of instructions.
    fn code_bytes(&self) -> Result<u64> {
        self.sum(|kind| kind == SectionKind::Text)
    }

    /// Bytes that the image takes of flash: instructions, constants and initial values, with the
    /// vector table and the start-up code.
    ///
    /// # Errors
    /// If the file is no ELF file.
    pub fn flash_bytes(&self) -> Result<u64> {
        self.sum(|kind| {
            matches!(
                kind,
                SectionKind::Text
                    | SectionKind::ReadOnlyData
                    | SectionKind::ReadOnlyString
                    | SectionKind::Data
            )
        })
    }

    fn sum(&self, counts: impl Fn(SectionKind) -> bool) -> Result<u64> {
        let file = self.file()?;
        let sections = file.sections().filter(|section| counts(section.kind()));
        Ok(sections.map(|section| section.size()).sum())
    }
}

/// Another may be running the file that is there: it keeps it.
fn replace(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    let mut file = tempfile::NamedTempFile::new_in(path.parent().unwrap_or(path))?;
    file.write_all(bytes)?;
    file.persist(path)?;
    Ok(())
}
