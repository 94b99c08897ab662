//! A scene's motions on its mesh.

use super::mesh::{Driven, Mesh, UnknownSet};
use crate::error::Result;
use crate::scene::Scene;

/// The mesh with what its nodes follow: those components are held besides those that are already.
pub(super) fn driven(mut mesh: Mesh, scene: &Scene) -> Result<Mesh> {
    let file = scene.file.display().to_string();
    for (k, motion) in scene.recorded().into_iter().enumerate() {
        let moves = k < scene.motions.len();
        let number =
            |of: usize| scene.holds.iter().enumerate().filter(|(_, h)| h.reaction).nth(of).map_or(0, |h| h.0);
        let key = match moves {
            true => format!("motion.{k}.nodes"),
            false => format!("hold.{}.nodes", number(k - scene.motions.len())),
        };
        let unknown = |e: UnknownSet| motion.nodes.unknown(&file, &key, &e.known);
        let components = motion.prescribed();
        let bits = (0..3).filter(|&d| components[d]).fold(0, |bits, d| bits | 1 << d);
        let is_rim = |n: &u32| mesh.rim.binary_search(n).is_ok();
        let mut nodes = mesh.set(&motion.nodes.name).map_err(unknown)?;
        if moves {
            let held = |n: &u32| mesh.held.get(*n as usize).is_some_and(|held| held & bits != 0);
            let taken = nodes.iter().find(|n| is_rim(n) || held(n));
            if let Some(&n) = taken {
                let by = if is_rim(&n) { "moved by the rim" } else { "held or moved by another section" };
                let problem = format!("node {n} of the set is {by} along the same component");
                let remedy = "name sets that share no node along the components they prescribe".into();
                return Err(motion.nodes.error(&file, &key, problem, remedy));
            }
        }
        nodes.retain(|n| !is_rim(n));
        mesh = mesh
            .with_held(&motion.nodes.name, components)
            .map_err(|e| motion.nodes.unknown(&file, &key, &e.known))?;
        mesh.driven.push(Driven { nodes, components, motion });
    }
    Ok(mesh)
}
