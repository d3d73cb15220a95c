//! Lists of terms that share one loop over pairs: tuples, which lose their empty parts as they are joined.
//! A list costs what the same terms would cost written as one.

use super::{Layout, Pair, Sums, Term, TermDoc, TermUse};
use crate::particles::{Fields, Outputs};
use crate::scalar::Lane;
use core::fmt::Debug;

/// A list of terms that share one sweep: a tuple.
pub trait Terms<const D: usize>: Clone + Debug + Send + Sync + 'static {
    /// Union of what the terms read.
    const READS: Fields;
    /// Union of what the terms write.
    const WRITES: Outputs;
    /// Union of what the terms read and carries tension.
    const TENSILE: Fields = Self::READS.stresses();
    /// These terms and then others, as one list without empty parts.
    type Then<B: Terms<D>>: Terms<D>;
    /// These terms and then others.
    fn then<B: Terms<D>>(self, next: B) -> Self::Then<B>;
    /// Others and then these terms, where the others are not empty.
    type After<A: Terms<D>>: Terms<D>;
    /// Others and then these terms.
    fn after<A: Terms<D>>(self, first: A) -> Self::After<A>;
    /// Adds what this pair contributes to every term.
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>);
    /// The terms, for people.
    fn document(&self) -> Vec<TermDoc>;
    /// What each term reads and writes; all together as one if not given.
    fn uses(&self) -> Vec<TermUse> {
        let names: Vec<_> = self.document().into_iter().map(|own| own.name).collect();
        vec![TermUse {
            name: names.join(", "),
            reads: Self::READS,
            writes: Self::WRITES,
        }]
    }
}

impl<const D: usize> Terms<D> for () {
    const READS: Fields = Fields::NONE;
    const WRITES: Outputs = Outputs::NONE;
    const TENSILE: Fields = Fields::NONE;
    type Then<B: Terms<D>> = B;
    fn then<B: Terms<D>>(self, next: B) -> B {
        next
    }
    type After<A: Terms<D>> = A;
    fn after<A: Terms<D>>(self, first: A) -> A {
        first
    }
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, _pair: &Pair<'_, L, D, P>, _sums: &mut Sums<L, D, P>) {}
    fn document(&self) -> Vec<TermDoc> {
        Vec::new()
    }
    fn uses(&self) -> Vec<TermUse> {
        Vec::new()
    }
}

/// How terms that are not empty are joined to others.
macro_rules! not_empty {
    ($D:ident) => {
        type Then<Next: $crate::term::Terms<$D>> = Next::After<Self>;
        fn then<Next: $crate::term::Terms<$D>>(self, next: Next) -> Self::Then<Next> {
            next.after(self)
        }
        type After<First: $crate::term::Terms<$D>> = $crate::term::Join<First, Self>;
        fn after<First: $crate::term::Terms<$D>>(self, first: First) -> Self::After<First> {
            $crate::term::Join(first, self)
        }
    };
}
pub(crate) use not_empty;

macro_rules! tuple {
    ($($name:ident),*) => {
        #[allow(non_snake_case)]
        impl<const D: usize, $($name: Term<D>),*> Terms<D> for ($($name,)*) {
            const READS: Fields = Fields::NONE$(.union($name::READS))*;
            const WRITES: Outputs = Outputs::NONE$(.union($name::WRITES))*;
            const TENSILE: Fields = Fields::NONE$(.union($name::TENSILE))*;
            not_empty!(D);
            #[inline(always)]
            fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
                let ($($name,)*) = self;
                $($name.pair(pair, sums);)*
            }
            fn document(&self) -> Vec<TermDoc> {
                let ($($name,)*) = self;
                let mut documents = vec![$($name.document(),)*];
                documents.retain(|document| !document.name.is_empty());
                documents
            }
            fn uses(&self) -> Vec<TermUse> {
                let ($($name,)*) = self;
                vec![$(TermUse {
                    name: $name.document().name,
                    reads: $name::READS,
                    writes: $name::WRITES,
                },)*]
            }
        }
    };
}
tuple!(A);
tuple!(A, B);
tuple!(A, B, C);
tuple!(A, B, C, E);
tuple!(A, B, C, E, F);
tuple!(A, B, C, E, F, G);
tuple!(A, B, C, E, F, G, H);
tuple!(A, B, C, E, F, G, H, I);
