//! Whether the main loop still turns. It alone hears the terminal, so that without it a terminal cannot stop the drive.

/// Ticks without a turn of the main loop after which it counts as hung: half a second at 10 kHz. Its longest turn, a
/// step of in-run balancing included, takes milliseconds.
pub const PATIENCE: u32 = 5_000;

/// The tick's record of the main loop.
#[derive(Clone, Copy, Debug, Default)]
pub struct Attended {
    turns: u32,
    ticks: u32,
}

impl Attended {
    /// Whether the main loop has turned within the last ticks; `turns` counts its turns, and wraps.
    #[inline]
    pub fn check(&mut self, turns: u32) -> bool {
        self.ticks = if turns == self.turns { self.ticks.saturating_add(1) } else { 0 };
        self.turns = turns;
        self.ticks < PATIENCE
    }
}
