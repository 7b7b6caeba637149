//! Observers with constant gains: the five states multiplied out by hand, and with `nalgebra`.

use nalgebra::{SMatrix, SVector};

use crate::model::{Model, Peer, at_rest, estimate};

/// Five states, the zeros and ones of the model left out.
#[derive(Clone, Copy, Debug)]
pub struct ByHand {
    transition: [[f32; 4]; 4],
    input: [f32; 4],
    gains: [f32; 5],
    shaft: [f32; 2],
    /// As [`Model`] has them.
    state: [f32; 5],
}

impl ByHand {
    /// With gains of one's own.
    pub fn new(model: &Model, gains: [f32; 5]) -> Self {
        let a = &model.transition;
        let row = |k: usize| [a[k][1], a[k][2], a[k][3], a[k][4]];
        let b = &model.input;
        ByHand {
            transition: [row(0), row(1), row(2), row(3)],
            input: [b[0], b[1], b[2], b[3]],
            gains,
            shaft: model.shaft,
            state: [0.0; 5],
        }
    }
}

impl Peer for ByHand {
    fn start(&mut self, torque: f32) {
        self.state = at_rest(self.shaft, torque);
    }

    #[inline(always)]
    fn step(&mut self, turn: f32, torque: f32, deadband: f32) {
        let [angle, motor, twist, load, load_torque] = self.state;
        let next = |k: usize| {
            let [a, b, c, d] = self.transition[k];
            a * motor + b * twist + c * load + d * load_torque + self.input[k] * torque
        };
        let angle = angle - turn + next(0);
        let (motor, twist, load) = (next(1), next(2), next(3));
        let [k0, k1, k2, k3, k4] = self.gains;
        let innovation = if angle.abs() <= deadband { 0.0 } else { -angle };
        self.state = [
            angle + k0 * innovation,
            motor + k1 * innovation,
            twist + k2 * innovation,
            load + k3 * innovation,
            load_torque + k4 * innovation,
        ];
    }

    #[inline(always)]
    fn estimate(&self) -> [f32; 3] {
        estimate(self.shaft, self.state[1], self.state[2], self.state[3])
    }
}

/// Five states as matrices of `nalgebra`.
#[derive(Clone, Copy, Debug)]
pub struct ByNalgebra {
    transition: SMatrix<f32, 5, 5>,
    input: SVector<f32, 5>,
    gains: SVector<f32, 5>,
    shaft: [f32; 2],
    state: SVector<f32, 5>,
}

impl ByNalgebra {
    /// With the library's gains.
    pub fn new(model: &Model) -> Self {
        ByNalgebra {
            transition: SMatrix::<f32, 5, 5>::from(model.transition).transpose(),
            input: model.input.into(),
            gains: model.gains.into(),
            shaft: model.shaft,
            state: SVector::zeros(),
        }
    }
}

impl Peer for ByNalgebra {
    fn start(&mut self, torque: f32) {
        self.state = at_rest(self.shaft, torque).into();
    }

    #[inline(always)]
    fn step(&mut self, turn: f32, torque: f32, deadband: f32) {
        let mut next = self.transition * self.state + self.input * torque;
        next.x -= turn;
        let innovation = if next.x.abs() <= deadband { 0.0 } else { -next.x };
        self.state = next + self.gains * innovation;
    }

    #[inline(always)]
    fn estimate(&self) -> [f32; 3] {
        estimate(self.shaft, self.state[1], self.state[2], self.state[3])
    }
}
