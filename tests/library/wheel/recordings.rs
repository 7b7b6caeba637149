//! Recordings of real engines, read from where they are kept: they may not be copied here (GPL-3.0).

use driveline::fluctuation::{Ripple, ToothErrors, ToothWindow};
use driveline::settings::{Teeth, ToothClock};
use driveline::wheel::{CycleTimes, ToothedWheel, ToothedWheelConfig};

use super::edges::{CLOCK, TIMING, clock};
use super::other_teeth::nothing_but;
use crate::recordings::recording;

/// Rising edges of a column (s), or all times of a list (ms).
fn edges(file: &str, column: usize) -> Option<Vec<f64>> {
    let text = std::fs::read_to_string(recording(&format!("engines/{file}"))?).unwrap();
    if file.ends_with("edges_ms") {
        return Some(text.split_whitespace().map(|time| time.parse::<f64>().unwrap() * 1e-3).collect());
    }
    let (mut last, mut edges) = (None, Vec::new());
    for line in text.lines() {
        let mut cells = line.split(',').map(str::trim);
        let time = cells.next().and_then(|cell| cell.parse::<f64>().ok());
        let (Some(time), Some(level)) = (time, cells.nth(column - 1).and_then(|cell| cell.parse::<u8>().ok())) else {
            continue;
        };
        if last == Some(0) && level == 1 {
            edges.push(time);
        }
        last = Some(level);
    }
    Some(edges)
}

/// The 36-2 wheel with a noisy pickup. Truth: the teeth counted from gap to gap, the angle even between two edges.
#[test]
fn a_noisy_pickup_gives_the_angle_from_the_second_gap_on() {
    let Some(edges) = edges("noisy-trigger-2.csv", 1) else { return };
    let teeth = Teeth::<34>::gap(36, 2);
    let config = ToothedWheelConfig::new(&teeth, TIMING);
    // The edges behind the gaps: intervals beyond 2.2 times the median of the 17 around, and below a stall's 60 ms.
    let spans: Vec<f64> = edges.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let gap = |at: &usize| {
        let mut around = spans[at.saturating_sub(8)..(at + 9).min(spans.len())].to_vec();
        around.sort_by(f64::total_cmp);
        spans[*at] > 2.2 * around[around.len() / 2] && spans[*at] < 0.06
    };
    let gaps: Vec<usize> = (0..spans.len()).filter(gap).map(|at| at + 1).collect();
    // In one turn the engine hesitates for four pitches at its third tooth; 34 edges were counted all the same.
    // Beside them 34 edges of the stall, which take longer.
    let is_turn = |first: &usize| gaps.contains(&(first + 34)) && edges[first + 34] - edges[*first] < 0.31;
    let whole: Vec<usize> = gaps.iter().copied().filter(is_turn).collect();
    assert_eq!(whole.len(), 18);
    let mut wheel = ToothedWheel::<()>::default();
    let (mut next, mut ticks, mut known, mut squares) = (0, 0, 0, 0.0);
    for tick in 0..((edges[edges.len() - 1] - edges[0]) * 1e3) as u32 {
        let now = edges[0] + f64::from(tick) * 1e-3;
        while next < edges.len() && edges[next] <= now {
            wheel.tooth(&config, clock(edges[next]));
            next += 1;
        }
        let angle = wheel.at(&config, clock(now));
        let (last, turn) = (next - 1, whole.iter().skip(1).find(|first| (**first..**first + 34).contains(&(next - 1))));
        let Some(first) = turn else { continue };
        ticks += 1;
        if let Ok(angle) = angle {
            known += 1;
            let span = if last - first == 33 { 3.0 } else { 1.0 };
            let part = (now - edges[last]) / (edges[last + 1] - edges[last]);
            let truth = ((last - first) as f64 + span * part) / 36.0;
            let error = f64::from(angle.angle) / 4_294_967_296.0 - truth;
            squares += ((error - error.round()) * 360.0).powi(2);
        }
    }
    let rms = (squares / f64::from(known)).sqrt();
    println!("{known} of {ticks} ticks, {rms} degrees");
    assert!(f64::from(known) > 0.95 * f64::from(ticks) && rms < 4.0, "{known} of {ticks}, {rms}");
}

/// The ripple of each cycle, and the edge that ends it.
fn ripples<const WHEEL: usize, const CYCLE: usize>(
    teeth: &Teeth<WHEEL>,
    turns: u32,
    edges: &[f64],
    highest: usize,
) -> Vec<(Ripple, usize)> {
    let config = ToothedWheelConfig::new(teeth, ToothClock { turns, ..TIMING });
    let mut wheel = ToothedWheel::<CycleTimes<CYCLE>>::default();
    let mut all = Vec::new();
    for (at, edge) in edges.iter().enumerate() {
        wheel.tooth(&config, (edge * CLOCK) as i64 as u32);
        if let Some(cycle) = wheel.take() {
            let mut window = ToothWindow::default();
            window.add(&config, &cycle);
            all.extend(window.ripple(&config, &ToothErrors::NONE, highest).ok().map(|ripple| (ripple, at)));
        }
    }
    all
}

/// Delta, and the amplitude of the highest order but two over the mean, by least squares over the same edges: of each
/// tooth's lateness over the cycle, `t/T = x/2 pi + c0 + sum (c_n cos n x + s_n sin n x)`, `x` the angle of the cycle.
/// The slowness is its derivative.
fn least_squares(places: &[f64], times: &[f64], highest: usize) -> [f64; 2] {
    use std::f64::consts::TAU;
    let length = times[places.len()] - times[0];
    let rows = nalgebra::DMatrix::from_fn(places.len(), 1 + 2 * highest, |at, column| {
        let x = column.div_ceil(2) as f64 * places[at];
        if column % 2 == 0 { x.cos() } else { x.sin() }
    });
    let late = nalgebra::DVector::from_fn(places.len(), |at, _| (times[at] - times[0]) / length - places[at] / TAU);
    let found = rows.svd(true, true).solve(&late, 1e-12).unwrap();
    let slowness = |x: f64| -> f64 {
        let order = |n: usize| {
            let angle = n as f64 * x;
            n as f64 * (found[2 * n - 1] * angle.cos() - found[2 * n] * angle.sin())
        };
        1.0 + TAU * (1..=highest).map(order).sum::<f64>()
    };
    let speed = |x: f64| 1.0 / slowness(x);
    let grid = || (0..2000).map(|at| TAU * f64::from(at) / 2000.0);
    let [most, least] = [grid().map(speed).fold(0.0, f64::max), grid().map(speed).fold(f64::INFINITY, f64::min)];
    let n = highest.saturating_sub(2) as f64;
    let part = |wave: fn(f64) -> f64| grid().map(|x| speed(x) * wave(n * x)).sum::<f64>() / 1000.0;
    [most - least, part(f64::cos).hypot(part(f64::sin))]
}

/// Angles of the teeth (degrees) in a cycle of turns (rad of the cycle).
fn places(teeth: &[f64], turns: u32) -> Vec<f64> {
    let turn = |turn: u32| teeth.iter().map(move |angle| f64::from(turn) + angle / 360.0);
    (0..turns).flat_map(turn).map(|angle| std::f64::consts::TAU * angle / f64::from(turns)).collect()
}

/// Three equal thirds of 12-2: speed, delta and sixth order of the last two turns.
#[test]
fn a_wheel_of_three_gaps_gives_speed_and_ripple() {
    let Some(edges) = edges("nissan_vq40_cranking-1.csv", 1) else { return };
    let teeth = Teeth::<30>::without(36, &[10, 11, 22, 23, 34, 35]);
    let all = ripples::<30, 60>(&teeth, 2, &edges, 8);
    let (ripple, end) = all.last().unwrap();
    let cycle = &edges[end - 60..=*end];
    let degrees: Vec<f64> = (0..30).map(|tooth| f64::from(tooth / 10 * 12 + tooth % 10) * 10.0).collect();
    let (speed, [delta, sixth]) =
        (2.0 * std::f64::consts::TAU / (cycle[60] - cycle[0]), least_squares(&places(&degrees, 2), cycle, 8));
    let found = ripple.speed.order(6).amplitude() / ripple.mean;
    println!("{} for {speed} rad/s, delta {} for {delta}, {found} for {sixth}", ripple.mean, ripple.motor.delta);
    // what is asked of the recordings
    assert!((ripple.mean / speed - 1.0).abs() < 1e-3, "{ripple:?}");
    assert!((ripple.motor.delta / delta - 1.0).abs() < 0.02, "{ripple:?} {delta}");
    assert!((found / sixth - 1.0).abs() < 0.02, "{ripple:?} {sixth}");
}

#[test]
fn an_additional_tooth_gives_the_speed() {
    let Some(edges) = edges("cranking_honda_k24a2_no_plugs.csv", 1) else { return };
    let all = ripples::<13, 13>(&Teeth::extra(12, 340.0), 1, &edges, 3);
    let ripple = all.last().unwrap().0;
    // 12 intervals of the last turn whose end was recorded: 318 ms.
    let last = edges.len() - 1;
    let turn = (0..12).map(|k| edges[last - k] - edges[last - k - 13]).sum::<f64>() / 12.0;
    assert!((ripple.mean * turn / std::f64::consts::TAU - 1.0).abs() < 1e-3, "{ripple:?} {turn}");
}

/// Four teeth that repeat after half a turn, as the recording has them: the speed of the last whole turn.
#[test]
fn four_uneven_teeth_give_the_speed() {
    let Some(edges) = edges("nb2-cranking-good.csv", 1) else { return };
    let all = ripples::<4, 4>(&Teeth::degrees([0.0, 110.0, 180.0, 290.0]), 1, &edges, 1);
    let (ripple, end) = *all.last().unwrap();
    let turn = edges[end] - edges[end - 4];
    println!("{} r/min", ripple.mean * 9.5493);
    assert!((ripple.mean * turn / std::f64::consts::TAU - 1.0).abs() < 1e-3, "{ripple:?} {turn}");
}

/// Every cycle of two turns on wheels of few teeth: delta against least squares over the same teeth and orders, 6 of 26
/// teeth and 2 of 8. How well these tell the engine's own delta is another matter: by the residue to a tenth.
#[test]
fn few_teeth_give_the_delta_of_their_orders() {
    let mut even: Vec<f64> = (0..12).map(|tooth| f64::from(tooth) * 30.0).chain([340.0]).collect();
    even.sort_by(f64::total_cmp);
    let uneven = [0.0, 110.0, 180.0, 290.0];
    let honda = edges("cranking_honda_k24a2_no_plugs.csv", 1)
        .map(|edges| (ripples::<13, 26>(&Teeth::extra(12, 340.0), 2, &edges, 6), edges, places(&even, 2), 6));
    let mazda = edges("nb2-cranking-good.csv", 1)
        .map(|edges| (ripples::<4, 8>(&Teeth::degrees(uneven), 2, &edges, 2), edges, places(&uneven, 2), 2));
    for (all, edges, places, highest) in honda.into_iter().chain(mazda) {
        assert!(all.len() > 1, "{}", all.len());
        let mut worst = 0.0_f64;
        for (ripple, end) in &all {
            let [delta, _] = least_squares(&places, &edges[end - places.len()..=*end], highest);
            worst = worst.max((ripple.motor.delta / delta - 1.0).abs());
        }
        println!("{} cycles, worst {worst}", all.len());
        // what is asked of the recordings
        assert!(worst < 0.02, "{worst}");
    }
}

/// Each recording under some 50 descriptions of other wheels. Kawasaki's engine with compression changes its speed by
/// a factor of two within a turn: no angle.
#[test]
fn a_recording_of_another_wheel_gives_nothing() {
    for (file, right) in [
        ("noisy-trigger-2.csv", &["36-2"][..]),
        ("nissan_vq40_cranking-1.csv", &["12-2", "36 without [10, 11, 22, 23, 34, 35]"]),
        ("cranking_honda_k24a2_no_plugs.csv", &["12+1"]),
        ("nb2-cranking-good.csv", &[]),
        ("kawasaki_no_plug.edges_ms", &["8-1"]),
        ("kawasaki_with_plug.edges_ms", &[]),
    ] {
        if let Some(edges) = edges(file, 1) {
            nothing_but(file, &edges, right);
        }
    }
}
