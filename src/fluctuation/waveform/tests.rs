//! Single steps from states made by hand.

use super::super::CycleConfig;
use super::*;

type Eight = Waveform<8, f64>;

/// A turn in quarters and five units, of two bins to a quarter; four cycles to a window.
const CONFIG: WaveformConfig = WaveformConfig {
    cycle: CycleConfig {
        length: 1 << 30,
        last_segment: 3,
        whole: 5,
        part: 0,
        divisor: 1,
        angle: core::f64::consts::TAU,
        period: 0.01,
        speed: 1.0,
        torque: 1.0,
    },
    cycles: 4,
    // eight bins to 2^32, in 2^-50
    scale: 1 << 21,
    per_segment: 2,
};

fn new(slice: Slice, stage: Stage) -> Eight {
    let mut waveform = Eight { slice, stage, ..Eight::default() };
    waveform.position.measure(&CONFIG.cycle);
    waveform.position.is_sure = true;
    waveform
}

/// A slice's work at this angle.
fn step(waveform: &mut Eight, angle: u32, tick: u32) -> Slice {
    waveform.slice(&CONFIG, angle, tick, &Estimate { motor_speed: 3.0, ..Estimate::default() });
    waveform.slice
}

/// The distances of three ticks from the middle of the second bin: a quarter of it either way, and none.
#[test]
fn a_tick_counts_where_it_is_in_its_bin() {
    const BIN: u32 = 1 << 29;
    for (base, within, bin, first, second) in [
        (0, BIN + BIN / 4 * 3, 1, 256, 64 * 64),
        (0, BIN + BIN / 4, 1, -256, 64 * 64),
        (0, BIN + BIN / 2, 1, 0, 0),
        // behind the segment's start and beyond the cycle's end
        (2, (BIN / 4).wrapping_neg(), 1, 256, 64 * 64),
        (7, BIN + BIN / 4, 0, -256, 64 * 64),
        (0, BIN, 1, -512, 128 * 128),
    ] {
        for (stage, ticks) in [(Stage::Filling, 2), (Stage::Waiting, 0), (Stage::Full, 0), (Stage::Void, 0)] {
            let mut waveform = Eight { base, ..new(Slice::Watch, stage) };
            waveform.fill(&CONFIG, within, 5.0);
            waveform.fill(&CONFIG, within, 2.0);
            let mut bins = [Bin::default(); 8];
            if ticks > 0 {
                bins[bin] = Bin { ticks, first: 2 * first, second: 2 * second, torque: 7.0 };
            }
            assert_eq!(waveform.bins, bins, "{base} {within}");
        }
    }
}

/// Ends belong to what follows: that of a segment, and that of the cycle five units behind its last one's.
#[test]
fn ends_are_in_what_follows() {
    const QUARTER: u32 = 1 << 30;
    for (slice, angle, expected) in [
        (Slice::Watch, QUARTER - 1, Slice::Watch),
        (Slice::Watch, QUARTER, Slice::Ahead),
        (Slice::Watch, QUARTER + 1, Slice::Ahead),
        (Slice::Beyond, QUARTER + 4, Slice::Watch),
        (Slice::Beyond, QUARTER + 5, Slice::NextCycle),
        (Slice::Beyond, QUARTER + 6, Slice::NextCycle),
        // turned back before the end was noted down
        (Slice::Note, 0, Slice::File),
        (Slice::Note, 1, Slice::File),
        (Slice::Note, u32::MAX, Slice::ReadingFault),
        (Slice::NoteBack, QUARTER + 4, Slice::File),
        (Slice::NoteBack, QUARTER + 5, Slice::File),
        (Slice::NoteBack, QUARTER + 6, Slice::ReadingFault),
    ] {
        let mut waveform = Eight { then: Stage::Full, ..new(slice, Stage::Filling) };
        assert_eq!(step(&mut waveform, angle, 77), expected, "{slice:?} {angle}");
        let edge = match slice {
            Slice::Note => Edge { tick: 77, angle, beyond: angle, speed: 3.0 },
            _ => Edge { tick: 77, angle, beyond: (QUARTER + 5).wrapping_sub(angle), speed: 3.0 },
        };
        let noted = expected == Slice::File;
        assert_eq!(waveform.edge, if noted { edge } else { Edge::default() });
        assert_eq!(waveform.stage, if noted { Stage::Full } else { Stage::Filling });
    }
}

/// A window is full with its fourth cycle, or where it has lasted more than 2^21 ticks; turned back it is void.
#[test]
fn a_window_ends_with_its_last_cycle() {
    for (then, cycles, ticks, expected) in [
        (Stage::Filling, 2, 100, Stage::Filling),
        (Stage::Filling, 3, 100, Stage::Full),
        (Stage::Filling, 4, 100, Stage::Full),
        // the first end of all
        (Stage::Filling, u32::MAX, 100, Stage::Filling),
        (Stage::Filling, 0, 1 << 21, Stage::Filling),
        (Stage::Filling, 0, (1 << 21) + 1, Stage::Full),
        (Stage::Void, 3, 100, Stage::Void),
        (Stage::Void, 0, (1 << 21) + 1, Stage::Void),
    ] {
        for (ahead, next) in [(true, Slice::Note), (false, Slice::NoteBack)] {
            let mut waveform = Eight { then, cycles, ahead, ..new(Slice::Duration, Stage::Filling) };
            waveform.edges[0].tick = u32::MAX;
            assert_eq!(step(&mut waveform, 0, ticks - 1), next);
            assert_eq!(waveform.then, expected, "{cycles} {ticks}");
        }
    }
    for (ahead, forward, then) in [
        (true, true, Stage::Filling),
        (false, false, Stage::Filling),
        (true, false, Stage::Void),
        (false, true, Stage::Void),
    ] {
        let mut waveform = Eight { ahead, forward, ..new(Slice::Direction, Stage::Filling) };
        assert_eq!((step(&mut waveform, 0, 1), waveform.then), (Slice::Duration, then));
        // a segment that is passed the other way
        let mut waveform = Eight { forward, ..new(Slice::CountUp, Stage::Filling) };
        assert_eq!(step(&mut waveform, 0, 1), if forward { Slice::Watch } else { Slice::ReadingFault });
        let mut waveform = Eight { forward, ..new(Slice::CountDown, Stage::Filling) };
        assert_eq!(step(&mut waveform, 0, 1), if forward { Slice::ReadingFault } else { Slice::Watch });
    }
}

/// The first end of a cycle and the second stand, and so do the last of an even and of an odd number.
#[test]
fn ends_are_filed_by_their_number() {
    let marked = Edge { tick: 9, ..Edge::default() };
    for (before, number, places) in
        [(u32::MAX, 0, &[0, 2][..]), (0, 1, &[1, 3]), (1, 2, &[2]), (2, 3, &[3]), (3, 4, &[2])]
    {
        let mut waveform = Eight { cycles: before, edge: marked, ..new(Slice::File, Stage::Filling) };
        assert_eq!(step(&mut waveform, 0, 1), Slice::FileFirst);
        assert_eq!(step(&mut waveform, 0, 3), Slice::Watch);
        assert_eq!(waveform.cycles, number);
        let filed = [0, 1, 2, 3].map(|place| waveform.edges[place] == marked);
        assert_eq!(filed, [0, 1, 2, 3].map(|place| places.contains(&place)), "{number}");
    }
}

/// A fault, a disturbance or a window taken: what is left of the stage, and of the work that was pending.
#[test]
fn a_window_that_is_disturbed_is_void() {
    for (stage, expected) in [
        (Stage::Filling, Stage::Void),
        (Stage::Waiting, Stage::Waiting),
        (Stage::Full, Stage::Full),
        (Stage::Void, Stage::Void),
    ] {
        let mut waveform = new(Slice::ReadingFault, stage);
        assert_eq!((step(&mut waveform, 0, 1), waveform.stage), (Slice::Watch, expected));
        for (slice, is_pending) in [
            (Slice::Open, true),
            (Slice::Direction, true),
            (Slice::Duration, true),
            (Slice::Note, true),
            (Slice::NoteBack, true),
            (Slice::Decide, false),
            (Slice::Beyond, false),
            (Slice::File, false),
        ] {
            let mut waveform = new(slice, stage);
            waveform.disturb();
            assert_eq!((waveform.stage, waveform.position.is_sure), (expected, false));
            assert_eq!(waveform.slice, if is_pending { Slice::Watch } else { slice });
            assert!(new(Slice::Watch, stage).is_watching() && !new(slice, stage).is_watching());
        }
    }
}

/// A window of at most 2^22 ticks is handed on, however late; one that lasts longer is given up. Its last ends are
/// those before the last and of the last cycle.
#[test]
fn a_window_is_taken_once() {
    const LONG: u32 = 1 << 22;
    for (stage, slice, first, last, tick, is_taken, then) in [
        (Stage::Full, Slice::Watch, 0, LONG, LONG, true, Stage::Waiting),
        (Stage::Full, Slice::Watch, 0, LONG + 1, LONG + 1, false, Stage::Waiting),
        (Stage::Full, Slice::Watch, 0, 100, 3 * LONG, true, Stage::Waiting),
        (Stage::Full, Slice::File, 0, 100, 200, false, Stage::Full),
        (Stage::Full, Slice::FileFirst, 0, 100, 200, false, Stage::Full),
        (Stage::Filling, Slice::Watch, 0, 100, LONG + 100, false, Stage::Filling),
        (Stage::Filling, Slice::Watch, 0, 100, LONG + 101, false, Stage::Waiting),
        (Stage::Waiting, Slice::Watch, 0, 2 * LONG, 4 * LONG, false, Stage::Waiting),
        (Stage::Void, Slice::Watch, 0, 100, 200, false, Stage::Waiting),
    ] {
        for cycles in 1..4 {
            let mut waveform = Eight { tick, cycles, ..new(slice, stage) };
            waveform.bins[3].ticks = 17;
            let edge = |tick| Edge { tick, ..Edge::default() };
            // an even number is the third place
            let (even, odd) = if cycles % 2 == 0 { (last, last - 1) } else { (last - 1, last) };
            waveform.edges = [edge(first), edge(first), edge(even), edge(odd)];
            let window = waveform.take();
            assert_eq!((window.is_some(), waveform.stage), (is_taken, then), "{stage:?} {slice:?} {last} {tick}");
            if let Some(window) = window {
                assert_eq!((window.edges[2].tick, window.edges[3].tick), (last - 1, last));
                assert_eq!((window.cycles, window.bins()[3].ticks), (cycles, 17));
            }
            let is_emptied = stage != Stage::Waiting && then == Stage::Waiting;
            assert_eq!(waveform.bins[3].ticks, if is_emptied { 0 } else { 17 });
            assert_eq!(waveform.take(), None);
        }
    }
    for (slice, then) in [(Slice::Note, Slice::Decide), (Slice::Beyond, Slice::Beyond)] {
        let mut waveform = new(slice, Stage::Void);
        assert_eq!((waveform.take(), waveform.slice), (None, then));
    }
}

/// Every other tick is a slice of the work, from the first on.
#[test]
fn ticks_take_turns() {
    let mut waveform = Eight::default();
    for (angle, slice) in [(0, Slice::Watch), (1 << 30, Slice::Watch), (1 << 30, Slice::Ahead), (0, Slice::Ahead)] {
        waveform.measure(&CONFIG, angle, 0.0, &Estimate::default());
        assert_eq!(waveform.slice, slice);
    }
}
