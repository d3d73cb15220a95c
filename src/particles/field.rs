//! What a particle can carry, and what a sweep over its neighbours can sum.
//! Terms declare both as constants, so storage is the union of what a scene's parts name.

macro_rules! quantities {
    (
        $(#[$doc:meta])* $Quantity:ident, $Set:ident, $set_doc:literal;
        $( $(#[$vdoc:meta])* $variant:ident, $shape:ident, $name:literal, $unit:literal; )*
    ) => {
        $(#[$doc])*
        #[derive(Clone, Copy, PartialEq, Eq, Debug, Hash, PartialOrd, Ord)]
        #[repr(u8)]
        pub enum $Quantity { $( $(#[$vdoc])* $variant, )* }

        impl $Quantity {
            /// Every one, in the order of storage.
            pub const ALL: &'static [$Quantity] = &[$( $Quantity::$variant, )*];
            /// How many there are.
            pub const COUNT: usize = Self::ALL.len();

            /// Numbers per particle in `d` dimensions.
            #[must_use]
            pub const fn components(self, d: usize) -> usize {
                match self { $( $Quantity::$variant => Shape::$shape.components(d), )* }
            }
            /// How it changes under rotation and reflection.
            #[must_use]
            pub const fn shape(self) -> Shape {
                match self { $( $Quantity::$variant => Shape::$shape, )* }
            }
            /// Its name in files and messages.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $( $Quantity::$variant => $name, )* }
            }
            /// Its SI unit.
            #[must_use]
            pub const fn unit(self) -> &'static str {
                match self { $( $Quantity::$variant => $unit, )* }
            }
        }

        #[doc = $set_doc]
        #[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
        pub struct $Set(u64);

        impl $Set {
            /// The empty set.
            pub const NONE: Self = Self(0);
            /// The set of all.
            pub const ALL: Self = Self::of($Quantity::ALL);

            /// The set of the listed members.
            #[must_use]
            pub const fn of(members: &[$Quantity]) -> Self {
                let (mut bits, mut k) = (0, 0);
                while k < members.len() {
                    bits |= 1 << members[k] as u64;
                    k += 1;
                }
                Self(bits)
            }
            /// Members of either set.
            #[must_use]
            pub const fn union(self, other: Self) -> Self {
                Self(self.0 | other.0)
            }
            /// The set without `member`.
            #[must_use]
            pub const fn without(self, member: $Quantity) -> Self {
                Self(self.0 & !(1 << member as u64))
            }
            /// Whether `member` belongs to the set.
            #[must_use]
            #[inline(always)]
            pub const fn contains(self, member: $Quantity) -> bool {
                self.0 >> member as u64 & 1 == 1
            }
            /// Where `member` starts when the set is laid out in order, in `d` dimensions.
            #[must_use]
            #[inline(always)]
            pub const fn offset(self, member: $Quantity, d: usize) -> usize {
                Self(self.0 & ((1 << member as u64) - 1)).width(d)
            }
            /// Numbers per particle of the whole set in `d` dimensions.
            ///
            /// Three population counts, so that the pair loop sees constants.
            #[must_use]
            #[inline(always)]
            pub const fn width(self, d: usize) -> usize {
                const SCALARS: u64 = $Set::with_components(1);
                const MATRICES: u64 = $Set::with_components(9);
                let scalars = (self.0 & SCALARS).count_ones() as usize;
                let matrices = (self.0 & MATRICES).count_ones() as usize;
                let vectors = (self.0 & !(SCALARS | MATRICES)).count_ones() as usize;
                scalars + vectors * d + matrices * d * d
            }
            const fn with_components(components: usize) -> u64 {
                let (mut bits, mut k) = (0, 0);
                while k < $Quantity::COUNT {
                    if $Quantity::ALL[k].components(3) == components {
                        bits |= 1 << k;
                    }
                    k += 1;
                }
                bits
            }
            /// The members in the order of storage.
            pub fn iter(self) -> impl Iterator<Item = $Quantity> {
                $Quantity::ALL.iter().copied().filter(move |&member| self.contains(member))
            }
        }
    };
}

/// How a quantity changes under rotation and reflection.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Shape {
    /// One number that no rotation changes.
    Scalar,
    /// A point in space.
    Point,
    /// A velocity: also shifted by a moving boundary.
    Velocity,
    /// A vector that only rotates.
    Vector,
    /// A `D × D` matrix, row by row.
    Matrix,
}

impl Shape {
    const fn components(self, d: usize) -> usize {
        match self {
            Shape::Scalar => 1,
            Shape::Point | Shape::Velocity | Shape::Vector => d,
            Shape::Matrix => d * d,
        }
    }
}

quantities! {
    /// A quantity that a particle carries.
    Field, Fields, "A set of [`Field`]s, usable in constants.";
    /// Position x.
    Position, Point, "position", "m";
    /// The rounding error of the position, kept where the scalar is `f32`.
    PositionResidual, Vector, "position_residual", "m";
    /// Velocity v.
    Velocity, Velocity, "velocity", "m/s";
    /// Velocity averaged over a kick, with which pair forces do their work.
    MeanVelocity, Velocity, "mean_velocity", "m/s";
    /// Mass m.
    Mass, Scalar, "mass", "kg";
    /// Density ρ.
    Density, Scalar, "density", "kg/m³";
    /// The rounding error of an integrated density, kept where the scalar is `f32`.
    DensityResidual, Scalar, "density_residual", "kg/m³";
    /// Natural logarithm of the density that torn liquid would have over the density at which it is held.
    Tear, Scalar, "tear", "1";
    /// Specific internal energy e.
    Energy, Scalar, "energy", "J/kg";
    /// Smoothing length h.
    SmoothingLength, Scalar, "smoothing_length", "m";
    /// Pressure p, positive in compression.
    Pressure, Scalar, "pressure", "Pa";
    /// Sound speed c.
    SoundSpeed, Scalar, "sound_speed", "m/s";
    /// The weight B of a particle in pair sums: its mass or its volume, by the density form.
    Weight, Scalar, "weight", "kg or m³";
    /// The pressure coefficient X of the density form; pair forces are −Bᵢ Bⱼ (Xᵢ + Xⱼ) ∇W.
    PressureCoefficient, Scalar, "pressure_coefficient", "by the density form";
    /// First moment of the kernel gradient at rest, by which the pair is normalised.
    Normalisation, Scalar, "normalisation", "1";
    /// Sum of kernel weights at rest.
    ReferenceSum, Scalar, "reference_sum", "by the density form";
    /// Density at rest, from which compression is measured.
    ReferenceDensity, Scalar, "reference_density", "kg/m³";
    /// Velocity gradient ∂vₐ/∂x_b, row a.
    VelocityGradient, Matrix, "velocity_gradient", "1/s";
    /// Pressure gradient ∇p.
    PressureGradient, Vector, "pressure_gradient", "Pa/m";
    /// Inverse of the kernel's first moment matrix, which makes gradients exact for linear fields.
    Correction, Matrix, "correction", "1";
    /// The particle's own coefficient of artificial viscosity α.
    ViscosityCoefficient, Scalar, "viscosity_coefficient", "1";
    /// Velocity divergence of the step before, whose rate triggers a viscosity switch.
    Divergence, Scalar, "divergence", "1/s";
    /// Factor Ω of a smoothing length that follows the density.
    GradH, Scalar, "grad_h", "1";
    /// Kernel sum over the other side of a contact at the moment of touching.
    TouchingSum, Scalar, "touching_sum", "1";
    /// One where the particle touches the other side of a contact, zero elsewhere.
    Touching, Scalar, "touching", "1";
    /// Dynamic viscosity μ.
    DynamicViscosity, Scalar, "dynamic_viscosity", "Pa s";
    /// Density gradient ∇ρ.
    DensityGradient, Vector, "density_gradient", "kg/m⁴";
    /// Free for a user's own terms.
    UserA, Scalar, "user_a", "";
    /// Free for a user's own terms.
    UserB, Scalar, "user_b", "";
}

quantities! {
    /// A sum over neighbours.
    Output, Outputs, "A set of [`Output`]s, usable in constants.";
    /// Force Σⱼ Fᵢⱼ.
    Force, Vector, "force", "N";
    /// Rate of internal energy times mass, Σⱼ −½ Fᵢⱼ·vᵢⱼ.
    Power, Scalar, "power", "W";
    /// Σⱼ Bⱼ vᵢⱼ·∇W, the rate of compression.
    Compression, Scalar, "compression", "by the density form";
    /// Rate of density by diffusion.
    DensityDiffusion, Scalar, "density_diffusion", "kg/(m³ s)";
    /// Σⱼ Bⱼ Wᵢⱼ over the particle's own body and those bonded to it, itself included.
    KernelSum, Scalar, "kernel_sum", "by the density form";
    /// Σⱼ Bⱼ/ρⱼ Wᵢⱼ, the partition of unity.
    Unity, Scalar, "unity", "1";
    /// Σⱼ Bⱼ Wᵢⱼ over the other sides of contacts.
    ContactSum, Scalar, "contact_sum", "1";
    /// −Σⱼ Bⱼ rᵢⱼ·∇W / D, the first moment of the kernel gradient.
    Moment, Scalar, "moment", "by the density form";
    /// Σⱼ Bⱼ ∂W/∂h at the particle's own smoothing length.
    SlopeInH, Scalar, "slope_in_h", "by the density form";
    /// Σⱼ Vⱼ (vⱼ − vᵢ) ⊗ ∇W.
    VelocityGradient, Matrix, "velocity_gradient", "1/s";
    /// Σⱼ Vⱼ (pⱼ − pᵢ) ∇W.
    PressureGradient, Vector, "pressure_gradient", "Pa/m";
    /// Σⱼ Vⱼ (ρⱼ − ρᵢ) ∇W.
    DensityGradient, Vector, "density_gradient", "kg/m⁴";
    /// Σⱼ Vⱼ pⱼ Wᵢⱼ over liquid, from which a wall takes its pressure.
    LiquidPressure, Scalar, "liquid_pressure", "Pa";
    /// Σⱼ Vⱼ ρⱼ rᵢⱼ Wᵢⱼ over liquid, the arm of a wall's hydrostatic pressure.
    LiquidMoment, Vector, "liquid_moment", "kg/m²";
    /// Σⱼ Vⱼ vⱼ Wᵢⱼ over liquid, from which a wall takes the velocity that makes the liquid stick.
    LiquidVelocity, Vector, "liquid_velocity", "m/s";
    /// Σⱼ Vⱼ μⱼ Wᵢⱼ over liquid, from which a wall takes its viscosity.
    LiquidViscosity, Scalar, "liquid_viscosity", "Pa s";
    /// Σⱼ Vⱼ ∇W with a weight that grows as particles meet: where they crowd.
    Crowding, Vector, "crowding", "1/m";
    /// −Σⱼ Vⱼ rᵢⱼ ⊗ ∇W.
    MomentMatrix, Matrix, "moment_matrix", "1";
    /// The fastest signal that a viscosity saw, a maximum and not a sum.
    Signal, Scalar, "signal", "m/s";
    /// The fastest that signals of a particle and a neighbour meet, a maximum and not a sum.
    SignalSpeed, Scalar, "signal_speed", "m/s";
    /// Σⱼ Vⱼ sign(∇·vⱼ) Wᵢⱼ, whether the surroundings close in or open.
    DivergenceSign, Scalar, "divergence_sign", "1";
    /// Free for a user's own terms.
    UserA, Scalar, "user_a", "";
    /// Free for a user's own terms.
    UserB, Scalar, "user_b", "";
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layout_is_dense_and_ordered() {
        const SET: Fields = Fields::of(&[Field::Velocity, Field::Position, Field::Density]);
        assert_eq!(SET.offset(Field::Position, 3), 0);
        assert_eq!(SET.offset(Field::Velocity, 3), 3);
        assert_eq!(SET.offset(Field::Density, 3), 6);
        assert_eq!(SET.width(3), 7);
        assert_eq!(SET.iter().count(), 3);
    }
}
