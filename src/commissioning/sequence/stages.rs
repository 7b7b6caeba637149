//! The phases of each stage: where they begin, when they end, what follows.

use super::super::friction::{SEGMENTS, Segment, ends_of};
use super::super::gap::PUSHES;
use super::super::harmonic::Harmonic;
use super::{Commissioning, Next, Phase, Stage, TestConfig};

/// Share of the push at which the servo has found a flank.
const TOUCH: f32 = 0.3;

impl<const L: usize> Commissioning<L> {
    /// The first phase of the next stage.
    pub(super) fn begin(&mut self, config: &TestConfig) {
        let speed = config.settings.speed as f32;
        let rate = config.acceleration as f32;
        self.index = 0;
        self.phase = Phase::Goes;
        (self.bound, self.reversals) = (0.0, 0);
        match self.next {
            Next::Segments => {
                self.stage = Stage::Friction;
                // Gently: whether there is a gap, and whether the load is free, is not known yet.
                self.reference.go(ends_of(0).0 * speed, 0.25 * rate);
            }
            Next::Turns => {
                self.stage = Stage::Encoder;
                self.orders = [Harmonic::default(); 3];
                self.reference.go(speed, rate);
            }
            Next::Reversals { speed, .. } => {
                self.stage = Stage::Backlash;
                self.start.0 = self.reference.angle;
                self.reference.go(speed as f32, (speed * config.servo) as f32);
            }
            Next::Record { way, .. } => {
                self.stage = Stage::Resonance;
                self.lines = self.known.lines;
                self.reference.go(way as f32 * 0.9 * speed, rate);
            }
            Next::Done(_) => {
                self.stage = Stage::Done;
                self.phase = Phase::Waits;
            }
            Next::Refused(_) => {
                self.stage = Stage::Refused;
                self.phase = Phase::Waits;
            }
        }
    }

    /// Whether the phase has ended.
    pub(super) fn is_over(&self, config: &TestConfig) -> bool {
        match (self.stage, self.phase) {
            (Stage::Backlash, Phase::Goes) => {
                let Next::Reversals { torque, widest, .. } = self.next else { return true };
                let way = if self.reference.target < 0.0 { -1.0 } else { 1.0 };
                let crept = (self.reference.angle.wrapping_sub(self.start.0)) as f64 / f64::from(config.units);
                way * self.torque >= TOUCH * torque as f32 || crept.abs() > widest
            }
            (_, Phase::Goes | Phase::Stops) => self.reference.is_there(),
            _ => self.left == 0,
        }
    }

    /// Goes to the next phase.
    pub(super) fn advance(&mut self, config: &TestConfig) {
        let rate = config.acceleration as f32;
        let steady = config.blocks(6.0 / config.servo);
        let stop = |this: &mut Self| {
            this.reference.go(0.0, rate);
            this.phase = Phase::Stops;
        };
        match (self.stage, self.phase) {
            (Stage::Holding, _) => {
                self.next = Next::Segments;
                self.begin(config);
            }
            (Stage::Backlash, Phase::Goes) => {
                self.reference.go(0.0, f32::MAX);
                self.phase = Phase::Settles;
                self.left = steady.saturating_mul(3);
            }
            (_, Phase::Goes) => {
                self.phase = Phase::Settles;
                self.left = match self.next {
                    Next::Record { settle, .. } => settle,
                    _ => steady,
                };
                self.fading = 2.0 / self.left.max(1) as f32;
            }
            (_, Phase::Settles) => self.measure(config),
            (Stage::Friction, Phase::Measures) => {
                self.finish_segment(config);
                self.index += 1;
                if self.index < SEGMENTS {
                    let (from, _) = ends_of(self.index);
                    self.reference.go(from * config.settings.speed as f32, rate);
                    self.phase = Phase::Goes;
                } else {
                    stop(self);
                }
            }
            (Stage::Backlash, Phase::Measures) => {
                let place = self.place(config);
                if let Some(push) = self.pushes.get_mut(self.index) {
                    push.1 = place;
                }
                self.index += 1;
                self.phase = Phase::Fades;
                self.left = steady.saturating_mul(2);
            }
            (Stage::Backlash, Phase::Fades) => {
                // The reference starts anew from where the motor stands, so that the torque does not jump.
                self.reference.angle += (self.deviation.angle * config.units) as i64;
                self.deviation.angle = 0.0;
                self.start.0 = self.reference.angle;
                if self.index < PUSHES {
                    let Next::Reversals { speed, .. } = self.next else { return };
                    let way = if self.index.is_multiple_of(2) { 1.0 } else { -1.0 };
                    self.reference.go(way * speed as f32, (speed * config.servo) as f32);
                    self.phase = Phase::Goes;
                } else {
                    stop(self);
                }
            }
            (Stage::Encoder, Phase::Measures) => {
                let turned = self.angle.wrapping_sub(self.start.0) as f64 / f64::from(config.units);
                let blocks = if let Next::Turns = self.next { config.turns() } else { 1 };
                self.total = turned / (f64::from(blocks) * config.block);
                stop(self);
            }
            (_, Phase::Measures) => {
                self.phase = Phase::Fades;
                self.left = steady;
                self.fading = -2.0 / steady as f32;
            }
            (_, Phase::Fades) => {
                self.fade = 0.0;
                stop(self);
            }
            (_, Phase::Stops | Phase::Waits | Phase::Lost) => {
                self.phase = Phase::Waits;
                self.fade = 0.0;
            }
        }
    }

    /// Begins to measure.
    fn measure(&mut self, config: &TestConfig) {
        self.phase = Phase::Measures;
        self.total = 0.0;
        self.carried = -self.deviation.disturbance;
        self.start = (self.angle, self.reference.speed + self.deviation.speed);
        let speed = config.settings.speed as f32;
        match self.next {
            Next::Segments => {
                let (from, to) = ends_of(self.index);
                self.left = config.blocks(config.segment());
                let time = self.left as f32 * config.block_f32;
                self.reference.go(to * speed, ((to - from) * speed).abs() / time);
            }
            Next::Turns => {
                self.left = config.turns();
                self.window = self.known.window;
            }
            Next::Reversals { .. } => {
                self.left = config.blocks(12.0 / config.servo);
                let place = self.place(config);
                if let Some(push) = self.pushes.get_mut(self.index) {
                    push.0 = place;
                }
            }
            Next::Record { blocks, way, .. } => {
                self.left = blocks;
                self.window = self.known.window;
                self.fading = 0.0;
                for line in &mut self.lines {
                    (line.angle, line.torque) = ([0.0; 2], [0.0; 2]);
                }
                let time = blocks as f32 * config.block_f32;
                self.reference.go(way as f32 * 1.1 * speed, 0.2 * speed / time);
            }
            Next::Done(_) | Next::Refused(_) => {}
        }
    }

    /// Where the motor stands against a flank (rad).
    fn place(&self, config: &TestConfig) -> f64 {
        self.reference.angle as f64 / f64::from(config.units) + f64::from(self.deviation.angle)
    }

    fn finish_segment(&mut self, config: &TestConfig) {
        let blocks = f64::from(config.blocks(config.segment()));
        let time = blocks * config.block;
        let (angle, speed) = self.start;
        let turned = self.angle.wrapping_sub(angle) as f64 / f64::from(config.units);
        let now = self.reference.speed + self.deviation.speed;
        if let Some(segment) = self.segments.get_mut(self.index) {
            *segment = Segment {
                torque: self.total / blocks,
                speed: turned / time,
                acceleration: f64::from(now - speed) / time,
            };
        }
    }
}

impl TestConfig {
    /// Duration of a segment of the friction's test (s): long beside the servo and the band's lower end, and for
    /// ramps no steeper than the others.
    pub(crate) fn segment(&self) -> f64 {
        let [low, _] = self.settings.band;
        (6.0 / low).max(0.6 * self.settings.speed / self.acceleration)
    }

    /// Blocks in the turns of the encoder's test: 40, or eight at least where the travel is shorter.
    pub(crate) fn turns(&self) -> u32 {
        let angle = (0.4 * self.settings.travel).clamp(8.0 * core::f64::consts::TAU, 40.0 * core::f64::consts::TAU);
        self.blocks(angle / self.settings.speed)
    }
}
