//! Errors of the balancing calculations. Earlier entries stay.

use core::fmt;

/// An entry that cannot be used; planes, rows and runs are counted from 0.
///
/// ```
/// use driveline::balancing::{Complex, Error, Influence};
/// let mut fan = Influence::<f64, 2, 2>::new(2, 2)?;
/// // a trial weight that changed nothing: it was put into another plane, or not at all; the coefficients stay
/// let run = [Complex::new(4.0, 0.0), Complex::new(1.0, 2.0)];
/// assert_eq!(fan.learn(1, &run, &run, Complex::new(10.0, 0.0)), Err(Error::NoEffect { plane: 1 }));
/// assert_eq!(fan.unknown(), Some(0));
/// # Ok::<(), driveline::balancing::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
#[expect(missing_docs, reason = "the text of a variant says what its fields are")]
pub enum Error {
    /// More planes, readings or runs than the type has room for, or none.
    Size,
    /// A plane that does not exist.
    NoPlane { plane: usize },
    /// A trial weight of zero.
    TrialWeightZero { plane: usize },
    /// A weight that is not a number.
    Weight { plane: usize },
    /// Fewer readings than rows; the first row without one.
    ReadingMissing { row: usize },
    /// A reading that is not a number.
    Reading { row: usize },
    /// The trial weight changed nothing.
    NoEffect { plane: usize },
    /// The trial run of a plane is there already, and cannot be replaced.
    TrialRepeated { plane: usize },
    /// The influence of a plane is not known yet.
    PlaneUnknown { plane: usize },
    /// More planes than readings.
    MorePlanesThanReadings { planes: usize, readings: usize },
    /// Modal balancing takes as many planes as modes, or two more.
    ModalPlanes { modes: usize, planes: usize },
    /// A weighting of a reading, or a limit of a weight, that is not positive; the row or the plane.
    Setting { index: usize },
    /// The search ended too far from the optimum.
    NotProven,
    /// Trial weights at one place, or three or more on one line through the shaft.
    TrialAngles,
    /// No influence gives such amplitudes.
    AmplitudesDisagree,
    /// Runs at different speeds; the row whose speed is not that of its baseline.
    SpeedDiffers { row: usize },
    /// All phases are so small that they must be in radians.
    PhasesInRadians,
    /// This step has nothing before it to build on.
    TooEarly,
    /// A record that was not written by this procedure, or is damaged; the word at which that shows.
    Record { word: usize },
    /// There are no holes, or no weights, to choose from.
    NothingToFit,
    /// The weight is more than all holes can take.
    TooHeavy { plane: usize },
}

impl Error {
    /// Compile error of a type with room for more planes than readings.
    pub const MORE_PLANES_THAN_READINGS: &str =
        "more planes than readings cannot be separated: measure at another place or speed, or take fewer planes";
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::Size => {
                f.write_str("planes, readings and runs must number at least one, and no more than there is room for")
            }
            Error::NoPlane { plane } => write!(f, "there is no plane {}", plane + 1),
            Error::TrialWeightZero { plane } => {
                write!(f, "the trial weight in plane {} is zero: put a weight there and run again", plane + 1)
            }
            Error::Weight { plane } => write!(f, "the weight in plane {} is not a number", plane + 1),
            Error::ReadingMissing { row } => write!(f, "reading {} is missing", row + 1),
            Error::Reading { row } => write!(f, "reading {} is not a number", row + 1),
            Error::NoEffect { plane } => {
                write!(f, "the trial weight in plane {} changed nothing: take a heavier one", plane + 1)
            }
            Error::TrialRepeated { plane } => {
                write!(f, "plane {} has its trial run already: undo it, or enter an extra one", plane + 1)
            }
            Error::PlaneUnknown { plane } => {
                write!(f, "the influence of plane {} is not known: make its trial run", plane + 1)
            }
            Error::MorePlanesThanReadings { planes, readings } => {
                write!(
                    f,
                    "{planes} planes cannot be separated by {readings} readings: measure at another place or speed"
                )
            }
            Error::ModalPlanes { modes, planes } => {
                write!(f, "balancing {modes} mode(s) takes {modes} plane(s), or two more: there are {planes}")
            }
            Error::Setting { index } => write!(f, "setting {} is not a positive number", index + 1),
            Error::NotProven => f.write_str(
                "the search ended too far from the optimum: take other limits or weightings, or least squares without \
                     limits",
            ),
            Error::TrialAngles => f.write_str(
                "the trial weights stand at one place or on one line through the shaft: put them at angles all around",
            ),
            Error::AmplitudesDisagree => f.write_str(
                "no influence gives these amplitudes: repeat the runs at the same speed, with a heavier trial weight",
            ),
            Error::SpeedDiffers { row } => {
                write!(f, "reading {} was taken at another speed than its baseline: run at the same speed", row + 1)
            }
            Error::PhasesInRadians => {
                f.write_str("all phases are below 2 pi: they seem to be in radians, and degrees are expected")
            }
            Error::TooEarly => f.write_str("a step before this one is still missing"),
            Error::Record { word } => write!(f, "the record is damaged, or of another plan, at word {word}"),
            Error::NothingToFit => f.write_str("there are no holes or no weights to choose from"),
            Error::TooHeavy { plane } => {
                write!(f, "the weight in plane {} is more than its holes can take", plane + 1)
            }
        }
    }
}

impl core::error::Error for Error {}
