//! The course of an axis, which a type may leave out: then it takes no memory, no flash and no time.

use crate::record::course::Course;
use core::fmt::Debug;

/// Keeps the course of every axis over time: `T` of [`Axes`](super::Axes).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Courses;

/// What can stand for `T` of [`Axes`](super::Axes): [`Courses`], or `()` for none.
pub trait CoursePart: Clone + Debug + PartialEq + Eq {
    /// The course of one axis.
    #[doc(hidden)]
    type Sums<const COVARIATES: usize>: CourseSums<COVARIATES>;
}

impl CoursePart for Courses {
    type Sums<const COVARIATES: usize> = Course<COVARIATES>;
}

impl CoursePart for () {
    type Sums<const COVARIATES: usize> = ();
}

/// The course of one axis, or nothing.
pub trait CourseSums<const COVARIATES: usize>: Clone + Debug + PartialEq + Eq {
    /// Nothing seen yet.
    const NEW: Self;

    /// Whether a course is kept.
    const EXISTS: bool;

    /// Adds one count, and one of every covariate.
    fn push(&mut self, count: i32, covariates: [i32; COVARIATES]);

    /// Adds counts whose covariates are zero.
    fn push_counts(&mut self, counts: &[i32]);

    /// So many samples are not in the record, or it is not known how many if the number is 0.
    fn gap(&mut self, missing: u64);

    /// The course, if it is kept.
    fn course(&self) -> Option<&Course<COVARIATES>>;

    /// The course, if it is kept.
    #[cfg(feature = "storage")]
    fn course_mut(&mut self) -> Option<&mut Course<COVARIATES>>;
}

impl<const COVARIATES: usize> CourseSums<COVARIATES> for Course<COVARIATES> {
    const NEW: Self = Self::new();
    const EXISTS: bool = true;

    #[inline(always)]
    fn push(&mut self, count: i32, covariates: [i32; COVARIATES]) {
        self.push(count, covariates);
    }

    fn push_counts(&mut self, counts: &[i32]) {
        self.push_counts(counts);
    }

    fn gap(&mut self, missing: u64) {
        self.gap();
        self.lost(missing);
    }

    fn course(&self) -> Option<&Self> {
        Some(self)
    }

    #[cfg(feature = "storage")]
    fn course_mut(&mut self) -> Option<&mut Self> {
        Some(self)
    }
}

impl<const COVARIATES: usize> CourseSums<COVARIATES> for () {
    const NEW: Self = ();
    const EXISTS: bool = false;

    #[inline(always)]
    fn push(&mut self, _: i32, _: [i32; COVARIATES]) {}

    #[inline(always)]
    fn push_counts(&mut self, _: &[i32]) {}

    fn gap(&mut self, _: u64) {}

    fn course(&self) -> Option<&Course<COVARIATES>> {
        None
    }

    #[cfg(feature = "storage")]
    fn course_mut(&mut self) -> Option<&mut Course<COVARIATES>> {
        None
    }
}
