//! Where the parts of a chain's state stand.

/// Where the parts of the state stand: twists, then speeds, then the motor's angle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Layout {
    pub nodes: usize,
}

impl Layout {
    pub fn speed(self, node: usize) -> usize {
        self.nodes - 1 + node
    }

    pub fn angle(self) -> usize {
        2 * self.nodes - 1
    }

    pub fn states(self) -> usize {
        2 * self.nodes
    }
}
