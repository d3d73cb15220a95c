//! What is compiled once in this crate for `f64`, and not again in each program that uses it.
//! Programs so hold the loops of their own schemes and little of what drives them.

use core::any::Any;

/// Whether this crate holds the functions of a scalar and a dimension.
pub(crate) const fn is_compiled_here<T, const D: usize>() -> bool {
    // Of the two scalars, the other has half the size.
    size_of::<T>() == size_of::<f64>() && D >= 1 && D <= 3
}

/// The table of one's own type, of those that this crate holds.
pub(crate) fn own<V: 'static>(tables: [&'static (dyn Any + Sync); 3]) -> Option<&'static V> {
    tables
        .into_iter()
        .find_map(|table| (table as &dyn Any).downcast_ref())
}

/// Gives a table of functions of a scalar `T` and a dimension `D`, each a `const OWN` of its type, a way to itself that
/// compiles none of them in a program for which this crate has compiled them.
macro_rules! compiled_once {
    ($Table:ident) => {
        impl<T: crate::scalar::Real, const D: usize> $Table<T, D> {
            /// The functions for one's own scalar and dimension.
            pub(crate) fn get() -> &'static Self {
                static TABLES: [&(dyn core::any::Any + Sync); 3] = [
                    const { &$Table::<f64, 1>::OWN },
                    const { &$Table::<f64, 2>::OWN },
                    const { &$Table::<f64, 3>::OWN },
                ];
                if const { crate::once::is_compiled_here::<T, D>() } {
                    crate::once::own(TABLES).expect("there is a table for each dimension")
                } else {
                    const { &Self::OWN }
                }
            }
        }
    };
}

pub(crate) use compiled_once;
