//! The table of variants: their names, the type behind each, and on a host what starts one by its name.

use driveline::number::Fixed;

use super::Variant;
use crate::scenes::VARIANTS;

#[cfg(not(target_os = "none"))]
pub use host::{Row, find};

/// The variant on line `LINE` of the table.
pub trait Select<const LINE: usize> {
    /// The variant.
    type Variant: Variant;
}

/// The table of variants, whose lines are chosen by [`Select`].
#[derive(Clone, Copy, Debug)]
pub struct Table;

/// The variant on a line of the table.
pub type Line<const LINE: usize> = <Table as Select<LINE>>::Variant;

/// The line of the variant called `name`.
///
/// # Panics
/// When there is none, with the names that there are; at compile time, where the binaries call it.
pub const fn line(name: &str) -> usize {
    let mut line = 0;
    while line < VARIANTS.len() {
        if same(VARIANTS[line].as_bytes(), name.as_bytes()) {
            return line;
        }
        line += 1;
    }
    let mut text = [0; 8192];
    let mut length = append(&mut text, 0, &["DRIVELINE_VARIANT is `", name, "`; firmware/src/scenes.rs has"]);
    let mut line = 0;
    while line < VARIANTS.len() {
        length = append(&mut text, length, &[" `", VARIANTS[line], "`"]);
        line += 1;
    }
    match core::str::from_utf8(text.split_at(length).0) {
        Ok(text) => panic!("{}", text),
        Err(_) => panic!("DRIVELINE_VARIANT names no variant of firmware/src/scenes.rs"),
    }
}

const fn same(one: &[u8], other: &[u8]) -> bool {
    let mut at = 0;
    while at < one.len() && at < other.len() && one[at] == other[at] {
        at += 1;
    }
    at == one.len() && at == other.len()
}

/// Writes parts one after another from `at` on, as far as they fit, and gives the end.
const fn append(text: &mut [u8], mut at: usize, parts: &[&str]) -> usize {
    let mut part = 0;
    while part < parts.len() {
        let bytes = parts[part].as_bytes();
        let mut byte = 0;
        while byte < bytes.len() && at < text.len() {
            text[at] = bytes[byte];
            at += 1;
            byte += 1;
        }
        part += 1;
    }
    at
}

/// The name of a number in a variant's name.
pub trait Named {
    /// The name.
    const NAME: &'static str;
}

impl Named for f32 {
    const NAME: &'static str = "f32";
}

impl Named for Fixed {
    const NAME: &'static str = "fixed";
}

/// A variant's name, made of its module (`driveline_firmware::scenes::crane_travel`), number, observer and rate, and
/// its length.
pub const fn name(module: &str, number: &str, observer: &str, rate_hz: u32) -> ([u8; 64], usize) {
    let mut text = [0; 64];
    let mut start = module.len();
    while start > 0 && module.as_bytes()[start - 1] != b':' {
        start -= 1;
    }
    let mut end = append(&mut text, 0, &[module.split_at(start).1]);
    let mut at = 0;
    while at < end {
        if text[at] == b'_' {
            text[at] = b'-';
        }
        at += 1;
    }
    end = append(&mut text, end, &["/", number, "/", observer, "/"]);
    let mut digit = 1;
    while rate_hz / digit >= 10 {
        digit *= 10;
    }
    while digit > 0 {
        text[end] = b'0' + (rate_hz / digit % 10) as u8;
        end += 1;
        digit /= 10;
    }
    (text, end)
}

/// The name of the scene whose variants have these names: the part before the first stroke.
///
/// # Panics
/// For a scene without variants.
pub const fn scene(names: &[&'static str]) -> &'static str {
    let name = names[0];
    let mut end = 0;
    while end < name.len() && name.as_bytes()[end] != b'/' {
        end += 1;
    }
    name.split_at(end).0
}

/// The names of several scenes in one list.
pub const fn flat<const COUNT: usize>(scenes: &[&[&'static str]]) -> [&'static str; COUNT] {
    let mut names = [""; COUNT];
    let (mut scene, mut at) = (0, 0);
    while scene < scenes.len() {
        let mut variant = 0;
        while variant < scenes[scene].len() {
            names[at] = scenes[scene][variant];
            at += 1;
            variant += 1;
        }
        scene += 1;
    }
    names
}

/// The number of names in a list of scenes.
pub const fn count(scenes: &[&[&str]]) -> usize {
    let (mut scene, mut count) = (0, 0);
    while scene < scenes.len() {
        count += scenes[scene].len();
        scene += 1;
    }
    count
}

/// Gives a binary `Selected`, the variant that `DRIVELINE_VARIANT` names, and `driveline_tick`, its tick as a function
/// of its own, so that its code and instructions can be measured.
///
/// `selected!("name")` is for a binary with another default than the hoist's. Only the binary depends on the choice:
/// the library with all scenes is compiled once for all variants.
#[macro_export]
macro_rules! selected {
    () => {
        $crate::selected!("hoist/f32/reduced/10000");
    };
    ($default:literal) => {
        /// The variant that this image holds; the default where none is named.
        type Selected = $crate::scene::table::Line<
            {
                $crate::scene::table::line(match option_env!("DRIVELINE_VARIANT") {
                    Some(name) => name,
                    None => $default,
                })
            },
        >;

        /// One tick of the scene that this image holds.
        #[unsafe(no_mangle)]
        #[unsafe(link_section = ".text.driveline_tick")]
        #[inline(never)]
        extern "Rust" fn driveline_tick(
            scene: &mut <Selected as $crate::scene::Variant>::Scene,
            input: &$crate::scene::Input,
            output: &mut $crate::scene::Output,
        ) {
            *output = $crate::scene::Scene::tick(scene, input);
        }
    };
}

/// Lists a scene's variants: a name of the observer or of what else tells them apart, the drive, and the machines that
/// it is for.
///
/// `variants! { "rigid": Rigid for Fan; }` needs a type `Rigid<N>` and a machine `Fan`; each line is a variant in `f32`
/// and one in fixed point. `variants! { f32: "rigid": Rigid for Fan; }` is in `f32` alone. A scene of another kind
/// implements [`Variant`] itself: `variants! { Empty }`.
macro_rules! variants {
    ($($text:literal: $drive:ident for $($machine:ty),+;)+) => {
        $($(
            $crate::scene::table::variants!(@of f32, $text, $drive, $machine);
            $crate::scene::table::variants!(@of driveline::number::Fixed, $text, $drive, $machine);
        )+)+
        $crate::scene::table::variants! {
            $($(
                $crate::scene::Of<$machine, $drive<f32>>,
                $crate::scene::Of<$machine, $drive<driveline::number::Fixed>>,
            )+)+
        }
    };
    (f32: $($text:literal: $drive:ident for $machine:ty;)+) => {
        $($crate::scene::table::variants!(@of f32, $text, $drive, $machine);)+
        $crate::scene::table::variants! { $($crate::scene::Of<$machine, $drive<f32>>,)+ }
    };
    (@of $number:ty, $text:literal, $drive:ident, $machine:ty) => {
        impl $crate::scene::Variant for $crate::scene::Of<$machine, $drive<$number>> {
            type Scene = $drive<$number>;
            const NAME: &'static str = {
                const NUMBER: &str = <$number as $crate::scene::table::Named>::NAME;
                const RATE_HZ: u32 = <$machine as driveline::configure::Machine>::RATE_HZ;
                const NAME: ([u8; 64], usize) = $crate::scene::table::name(module_path!(), NUMBER, $text, RATE_HZ);
                const EXACTLY: [u8; NAME.1] = *NAME.0.first_chunk().expect("a shorter name");
                match core::str::from_utf8(&EXACTLY) {
                    Ok(name) => name,
                    Err(_) => panic!("a name is ASCII"),
                }
            };
            const RATE_HZ: u32 = <$machine as driveline::configure::Machine>::RATE_HZ;

            fn start() -> Self::Scene {
                $crate::scene::FromConfig::from_config(<Self as $crate::scene::Constants>::CONFIG)
            }

            fn expected() -> Option<$crate::scene::expected::Expected> {
                <<$drive<$number> as $crate::scene::FromConfig>::Drive as
                    $crate::scene::expected::Expects<$machine>>::expected()
            }
        }

        impl $crate::scene::Constants for $crate::scene::Of<$machine, $drive<$number>> {
            const CONFIG: &'static driveline::drive::ConfigOf<<$drive<$number> as $crate::scene::FromConfig>::Drive> =
                &<<$drive<$number> as $crate::scene::FromConfig>::Drive as driveline::configure::Configure<
                    $machine,
                    $number,
                >>::CONFIG;
        }
    };
    ($($variant:ty),+ $(,)?) => {
        /// The scene's name.
        pub const SCENE: &str = $crate::scene::table::scene(NAMES);

        /// The names of the scene's variants.
        pub const NAMES: &[&str] = &[$(<$variant as $crate::scene::Variant>::NAME),+];

        /// The scene's variants, to be started by their names.
        #[cfg(not(target_os = "none"))]
        pub static ROWS: &[$crate::scene::table::Row] = &[$($crate::scene::table::Row::of::<$variant>()),+];

        $(
            impl $crate::scene::table::Select<
                { $crate::scene::table::line(<$variant as $crate::scene::Variant>::NAME) }
            > for $crate::scene::table::Table {
                type Variant = $variant;
            }
        )+
    };
}
pub(crate) use variants;

/// The number type that a variant's words are bit patterns of, from its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Words {
    /// `f32` in SI units.
    Single,
    /// `i32`, per unit of the scene's limits.
    Fixed,
}

impl Words {
    /// The words of a variant.
    pub const fn of<V: Variant>() -> Self {
        Words::named(V::NAME)
    }

    /// The words of the variant called `name`: the second part of its name, `f32` or else fixed point.
    pub const fn named(name: &str) -> Self {
        let name = name.as_bytes();
        let mut at = 0;
        while at + 4 < name.len() {
            if name[at] == b'/' {
                let single = name[at + 1] == b'f' && name[at + 2] == b'3' && name[at + 3] == b'2';
                return if single { Words::Single } else { Words::Fixed };
            }
            at += 1;
        }
        Words::Fixed
    }
}

/// What only a host does with the table.
#[cfg(not(target_os = "none"))]
mod host {
    use alloc::boxed::Box;

    use super::{Variant, Words};
    use crate::scene::expected::Expected;
    use crate::scene::{Input, Output, Scene};
    use crate::scenes::ROWS;

    /// A variant, to be started by its name.
    #[derive(Clone, Copy, Debug)]
    pub struct Row {
        /// Its name.
        pub name: &'static str,
        /// Ticks a second.
        pub rate_hz: u32,
        start: fn() -> Box<dyn Scene>,
        expected: fn() -> Option<Expected>,
    }

    impl Row {
        /// Of a variant.
        pub const fn of<V: Variant>() -> Self {
            Row { name: V::NAME, rate_hz: V::RATE_HZ, start: || Box::new(V::start()), expected: V::expected }
        }

        /// The drive at rest.
        pub fn start(&self) -> Box<dyn Scene> {
            (self.start)()
        }

        /// What the design says of its observer's errors, as [`Variant::expected`].
        pub fn expected(&self) -> Option<Expected> {
            (self.expected)()
        }

        /// Whether a drive at rest gives these outputs for these inputs, their instructions aside.
        pub fn gives(&self, exchanged: &[(Input, Output)]) -> bool {
            let mut scene = self.start();
            exchanged.iter().all(|(input, output)| scene.exchange(input) == Output { instructions: 0, ..*output })
        }

        /// The kind of its words.
        pub const fn words(&self) -> Words {
            Words::named(self.name)
        }
    }

    /// The variant called `name`; `None` where there is none.
    pub fn find(name: &str) -> Option<&'static Row> {
        ROWS.iter().flat_map(|scene| scene.iter()).find(|row| row.name == name)
    }
}
