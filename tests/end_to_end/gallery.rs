//! `regrasp gallery`: what the book shows is what the program makes.

use crate::desk::Desk;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// The most bytes of a picture: the repository keeps twelve of them.
const MOST_BYTES: usize = 40_000;

#[test]
fn the_books_gallery_is_what_the_program_makes() {
    let desk = Desk::new();
    let said = desk.run("gallery --no-pages -o made");
    assert_eq!(said.code, 0, "{}", said.err);
    let book = Path::new(env!("CARGO_MANIFEST_DIR")).join("book/src/gallery");
    let names = |folder: &Path| -> BTreeSet<String> {
        let entries = fs::read_dir(folder).expect("the folder is there");
        entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect()
    };
    let made = names(&desk.path("made"));
    let remedy = "`regrasp gallery --no-pages -o book/src/gallery` brings the book up to date";
    assert_eq!(made, names(&book), "{remedy}");
    assert_eq!(made.len(), 13, "twelve pictures and the page");
    for name in &made {
        let text = desk.read(&format!("made/{name}"));
        assert!(fs::read_to_string(book.join(name)).is_ok_and(|old| old == text), "{name}: {remedy}");
        assert!(name == "README.md" || text.len() <= MOST_BYTES, "{name} has {} bytes", text.len());
    }
}

#[test]
fn hands_and_objects_of_the_gallery_differ() {
    let page = include_str!("../../book/src/gallery/README.md");
    let rows = page.lines().filter(|line| line.starts_with("| `"));
    let cells: Vec<Vec<&str>> = rows.map(|row| row.split('|').map(str::trim).collect()).collect();
    let count = |column: usize| cells.iter().map(|row| row[column]).collect::<BTreeSet<_>>().len();
    assert_eq!(cells.len(), 12);
    assert!(count(1) >= 7, "{} hands", count(1));
    assert!(count(2) >= 7, "{} objects", count(2));
}

#[test]
fn pages_play_and_lead_to_each_other() {
    let desk = Desk::new();
    let said = desk.run("gallery cube-free sphere-free -o made");
    assert_eq!(said.code, 0, "{}", said.err);
    let index = desk.read("made/index.html");
    for name in ["cube-free", "sphere-free"] {
        assert!(index.contains(&format!("<a href=\"{name}.html\"")), "{name}");
        let page = desk.read(&format!("made/{name}.html"));
        assert!(page.contains("content=\"regrasp view\"") && page.contains("</html>"), "{name}");
        assert!(desk.read("made/README.md").contains(&format!("[The plan, playing]({name}.html)")), "{name}");
    }
    // It stands alone: nothing is loaded from anywhere.
    let loaded = ["src=", "<link", "url(", "@import"].into_iter().find(|word| index.contains(word));
    assert_eq!(loaded, None);
    assert_eq!(index.matches("<svg").count(), 2);
    assert_eq!(desk.run("gallery cube-free sphere-free -o made").code, 0, "its own files are replaced");
}

#[test]
fn what_it_did_not_write_stays() {
    let desk = Desk::new();
    fs::create_dir(desk.path("mine")).expect("the folder can be made");
    desk.write("mine/README.md", "my thesis");
    desk.run("gallery sphere-free -o mine").assert_fails(2, &["README.md", "--force"]);
    assert_eq!(desk.read("mine/README.md"), "my thesis");
    desk.run("gallery sphere-free sphere-free -o twice").assert_fails(2, &["`sphere-free`", "two scenarios"]);
    desk.run("gallery -o -").assert_fails(2, &["need a folder"]);
}
