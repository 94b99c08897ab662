//! Shape classes: elements whose reference metrics agree share one entry of a small table.

use super::mesh::Mesh;
use crate::physics::element::Class;
use std::collections::HashMap;

/// Relative difference below which two metrics are the same shape. Generators reach about 1e-13 (sines of angles at
/// coordinates 10 times an element's edge); 1e-10 moves a force by 1e-10 of itself, far below any tolerance here.
const SAME: f64 = 1e-10;

/// Finds the classes by comparing metrics; `Err(element)`: inside out.
pub fn find(mesh: &Mesh, [modulus, eta]: [f64; 2]) -> Result<(Vec<Class<f64>>, Vec<u32>), usize> {
    let mut classes: Vec<Class<f64>> = Vec::new();
    let mut buckets: HashMap<i64, Vec<u32>> = HashMap::new();
    let mut class_of = Vec::with_capacity(mesh.hexes.len());
    for (element, hex) in mesh.hexes.iter().enumerate() {
        let class = Class::new(&hex.map(|n| mesh.nodes[n as usize]), modulus, eta).ok_or(element)?;
        // Volumes in logarithmic bins a hundred times as wide as SAME: an equal shape is in this bin or a neighbour.
        let bin = (class.volume.ln() * 1e8).floor() as i64;
        let known = (bin - 1..=bin + 1)
            .filter_map(|b| buckets.get(&b))
            .flatten()
            .copied()
            .find(|&c| same(&classes[c as usize], &class));
        class_of.push(known.unwrap_or_else(|| {
            let new = classes.len() as u32;
            buckets.entry(bin).or_default().push(new);
            classes.push(class);
            new
        }));
    }
    Ok((classes, class_of))
}

fn same(a: &Class<f64>, b: &Class<f64>) -> bool {
    let close = |x: f64, y: f64, scale: f64| (x - y).abs() <= SAME * scale;
    (0..8).all(|q| {
        let (m, n) = (a.metric[q].to_array(), b.metric[q].to_array());
        let scale = m[0] + m[1] + m[2];
        close(a.det_j0[q], b.det_j0[q], a.volume) && (0..6).all(|i| close(m[i], n[i], scale))
    })
}
