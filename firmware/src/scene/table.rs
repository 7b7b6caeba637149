//! A scene's variants: their names, the type behind each, and on a host its row of the table.

use driveline::number::Fixed;

use super::Variant;

#[cfg(not(target_os = "none"))]
pub use host::Row;

/// The variant whose name has the [`key`] `KEY`.
pub trait Select<const KEY: u64> {
    /// The variant.
    type Variant: Variant;
}

/// The table of variants, one of which [`Select`] chooses.
#[derive(Clone, Copy, Debug)]
pub struct Table;

/// The number that a variant's name stands for in [`Select`]: FNV-1a, 64 bit. Of two names with one number, the second
/// does not compile.
pub const fn key(name: &str) -> u64 {
    let (mut key, mut at) = (0xcbf2_9ce4_8422_2325_u64, 0);
    while at < name.len() {
        key = (key ^ name.as_bytes()[at] as u64).wrapping_mul(0x0000_0100_0000_01b3);
        at += 1;
    }
    key
}

/// Writes parts one after another from `at` on, as far as they fit, and gives the end.
pub(crate) const fn append(text: &mut [u8], mut at: usize, parts: &[&str]) -> usize {
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
            const CHANNELS: &'static [driveline::telemetry::Channel<'static>] =
                <$drive<$number> as $crate::scene::FromConfig>::CHANNELS;

            #[inline]
            fn start() -> Self::Scene {
                let at_rest: fn() -> Self::Scene = const { $crate::scene::at_rest::<Self> };
                at_rest()
            }
        }

        impl<Any> $crate::scene::Constants<Any> for $crate::scene::Of<$machine, $drive<$number>> {
            const CONFIG: &'static driveline::drive::ConfigOf<<$drive<$number> as $crate::scene::FromConfig>::Drive> =
                const {
                    &<<$drive<$number> as $crate::scene::FromConfig>::Drive as driveline::configure::Configure<
                        $machine,
                        $number,
                    >>::CONFIG
                };
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
                { $crate::scene::table::key(<$variant as $crate::scene::Variant>::NAME) }
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
    use crate::scene::{Input, Output, Scene};

    /// A variant, to be started by its name.
    #[derive(Clone, Copy, Debug)]
    pub struct Row {
        /// Its name.
        pub name: &'static str,
        /// Ticks a second.
        pub rate_hz: u32,
        start: fn() -> Box<dyn Scene>,
    }

    impl Row {
        /// Of a variant.
        pub const fn of<V: Variant>() -> Self {
            Row { name: V::NAME, rate_hz: V::RATE_HZ, start: || Box::new(V::start()) }
        }

        /// The drive at rest.
        pub fn start(&self) -> Box<dyn Scene> {
            (self.start)()
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
}
