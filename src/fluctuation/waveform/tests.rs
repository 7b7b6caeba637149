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

/// Every other tick is a slice of the work, from the first on.
#[test]
fn ticks_take_turns() {
    let mut waveform = Eight::default();
    for (angle, slice) in [(0, Slice::Watch), (1 << 30, Slice::Watch), (1 << 30, Slice::Ahead), (0, Slice::Ahead)] {
        waveform.measure(&CONFIG, angle, 0.0, &Estimate::default());
        assert_eq!(waveform.slice, slice);
    }
}
