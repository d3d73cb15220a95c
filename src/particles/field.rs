//! What a particle can carry, and what a sweep over its neighbours can sum.
//! Terms declare both as constants, so storage is the union of what a scene's parts name.

use super::name::{Key, Name, Set, Shape, shapes};

macro_rules! quantities {
    (
        $(#[$doc:meta])* $Quantity:ident, $index:ident, $Set:ident, $set_doc:literal, $example:literal;
        $( $(#[$vdoc:meta])* $NAME:ident, $shape:ident, $name:literal, $unit:literal; )*
    ) => {
        #[allow(non_camel_case_types, clippy::upper_case_acronyms)]
        mod $index {
            #[repr(u8)]
            pub(super) enum Index { $( $NAME, )* }
        }

        $(#[$doc])*
        ///
        /// Those of the crate are constants here. An effect makes its own, as constants too, and names them:
        ///
        /// ```
        /// use meshfree::name;
        #[doc = concat!("use meshfree::particles::", stringify!($Quantity), ";")]
        #[doc = $example]
        /// ```
        ///
        /// The [full name](Self::full_name) tells it from all others. Effects that use one together share the constant.
        #[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub struct $Quantity(Key);

        impl core::fmt::Debug for $Quantity {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                f.write_str(self.index().map_or(self.full_name(), |_| self.name()))
            }
        }

        impl $Quantity {
            $( $(#[$vdoc])* pub const $NAME: Self = Self(Key::of_crate(
                $index::Index::$NAME as u8,
                Shape::$shape,
                &Name { full: concat!("meshfree::", $name), unit: $unit },
            )); )*

            /// Those of the crate that every scheme knows, in the order of storage.
            pub const ALL: &'static [$Quantity] = &[$( $Quantity::$NAME, )*];
            const SHAPES: [u64; 3] = shapes(&[$( Shape::$shape, )*]);

            /// One number of an effect that no rotation changes.
            #[must_use]
            pub const fn scalar(name: &'static Name) -> Self {
                Self(Key::of_effect(Shape::Scalar, name))
            }
            /// A vector of an effect that only rotates.
            #[must_use]
            pub const fn vector(name: &'static Name) -> Self {
                Self(Key::of_effect(Shape::Vector, name))
            }
            /// A symmetric tensor of an effect, of six components whatever the dimension.
            #[must_use]
            pub const fn tensor(name: &'static Name) -> Self {
                Self(Key::of_effect(Shape::Tensor, name))
            }
            /// A `D × D` matrix of an effect, row by row.
            #[must_use]
            pub const fn matrix(name: &'static Name) -> Self {
                Self(Key::of_effect(Shape::Matrix, name))
            }

            /// The place among those of the crate; none of one of an effect.
            #[inline(always)]
            pub(crate) const fn index(self) -> Option<usize> {
                self.0.index()
            }
            /// Whether both are the same, for pair loops: `==` compares names too.
            #[inline(always)]
            pub(crate) const fn is(self, other: Self) -> bool {
                self.0.is(other.0)
            }
            /// Numbers per particle in `d` dimensions.
            #[inline]
            #[must_use]
            pub const fn components(self, d: usize) -> usize {
                self.0.shape().components(d)
            }
            /// How it changes under rotation and reflection.
            #[inline]
            #[must_use]
            pub const fn shape(self) -> Shape {
                self.0.shape()
            }
            /// Its name without the namespace, as it stands in files and messages.
            #[must_use]
            pub const fn name(self) -> &'static str {
                self.0.name().local()
            }
            /// Its SI unit.
            #[must_use]
            pub const fn unit(self) -> &'static str {
                self.0.name().unit
            }
            /// Its name with the package that it belongs to, as `meshfree::density`.
            #[must_use]
            pub const fn full_name(self) -> &'static str {
                self.0.name().full
            }
            /// Its name among others: the full one if it is of an effect, and one of these or of the crate has the same name.
            pub(crate) fn name_among(self, others: impl IntoIterator<Item = Self>) -> &'static str {
                let mut all = Self::ALL.iter().copied().chain(others);
                let clashes = |other: Self| !other.is(self) && other.name() == self.name();
                if self.index().is_none() && all.any(clashes) {
                    return self.full_name();
                }
                self.name()
            }
        }

        #[doc = $set_doc]
        ///
        /// Those of the crate come first, in their order, and those of effects behind them. A set has room for
        #[doc = concat!("[`MOST_OF_EFFECTS`](Self::MOST_OF_EFFECTS) of these. One that lacks room for a member, or has two of one name that differ in shape or unit,")]
        /// does not compile as the set of a sweep, and a scheme with it is refused.
        #[derive(Clone, Copy, PartialEq, Eq)]
        pub struct $Set(Set);

        impl Default for $Set {
            fn default() -> Self {
                Self::NONE
            }
        }

        impl core::fmt::Debug for $Set {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                f.debug_set().entries(self.iter()).finish()
            }
        }

        impl $Set {
            /// The empty set.
            pub const NONE: Self = Self(Set::NONE);
            /// The set of all that the crate names.
            pub const ALL: Self = Self::of($Quantity::ALL);
            /// How many of effects a set has room for.
            pub const MOST_OF_EFFECTS: usize = Set::MOST;

            /// The set of the listed members.
            #[must_use]
            pub const fn of(members: &[$Quantity]) -> Self {
                let (mut set, mut k) = (Set::NONE, 0);
                while k < members.len() {
                    set = set.with(members[k].0);
                    k += 1;
                }
                Self(set)
            }
            /// Members of either set.
            #[must_use]
            pub const fn union(self, other: Self) -> Self {
                Self(self.0.union(&other.0))
            }
            /// Members of this set that are not in the other.
            #[must_use]
            pub const fn minus(self, other: Self) -> Self {
                Self(self.0.minus(&other.0))
            }
            /// The set without `member`.
            #[must_use]
            pub const fn without(self, member: $Quantity) -> Self {
                self.minus(Self::of(&[member]))
            }
            /// Whether it has no members.
            #[must_use]
            pub const fn is_empty(&self) -> bool {
                self.0.is_empty()
            }
            /// Whether `member` belongs to the set.
            #[must_use]
            #[inline(always)]
            pub const fn contains(&self, member: $Quantity) -> bool {
                self.0.contains(member.0)
            }
            /// Where `member` starts when the set is laid out in order, in `d` dimensions.
            #[must_use]
            #[inline(always)]
            pub const fn offset(&self, member: $Quantity, d: usize) -> usize {
                self.0.offset(member.0, &$Quantity::SHAPES, d)
            }
            /// Numbers per particle of the whole set in `d` dimensions.
            #[must_use]
            #[inline(always)]
            pub const fn width(&self, d: usize) -> usize {
                self.0.width(&$Quantity::SHAPES, d)
            }
            /// The members in the order of storage.
            pub fn iter(self) -> impl Iterator<Item = $Quantity> {
                let mut next = 0;
                core::iter::from_fn(move || {
                    let member;
                    (member, next) = self.from(next)?;
                    Some(member)
                })
            }
            /// The first member from a place on, and the place behind it; from zero on this goes through all members.
            #[allow(clippy::wrong_self_convention)]
            pub(crate) const fn from(&self, place: usize) -> Option<($Quantity, usize)> {
                let Some(at) = self.0.place_from(place) else {
                    return None;
                };
                let member = match self.0.of_effect(at) {
                    Some(key) => $Quantity(key),
                    None => $Quantity::ALL[at],
                };
                Some((member, at + 1))
            }
            /// The place of a member in tables of [`PLACES`](Self::PLACES): those of the crate have one whether or not they
            /// are members.
            #[allow(dead_code)]
            #[inline(always)]
            pub(crate) const fn place(&self, member: $Quantity) -> Option<usize> {
                self.0.place(member.0)
            }
            /// How many places tables of members need.
            #[allow(dead_code)]
            pub(crate) const PLACES: usize = Set::PLACES;
            /// Whether the set has all that was put into it.
            pub(crate) const fn is_sound(&self) -> bool {
                self.0.fault().is_none()
            }
            /// Why the set does not have all that was put into it, in words.
            pub(crate) fn fault(&self) -> Option<String> {
                let [first, second] = self.0.fault()?;
                Some(first.against(second))
            }
        }
    };
}

quantities! {
    /// A quantity that a particle carries.
    Field, field_index, Fields, "A set of [`Field`]s, usable in constants.",
    "const STRESS: Field = Field::tensor(name!(\"stress\", \"Pa\"));";
    /// Position x, counted from the [origin](crate::scene#place) of the scene.
    POSITION, Point, "position", "m";
    /// The rounding error of the position, kept where the scalar is `f32`.
    POSITION_RESIDUAL, Vector, "position_residual", "m";
    /// Velocity v.
    VELOCITY, Velocity, "velocity", "m/s";
    /// Velocity with which the work of pair forces is summed: the mean of a kick or, in total-Lagrangian schemes, that of the evaluation.
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
    /// Inverse of the moment matrix, which makes gradients exact for linear fields; in m⁻² where kernels are the
    /// [weights](crate::term::Pair::weight_i).
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
    Output, output_index, Outputs, "A set of [`Output`]s, usable in constants.",
    "const FLOW: Output = Output::scalar(name!(\"heat_flow\", \"W\"));";
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
        let pressures = Self::of(&[Field::PRESSURE_COEFFICIENT, Field::PRESSURE_GRADIENT]);
        let (mut others, mut place) = (self.minus(pressures), 0);
        while let Some((field, next)) = others.from(place) {
            if matches!(field.shape(), Shape::Tensor) {
                others = others.without(field);
            } else {
                place = next;
            }
        }
        self.minus(others)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::name;

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
        const STRESS: Field = Field::tensor(name!("stress", "Pa"));
        const TEMPERATURE: Field = Field::scalar(name!("temperature", "K"));
        let set = Fields::of(&[
            STRESS,
            TEMPERATURE,
            Field::PRESSURE_COEFFICIENT,
            Field::MASS,
        ]);
        let carry = Fields::of(&[STRESS, Field::PRESSURE_COEFFICIENT]);
        assert_eq!(set.stresses(), carry);
    }

    /// A name that only a test knows.
    fn named(package: &str, local: &str, unit: &'static str) -> &'static Name {
        let full = format!("{package}::{local}").leak();
        Box::leak(Box::new(Name { full, unit }))
    }

    #[test]
    fn a_set_of_any_fields_is_what_a_list_of_them_is() {
        let shapes = [Field::scalar, Field::vector, Field::tensor, Field::matrix];
        let all: Vec<Field> = (0..Fields::MOST_OF_EFFECTS)
            .map(|k| shapes[k % 4](named("a", &k.to_string(), "1")))
            .chain(Field::ALL.iter().copied())
            .collect();
        let set = all
            .iter()
            .fold(Fields::NONE, |set, own| set.union(Fields::of(&[*own])));
        assert!(set.is_sound() && set == Fields::of(&all));
        let members: Vec<Field> = set.iter().collect();
        assert_eq!(members.len(), all.len());
        assert!(members.is_sorted());
        let mut at = 0;
        for field in &members {
            assert_eq!(set.offset(*field, 2), at);
            at += field.components(2);
            assert!(set.contains(*field) && !set.without(*field).contains(*field));
        }
        assert_eq!(set.width(2), at);
        let half = Fields::of(&all[10..40]);
        let other: Vec<Field> = all
            .iter()
            .copied()
            .filter(|own| !half.contains(*own))
            .collect();
        assert_eq!(set.minus(half), Fields::of(&other));
        assert_eq!(half.minus(set), Fields::NONE);
    }

    #[test]
    fn what_a_set_has_no_room_for_it_names() {
        let fields: Vec<Field> = (0..Fields::MOST_OF_EFFECTS + 1)
            .map(|k| Field::scalar(named("a", &format!("f{k}"), "1")))
            .collect();
        let set = Fields::of(&fields);
        assert_eq!(set.iter().count(), Fields::MOST_OF_EFFECTS);
        let fault = Fields::of(&[Field::MASS])
            .union(set)
            .fault()
            .expect("a fault");
        assert_eq!(
            fault,
            "there is no room for `a::f32` beside 32 others of effects"
        );
    }

    #[test]
    fn one_name_of_two_shapes_or_units_is_a_fault() {
        let name = |unit| named("a", "stress", unit);
        let own = Field::tensor(name("Pa"));
        for other in [
            Field::scalar(name("Pa")),
            Field::matrix(name("Pa")),
            Field::tensor(name("bar")),
        ] {
            let fault = Fields::of(&[own]).union(Fields::of(&[other])).fault();
            let fault = fault.expect("a fault");
            assert!(fault.contains("`a::stress` is a tensor [Pa]"), "{fault}");
        }
        assert!(Fields::of(&[own, own, Field::tensor(name("Pa"))]).is_sound());
    }

    #[test]
    fn a_name_that_two_have_is_written_in_full() {
        let [a, b] = ["a", "b"].map(|own| Field::scalar(named(own, "dye", "1")));
        let density = Field::scalar(named("a", "density", "1"));
        assert_eq!(a.name_among([a, density, Field::DENSITY]), "dye");
        assert_eq!(a.name_among([a, b]), "a::dye");
        assert_eq!(density.name_among([]), "a::density");
        assert_eq!(Field::DENSITY.name_among([density]), "density");
    }
}
