//! A spur pair with rectangular mesh stiffness whose periodic motion is known to 40 digits (`gear_mesh.json`).

use serde::Deserialize;

use driveline_solver::plant::train::{Coordinate, Link, Motion, Signal, Source, Train, Variation};

const FILE: &str = include_str!("../../../../tests/data/gear_mesh.json");

#[derive(Deserialize)]
struct Cases {
    cases: Vec<Pair>,
}

/// The pair; names and units are the file's.
#[derive(Clone, Deserialize)]
#[allow(non_snake_case, missing_docs)]
pub struct Pair {
    pub J1_kg_m2: f64,
    pub J2_kg_m2: f64,
    pub rb1_m: f64,
    pub rb2_m: f64,
    pub equivalent_mass_m_kg: f64,
    pub k_single_pair_zone_N_m: f64,
    pub k_double_pair_zone_N_m: f64,
    pub k_mean_N_m: f64,
    pub contact_ratio: f64,
    pub c_Ns_m: f64,
    pub T1_Nm: f64,
    pub Fn_N: f64,
    pub rel_tol: f64,
    pub points: Vec<Point>,
}

/// Its motion at a mesh frequency.
#[derive(Clone, Deserialize)]
#[allow(non_snake_case, missing_docs)]
pub struct Point {
    pub mesh_frequency_ratio: f64,
    pub mesh_frequency_Hz: f64,
    pub dynamic_factor_elastic_max: f64,
    pub dynamic_factor_total_max: f64,
    pub Fd_total_min_over_Fn: f64,
    pub Fd_elastic_min_over_Fn: f64,
    pub x_max_m: f64,
    pub x_min_m: f64,
    pub x_state_at_start_of_double_zone: [f64; 2],
    pub teeth_separate_in_linear_model: bool,
}

/// The pair of the file.
pub fn pair() -> Result<Pair, String> {
    let cases = serde_json::from_str::<Cases>(FILE).map_err(|error| error.to_string())?.cases;
    cases.into_iter().next().ok_or_else(|| "the file has no pair".to_owned())
}

impl Pair {
    /// Pinion and wheel on free shafts, driven and braked by torques in balance; the mesh at `x` with the closing speed
    /// `v`.
    pub fn drive(&self, frequency: f64, error: f64, gap: f64, x: f64, v: f64) -> Result<Motion, String> {
        let brake = -self.T1_Nm * self.rb2_m / self.rb1_m;
        let (double, single) = (self.k_double_pair_zone_N_m, self.k_single_pair_zone_N_m);
        let variation = Variation::spur(self.contact_ratio, frequency, double, single, error);
        // both give way as they would from rest, so that only the mesh moves
        let shares = [self.rb1_m / self.J1_kg_m2, -self.rb2_m / self.J2_kg_m2];
        let start = shares.map(|share| v * self.equivalent_mass_m_kg * share);
        let mesh = Link::mesh((0, self.rb1_m), (1, self.rb2_m), self.k_mean_N_m)
            .damping(self.c_Ns_m)
            .varying(variation)
            .gap(gap)
            .elongated(x);
        Train::new()
            .coordinate(Coordinate::new(self.J1_kg_m2).speed(start[0]).source(Source::Constant(self.T1_Nm)))
            .coordinate(Coordinate::new(self.J2_kg_m2).speed(start[1]).source(Source::Constant(brake)))
            .link(mesh)
            .build()
            .map_err(|error| error.to_string())
    }

    /// Elongation of the mesh, and its speed.
    pub fn state(&self, motion: &Motion) -> [f64; 2] {
        [motion.elongation(0), self.rb1_m * motion.speed(0) - self.rb2_m * motion.speed(1)]
    }

    /// The state that a linear train comes back to after a period, from three runs of one period.
    pub fn periodic(&self, point: &Point) -> Result<[f64; 2], String> {
        let period = 1.0 / point.mesh_frequency_Hz;
        let map = |x: f64, v: f64| -> Result<[f64; 2], String> {
            let mut motion = self.drive(point.mesh_frequency_Hz, 0.0, 0.0, x, v)?;
            motion.advance(period);
            Ok(self.state(&motion))
        };
        // steps of the size of the motion itself
        let (dx, dv) = (1e-5, 0.1);
        let (zero, one, two) = (map(0.0, 0.0)?, map(dx, 0.0)?, map(0.0, dv)?);
        let a =
            [[(one[0] - zero[0]) / dx, (two[0] - zero[0]) / dv], [(one[1] - zero[1]) / dx, (two[1] - zero[1]) / dv]];
        let m = [[1.0 - a[0][0], -a[0][1]], [-a[1][0], 1.0 - a[1][1]]];
        let det = m[0][0] * m[1][1] - m[0][1] * m[1][0];
        Ok([(m[1][1] * zero[0] - m[0][1] * zero[1]) / det, (m[0][0] * zero[1] - m[1][0] * zero[0]) / det])
    }

    /// The solver's result at a point against the file: found, expected, and the reference of their difference.
    pub fn compared(&self, point: &Point) -> Result<Vec<(&'static str, [f64; 3])>, String> {
        let start = self.periodic(point)?;
        let [x, v] = point.x_state_at_start_of_double_zone;
        // a velocity may be near zero: against the largest that the deflection brings at the mesh frequency
        let fast = point.x_max_m * std::f64::consts::TAU * point.mesh_frequency_Hz;
        let mut motion = self.drive(point.mesh_frequency_Hz, 0.0, 0.0, start[0], start[1])?;
        let signals = [Signal::Force(0), Signal::Elastic(0), Signal::Elongation(0)];
        signals.iter().for_each(|&signal| motion.watch(signal));
        motion.advance(1.0 / point.mesh_frequency_Hz);
        let mut extremes = Vec::new();
        for signal in signals {
            extremes.push(motion.extremes(signal).ok_or("a signal that is watched has no extremes")?);
        }
        let (total, elastic, elongation) = (&extremes[0], &extremes[1], &extremes[2]);
        Ok(vec![
            ("x", [start[0], x, x.abs()]),
            ("v", [start[1], v, fast.max(v.abs())]),
            ("K total", [total.peak / self.Fn_N, self.total_peak(point), 1.0]),
            ("K elastic", [elastic.peak / self.Fn_N, point.dynamic_factor_elastic_max, 1.0]),
            ("least total", [total.least / self.Fn_N, point.Fd_total_min_over_Fn, 1.0]),
            ("least elastic", [elastic.least / self.Fn_N, point.Fd_elastic_min_over_Fn, 1.0]),
            ("x max", [elongation.peak, point.x_max_m, point.x_max_m]),
            ("x min", [elongation.least, point.x_min_m, point.x_max_m]),
        ])
    }

    /// Greatest force over the static one, by the closed form of a damped swing in each zone from the case's own state.
    pub fn total_peak(&self, point: &Point) -> f64 {
        let (m, c, force) = (self.equivalent_mass_m_kg, self.c_Ns_m, self.Fn_N);
        let pitch = 1.0 / point.mesh_frequency_Hz;
        let [mut x, mut v] = point.x_state_at_start_of_double_zone;
        let mut peak = 0.0_f64;
        let two = self.contact_ratio - 1.0;
        for (length, k) in [(two, self.k_double_pair_zone_N_m), (1.0 - two, self.k_single_pair_zone_N_m)] {
            let decay = c / (2.0 * m);
            let omega = (k / m - decay * decay).sqrt();
            let (a, b) = (x - force / k, (v + decay * (x - force / k)) / omega);
            let at = |t: f64| {
                let (sine, cosine) = (omega * t).sin_cos();
                let x = force / k + (-decay * t).exp() * (a * cosine + b * sine);
                let v = (-decay * t).exp() * ((b * omega - decay * a) * cosine - (a * omega + decay * b) * sine);
                (x, v)
            };
            // k x + c v = force + exp(-decay t) (p cos + q sin), flat where p and q turn by the angle below
            let (p, q) = (k * a + c * (b * omega - decay * a), k * b - c * (a * omega + decay * b));
            let flat = (q * omega - decay * p).atan2(p * omega + decay * q) / omega;
            let length = length * pitch;
            let half = std::f64::consts::PI / omega;
            let within = (-2..200).map(|i| flat + f64::from(i) * half).filter(|t| (0.0..=length).contains(t));
            for t in within.chain([0.0, length]) {
                let (x, v) = at(t);
                peak = peak.max((k * x + c * v) / force);
            }
            (x, v) = at(length);
        }
        peak
    }
}
