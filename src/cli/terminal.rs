//! Results on the standard output.

use std::io::Write;

use hexroll::{Error, Result};

/// Prints a result. A reader that has seen enough (`| head`) is no error.
pub fn print(text: &str) -> Result<()> {
    match std::io::stdout().lock().write_all(text.as_bytes()) {
        Err(e) if e.kind() == std::io::ErrorKind::BrokenPipe => Ok(()),
        result => result.map_err(Error::io("stdout", "write the result")),
    }
}

/// The same for a value as JSON.
pub fn print_json(value: &impl serde::Serialize) -> Result<()> {
    let text =
        serde_json::to_string_pretty(value).map_err(|e| Error::io("stdout", "write the result")(e.into()))?;
    print(&(text + "\n"))
}
