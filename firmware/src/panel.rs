//! What the panel of a scene that is balanced is asked, as words of [`Input::asked`](crate::scene::Input::asked).
//!
//! A key and a value go in after a tick, a word comes back. Weights, vibrations and their like travel as the bits of
//! `f32`, real and
//! imaginary part one after the other; planes, rows and channels are counted from 0. What cannot be done answers with
//! [`refused`],
//! and changes nothing.

/// What is asked. Zero asks for nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Key {
    /// Begin a reading. Answers [`DONE`].
    Begin = 1,
    /// Is there a reading? Answers [`MEASURING`], [`DONE`], or [`refused`] with the number of the doubt.
    State = 2,
    /// Keep the reading of both channels as the run-out of a slow roll, which is taken off all later ones.
    RunOut = 3,
    /// Keep the reading of both channels as two rows of the run, from row `value` on.
    Row = 4,
    /// The run is the baseline.
    Baseline = 5,
    /// The real part of the weight that was set, in kg m.
    WeightRe = 6,
    /// Its imaginary part.
    WeightIm = 7,
    /// The run was made with the weight in plane `value`: its influence is learnt.
    Trial = 8,
    /// Solve for the weights that take the run's vibration away.
    Solve = 9,
    /// The real part of the weight to be added in plane `value`.
    AddRe = 10,
    /// Its imaginary part.
    AddIm = 11,
    /// The real part of row `value` of the run.
    RowRe = 12,
    /// Its imaginary part.
    RowIm = 13,
    /// The root mean square that the solution predicts for the rows.
    Predicted = 14,
    /// The condition number of the solution.
    Condition = 15,
    /// Take the run's reading as a step of balancing in-run, and choose the next place of the head.
    Step = 16,
    /// The real part of the balancing head's correction.
    HeadRe = 17,
    /// Its imaginary part.
    HeadIm = 18,
}

/// Every key.
const KEYS: [Key; 18] = [
    Key::Begin,
    Key::State,
    Key::RunOut,
    Key::Row,
    Key::Baseline,
    Key::WeightRe,
    Key::WeightIm,
    Key::Trial,
    Key::Solve,
    Key::AddRe,
    Key::AddIm,
    Key::RowRe,
    Key::RowIm,
    Key::Predicted,
    Key::Condition,
    Key::Step,
    Key::HeadRe,
    Key::HeadIm,
];

impl Key {
    /// The key of a word.
    pub fn of(word: u32) -> Option<Key> {
        KEYS.iter().copied().find(|key| *key as u32 == word)
    }
}

/// Answer: a reading is under way.
pub const MEASURING: u32 = 0;
/// Answer: done.
pub const DONE: u32 = 1;
/// First of the answers that refuse; the next ones say why.
pub const REFUSED: u32 = 2;

/// The answer that refuses for reason `number`.
pub const fn refused(number: u32) -> u32 {
    REFUSED + number
}
