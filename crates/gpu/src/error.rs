//! What can go wrong on a device, each with what to do about it.
//! What cannot be recorded is `Unrecordable` before anything gets here.

use meshfree::scalar::Unrecordable;

/// A part of a scheme, by its kind and name, as messages give it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// `pair term`, `law`, `equation of state`, …
    pub kind: &'static str,
    /// Its own name.
    pub name: String,
}

impl core::fmt::Display for Part {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "{} `{}`", self.kind, self.name)
    }
}

/// Why something does not run on a device.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// What a scene, or a step of it, is refused for: also by name each of its parts that does not run on a device.
    #[error(transparent)]
    Simulation(#[from] meshfree::error::Error),
    /// There is no adapter.
    #[error(
        "no adapter for Vulkan was found; install the driver of the card, or the software driver (Debian: `mesa-vulkan-drivers libvulkan1`)"
    )]
    NoAdapter,
    /// No adapter has this name.
    #[error("no adapter is named `{wanted}`; there are: {}", .found.join(", "))]
    UnknownAdapter {
        /// The name.
        wanted: String,
        /// What there is.
        found: Vec<String>,
    },
    /// The adapter cannot be opened.
    #[error("the adapter `{adapter}` cannot be opened: {message}")]
    Refused {
        /// Its name.
        adapter: String,
        /// What the driver says.
        message: String,
    },
    /// The adapter has no `f64`.
    #[error(
        "the adapter `{adapter}` cannot compute in f64 with 64-bit integers; take `Precision::Single` or another adapter"
    )]
    NoDouble {
        /// Its name.
        adapter: String,
    },
    /// An array needs more memory than the device binds at once.
    #[error(
        "{what} takes {bytes} bytes, and the device binds {most} of an array; take fewer particles, or an adapter with larger bindings"
    )]
    TooLarge {
        /// What it is.
        what: &'static str,
        /// What it takes.
        bytes: u64,
        /// What there is.
        most: u64,
    },
    /// The device has no memory left.
    #[error("the device has no memory left for {what}; take fewer particles")]
    OutOfMemory {
        /// What the memory was for.
        what: &'static str,
    },
    /// The driver does not take the text of a kernel.
    #[error("the driver does not take the kernel of the {part}: {message}")]
    Kernel {
        /// Whose.
        part: Part,
        /// What it says.
        message: String,
    },
    /// The driver computes sums of `f32` in another order than they are written, so places would lose what their rounding leaves.
    #[error(
        "the driver of `{adapter}` reorders sums, so places in f32 would drift by what rounding leaves of them; run the scene in f64, or on \
         another adapter"
    )]
    Reordered {
        /// Its name.
        adapter: String,
    },
    /// A text cannot be recorded.
    #[error(
        "the {part} cannot be recorded: {what}; write it with the arithmetic of lanes and `Lane::select`"
    )]
    Recorded {
        /// Whose.
        part: Part,
        /// What it does.
        what: &'static str,
    },
    /// What a kernel is given has another size than it asks for.
    #[error("{what}: {found} were given, and {wanted} are needed")]
    Size {
        /// What it is.
        what: &'static str,
        /// How many were given.
        found: usize,
        /// How many are needed.
        wanted: usize,
    },
    /// A kernel is run on another device than it was made for.
    #[error("a kernel was made for another device; make it anew for this one")]
    OtherDevice,
    /// A number that what a kernel is given cannot have.
    #[error("{what} is {value}; {must_be}")]
    Value {
        /// What it is.
        what: &'static str,
        /// The number.
        value: f64,
        /// What it must be.
        must_be: &'static str,
    },
    /// An integrator asks for more states than it [says](meshfree::integrator::Integrator::slots) that it keeps.
    #[error(
        "the integrator {name} asks for a state that it does not say it keeps; give Integrator::slots their number"
    )]
    KeptState {
        /// Its name.
        name: String,
    },
    /// The device was lost, or gave no answer.
    #[error("the device was lost: {message}; resume from the last checkpoint")]
    Lost {
        /// What the driver says.
        message: String,
    },
}

impl Error {
    /// That a part cannot be recorded.
    pub(crate) fn recorded(kind: &'static str, name: &str, error: &Unrecordable) -> Self {
        let name = name.into();
        Self::Recorded {
            part: Part { kind, name },
            what: error.what,
        }
    }

    /// Refuses a size that is not as it should be.
    pub(crate) fn unless(
        fits: bool,
        what: &'static str,
        [found, wanted]: [usize; 2],
    ) -> Result<(), Self> {
        let wrong = Self::Size {
            what,
            found,
            wanted,
        };
        if fits { Ok(()) } else { Err(wrong) }
    }
}
