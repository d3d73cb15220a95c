//! What a particle can carry, and what a sweep over its neighbours can sum.
//! Terms declare both as constants, so storage is the union of what a scene's parts name.

macro_rules! quantities {
    (
        $(#[$doc:meta])* $Quantity:ident, $index:ident, $Set:ident, $set_doc:literal;
        $( $(#[$vdoc:meta])* $NAME:ident, $shape:ident, $name:literal, $unit:literal; )*
    ) => {
        #[allow(non_camel_case_types, clippy::upper_case_acronyms)]
        mod $index {
            #[repr(u8)]
            pub(super) enum Index { $( $NAME, )* }
        }

        $(#[$doc])*
        ///
        /// Those of the crate are constants here; an effect declares its own with
        #[doc = concat!("[`", stringify!($Quantity), "::scalar`], [`", stringify!($Quantity), "::vector`], [`",
            stringify!($Quantity), "::tensor`] or [`", stringify!($Quantity), "::matrix`].")]
        #[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub struct $Quantity {
            index: u8,
            shape: Shape,
        }

        impl core::fmt::Debug for $Quantity {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                f.write_str(self.name())
            }
        }

        impl $Quantity {
            $( $(#[$vdoc])* pub const $NAME: Self = Self {
                index: $index::Index::$NAME as u8,
                shape: Shape::$shape,
            }; )*
            const NAMES: &'static [[&'static str; 2]] = &[$( [$name, $unit], )*];

            /// Those of the crate that every scheme knows, in the order of storage.
            pub const ALL: &'static [$Quantity] = &[$( $Quantity::$NAME, )*];

            own_quantities! { $Quantity
                /// One number that no rotation changes.
                scalar: Scalar,
                /// A vector that only rotates.
                vector: Vector,
                /// A symmetric tensor of six components, whatever the dimension.
                tensor: Tensor,
                /// A `D × D` matrix, row by row.
                matrix: Matrix
            }

            /// Where it stands in tables of all quantities, below [`PLACES`](crate::particles::PLACES).
            #[inline(always)]
            #[must_use]
            pub const fn place(self) -> usize {
                self.index as usize
            }
            /// What stands in a place; one of the free places below 64 holds nothing, and is called a scalar.
            pub(crate) const fn at(place: usize) -> Self {
                if place < Self::ALL.len() {
                    return Self::ALL[place];
                }
                Self {
                    index: place as u8,
                    shape: own_shape(place),
                }
            }
            /// The number and shape of one that an effect declares, as `scalar 3`; none of those of the crate.
            pub(crate) fn own_number(self) -> Option<String> {
                let own = self.place().checked_sub(64)?;
                Some(format!("{} {}", self.shape.word(), own % OWN))
            }
            /// Numbers per particle in `d` dimensions.
            #[must_use]
            pub const fn components(self, d: usize) -> usize {
                self.shape.components(d)
            }
            /// How it changes under rotation and reflection.
            #[must_use]
            pub const fn shape(self) -> Shape {
                self.shape
            }
            /// Its name in files and messages; of one that an effect declares, its shape, for the effect names it.
            #[must_use]
            pub fn name(self) -> &'static str {
                match Self::NAMES.get(self.place()) {
                    Some([name, _]) => name,
                    None => self.shape.own_name(),
                }
            }
            /// Its SI unit; empty for one that an effect declares.
            #[must_use]
            pub fn unit(self) -> &'static str {
                Self::NAMES.get(self.place()).map_or("", |[_, unit]| unit)
            }
        }

        #[doc = $set_doc]
        #[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
        pub struct $Set(u128);

        impl $Set {
            /// The empty set.
            pub const NONE: Self = Self(0);
            /// The set of all that the crate names.
            pub const ALL: Self = Self::of($Quantity::ALL);

            /// The set of the listed members.
            #[must_use]
            pub const fn of(members: &[$Quantity]) -> Self {
                let (mut bits, mut k) = (0, 0);
                while k < members.len() {
                    bits |= 1 << members[k].index;
                    k += 1;
                }
                Self(bits)
            }
            /// Members of either set.
            #[must_use]
            pub const fn union(self, other: Self) -> Self {
                Self(self.0 | other.0)
            }
            /// Members of this set that are not in the other.
            #[must_use]
            pub const fn minus(self, other: Self) -> Self {
                Self(self.0 & !other.0)
            }
            /// The set without `member`.
            #[must_use]
            pub const fn without(self, member: $Quantity) -> Self {
                Self(self.0 & !(1 << member.index))
            }
            /// Whether it has no members.
            #[must_use]
            pub const fn is_empty(self) -> bool {
                self.0 == 0
            }
            /// Whether `member` belongs to the set.
            #[must_use]
            #[inline(always)]
            pub const fn contains(self, member: $Quantity) -> bool {
                self.0 >> member.index & 1 == 1
            }
            /// Whether the member with this place belongs to the set.
            #[allow(dead_code)]
            pub(crate) const fn has_place(self, place: usize) -> bool {
                self.0 >> place & 1 == 1
            }
            /// Where `member` starts when the set is laid out in order, in `d` dimensions.
            #[must_use]
            #[inline(always)]
            pub const fn offset(self, member: $Quantity, d: usize) -> usize {
                Self(self.0 & ((1 << member.index) - 1)).width(d)
            }
            /// Numbers per particle of the whole set in `d` dimensions.
            ///
            /// Population counts, so that the pair loop sees constants.
            #[must_use]
            #[inline(always)]
            pub const fn width(self, d: usize) -> usize {
                const SCALARS: u128 = $Set::of_shape(1);
                const TENSORS: u128 = $Set::of_shape(6);
                const MATRICES: u128 = $Set::of_shape(9);
                let scalars = (self.0 & SCALARS).count_ones() as usize;
                let tensors = (self.0 & TENSORS).count_ones() as usize;
                let matrices = (self.0 & MATRICES).count_ones() as usize;
                let vectors = (self.0 & !(SCALARS | TENSORS | MATRICES)).count_ones() as usize;
                scalars + vectors * d + tensors * 6 + matrices * d * d
            }
            /// The places of quantities with so many components in three dimensions.
            const fn of_shape(components: usize) -> u128 {
                let (mut bits, mut k) = (own_places(components), 0);
                while k < $Quantity::ALL.len() {
                    if $Quantity::ALL[k].components(3) == components {
                        bits |= 1 << k;
                    }
                    k += 1;
                }
                bits
            }
            /// The members in the order of storage.
            pub fn iter(self) -> impl Iterator<Item = $Quantity> {
                let mut left = self.0;
                core::iter::from_fn(move || {
                    let place = left.trailing_zeros() as usize;
                    // Clears the lowest bit that is set.
                    left &= left.wrapping_sub(1);
                    (place < PLACES).then(|| $Quantity::at(place))
                })
            }
        }
    };
}

/// The constructors of quantities that effects declare.
macro_rules! own_quantities {
    ($Quantity:ident $( $(#[$doc:meta])* $name:ident: $Shape:ident ),*) => {
        $(
            $(#[$doc])*
            ///
            /// `number` tells it from others of its shape that effects of the same scheme declare, and is below
            /// [`OWN`](crate::particles::OWN); those of the crate take numbers from the end. Two effects that
            /// claim one number for different names are refused when the scene is built.
            ///
            /// A number out of range does not compile where the quantity is a constant, as it should be.
            #[must_use]
            pub const fn $name(number: u8) -> Self {
                assert!((number as usize) < OWN, "an own quantity has a number below particles::OWN");
                Self {
                    index: own_start(Shape::$Shape.components(3)) as u8 + number,
                    shape: Shape::$Shape,
                }
            }
        )*
    };
}

/// Places in sets and tables: 64 for the quantities of the crate, then those that effects declare, by shape.
pub const PLACES: usize = 128;
/// How many quantities of one shape effects may declare.
pub const OWN: usize = 16;

/// The first place of own quantities with so many components in three dimensions.
const fn own_start(components: usize) -> usize {
    match components {
        1 => 64,
        3 => 64 + OWN,
        6 => 64 + 2 * OWN,
        _ => 64 + 3 * OWN,
    }
}

/// The places of own quantities with so many components in three dimensions.
const fn own_places(components: usize) -> u128 {
    ((1 << OWN) - 1) << own_start(components)
}

const fn own_shape(place: usize) -> Shape {
    match place.saturating_sub(64) / OWN {
        0 => Shape::Scalar,
        1 => Shape::Vector,
        2 => Shape::Tensor,
        _ => Shape::Matrix,
    }
}

/// How a quantity changes under rotation and reflection.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash, PartialOrd, Ord)]
pub enum Shape {
    /// One number that no rotation changes.
    Scalar,
    /// A point in space.
    Point,
    /// A velocity: also shifted by a moving boundary.
    Velocity,
    /// A vector that only rotates.
    Vector,
    /// A symmetric tensor of six components, xx, yy, zz, yz, xz, xy, whatever the dimension: plane and
    /// uniaxial states need those out of the plane.
    Tensor,
    /// A `D × D` matrix, row by row.
    Matrix,
}

impl Shape {
    const fn own_name(self) -> &'static str {
        match self {
            Shape::Scalar => "own scalar",
            Shape::Tensor => "own tensor",
            Shape::Matrix => "own matrix",
            _ => "own vector",
        }
    }
    const fn word(self) -> &'static str {
        match self {
            Shape::Scalar => "scalar",
            Shape::Tensor => "tensor",
            Shape::Matrix => "matrix",
            _ => "vector",
        }
    }
    const fn components(self, d: usize) -> usize {
        match self {
            Shape::Scalar => 1,
            Shape::Point | Shape::Velocity | Shape::Vector => d,
            Shape::Tensor => 6,
            Shape::Matrix => d * d,
        }
    }
}

quantities! {
    /// A quantity that a particle carries.
    Field, field_index, Fields, "A set of [`Field`]s, usable in constants.";
    /// Position x, counted from the [origin](crate::scene#place) of the scene.
    POSITION, Point, "position", "m";
    /// The rounding error of the position, kept where the scalar is `f32`.
    POSITION_RESIDUAL, Vector, "position_residual", "m";
    /// Velocity v.
    VELOCITY, Velocity, "velocity", "m/s";
    /// Velocity averaged over a kick, with which pair forces do their work.
    MEAN_VELOCITY, Velocity, "mean_velocity", "m/s";
    /// Mass m.
    MASS, Scalar, "mass", "kg";
    /// Density ρ.
    DENSITY, Scalar, "density", "kg/m³";
    /// The rounding error of an integrated density, kept where the scalar is `f32`.
    DENSITY_RESIDUAL, Scalar, "density_residual", "kg/m³";
    /// Natural logarithm of the density that cavitated liquid would have over the density at which it is held.
    EXPANSION, Scalar, "expansion", "1";
    /// Specific internal energy e.
    ENERGY, Scalar, "energy", "J/kg";
    /// Smoothing length h.
    SMOOTHING_LENGTH, Scalar, "smoothing_length", "m";
    /// Pressure p, positive in compression.
    PRESSURE, Scalar, "pressure", "Pa";
    /// Sound speed c.
    SOUND_SPEED, Scalar, "sound_speed", "m/s";
    /// The weight B of a particle in pair sums: its mass or its volume, by the density form.
    WEIGHT, Scalar, "weight", "kg or m³";
    /// The pressure coefficient X of the density form; pair forces are −Bᵢ Bⱼ (Xᵢ + Xⱼ) ∇W.
    PRESSURE_COEFFICIENT, Scalar, "pressure_coefficient", "by the density form";
    /// First-moment consistency factor −Σ V r·∇W/D of the reference configuration, by which pair sums are divided.
    CONSISTENCY_FACTOR, Scalar, "consistency_factor", "1";
    /// Sum of kernel weights at rest.
    REFERENCE_SUM, Scalar, "reference_sum", "by the density form";
    /// Density at rest, from which compression is measured.
    REFERENCE_DENSITY, Scalar, "reference_density", "kg/m³";
    /// Velocity gradient ∂vₐ/∂x_b, row a.
    VELOCITY_GRADIENT, Matrix, "velocity_gradient", "1/s";
    /// Pressure gradient ∇p.
    PRESSURE_GRADIENT, Vector, "pressure_gradient", "Pa/m";
    /// Inverse of the kernel's first moment matrix, which makes gradients exact for linear fields.
    CORRECTION, Matrix, "correction", "1";
    /// The particle's own coefficient of artificial viscosity α.
    VISCOSITY_COEFFICIENT, Scalar, "viscosity_coefficient", "1";
    /// Velocity divergence of the step before, whose rate triggers a viscosity switch.
    DIVERGENCE, Scalar, "divergence", "1/s";
    /// Factor Ω of a smoothing length that follows the density.
    GRAD_H, Scalar, "grad_h", "1";
    /// Kernel sum over the other side of a contact from which on the contact is active.
    CONTACT_THRESHOLD, Scalar, "contact_threshold", "1";
    /// One where the particle is active in a contact, zero elsewhere.
    CONTACT_ACTIVITY, Scalar, "contact_activity", "1";
    /// Dynamic viscosity μ.
    DYNAMIC_VISCOSITY, Scalar, "dynamic_viscosity", "Pa s";
    /// Density gradient ∇ρ.
    DENSITY_GRADIENT, Vector, "density_gradient", "kg/m⁴";
    /// Acceleration by [loads](crate::simulation::Load) that depend on the particle.
    LOAD_ACCELERATION, Vector, "load_acceleration", "m/s²";
    /// Rate of specific internal energy by heat sources.
    LOAD_HEATING, Scalar, "load_heating", "W/kg";
    /// Position X in the reference configuration, as built, counted as the position: where terms of a sweep read it, lists and kernels are those
    /// of the reference configuration.
    REFERENCE_POSITION, Point, "reference_position", "m";
    /// Acceleration of a kick, by which the work of its pair forces changes with its length.
    MEAN_ACCELERATION, Vector, "mean_acceleration", "m/s²";
    /// The smoothing length that the last evaluation found, where it follows the density.
    FOUND_SMOOTHING_LENGTH, Scalar, "found_smoothing_length", "m";
    /// Rate of ln h where the smoothing length follows the density, from the last two evaluations: where the next begins
    /// to look for it.
    SMOOTHING_RATE, Scalar, "smoothing_rate", "1/s";
    /// Force that [laws](crate::effect::Law) of [`Stage::Rates`](crate::term::Stage::Rates) add to that of pairs. It is zero before the first of
    /// them in every evaluation, so a law adds to it: others may have done so.
    FORCE, Vector, "force_of_laws", "N";
}

quantities! {
    /// A sum over neighbours.
    Output, output_index, Outputs, "A set of [`Output`]s, usable in constants.";
    /// Force Σⱼ Fᵢⱼ.
    FORCE, Vector, "force", "N";
    /// Rate of internal energy times mass, Σⱼ −½ Fᵢⱼ·vᵢⱼ.
    POWER, Scalar, "power", "W";
    /// Σⱼ Bⱼ vᵢⱼ·∇W, the rate of compression.
    COMPRESSION, Scalar, "compression", "by the density form";
    /// Rate of density by diffusion.
    DENSITY_DIFFUSION, Scalar, "density_diffusion", "kg/(m³ s)";
    /// Σⱼ Bⱼ Wᵢⱼ over the particle's own body and those bonded to it, itself included.
    KERNEL_SUM, Scalar, "kernel_sum", "by the density form";
    /// Σⱼ Bⱼ/ρⱼ Wᵢⱼ, the partition of unity.
    UNITY, Scalar, "unity", "1";
    /// Σⱼ Bⱼ Wᵢⱼ over the other sides of contacts.
    CONTACT_SUM, Scalar, "contact_sum", "1";
    /// −Σⱼ Bⱼ rᵢⱼ·∇W / D, the first moment of the kernel gradient.
    MOMENT, Scalar, "moment", "by the density form";
    /// Σⱼ Bⱼ ∂W/∂h at the particle's own smoothing length.
    SLOPE_IN_H, Scalar, "slope_in_h", "by the density form";
    /// Σⱼ Vⱼ (vⱼ − vᵢ) ⊗ ∇W.
    VELOCITY_GRADIENT, Matrix, "velocity_gradient", "1/s";
    /// Σⱼ Vⱼ (pⱼ − pᵢ) ∇W.
    PRESSURE_GRADIENT, Vector, "pressure_gradient", "Pa/m";
    /// Σⱼ Vⱼ (ρⱼ − ρᵢ) ∇W.
    DENSITY_GRADIENT, Vector, "density_gradient", "kg/m⁴";
    /// Σⱼ Vⱼ pⱼ Wᵢⱼ over liquid, from which a wall takes its pressure.
    LIQUID_PRESSURE, Scalar, "liquid_pressure", "Pa";
    /// Σⱼ Vⱼ ρⱼ rᵢⱼ Wᵢⱼ over liquid, the arm of a wall's hydrostatic pressure.
    LIQUID_MOMENT, Vector, "liquid_moment", "kg/m²";
    /// Σⱼ Vⱼ vⱼ Wᵢⱼ over liquid, from which a wall takes the velocity that makes the liquid stick.
    LIQUID_VELOCITY, Vector, "liquid_velocity", "m/s";
    /// Σⱼ Vⱼ rᵢⱼ Wᵢⱼ over liquid, the arm by which its velocity is seen from a wall that turns.
    LIQUID_ARM, Vector, "liquid_arm", "m";
    /// Σⱼ Vⱼ μⱼ Wᵢⱼ over liquid, from which a wall takes its viscosity.
    LIQUID_VISCOSITY, Scalar, "liquid_viscosity", "Pa s";
    /// The gradient of the concentration, Σⱼ Vⱼ ∇W with a weight that grows as particles meet.
    CONCENTRATION_GRADIENT, Vector, "concentration_gradient", "1/m";
    /// −Σⱼ Vⱼ rᵢⱼ ⊗ ∇W.
    MOMENT_MATRIX, Matrix, "moment_matrix", "1";
    /// The fastest signal that a viscosity saw, a maximum and not a sum.
    SIGNAL, Scalar, "signal", "m/s";
    /// The fastest that signals of a particle and a neighbour meet, a maximum and not a sum.
    SIGNAL_SPEED, Scalar, "signal_speed", "m/s";
    /// Σⱼ Vⱼ sign(∇·vⱼ) Wᵢⱼ, whether the surroundings close in or open.
    DIVERGENCE_SIGN, Scalar, "divergence_sign", "1";
    /// What a second of acceleration adds to the [power](Output::POWER) of the same forces, Σⱼ −½ Fᵢⱼ·aᵢⱼ.
    POWER_OF_ACCELERATION, Scalar, "power_of_acceleration", "W/s";
}

impl Fields {
    /// Those of the set that carry tension as well as compression: pressure coefficients, pressure gradients,
    /// and all symmetric tensors, which are taken for stresses.
    #[must_use]
    pub const fn stresses(self) -> Self {
        const PRESSURES: Fields =
            Fields::of(&[Field::PRESSURE_COEFFICIENT, Field::PRESSURE_GRADIENT]);
        Self(self.0 & (PRESSURES.0 | Self::of_shape(6)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layout_is_dense_and_ordered() {
        const SET: Fields = Fields::of(&[Field::VELOCITY, Field::POSITION, Field::DENSITY]);
        assert_eq!(SET.offset(Field::POSITION, 3), 0);
        assert_eq!(SET.offset(Field::VELOCITY, 3), 3);
        assert_eq!(SET.offset(Field::DENSITY, 3), 6);
        assert_eq!(SET.width(3), 7);
        assert_eq!(SET.iter().count(), 3);
    }

    #[test]
    fn tensors_are_taken_for_stresses_and_temperatures_are_not() {
        const STRESS: Field = Field::tensor(3);
        const TEMPERATURE: Field = Field::scalar(0);
        let set = Fields::of(&[
            STRESS,
            TEMPERATURE,
            Field::PRESSURE_COEFFICIENT,
            Field::MASS,
        ]);
        let carry = Fields::of(&[STRESS, Field::PRESSURE_COEFFICIENT]);
        assert_eq!(set.stresses(), carry);
    }
}
