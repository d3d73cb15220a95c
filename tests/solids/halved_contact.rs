//! Couplings by forces at a plane of symmetry and across a period, against the whole scene.
//! What stands behind the plane presses, holds and rubs as if it were there.

use meshfree::coupling::{ContactDensity, Coupling, Penalty, Tied};
use meshfree::effect::NeoHookean;
use meshfree::material::eos::Linear;
use meshfree::particles::Field;
use meshfree::prelude::*;

const RHO: f64 = 1000.0;
const YOUNGS: f64 = 2e6;
const POISSON: f64 = 0.3975;
/// Half the width of the punch and of the plate \[m\].
const HALVES: [f64; 2] = [0.04, 0.1];
const SPEED: f64 = 2.0;

fn scheme() -> Scheme<f64, 2> {
    schemes::total_lagrangian().with(NeoHookean).compose()
}

fn body(name: &str, low: [f64; 2], high: [f64; 2], dx: f64) -> Body<f64, 2> {
    let law = Linear::from_elastic_constants(RHO, YOUNGS, POISSON);
    let shear = YOUNGS / (2.0 * (1.0 + POISSON));
    let material = Material::new("rubber", law).with_shear_modulus(shear);
    Body::block(name, material, low, high, dx)
}

/// A punch that strikes a plate, or is torn from it where `speed` is positive; all of it, or its right half.
fn punched(
    half: bool,
    speed: f64,
    coupling: impl Coupling<f64, 2> + 'static,
) -> Simulation<f64, 2> {
    let [punch, plate] = HALVES.map(|width| if half { 0.0 } else { -width });
    // Rotating the punch's velocity makes it slide as it strikes.
    let punch = body("punch", [punch, 0.0], [HALVES[0], 0.06], 0.008).start(move |[x, y], own| {
        meshfree::scheme::Start {
            velocity: [8.0 * SPEED * x * y / 0.06, speed],
            ..own
        }
    });
    let scene = Scene::new(scheme())
        .body(punch)
        .group(
            scheme(),
            [body("plate", [plate, -0.04], [HALVES[1], 0.0], 0.01)],
        )
        .couple("punch", "plate", coupling);
    let scene = if half {
        scene.boundary(MirrorPlane::symmetry([0.0; 2], [-1.0, 0.0]))
    } else {
        scene
    };
    let mut simulation = scene.build().unwrap();
    simulation.run_until(1e-3).unwrap();
    simulation
}

/// Places by those as built, right of the plane.
fn right(now: &Simulation<f64, 2>) -> Vec<[f64; 4]> {
    let mut all: Vec<_> = now
        .all()
        .map(|p| {
            let built = p.vector(Field::REFERENCE_POSITION).unwrap();
            let [x, y] = p.position();
            [built[0], built[1], x, y]
        })
        .filter(|own| own[0] > 0.0)
        .collect();
    let key = |own: &[f64; 4]| [own[0], own[1]].map(|x| (x * 1e6).round() as i64);
    all.sort_by_key(key);
    all
}

#[test]
fn a_half_with_a_plane_of_symmetry_is_half_of_the_whole() {
    type Run = fn(bool) -> Simulation<f64, 2>;
    let runs: [(&str, Run); 3] = [
        ("contact", |half| {
            punched(half, -SPEED, ContactDensity::new().friction(0.3))
        }),
        ("tied", |half| punched(half, SPEED, Tied::new())),
        ("penalty", |half| {
            punched(half, -SPEED, Penalty::new().friction(0.3))
        }),
    ];
    for (name, run) in runs {
        let (whole, half) = (run(false), run(true));
        let (own, other) = (right(&whole), right(&half));
        assert_eq!(own.len(), other.len());
        let (mut worst, mut farthest) = (0.0_f64, 0.0_f64);
        for (a, b) in own.iter().zip(&other) {
            for d in 2..4 {
                worst = worst.max((a[d] - b[d]).abs());
                farthest = farthest.max((a[d] - a[d - 2]).abs());
            }
        }
        let [first, second] = [&whole, &half].map(|now| now.contacts().remove(0));
        println!(
            "{name}: places within {worst:.1e} m of {farthest:.1e} m; force {:.3} and {:.3} N/m, pairs {} and {}, \
             stored {:.4e} and {:.4e} J/m",
            first.force[1], second.force[1], first.pairs, second.pairs, first.stored, second.stored
        );
        assert!(farthest > 1e-3 && worst < 1e-14, "{name}: {worst:e}");
        // Half of what the whole stores, heats and works.
        for (all, part) in [
            (first.stored, second.stored),
            (first.heat, second.heat),
            (first.work[0], second.work[0]),
        ] {
            assert!(
                (all - 2.0 * part).abs() <= 1e-9 * all.abs() + 1e-15,
                "{name}: {all:e} {part:e}"
            );
        }
        // And of the force along the plane.
        let [whole, part] = [first.force[1], second.force[1]];
        assert!(
            (whole - 2.0 * part).abs() <= 1e-9 * whole.abs(),
            "{name}: {whole} {part}"
        );
        // What the half gains along the normal of the plane, the plane has given: kernels and couplings.
        let ledger = half.ledger();
        let gained = ledger.whole.momentum[0] - start_of_half();
        let given = ledger.boundary_impulse[0];
        println!("{name}: momentum {gained:.6e} N s/m, of the plane {given:.6e}");
        assert!((gained - given).abs() < 1e-12 * RHO * SPEED, "{name}");
    }
}

/// The first momentum along x of the right half of the punch \[kg m/s per m\].
fn start_of_half() -> f64 {
    let punch = body("punch", [0.0; 2], [HALVES[0], 0.06], 0.008);
    let area = HALVES[0] * 0.06 / punch.points().len() as f64;
    let sum: f64 = punch
        .points()
        .iter()
        .map(|[x, y]| 8.0 * SPEED * x * y / 0.06)
        .sum();
    RHO * area * sum
}

/// Two rods that meet across a period press each other as two that meet within it.
#[test]
fn a_contact_across_a_period_is_one() {
    let strike = |shift: f64| {
        let place = |low: f64| {
            let low = (low + shift).rem_euclid(1.0);
            ([low, 0.0], [low + 0.3, 0.1])
        };
        let ([a, b], [c, d]) = {
            let (first, second) = (place(0.1), place(0.4));
            ([first.0, first.1], [second.0, second.1])
        };
        let mut now = Scene::new(scheme())
            .body(body("left", a, b, 0.02).velocity([0.5, 0.0]))
            .body(body("right", c, d, 0.02))
            .couple("left", "right", ContactDensity::new())
            .boundary(Periodic::along(0, 0.0, 1.0))
            .build()
            .unwrap();
        now.run_until(2e-3).unwrap();
        let ledger = now.ledger();
        ledger.bodies[1].1.momentum[0]
    };
    let (within, across) = (strike(0.0), strike(0.3));
    println!("momentum handed over: {within} and {across} N s/m");
    assert!(within > 1.0 && (across / within - 1.0).abs() < 1e-10);
}
