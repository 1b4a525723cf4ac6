//! The accumulator against its definition in big integers, and what must not change its state.

mod definition;
mod events;
mod full_scale;
#[path = "../common/seeded.rs"]
mod seeded;
mod sequences;
mod state;
