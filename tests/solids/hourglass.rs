//! Hourglass control that yields with the metal, against one that does not: the same block, pressed far beyond its yield.
//! Plane strain.

use meshfree::effect::{FiniteStrainPlasticity, HourglassControl, YieldingHourglass};
use meshfree::material::eos::Linear;
use meshfree::material::strength::LinearHardening;
use meshfree::prelude::*;
use meshfree::scheme::Start;

/// Shares of the first energy of motion that the control has worked and that have gone into flow, the drift of energy, and
/// the momentum gained over that of a half, when a block whose halves meet in a bent front has come to rest.
fn pressed(scheme: Scheme<f64, 2>) -> [f64; 4] {
    let law = Linear::from_elastic_constants(8930.0, 117e9, 0.35);
    let metal = Material::new("metal", law)
        .with_shear_modulus(117e9 / 2.7)
        .with_strength(LinearHardening::new(0.2e9, 0.2e9));
    let start = |[x, y]: [f64; 2], own: Start<2>| Start {
        velocity: [-80.0 * (1e3 * x + 0.4 * (1.5e3 * y).sin()).tanh(), 0.0],
        ..own
    };
    let block = Body::block("block", metal, [-0.005, -0.003], [0.005, 0.003], 0.25e-3);
    let mut block = Scene::new(scheme).body(block.start(start)).build().unwrap();
    let first = block.ledger().whole;
    block.run_until(15e-6).unwrap();
    let own = block.ledger().whole;
    let share = |name: &str| own.total(name).unwrap() / first.kinetic;
    [
        share("hourglass energy"),
        share("plastic work"),
        own.total_energy() / first.total_energy() - 1.0,
        (own.momentum[0] - first.momentum[0]).abs() / (0.5 * own.mass * 80.0),
    ]
}

#[test]
fn a_control_that_yields_takes_less_of_the_work() {
    let plastic = || schemes::total_lagrangian().with(FiniteStrainPlasticity);
    let firm = pressed(plastic().compose());
    let soft = pressed(plastic().with(YieldingHourglass).compose());
    println!("{firm:?}\n{soft:?}");
    for own in [firm, soft] {
        assert!(own[2].abs() < 1e-12 && own[3] < 1e-12, "{own:?}");
        assert!(own[1] > 0.5, "{own:?}");
    }
    assert!(soft[0].abs() < 0.5 * firm[0].abs(), "{soft:?} {firm:?}");
    assert_eq!(HourglassControl::default().strength, 0.1);
    let elastic = schemes::total_lagrangian().with(meshfree::effect::NeoHookean);
    let block = Body::<f64, 2>::block("block", catalogue::ofhc_copper(), [0.0; 2], [0.1; 2], 0.01);
    let refused = Scene::new(elastic.with(YieldingHourglass))
        .body(block)
        .build();
    let refused = refused.err().map(|own| own.to_string()).unwrap_or_default();
    assert!(refused.contains("FiniteStrainPlasticity"), "{refused}");
}
