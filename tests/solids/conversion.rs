//! Total-Lagrangian bodies that go on as updated-Lagrangian ones: what is continuous, and that both go the same way after.
//! Plane strain.

use approx::assert_relative_eq;
use meshfree::effect::{
    FiniteStrainPlasticity, Hypoelastic, NeoHookean, Plasticity, TotalLagrangian,
};
use meshfree::material::eos::Linear;
use meshfree::material::strength::LinearHardening;
use meshfree::prelude::*;
use meshfree::scene::Conversion;
use meshfree::scheme::Start;

const RHO: f64 = 8930.0;
const DX: f64 = 0.25e-3;

fn metal() -> Material<f64> {
    let law = Linear::from_elastic_constants(RHO, 117e9, 0.35);
    Material::new("metal", law)
        .with_shear_modulus(117e9 / 2.7)
        .with_strength(LinearHardening::new(0.2e9, 0.5e9))
}

fn flowing() -> Scheme<f64, 2> {
    schemes::impact_by_continuity()
        .with(Hypoelastic)
        .with(Plasticity)
        .compose()
}

/// A block that is thrown out of its shape, off its centre, and moves and turns as a whole.
fn thrown(scheme: Scheme<f64, 2>, material: Material<f64>, rate: f64) -> Simulation<f64, 2> {
    let start = move |[x, y]: [f64; 2], own: Start<2>| Start {
        velocity: [
            rate * (0.4 * y - x) + 2e-3 * rate,
            rate * (0.7 * y - 0.1 * x) - 1e-3 * rate,
        ],
        ..own
    };
    let block = Body::block("block", material, [-0.003, -0.002], [0.003, 0.002], DX);
    Scene::new(scheme).body(block.start(start)).build().unwrap()
}

/// Mass, momentum, angular momentum and energies of a body.
fn budget(now: &Simulation<f64, 2>) -> [f64; 6] {
    let whole = now.ledger().whole;
    let turning = |x: [f64; 2], v: [f64; 2]| x[0] * v[1] - x[1] * v[0];
    let angular = now
        .all()
        .map(|p| p.mass() * turning(p.position(), p.velocity()))
        .sum();
    let [px, py] = [whole.momentum[0], whole.momentum[1]];
    [whole.mass, px, py, angular, whole.kinetic, whole.internal]
}

/// S of the new body, and the largest difference of pressure over the largest pressure.
fn pressures(before: &Simulation<f64, 2>, after: &Simulation<f64, 2>) -> f64 {
    let most = before
        .all()
        .fold(0.0_f64, |most, p| most.max(p.pressure().abs()));
    before.all().zip(after.all()).fold(0.0_f64, |off, (a, b)| {
        off.max((a.pressure() - b.pressure()).abs())
    }) / most
}

#[test]
fn a_body_that_has_flowed_goes_on_with_all_that_it_had() {
    let total = schemes::total_lagrangian().with(FiniteStrainPlasticity);
    let mut block = thrown(total.compose(), metal(), 8e4);
    let conversion = Conversion::default().stretches([0.92, 1.5]);
    while !conversion.is_due(&block, "block").unwrap() {
        assert!(block.time() < 3e-6);
        block.step().unwrap();
    }
    let flowed = block.ledger().whole.total("plastic work").unwrap();
    assert!(flowed > 0.0);

    let body = conversion.body(&block, "block").unwrap();
    let mut after = Scene::new(flowing()).body(body).build().unwrap();
    let ([first, then], sizes) = ([budget(&block), budget(&after)], budget(&block));
    for (k, (a, b)) in first.into_iter().zip(then).enumerate() {
        assert!((a - b).abs() <= 1e-13 * sizes[k].abs(), "{k}: {a} {b}");
    }
    let own = after.ledger().whole;
    assert_relative_eq!(
        own.total("plastic work").unwrap(),
        flowed,
        epsilon = 0.0,
        max_relative = 1e-14
    );
    // Distortion is S:S/4Gρ here and ½ G (tr b̄ − 3) there, which differ by the elastic strain.
    let distortion = block.ledger().whole.total("distortion").unwrap();
    let off = own.total("distortion").unwrap() / distortion - 1.0;
    println!(
        "time {:.2e}, distortion {off:e}, pressure {:e}",
        block.time(),
        pressures(&block, &after)
    );
    assert!(off.abs() < 0.02, "{off}");
    assert!(pressures(&block, &after) < 1e-3);
    // Cauchy's stress, written once more from P and F.
    for (a, b) in block.all().zip(after.all()) {
        let f = a.matrix(TotalLagrangian::DEFORMATION).unwrap();
        let p = a.matrix(TotalLagrangian::PIOLA).unwrap();
        let volume = f[0][0] * f[1][1] - f[0][1] * f[1][0];
        let shear = (p[0][0] * f[1][0] + p[0][1] * f[1][1]) / volume;
        let s = b.tensor(Hypoelastic::STRESS).unwrap();
        assert!((s.at(0, 1) - shear).abs() < 1e-9 * 0.2e9);
        assert!((s.at(0, 0) + s.at(1, 1) + s.at(2, 2)).abs() < 1e-6 * 0.2e9);
        // No particle is beyond its yield surface.
        let yields = 0.2e9 + 0.5e9 * b.scalar(Plasticity::STRAIN).unwrap();
        assert!(s.von_mises() < yields * (1.0 + 1e-9));
    }

    // Half a microsecond on, both have gone the same way.
    let from: Vec<_> = block.all().map(|p| p.position()).collect();
    let until = 0.5e-6;
    block.run_until(block.time() + until).unwrap();
    after.run_until(until).unwrap();
    let (mut apart, mut moved) = (0.0_f64, 0.0_f64);
    for ((a, b), x) in block.all().zip(after.all()).zip(from) {
        let gap = |y: [f64; 2], z: [f64; 2]| (y[0] - z[0]).hypot(y[1] - z[1]);
        apart = apart.max(gap(a.position(), b.position()));
        moved = moved.max(gap(a.position(), x));
    }
    let [kept, flows] = [&block, &after].map(|own| own.ledger().whole.kinetic);
    println!(
        "moved {moved:e} m, apart {:.4} of it, kinetic {:+.4}",
        apart / moved,
        flows / kept - 1.0
    );
    assert!(apart < 0.03 * moved, "{apart:e} {moved:e}");
    assert_relative_eq!(flows, kept, epsilon = 0.0, max_relative = 0.02);
    let end = budget(&after);
    assert!((end[4] + end[5]) / (then[4] + then[5]) - 1.0 < 1e-12);
}

#[test]
fn rubber_goes_on_at_its_pressure() {
    let rubber = || {
        let law = Linear::from_elastic_constants(1000.0, 2e6, 0.4);
        Material::new("rubber", law).with_shear_modulus(2e6 / 2.8)
    };
    let total = schemes::total_lagrangian().with(NeoHookean);
    let mut block = thrown(total.compose(), rubber(), 3e3);
    block.run_until(4e-5).unwrap();
    let conversion = Conversion::default();
    assert!(!conversion.is_due(&block, "block").unwrap());
    assert!(
        conversion
            .stretches([0.98, 1.02])
            .is_due(&block, "block")
            .unwrap()
    );
    let body = conversion.body(&block, "block").unwrap();
    let scheme = schemes::impact_by_continuity().with(Hypoelastic);
    let after = Scene::new(scheme).body(body).build().unwrap();
    for (a, b) in budget(&block).into_iter().zip(budget(&after)) {
        assert!((a - b).abs() <= 1e-13 * a.abs(), "{a} {b}");
    }
    assert!(
        pressures(&block, &after) < 1e-9,
        "{:e}",
        pressures(&block, &after)
    );

    let refusal = |own: meshfree::error::Error| own.to_string();
    let again = refusal(conversion.body(&after, "block").err().unwrap());
    assert!(again.contains("schemes::total_lagrangian"), "{again}");
    let unknown = refusal(conversion.body(&block, "ball").err().unwrap());
    assert!(unknown.contains("no body called `ball`"), "{unknown}");
    let bounds = refusal(
        conversion
            .volumes([1.2, 2.0])
            .is_due(&block, "block")
            .err()
            .unwrap(),
    );
    assert!(
        bounds.contains("volumes") && bounds.contains("1.2"),
        "{bounds}"
    );
}
