//! Single steps of the observers.

use driveline::angle::RotorAngleConfig;
use driveline::number::{Coefficient, Fixed, Number};
use driveline::observer::{
    BacklashConfig, BacklashObserver, Contact, FreeFlight, GapCorrection, GearFriction, GearedConfig, GearedObserver,
    MechanismConfig, MechanismObserver, Observer, RigidConfig, RigidObserver, SemiImplicitConfig, SemiImplicitObserver,
    TABLE_POINTS, TablePoint, TwoMassConfig, TwoMassObserver,
};

use super::UNIT;

/// Shaft torque: the load's torque, and the load's share of the torque that accelerates.
#[test]
fn the_rigid_shaft_carries_the_loads_share_of_the_accelerating_torque() {
    let mut rigid = RigidObserver::<f64>::steady(&UNIT, 0, 4.0, 0.0);
    assert_eq!(rigid.estimate(&UNIT).shaft_torque, 4.0);
    // 12 - 4 = 8 accelerate, a quarter of it through the shaft
    let predicted = rigid.predict(&UNIT, 4, 12.0);
    rigid.correct(&UNIT, predicted, 4);
    assert_eq!(rigid.estimate(&UNIT).shaft_torque, 6.0);
    assert_eq!(rigid.estimate(&UNIT).motor_speed, 8.0);
    // coasting with -4 N m: -8 accelerate
    let predicted = rigid.predict(&UNIT, 4, -4.0);
    rigid.coast(predicted, 4);
    assert_eq!(rigid.estimate(&UNIT).shaft_torque, 2.0);
    assert_eq!(rigid.estimate(&UNIT).motor_speed, 0.0);
}

const SEMI_IMPLICIT: SemiImplicitConfig<f64> = SemiImplicitConfig {
    motor: 0.5,
    load: 0.25,
    shaft: [3.0, 5.0],
    turn: 1.0,
    correction: [0.0; 4],
    angle_correction: 0.0,
    speed: 1.0,
};

/// One step by hand: speeds first, then the shaft's torque from the new twist rate and, by its damping, from the old.
#[test]
fn a_semi_implicit_step_is_the_one_on_paper() {
    let mut observer = SemiImplicitObserver::<f64>::steady(&SEMI_IMPLICIT, 0, 8.0, 100.0);
    observer.step(&SEMI_IMPLICIT, 0, 16.0);
    let first = observer.estimate(&SEMI_IMPLICIT);
    // motor 100 + (16 - 8)/2, load 100 + (8 - 8)/4, shaft 8 + 3 (104 - 100) + 5 (100 - 100)
    assert_eq!((first.motor_speed, first.load_speed, first.shaft_torque), (104.0, 100.0, 20.0));
    observer.step(&SEMI_IMPLICIT, 0, 16.0);
    let second = observer.estimate(&SEMI_IMPLICIT);
    // motor 104 + (16 - 20)/2, load 100 + (20 - 8)/4, shaft 20 + 3 (102 - 103) + 5 (104 - 100)
    assert_eq!((second.motor_speed, second.load_speed, second.shaft_torque), (102.0, 103.0, 37.0));
    assert_eq!(second.load_torque, 8.0);
}

/// Twice the base, where fixed point saturates: 2^29 units less one.
const TWICE: i32 = (1 << 29) - 1;

#[test]
fn the_semi_implicit_states_saturate_at_twice_their_base_and_say_so() {
    let half = Coefficient::from_f64(0.499).unwrap();
    let config = SemiImplicitConfig::<Fixed> {
        motor: half,
        load: Coefficient::ZERO,
        shaft: [Coefficient::ZERO; 2],
        turn: Coefficient::ZERO,
        correction: [Coefficient::ZERO; 4],
        angle_correction: Coefficient::ZERO,
        speed: Coefficient::ZERO,
    };
    let base = Fixed::from_bits(1 << 28);
    let mut observer = SemiImplicitObserver::<Fixed>::at_rest(&config, 0, Fixed::ZERO);
    let mut seen = Vec::new();
    for _ in 0..8 {
        observer.step(&config, 0, base);
        seen.push((observer.estimate(&config).motor_speed.to_bits(), observer.beyond_base()));
    }
    // 0.499 of a base a step: two stay within it, four within twice of it
    assert!(seen[1].0 < 1 << 28 && seen[1].1 == 0, "{seen:?}");
    assert!(seen[2].0 > 1 << 28 && seen[2].1 == 1, "{seen:?}");
    assert!((TWICE - 1..=TWICE).contains(&seen[7].0) && seen[7].1 == 1, "{seen:?}");
    // and a coast saturates as a correction does
    let predicted = observer.predict(&config, 0, base);
    observer.coast(predicted, 0);
    assert!((TWICE - 1..=TWICE).contains(&observer.estimate(&config).motor_speed.to_bits()));
}

const ZERO: Coefficient = Coefficient::ZERO;

/// Nothing moves them.
const RIGID: RigidConfig<Fixed> = RigidConfig {
    acceleration: ZERO,
    turn: ZERO,
    correction: [ZERO; 2],
    angle_correction: ZERO,
    speed: ZERO,
    load_share: ZERO,
};
const TWO_MASSES: TwoMassConfig<Fixed> = TwoMassConfig {
    forcing: [ZERO; 2],
    twist: [ZERO; 3],
    twist_rate: [ZERO; 3],
    acceleration: ZERO,
    turn: [ZERO; 2],
    correction: [ZERO; 4],
    angle_correction: ZERO,
    speed: ZERO,
    share: [ZERO; 2],
    shaft: [ZERO; 2],
    compliance: ZERO,
};

/// 150 units times 0.01 and the rounding half make 2 units and leave nothing over. A quarter of the 2 is then half a
/// unit of turn, which nothing rounds up: a sum begins with what the one before it has left.
#[test]
fn a_sum_takes_over_what_the_one_before_has_left() {
    let config = TwoMassConfig::<Fixed> {
        acceleration: Coefficient::from_f64(0.01).unwrap(),
        turn: [Coefficient::from_f64(0.25).unwrap(), ZERO],
        ..TWO_MASSES
    };
    let mut observer = TwoMassObserver::<Fixed>::at_rest(&config, 0, Fixed::ZERO);
    // 0.01 in parts of 2^32 lies above a hundredth: 151 units would leave 0.01, 150 leave 1e-8
    let predicted = observer.predict(&config, 0, Fixed::from_bits(150));
    assert_eq!(predicted.turn().to_bits(), 0);
    observer.correct(&config, predicted, 0);
    assert_eq!(observer.estimate(&config).motor_speed.to_bits(), 2);
}

fn geared(stiction_gain: f64) -> GearedConfig<f64, RigidConfig<f64>> {
    let observer = RigidConfig { correction: [0.5, 0.0], ..UNIT };
    let friction = GearFriction { share: 0.125, excess: 0.0 };
    GearedConfig { observer, friction, stiction_gain, deadband: 10.0 }
}

/// The gear's loss is an eighth of the shaft's torque and opposes the motion, whatever the shaft's sign.
#[test]
fn a_gear_takes_its_loss_against_the_motion() {
    let config = geared(16.0);
    for (speed, shaft, expected) in [(50.0, 8.0, -1.0), (-50.0, 8.0, 1.0), (50.0, -8.0, -1.0), (-50.0, -8.0, 1.0)] {
        let mut observer = GearedObserver::<RigidObserver<f64>>::steady(&config, 0, shaft, speed);
        // the shaft's torque is applied, so that the loss alone accelerates
        let predicted = observer.predict(&config, 0, shaft);
        observer.coast(predicted, 0);
        assert_eq!(observer.estimate(&config).motor_speed, speed + expected, "{speed} rad/s, {shaft} N m");
    }
}

/// At a constant speed the motor carries T/eta while it drives the load and eta T while the load drives it, whatever
/// the efficiency: the shaft torque is T either way.
#[test]
fn the_torque_behind_a_gear_is_right_in_both_directions() {
    use driveline::design::{Disturbance, Encoder, Rate};
    use driveline::machine::{Damping, Inertia, Stiffness, TwoMass};
    use driveline::settings::{Bases, Gear};
    let machine = TwoMass::new(Inertia(0.6), Inertia(0.8), Stiffness(5e3), Damping(3.0));
    let disturbance = Disturbance { torque_accuracy: 5.0, load_torque_step: 300.0, within: 0.1 };
    let design = machine.observer(Rate::hz(1000), Encoder::lines(2048), disturbance);
    let observer = TwoMassConfig::<f64>::new(&design, Bases::SI);
    for efficiency in [0.99, 0.94, 0.8, 0.6, 0.5] {
        let gear = Gear { efficiency, inertia: 0.6, deadband: 0.0 };
        let config = GearedConfig::<f64, _>::new(observer, &gear, 1e-3, Bases::SI);
        for (speed, torque) in [(20.0, 300.0 / efficiency), (-20.0, 300.0 * efficiency)] {
            let mut observer = GearedObserver::<TwoMassObserver<f64>>::steady(&config, 0, 0.0, speed);
            for tick in 1..5000 {
                let turns = speed * 1e-3 * f64::from(tick) / core::f64::consts::TAU;
                observer.step(&config, (turns * 4_294_967_296.0) as i64 as u32, torque);
            }
            let estimate = observer.estimate(&config);
            // an angle is truncated to 2^-32 turn, which its gain takes for 1e-4 N m
            for found in [estimate.shaft_torque, estimate.load_torque] {
                assert!((found - 300.0).abs() < 1e-3, "{efficiency} {speed}: {found}");
            }
            let held = GearedObserver::<TwoMassObserver<f64>>::at_rest(&config, 0, 300.0).estimate(&config);
            // a series of which two terms are taken
            let excess = 1.0 - 2.0 * efficiency / (1.0 + efficiency * efficiency);
            assert!(
                (held.shaft_torque - 300.0).abs() < 300.0 * excess.powi(3) + 1e-9,
                "{efficiency}: {}",
                held.shaft_torque
            );
        }
    }
}

/// A gear that holds: what is applied beyond the shaft's torque, up to the loss, moves nothing.
#[test]
fn a_held_gear_does_not_move_and_does_not_learn_from_the_deadband() {
    let config = geared(16.0);
    let mut held = GearedObserver::<RigidObserver<f64>>::at_rest(&config, 0, 8.0);
    // half the loss: it holds, and an angle within the deadband corrects nothing
    held.step(&config, 9, 8.5);
    assert_eq!(held.estimate(&config).motor_speed, 0.0);
    // beyond the deadband it does: half of the further 3 and of the 9, a thirty-second part of which has decayed
    held.step(&config, 12, 8.5);
    assert_eq!(held.estimate(&config).motor_speed, (3.0 + 9.0 * 31.0 / 32.0) / 2.0);
    // more than the loss breaks it loose: 2 less 1 accelerate, and an innovation of 9 - 1/2 corrects by half of it
    let mut loose = GearedObserver::<RigidObserver<f64>>::at_rest(&config, 0, 8.0);
    loose.step(&config, 9, 10.0);
    assert_eq!(loose.estimate(&config).motor_speed, 1.0 + 8.5 / 2.0);
}

/// A turn within the deadband is twist of the motor's own shaft: after 100 held ticks (31/32)^100 of it is left, a
/// twenty-fourth part, which the tick that breaks the gear loose corrects by.
#[test]
fn the_residual_of_a_held_gear_decays() {
    let left = (31.0_f64 / 32.0).powi(100);
    let config = geared(16.0);
    let mut held = GearedObserver::<RigidObserver<f64>>::at_rest(&config, 0, 8.0);
    (0..100).for_each(|_| held.step(&config, 9, 8.5));
    assert_eq!(held.estimate(&config).motor_speed, 0.0);
    held.step(&config, 9, 10.0);
    // 2 less 1 accelerate, by which the motor turns by 1/2; a hundred roundings are below 1e-13
    assert!((held.estimate(&config).motor_speed - (1.0 + (9.0 * left - 0.5) / 2.0)).abs() < 1e-12);

    let friction = Coefficient::from_f64(0.125).unwrap();
    let observer = RigidConfig { correction: [friction, ZERO], ..RIGID };
    for turned in [1_i32 << 20, -(1 << 20)] {
        let friction = GearFriction { share: friction, excess: ZERO };
        let config = GearedConfig { observer, friction, stiction_gain: (), deadband: Fixed::from_bits((1 << 20) + 1) };
        let mut held = GearedObserver::<RigidObserver<Fixed>>::at_rest(&config, 0, Fixed::ONE);
        (0..100).for_each(|_| held.step(&config, turned as u32, Fixed::ONE));
        assert_eq!(held.estimate(&config).motor_speed, Fixed::ZERO);
        let rest = held.predict(&config, turned as u32, Fixed::ONE).innovation().to_bits();
        // each tick rounds by less than a unit, of which 32 remain in the sum
        assert!((f64::from(rest) - f64::from(turned) * left).abs() < 32.0, "{rest} of {turned}");
    }
}

/// A motor that turns by a unit in every fourth tick, under a torque that the gear would hold: less than a
/// thirty-second part of the deadband in a tick, yet within two deadbands, 80 ticks, it is followed.
#[test]
fn a_slow_motion_of_a_gear_that_does_not_hold_is_followed() {
    let config = geared(16.0);
    let mut moving = GearedObserver::<RigidObserver<f64>>::at_rest(&config, 0, 8.0);
    let mut speeds = (0..80).map(|tick| {
        moving.step(&config, tick / 4, 8.5);
        moving.estimate(&config).motor_speed
    });
    assert!(speeds.any(|speed| speed > 0.0));
}

fn cranked(points: [TablePoint<f64>; TABLE_POINTS]) -> MechanismConfig<f64> {
    MechanismConfig { rigid: UNIT, turning: RotorAngleConfig::new(1, 1).unwrap(), points, tool: [] }
}

const FLAT: TablePoint<f64> = TablePoint { inertia_ratio: 1.0, inertia_slope: 0.0 };

/// Between the last place of the table and the first the crank goes over its zero.
#[test]
fn the_table_of_a_crank_closes() {
    let mut points = [FLAT; TABLE_POINTS];
    points[TABLE_POINTS - 1].inertia_ratio = 3.0;
    let config = cranked(points);
    let place = 1_u32 << 26;
    for (at, ratio) in [(-2, 1.0), (-1, 3.0), (0, 1.0)] {
        let crank_angle = place.wrapping_mul(at as u32);
        let mut observer = MechanismObserver::<f64>::at_rest(&config, 0, 0.0);
        observer.home(&config, crank_angle);
        observer.step(&config, 0, 1.0);
        let speed = observer.estimate(&config).motor_speed;
        // the angle in the table has 2^-26 turns of resolution, 2^-20 of a place
        assert!((speed - ratio).abs() < 1e-5, "{at}: {speed}");
        observer = MechanismObserver::<f64>::at_rest(&config, 0, 0.0);
        observer.home(&config, crank_angle.wrapping_add(place / 2));
        observer.step(&config, 0, 1.0);
        let speed = observer.estimate(&config).motor_speed;
        let between = if at == 0 { 1.0 } else { 2.0 };
        assert!((speed - between).abs() < 1e-5, "after {at}: {speed}");
    }
}

/// With twice the inverse inertia, the crank itself gives as much torque as the motor; the shaft feels all but that.
#[test]
fn a_crank_that_coasts_goes_on_and_one_that_starts_anew_keeps_its_angle() {
    let config = cranked([TablePoint { inertia_ratio: 2.0, ..FLAT }; TABLE_POINTS]);
    let mut observer = MechanismObserver::<f64>::at_rest(&config, 0, 0.0);
    observer.home(&config, 1 << 30);
    let predicted = observer.predict(&config, 0, 4.0);
    observer.coast(predicted, 0);
    // 8 N m accelerate an inertia of one; 4 - 8 remain for the crank; a quarter of 8 is the load's share
    assert_eq!(observer.estimate(&config).motor_speed, 8.0);
    assert_eq!(observer.estimate(&config).shaft_torque, 2.0 - 4.0);
    assert!(observer.crank_angle(&config).abs_diff(1 << 30) < 1 << 7, "a coast has no angle to follow");
    // half a turn later it starts anew, at 5 rad/s and 3 N m
    observer.restart(&config, 1 << 31, 3.0, 5.0);
    let estimate = observer.estimate(&config);
    assert_eq!((estimate.motor_speed, estimate.shaft_torque, estimate.load_torque), (5.0, 3.0, 3.0));
    let crank = observer.crank_angle(&config);
    assert!(crank.abs_diff((1 << 30) + (1 << 31)) < 1 << 7, "{crank:#x}");
    assert_eq!(observer.angle(), 1 << 31);
}

/// A crank behind a gear of 5 to 2, turned backwards over its zero and forwards again.
#[test]
fn a_crank_behind_a_gear_turns_back_over_its_zero() {
    let config = MechanismConfig { turning: RotorAngleConfig::new(2, 5).unwrap(), ..cranked([FLAT; TABLE_POINTS]) };
    let mut observer = MechanismObserver::<f64>::at_rest(&config, 0, 0.0);
    observer.home(&config, 0);
    let mut motor = 0_i64;
    // two turns of the motor back in steps of 0.3 turn, three forwards: 0.8 and 1.2 turns of the crank
    let steps = [-3_i64; 7].into_iter().chain([3; 10]);
    for step in steps {
        let turned = step * (1 << 32) / 10;
        motor += turned;
        let angle = motor as u32;
        let predicted = observer.predict(&config, angle, 0.0);
        observer.correct(&config, predicted, angle);
        let expected = (motor * 2 / 5) as u32;
        let off = observer.crank_angle(&config).wrapping_sub(expected) as i32;
        // 2^-26 turns of resolution, and the motor's angle times 2/5 cut to whole units
        assert!(off.abs() < 1 << 8, "{motor}: {off}");
    }
}

/// Half a gap of one; the forcing is the motor's torque less the load's.
const BACKLASH: BacklashConfig<f64> = BacklashConfig {
    forcing: [1.0, -1.0],
    half_gap: 1.0,
    contact: Contact { twist: [-0.25, 2.0, 0.5], twist_rate: [-0.5, 0.25, 0.5], leaving: [2.0, 3.0, -0.5] },
    free: FreeFlight { twist: [1.0, 0.5], twist_rate: 0.0, meeting: [2.0, 3.0, 0.25] },
    acceleration: 1.0,
    turn: [0.5, 0.25],
    settled: GapCorrection { states: [0.0; 4], angle: 0.0 },
    searching: GapCorrection { states: [0.5, 0.0, 0.0, 0.0], angle: 0.0 },
    hold: 2,
    speed: 1.0,
    share: [0.5, -0.5],
    shaft: [4.0, 2.0],
    compliance: 0.25,
};

/// Twist, motor speed, shaft torque, load torque.
fn seen(observer: &BacklashObserver<f64>) -> [f64; 4] {
    let estimate = observer.estimate(&BACKLASH);
    [observer.twist(), estimate.motor_speed, estimate.shaft_torque, estimate.load_torque]
}

/// One step without a correction; the turn that it predicts.
fn glide(observer: &mut BacklashObserver<f64>, torque: f64) -> f64 {
    let predicted = observer.predict(&BACKLASH, 0, torque);
    let turn = predicted.turn();
    observer.coast(predicted, 0);
    turn
}

/// A shaft in contact on either side: 8 N m stretch it by 2 beyond half the gap.
#[test]
fn a_stretched_shaft_moves_about_its_flank() {
    for side in [1.0, -1.0] {
        let mut observer = BacklashObserver::<f64>::steady(&BACKLASH, 0, side * 8.0, side * 100.0);
        assert_eq!(seen(&observer), [3.0, 100.0, 8.0, 8.0].map(|x| side * x));
        // 4 accelerate: twist 3 - 2/4 + 4/2, rate -2/2 + 4/2; mean speed 104, half of the rate above it
        assert_eq!(glide(&mut observer, side * 12.0), side * (0.5 * 204.0 + 0.25 * 1.5));
        assert_eq!(seen(&observer), [4.5, 104.5, 4.0 * 3.5 + 2.0, 8.0].map(|x| side * x));
        // and with the rate of 1: twist 4.5 - 3.5/4 + 2, rate 1 - 3.5/2 + 1/4
        glide(&mut observer, side * 8.0);
        assert_eq!(seen(&observer), [5.625, 103.75, 4.0 * 4.625 - 1.0, 8.0].map(|x| side * x));
    }
    assert_eq!(BacklashObserver::<f64>::steady(&BACKLASH, 0, 0.0, 5.0).twist(), 0.0);
}

/// A twist that passes a flank is put right by how far, and by that times the share of the tick that it took.
#[test]
fn a_flank_that_is_met_or_left_within_a_tick_puts_the_motion_right() {
    for side in [1.0, -1.0] {
        // 3 - 2/4 - 7/2 is 2 behind the flank, of 4 travelled: 4/4 passed, against the motion
        let mut observer = BacklashObserver::<f64>::steady(&BACKLASH, 0, side * 8.0, 0.0);
        glide(&mut observer, side);
        // rate -2/2 - 7/2 - 2 (2) - 3 (1); mean speed -7; the gap is open
        assert_eq!(seen(&observer), [-0.5, -7.0 - 5.75, 0.0, 8.0].map(|x| side * x));
        assert!(observer.is_open(&BACKLASH));
        // a quarter of the gap first, without a contact; then 0.5 + 4/2 is 1.5 beyond, of 2 travelled: 9/8 passed
        let mut observer = BacklashObserver::<f64>::at_rest(&BACKLASH, 0, 0.0);
        glide(&mut observer, side);
        assert_eq!(seen(&observer), [0.5, 1.0, 0.0, 0.0].map(|x| side * x));
        glide(&mut observer, side * 4.0);
        let (twist, rate) = (2.5 + 0.25 * 1.125, 2.0 * 1.5 + 3.0 * 1.125);
        assert_eq!(seen(&observer), [twist, 5.0 + 0.5 * rate, 4.0 * (twist - 1.0) + 2.0 * rate, 0.0].map(|x| side * x));
    }
}

/// The searching gains stand in the gap, and after a start for two ticks, of which the second is the last.
#[test]
fn the_searching_gains_stand_in_the_gap_and_for_their_ticks_after_it() {
    // a shaft that stays as it is stretched
    let contact = Contact { twist: [0.0; 3], twist_rate: [0.0; 3], ..BACKLASH.contact };
    let config = BacklashConfig { contact, ..BACKLASH };
    let corrected = |torque: f64| {
        let mut observer = BacklashObserver::<f64>::steady(&config, 0, torque, 64.0);
        // the angle stands, so that every tick has an innovation; the settled gains are zero
        [(); 4].map(|()| {
            let before = observer.estimate(&config).motor_speed;
            observer.step(&config, 0, torque);
            observer.estimate(&config).motor_speed != before
        })
    };
    assert_eq!(corrected(8.0), [true, false, false, false], "in contact");
    assert_eq!(corrected(0.0), [true; 4], "in the gap");
}

/// A speed or a torque beyond its base is told of, and one within it is not.
fn tells<O: Observer<Fixed>>(config: &O::Config) {
    let (half, beyond) = (Fixed::from_bits(1 << 27), Fixed::from_bits(3 << 27));
    for (torque, speed, told) in [(half, half, 0), (beyond, half, 1), (half, beyond, 1), (-beyond, -half, 1)] {
        assert_eq!(O::steady(config, 0, torque, speed).beyond_base(), told, "{torque:?} {speed:?}");
    }
}

#[test]
fn the_observers_tell_of_a_state_beyond_its_base() {
    tells::<TwoMassObserver<Fixed>>(&TWO_MASSES);
    tells::<RigidObserver<Fixed>>(&RIGID);
    tells::<GearedObserver<RigidObserver<Fixed>>>(&GearedConfig {
        observer: RIGID,
        friction: GearFriction::default(),
        stiction_gain: (),
        deadband: Fixed::ZERO,
    });
    let flat = TablePoint { inertia_ratio: Fixed::ONE, inertia_slope: Fixed::ZERO };
    tells::<MechanismObserver<Fixed>>(&MechanismConfig {
        rigid: RIGID,
        turning: RotorAngleConfig::new(1, 1).unwrap(),
        points: [flat; TABLE_POINTS],
        tool: [],
    });
    let gains = GapCorrection { states: [ZERO; 4], angle: ZERO };
    tells::<BacklashObserver<Fixed>>(&BacklashConfig {
        forcing: [ZERO; 2],
        half_gap: Fixed::from_bits(1 << 20),
        contact: Contact { twist: [ZERO; 3], twist_rate: [ZERO; 3], leaving: [ZERO; 3] },
        free: FreeFlight { twist: [ZERO; 2], twist_rate: ZERO, meeting: [ZERO; 3] },
        acceleration: ZERO,
        turn: [ZERO; 2],
        settled: gains,
        searching: gains,
        hold: 0,
        speed: ZERO,
        share: [ZERO; 2],
        shaft: [ZERO; 2],
        compliance: ZERO,
    });
}

/// An angle that is taken over moves no state, and a turn in a tick is a speed in each of them.
fn follows<O: Observer<f64>>(config: &O::Config) {
    let mut observer = O::steady(config, 7, 4.0, 50.0);
    assert_eq!((observer.angle(), O::speed_of_turn(config, 3.0)), (7, 3.0));
    let before = observer.estimate(config);
    observer.resync(1000);
    assert_eq!((observer.angle(), observer.estimate(config)), (1000, before));
}

#[test]
fn the_observers_take_an_angle_over() {
    follows::<RigidObserver<f64>>(&UNIT);
    follows::<SemiImplicitObserver<f64>>(&SEMI_IMPLICIT);
    follows::<BacklashObserver<f64>>(&BACKLASH);
    follows::<GearedObserver<RigidObserver<f64>>>(&geared(16.0));
    follows::<MechanismObserver<f64>>(&cranked([FLAT; TABLE_POINTS]));
}

/// The estimate is the same under both constants: in contact the stretch takes the stiffness over, in the gap nothing.
#[test]
fn a_switch_of_a_shaft_with_a_gap_leaves_speed_and_shaft_torque() {
    let to = BacklashConfig { share: [0.75, -0.25], shaft: [8.0, 2.0], compliance: 0.125, ..BACKLASH };
    let mut observer = BacklashObserver::<f64>::steady(&BACKLASH, 0, 8.0, 100.0);
    glide(&mut observer, 12.0);
    let before = observer.estimate(&BACKLASH);
    observer.switch(&BACKLASH, &to);
    let after = observer.estimate(&to);
    assert_eq!((after.motor_speed, after.shaft_torque), (before.motor_speed, before.shaft_torque));
    let mut open = BacklashObserver::<f64>::at_rest(&BACKLASH, 0, 0.0);
    glide(&mut open, 1.0);
    open.switch(&BACKLASH, &to);
    assert_eq!((open.twist(), open.estimate(&to).motor_speed), (0.5, 1.0));
}
