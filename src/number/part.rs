//! Parts of a drive, named without their number.

/// A part of a drive, or of a part. Its name has no number: `TwoMassObserver`, `SpeedLoop<SetpointLag>`. `()` is a part
/// that is left out, a tuple is several.
///
/// A drive names its number once, and holds the [`State`](Self::State) of each part in that number. On its own, such a
/// name is the state in `f32`. A part of one's own names its state, which may be itself:
///
/// ```
/// # use driveline::number::Part;
/// struct MyFilter;
/// impl Part<f32> for MyFilter {
///     type State = Self;
/// }
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no part of a drive in `{N}`",
    note = "name the number once and each part without it: `Drive<Fixed, TwoMassObserver, SpeedLoop>`",
    note = "a part of one's own implements `driveline::number::Part`"
)]
pub trait Part<N> {
    /// Its state, in the number `N`.
    type State;
}

/// The state of a part in a number: `StateOf<SpeedLoop<SetpointLag>, Fixed>`.
pub type StateOf<P, N> = <P as Part<N>>::State;

impl<N> Part<N> for () {
    type State = ();
}

impl<N, A: Part<N>, B: Part<N>> Part<N> for (A, B) {
    type State = (A::State, B::State);
}

impl<N, A: Part<N>, B: Part<N>, C: Part<N>> Part<N> for (A, B, C) {
    type State = (A::State, B::State, C::State);
}
