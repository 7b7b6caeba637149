//! The parts of a drive and the state of each in a number.

use crate::adaptive::*;
use crate::balancing::Phasors;
use crate::fatigue::Rainflow;
use crate::fluctuation::*;
use crate::governor::*;
use crate::learning::{EccentricityNumber, EccentricityObserver};
use crate::number::Part;
use crate::observer::*;
use crate::{angle, configure};

/// Rows of a part, its state in the number `N`, and what the number must be; generic arguments of the part before it.
macro_rules! parts {
    ($([$($generic:tt)*] $part:ty, $state:ty $(, $bound:path)*;)+) => {$(
        impl<N, $($generic)*> Part<N> for $part
        where
            N: $($bound +)* Sized,
        {
            type State = $state;
        }
    )+};
}

parts! {
    [] Learners, LearnersState<N>, configure::Units;
    [const A: usize, const B: usize] LoadAndRope<A, B>, LoadAndRopeState<A, B>;
    [const CHANNELS: usize, const EDGES: usize] Phasors<CHANNELS, EDGES>, Phasors<CHANNELS, EDGES, N>, angle::Synchronous;
    [const CLASSES: usize] Rainflow<CLASSES>, Rainflow<CLASSES, N>;
    [const SEGMENTS: usize] CycleMean<SEGMENTS>, CycleMean<SEGMENTS, N>;
    [] Extremes, Extremes<N>, Ranked;
    [const LINES: usize, const EDGES: usize] GearMesh<LINES, EDGES>, GearMesh<LINES, EDGES>;
    [const BINS: usize] Interleaved<BINS>, Interleaved<BINS, N>, Summed, Ranked;
    [const BINS: usize] Waveform<BINS>, Waveform<BINS, N>, Summed;
    [] SymmetricLimit, SymmetricLimit;
    [] TorqueRange, TorqueRange;
    [const K: usize] Curve<K>, Curve<K>;
    [L: Part<N>] Slew<L>, Slew<L::State, N>;
    [L: Part<N>] BacklashTakeUp<L>, BacklashTakeUp<L::State, N>;
    [] FeedForward, FeedForward;
    [] MechanismFeedForward, MechanismFeedForward<N>;
    [] ActiveDamping, ActiveDamping;
    [] AccelerationFeedback, AccelerationFeedback;
    [] Droop, Droop;
    [const K: usize] Barred<K>, Barred<K>;
    [] Sequencer, Sequencer;
    [const K: usize] MovingAverage<K>, MovingAverage<K, N>;
    [] CycleAverage, CycleAverage<N>;
    [] SetpointLag, SetpointLag<N>;
    [] DampingLag, DampingLag<N>;
    [] SpeedLag, SpeedLag<N>;
    [F: Part<N>] SpeedLoop<F>, SpeedLoop<F::State, N>;
    [G: Part<N>] Supervised<G>, Supervised<G::State, N>;
    [G: Part<N>, const SLOTS: usize, const PARTS: usize] InputShaper<G, SLOTS, PARTS>,
        InputShaper<G::State, SLOTS, PARTS, N>;
    [] TwoMassObserver, TwoMassObserver<N>;
    [] SemiImplicitObserver, SemiImplicitObserver<N>;
    [] RigidObserver, RigidObserver<N>;
    [const TOOLS: usize] MechanismObserver<f32, TOOLS>, MechanismObserver<N, TOOLS>;
    [O: Part<N>] GearedObserver<O>, GearedObserver<O::State>;
    [O: Part<N>] LoadGearObserver<O>, LoadGearObserver<O::State>;
    [O: Part<N>] EccentricityObserver<O>, EccentricityObserver<O::State, N>, EccentricityNumber;
}
