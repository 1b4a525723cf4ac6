//! Files and archives that are the same bytes whoever packs them, and whenever.

use anyhow::{Context as _, Result};
use flate2::{Compression, GzBuilder};
use std::{
    collections::BTreeSet,
    io::Write as _,
    path::{Path, PathBuf},
};

/// A file to be packed.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Packed {
    /// Where it is installed, below the folder that things are installed to.
    pub(super) path: String,
    pub(super) bytes: Vec<u8>,
    pub(super) is_program: bool,
}

impl Packed {
    pub(super) fn new(path: impl Into<String>, bytes: impl Into<Vec<u8>>) -> Self {
        Self {
            path: path.into(),
            bytes: bytes.into(),
            is_program: false,
        }
    }
}

/// The bytes as gzip, without a name and a time.
pub(super) fn gzip(bytes: &[u8]) -> Result<Vec<u8>> {
    let mut packer = GzBuilder::new()
        .mtime(0)
        .write(Vec::new(), Compression::best());
    packer.write_all(bytes)?;
    Ok(packer.finish()?)
}

/// The files and their folders as a tar archive below a folder: in the order of their paths, owned by root, of one time.
pub(super) fn tar(files: &[Packed], below: &str, epoch: u64) -> Result<Vec<u8>> {
    let mut archive = tar::Builder::new(Vec::new());
    let mut folders = BTreeSet::new();
    let mut sorted: Vec<_> = files.iter().collect();
    sorted.sort();
    for file in sorted {
        let path = PathBuf::from(format!("{below}/{}", file.path));
        let mut above: Vec<&Path> = path.ancestors().skip(1).collect();
        above.retain(|folder| !folder.as_os_str().is_empty());
        for folder in above.into_iter().rev() {
            if folders.insert(folder.to_owned()) {
                let name = format!("{}/", folder.display());
                let header = header(tar::EntryType::Directory, &name, 0o755, 0, epoch)?;
                archive.append(&header, std::io::empty())?;
            }
        }
        let mode = if file.is_program { 0o755 } else { 0o644 };
        let size = file.bytes.len() as u64;
        let name = path.display().to_string();
        let header = header(tar::EntryType::Regular, &name, mode, size, epoch)?;
        archive.append(&header, &*file.bytes)?;
    }
    Ok(archive.into_inner()?)
}

fn header(
    kind: tar::EntryType,
    name: &str,
    mode: u32,
    size: u64,
    epoch: u64,
) -> Result<tar::Header> {
    let mut header = tar::Header::new_gnu();
    // The crate would leave out the `./` that Debian's names begin with.
    let place = header.as_old_mut().name.get_mut(..name.len());
    place
        .with_context(|| format!("the name {name} is too long for an archive"))?
        .copy_from_slice(name.as_bytes());
    header.set_entry_type(kind);
    header.set_mode(mode);
    header.set_size(size);
    header.set_mtime(epoch);
    header.set_uid(0);
    header.set_gid(0);
    header.set_username("root")?;
    header.set_groupname("root")?;
    header.set_cksum();
    Ok(header)
}

/// The digits of a hash.
pub(super) fn hexadecimal(hash: &[u8]) -> String {
    hash.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn archives_do_not_depend_on_the_order_and_have_every_folder() {
        let mut files = vec![
            Packed::new("share/b", "second"),
            Packed::new("bin/a", "first"),
            Packed::new("share/doc/c", vec![7; 3000]),
        ];
        files[1].is_program = true;
        let archive = tar(&files, "./usr", 86_400).unwrap();
        files.reverse();
        assert_eq!(tar(&files, "./usr", 86_400).unwrap(), archive);
        assert_ne!(tar(&files, "./usr", 86_401).unwrap(), archive);
        let mut read = tar::Archive::new(&*archive);
        let entries: Vec<_> = read
            .entries()
            .unwrap()
            .map(|entry| {
                let entry = entry.unwrap();
                let header = entry.header();
                assert_eq!(header.mtime().unwrap(), 86_400);
                assert_eq!(header.uid().unwrap(), 0);
                let path = entry.path_bytes();
                let path = String::from_utf8(path.into_owned()).unwrap();
                format!("{path} {:o} {}", header.mode().unwrap(), entry.size())
            })
            .collect();
        assert_eq!(
            entries,
            [
                "./ 755 0",
                "./usr/ 755 0",
                "./usr/bin/ 755 0",
                "./usr/bin/a 755 5",
                "./usr/share/ 755 0",
                "./usr/share/b 644 6",
                "./usr/share/doc/ 755 0",
                "./usr/share/doc/c 644 3000",
            ]
        );
        let packed = gzip(&archive).unwrap();
        assert_eq!(packed[3..8], [0; 5], "a name or a time");
        assert!(packed.len() < archive.len() / 4);
    }
}
