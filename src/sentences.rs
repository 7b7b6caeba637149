//! Errors that carry one sentence for each variant.

/// An error enum from lines of `Variant => "sentence"`: documentation, `message()`, `Display` and `Error`.
/// `[Variant(Other)]` before the lines wraps an error of another kind.
macro_rules! sentences {
    ($(#[$meta:meta])* $error:ident: $([$outer:ident($inner:ty)])? $($name:ident => $sentence:literal),+ $(,)?) => {
        $(#[$meta])*
        ///
        /// [`Display`](core::fmt::Display) gives a sentence that names the parameter.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[cfg_attr(feature = "defmt", derive(defmt::Format))]
        #[non_exhaustive]
        pub enum $error {
            $(
                #[doc = concat!("An error of [`", stringify!($inner), "`].")]
                $outer($inner),
            )?
            $(#[doc = $sentence] $name),+
        }

        impl $error {
            /// All with a sentence of their own, in order.
            pub const ALL: &'static [Self] = &[$(Self::$name),+];

            /// The sentence that names the parameter and the reason.
            #[must_use]
            pub const fn message(self) -> &'static str {
                match self {
                    $(Self::$outer(error) => error.message(),)?
                    $(Self::$name => $sentence),+
                }
            }
        }

        messages!($error);
    };
}

/// `Display` and `Error` of a type with a `message()`.
macro_rules! messages {
    ($error:ident) => {
        impl core::fmt::Display for $error {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                f.write_str(self.message())
            }
        }

        impl core::error::Error for $error {}
    };
}
