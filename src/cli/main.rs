//! Parses the command line, runs the command, prints an error once with its causes, sets the exit code.

use std::process::ExitCode;

use hexroll_cli::Cli;

fn main() -> ExitCode {
    without_a_window_system();
    match Cli::from_arguments().execute() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            let mut cause = std::error::Error::source(&error);
            while let Some(inner) = cause {
                eprintln!("  caused by: {inner}");
                cause = inner.source();
            }
            ExitCode::from(error.exit_code())
        }
    }
}

/// Vulkan drivers look for a Wayland display when a device is opened, and complain on stderr if the session has no
/// `XDG_RUNTIME_DIR`. Nothing here opens a window: a folder that does not exist makes them look in vain and in silence.
fn without_a_window_system() {
    if cfg!(target_os = "linux") && std::env::var_os("XDG_RUNTIME_DIR").is_none() {
        // SAFETY: the first thing this process does; no other thread is there to read the environment.
        unsafe { std::env::set_var("XDG_RUNTIME_DIR", "/nonexistent") };
    }
}
