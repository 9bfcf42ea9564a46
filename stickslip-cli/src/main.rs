//! The command `stickslip`.

mod bench;
mod chart;
mod commands;
mod drawing;
mod failure;
mod files;
mod frame_pictures;
mod illustration;
mod jobs;
mod memory;
mod page;
mod picture;
mod progress;
mod reproduce;
mod sweep;
mod validation;
mod view;

use clap::Parser;
use std::process::ExitCode;

#[global_allocator]
static MEMORY: memory::EndsWithASentence = memory::EndsWithASentence;

fn main() -> ExitCode {
    memory::keep_some();
    match commands::Command::parse().execute() {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            failure.print();
            failure.exit_code()
        }
    }
}
