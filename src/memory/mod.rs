//! Memory is asked for before it is taken: what a run will hold, from element counts alone, against what there is. A run that
//! does not fit is refused with numbers, before the first array of its mesh is allocated. The body, the engine and the search for
//! the critical step each say what they hold (`model/memory.rs`, `cpu/memory.rs`, `run/stability.rs`).

mod counts;
mod need;

pub use counts::Counts;
pub use need::{Need, Part};

use crate::error::{Error, Result};
use crate::scene::{MeshSpec, Scene};

/// Memory that can be had now, and what limits it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct There {
    pub bytes: u64,
    pub limit: &'static str,
}

/// A need below this is not looked at: no machine that runs this program lacks it, and looking costs more than small runs take.
const NOT_WORTH_A_LOOK: u64 = 32 << 20;

/// What a process may map beside its arrays, of a limit on its addresses: stacks, and the heaps that the C library sets aside for
/// threads.
const ASIDE: u64 = 128 << 20;

/// Of what there is, the share that counts advised of may need: one run finds a little more than the next.
const ADVISED: f64 = 0.95;

/// The smallest of what the machine has free, what the control group leaves, and what the limit on addresses leaves; none where
/// the system says nothing.
pub fn there() -> Option<There> {
    let system = sysinfo::System::new_with_specifics(
        sysinfo::RefreshKind::nothing().with_memory(sysinfo::MemoryRefreshKind::nothing().with_ram()),
    )
    .ok();
    let free =
        system.as_ref().map(|s| There { bytes: s.available_memory(), limit: "free memory of the machine" });
    let total = system.as_ref().map_or(0, sysinfo::System::total_memory);
    let group = system.as_ref().and_then(sysinfo::System::cgroup_limits);
    let group = group.filter(|g| g.total_memory < total).map(|g| There {
        // The cache of files is given back on demand: what counts is what processes hold.
        bytes: g.total_memory.saturating_sub(g.rss),
        limit: "limit of the control group",
    });
    [free.filter(|free| free.bytes > 0), group, addresses()].into_iter().flatten().min_by_key(|t| t.bytes)
}

/// What is left of the limit on this process's addresses (`ulimit -v`).
#[cfg(unix)]
fn addresses() -> Option<There> {
    use rustix::process::{Resource, getrlimit};
    let most = getrlimit(Resource::As).current?;
    let mapped = std::fs::read_to_string("/proc/self/maps").map_or(0, |maps| mapped(&maps));
    Some(There { bytes: most.saturating_sub(mapped + ASIDE), limit: "limit of addresses, ulimit -v" })
}

/// Bytes of the regions in `maps` (a line each: first-last address, rights, ..) that can be read or written. The others are set
/// aside, which [`ASIDE`] stands for: a thread's heap is there or not yet, as threads happen to start.
#[cfg(unix)]
fn mapped(maps: &str) -> u64 {
    let region = |line: &str| {
        let (addresses, rights) = line.split_once(' ')?;
        let (first, last) = addresses.split_once('-')?;
        let [first, last] = [first, last].map(|a| u64::from_str_radix(a, 16).ok());
        (!rights.starts_with("---")).then_some(last?.checked_sub(first?)?)
    };
    maps.lines().filter_map(region).sum()
}

#[cfg(not(unix))]
fn addresses() -> Option<There> {
    None
}

/// Refuses what does not fit: `need` says what a scene, and one of other element counts, needs.
///
/// # Errors
/// [`Error::Memory`].
pub fn ensure(scene: &Scene, need: impl Fn(&Scene) -> Need) -> Result<()> {
    if need(scene).bytes() < NOT_WORTH_A_LOOK {
        return Ok(());
    }
    there().map_or(Ok(()), |there| within(there, scene, need))
}

fn within(there: There, scene: &Scene, need: impl Fn(&Scene) -> Need) -> Result<()> {
    let needed = need(scene);
    if needed.bytes() <= there.bytes {
        return Ok(());
    }
    Err(Error::Memory {
        elements: Counts::of(scene).elements,
        need: needed.bytes(),
        parts: needed.to_string(),
        there: there.bytes,
        limit: there.limit,
        fits: largest((ADVISED * there.bytes as f64) as u64, scene, need).map_or_else(
            || nothing_fits(scene),
            |c| format!("body.mesh.elements = {c:?} ({} elements) would fit", c.iter().product::<usize>()),
        ),
    })
}

fn nothing_fits(scene: &Scene) -> String {
    match scene.body.mesh {
        MeshSpec::File(_) => {
            "a coarser mesh would fit (the counts are guessed from the size of its file)".into()
        }
        MeshSpec::Ring { .. } | MeshSpec::Block { .. } => "no mesh would fit".into(),
    }
}

/// The largest element counts of about the scene's proportions whose need is within `bytes`.
fn largest(bytes: u64, scene: &Scene, need: impl Fn(&Scene) -> Need) -> Option<[usize; 3]> {
    let elements = scene.body.mesh.elements()?;
    // A closed ring needs three sides.
    let least = if matches!(scene.body.mesh, MeshSpec::Ring { .. }) { [3, 1, 1] } else { [1; 3] };
    let scaled =
        |s: f64| -> [usize; 3] { std::array::from_fn(|d| ((elements[d] as f64 * s) as usize).max(least[d])) };
    let fits = |counts: [usize; 3]| {
        let mut other = scene.clone();
        *other.body.mesh.elements_mut().expect("a generator has counts") = counts;
        need(&other).bytes() <= bytes
    };
    if !fits(scaled(0.0)) {
        return None;
    }
    // More halvings than a count has digits.
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if fits(scaled(middle)) { low = middle } else { high = middle }
    }
    Some(scaled(low))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A block of so many elements.
    fn block(elements: [usize; 3]) -> Scene {
        let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/spinning_block.toml");
        Scene::load(&file, &[format!("body.mesh.elements={elements:?}")]).unwrap()
    }

    #[cfg(unix)]
    #[test]
    fn heaps_that_threads_may_yet_fill_are_not_counted() {
        let maps = "55d0c000-55d0f000 r-xp 00000000 fe:00 12 /bin/a\n7f00000000-7f00021000 rw-p 00000000 00:00 0 \n\
                    7f00021000-7f04000000 ---p 00000000 00:00 0 \n";
        assert_eq!(mapped(maps), 0x3000 + 0x21000);
    }

    #[test]
    fn what_does_not_fit_is_refused_with_counts_that_do() {
        let scene = block([2000, 100, 200]);
        let need =
            |scene: &Scene| Need::from(Part { name: "test", bytes: 1000 * Counts::of(scene).elements });
        let there = |bytes| There { bytes, limit: "a limit" };
        let error = within(there(4 << 30), &scene, need).unwrap_err();
        assert_eq!(error.exit_code(), 4);
        let text = error.to_string();
        for part in
            ["40000000 elements need 40.00 GB (test 40.00 GB)", "4.29 GB can be had (a limit)", "would fit"]
        {
            assert!(text.contains(part), "{text}");
        }
        let counts = largest(4 << 30, &scene, need).unwrap();
        let elements = counts.iter().product::<usize>() as u64;
        // One more layer along the shortest direction is some 2 %.
        assert!(1000 * elements <= 4 << 30 && 1000 * elements > 4 << 29, "{counts:?}");
        assert!(within(there(40_000_000_000), &scene, need).is_ok());
        assert_eq!(largest(10, &scene, need), None);
    }
}
