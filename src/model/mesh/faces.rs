//! Which faces of elements meet: found from their nodes alone.

use super::FACES;

/// Faces of a mesh: face f of element e is number 6 e + f.
#[derive(Debug)]
pub struct Faces {
    /// The face on the other side, shape `[6 element_count]`.
    pub other: Vec<u32>,
}

/// Nothing on the other side: an outer face.
pub const OUTER: u32 = u32::MAX;
/// More than one face on the other side.
pub const MANY: u32 = u32::MAX - 1;

impl Faces {
    /// Faces with the same four nodes meet.
    pub fn of(hexes: &[[u32; 8]]) -> Faces {
        let count = hexes.iter().flatten().max().map_or(0, |&n| n as usize + 1);
        // Faces by their lowest node (compressed rows), each with its other nodes: few faces share the lowest.
        let mut start = vec![0_u32; count + 1];
        for hex in hexes {
            FACES.iter().for_each(|face| start[sorted(hex, face)[0] as usize + 1] += 1);
        }
        (0..count).for_each(|n| start[n + 1] += start[n]);
        let mut entries = vec![([0_u32; 3], 0_u32); 6 * hexes.len()];
        let mut next = start.clone();
        for (e, hex) in hexes.iter().enumerate() {
            for (f, face) in FACES.iter().enumerate() {
                let [lowest, a, b, c] = sorted(hex, face);
                entries[next[lowest as usize] as usize] = ([a, b, c], (6 * e + f) as u32);
                next[lowest as usize] += 1;
            }
        }
        let mut other = vec![OUTER; entries.len()];
        for n in 0..count {
            let row = &mut entries[start[n] as usize..start[n + 1] as usize];
            row.sort_unstable();
            for same in row.chunk_by(|a, b| a.0 == b.0) {
                match same {
                    [_] => {}
                    [a, b] => (other[a.1 as usize], other[b.1 as usize]) = (b.1, a.1),
                    many => many.iter().for_each(|face| other[face.1 as usize] = MANY),
                }
            }
        }
        Faces { other }
    }

    /// Outer faces in the order of the elements.
    pub fn outer(&self) -> impl Iterator<Item = u32> {
        self.other.iter().enumerate().filter(|(_, other)| **other == OUTER).map(|(face, _)| face as u32)
    }
}

/// Nodes of a face, counter-clockwise seen from outside.
pub fn nodes_of(hexes: &[[u32; 8]], face: u32) -> [u32; 4] {
    FACES[face as usize % 6].map(|c| hexes[face as usize / 6][c])
}

fn sorted(hex: &[u32; 8], face: &[usize; 4]) -> [u32; 4] {
    let mut nodes = face.map(|c| hex[c]);
    nodes.sort_unstable();
    nodes
}
