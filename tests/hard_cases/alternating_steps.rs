//! An undamped plate whose steps repeat a pattern, which a leapfrog resonates with far below its limit.
//! Kinetic and internal energy close to rounding meanwhile; stored energy, as a function of the state, does not.

use super::harness::Row;
use meshfree::effect::NeoHookean;
use meshfree::material::eos::Linear;
use meshfree::prelude::*;

/// The largest gain of stored energy over the energy supplied of a plate, six particles thick, clamped and bent by a velocity; two
/// of five steps are this share of a full one.
fn gained(share: f64) -> f64 {
    let bent = |[x, _]: [f64; 2], start| meshfree::scheme::Start {
        velocity: [0.0, (x.max(0.0) / 0.2).powi(2)],
        ..start
    };
    let law = Linear::from_bulk_modulus(1000.0, 3.25e6);
    let plate = Material::new("soft", law).with_shear_modulus(7.15e5);
    let body = Body::block("plate", plate, [-0.02, 0.0], [0.2, 0.02], 0.02 / 6.0);
    let scene = Scene::<f64, 2>::new(schemes::total_lagrangian().with(NeoHookean))
        .body(body.start(bent))
        .fix("plate", |[x, _]| *x < 0.0);
    let mut now = scene.build().unwrap();
    let full = now.step().unwrap();
    for k in 0..4000 {
        let step = if k % 5 < 3 { full } else { share * full };
        // An error is the end of it, and what was gained has been kept.
        if now.step_at_most(step).is_err() {
            break;
        }
    }
    now.stored_energy().largest().expect("it is checkable")
}

#[test]
fn alternating_steps() {
    let row = Row {
        case: "clamped plate, undamped, 4000 steps",
        criterion: "gain of stored energy over the energy supplied; control: two steps of five halved",
        value: gained(1.0),
        control: gained(0.5),
    };
    row.at_most(0.002);
}
