//! The tree of links: one root, no loops, and the ways through it.

use regrasp_formats::RobotFault as Fault;
use regrasp_formats::{Joint, Link, Robot};
use std::collections::{BTreeMap, BTreeSet};

/// The most links of a file.
const MOST_LINKS: usize = 1000;

/// A model whose links form one tree.
#[derive(Debug)]
pub(crate) struct Tree<'m> {
    pub model: &'m Robot,
    links: BTreeMap<&'m str, usize>,
    joints: BTreeMap<&'m str, usize>,
    /// For each link the joint above it; none for the root.
    above: Vec<Option<usize>>,
    /// For each link the joints below it, in the file's order.
    below: Vec<Vec<usize>>,
    /// For each joint its parent and child link.
    ends: Vec<(usize, usize)>,
}

impl<'m> Tree<'m> {
    /// The tree of a model; refused are names given twice, unknown links, two roots and loops.
    pub fn new(model: &'m Robot) -> Result<Self, Fault> {
        let links = index(model.links.iter().map(|link| (link.name.as_str(), link.line)), "link")?;
        let joints = index(model.joints.iter().map(|joint| (joint.name.as_str(), joint.line)), "joint")?;
        if model.links.is_empty() {
            return Err(Fault::of_file("there is no <link>; is this the URDF of a hand?"));
        }
        if model.links.len() > MOST_LINKS {
            let message = format!(
                "{} links are more than the {MOST_LINKS} that any robot with hands has",
                model.links.len()
            );
            return Err(Fault::of_file(message));
        }
        let mut above = vec![None; model.links.len()];
        let mut below = vec![Vec::new(); model.links.len()];
        let mut ends = Vec::new();
        for (j, joint) in model.joints.iter().enumerate() {
            let [parent, child] = [&joint.parent, &joint.child].map(|name| {
                let message =
                    format!("joint `{}` names the link `{name}`, which the file does not have", joint.name);
                links.get(name.as_str()).copied().ok_or(Fault::at(joint.line, message))
            });
            let (parent, child) = (parent?, child?);
            if let Some(other) = above[child].replace(j) {
                return Err(two_parents(joint, &model.joints[other]));
            }
            below[parent].push(j);
            ends.push((parent, child));
        }
        let tree = Self { model, links, joints, above, below, ends };
        tree.check_connected()?;
        Ok(tree)
    }

    /// One root, from which every link is reached: then there is no loop either.
    fn check_connected(&self) -> Result<(), Fault> {
        let roots: Vec<usize> = (0..self.above.len()).filter(|&link| self.above[link].is_none()).collect();
        let name = |link: usize| format!("`{}`", self.model.links[link].name);
        if let [first, second, ..] = roots[..] {
            let all: Vec<String> = roots.iter().map(|&root| name(root)).collect();
            let message = format!(
                "the links {} hang on no joint: a robot has one root; join {} to {} by a fixed joint, or \
                    remove it",
                all.join(", "),
                name(second),
                name(first)
            );
            return Err(Fault::at(self.model.links[second].line, message));
        }
        let mut reached = BTreeSet::new();
        let mut open: Vec<usize> = roots;
        while let Some(link) = open.pop() {
            reached.insert(link);
            open.extend(self.below[link].iter().map(|&joint| self.ends[joint].1));
        }
        match (0..self.above.len()).find(|link| !reached.contains(link)) {
            None => Ok(()),
            Some(link) => {
                let joint = &self.model.joints[self.above[link].expect("only the root has none")];
                let message = format!(
                    "the joints form a loop through joint `{}` and link {}; a URDF is a tree: remove one \
                        joint of the loop",
                    joint.name,
                    name(link)
                );
                Err(Fault::at(joint.line, message))
            }
        }
    }

    pub fn link(&self, name: &str) -> Option<usize> {
        self.links.get(name).copied()
    }

    pub fn joint_named(&self, name: &str) -> Option<usize> {
        self.joints.get(name).copied()
    }

    pub fn link_of(&self, link: usize) -> &'m Link {
        &self.model.links[link]
    }

    pub fn joint(&self, joint: usize) -> &'m Joint {
        &self.model.joints[joint]
    }

    pub fn above(&self, link: usize) -> Option<usize> {
        self.above[link]
    }

    pub fn below(&self, link: usize) -> &[usize] {
        &self.below[link]
    }

    pub fn parent(&self, joint: usize) -> usize {
        self.ends[joint].0
    }

    pub fn child(&self, joint: usize) -> usize {
        self.ends[joint].1
    }

    /// The joints from the root to a link, root first.
    pub fn path(&self, link: usize) -> Vec<usize> {
        let mut path: Vec<usize> =
            std::iter::successors(self.above[link], |&joint| self.above[self.parent(joint)]).collect();
        path.reverse();
        path
    }

    /// The links without a joint below them, in the file's order.
    pub fn leaves(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.below.len()).filter(|&link| self.below[link].is_empty())
    }
}

fn index<'m>(
    names: impl Iterator<Item = (&'m str, usize)>,
    what: &str,
) -> Result<BTreeMap<&'m str, usize>, Fault> {
    let mut index = BTreeMap::new();
    for (i, (name, line)) in names.enumerate() {
        if index.insert(name, i).is_some() {
            return Err(Fault::at(line, format!("there are two {what}s of the name `{name}`; rename one")));
        }
    }
    Ok(index)
}

fn two_parents(joint: &Joint, other: &Joint) -> Fault {
    let message = format!(
        "link `{}` hangs on two joints, `{}` and `{}`: the links form a loop; a URDF is a tree: remove one \
            of the joints",
        joint.child, other.name, joint.name
    );
    Fault::at(joint.line, message)
}
