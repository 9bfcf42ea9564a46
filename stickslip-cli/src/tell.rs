//! What the command says on standard error.

/// Says a line on standard error. A log that takes no more, on a full disk or behind a pipe that was closed, is no reason
/// to lose a run: `eprintln!` would end the program.
macro_rules! tell {
    ($($text:tt)*) => {{
        let _ = std::io::Write::write_fmt(&mut std::io::stderr(), format_args!("{}\n", format_args!($($text)*)));
    }};
}
pub(crate) use tell;
