//! A bounding volume hierarchy: which of many small things comes closest to a point.
//!
//! Boxes as in C. Ericson, "Real-time collision detection", Morgan Kaufmann 2005, chapter 6.

use regrasp_api::{Vec3, any_orthogonal};

/// Deep enough for 2^31 things: sixteen levels, each of which leaves three children waiting.
const DEPTH: usize = 64;

/// A flat or straight thing: the hull of three points (m), and the direction in which it is thin (zero if
/// none).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Thing {
    pub corners: [Vec3; 3],
    pub thin: Vec3,
}

/// A box about some things, turned so that its third axis is their mean thin direction.
///
/// Facets of a curved surface fill a turned box far better than one along the axes: a fingertip that touches
/// the surface comes within its radius of few boxes besides the one that it touches.
#[derive(Clone, Copy, Debug)]
struct Turned {
    axes: [Vec3; 3],
    low: [f64; 3],
    high: [f64; 3],
}

impl Turned {
    fn around(things: &[Thing], members: &[u32]) -> Self {
        let thin: Vec3 = members.iter().map(|&member| things[member as usize].thin).sum();
        let n = if thin.norm() > 0.1 * members.len() as f64 { thin.normalize() } else { Vec3::z() };
        let t = any_orthogonal(&n);
        let axes = [t, n.cross(&t), n].map(|axis| axis.map(rounded));
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for corner in members.iter().flat_map(|&member| &things[member as usize].corners) {
            for k in 0..3 {
                let along = axes[k].dot(corner);
                low[k] = low[k].min(along);
                high[k] = high[k].max(along);
            }
        }
        Self { axes, low, high }
    }

    /// The axis along which the box is longest.
    fn longest(&self) -> &Vec3 {
        let size = |k: usize| self.high[k] - self.low[k];
        &self.axes[(1..3).fold(0, |best, k| if size(k) > size(best) { k } else { best })]
    }
}

/// The nearest number of single precision.
fn rounded(x: f64) -> f64 {
    f64::from(x as f32)
}

/// How many children a node has, so many as one instruction compares at once.
const WIDE: usize = 4;
/// Numbers of single precision, one a child.
type Lanes = [f32; WIDE];
/// Bounds a product of three terms' rounding in single precision, as a part of the sum of their sizes.
const ROUNDING: f32 = 1e-6;
/// Tells things from nodes.
const THING: u32 = 1 << 31;

/// The turned boxes of four children, in single precision, side by side.
///
/// Distances from them are rounded down by more than single precision may be wrong: nothing is missed, and
/// the exact distances are the things' own.
#[derive(Clone, Copy, Debug)]
struct Node {
    /// For each axis its three coordinates.
    axes: [[Lanes; 3]; 3],
    low: [Lanes; 3],
    high: [Lanes; 3],
    /// Indices of nodes, or of things with the flag.
    children: [u32; WIDE],
}

impl Node {
    const EMPTY: Self = Self {
        axes: [[[0.0; WIDE]; 3]; 3],
        low: [[f32::INFINITY; WIDE]; 3],
        high: [[f32::INFINITY; WIDE]; 3],
        children: [THING; WIDE],
    };

    fn put(&mut self, lane: usize, child: u32, turned: &Turned) {
        self.children[lane] = child;
        for k in 0..3 {
            for i in 0..3 {
                self.axes[k][i][lane] = turned.axes[k][i] as f32;
            }
            self.low[k][lane] = turned.low[k] as f32;
            self.high[k][lane] = turned.high[k] as f32;
        }
    }

    /// Squared distances (m²) of a point from the boxes, rounded down so far that what is as close as a bound
    /// in single precision lies below it; infinite where there is no child. `slack` (m) bounds what rounding
    /// may do to one coordinate.
    #[inline]
    fn squared_distances(&self, [x, y, z]: [f32; 3], slack: f32) -> Lanes {
        let mut sum = [0.0_f32; WIDE];
        for k in 0..3 {
            let [ax, ay, az] = &self.axes[k];
            for lane in 0..WIDE {
                let along = ax[lane] * x + ay[lane] * y + az[lane] * z;
                let (below, above) = (self.low[k][lane] - along, along - self.high[k][lane]);
                let outside = if below > above { below } else { above } - slack;
                let gap = if outside > 0.0 { outside } else { 0.0 };
                sum[lane] += gap * gap;
            }
        }
        sum.map(|squared| squared * (1.0 - 1e-5))
    }
}

/// A bit for each lane that is not above a limit.
fn below(distances: &Lanes, limit: f32) -> u32 {
    let limit = limit.min(f32::MAX); // where there is no child, the distance is infinite
    (0..WIDE).fold(0, |bits, lane| bits | u32::from(distances[lane] <= limit) << lane)
}

/// Takes the lowest bit.
fn take(bits: &mut u32) -> Option<usize> {
    let lane = bits.trailing_zeros() as usize;
    *bits &= bits.wrapping_sub(1);
    (lane < WIDE).then_some(lane)
}

/// A point in single precision, with what rounding may do to its coordinates along a box's axes.
#[derive(Clone, Copy, Debug)]
struct Probe {
    at: [f32; 3],
    slack: f32,
}

/// Boxes over numbered things, halved again and again at the median of their middles along the longest side.
#[derive(Clone, Debug, Default)]
pub(crate) struct Hierarchy {
    nodes: Vec<Node>,
    /// Largest sum of a corner's coordinates' sizes (m).
    size: f32,
}

impl Hierarchy {
    /// Builds in O(n log n).
    pub fn new(things: &[Thing]) -> Self {
        let size = |corner: &Vec3| corner.abs().sum() as f32;
        let corners = things.iter().flat_map(|thing| &thing.corners);
        let mut built = Self { nodes: Vec::new(), size: corners.map(size).fold(0.0, f32::max) };
        let mut order: Vec<u32> = (0..things.len() as u32).collect();
        if !order.is_empty() {
            built.add(things, &mut order);
        }
        built
    }

    /// Adds the node of some things and what is below it; its index.
    fn add(&mut self, things: &[Thing], members: &mut [u32]) -> u32 {
        let index = self.nodes.len();
        self.nodes.push(Node::EMPTY);
        let (first, second) = halves(things, members);
        let ([a, b], [c, d]) =
            (<[_; 2]>::from(halves(things, first)), <[_; 2]>::from(halves(things, second)));
        for (lane, part) in [a, b, c, d].into_iter().enumerate().filter(|(_, part)| !part.is_empty()) {
            let turned = Turned::around(things, part);
            let child = if part.len() == 1 { part[0] | THING } else { self.add(things, part) };
            self.nodes[index].put(lane, child, &turned);
        }
        index as u32
    }

    fn probe(&self, p: &Vec3) -> Probe {
        let at = [p.x as f32, p.y as f32, p.z as f32];
        let reach = at.iter().map(|x| x.abs()).sum::<f32>() + self.size;
        Probe { at, slack: ROUNDING * reach }
    }

    /// Whether `is_closer` holds for a thing whose box comes closer to `p` than a squared distance (m²).
    pub fn any_closer(&self, p: &Vec3, squared: f64, mut is_closer: impl FnMut(u32) -> bool) -> bool {
        let Probe { at, slack } = self.probe(p);
        let limit = squared as f32;
        let mut stack = [0_u32; DEPTH];
        let mut height = usize::from(!self.nodes.is_empty());
        while height > 0 {
            height -= 1;
            let node = &self.nodes[stack[height] as usize];
            let mut lanes = below(&node.squared_distances(at, slack), limit);
            while let Some(lane) = take(&mut lanes) {
                let child = node.children[lane];
                if child & THING == 0 {
                    stack[height] = child;
                    height += 1;
                } else if is_closer(child & !THING) {
                    return true;
                }
            }
        }
        false
    }

    /// Visits every thing whose box may come as close to `p` as the bound, near ones first.
    ///
    /// `visit` is handed a thing and the bound on the squared distance (m²), and lowers the bound where the
    /// thing is closer.
    pub fn closest(&self, p: &Vec3, bound: &mut f64, mut visit: impl FnMut(u32, &mut f64)) {
        let Probe { at, slack } = self.probe(p);
        let mut stack = [(0.0_f32, 0_u32); DEPTH];
        let mut height = usize::from(!self.nodes.is_empty());
        while height > 0 {
            height -= 1;
            let (distance, child) = stack[height];
            if f64::from(distance) > *bound {
                continue;
            }
            if child & THING != 0 {
                visit(child & !THING, bound);
                continue;
            }
            let node = &self.nodes[child as usize];
            let distances = node.squared_distances(at, slack);
            let mut lanes = below(&distances, *bound as f32);
            let base = height;
            while let Some(lane) = take(&mut lanes) {
                // The nearest comes out first.
                let mut place = height;
                while place > base && stack[place - 1].0 < distances[lane] {
                    stack[place] = stack[place - 1];
                    place -= 1;
                }
                stack[place] = (distances[lane], node.children[lane]);
                height += 1;
            }
        }
    }
}

/// The things with the smaller and with the larger middles along the longest side of their box; one thing
/// stays alone.
fn halves<'a>(things: &[Thing], members: &'a mut [u32]) -> (&'a mut [u32], &'a mut [u32]) {
    if members.len() < 2 {
        return members.split_at_mut(members.len());
    }
    let turned = Turned::around(things, members);
    let longest = turned.longest();
    let middle = |member: u32| longest.dot(&things[member as usize].corners.iter().sum::<Vec3>());
    let half = members.len() / 2;
    members.select_nth_unstable_by(half, |&a, &b| middle(a).total_cmp(&middle(b)).then(a.cmp(&b)));
    members.split_at_mut(half)
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
