//! A solid of particles a micrometre and a kilometre apart moves in `f32` as one of metres does: elasticity has no length of its own.
//! What fails elsewhere is a power of a length that leaves the range of the scalar before another brings it back.

use meshfree::effect::{ArtificialStress, HourglassFree, Hypoelastic};
use meshfree::prelude::*;
use meshfree::scene::Start;

/// Velocities \[m/s\] of a block of steel, 6³ particles so far apart \[m\], that has rung for 20 steps from 50 m/s.
fn velocities(spacing: f64) -> Vec<f64> {
    let scheme = schemes::impact_by_continuity()
        .with(Hypoelastic)
        .with(ArtificialStress::default())
        .with(HourglassFree::default());
    let steel = catalogue::steel_4340::<f32>();
    let block = Body::block("block", steel, [0.0; 3], [6.0 * spacing; 3], spacing);
    let block = block.start(move |x: [f64; 3], own| Start {
        velocity: x.map(|x| 50.0 * (x / spacing).sin()),
        ..own
    });
    let scene = Scene::<f32, 3>::new(scheme.compose()).body(block);
    let mut block = scene.build().expect("a block");
    for _ in 0..20 {
        block.step().expect("a step");
    }
    block.all().flat_map(|p| p.velocity()).collect()
}

#[test]
fn a_solid_knows_no_length() {
    let metres = velocities(1.0);
    for spacing in [1e-6, 1e3] {
        let pairs = metres.iter().zip(velocities(spacing));
        let off = pairs.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
        // Measured 1e-4: rounding of `f32` at 50 m/s is 4e-6, and 20 steps.
        assert!(off < 1e-3, "{spacing} m: {off} m/s");
    }
}
