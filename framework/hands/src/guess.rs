//! Which links are probably the fingertips and the palm, where nobody says.

use crate::fingers::{FEWEST_JOINTS, Fingers, below, common, moves, unfit};
use crate::tree::Tree;
use regrasp_api::Pose;
use regrasp_formats::RobotFault as Fault;

/// The hand whose fingers end where the file's links end; below `palm`, if it is given. What has too few
/// joints is left out.
pub(crate) fn hand(tree: &Tree<'_>, palm: Option<usize>) -> Result<Fingers, Fault> {
    let all = ends(tree, palm);
    if all.is_empty() {
        return Err(Fault::of_file(match palm {
            None => "there are no fingers: no joint of the file moves".into(),
            Some(palm) => format!("there are no fingers: no joint below `{}` moves", name(tree, palm)),
        }));
    }
    let mut tips = all.clone();
    let mut left_out = Vec::new();
    // Without the weak ones, the last link that all hang on may be another one, and the chains shorter.
    loop {
        let root = palm.unwrap_or_else(|| common(tree, &tips));
        let why = |&tip: &usize| unfit(tree, &below(tree, root, tip));
        let (out, kept): (Vec<usize>, Vec<usize>) = tips.iter().partition(|&tip| why(tip).is_some());
        if kept.is_empty() {
            return Err(none(tree, &all, root));
        }
        left_out.extend(out.iter().filter_map(|tip| {
            Some(format!(
                "`{}` is no finger: {}; what hangs there stays where it is, as bodies that do not hold",
                name(tree, *tip),
                why(tip)?
            ))
        }));
        if out.is_empty() {
            let fingers = Fingers::new(tree, &tips, palm)?;
            return Ok(Fingers { guessed: true, left_out, ..fingers });
        }
        tips = kept;
    }
}

/// Of a file of more than a hand, the hand, if there is one; a fault that names them, if there are more;
/// `None` where there is none.
pub(crate) fn only_hand(tree: &Tree<'_>) -> Option<Result<Fingers, Fault>> {
    let mut hands: Vec<Fingers> = Vec::new();
    for palm in (0..tree.model.links.len()).filter(|&link| tree.below(link).len() > 1) {
        let Ok(found) = hand(tree, Some(palm)) else { continue };
        let tips = |hand: &Fingers| hand.chains.iter().map(|chain| chain.tip).collect::<Vec<_>>();
        // The palm is the last link that the fingers hang on.
        let is_palm = common(tree, &tips(&found)) == palm;
        if is_palm && found.chains.len() > 1 {
            hands.push(found);
        }
    }
    if hands.len() < 2 {
        return hands.pop().map(Ok);
    }
    let each = |hand: &Fingers| {
        let tips: Vec<String> =
            hand.chains.iter().map(|chain| format!("`{}`", name(tree, chain.tip))).collect();
        format!("`{}` (to {})", name(tree, hand.palm), tips.join(", "))
    };
    let all: Vec<String> = hands.iter().map(each).collect();
    Some(Err(Fault::of_file(format!(
        "the file has more than one hand; give the `palm` of the one to use: {}",
        all.join("; ")
    ))))
}

fn name<'t>(tree: &Tree<'t>, link: usize) -> &'t str {
    &tree.link_of(link).name
}

fn none(tree: &Tree<'_>, ends: &[usize], root: usize) -> Fault {
    let each = |&tip: &usize| {
        let why = unfit(tree, &below(tree, root, tip)).unwrap_or_default();
        format!("\n  `{}`: {why}", name(tree, tip))
    };
    let mut all: Vec<String> = ends.iter().take(8).map(each).collect();
    if ends.len() > 8 {
        all.push("\n  …".into());
    }
    Fault::of_file(format!(
        "nothing in the file can be a finger: at least {FEWEST_JOINTS} joints before a fingertip must move \
         by themselves, so that it can go in \
         all directions; the ends:{}",
        all.join("")
    ))
}

/// One tip for each joint behind which nothing moves: among the ends of what it moves, the one with `tip` in
/// its name, or else the farthest.
fn ends(tree: &Tree<'_>, palm: Option<usize>) -> Vec<usize> {
    let mut best: Vec<(usize, (bool, f64), usize)> = Vec::new();
    for leaf in tree.leaves() {
        let path = tree.path(leaf);
        if palm.is_some_and(|palm| !path.iter().any(|&joint| tree.parent(joint) == palm)) {
            continue;
        }
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
    best.into_iter().map(|(.., leaf)| leaf).collect()
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
