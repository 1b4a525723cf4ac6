//! Compares the accumulator with its definition in big integers, and checks what must not change
//! its state.

mod definition;
mod events;
mod full_scale;
mod sequences;
mod state;
