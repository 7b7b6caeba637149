//! A wheel that is not the one described gives no angle and no cycle.

use driveline::settings::Teeth;
use driveline::wheel::{CycleTimes, ToothedWheel, ToothedWheelConfig};

use super::edges::{Run, TIMING, clock};

/// Ticks with an angle and finished cycles of a wheel that is described by `teeth`.
pub fn seen<const TEETH: usize>(teeth: &Teeth<TEETH>, edges: &[f64]) -> [usize; 2] {
    let config = ToothedWheelConfig::new(teeth, TIMING);
    let mut wheel = ToothedWheel::<CycleTimes<TEETH>>::default();
    let mut edges = edges.iter().map(|edge| edge - edges[0]).peekable();
    let mut seen = [0; 2];
    for tick in 1.. {
        let now = f64::from(tick) * 1e-3;
        while let Some(edge) = edges.next_if(|edge| *edge <= now) {
            wheel.tooth(&config, clock(edge));
            seen[1] += usize::from(wheel.take().is_some());
        }
        seen[0] += usize::from(wheel.at(&config, clock(now)).is_ok());
        if edges.peek().is_none() {
            return seen;
        }
    }
    seen
}

macro_rules! seen_as {
    ($edges:expr; gaps $(($places:literal, $missing:literal))*;
     without $(($left:literal, $n:literal, $gone:expr))*) => {
        [
            $((
                concat!($places, "-", $missing),
                seen(&Teeth::<{ $places - $missing }>::gap($places, $missing), $edges),
            ),)*
            $((stringify!($n without $gone), seen(&Teeth::<$left>::without($n, &$gone), $edges)),)*
            ("12+1", seen(&Teeth::<13>::extra(12, 340.0), $edges)),
            ("12+1 backwards", seen(&Teeth::<13>::extra(12, 350.0), $edges)),
            ("24+1", seen(&Teeth::<25>::extra(24, 355.0), $edges)),
            ("three", seen(&Teeth::degrees([0.0, 90.0, 250.0]), $edges)),
            ("four", seen(&Teeth::degrees([0.0, 50.0, 180.0, 250.0]), $edges)),
        ]
    };
}

/// All descriptions but those of `right` must see nothing.
#[track_caller]
pub fn nothing_but(name: &str, edges: &[f64], right: &[&str]) {
    let all = seen_as!(edges;
        gaps (36, 1) (36, 2) (36, 3) (36, 4) (35, 1) (35, 2) (34, 1) (37, 2) (37, 3) (33, 1) (60, 1) (60, 2) (60, 3)
            (59, 1) (61, 3) (58, 1) (48, 2) (44, 2) (32, 2) (30, 1) (24, 1) (24, 2) (18, 1) (16, 2) (15, 2) (15, 3)
            (14, 1) (14, 2) (13, 1) (12, 1) (12, 2) (12, 3) (10, 3) (9, 2) (8, 1) (8, 2) (7, 1) (6, 1) (6, 2)
            (5, 1) (4, 1);
        without (33, 36, [17, 34, 35]) (33, 36, [16, 17, 34]) (33, 36, [10, 34, 35]) (34, 36, [17, 35])
            (30, 36, [13, 14, 17, 18, 34, 35]) (30, 36, [9, 10, 22, 23, 34, 35]) (30, 36, [8, 9, 17, 18, 34, 35])
            (30, 36, [10, 11, 22, 23, 34, 35]) (32, 36, [16, 17, 34, 35]));
    for (described, [ticks, cycles]) in all {
        if right.contains(&described) {
            assert!(ticks > 0, "{name} as {described}");
        } else {
            assert_eq!([ticks, cycles], [0, 0], "{name} as {described}");
        }
    }
}

/// Five engines' wheels, clean and with jitter: 54 other descriptions of each.
#[test]
fn another_wheel_gives_no_angle_and_no_cycle() {
    for (ripple, jitter) in [(0.02, 0.0), (0.05, 0.03), (0.1, 0.1), (0.2, 0.0)] {
        let run = Run { speed: 13.0, ripple, order: 2.0, jitter, seed: 1 };
        let single = |order| Run { order, ..run };
        nothing_but("60-2", &run.edges(&Teeth::<58>::gap(60, 2), 40), &["60-2"]);
        nothing_but("36-1", &run.edges(&Teeth::<35>::gap(36, 1), 40), &["36-1"]);
        nothing_but("24-1", &single(3.0).edges(&Teeth::<23>::gap(24, 1), 40), &["24-1"]);
        let teeth = Teeth::<33>::without(36, &[17, 34, 35]);
        nothing_but("36-2-1", &single(1.5).edges(&teeth, 40), &["36 without [17, 34, 35]"]);
        let teeth = Teeth::<30>::without(36, &[13, 14, 17, 18, 34, 35]);
        nothing_but("36-2-2-2", &single(1.5).edges(&teeth, 40), &["36 without [13, 14, 17, 18, 34, 35]"]);
    }
}
