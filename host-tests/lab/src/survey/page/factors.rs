//! Dynamic factors (gears: K_v; mills: torque amplification factor, TAF), and the peaks with backlash take-up.

use super::{Section, kept};
use crate::survey::Survey;
use driveline_report::Table;
use driveline_report::format::{percent, significant};

/// Limit of the peak, of the plain speed loop's.
const OVER_PLAIN: f64 = 0.7;

/// Peaks and dynamic factors.
pub fn section(survey: &Survey) -> Section {
    let mut factors = Table::new(["scene", "variant", "run", "peak N m", "rigid machine, N m", "K"]);
    let mut gentle = Table::new(["scene", "variant", "run", "beside", "peak, of its", "at most", ""]);
    let mut any = false;
    for scene in &survey.scenes {
        for run in scene.chosen() {
            let label = run.variant.label();
            for factor in &run.factors {
                let k = factor.k().map_or_else(|| "not stated: nothing is carried, or a crank".to_owned(), significant);
                let torques = [factor.peak, factor.rigid].map(significant);
                let names = [scene.name.clone(), label.clone(), factor.scenario.clone()];
                factors.row(names.into_iter().chain(torques).chain([k]));
            }
        }
        for run in &scene.runs {
            for one in scene.gentle(run) {
                any = true;
                let verdict = kept(one.share <= OVER_PLAIN).to_owned();
                let shares = [one.share, OVER_PLAIN].map(percent);
                let names = [scene.name.clone(), run.variant.label(), one.scenario, one.plain];
                gentle.row(names.into_iter().chain(shares).chain([verdict]));
            }
        }
    }
    let text = "K is the peak of the shaft torque over the largest torque that the same shaft would carry in a rigid \
        machine under the same \
                torques, accelerating with the whole machine: the increase by vibration, impacts and backlash. \
                (Gears: dynamic factor K_v; mills: torque amplification factor, TAF.)";
    let section = Section::new("Dynamic factors", text);
    if survey.scenes.is_empty() {
        return section;
    }
    let section = section.table("", "", &factors);
    let text = "The peak with backlash take-up and active damping over that of a plain speed loop on the same run, \
        where a gap opens or a rope goes slack.";
    if any { section.table("With and without backlash take-up", text, &gentle) } else { section }
}
