//! The diesel set's drive and its full plant: the verdicts on the cylinders, by the panel of the image.

use driveline_closed_loop::sensors::Encoder;
use driveline_closed_loop::units::Units;
use driveline_firmware::Words;
use driveline_firmware::scene::{Input, Scene};
use driveline_firmware::scenes::find;
use driveline_firmware::scenes::generator::cylinders::{CYLINDERS, panel};
use driveline_firmware::scenes::generator::{DIESEL, DIESEL_TORQUE, RATE_HZ, RATED_SPEED};
use driveline_lab::generator::set::{Kind, STEPS, Set};
use driveline_solver::noise::Noise;

/// Cycles at each load; `CYCLES` asks for more.
fn cycles() -> u32 {
    std::env::var("CYCLES").ok().and_then(|text| text.parse().ok()).unwrap_or(160)
}

/// A run at a load (of rated): shares and verdicts of the cylinders of each window of eight cycles, the first two left
/// out. Each combustion differs by 3 %; cylinder `weak` burns a share of its fuel.
fn windows(
    words: Words,
    load: f64,
    weak: Option<(usize, f64)>,
    cycles: u32,
    seed: u64,
) -> Vec<[(f32, u32); CYLINDERS]> {
    let number = if words == Words::Single { "f32" } else { "fixed" };
    let mut drive = find(&format!("generator/{number}/cylinders/{RATE_HZ}")).unwrap().start();
    let units = Units::new(words, DIESEL.bases());
    let mut set = Set::new(Kind::Diesel, RATED_SPEED).unwrap();
    let (encoder, mut noise) = (Encoder::new(8192), Noise::new(seed));
    let period = 1.0 / f64::from(RATE_HZ);
    let (mut found, mut seen, mut turns) = (Vec::new(), 0, 0.0);
    // six seconds until it runs under its load
    let ticks = 6 * RATE_HZ + (f64::from(cycles + 24) * 0.08 * f64::from(RATE_HZ)) as u32;
    for tick in 0..ticks {
        // a turbocharged engine takes half of its load at once
        match tick / (RATE_HZ / 2) {
            2..=4 => set.set_load(load.min(0.5)),
            5.. => set.set_load(load),
            _ => {}
        }
        let turned = (set.flywheel_angle() / std::f64::consts::TAU).floor();
        if turned > turns {
            turns = turned;
            let mut burns = std::array::from_fn(|_| 1.0 + 0.03 * noise.normal());
            if let Some((cylinder, share)) = weak {
                burns[cylinder - 1] *= share;
            }
            set.set_burns(burns);
        }
        let input = Input {
            angle: encoder.read(set.flywheel_angle()),
            torque: units.torque_word(set.told() + 0.002 * DIESEL_TORQUE * noise.normal()),
            setpoint: units.speed_word(RATED_SPEED),
            flags: if tick > 100 { Input::RELEASED } else { 0 },
            ..Input::default()
        };
        let command = units.torque(drive.tick(&input).torque);
        let mut asked = |key: u32| drive.panel([key, 0]);
        if tick % 64 == 0 && asked(panel::WINDOWS) != seen {
            seen = asked(panel::WINDOWS);
            if tick > 6 * RATE_HZ {
                found.push(std::array::from_fn(|k| {
                    let number = k as u32 + 1;
                    (f32::from_bits(asked(panel::SHARE + number)), asked(panel::VERDICT + number))
                }));
            }
        }
        for _ in 0..STEPS {
            set.step(command, period / f64::from(STEPS));
        }
    }
    found
}

/// Each cylinder in turn does not fire, at three loads: right is a misfire of that one and of no other.
#[test]
fn a_misfire_is_found() {
    let (mut right, mut all) = (0, 0);
    for (number, load) in [(Words::Single, 0.4), (Words::Fixed, 0.7), (Words::Single, 0.6)] {
        for cylinder in 1..=CYLINDERS {
            let windows = windows(number, load, Some((cylinder, 0.0)), cycles() / 2, cylinder as u64);
            let expected =
                |window: &[(f32, u32); CYLINDERS]| (0..CYLINDERS).all(|k| (window[k].1 == 3) == (k + 1 == cylinder));
            let good = windows.iter().filter(|window| expected(window)).count();
            println!("cylinder {cylinder} at {load}: {good} of {}, {:?}", windows.len(), windows.last());
            (right, all) = (right + good, all + windows.len());
        }
    }
    assert!(all > 100 && right as f64 >= 0.99 * all as f64, "{right} of {all}");
}

/// A sound engine whose cylinders differ by 2 % and whose combustions by 3 %: no misfire.
#[test]
fn a_sound_engine_has_no_misfire() {
    let mut all = 0;
    for (number, load) in [(Words::Single, 0.3), (Words::Fixed, 0.6), (Words::Single, 0.7)] {
        let windows = windows(number, load, None, cycles(), 7);
        println!("at {load}: {:?}", windows.last());
        let with =
            |word: u32| windows.iter().filter(|window| window.iter().any(|(_, verdict)| *verdict == word)).count();
        println!("at {load}: {} windows, {} with a cylinder called weak", windows.len(), with(2));
        assert_eq!(with(3), 0, "at {load}");
        all += windows.len();
    }
    println!("{all} windows of eight cycles");
    assert!(all >= 40, "{all}");
}
