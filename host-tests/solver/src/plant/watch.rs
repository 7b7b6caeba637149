//! Greatest and least shaft torques of a run, found where their rate is zero and not on a grid of samples.

use super::extremes::Extremes;
use super::mode::elastic_torque;
use super::root::{derivative, sign_changes};
use super::solver::Plant;
use super::taylor::Stretch;

impl Plant {
    /// Begins to watch the extremes of [`shaft_torque`](Self::shaft_torque) of every shaft. Ticks take some ten times
    /// as long while watched.
    pub fn watch_extremes(&mut self) {
        let time = self.clock.0;
        let now = (0..self.chain.shafts.len()).map(|s| Extremes::of(self.shaft_torque(s), time));
        self.extremes = Some(now.collect());
    }

    /// Extremes of a shaft; none before [`watch_extremes`](Self::watch_extremes) or for a shaft that is not there.
    #[must_use]
    pub fn extremes(&self, shaft: usize) -> Option<Extremes> {
        self.extremes.as_ref()?.get(shaft).copied()
    }

    /// Looks at the part of the stretch up to `share`: both ends and every place where a rate of torque is zero.
    pub(super) fn note_extremes(&mut self, stretch: &Stretch, share: f64) {
        let Some(mut extremes) = self.extremes.take() else {
            return;
        };
        let (x, outer) = (self.x.clone(), self.outer.clone());
        for (s, extreme) in extremes.iter_mut().enumerate() {
            let (row, constant) = elastic_torque(&self.chain, &self.mode, s);
            let rate = derivative(&stretch.form(&row, constant, 0.0).0);
            let mut places = vec![0.0, share];
            // near an extreme an error of 1e-12 of the stretch changes the torque by the square of that
            places.extend(sign_changes(&rate, 1e-12).into_iter().filter(|&p| p < share));
            for place in places {
                let passed = place * stretch.length;
                self.x = stretch.at(place);
                for (j, torque) in self.outer.iter_mut().enumerate() {
                    *torque = outer[j] + self.outer_rate[j] * passed;
                }
                extreme.take(self.shaft_torque(s), self.clock.0 + self.elapsed + passed);
            }
        }
        (self.x, self.outer) = (x, outer);
        self.extremes = Some(extremes);
    }
}
