//! Where pages of hands and objects go, and how they are opened: beside what they show, or where one says.

use crate::outputs::{self, Kind, OverwriteArgs};
use crate::view::{open, put, tell};
use crate::{Failure, say};
use std::path::{Path, PathBuf};

/// Whether a page is made of what a command has understood.
#[derive(Clone, Debug, clap::Args)]
pub struct PageArgs {
    /// Write a page that shows it in 3-D, beside the file that `-o` writes or to a temporary place, and open
    /// it in the browser.
    #[arg(long)]
    pub view: bool,
    /// Write the page to this file instead, and open nothing; `-` is standard output, and the report then
    /// goes to standard error.
    #[arg(long, value_name = "FILE")]
    pub page: Option<PathBuf>,
}

impl PageArgs {
    /// Whether there is to be a page.
    pub fn wanted(&self) -> bool {
        self.view || self.page.is_some()
    }

    /// Whether the page is what goes to standard output.
    pub fn is_standard(&self) -> bool {
        self.page.as_deref().is_some_and(outputs::is_standard)
    }

    /// Where the page goes, as far as that is known before it is made.
    fn place(&self, written: Option<&Path>) -> Option<PathBuf> {
        let beside = written.filter(|path| self.view && !outputs::is_standard(path));
        self.page.clone().or_else(|| beside.map(|path| path.with_extension("html")))
    }

    /// Refuses, before any work, outputs that would destroy something: the page, and `others`, which the
    /// command writes besides; the page lies beside the first.
    pub fn check(
        &self,
        inputs: &[PathBuf],
        others: &[(&Path, Kind)],
        overwrite: OverwriteArgs,
    ) -> Result<(), Failure> {
        if self.is_standard() && others.iter().any(|(path, _)| outputs::is_standard(path)) {
            return Err(Failure::bad_input(
                "`-o -` and `--page -` both want standard output; name a file for one of them",
            ));
        }
        let page = self.place(others.first().map(|&(path, _)| path));
        let mut wished = others.to_vec();
        wished.extend(page.as_deref().map(|path| (path, Kind::Page)));
        outputs::check(inputs, &wished, overwrite)
    }

    /// Writes the page, opens it where that was asked for, and says on standard error where it is.
    pub fn show(&self, page: &str, written: Option<&Path>) -> Result<(), Failure> {
        if self.is_standard() {
            return say(page);
        }
        let output = match self.place(written) {
            Some(path) => path,
            None => open::temporary_folder().map_err(Failure::bad_input)?.join("page.html"),
        };
        put(page, &output).map_err(Failure::bad_input)?;
        let size = format!("{} ({:.1} MB)", output.display(), page.len() as f64 / 1e6);
        if self.page.is_some() {
            return tell(&format!("the page: {size}"));
        }
        let shown =
            if open::in_browser(&output) { "the page is opened" } else { "open the page in a browser" };
        tell(&format!("{shown}: {size}"))
    }
}
