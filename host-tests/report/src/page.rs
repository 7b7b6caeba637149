//! Puts the report on one page.

mod thinning;
mod view;

use minijinja::value::Serde;
use minijinja::{AutoEscape, Environment};
use serde::Serialize;

use crate::report::Report;

/// The page's template and its parts, compiled into the program.
const TEMPLATES: &[(&str, &str)] = &[
    ("page.html", include_str!("page/page.html")),
    ("costs.html", include_str!("page/costs.html")),
    ("sheet.html", include_str!("page/sheet.html")),
    ("frame.html", include_str!("page/frame.html")),
    ("style.css", include_str!("page/style.css")),
    ("viewer.js", include_str!("page/viewer.js")),
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
    template.render(Serde(values)).expect("a template of the report lacks an input")
}

impl Report {
    /// The page as HTML. Long series are thinned (peaks kept) so that it stays under 3 MB.
    pub fn page(&self) -> String {
        fill("page.html", view::view(self))
    }

    /// Output of `run --json`: `{scene, variants}`.
    pub fn json(&self) -> serde_json::Value {
        serde_json::json!({ "scene": self.scene, "variants": self.variants })
    }
}
