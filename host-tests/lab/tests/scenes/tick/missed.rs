//! Ticks that do not run: made up by prediction they cost the estimates next to nothing, and are flagged.

use std::io;

use driveline::drive::{Composition, ConfigOf, Drive, MADE_UP};
use driveline::fault::Faults;
use driveline::governor::Governor;
use driveline::number::{Fixed, Number, Part};
use driveline::observer::Observer;
use driveline::sample::{Command, Sample};
use driveline_closed_loop::figures::{deviations, peaks};
use driveline_closed_loop::lockstep::{Trace, run};
use driveline_closed_loop::scenario::Machine;
use driveline_closed_loop::ticks::Ticks;
use driveline_closed_loop::units::Units;
use driveline_firmware::Words;
use driveline_firmware::scene::{Constants, FromConfig, Input, Of, Output};
use driveline_firmware::scenes::hoist::{self, Hoist};
use driveline_firmware::scenes::strip_mill::{self, StripMill};
use driveline_lab::drivetrains;
use driveline_solver::noise::Noise;

/// The drive of a variant, of whose ticks some do not run.
struct Missing<D: Composition<Config: 'static>> {
    drive: D,
    config: &'static ConfigOf<D>,
    noise: Noise,
    /// Probability that a tick does not run.
    share: f64,
    made_up: bool,
    missed: u32,
    last: Output,
    /// Ticks that did not run, and gaps that were flagged.
    counted: [u32; 2],
}

impl<D: Composition<Config: 'static>> Missing<D> {
    fn new(config: &'static ConfigOf<D>, share: f64, made_up: bool) -> Self {
        Missing {
            drive: D::new(config, 0),
            config,
            noise: Noise::new(7),
            share,
            made_up,
            missed: 0,
            last: Output::default(),
            counted: [0; 2],
        }
    }
}

impl<D: Composition<Config: 'static>> Ticks for Missing<D> {
    fn tick(&mut self, input: &Input) -> io::Result<Output> {
        let word = D::Number::from_word;
        let released = input.flags & Input::RELEASED != 0;
        if released && 0.5 * (self.noise.uniform() + 1.0) < self.share {
            self.missed += 1;
            self.counted[0] += 1;
            return Ok(self.last);
        }
        let missed = if self.made_up { self.missed } else { 0 };
        self.missed = 0;
        let Command { torque, faults } = if released {
            let sample = Sample { angle: input.angle, torque: word(input.torque), setpoint: word(input.setpoint) };
            self.drive.tick_after(self.config, &sample, missed)
        } else {
            self.drive.hold(self.config, input.angle, word(input.setpoint))
        };
        assert_eq!(faults.contains(Faults::TICK_MISSED), missed != 0);
        self.counted[1] += u32::from(missed != 0);
        let estimate = self.drive.estimate(self.config);
        self.last = Output {
            torque: torque.to_word(),
            motor_speed: estimate.motor_speed.to_word(),
            shaft_torque: estimate.shaft_torque.to_word(),
            load_speed: estimate.load_speed.to_word(),
            load_torque: estimate.load_torque.to_word(),
            faults: faults.bits(),
            ..Output::default()
        };
        Ok(self.last)
    }
}

/// Rms errors of shaft torque and load torque, over their peaks, and of load speed, over rated, in the counted runs.
fn errors<V, D>(machine: &Machine, words: Words, share: f64, made_up: bool) -> [f64; 3]
where
    V: Constants<Scene: FromConfig<Drive = D>>,
    D: Composition<Config: 'static> + 'static,
{
    let units = Units::new(words, machine.bases);
    let mut counted = [0; 2];
    let traces: Vec<Trace> = machine
        .scenarios
        .iter()
        .filter(|scenario| scenario.counted)
        .map(|scenario| {
            let mut drive = Missing::<D>::new(V::CONFIG, share, made_up);
            let trace = run(machine, scenario, &units, V::RATE_HZ, &mut drive, |_| ()).unwrap();
            counted = [counted[0] + drive.counted[0], counted[1] + drive.counted[1]];
            trace
        })
        .collect();
    if share > 0.0 {
        // of the 90,000 ticks or more of a scene's runs a thousandth; two in a row are flagged once
        assert!(counted[0] > 50, "{}: {counted:?}", V::NAME);
        assert!(!made_up || counted[1] + 3 >= counted[0], "{}: {counted:?}", V::NAME);
    }
    let peaks = peaks(traces.iter());
    let errors = deviations(traces.iter(), [peaks[0], machine.rated_speed, peaks[2]]).map(|deviation| deviation.rms);
    println!("{} {share} made up: {made_up}: {:?}", V::NAME, errors.map(|error| 100.0 * error));
    errors
}

fn test<V, D>(machine: &Machine, words: Words)
where
    V: Constants<Scene: FromConfig<Drive = D>>,
    D: Composition<Config: 'static> + 'static,
{
    let nominal = errors::<V, D>(machine, words, 0.0, true);
    let overlooked = errors::<V, D>(machine, words, 0.001, false);
    let made_up = errors::<V, D>(machine, words, 0.001, true);
    for k in 0..3 {
        // the project's target; a gap is seen by the estimates as long as it lasts, a thousandth of the time
        assert!(made_up[k] <= 1.2 * nominal[k], "{} {k}: {made_up:?} {nominal:?}", V::NAME);
        // the test sees a drive that does not make them up: its errors are beyond those that are allowed
        assert!(overlooked[k] > 1.5 * nominal[k], "{} {k}: {overlooked:?} {nominal:?}", V::NAME);
    }
}

#[test]
fn a_thousandth_of_the_ticks_missed_leaves_the_hoists_errors() {
    let machine = drivetrains::hoist::machine().unwrap();
    test::<Of<Hoist<10_000>, hoist::Reduced<f32>>, _>(&machine, Words::Single);
    test::<Of<Hoist<10_000>, hoist::Reduced<Fixed>>, _>(&machine, Words::Fixed);
}

#[test]
fn a_thousandth_of_the_ticks_missed_leaves_the_strip_mills_errors() {
    let machine = drivetrains::strip_mill::machine().unwrap();
    test::<Of<StripMill, strip_mill::SemiImplicit<f32>>, _>(&machine, Words::Single);
    test::<Of<StripMill, strip_mill::SemiImplicit<Fixed>>, _>(&machine, Words::Fixed);
}

/// A motor that turns steadily: whatever the gap, the estimate of its speed stands, and a gap beyond the limit of ticks
/// without an angle loses the angle until there are two in a row.
#[test]
fn a_gap_of_any_length_leaves_the_speed() {
    fn gap<V, N, O, G>(base: f64)
    where
        V: Constants<Scene: FromConfig<Drive = Drive<N, O, G>>>,
        N: Number + 'static,
        O: Part<N, State: Observer<N, Config: 'static>> + 'static,
        G: Part<N, State: Governor<N, Config: 'static>> + 'static,
    {
        let config = V::CONFIG;
        const SPEED: f64 = 30.0;
        let turn =
            |tick: u32| (SPEED * f64::from(tick) * 1e-4 / core::f64::consts::TAU * 4_294_967_296.0) as u64 as u32;
        let most = config.limits.max_coast;
        for missed in [1, MADE_UP, MADE_UP + 1, most, most + 1, u32::MAX] {
            let mut drive = Drive::<N, O, G>::new(config, 0);
            let sample = |tick| Sample { angle: turn(tick), torque: N::ZERO, setpoint: N::ZERO };
            for tick in 0..2_000 {
                drive.tick(config, &sample(tick));
            }
            // in a steady motion a gap is any number of ticks; the drive's own torque is left out of it
            let after = 2_000 + missed % 100_000;
            let command = drive.tick_after(config, &sample(after), missed);
            assert!(command.faults.contains(Faults::TICK_MISSED));
            assert_eq!(command.faults.contains(Faults::ANGLE_LOST), missed > most, "{missed}");
            for tick in after + 1..after + 20 {
                let lost = drive.is_lost();
                assert!(lost || tick > after + 2 || missed <= most);
                let command = drive.tick(config, &sample(tick));
                assert!(command.faults.is_none() || missed > most && tick <= after + 2, "{missed}: {}", command.faults);
            }
            let speed = drive.estimate(config).motor_speed.to_real() * base;
            // two counts of 8192 in a tick are 15 rad/s; a drive that is a period off is off by the whole speed
            assert!((speed - SPEED).abs() < 0.1 * SPEED, "{missed}: {speed}");
        }
    }
    use driveline::configure::Machine as _;
    gap::<Of<Hoist<10_000>, hoist::Reduced<f32>>, _, _, _>(1.0);
    gap::<Of<Hoist<10_000>, hoist::Reduced<Fixed>>, _, _, _>(Hoist::<10_000>::BASES.speed);
}
