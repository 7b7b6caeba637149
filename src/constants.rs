//! Loops, `?` and `unwrap` for `const fn`, which has none of them.

/// A block for each value of an integer in a range, or while a condition holds. The range starts with one token, or in
/// parentheses. No `continue`.
macro_rules! each {
    ($k:ident, $from:tt..$to:expr, $body:block) => {{
        #[allow(unused_parens)]
        let mut $k = $from;
        while $k < $to {
            $body
            $k += 1;
        }
    }};
    ($k:ident, $from:tt.., $while:expr, $body:block) => {{
        #[allow(unused_parens)]
        let mut $k = $from;
        while $while {
            $body
            $k += 1;
        }
    }};
}

/// The value of a result, or the function's return with its error.
macro_rules! get {
    ($result:expr) => {
        match $result {
            Ok(value) => value,
            Err(error) => return Err(error),
        }
    };
    ($result:expr, $wrapped:expr) => {
        match $result {
            Ok(value) => value,
            Err(error) => return Err($wrapped(error)),
        }
    };
}

/// The value of a result, or the error's sentence: a compile error in a constant.
macro_rules! or_stop {
    ($result:expr) => {
        match $result {
            Ok(value) => value,
            Err(error) => error.stop(),
        }
    };
}

/// The form of a `try_` function that stops where it returns an error.
macro_rules! stops {
    (
        $(#[$doc:meta])*
        pub const fn $name:ident$(<const $N:ident: usize>)?(
            &$this:ident $(, $argument:ident: $type:ty)* $(,)?
        ) -> $out:ty = $try:ident
    ) => {
        stops! {
            @one [$(#[$doc])*] $name [$(const $N: usize)?] (&$this, $($argument: $type),*) $out,
            $this.$try($($argument),*)
        }
    };
    (
        $(#[$doc:meta])*
        pub const fn $name:ident$(<const $N:ident: usize>)?(
            $this:ident $(, $argument:ident: $type:ty)* $(,)?
        ) -> $out:ty = $try:ident
    ) => {
        stops! {
            @one [$(#[$doc])*] $name [$(const $N: usize)?] ($this, $($argument: $type),*) $out,
            $this.$try($($argument),*)
        }
    };
    (
        $(#[$doc:meta])*
        pub const fn $name:ident$(<const $N:ident: usize>)?(
            $($argument:ident: $type:ty),* $(,)?
        ) -> $out:ty = $try:ident
    ) => {
        stops! {
            @one [$(#[$doc])*] $name [$(const $N: usize)?] ($($argument: $type),*) $out,
            Self::$try$(::<$N>)?($($argument),*)
        }
    };
    (@one [$($doc:tt)*] $name:ident [$($generic:tt)*] ($($parameters:tt)*) $out:ty, $result:expr) => {
        $($doc)*
        ///
        /// # Panics
        /// At compile time in a constant, with the sentence of the error that the `try_` form returns.
        #[must_use]
        pub const fn $name<$($generic)*>($($parameters)*) -> $out {
            or_stop!($result)
        }
    };
}
