//! Requests to the panel of a balancing scene, as words of [`Input::asked`](crate::scene::Input::asked).
//!
//! A key and a value go in after a tick, a word comes back. Weights, vibrations and their like travel as the bits of
//! `f32`, real and imaginary part one after the other; planes, rows and channels are counted from 0. An impossible
//! request is answered with [`refused`] and changes nothing.

/// Defines the keys from their numbers.
macro_rules! keys {
    ($($(#[$text:meta])* $key:ident = $word:literal,)+) => {
        /// Keys of the requests. Zero is none.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(u32)]
        pub enum Key {
            $($(#[$text])* $key = $word,)+
        }

        impl Key {
            /// The key of a word.
            pub fn of(word: u32) -> Option<Key> {
                match word {
                    $($word => Some(Key::$key),)+
                    _ => None,
                }
            }
        }
    };
}

keys! {
    /// Begin a reading. Answers [`DONE`].
    Begin = 1,
    /// Is there a reading? Answers [`MEASURING`], [`DONE`], or [`refused`] with the number of the doubt.
    State = 2,
    /// Keep the reading of both channels as the run-out of a slow roll, which is taken off all later ones.
    RunOut = 3,
    /// Keep the reading of both channels as two rows of the run, from row `value` on.
    Row = 4,
    /// The next step: one of [`next`].
    Next = 5,
    /// The run is the baseline.
    Baseline = 6,
    /// The real part of the trial weight that was set, in kg m.
    WeightRe = 7,
    /// Its imaginary part.
    WeightIm = 8,
    /// The run was made with the trial weight in plane `value`: its influence is learnt.
    Trial = 9,
    /// Solve for the weights that take the present vibration away.
    Solve = 10,
    /// The real part of the weight to be added in plane `value`.
    AddRe = 11,
    /// Its imaginary part.
    AddIm = 12,
    /// The weights of the solution were put on.
    Placed = 13,
    /// The run was made with them.
    Verified = 14,
    /// Take the last entry back.
    TakeBack = 15,
    /// The real part of row `value` of the run.
    RowRe = 16,
    /// Its imaginary part.
    RowIm = 17,
    /// The root mean square that the solution predicts for the rows.
    Predicted = 18,
    /// The condition number of the solution.
    Condition = 19,
    /// Balance by the head, by itself: on (1) or off (0).
    Balance = 20,
    /// The real part of the balancing head's correction.
    HeadRe = 21,
    /// Its imaginary part.
    HeadIm = 22,
    /// Power is on again: go on from the record in the flash. Answers [`DONE`], or refuses where there is none.
    Resume = 23,
    /// Word `value` of the flash.
    FlashWord = 24,
    /// The place of the flash that the next [`Key::PutWord`] goes to.
    PutPlace = 25,
    /// A word of the flash, as a programmer puts it there; the place goes on by one.
    PutWord = 26,
    /// The grade of the residual unbalance that the head leaves (mm/s); 0 before it holds.
    Grade = 27,
}

/// Answers to [`Key::Next`].
pub mod next {
    /// A run as the rotor is.
    pub const BASELINE: u32 = 1;
    /// Solve, put the weights on.
    pub const CORRECTION: u32 = 2;
    /// A run with them.
    pub const VERIFY: u32 = 3;
    /// Solve again with the coefficients that are known, put the weights on.
    pub const TRIM: u32 = 4;
    /// Good enough.
    pub const DONE: u32 = 5;
    /// A run with a trial weight in plane `answer - TRIAL`.
    pub const TRIAL: u32 = 16;
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

/// Whether an answer refuses. Figures are bits of floats, which are above; a count or a next step among these answers
/// is taken for a refusal.
pub const fn is_refusal(answer: u32) -> bool {
    answer >= REFUSED && answer <= 0xff
}
