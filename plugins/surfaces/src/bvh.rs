//! A bounding volume hierarchy: which of many small things comes closest to a point.

use regrasp_api::Vec3;

/// How many things a leaf holds at most.
const LEAF: usize = 4;
/// Deep enough for 2^32 things: the halves of every node differ by one thing at most.
const DEPTH: usize = 64;

#[derive(Clone, Copy, Debug)]
struct Node {
    low: Vec3,
    high: Vec3,
    /// First thing of a leaf, or index of the second child (the first follows its parent).
    start: u32,
    /// How many things a leaf holds; 0 for an inner node.
    count: u32,
}

/// Axis-aligned boxes over numbered things, split at the median of their centres along the longest side.
#[derive(Clone, Debug, Default)]
pub(crate) struct Hierarchy {
    nodes: Vec<Node>,
    order: Vec<u32>,
}

impl Hierarchy {
    /// Builds over things given by their boxes (low and high corner, m).
    pub fn new(boxes: &[(Vec3, Vec3)]) -> Self {
        let mut built = Self { nodes: Vec::new(), order: (0..boxes.len() as u32).collect() };
        if !boxes.is_empty() {
            let mut order = std::mem::take(&mut built.order);
            built.split(boxes, &mut order, 0);
            built.order = order;
        }
        built
    }

    fn split(&mut self, boxes: &[(Vec3, Vec3)], things: &mut [u32], start: usize) {
        let (mut low, mut high) = boxes[things[0] as usize];
        for &thing in things.iter() {
            low = low.inf(&boxes[thing as usize].0);
            high = high.sup(&boxes[thing as usize].1);
        }
        let index = self.nodes.len();
        self.nodes.push(Node { low, high, start: start as u32, count: things.len() as u32 });
        if things.len() <= LEAF {
            return;
        }
        let axis = (high - low).imax();
        let center = |thing: u32| boxes[thing as usize].0[axis] + boxes[thing as usize].1[axis];
        let half = things.len() / 2;
        things.select_nth_unstable_by(half, |&a, &b| center(a).total_cmp(&center(b)).then(a.cmp(&b)));
        let (first, second) = things.split_at_mut(half);
        self.split(boxes, first, start);
        self.nodes[index].start = self.nodes.len() as u32;
        self.nodes[index].count = 0;
        self.split(boxes, second, start + half);
    }

    /// Visits every thing whose box may come as close to `p` as the bound, near ones first.
    ///
    /// `visit` is handed a thing and the bound on the squared distance (m²), and lowers the bound where the thing is closer.
    pub fn closest(&self, p: &Vec3, bound: &mut f64, mut visit: impl FnMut(u32, &mut f64)) {
        let mut stack = [(0.0, 0_u32); DEPTH];
        let mut height = usize::from(!self.nodes.is_empty());
        while height > 0 {
            height -= 1;
            let (distance, index) = stack[height];
            if distance > *bound {
                continue;
            }
            let node = &self.nodes[index as usize];
            if node.count > 0 {
                let things = &self.order[node.start as usize..(node.start + node.count) as usize];
                things.iter().for_each(|&thing| visit(thing, bound));
                continue;
            }
            let (a, b) = (index + 1, node.start);
            let (to_a, to_b) = (self.squared_distance(a, p), self.squared_distance(b, p));
            let ((near, first), (far, second)) =
                if to_a <= to_b { ((to_a, a), (to_b, b)) } else { ((to_b, b), (to_a, a)) };
            stack[height] = (far, second);
            stack[height + 1] = (near, first);
            height += 2;
        }
    }

    /// Squared distance (m²) of `p` from a node's box, rounded down so that ties are always visited.
    fn squared_distance(&self, node: u32, p: &Vec3) -> f64 {
        let node = &self.nodes[node as usize];
        let gap = |k: usize| (node.low[k] - p[k]).max(p[k] - node.high[k]).max(0.0);
        let (x, y, z) = (gap(0), gap(1), gap(2));
        (x * x + y * y + z * z) * (1.0 - 1e-9)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::Random;

    #[test]
    fn finds_the_nearest_of_many_points_and_nothing_in_an_empty_set() {
        let mut random = Random::from_key(5, 0, 0, 0);
        let points: Vec<Vec3> = (0..500).map(|_| random.direction() * random.unit()).collect();
        let boxes: Vec<_> = points.iter().map(|&p| (p, p)).collect();
        let hierarchy = Hierarchy::new(&boxes);
        for _ in 0..200 {
            let p = random.direction() * random.range(0.0, 2.0);
            let (mut bound, mut visits) = (f64::INFINITY, 0);
            hierarchy.closest(&p, &mut bound, |thing, bound| {
                visits += 1;
                *bound = bound.min((points[thing as usize] - p).norm_squared());
            });
            let truth = points.iter().map(|q| (q - p).norm_squared()).fold(f64::INFINITY, f64::min);
            assert_eq!(bound, truth);
            assert!(visits < 200, "{visits} of 500 visited");
        }
        Hierarchy::new(&[]).closest(&Vec3::zeros(), &mut 1.0, |_, _| unreachable!());
    }
}
