//! The book holds together: its links, anchors, pictures and included code exist, its table of contents is
//! complete, and the commands that it shows are commands of the program, its pieces of scenarios are pieces
//! of scenarios, and what it shows of the program's output is what the program prints.
//!
//! Each check has a liar: a small book with that one fault.

mod commands;
mod liars;
mod markdown;
mod outputs;
mod scenarios;
mod tree;

use std::path::Path;

#[test]
fn the_book_and_the_documents_beside_it_hold_together() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let tree = tree::Tree::read(
        root,
        &["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "STYLE.md", "clusters/README.md"],
    );
    assert!(tree.pages.len() > 20, "only {} pages were found", tree.pages.len());
    let mut faults = tree.faults();
    faults.extend(commands::faults(&tree, &commands::Help::of_the_program()));
    assert!(tree.pages.values().any(|page| !page.outputs.is_empty()), "no page shows an output");
    faults.extend(outputs::faults(&tree, &outputs::run_program));
    faults.extend(scenarios::faults(&tree));
    assert!(faults.is_empty(), "{} faults:\n{}", faults.len(), faults.join("\n"));
}
