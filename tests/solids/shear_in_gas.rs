//! Shear in a gas: the switch of Cullen and Dehnen sees the velocity gradient of every particle.
//! Without it nothing tells a vortex from a shock.

use meshfree::material::eos::IdealGas;
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::term::viscosity::CullenDehnen;

/// v = (a y, b x): the gradient in the middle of the gas is that of the flow.
#[test]
fn a_switch_knows_the_gradient_of_the_flow() {
    const A: f64 = 0.3;
    const B: f64 = -0.1;
    let start = |[x, y]: [f64; 2], own| Start {
        velocity: [A * y, B * x],
        energy: 2.5,
        ..own
    };
    let gas = Material::new("gas", IdealGas::new(1.4, 1.0));
    let gas = Body::block("gas", gas, [-0.5; 2], [0.5; 2], 0.05).start(start);
    let scheme = schemes::gas().with_viscosity(CullenDehnen::default());
    let mut gas = Scene::<f64, 2>::new(scheme).body(gas).build().expect("gas");
    gas.step_at_most(1e-6).expect("a step");
    let mut inside = 0;
    for particle in gas.all() {
        if particle.position().iter().all(|x| x.abs() < 0.2) {
            let gradient = particle
                .matrix(Field::VELOCITY_GRADIENT)
                .expect("a gradient");
            for (found, exact) in gradient.iter().flatten().zip([0.0, A, B, 0.0]) {
                assert!((found - exact).abs() < 1e-4, "{gradient:?}");
            }
            inside += 1;
        }
    }
    assert!(inside > 30, "{inside}");
}
