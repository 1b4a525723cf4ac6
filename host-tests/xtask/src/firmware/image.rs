//! Builds an image and examines it.

use super::{CORTEX_M4F, Core, Heartbeat, Precision, REMEDY, Toolchain, toolchain::artefacts};
use anyhow::{Context as _, Result, bail, ensure};
use object::{Object as _, ObjectSection as _, ObjectSymbol as _, SectionKind, SymbolKind};
use std::path::{Path, PathBuf};

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

/// The images whose cost is measured, or that are compared with this host, on every core.
pub const ON_EVERY_CORE: [&str; 5] = [
    "bench",
    "characterise",
    "footprint_fit",
    "footprint_five_terms",
    "footprint_self_test",
];

/// Those that need more than the RAM of the smallest core.
pub const ON_LARGE_CORES: [&str; 1] = ["bench_parts"];

/// Those that are measured on a Cortex-M4F alone.
pub const ON_THE_MEASURED_CORE: [&str; 6] = [
    "footprint_nothing",
    "footprint_accumulator",
    "footprint_diagnosis",
    "footprint_spectrum",
    "footprint_everything",
    "footprint_words",
];

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
        build_all(&[name], &[*core], profile)?;
        let path = artefacts(core.precision).join(core.target);
        let path = path.join(profile).join(name);
        let elf = std::fs::read(&path).with_context(|| format!("reading {}", path.display()))?;
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

/// Builds several images for several cores at once: one command for a precision and an architecture, in which no core of this host
/// waits while another one links. Images that are up to date cost a moment.
///
/// Architectures are built apart, because one command of cargo joins the features that a crate has for each of its targets:
/// `critical-section` has one of its features for Arm and another one for RISC-V, and does not build with both.
///
/// # Errors
/// Fails if no compiler for the targets is found, or if the build fails.
pub fn build_all(names: &[&str], cores: &[Core], profile: &str) -> Result<()> {
    let kinds = Precision::ALL
        .into_iter()
        .flat_map(|precision| [false, true].map(|is_arm| (precision, is_arm)));
    for kind in kinds {
        let cores: Vec<Core> = (cores.iter().copied())
            .filter(|core| (core.precision, core.target.starts_with("thumb")) == kind)
            .collect();
        let feature = |name: &str| FEATURES.iter().find(|(image, _)| *image == name);
        let (apart, plain): (Vec<&str>, Vec<&str>) =
            names.iter().partition(|name| feature(name).is_some());
        if cores.is_empty() {
            continue;
        }
        if !plain.is_empty() {
            build(&plain, &[], &cores, profile)?;
        }
        // Another set of features is another build of everything that the images share.
        let features: Vec<&str> = apart
            .iter()
            .filter_map(|name| Some(feature(name)?.1))
            .collect();
        if !apart.is_empty() {
            build(&apart, &features, &cores, profile)?;
        }
    }
    Ok(())
}

/// Builds images for cores of one precision.
fn build(names: &[&str], features: &[&str], cores: &[Core], profile: &str) -> Result<()> {
    let precision = cores
        .first()
        .map_or(Precision::Single, |core| core.precision);
    let shown: Vec<&str> = cores.iter().map(|core| core.name).collect();
    let (images, shown) = (names.join(", "), shown.join(", "));
    let _heartbeat = Heartbeat::new(format!(
        "the build of {images} for {shown}, {} precision",
        precision.name()
    ));
    let mut command = Toolchain::cargo_for_all("build", cores)?;
    command.args(["--package", "images", "--profile", profile]);
    for name in names {
        command.args(["--bin", name]);
    }
    command.args(precision.arguments());
    for feature in features {
        command.args(["--features", feature]);
    }
    let status = command
        .status()
        .with_context(|| format!("cargo did not start: {REMEDY}"))?;
    ensure!(
        status.success(),
        "building {images} for {shown} failed ({status}): {REMEDY}"
    );
    Ok(())
}
