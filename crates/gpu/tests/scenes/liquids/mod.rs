//! Whole scenes on the device: against the host, to the bits in any work groups, and what is refused by name.
//! Water in a tank, in the plane and in space.

mod agreement;
mod lists;
mod refused;
mod steps;

use crate::compare::on;
use meshfree::effect::{Laminar, NeoHookean, Shifting};
use meshfree::kernel::{Kernel, WendlandC2};
use meshfree::material::eos::Linear;
use meshfree::prelude::*;
use meshfree::term::LaminarViscosity;

/// Gravity \[m/s²\].
const G: f64 = 9.81;

/// What a tank is filled with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Fill {
    /// Water over the whole floor, at rest.
    Still,
    /// A column at one end.
    Dam,
}

/// Width of the tank, depth of the water and spacing \[m\].
pub(crate) fn sizes<const D: usize>() -> [f64; 3] {
    if D == 2 {
        [0.6, 0.3, 0.0125]
    } else {
        [0.5, 0.3, 0.05]
    }
}

/// Water in a tank with an open top, under a scheme.
pub(crate) fn tank<T: Real, const D: usize>(
    fill: Fill,
    scheme: impl Into<Scheme<T, D>>,
    change: impl FnOnce(Body<T, D>, Wall<D>) -> (Body<T, D>, Wall<D>),
) -> Scene<T, D> {
    let [width, depth, spacing] = sizes::<D>();
    let mut high = [width; D];
    high[D - 1] = depth;
    if fill == Fill::Dam {
        high[0] = 0.5 * width;
    }
    let mut closed = [[true; 2]; D];
    closed[D - 1][1] = false;
    let gravity: [f64; D] = core::array::from_fn(|d| if d + 1 == D { -G } else { 0.0 });
    let water = catalogue::weakly_compressible_water::<T>((2.0 * G * depth).sqrt());
    let water = water.with_dynamic_viscosity(1.0);
    let wall = Wall::around("tank", [0.0; D], [width; D], spacing, 3, closed);
    let body = Body::block("water", water, [0.0; D], high, spacing);
    let (body, wall) = change(body, wall);
    Scene::<T, D>::new(scheme)
        .body(body)
        .wall(wall)
        .acceleration(move |_| gravity)
}

/// The same under the ready scheme, on instructions without fused multiply-adds, or the best that there are.
pub(crate) fn water<T: Real, const D: usize>(fill: Fill, fused: bool) -> Scene<T, D>
where
    WendlandC2: Kernel<D>,
{
    let scene = tank::<T, D>(fill, schemes::weakly_compressible(), |body, wall| {
        (body, wall)
    });
    on(scene, fused)
}

/// A viscous column whose particles are shifted, in a tank that swings and to which it sticks.
pub(crate) fn stirred<T: Real>(fused: bool) -> Scene<T, 2> {
    let scheme = schemes::weakly_compressible()
        .with(Laminar(LaminarViscosity))
        .with(Shifting::STANDARD);
    let (size, rate) = (0.01, 20.0);
    let motion = Translation::new(
        move |t: f64| [size * (rate * t).sin(), 0.0],
        move |t: f64| [size * rate * (rate * t).cos(), 0.0],
        move |t: f64| [-size * rate * rate * (rate * t).sin(), 0.0],
    );
    let scene = tank(Fill::Dam, scheme, |body, wall| {
        (body, wall.no_slip().motion(motion))
    });
    on(scene, fused)
}

/// Vortices in a square that is periodic along both axes, and that streams through itself.
pub(crate) fn vortices<T: Real>(fused: bool) -> Scene<T, 2> {
    let (length, speed) = (0.5, 1.0);
    let water = catalogue::weakly_compressible_water::<T>(2.0 * speed);
    let wave = core::f64::consts::TAU / length;
    let flow = move |[x, y]: [f64; 2]| {
        let (u, v) = (
            (wave * x).cos() * (wave * y).sin(),
            (wave * x).sin() * (wave * y).cos(),
        );
        [speed * (0.5 - u), speed * v]
    };
    let start = move |x, start| meshfree::scheme::Start {
        velocity: flow(x),
        ..start
    };
    let body = Body::block("water", water, [0.0; 2], [length; 2], 0.0125).start(start);
    let scene = Scene::new(schemes::weakly_compressible())
        .body(body)
        .boundary(Periodic::along(0, 0.0, length))
        .boundary(Periodic::along(1, 0.0, length));
    on(scene, fused)
}

/// A free plate of rubber that bends, by its neighbours as built.
pub(crate) fn plate<T: Real>(fused: bool) -> Scene<T, 2> {
    let rubber = Linear::new(1010.0, 54.0);
    let rubber = Material::<T>::new("rubber", rubber).with_shear_modulus(7e5);
    let (length, height) = (0.4, 0.1);
    let bend = move |[x, _]: [f64; 2], start| meshfree::scheme::Start {
        velocity: [0.5, 8.0 * (core::f64::consts::PI * x / length).sin()],
        ..start
    };
    let body = Body::block("plate", rubber, [0.0; 2], [length, height], 0.005).start(bend);
    let scheme = schemes::total_lagrangian().with(NeoHookean);
    on(Scene::new(scheme).body(body), fused)
}
