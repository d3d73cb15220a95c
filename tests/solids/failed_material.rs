//! Failed material: it supports no shear stress, and no longer flows, hardens or heats.
//! A copper bar is pulled apart until it breaks.

use meshfree::effect::{Damage, Hypoelastic, Plasticity};
use meshfree::material::failure::PlasticStrainLimit;
use meshfree::prelude::*;
use meshfree::scene::Start;

/// Half the length of the bar, and the distance of its particles \[m\].
const HALF: f64 = 0.01;
const DX: f64 = 1e-4;

fn pulled_apart(scheme: impl Into<Scheme<f64, 1>>) -> Simulation<f64, 1> {
    let copper = catalogue::copper()
        .with_shear_modulus(46e9)
        .with_yield_stress(1e8)
        .with_failure(PlasticStrainLimit::new(0.004));
    let apart = |[x]: [f64; 1], start| Start {
        velocity: [if x < 0.0 { -60.0 } else { 60.0 }],
        ..start
    };
    let bar = Body::block("bar", copper, [-HALF], [HALF], DX).start(apart);
    Scene::new(scheme).body(bar).build().expect("a bar")
}

/// Failure, plastic strain and plastic work of every particle, in the order of their places.
fn state(bar: &Simulation<f64, 1>) -> Vec<(f64, [f64; 3])> {
    let fields = [Damage::FAILED, Plasticity::STRAIN, Plasticity::WORK];
    let mut all = Vec::new();
    for particle in bar.all() {
        let own = fields.map(|field| particle.scalar(field).expect("a field"));
        all.push((particle.position()[0], own));
    }
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    all
}

/// From the step after that in which a particle fails its plastic strain and work stay as they are.
#[test]
fn what_has_failed_does_not_flow() {
    let scheme = schemes::impact_by_continuity()
        .with(Hypoelastic)
        .with(Plasticity)
        .with(Damage);
    let mut bar = pulled_apart(scheme);
    let mut before = state(&bar);
    let mut stayed = 0;
    while bar.time() < 1e-6 {
        bar.step().expect("a step");
        let now = state(&bar);
        for ((_, before), (_, now)) in before.iter().zip(&now) {
            let [failed, strain, work] = *before;
            if failed == 1.0 {
                assert_eq!([1.0, strain, work], *now);
                stayed += 1;
            }
        }
        before = now;
    }
    assert!(stayed > 50, "{stayed}");
    let failed: Vec<_> = before.iter().filter(|(_, own)| own[0] == 1.0).collect();
    // It breaks in the middle, where the strain exceeds the limit by less than a step adds.
    assert!((2..=6).contains(&failed.len()), "{failed:?}");
    for (x, [_, strain, _]) in failed {
        assert!(x.abs() < 8.0 * DX, "{x}");
        assert!((0.004..0.012).contains(strain), "{strain}");
    }
    let work = bar.ledger().whole.total("plastic work").expect("a column");
    println!("plastic work {work} J/m²");
    assert!(work < 400.0, "{work}");
}
