//! Names that other formats demand to be different.

use regrasp_api::{HandDescription, ObstacleDescription};
use std::collections::BTreeSet;

/// What the joints and links of a hand are called in files.
///
/// Joints keep their names where these differ, and take their finger's name in front where not. Links are
/// called after the joint before them.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Names {
    /// For each finger, the joints' names.
    pub joints: Vec<Vec<String>>,
    /// For each finger, the names of the links behind its joints.
    pub links: Vec<Vec<String>>,
    /// For each finger, the name of its fingertip's link.
    pub tips: Vec<String>,
    /// The obstacles' names.
    pub obstacles: Vec<String>,
}

impl Names {
    pub fn new(hand: &HandDescription, obstacles: &[ObstacleDescription]) -> Self {
        let all: Vec<&str> =
            hand.finger.iter().flat_map(|f| &f.joint).map(|joint| joint.name.as_str()).collect();
        let different = all.iter().collect::<BTreeSet<_>>().len() == all.len();
        let mut taken = BTreeSet::from([ROOT.to_owned(), OBJECT.to_owned()]);
        let mut joints = Vec::new();
        for finger in &hand.finger {
            let name =
                |joint: &str| if different { joint.to_owned() } else { format!("{}-{joint}", finger.name) };
            joints.push(
                finger.joint.iter().map(|joint| free(name(&joint.name), &mut taken)).collect::<Vec<_>>(),
            );
        }
        let mut link = |joint: &String| free(format!("{joint}-link"), &mut taken);
        let links = joints.iter().map(|joints| joints.iter().map(&mut link).collect()).collect();
        let tips =
            hand.finger.iter().map(|finger| free(format!("{}-tip", finger.name), &mut taken)).collect();
        let obstacle = |(index, obstacle): (usize, &ObstacleDescription)| {
            let name = &obstacle.name;
            let name = if name.is_empty() { format!("obstacle-{}", index + 1) } else { name.clone() };
            free(name, &mut taken)
        };
        let obstacles = obstacles.iter().enumerate().map(obstacle).collect();
        Self { joints, links, tips, obstacles }
    }
}

/// The names of all joints of a hand in turn, different ones.
pub fn joint_names(hand: &HandDescription) -> Vec<String> {
    Names::new(hand, &[]).joints.into_iter().flatten().collect()
}

/// The link of the palm, whose frame is H.
pub(crate) const ROOT: &str = "hand";

/// The object's link, whose frame is O.
pub(crate) const OBJECT: &str = "object";

/// `name`, or with a number behind it where it is taken.
fn free(name: String, taken: &mut BTreeSet<String>) -> String {
    let numbered = (2..).map(|number| format!("{name}-{number}"));
    let free = std::iter::once(name.clone()).chain(numbered).find(|name| !taken.contains(name));
    let free = free.expect("there is always a next number");
    taken.insert(free.clone());
    free
}

/// `name` as part of a file's name: what is neither a letter, a digit nor `-`, `_`, `.` becomes `-`.
pub(crate) fn file_stem(name: &str) -> String {
    let allowed = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_' | '.');
    let stem: String = name.chars().map(|c| if allowed(c) { c } else { '-' }).collect();
    let bare = stem.trim_matches(['.', '-']);
    if bare.is_empty() { "plan".into() } else { bare.into() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_different_whatever_the_hand_calls_its_joints() {
        let text = include_str!("../../../scenarios/hands/four-finger.toml");
        let mut hand: HandDescription = toml::from_str(text).unwrap();
        assert_eq!(Names::new(&hand, &[]).joints[0][1], "east-proximal");
        for finger in &mut hand.finger {
            finger.joint[0].name = "hand".into();
            finger.joint[1].name = "hand".into();
        }
        let names = Names::new(&hand, &[]);
        let all = names.joints.iter().chain(&names.links).flatten().chain(&names.tips);
        let all: Vec<_> = all.collect();
        assert_eq!(all.iter().collect::<BTreeSet<_>>().len(), all.len());
        assert_eq!(names.joints[1][0], format!("{}-hand", hand.finger[1].name));
    }

    #[test]
    fn file_stems_hold_no_folders() {
        assert_eq!(file_stem("../a b/ü"), "a-b-ü");
        assert_eq!(file_stem("///"), "plan");
    }
}
