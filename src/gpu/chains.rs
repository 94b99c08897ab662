//! Elements in chains: the order in which the element pass goes through a mesh, and who gathers from where.

pub use super::lattice::LANES;
use super::lattice::Lattice;
use crate::model::Model;
use std::collections::HashMap;

/// Corners of a face.
const CORNERS: usize = 4;
/// Slots of a face of 64 chains that store all corners: from one face of a chain to the next.
const FACE: usize = LANES * CORNERS;
/// Most shape classes of the table that shaders/class/shared.wgsl declares.
pub const SHARED_CLASSES: usize = 48;

/// Threads that keep a large GPU busy: where there are fewer elements than that times the length, chains are shorter.
const BUSY: usize = 65_536;

/// Elements of which a mesh may fit into one work group's memory.
const RESIDENT: usize = 2048;
/// Threads of such a work group, at most: enough for a chain each on small wheels, few enough that each has the registers it
/// needs (on NVIDIA hardware 65,536 for 384 threads: 168 each; `benches/sass` counts them).
pub const THREADS: usize = 384;

/// Elements a chain has at most: long ones move less memory, short ones keep more threads busy. A software adapter's
/// threads are lanes of a few processors, so there the longest are best. In one work group chains are as long as its
/// threads ask: a wheel of 880 elements in chains of 5 would keep half of them waiting.
pub fn longest(software: bool, elements: usize) -> usize {
    match elements {
        _ if software => 16,
        0..=RESIDENT => elements.div_ceil(THREADS).clamp(1, 16),
        _ => (elements / BUSY).clamp(1, 8),
    }
}

/// Work groups of 64 chains of one length. A chain's elements share faces: corners 4 to 7 of one are corners 0 to 3 of
/// the next, so that a chain of n elements has 4 (n + 1) corner slots, not 8 n.
#[derive(Debug, Clone)]
pub struct Chains {
    /// First slot, first entry of `classes` (shared classes), elements a chain, chains; shape `[group_count]`.
    pub groups: Vec<[u32; 4]>,
    /// Slots from one face of a chain to the next: 64 chains by 4 corners; in a lattice whose chains are joined
    /// (shaders/slots/joined.wgsl) 64 by 2, and 2 for each place where a row or a group may end.
    pub face: usize,
    /// Node at every corner: 64 chains by 4 corners by faces of a group; shape `[256 faces]`.
    pub nodes: Vec<u32>,
    /// Whether the chains of a group have the same classes, in the same order.
    pub shared_classes: bool,
    /// Class of every element along a group's chains (shared), or of the element whose lower face is there.
    pub classes: Vec<u32>,
    /// The element whose lower face is there: 64 chains by faces of a group.
    pub elements: Vec<u32>,
    /// The numbering, where it is a generator's: then `nodes` and `elements` follow from it, slots of nodes too.
    pub lattice: Option<Lattice>,
    /// Elements of a chain, at most, as asked for.
    pub longest: usize,
    /// Slots of each node, ascending: `slots[start[n]..start[n + 1]]`; empty where there is a lattice.
    pub start: Vec<u32>,
    pub slots: Vec<u32>,
}

impl Chains {
    /// Chains of at most `longest` elements; `joined`: of a lattice, those side by side add up their forces before they
    /// store them.
    pub fn new(model: &Model, longest: usize, joined: bool) -> Chains {
        let longest = longest.max(1);
        match Lattice::of(&model.mesh) {
            Some(lattice) => Chains::of_lattice(model, longest, lattice, joined),
            None => Chains::of_any(model, longest),
        }
    }

    /// By tables, whatever the numbering.
    fn of_any(model: &Model, longest: usize) -> Chains {
        let chains = cut(model, longest);
        let lanes = chains.len().div_ceil(LANES);
        let by_class = group(&chains, |chain| classes(model, chain));
        // Groups whose chains have the same classes are worth little if most of them are nearly empty.
        let shared_classes = model.classes.len() <= SHARED_CLASSES && by_class.len() <= 2 * lanes;
        let groups = if shared_classes { by_class } else { group(&chains, |chain| vec![chain.len() as u32]) };
        let mut all = Chains::empty(longest, None, shared_classes);
        all.start = vec![0; model.node_count() + 1];
        let mut used: Vec<(u32, u32)> = Vec::new();
        groups.iter().for_each(|g| all.push(model, g, &mut used));
        all.gather(used);
        all
    }

    /// In the order that shaders/chain/lattice.wgsl and shaders/gather/lattice.wgsl compute.
    fn of_lattice(model: &Model, longest: usize, lattice: Lattice, joined: bool) -> Chains {
        let layers = lattice.chains(longest);
        let groups: Vec<Vec<&[u32]>> = (layers.iter())
            .flat_map(|layer| layer.chunks(LANES).map(|group| group.iter().map(Vec::as_slice).collect()))
            .collect();
        let equal = |group: &Vec<&[u32]>| {
            let first = classes(model, group[0]);
            group.iter().all(|chain| classes(model, chain) == first)
        };
        let shared_classes = model.classes.len() <= SHARED_CLASSES && groups.iter().all(equal);
        let mut all = Chains::empty(longest, Some(lattice), shared_classes);
        if joined {
            all.face = 2 * (LANES + lattice.row_ends(LANES));
        }
        groups.iter().for_each(|g| all.push(model, g, &mut Vec::new()));
        all
    }

    fn empty(longest: usize, lattice: Option<Lattice>, shared_classes: bool) -> Chains {
        Chains {
            groups: Vec::new(),
            face: FACE,
            nodes: Vec::new(),
            shared_classes,
            classes: Vec::new(),
            elements: Vec::new(),
            lattice,
            longest,
            start: Vec::new(),
            slots: Vec::new(),
        }
    }

    /// Slots of all groups, those of missing chains included.
    pub fn slot_count(&self) -> usize {
        self.nodes.len() / FACE * self.face
    }

    /// Nodes at corner `corner` of face `face` of a group's chains.
    pub fn corner_nodes(&self, group: &[u32; 4], face: usize, corner: usize) -> &[u32] {
        let at = (group[0] as usize / self.face + face) * FACE + corner * LANES;
        &self.nodes[at..at + group[3] as usize]
    }

    /// Whether chains side by side add up their forces before they store them.
    pub fn is_joined(&self) -> bool {
        self.face != FACE
    }

    /// Slots that are filled. Where chains are joined, one whose neighbour in its group and row has its forces on the
    /// corners between them does not store these.
    pub fn stored_slots(&self) -> usize {
        let row =
            self.lattice.filter(|_| self.is_joined()).map(|lattice| (lattice.elements[0], lattice.columns()));
        let mut first = 0;
        let mut stored = 0;
        for &[_, _, length, chains] in &self.groups {
            let chains = chains as usize;
            // Chains with one on their left.
            let passed =
                row.map_or(0, |(row, _)| (first + 1..first + chains).filter(|c| c % row > 0).count());
            stored += (length as usize + 1) * (CORNERS * chains - 2 * passed);
            first += chains;
            if row.is_some_and(|(_, layer)| first == layer) {
                first = 0;
            }
        }
        stored
    }

    /// Appends a group of chains of one length; `used` gains (node, slot).
    fn push(&mut self, model: &Model, chains: &[&[u32]], used: &mut Vec<(u32, u32)>) {
        let (first, length) = (self.slot_count(), chains[0].len());
        let sequence = self.classes.len() as u32;
        let class = |e: &u32| model.class_of[*e as usize];
        if self.shared_classes {
            self.classes.extend(chains[0].iter().map(class));
        }
        for level in 0..=length {
            let mut face = [0; FACE];
            let mut elements = [0; LANES];
            for (lane, chain) in chains.iter().enumerate() {
                let element = chain[level.min(length - 1)];
                let upper = if level < length { 0 } else { CORNERS };
                elements[lane] = element;
                for corner in 0..CORNERS {
                    let (node, at) =
                        (model.mesh.hexes[element as usize][corner + upper], corner * LANES + lane);
                    face[at] = node;
                    used.push((node, (self.nodes.len() + at) as u32));
                }
            }
            self.nodes.extend(face);
            self.elements.extend(elements);
            if !self.shared_classes {
                self.classes.extend(elements.iter().map(class));
            }
        }
        self.groups.push([first as u32, sequence, length as u32, chains.len() as u32]);
    }

    fn gather(&mut self, mut used: Vec<(u32, u32)>) {
        used.sort_unstable();
        for &(node, _) in &used {
            self.start[node as usize + 1] += 1;
        }
        for n in 1..self.start.len() {
            self.start[n] += self.start[n - 1];
        }
        self.slots = used.into_iter().map(|(_, slot)| slot).collect();
    }
}

fn classes(model: &Model, chain: &[u32]) -> Vec<u32> {
    chain.iter().map(|&e| model.class_of[e as usize]).collect()
}

/// Chains of at most `longest` elements, by their first element.
fn cut(model: &Model, longest: usize) -> Vec<Vec<u32>> {
    let hexes = &model.mesh.hexes;
    let lower: HashMap<[u32; 4], u32> =
        hexes.iter().enumerate().map(|(e, h)| ([h[0], h[1], h[2], h[3]], e as u32)).collect();
    let next: Vec<Option<u32>> =
        hexes.iter().map(|h| lower.get(&[h[4], h[5], h[6], h[7]]).copied()).collect();
    let mut is_next = vec![false; hexes.len()];
    next.iter().flatten().for_each(|&e| is_next[e as usize] = true);
    let mut met = vec![false; hexes.len()];
    let mut chains = Vec::new();
    // From every beginning; then whatever lies on closed chains.
    let beginnings = (0..hexes.len()).filter(|&e| !is_next[e]).chain(0..hexes.len());
    for beginning in beginnings {
        let mut line = Vec::new();
        let mut at = Some(beginning as u32);
        while let Some(e) = at.filter(|&e| !met[e as usize]) {
            met[e as usize] = true;
            line.push(e);
            at = next[e as usize];
        }
        // Pieces of about one length.
        let length = line.len().div_ceil(line.len().div_ceil(longest).max(1)).max(1);
        chains.extend(line.chunks(length).map(<[u32]>::to_vec));
    }
    chains.sort_unstable();
    chains
}

/// Groups of at most 64 chains whose `kind` is the same, in the order in which kinds appear.
fn group(chains: &[Vec<u32>], kind: impl Fn(&[u32]) -> Vec<u32>) -> Vec<Vec<&[u32]>> {
    let mut kinds: HashMap<Vec<u32>, usize> = HashMap::new();
    let mut members: Vec<Vec<&[u32]>> = Vec::new();
    for chain in chains {
        let fresh = members.len();
        let at = *kinds.entry(kind(chain)).or_insert(fresh);
        if at == fresh {
            members.push(Vec::new());
        }
        members[at].push(chain);
    }
    members.iter().flat_map(|m| m.chunks(LANES).map(<[&[u32]]>::to_vec)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;
    use std::path::Path;

    fn model(elements: [usize; 3]) -> Model {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/lat100_straight.toml");
        let scene = Scene::load(&file, &[format!("body.mesh.elements={elements:?}")]).unwrap();
        Model::new(&scene).unwrap()
    }

    /// Every corner of every element is a slot of its node, and every element is met once, whatever the length.
    #[test]
    fn chains_hold_every_element_once_and_every_node_gathers_all_its_corners() {
        let model = model([7, 5, 3]);
        let lattice = Lattice::of(&model.mesh).unwrap();
        let all = |longest| {
            let lattice_chains = |joined| Chains::of_lattice(&model, longest, lattice, joined);
            [Chains::of_any(&model, longest), lattice_chains(false), lattice_chains(true)]
        };
        for chains in [1, 2, 3, 5, 9].into_iter().flat_map(all) {
            let mut met = vec![0; model.element_count()];
            let mut corners: Vec<Vec<u32>> = vec![Vec::new(); model.node_count()];
            let mut next = 0;
            for &[first, sequence, length, lanes] in &chains.groups {
                assert_eq!(first as usize, next);
                next += (length as usize + 1) * chains.face;
                for lane in 0..lanes as usize {
                    for level in 0..length as usize {
                        let at = first as usize + level * chains.face + lane;
                        let entry = at / chains.face * LANES + at % chains.face;
                        let element = chains.elements[entry];
                        met[element as usize] += 1;
                        let hex = model.mesh.hexes[element as usize];
                        let class = if chains.shared_classes {
                            chains.classes[sequence as usize + level]
                        } else {
                            chains.classes[entry]
                        };
                        assert_eq!(class, model.class_of[element as usize]);
                        let group = [first, sequence, length, lanes];
                        let node = |c: usize| chains.corner_nodes(&group, level + c / 4, c % 4)[lane];
                        assert_eq!(std::array::from_fn(node), hex);
                        (0..8).for_each(|c| {
                            corners[hex[c] as usize].push((at + c / 4 * FACE + c % 4 * LANES) as u32)
                        });
                    }
                }
            }
            assert_eq!(chains.slot_count(), next);
            assert!(met.iter().all(|&m| m == 1));
            if chains.lattice.is_some() {
                continue;
            }
            for (n, slots) in corners.iter_mut().enumerate() {
                slots.sort_unstable();
                slots.dedup();
                assert_eq!(slots[..], chains.slots[chains.start[n] as usize..chains.start[n + 1] as usize]);
            }
        }
    }

    /// 1,024 columns of four radial layers: 16 groups, and five faces for four elements.
    #[test]
    fn a_ring_has_full_groups_of_equal_classes() {
        let chains = |joined| Chains::new(&model([64, 4, 16]), 4, joined);
        let apart = chains(false);
        assert!(apart.shared_classes);
        assert_eq!(apart.groups.len(), 16);
        assert_eq!((apart.slot_count(), apart.stored_slots()), (5 * 4 * 1024, 5 * 4 * 1024));
        // A row of 64 is a group: the first chain of each has none on its left. A group that began elsewhere would have
        // two ends.
        let joined = chains(true);
        assert_eq!(
            (joined.slot_count(), joined.stored_slots()),
            (5 * 16 * (2 * 64 + 4), 5 * 16 * (2 * 64 + 2))
        );
    }

    /// Rows of 10, of which six begin in the first group and one in the second, whose first chain is in a row's middle; two layers of
    /// chains, of four faces and of three.
    #[test]
    fn rows_that_end_within_a_group_store_both_sides() {
        let chains = |joined| Chains::new(&model([10, 5, 7]), 3, joined);
        let (apart, joined) = (chains(false), chains(true));
        assert_eq!(
            joined.groups.iter().map(|g| (g[2], g[3])).collect::<Vec<_>>(),
            [(3, 64), (3, 6), (2, 64), (2, 6)]
        );
        assert_eq!(apart.stored_slots(), (4 + 3) * 4 * 70);
        // Chains without one on their left: seven that begin a row and the first of the second group.
        assert_eq!(joined.stored_slots(), (4 + 3) * (2 * 70 + 2 * 8));
        // No group touches more rows than there are.
        assert_eq!(joined.slot_count(), (4 + 3) * 2 * (2 * 64 + 2 * 7));
    }

    /// In rows of one element nothing is shared, so that a full group has four corners a chain.
    #[test]
    fn rows_of_one_are_not_joined() {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/bouncing_block.toml");
        let scene = Scene::load(&file, &["body.mesh.elements=[1,70,2]".to_string()]);
        let model = Model::new(&scene.unwrap()).unwrap();
        let chains = Chains::new(&model, 2, true);
        assert!(chains.lattice.is_some() && !chains.is_joined());
        assert_eq!((chains.slot_count(), chains.stored_slots()), (3 * 2 * 256, 3 * 4 * 70));
    }
}
