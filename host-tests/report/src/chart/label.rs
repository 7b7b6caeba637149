//! Labels beside points so that none covers another.

use crate::svg::{Anchor, text_width};

/// Boxes that are taken, as left, top, right, bottom.
#[derive(Default)]
pub struct Labels {
    taken: Vec<[f64; 4]>,
}

impl Labels {
    /// Marks the box of a point's marker as taken.
    pub fn point(&mut self, x: f64, y: f64) {
        self.taken.push([x - 6.0, y - 6.0, x + 6.0, y + 6.0]);
    }

    /// A free place beside a point for a text of this size, within the frame; `None` where there is none.
    pub fn place(&mut self, text: &str, size: f64, at: (f64, f64), frame: [f64; 4]) -> Option<(f64, f64, Anchor)> {
        let (x, y) = at;
        let width = text_width(text, size);
        let (left, right, centre) = (x - 9.0 - width, x + 9.0, x - width / 2.0);
        let places = [
            (right, y + 4.0, Anchor::Start),
            (left, y + 4.0, Anchor::End),
            (centre, y - 10.0, Anchor::Middle),
            (centre, y + 18.0, Anchor::Middle),
            (right, y - 9.0, Anchor::Start),
            (right, y + 16.0, Anchor::Start),
            (left, y - 9.0, Anchor::End),
            (left, y + 16.0, Anchor::End),
            (centre, y - 24.0, Anchor::Middle),
            (centre, y + 32.0, Anchor::Middle),
        ];
        for (start, baseline, anchor) in places {
            let wanted = [start, baseline - size * 0.85, start + width, baseline + size * 0.25];
            let inside =
                wanted[0] >= frame[0] && wanted[1] >= frame[1] && wanted[2] <= frame[2] && wanted[3] <= frame[3];
            if inside && self.taken.iter().all(|&other| apart(wanted, other)) {
                self.taken.push(wanted);
                let anchored = match anchor {
                    Anchor::Start => start,
                    Anchor::Middle => x,
                    Anchor::End => start + width,
                };
                return Some((anchored, baseline, anchor));
            }
        }
        None
    }
}

fn apart(a: [f64; 4], b: [f64; 4]) -> bool {
    a[2] <= b[0] || b[2] <= a[0] || a[3] <= b[1] || b[3] <= a[1]
}
