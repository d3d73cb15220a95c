//! Lists of terms that share one loop over pairs: tuples as they are written, and terms of effects in the order of their names.
//! A list costs what the same terms would cost written as one.

use super::{Layout, Pair, Sums, Term, TermDoc, TermUse};
use crate::particles::{Fields, Outputs};
use crate::scalar::Lane;
use core::fmt::{self, Debug};

/// Terms that share one sweep. A tuple runs them in its order.
pub trait Terms<const D: usize>: Clone + Debug + Send + Sync + 'static {
    /// Union of what the terms read.
    const READS: Fields;
    /// Union of what the terms write.
    const WRITES: Outputs;
    /// Union of what the terms read and carries tension.
    const TENSILE: Fields = Self::READS.stresses();
    /// Adds what this pair contributes to every term.
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>);
    /// The terms in the order in which they run, with what each reads and writes.
    fn uses(&self) -> Vec<TermUse>;
    /// The terms, for people.
    fn document(&self) -> Vec<TermDoc> {
        let documents = self.uses().into_iter().map(|term| term.document);
        documents.filter(|own| !own.name.is_empty()).collect()
    }
}

/// Terms of effects in one sweep, as the list of effects has them. They run in the order of their [names](Term::NAME).
pub trait TermList<const D: usize>: Terms<D> {
    /// The names of the terms.
    const NAMES: Names;
    /// These terms and then others, as one list without empty parts.
    type Then<B: TermList<D>>: TermList<D>;
    /// These terms and then others.
    fn then<B: TermList<D>>(self, next: B) -> Self::Then<B>;
    /// Others and then these terms, where the others are not empty.
    type After<A: TermList<D>>: TermList<D>;
    /// Others and then these terms.
    fn after<A: TermList<D>>(self, first: A) -> Self::After<A>;
    /// Adds what this pair contributes to the term whose name is number `RANK` of those of `All`, of which these are a part.
    fn ranked<const RANK: usize, All: TermList<D>, L: Lane, P: Layout>(
        &self,
        pair: &Pair<'_, L, D, P>,
        sums: &mut Sums<L, D, P>,
    );
}

/// Names of terms, in order.
#[derive(Clone, Copy, Debug)]
pub struct Names {
    all: [&'static str; Self::MOST],
    count: usize,
}

impl Names {
    /// How many terms of effects may share a sweep, beside those of the scheme.
    pub const MOST: usize = 16;
    const NONE: Self = Self {
        all: [""; Self::MOST],
        count: 0,
    };

    const fn with(mut self, name: &'static str) -> Self {
        assert!(
            self.count < Self::MOST,
            "more terms of effects share a sweep than `meshfree::term::Names::MOST`"
        );
        let mut k = self.count;
        while k > 0 && is_less(name, self.all[k - 1]) {
            self.all[k] = self.all[k - 1];
            k -= 1;
        }
        self.all[k] = name;
        self.count += 1;
        self
    }
    const fn union(mut self, other: Self) -> Self {
        let mut k = 0;
        while k < other.count {
            self = self.with(other.all[k]);
            k += 1;
        }
        self
    }
    const fn has(&self, name: &str) -> bool {
        let mut k = 0;
        while k < self.count {
            if !is_less(self.all[k], name) && !is_less(name, self.all[k]) {
                return true;
            }
            k += 1;
        }
        false
    }
}

/// Whether a text comes before another, byte by byte.
const fn is_less(a: &str, b: &str) -> bool {
    let (a, b, mut k) = (a.as_bytes(), b.as_bytes(), 0);
    while k < a.len() && k < b.len() {
        if a[k] != b[k] {
            return a[k] < b[k];
        }
        k += 1;
    }
    a.len() < b.len()
}

impl<const D: usize> Terms<D> for () {
    const READS: Fields = Fields::NONE;
    const WRITES: Outputs = Outputs::NONE;
    const TENSILE: Fields = Fields::NONE;
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, _: &Pair<'_, L, D, P>, _: &mut Sums<L, D, P>) {}
    fn uses(&self) -> Vec<TermUse> {
        Vec::new()
    }
}

impl<const D: usize> TermList<D> for () {
    const NAMES: Names = Names::NONE;
    type Then<B: TermList<D>> = B;
    fn then<B: TermList<D>>(self, next: B) -> B {
        next
    }
    type After<A: TermList<D>> = A;
    fn after<A: TermList<D>>(self, first: A) -> A {
        first
    }
    #[inline(always)]
    fn ranked<const RANK: usize, All: TermList<D>, L: Lane, P: Layout>(
        &self,
        _: &Pair<'_, L, D, P>,
        _: &mut Sums<L, D, P>,
    ) {
    }
}

/// How terms that are not empty are joined to others.
macro_rules! not_empty {
    () => {
        type Then<Next: TermList<D>> = Next::After<Self>;
        fn then<Next: TermList<D>>(self, next: Next) -> Self::Then<Next> {
            next.after(self)
        }
        type After<First: TermList<D>> = Join<First, Self>;
        fn after<First: TermList<D>>(self, first: First) -> Self::After<First> {
            Join(first, self)
        }
    };
}

impl<const D: usize, A: Term<D>> TermList<D> for (A,) {
    const NAMES: Names = Names::NONE.with(A::NAME);
    not_empty!();
    #[inline(always)]
    fn ranked<const RANK: usize, All: TermList<D>, L: Lane, P: Layout>(
        &self,
        pair: &Pair<'_, L, D, P>,
        sums: &mut Sums<L, D, P>,
    ) {
        self.0.pair(pair, sums);
    }
}

/// Two lists of terms of one sweep, the first first.
#[derive(Clone, Debug)]
pub struct Join<A, B>(pub A, pub B);

impl<const D: usize, A: Terms<D>, B: Terms<D>> Terms<D> for Join<A, B> {
    const READS: Fields = A::READS.union(B::READS);
    const WRITES: Outputs = A::WRITES.union(B::WRITES);
    const TENSILE: Fields = A::TENSILE.union(B::TENSILE);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        self.0.pair(pair, sums);
        self.1.pair(pair, sums);
    }
    fn uses(&self) -> Vec<TermUse> {
        [self.0.uses(), self.1.uses()].concat()
    }
}

impl<const D: usize, A: TermList<D>, B: TermList<D>> TermList<D> for Join<A, B> {
    const NAMES: Names = A::NAMES.union(B::NAMES);
    not_empty!();
    #[inline(always)]
    fn ranked<const RANK: usize, All: TermList<D>, L: Lane, P: Layout>(
        &self,
        pair: &Pair<'_, L, D, P>,
        sums: &mut Sums<L, D, P>,
    ) {
        if const { A::NAMES.has(All::NAMES.all[RANK]) } {
            self.0.ranked::<RANK, All, L, P>(pair, sums);
        } else {
            self.1.ranked::<RANK, All, L, P>(pair, sums);
        }
    }
}

/// Terms of effects, which run in the order of their [names](Term::NAME): sums have the same bits for every order of the list.
#[derive(Clone)]
pub struct ByName<A, const D: usize>(pub A);

impl<A: TermList<D>, const D: usize> Debug for ByName<A, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let texts = self.uses().into_iter().map(|term| term.text);
        f.debug_list().entries(texts).finish()
    }
}

impl<const D: usize, A: TermList<D>> Terms<D> for ByName<A, D> {
    const READS: Fields = A::READS;
    const WRITES: Outputs = A::WRITES;
    const TENSILE: Fields = A::TENSILE;
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        macro_rules! in_turn {
            ($($rank:literal)*) => {$(
                if const { A::NAMES.count > $rank } {
                    self.0.ranked::<$rank, A, L, P>(pair, sums);
                }
            )*};
        }
        in_turn!(0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15);
    }
    fn uses(&self) -> Vec<TermUse> {
        let mut uses = self.0.uses();
        uses.sort_by_key(|term| term.name);
        uses
    }
}

macro_rules! tuple {
    ($($name:ident),*) => {
        #[allow(non_snake_case)]
        impl<const D: usize, $($name: Term<D>),*> Terms<D> for ($($name,)*) {
            const READS: Fields = Fields::NONE$(.union($name::READS))*;
            const WRITES: Outputs = Outputs::NONE$(.union($name::WRITES))*;
            const TENSILE: Fields = Fields::NONE$(.union($name::TENSILE))*;
            #[inline(always)]
            fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
                let ($($name,)*) = self;
                $($name.pair(pair, sums);)*
            }
            fn uses(&self) -> Vec<TermUse> {
                let ($($name,)*) = self;
                vec![$(TermUse::of($name),)*]
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
