//! Which variants of a scene run on which boards.

use driveline_firmware::Words;
use driveline_firmware::board::{BOARDS, Facts};
use driveline_firmware::scenes::VARIANTS;

use driveline_qemu::image::belongs;

/// A variant on a board.
#[derive(Clone, Copy, Debug)]
pub struct Candidate {
    /// Its name in `firmware/src/scenes.rs`: scene, number, observer, rate.
    pub variant: &'static str,
    pub board: Facts,
}

impl Candidate {
    /// Part `k` of the name: 0 the scene, 1 the number, 2 the observer, 3 the rate.
    pub fn part(&self, k: usize) -> &'static str {
        self.variant.split('/').nth(k).unwrap_or_default()
    }

    /// Ticks a second.
    pub fn rate_hz(&self) -> u32 {
        self.part(3).parse().unwrap_or_default()
    }

    /// The kind of its words.
    pub fn words(&self) -> Words {
        if self.part(1) == "f32" { Words::Single } else { Words::Fixed }
    }

    /// Whether its number is the one that the core is for: floats with a unit for them, fixed point without.
    pub fn is_native(&self) -> bool {
        self.board.target.ends_with("hf") == (self.words() == Words::Single)
    }

    /// Number, core, observer and rate, as a filter matches them: `fixed/m3/reduced/10000`.
    pub fn key(&self) -> String {
        format!("{}/{}/{}/{}", self.part(1), self.board.core, self.part(2), self.part(3))
    }
}

/// The candidates of a scene whose key contains `filter`.
pub fn candidates(scene: &str, filter: Option<&str>) -> Vec<Candidate> {
    let mut candidates = Vec::new();
    for &board in BOARDS {
        for variant in VARIANTS {
            let candidate = Candidate { variant, board };
            if candidate.part(0) == scene
                && belongs(variant, &board)
                && filter.is_none_or(|filter| candidate.key().contains(filter))
            {
                candidates.push(candidate);
            }
        }
    }
    candidates
}
