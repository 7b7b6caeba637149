//! Kalman filters whose covariance is computed in every tick, by the crates that there are.
//!
//! The angle is counted from the last measured one: the turn of a tick is taken off the predicted state, and the
//! measurement is zero. So no filter loses resolution in `f32` over many turns.

use adskalman::{CovarianceUpdateMethod, ObservationModel, StateAndCovariance, TransitionModelLinearNoControl};
use kfilter::kalman::{Kalman, KalmanFilter, KalmanLinear, KalmanPredictInput, KalmanUpdate};
use kfilter::measurement::LinearMeasurement;
use kfilter::system::System;
use minikalman::prelude::*;
use minikalman::regular::builder::{
    KalmanFilterBuilder, KalmanFilterControlType, KalmanFilterObservationType, KalmanFilterType,
};
use nalgebra as na;
use nalgebra_034 as na_034;

use crate::model::{Model, Peer, at_rest, estimate};

/// `idsp::kalman`, its transition dense, its observation direct.
#[derive(Clone, Copy, Debug)]
pub struct Idsp {
    transition: idsp::kalman::Transition<f32, 5>,
    observation: idsp::kalman::Direct<f32, 0>,
    input: [f32; 5],
    shaft: [f32; 2],
    estimate: idsp::kalman::Estimate<f32, 5>,
}

impl Idsp {
    /// With the library's noises.
    pub fn new(model: &Model) -> Self {
        Idsp {
            transition: idsp::kalman::Transition::new(model.transition, model.noise),
            observation: idsp::kalman::Direct::new(model.measurement),
            input: model.input,
            shaft: model.shaft,
            estimate: idsp::kalman::Estimate::new([0.0; 5], model.covariance),
        }
    }
}

impl Peer for Idsp {
    fn start(&mut self, torque: f32) {
        self.estimate.state = at_rest(self.shaft, torque);
    }

    #[inline(always)]
    fn step(&mut self, turn: f32, torque: f32, deadband: f32) {
        self.transition.predict(&mut self.estimate);
        for (state, input) in self.estimate.state.iter_mut().zip(self.input) {
            *state += input * torque;
        }
        self.estimate.state[0] -= turn;
        if !(self.estimate.state[0].abs() <= deadband) {
            self.observation.correct(&mut self.estimate, 0.0);
        }
    }

    #[inline(always)]
    fn estimate(&self) -> [f32; 3] {
        let state = &self.estimate.state;
        estimate(self.shaft, state[1], state[2], state[3])
    }
}

/// `adskalman`, with the update that keeps the covariance symmetric at least cost.
#[derive(Clone, Debug)]
pub struct Adskalman {
    model: AdskalmanModel,
    input: na::SVector<f32, 5>,
    shaft: [f32; 2],
    estimate: StateAndCovariance<f32, na::U5>,
}

/// Transition and observation.
#[derive(Clone, Copy, Debug)]
struct AdskalmanModel {
    transition: na::SMatrix<f32, 5, 5>,
    transposed: na::SMatrix<f32, 5, 5>,
    noise: na::SMatrix<f32, 5, 5>,
    observation: na::SMatrix<f32, 1, 5>,
    observation_transposed: na::SMatrix<f32, 5, 1>,
    measurement: na::SMatrix<f32, 1, 1>,
}

impl TransitionModelLinearNoControl<f32, na::U5> for AdskalmanModel {
    fn F(&self) -> &na::SMatrix<f32, 5, 5> {
        &self.transition
    }

    fn FT(&self) -> &na::SMatrix<f32, 5, 5> {
        &self.transposed
    }

    fn Q(&self) -> &na::SMatrix<f32, 5, 5> {
        &self.noise
    }
}

impl ObservationModel<f32, na::U5, na::U1> for AdskalmanModel {
    fn H(&self) -> &na::SMatrix<f32, 1, 5> {
        &self.observation
    }

    fn HT(&self) -> &na::SMatrix<f32, 5, 1> {
        &self.observation_transposed
    }

    fn R(&self) -> &na::SMatrix<f32, 1, 1> {
        &self.measurement
    }
}

impl Adskalman {
    /// With the library's noises.
    pub fn new(model: &Model) -> Self {
        let transition = na::SMatrix::<f32, 5, 5>::from(model.transition).transpose();
        let observation = na::SMatrix::<f32, 1, 5>::new(1.0, 0.0, 0.0, 0.0, 0.0);
        let filter = AdskalmanModel {
            transition,
            transposed: transition.transpose(),
            noise: model.noise.into(),
            observation,
            observation_transposed: observation.transpose(),
            measurement: na::SMatrix::<f32, 1, 1>::new(model.measurement),
        };
        Adskalman {
            model: filter,
            input: model.input.into(),
            shaft: model.shaft,
            estimate: StateAndCovariance::new(na::SVector::zeros(), model.covariance.into()),
        }
    }
}

impl Peer for Adskalman {
    fn start(&mut self, torque: f32) {
        *self.estimate.state_mut() = at_rest(self.shaft, torque).into();
    }

    #[inline(always)]
    fn step(&mut self, turn: f32, torque: f32, deadband: f32) {
        let mut prior = self.model.predict(&self.estimate);
        *prior.state_mut() += self.input * torque;
        prior.state_mut().x -= turn;
        if prior.state().x.abs() <= deadband {
            self.estimate = prior;
            return;
        }
        let method = CovarianceUpdateMethod::OptimalKalmanForcedSymmetric;
        if let Ok(estimate) = self.model.update(&prior, &na::SVector::<f32, 1>::zeros(), method) {
            self.estimate = estimate;
        }
    }

    #[inline(always)]
    fn estimate(&self) -> [f32; 3] {
        let state = self.estimate.state();
        estimate(self.shaft, state[1], state[2], state[3])
    }
}

/// `minikalman`, with owned buffers.
pub struct Minikalman {
    filter: KalmanFilterType<5, f32>,
    control: KalmanFilterControlType<5, 1, f32>,
    observation: KalmanFilterObservationType<5, 1, f32>,
    shaft: [f32; 2],
}

impl Minikalman {
    /// With the library's noises.
    pub fn new(model: &Model) -> Self {
        let builder = KalmanFilterBuilder::<5, f32>::default();
        let mut filter = builder.build();
        let mut control = builder.controls().build::<1>();
        let mut observation = builder.observations().build::<1>();
        for row in 0..5 {
            for column in 0..5 {
                filter.state_transition_mut().set_at(row, column, model.transition[row][column]);
                filter.estimate_covariance_mut().set_at(row, column, model.covariance[row][column]);
                filter.direct_process_noise_mut().set_at(row, column, model.noise[row][column]);
            }
            control.control_matrix_mut().set_at(row, 0, model.input[row]);
        }
        observation.observation_matrix_mut().set_at(0, 0, 1.0);
        observation.measurement_noise_covariance_mut().set_at(0, 0, model.measurement);
        Minikalman { filter, control, observation, shaft: model.shaft }
    }
}

impl Peer for Minikalman {
    fn start(&mut self, torque: f32) {
        for (row, value) in at_rest(self.shaft, torque).into_iter().enumerate() {
            self.filter.state_vector_mut().set_row(row, value);
        }
    }

    #[inline(always)]
    fn step(&mut self, turn: f32, torque: f32, deadband: f32) {
        self.control.control_vector_mut().set_row(0, torque);
        self.filter.predict();
        self.filter.control(&mut self.control);
        let angle = self.filter.state_vector().get_row(0) - turn;
        self.filter.state_vector_mut().set_row(0, angle);
        if !(angle.abs() <= deadband) {
            self.filter.correct(&mut self.observation);
        }
    }

    #[inline(always)]
    fn estimate(&self) -> [f32; 3] {
        let state = self.filter.state_vector();
        estimate(self.shaft, state.get_row(1), state.get_row(2), state.get_row(3))
    }
}

/// `kfilter`.
#[derive(Clone, Debug)]
pub struct Kfilter {
    filter: KalmanLinear<f32, 5, 1>,
    measurement: LinearMeasurement<f32, 5, 1>,
    shaft: [f32; 2],
}

impl Kfilter {
    /// With the library's noises.
    pub fn new(model: &Model) -> Self {
        let filter = Kalman::new_with_input(
            na_034::SMatrix::<f32, 5, 5>::from(model.transition).transpose(),
            model.noise.into(),
            model.input.into(),
            na_034::SVector::zeros(),
            model.covariance.into(),
        );
        let measurement = LinearMeasurement::new(
            na_034::SMatrix::<f32, 1, 5>::new(1.0, 0.0, 0.0, 0.0, 0.0),
            na_034::SMatrix::<f32, 1, 1>::new(model.measurement),
            na_034::SVector::<f32, 1>::zeros(),
        );
        Kfilter { filter, measurement, shaft: model.shaft }
    }
}

impl Peer for Kfilter {
    fn start(&mut self, torque: f32) {
        *self.filter.system.state_mut() = at_rest(self.shaft, torque).into();
    }

    #[inline(always)]
    fn step(&mut self, turn: f32, torque: f32, deadband: f32) {
        if self.filter.predict(na_034::SVector::<f32, 1>::new(torque)).is_err() {
            return;
        }
        self.filter.system.state_mut().x -= turn;
        if !(self.filter.state().x.abs() <= deadband) {
            // It fails where the innovation's variance cannot be inverted; the prediction then stands.
            let _ = self.filter.update(&self.measurement);
        }
    }

    #[inline(always)]
    fn estimate(&self) -> [f32; 3] {
        let state = self.filter.state();
        estimate(self.shaft, state[1], state[2], state[3])
    }
}
