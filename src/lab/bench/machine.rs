//! Where and from what a record was made.

use std::process::Command;
use std::time::{SystemTime, UNIX_EPOCH};

use serde::{Deserialize, Serialize};

use hexroll::gpu::AdapterReport;

/// The machine, the program and the moment.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Machine {
    pub processor: String,
    pub cores: usize,
    pub memory_bytes: u64,
    pub system: String,
    /// GPU adapter and its driver; none where no row used one.
    pub adapter: Option<String>,
    pub driver: Option<String>,
    pub hexroll: String,
    /// `git describe` of the program's own tree; `unknown` outside of one.
    pub commit: String,
    /// `release`, or `debug`, whose figures mean nothing.
    pub profile: String,
    /// Year-month-day, UTC.
    pub date: String,
    /// Runnable processes over the last minute when the bench began: above about 0.2 the machine was not idle.
    pub load: Option<f64>,
    pub command: String,
}

impl Machine {
    pub fn describe(adapter: Option<&AdapterReport>) -> Machine {
        Machine {
            processor: processor(),
            cores: std::thread::available_parallelism().map_or(1, |n| n.get()),
            memory_bytes: meminfo("MemTotal:").unwrap_or(0),
            system: system(),
            adapter: adapter.map(|a| a.name.clone()),
            driver: adapter.map(|a| a.driver.clone()),
            hexroll: env!("CARGO_PKG_VERSION").into(),
            commit: commit(),
            profile: if cfg!(debug_assertions) { "debug" } else { "release" }.into(),
            date: date(seconds_now()),
            load: read("/proc/loadavg").and_then(|t| t.split_whitespace().next()?.parse().ok()),
            command: command(),
        }
    }
}

fn read(path: &str) -> Option<String> {
    std::fs::read_to_string(path).ok()
}

/// A line of /proc/meminfo [bytes].
fn meminfo(name: &str) -> Option<u64> {
    let text = read("/proc/meminfo")?;
    let line = text.lines().find(|l| l.starts_with(name))?;
    Some(line.split_whitespace().nth(1)?.parse::<u64>().ok()? << 10)
}

/// Memory that could be had now [bytes]; none where the system does not say.
pub fn available_memory() -> Option<u64> {
    meminfo("MemAvailable:")
}

/// Memory this process has touched and not given back [bytes].
pub fn resident_memory() -> Option<u64> {
    const PAGE: u64 = 4096;
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    {
        unsafe extern "C" {
            /// Gives freed memory back to the system (glibc).
            fn malloc_trim(pad: usize) -> std::ffi::c_int;
        }
        // SAFETY: it may be called at any time, from any thread.
        unsafe { malloc_trim(0) };
    }
    Some(read("/proc/self/statm")?.split_whitespace().nth(1)?.parse::<u64>().ok()? * PAGE)
}

fn processor() -> String {
    let text = read("/proc/cpuinfo").unwrap_or_default();
    let entry = |name: &str| -> Option<String> {
        let line = text.lines().find(|l| l.split(':').next().is_some_and(|key| key.trim() == name))?;
        Some(line.split_once(':')?.1.trim().to_string())
    };
    match (entry("model name"), entry("cpu family"), entry("model")) {
        (Some(name), Some(family), Some(model)) => format!("{name} (family {family}, model {model})"),
        (Some(name), ..) => name,
        _ => std::env::consts::ARCH.into(),
    }
}

fn system() -> String {
    let release = read("/etc/os-release").unwrap_or_default();
    let pretty = release.lines().find_map(|l| l.strip_prefix("PRETTY_NAME="));
    pretty.map_or(std::env::consts::OS.into(), |p| p.trim_matches('"').to_string())
}

/// From the build's environment, else from git where the program lies in its tree's own target folder.
fn commit() -> String {
    if let Some(commit) = option_env!("HEXROLL_COMMIT") {
        return commit.into();
    }
    let describe = || -> Option<String> {
        let exe = std::env::current_exe().ok()?;
        let git = |arguments: &[&str]| -> Option<String> {
            let output = Command::new("git").arg("-C").arg(exe.parent()?).args(arguments).output().ok()?;
            let text = String::from_utf8(output.stdout).ok()?.trim().to_string();
            (output.status.success() && !text.is_empty()).then_some(text)
        };
        git(&["describe", "--always", "--dirty", "--tags"])
    };
    describe().unwrap_or("unknown".into())
}

/// The command line with the program's bare name.
fn command() -> String {
    let quoted = |a: String| if a.contains([' ', '*', '$']) { format!("'{a}'") } else { a };
    let arguments = std::env::args().skip(1).map(quoted);
    std::iter::once("hexroll".to_string()).chain(arguments).collect::<Vec<_>>().join(" ")
}

fn seconds_now() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |d| d.as_secs())
}

/// Civil date of a Unix time (H. Hinnant's days-to-civil: eras of 400 years that begin in March).
fn date(seconds: u64) -> String {
    let days = seconds / 86_400 + 719_468;
    let (era, day) = (days / 146_097, days % 146_097);
    let year = (day - day / 1_460 + day / 36_524 - day / 146_096) / 365;
    let day_of_year = day - (365 * year + year / 4 - year / 100);
    let shifted = (5 * day_of_year + 2) / 153;
    let day_of_month = day_of_year - (153 * shifted + 2) / 5 + 1;
    let month = if shifted < 10 { shifted + 3 } else { shifted - 9 };
    let year = year + 400 * era + u64::from(month <= 2);
    format!("{year:04}-{month:02}-{day_of_month:02}")
}

#[cfg(test)]
mod tests {
    use super::date;

    #[test]
    fn dates_are_those_of_the_calendar() {
        // `date -u -d @N +%F`
        for (seconds, day) in [
            (0, "1970-01-01"),
            (951_782_400, "2000-02-29"),
            (1_709_251_199, "2024-02-29"),
            (1_709_251_200, "2024-03-01"),
            (4_107_542_399, "2100-02-28"),
            (4_107_542_400, "2100-03-01"),
        ] {
            assert_eq!(date(seconds), day);
        }
    }
}
