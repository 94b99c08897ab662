//! Bytes that something will hold, by part.

use std::fmt;

/// Bytes by part.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize)]
pub struct Need {
    pub parts: Vec<Part>,
}

/// Who holds memory, and how much when it holds most.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub struct Part {
    pub name: &'static str,
    pub bytes: u64,
}

impl Need {
    pub fn bytes(&self) -> u64 {
        self.parts.iter().map(|p| p.bytes).sum()
    }
}

impl From<Part> for Need {
    fn from(part: Part) -> Need {
        Need { parts: vec![part] }
    }
}

/// `body 1.20 GB, engine 3.40 GB`
impl fmt::Display for Need {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let part = |p: &Part| format!("{} {:.2} GB", p.name, 1e-9 * p.bytes as f64);
        f.write_str(&self.parts.iter().map(part).collect::<Vec<_>>().join(", "))
    }
}
