//! Which links are fingertips, which one is the palm, and the chains of joints between them.

use crate::posture::drive;
use crate::rank;
use crate::tree::Tree;
use regrasp_api::{MAX_FINGER_JOINTS, MAX_FINGERS};
use regrasp_formats::RobotFault as Fault;
use regrasp_formats::{Joint, Kind};

/// The palm and the fingers as links and joints of the tree.
#[derive(Debug)]
pub(crate) struct Fingers {
    /// The link whose frame is the hand's.
    pub palm: usize,
    pub chains: Vec<Chain>,
    /// Whether the tips were guessed.
    pub guessed: bool,
    /// The ends that the guess left out, and why.
    pub left_out: Vec<String>,
}

/// One finger.
#[derive(Debug)]
pub(crate) struct Chain {
    pub tip: usize,
    /// The joints from the palm to the tip, fixed ones among them.
    pub path: Vec<usize>,
    /// Those of them that move.
    pub moving: Vec<usize>,
}

/// A finger needs as many joints that move by themselves: a fingertip must be able to go in every direction.
pub(crate) const FEWEST_JOINTS: usize = 3;

impl Fingers {
    pub(crate) fn new(tree: &Tree<'_>, tips: &[usize], palm: Option<usize>) -> Result<Self, Fault> {
        if tips.len() > MAX_FINGERS {
            let message = format!(
                "{} fingertips, at most {MAX_FINGERS} are possible; name the ones to use (`tips`), or the \
                 `palm` that they hang on",
                tips.len()
            );
            return Err(Fault::of_file(message));
        }
        let palm = palm.unwrap_or_else(|| common(tree, tips));
        let mut chains = tips.iter().map(|&tip| chain(tree, palm, tip)).collect::<Result<Vec<_>, _>>()?;
        check_apart(tree, &chains)?;
        hold_followers(tree, &mut chains);
        Ok(Self { palm, chains, guessed: false, left_out: Vec::new() })
    }

    /// The finger, and which of its moving joints it is, that a joint belongs to.
    pub fn owner(&self, joint: usize) -> Option<(usize, usize)> {
        let place = |chain: &Chain| chain.moving.iter().position(|&own| own == joint);
        self.chains.iter().enumerate().find_map(|(f, chain)| Some((f, place(chain)?)))
    }
}

pub(crate) fn moves(joint: &Joint) -> bool {
    joint.kind != Kind::Fixed
}

/// The last link that all tips hang on; the root where there is one tip alone.
pub(crate) fn common(tree: &Tree<'_>, tips: &[usize]) -> usize {
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
    let line = tree.link_of(tip).line;
    if let Some(why) = unfit(tree, &path) {
        let message = format!(
            "the finger to `{tip_name}`: {why}; name the fingertips to use (`tips`) to leave it out, it \
             then stays as a body that does not hold"
        );
        return Err(Fault::at(line, message));
    }
    if moving.len() > MAX_FINGER_JOINTS {
        let message = format!(
            "the finger to `{tip_name}` has {} moving joints, at most {MAX_FINGER_JOINTS} are possible; \
             give a `palm` nearer to it, or make \
             some of type fixed",
            moving.len()
        );
        return Err(Fault::at(line, message));
    }
    Ok(Chain { tip, path, moving })
}

/// Why a chain of joints can be no finger; `None` where it can.
pub(crate) fn unfit(tree: &Tree<'_>, path: &[usize]) -> Option<String> {
    let slides = |&&index: &&usize| matches!(tree.joint(index).kind, Kind::Prismatic | Kind::Other);
    if let Some(&joint) = path.iter().find(slides) {
        let name = &tree.joint(joint).name;
        return Some(format!("joint `{name}` is neither revolute nor fixed, and fingers turn"));
    }
    let (own, needed) = (independent(tree, path), FEWEST_JOINTS);
    if own < needed {
        let all = path.iter().filter(|&&joint| moves(tree.joint(joint))).count();
        return Some(format!(
            "{own} of the joints before it move by themselves ({all} move at all), at least {needed} are \
             needed"
        ));
    }
    let directions = rank::directions(tree, path);
    (directions < needed).then(|| {
        let parallel = if directions == 2 { " (its axes are parallel)" } else { "" };
        format!(
            "its joints move the tip in {directions} independent directions only{parallel}, {needed} are \
             needed"
        )
    })
}

/// The joints from a link to a tip below it; all from the root where the tip is not below it.
pub(crate) fn below(tree: &Tree<'_>, link: usize, tip: usize) -> Vec<usize> {
    let path = tree.path(tip);
    let start = path.iter().position(|&joint| tree.parent(joint) == link).unwrap_or(0);
    path[start..].to_vec()
}

/// How many of these joints move by themselves.
pub(crate) fn independent(tree: &Tree<'_>, joints: &[usize]) -> usize {
    let by_itself = |joint: &&usize| moves(tree.joint(**joint)) && tree.joint(**joint).mimic.is_none();
    joints.iter().filter(by_itself).count()
}

fn check_kind(joint: &Joint, tip: &str) -> Result<(), Fault> {
    let (name, line) = (&joint.name, joint.line);
    match joint.kind {
        Kind::Fixed | Kind::Revolute | Kind::Continuous => Ok(()),
        Kind::Prismatic => Err(Fault::at(
            line,
            format!(
                "joint `{name}` of the finger to `{tip}` is prismatic; fingers have revolute joints: leave \
                 the finger out (`tips`), or make \
                 the joint fixed"
            ),
        )),
        Kind::Other => Err(Fault::at(
            line,
            format!(
                "joint `{name}` of the finger to `{tip}` is neither revolute nor fixed; fingers have \
                 revolute joints"
            ),
        )),
    }
}

/// A joint of a finger that follows one which no finger has does not move: it stands where that one has it.
fn hold_followers(tree: &Tree<'_>, chains: &mut [Chain]) {
    let all: Vec<usize> = chains.iter().flat_map(|chain| chain.moving.iter().copied()).collect();
    let moves = |joint: &usize| match drive(tree, tree.joint(*joint)) {
        Ok(Some(drive)) => all.contains(&drive.joint),
        Ok(None) | Err(_) => true,
    };
    chains.iter_mut().for_each(|chain| chain.moving.retain(moves));
}

/// Fingers share no moving joint.
fn check_apart(tree: &Tree<'_>, chains: &[Chain]) -> Result<(), Fault> {
    for (i, chain) in chains.iter().enumerate() {
        for other in &chains[..i] {
            if let Some(&joint) = chain.moving.iter().find(|joint| other.moving.contains(joint)) {
                let joint = tree.joint(joint);
                let message = format!(
                    "joint `{}` moves two fingers, to `{}` and to `{}`; fingers must be chains of their own \
                     from the palm: make the joint \
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
