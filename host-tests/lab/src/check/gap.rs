//! The gap between the longest path of an image and the worst of its inputs.

use std::fmt;

use driveline_firmware::board::Facts;
use driveline_qemu::image::Image;
use driveline_qemu::measure::{Called, Loops, MachineCode, worst_called, worst_drawn, worst_sought};

/// Inputs of an image that are drawn, and that are sought.
#[derive(Clone, Copy, Debug)]
pub struct Inputs {
    pub drawn: usize,
    pub sought: usize,
}

impl Inputs {
    /// Three million and one million, or as many as `INPUTS` says of both.
    pub fn of_environment() -> Result<Self, String> {
        let Ok(text) = std::env::var("INPUTS") else { return Ok(Inputs { drawn: 3_000_000, sought: 1_000_000 }) };
        let count = text.parse().ok().filter(|&count| count > 0);
        let count = count.ok_or_else(|| format!("INPUTS is `{text}`, expected a number of inputs, 1 or more"))?;
        Ok(Inputs { drawn: count, sought: count })
    }
}

/// Instructions of an image's tick.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Gap {
    pub variant: String,
    pub core: &'static str,
    /// On the longest path; none where the analysis refuses it.
    pub longest: Option<u64>,
    /// The worst of the inputs that were drawn.
    pub drawn: u64,
    /// The worst of those that were sought; none for a function of the bench.
    pub sought: Option<u64>,
}

/// The hoist's worst input takes at least this share of its longest path: the bound is hardly more than is reached.
const HOIST: f64 = 0.97;

impl Gap {
    /// Finds the worst inputs of an image.
    pub fn of(image: &Image, inputs: Inputs) -> Result<Self, String> {
        let code = MachineCode::read(&image.path, Loops::default()).map_err(|error| error.to_string())?;
        let start = code.find("driveline_tick").ok_or("there is no function `driveline_tick`")?;
        let worst = |found: Result<u32, Box<dyn std::error::Error>>| found.map_err(|error| error.to_string());
        Ok(Gap {
            variant: image.variant.clone(),
            core: image.board.core,
            longest: code.bound(start).ok().map(|bound| bound.instructions),
            drawn: worst(worst_drawn(image, inputs.drawn))?.into(),
            sought: Some(worst(worst_sought(image, inputs.sought))?.into()),
        })
    }

    /// The worst calls of the bench's functions on a board.
    pub fn of_functions(board: Facts, inputs: Inputs) -> Result<Vec<Self>, String> {
        let calls = u32::try_from(inputs.drawn).map_err(|error| format!("INPUTS is {}: {error}", inputs.drawn))?;
        let called = worst_called(board, calls).map_err(|error| error.to_string())?;
        let gap = |Called { name, longest, most }| Gap {
            variant: format!("bench/{name}"),
            core: board.core,
            longest,
            drawn: most,
            sought: None,
        };
        // those of `nops` calibrate the counter
        Ok(called.into_iter().filter(|called| !called.name.starts_with("nops/")).map(gap).collect())
    }

    /// The worst input's share of the longest path.
    pub fn share(&self) -> Option<f64> {
        Some(self.drawn.max(self.sought.unwrap_or(0)) as f64 / self.longest? as f64)
    }

    /// Whether no input exceeds the longest path, and the hoist's comes near it.
    pub fn holds(&self) -> Result<(), String> {
        let Some(share) = self.share() else { return Ok(()) };
        if share > 1.0 {
            return Err(format!("an input exceeds the longest path, {self}: the analysis is wrong"));
        }
        if share < HOIST && self.is_hoist() {
            return Err(format!("no input was found near the longest path, {self}: expected {:.0} %", 100.0 * HOIST));
        }
        Ok(())
    }

    /// Whether it is the hoist's whole drive.
    pub fn is_hoist(&self) -> bool {
        self.variant.starts_with("hoist/")
    }
}

impl fmt::Display for Gap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Gap { variant, core, drawn, sought, .. } = self;
        write!(f, "{variant} on {core}: {drawn} of the inputs drawn")?;
        if let Some(sought) = sought {
            write!(f, ", {sought} of those sought")?;
        }
        match (self.longest, self.share()) {
            (Some(longest), Some(share)) => {
                write!(f, ", longest path {longest}, gap {:.1} %", 100.0 * (1.0 - share))
            }
            _ => f.write_str(", without a bound"),
        }
    }
}

/// A table for the book: longest path, worst input drawn and sought, and the gap, a variant a row, a core a column.
pub fn table(gaps: &[Gap], cores: &[&str]) -> String {
    let mut text = format!("| image | {} |\n|---|{}\n", cores.join(" | "), "---|".repeat(cores.len()));
    let mut variants: Vec<&str> = gaps.iter().map(|gap| gap.variant.as_str()).collect();
    variants.sort_unstable();
    variants.dedup();
    for variant in variants {
        let cell = |core: &&str| {
            let Some(gap) = gaps.iter().find(|gap| gap.variant == variant && gap.core == *core) else {
                return String::new();
            };
            let sought = gap.sought.map(|sought| format!(", {sought}")).unwrap_or_default();
            let (Some(longest), Some(share)) = (gap.longest, gap.share()) else {
                return format!("no bound, {}{sought}", gap.drawn);
            };
            format!("{longest}, {}{sought}: {:.1} %", gap.drawn, 100.0 * (1.0 - share))
        };
        text += &format!("| {variant} | {} |\n", cores.iter().map(cell).collect::<Vec<_>>().join(" | "));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::{Gap, table};

    fn gap(variant: &str, longest: Option<u64>, drawn: u64, sought: u64) -> Gap {
        Gap { variant: variant.into(), core: "m3", longest, drawn, sought: Some(sought) }
    }

    #[test]
    fn an_input_beyond_the_longest_path_fails_and_so_does_a_hoist_that_is_far_from_it() {
        let fails = |gap: Gap, text: &str| {
            let error = gap.holds().unwrap_err();
            assert!(error.contains(text), "{error}");
        };
        fails(gap("spindle/f32/rigid/4000", Some(100), 90, 101), "exceeds the longest path");
        fails(gap("spindle/f32/rigid/4000", Some(100), 101, 90), "exceeds the longest path");
        fails(gap("hoist/f32/exact/1000", Some(100), 96, 96), "expected 97 %");
        assert_eq!(gap("hoist/f32/exact/1000", Some(100), 90, 97).holds(), Ok(()));
        assert_eq!(gap("spindle/f32/rigid/4000", Some(100), 50, 60).holds(), Ok(()));
        assert_eq!(gap("commission/f32/hoist/1000", None, 50, 60).holds(), Ok(()));
    }

    #[test]
    fn the_table_has_a_row_for_a_variant_and_a_column_for_a_core() {
        let first = Gap { core: "m4f", ..gap("b", Some(200), 150, 190) };
        let function = Gap { sought: None, ..gap("c", Some(50), 40, 0) };
        let gaps = [first, gap("b", Some(100), 96, 93), gap("a", None, 7, 9), function];
        let expected = "| image | m4f | m3 |\n|---|---|---|\n| a |  | no bound, 7, 9 |\n\
                        | b | 200, 150, 190: 5.0 % | 100, 96, 93: 4.0 % |\n\
                        | c |  | 50, 40: 20.0 % |\n";
        assert_eq!(table(&gaps, &["m4f", "m3"]), expected);
    }
}
