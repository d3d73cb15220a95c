//! Absorbing layers: what of a pulse comes back from them in a liquid, a gas and solids, and from ends without them.
//! Liquid under gravity stays as it is, and what does not fit is refused.

use approx::assert_abs_diff_eq;
use meshfree::effect::{AbsorbingLayer, Hypoelastic, Sponge, StVenantKirchhoff};
use meshfree::material::SoundSpeed;
use meshfree::material::eos::{IdealGas, Linear};
use meshfree::prelude::*;
use meshfree::scene::Start;
use std::f64::consts::TAU;

const RHO: f64 = 1000.0;
/// Sound speed of liquid and gas \[m/s\], and of longitudinal waves in the solid.
const C: f64 = 100.0;
const MODULUS: f64 = 5e6;
const DX: f64 = 0.01;
/// Ten spacings, and twenty for gas, whose kernels are wider.
const LAYER: f64 = 0.1;
const WIDE: f64 = 0.2;

fn soft() -> Material<f64> {
    Material::new("soft", Linear::new(RHO, C)).with_shear_modulus(MODULUS)
}

fn solid_speed() -> f64 {
    (C * C + 4.0 / 3.0 * MODULUS / RHO).sqrt()
}

fn both_ends(thickness: f64) -> AbsorbingLayer {
    let [low, high] = [(0.0, -1.0), (1.0, 1.0)];
    let layer = |(x, normal)| AbsorbingLayer::beyond([x], [normal], thickness);
    layer(low).and(layer(high))
}

/// A metre of material between two layers, in whose middle velocities of a thousandth of the sound speed make two pulses of 0.1 m,
/// one to each end. The largest speed between the layers, from when they have left until they would be back, over that of a pulse.
fn returned(
    scheme: impl Into<Scheme<f64, 1>>,
    material: Material<f64>,
    (speed, energy): (f64, f64),
    thickness: f64,
) -> f64 {
    let sent = 0.5e-3 * speed;
    let start = |[x]: [f64; 1], own: Start<1>| Start {
        velocity: [2.0 * sent * (-((x - 0.5) / 0.1_f64).powi(2)).exp()],
        energy: own.energy + energy,
        ..own
    };
    let mut run = Scene::<f64, 1>::new(scheme)
        .body(Body::block("rod", material, [-thickness], [1.0 + thickness], DX).start(start))
        .boundary(MirrorPlane::symmetry([-thickness], [-1.0]))
        .boundary(MirrorPlane::symmetry([1.0 + thickness], [1.0]))
        .build()
        .expect("a rod");
    let mut most = 0.0;
    for k in 0..8 {
        run.run_until((0.95 + 0.05 * f64::from(k)) / speed)
            .expect("waves");
        let inside = run
            .all()
            .filter(|p| (0.05..0.95).contains(&p.position()[0]));
        most = inside.map(|p| p.velocity()[0].abs()).fold(most, f64::max);
    }
    most / sent
}

#[test]
fn pulses_leave_liquid_gas_and_solids() {
    let water = || catalogue::water_at(SoundSpeed::Chosen(C));
    let liquid = schemes::weakly_compressible();
    let own = returned(
        liquid.clone().with(both_ends(LAYER)),
        water(),
        (C, 0.0),
        LAYER,
    );
    assert!(own < 0.02, "liquid {own}");
    // Without the layers all comes back, and with sponges of their thickness, which do not fade pressure, a part.
    let without = returned(liquid.clone(), water(), (C, 0.0), LAYER);
    assert!(without > 0.8, "{without}");
    let rate = 3000.0;
    let sponges =
        Sponge::beyond([0.0], [-1.0], LAYER, rate).and(Sponge::beyond([1.0], [1.0], LAYER, rate));
    let sponge = returned(liquid.with(sponges), water(), (C, 0.0), LAYER);
    assert!(sponge > 0.1, "{sponge}");

    let gas = Material::new("gas", IdealGas::new(1.4, 1.0));
    let energy = C * C / (1.4 * 0.4);
    let own = returned(schemes::gas().with(both_ends(WIDE)), gas, (C, energy), WIDE);
    assert!(own < 0.02, "gas {own}");

    let layer = both_ends(LAYER).with_deviatoric_stress();
    let hypoelastic = schemes::impact_by_continuity()
        .with(Hypoelastic)
        .with(layer);
    let own = returned(hypoelastic, soft(), (solid_speed(), 0.0), LAYER);
    assert!(own < 0.02, "hypoelastic {own}");

    let layer = both_ends(LAYER).with_piola_stress();
    let elastic = schemes::total_lagrangian()
        .with(StVenantKirchhoff)
        .with(layer);
    let own = returned(elastic, soft(), (solid_speed(), 0.0), LAYER);
    assert!(own < 0.02, "total Lagrangian {own}");
}

/// What comes back of a packet of waves of 0.4 m that reaches a layer of 0.4 m at an angle to its normal, in a plane with a period along
/// the layer.
fn returned_at(degrees: f64) -> f64 {
    let (dx, length, layer) = (0.02, 3.0, 0.4);
    let (sin, cos) = degrees.to_radians().sin_cos();
    let [kx, across] = [TAU / 0.4 * cos, TAU / 0.4 * sin];
    let height = if across > 0.0 { TAU / across } else { 0.2 };
    let height = (height / dx).round() * dx;
    let ky = if across > 0.0 { TAU / height } else { 0.0 };
    let towards = [kx, ky].map(|k| k / kx.hypot(ky));
    let sent = 5e-4 * C;
    let start = move |[x, y]: [f64; 2], own: Start<2>| {
        let packet = (-((x - 0.5 * length) / 0.45).powi(2)).exp();
        let v = sent * packet * (kx * x + ky * y).sin();
        Start {
            velocity: towards.map(|n| n * v),
            density: own.density * (1.0 + v / C),
            ..own
        }
    };
    let water = catalogue::water_at(SoundSpeed::Chosen(C));
    let body = Body::block("water", water, [0.0; 2], [length + layer, height], dx);
    let end = AbsorbingLayer::beyond([length, 0.0], [1.0, 0.0], layer);
    let mut run = Scene::<f64, 2>::new(schemes::weakly_compressible().with(end))
        .body(body.start(start))
        .boundary(Periodic::along(1, 0.0, height))
        .build()
        .expect("waves");
    run.run_until(length / (C * towards[0])).expect("waves");
    let inside = run.all().filter(|p| (0.4..2.7).contains(&p.position()[0]));
    let speeds = inside.map(|p| p.velocity()[0].hypot(p.velocity()[1]));
    speeds.fold(0.0, f64::max) / sent
}

/// A layer that begins at once would give back (1 − cos θ)/(1 + cos θ): Berenger 1994.
#[test]
fn oblique_waves_leave_better_than_through_a_layer_that_begins_at_once() {
    assert!(returned_at(0.0) < 0.02);
    let own = returned_at(45.0);
    let cos = 0.5_f64.sqrt();
    assert!(own < (1.0 - cos) / (1.0 + cos) && own > 0.02, "{own}");
}

/// A column of water on a wall, with a layer at its foot, for 40 times that of sound through it.
#[test]
fn water_stands_on_a_layer() {
    let gravity = [-9.81];
    let water = catalogue::water_at(SoundSpeed::Chosen(C));
    let layer = AbsorbingLayer::beyond([0.3], [-1.0], 0.3);
    let body = Body::block("water", water, [0.0], [1.0], DX);
    let mut column = Scene::<f64, 1>::new(schemes::weakly_compressible().with(layer))
        .body(body.hydrostatic(gravity, [1.0]))
        .boundary(MirrorPlane::wall([0.0], [-1.0]))
        .acceleration(move |_| gravity)
        .build()
        .expect("a column");
    let top = |column: &Simulation<f64, 1>| {
        let places = column.all().map(|p| p.position()[0]);
        places.fold(0.0, f64::max)
    };
    let before = top(&column);
    column.run_until(0.4).expect("water at rest");
    assert_abs_diff_eq!(top(&column), before, epsilon = 1e-4);
    let foot = column
        .all()
        .min_by(|a, b| a.position()[0].total_cmp(&b.position()[0]));
    let pressure = foot.expect("a particle").pressure();
    assert_abs_diff_eq!(pressure, RHO * 9.81, epsilon = 0.01 * RHO * 9.81);
}

#[test]
fn the_wrong_stress_and_thickness_are_refused() {
    let refused = |scheme: Scheme<f64, 1>| {
        let scene = Scene::<f64, 1>::new(scheme).body(Body::block("b", soft(), [0.0], [1.0], DX));
        let problems: Vec<_> = scene.problems().iter().map(ToString::to_string).collect();
        problems.join("\n")
    };
    let solid = schemes::impact_by_continuity().with(Hypoelastic);
    let text = refused(solid.clone().with(both_ends(LAYER)).compose());
    assert!(text.contains("with_deviatoric_stress"), "{text}");
    let solid = schemes::total_lagrangian().with(StVenantKirchhoff);
    let text = refused(solid.clone().with(both_ends(LAYER)).compose());
    assert!(text.contains("with_piola_stress"), "{text}");
    let layer = AbsorbingLayer::beyond([0.0], [1.0], -0.1).with_piola_stress();
    let text = refused(solid.with(layer).compose());
    assert!(
        text.contains("thickness of an absorbing layer") && text.contains("-0.1"),
        "{text}"
    );
}
