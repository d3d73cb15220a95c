//! What runs a scene, compiled once with the library and not again with each program that uses it (feature `precompiled`).
//! A generic method hands over to a function of its scalar and dimension that stands in the library already.

/// Calls a method of a [`Scene`](crate::scene::Scene), or whatever else is generic over `T` and `D`: where they are compiled
/// by one of six functions that are not generic. The method that calls knows `T` and `D`; neither may be in what comes back.
/// The method that is called does the work wherever it is compiled, and has a name that ends in `_here`.
///
/// The condition is a constant, so a program compiles one of the branches alone.
#[cfg(all(feature = "precompiled", not(test)))]
macro_rules! once {
    ($own:expr => &mut $kind:ident, $($call:tt)*) => {
        $crate::once::once!(@choose $own, [&mut] downcast_mut, $kind, $($call)*)
    };
    ($own:expr => &$kind:ident, $($call:tt)*) => {
        $crate::once::once!(@choose $own, [&] downcast_ref, $kind, $($call)*)
    };
    (@choose $own:expr, [$($by:tt)*] $cast:ident, $kind:ident, $method:ident($($argument:ident: $type:ty),*) -> $result:ty) => {
        if const { 1 <= D && D <= 3 } {
            let own: $($by)* dyn core::any::Any = $own;
            $crate::once::once!(@each own [$($by)*] $cast $kind $method ($($argument: $type),*) $result,
                f64 1, f64 2, f64 3, f32 1, f32 2, f32 3);
            unreachable!("scalars are f32 and f64")
        } else {
            $own.$method($($argument),*)
        }
    };
    (@each $own:ident $by:tt $cast:ident $kind:ident $method:ident $arguments:tt $result:ty, $($scalar:ident $d:literal),*) => {
        $($crate::once::once!(@one $own $by $cast $kind $method $arguments $result, $scalar $d);)*
    };
    (@one $own:ident [$($by:tt)*] $cast:ident $kind:ident $method:ident ($($argument:ident: $type:ty),*) $result:ty, $scalar:ident $d:literal) => {
        if let Some(own) = $own.$cast() {
            // Not generic, since it stands in a function that is: nothing of it is compiled where it is called.
            #[inline(never)]
            fn compiled(own: $($by)* $kind<$scalar, $d>, $($argument: $type),*) -> $result {
                own.$method($($argument),*)
            }
            return compiled(own, $($argument),*);
        }
    };
}

/// Calls a method: each program compiles it for itself.
#[cfg(not(all(feature = "precompiled", not(test))))]
macro_rules! once {
    ($own:expr => & $($kind:ident)+, $method:ident($($argument:ident: $type:ty),*) -> $result:ty) => {
        $own.$method($($argument),*)
    };
}

pub(crate) use once;
