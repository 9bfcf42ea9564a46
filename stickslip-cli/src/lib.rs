//! The command `stickslip`, for the program of this name, and for others that bring it along, as the Python package
//! does. What stands in [`door`] is for tests that feed it what nobody means to (`fuzz/`), and in [`bench`] for
//! `stickslip-bench`.

#![deny(clippy::print_stderr, clippy::print_stdout)]

pub mod bench;
mod chart;
mod commands;
pub mod door;
mod drawing;
mod failure;
mod files;
mod film;
mod frame_pictures;
mod gallery;
mod illustration;
mod jobs;
pub mod memory;
mod page;
mod picture;
mod progress;
mod ranks;
mod reproduce;
mod sweep;
mod tell;
mod validation;
mod view;

use clap::Parser;
use std::ffi::OsString;
use std::sync::OnceLock;
use std::time::Duration;

/// So long the first of several processes may take to tell what is wrong.
const UNTIL_TOLD: Duration = Duration::from_secs(2);

/// How another program is called that brings the command along.
static CALLED: OnceLock<Vec<OsString>> = OnceLock::new();

/// Says how the command is called where that is not a program of its own: `python -m stickslip`, by absolute paths. Of
/// scripts that the command writes.
pub fn is_called(words: Vec<OsString>) {
    // The process has one answer, the first.
    let _ = CALLED.set(words);
}

/// What a script calls the command by: a program, and the words that go before the command's own.
fn program() -> std::io::Result<Vec<OsString>> {
    match CALLED.get() {
        Some(words) => Ok(words.clone()),
        None => Ok(vec![std::path::absolute(std::env::current_exe()?)?.into_os_string()]),
    }
}

/// Does what the words of a command line ask for, the program's name first, and gives the exit code.
///
/// It takes over Ctrl-C and the pool of threads of the process: it is for processes that do nothing else. Of several
/// that a launcher began together, all are to call it with the same words.
pub fn execute(words: impl IntoIterator<Item = OsString>) -> u8 {
    let together = ranks::Launched::together();
    let ended = match (commands::Command::try_parse_from(words), together) {
        (Ok(command), None) => command.execute(),
        (Ok(command), Some(launched)) => launched.execute(command),
        (Err(error), _) => {
            let code = u8::try_from(error.exit_code()).unwrap_or(1);
            if tells(together, code) {
                // Nobody can be told of an output that takes nothing.
                let _ = error.print();
            }
            return code;
        }
    };
    match ended {
        Ok(()) => 0,
        Err(failure) => {
            if tells(together, failure.exit_code()) {
                failure.print();
            }
            failure.exit_code()
        }
    }
}

/// Whether this process tells why it ends with a code: of several only the first. A launcher ends all as soon as one
/// has ended with another code than 0, so the others give it time to tell.
fn tells(together: Option<ranks::Launched>, code: u8) -> bool {
    let tells = together.is_none_or(ranks::Launched::is_first);
    if !tells && code != 0 {
        std::thread::sleep(UNTIL_TOLD);
    }
    tells
}
