//! The rotors that were balanced.

use super::Section;
use crate::balancing::tables;
use crate::survey::Survey;

/// Every rotor: what it had to show, and what it took.
pub fn section(survey: &Survey) -> Section {
    let mut section =
        Section::new("Balancing while the machine runs", "In QEMU, in closed loop with drivetrain and whirling rotor.");
    for (scene, ran) in &survey.balanced {
        section = section.failed(survey, scene);
        if ran.is_empty() {
            continue;
        }
        for part in tables(ran) {
            section = section.table(&format!("{scene}: {}", part.title.to_lowercase()), &part.text, &part.table);
        }
    }
    section
}
