//! A case: a striker, perhaps with a pad on its head, that hits a rod or a wall.
//! Geometry, materials and numerical choices; its scene and its exact solutions follow from it.

use super::choices::{ContactChoice, IntegratorChoice, SchemeChoice, StateChoice, StrengthChoice};
use meshfree::boundary::MirrorPlane;
use meshfree::effect::{Effects, Hypoelastic, MixedSpacing, NoWalls, Plasticity, UniaxialStress};
use meshfree::error::{Error, Result};
use meshfree::kernel::{CubicSpline, KernelKind};
use meshfree::material::{Material, catalogue};
use meshfree::scene::{Body, Scene};
use meshfree::scheme::{EnergyForm, Scheme, SchemeBuilder};
use meshfree::schemes;
use meshfree::simulation::Simulation;
use meshfree::sweep::Interaction;
use meshfree::term::ArtificialViscosity;
use meshfree::term::viscosity::ViscosityKind;

/// A case, in SI units. `None` leaves a choice to the scheme.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    pub striker: String,
    /// The target's material; `None` is a rigid wall.
    pub target: Option<String>,
    /// Material and length of the pad.
    pub pad: Option<(String, f64)>,
    pub speed: f64,
    pub striker_length: f64,
    pub target_length: f64,
    pub state: StateChoice,
    /// Whether rods yield; `None` is as their state has it.
    pub strength: Option<StrengthChoice>,
    pub spacing: f64,
    pub scheme: SchemeChoice,
    pub kernel: Option<KernelKind>,
    pub h_over_dx: Option<f64>,
    pub integrator: Option<IntegratorChoice>,
    pub viscosity: Option<ViscosityKind>,
    pub contact: Option<ContactChoice>,
    pub until: f64,
    pub probes: Vec<f64>,
    pub snapshots: Vec<f64>,
}

impl Default for Case {
    /// Case 1 of the paper with the copper target.
    fn default() -> Self {
        Self {
            striker: "copper".into(),
            target: Some("copper".into()),
            pad: None,
            speed: 20.0,
            striker_length: 0.010,
            target_length: 0.040,
            state: StateChoice::Hydrodynamic,
            strength: None,
            spacing: 5e-5,
            scheme: SchemeChoice::Impact,
            kernel: None,
            h_over_dx: None,
            integrator: None,
            viscosity: None,
            contact: None,
            until: 12.7e-6,
            probes: Vec::new(),
            snapshots: Vec::new(),
        }
    }
}

/// A rod of a case: striker, pad or target.
#[derive(Clone, Debug, PartialEq)]
pub struct Rod {
    pub name: &'static str,
    pub material: String,
    pub from: f64,
    pub to: f64,
    pub speed: f64,
}

impl Rod {
    pub fn length(&self) -> f64 {
        self.to - self.from
    }
    /// Particles along the rod.
    pub fn count(&self, spacing: f64) -> f64 {
        (self.length() / spacing).round()
    }
}

/// A catalogue material, or the crate's error for a name that it does not know.
pub fn material(name: &str) -> Result<Material<f64>> {
    catalogue::by_name(name).map_err(|unknown| {
        Error::Argument(meshfree::error::Problem::UnknownName {
            kind: "material",
            name: unknown.given,
            known: catalogue::NAMES.join(", "),
        })
    })
}

/// A material with a shear modulus, that of a relative in the catalogue where it has none: the paper states none.
pub fn with_shear(material: Material<f64>) -> Material<f64> {
    let relative: Material<f64> = match material.name.as_str() {
        "copper" => catalogue::ofhc_copper(),
        "steel" => catalogue::steel_4340(),
        "aluminium" => catalogue::aluminium_6061_t6(),
        "pmma" => catalogue::tank_pmma(),
        _ => return material,
    };
    match (material.shear_modulus, relative.shear_modulus) {
        (None, Some(modulus)) => material.with_shear_modulus(modulus),
        _ => material,
    }
}

impl Case {
    /// Whether rods support more than pressure.
    pub fn bears_shear(&self) -> bool {
        self.state != StateChoice::Hydrodynamic
    }
    /// Whether rods yield.
    pub fn strength(&self) -> StrengthChoice {
        let own = if self.bears_shear() {
            StrengthChoice::On
        } else {
            StrengthChoice::Off
        };
        self.strength.unwrap_or(own)
    }

    /// The rods from left to right.
    pub fn rods(&self) -> Vec<Rod> {
        let mut rods = Vec::new();
        let mut end = 0.0;
        let mut add = |name, material: &str, length: f64, speed| {
            rods.push(Rod {
                name,
                material: material.into(),
                from: end,
                to: end + length,
                speed,
            });
            end += length;
        };
        add("striker", &self.striker, self.striker_length, self.speed);
        if let Some((pad, length)) = &self.pad {
            add("pad", pad, *length, self.speed);
        }
        if let Some(target) = &self.target {
            add("target", target, self.target_length, 0.0);
        }
        rods
    }

    /// Where the striker, or its pad, meets the target \[m\].
    pub fn contact_place(&self) -> f64 {
        self.striker_length + self.pad.as_ref().map_or(0.0, |(_, length)| *length)
    }

    /// Index of the rod that meets the target.
    pub fn head(&self) -> usize {
        usize::from(self.pad.is_some())
    }

    /// Length of the whole chain \[m\].
    pub fn length(&self) -> f64 {
        self.rods().last().map_or(0.0, |rod| rod.to)
    }

    pub fn contact(&self) -> ContactChoice {
        self.contact.unwrap_or(self.scheme.contact())
    }
    pub fn integrator(&self) -> IntegratorChoice {
        self.integrator.unwrap_or(self.scheme.integrator())
    }

    /// What it is, in a line.
    pub fn title(&self) -> String {
        let mm = |x: f64| short(1e3 * x);
        let pad = self
            .pad
            .as_ref()
            .map_or_else(String::new, |(material, length)| {
                format!(" with {} mm of {material} on its head", mm(*length))
            });
        let target = match &self.target {
            Some(material) => format!("{} mm of {material}", mm(self.target_length)),
            None => "a rigid wall".into(),
        };
        format!(
            "{} mm of {}{pad} onto {target} at {} m/s",
            mm(self.striker_length),
            self.striker,
            short(self.speed)
        )
    }

    /// The scene as a simulation.
    pub fn build(&self) -> Result<Simulation<f64, 1>> {
        let mut scene = Scene::new(self.scheme()).boxed_integrator(self.integrator().make());
        for rod in self.rods() {
            let mut material = material(&rod.material)?;
            if self.bears_shear() {
                material = with_shear(material);
            }
            let body = Body::block(rod.name, material, [rod.from], [rod.to], self.spacing);
            scene = scene.body(body.velocity([rod.speed]));
        }
        if self.pad.is_some() {
            scene = scene.between("striker", "pad", Interaction::Bonded);
        }
        let place = [self.contact_place()];
        if self.target.is_none() {
            scene = scene.boundary(match self.contact() {
                ContactChoice::Unilateral => MirrorPlane::wall(place, [1.0]),
                ContactChoice::Bonded => MirrorPlane::symmetry(place, [1.0]),
            });
        } else {
            let head = if self.pad.is_some() { "pad" } else { "striker" };
            scene = scene.between(head, "target", self.contact().interaction());
            if self.pad.is_some() {
                // A short pad lets the kernel look through: striker and target still only touch.
                scene = scene.between("striker", "target", self.contact().interaction());
            }
        }
        scene.build()
    }

    /// The scheme with all choices made.
    pub fn scheme(&self) -> Scheme<f64, 1> {
        if self.is_ready() {
            return self.ready_scheme();
        }
        if self.bears_shear() {
            let mut builder = schemes::impact_by_continuity();
            if let Some(ratio) = self.h_over_dx {
                builder = builder.h_over_dx(ratio);
            }
            let bar = self.state == StateChoice::UniaxialStress;
            let yields = self.strength() == StrengthChoice::On;
            return builder
                .with(MixedSpacing)
                .with(Hypoelastic)
                .with(bar.then_some(UniaxialStress))
                .with(yields.then_some(Plasticity))
                .compose();
        }
        match self.scheme {
            SchemeChoice::Impact => self.with_choices(schemes::impact()),
            SchemeChoice::Continuity => self.with_choices(schemes::impact_by_continuity()),
            SchemeChoice::Lam2002 => self.with_choices(schemes::lam2002()),
        }
    }

    /// The scheme of a case that [`Self::is_ready`].
    fn ready_scheme(&self) -> Scheme<f64, 1> {
        match self.scheme {
            SchemeChoice::Impact => self.adjusted(schemes::impact()).compose(),
            SchemeChoice::Continuity => self.adjusted(schemes::impact_by_continuity()).compose(),
            SchemeChoice::Lam2002 => self.adjusted(schemes::lam2002()).compose(),
        }
    }

    /// Whether the case has a ready scheme with its own kernel and viscosity, without shear, and one spacing.
    fn is_ready(&self) -> bool {
        let own_kernel = self
            .kernel
            .is_none_or(|kernel| kernel == KernelKind::CubicSpline);
        own_kernel && self.viscosity.is_none() && !self.bears_shear() && self.has_one_spacing()
    }

    fn adjusted<V, E>(&self, mut builder: SolidBuilder<V, E>) -> SolidBuilder<V, E> {
        if let Some(ratio) = self.h_over_dx {
            builder = builder.h_over_dx(ratio);
        }
        if !self.integrator().make().kicks() {
            builder = builder.energy(EnergyForm::Symmetric);
        }
        builder
    }

    /// Loops for choices at run time: slower, and compiled once for all choices.
    fn with_choices<V, E>(&self, builder: SolidBuilder<V, E>) -> Scheme<f64, 1>
    where
        V: ArtificialViscosity<1> + Into<ViscosityKind>,
        E: Effects<1>,
    {
        let builder = self.adjusted(builder);
        let viscosity = self
            .viscosity
            .unwrap_or_else(|| builder.viscosity().clone().into());
        builder
            .with_kernel(self.kernel.unwrap_or(KernelKind::CubicSpline))
            .with_viscosity(viscosity)
            .with(MixedSpacing)
            .compose()
    }

    /// Whether the spacing divides all rods alike.
    fn has_one_spacing(&self) -> bool {
        let actual = |rod: &Rod| rod.length() / rod.count(self.spacing).max(1.0);
        let rods = self.rods();
        let first = rods.first().map_or(self.spacing, actual);
        rods.iter()
            .all(|rod| (actual(rod) - first).abs() <= 1e-9 * first)
    }
}

/// A scheme of solids with the cubic spline.
type SolidBuilder<V, E> = SchemeBuilder<CubicSpline, V, NoWalls, E>;

/// A number without needless digits: 5, 7.5, 0.025.
pub fn short(value: f64) -> String {
    // Twelve digits hide that 0.0075 m is not quite 7.5 mm.
    let text = format!("{value:.9}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text.is_empty() || text == "-0" {
        "0".into()
    } else {
        text.into()
    }
}
