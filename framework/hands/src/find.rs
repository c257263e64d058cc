//! The fingers that are asked for by name, or else guessed.

use crate::fingers::Fingers;
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
            return Self::new(tree, &named(tree, tips)?, palm);
        }
        let whole = guess::hand(tree, palm);
        match (whole, palm) {
            (Err(fault), None) => guess::only_hand(tree).unwrap_or(Err(fault)),
            (whole, _) => whole,
        }
    }
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
