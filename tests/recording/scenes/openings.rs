//! Inlets, outlets, and groups: liquids that meet structures, or do not.
//! Particles enter, leave, and are numbered anew while a scene runs.

use super::{Plan, Scenes, noise};
use meshfree::boundary::Inlet;
use meshfree::material::{Liquid, SoundSpeed};
use meshfree::observe::FlowPlane;
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::term::LaminarViscosity;

const DX: f64 = 0.01;

pub fn add(scenes: &mut Scenes) {
    openings(scenes);
    structures(scenes);
}

fn water<T: Real>() -> Material<T> {
    catalogue::weakly_compressible_water(2.0)
}

/// Water that flows through a periodic channel, in through an inlet and out beyond a plane.
fn channel<T: Real>(scheme: impl Into<Scheme<T, 2>>) -> Scene<T, 2> {
    let (length, width) = (0.2, 0.1);
    let opening = (0..10).map(|k| [0.0, DX * (f64::from(k) + 0.5)]);
    let inlet = Inlet::new("water", opening.collect(), [4.0, 0.0], DX, 120);
    let body = Body::block("water", water(), [0.0; 2], [length, width], DX);
    let body = body.start(|x, start| Start {
        velocity: [4.0 + 0.1 * noise(x)[0], 0.1 * noise(x)[1]],
        ..start
    });
    Scene::new(scheme)
        .body(body)
        .inlet(inlet)
        .outlet(Outlet::plane([length, 0.0], [1.0, 0.0]))
        .boundary(Periodic::along(1, 0.0, width))
}

fn openings(scenes: &mut Scenes) {
    let weak = schemes::weakly_compressible;
    let plan = || Plan {
        steps: 60,
        change: |_| {},
        read: |now| {
            let plane = FlowPlane::new([0.1, 0.0], [1.0, 0.0]).expect("a plane");
            vec![plane.mass_beyond(now)]
        },
    };
    scenes.add_with("inlet-and-outlet", plan(), move || channel::<f64>(weak()));
    scenes.add("inlet-and-outlet-f32", 60, move || channel::<f32>(weak()));
    scenes.add("inlet-and-outlet-with-shifting", 60, move || {
        channel::<f64>(weak().with(Shifting::STANDARD))
    });
    scenes.add("inlet-and-outlet-in-one-dimension", 60, move || {
        let body = Body::block("water", water(), [0.0], [0.4], DX);
        Scene::<f64, 1>::new(weak())
            .body(body.velocity([4.0]))
            .inlet(Inlet::new("water", vec![[0.0]], [4.0], DX, 60))
            .outlet(Outlet::plane([0.4], [1.0]))
    });
    scenes.add("outlets-of-a-box-and-of-a-speed", 60, move || {
        let body = Body::block("water", water(), [0.0; 2], [0.16; 2], DX);
        let body = body.start(|x, start| Start {
            velocity: [if x[1] > 0.12 { 6.5 } else { 2.0 }, 12.0 * (x[0] - 0.08)],
            ..start
        });
        Scene::<f64, 2>::new(weak())
            .body(body)
            .outlet(Outlet::outside_box([-0.1, 0.0], [0.17, 0.2]))
            .outlet(Outlet::faster_than(6.52))
    });
}

/// A soft solid without shear strength: 2000 kg/m³, 40 m/s.
fn soft<T: Real>() -> Material<T> {
    Liquid::new(2000.0, 40.0, 0.0).material("soft", SoundSpeed::Physical)
}

/// A drop with a random flow that falls on a soft block.
fn drop_on_block<T: Real>(
    scheme: impl Into<Scheme<T, 2>>,
    change: impl Fn(Body<T, 2>) -> Body<T, 2>,
) -> Scene<T, 2> {
    let drop = Body::block(
        "drop",
        water().with_dynamic_viscosity(0.5),
        [0.0; 2],
        [0.12; 2],
        DX,
    );
    let drop = drop.start(|x, start| {
        let own = noise(x.map(|x| 8.0 * x)).map(|v| 0.2 * v);
        Start {
            velocity: [own[0], own[1] - 1.0],
            ..start
        }
    });
    let block = Body::block("block", soft(), [-0.05, -0.105], [0.17, -0.005], DX);
    Scene::new(scheme)
        .body(drop)
        .group(schemes::impact(), [change(block)])
}

fn structures(scenes: &mut Scenes) {
    let weak = schemes::weakly_compressible;
    scenes.add("structure-with-slip", 40, move || {
        drop_on_block::<f64>(weak(), |block| block)
    });
    scenes.add("structure-with-slip-f32", 40, move || {
        drop_on_block::<f32>(weak(), |block| block)
    });
    scenes.add("structure-without-slip", 40, move || {
        drop_on_block::<f64>(weak().with(Laminar(LaminarViscosity)), Body::no_slip)
    });
    scenes.add("structure-beside-riemann-walls", 40, move || {
        let side = [[true, false], [false; 2]];
        let side = Wall::around("side", [0.0; 2], [0.2, 0.2], DX, 4, side);
        drop_on_block::<f64>(weak().walls(RiemannWalls::default()), |block| block)
            .wall(side)
            .between("block", "side", Interaction::None)
    });
    scenes.add("structure-finer-than-liquid-in-space", 10, move || {
        let drop = Body::block("drop", water(), [0.0; 3], [0.05; 3], DX);
        let low = [-0.01, -0.01, -0.0375];
        let block = Body::block("block", soft(), low, [0.06, 0.06, -0.0075], 0.5 * DX);
        Scene::<f32, 3>::new(weak())
            .body(drop.velocity([0.1, 0.0, -1.0]))
            .group(schemes::impact(), [block])
    });
    scenes.add("plate-that-strikes-water", 60, move || {
        let water = Liquid::new(1000.0, 1480.0, 0.0).material("water", SoundSpeed::Physical);
        let plate = Body::block("plate", catalogue::copper(), [-1e-3], [0.0], 2e-5);
        Scene::<f64, 1>::new(weak())
            .body(Body::block("water", water, [0.0], [2e-3], 2e-5))
            .group(schemes::impact(), [plate.velocity([1.0])])
    });
    scenes.add("block-in-water-between-boundaries", 30, move || {
        let g = 9.81;
        let block = Body::block("block", soft(), [0.0, 0.0], [0.1, 0.08], DX);
        let body = Body::block("water", water(), [0.0, 0.08], [0.1, 0.2], DX);
        Scene::<f64, 2>::new(weak())
            .body(body.hydrostatic([0.0, -g], [0.0, 0.2]))
            .group(schemes::impact(), [block])
            .boundary(Periodic::along(0, 0.0, 0.1))
            .boundary(MirrorPlane::wall([0.0, 0.0], [0.0, -1.0]))
            .acceleration(move |_| [0.0, -g])
    });
    scenes.add("groups-that-do-not-meet", 40, move || {
        let body = Body::block("water", water(), [0.0; 2], [0.12; 2], DX);
        let [left, right] =
            [("left", 0.0, 1.0), ("right", 0.06, -1.0)].map(|(name, low, speed)| {
                Body::block(name, soft(), [low, 0.0], [low + 0.06, 0.06], DX).velocity([speed, 0.0])
            });
        Scene::<f64, 2>::new(weak())
            .body(body.velocity([0.3, 0.1]))
            .group(schemes::impact(), [left, right])
            .between("water", "left", Interaction::None)
            .between("right", "water", Interaction::None)
    });
    scenes.add("two-structures-and-a-wall", 40, move || {
        let [left, right] = [("left", -0.05), ("right", 0.06)]
            .map(|(name, low)| Body::block(name, soft(), [low, -0.105], [low + 0.11, -0.005], DX));
        let drop = Body::block("drop", water(), [0.0; 2], [0.12; 2], DX).velocity([0.0, -1.0]);
        let side = [[true, false], [false; 2]];
        let side = Wall::around("side", [-0.01, 0.0], [0.2, 0.2], DX, 4, side);
        Scene::<f64, 2>::new(weak())
            .body(drop)
            .group(schemes::impact(), [left, right])
            .wall(side.motion(Translation::steady([0.2, 0.0])))
            .between("left", "side", Interaction::None)
            .between("right", "side", Interaction::None)
    });
}
