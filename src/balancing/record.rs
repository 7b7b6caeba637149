//! The record of a procedure as parameters in flash: entries survive a power cut.

use heapless::Vec;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::error::Error;
use super::procedure::{Plan, Procedure};
use super::scalar::Scalar;
use crate::parameters::Parameters;

/// Everything that was entered into a procedure, in at most `WORDS` words: [`Procedure::words`] gives the number
/// needed. In front of them are words of the firmware's own, as the run-out that its readings are less.
///
/// ```
/// use driveline::balancing::{Complex, Plan, Procedure, ProcedureRecord, Run};
#[doc = include_str!("../parameters/flash.txt")]
/// type Field = Procedure<f32, 2, 2>;
/// type Kept = ProcedureRecord<{ Field::words(2, 2) }>;
/// let plan = Plan::usual(2, 2, 1e-4);
/// let mut field = Field::new(plan)?;
/// let mut store = driveline::parameters::Store::new(&mut flash, 0..4096)?;
///
/// // after every entry
/// field.baseline(&Run::new(&[Complex::new(1.0, 0.5), Complex::new(0.0, 2.0)], &[155.0; 2])?)?;
/// store.save(&Kept::of(&field, &[])?, &mut [0; 1024])?;
///
/// // when power is on again
/// let kept: Option<Kept> = store.load(&mut [0; 1024])?.parameters;
/// let resumed = kept.ok_or("nothing was kept")?.resume(plan, &mut [])?;
/// assert_eq!(resumed, field);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
// Not logged: the complex numbers of `nalgebra` have no `Format`.
pub struct ProcedureRecord<const WORDS: usize>(Vec<u32, WORDS>);

impl<const WORDS: usize> ProcedureRecord<WORDS> {
    /// The record of a procedure as it is, with words of the firmware's own.
    ///
    /// # Errors
    /// [`Error::Size`] where there is no room.
    pub fn of<T: Scalar, const ROWS: usize, const PLANES: usize, const TRIALS: usize>(
        procedure: &Procedure<T, ROWS, PLANES, TRIALS>,
        own: &[u32],
    ) -> Result<Self, Error> {
        let mut words = Vec::from_array([0; WORDS]);
        let (front, rest) = words.split_at_mut_checked(own.len()).ok_or(Error::Size)?;
        for (to, word) in front.iter_mut().zip(own) {
            *to = *word;
        }
        let length = procedure.record(rest)?;
        words.truncate(own.len().saturating_add(length));
        Ok(ProcedureRecord(words))
    }

    /// Goes on from it: a procedure of the same plan with everything entered, and the firmware's own words.
    ///
    /// # Errors
    /// [`Error::Record`] with the word at which it is of another plan.
    pub fn resume<T: Scalar, const ROWS: usize, const PLANES: usize, const TRIALS: usize>(
        &self,
        plan: Plan<T, ROWS, PLANES>,
        own: &mut [u32],
    ) -> Result<Procedure<T, ROWS, PLANES, TRIALS>, Error> {
        let (front, rest) = self.0.split_at_checked(own.len()).ok_or(Error::Record { word: self.0.len() })?;
        let procedure = Procedure::resume(plan, rest)?;
        for (to, word) in own.iter_mut().zip(front) {
            *to = *word;
        }
        Ok(procedure)
    }
}

impl<const WORDS: usize> Serialize for ProcedureRecord<WORDS> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.serialize(serializer)
    }
}

impl<'de, const WORDS: usize> Deserialize<'de> for ProcedureRecord<WORDS> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Vec::deserialize(deserializer).map(ProcedureRecord)
    }
}

/// "BAL" and the version of its form; the sizes of the plan are in the words.
impl<const WORDS: usize> Parameters for ProcedureRecord<WORDS> {
    const IDENTITY: u32 = 0x4241_4c00;
    const VERSION: u16 = 1;
}
