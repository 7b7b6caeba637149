//! Why a design cannot work.

sentences! {
    /// A parameter of a design that is out of its range, or a machine that cannot be observed or governed so.
    ///
    /// ```
    /// use driveline::design::{Disturbance, Encoder, Error, Rate};
    /// use driveline::machine::{Damping, Inertia, Stiffness, TwoMass};
    /// // a shaft of 200 rad/s = 32 Hz at 50 ticks a second
    /// let shaft = TwoMass::new(Inertia(0.5), Inertia(0.5), Stiffness(1.0e4), Damping(0.0));
    /// let load = Disturbance { torque_accuracy: 3.0, load_torque_step: 150.0, within: 10.0 };
    /// assert_eq!(shaft.try_observer(Rate::hz(50), Encoder::lines(2048), load), Err(Error::SampleRate));
    /// ```
    Error: [Machine(crate::machine::Error)]
    Period => "the sample rate must be positive and finite (Hz)",
    EncoderLines => "the encoder must have at least one line",
    EncoderAccuracy => "the accuracy of the encoder must be zero or above and finite: interpolation error (fraction of \
        a signal period), eccentricity (rad), jitter (s) and its speed (rad/s)",
    TorqueAccuracy => "torque_accuracy of the disturbance must be positive and finite (N m)",
    LoadTorqueStep => "load_torque_step of the disturbance must be positive and finite (N m)",
    Within => "within of the disturbance must be positive and finite (s)",
    Unobservable => "the load is unobservable from the motor's angle: the stiffness between the two masses is zero",
    SampleRate => "the sample rate cannot follow the shaft, whose resonance lies above half the rate and is lightly \
        damped: take a higher rate, or the observer of one mass",
    NotConverged => "the observer's gain was not found: the Riccati equation has no stabilising solution for these \
        disturbances",
    NotStabilising => "the observer's gain does not stabilise the estimate: the disturbances are too small for this \
        machine",
    MechanismNotStabilising => "the gains for the mechanism's mean inertia do not stabilise the estimate at its least \
        or its largest one: the inertia swings too far, or the disturbances are too small",
    NoGap => "the machine has no backlash: take the observer of two masses",
    Wander => "the wanders of the backlash's tuning must be finite, those of twist and load torque above zero, that of \
        the load speed not negative (share of the gap, of the disturbance, of the gap times the resonance)",
    Hold => "the hold of the backlash's tuning must not be negative, and within 2^32 ticks (periods of the resonance)",
    Slack => "impact, torque, rise and largest torque of the backlash take-up must be positive and finite, the largest \
        torque no less than that in the gap, its damping zero or above (N m, N m, N m, N m, 1)",
    Noise => "the measurement noise must have a positive definite covariance",
    Bandwidth => "the bandwidth of the speed loop must be above zero and below the antiresonance of the machine, or \
        above its resonance",
    ObserverBandwidth => "the bandwidth of the observer must be above zero and below 0.618 times the sample rate in Hz \
        (rad/s), and not so far below the resonance that rounding moves its poles: two thousandths of it are enough",
    Shaper => "the input shaper needs a frequency above zero and finite (rad/s), and a damping ratio from 0 to below 1",
    DampingRatio => "the damping ratios of the speed loop must be above zero and finite",
    TwistGain => "the gain on the twist rate must be above zero and finite (of the proportional gain): 0.1 for much \
        margin, 0.3 for a swing that decays soon",
    Actuator => "the actuator's delay and lag must be zero or above and finite (s), its engine must have cylinders and \
        turn",
    OptimumFactor => "the symmetrical-optimum factor of the governor must be above 1 and finite: from 2 (fast) to 4 \
        (well damped)",
    VirtualInertia => "the virtual inertia must be from 0 to 1 of the machine's own, the lag of the estimate zero or \
        above and finite (s)",
    FeedForward => "the share of the load torque that is fed forward must be from 0 to 1, the lag of its estimate zero \
        or above and finite (s)",
    NaturalDamping => "the natural damping of motor and load must be finite (N m s/rad)",
    GovernorUnstable => "the governor is unstable with this actuator and shaft: raise its symmetrical-optimum factor",
    GovernorGain => "the governor with its filter has less gain margin than ROBUSTNESS requires (6 dB unless named): \
        raise its symmetrical-optimum factor, shorten the filter, or name a ROBUSTNESS of less",
    GovernorPhase => "the governor with its filter has less phase margin than ROBUSTNESS requires (30 degrees unless \
        named): raise its symmetrical-optimum factor, shorten the filter, or name a ROBUSTNESS of less",
    DampingUnstable => "the governor is unstable with this natural damping: a negative sum needs more gain, a lower \
        symmetrical-optimum factor",
    Barred => "barred speeds need frequencies and orders above zero and finite, and a margin above 0 and below 1",
    BarredCount => "there are more barred ranges of speed than the governor has room for: raise K",
    TorqueCurve => "a torque curve needs points of rising speed from zero on, each with a torque of zero or above, all \
        finite",
    Tolerance => "a tolerance must be from a factor above 0 and at most 1 to one of 1 or above, a gain margin 1 or \
        above, a phase margin zero or above, a lag zero or above and finite (s)",
    LoopUnstable => "the speed loop with its observer is unstable: take less bandwidth \
        (SpeedLoopTuning::with_bandwidth), less damping of a take-up, or a load disturbance of more for the observer",
    LoopGain => "the speed loop with its observer has less gain margin than ROBUSTNESS requires (6 dB unless named): \
        take less bandwidth (SpeedLoopTuning::with_bandwidth) or less damping of a take-up, or name a ROBUSTNESS of \
        less",
    LoopPhase => "the speed loop with its observer has less phase margin than ROBUSTNESS requires (30 degrees unless \
        named): take less bandwidth (SpeedLoopTuning::with_bandwidth) or less damping of a take-up, or name a \
        ROBUSTNESS of less",
    LoopMotorInertia => "the speed loop with its observer is unstable at the tolerance of the motor inertia: take less \
        bandwidth (SpeedLoopTuning::with_bandwidth) or less damping of a take-up, or name a narrower TOLERANCE",
    LoopLoadInertia => "the speed loop with its observer is unstable at the tolerance of the load inertia: take less \
        bandwidth (SpeedLoopTuning::with_bandwidth) or less damping of a take-up, or name a narrower TOLERANCE",
    LoopStiffness => "the speed loop with its observer is unstable at the tolerance of the stiffness: take less \
        bandwidth (SpeedLoopTuning::with_bandwidth) or less damping of a take-up, or name a narrower TOLERANCE",
    LoopDamping => "the speed loop with its observer is unstable at the tolerance of the shaft's damping: take less \
        bandwidth (SpeedLoopTuning::with_bandwidth), a lag of the speed (SpeedLoopDesign::with_speed_lag and the \
        governor SpeedLag), or name a narrower TOLERANCE",
    LoopUndescribed => "the speed loop with its observer is unstable, or lacks the gain margin of ROBUSTNESS, with a \
        resonance that the description leaves out (undescribed of TOLERANCE): take less active damping \
        (SpeedLoopTuning::of), a lag of the speed (SpeedLoopDesign::with_speed_lag and the governor SpeedLag) or less \
        bandwidth, or describe the machine up to a higher frequency and name it in TOLERANCE",
    LoopTorque => "the speed loop with its observer is unstable at the tolerance of the torque: take less bandwidth \
        (SpeedLoopTuning::with_bandwidth) or less damping of a take-up, or name a narrower TOLERANCE",
    LoopLate => "the speed loop with its observer is unstable with a torque as late as TOLERANCE allows: take less \
        bandwidth (SpeedLoopTuning::with_bandwidth) or less damping of a take-up, or name a narrower TOLERANCE",
    LoopCorner => "the speed loop with its observer is unstable at its tolerances together: take less bandwidth \
        (SpeedLoopTuning::with_bandwidth) or less damping of a take-up, or name a narrower TOLERANCE",
    SpeedLoopUnstable => "the speed loop is unstable at this sample rate: lower its bandwidth or raise the rate",
}

impl Error {
    /// Stops with the sentence: a compile error in a constant.
    pub(crate) const fn stop(self) -> ! {
        panic!("{}", self.message())
    }
}

impl From<crate::machine::Error> for Error {
    fn from(error: crate::machine::Error) -> Self {
        Self::Machine(error)
    }
}
