//! Which body, wall or boundary is meant: by its name, or by its index in the scene.
//! What is not there is an error that lists what is.

use crate::error::{Error, Problem, Result};

/// Which body, wall or boundary is meant: by its name, or by its index in the order of the scene.
///
/// Whatever asks for one takes either, and what the scene does not have is an error:
///
/// ```
/// use meshfree::prelude::*;
/// let simulation = Scene::<f64, 1>::new(schemes::impact())
///     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4))
///     .build()?;
/// assert_eq!(simulation.body("rod")?.count(), simulation.body(0)?.count());
/// let (name, index) = (simulation.body("pad").unwrap_err(), simulation.body(1).unwrap_err());
/// assert_eq!(name.to_string(), "there is no body called `pad`: the scene has rod");
/// assert_eq!(index.to_string(), "there is no body with the index 1: the scene has rod, counted from 0");
/// # Ok::<(), Error>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` does not say which body or wall is meant",
    note = "give its name (`&str`) or its index (`usize`)"
)]
pub trait Which {
    /// Whether it means the one with an index and a name.
    fn means(&self, index: usize, name: &str) -> bool;
    /// The problem that there is none of a kind; `known` lists the names that exist.
    fn unknown(&self, kind: &'static str, known: String) -> Problem;
}

/// By its name.
impl Which for str {
    fn means(&self, _: usize, name: &str) -> bool {
        self == name
    }
    fn unknown(&self, kind: &'static str, known: String) -> Problem {
        let name = self.into();
        Problem::UnknownName { kind, name, known }
    }
}

/// By its name.
impl Which for String {
    fn means(&self, index: usize, name: &str) -> bool {
        self.as_str().means(index, name)
    }
    fn unknown(&self, kind: &'static str, known: String) -> Problem {
        self.as_str().unknown(kind, known)
    }
}

/// By its index, from zero.
impl Which for usize {
    fn means(&self, index: usize, _: &str) -> bool {
        *self == index
    }
    fn unknown(&self, kind: &'static str, known: String) -> Problem {
        let index = *self;
        Problem::UnknownIndex { kind, index, known }
    }
}

impl<W: Which + ?Sized> Which for &W {
    fn means(&self, index: usize, name: &str) -> bool {
        (**self).means(index, name)
    }
    fn unknown(&self, kind: &'static str, known: String) -> Problem {
        (**self).unknown(kind, known)
    }
}

/// The one that is meant of all that have a name, with its index; `kind` says in messages what it is.
pub(crate) fn find<N: AsRef<str>, I>(
    which: &impl Which,
    kind: &'static str,
    all: impl Iterator<Item = (N, I)> + Clone,
) -> Result<(usize, I)> {
    let named = all.clone().enumerate();
    let mut found = named.filter(|(index, (name, _))| which.means(*index, name.as_ref()));
    let problem = match (found.next(), found.next()) {
        (Some((index, (_, item))), None) => return Ok((index, item)),
        // Two inlets of one body have buffers of one name.
        (Some((_, (name, _))), Some(_)) => Problem::Incompatible {
            what: format!("more than one {kind} is called `{}`", name.as_ref()),
            remedy: "ask for it by its index",
        },
        (None, _) => {
            let known: Vec<_> = all.map(|(name, _)| name.as_ref().to_owned()).collect();
            which.unknown(kind, known.join(", "))
        }
    };
    Err(Error::Argument(problem))
}
