//! Liquids: ready schemes, viscosities, diffusion, shifting, and all options, in tanks and periodic boxes.
//! Walls of particles move, stick and slide; probes and gauges are read after every step.

use super::{Plan, Scenes, noise};
use meshfree::material::rheology::{CarreauYasuda, Cross, HerschelBulkley, PowerLaw};
use meshfree::material::{Liquid, SoundSpeed};
use meshfree::observe::{PressureProbe, WaveGauge};
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::term::viscosity::{Inviscid, MonaghanGingold};
use meshfree::term::{Antuono, CentralViscosity, Fourtakas, LaminarViscosity, Molteni};

const DX: f64 = 0.01;
const G: f64 = 9.81;

pub fn add(scenes: &mut Scenes) {
    ready(scenes);
    options(scenes);
    viscous(scenes);
    walls(scenes);
    cavitating(scenes);
}

fn water<T: Real>() -> Material<T> {
    catalogue::weakly_compressible_water(2.0)
}

/// Water in the corner of an open tank, on its way to the other side.
fn dam_in<T: Real>(
    scheme: impl Into<Scheme<T, 2>>,
    water: Material<T>,
    change: impl Fn(Wall<2>) -> Wall<2>,
) -> Scene<T, 2> {
    let (size, high) = ([20.0 * DX, 15.0 * DX], [28.0 * DX, 22.0 * DX]);
    let faces = [[true; 2], [true, false]];
    let tank = Wall::around("tank", [0.0; 2], high, DX, 4, faces);
    let body =
        Body::block("water", water, [0.0; 2], size, DX).hydrostatic([0.0, -G], [0.0, size[1]]);
    let body = body.start(|x, start| {
        let own = noise(x.map(|x| 4.0 * x));
        Start {
            velocity: [1.0 + 0.3 * own[0], 0.3 * own[1]],
            ..start
        }
    });
    Scene::new(scheme)
        .body(body)
        .wall(change(tank))
        .acceleration(|_| [0.0, -G])
}

fn dam<T: Real>(scheme: impl Into<Scheme<T, 2>>) -> Scene<T, 2> {
    dam_in(scheme, water(), |tank| tank)
}

/// A swirl in a periodic box without walls.
fn swirl<T: Real>(scheme: impl Into<Scheme<T, 2>>) -> Scene<T, 2> {
    let size = 18.0 * DX;
    let body = Body::block("water", water(), [0.0; 2], [size; 2], DX).start(|x, start| Start {
        velocity: noise(x.map(|x| x / size)),
        ..start
    });
    Scene::new(scheme)
        .body(body)
        .boundary(Periodic::along(0, 0.0, size))
        .boundary(Periodic::along(1, 0.0, size))
}

/// A drop in space on a floor, between periods.
fn drop_in_space<T: Real>(scheme: impl Into<Scheme<T, 3>>) -> Scene<T, 3> {
    let side = 8.0 * DX;
    let body = Body::block("water", water(), [0.0; 3], [side, side, 6.0 * DX], DX);
    let body = body.start(|x, start| {
        let own = noise(x.map(|x| x / side)).map(|v| 0.2 * v);
        Start {
            velocity: [own[0], own[1], own[2] - 0.5],
            ..start
        }
    });
    let faces = [[false; 2], [false; 2], [true, false]];
    Scene::new(scheme)
        .body(body)
        .wall(Wall::around("floor", [0.0; 3], [side; 3], DX, 4, faces))
        .boundary(Periodic::along(0, 0.0, side))
        .boundary(Periodic::along(1, 0.0, side))
        .acceleration(|_| [0.0, 0.0, -G])
}

/// A column of water in one dimension on a wall of particles.
fn column<T: Real>(scheme: impl Into<Scheme<T, 1>>) -> Scene<T, 1> {
    let body = Body::block("water", water(), [0.0], [0.5], DX).hydrostatic([-G], [0.5]);
    let floor = Wall::around("floor", [0.0], [0.6], DX, 4, [[true, false]]);
    Scene::new(scheme)
        .body(body.velocity([-0.5]))
        .wall(floor)
        .acceleration(|_| [-G])
}

/// What probes and gauges of a tank in a plane read.
fn probes<T: Real>(now: &Simulation<T, 2>) -> Vec<f64> {
    let wall = |place, normal| {
        let probe = PressureProbe::disc(now, "probe", place, normal, 3.0 * DX);
        probe.and_then(|probe| probe.on_wall(0)).expect("a probe")
    };
    let probes = [
        wall([0.0, 5.0 * DX], [1.0, 0.0]),
        wall([10.0 * DX, 0.0], [0.0, 1.0]),
    ];
    let gauge = WaveGauge::upwards(now, "gauge", [8.0 * DX, 0.0], 1).expect("a gauge");
    let mut read = PressureProbe::contact_pressures(&probes, now);
    read.extend(probes.iter().map(|probe| probe.pressure(now)));
    read.extend([gauge.height(now), gauge.wetted_length(now)]);
    read
}

fn ready(scenes: &mut Scenes) {
    let weak = schemes::weakly_compressible;
    scenes.add("weakly-compressible-1d-f64", 40, move || {
        column::<f64>(weak())
    });
    scenes.add("weakly-compressible-2d-f64", 40, move || dam::<f64>(weak()));
    scenes.add("weakly-compressible-2d-f32", 40, move || dam::<f32>(weak()));
    scenes.add("weakly-compressible-3d-f64", 12, move || {
        drop_in_space::<f64>(weak())
    });
    scenes.add("weakly-compressible-3d-f32", 12, move || {
        drop_in_space::<f32>(weak())
    });
    scenes.add("riemann-liquid", 40, || {
        dam::<f64>(schemes::riemann_liquid())
    });
    scenes.add("ls-dyna-default", 40, || {
        dam::<f64>(schemes::ls_dyna_default())
    });
    scenes.add("ls-dyna-fluid", 40, || dam::<f64>(schemes::ls_dyna_fluid()));
    scenes.add("ls-dyna-renormalised", 40, || {
        dam::<f64>(schemes::ls_dyna_renormalised())
    });
    scenes.add("ls-dyna-fluid-renormalised", 40, || {
        dam::<f64>(schemes::ls_dyna_fluid_renormalised())
    });
    let with_probes = Plan {
        steps: 40,
        change: |_| {},
        read: probes,
    };
    scenes.add_with("probes-and-gauges", with_probes, move || dam::<f64>(weak()));
}

/// A scheme that dissipates nothing by itself.
fn bare() -> SchemeBuilder<WendlandC2, Inviscid, ExtrapolatedPressure, impl Effects<2>> {
    SchemeBuilder::liquid(WendlandC2, Inviscid)
}

fn options(scenes: &mut Scenes) {
    let weak = schemes::weakly_compressible;
    scenes.add("no-diffusion", 30, || dam::<f64>(bare()));
    scenes.add("diffusion-molteni", 30, move || {
        dam::<f64>(weak().density_diffusion(Molteni::default()))
    });
    scenes.add("diffusion-fourtakas-strong", 30, move || {
        dam::<f64>(weak().density_diffusion(Fourtakas { delta: 0.2 }))
    });
    scenes.add("diffusion-antuono", 30, move || {
        dam::<f64>(weak().density_diffusion(Antuono::default()))
    });
    for (name, shifting) in [
        ("standard", Shifting::STANDARD),
        ("closed", Shifting::CLOSED),
        ("transport", Shifting::TRANSPORT),
    ] {
        scenes.add(format!("shifting-{name}"), 30, move || {
            swirl::<f64>(weak().with(shifting))
        });
    }
    scenes.add("shifting-at-a-free-surface", 30, move || {
        dam::<f64>(weak().with(Shifting::STANDARD))
    });
    scenes.add("acoustic-damping", 30, move || {
        dam::<f64>(weak().with(AcousticDamping { strength: 0.3 }))
    });
    scenes.add("volume-consistency", 30, move || {
        dam::<f64>(weak().with(VolumeConsistency { strength: 0.05 }))
    });
    scenes.add("smoothing-at-its-limits", 30, || {
        dam::<f64>(schemes::ls_dyna_fluid().with(DivergenceSmoothing {
            smallest: 0.9995,
            largest: 1.001,
        }))
    });
    scenes.add("wall-pressure-floor", 30, move || {
        dam::<f64>(weak().walls(ExtrapolatedPressure { floor: -1e5 }))
    });
    scenes.add("mixed-spacing-of-liquids", 20, || {
        let [coarse, fine] =
            [("coarse", 0.0, DX), ("fine", 0.16, 0.5 * DX)].map(|(name, low, spacing)| {
                Body::block(name, water::<f64>(), [low, 0.0], [low + 0.16, 0.1], spacing)
                    .velocity([0.5 - low, 0.0])
            });
        let viscosity = MonaghanGingold::STANDARD;
        Scene::new(SchemeBuilder::liquid(CubicSpline, viscosity).with(MixedSpacing))
            .body(coarse)
            .body(fine)
            .between("coarse", "fine", Interaction::Bonded)
    });
    scenes.add("two-liquids-in-one-group", 30, move || {
        let oil = Liquid::new(850.0, 1300.0, 0.05).material("oil", SoundSpeed::Chosen(20.0));
        let above = Body::block("oil", oil, [0.0, 15.0 * DX], [20.0 * DX, 18.0 * DX], DX);
        dam::<f64>(weak()).body(above)
    });
    scenes.add("liquid-by-drift-kick-drift", 30, move || {
        dam::<f64>(weak()).integrator(DriftKickDrift)
    });
    scenes.add("liquid-by-position-verlet", 30, move || {
        dam::<f64>(weak()).integrator(PositionVerlet)
    });
    scenes.add("liquid-off-its-lattice", 30, move || {
        let body = Body::block("water", water(), [0.0; 2], [0.16; 2], DX);
        let body = body.jitter(0.2, 7);
        Scene::<f64, 2>::new(weak()).body(body.velocity([0.5, 0.2]))
    });
}

/// Physical viscosities, of constant and of general laws.
fn viscous(scenes: &mut Scenes) {
    let weak = schemes::weakly_compressible;
    let thick = || water::<f64>().with_dynamic_viscosity(0.5);
    let laminar = move || weak().with(Laminar(LaminarViscosity));
    let central = move || weak().with(Laminar(CentralViscosity));
    scenes.add("laminar-viscosity", 30, move || {
        dam_in(laminar(), thick(), |tank| tank)
    });
    scenes.add("central-viscosity-without-slip", 30, move || {
        dam_in(central(), thick(), Wall::no_slip)
    });
    scenes.add("no-slip", 30, move || {
        dam_in(laminar(), thick(), Wall::no_slip)
    });
    scenes.add("sliding-wall", 30, move || {
        let size = 16.0 * DX;
        let body = Body::block("water", thick(), [0.0; 2], [size; 2], DX);
        let lid = [[false; 2], [false, true]];
        let floor = [[false; 2], [true, false]];
        let around = |name, faces| Wall::around(name, [0.0; 2], [size; 2], DX, 4, faces).no_slip();
        Scene::new(laminar())
            .body(body)
            .wall(around("lid", lid).sliding([1.0, 0.0]))
            .wall(around("floor", floor))
            .boundary(Periodic::along(0, 0.0, size))
    });
    let general = [
        water::<f64>().with_rheology(PowerLaw::new(0.5, 0.6, 1e-3, 10.0)),
        water().with_rheology(HerschelBulkley::bingham(1.0, 0.1, 0.1)),
        water().with_rheology(Cross::new(1.0, 0.01, 0.2, 0.8)),
        water().with_rheology(CarreauYasuda::new(1.0, 0.01, 0.2, 0.5)),
    ];
    let names = ["power-law", "bingham", "cross", "carreau-yasuda"];
    for (name, material) in names.into_iter().zip(general) {
        let own = material.clone();
        scenes.add(format!("rheology-{name}"), 25, move || {
            dam_in(
                laminar().with(GeneralisedNewtonian),
                own.clone(),
                Wall::no_slip,
            )
        });
    }
}

/// Walls of particles and how they move.
fn walls(scenes: &mut Scenes) {
    let weak = schemes::weakly_compressible;
    let plan = || Plan {
        steps: 40,
        change: |_| {},
        read: probes,
    };
    scenes.add_with("wall-translated", plan(), move || {
        dam_in::<f64>(weak(), water(), |tank| {
            tank.motion(Translation::steady([0.7, -0.2]))
                .container_frame()
        })
    });
    scenes.add("wall-that-accelerates", 40, move || {
        let record = [(0.0, [0.0; 2]), (0.005, [60.0, 0.0]), (0.1, [-20.0, 5.0])];
        dam_in::<f64>(weak(), water(), move |tank| {
            let motion = Translation::from_acceleration(&record).expect("a record");
            tank.motion(motion).container_frame()
        })
    });
    scenes.add_with("wall-rotated", plan(), move || {
        dam_in::<f64>(weak(), water(), |tank| {
            tank.motion(Rotation::about([0.14, 0.0], |t| {
                [3.0 * t + 40.0 * t * t, 3.0 + 80.0 * t, 80.0]
            }))
        })
    });
    scenes.add("wall-rotated-f32", 40, move || {
        dam_in::<f32>(weak(), water(), |tank| {
            tank.motion(Rotation::about([0.14, 0.0], |t| [2.0 * t, 2.0, 0.0]))
        })
    });
    scenes.add("wall-crushed", 40, move || {
        dam_in::<f64>(weak(), water(), |tank| {
            tank.motion(Crush::along(0, 0.0, |t| [1.5 * t, 1.5, 0.0]))
        })
    });
    scenes.add("two-walls", 40, move || {
        let post = Wall::of(
            "post",
            (0..40)
                .map(|k| [0.215 + DX * f64::from(k % 8), 0.005 + DX * f64::from(k / 8)])
                .collect(),
            DX,
        );
        dam::<f64>(weak()).wall(post.motion(Translation::steady([-1.0, 0.0])))
    });
    let riemann = move || weak().walls(RiemannWalls::default());
    scenes.add_with("riemann-walls", plan(), move || {
        dam_in::<f64>(riemann(), water().with_pressure_cut_off(0.0), |tank| tank)
    });
    scenes.add("riemann-walls-f32", 40, move || {
        dam_in::<f32>(riemann(), water().with_pressure_cut_off(0.0), |tank| tank)
    });
    scenes.add("riemann-walls-that-turn", 40, move || {
        dam_in::<f64>(riemann(), water(), |tank| {
            let points = tank.points().to_vec();
            Wall::of("tank", points, DX)
                .fluid_side(HalfSpace::new([0.0, 0.0], [0.0, -1.0]))
                .motion(Rotation::about([0.0; 2], |t| [t, 1.0, 0.0]))
        })
    });
    scenes.add("liquid-between-mirrors", 40, move || {
        let body = Body::block("water", water(), [0.0; 2], [0.15; 2], DX);
        Scene::<f64, 2>::new(weak())
            .body(body.velocity([0.4, -0.6]))
            .boundary(MirrorPlane::wall([0.0, 0.0], [0.0, -1.0]))
            .boundary(MirrorPlane::wall([0.0, 0.0], [-1.0, 0.0]))
            .boundary(MirrorPlane::wall([0.15, 0.0], [1.0, 0.0]).moving(-0.3))
            .acceleration(|_| [0.0, -G])
    });
}

/// Liquid that cavitates and closes again.
fn cavitating(scenes: &mut Scenes) {
    fn stretched(scheme: impl Into<Scheme<f64, 2>>) -> Scene<f64, 2> {
        let material = water::<f64>().with_pressure_cut_off(0.0);
        let body = Body::block("water", material, [-0.09; 2], [0.09; 2], DX);
        let body = body.start(|x, start| Start {
            velocity: x.map(|x| 30.0 * x),
            ..start
        });
        Scene::<f64, 2>::new(scheme).body(body)
    }
    let turned = || Plan {
        steps: 50,
        change: |now: &mut Simulation<f64, 2>| now.set_velocities(|_, v| v.map(|v| -v)),
        read: |_| Vec::new(),
    };
    let scheme = bare;
    scenes.add_with("cavitation", turned(), move || stretched(scheme()));
    scenes.add_with("cavitation-with-expansion-memory", turned(), move || {
        stretched(scheme().with(ExpansionMemory))
    });
}
