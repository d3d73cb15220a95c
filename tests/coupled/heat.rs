//! Heat: conduction, and convection and radiation at free surfaces, against exact solutions and lumped ones.
//! Areas of surfaces against those of bodies; the ledger and the energy of a solid against what entered.

use approx::assert_relative_eq;
use meshfree::effect::{HeatConduction, STEFAN_BOLTZMANN, SurfaceHeat};
use meshfree::geometry::Ball;
use meshfree::kernel::KernelKind;
use meshfree::prelude::*;

const RHO: f64 = 1000.0;

fn water<T: Real>() -> Material<T> {
    catalogue::weakly_compressible_water(1.0)
}

fn conduction(conductivity: f64) -> HeatConduction {
    HeatConduction {
        conductivity,
        specific_heat: 1.0,
        temperature: 400.0,
    }
}

fn area<const D: usize>(run: &Simulation<f64, D>) -> f64 {
    let areas = run.all().filter_map(|own| own.scalar(SurfaceHeat::AREA));
    areas.sum()
}

/// Mean temperature, and the largest distance from it.
fn temperature<const D: usize>(run: &Simulation<f64, D>) -> [f64; 2] {
    let all: Vec<f64> = run
        .all()
        .filter_map(|own| own.scalar(HeatConduction::TEMPERATURE))
        .collect();
    let mean = all.iter().sum::<f64>() / all.len() as f64;
    let off = all.iter().map(|own| (own - mean).abs());
    [mean, off.fold(0.0, f64::max)]
}

/// The scheme of a body that is heated and does not flow.
macro_rules! still {
    ($conductivity:expr, $surface:expr) => {
        schemes::weakly_compressible()
            .with(conduction($conductivity))
            .with($surface)
    };
}

fn built<const D: usize>(body: Body<f64, D>) -> Simulation<f64, D>
where
    WendlandC2: meshfree::kernel::Kernel<D>,
{
    let scheme = still!(1.0, SurfaceHeat::convection(1e-3, 300.0));
    let mut run = Scene::new(scheme).body(body).build().expect("a body");
    run.step_at_most(1e-9).expect("a step");
    run
}

/// Σ A over the true area: flat ends exactly, and a few per cent where smoothing rounds edges.
#[test]
fn areas_of_bodies() {
    let dx = 0.01;
    let slab = built(Body::block("slab", water(), [0.0], [0.2], dx));
    assert_relative_eq!(area(&slab), 2.0, max_relative = 1e-9);

    let strip = still!(1.0, SurfaceHeat::convection(1e-3, 300.0));
    let mut strip = Scene::new(strip)
        .body(Body::block("strip", water(), [0.0; 2], [0.2, 0.1], dx))
        .boundary(meshfree::boundary::Periodic::along(1, 0.0, 0.1))
        .build()
        .expect("a strip");
    strip.step_at_most(1e-9).expect("a step");
    assert_relative_eq!(area(&strip), 0.2, max_relative = 1e-9);

    let n = 40.0;
    let square = built(Body::block("square", water(), [0.0; 2], [n * dx; 2], dx));
    let disc = Body::fill("disc", water(), &Ball::new([0.0; 2], 0.5 * n * dx), dx);
    let disc = built(disc);
    let size = std::f64::consts::PI * n * dx;
    println!(
        "square {} disc {}",
        area(&square) / (4.0 * n * dx),
        area(&disc) / size
    );
    assert_relative_eq!(area(&square), 4.0 * n * dx, max_relative = 0.03);
    assert_relative_eq!(area(&disc), size, max_relative = 0.02);

    let n = 20.0;
    let cube = built(Body::block("cube", water(), [0.0; 3], [n * dx; 3], dx));
    let ball = built(Body::fill(
        "ball",
        water(),
        &Ball::new([0.0; 3], 0.5 * n * dx),
        dx,
    ));
    let size = std::f64::consts::PI * (n * dx).powi(2);
    println!(
        "cube {} ball {}",
        area(&cube) / (6.0 * (n * dx).powi(2)),
        area(&ball) / size
    );
    assert_relative_eq!(area(&cube), 6.0 * (n * dx).powi(2), max_relative = 0.105);
    assert_relative_eq!(area(&ball), size, max_relative = 0.03);
}

fn slab(conductivity: f64, surface: SurfaceHeat) -> Simulation<f64, 1> {
    let body = Body::block("slab", water(), [0.0], [0.2], 0.01);
    let scheme = still!(conductivity, surface);
    Scene::new(scheme).body(body).build().expect("a slab")
}

/// dT/dt = −2 q(T)/(ρ c L) of the slab, by Runge & Kutta.
fn lumped(q: impl Fn(f64) -> f64, until: f64) -> f64 {
    let rate = |t: f64| -2.0 * q(t) / (RHO * 0.2);
    let (mut t, dt) = (400.0, until / 1000.0);
    for _ in 0..1000 {
        let a = rate(t);
        let b = rate(t + 0.5 * dt * a);
        let c = rate(t + 0.5 * dt * b);
        let d = rate(t + dt * c);
        t += dt * (a + 2.0 * b + 2.0 * c + d) / 6.0;
    }
    t
}

/// What is left of T − T∞ after 1 s, over that of the lumped solution.
fn left(conductivity: f64, h: f64) -> f64 {
    let mut run = slab(conductivity, SurfaceHeat::convection(h, 300.0));
    run.run_until(1.0).expect("a run");
    let [mean, _] = temperature(&run);
    (mean - 300.0) / (lumped(|t| h * (t - 300.0), 1.0) - 300.0)
}

/// With Bi = h L/(2 k) = 0.005 the mean temperature is the lumped one; with Bi = 5 the surface cools and the middle stays warm.
#[test]
fn a_block_cools_by_convection() {
    let thin = left(1000.0, 50.0);
    println!("left: {thin}");
    assert_relative_eq!(thin, 1.0, max_relative = 0.01);
    let thick = left(1.0, 50.0);
    println!("left with a large Biot number: {thick}");
    assert!(thick > 1.2, "{thick}");
}

/// What is left of T − T∞ of a body over that of the lumped solution, with Bi = h L/(2 k) = 0.0075, and by how much its area was low.
fn left_of_block<const D: usize>(body: Body<f64, D>, true_area: Option<f64>) -> [f64; 2]
where
    WendlandC2: meshfree::kernel::Kernel<D>,
{
    let (h, until) = (50.0, 0.2);
    let scheme = still!(400.0, SurfaceHeat::convection(h, 300.0));
    let mut run = Scene::new(scheme).body(body).build().expect("a block");
    let ratio = true_area.map_or(1.0, |area| {
        SurfaceHeat::set_area(&mut run, "block", area).expect("an area")
    });
    run.run_until(until).expect("a run");
    let [mean, _] = temperature(&run);
    // A/V = 2 D/L of a square and a cube.
    let rate = h * 2.0 * D as f64 / (RHO * EDGE);
    [(mean - 300.0) / (100.0 * (-rate * until).exp()), ratio]
}

/// Twelve particles of a block \[m\].
const EDGE: f64 = 0.12;

/// With its true area a square cools as the lumped solution does. The control has the area that smoothing leaves.
#[test]
fn a_square_cools_by_its_true_area() {
    let square = || Body::block("block", water(), [0.0; 2], [EDGE; 2], EDGE / 12.0);
    let [[rounded, _], [exact, ratio]] =
        [None, Some(4.0 * EDGE)].map(|area| left_of_block(square(), area));
    println!("square {rounded} {exact}, area low by {ratio}");
    assert_relative_eq!(exact, 1.0, max_relative = 0.01);
    assert!(rounded > 1.01 && ratio > 1.03, "{rounded} {ratio}");
}

/// So does a cube, whose conduction takes the longest step that is stable in space.
#[test]
fn a_cube_cools_by_its_true_area() {
    let cube = || Body::block("block", water(), [0.0; 3], [EDGE; 3], EDGE / 12.0);
    let [[rounded, _], [exact, ratio]] =
        [None, Some(6.0 * EDGE * EDGE)].map(|area| left_of_block(cube(), area));
    println!("cube {rounded} {exact}, area low by {ratio}");
    assert_relative_eq!(exact, 1.0, max_relative = 0.01);
    assert!(rounded > 1.01 && ratio > 1.1, "{rounded} {ratio}");
}

/// Layers of two temperatures beside a conductor that is a thousand times better, in space: with no kernel conduction leaves the
/// temperatures that there are, which a step beyond its limit does in a few steps.
#[test]
fn conduction_in_space_is_stable_with_every_kernel() {
    let half = |name, low: f64| {
        Body::block(
            name,
            water(),
            [low, 0.0, 0.0],
            [low + 0.06, EDGE, EDGE],
            0.01,
        )
    };
    let striped = |[_, y, _]: [f64; 3]| [300.0 + 100.0 * ((100.0 * y).floor() % 2.0)];
    // The cubic spline pairs at this ratio.
    let kinds = KernelKind::ALL
        .iter()
        .filter(|own| **own != KernelKind::CubicSpline);
    for &kernel in kinds {
        let scheme = schemes::weakly_compressible().with_kernel(kernel);
        let left = half("left", 0.0).field(HeatConduction::TEMPERATURE, striped);
        let right = half("right", 0.06).field(HeatConduction::CONDUCTIVITY, |_| [4e5]);
        let mut run = Scene::<f64, 3>::new(scheme.h_over_dx(1.5).with(conduction(400.0)))
            .body(left)
            .body(right)
            .build()
            .expect("two halves");
        for _ in 0..60 {
            run.step().expect("a step");
        }
        let all = run
            .all()
            .filter_map(|own| own.scalar(HeatConduction::TEMPERATURE));
        let all: Vec<f64> = all.collect();
        assert!(all.iter().all(|t| (300.0..=400.0).contains(t)), "{kernel}");
    }
}

#[test]
fn areas_that_no_body_has_are_refused() {
    let mut run = slab(1.0, SurfaceHeat::convection(1.0, 300.0));
    let refused = |run: &mut Simulation<f64, 1>, body: &str, area: f64, what: &str| {
        let error = SurfaceHeat::set_area(run, body, area).expect_err(what);
        assert!(error.to_string().contains(what), "{error}");
    };
    // Without the effect there is no area.
    let scheme = schemes::weakly_compressible().with(conduction(1.0));
    let body = Body::block("slab", water(), [0.0], [0.2], 0.01);
    let mut without = Scene::new(scheme).body(body).build().expect("a slab");
    refused(&mut without, "slab", 2.0, "SurfaceHeat");
    refused(
        &mut run,
        "slab",
        f64::NAN,
        "area of the surface of body `slab`",
    );
    refused(&mut run, "slab", 0.0, "positive");
    refused(&mut run, "slap", 2.0, "slab");
    let ratio = SurfaceHeat::set_area(&mut run, "slab", 1.0).expect("an area");
    assert_relative_eq!(ratio, 0.5, max_relative = 1e-9);
    assert_relative_eq!(area(&run), 1.0, max_relative = 1e-9);
    // Once more, and after other factors: it is the area that is given.
    let again = SurfaceHeat::set_area(&mut run, "slab", 1.0).expect("an area");
    assert_relative_eq!(again, 1.0, max_relative = 1e-9);
    run.set_field("slab", SurfaceHeat::AREA_FACTOR, |_, [_]: [f64; 1]| [7.0])
        .expect("factors");
    SurfaceHeat::set_area(&mut run, "slab", 3.0).expect("an area");
    run.step_at_most(1e-9).expect("a step");
    assert_relative_eq!(area(&run), 3.0, max_relative = 1e-9);
}

#[test]
fn a_block_cools_by_radiation() {
    let mut run = slab(
        1000.0,
        SurfaceHeat::radiation(0.8, 100.0).and(SurfaceHeat::radiation(0.1, 300.0)),
    );
    run.run_until(4.0).expect("a run");
    let grey = |e: f64, t: f64, to: f64| e * STEFAN_BOLTZMANN * (t.powi(4) - to.powi(4));
    let exact = lumped(|t| grey(0.8, t, 100.0) + grey(0.1, t, 300.0), 4.0);
    let [mean, _] = temperature(&run);
    println!("{mean} K of {exact} K");
    assert_relative_eq!(400.0 - mean, 400.0 - exact, max_relative = 0.01);
    assert!(400.0 - exact > 20.0);
}

/// What warms bodies is what passed their surfaces and what loads gave; conduction gives nothing to all together.
#[test]
fn the_ledger_has_the_heat() {
    let scheme = still!(
        5.0,
        SurfaceHeat::convection(50.0, 300.0).and(SurfaceHeat::radiation(1.0, 0.0))
    );
    let half = |name, low: f64| Body::block(name, water(), [low], [low + 0.1], 0.01);
    let mut run = Scene::<f64, 1>::new(scheme)
        .body(half("left", 0.0))
        .body(half("right", 0.1))
        .load(Load::heating(|_| 30.0).on("left"))
        .build()
        .expect("two halves");
    run.run_until(0.5).expect("a run");
    let ledger = run.ledger();
    let of = |body: usize, name: &str| ledger.bodies[body].1.total(name).expect("a total");
    let all = |name: &str| of(0, name) + of(1, name);
    for (k, load) in [(0, 30.0 * 0.5 * RHO * 0.1), (1, 0.0)] {
        let own: Vec<f64> = run
            .body(k)
            .expect("a body")
            .filter_map(|own| own.scalar(HeatConduction::TEMPERATURE))
            .collect();
        let gained = (own.iter().sum::<f64>() - 400.0 * own.len() as f64) * RHO * 0.01;
        let given = of(k, "heat through surfaces") + of(k, "heat conduction") + load;
        assert_relative_eq!(gained, given, max_relative = 1e-9);
    }
    assert!(of(1, "heat conduction") > 1.0);
    assert!(all("heat conduction").abs() < 1e-9 * of(1, "heat conduction"));
}

/// Two half spaces of one ρ c have T* = (T₁ √k₁ + T₂ √k₂)/(√k₁ + √k₂) where they meet.
#[test]
fn two_conductivities_meet_at_the_temperature_of_their_effusivities() {
    let half = |name, low: f64, k: f64, t: f64| {
        Body::block(name, water(), [low], [low + 0.5], 0.005)
            .field(HeatConduction::CONDUCTIVITY, move |_| [k])
            .field(HeatConduction::TEMPERATURE, move |_| [t])
    };
    let scheme = schemes::weakly_compressible().with(conduction(1.0));
    let mut run = Scene::<f64, 1>::new(scheme)
        .body(half("hot", 0.0, 40.0, 500.0))
        .body(half("cold", 0.5, 10.0, 300.0))
        .build()
        .expect("two halves");
    run.run_until(0.3).expect("a run");
    let at = |name, from_joint: usize| {
        let body = run.body(name).expect("a body");
        let all: Vec<f64> = body
            .filter_map(|own| own.scalar(HeatConduction::TEMPERATURE))
            .collect();
        let k = if name == "hot" {
            all.len() - 1 - from_joint
        } else {
            from_joint
        };
        all[k]
    };
    // By flux: equal k dT/dx on both sides of the joint.
    let (hot, cold) = (at("hot", 0), at("cold", 0));
    let joint = (40.0 * hot + 10.0 * cold) / 50.0;
    let (a, b) = (40.0_f64.sqrt(), 10.0_f64.sqrt());
    let exact = (500.0 * a + 300.0 * b) / (a + b);
    println!("{joint} K of {exact} K");
    assert!((joint - exact).abs() < 1.0);
}

/// Heat that enters a solid with internal energy is in the energy of the body, to rounding.
#[test]
fn heat_joins_internal_energy() {
    let copper = HeatConduction {
        conductivity: 400.0,
        specific_heat: 385.0,
        temperature: 300.0,
    };
    let scheme = schemes::impact()
        .with(copper)
        .with(SurfaceHeat::convection(1e9, 400.0).of("copper"));
    let mut run = Scene::<f64, 1>::new(scheme)
        .body(Body::block("bar", catalogue::copper(), [0.0], [0.01], 2e-4))
        .build()
        .expect("a bar");
    let before = run.ledger().whole.total_energy();
    run.run_until(3e-6).expect("a run");
    let after = run.ledger().whole;
    let heat = after.total("heat through surfaces").expect("heat");
    println!("{heat} J, {} J", after.total_energy() - before);
    assert!(heat > 1e5);
    assert_relative_eq!(after.total_energy() - before, heat, max_relative = 1e-10);
    // What is heated expands.
    assert!(after.kinetic > 1e-6 * heat);
}

/// In single precision, and resumed from a file on the way: the same bits.
#[cfg(feature = "checkpoint")]
#[test]
fn heat_resumes_to_the_same_bits() {
    let scene = || {
        let scheme = still!(10.0, SurfaceHeat::convection(50.0, 300.0));
        Scene::<f32, 2>::new(scheme).body(Body::block("block", water(), [0.0; 2], [0.1; 2], 0.01))
    };
    let bits = |run: &Simulation<f32, 2>| -> Vec<u64> {
        let fields = [
            HeatConduction::TEMPERATURE,
            SurfaceHeat::RECEIVED,
            SurfaceHeat::AREA,
        ];
        let of = |field| run.all().filter_map(move |own| own.scalar(field));
        fields.into_iter().flat_map(of).map(f64::to_bits).collect()
    };
    let file = std::env::temp_dir().join(format!("meshfree-{}-heat", std::process::id()));
    let mut whole = scene().build().expect("a block");
    whole.run_until(0.02).expect("a run");
    SurfaceHeat::set_area(&mut whole, "block", 0.4).expect("an area");
    whole.save(&file).expect("a file");
    whole.run_until(0.04).expect("a run");
    let mut resumed = scene().resume(&file).expect("a file");
    resumed.run_until(0.04).expect("a run");
    let _ = std::fs::remove_file(&file);
    assert_eq!(bits(&whole), bits(&resumed));
    assert!(temperature_f32(&whole) < 399.9);
}

#[cfg(feature = "checkpoint")]
fn temperature_f32(run: &Simulation<f32, 2>) -> f64 {
    let all = run
        .all()
        .filter_map(|own| own.scalar(HeatConduction::TEMPERATURE));
    all.fold(f64::INFINITY, f64::min)
}

#[test]
fn wrong_heat_is_refused() {
    let refused = |scheme: Scheme<f64, 1>, what: &str| {
        let body = Body::block("slab", water(), [0.0], [0.2], 0.01);
        let error = Scene::new(scheme).body(body).build().map(drop);
        let error = error.expect_err(what).to_string();
        assert!(error.contains(what), "{error}");
    };
    let convection = SurfaceHeat::convection(1.0, 300.0);
    for (surface, what) in [
        (
            SurfaceHeat::convection(-1.0, 300.0),
            "coefficient of convection",
        ),
        (
            SurfaceHeat::convection(1.0, f64::NAN),
            "temperature of the surroundings",
        ),
        (SurfaceHeat::radiation(1.5, 300.0), "emissivity"),
        (convection.clone().of("steel"), "steel"),
    ] {
        refused(still!(1.0, surface).compose(), what);
    }
    let alone = schemes::weakly_compressible().with(convection).compose();
    refused(alone, "temperature");
    for (own, what) in [
        (
            HeatConduction {
                specific_heat: 0.0,
                ..conduction(1.0)
            },
            "specific heat",
        ),
        (conduction(f64::INFINITY), "conductivity"),
        (
            HeatConduction {
                temperature: -1.0,
                ..conduction(1.0)
            },
            "temperature",
        ),
    ] {
        refused(schemes::weakly_compressible().with(own).compose(), what);
    }
}
