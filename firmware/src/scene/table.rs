//! The table of variants: as names, as the type that an image holds, and as types that a host can visit.

use crate::scene::Scene;

/// What is to be done with the type behind a variant's name, for [`visit`](crate::variants::visit).
pub trait Visitor {
    /// What doing it gives.
    type Outcome;
    /// Does it with scene `S`.
    fn visit<S: Scene>(self) -> Self::Outcome;
}

/// The type behind line `LINE` of the table of variants.
pub trait Select<const LINE: usize> {
    /// The type.
    type Scene: Scene;
}

/// The table of variants, whose lines are chosen by [`Select`].
#[derive(Clone, Copy, Debug)]
pub struct Table;

/// The line of the variant called `name`.
///
/// # Panics
/// When there is none, with the names that there are; at compile time, where the binaries call it.
pub const fn line(name: &str, names: &[&str]) -> usize {
    let mut line = 0;
    while line < names.len() {
        if same(names[line].as_bytes(), name.as_bytes()) {
            return line;
        }
        line += 1;
    }
    let mut text = [0; 8192];
    let mut length = append(&mut text, 0, &["DRIVELINE_VARIANT is `", name, "`; firmware/src/variants.rs has"]);
    let mut line = 0;
    while line < names.len() {
        length = append(&mut text, length, &[" `", names[line], "`"]);
        line += 1;
    }
    match core::str::from_utf8(text.split_at(length).0) {
        Ok(text) => panic!("{}", text),
        Err(_) => panic!("DRIVELINE_VARIANT names no line of firmware/src/variants.rs"),
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

/// Gives a binary `Selected`, the scene that `DRIVELINE_VARIANT` names, and `driveline_tick`, its tick as a function of its own, so that
/// its code and instructions can be measured.
///
/// `selected!("name")` is for a binary with another default than the hoist's. Only the binary depends on the choice: the library with all scenes is compiled once for all variants.
#[macro_export]
macro_rules! selected {
    () => {
        $crate::selected!("hoist/f32/reduced/10000");
    };
    ($default:literal) => {
        /// The line that this image holds; the default where none is named.
        const LINE: usize = $crate::scene::table::line(
            match option_env!("DRIVELINE_VARIANT") {
                Some(name) => name,
                None => $default,
            },
            $crate::variants::VARIANTS,
        );
        /// The scene that this image holds.
        type Selected = <$crate::scene::table::Table as $crate::scene::table::Select<LINE>>::Scene;

        /// One tick of the scene that this image holds.
        #[unsafe(no_mangle)]
        #[unsafe(link_section = ".text.driveline_tick")]
        #[inline(never)]
        extern "Rust" fn driveline_tick(
            scene: &mut Selected,
            input: &$crate::scene::Input,
            output: &mut $crate::scene::Output,
        ) {
            *output = $crate::scene::Scene::tick(scene, input);
        }
    };
}

/// Defines `VARIANTS`, the lines of [`Table`] and `visit` from lines of `"name" => Type`.
macro_rules! variants {
    ($($name:literal => $scene:ty,)+) => {
        /// The names of all variants.
        pub const VARIANTS: &[&str] = &[$($name),+];

        $(
            impl $crate::scene::table::Select<{ $crate::scene::table::line($name, VARIANTS) }> for $crate::scene::table::Table {
                type Scene = $scene;
            }
        )+

        /// Calls the visitor with the type of the variant called `name`; `None` where there is no such variant.
        pub fn visit<V: $crate::Visitor>(name: &str, visitor: V) -> Option<V::Outcome> {
            match name {
                $($name => Some(visitor.visit::<$scene>()),)+
                _ => None,
            }
        }
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
    /// The words of scene `S`: the second part of its name, `f32` or else fixed point.
    pub const fn of<S: Scene>() -> Self {
        let name = S::NAME.as_bytes();
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
