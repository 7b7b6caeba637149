//! What a wheel or a vibration came to.

use driveline_report::Sheet;

/// The results in every form.
pub struct Shown {
    /// Printed.
    pub text: String,
    /// With `--json`.
    pub json: serde_json::Value,
    /// With `--csv`.
    pub csv: String,
    /// What the record does not tell; none where it tells something.
    pub untold: Option<String>,
    /// The page.
    pub sheet: Sheet,
}
