//! Terms by stage: of the terms of an effect, those that share the sweep of one stage, as a type.
//! A sweep is compiled once for the terms that it has, whatever else the schemes that use it name.

use super::{Term, TermList};
use crate::particles::Fields;
use core::fmt::Debug;
use core::marker::PhantomData;

macro_rules! markers {
    ($( $(#[$doc:meta])* $Marker:ident $If:ident $put:ident ),* $(,)?) => {
        /// A [`Stage`](crate::term::Stage), or the part of its sweep that comes first or last, as a type.
        pub trait StageMarker<const D: usize>: Clone + Debug + Send + Sync + 'static {
            /// The terms `A` of this stage in the sweep of stage `S`: all of them if it is the same, none if not.
            type Of<S: StageMarker<D>, A: TermList<D>>: TermList<D>;
            /// The terms of this stage in the sweep of stage `S`.
            fn put<S: StageMarker<D>, A: TermList<D>>(terms: A) -> Self::Of<S, A>;
            $(
                #[doc(hidden)]
                type $If<A: TermList<D>>: TermList<D>;
                #[doc(hidden)]
                fn $put<A: TermList<D>>(terms: A) -> Self::$If<A>;
            )*
        }
        $(
            $(#[$doc])*
            #[derive(Clone, Copy, Debug)]
            pub struct $Marker;
        )*
        markers!(@each [] $([$Marker $If $put])*);
    };
    (@each [$([$_m:ident $Before:ident $before:ident])*]) => {};
    (@each [$([$_m:ident $Before:ident $before:ident])*] [$Marker:ident $If:ident $put:ident]
        $([$Next:ident $After:ident $after:ident])*) => {
        impl<const D: usize> StageMarker<D> for $Marker {
            type Of<S: StageMarker<D>, A: TermList<D>> = S::$If<A>;
            fn put<S: StageMarker<D>, A: TermList<D>>(terms: A) -> Self::Of<S, A> {
                S::$put(terms)
            }
            type $If<A: TermList<D>> = A;
            fn $put<A: TermList<D>>(terms: A) -> A {
                terms
            }
            $(
                type $Before<A: TermList<D>> = ();
                fn $before<A: TermList<D>>(_terms: A) {}
            )*
            $(
                type $After<A: TermList<D>> = ();
                fn $after<A: TermList<D>>(_terms: A) {}
            )*
        }
        markers!(@each [$([$_m $Before $before])* [$Marker $If $put]] $([$Next $After $after])*);
    };
}

/// The stages that have sweeps, as types, for the terms of effects: `In<stage::Rates, A>`.
pub mod stage {
    use super::{Debug, TermList};

    markers! {
        /// [`Stage::Reference`](crate::term::Stage::Reference).
        Reference IfReference if_reference,
        /// The sums of [`Stage::Density`](crate::term::Stage::Density) that make densities, where these are not integrated.
        Sums IfSums if_sums,
        /// [`Stage::Density`](crate::term::Stage::Density).
        Density IfDensity if_density,
        /// [`Stage::Walls`](crate::term::Stage::Walls).
        Walls IfWalls if_walls,
        /// [`Stage::Gradients`](crate::term::Stage::Gradients).
        Gradients IfGradients if_gradients,
        /// [`Stage::Flow`](crate::term::Stage::Flow).
        Flow IfFlow if_flow,
        /// The pressure force of [`Stage::Rates`](crate::term::Stage::Rates), before the viscosity.
        Pressure IfPressure if_pressure,
        /// [`Stage::Rates`](crate::term::Stage::Rates), after the viscosity.
        Rates IfRates if_rates,
        /// The power of the forces of [`Stage::Rates`](crate::term::Stage::Rates).
        Power IfPower if_power,
        /// The rate of compression: at [`Stage::Continuity`](crate::term::Stage::Continuity) where density is integrated,
        /// and with the power where anything follows it.
        Compression IfCompression if_compression,
        /// [`Stage::Continuity`](crate::term::Stage::Continuity).
        Continuity IfContinuity if_continuity,
    }
}
pub use stage::StageMarker;

/// A term with the stage in whose sweep it takes part: `In<stage::Rates, A>`.
#[derive(Clone, Debug)]
pub struct In<S, A> {
    term: A,
    stage: PhantomData<S>,
}

impl<S, A> In<S, A> {
    /// The term in the sweep of the stage `S`.
    #[must_use]
    pub fn new(term: A) -> Self {
        Self {
            term,
            stage: PhantomData,
        }
    }
}

/// Terms of an effect, each with its stage: a tuple of up to four `In<Stage, Term>`, `()` for none.
pub trait StagedTerms<const D: usize>: Clone + Debug + Send + Sync + 'static {
    /// The terms of one stage.
    type At<S: StageMarker<D>>: TermList<D>;
    /// What all terms read.
    const READS: Fields;
    /// The terms of one stage.
    fn at<S: StageMarker<D>>(&self) -> Self::At<S>;
}

impl<const D: usize> StagedTerms<D> for () {
    type At<S: StageMarker<D>> = ();
    const READS: Fields = Fields::NONE;
    fn at<S: StageMarker<D>>(&self) {}
}

/// The terms `A` of stage `M` in the sweep of stage `S`.
type Own<S, M, A, const D: usize> = <M as StageMarker<D>>::Of<S, (A,)>;
/// `A` and then `B`.
type Then<A, B, const D: usize> = <A as TermList<D>>::Then<B>;

/// Lists of terms as one, from the left.
macro_rules! joined {
    ($all:ty) => { $all };
    ($all:ty, $next:ty $(, $rest:ty)*) => { joined!(Then<$all, $next, D> $(, $rest)*) };
}

macro_rules! staged {
    ($M:ident $A:ident $(, $n:tt $N:ident $B:ident)*) => {
        impl<const D: usize, $M, $A, $($N, $B),*> StagedTerms<D> for (In<$M, $A>, $(In<$N, $B>),*)
        where
            $M: StageMarker<D>,
            $A: Term<D>,
            $($N: StageMarker<D>, $B: Term<D>,)*
        {
            type At<S: StageMarker<D>> = joined!(Own<S, $M, $A, D> $(, Own<S, $N, $B, D>)*);
            const READS: Fields = $A::READS$(.union($B::READS))*;
            fn at<S: StageMarker<D>>(&self) -> Self::At<S> {
                let all = $M::put::<S, _>((self.0.term.clone(),));
                $(let all = all.then($N::put::<S, _>((self.$n.term.clone(),)));)*
                all
            }
        }
    };
}
staged!(M A);
staged!(M A, 1 N B);
staged!(M A, 1 N B, 2 O C);
staged!(M A, 1 N B, 2 O C, 3 Q E);
