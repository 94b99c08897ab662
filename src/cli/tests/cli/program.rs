//! The built program in a folder of its own, and small scenes for it.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use tempfile::TempDir;

/// A folder that goes with the test.
pub struct Place {
    pub dir: TempDir,
}

/// What a command left behind.
#[derive(Debug)]
pub struct Done {
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

impl Place {
    pub fn new() -> Place {
        Place { dir: TempDir::new().unwrap() }
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.dir.path().join(name)
    }

    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_hexroll"));
        command.args(arguments).current_dir(self.dir.path()).stdin(Stdio::null());
        command
    }

    pub fn hexroll(&self, arguments: &[&str]) -> Done {
        Done::from(self.command(arguments).output().unwrap())
    }

    /// Writes a scene file of the block, changed by `change`.
    pub fn scene(&self, name: &str, change: impl Fn(String) -> String) -> PathBuf {
        let path = self.path(name);
        std::fs::write(&path, change(BLOCK.into())).unwrap();
        path
    }
}

impl From<Output> for Done {
    fn from(output: Output) -> Done {
        let text = |bytes| String::from_utf8(bytes).unwrap();
        Done { code: output.status.code(), stdout: text(output.stdout), stderr: text(output.stderr) }
    }
}

impl Done {
    /// Panics with everything that was said, unless the command ended with `code`.
    #[track_caller]
    pub fn expect(self, code: i32) -> Done {
        assert_eq!(self.code, Some(code), "{self:#?}");
        self
    }
}

/// A scene that ships with the program.
pub fn shipped(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(name).display().to_string()
}

/// A rubber block of 8 elements that falls on a road, with friction: 10 windows of 0.1 ms in two stages.
pub const BLOCK: &str = r#"title = "A block falls"
gravity = ["0 m/s2", "0 m/s2", "-9.81 m/s2"]

[body]
density = "1100 kg/m3"
velocity = ["0.1 m/s", "0 m/s", "-1 m/s"]

[body.mesh]
generator = "block"
size = ["20 mm", "20 mm", "20 mm"]
elements = [2, 2, 2]

[body.material]
law = "mooney-rivlin"
shear_modulus = "2.64 MPa"
bulk_modulus = "65.1 MPa"
viscosity = "2 Pa s"

[road]
shape = "plane"

[friction]
coefficient = 0.5

[[stage]]
name = "land"
method = "explicit"
duration = "0.6 ms"

[[stage]]
name = "slide"
method = "explicit"
duration = "0.4 ms"

[output]
sample = "0.1 ms"
"#;
