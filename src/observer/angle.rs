//! Angle tracking of an observer: innovation, correction, coasting.

use crate::number::Number;

/// Part of the residual that a tick of a sticking gear takes away, of 2^32: 1/32.
const DECAY: u32 = 1 << 27;

/// The last accepted motor angle, and the distance of the estimated angle from it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct AngleTracker<N> {
    residual: N,
    angle: u32,
}

/// The states `S` predicted for the end of a tick from the torque alone, with turn and innovation.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Prediction<N: Number, S> {
    states: S,
    turn: N,
    innovation: N,
    carry: N::Carry,
}

impl<N: Number> AngleTracker<N> {
    /// At `angle`, 2^32 per turn, without a residual.
    pub fn new(angle: u32) -> Self {
        AngleTracker { residual: N::ZERO, angle }
    }

    /// The last accepted angle, 2^32 per turn.
    #[inline(always)]
    pub fn angle(&self) -> u32 {
        self.angle
    }

    /// The prediction of `states` and of the turn, `c[0] y[0] + ...` in the unit of [`Number::less_turn`], at a measured
    /// `angle`.
    // The turn's remainder counts for the innovation: the fastest observers amplify a rounding of the turn.
    #[inline(always)]
    pub fn predict<S, const K: usize>(
        &self,
        states: S,
        (c, y): ([N::Coefficient; K], [N; K]),
        angle: u32,
        carry: N::Carry,
    ) -> Prediction<N, S> {
        let mut rest = N::Carry::default();
        let turn = N::sum(&mut rest, c, y);
        let turned = N::from_angle(angle.wrapping_sub(self.angle) as i32) + self.residual;
        Prediction { states, turn, innovation: turned.less_turn(turn, rest), carry }
    }

    /// Corrects predicted states and residual, each by its gain times the innovation, and stores them in `states`.
    // The residual's gain by reference, and each state stored at once: fewer registers.
    #[inline(always)]
    pub fn correct<const K: usize>(
        &mut self,
        predicted: Prediction<N, [N; K]>,
        gains: [N::Coefficient; K],
        angle_gain: &N::Coefficient,
        angle: u32,
        states: [&mut N; K],
    ) {
        let Prediction { states: from, innovation, mut carry, .. } = predicted;
        let operand = innovation.innovation_operand();
        self.angle = angle;
        for ((state, from), gain) in states.into_iter().zip(from).zip(gains) {
            *state = from.accumulate(&mut carry, [gain], [operand]).saturated();
        }
        self.residual = innovation.accumulate(&mut carry, [*angle_gain], [operand]);
    }

    /// The predicted states without a correction. The last accepted angle stays, and the residual grows by the turn.
    #[inline(always)]
    pub fn coast<const K: usize>(&mut self, predicted: Prediction<N, [N; K]>, angle: u32) -> [N; K] {
        self.residual = predicted.innovation - N::from_angle(angle.wrapping_sub(self.angle) as i32);
        predicted.states.map(N::saturated)
    }
}

impl<N: Number, S> Prediction<N, S> {
    /// Measured less predicted angle (2^-32 turn).
    #[inline(always)]
    pub fn innovation(&self) -> N {
        self.innovation
    }

    /// The prediction with a part of the innovation left out: a residual that coasts so decays.
    #[inline(always)]
    pub(super) fn decayed(self) -> Self {
        Prediction { innovation: self.innovation - self.innovation.scaled(N::fraction(DECAY)), ..self }
    }

    /// Predicted turn of the motor, in the unit of [`Number::less_turn`].
    #[inline(always)]
    pub fn turn(&self) -> N {
        self.turn
    }

    /// The prediction with a further value beside the states.
    #[inline(always)]
    pub fn with<X>(self, beside: X) -> Prediction<N, (S, X)> {
        let Prediction { states, turn, innovation, carry } = self;
        Prediction { states: (states, beside), turn, innovation, carry }
    }
}

impl<N: Number, S, X> Prediction<N, (S, X)> {
    /// The prediction without the value that [`with`](Prediction::with) added, and that value.
    #[inline(always)]
    pub fn split(self) -> (Prediction<N, S>, X) {
        let Prediction { states: (states, beside), turn, innovation, carry } = self;
        (Prediction { states, turn, innovation, carry }, beside)
    }
}
