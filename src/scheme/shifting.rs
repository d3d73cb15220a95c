//! Shifting: how a scheme keeps the particles of a liquid evenly spread.
//! By the gradient of their concentration, or by a background pressure that moves particles alone.

/// How particles are kept evenly spread.
///
/// Where a flow strains, a lattice breaks up, and the kernel sums of a disordered neighbourhood read
/// as pressure. Taylor–Green vortices at Re 100 on 50² particles (Wendland C2, h/dx 1.5), whose speed falls
/// to 0.454 of the first within 1 s; the largest error of that speed:
///
/// | none | [`CLOSED`](Self::CLOSED), A = 20 | [`TRANSPORT`](Self::TRANSPORT), 10 ρc² |
/// |---|---|---|
/// | −77 % | −0.4 % | −3.6 % |
///
/// Densities do not follow the shifts, and drift where viscosity is too weak to keep order:
/// [`volume_consistency`](super::LiquidBuilder::volume_consistency) holds them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shifting {
    /// Against the gradient of their concentration, by A h |v| dt, at most 0.3 h²
    /// (Lind et al. 2012; Skillen et al. 2013, eq. 15). The speed is that in the frame of the scene, so
    /// a tank that moves fast is better given as an [acceleration](crate::scene::Scene::acceleration).
    Concentration {
        /// Strength A; Skillen et al. use 1 to 6, in flows that stay better ordered.
        strength: f64,
        /// Whether a free surface is left alone. In a flow without one, voids must not pass for one, or
        /// nothing closes them.
        free_surface: bool,
    },
    /// By a background pressure that moves particles and not their momentum: by
    /// −dt² p_b/m Σ (Vᵢ² + Vⱼ²) ∇W/2 in a step (Adami, Hu & Adams 2013, eq. 8). For flow without free
    /// surface.
    ///
    /// The stress by which Adami et al. make momentum follow (their eq. 13) is left out: with it the
    /// vortices gained 11 % where they lose 0.8 % without (3 ρc² at h/dx 2), and with the other sign
    /// they lost 20 %.
    TransportVelocity {
        /// Background pressure in units of ρ c².
        background: f64,
    },
}

impl Shifting {
    /// Free-surface shifting, A = 2.
    pub const STANDARD: Self = Self::Concentration {
        strength: 2.0,
        free_surface: true,
    };
    /// For flow that walls or periods enclose, A = 20.
    pub const CLOSED: Self = Self::Concentration {
        strength: 20.0,
        free_surface: false,
    };
    /// The transport velocity, 10 ρc².
    pub const TRANSPORT: Self = Self::TransportVelocity { background: 10.0 };
}
