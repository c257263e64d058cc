//! A bounding volume hierarchy: which of many small things comes closest to a point.

use regrasp_api::{Vec3, any_orthogonal};

/// How many things a leaf holds at most: a box about one facet is flat, and so tells most.
const LEAF: usize = 1;
/// Deep enough for 2^32 things: the halves of every node differ by one thing at most.
const DEPTH: usize = 64;

/// A flat or straight thing: the hull of three points (m), and the direction in which it is thin (zero if none).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Thing {
    pub corners: [Vec3; 3],
    pub thin: Vec3,
}

/// A box about some things, turned so that its third axis is their mean thin direction.
///
/// Facets of a curved surface fill a turned box far better than one along the axes: a fingertip that touches the surface
/// comes within its radius of few boxes besides the one that it touches.
#[derive(Clone, Copy, Debug)]
struct Node {
    axes: [Vec3; 3],
    low: [f64; 3],
    high: [f64; 3],
    /// First thing of a leaf, or index of the second child (the first follows its parent).
    start: u32,
    /// How many things a leaf holds; 0 for an inner node.
    count: u32,
}

impl Node {
    fn around(things: &[Thing], members: &[u32], start: usize) -> Self {
        let thin: Vec3 = members.iter().map(|&member| things[member as usize].thin).sum();
        let n = if thin.norm() > 0.1 * members.len() as f64 { thin.normalize() } else { Vec3::z() };
        let t = any_orthogonal(&n);
        let axes = [t, n.cross(&t), n];
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for corner in members.iter().flat_map(|&member| &things[member as usize].corners) {
            for k in 0..3 {
                let along = axes[k].dot(corner);
                low[k] = low[k].min(along);
                high[k] = high[k].max(along);
            }
        }
        // Rounding of the products above and of the closest points: ties must be visited.
        for k in 0..3 {
            let slack = 1e-12 * low[k].abs().max(high[k].abs());
            low[k] -= slack;
            high[k] += slack;
        }
        Self { axes, low, high, start: start as u32, count: members.len() as u32 }
    }

    /// Squared distance (m²) of `p` from the box, rounded down so that ties are always visited.
    fn squared_distance(&self, p: &Vec3) -> f64 {
        let gap = |k: usize| {
            let along = self.axes[k].dot(p);
            (self.low[k] - along).max(along - self.high[k]).max(0.0)
        };
        let (x, y, z) = (gap(0), gap(1), gap(2));
        (x * x + y * y + z * z) * (1.0 - 1e-9)
    }
}

/// Boxes over numbered things, halved again and again at the median of their middles along the longest side.
#[derive(Clone, Debug, Default)]
pub(crate) struct Hierarchy {
    nodes: Vec<Node>,
    order: Vec<u32>,
}

impl Hierarchy {
    /// Builds in O(n log n).
    pub fn new(things: &[Thing]) -> Self {
        let mut order: Vec<u32> = (0..things.len() as u32).collect();
        let mut built = Self::default();
        if !things.is_empty() {
            built.split(things, &mut order, 0);
        }
        built.order = order;
        built
    }

    fn split(&mut self, things: &[Thing], members: &mut [u32], start: usize) {
        let index = self.nodes.len();
        let node = Node::around(things, members, start);
        self.nodes.push(node);
        if members.len() <= LEAF {
            return;
        }
        let size = |k: usize| node.high[k] - node.low[k];
        let longest = (1..3).fold(0, |best, k| if size(k) > size(best) { k } else { best });
        let middle =
            |member: u32| node.axes[longest].dot(&things[member as usize].corners.iter().sum::<Vec3>());
        let half = members.len() / 2;
        members.select_nth_unstable_by(half, |&a, &b| middle(a).total_cmp(&middle(b)).then(a.cmp(&b)));
        let (first, second) = members.split_at_mut(half);
        self.split(things, first, start);
        self.nodes[index].start = self.nodes.len() as u32;
        self.nodes[index].count = 0;
        self.split(things, second, start + half);
    }

    /// Whether `is_closer` holds for a thing whose box comes closer to `p` than a squared distance (m²).
    pub fn any_closer(&self, p: &Vec3, squared: f64, mut is_closer: impl FnMut(u32) -> bool) -> bool {
        let mut stack = [0_u32; DEPTH];
        let mut height = usize::from(!self.nodes.is_empty());
        while height > 0 {
            height -= 1;
            let index = stack[height];
            let node = &self.nodes[index as usize];
            if node.squared_distance(p) >= squared {
                continue;
            }
            if node.count > 0 {
                let members = &self.order[node.start as usize..(node.start + node.count) as usize];
                if members.iter().any(|&thing| is_closer(thing)) {
                    return true;
                }
                continue;
            }
            stack[height] = index + 1;
            stack[height + 1] = node.start;
            height += 2;
        }
        false
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
                let members = &self.order[node.start as usize..(node.start + node.count) as usize];
                members.iter().for_each(|&thing| visit(thing, bound));
                continue;
            }
            let (a, b) = (index + 1, node.start);
            let to_a = self.nodes[a as usize].squared_distance(p);
            let to_b = self.nodes[b as usize].squared_distance(p);
            let ((near, first), (far, second)) =
                if to_a <= to_b { ((to_a, a), (to_b, b)) } else { ((to_b, b), (to_a, a)) };
            if far <= *bound {
                stack[height] = (far, second);
                height += 1;
            }
            stack[height] = (near, first);
            height += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::Random;

    #[test]
    fn finds_the_nearest_of_many_points_and_nothing_in_an_empty_set() {
        let mut random = Random::from_key(5, 0, 0, 0);
        let points: Vec<Vec3> = (0..500).map(|_| random.direction() * random.range(0.9, 1.0)).collect();
        let things: Vec<_> = points.iter().map(|&p| Thing { corners: [p; 3], thin: p.normalize() }).collect();
        let hierarchy = Hierarchy::new(&things);
        for _ in 0..200 {
            let p = random.direction() * random.range(0.5, 2.0);
            let (mut bound, mut visits) = (f64::INFINITY, 0);
            hierarchy.closest(&p, &mut bound, |thing, bound| {
                visits += 1;
                *bound = bound.min((points[thing as usize] - p).norm_squared());
            });
            let truth = points.iter().map(|q| (q - p).norm_squared()).fold(f64::INFINITY, f64::min);
            assert_eq!(bound, truth);
            assert!(visits < 100, "{visits} of 500 visited");
        }
        Hierarchy::new(&[]).closest(&Vec3::zeros(), &mut 1.0, |_, _| unreachable!());
    }
}
