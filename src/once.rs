//! What runs a scene, compiled once with the library and not again with each program that uses it (feature `precompiled`).
//! A generic method hands over to a function of its scalar and dimension that stands in the library already.

/// Does what the body says with a [`Simulation`](crate::simulation::Simulation), or whatever else is generic over `T` and `D`,
/// where it is compiled by one of six functions that are not generic. The method around it knows `T` and `D`; neither may be in the body
/// or in what comes back.
///
/// The condition is a constant, so a program compiles one of the branches alone.
#[cfg(all(feature = "precompiled", not(test)))]
macro_rules! once {
    ($own:expr => &mut $kind:ident, $($body:tt)*) => {
        $crate::once::once!(@choose $own, [&mut] downcast_mut, $kind, $($body)*)
    };
    ($own:expr => &$kind:ident, $($body:tt)*) => {
        $crate::once::once!(@choose $own, [&] downcast_ref, $kind, $($body)*)
    };
    (@choose $own:expr, [$($by:tt)*] $cast:ident, $kind:ident, |$name:ident $(, $argument:ident: $type:ty)*| -> $result:ty $body:block) => {
        if const { 1 <= D && D <= 3 } {
            let own: $($by)* dyn core::any::Any = $own;
            $crate::once::once!(@each own [$($by)*] $cast $kind $name [$($argument: $type),*] $result, $body,
                f64 1, f64 2, f64 3, f32 1, f32 2, f32 3);
            unreachable!("scalars are f32 and f64")
        } else {
            let $name = $own;
            $body
        }
    };
    (@each $own:ident $by:tt $cast:ident $kind:ident $name:ident $arguments:tt $result:ty, $body:block, $($scalar:ident $d:literal),*) => {
        $($crate::once::once!(@one $own $by $cast $kind $name $arguments $result, $body, $scalar $d);)*
    };
    (@one $own:ident [$($by:tt)*] $cast:ident $kind:ident $name:ident [$($argument:ident: $type:ty),*] $result:ty, $body:block, $scalar:ident $d:literal) => {
        if let Some(own) = $own.$cast() {
            // Not generic, since it stands in a function that is: nothing of it is compiled where it is called.
            #[inline(never)]
            fn compiled($name: $($by)* $kind<$scalar, $d>, $($argument: $type),*) -> $result $body
            return compiled(own, $($argument),*);
        }
    };
}

/// Does what the body says: each program compiles it for itself.
#[cfg(not(all(feature = "precompiled", not(test))))]
macro_rules! once {
    ($own:expr => & $($kind:ident)+, |$name:ident $(, $argument:ident: $type:ty)*| -> $result:ty $body:block) => {{
        let $name = $own;
        $body
    }};
}

pub(crate) use once;
