//! A course in a snapshot.
//!
//! The length of a block less 1, the number of complete blocks, and the samples of time in the open block; then for
//! each complete block and for the open one: the sum of the counts, the two parts of the sum of squared differences,
//! the samples that are missing, those without a difference, and the sum of the counts of each covariate.

use super::{BLOCKS, Course, LONGEST, sums::Sums};
use crate::storage::{
    envelope::{put, take},
    snapshot::LONGEST as LONGEST_VARINT,
};

impl<const COVARIATES: usize> Course<COVARIATES> {
    /// The largest number of bytes that a course takes.
    pub(crate) const LONGEST_STORED: usize =
        3 * LONGEST_VARINT + BLOCKS * (5 + COVARIATES) * LONGEST_VARINT;

    /// Writes the course as it is after a [`gap`](Self::gap), and returns the number of bytes; `None` if the buffer is
    /// too small.
    #[inline(never)]
    pub(crate) fn write(&self, buffer: &mut [u8]) -> Option<usize> {
        let mut length = 0;
        let head = (self.last_place, self.complete, self.filled);
        put(&head, buffer, &mut length)?;
        let complete = self.blocks.iter().take(usize::from(self.complete));
        for sums in complete.chain([&self.open]) {
            put(&sums.parts(), buffer, &mut length)?;
            for covariate in sums.covariates() {
                put(covariate, buffer, &mut length)?;
            }
        }
        Some(length)
    }

    /// Reads a course, and returns the bytes behind it; `None` if no record can have such a course.
    #[inline(never)]
    pub(crate) fn read<'b>(&mut self, mut bytes: &'b [u8]) -> Option<&'b [u8]> {
        self.reset();
        let (last_place, complete, filled): (u32, u8, u32) = take(&mut bytes)?;
        let length = last_place.checked_add(1)?;
        let is_possible = length.is_power_of_two() && length <= LONGEST && filled <= length;
        // A course with longer blocks has been full before.
        let fewest = if length > 1 { BLOCKS / 2 } else { 0 };
        if !is_possible || !(fewest..BLOCKS).contains(&usize::from(complete)) {
            return None;
        }
        let mut read = |time: u32| {
            let parts = take(&mut bytes)?;
            let mut covariates = [0; COVARIATES];
            for covariate in &mut covariates {
                *covariate = take(&mut bytes)?;
            }
            Sums::from_parts(parts, covariates, time)
        };
        for block in self.blocks.iter_mut().take(usize::from(complete)) {
            *block = read(length)?;
        }
        self.open = read(filled)?;
        (self.last_place, self.complete, self.filled) = (last_place, complete, filled);
        Some(bytes)
    }
}

/// The bytes in which a course is stored, for a program that keeps it with what it has computed from it.
impl serde::Serialize for Course {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut buffer = [0; Self::LONGEST_STORED];
        // The buffer has room for every course.
        let length = self.write(&mut buffer).unwrap_or(0);
        serializer.serialize_bytes(buffer.get(..length).unwrap_or(&[]))
    }
}

impl<'de> serde::Deserialize<'de> for Course {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let bytes: &[u8] = serde::Deserialize::deserialize(deserializer)?;
        let mut course = Self::new();
        match course.read(bytes) {
            Some([]) => Ok(course),
            _ => Err(serde::de::Error::custom("no record has this course")),
        }
    }
}
