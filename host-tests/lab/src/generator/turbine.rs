//! A steam turbine without reheat: a valve and a steam chest, each a lag [IEEE PES-TR1 2013 §2.1, TGOV1], and a torque
//! that falls with speed to half at twice the rated speed [Wang 1989 (1-6)].

/// A running turbine.
#[derive(Clone, Debug)]
pub struct Turbine {
    rated_torque: f64,
    rated_speed: f64,
    lags: [f64; 2],
    valve: f64,
    chest: f64,
    seized: bool,
}

impl Turbine {
    /// A turbine without steam, of a rated torque (N m) and speed (rad/s), with the lags of valve and chest (s).
    pub fn new(rated_torque: f64, rated_speed: f64, lags: [f64; 2]) -> Self {
        Turbine { rated_torque, rated_speed, lags, valve: 0.0, chest: 0.0, seized: false }
    }

    /// The valve stays where it is from now on.
    pub fn seize(&mut self) {
        self.seized = true;
    }

    /// The torque that the chest's pressure stands for (N m).
    pub fn chest(&self) -> f64 {
        self.chest
    }

    /// Runs on by `dt` with the valve commanded to a torque, at a speed (rad/s): its torque.
    pub fn advance(&mut self, command: f64, speed: f64, dt: f64) -> f64 {
        let [valve, chest] = self.lags;
        if !self.seized {
            let command = command.clamp(0.0, 1.2 * self.rated_torque);
            self.valve = command + (self.valve - command) * (-dt / valve).exp();
        }
        self.chest = self.valve + (self.chest - self.valve) * (-dt / chest).exp();
        self.chest * (1.5 - 0.5 * speed / self.rated_speed)
    }
}
