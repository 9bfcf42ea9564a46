//! The command `stickslip`: `main.rs` is its program. What stands in [`door`] is for the program and for tests that feed
//! it what nobody means to (`fuzz/`).

mod bench;
mod chart;
mod commands;
pub mod door;
mod drawing;
mod failure;
mod files;
mod frame_pictures;
mod illustration;
mod jobs;
mod page;
mod picture;
mod progress;
mod reproduce;
mod sweep;
mod validation;
mod view;
