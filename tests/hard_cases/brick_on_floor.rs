//! A brick that falls on its corner onto a floor of particles, and tumbles: it must not go through, nor gain energy.
//! The control has no contact, which a scene has to say.

use super::harness::{Row, Varied, lasting, seed};
use meshfree::coupling::ContactDensity;
use meshfree::effect::NeoHookean;
use meshfree::material::eos::Linear;
use meshfree::prelude::*;

const DX: f64 = 0.02;
const G: f64 = 9.81;

/// The deepest place of a particle below the face of the floor in spacings, and the largest energy of the brick with its
/// contact over what it had.
fn falls(contact: bool, elastic: bool) -> [f64; 2] {
    let law = Linear::from_elastic_constants(2000.0, 5e5, 0.3);
    let stuff = Material::new("stuff", law).with_shear_modulus(5e5 / 2.6);
    let (sin, cos) = 0.6_f64.sin_cos();
    let points = (0..12).flat_map(|i| (0..6).map(move |j| [f64::from(i), f64::from(j)]));
    let points = points.map(|[i, j]| {
        let [x, y] = [(i - 5.5) * DX, (j - 2.5) * DX];
        [cos * x - sin * y, 0.3 + sin * x + cos * y]
    });
    let brick = Body::points_of("brick", stuff, points.collect(), DX).jitter(0.01, seed(3));
    let floor = (-60..60).flat_map(|i| (0..3).map(move |j| [f64::from(i), f64::from(j)]));
    let floor = floor.map(|[i, j]| [(i + 0.5) * DX, -(j + 0.5) * DX]);
    let mut scene = Scene::<f64, 2>::new(schemes::total_lagrangian().with(NeoHookean))
        .body(brick)
        .wall(Wall::of("floor", floor.collect(), DX))
        .acceleration(|_| [0.0, -G]);
    if !elastic {
        scene = scene.rigid("brick");
    }
    scene = if contact {
        scene.couple("brick", "floor", ContactDensity::new().friction(0.3))
    } else {
        scene.between("brick", "floor", Interaction::None)
    };
    let mut own = scene.varied().build().expect("a brick");
    let (mut deep, mut least, mut most) = (0.0_f64, 0.0, 0.0_f64);
    let ended = own.run_with(lasting(1.5), |now| {
        let ledger = now.ledger().whole;
        let mut whole = ledger.kinetic + ledger.internal;
        whole += ledger.total("energy of couplings").unwrap_or(0.0);
        for p in now.all() {
            let y = p.position()[1];
            deep = deep.max(-y);
            whole += p.mass() * G * y;
        }
        if least == 0.0 {
            least = whole;
        }
        most = most.max(whole / least);
    });
    assert!(ended.is_ok(), "{ended:?}");
    [deep / DX, most]
}

#[test]
fn bricks_do_not_fall_through_floors() {
    for (case, elastic) in [
        ("rigid brick on a floor of particles", false),
        ("elastic brick on a floor of particles", true),
    ] {
        let [met, through] = [true, false].map(|contact| falls(contact, elastic));
        println!("{case}: energy at most {} of its first", met[1]);
        Row {
            case,
            criterion: "deepest particle in spacings; contact, control: none",
            value: met[0],
            control: through[0],
        }
        .at_most(0.5);
        assert!(met[1] < 1.02, "{case}: {met:?}");
    }
}
