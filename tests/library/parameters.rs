//! Parameters in a flash whose power is cut anywhere.

use driveline::balancing::{self, Complex, Influence, Plan, Procedure, ProcedureStep, Run};
use driveline::parameters::{Error, Loaded, Parameters, RecordError, Store};
use embedded_storage::nor_flash::{ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash};
use serde::{Deserialize, Serialize};

use crate::flash::PAGE;

/// Bytes that are programmed at once, as in an STM32G4.
const WORD: usize = 8;
const PAGES: usize = 2;
const RANGE: std::ops::Range<u32> = 0..(PAGES * PAGE) as u32;

/// A flash that loses its power after so many bytes; what was being written or erased then is any bits.
#[derive(Clone)]
struct Flash {
    bytes: Vec<u8>,
    written: Vec<bool>,
    /// Whether a word that was being programmed at the cut cannot be read, for its check fails; and such words.
    checks: bool,
    torn: Vec<usize>,
    /// A byte that is worn: it stays zero.
    worn: Option<usize>,
    /// Bytes until the power is cut.
    left: usize,
    random: u32,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Cut;

impl NorFlashError for Cut {
    fn kind(&self) -> NorFlashErrorKind {
        NorFlashErrorKind::Other
    }
}

impl Flash {
    fn new() -> Self {
        let length = PAGES * PAGE;
        Flash {
            bytes: vec![0xff; length],
            written: vec![false; length / WORD],
            checks: false,
            torn: Vec::new(),
            worn: None,
            left: usize::MAX,
            random: 2_463_534_242,
        }
    }

    fn any(&mut self) -> u8 {
        self.random ^= self.random << 13;
        self.random ^= self.random >> 17;
        self.random ^= self.random << 5;
        self.random as u8
    }
}

impl ErrorType for Flash {
    type Error = Cut;
}

impl ReadNorFlash for Flash {
    const READ_SIZE: usize = 1;
    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Cut> {
        if self.left == 0 {
            return Err(Cut);
        }
        let range = offset as usize..offset as usize + bytes.len();
        if self.torn.iter().any(|word| range.contains(&(word * WORD))) {
            return Err(Cut);
        }
        bytes.copy_from_slice(&self.bytes[range.clone()]);
        if let Some(worn) = self.worn.filter(|worn| range.contains(worn)) {
            bytes[worn - range.start] = 0;
        }
        Ok(())
    }
    fn capacity(&self) -> usize {
        self.bytes.len()
    }
}

impl NorFlash for Flash {
    const WRITE_SIZE: usize = WORD;
    const ERASE_SIZE: usize = PAGE;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), Cut> {
        // a word's worth of time for each word
        for word in from as usize / WORD..to as usize / WORD {
            if self.left < WORD {
                // the pages are left at any bits
                for byte in from as usize..to as usize {
                    self.bytes[byte] |= self.any();
                }
                self.left = 0;
                return Err(Cut);
            }
            self.left -= WORD;
            self.bytes[word * WORD..(word + 1) * WORD].fill(0xff);
            self.written[word] = false;
            self.torn.retain(|&torn| torn != word);
        }
        Ok(())
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Cut> {
        assert!((offset as usize).is_multiple_of(WORD) && bytes.len().is_multiple_of(WORD));
        for (word, bytes) in (offset as usize / WORD..).zip(bytes.chunks(WORD)) {
            assert!(!self.written[word], "word {word} is written twice");
            self.written[word] = true;
            for (place, &byte) in (word * WORD..).zip(bytes) {
                if self.left == 0 {
                    if self.checks {
                        self.torn.push(word);
                    }
                    // part of the word is programmed
                    for rest in place..(word + 1) * WORD {
                        self.bytes[rest] &= self.any();
                    }
                    return Err(Cut);
                }
                self.left -= 1;
                self.bytes[place] = byte;
            }
        }
        Ok(())
    }
}

/// A form of parameters under an identity and a version; as a record it is what it holds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Form<T, const IDENTITY: u32, const VERSION: u16>(T);

impl<T: Serialize + serde::de::DeserializeOwned, const IDENTITY: u32, const VERSION: u16> Parameters
    for Form<T, IDENTITY, VERSION>
{
    const IDENTITY: u32 = IDENTITY;
    const VERSION: u16 = VERSION;
}

const OWN: u32 = 0x4857_0001;

/// What a drive keeps, a run of the balancing among it.
type Kept = Form<Values, OWN, 3>;

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Values {
    inertia: f32,
    stiffness: f32,
    influence: Vec<f32>,
}

fn kept(number: u32) -> Kept {
    let influence = (0..200).map(|at| (number * 1000 + at) as f32).collect();
    Form(Values { inertia: number as f32, stiffness: 0.5, influence })
}

fn save<P: Parameters>(flash: &mut Flash, parameters: &P) -> Result<(), Error<Cut>> {
    let mut store = Store::new(flash.clone(), RANGE).unwrap();
    let saved = store.save(parameters, &mut [0; 4096]);
    *flash = store.release();
    saved
}

/// Power on again, and read.
fn load<P: Parameters>(flash: &mut Flash) -> Loaded<P> {
    flash.left = usize::MAX;
    let mut store = Store::new(flash.clone(), RANGE).unwrap();
    let loaded = store.load(&mut [0; 4096]).unwrap();
    *flash = store.release();
    loaded
}

#[test]
fn an_empty_flash_has_nothing_and_what_is_saved_is_there() {
    let mut flash = Flash::new();
    assert_eq!(load::<Kept>(&mut flash), Loaded { parameters: None, refused: None });
    for number in 0..50 {
        save(&mut flash, &kept(number)).unwrap();
        assert_eq!(load(&mut flash), Loaded { parameters: Some(kept(number)), refused: None });
    }
}

/// The check says that a record is whole, not that its parameters are some: a count of four thousand million values,
/// say.
#[test]
fn a_sound_record_of_nonsense_is_refused_and_the_last_good_one_kept() {
    for count in [[0xff, 0xff, 0xff, 0xff, 0x0f], [0xff; 5], [0x7f; 5], [2, 0, 0, 0, 0]] {
        let mut flash = Flash::new();
        save(&mut flash, &kept(1)).unwrap();
        // two numbers of four bytes, then the count of the values; an array has no count before it
        let mut nonsense = [0; 13];
        nonsense[8..].copy_from_slice(&count);
        save(&mut flash, &Form::<_, OWN, 3>(nonsense)).unwrap();
        let Loaded { parameters, refused } = load::<Kept>(&mut flash);
        assert_eq!((parameters, refused), (Some(kept(1)), Some(RecordError::Content)), "{count:?}");
    }
    // a page of any bytes
    let mut flash = Flash::new();
    save(&mut flash, &kept(1)).unwrap();
    for _ in 0..1000 {
        for place in PAGE..2 * PAGE {
            flash.bytes[place] = flash.any();
        }
        flash.bytes[PAGE..PAGE + 4].copy_from_slice(b"DLP1");
        let Loaded { parameters, refused } = load::<Kept>(&mut flash);
        assert_eq!((parameters, refused), (Some(kept(1)), Some(RecordError::Damaged)));
    }
}

/// A flash with a check of each word, as the STM32G4's: what is half programmed cannot be read at all.
#[test]
fn a_record_that_the_flash_does_not_give_is_refused_and_the_other_one_taken() {
    let mut flash = Flash { checks: true, ..Flash::new() };
    save(&mut flash, &kept(0)).unwrap();
    save(&mut flash, &kept(1)).unwrap();
    flash.left = usize::MAX;
    let mut uncut = flash.clone();
    save(&mut uncut, &kept(2)).unwrap();
    let whole = usize::MAX - uncut.left;
    let mut unreadable = 0;
    for point in (0..whole).step_by(11) {
        let mut cut = flash.clone();
        cut.left = point;
        assert_eq!(save(&mut cut, &kept(2)), Err(Error::Flash(Cut)), "{point}");
        let Loaded { parameters, refused } = load::<Kept>(&mut cut);
        assert_eq!(parameters, Some(kept(1)), "{point}");
        unreadable += usize::from(refused == Some(RecordError::Unreadable));
        save(&mut cut, &kept(3)).unwrap();
        assert_eq!(load(&mut cut), Loaded { parameters: Some(kept(3)), refused: None }, "{point}");
    }
    assert!(unreadable > 10, "{unreadable}");
}

#[test]
fn a_flash_that_gives_neither_record_is_an_error_and_nothing_is_erased() {
    let mut flash = Flash::new();
    save(&mut flash, &kept(1)).unwrap();
    save(&mut flash, &kept(2)).unwrap();
    flash.torn = vec![0, PAGE / WORD];
    let before = flash.bytes.clone();
    let mut store = Store::new(flash.clone(), RANGE).unwrap();
    assert_eq!(store.load::<Kept>(&mut [0; 4096]), Err(Error::Flash(Cut)));
    assert_eq!(store.save(&kept(3), &mut [0; 4096]), Err(Error::Flash(Cut)));
    assert!(store.release().bytes == before);
}

#[test]
fn what_a_worn_page_does_not_hold_is_not_said_to_be_kept() {
    for worn in (0..800).step_by(3) {
        let mut flash = Flash::new();
        save(&mut flash, &kept(1)).unwrap();
        save(&mut flash, &kept(2)).unwrap();
        flash.worn = Some(worn);
        let saved = save(&mut flash, &kept(3));
        // a byte that is to be zero is none the worse
        let held = load::<Kept>(&mut flash).parameters;
        match saved {
            Ok(()) => assert_eq!(held, Some(kept(3)), "{worn}"),
            Err(error) => assert_eq!((error, held), (Error::Unwritten, Some(kept(2))), "{worn}"),
        }
    }
}

#[test]
fn any_damaged_byte_is_no_other_parameters() {
    let mut flash = Flash::new();
    save(&mut flash, &kept(1)).unwrap();
    save(&mut flash, &kept(2)).unwrap();
    for place in (0..2 * PAGE).step_by(3) {
        let mut damaged = flash.clone();
        damaged.bytes[place] ^= 0x10;
        let mut store = Store::new(damaged, RANGE).unwrap();
        let found = store.load::<Kept>(&mut [0; 4096]).unwrap().parameters.unwrap();
        assert!(found == kept(1) || found == kept(2), "{place}");
    }
}

/// The same form from another firmware, and another form from this one.
type Foreign = Form<Values, 0x4857_0002, 3>;
type Older = Form<f32, OWN, 2>;
type Longer = Form<(Values, u8), OWN, 3>;

#[test]
fn records_of_others_are_refused_with_the_reason() {
    let mut flash = Flash::new();
    save::<Foreign>(&mut flash, &Form(kept(7).0)).unwrap();
    let refused = load::<Kept>(&mut flash);
    assert_eq!(refused, Loaded { parameters: None, refused: Some(RecordError::Foreign(0x4857_0002)) });
    assert_eq!(refused.refused.unwrap().to_string(), "the record is another firmware's, 0x48570002");
    let mut flash = Flash::new();
    save::<Older>(&mut flash, &Form(1.0)).unwrap();
    assert_eq!(load::<Kept>(&mut flash).refused, Some(RecordError::Version(2)));
    let mut flash = Flash::new();
    save::<Longer>(&mut flash, &Form((kept(7).0, 1))).unwrap();
    assert_eq!(load::<Kept>(&mut flash).refused, Some(RecordError::Content));
}

#[test]
fn the_last_good_one_is_kept_beside_one_that_is_refused() {
    let mut flash = Flash::new();
    save(&mut flash, &kept(1)).unwrap();
    save(&mut flash, &kept(2)).unwrap();
    // an older firmware finds nothing of its own, and takes one of the two places
    save::<Older>(&mut flash, &Form(1.0)).unwrap();
    let Loaded { parameters, refused } = load::<Kept>(&mut flash);
    assert_eq!((parameters, refused), (Some(kept(2)), Some(RecordError::Version(2))));
}

/// A form before that of [`Kept`], which had more to keep.
type Before = Form<(f32, Vec<f32>), OWN, 2>;

fn before(number: u32) -> Before {
    Form((number as f32, (0..300).map(|at| (number * 1000 + at) as f32).collect()))
}

/// Whose records stand in the two halves when a new firmware comes, in the order of their saves.
#[derive(Clone, Copy, Debug)]
enum Saved {
    Before(u32),
    Kept(u32),
    Foreign(u32),
}

/// What the new firmware reads, and what the older one would.
fn loaded(flash: &mut Flash) -> (Option<Kept>, Option<Before>) {
    (load::<Kept>(flash).parameters, load::<Before>(flash).parameters)
}

#[test]
fn a_power_cut_leaves_the_old_record_or_the_new() {
    // at each place of a word in turn
    assert!(cuts_of_every_history(7) > 1000);
}

#[test]
#[ignore = "a minute"]
fn a_power_cut_at_every_byte_of_every_history() {
    println!("measured: {} cuts", cuts_of_every_history(1));
}

/// Cuts at every so many bytes of a save, through the whole save; the number of cuts.
fn cuts_of_every_history(every: usize) -> usize {
    use Saved::{Before as B, Foreign as F, Kept as K};
    let mut points = 0;
    for history in [
        &[K(1)][..],
        &[K(1), K(2)],
        &[K(1), K(2), K(3)],
        &[B(1)],
        &[B(1), B(2)],
        &[B(1), B(2), B(3)],
        &[F(1), B(2)],
        &[B(1), F(2)],
        &[B(1), B(2), F(3)],
        &[K(1), B(2)],
        &[K(1), K(2), B(3)],
        &[B(1), K(2)],
    ] {
        let mut flash = Flash::new();
        for &record in history {
            match record {
                B(number) => save(&mut flash, &before(number)),
                K(number) => save(&mut flash, &kept(number)),
                F(number) => save::<Foreign>(&mut flash, &Form(kept(number).0)),
            }
            .unwrap();
        }
        let old = loaded(&mut flash);
        assert!(old.0.is_some() || old.1.is_some(), "{history:?}");
        let start = flash.clone();
        save(&mut flash, &kept(100)).unwrap();
        let whole = usize::MAX - flash.left;
        assert_eq!(loaded(&mut flash).0, Some(kept(100)), "{history:?}");
        for point in (0..whole).step_by(every) {
            let mut cut = start.clone();
            cut.left = point;
            cut.random ^= point as u32;
            assert_eq!(save(&mut cut, &kept(100)), Err(Error::Flash(Cut)), "{history:?}, {point}");
            let (own, older) = loaded(&mut cut);
            match old.0.clone() {
                // what this firmware had it has, or the new ones
                Some(had) => assert!(own == Some(had) || own == Some(kept(100)), "{history:?}, {point}: {own:?}"),
                // it had none: those of the form before are there, or the new ones
                None => assert!(own == Some(kept(100)) || own.is_none() && older == old.1, "{history:?}, {point}"),
            }
            points += 1;
            save(&mut cut, &kept(101)).unwrap();
            assert_eq!(load(&mut cut).parameters, Some(kept(101)), "{history:?}, {point}");
        }
    }
    points
}

/// A record that the buffer has no room for cannot be checked; it is not taken for nothing.
#[test]
fn a_longer_record_of_an_older_version_is_not_erased_first() {
    let (mut flash, short): (_, Form<f32, OWN, 4>) = (Flash::new(), Form(7.0));
    save(&mut flash, &before(1)).unwrap();
    let mut store = Store::new(flash.clone(), RANGE).unwrap();
    // the older one has 1200 bytes and more
    store.save(&short, &mut [0; 300]).unwrap();
    flash = store.release();
    assert_eq!(load::<Before>(&mut flash).parameters, Some(before(1)));
    assert_eq!(load(&mut flash).parameters, Some(short));
}

#[test]
fn what_does_not_fit_is_said_and_nothing_is_lost() {
    let mut flash = Flash::new();
    save(&mut flash, &kept(1)).unwrap();
    let large: Kept = Form(Values { influence: vec![1.0; 3000], ..kept(2).0 });
    let mut store = Store::new(flash.clone(), RANGE).unwrap();
    assert_eq!(store.save(&large, &mut [0; 65_536]), Err(Error::TooLarge));
    assert_eq!(store.save(&kept(2), &mut [0; 300]), Err(Error::TooLarge));
    // a buffer that holds no record at all does not say that there is none
    assert_eq!(store.load::<Kept>(&mut [0; 21]), Err(Error::TooLarge));
    assert_eq!(store.load::<Kept>(&mut []), Err(Error::TooLarge));
    assert_eq!(store.load(&mut [0; 4096]).unwrap().parameters, Some(kept(1)));
    assert!(Store::new(Flash::new(), 0..PAGE as u32).is_err_and(|error| error == Error::Range));
    assert!(Store::new(Flash::new(), 7..3 * PAGE as u32).is_err_and(|error| error == Error::Range));
}

type Field = Procedure<f64, 2, 2, 4>;
type FieldRecord = balancing::ProcedureRecord<{ Field::words(2, 2) + 1 }>;

/// A rotor that two sensors feel, and what is on it.
struct Rotor {
    influence: Influence<f64, 2, 2>,
    on: [Complex<f64>; 2],
}

impl Rotor {
    fn new() -> Self {
        let mut influence = Influence::new(2, 2).unwrap();
        influence.set(0, &[Complex::new(1.0, 0.4), Complex::new(-0.3, 0.2)]).unwrap();
        influence.set(1, &[Complex::new(0.2, -0.5), Complex::new(0.8, 0.9)]).unwrap();
        Rotor { influence, on: [Complex::new(0.0, 0.0); 2] }
    }

    fn run(&self) -> Run<f64, 2> {
        let found = [Complex::new(5.0, 1.0), Complex::new(-2.0, 3.0)];
        Run::new(&self.influence.predict(&found, &self.on).unwrap(), &[155.0; 2]).unwrap()
    }

    /// Does the next step, and says what was put on at last.
    fn step(&mut self, field: &mut Field) {
        let trial = Complex::new(1.5, 0.5);
        match field.next() {
            ProcedureStep::Baseline => field.baseline(&self.run()).unwrap(),
            ProcedureStep::Trial { plane } => {
                self.on[plane] = trial;
                field.trial(plane, trial, &self.run()).unwrap();
                self.on[plane] = Complex::new(0.0, 0.0);
            }
            ProcedureStep::Correction | ProcedureStep::Trim => {
                // set a tenth wrong the first time
                let share = if field.next() == ProcedureStep::Trim { 1.0 } else { 0.9 };
                let weights = field.correction().unwrap().weights.map(|weight| weight * share);
                // the rotor has them whether the entry is kept or not
                let before = field.weights();
                self.on = [before[0] + weights[0], before[1] + weights[1]];
                field.installed(&weights).unwrap();
            }
            ProcedureStep::Verify => field.verified(&self.run()).unwrap(),
            ProcedureStep::Done => {}
        }
    }
}

/// The record of a balancing through the store: the power is cut at every seventh byte of the save of every step. What
/// is loaded is the procedure before the step or after it, and it ends at the same weights.
#[test]
fn a_balancing_goes_on_after_a_power_cut_at_any_step() {
    let plan = Plan::usual(2, 2, 1e-9);
    let whole = {
        let (mut rotor, mut field) = (Rotor::new(), Field::new(plan).unwrap());
        while field.next() != ProcedureStep::Done {
            rotor.step(&mut field);
        }
        field.weights()
    };
    let keep = |flash: &mut Flash, field: &Field| save(flash, &FieldRecord::of(field, &[0x5eed]).unwrap());
    let (mut flash, mut rotor, mut field) = (Flash::new(), Rotor::new(), Field::new(plan).unwrap());
    keep(&mut flash, &field).unwrap();
    flash.left = usize::MAX;
    let (mut cuts, mut steps, mut lost) = (0, 0, 0);
    while field.next() != ProcedureStep::Done {
        let (before, kept) = (field.clone(), flash.clone());
        rotor.step(&mut field);
        keep(&mut flash, &field).unwrap();
        let bytes = usize::MAX - flash.left;
        flash.left = usize::MAX;
        for point in (0..bytes).step_by(7) {
            let mut cut = Flash { left: point, ..kept.clone() };
            assert_eq!(keep(&mut cut, &field), Err(Error::Flash(Cut)));
            let mut own = [0];
            let found: FieldRecord = load(&mut cut).parameters.unwrap();
            let mut resumed: Field = found.resume(plan, &mut own).unwrap();
            assert!(resumed == before || resumed == field, "step {steps}, cut after {point} of {bytes} bytes");
            assert_eq!(own, [0x5eed]);
            lost += usize::from(resumed == before);
            let mut rotor = Rotor { influence: rotor.influence, on: rotor.on };
            if resumed.next() == ProcedureStep::Verify || resumed == before {
                rotor.on = resumed.weights();
            }
            while resumed.next() != ProcedureStep::Done {
                rotor.step(&mut resumed);
            }
            assert_eq!(resumed.weights(), whole, "step {steps}, cut after {point} of {bytes} bytes");
            cuts += 1;
        }
        steps += 1;
    }
    println!("{cuts} cuts in {steps} steps: {lost} steps were to be done again");
    // baseline, two trials, correction, run, trim, run
    assert_eq!((field.weights(), steps), (whole, 7));
    assert!(cuts > 500 && lost > 0 && lost < cuts, "{cuts} {lost}");
    // a record of another plan is refused
    let other: FieldRecord = load(&mut flash).parameters.unwrap();
    let resumed: Result<Field, _> = other.resume(Plan { leave_trials: true, ..plan }, &mut [0]);
    assert!(matches!(resumed, Err(balancing::Error::Record { .. })));
}

/// A buffer that holds the record but not the words that it is read in: it is too small, and no page is erased for it.
#[test]
fn a_buffer_that_ends_within_a_word_is_too_small() {
    let small: Kept = Form(Values { inertia: 1.0, stiffness: 0.5, influence: Vec::new() });
    let mut store = Store::new(crate::flash::Flash::<32, 1>::erased(), RANGE).unwrap();
    // 18 bytes of head, 9 of parameters, 4 of check.
    for (length, kept) in [(30, false), (31, false), (32, true), (33, true), (63, true)] {
        let saved = store.save(&small, &mut vec![0; length]);
        assert_eq!(saved, if kept { Ok(()) } else { Err(Error::TooLarge) }, "{length}");
        let loaded = store.load::<Kept>(&mut [0; 64]).unwrap();
        assert_eq!(loaded, Loaded { parameters: kept.then(|| small.clone()), refused: None }, "{length}");
    }
}
