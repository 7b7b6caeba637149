//! Puts the report on one page.

mod thinning;
pub mod view;

use std::path::Path;

use minijinja::value::Serde;
use minijinja::{AutoEscape, Environment};
use serde::Serialize;

use crate::results::Report;

/// The page's template and its parts, compiled into the program.
const TEMPLATES: &[(&str, &str)] = &[
    ("page.html", include_str!("page/page.html")),
    ("costs.html", include_str!("page/costs.html")),
    ("sweeps.html", include_str!("page/sweeps.html")),
    ("survey.html", include_str!("page/survey.html")),
    ("machine.html", include_str!("page/machine.html")),
    ("sheet.html", include_str!("page/sheet.html")),
    ("simulation.html", include_str!("page/simulation.html")),
    ("backlash.html", include_str!("page/backlash.html")),
    ("balance.html", include_str!("page/balance.html")),
    ("plots.html", include_str!("page/plots.html")),
    ("frame.html", include_str!("page/frame.html")),
    ("style.css", include_str!("page/style.css")),
];

/// Fills a template. Everything is escaped but what is marked as safe: our own SVG and style.
///
/// # Panics
/// Where a template is wrong, which the tests show: the templates are part of the program.
pub fn fill(template: &str, values: impl Serialize) -> String {
    let mut environment = Environment::new();
    environment.set_auto_escape_callback(
        |name| {
            if name.ends_with(".html") { AutoEscape::Html } else { AutoEscape::None }
        },
    );
    for &(name, text) in TEMPLATES {
        environment.add_template(name, text).expect("a template of the report is not well-formed");
    }
    let template = environment.get_template(template).expect("the report's template is compiled in");
    template.render(Serde(values)).expect("a template of the report asks for what it is not given")
}

impl Report {
    /// The page as HTML. Long series are thinned (peaks kept) so that it stays under 3 MB.
    pub fn page(&self) -> String {
        fill("page.html", view::view(self))
    }

    /// Writes the page, and the folder it stands in where that is missing.
    ///
    /// # Errors
    /// What the file system says.
    pub fn write(&self, path: &Path) -> std::io::Result<()> {
        write_page(path, &self.page())
    }

    /// What `run --json` prints: `{scene, variants}`.
    pub fn json(&self) -> serde_json::Value {
        serde_json::json!({ "scene": self.scene, "variants": self.variants })
    }
}

/// Finds out before a long run whether a page can be written; what stands there is left alone, and the folder is made where it is missing.
///
/// # Errors
/// What the file system says.
pub fn writable(path: &Path) -> std::io::Result<()> {
    make_folder_of(path)?;
    let stood = path.exists();
    std::fs::OpenOptions::new().append(true).create(true).open(path)?;
    if stood { Ok(()) } else { std::fs::remove_file(path) }
}

fn make_folder_of(path: &Path) -> std::io::Result<()> {
    match path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        Some(folder) => std::fs::create_dir_all(folder),
        None => Ok(()),
    }
}

/// Writes a page, and the folder it stands in where that is missing.
///
/// # Errors
/// What the file system says.
pub fn write_page(path: &Path, page: &str) -> std::io::Result<()> {
    make_folder_of(path)?;
    std::fs::write(path, page)
}
