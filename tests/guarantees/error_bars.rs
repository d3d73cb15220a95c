//! Error bars on held-out results: that of a spacing four times as fine is in nine of ten intervals.
//! The rods of Lam, Shen & Gong (2002), and a column of water that falls.

use meshfree::material::Material;
use meshfree::material::catalogue;
use meshfree::prelude::*;
use meshfree::study::with_error_bar;

const RODS: [f64; 4] = [4e-4, 3.2e-4, 2.5e-4, 2e-4];
const RODS_FINER: f64 = 5e-5;
const TANK: [f64; 4] = [0.05, 0.1 / 3.0, 0.025, 0.02];
const TANK_FINER: f64 = 0.005;

type Found = Result<[f64; 5], Box<dyn std::error::Error + Send + Sync>>;

/// What a striker of copper has given to a target after `end` \[s\]: momentum \[kg/(m s)\], kinetic energy \[J/m²\], largest pressure
/// \[Pa\], its mean over the target \[Pa\], and how far the target's middle has gone \[m\].
fn rods(dx: f64, target: Material<f64>, end: f64) -> Found {
    let striker = Body::block("striker", catalogue::copper(), [0.0], [0.01], dx).velocity([20.0]);
    let scene = Scene::<f64, 1>::new(schemes::impact()).body(striker);
    let mut rods = scene
        .body(Body::block("target", target, [0.01], [0.03], dx))
        .build()?;
    rods.run_until(end)?;
    let mut found = [0.0; 5];
    let mut mass = 0.0;
    for p in rods.body("target")? {
        let (m, v) = (p.mass(), p.velocity()[0]);
        mass += m;
        found[0] += m * v;
        found[1] += 0.5 * m * v * v;
        found[2] = found[2].max(p.pressure());
        found[3] += m * p.pressure();
        found[4] += m * p.position()[0];
    }
    found[3] /= mass;
    found[4] = found[4] / mass - 0.02;
    Ok(found)
}

/// Water that falls in a tank: kinetic energy \[J/m\], heights of the centre of mass \[m\] along and up, front \[m\] and top \[m\] at 0.15 s.
fn tank(dx: f64) -> Found {
    let water = Material::new("water", meshfree::material::eos::Tait::new(1000.0, 30.0));
    let scene = Scene::<f64, 2>::new(schemes::weakly_compressible())
        .body(Body::block("water", water, [0.0; 2], [0.5, 0.3], dx))
        .boundary(MirrorPlane::symmetry([0.0; 2], [-1.0, 0.0]))
        .boundary(MirrorPlane::symmetry([0.0; 2], [0.0, -1.0]))
        .acceleration(|_| [0.0, -9.81]);
    let mut tank = scene.build()?;
    tank.run_until(0.15)?;
    let (mut found, mut mass) = ([0.0; 5], 0.0);
    for p in tank.all() {
        let ([x, y], [u, v], m) = (p.position(), p.velocity(), p.mass());
        mass += m;
        found[0] += 0.5 * m * (u * u + v * v);
        found[1] += m * x;
        found[2] += m * y;
        found[3] = f64::max(found[3], x + 0.5 * dx);
        found[4] = f64::max(found[4], y + 0.5 * dx);
    }
    (found[1], found[2]) = (found[1] / mass, found[2] / mass);
    Ok(found)
}

/// How many of five results of the finer spacing are in the intervals.
fn held(name: &str, spacings: [f64; 4], finer: f64, run: impl Fn(f64) -> Found) -> usize {
    let all: Vec<_> = spacings
        .iter()
        .map(|dx| run(*dx).expect("it runs"))
        .collect();
    let found = run(finer).expect("it runs");
    let inside = |k: usize| {
        let at = |dx: f64| {
            spacings
                .iter()
                .position(|own| *own == dx)
                .expect("one of them")
        };
        let bar = with_error_bar(spacings, |dx| Ok(all[at(dx)][k])).expect("four spacings");
        let within = (bar.value - found[k]).abs() <= bar.uncertainty;
        println!("{name} {k}: {bar}, finer {:.6e}, within {within}", found[k]);
        within
    };
    (0..5).filter(|k| inside(*k)).count()
}

#[test]
fn nine_of_ten_intervals_hold_the_finer_result() {
    let copper = |dx| rods(dx, catalogue::copper(), 3.2e-6);
    let pmma = |dx| rods(dx, catalogue::pmma(), 3.2e-6);
    let inside = held("copper on copper", RODS, RODS_FINER, copper)
        + held("copper on PMMA", RODS, RODS_FINER, pmma)
        + held("tank", TANK, TANK_FINER, tank);
    assert!(inside * 10 >= 15 * 9, "{inside} of 15");
}
