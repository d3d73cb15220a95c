//! Ready schemes with the options of a file: the combinations that are compiled in.
//! Each costs time to compile, so a file cannot choose what a scheme is made of, and each group is a feature of the package.

#[cfg(feature = "gases")]
mod gases;
#[cfg(feature = "liquids")]
mod liquids;
#[cfg(feature = "rods")]
mod rods;
#[cfg(feature = "solids")]
mod solids;

use super::Part;
use crate::fault::Fault;
use crate::format::Scheme as Described;
use meshfree::prelude::Scheme;
#[cfg(any(feature = "gases", feature = "rods"))]
use meshfree::term::viscosity::LimitedMonaghanGingold;

/// Why a scheme is not there in a dimension.
fn lacking<V>(own: &Described, dimension: usize) -> Part<V> {
    let (name, feature, dimensions) = match own {
        Described::WeaklyCompressible(_) => ("weakly_compressible", "liquids", "2D and 3D"),
        Described::Impact(_) => ("impact", "rods", "1D"),
        Described::UpdatedLagrangian(_) => ("updated_lagrangian", "solids", "2D and 3D"),
        Described::Gas(_) => ("gas", "gases", "1D and 2D"),
    };
    let text = format!(
        "is `{name}`, which this program has in {dimensions} with the feature `{feature}`, and the scene has {dimension}: \
         take another scheme or dimension, or write the scene in Rust"
    );
    Err(Fault::new("scheme", text))
}

/// The viscosity of a ready scheme, with coefficients of a file.
#[cfg(any(feature = "gases", feature = "rods"))]
fn limited(
    standard: LimitedMonaghanGingold,
    [alpha, beta]: [Option<f64>; 2],
) -> LimitedMonaghanGingold {
    LimitedMonaghanGingold {
        alpha: alpha.unwrap_or(standard.alpha),
        beta: beta.unwrap_or(standard.beta),
    }
}

/// The scheme of a file in one dimension.
///
/// # Errors
/// If this program lacks it there.
pub fn in_line(own: &Described) -> Part<Scheme<f64, 1>> {
    match own {
        #[cfg(feature = "rods")]
        Described::Impact(own) => Ok(rods::impact(own)),
        #[cfg(feature = "gases")]
        Described::Gas(own) => Ok(gases::gas(own)),
        other => lacking(other, 1),
    }
}

/// The scheme of a file in a plane.
///
/// # Errors
/// If this program lacks it there, or an option of it makes none.
pub fn in_plane(own: &Described) -> Part<Scheme<f64, 2>> {
    match own {
        #[cfg(feature = "liquids")]
        Described::WeaklyCompressible(own) => liquids::liquid(own),
        #[cfg(feature = "solids")]
        Described::UpdatedLagrangian(own) => Ok(solids::solid(own)),
        #[cfg(feature = "gases")]
        Described::Gas(own) => Ok(gases::gas(own)),
        other => lacking(other, 2),
    }
}

/// The scheme of a file in space.
///
/// # Errors
/// If this program lacks it there, or an option of it makes none.
pub fn in_space(own: &Described) -> Part<Scheme<f64, 3>> {
    match own {
        #[cfg(feature = "liquids")]
        Described::WeaklyCompressible(own) => liquids::liquid(own),
        #[cfg(feature = "solids")]
        Described::UpdatedLagrangian(own) => Ok(solids::solid(own)),
        other => lacking(other, 3),
    }
}
