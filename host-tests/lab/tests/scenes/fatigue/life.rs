//! The life of the strip mill's spindles on its panel: counted, told, kept over a power cut.

use driveline::configure::{Configure, HasLife, Machine};
use driveline::fatigue::Rainflow;
use driveline::fluctuation::Fluctuation;
use driveline::sample::Estimate;
use driveline_firmware::panel::life::{AMPLIFICATION, DAMAGE, REMAINING, SAVE, TIME_ABOVE};
use driveline_firmware::scene::panel_keys::{DONE, Key};
use driveline_firmware::scene::{Input, Scene, Variant};
use driveline_firmware::scenes::find;
use driveline_firmware::scenes::strip_mill::{Life, StripMill};

const NAME: &str = "strip-mill/f32/life/10000";

fn number(scene: &mut dyn Scene, key: u32) -> f64 {
    f32::from_bits(scene.panel([key, 0])).into()
}

/// Torque of the motor that swings the spindles at their first resonance of 10 Hz, and grows: for 12 s.
fn swung() -> (Box<dyn Scene>, Vec<f32>) {
    let mut scene = find(NAME).unwrap().start();
    let torques = (0..120_000_u32).map(|tick| {
        // the motor stands; its torque is the sample's, which alone makes the observer's shaft torque move
        let swing = (62.8 * f64::from(tick) * StripMill::PERIOD).sin() * f64::from(tick) / 120_000.0;
        let torque = (2.0 * StripMill::RATING.torque.0 * swing) as f32;
        let input = Input { torque: torque.to_bits(), flags: Input::RELEASED, ..Input::default() };
        f32::from_bits(scene.exchange(&input).shaft_torque)
    });
    let torques = torques.collect();
    (scene, torques)
}

/// What the flash of one holds, into that of another.
fn copy_flash(from: &mut dyn Scene, to: &mut dyn Scene) {
    for word in 0..512 {
        let content = from.panel([Key::FlashWord as u32, word]);
        to.panel([Key::PutPlace as u32, word]);
        assert_eq!(to.panel([Key::PutWord as u32, content]), DONE);
    }
}

/// What is taken once a second and closed at the end is the damage of one count over the whole run, and of Miner's sum
/// over the count's classes; the record brings it over a power cut.
#[test]
fn the_damage_is_that_of_the_whole_count_and_survives_a_power_cut() {
    let (mut scene, torques) = swung();
    let config = <Rainflow<128> as Configure<StripMill, f32>>::CONFIG;
    let mut count = Rainflow::<128, f32>::default();
    for &shaft_torque in &torques {
        count.measure(&config, 0, 0.0, &Estimate { shaft_torque, ..Estimate::default() });
    }
    let counts = count.counts(&config);
    let line = StripMill::SHAFT;
    let miner = |range: f64| (0.5 * range * config.width() / line.knee).powf(line.slope) / line.cycles;
    let cycles: f64 = (0_u32..).zip(counts.cycles()).map(|(range, &n)| f64::from(n) * miner(range.into())).sum();
    let halves: f64 = counts.residue().windows(2).map(|pair| 0.5 * miner(pair[0].abs_diff(pair[1]).into())).sum();
    assert!(counts.cycles().iter().sum::<u32>() > 50 && cycles > 0.0 && halves > 0.0);

    assert_eq!(scene.panel([SAVE, 0]), DONE);
    let largest = torques.iter().fold(0.0_f32, |largest, torque| largest.max(torque.abs()));
    let expected = [
        (DAMAGE, cycles + halves),
        (REMAINING, 1.0 - cycles - halves),
        (AMPLIFICATION, f64::from(largest) / StripMill::RATING.torque.0),
        (TIME_ABOVE, counts.time_above(StripMill::OVERLOAD)),
    ];
    let mut again = find(NAME).unwrap().start();
    assert_eq!(number(&mut *again, DAMAGE), 0.0);
    copy_flash(&mut *scene, &mut *again);
    assert_eq!(again.panel([Key::Resume as u32, 0]), DONE);
    let channels = <driveline_firmware::scene::Of<StripMill, Life<f32>> as Variant>::CHANNELS;
    assert_eq!(channels.len(), expected.len());
    for (index, (key, value)) in expected.into_iter().enumerate() {
        // an f32 on the panel
        let close = |number: f64| (number - value).abs() <= 1e-7 * value.abs();
        assert!(close(number(&mut *scene, key)) && close(number(&mut *again, key)), "{key}: {value}");
        assert!(close(f32::from_bits(again.channel(index)).into()), "{}", channels[index].name);
    }
}

/// What was counted before the record is resumed stays, and the record is added once: by a resume, by more of them, or
/// by the save alone. The same run twice does twice the damage.
#[test]
fn a_resume_adds_the_record_to_what_has_been_counted() {
    let (mut first, _) = swung();
    assert_eq!(first.panel([SAVE, 0]), DONE);
    let [damage, time] = [DAMAGE, TIME_ABOVE].map(|key| number(&mut *first, key));
    assert!(damage > 0.0 && time > 0.0);
    for resumes in 0..3 {
        let (mut again, _) = swung();
        copy_flash(&mut *first, &mut *again);
        (0..resumes).for_each(|_| assert_eq!(again.panel([Key::Resume as u32, 0]), DONE));
        assert_eq!(again.panel([SAVE, 0]), DONE);
        assert_eq!(again.panel([Key::Resume as u32, 0]), DONE);
        // an f32 on the panel, either of them
        for (key, once) in [(DAMAGE, damage), (TIME_ABOVE, time)] {
            let twice = number(&mut *again, key);
            assert!((twice / (2.0 * once) - 1.0).abs() < 2e-7, "{resumes} resumes: {twice} of {once}");
        }
    }
}
