//! Which links are fingertips, which one is the palm, and the chains of joints between them.

use super::document::{Joint, Kind};
use super::error::Fault;
use super::tree::Tree;
use regrasp_api::{MAX_FINGER_JOINTS, MAX_FINGERS, Pose};

/// The palm and the fingers as links and joints of the tree.
#[derive(Debug)]
pub(super) struct Fingers {
    /// The link whose frame is the hand's.
    pub palm: usize,
    pub chains: Vec<Chain>,
    /// Whether the tips were guessed.
    pub guessed: bool,
}

/// One finger.
#[derive(Debug)]
pub(super) struct Chain {
    pub tip: usize,
    /// The joints from the palm to the tip, fixed ones among them.
    pub path: Vec<usize>,
    /// Those of them that move.
    pub moving: Vec<usize>,
}

impl Fingers {
    /// The fingers to the given tips, or to guessed ones; the palm is given, or the last link that all tips hang on.
    pub fn find(tree: &Tree<'_>, tips: &[String], palm: Option<&str>) -> Result<Self, Fault> {
        let guessed = tips.is_empty();
        let tips = if guessed { guess(tree)? } else { named(tree, tips)? };
        if tips.len() > MAX_FINGERS {
            let message = format!(
                "{} fingertips, at most {MAX_FINGERS} are possible; name the ones to use",
                tips.len()
            );
            return Err(Fault::of_file(message));
        }
        let palm = match palm {
            Some(name) => tree.link(name).ok_or_else(|| unknown(tree, "palm", name))?,
            None => common(tree, &tips),
        };
        let chains = tips.iter().map(|&tip| chain(tree, palm, tip)).collect::<Result<Vec<_>, _>>()?;
        check_apart(tree, &chains)?;
        Ok(Self { palm, chains, guessed })
    }

    /// The finger, and which of its moving joints it is, that a joint belongs to.
    pub fn owner(&self, joint: usize) -> Option<(usize, usize)> {
        let place = |chain: &Chain| chain.moving.iter().position(|&own| own == joint);
        self.chains.iter().enumerate().find_map(|(f, chain)| Some((f, place(chain)?)))
    }
}

fn moves(joint: &Joint) -> bool {
    joint.kind != Kind::Fixed
}

fn named(tree: &Tree<'_>, tips: &[String]) -> Result<Vec<usize>, Fault> {
    for (i, name) in tips.iter().enumerate() {
        if tips[..i].contains(name) {
            return Err(Fault::of_file(format!("the fingertip `{name}` is named twice")));
        }
    }
    tips.iter().map(|name| tree.link(name).ok_or_else(|| unknown(tree, "fingertip", name))).collect()
}

fn unknown(tree: &Tree<'_>, what: &str, name: &str) -> Fault {
    let known: Vec<String> = if what == "palm" {
        tree.model.links.iter().map(|link| format!("`{}`", link.name)).collect()
    } else {
        tree.leaves().map(|link| format!("`{}`", tree.link_of(link).name)).collect()
    };
    let (what_is, shown) = (if what == "palm" { "links" } else { "links at the ends" }, known.len().min(12));
    let dots = if shown < known.len() { ", …" } else { "" };
    Fault::of_file(format!(
        "there is no link `{name}` to be the {what}; {what_is}: {}{dots}",
        known[..shown].join(", ")
    ))
}

/// One tip for each joint behind which nothing moves: among the ends of what it moves, the one with `tip` in its name, or else the farthest.
fn guess(tree: &Tree<'_>) -> Result<Vec<usize>, Fault> {
    let mut best: Vec<(usize, (bool, f64), usize)> = Vec::new();
    for leaf in tree.leaves() {
        let path = tree.path(leaf);
        let Some(last) = path.iter().rposition(|&joint| moves(tree.joint(joint))) else { continue };
        // What is fixed to a link halfway is no finger.
        if moves_below(tree, path[last]) {
            continue;
        }
        let X = path[last + 1..].iter().fold(Pose::identity(), |X, &joint| X * tree.joint(joint).X_PJ);
        let is_tip = tree.link_of(leaf).name.to_ascii_lowercase().contains("tip");
        let merit = (is_tip, X.translation.vector.norm());
        match best.iter_mut().find(|(joint, ..)| *joint == path[last]) {
            Some(known) if merit > known.1 => *known = (path[last], merit, leaf),
            Some(_) => {}
            None => best.push((path[last], merit, leaf)),
        }
    }
    if best.is_empty() {
        return Err(Fault::of_file("there are no fingers: no joint of the file moves"));
    }
    Ok(best.into_iter().map(|(.., leaf)| leaf).collect())
}

/// Whether some joint behind this one moves.
fn moves_below(tree: &Tree<'_>, joint: usize) -> bool {
    let mut open = tree.below(tree.child(joint)).to_vec();
    while let Some(joint) = open.pop() {
        if moves(tree.joint(joint)) {
            return true;
        }
        open.extend(tree.below(tree.child(joint)));
    }
    false
}

/// The last link that all tips hang on; the root where there is one tip alone.
fn common(tree: &Tree<'_>, tips: &[usize]) -> usize {
    let paths: Vec<Vec<usize>> = tips.iter().map(|&tip| tree.path(tip)).collect();
    let root = (0..tree.model.links.len()).find(|&link| tree.above(link).is_none()).unwrap_or(0);
    if tips.len() < 2 {
        return root;
    }
    let shared = (0..).take_while(|&i| {
        let joint = paths[0].get(i);
        joint.is_some() && paths.iter().all(|path| path.get(i) == joint)
    });
    shared.last().map_or(root, |i| tree.child(paths[0][i]))
}

fn chain(tree: &Tree<'_>, palm: usize, tip: usize) -> Result<Chain, Fault> {
    let (tip_name, palm_name) = (&tree.link_of(tip).name, &tree.link_of(palm).name);
    let path = tree.path(tip);
    let below = path.iter().position(|&joint| tree.parent(joint) == palm);
    let Some(start) = below else {
        let message = format!(
            "the fingertip `{tip_name}` does not hang on the palm `{palm_name}`; give another `palm`"
        );
        return Err(Fault::at(tree.link_of(tip).line, message));
    };
    let path = path[start..].to_vec();
    let moving: Vec<usize> = path.iter().copied().filter(|&joint| moves(tree.joint(joint))).collect();
    for &joint in &moving {
        check_kind(tree.joint(joint), tip_name)?;
    }
    let independent = moving.iter().filter(|&&joint| tree.joint(joint).mimic.is_none()).count();
    let line = tree.link_of(tip).line;
    if independent < 3 {
        let message = format!(
            "the finger to `{tip_name}` has {independent} joints that move by themselves ({} move at all), at least three are needed; name \
             the fingertips to use (`tips`) to leave it out, it then stays at its zero position",
            moving.len()
        );
        return Err(Fault::at(line, message));
    }
    if moving.len() > MAX_FINGER_JOINTS {
        let message = format!(
            "the finger to `{tip_name}` has {} moving joints, at most {MAX_FINGER_JOINTS} are possible; give a `palm` nearer to it, or make \
             some of type fixed",
            moving.len()
        );
        return Err(Fault::at(line, message));
    }
    Ok(Chain { tip, path, moving })
}

fn check_kind(joint: &Joint, tip: &str) -> Result<(), Fault> {
    let (name, line) = (&joint.name, joint.line);
    match joint.kind {
        Kind::Fixed | Kind::Revolute | Kind::Continuous => Ok(()),
        Kind::Prismatic => Err(Fault::at(
            line,
            format!(
                "joint `{name}` of the finger to `{tip}` is prismatic; fingers have revolute joints: leave the finger out (`tips`), or make \
                 the joint fixed"
            ),
        )),
        Kind::Other => Err(Fault::at(
            line,
            format!(
                "joint `{name}` of the finger to `{tip}` is neither revolute nor fixed; fingers have revolute joints"
            ),
        )),
    }
}

/// Fingers share no moving joint.
fn check_apart(tree: &Tree<'_>, chains: &[Chain]) -> Result<(), Fault> {
    for (i, chain) in chains.iter().enumerate() {
        for other in &chains[..i] {
            if let Some(&joint) = chain.moving.iter().find(|joint| other.moving.contains(joint)) {
                let joint = tree.joint(joint);
                let message = format!(
                    "joint `{}` moves two fingers, to `{}` and to `{}`; fingers must be chains of their own from the palm: make the joint \
                     fixed, name other fingertips (`tips`), or a `palm` behind it",
                    joint.name,
                    tree.link_of(other.tip).name,
                    tree.link_of(chain.tip).name
                );
                return Err(Fault::at(joint.line, message));
            }
        }
    }
    Ok(())
}
