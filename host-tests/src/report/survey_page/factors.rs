//! Dynamic factors, and what the gentle governors take off the peak.

use super::{Section, kept};
use crate::report::Table;
use crate::report::format::{percent, significant};
use crate::survey::Survey;

/// What the peak may be of the plain speed loop's.
const OVER_PLAIN: f64 = 0.7;

/// Peaks and dynamic factors.
pub fn section(survey: &Survey) -> Section {
    let mut factors = Table::new(["scene", "variant", "peak N m", "were it rigid N m", "K"]);
    let mut gentle = Table::new(["scene", "variant", "beside the plain speed loop of", "peak, of its", "at most", ""]);
    let mut any = false;
    for scene in &survey.scenes {
        for run in scene.chosen() {
            let k = run.factor.k().map_or_else(|| "none: nothing is carried".to_owned(), significant);
            let torques = [run.factor.peak, run.factor.rigid].map(significant);
            factors.row([scene.name.clone(), run.variant.label()].into_iter().chain(torques).chain([k]));
            for (plain, share) in scene.over_plain(run) {
                any = true;
                gentle.row([
                    scene.name.clone(),
                    run.variant.label(),
                    plain,
                    percent(share),
                    percent(OVER_PLAIN),
                    kept(share <= OVER_PLAIN).to_owned(),
                ]);
            }
        }
    }
    let text = "K is the peak of the shaft torque over the largest torque that the same shaft would carry in a rigid machine under the same \
                torques, gaining speed as the whole machine gains momentum: what vibration, impacts and slack add. Over all runs of the scene, the \
                one with the largest peak.";
    let section = Section::new("Dynamic factors", text);
    if survey.scenes.is_empty() {
        return section;
    }
    let section = section.table("", "", &factors);
    let text = "The peak of the governor that takes up slack and damps the shaft, over that of a plain speed loop on the same run.";
    if any { section.table("With and without a gentle governor", text, &gentle) } else { section }
}
