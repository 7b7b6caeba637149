//! Learnt and stored values over a restart: all of them different, each read back by its name.
//!
//! A swap in the writer and one in the reader would hide each other, so the record is also written here from the layout
//! of postcard. The corrected angle is compared with one that is corrected here.

use crate::flash::Flash;
use crate::hoist::Hoist;

use driveline::configure::Machine;
use driveline::drive::{ConfigOf, Drive};
use driveline::fatigue::LifeRecord;
use driveline::governor::SpeedLoop;
use driveline::learning::{
    EccentricityConfig, EccentricityObserver, GearLoss, GearLossConfig, Learnt, RunUp, RunUpConfig, TorqueCalibration,
    TorqueConstant, TorqueConstantConfig,
};
use driveline::observer::{GearedObserver, SemiImplicitObserver};
use driveline::parameters::{Parameters, Store};
use driveline::sample::Sample;
use serde::{Deserialize, Serialize};

type M = Hoist<10_000>;

/// Saves, forgets the store, and loads from the flash; the content of the record beside.
fn restarted<P: Parameters>(parameters: &P, length: usize) -> (P, Vec<u8>) {
    let mut flash = Flash::<1, 4>::erased();
    Store::new(&mut flash, 0..4096).unwrap().save(parameters, &mut [0; 512]).unwrap();
    let begin = flash.0.windows(4).position(|four| four == b"DLP1").unwrap() + 18;
    let content = flash.0[begin..begin + length].to_vec();
    let loaded = Store::new(&mut flash, 0..4096).unwrap().load(&mut [0; 512]).unwrap();
    (loaded.parameters.unwrap(), content)
}

#[derive(Serialize, Deserialize)]
struct Kept(Learnt);

impl Parameters for Kept {
    const IDENTITY: u32 = 7;
    const VERSION: u16 = 1;
}

const LEARNT: Learnt =
    Learnt { friction: 0.031, eccentricity: [521_000, -187_000], torque: [-0.023, 4.5], inertia: 0.079 };

/// As a varint of postcard: zigzag, seven bits a byte, the least significant ones first.
fn varint(value: i32) -> Vec<u8> {
    let mut left = ((value << 1) ^ (value >> 31)) as u32;
    let mut bytes = Vec::new();
    while left > 127 {
        bytes.push(left as u8 | 128);
        left >>= 7;
    }
    bytes.push(left as u8);
    bytes
}

#[test]
fn learnt_values_are_read_back_by_name() {
    let mut content = LEARNT.friction.to_le_bytes().to_vec();
    LEARNT.eccentricity.iter().for_each(|&value| content.extend(varint(value)));
    for value in [LEARNT.torque[0], LEARNT.torque[1], LEARNT.inertia] {
        content.extend(value.to_le_bytes());
    }
    let (Kept(loaded), found) = restarted(&Kept(LEARNT), content.len());
    assert_eq!(found, content);
    assert_eq!(loaded.friction.to_bits(), LEARNT.friction.to_bits());
    assert_eq!(loaded.eccentricity, [521_000, -187_000]);
    assert_eq!(loaded.torque.map(f32::to_bits), LEARNT.torque.map(f32::to_bits));
    assert_eq!(loaded.inertia.to_bits(), LEARNT.inertia.to_bits());
    // and each learner goes on from its own
    const EFFICIENCY: [f64; 2] = [0.85, 0.99];
    let loss = GearLoss::new(&GearLossConfig::new(750.0, 155.0, EFFICIENCY, 0.01), loaded.friction);
    let (gain, offset) = (1.0 + loaded.torque[0], loaded.torque[1]);
    let torque = TorqueConstant::new(&TorqueConstantConfig::new(750.0, 155.0, EFFICIENCY, 0.01), gain, offset);
    let inertia = RunUp::new(&RunUpConfig::new(750.0, 155.0, [0.5, 2.5], 0.01), 1.0 + loaded.inertia);
    assert_eq!((loss.friction(), torque.gain(), torque.offset()), (0.031, 1.0 - 0.023, 4.5));
    assert_eq!(inertia.inertia(), 1.0 + 0.079);
    // 100 N m less 2.3 %, and 4.5 N m; the coefficient has 24 places
    assert!((TorqueCalibration::<f32>::new(gain, offset).torque(100.0) - 102.2).abs() < 1e-4);
}

#[test]
fn a_life_is_read_back_by_name() {
    let life = LifeRecord { damage: 0.125, time_above: 3600.5, largest: 1480.0 };
    let content: Vec<u8> = [0.125_f64, 3600.5, 1480.0].into_iter().flat_map(f64::to_le_bytes).collect();
    let (loaded, found) = restarted(&life, content.len());
    assert_eq!(found, content);
    assert_eq!((loaded.damage, loaded.time_above, loaded.largest), (0.125, 3600.5, 1480.0));
}

type Corrected = Drive<f32, EccentricityObserver<GearedObserver<SemiImplicitObserver>>, SpeedLoop>;
type Plain = Drive<f32, GearedObserver<SemiImplicitObserver>, SpeedLoop>;

static BOUND: EccentricityConfig = EccentricityConfig::new(&M::OBSERVER, 0.1 * core::f64::consts::PI / 180.0, 0.4);
static CORRECTED: ConfigOf<Corrected> = Corrected::configure::<M>();
static PLAIN: ConfigOf<Plain> = Plain::configure::<M>();

/// Angles (2^-32 turn) of a motor at 60 rad/s that swings.
fn angle(tick: u32) -> u32 {
    let time = f64::from(tick) * 1e-4;
    let turned = 60.0 * time + 0.2 * (9.0 * time).sin();
    (turned / core::f64::consts::TAU * 4_294_967_296.0) as u64 as u32
}

/// Bits of the commands with an eccentricity that was restored.
fn commands(eccentricity: [i32; 2]) -> Vec<f32> {
    let mut drive = Corrected::new(&CORRECTED, 0);
    drive.observer_mut().restore(&BOUND, eccentricity);
    assert_eq!(drive.observer().eccentricity(), eccentricity);
    (0..4000).map(|tick| drive.tick(&CORRECTED, &Sample::si::<M>(angle(tick), 40.0, 60.0)).torque_si::<M>()).collect()
}

/// The same command bit for bit after a restart; and that of a drive whose angle is corrected by `a cos + b sin`
/// beforehand, but for the cosine at the last tick's angle, 0.006 rad away, and its rounding. Swapped, the commands
/// differ by far more.
#[test]
fn a_restored_eccentricity_commands_as_before() {
    let (Kept(loaded), _) = restarted(&Kept(LEARNT), 1);
    let [before, after] = [LEARNT, loaded].map(|learnt| commands(learnt.eccentricity));
    assert!(before.iter().zip(&after).all(|(a, b)| a.to_bits() == b.to_bits()));
    let [a, b] = LEARNT.eccentricity;
    let swapped = commands([b, a]);
    let mut drive = Plain::new(&PLAIN, 0);
    let (mut off, mut apart) = (0.0_f32, 0.0_f32);
    for tick in 0..4000 {
        let measured = angle(tick);
        let (sine, cosine) = (f64::from(measured) / 4_294_967_296.0 * core::f64::consts::TAU).sin_cos();
        let error = f64::from(a) * cosine + f64::from(b) * sine;
        let corrected = measured.wrapping_sub(error as i32 as u32);
        let command = drive.tick(&PLAIN, &Sample::si::<M>(corrected, 40.0, 60.0)).torque_si::<M>();
        // the drives begin at angle 0, one of them less its error: a start of 0.1 s to forget
        if tick >= 1000 {
            off = off.max((command - after[tick as usize]).abs());
            apart = apart.max((command - swapped[tick as usize]).abs());
        }
    }
    println!("off by {off} N m, swapped by {apart} N m");
    assert!(off < 0.05 * apart, "{off} {apart}");
}
