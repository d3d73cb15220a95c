//! The clock that times the parts of a step.
//! Where a machine has none, as WebAssembly without a host, it stands still, and times are zero.

#[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
pub(crate) use std::time::Instant;

#[cfg(all(target_family = "wasm", target_os = "unknown"))]
pub(crate) use still::Instant;

#[cfg(all(target_family = "wasm", target_os = "unknown"))]
mod still {
    use std::ops::Sub;
    use std::time::Duration;

    /// An instant of a clock that stands still.
    #[derive(Clone, Copy, Debug)]
    pub(crate) struct Instant;

    impl Instant {
        pub(crate) fn now() -> Self {
            Self
        }
        pub(crate) fn elapsed(&self) -> Duration {
            Duration::ZERO
        }
    }

    impl Sub for Instant {
        type Output = Duration;
        fn sub(self, _: Self) -> Duration {
            Duration::ZERO
        }
    }
}
