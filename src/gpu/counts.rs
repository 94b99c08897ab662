//! How many there are of everything that a dispatch or a buffer is as long as.

use super::buffers::PLAN;
use super::chains::Chains;
use super::series;
use crate::model::Model;

/// Threads of a work group, as written in every kernel.
pub const GROUP: usize = 64;
/// Partial sums of a reduction.
pub const PARTIALS: usize = 64;

/// Sizes of dispatches.
#[derive(Debug, Clone, Copy)]
pub struct Counts {
    pub elements: usize,
    /// Terms of a Prony series, and numbers that all points remember for it.
    pub terms: usize,
    pub remembered: usize,
    pub nodes: usize,
    pub surface: usize,
    pub rim: usize,
    /// Work groups of chains.
    pub chain_groups: usize,
    /// Corner slots, and those that the element pass fills.
    pub slots: usize,
    pub stored_slots: usize,
    /// Work groups a dispatch may have in one dimension.
    pub most_groups: u32,
}

impl Counts {
    /// Of a model in these chains; `road`: surface nodes can touch, `most_groups`: of an adapter.
    pub fn of(model: &Model, chains: &Chains, road: bool, most_groups: u32) -> Counts {
        Counts {
            elements: model.element_count(),
            terms: model.relaxation.terms.len(),
            remembered: series::remembered(model),
            nodes: model.node_count(),
            surface: if road { model.mesh.surface.len() } else { 0 },
            rim: model.mesh.rim.len(),
            chain_groups: chains.groups.len(),
            slots: chains.slot_count(),
            stored_slots: chains.stored_slots(),
            most_groups,
        }
    }

    /// Records of a sample's probe.
    pub fn probe_records(&self) -> usize {
        4 * self.nodes.div_ceil(GROUP)
    }

    /// Work groups for `items` threads, folded into two dimensions where one is too short.
    pub fn groups(&self, items: usize) -> [u32; 3] {
        let groups = items.div_ceil(GROUP) as u32;
        if groups <= self.most_groups {
            return [groups, 1, 1];
        }
        let rows = groups.div_ceil(self.most_groups);
        [groups.div_ceil(rows), rows, 1]
    }

    /// Most steps a submission may hold: those whose contact the device can keep, in 2 bytes an element or 1 MiB.
    pub fn contact_slots(&self) -> usize {
        match self.surface.div_ceil(GROUP) {
            0 => PLAN,
            groups => ((2 * self.elements).max(1 << 20) / (16 * groups)).clamp(64, PLAN),
        }
    }

    /// Records of the contact of those steps.
    pub fn contact_records(&self) -> usize {
        self.contact_slots() * self.surface.div_ceil(GROUP)
    }
}
