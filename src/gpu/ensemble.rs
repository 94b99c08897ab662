//! Several bodies on one device that take their steps together: a work group a body, all of them in one submission.
//!
//! Every body has an engine of its own, driven by a thread of its own, with its own stages, windows and steps. When each of
//! them waits for steps to be taken, one thread submits those of all. Bodies with the same kernels and tables are *alike*:
//! their arrays are parts of the same buffers, and one dispatch takes the steps of all that wait and are in the same kind of
//! stage. Others have dispatches of their own in the same pass, with nothing between them to wait for. A body alone is
//! dispatched by the same kernel, so that its results do not depend on who else is there, to the bit.

use super::Gpu;
use super::engine::GpuEngine;
use super::meeting::{Job, Seat, Seated, Together};
use super::precision::Precision;
use super::prepared::Prepared;
use super::upload::MEMBERS;
use crate::engine::Step;
use crate::error::{Error, Result};
use crate::model::Model;
use crate::physics::rim::Coordinates;
use crate::scene::Scene;
use std::sync::Arc;

/// Engines in plain f32 for bodies that each fit into one work group's memory. Each is to be driven by a thread of its own
/// and dropped when it has nothing more to do: a body that takes no steps keeps the others waiting.
///
/// # Errors
/// [`Error::Unsupported`] for a mesh that does not fit; those of [`GpuEngine::new`].
pub fn ensemble(gpu: &Gpu, bodies: &[(&Model, &Scene)]) -> Result<Vec<GpuEngine>> {
    let prepared = bodies.iter().map(|(model, scene)| {
        let prepared = Prepared::new(gpu, model, scene, Precision::F32)?;
        if prepared.shape.is_none() {
            return Err(Error::Unsupported {
                what: format!("an ensemble of meshes of {} elements on {}", prepared.counts.elements, gpu.report.name),
                instead: "mesh them so that positions and forces fit into one work group's memory (1,320 nodes need \
                          32 KiB), or run them one by one"
                    .into(),
            });
        }
        Ok(prepared)
    });
    let prepared = prepared.collect::<Result<Vec<Prepared>>>()?;
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (k, body) in prepared.iter().enumerate() {
        let most = body.most_bodies(gpu).min(MEMBERS);
        let alike = |group: &&mut Vec<usize>| group.len() < most && prepared[group[0]].is_alike(body);
        match groups.iter_mut().find(alike) {
            Some(group) => group.push(k),
            None => groups.push(vec![k]),
        }
    }
    let buffers: Vec<_> = groups.iter().map(|g| prepared[g[0]].buffers(gpu, g.len())).collect();
    gpu.check()?;
    let mut places: Vec<Seated> = vec![(0, 0); prepared.len()];
    for (g, group) in groups.iter().enumerate() {
        group.iter().enumerate().for_each(|(body, &k)| places[k] = (g, body));
    }
    let members = buffers.iter().map(|b| b.get("members").clone());
    let together = Arc::new(Together::new(gpu, members, prepared.len()));
    let engine = |(prepared, seated): (Prepared, Seated)| {
        let seat = Seat { together: together.clone(), seated };
        GpuEngine::of_prepared(gpu, prepared, buffers[seated.0].of_body(seated.1), Some(seat))
    };
    prepared.into_iter().zip(places).map(engine).collect()
}

/// Takes the same steps with every engine of an ensemble, from one thread: no one waits for anyone. To the bit what
/// [`Engine::advance`](crate::engine::Engine::advance) does with each.
///
/// # Errors
/// Those of `advance`, the first one's; [`Error::Unsupported`] where a stage's rim moves freely, which no engine of small
/// meshes has.
pub fn advance_together(engines: &mut [GpuEngine], steps: &[Step]) -> Result<()> {
    let begun = engines.iter_mut().map(|e| e.begin_steps(steps)).collect::<Result<Vec<_>>>()?;
    let Some(together) = engines.iter().find_map(|e| e.seat.as_ref()).map(|seat| seat.together.clone())
    else {
        return Ok(());
    };
    let mut at = 0;
    while at < steps.len() {
        let end = engines.iter().map(|e| at + e.pace.per_submit).fold(steps.len(), usize::min);
        let job = |(engine, (_, starts)): (&GpuEngine, &(u64, Vec<Coordinates>))| {
            engine.write_steps(&steps[at..end], &starts[at..end]);
            engine.job(end - at).ok_or_else(|| Error::Unsupported {
                what: "an ensemble whose rims move freely".into(),
                instead: "prescribe the rims' motion, or advance each engine by itself".into(),
            })
        };
        let jobs = engines.iter().zip(&begun).map(job).collect::<Result<Vec<Job>>>()?;
        let taken = together.try_submit(&jobs)?;
        for (engine, taken) in engines.iter_mut().zip(&taken) {
            engine.took(&steps[at..end], taken);
            engine.learn(end - at, taken);
        }
        at = end;
    }
    engines.iter_mut().zip(&begun).try_for_each(|(engine, (first, _))| engine.end_steps(steps, *first))
}
