//! Restart of layers, openings, recorded motions and mechanisms: stopped at any moment, they go on to the same bits.
//! What they remember, as the stress of the start in a layer, is in the file.

use super::flap::raft_with_flap;
use super::stopped::stop_and_go_on;
use meshfree::boundary::{FlowRate, GivenPressure, Inlet, Outlet, Recorded, TimeSeries, Wall};
use meshfree::effect::{AbsorbingLayer, Hypoelastic, Sponge, StVenantKirchhoff};
use meshfree::material::eos::Linear;
use meshfree::material::{Material, SoundSpeed};
use meshfree::prelude::*;
use meshfree::scene::Start;
use std::f64::consts::TAU;

/// Sound speed \[m/s\].
const C: f64 = 100.0;
const DX: f64 = 0.01;

/// A strip whose last 0.1 m of 0.4 m are an absorbing layer, with a pulse before it that is half through the layer after 1.5 ms.
fn strip<const D: usize>(
    scheme: impl Into<Scheme<f64, D>>,
    material: Material<f64>,
    high: [f64; D],
) -> Scene<f64, D> {
    let start = |x: [f64; D], own: Start<D>| {
        let shape = (-((x[0] - 0.2) / 0.05_f64).powi(2)).exp();
        // Across the strip too, so that shear stress fades in the layer.
        let velocity = core::array::from_fn(|d| [0.1, 0.03, 0.0][d] * shape);
        Start { velocity, ..own }
    };
    Scene::new(scheme).body(Body::block("strip", material, [0.0; D], high, DX).start(start))
}

fn layer<const D: usize>() -> AbsorbingLayer {
    let [place, normal] =
        [0.3, 1.0].map(|x| core::array::from_fn(|d| if d == 0 { x } else { 0.0 }));
    AbsorbingLayer::beyond::<D>(place, normal, 0.1)
}

#[test]
fn pulses_in_absorbing_layers() {
    let end = 3e-3;
    let liquid = || {
        let water = catalogue::water_at(SoundSpeed::Chosen(C));
        strip(
            schemes::weakly_compressible().with(layer::<1>()),
            water,
            [0.4],
        )
    };
    stop_and_go_on("layer-liquid", liquid, true, end);
    let soft = || Material::new("soft", Linear::new(1000.0, C)).with_shear_modulus(5e6);
    let hypoelastic = || {
        let layer = layer::<2>().with_deviatoric_stress();
        let scheme = schemes::impact_by_continuity()
            .with(Hypoelastic)
            .with(layer);
        strip(scheme, soft(), [0.4, 0.05])
    };
    stop_and_go_on("layer-hypoelastic", hypoelastic, false, end);
    let total = || {
        let layer = layer::<2>().with_piola_stress();
        let scheme = schemes::total_lagrangian()
            .with(StVenantKirchhoff)
            .with(layer);
        strip(scheme, soft(), [0.4, 0.05])
    };
    stop_and_go_on("layer-total-lagrangian", total, false, end);
}

/// A piston that follows rows for 0.12 s and then rests, before a sponge.
#[test]
fn a_flume_with_a_recorded_piston_and_a_sponge() {
    let (dx, gravity) = (0.02, [0.0, -9.81]);
    let rows: Vec<(f64, [f64; 2])> = (0..=12)
        .map(|k| 0.01 * f64::from(k))
        .map(|t| (t, [0.01 * (1.0 - (TAU * t / 0.12).cos()), 0.0]))
        .collect();
    let scene = || {
        let motion = Recorded::translation(&rows).unwrap().at_rest_beyond();
        let place = |i: u32, j: u32| [dx * (f64::from(i) - 3.5), dx * (f64::from(j) + 0.5)];
        let piston = (0..4).flat_map(|i| (0..10).map(move |j| place(i, j)));
        let water = catalogue::water_at(SoundSpeed::Chosen(10.0));
        let water = Body::block("water", water, [0.0; 2], [0.8, 0.1], dx);
        let sides = [[false, true], [true, false]];
        let sponge = Sponge::beyond([0.3, 0.0], [1.0, 0.0], 0.5, 10.0);
        Scene::<f64, 2>::new(schemes::weakly_compressible().with(sponge))
            .body(water.hydrostatic(gravity, [0.0, 0.1]))
            .wall(Wall::around("tank", [-0.08, 0.0], [0.8, 0.2], dx, 4, sides))
            .wall(Wall::of("piston", piston.collect(), dx).motion(motion))
            .acceleration(move |_| gravity)
    };
    stop_and_go_on("flume", scene, true, 0.15);
}

/// A pipe between plates: the flow that enters follows rows, and a pressure is held where it leaves.
#[test]
fn a_pipe_whose_flow_follows_rows() {
    let rows: Vec<(f64, f64)> = (0..=20)
        .map(|k| 0.01 * f64::from(k))
        .map(|t| (t, 0.1 * (1.0 + 0.5 * (TAU * t / 0.08).sin())))
        .collect();
    let scene = || {
        let opening: Vec<_> = (0..10).map(|k| [0.0, DX * (f64::from(k) + 0.5)]).collect();
        let flow = FlowRate::over(&opening, DX, TimeSeries::rows(&rows).unwrap());
        let water = catalogue::weakly_compressible_water(2.0);
        let closed = [[false; 2], [true; 2]];
        Scene::<f64, 2>::new(schemes::weakly_compressible())
            .body(Body::block("water", water, [0.0; 2], [0.2, 0.1], DX).velocity([1.0, 0.0]))
            .wall(Wall::around(
                "plates",
                [-0.06, 0.0],
                [0.26, 0.1],
                DX,
                4,
                closed,
            ))
            .inlet(Inlet::through("water", opening, [1.0, 0.0], DX, 60, flow))
            .outlet(Outlet::plane([0.2, 0.0], [1.0, 0.0]).buffer(0.05, GivenPressure::of(500.0)))
    };
    stop_and_go_on("pipe", scene, true, 0.12);
}

#[test]
fn a_raft_with_a_flap_on_a_hinge() {
    stop_and_go_on("raft", || raft_with_flap(0.02), true, 0.08);
}
