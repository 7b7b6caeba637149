//! Errors of the commissioning test.

sentences! {
    /// Why the test did not begin, was ended, or why its data do not support an answer.
    Error:
    Rate => "the rate of the ticks must be positive and finite",
    EncoderLines => "the encoder must have at least one line",
    EncoderCounts => "the encoder must have no more counts than 2^31 on a turn",
    EncoderAccuracy => "the accuracy of the encoder must be zero or above and finite: interpolation error (fraction of \
        a signal period), eccentricity (rad), jitter (s) and its speed (rad/s)",
    Torque => "the test's torque must be positive and finite, and within the shaft's bring the first guess of the \
        inertia to the test's speed in half an hour (N m)",
    ShaftTorque => "the largest torque of the shaft must be above the holding torque of the load, and finite (N m)",
    Speed => "the test's speed must make eight turns in an hour, and less than a quarter turn in a tick (rad/s)",
    Travel => "the travel must be positive and finite, and suffice for the tests of friction and encoder (rad)",
    Held => "the torque that holds the load at the start must be finite (N m)",
    Inertia => "the first guess of the inertia must be positive and finite (kg m2)",
    Band => "the band of the resonance must rise from at least 0.01 Hz to at most a tenth of the rate of the ticks \
        (Hz)",
    TorqueAccuracy => "the accuracy of the torque must be positive and finite (N m)",
    Delay => "the delay of the torque must be zero or above and finite (s)",
    AngleJump => "the angle moved by more in a tick than three times the test's speed explains: is the encoder \
        connected?",
    NotFollowed => "the motor does not follow the test's torque: more torque, a load that is free, the right first \
        guess of the inertia and the right sign of the angle are expected",
    Unsteady => "the shaft swings: begin the band lower (the shaft has little damping), or give a smaller first \
        guess of the inertia",
    TravelExceeded => "the motor left the travel: the load that is held, the first guess of the inertia, or the sign \
        of the torque is wrong",
    TravelTooShort => "the travel is too short for a record that tells the resonance: more travel, less speed, or a \
        narrower band is expected",
    InertiaUnclear => "the inertia is not told by the ramps: more torque of the shaft or a friction that depends on \
        speed alone is expected",
    Rigid => "no resonance in the band, with as much torque as the shaft may carry: the machine is rigid up to the \
        band's end",
    ResonanceUnclear => "there is a resonance, but the data do not tell where: more torque, more travel or a finer \
        encoder is expected",
    ResonanceOutside => "the resonance lies outside the band, or at its edge: a wider band is expected",
    AntiresonanceUnclear => "the antiresonance is not told apart from the resonance: the load is too light beside the \
        motor to be weighed",
    LoadNotHeld => "no gap is identified: friction does not hold the load against the test's torque",
    Preloaded => "no gap is identified: the weight of the load closes it",
    GapBelowResolution => "the gap is below what the encoder resolves",
    GapUnclear => "the ends of the gap did not repeat: a load that friction holds is expected",
}
