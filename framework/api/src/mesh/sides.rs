//! The sides of facets by where they begin: what lies across each is found without a table of hashes.

/// All sides of all facets; side `3 i + k` runs from corner `k` of facet `i` to the next.
pub(super) struct Sides {
    /// Where the sides that begin at each vertex begin in `to`; one entry more than there are vertices.
    begins: Vec<u32>,
    /// Where each side ends, and its number; in order within a vertex.
    to: Vec<(u32, u32)>,
}

impl Sides {
    /// The sides of facets whose corners are below `count`.
    pub fn new(count: usize, facets: &[[u32; 3]]) -> Self {
        let mut begins = vec![0; count + 1];
        facets.iter().flatten().for_each(|&vertex| begins[vertex as usize + 1] += 1);
        for vertex in 0..count {
            begins[vertex + 1] += begins[vertex];
        }
        let mut next = begins.clone();
        let mut to = vec![(0, 0); 3 * facets.len()];
        for side in 0..to.len() as u32 {
            let [from, end] = ends(facets, side);
            let place = &mut next[from as usize];
            to[*place as usize] = (end, side);
            *place += 1;
        }
        for vertex in 0..count {
            to[begins[vertex] as usize..begins[vertex + 1] as usize].sort_unstable();
        }
        Self { begins, to }
    }

    /// The side from one vertex to another; of several the first.
    pub fn find(&self, from: u32, to: u32) -> Option<u32> {
        let there = self.at(from);
        let place = there.partition_point(|(end, _)| *end < to);
        there.get(place).filter(|(end, _)| *end == to).map(|(_, side)| *side)
    }

    /// The first side that runs where one before it does.
    pub fn first_doubled(&self) -> Option<u32> {
        let vertices = 0..self.begins.len() as u32 - 1;
        let doubled = vertices.flat_map(|vertex| self.at(vertex).windows(2));
        doubled.filter(|pair| pair[0].0 == pair[1].0).map(|pair| pair[1].1).min()
    }

    fn at(&self, vertex: u32) -> &[(u32, u32)] {
        &self.to[self.begins[vertex as usize] as usize..self.begins[vertex as usize + 1] as usize]
    }
}

/// The vertices at which a side begins and ends.
pub(super) fn ends(facets: &[[u32; 3]], side: u32) -> [u32; 2] {
    let (facet, k) = (facets[side as usize / 3], side as usize % 3);
    [facet[k], facet[(k + 1) % 3]]
}
