//! The bands of the dimensionless numbers: below which bound an effect is skipped, and from which on it is needed.
//! Customary values; each is a table, so that a test can look at both sides of every bound.

use super::{Line, Need};

/// A band of a number: what follows from a value below `below`, and at least the bound of the band before.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Band {
    /// Its upper bound, which does not belong to it; infinity for the last.
    pub below: f64,
    /// What follows.
    pub need: Need,
    /// Why.
    pub reason: &'static str,
}

/// A dimensionless number, the effect that it speaks of, and its bands from low to high.
///
/// ```
/// use meshfree::scene::advice::{Need, Scale};
/// let mach = Scale::ALL.iter().find(|scale| scale.number == "U/c").unwrap();
/// assert_eq!(mach.band(0.05).need, Need::Skip);
/// assert_eq!(mach.band(0.1).need, Need::Require);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Scale {
    /// The effect.
    pub effect: &'static str,
    /// The number, as a formula.
    pub number: &'static str,
    /// Its bands, the last of them without an upper bound.
    pub bands: &'static [Band],
}

impl Scale {
    /// The band of a value.
    #[must_use]
    pub fn band(&self, value: f64) -> &'static Band {
        &self.bands[self.place(value)]
    }

    /// The place of that band.
    fn place(&self, value: f64) -> usize {
        let last = self.bands.len() - 1;
        self.bands[..last].partition_point(|band| value >= band.below)
    }

    /// What a value says of a body.
    pub(super) fn line(&self, of: &str, value: f64, present: Option<bool>) -> Line {
        let number = self.place(value);
        let band = &self.bands[number];
        let bounds = match (
            number.checked_sub(1).map(|k| self.bands[k].below),
            band.below,
        ) {
            (None, high) => format!("< {high}"),
            (Some(low), high) if high.is_finite() => format!("{low} to {high}"),
            (Some(low), _) => format!(">= {low}"),
        };
        Line {
            effect: self.effect,
            of: of.into(),
            number: self.number,
            value,
            need: band.need,
            band: bounds,
            reason: band.reason.into(),
            present,
        }
    }
}

/// A scale from `effect, number: (need, reason) bound (need, reason) …`.
macro_rules! scales {
    ($( $name:ident $effect:literal, $number:literal:
        $( $need:ident $reason:literal, below $bound:literal; )* => $last:ident $why:literal; )*) => {
        $( pub(super) const $name: Scale = Scale {
            effect: $effect,
            number: $number,
            bands: &[
                $( Band { below: $bound, need: Need::$need, reason: $reason }, )*
                Band { below: f64::INFINITY, need: Need::$last, reason: $why },
            ],
        }; )*
        impl Scale {
            /// All numbers that advice knows.
            pub const ALL: &'static [Self] = &[$( $name ),*];
        }
    };
}

scales! {
    MACH "physical sound speed", "U/c":
        Skip "density keeps within 1 %: an artificial sound speed of ten times the flow is enough", below 0.1;
        => Require "density changes by more than 1 %";
    VISCOUS "sound speed above that of viscous pressure", "p_v/(rho c2)":
        Skip "viscous pressure compresses the liquid by less than 1 %", below 0.01;
        Optional "viscous pressure compresses the liquid by 1 to 3 %, and forces are low by some per cent", below 0.03;
        => Impossible "viscous pressure compresses the liquid, and forces are far too low";
    UNDER_PRESSURE "pressure by differences", "p/(mu U/L + rho U2)":
        Skip "pressure is of the order of the stresses of the flow", below 3.0;
        Optional "pressure hardens the lattice of particles against shear: slow viscous flow is slower by 10 to \
        20 %", below 30.0;
        => Recommend "pressure hardens the lattice of particles against shear: slow viscous flow has about half \
        of its speed";
    CROSSINGS "physical sound speed", "t c/L":
        Require "waves cross few times and decide what happens", below 100.0;
        Optional "waves cross often: what matters is whether the pressure of impacts does", below 1e4;
        => Skip "sound has long settled; an incompressible method would be cheaper";
    SHOCK "energy and shock viscosity", "u/c":
        Skip "the shock is weak", below 0.1;
        Optional "a shock of moderate strength heats a little", below 0.3;
        => Require "a strong shock heats and has to be captured";
    NONLINEAR "nonlinear equation of state", "S u/c":
        Skip "linear in the range of the shock", below 1e-2;
        Optional "the shock is faster than sound by this share", below 0.1;
        => Require "the whole shock curve is needed";
    YIELD "plasticity", "stress of the impact/Y":
        Skip "it stays elastic", below 0.8;
        Recommend "it comes near to yielding: worth a check", below 1.0;
        => Require "it yields";
    STATIC "plasticity", "E strain/Y":
        Skip "it stays elastic", below 0.8;
        Recommend "it comes near to yielding: worth a check", below 1.0;
        => Require "it yields";
    JOHNSON "plasticity in the flow", "rho U2/Y":
        Skip "quasi-static and elastic", below 1e-3;
        Optional "stresses of the impact decide", below 1.0;
        => Optional "inertia outweighs strength: it flows as a liquid once the first wave has passed";
    THERMAL "thermal pressure", "Gamma rho e/p":
        Skip "heat of the shock hardly changes the pressure", below 0.01;
        Optional "heat of the shock changes the pressure by some per cent", below 0.05;
        => Require "heat of the shock is part of the pressure";
    FOURIER "heat conduction", "kappa t/L2":
        Skip "heat stays where it is made", below 0.1;
        => Require "heat crosses the body within the run";
    RATE "rate of strain in the yield stress", "Y(rate)/Y(0) - 1":
        Skip "the rate hardly changes the yield stress", below 0.05;
        Optional "the rate changes the yield stress a little", below 0.1;
        => Require "the rate hardens by this share";
    ASYMMETRY "sign of pressure in the yield stress", "Y(p)/Y(-p) - 1":
        Skip "it yields equally in tension and compression", below 0.05;
        Optional "it yields a little later in compression", below 0.1;
        => Require "it yields later in compression by this share";
    OPENS "contact that opens", "t c/(2 L)":
        Skip "the run ends before release", below 1.0;
        => Require "release waves bring tension to the contact, which has to open; consider the remedies for \
        tension too";
    REYNOLDS "viscosity", "U L/nu":
        Require "viscous forces are felt throughout", below 1e3;
        Optional "viscosity is felt near walls", below 1e4;
        => Skip "inertia outweighs viscosity by far";
    VISIBLE "viscosity, against that of the scheme", "(alpha h c/10)/nu":
        Optional "the viscosity of the liquid is the larger", below 1.0;
        => Impossible "the artificial viscosity hides that of the liquid: take a finer spacing or a smaller alpha";
    WALL_REYNOLDS "no-slip walls", "U dx/nu":
        Require "the layer at walls is resolved", below 10.0;
        Optional "the layer at walls is a spacing or so thick", below 50.0;
        => Skip "the layer at walls is not resolved: free slip is nearer";
    FROUDE "gravity", "max(U/sqrt(g L), a/g)":
        Require "gravity is felt", below 10.0;
        => Skip "inertia and other loads outweigh gravity";
    WEBER "surface tension", "rho U2 L/sigma":
        Require "it shapes the surface", below 100.0;
        Optional "it is felt in drops and thin films", below 1e3;
        => Skip "inertia outweighs it";
    BOND "surface tension", "rho a L2/sigma":
        Require "it holds the liquid against loads", below 10.0;
        Optional "it is felt in drops and thin films", below 1e3;
        => Skip "loads outweigh it";
    DEFLECTION "two-way coupling", "0.014 (rho U2/E)(L/t)3":
        Skip "the wall moves too little to affect the liquid", below 1e-3;
        Optional "one-way coupling is enough for the forces of the liquid; stress and vibration of the wall need \
        two-way coupling", below 1e-2;
        => Require "the wall moves, and changes the flow";
    ADDED_MASS "two-way coupling, added mass", "rho L/(rho_s t)":
        Skip "the liquid is light compared with the wall", below 0.1;
        Recommend "the liquid is about as heavy as the wall", below 1.0;
        => Require "the liquid moves with the wall as an added mass: couple both ways, and sub-cycle the wall";
    CAVITATION "cavitation", "(p - p_v)/(rho U2/2)":
        Require "the liquid cavitates: cut its tension off", below 0.0;
        Optional "suction reaches the vapour pressure where flow is fastest", below 1.0;
        => Skip "suction does not reach the vapour pressure";
    GAS "gas beside the liquid", "rho_2/rho_1":
        Skip "the gas is light", below 1e-2;
        => Require "the gas is heavy enough to matter";
    BENDING "spacing across what bends in space", "thickness/dx in 3D":
        Optional "first frequencies of bending are low by 13 % at four particles, 7 % at six", below 7.5;
        => Skip "first frequencies of bending are low by less than 5 %";
    RESOLUTION "spacing across a thin part", "thickness/dx":
        Impossible "too few particles across to bend or flow: take a finer spacing", below 4.0;
        Optional "at the limit of what bends or flows", below 5.0;
        => Skip "resolved";
    ROWS "rows of a recorded motion", "|s_2 - s|/A":
        Skip "the rows resolve the motion", below 0.01;
        Recommend "the greatest accelerations are off by 1.5 to 5 %: give rows at shorter intervals", below 0.1;
        => Impossible "the rows do not resolve the motion: give rows at shorter intervals";
    FLOW_ROWS "rows of an open boundary", "|q_2 - q|/A":
        Skip "the rows resolve the flow or pressure", below 0.01;
        Recommend "the greatest accelerations of the liquid are off by some per cent: give rows at shorter intervals", below 0.1;
        => Impossible "the rows do not resolve the flow or pressure, and another mass passes: give rows at shorter \
        intervals";
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bound_has_two_sides() {
        for scale in Scale::ALL {
            let bands = scale.bands;
            let (last, bounded) = bands.split_last().expect("a band");
            assert_eq!(last.below, f64::INFINITY, "{}", scale.number);
            assert!(!bounded.is_empty(), "{}", scale.number);
            for (k, band) in bounded.iter().enumerate() {
                let bound = band.below;
                let just_below = bound - 1e-12 * bound.abs().max(1e-3);
                for (value, expected) in [(just_below, band), (bound, &bands[k + 1])] {
                    let line = scale.line("it", value, None);
                    assert_eq!(scale.band(value), expected, "{} at {value}", scale.number);
                    assert_eq!(
                        (line.need, line.reason.as_str()),
                        (expected.need, expected.reason)
                    );
                }
                assert_ne!(band.reason, bands[k + 1].reason, "{}", scale.number);
            }
            // Bounds rise, and the ends belong to the outer bands.
            assert!(bands.windows(2).all(|pair| pair[0].below < pair[1].below));
            assert_eq!(scale.band(-1e30), &bands[0]);
            assert_eq!(scale.band(1e30), last);
        }
    }

    #[test]
    fn bands_are_told_in_words() {
        let band = |value| YIELD.line("rod", value, Some(false)).band;
        assert_eq!(
            [band(0.5), band(0.9), band(2.0)],
            ["< 0.8", "0.8 to 1", ">= 1"]
        );
    }
}
