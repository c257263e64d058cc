//! What facets cover together, as the loops round them: a tenth of the characters of the facets themselves.

use super::view::Point;
use std::collections::BTreeMap;
use std::fmt::Write;

/// The loops round facets that face the eye, as a path for the fill rule `nonzero`, to 0.1 mm.
///
/// Each facet is a loop of its own, run through in one sense; where two share an edge they run through it
/// both ways, and it drops out. So the winding numbers of what is left are those of the facets, also where
/// these overlap.
pub(super) fn outline(facets: impl Iterator<Item = [u32; 3]>, seen: &[Point]) -> String {
    let mut ways = ways(facets);
    let mut path = String::new();
    while let Some((&first, _)) = ways.first_key_value() {
        let mut around = vec![tenths(&seen[first as usize])];
        let mut at = first;
        while let Some(next) = take(&mut ways, at) {
            at = next;
            if at == first {
                break;
            }
            around.push(tenths(&seen[at as usize]));
        }
        draw(&around, &mut path);
    }
    path
}

/// The edges that no other facet runs through the other way: where one leads to from each corner.
fn ways(facets: impl Iterator<Item = [u32; 3]>) -> BTreeMap<u32, Vec<u32>> {
    let mut ways: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for [a, b, c] in facets {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let back = ways.get(&to).and_then(|ends| ends.iter().position(|end| *end == from));
            match back {
                Some(index) => drop(remove(&mut ways, to, index)),
                None => ways.entry(from).or_default().push(to),
            }
        }
    }
    ways
}

/// Takes one of the edges that lead away from a corner.
fn take(ways: &mut BTreeMap<u32, Vec<u32>>, from: u32) -> Option<u32> {
    let last = ways.get(&from)?.len() - 1;
    Some(remove(ways, from, last))
}

fn remove(ways: &mut BTreeMap<u32, Vec<u32>>, from: u32, index: usize) -> u32 {
    let ends = ways.get_mut(&from).expect("an edge that was found is there");
    let end = ends.remove(index);
    if ends.is_empty() {
        ways.remove(&from);
    }
    end
}

fn tenths(point: &Point) -> [i64; 2] {
    [point.x, point.y].map(|x| (10.0 * x).round() as i64)
}

/// The first corner, and the way on from there, which takes fewer characters.
fn draw(around: &[[i64; 2]], path: &mut String) {
    let length = |tenths: i64| tenths as f64 / 10.0;
    let [first, rest @ ..] = around else { return };
    write!(path, "M{} {}l", length(first[0]), length(first[1])).expect("a text takes everything");
    let mut at = *first;
    let mut gap = "";
    for next in rest.iter().filter(|next| **next != *first) {
        if *next == at {
            continue;
        }
        let step = [0, 1].map(|axis| length(next[axis] - at[axis]));
        write!(path, "{gap}{} {}", step[0], step[1]).expect("a text takes everything");
        (at, gap) = (*next, " ");
    }
    // A loop that rounding made a point of.
    if gap.is_empty() {
        path.push_str("0 0");
    }
    path.push('z');
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Corners of unit squares: 0 1 2 above, 3 4 5 below.
    fn corners() -> Vec<Point> {
        let at = |k: u32| Point { x: f64::from(k % 3), y: f64::from(k / 3), depth: 0.0 };
        (0..6).map(at).collect()
    }

    fn path(facets: &[[u32; 3]]) -> String {
        outline(facets.iter().copied(), &corners())
    }

    #[test]
    fn what_facets_share_drops_out() {
        assert_eq!(path(&[[0, 3, 4], [0, 4, 1]]), "M0 0l0 1 1 0 0 -1z", "a square");
        let strip = [[0, 3, 4], [0, 4, 1], [1, 4, 5], [1, 5, 2]];
        assert_eq!(path(&strip), "M0 0l0 1 1 0 1 0 0 -1 -1 0z", "two squares");
        assert_eq!(path(&[[0, 3, 4], [1, 5, 2]]).matches('z').count(), 2, "two triangles apart");
        assert_eq!(path(&[]), "");
    }

    #[test]
    fn each_edge_is_drawn_once_and_the_area_is_that_of_the_facets() {
        let strip = [[0, 3, 4], [0, 4, 1], [1, 4, 5]];
        let steps: Vec<f64> = path(&strip)
            .trim_start_matches("M0 0l")
            .trim_end_matches('z')
            .split(' ')
            .map(|word| word.parse().unwrap())
            .collect();
        let (mut at, mut area) = ([0.0, 0.0], 0.0);
        for step in steps.chunks(2) {
            let next = [at[0] + step[0], at[1] + step[1]];
            area += 0.5 * (at[0] * next[1] - at[1] * next[0]);
            at = next;
        }
        assert_eq!(area.abs(), 1.5);
    }
}
