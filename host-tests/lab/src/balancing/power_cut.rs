//! Power cuts while a rotor is balanced: after every entry the controller loses its memory, and a new one goes on from
//! the flash.

use std::io;

use driveline_firmware::panel::flash_model::WORDS;
use driveline_firmware::scene::panel_keys::{DONE, Key};
use driveline_firmware::scene::{Input, Output};

use driveline_closed_loop::ticks::Ticks;

/// Content of the flash once it is done.
const ENTRIES: [Key; 5] = [Key::RunOut, Key::Baseline, Key::Trial, Key::Placed, Key::Verified];
/// Most planes of a scene.
const PLANES: u32 = 3;

/// Switches a controller on.
pub type Start<'d> = Box<dyn FnMut() -> io::Result<Box<dyn Ticks + 'd>> + 'd>;

/// A drive that is cut off after every entry. Its flash content is put into the next one, which resumes; the machine
/// coasts meanwhile.
pub struct PowerCuts<'d> {
    drive: Box<dyn Ticks + 'd>,
    start: Start<'d>,
    /// Cuts so far.
    pub cuts: usize,
    /// Those after which the panel gave another answer, or another weight, than the one that was cut off.
    pub differing: usize,
}

impl<'d> PowerCuts<'d> {
    /// Switches the first controller on.
    ///
    /// # Errors
    /// What the link says.
    pub fn new(mut start: Start<'d>) -> io::Result<Self> {
        Ok(PowerCuts { drive: start()?, start, cuts: 0, differing: 0 })
    }

    fn cut(&mut self, last: &Input) -> io::Result<()> {
        // the brake is closed: no torque
        let held = Input { flags: 0, setpoint: 0, ..*last };
        let ask = |drive: &mut dyn Ticks, key: Key, value: u32| {
            drive.tick(&Input { asked: [key as u32, value], ..held }).map(|output| output.answer)
        };
        let mut next = (self.start)()?;
        ask(&mut *next, Key::PutPlace, 0)?;
        for place in 0..WORDS as u32 {
            let word = ask(&mut *self.drive, Key::FlashWord, place)?;
            ask(&mut *next, Key::PutWord, word)?;
        }
        let resumed = ask(&mut *next, Key::Resume, 0)?;
        // the same step next, and where there are weights the same weights to the bit
        let says = |drive: &mut dyn Ticks| -> io::Result<Vec<u32>> {
            let mut words = vec![ask(drive, Key::Next, 0)?, ask(drive, Key::Solve, 0)?];
            if words[1] == DONE {
                for plane in 0..PLANES {
                    words.push(ask(drive, Key::AddRe, plane)?);
                    words.push(ask(drive, Key::AddIm, plane)?);
                }
            }
            Ok(words)
        };
        let same = says(&mut *self.drive)? == says(&mut *next)?;
        self.differing += usize::from(resumed != DONE || !same);
        self.cuts += 1;
        self.drive = next;
        Ok(())
    }
}

impl Ticks for PowerCuts<'_> {
    fn tick(&mut self, input: &Input) -> io::Result<Output> {
        let output = self.drive.tick(input)?;
        let [key, _] = input.asked;
        if output.answer == DONE && ENTRIES.iter().any(|&entry| entry as u32 == key) {
            self.cut(input)?;
        }
        Ok(output)
    }
}
