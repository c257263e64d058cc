//! The pages that show all plans of a gallery.

use super::GalleryArgs;
use super::entry::Entry;
use super::figures::Figures;
use std::fmt::Write;

/// What stands above the plans.
const ABOUT: &str = "\
A dark fingertip holds the object, a red one is on its way to a new contact; the cross painted on the object \
shows how it turns. Every plan is verified. *Margin* and *clearance* are the least of the whole motion, as \
the verifier certifies them. *Holds* says at which friction, which mass and which push from any side every \
grasp of the motion still stands, within the efforts of the joints.";

/// The page for a forge and for the book.
pub fn markdown(entries: &[Entry], args: &GalleryArgs) -> String {
    let mut text = format!("<!-- regrasp-gallery -->\n# Gallery\n\n{}\n", wrapped(&about(entries, args)));
    for entry in entries {
        let Entry { name, asked, summary, figures, .. } = entry;
        let seed = if args.seed == 0 { String::new() } else { format!(" --seed {}", args.seed) };
        write!(
            text,
            "\n## {name}\n\n{}.\n\n![{summary}, at four moments]({name}.svg)\n\n\
             | {} |\n|{}\n| {} |\n\n```\n$ regrasp plan {asked}{seed} --view\n```\n",
            capital(summary),
            Figures::HEAD.join(" | "),
            "---|".repeat(Figures::HEAD.len()),
            figures.cells().join(" | "),
        )
        .expect("a text takes everything");
        if !args.no_pages {
            writeln!(text, "\n[The plan, playing]({name}.html)").expect("a text takes everything");
        }
    }
    text
}

fn about(entries: &[Entry], args: &GalleryArgs) -> String {
    let pages = match args.no_pages {
        true => "; without `--no-pages` it also writes a page that plays each of them",
        false => "",
    };
    format!(
        "{} plans, each of the seed {}, at four moments. `regrasp gallery` makes this page{pages}. {ABOUT}",
        entries.len(),
        args.seed
    )
}

/// The page for the browser: pictures that lead to the pages which play.
pub fn html(entries: &[Entry]) -> String {
    let mut text = String::from(HEAD);
    for entry in entries {
        let [name, summary] = [&entry.name, &entry.summary].map(|text| escaped(text));
        let rows = Figures::HEAD.iter().zip(entry.figures.cells());
        let rows: String = rows
            .map(|(head, cell)| format!("<dt>{head}</dt><dd>{}</dd>", escaped(&cell.replace('`', ""))))
            .collect();
        write!(
            text,
            "<article>\n<a href=\"{name}.html\" aria-label=\"play {name}\">{}</a>\n<h2><a \
             href=\"{name}.html\">{name}</a></h2>\n<p>{}.</p>\n<dl>{rows}</dl>\n</article>\n",
            entry.picture,
            capital(&summary)
        )
        .expect("a text takes everything");
    }
    text + "</main>\n</body>\n</html>\n"
}

const HEAD: &str = include_str!("head.html");

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// A sentence's first letter.
fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map(|first| first.to_uppercase().chain(letters).collect()).unwrap_or_default()
}

/// Lines of the width that the book has.
fn wrapped(text: &str) -> String {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let line = lines.last_mut().expect("there is a line");
        if !line.is_empty() && line.chars().count() + 1 + word.chars().count() > 110 {
            lines.push(word.to_owned());
        } else {
            *line += if line.is_empty() { "" } else { " " };
            *line += word;
        }
    }
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_not_wider_than_the_book() {
        let text = wrapped(&"word ".repeat(100));
        assert!(text.lines().all(|line| line.len() <= 110));
        assert_eq!(text.split_whitespace().count(), 100);
        assert_eq!(text.lines().count(), 5, "22 words of 5 letters in a line, blanks included");
    }

    #[test]
    fn sentences_begin_with_a_capital_and_names_cannot_break_the_page() {
        assert_eq!(capital("a ball"), "A ball");
        assert_eq!(capital(""), "");
        assert_eq!(escaped("<b> & \"c\""), "&lt;b&gt; &amp; &quot;c&quot;");
    }
}
