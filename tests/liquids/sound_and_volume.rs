//! The cures of liquids that act on density alone: bulk viscosity and volume consistency against exact
//! decay, expansion memory against straight paths; each with its control.

use meshfree::boundary::{Periodic, Wall};
use meshfree::effect::{Effect, Rate, Setting, StepProgram, View};
use meshfree::kernel::WendlandC2;
use meshfree::material::{Liquid, Material, SoundSpeed};
use meshfree::particles::{Field, Fields, Output, Outputs};
use meshfree::prelude::*;
use meshfree::scalar::Real;
use meshfree::scene::Start;
use meshfree::simulation::ParticleView;

use meshfree::term::viscosity::Inviscid;
use meshfree::term::{In, parts::Unity, stage};

const SOUND: f64 = 10.0;
const DENSITY: f64 = 1000.0;

fn liquid() -> Material<f64> {
    let liquid = Liquid::new(DENSITY, 1480.0, 0.0).linear();
    liquid.material("liquid", SoundSpeed::Chosen(SOUND))
}

/// A scheme that dissipates nothing by itself.
fn plain() -> SchemeBuilder<WendlandC2, Inviscid, ExtrapolatedPressure, impl Effects<2>> {
    SchemeBuilder::liquid(WendlandC2, Inviscid).h_over_dx(1.5)
}

/// The share of a standing wave's energy that is left after `periods`; a wave is 48 particles long.
fn energy_left(scheme: impl Into<Scheme<f64, 2>>, periods: f64) -> f64 {
    let (dx, wavenumber) = (1.0 / 48.0, core::f64::consts::TAU);
    let body = Body::block("liquid", liquid(), [0.0; 2], [1.0, 8.0 * dx], dx);
    let body = body.start(|x, start| Start {
        velocity: [1e-4 * SOUND * (wavenumber * x[0]).sin(), 0.0],
        ..start
    });
    let mut simulation = Scene::new(scheme)
        .body(body)
        .boundary(Periodic::along(0, 0.0, 1.0))
        .boundary(Periodic::along(1, 0.0, 8.0 * dx))
        .build()
        .expect("a sound scene");
    simulation.keep_energy();
    // Compression is measured from the density at rest, which is that of the start.
    let stored = |now: &Simulation<f64, 2>| {
        let energy = now.energy().expect("a ledger");
        energy.kinetic + energy.compression
    };
    let first = stored(&simulation);
    simulation.run_until(periods / SOUND).expect("a stable run");
    stored(&simulation) / first
}

#[test]
fn a_bulk_viscosity_damps_sound_as_it_says() {
    // Energy decays by exp(−λ c h k² t).
    let strength = 0.3;
    let (h, wavenumber) = (1.5 / 48.0, core::f64::consts::TAU);
    let exact = (-strength * SOUND * h * wavenumber.powi(2) * 2.0 / SOUND).exp();
    let damped = energy_left(plain().with(AcousticDamping { strength }), 2.0);
    let free = energy_left(plain(), 2.0);
    assert!(
        (damped.ln() / exact.ln() - 1.0).abs() < 0.03,
        "{damped} of the energy is left, exactly {exact}"
    );
    assert!((free - 1.0).abs() < 0.01, "{free} is left without");
}

/// The greatest speed after 200 steps over the first, of a flow that changes from particle to particle.
fn growth(scheme: impl Into<Scheme<f64, 2>>) -> f64 {
    let dx = 0.05;
    let speed = 1e-4 * SOUND;
    let body = Body::block("liquid", liquid(), [0.0; 2], [1.0, 1.0], dx);
    let body = body.start(|x, start| {
        // Without a pattern: the kernel does not see every one.
        let noise = (43_758.5 * (12.9 * x[0] / dx + 78.2 * x[1] / dx).sin()).fract();
        let velocity = [noise * speed, 0.0];
        Start { velocity, ..start }
    });
    let mut simulation = Scene::new(scheme)
        .body(body)
        .boundary(Periodic::along(0, 0.0, 1.0))
        .boundary(Periodic::along(1, 0.0, 1.0))
        .build()
        .expect("a sound scene");
    for _ in 0..200 {
        if simulation.step().is_err() {
            return f64::INFINITY;
        }
    }
    let fastest = |most: f64, p: ParticleView<'_, f64, 2>| most.max(p.velocity()[0].abs());
    simulation.all().fold(0.0, fastest) / speed
}

#[test]
fn a_strong_bulk_viscosity_is_stable_because_it_shortens_the_step() {
    let strong = || plain().with(AcousticDamping { strength: 4.0 });
    let stable = growth(strong());
    assert!(stable < 1.0, "grown {stable} times");
    // The step without the share that the bulk viscosity leaves of it, 0.14 for this kernel.
    let control = growth(strong().step_factor(0.55 / 0.14));
    assert!(
        control > 100.0,
        "the control has grown only {control} times"
    );
}

/// How far densities are from what mass and space of the particles make, in units of the first, after
/// `time`: a lattice drawn 1 % too narrow.
fn drift_left(scheme: impl Into<Scheme<f64, 2>>, time: f64) -> f64 {
    let (dx, narrow) = (0.05, 0.99 * 0.05);
    let places = (0..100).map(|k| [k % 10, k / 10].map(|n| (f64::from(n) + 0.5) * narrow));
    let body = Body::points_of("liquid", liquid(), places.collect(), dx);
    let mut simulation = Scene::new(scheme)
        .body(body)
        .boundary(Periodic::along(0, 0.0, 10.0 * narrow))
        .boundary(Periodic::along(1, 0.0, 10.0 * narrow))
        .build()
        .expect("a sound scene");
    simulation.run_until(time).expect("a stable run");
    let true_density = DENSITY * (dx / narrow).powi(2);
    let departure = |p: ParticleView<'_, f64, 2>| true_density - p.density();
    simulation.all().map(departure).fold(0.0, f64::max) / (true_density - DENSITY)
}

#[test]
fn volume_consistency_brings_densities_back_to_the_space_of_particles() {
    // dρ/dt = κ (c/h) (ρ_true − ρ) while particles stay on their lattice.
    let (strength, time) = (0.05, 0.15);
    let exact = (-strength * SOUND / (1.5 * 0.05) * time).exp();
    let held = drift_left(plain().with(VolumeConsistency { strength }), time);
    let free = drift_left(plain(), time);
    // The lattice sum at this h over the narrow spacing is 2 % of the departure below the one at rest.
    assert!((held - exact).abs() < 0.02, "{held}, exactly {exact}");
    assert!((free - 1.0).abs() < 1e-9, "{free} without");
    let both = plain().with(VolumeConsistency { strength: 0.0 });
    assert!((drift_left(both, time) - 1.0).abs() < 1e-9);
}

#[test]
fn strengths_that_are_no_numbers_are_refused() {
    for (scheme, name) in [
        (
            plain()
                .with(AcousticDamping { strength: f64::NAN })
                .compose::<f64, 2>(),
            "acoustic damping",
        ),
        (
            plain().with(AcousticDamping { strength: -0.1 }).compose(),
            "acoustic damping",
        ),
        (
            plain()
                .with(VolumeConsistency {
                    strength: f64::INFINITY,
                })
                .compose(),
            "volume consistency",
        ),
    ] {
        let body = Body::block("liquid", liquid(), [0.0; 2], [0.5, 0.5], 0.05);
        let error = Scene::new(scheme)
            .body(body)
            .build()
            .unwrap_err()
            .to_string();
        assert!(error.contains(name), "{error}");
    }
}

#[test]
fn volume_consistency_wants_one_smoothing_length() {
    for scheme in [
        plain()
            .with(VolumeConsistency { strength: 0.05 })
            .with(MixedSpacing)
            .compose(),
        plain()
            .with(VolumeConsistency { strength: 0.05 })
            .with(DivergenceSmoothing {
                smallest: 0.5,
                largest: 2.0,
            })
            .compose(),
    ] {
        let body = Body::block("liquid", liquid(), [0.0; 2], [0.5, 0.5], 0.05);
        let built = Scene::<f64, 2>::new(scheme).body(body).build();
        let error = built.unwrap_err().to_string();
        assert!(error.contains("one smoothing length"), "{error}");
    }
}

#[test]
fn volume_consistency_wants_one_density_at_rest() {
    let scheme = plain().with(VolumeConsistency { strength: 0.05 }).compose();
    let light = Liquid::new(0.5 * DENSITY, 1480.0, 0.0).linear();
    let light = light.material("light", SoundSpeed::Chosen(SOUND));
    let scene = Scene::<f64, 2>::new(scheme)
        .body(Body::block("heavy", liquid(), [0.0; 2], [0.5, 0.5], 0.05))
        .body(Body::block("light", light, [0.5, 0.0], [1.0, 0.5], 0.05));
    let error = scene.build().unwrap_err().to_string();
    let named = ["`heavy`", "`light`", "density at rest"];
    assert!(named.iter().all(|name| error.contains(name)), "{error}");
}

/// The law with volumes at hand in place of masses, as the crate had it before.
#[derive(Clone, Copy, Debug)]
struct ByVolumes;

impl<const D: usize> Effect<D> for ByVolumes {
    type Terms = (In<stage::Continuity, Unity>,);
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(Unity),)
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        let unity = program.setting().lattice_unity;
        program.contribute(Field::DENSITY, Volumes { unity });
    }
}

/// κ (c/h) (Σ V W/u₀ − 1), κ = 0.05.
#[derive(Clone, Copy, Debug)]
struct Volumes {
    unity: f64,
}

impl<T: Real, const D: usize> Rate<T, D> for Volumes {
    fn reads(&self) -> Fields {
        Fields::NONE
    }
    fn sums(&self) -> Outputs {
        Outputs::of(&[Output::UNITY])
    }
    fn growth(&self, at: &View<'_, T, D>, first: usize, _present: &[T], growth: &mut [T]) {
        let sums = at.sum(Output::UNITY);
        let factor = T::from_f64(0.05 * SOUND / at.around.smoothing_length);
        for (n, growth) in growth.iter_mut().enumerate() {
            let unity = sums.get(0, first + n) / T::from_f64(self.unity);
            *growth += factor * (unity - T::one());
        }
    }
    fn source(&self, _at: &View<'_, T, D>, _first: usize, _source: &mut [T]) {}
}

/// Share of the water between walls, at rest and without pressure, that has left by an open end.
fn driven_out(scheme: impl Into<Scheme<f64, 2>>) -> f64 {
    let (dx, size) = (0.025, [1.0, 0.5]);
    let water = liquid().with_pressure_cut_off(0.0);
    let water = Body::block("water", water, [0.0; 2], size, dx);
    let sides = [[true, false], [true; 2]];
    let wall = Wall::around("wall", [0.0; 2], [2.0 * size[0], size[1]], dx, 3, sides);
    let mut own = Scene::new(scheme)
        .body(water)
        .wall(wall)
        .build()
        .expect("a scene");
    // Twenty crossings of sound.
    own.run_until(20.0 * size[0] / SOUND).expect("a stable run");
    let out = own
        .all()
        .map(|p| ((p.position()[0] - size[0]) / dx + 0.5).clamp(0.0, 1.0));
    out.sum::<f64>() * dx * dx / (size[0] * size[1])
}

#[test]
fn volume_consistency_leaves_water_with_an_open_end_where_it_is() {
    let own = driven_out(plain().with(VolumeConsistency { strength: 0.05 }));
    let volumes = driven_out(plain().with(ByVolumes));
    println!("driven out by masses {own:e}, by volumes {volumes}");
    assert!(own < 1e-6, "{own} of the water is driven out");
    assert!(volumes > 0.01, "by volumes only {volumes}");
}

/// How much wider than at first a square of liquid is that was stretched to twice its width, and whose velocities
/// were then turned round, at the time at which free particles are back where they were.
fn width_after_tearing(scheme: impl Into<Scheme<f64, 2>>) -> f64 {
    let (dx, rate, time) = (0.05, 2.0, 0.5);
    let wide = Body::block(
        "liquid",
        liquid().with_pressure_cut_off(0.0),
        [-0.5; 2],
        [0.5; 2],
        dx,
    );
    let wide = wide.start(|x, start| Start {
        velocity: x.map(|x| rate * x),
        ..start
    });
    let mut simulation = Scene::new(scheme)
        .body(wide)
        .build()
        .expect("a sound scene");
    let width = |now: &Simulation<f64, 2>| {
        let r2: f64 = now
            .all()
            .map(|p| p.position().map(|x| x * x).iter().sum::<f64>())
            .sum();
        (r2 / now.particles() as f64).sqrt()
    };
    let first = width(&simulation);
    simulation.run_until(time).expect("a run");
    let stretched = width(&simulation) / first;
    assert!(
        (stretched - 2.0).abs() < 0.01,
        "cavitated water flies freely: {stretched}"
    );
    simulation.set_velocities(|_, v| v.map(|v| -v));
    simulation.run_until(2.0 * time).expect("a run");
    width(&simulation) / first - 1.0
}

#[test]
fn liquid_closes_where_it_tore() {
    let wider = width_after_tearing(plain().with(ExpansionMemory));
    assert!(wider.abs() < 0.02, "{wider}");
    // The control forgets how far it was stretched, and has pressure long before it has closed.
    let forgetful = width_after_tearing(plain());
    assert!(forgetful > 0.1, "{forgetful}");
}

#[test]
fn expansion_memory_that_cannot_be_is_refused() {
    let body = |material| Body::block("liquid", material, [0.0; 2], [1.0; 2], 0.1);
    let scheme = || plain().with(ExpansionMemory);
    let solid = Scene::<f64, 2>::new(scheme()).body(body(liquid()));
    assert!(solid.problems()[0].to_string().contains("can cavitate"));
    let wide = body(liquid().with_pressure_cut_off(0.0));
    let combined = Scene::<f64, 2>::new(scheme())
        .body(wide)
        .integrator(meshfree::integrator::RungeKutta4);
    let problems: Vec<String> = combined
        .problems()
        .iter()
        .map(ToString::to_string)
        .collect();
    assert!(
        problems.iter().any(|own| own.contains("does not hold")),
        "{problems:?}"
    );
}
