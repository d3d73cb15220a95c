//! A disc that sinks slowly in a closed channel, 8 diameters wide (Glowinski et al. 2001), to its steady speed.
//! The weight of the liquid only lifts it, so it is taken off the disc, and the liquid has no pressure that hardens its lattice.

use meshfree::coupling::Penalty;
use meshfree::effect::{ConsistentShifting, ExtrapolatedPressure, VolumeConsistency};
use meshfree::geometry::fill;
use meshfree::material::eos::Linear;
use meshfree::material::{Liquid, SoundSpeed};
use meshfree::prelude::*;
use meshfree::term::viscosity::Inviscid;
use meshfree::term::{Antuono, LaminarViscosity};
use std::f64::consts::PI;

/// Diameter of the disc, width and height of the channel \[m\].
const DIAMETER: f64 = 2.5e-3;
const CHANNEL: [f64; 2] = [0.02, 0.06];
/// Dynamic viscosity \[Pa s\], densities of liquid and disc \[kg/m³\].
const VISCOSITY: f64 = 0.01;
const DENSITIES: [f64; 2] = [1000.0, 1250.0];
const GRAVITY: f64 = 9.81;
/// The speed \[m/s\] that Glowinski et al. computed with fictitious domains.
const EXACT: f64 = 0.055;

/// Speed \[m/s\] of the disc of so many particles across, as a mean over 20 ms before a time \[s\].
fn speed(across: f64, weight: bool, time: f64) -> f64 {
    let dx = DIAMETER / across;
    // Ten times the speed of the disc, or twice that of a fall from the surface to the bottom.
    let sound = if weight { 1.5 } else { 0.55 };
    let viscous = schemes::weakly_compressible()
        .density_diffusion(Antuono::default())
        .walls(ExtrapolatedPressure {
            floor: f64::NEG_INFINITY,
        })
        .with_viscosity(Inviscid)
        .with(Laminar(LaminarViscosity))
        .with(ConsistentShifting {
            in_tension: true,
            strength: if weight { 0.0 } else { 0.1 },
        })
        .with(VolumeConsistency { strength: 0.05 });
    let ball = Ball::new([0.5 * CHANNEL[0], 0.04], 0.5 * DIAMETER);
    let around = Cuboid::new([0.0; 2], CHANNEL).minus(ball);
    let around = fill(&around, dx, [0.0; 2]).expect("a channel");
    let inside = fill(&ball, dx, [0.0; 2]).expect("a disc");
    // The lattice gives the disc another area; its mass is that of the round one.
    let area = inside.len() as f64 * dx * dx;
    let density = DENSITIES[1] * PI * DIAMETER * DIAMETER / 4.0 / area;
    let disc = Material::new("disc", Linear::new(density, sound));
    let liquid = Liquid::new(DENSITIES[0], 1450.0, VISCOSITY).linear();
    let liquid = liquid.material("liquid", SoundSpeed::Chosen(sound));
    let mut liquid = Body::points_of("liquid", liquid, around, dx);
    if weight {
        liquid = liquid.hydrostatic([0.0, -GRAVITY], [0.0, CHANNEL[1]]);
    }
    let scene = Scene::<f64, 2>::new(viscous)
        .body(liquid)
        .group(
            schemes::impact_by_continuity(),
            [Body::points_of("disc", disc, inside, dx).no_slip()],
        )
        .rigid("disc")
        .couple("disc", "channel", Penalty::new())
        .wall(Wall::around("channel", [0.0; 2], CHANNEL, dx, 6, [[true; 2]; 2]).no_slip());
    let scene = if weight {
        scene.acceleration(|_| [0.0, -GRAVITY])
    } else {
        let reduced = GRAVITY * (1.0 - DENSITIES[0] / DENSITIES[1]);
        scene.load(Load::acceleration(move |_| [0.0, -reduced]).on("disc"))
    };
    let mut scene = scene.build().expect("a scene");
    let [before, after] = [time - 0.02, time].map(|time| {
        scene.run_until(time).expect("a fall");
        let disc = scene.body("disc").expect("a disc");
        let heights: Vec<f64> = disc.map(|p| p.position()[1]).collect();
        heights.iter().sum::<f64>() / heights.len() as f64
    });
    (before - after) / 0.02
}

#[test]
#[ignore = "a minute"]
fn a_disc_sinks_as_fast_as_by_fictitious_domains() {
    let free = speed(8.0, false, 0.32);
    // On the way: 3.9 cm/s without the weight.
    let pressed = speed(8.0, true, 0.1);
    println!("{free:.4} m/s; with the weight of the liquid {pressed:.4}");
    assert!((free / EXACT - 1.0).abs() < 0.1, "{free}");
    assert!(pressed < 0.03, "{pressed}");
}
