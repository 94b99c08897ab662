//! Errors carry the values that explain them; `main` prints one once, with its causes.

use std::path::PathBuf;

/// Everything that can end a command.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A scene file that cannot be used: where, which key, what is wrong and what would be right.
    #[error("{file}{}: {key}: {problem}; {remedy}", .line.map(|l| format!(":{l}")).unwrap_or_default())]
    Scene { file: String, line: Option<usize>, key: String, problem: String, remedy: String },

    /// Something a scene may name one day, but that this version does not have.
    #[error("{what} is not available in this version; {instead}")]
    Unsupported { what: String, instead: String },

    /// A file or folder that could not be read or written.
    #[error("{}: cannot {action}", .path.display())]
    Io {
        path: PathBuf,
        action: &'static str,
        #[source]
        source: std::io::Error,
    },

    /// A result file whose content is not what this program writes.
    #[error("{}: {problem}", .path.display())]
    Format { path: PathBuf, problem: String },

    /// An element turned inside out or lost its volume: J = det F at a point is not positive.
    #[error(
        "element {element} inverted at step {step} (t = {time:.6e} s): det F is not positive; \
         the last good sample is kept. A smaller time_step.safety, a gentler load or a finer mesh may help"
    )]
    Inverted { step: u64, time: f64, element: usize },

    /// A NaN or infinity in the element pass.
    #[error(
        "element {element} has a value that is not finite at step {step} (t = {time:.6e} s); \
         the last good sample is kept. A smaller time_step.safety may help"
    )]
    NotFinite { step: u64, time: f64, element: usize },

    /// Energies that do not add up: the steps were too long, though no element failed.
    #[error(
        "stored energy and works differ by {:.0} % of the largest of them after step {step} (t = {time:.6e} s): steps are too \
         long for what happens in them; everything up to here is kept. A smaller time_step.safety, or windows (output.sample) \
         shorter than an impact, after which the critical step is looked at again, may help", 100.0 * share
    )]
    Unbalanced { step: u64, time: f64, share: f64 },

    /// The zero-energy modes of `uniform-gradient` have taken over, by the limit that the scene sets.
    #[error(
        "hourglass energy is {:.0} % of the strain energy after step {step} (t = {time:.6e} s), more than \
         body.hourglass_limit = {limit}; everything up to here is kept. element = \"q1p0\" or \"full\", or a finer mesh, helps",
        100.0 * share
    )]
    Hourglass { step: u64, time: f64, share: f64, limit: f64 },

    /// A body where its road has neither heights nor a border.
    #[error(
        "there is no road at ({:.6}, {:.6}, {:.6}) m, where the body is at t = {time:.6e} s: the map ends there, or a sample is missing; \
         everything up to here is kept. A larger map, road.border = \"periodic\" or \"keep\", or another way of the rim helps",
        at[0], at[1], at[2]
    )]
    OffRoad { time: f64, at: [f64; 3] },

    /// No adapter can run compute shaders.
    #[error(
        "no GPU adapter found ({detail}); install a Vulkan driver (Debian: mesa-vulkan-drivers) or use --engine cpu"
    )]
    NoAdapter { detail: String },

    /// The scene needs more than the adapter offers.
    #[error(
        "the scene needs {need} for {what}, but {adapter} offers {limit}; about {fits} elements would fit"
    )]
    TooLarge { what: String, need: u64, limit: u64, adapter: String, fits: u64 },

    /// The run needs more memory than there is: nothing of it has been taken yet.
    #[error(
        "{elements} elements need {:.2} GB ({parts}), but {:.2} GB can be had ({limit}); {fits}", 1e-9 * *need as f64,
        1e-9 * *there as f64
    )]
    Memory { elements: u64, need: u64, parts: String, there: u64, limit: &'static str, fits: String },

    /// A picture that cannot be drawn from the data given.
    #[error("cannot draw the picture: {problem}")]
    Picture { problem: String },

    /// The adapter went away or refused a request.
    #[error("GPU adapter {adapter}: {detail}")]
    Device { adapter: String, detail: String },

    /// A quasi-static or other iterative stage ended without reaching its criterion.
    #[error("stage {stage:?} did not settle: {detail}")]
    NotSettled { stage: String, detail: String },

    /// A report whose claims do not all hold.
    #[error("claims that do not hold: {cases}; the report says by how much")]
    Claims { cases: String },

    /// Rows of a bench that failed, or whose results are wrong: a fast wrong run is a failed run.
    #[error("bench rows failed: {detail}")]
    Bench { detail: String },

    /// Ctrl-C: everything computed so far has been written.
    #[error("interrupted at t = {time:.6e} s; everything computed so far is in {}", .out.display())]
    Interrupted { time: f64, out: PathBuf },
}

/// Result of this crate.
pub type Result<T> = std::result::Result<T, Error>;

impl Error {
    /// Exit code of the program: 2 bad input, 3 no such feature, 4 no usable adapter or not memory enough, 5 the run failed
    /// numerically, 6 files, 130 interrupted.
    pub fn exit_code(&self) -> u8 {
        match self {
            Error::Scene { .. } => 2,
            Error::Unsupported { .. } => 3,
            Error::NoAdapter { .. }
            | Error::TooLarge { .. }
            | Error::Memory { .. }
            | Error::Device { .. } => 4,
            Error::Inverted { .. }
            | Error::NotFinite { .. }
            | Error::Unbalanced { .. }
            | Error::Hourglass { .. }
            | Error::OffRoad { .. }
            | Error::NotSettled { .. }
            | Error::Claims { .. }
            | Error::Bench { .. } => 5,
            Error::Io { .. } | Error::Format { .. } | Error::Picture { .. } => 6,
            Error::Interrupted { .. } => 130,
        }
    }

    /// Wraps an I/O error with the path and what was being done to it.
    pub fn io(path: impl Into<PathBuf>, action: &'static str) -> impl FnOnce(std::io::Error) -> Error {
        let path = path.into();
        move |source| Error::Io { path, action, source }
    }
}
