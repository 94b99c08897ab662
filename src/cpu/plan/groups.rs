//! Second stage: pieces joined into items, and items in groups that one thread takes.

use super::lines::{LaidChain, Lines, Piece};
use crate::kernels::runs;
use std::ops::Range;

/// Most groups, and fewest elements of one.
const MOST_GROUPS: usize = 256;
const LEAST_ELEMENTS: usize = 40;

/// What the element pass takes at a time.
#[derive(Debug, Clone)]
pub enum Joined {
    /// Chains that batches run through one after the other.
    Chains(Vec<LaidChain>),
    Loose(Vec<u32>),
}

impl Joined {
    pub fn element_count(&self) -> usize {
        match self {
            Joined::Chains(chains) => chains.iter().map(|laid| laid.chain.elements.len()).sum(),
            Joined::Loose(elements) => elements.len(),
        }
    }

    pub fn is_loose(&self) -> bool {
        matches!(self, Joined::Loose(_))
    }
}

/// Items in groups. Groups depend on the mesh and the number of lanes alone: with them, the order of sums.
#[derive(Debug, Clone)]
pub struct Groups {
    pub items: Vec<Joined>,
    /// Items by group.
    pub groups: Vec<Range<usize>>,
    /// Group by item.
    pub group_of: Vec<usize>,
    /// Lines that each item touches, chain by chain.
    pub touched: Vec<Vec<usize>>,
    /// First and last item that touches each line; none: its nodes belong to no element.
    pub spans: Vec<Option<(usize, usize)>>,
}

impl Groups {
    /// Groups of the pieces of `lines`; `hexes`: corners of the elements.
    pub fn new(lines: &Lines, hexes: &[[u32; 8]], width: usize) -> Groups {
        let of_piece = |piece: &Piece| match piece {
            Piece::Chain(laid) => laid.lines.to_vec(),
            Piece::Loose(elements) => lines_of_loose(lines, hexes, elements),
        };
        let of_pieces: Vec<Vec<usize>> = lines.pieces.iter().map(of_piece).collect();
        let cuts = cut(&lines.pieces, &spans(&of_pieces, lines.lines.len()));
        let (mut items, mut groups) = (Vec::new(), Vec::new());
        for pieces in cuts {
            let start = items.len();
            join(&lines.pieces[pieces], width, &mut items);
            groups.push(start..items.len());
        }
        let of_item = |item: &Joined| match item {
            Joined::Chains(chains) => chains.iter().flat_map(|laid| laid.lines).collect(),
            Joined::Loose(elements) => lines_of_loose(lines, hexes, elements),
        };
        let touched: Vec<Vec<usize>> = items.iter().map(of_item).collect();
        let spans = spans(&touched, lines.lines.len());
        let group_of =
            groups.iter().enumerate().flat_map(|(g, range)| range.clone().map(move |_| g)).collect();
        Groups { items, groups, group_of, touched, spans }
    }
}

fn lines_of_loose(lines: &Lines, hexes: &[[u32; 8]], elements: &[u32]) -> Vec<usize> {
    let nodes = elements.iter().flat_map(|e| hexes[*e as usize]);
    let mut met: Vec<usize> = nodes.map(|n| lines.at[n as usize].line as usize).collect();
    met.sort_unstable();
    met.dedup();
    met
}

/// First and last of the entries of `touched` that each of `count` lines is in.
fn spans(touched: &[Vec<usize>], count: usize) -> Vec<Option<(usize, usize)>> {
    let mut spans: Vec<Option<(usize, usize)>> = vec![None; count];
    for (i, lines) in touched.iter().enumerate() {
        for &l in lines {
            spans[l] = Some((spans[l].map_or(i, |(first, _)| first), i));
        }
    }
    spans
}

/// Cuts the pieces so that a line meets few groups: every so many as lie between the first and the last piece at a line.
fn cut(pieces: &[Piece], spans: &[Option<(usize, usize)>]) -> Vec<Range<usize>> {
    let widest = spans.iter().flatten().map(|(first, last)| last - first).max().unwrap_or(0);
    let stride = widest.saturating_sub(1).max(1);
    let all: usize = pieces.iter().map(Piece::element_count).sum();
    let least = LEAST_ELEMENTS.max(all.div_ceil(MOST_GROUPS));
    let mut groups: Vec<Range<usize>> = Vec::new();
    let (mut start, mut elements) = (0, 0);
    for (i, piece) in pieces.iter().enumerate() {
        elements += piece.element_count();
        let whole = (i + 1 - start).is_multiple_of(stride);
        if whole && elements >= least {
            groups.push(start..i + 1);
            (start, elements) = (i + 1, 0);
        }
    }
    match groups.last_mut() {
        Some(last) if elements < least => last.end = pieces.len(),
        _ => groups.push(start..pieces.len()),
    }
    groups
}

/// Joins the chains of a group that follow each other where that fills lanes.
fn join(group: &[Piece], width: usize, items: &mut Vec<Joined>) {
    for pieces in group.chunk_by(|a, b| matches!((a, b), (Piece::Chain(_), Piece::Chain(_)))) {
        let mut chains = Vec::new();
        for piece in pieces {
            match piece {
                Piece::Chain(laid) => chains.push(laid.clone()),
                Piece::Loose(elements) => items.push(Joined::Loose(elements.clone())),
            }
        }
        let counts: Vec<usize> = chains.iter().map(|laid| laid.chain.elements.len()).collect();
        let mut rest = chains.into_iter();
        for count in runs(&counts, width) {
            items.push(Joined::Chains(rest.by_ref().take(count).collect()));
        }
    }
}
