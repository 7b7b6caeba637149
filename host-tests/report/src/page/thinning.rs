//! How finely trajectories are drawn, so that the page stays small enough to send.

/// Bytes that all trajectories together may take, of the 3 MB of the page; the rest is plots, tables and style.
const BYTES: usize = 2_200_000;
/// Bytes of a point of a trace: a relative move in tenths of a unit, generously.
const POINT: usize = 9;
/// Lines of a trajectory: truth, estimate and error of three quantities.
const LINES: usize = 9;
/// Points of a stretch: first, least, most, last.
const STRETCH: usize = 4;
/// Finest: about one stretch for each unit of the plot's width.
const FINEST: usize = 900;
/// Coarsest that still shows a course.
const COARSEST: usize = 40;

/// How many trajectories are drawn, and into how many stretches each line of them is cut.
pub fn fineness(trajectories: usize) -> (usize, usize) {
    let each = LINES * POINT * STRETCH;
    let drawn = trajectories.min(BYTES / (each * COARSEST));
    (drawn, (BYTES / (each * drawn.max(1))).clamp(COARSEST, FINEST))
}

#[cfg(test)]
mod tests {
    use crate::page::thinning::*;

    #[test]
    fn any_number_of_trajectories_fits() {
        for count in [0, 1, 12, 48, 1_000] {
            let (drawn, stretches) = fineness(count);
            assert!(drawn * stretches * LINES * POINT * STRETCH <= BYTES);
            assert!(drawn == count || stretches == COARSEST);
        }
    }
}
