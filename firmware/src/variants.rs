//! The table of variants as an alias (which type this image holds), as names, and as types that a host can visit.

use crate::scene::Scene;

/// What is to be done with the type behind a variant's name, for [`visit`](crate::selected::visit).
pub trait Visitor {
    /// What doing it gives.
    type Outcome;
    /// Does it with scene `S`.
    fn visit<S: Scene>(self) -> Self::Outcome;
}

/// Defines `Selected`, `VARIANTS` and `visit` from lines of `"name" => Type`.
macro_rules! variants {
    ($($name:literal => $scene:ty,)+) => {
        $(
            /// The variant that this image holds.
            #[cfg(driveline_variant = $name)]
            pub type Selected = $scene;
        )+

        #[cfg(not(any($(driveline_variant = $name),+)))]
        compile_error!(concat!(
            "DRIVELINE_VARIANT is `", env!("DRIVELINE_VARIANT"), "`; firmware/src/selected.rs has", $(" `", $name, "`"),+
        ));

        /// The names of all variants.
        pub const VARIANTS: &[&str] = &[$($name),+];

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
