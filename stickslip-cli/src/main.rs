//! The program `stickslip`.

use std::process::ExitCode;
use stickslip_cli::memory::{self, EndsWithASentence};

#[global_allocator]
static MEMORY: EndsWithASentence = EndsWithASentence;

fn main() -> ExitCode {
    memory::keep_some();
    ExitCode::from(stickslip_cli::execute(std::env::args_os()))
}
