//! What can be chosen by name on the command line: scheme, integrator, contact, state.
//! Each list is written once; parsing, help and messages follow from it.

use clap::ValueEnum;
use clap::builder::PossibleValue;
use meshfree::integrator::{
    DriftKickDrift, Integrator, KickDriftKick, LamLeapfrog, Midpoint, PositionVerlet, Predictor,
    RungeKutta4, StrongStabilityPreserving3,
};
use meshfree::study;
use meshfree::sweep::Interaction;

macro_rules! choices {
    ($(#[$text:meta])* $Name:ident: $($Variant:ident $key:literal),* $(,)?) => {
        $(#[$text])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $Name { $($Variant),* }

        impl $Name {
            /// The name on the command line.
            pub const fn key(self) -> &'static str {
                match self { $(Self::$Variant => $key),* }
            }
        }

        impl ValueEnum for $Name {
            fn value_variants<'a>() -> &'a [Self] {
                &[$(Self::$Variant),*]
            }
            fn to_possible_value(&self) -> Option<PossibleValue> {
                Some(PossibleValue::new(self.key()))
            }
        }
    };
}

choices! {
    /// The scheme.
    SchemeChoice:
    Impact "impact", Continuity "continuity", Lam2002 "lam2002",
}

choices! {
    /// The integrator.
    IntegratorChoice:
    KickDriftKick "kick-drift-kick", DriftKickDrift "drift-kick-drift",
    PositionVerlet "position-verlet", Midpoint "midpoint", SspRk3 "ssp-rk3", RungeKutta4 "rk4",
    LamFresh "lam-fresh", LamLagged "lam-lagged",
}

choices! {
    /// What the striker (or its pad) and the target do to each other.
    ContactChoice:
    Unilateral "unilateral", Bonded "bonded",
}

choices! {
    /// What stress a rod supports: pressure alone, or that of a layer of a plate, or that of a slender bar.
    StateChoice:
    Hydrodynamic "hydrodynamic", UniaxialStrain "uniaxial-strain", UniaxialStress "uniaxial-stress",
}

choices! {
    /// Whether rods yield.
    StrengthChoice:
    On "on", Off "off",
}

impl SchemeChoice {
    /// The integrator that the scheme runs with by default.
    pub fn integrator(self) -> IntegratorChoice {
        match self {
            Self::Lam2002 => IntegratorChoice::LamFresh,
            _ => IntegratorChoice::KickDriftKick,
        }
    }
    /// The contact law that the scheme runs with by default; the paper has none.
    pub fn contact(self) -> ContactChoice {
        match self {
            Self::Lam2002 => ContactChoice::Bonded,
            _ => ContactChoice::Unilateral,
        }
    }
}

impl IntegratorChoice {
    pub fn make(self) -> Box<dyn Integrator> {
        let lam = |predictor| Box::new(LamLeapfrog { predictor });
        match self {
            Self::KickDriftKick => Box::new(KickDriftKick),
            Self::DriftKickDrift => Box::new(DriftKickDrift),
            Self::PositionVerlet => Box::new(PositionVerlet),
            Self::Midpoint => Box::new(Midpoint),
            Self::SspRk3 => Box::new(StrongStabilityPreserving3),
            Self::RungeKutta4 => Box::new(RungeKutta4),
            Self::LamFresh => lam(Predictor::Fresh),
            Self::LamLagged => lam(Predictor::Lagged),
        }
    }
}

impl ContactChoice {
    pub fn interaction(self) -> Interaction {
        match self {
            Self::Unilateral => Interaction::Unilateral,
            Self::Bonded => Interaction::Bonded,
        }
    }
    pub fn in_theory(self) -> study::Contact {
        match self {
            Self::Unilateral => study::Contact::Unilateral,
            Self::Bonded => study::Contact::Bonded,
        }
    }
    /// A wall under this contact law.
    pub fn wall(self) -> study::End {
        match self {
            Self::Unilateral => study::End::Wall,
            Self::Bonded => study::End::Bonded,
        }
    }
}
