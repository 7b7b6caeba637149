//! Wheels that nobody listed: places of an even wheel with random teeth left out, described with as many in others.

use driveline::settings::Teeth;

use super::edges::{Random, Run};
use super::other_teeth::seen;

/// In how many turns by a place one is the other.
fn alike(one: &[usize], other: &[usize], places: usize) -> usize {
    let turned = |by: usize| {
        let mut moved: Vec<usize> = one.iter().map(|place| (place + by) % places).collect();
        moved.sort_unstable();
        moved == other
    };
    (0..places).filter(|by| turned(*by)).count()
}

/// `TEETH` of so many even places, which do not repeat within the turn.
fn drawn<const TEETH: usize>(places: usize, random: &mut Random) -> (Vec<usize>, Teeth<TEETH>) {
    loop {
        let mut kept: Vec<usize> = (0..places).collect();
        while kept.len() > TEETH {
            kept.remove(((random.even() * kept.len() as f64) as usize).min(kept.len() - 1));
        }
        if alike(&kept, &kept, places) == 1 {
            let degrees = core::array::from_fn(|tooth| 360.0 / places as f64 * kept[tooth] as f64);
            return (kept, Teeth::degrees(degrees));
        }
    }
}

/// Descriptions with the right number of teeth in wrong places: neither an angle nor a cycle.
fn wrong<const TEETH: usize>(places: usize, trials: usize, random: &mut Random) -> usize {
    let mut believed = 0;
    for _ in 0..trials {
        let (real, teeth) = drawn::<TEETH>(places, random);
        let (said, described) = drawn::<TEETH>(places, random);
        if alike(&real, &said, places) > 0 {
            continue;
        }
        let (ripple, jitter) = (0.1 * random.even(), 0.05 * random.even());
        let run = Run { speed: 13.0, ripple, order: 2.0, jitter, seed: (random.even() * 1e9) as u64 };
        let found = seen(&described, &run.edges(&teeth, 40));
        if found != [0, 0] {
            println!("{real:?} as {said:?} of {places}: {found:?}, {ripple:.3} {jitter:.3}");
            believed += 1;
        }
    }
    believed
}

#[test]
fn no_wrong_description_is_believed() {
    let mut random = Random(41);
    let believed = wrong::<10>(12, 100, &mut random)
        + wrong::<21>(24, 100, &mut random)
        + wrong::<33>(36, 100, &mut random)
        + wrong::<56>(60, 100, &mut random);
    assert_eq!(believed, 0);
}
