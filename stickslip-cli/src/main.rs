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
mod page;
mod picture;
mod progress;
mod reproduce;
mod sweep;
mod validation;
mod view;

use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    match commands::Command::parse().execute() {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            failure.print();
            failure.exit_code()
        }
    }
}
