//! What in-run balancing remembers over a power cut.

use super::{InRun, InRunConfig};
use crate::balancing::error::Error;
use crate::balancing::matrix::Matrix;
use crate::balancing::scalar::{Complex, given, zero};

/// Record of in-run balancing: the weights to return to, and the influence.
///
/// ```
/// use driveline::balancing::{BalancingMemory, BalancingRecord, Complex};
/// // what a head goes back to after a power cut; an `Option` is a memory that keeps its content
/// let mut memory = None;
/// memory.save(&BalancingRecord::<1, 1>::new([Complex::new(0.004, 0.0)]))?;
/// assert_eq!(memory.load()?.map(|record| record.weights), Some([Complex::new(0.004, 0.0)]));
/// # Ok::<(), core::convert::Infallible>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
// Not logged: the complex numbers of `nalgebra` have no `Format`.
pub struct BalancingRecord<const ROWS: usize, const PLANES: usize> {
    /// Weights to return to (kg m): the best ones, or those that it began with.
    pub weights: [Complex<f32>; PLANES],
    /// Largest amplitude of the very first reading (unit of the sensors); 0 before it.
    pub first: f32,
    /// Speed of the readings (rad/s); 0 before them.
    pub speed: f32,
    /// Influence of each plane on each row (unit of the sensors per kg m).
    pub influence: [[Complex<f32>; PLANES]; ROWS],
    /// Standard deviation of each plane's influence; 0 where it is not known.
    pub deviation: [f32; PLANES],
}

impl<const ROWS: usize, const PLANES: usize> BalancingRecord<ROWS, PLANES> {
    /// Nothing known; the heads stand at `weights` (kg m).
    pub fn new(weights: [Complex<f32>; PLANES]) -> Self {
        let influence = [[zero(); PLANES]; ROWS];
        BalancingRecord { weights, first: 0.0, speed: 0.0, influence, deviation: [0.0; PLANES] }
    }

    /// Its numbers, one after the other.
    #[cfg(feature = "parameters")]
    fn numbers(&mut self) -> impl Iterator<Item = &mut f32> {
        let weights = self.weights.iter_mut().chain(self.influence.iter_mut().flatten());
        let complex = weights.flat_map(|z| [&mut z.re, &mut z.im]);
        complex.chain([&mut self.first, &mut self.speed]).chain(&mut self.deviation)
    }

    fn is_sound(&self) -> bool {
        let positive = |x: &f32| *x >= 0.0 && x.is_finite();
        self.weights.iter().chain(self.influence.iter().flatten()).all(|z| given(*z))
            && [self.first, self.speed].iter().chain(&self.deviation).all(positive)
    }
}

impl<const ROWS: usize, const PLANES: usize> InRun<f32, ROWS, PLANES> {
    /// Goes on from a record, the heads at its weights. What was learnt has to be confirmed, as after
    /// [`InRun::resume`].
    ///
    /// # Errors
    /// As [`InRun::new`]; [`Error::Record`] where a number of it is none.
    pub fn remembered(config: InRunConfig<f32, PLANES>, record: &BalancingRecord<ROWS, PLANES>) -> Result<Self, Error> {
        let mut run = InRun::new(config, ROWS, record.weights)?;
        if !record.is_sound() {
            return Err(Error::Record { word: 0 });
        }
        run.first = record.first;
        if record.deviation.iter().all(|deviation| *deviation > 0.0) {
            run.estimate.remember(Matrix::of(record.influence), &record.deviation);
        }
        run.resume(&record.weights);
        Ok(run)
    }

    /// Largest amplitude of the very first reading; 0 before it.
    pub(crate) fn first_level(&self) -> f32 {
        self.first
    }

    /// Largest change of a row by a move, as the influence is estimated.
    pub(crate) fn predicted_change(&self, from: &[Complex<f32>; PLANES], to: &[Complex<f32>; PLANES]) -> f32 {
        let mut moved = *to;
        for (moved, from) in moved.iter_mut().zip(from) {
            *moved -= *from;
        }
        self.estimate.largest_change(&moved)
    }

    /// What is to be remembered; `speed` is that of the readings (rad/s).
    pub fn record(&self, speed: f32) -> BalancingRecord<ROWS, PLANES> {
        let mut record = BalancingRecord { first: self.first, speed, ..BalancingRecord::new(self.home()) };
        if self.estimate.confirmed() {
            record.influence = self.estimate.coefficients();
            for (plane, deviation) in record.deviation.iter_mut().enumerate() {
                *deviation = self.estimate.deviation(plane);
            }
        }
        record
    }

    /// Residual unbalance by a reading (kg m); none before the influence is confirmed.
    ///
    /// It is the sum of the weights that the planes lack, and what is left of the reading beside them over the least
    /// effective plane's influence: an upper estimate.
    pub fn residual(&self, reading: &[Complex<f32>; ROWS]) -> Option<f32> {
        self.estimate.confirmed().then(|| self.estimate.residual(reading))
    }
}

#[cfg(feature = "parameters")]
mod stored {
    use core::fmt;

    use serde::de::{Error, SeqAccess, Visitor};
    use serde::ser::SerializeTuple;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    use super::BalancingRecord;
    use crate::balancing::scalar::zero;
    use crate::parameters::Parameters;

    impl<const ROWS: usize, const PLANES: usize> BalancingRecord<ROWS, PLANES> {
        /// Numbers of a record.
        const NUMBERS: usize = 2 * PLANES * (1 + ROWS) + 2 + PLANES;
    }

    impl<const ROWS: usize, const PLANES: usize> Serialize for BalancingRecord<ROWS, PLANES> {
        fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
            let (mut record, mut tuple) = (*self, serializer.serialize_tuple(Self::NUMBERS)?);
            for number in record.numbers() {
                tuple.serialize_element(number)?;
            }
            tuple.end()
        }
    }

    struct Numbers<const ROWS: usize, const PLANES: usize>;

    impl<'de, const ROWS: usize, const PLANES: usize> Visitor<'de> for Numbers<ROWS, PLANES> {
        type Value = BalancingRecord<ROWS, PLANES>;

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str("the numbers of a record of balancing")
        }

        fn visit_seq<A: SeqAccess<'de>>(self, mut numbers: A) -> Result<Self::Value, A::Error> {
            let mut record = BalancingRecord::new([zero(); PLANES]);
            for number in record.numbers() {
                *number = numbers.next_element()?.ok_or_else(|| A::Error::custom("too short"))?;
            }
            Ok(record)
        }
    }

    impl<'de, const ROWS: usize, const PLANES: usize> Deserialize<'de> for BalancingRecord<ROWS, PLANES> {
        fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
            deserializer.deserialize_tuple(Self::NUMBERS, Numbers)
        }
    }

    /// "BLR"; the number of rows and planes in the version.
    impl<const ROWS: usize, const PLANES: usize> Parameters for BalancingRecord<ROWS, PLANES> {
        const IDENTITY: u32 = 0x424c_5200;
        const VERSION: u16 = (ROWS as u16) << 8 | PLANES as u16;
    }
}
