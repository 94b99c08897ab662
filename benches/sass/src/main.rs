//! WGSL from standard input as Metal's C++ on standard output, without checks of indices and loops.

use naga::back::msl;
use naga::proc::{BoundsCheckPolicies, BoundsCheckPolicy::Unchecked};
use naga::valid::{Capabilities, ValidationFlags, Validator};

fn main() {
    if let Err(error) = translate() {
        eprintln!("{error}");
        std::process::exit(1);
    }
}

fn translate() -> Result<(), String> {
    let text = std::io::read_to_string(std::io::stdin()).map_err(|e| e.to_string())?;
    let mut module = naga::front::wgsl::parse_str(&text).map_err(|e| e.emit_to_string(&text))?;
    naga::compact::compact(&mut module, naga::compact::KeepUnused::No);
    let info = Validator::new(ValidationFlags::all(), Capabilities::all())
        .validate(&module)
        .map_err(|e| e.emit_to_string(&text))?;
    let options = msl::Options {
        fake_missing_bindings: true,
        zero_initialize_workgroup_memory: false,
        force_loop_bounding: false,
        bounds_check_policies: BoundsCheckPolicies {
            index: Unchecked,
            buffer: Unchecked,
            image_load: Unchecked,
            binding_array: Unchecked,
        },
        ..Default::default()
    };
    let (metal, _) = msl::write_string(&module, &info, &options, &Default::default())
        .map_err(|e| e.to_string())?;
    print!("{metal}");
    Ok(())
}
