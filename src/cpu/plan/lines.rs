//! First stage: the nodes of a mesh on lines, its elements in pieces that lie on them.

use crate::model::chains::{BACK, Chain, FRONT};

/// Nodes of a line that no chain runs along, in batches: the size of a typical line.
const LOOSE_BATCHES: usize = 8;

/// Where a node is: its line, and its index in it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct At {
    pub line: u32,
    pub index: u32,
}

/// Nodes side by side in memory.
#[derive(Debug, Clone)]
pub struct NodeLine {
    pub nodes: Vec<u32>,
    /// The first node follows the last one, and stands behind it once more.
    pub closed: bool,
    /// Place of the first node in arrays by place.
    pub start: usize,
    /// Numbers in an array: a vector more than the nodes fill, so that a load from the second node on stays inside.
    pub length: usize,
}

/// A chain whose corners 0-1, 3-2, 4-5 and 7-6 lie on the lines of these numbers.
#[derive(Debug, Clone)]
pub struct LaidChain {
    pub chain: Chain,
    pub lines: [usize; 4],
}

/// Elements that belong together.
#[derive(Debug, Clone)]
pub enum Piece {
    Chain(LaidChain),
    /// At most as many elements as there are lanes, with nothing in common.
    Loose(Vec<u32>),
}

impl Piece {
    pub fn element_count(&self) -> usize {
        match self {
            Piece::Chain(laid) => laid.chain.elements.len(),
            Piece::Loose(elements) => elements.len(),
        }
    }
}

/// Every node on one line, every element in one piece.
#[derive(Debug, Clone)]
pub struct Lines {
    pub pieces: Vec<Piece>,
    pub lines: Vec<NodeLine>,
    /// Of every node.
    pub at: Vec<At>,
    /// Length of arrays by place.
    pub places: usize,
}

impl Lines {
    /// Lays chains for lanes of `width`, one after the other: a chain becomes a piece if its nodes lie, or can be laid, on
    /// four lines; else its elements are loose.
    pub fn new(chains: Vec<Chain>, hexes: &[[u32; 8]], nodes: usize, width: usize) -> Lines {
        let mut laying = Laying {
            hexes,
            width,
            lines: Vec::new(),
            at: vec![None; nodes],
            pieces: Vec::new(),
            waiting: Vec::new(),
        };
        for chain in chains {
            laying.add(chain);
        }
        laying.end_loose();
        laying.rest();
        let Laying { lines, at, pieces, .. } = laying;
        let at = at.into_iter().map(|at| at.expect("every node has a line")).collect();
        let places = lines.last().map_or(0, |line| line.start + line.length);
        Lines { pieces, lines, at, places }
    }

    /// Place of a node.
    pub fn place(&self, node: u32) -> u32 {
        let At { line, index } = self.at[node as usize];
        self.lines[line as usize].start as u32 + index
    }
}

/// Lines while chains are laid.
struct Laying<'a> {
    hexes: &'a [[u32; 8]],
    width: usize,
    lines: Vec<NodeLine>,
    /// Of the nodes that are on a line already.
    at: Vec<Option<At>>,
    pieces: Vec<Piece>,
    /// Loose elements, fewer than there are lanes.
    waiting: Vec<u32>,
}

impl Laying<'_> {
    fn add(&mut self, mut chain: Chain) {
        if 2 * chain.elements.len() >= self.width {
            self.rotate(&mut chain);
            if let Some(lines) = self.lines_of(&chain) {
                self.end_loose();
                self.pieces.push(Piece::Chain(LaidChain { chain, lines }));
                return;
            }
        }
        for e in chain.elements {
            self.waiting.push(e);
            if self.waiting.len() == self.width {
                self.end_loose();
            }
        }
    }

    fn end_loose(&mut self) {
        if !self.waiting.is_empty() {
            self.pieces.push(Piece::Loose(std::mem::take(&mut self.waiting)));
        }
    }

    fn corner(&self, e: u32, corner: usize) -> u32 {
        self.hexes[e as usize][corner]
    }

    /// Starts a closed chain where a line that it meets starts.
    fn rotate(&self, chain: &mut Chain) {
        if !chain.closed {
            return;
        }
        for corner in BACK {
            let starts = |e: &u32| self.at[self.corner(*e, corner) as usize].is_some_and(|at| at.index == 0);
            if let Some(first) = chain.elements.iter().position(starts) {
                chain.elements.rotate_left(first);
                return;
            }
        }
    }

    fn lines_of(&mut self, chain: &Chain) -> Option<[usize; 4]> {
        let mut lines = [0; 4];
        for k in 0..4 {
            let mut nodes: Vec<u32> = chain.elements.iter().map(|e| self.corner(*e, BACK[k])).collect();
            if !chain.closed {
                nodes.push(self.corner(*chain.elements.last()?, FRONT[k]));
            }
            lines[k] = self.line_of(nodes, chain.closed)?;
        }
        Some(lines)
    }

    /// The line with exactly these nodes: an old one, or a new one if none of them is on a line.
    fn line_of(&mut self, nodes: Vec<u32>, closed: bool) -> Option<usize> {
        match self.at[nodes[0] as usize] {
            Some(first) => {
                let line = &self.lines[first.line as usize];
                (line.closed == closed && line.nodes == nodes).then_some(first.line as usize)
            }
            None => {
                let fresh = nodes.iter().all(|n| self.at[*n as usize].is_none());
                fresh.then(|| self.new_line(nodes, closed))
            }
        }
    }

    fn new_line(&mut self, nodes: Vec<u32>, closed: bool) -> usize {
        let line = self.lines.len();
        for (index, &n) in nodes.iter().enumerate() {
            self.at[n as usize] = Some(At { line: line as u32, index: index as u32 });
        }
        let start = self.lines.last().map_or(0, |before| before.start + before.length);
        let length = (nodes.len().div_ceil(self.width) + 1) * self.width;
        self.lines.push(NodeLine { nodes, closed, start, length });
        line
    }

    /// Lines for the nodes that are on none, in the order in which elements meet them.
    fn rest(&mut self) {
        let elements = self.pieces.iter().flat_map(|piece| match piece {
            Piece::Chain(laid) => &laid.chain.elements,
            Piece::Loose(elements) => elements,
        });
        let of_elements = elements.flat_map(|e| self.hexes[*e as usize]);
        // Nodes of no element are nodes all the same.
        let mut met = vec![false; self.at.len()];
        let mut left = Vec::new();
        for n in of_elements.chain(0..self.at.len() as u32) {
            if self.at[n as usize].is_none() && !std::mem::replace(&mut met[n as usize], true) {
                left.push(n);
            }
        }
        for nodes in left.chunks(LOOSE_BATCHES * self.width) {
            self.new_line(nodes.to_vec(), false);
        }
    }
}
