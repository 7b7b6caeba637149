//! Machines in their own equations: masses, shafts, frictions, and what breaks of them. Classical Runge-Kutta of the
//! fourth order; nothing is shared with the library.

/// Masses in a row, the motor first, all referred to it.
#[derive(Clone, Debug)]
pub struct Plant {
    pub inertia: Vec<f64>,
    /// Stiffness and damping of the shafts between them.
    pub shafts: Vec<[f64; 2]>,
    pub angle: Vec<f64>,
    pub speed: Vec<f64>,
    /// Torque against the last mass, whatever its motion.
    pub load: f64,
    /// Dry friction at the motor: a brake.
    pub brake: f64,
    /// Speed below which friction is proportional to the speed (rad/s).
    pub creep: f64,
    /// The shaft that breaks, and whose torque is observed.
    pub weak: usize,
    /// The mass that cannot move.
    pub jammed: Option<usize>,
    /// It cannot push.
    pub rope: bool,
    /// Largest torque of a coupling in it.
    pub slipping: Option<f64>,
    /// Fastest natural frequency (rad/s).
    fastest: f64,
}

impl Plant {
    pub fn new(inertia: &[f64], shafts: &[[f64; 2]], rated_speed: f64) -> Self {
        let n = inertia.len();
        let weak = (0..shafts.len()).min_by(|&a, &b| shafts[a][0].total_cmp(&shafts[b][0])).unwrap();
        let fastest = shafts
            .iter()
            .enumerate()
            .map(|(at, [k, _])| (k * (1.0 / inertia[at] + 1.0 / inertia[at + 1])).sqrt())
            .fold(0.0, f64::max);
        Plant {
            inertia: inertia.to_vec(),
            shafts: shafts.to_vec(),
            angle: vec![0.0; n],
            speed: vec![0.0; n],
            load: 0.0,
            brake: 0.0,
            creep: 0.002 * rated_speed,
            weak,
            jammed: None,
            rope: false,
            slipping: None,
            fastest,
        }
    }

    /// At rest, its shafts carrying this torque.
    pub fn rest(&mut self, torque: f64) {
        for at in (0..self.shafts.len()).rev() {
            self.angle[at] = self.angle[at + 1] + torque / self.shafts[at][0];
        }
    }

    /// Torque of a shaft.
    pub fn torque(&self, at: usize) -> f64 {
        self.shaft(at, &self.angle, &self.speed)
    }

    fn shaft(&self, at: usize, angle: &[f64], speed: &[f64]) -> f64 {
        let [k, d] = self.shafts[at];
        let rate = speed[at] - speed[at + 1];
        let torque = k * (angle[at] - angle[at + 1]) + d * rate;
        if at != self.weak {
            return torque;
        }
        match self.slipping {
            Some(most) => most * (rate / self.creep).clamp(-1.0, 1.0),
            None if self.rope => torque.max(0.0),
            None => torque,
        }
    }

    fn acceleration(&self, angle: &[f64], speed: &[f64], motor: f64) -> Vec<f64> {
        let n = self.inertia.len();
        let mut torque = vec![0.0; n];
        torque[0] = motor - self.brake * (speed[0] / self.creep).clamp(-1.0, 1.0);
        torque[n - 1] -= self.load;
        for at in 0..n - 1 {
            let shaft = self.shaft(at, angle, speed);
            torque[at] -= shaft;
            torque[at + 1] += shaft;
        }
        let mut acceleration: Vec<f64> = torque.iter().zip(&self.inertia).map(|(t, j)| t / j).collect();
        if let Some(at) = self.jammed {
            acceleration[at] = 0.0;
        }
        acceleration
    }

    /// Runs on by `dt` under a torque of the motor.
    pub fn advance(&mut self, motor: f64, dt: f64) {
        let n = self.inertia.len();
        if let Some(at) = self.jammed {
            self.speed[at] = 0.0;
        }
        // within a fifth of a radian, and half of the time constant of the friction's creep
        let friction = (self.brake + self.slipping.unwrap_or(0.0)) / (self.creep * self.inertia[0]);
        let substeps = (self.fastest * dt / 0.2).max(2.0 * friction * dt).ceil().max(2.0) as usize;
        let h = dt / substeps as f64;
        let along = |base: &[f64], rate: &[f64], by: f64| -> Vec<f64> {
            base.iter().zip(rate).map(|(b, r)| b + by * r).collect()
        };
        for _ in 0..substeps {
            let (x, v) = (self.angle.clone(), self.speed.clone());
            let a1 = self.acceleration(&x, &v, motor);
            let v2 = along(&v, &a1, 0.5 * h);
            let a2 = self.acceleration(&along(&x, &v, 0.5 * h), &v2, motor);
            let v3 = along(&v, &a2, 0.5 * h);
            let a3 = self.acceleration(&along(&x, &v2, 0.5 * h), &v3, motor);
            let v4 = along(&v, &a3, h);
            let a4 = self.acceleration(&along(&x, &v3, h), &v4, motor);
            for i in 0..n {
                self.angle[i] += h / 6.0 * (v[i] + 2.0 * v2[i] + 2.0 * v3[i] + v4[i]);
                self.speed[i] += h / 6.0 * (a1[i] + 2.0 * a2[i] + 2.0 * a3[i] + a4[i]);
            }
        }
    }
}
