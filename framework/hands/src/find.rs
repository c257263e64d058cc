//! The fingers that are asked for by name, or else guessed.

use crate::fingers::{FEWEST_JOINTS, Fingers, below, common, independent, unfit};
use crate::guess;
use crate::tree::Tree;
use regrasp_formats::RobotFault as Fault;

impl Fingers {
    /// The fingers to the given tips, or to guessed ones; the palm is given, or the last link that all tips
    /// hang on.
    ///
    /// A guess leaves out what cannot be a finger. Where it makes no hand of the whole file, the one link
    /// that carries a hand is the palm.
    pub fn find(tree: &Tree<'_>, tips: &[String], palm: Option<&str>) -> Result<Self, Fault> {
        let palm = palm.map(|name| tree.link(name).ok_or_else(|| unknown(tree, "palm", name))).transpose()?;
        if !tips.is_empty() {
            return given(tree, &named(tree, tips)?, palm);
        }
        let whole = guess::hand(tree, palm);
        match (whole, palm) {
            (Err(fault), None) => guess::only_hand(tree).unwrap_or(Err(fault)),
            (whole, _) => whole,
        }
    }
}

/// The fingers to these tips; one with too few joints is no finger but stays as a body.
fn given(tree: &Tree<'_>, tips: &[usize], palm: Option<usize>) -> Result<Fingers, Fault> {
    let root = palm.unwrap_or_else(|| common(tree, tips));
    let weak = |tip: usize| {
        let path = below(tree, root, tip);
        (independent(tree, &path) < FEWEST_JOINTS).then(|| unfit(tree, &path)).flatten()
    };
    let (out, kept): (Vec<usize>, Vec<usize>) = tips.iter().partition(|&&tip| weak(tip).is_some());
    let left_out = out.iter().filter_map(|&tip| {
        let name = &tree.link_of(tip).name;
        Some(format!("`{name}` does not hold: {}; its links stay where they are, as bodies", weak(tip)?))
    });
    let left_out: Vec<String> = left_out.collect();
    if kept.is_empty() {
        return Err(Fault::of_file(format!("no finger is left: {}", left_out.join("; "))));
    }
    // The palm is that of all tips: leaving one out moves no frame.
    let fingers = Fingers::new(tree, &kept, Some(root))?;
    Ok(Fingers { left_out, ..fingers })
}

fn named(tree: &Tree<'_>, tips: &[String]) -> Result<Vec<usize>, Fault> {
    for (i, name) in tips.iter().enumerate() {
        if tips[..i].contains(name) {
            return Err(Fault::of_key("tips", format!("the fingertip `{name}` is named twice")));
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
    let key = if what == "palm" { "palm" } else { "tips" };
    let shown = known[..shown].join(", ");
    Fault::of_key(key, format!("there is no link `{name}` to be the {what}; {what_is}: {shown}{dots}"))
}
