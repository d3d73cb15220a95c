//! Solids and gases: impact schemes, density and energy forms, integrators, artificial viscosities, kernels,
//! laws of materials, contacts, and boundaries that make images.

use super::{Scenes, noise};
use meshfree::integrator::Predictor;
use meshfree::kernel::KernelKind;
use meshfree::material::eos::{
    IdealGas, Jwl, Linear, MieGruneisen, Murnaghan, Polynomial, StiffenedGas, Tait, TensionCutOff,
    Tillotson,
};
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::term::viscosity::{
    Balsara, CullenDehnen, Inviscid, LamPrinted, LimitedMonaghanGingold, MonaghanGingold,
    MorrisMonaghan, Riemann, SignalVelocity, ViscosityKind,
};

pub fn add(scenes: &mut Scenes) {
    ready(scenes);
    forms(scenes);
    integrators(scenes);
    viscosities(scenes);
    smoothing(scenes);
    images(scenes);
    contacts(scenes);
    materials(scenes);
}

/// A copper rod strikes one of aluminium.
fn rods<T: Real>(scheme: impl Into<Scheme<T, 1>>) -> Scene<T, 1> {
    let striker = Body::block("striker", catalogue::copper(), [0.0], [0.01], 2e-4);
    let target = Body::block("target", catalogue::aluminium(), [0.01], [0.03], 2e-4);
    Scene::new(scheme)
        .body(striker.velocity([60.0]))
        .body(target)
}

/// Two blocks of `side` particles in a row that run into each other off the middle.
fn blocks<T: Real, const D: usize>(scheme: impl Into<Scheme<T, D>>, side: usize) -> Scene<T, D> {
    let dx = 1e-3;
    let size = side as f64 * dx;
    let block = |name: &str, material, low: [f64; D]| {
        let high = low.map(|x| x + size);
        Body::block(name, material, low, high, dx).start(|x, start| {
            let mut velocity = noise(x.map(|x| x / size)).map(|v| 5.0 * v);
            velocity[0] -= 40.0 * low[0].signum();
            Start { velocity, ..start }
        })
    };
    let mut left = [0.0; D];
    left[0] = -size;
    let mut right = [2.0 * dx; D];
    right[0] = 1e-9 * dx;
    Scene::new(scheme)
        .body(block("left", catalogue::copper(), left))
        .body(block("right", catalogue::aluminium(), right))
}

/// A gas in a periodic box, with a flow and an energy that change from place to place.
fn gas<T: Real, const D: usize>(scheme: impl Into<Scheme<T, D>>, side: usize) -> Scene<T, D> {
    let gas = Material::new("gas", IdealGas::new(1.4, 1.0));
    let size = side as f64;
    let body = Body::block("gas", gas, [0.0; D], [size; D], 1.0).start(|x, start| {
        let own = noise(x.map(|x| x / size));
        Start {
            velocity: own.map(|v| 0.4 * v),
            energy: 2.5 + 0.5 * own[D - 1],
            ..start
        }
    });
    let periods = |scene: Scene<T, D>, axis| scene.boundary(Periodic::along(axis, 0.0, size));
    (0..D).fold(Scene::new(scheme).body(body), periods)
}

fn ready(scenes: &mut Scenes) {
    let wall = || MirrorPlane::wall([0.03], [1.0]);
    scenes.add("impact-1d-f64", 60, move || {
        rods::<f64>(schemes::impact()).boundary(wall())
    });
    scenes.add("impact-1d-f32", 60, move || {
        rods::<f32>(schemes::impact()).boundary(wall())
    });
    scenes.add("impact-2d-f64", 30, || {
        blocks::<f64, 2>(schemes::impact(), 18)
    });
    scenes.add("impact-2d-f32", 30, || {
        blocks::<f32, 2>(schemes::impact(), 18)
    });
    scenes.add("impact-3d-f64", 12, || {
        blocks::<f64, 3>(schemes::impact(), 8)
    });
    scenes.add("impact-3d-f32", 12, || {
        blocks::<f32, 3>(schemes::impact(), 8)
    });
    let continuity = schemes::impact_by_continuity;
    scenes.add("impact-by-continuity-1d-f64", 60, move || {
        rods::<f64>(continuity())
    });
    scenes.add("impact-by-continuity-2d-f32", 30, move || {
        blocks::<f32, 2>(continuity(), 12)
    });
    scenes.add("impact-by-continuity-3d-f64", 12, move || {
        blocks::<f64, 3>(continuity(), 6)
    });
    scenes.add("impact-without-curvature", 40, || {
        rods::<f64>(schemes::impact().without_midpoint_reconstruction())
    });
    for (name, predictor) in [
        ("lam2002-fresh", Predictor::Fresh),
        ("lam2002-lagged", Predictor::Lagged),
    ] {
        let bonded =
            || rods::<f64>(schemes::lam2002()).between("striker", "target", Interaction::Bonded);
        scenes.add(name, 40, move || {
            bonded().integrator(LamLeapfrog { predictor })
        });
    }
    scenes.add("lam2002-f32", 40, || {
        rods::<f32>(schemes::lam2002()).between("striker", "target", Interaction::Bonded)
    });
}

/// A gas in a plane. One program serves all choices, so that they take little to compile.
fn sheet_of_gas(density: DensityForm, energy: EnergyForm, smoothing: Smoothing) -> Scene<f64, 2> {
    let scheme = plain().with(smoothing);
    gas(scheme.density(density).energy(energy), 16)
}

/// The builder of scenes in one dimension that choose.
fn plain() -> SchemeBuilder<CubicSpline, MonaghanGingold> {
    SchemeBuilder::new(CubicSpline, MonaghanGingold::STANDARD)
}

fn forms(scenes: &mut Scenes) {
    for form in DensityForm::ALL {
        let bonded = move |scheme: SchemeBuilder<_, _>| {
            rods::<f64>(scheme.density(form)).between("striker", "target", Interaction::Bonded)
        };
        scenes.add(format!("density-{}", form.name()), 40, move || {
            bonded(plain())
        });
        scenes.add(format!("gas-of-density-{}", form.name()), 20, move || {
            sheet_of_gas(form, EnergyForm::Compatible, Smoothing::Fixed)
        });
    }
    for (name, form) in [
        ("none", EnergyForm::None),
        ("symmetric", EnergyForm::Symmetric),
        ("compatible", EnergyForm::Compatible),
    ] {
        scenes.add(format!("energy-{name}"), 40, move || {
            rods::<f64>(plain().density(DensityForm::Continuity).energy(form))
        });
    }
    scenes.add("mismatched-pressure-form", 40, || {
        let scheme = plain()
            .density(DensityForm::Continuity)
            .mismatched_pressure_form(DensityForm::ContinuityByMass);
        rods::<f64>(scheme)
    });
    scenes.add("without-normalisation", 40, || {
        rods::<f64>(
            plain()
                .density(DensityForm::Continuity)
                .without_consistency_factor(),
        )
    });
}

fn integrators(scenes: &mut Scenes) {
    type Make = fn() -> Box<dyn Integrator>;
    let all: [(&str, bool, Make); 7] = [
        ("kick-drift-kick", true, || Box::new(KickDriftKick)),
        ("drift-kick-drift", true, || Box::new(DriftKickDrift)),
        ("position-verlet", true, || Box::new(PositionVerlet)),
        ("midpoint", true, || Box::new(Midpoint)),
        ("ssp-rk3", true, || Box::new(StrongStabilityPreserving3)),
        ("rk4", true, || Box::new(RungeKutta4)),
        ("lam-leapfrog", false, || Box::new(LamLeapfrog::default())),
    ];
    for (name, integrates_density, make) in all {
        let symmetric = EnergyForm::Symmetric;
        let integrated = move || plain().energy(symmetric).density(DensityForm::Continuity);
        scenes.add(format!("{name}-summation"), 25, move || {
            let gas = sheet_of_gas(DensityForm::Summation, symmetric, Smoothing::Fixed);
            gas.boxed_integrator(make())
        });
        if integrates_density {
            scenes.add(format!("{name}-continuity-f64"), 40, move || {
                rods::<f64>(integrated()).boxed_integrator(make())
            });
            scenes.add(format!("{name}-continuity-f32"), 40, move || {
                rods::<f32>(integrated()).boxed_integrator(make())
            });
        }
    }
    for (name, _, make) in &all[1..3] {
        let make = *make;
        scenes.add(format!("{name}-compatible"), 40, move || {
            rods::<f64>(plain().density(DensityForm::NumberDensity)).boxed_integrator(make())
        });
    }
}

fn viscosities(scenes: &mut Scenes) {
    for &law in ViscosityKind::ALL {
        scenes.add(format!("viscosity-kind-{}", law.key()), 20, move || {
            gas::<f64, 2>(SchemeBuilder::new(CubicSpline, law), 16)
        });
    }
    macro_rules! composed {
        ($($Law:ident $name:literal),*) => {$(
            scenes.add(concat!("viscosity-", $name), 40, || {
                let scheme = SchemeBuilder::new(CubicSpline, $Law::STANDARD);
                rods::<f64>(scheme.density(DensityForm::NumberDensity))
            });
        )*};
    }
    meshfree::for_each_viscosity!(composed);
    scenes.add("viscosity-as-printed-by-lam", 20, || {
        let printed = LamPrinted {
            alpha: 1.0,
            beta: 2.0,
        };
        rods::<f64>(SchemeBuilder::new(CubicSpline, printed).density(DensityForm::NumberDensity))
    });
    for &kernel in KernelKind::ALL {
        scenes.add(format!("kernel-{}", kernel.key()), 30, move || {
            rods::<f64>(
                SchemeBuilder::new(kernel, MonaghanGingold::STANDARD)
                    .density(DensityForm::NumberDensity),
            )
        });
    }
}

fn smoothing(scenes: &mut Scenes) {
    for (name, law) in [
        ("fixed", Smoothing::Fixed),
        (
            "divergence",
            Smoothing::Divergence(DivergenceSmoothing {
                smallest: 0.98,
                largest: 1.05,
            }),
        ),
        (
            "consistent",
            Smoothing::Consistent(ConsistentSmoothing {
                smallest: 0.5,
                largest: 2.0,
            }),
        ),
    ] {
        let scheme = move || plain().with(law);
        scenes.add(format!("smoothing-{name}-2d"), 20, move || {
            sheet_of_gas(DensityForm::Summation, EnergyForm::Compatible, law)
        });
        // Sums up to a free surface suit gases alone.
        if name != "consistent" {
            scenes.add(format!("smoothing-{name}-1d-f64"), 40, move || {
                rods::<f64>(scheme()).between("striker", "target", Interaction::Bonded)
            });
            scenes.add(format!("smoothing-{name}-1d-f32"), 40, move || {
                rods::<f32>(scheme()).between("striker", "target", Interaction::Bonded)
            });
            scenes.add(format!("smoothing-{name}-by-continuity"), 40, move || {
                rods::<f64>(scheme().density(DensityForm::Continuity))
            });
        }
    }
    scenes.add("mixed-spacing-1d", 40, || {
        let coarse = Body::block("coarse", catalogue::copper(), [0.0], [0.01], 2e-4);
        let fine = Body::block("fine", catalogue::pmma(), [0.01], [0.02], 1e-4);
        Scene::<f64, 1>::new(schemes::impact().with(MixedSpacing))
            .body(coarse.velocity([30.0]))
            .body(fine)
    });
}

/// Boundaries that make images, loads, and how steps are chosen.
fn images(scenes: &mut Scenes) {
    fn sheet<T: Real>() -> Scene<T, 2> {
        let body = Body::block("sheet", catalogue::copper(), [0.0; 2], [0.02, 0.016], 1e-3);
        let body = body.start(|x, start| Start {
            velocity: noise(x.map(|x| 50.0 * x)).map(|v| 20.0 * v),
            ..start
        });
        Scene::new(schemes::impact()).body(body)
    }
    scenes.add("mirror-wall-at-rest", 25, || {
        sheet::<f64>()
            .boundary(MirrorPlane::wall([0.0, 0.0], [-1.0, 0.0]))
            .boundary(MirrorPlane::wall([0.0, 0.0], [0.0, -1.0]))
    });
    scenes.add("mirror-wall-moving", 25, || {
        sheet::<f64>().boundary(MirrorPlane::wall([0.0, 0.0], [-1.0, 0.0]).moving(-30.0))
    });
    scenes.add("mirror-wall-moving-1d", 40, || {
        rods::<f64>(schemes::impact()).boundary(MirrorPlane::wall([0.0], [-1.0]).moving(-80.0))
    });
    scenes.add("symmetry-plane", 25, || {
        sheet::<f64>()
            .boundary(MirrorPlane::symmetry([0.0, 0.0], [0.0, -1.0]))
            .boundary(MirrorPlane::symmetry([0.0, 0.016], [0.0, 1.0]))
    });
    scenes.add("symmetry-plane-f32", 25, || {
        sheet::<f32>().boundary(MirrorPlane::symmetry([0.02, 0.0], [1.0, 0.0]))
    });
    scenes.add("periodic-with-mirror", 25, || {
        sheet::<f64>()
            .boundary(Periodic::along(0, 0.0, 0.02))
            .boundary(MirrorPlane::wall([0.0, 0.0], [0.0, -1.0]))
    });
    scenes.add("periodic-1d", 40, || gas::<f64, 1>(schemes::impact(), 60));
    scenes.add("periodic-3d", 12, || gas::<f64, 3>(schemes::impact(), 8));
    scenes.add("periodic-that-particles-cross", 40, || {
        let dx = 1e-3;
        let body = Body::block("block", catalogue::copper(), [0.0; 2], [0.016; 2], dx);
        Scene::<f64, 2>::new(schemes::impact())
            .body(body.velocity([400.0, -250.0]))
            .boundary(Periodic::along(0, 0.0, 0.016))
            .boundary(Periodic::along(1, 0.0, 0.016))
    });
    scenes.add("load-in-time", 25, || {
        sheet::<f64>()
            .acceleration(|t| [1e7 * (1.0 - 1e6 * t), -2e7])
            .acceleration(|t| [0.0, 5e13 * t])
    });
    scenes.add("fixed-step-and-skin", 25, || {
        sheet::<f64>().skin(0.3).steps(|control| StepControl {
            fixed: Some(5e-8),
            ..control
        })
    });
    scenes.add("fixed-step-of-rods", 30, || {
        rods::<f64>(schemes::impact()).steps(|control| StepControl {
            fixed: Some(1e-8),
            ..control
        })
    });
}

fn contacts(scenes: &mut Scenes) {
    for (name, interaction) in [
        ("unilateral", Interaction::Unilateral),
        ("bonded", Interaction::Bonded),
        ("none", Interaction::None),
    ] {
        scenes.add(format!("contact-{name}-1d"), 60, move || {
            rods::<f64>(schemes::impact()).between("target", "striker", interaction)
        });
        scenes.add(format!("contact-{name}-2d"), 30, move || {
            blocks::<f64, 2>(schemes::impact(), 12).between("left", "right", interaction)
        });
    }
    // Pulled apart, and across a gap.
    for (name, gap, speed) in [("opens", 0.0, -30.0), ("closes", 3e-5, 300.0)] {
        scenes.add(format!("contact-that-{name}"), 60, move || {
            let left = Body::block("left", catalogue::copper(), [-0.01 - gap], [-gap], 2e-4);
            let right = Body::block("right", catalogue::pmma(), [0.0], [0.01], 2e-4);
            Scene::<f64, 1>::new(schemes::impact())
                .body(left.velocity([speed]))
                .body(right)
        });
    }
}

/// Every equation of state, some at the limits of what they guard.
fn materials(scenes: &mut Scenes) {
    let bodies: [(Material<f64>, f64); 10] = [
        (Material::new("ideal gas", IdealGas::new(1.4, 1000.0)), 4e6),
        (Material::new("jwl", Jwl::tnt()), 4e6),
        (Material::new("linear", Linear::new(1100.0, 2000.0)), 0.0),
        (catalogue::ofhc_copper(), 1e3),
        (
            Material::new("murnaghan", Murnaghan::new(1000.0, 2.2e9, 7.15)),
            0.0,
        ),
        (
            Material::new(
                "polynomial",
                Polynomial::new(1000.0, [0.0, 2.2e9, 9.5e9, 14.6e9, 0.28, 0.28, 0.0]),
            ),
            1e3,
        ),
        (Material::new("stiffened gas", StiffenedGas::water()), 1e3),
        (Material::new("tait", Tait::new(1000.0, 1480.0)), 0.0),
        (
            Material::new(
                "cut copper",
                TensionCutOff::new(MieGruneisen::new(8930.0, 3940.0, 1.49, 2.02), -1e7),
            ),
            0.0,
        ),
        (Material::new("tillotson", Tillotson::aluminium()), 5e6),
    ];
    for (material, energy) in bodies {
        let name = format!("law-{}", material.name.replace(' ', "-"));
        scenes.add(name, 40, move || {
            let body = Body::block("rod", material.clone(), [0.0], [0.01], 1e-4);
            let body = body.start(|x, start| Start {
                // One half is compressed, the other drawn apart.
                velocity: [6e6 * (x[0] - 0.005).powi(2)],
                energy: energy * (1.0 + 10.0 * x[0]),
                ..start
            });
            Scene::<f64, 1>::new(schemes::impact()).body(body)
        });
    }
}
