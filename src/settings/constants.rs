//! The constructors of a part's constants, for each number.

/// `new` and `try_new` of constants in each number, with the bases behind their own arguments. The body is that of
/// `try_new`, with [`To`] of the number and the format that the bases give it.
macro_rules! constants {
    (
        @one $number:ty, [$($doc:tt)*] [$($generic:tt)*] $name:ident [$($rest:tt)*]
        $new:ident $try_new:ident [$($K:ident)?] ($($argument:ident: $type:ty,)*) $format:ident $body:block
    ) => {
        impl<$($generic)*> $name<$number $($rest)*> {
            /// The constants in this number. Floats are in SI units and leave the bases aside.
            ///
            /// # Panics
            /// At compile time in a constant, with the sentence of the error of the `try_` form.
            pub const fn $new$(<const $K: usize>)?($($argument: $type,)* bases: $crate::settings::Bases) -> Self {
                or_stop!(Self::$try_new$(::<$K>)?($($argument,)* bases))
            }

            /// The constants in this number. Floats are in SI units and leave the bases aside.
            ///
            /// # Errors
            $($doc)*
            pub const fn $try_new$(<const $K: usize>)?(
                $($argument: $type,)* bases: $crate::settings::Bases
            ) -> Result<Self, $crate::settings::Error> {
                #[allow(dead_code)]
                type Number = $number;
                #[allow(dead_code)]
                type To = $crate::settings::to::To<$number>;
                let $format = get!(To::format(bases));
                $body
            }
        }
    };
    ($(
        $(#[$doc:meta])* impl[$($generic:tt)*] $name:ident[$($rest:tt)*],
        $new:ident, $try_new:ident$(<const $K:ident: usize>)?($($argument:ident: $type:ty),*), |$format:ident| $body:block
    )+) => {$(
        constants! {
            @one f32, [$(#[$doc])*] [$($generic)*] $name [$($rest)*]
            $new $try_new [$($K)?] ($($argument: $type,)*) $format $body
        }
        constants! {
            @one f64, [$(#[$doc])*] [$($generic)*] $name [$($rest)*]
            $new $try_new [$($K)?] ($($argument: $type,)*) $format $body
        }
        constants! {
            @one $crate::number::Fixed, [$(#[$doc])*] [$($generic)*] $name [$($rest)*]
            $new $try_new [$($K)?] ($($argument: $type,)*) $format $body
        }
    )+};
}

pub(super) use constants;
