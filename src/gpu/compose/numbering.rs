//! Numbers for the buffers of a program: parts declare them without, writable and under one name everywhere.

use crate::error::Result;
use crate::gpu::bindings::capabilities;
use naga::valid::{GlobalUse, ValidationFlags, Validator};
use naga::{AddressSpace, ResourceBinding, StorageAccess};

/// What a buffer of a program became.
#[derive(Debug, Clone, PartialEq)]
pub struct Numbered {
    pub name: String,
    pub index: u32,
    /// Whether the program writes it.
    pub written: bool,
}

/// Gives the buffers of a module whose bindings have no numbers theirs, from 0 in the order of `order`, and those that it only
/// reads their access. `fail` makes an error of what naga says.
pub fn number(
    module: &mut naga::Module,
    order: &[&str],
    fail: impl Fn(String) -> crate::Error,
) -> Result<Vec<Numbered>> {
    let analysis = Validator::new(ValidationFlags::all() - ValidationFlags::BINDINGS, capabilities())
        .validate(module)
        .map_err(|e| fail(format!("{e:?}")))?;
    let entry = analysis.get_entry_point(0);
    let mut numbered = Vec::new();
    for name in order {
        let of_name = |(_, v): &(naga::Handle<naga::GlobalVariable>, &mut naga::GlobalVariable)| {
            v.name.as_deref() == Some(name)
        };
        let Some((handle, variable)) = module.global_variables.iter_mut().find(of_name) else { continue };
        let written = entry[handle].intersects(GlobalUse::WRITE | GlobalUse::ATOMIC);
        let index = numbered.len() as u32;
        variable.binding = Some(ResourceBinding { group: 0, binding: index });
        if let AddressSpace::Storage { access } = &mut variable.space
            && !written
        {
            *access = StorageAccess::LOAD;
        }
        numbered.push(Numbered { name: name.to_string(), index, written });
    }
    Ok(numbered)
}

/// The declaration of a buffer with its number and its access.
pub fn with_number(text: &str, buffer: &Numbered) -> String {
    let text = if buffer.written {
        text.to_string()
    } else {
        text.replacen("<storage, read_write>", "<storage, read>", 1)
    };
    // Behind its comments.
    let at = text.rfind("\nvar<").map_or(0, |n| n + 1);
    format!("{}@group(0) @binding({}) {}", &text[..at], buffer.index, &text[at..])
}
