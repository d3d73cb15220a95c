//! The list of all effects, for tests and benchmarks that run over each of them.
//! A new effect takes one line here, and is then held to what all are held to.

/// Calls a macro with one effect of each kind, as expressions, in groups by the schemes that they go with: liquids, solids that
/// follow present neighbours, total-Lagrangian solids, sheets in plane stress (two dimensions) and rods in uniaxial stress
/// (one dimension). Whatever else it is given comes first.
///
/// ```
/// macro_rules! count {
///     ($($group:ident [$($effect:expr),*])*) => { [$([$(stringify!($effect)),*].len()),*] };
/// }
/// assert!(meshfree::for_each_effect!(count).iter().sum::<usize>() > 20);
/// ```
#[macro_export]
macro_rules! for_each_effect {
    ($callback:ident $($given:tt)*) => {
        $callback! {
            $($given)*
            liquid [
                $crate::effect::Cavitation,
                $crate::effect::ExpansionMemory,
                $crate::effect::AcousticDamping { strength: 0.3 },
                $crate::effect::VolumeConsistency { strength: 0.05 },
                $crate::effect::DensityDiffusion($crate::term::Fourtakas::default()),
                $crate::effect::Shifting::STANDARD,
                $crate::effect::Laminar($crate::term::LaminarViscosity),
                $crate::effect::GeneralisedNewtonian,
                $crate::effect::ArtificialPressure::default(),
                $crate::effect::PairingControl::default(),
                $crate::effect::ConsistentShifting::default(),
                $crate::effect::ArbitraryLagrangian::<false>::default(),
                $crate::effect::Eulerian::<false>,
                $crate::effect::PressureDifference,
                $crate::effect::TwoPhase::default(),
                $crate::effect::SurfaceTension::between("oil", "water", 0.03),
                $crate::effect::Sponge::beyond([0.0], [1.0], 1.0, 1.0),
                $crate::effect::AbsorbingLayer::beyond([0.0], [1.0], 1.0),
                $crate::effect::ExtrapolatedPressure::default(),
                $crate::effect::HydrostaticWalls::default(),
                $crate::effect::RiemannWalls::default()
            ]
            solid [
                $crate::term::PressureForce,
                $crate::term::RenormalisedPressureForce,
                $crate::term::MatrixPressureForce,
                $crate::term::MidpointReconstruction::STANDARD,
                $crate::term::KernelSum,
                $crate::effect::MixedSpacing,
                $crate::effect::DivergenceSmoothing { smallest: 0.5, largest: 2.0 },
                $crate::effect::ConsistentSmoothing { smallest: 0.5, largest: 2.0 },
                $crate::effect::Hypoelastic,
                $crate::effect::RenormalisedHypoelastic,
                $crate::effect::Plasticity,
                $crate::effect::Damage,
                $crate::effect::DensityFloor::default(),
                $crate::effect::ProgrammedBurn::new("test", 4e3).lit_at_point([0.0], 0.0),
                $crate::effect::ArtificialConduction::default(),
                $crate::effect::ArtificialStress::default(),
                $crate::effect::HeatConduction { conductivity: 400.0, specific_heat: 385.0, temperature: 300.0 },
                $crate::effect::SurfaceHeat::convection(1e3, 400.0),
                $crate::effect::HourglassFree::default()
            ]
            total_lagrangian [
                $crate::effect::TotalLagrangian,
                $crate::effect::NeoHookean,
                $crate::effect::StVenantKirchhoff,
                $crate::effect::FiniteStrainPlasticity,
                $crate::effect::LagrangianLiquid,
                $crate::effect::HourglassControl::default(),
                $crate::effect::YieldingHourglass
            ]
            sheet [
                $crate::effect::PlaneStress,
                $crate::effect::StVenantKirchhoff.plane_stress(),
                $crate::effect::NeoHookean.plane_stress()
            ]
            rod [
                $crate::effect::UniaxialStress
            ]
        }
    };
}
