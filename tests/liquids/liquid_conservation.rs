//! What liquids conserve, under every scheme and every boundary of theirs: mass, momentum with the
//! impulse of walls, angular momentum where the forces are central, and energy with what is dissipated.

use crate::common::{self, Random};
use meshfree::boundary::{Crush, Inlet, Outlet, Rotation, Slip, Translation, Wall};
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::scheme::Scheme;
use meshfree::term::viscosity::Riemann;
use meshfree::term::{
    Antuono, CentralViscosity, LaminarViscosity, Molteni, Nothing, RiemannDiffusion,
};
use proptest::prelude::*;

const DX: f64 = 0.01;
const GRAVITY: f64 = 9.81;

/// Every scheme of liquids, with whether it conserves angular momentum: its forces are central, or their
/// torques cancel.
fn schemes_of_liquids() -> Vec<(Scheme<f64, 2>, bool)> {
    let base = schemes::weakly_compressible;
    vec![
        (base().compose(), true),
        (base().density_diffusion(Molteni::default()).compose(), true),
        (base().density_diffusion(Antuono::default()).compose(), true),
        (base().density_diffusion(Nothing).compose(), true),
        (schemes::riemann_liquid().compose(), true),
        (
            base().with(AcousticDamping { strength: 0.3 }).compose(),
            true,
        ),
        (
            base().with(VolumeConsistency { strength: 0.02 }).compose(),
            true,
        ),
        (
            base()
                .named("Riemann walls")
                .walls(RiemannWalls::default())
                .compose(),
            true,
        ),
        (
            base()
                .with_viscosity(Riemann::STANDARD)
                .density_diffusion(RiemannDiffusion)
                .with(Laminar(CentralViscosity))
                .compose(),
            true,
        ),
        (base().with(Laminar(LaminarViscosity)).compose(), false),
        (schemes::ls_dyna_default().compose(), true),
        (schemes::ls_dyna_fluid().compose(), true),
        (schemes::ls_dyna_renormalised().compose(), false),
        (schemes::ls_dyna_fluid_renormalised().compose(), true),
    ]
}

fn water() -> Material<f64> {
    catalogue::weakly_compressible_water(2.0).with_dynamic_viscosity(0.5)
}

/// A square of liquid whose particles are moved off the lattice and given random velocities.
fn drop_of(side: usize, seed: u64) -> Body<f64, 2> {
    let mut random = Random(seed);
    let points: Vec<[f64; 2]> = common::jittered([0.0; 2], [side; 2], 0.1, &mut random)
        .iter()
        .map(|x| x.map(|x| x * DX))
        .collect();
    let random = std::cell::RefCell::new(random);
    Body::points_of("water", water(), points, DX).start(|_, start| {
        let mut random = random.borrow_mut();
        Start {
            velocity: random.vector(1.0),
            density: 1000.0 * (1.0 + 0.005 * random.sign()),
            ..start
        }
    })
}

struct Totals {
    momentum: [f64; 2],
    angular: f64,
    scale: f64,
}

fn totals(simulation: &Simulation<f64, 2>) -> Totals {
    let mut sums = Totals {
        momentum: [0.0; 2],
        angular: 0.0,
        scale: 0.0,
    };
    for particle in simulation.all() {
        let (m, x, v) = (particle.mass(), particle.position(), particle.velocity());
        sums.angular += m * (x[0] * v[1] - x[1] * v[0]);
        for d in 0..2 {
            sums.momentum[d] += m * v[d];
            sums.scale += (m * v[d]).abs();
        }
    }
    sums
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4, ..ProptestConfig::default() })]
    #[test]
    fn a_free_drop_conserves_momentum(seed in any::<u64>()) {
        for (scheme, central) in schemes_of_liquids() {
            let name = scheme.name().to_string();
            let mut simulation = Scene::new(scheme).body(drop_of(10, seed)).build().unwrap();
            let before = totals(&simulation);
            for _ in 0..10 {
                simulation.step().unwrap();
            }
            let after = totals(&simulation);
            for d in 0..2 {
                let change = (after.momentum[d] - before.momentum[d]).abs() / before.scale;
                prop_assert!(change < 1e-13, "{name}: {change:e}");
            }
            let turned = (after.angular - before.angular).abs() / (before.scale * 10.0 * DX);
            prop_assert!(!central || turned < 1e-13, "{name}: {turned:e}");
            prop_assert_eq!(simulation.particles(), 100);
        }
    }
}

#[test]
fn other_forces_change_angular_momentum() {
    // The control of the test above: what it leaves out would fail it.
    for (scheme, central) in schemes_of_liquids() {
        if central {
            continue;
        }
        let name = scheme.name().to_string();
        let mut simulation = Scene::new(scheme).body(drop_of(10, 7)).build().unwrap();
        let before = totals(&simulation);
        for _ in 0..10 {
            simulation.step().unwrap();
        }
        let after = totals(&simulation);
        let turned = (after.angular - before.angular).abs() / (before.scale * 10.0 * DX);
        assert!(turned > 1e-8, "{name}: {turned:e}");
    }
}

/// Walls of every kind around the same liquid.
fn walls() -> Vec<(&'static str, Vec<Wall<2>>)> {
    let side = 10.0 * DX;
    let tank = |name| Wall::around(name, [0.0; 2], [side; 2], DX, 4, [[true; 2]; 2]);
    let wave = |size: f64, rate: f64| {
        move |t: f64| {
            let (s, c) = (rate * t).sin_cos();
            [size * s, size * rate * c, -size * rate * rate * s]
        }
    };
    let shake = wave(0.002, 60.0);
    let translation = Translation::new(
        move |t| [shake(t)[0], 0.0],
        move |t| [shake(t)[1], 0.0],
        move |t| [shake(t)[2], 0.0],
    );
    vec![
        ("at rest", vec![tank("tank")]),
        ("no slip", vec![tank("tank").no_slip()]),
        (
            "shaken",
            vec![tank("tank").motion(translation).container_frame()],
        ),
        (
            "rolled",
            vec![tank("tank").motion(Rotation::about([0.05; 2], wave(0.02, 60.0)))],
        ),
        (
            "crushed",
            vec![tank("tank").motion(Crush::along(1, 0.0, |t| [t, 1.0, 0.0]))],
        ),
    ]
}

#[test]
fn what_walls_give_is_what_liquid_gains() {
    let laminar = || {
        schemes::weakly_compressible()
            .with(Laminar(CentralViscosity))
            .compose()
    };
    let mut cases: Vec<(String, Scheme<f64, 2>, Vec<Wall<2>>)> = Vec::new();
    let riemann = || {
        schemes::weakly_compressible()
            .walls(RiemannWalls::default())
            .compose()
    };
    for (kind, walls) in walls() {
        cases.push((
            format!("{kind}, by Riemann problems"),
            riemann(),
            walls.clone(),
        ));
        cases.push((kind.into(), laminar(), walls));
    }
    for (scheme, _) in schemes_of_liquids() {
        let tank = Wall::around("tank", [0.0; 2], [0.1; 2], DX, 4, [[true; 2]; 2]);
        cases.push((scheme.name().into(), scheme, vec![tank]));
    }
    for (kind, scheme, walls) in cases {
        let mut scene = Scene::new(scheme)
            .body(drop_of(10, 3))
            .acceleration(|_| [0.0, -GRAVITY]);
        for wall in walls {
            scene = scene.wall(wall);
        }
        let mut simulation = scene.build().unwrap();
        simulation.keep_energy();
        let before = totals(&simulation);
        for _ in 0..60 {
            simulation.step().unwrap();
        }
        let (after, impulse) = (totals(&simulation), simulation.wall_impulse(0).unwrap());
        let mass: f64 = simulation.all().map(|particle| particle.mass()).sum();
        let fallen = [0.0, -GRAVITY * mass * simulation.time()];
        for d in 0..2 {
            let gained = after.momentum[d] - before.momentum[d];
            let off = (gained - fallen[d] + impulse[d]).abs() / before.scale;
            assert!(off < 1e-12, "{kind}: {off:e}");
        }
        // The sweep over walls gives what the sweep over liquid gives, with the opposite sign.
        let (by_liquid, mut by_wall) = (simulation.wall_force(0).unwrap(), [0.0; 2]);
        let mut size = 0.0;
        for (_, force) in simulation.wall_particle_forces() {
            for d in 0..2 {
                by_wall[d] += force[d];
                size += force[d].abs();
            }
        }
        for d in 0..2 {
            let off = (by_liquid[d] - by_wall[d]).abs() / size;
            assert!(off < 1e-12, "{kind}: {off:e}");
        }
        let energy = simulation.energy().unwrap();
        let lost = energy.dissipated / (energy.kinetic + energy.dissipated.abs());
        assert!(
            lost > 0.0,
            "{kind}: a random start is damped, not driven: {lost}"
        );
    }
}

#[test]
fn slip_is_what_separates_a_sliding_liquid_from_a_dragged_one() {
    assert_eq!(Slip::default(), Slip::Free);
    let drag = |wall: Wall<2>| {
        let scheme = schemes::weakly_compressible()
            .with(Laminar(LaminarViscosity))
            .compose::<f64, 2>();
        let water = catalogue::weakly_compressible_water(2.0).with_dynamic_viscosity(5.0);
        let mut simulation = Scene::new(scheme)
            .body(Body::block("water", water, [0.0; 2], [0.1; 2], DX).velocity([0.2, 0.0]))
            .wall(wall)
            .boundary(Periodic::along(0, 0.0, 0.1))
            .build()
            .unwrap();
        for _ in 0..40 {
            simulation.step().unwrap();
        }
        let momentum = totals(&simulation).momentum[0];
        let mass: f64 = simulation.all().map(|particle| particle.mass()).sum();
        momentum / (0.2 * mass)
    };
    let closed = [[false; 2], [true; 2]];
    let channel = || Wall::around("channel", [0.0; 2], [0.1; 2], DX, 4, closed);
    let (free, stuck) = (drag(channel()), drag(channel().no_slip()));
    assert!((free - 1.0).abs() < 2e-3, "free slip kept {free}");
    assert!(stuck < 0.98, "no slip kept {stuck}");
}

#[test]
fn mass_that_enters_less_mass_that_leaves_is_there() {
    let opening = (0..10).map(|k| [0.0, DX * (f64::from(k) + 0.5)]).collect();
    let closed = [[false; 2], [true; 2]];
    let mut simulation = Scene::new(schemes::weakly_compressible())
        .body(Body::block("water", water(), [0.0; 2], [0.2, 0.1], DX).velocity([1.0, 0.0]))
        .wall(Wall::around(
            "floor",
            [-0.06, 0.0],
            [0.3, 0.1],
            DX,
            4,
            closed,
        ))
        .inlet(Inlet::new("water", opening, [1.0, 0.0], DX, 100))
        .outlet(Outlet::plane([0.22, 0.0], [1.0, 0.0]))
        .build()
        .unwrap();
    simulation.run_until(0.155).unwrap();
    let removed = simulation.removed();
    let there: f64 = simulation.all().map(|particle| particle.mass()).sum();
    // Fifteen layers of ten have come in by now; more than the reserve would hold had none left.
    let entered = 150.0 * 1000.0 * DX * DX;
    let first = 200.0 * 1000.0 * DX * DX;
    assert!(removed.particles >= 100, "{removed:?}");
    assert!((there + removed.mass - first - entered).abs() < 1e-9 * first);
    assert_eq!(simulation.particles() as u64 + removed.particles, 200 + 150);
}

#[test]
fn an_inlet_without_reserve_says_so() {
    let opening = (0..10).map(|k| [0.0, DX * (f64::from(k) + 0.5)]).collect();
    let mut simulation = Scene::new(schemes::weakly_compressible())
        .body(Body::block("water", water(), [0.0; 2], [0.1; 2], DX).velocity([1.0, 0.0]))
        .boundary(Periodic::along(1, 0.0, 0.1))
        .inlet(Inlet::new("water", opening, [1.0, 0.0], DX, 15))
        .build()
        .unwrap();
    let error = simulation.run_until(0.1).unwrap_err().to_string();
    assert!(
        error.contains("reserve") && error.contains("`water`"),
        "{error}"
    );
}

#[test]
fn threads_do_not_change_a_bit() {
    let base = schemes::weakly_compressible;
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap().install(|| {
            let mut simulation = Scene::<f64, 2>::new(base())
                .body(drop_of(30, 11))
                .wall(Wall::around(
                    "tank",
                    [0.0; 2],
                    [0.3; 2],
                    DX,
                    4,
                    [[true; 2]; 2],
                ))
                .acceleration(|_| [0.0, -GRAVITY])
                .build()
                .unwrap();
            for _ in 0..30 {
                simulation.step().unwrap();
            }
            simulation
                .all()
                .flat_map(|p| [p.position(), p.velocity(), [p.density(), p.pressure()]])
                .collect::<Vec<_>>()
        })
    };
    let one = run(1);
    assert_eq!(one, run(2));
    assert_eq!(one, run(3));
}
