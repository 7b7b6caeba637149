//! The bench's inputs take every path of the observer's step.

use driveline::configure::Machine as _;
use driveline::number::Fixed;
use driveline::observer::{BacklashObserver, Gap, Observer};
use driveline_firmware::scene::Of;
use driveline_firmware::scene::composed::GovernedVariant;
use driveline_firmware::scenes::blooming_mill::{Backlash, BloomingMill};
use driveline_firmware::self_test::backlash_inputs::Rattle;

type Mill<N> = Of<BloomingMill, Backlash<N>>;

/// How often the gap was open or closed before a tick (first) and by its prediction after it (second), over what the
/// bench runs.
fn paths<N, V>(number: impl Fn(f32) -> N) -> [[u32; 2]; 2]
where
    N: Gap,
    V: GovernedVariant<Number = N, Observer = BacklashObserver>,
{
    let config = &V::CONFIG.observer;
    let mut observer: BacklashObserver<N> = BacklashObserver::at_rest(config, 0, N::ZERO);
    let mut rattle = Rattle::new();
    let mut counts = [[0; 2]; 2];
    for _ in 0..1001 {
        let (angle, torque) = rattle.next_input();
        let mut predicted = observer;
        let prediction = observer.predict(config, angle, number(torque));
        predicted.coast(prediction, angle);
        counts[usize::from(observer.is_open(config))][usize::from(predicted.is_open(config))] += 1;
        observer.step(config, angle, number(torque));
    }
    counts
}

#[test]
fn the_bench_takes_every_path() {
    let single = paths::<f32, Mill<f32>>(|torque| torque);
    let fixed = paths::<Fixed, Mill<Fixed>>(|torque| Fixed::from_f64(f64::from(torque) / BloomingMill::BASES.torque));
    for counts in [single, fixed] {
        // In contact, leaving, meeting, in the gap.
        assert!(counts.iter().flatten().all(|&count| count > 0), "{single:?} {fixed:?}");
    }
}
